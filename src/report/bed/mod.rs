//! A bed of grains from the side, to scale: pebbles as balls, the nearest in front, coloured by a quantity.
//!
//! Only visible pebbles are written. A pebble that nearer pebbles cover, on a raster of a fifth of a pixel (coarser for
//! a large picture), is left out. So the size of the file depends on the front face of the bed and not on its depth,
//! and any visible part that is left out is narrower than a cell of the raster.

mod bar;
mod raster;
#[cfg(test)]
mod tests;

use super::number::{nice_step, significant, tick_label, ticks, whole};
use super::svg::{Anchor, Frame, Svg};
use crate::results::{Grain, Link};
use crate::solvers::granular::shape::Shape;
use crate::solvers::granular::{Domain, Wall};
pub(super) use bar::Bar;
pub(super) use raster::Raster;

const WIDTH: f64 = 900.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 26.0;
const TOP: f64 = 78.0;
/// Height of the bed, px, at most.
const HIGHEST: f64 = 640.0;

/// Direction of view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Along y: x to the right, z upwards.
    #[default]
    X,
    /// Against x: y to the right, z upwards.
    Y,
}

/// Quantity of the colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    Displacement,
    Speed,
    /// The largest at a contact of the body.
    Force,
}

/// A bed as it is drawn.
#[derive(Debug, Clone, Copy)]
pub struct BedView<'a> {
    pub title: &'a str,
    pub grains: &'a [Grain],
    /// Contacts of visible grains, drawn over them as lines with the width of the force; none for no lines.
    pub chains: &'a [Link],
    pub walls: &'a [Wall],
    pub domain: &'a Domain,
    pub side: Side,
    pub colour: Colour,
}

/// The picture, valid on its own. A grain without a value, for example displacement without a reference, is drawn in
/// grey.
pub fn bed_svg(bed: &BedView) -> String {
    let mut svg = Svg::default();
    let view = View::for_bed(bed);
    let seen = seen(bed, &view);
    let bar = Bar::new(bed.colour, bed.grains);
    svg.text("strong", (LEFT, 24.0), Anchor::Start, bed.title);
    let bodies = bed.grains.last().map_or(0, |g| u64::from(g.body) + 1);
    let count = match bodies == bed.grains.len() as u64 {
        true => format!("{} spheres", whole(bodies)),
        false => format!("{} bodies of {} pebbles", whole(bodies), whole(bed.grains.len() as u64)),
    };
    let chains = seen_chains(bed, &seen);
    let lines = match chains.last().map(|l| l.size()) {
        Some(most) => format!("; widest line {} N", significant(most, 3)),
        None => String::new(),
    };
    svg.text("small muted", (LEFT, 42.0), Anchor::Start, &format!("{count}, seen from the side{lines}"));
    bar.define(&mut svg);
    bar.draw(&mut svg);
    view.draw_axes(&mut svg);
    svg.clipped("bed", view.frame, |svg| {
        draw_grains(svg, bed, &view, &seen, &bar);
        if !chains.is_empty() {
            svg.rect("veil", view.frame);
        }
        draw_walls(svg, bed, &view);
        draw_chains(svg, bed, &view, &chains);
    });
    let bottom = view.frame.y + view.frame.height + 44.0;
    svg.finish(WIDTH, bottom, &format!("{}: side view of the bed", bed.title))
}

/// From the world to the picture.
struct View {
    /// Axes of the world to the right, and into the depth.
    right: usize,
    deep: usize,
    /// Larger is nearer.
    nearness: f64,
    low: [f64; 2],
    high: [f64; 2],
    scale: f64,
    frame: Frame,
}

impl View {
    fn for_bed(bed: &BedView) -> View {
        let (right, deep, nearness) = match bed.side {
            Side::X => (0, 1, -1.0),
            Side::Y => (1, 0, 1.0),
        };
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for grain in bed.grains {
            for (k, axis) in [right, 2].into_iter().enumerate() {
                low[k] = low[k].min(grain.place[axis] - grain.radius);
                high[k] = high[k].max(grain.place[axis] + grain.radius);
            }
        }
        if bed.grains.is_empty() {
            (low, high) = ([0.0; 2], [1.0; 2]);
        }
        // blocks that stand on the bed
        for wall in bed.walls {
            if let Shape::Block { half } = &wall.shape {
                high[1] = high[1].max(wall.pose(bed.domain).position.z + half.z);
            }
        }
        // a floor that is near enough to be shown
        let near = low[1] - 0.5 * (high[1] - low[1]);
        for level in bed.walls.iter().filter_map(|wall| floor(wall, bed.domain)).filter(|level| *level > near) {
            low[1] = low[1].min(level);
        }
        let size = [0, 1].map(|k| (high[k] - low[k]).max(1e-9));
        let room = WIDTH - LEFT - RIGHT;
        let scale = (room / size[0]).min(HIGHEST / size[1]);
        // a little room for the floor and its hatching
        let width = size[0] * scale;
        let frame = Frame { x: LEFT + 0.5 * (room - width), y: TOP, width, height: size[1] * scale + 12.0 };
        View { right, deep, nearness, low, high, scale, frame }
    }

    fn projected(&self, place: [f64; 3]) -> (f64, f64) {
        let x = self.frame.x + (place[self.right] - self.low[0]) * self.scale;
        (x, self.frame.y + (self.high[1] - place[2]) * self.scale)
    }

    fn near(&self, grain: &Grain) -> f64 {
        self.nearness * grain.place[self.deep]
    }

    /// Lengths in m along both edges.
    fn draw_axes(&self, svg: &mut Svg) {
        let bottom = self.frame.y + self.frame.height;
        let name = ["x", "y"][self.right];
        let count = (self.frame.width / 80.0).clamp(1.0, 12.0) as usize;
        let step = nice_step(((self.high[0] - self.low[0]) / count as f64).max(1e-9));
        for tick in ticks(self.low[0], self.high[0], count) {
            let x = self.frame.x + (tick - self.low[0]) * self.scale;
            svg.line("axis", (x, bottom + 3.0), (x, bottom + 8.0));
            svg.text("small muted", (x, bottom + 21.0), Anchor::Middle, &tick_label(tick, step));
        }
        svg.text("small muted", (self.frame.x + self.frame.width, bottom + 36.0), Anchor::End, &format!("{name} [m]"));
        let count = (self.frame.height / 60.0).clamp(1.0, 10.0) as usize;
        let step = nice_step(((self.high[1] - self.low[1]) / count as f64).max(1e-9));
        let left = self.frame.x - 6.0;
        for tick in ticks(self.low[1], self.high[1], count) {
            let y = self.frame.y + (self.high[1] - tick) * self.scale;
            svg.line("axis", (left - 5.0, y), (left, y));
            svg.text("small muted", (left - 8.0, y + 4.0), Anchor::End, &tick_label(tick, step));
        }
        svg.text("small muted", (left - 8.0, self.frame.y - 10.0), Anchor::End, "z [m]");
    }
}

/// Level of a wall that is a floor \[m\].
fn floor(wall: &Wall, domain: &Domain) -> Option<f64> {
    let Shape::Plane { normal } = &wall.shape else { return None };
    let pose = wall.pose(domain);
    (pose.direction_to_space(normal).z > 0.999_999).then_some(pose.position.z)
}

/// Visible grains, the farthest first.
fn seen(bed: &BedView, view: &View) -> Vec<u32> {
    let mut order: Vec<u32> = (0..bed.grains.len() as u32).collect();
    let near = |index: &u32| view.near(&bed.grains[*index as usize]);
    order.sort_by(|a, b| near(b).total_cmp(&near(a)).then(a.cmp(b)));
    let mut raster = Raster::new(view.frame.width, view.frame.height);
    order.retain(|&index| {
        let grain = &bed.grains[index as usize];
        let (x, y) = view.projected(grain.place);
        raster.cover(x - view.frame.x, y - view.frame.y, grain.radius * view.scale)
    });
    order.reverse();
    order
}

fn draw_grains(svg: &mut Svg, bed: &BedView, view: &View, seen: &[u32], bar: &Bar) {
    // a rim as thin as its ball is small
    let mean = seen.iter().map(|&i| bed.grains[i as usize].radius).sum::<f64>() / seen.len().max(1) as f64;
    svg.group(
        &format!(r##"class="grains" stroke-width="{:.2}""##, (0.05 * mean * view.scale).clamp(0.15, 0.9)),
        |svg| {
            for &index in seen {
                let grain = &bed.grains[index as usize];
                svg.ball(
                    &format!("url(#g{})", bar.ball(grain)),
                    view.projected(grain.place),
                    grain.radius * view.scale,
                );
            }
        },
    );
}

/// Contacts between visible grains, or of a visible grain with a wall; the strongest last.
fn seen_chains<'a>(bed: &BedView<'a>, seen: &[u32]) -> Vec<&'a Link> {
    let mut shown = vec![false; bed.grains.iter().map(|g| g.body as usize + 1).max().unwrap_or(0)];
    seen.iter().for_each(|&i| shown[bed.grains[i as usize].body as usize] = true);
    let is_shown = |body: u32| shown.get(body as usize).copied().unwrap_or(false);
    let mut chains: Vec<&Link> =
        bed.chains.iter().filter(|l| is_shown(l.bodies.0) && l.bodies.1.is_none_or(is_shown)).collect();
    chains.sort_by(|a, b| a.size().total_cmp(&b.size()));
    chains
}

fn draw_chains(svg: &mut Svg, bed: &BedView, view: &View, chains: &[&Link]) {
    let Some(most) = chains.last().map(|l| l.size()).filter(|f| *f > 0.0) else { return };
    let mean = bed.grains.iter().map(|g| g.radius).sum::<f64>() / bed.grains.len().max(1) as f64;
    let widest = (0.7 * mean * view.scale).clamp(1.0, 9.0);
    svg.group(r#"class="chains""#, |svg| {
        for link in chains {
            let width = widest * link.size() / most;
            // thinner lines would only make the picture grey
            if width > 0.12 {
                svg.stroke(view.projected(link.from), view.projected(link.to), width);
            }
        }
    });
}

fn draw_walls(svg: &mut Svg, bed: &BedView, view: &View) {
    for wall in bed.walls {
        let pose = wall.pose(bed.domain);
        let at = |point: &nalgebra::Vector3<f64>| view.projected(pose.to_space(point).into());
        match &wall.shape {
            Shape::Plane { normal } => {
                draw_plane(svg, view, pose.position.into(), pose.direction_to_space(normal).into())
            }
            Shape::Block { half } => {
                let corner = |k: usize| {
                    let sign = |bit: usize, h: f64| if k >> bit & 1 == 1 { h } else { -h };
                    at(&nalgebra::Vector3::new(sign(0, half.x), sign(1, half.y), sign(2, half.z)))
                };
                for (a, b) in (0..8).flat_map(|a| [1, 2, 4].map(|bit| (a, a ^ bit))).filter(|(a, b)| a < b) {
                    svg.line("wall", corner(a), corner(b));
                }
            }
            Shape::Mesh(mesh) => {
                for triangle in mesh.triangles() {
                    let corners = triangle.map(|v| at(&mesh.vertices()[v as usize]));
                    svg.path("wall", &corners, true, "");
                }
            }
        }
    }
}

/// The line in which a plane that stands upright to the picture cuts it, hatched on the side of the solid.
fn draw_plane(svg: &mut Svg, view: &View, point: [f64; 3], normal: [f64; 3]) {
    let (across, up) = (normal[view.right], normal[2]);
    let size = across.hypot(up);
    if normal[view.deep].abs() > 1e-3 || size == 0.0 {
        return; // it would cover the picture
    }
    let (x, y) = view.projected(point);
    // on the picture, downwards is larger
    let (nx, ny) = (across / size, -up / size);
    let (tx, ty) = (-ny, nx);
    let reach = 2.0 * (view.frame.width + view.frame.height);
    // beside the middle of the picture
    let (mx, my) = (view.frame.x + 0.5 * view.frame.width, view.frame.y + 0.5 * view.frame.height);
    let along = (mx - x) * tx + (my - y) * ty;
    let at = |s: f64| (x + (along + s) * tx, y + (along + s) * ty);
    let step = 9.0;
    let count = (reach / step) as i32;
    for k in -count..=count {
        let (x, y) = at(f64::from(k) * step);
        svg.line("ground", (x, y), (x - 7.0 * nx + 6.0 * tx, y - 7.0 * ny + 6.0 * ty));
    }
    svg.line("wall", at(-reach), at(reach));
}
