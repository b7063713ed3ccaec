//! A bed of grains from the side, to scale: pebbles as balls, the nearest in front, coloured by what they do.
//!
//! Only what can be seen is written. On a raster a fifth of a pixel fine, or coarser where the picture is large, a pebble
//! that nearer ones cover is left out; so the file grows with the face of the bed and not with its depth, and what is left
//! out is narrower than a cell of the raster.

use super::colour_map::{colours, hex, shade};
use super::number::{nice_step, significant, tick_label, ticks, whole};
use super::svg::{Anchor, Frame, Svg};
use crate::results::{Grain, Link};
use crate::solvers::granular::shape::Shape;
use crate::solvers::granular::{Domain, Wall};

const WIDTH: f64 = 900.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 26.0;
const TOP: f64 = 78.0;
/// Height of the bed, px, at most.
const HIGHEST: f64 = 640.0;
/// Colours of the bar.
const SHADES: usize = 24;
/// Cells of the raster at most.
const CELLS: f64 = 2e7;
/// Share of the pebbles that may lie above the bar's end.
const ABOVE: f64 = 0.01;

/// From where one looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Along y: x to the right, z upwards.
    #[default]
    X,
    /// Against x: y to the right, z upwards.
    Y,
}

/// What the colours say.
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
    /// Contacts of grains that are seen, drawn over them as lines whose width is the force; none for no lines.
    pub chains: &'a [Link],
    pub walls: &'a [Wall],
    pub domain: &'a Domain,
    pub side: Side,
    pub colour: Colour,
}

/// The picture, valid on its own. A value that a grain has not, as a displacement without a reference, is drawn in grey.
pub fn bed_svg(bed: &BedView) -> String {
    let mut svg = Svg::default();
    let view = View::of(bed);
    let seen = seen(bed, &view);
    let bar = Bar::of(bed);
    svg.text("strong", (LEFT, 24.0), Anchor::Start, bed.title);
    let bodies = bed.grains.last().map_or(0, |g| u64::from(g.body) + 1);
    let count = match bodies == bed.grains.len() as u64 {
        true => format!("{} spheres", whole(bodies)),
        false => format!("{} bodies of {} pebbles", whole(bodies), whole(bed.grains.len() as u64)),
    };
    svg.text("small muted", (LEFT, 42.0), Anchor::Start, &format!("{count}, seen from the side"));
    bar.define(&mut svg);
    bar.draw(&mut svg);
    view.draw_axes(&mut svg);
    svg.clipped("bed", view.frame, |svg| {
        draw_walls(svg, bed, &view);
        draw_grains(svg, bed, &view, &seen, &bar);
        if !bed.chains.is_empty() {
            svg.rect("veil", view.frame);
            draw_chains(svg, bed, &view, &seen);
        }
    });
    let bottom = view.frame.y + view.frame.height + 44.0;
    svg.finish(WIDTH, bottom, &format!("{}: the bed from the side", bed.title))
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
    fn of(bed: &BedView) -> View {
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
        for level in bed.walls.iter().filter_map(|wall| floor(wall, bed.domain)) {
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

    fn at(&self, place: [f64; 3]) -> (f64, f64) {
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

/// Grains that can be seen, the farthest first.
fn seen(bed: &BedView, view: &View) -> Vec<u32> {
    let mut order: Vec<u32> = (0..bed.grains.len() as u32).collect();
    let near = |index: &u32| view.near(&bed.grains[*index as usize]);
    order.sort_by(|a, b| near(b).total_cmp(&near(a)).then(a.cmp(b)));
    let mut raster = Raster::new(view.frame.width, view.frame.height);
    order.retain(|&index| {
        let grain = &bed.grains[index as usize];
        let (x, y) = view.at(grain.place);
        raster.cover(x - view.frame.x, y - view.frame.y, grain.radius * view.scale)
    });
    order.reverse();
    order
}

/// What is covered already.
struct Raster {
    /// Cells a pixel.
    fine: f64,
    width: usize,
    height: usize,
    covered: Vec<bool>,
}

impl Raster {
    fn new(width: f64, height: f64) -> Raster {
        let fine = (CELLS / (width * height).max(1.0)).sqrt().min(5.0);
        let [width, height] = [width, height].map(|side| (side * fine).ceil().max(1.0) as usize);
        Raster { fine, width, height, covered: vec![false; width * height] }
    }

    /// Covers a disc, px; says whether some of it was open, or it is too small to tell.
    fn cover(&mut self, x: f64, y: f64, radius: f64) -> bool {
        let [x, y, radius] = [x, y, radius].map(|v| v * self.fine);
        let (mut open, mut cells) = (false, 0);
        for row in within(y, radius, self.height) {
            let height = row as f64 + 0.5 - y;
            let half = (radius * radius - height * height).max(0.0).sqrt();
            for column in within(x, half, self.width) {
                let cell = &mut self.covered[row * self.width + column];
                open |= !*cell;
                *cell = true;
                cells += 1;
            }
        }
        open || cells == 0
    }
}

/// Cells whose middle is within `half` of `middle`.
fn within(middle: f64, half: f64, count: usize) -> std::ops::Range<usize> {
    let edge = |v: f64| (v - 0.5).ceil().clamp(0.0, count as f64) as usize;
    edge(middle - half)..edge(middle + half)
}

/// The colours and what they stand for.
struct Bar {
    name: &'static str,
    unit: &'static str,
    /// The unit in SI.
    size: f64,
    /// Value of the last colour, SI.
    most: f64,
    /// Largest value, SI.
    largest: f64,
    colour: Colour,
}

impl Bar {
    fn of(bed: &BedView) -> Bar {
        let mut values: Vec<f64> = bed.grains.iter().filter_map(|g| value(g, bed.colour)).collect();
        values.sort_by(f64::total_cmp);
        let largest = values.last().copied().unwrap_or(0.0);
        let usual = values.get(((1.0 - ABOVE) * values.len() as f64) as usize).copied().unwrap_or(largest);
        // few stray values must not take the colours from all others
        let most = if largest > 1.5 * usual && usual > 0.0 { usual } else { largest };
        let step = nice_step(most.max(f64::MIN_POSITIVE) / 10.0);
        let most = if most > 0.0 { (most / step - 1e-9).ceil() * step } else { 1.0 };
        let (name, units): (_, &[(&str, f64)]) = match bed.colour {
            Colour::Displacement => ("displacement", &[("m", 1.0), ("mm", 1e-3), ("\u{b5}m", 1e-6), ("nm", 1e-9)]),
            Colour::Speed => ("speed", &[("m/s", 1.0), ("mm/s", 1e-3), ("\u{b5}m/s", 1e-6)]),
            Colour::Force => ("largest contact force", &[("MN", 1e6), ("kN", 1e3), ("N", 1.0), ("mN", 1e-3)]),
        };
        let fits = units.iter().find(|(_, size)| most >= *size).or(units.last());
        let (unit, size) = fits.copied().unwrap_or(("", 1.0));
        Bar { name, unit, size, most, largest, colour: bed.colour }
    }

    /// Balls of every colour, lit from above; one name for each, so that a grain takes few bytes.
    fn define(&self, svg: &mut Svg) {
        let mut text = String::from("<defs>");
        let grey = [150, 156, 163];
        for (number, colour) in colours(SHADES).into_iter().chain([grey]).enumerate() {
            let [lit, plain, dark] = [shade(colour, 0.28), colour, shade(colour, -0.30)].map(hex);
            text += &format!(
                concat!(
                    r#"<radialGradient id="g{}" cx=".42" cy=".34" r=".72"><stop stop-color="{}"/>"#,
                    r#"<stop offset=".5" stop-color="{}"/><stop offset="1" stop-color="{}"/></radialGradient>"#
                ),
                number, lit, plain, dark
            );
        }
        svg.define(&(text + "</defs>"));
    }

    fn draw(&self, svg: &mut Svg) {
        let (width, height, y) = (288.0, 11.0, 34.0);
        let x = WIDTH - RIGHT - width;
        let label = format!("{} [{}]", self.name, self.unit);
        svg.text("small", (x, y - 8.0), Anchor::Start, &label);
        let each = width / SHADES as f64;
        for (number, colour) in colours(SHADES).into_iter().enumerate() {
            // one past the other, so that no gap shows between them
            let frame = Frame {
                x: x + number as f64 * each,
                y,
                width: each + if number + 1 < SHADES { 0.6 } else { 0.0 },
                height,
            };
            svg.swatch(&hex(colour), frame);
        }
        let most = self.most / self.size;
        let step = nice_step(most / 5.0);
        for tick in ticks(0.0, most, 5) {
            let at = x + width * tick / most;
            svg.line("axis", (at, y + height), (at, y + height + 4.0));
            svg.text("small muted", (at, y + height + 16.0), Anchor::Middle, &tick_label(tick, step));
        }
        if self.largest > self.most {
            // the last colour goes on
            let last = colours(SHADES).last().map_or(String::new(), |c| hex(*c));
            let (right, middle) = (x + width, y + 0.5 * height);
            svg.polygon(&last, &[(right, y), (right + 9.0, middle), (right, y + height)]);
            let text = format!("up to {}", significant(self.largest / self.size, 2));
            svg.text("small muted", (right, y - 8.0), Anchor::End, &text);
        }
    }

    /// Name of a grain's ball.
    fn ball(&self, grain: &Grain) -> usize {
        let Some(value) = value(grain, self.colour) else { return SHADES };
        ((value / self.most * SHADES as f64).max(0.0) as usize).min(SHADES - 1)
    }
}

fn value(grain: &Grain, colour: Colour) -> Option<f64> {
    let size = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let value = match colour {
        Colour::Displacement => grain.displacement.map(size),
        Colour::Speed => Some(size(grain.velocity)),
        Colour::Force => Some(grain.largest_force),
    };
    value.filter(|v| v.is_finite())
}

fn draw_grains(svg: &mut Svg, bed: &BedView, view: &View, seen: &[u32], bar: &Bar) {
    // a rim as thin as its ball is small
    let mean = seen.iter().map(|&i| bed.grains[i as usize].radius).sum::<f64>() / seen.len().max(1) as f64;
    svg.group(
        &format!(r##"class="grains" stroke-width="{:.2}""##, (0.05 * mean * view.scale).clamp(0.15, 0.9)),
        |svg| {
            for &index in seen {
                let grain = &bed.grains[index as usize];
                svg.ball(&format!("url(#g{})", bar.ball(grain)), view.at(grain.place), grain.radius * view.scale);
            }
        },
    );
}

/// Contacts that a seen grain has, the strongest on top.
fn draw_chains(svg: &mut Svg, bed: &BedView, view: &View, seen: &[u32]) {
    let mut shown = vec![false; bed.grains.iter().map(|g| g.body as usize + 1).max().unwrap_or(0)];
    seen.iter().for_each(|&i| shown[bed.grains[i as usize].body as usize] = true);
    let is_shown = |body: u32| shown.get(body as usize).copied().unwrap_or(false);
    let mut chains: Vec<&Link> =
        bed.chains.iter().filter(|l| is_shown(l.bodies.0) && l.bodies.1.is_none_or(is_shown)).collect();
    chains.sort_by(|a, b| a.size().total_cmp(&b.size()));
    let Some(most) = chains.last().map(|l| l.size()).filter(|f| *f > 0.0) else { return };
    let mean = seen.iter().map(|&i| bed.grains[i as usize].radius).sum::<f64>() / seen.len().max(1) as f64;
    let widest = (0.7 * mean * view.scale).clamp(1.0, 9.0);
    svg.group(r#"class="chains""#, |svg| {
        for link in chains {
            let width = widest * link.size() / most;
            // what is thinner than a hair only greys the picture
            if width > 0.12 {
                svg.stroke(view.at(link.from), view.at(link.to), width);
            }
        }
    });
}

fn draw_walls(svg: &mut Svg, bed: &BedView, view: &View) {
    for wall in bed.walls {
        let pose = wall.pose(bed.domain);
        let at = |point: &nalgebra::Vector3<f64>| view.at(pose.to_space(point).into());
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
    let (x, y) = view.at(point);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::granular::{
        Bed, Dashpot, DashpotMode, FrictionLimit, Law, Laws, Linear, Motion, Pose, WallId, shape::Mesh, shape::MeshKind,
    };
    use nalgebra::Vector3;

    fn grain(x: f64, y: f64, z: f64, radius: f64, moved: f64) -> Grain {
        Grain {
            place: [x, y, z],
            radius,
            body: 0,
            velocity: [0.0, 0.0, 3.0 * moved],
            displacement: Some([moved, 0.0, 0.0]),
            coordination: 0,
            largest_force: 0.0,
        }
    }

    fn bed() -> Bed<f64> {
        let law = Linear {
            normal_stiffness: 1e6,
            shear_stiffness: 1e6,
            friction: 0.5,
            dashpot: Dashpot::Constant { normal: 0.0, shear: 0.0 },
            mode: DashpotMode::Full,
            limit: FrictionLimit::Spring,
        };
        Bed::new(Domain::open(), Laws::single(Law::Linear(law)))
    }

    fn draw(grains: &[Grain], chains: &[Link], bed: &Bed<f64>, colour: Colour, side: Side) -> String {
        let (walls, domain) = (bed.walls(), bed.domain());
        bed_svg(&BedView { title: "a <bed>", grains, chains, walls, domain, side, colour })
    }

    /// Paint, place and radius of every ball, in the order of drawing.
    fn balls(svg: &str) -> Vec<(String, f64, f64, f64)> {
        let document = roxmltree::Document::parse(svg).unwrap();
        let number = |n: &roxmltree::Node, name: &str| n.attribute(name).unwrap().parse::<f64>().unwrap();
        let circles = document.descendants().filter(|n| n.has_tag_name("circle"));
        circles
            .map(|n| (n.attribute("fill").unwrap().into(), number(&n, "cx"), number(&n, "cy"), number(&n, "r")))
            .collect()
    }

    #[test]
    fn the_nearest_is_drawn_last_and_the_hidden_not_at_all() {
        // seen along y: the second hides the third, and half of the first
        let grains =
            [grain(0.0, 0.5, 0.0, 0.1, 1e-3), grain(0.1, 0.1, 0.0, 0.1, 2e-3), grain(0.1, 0.9, 0.02, 0.05, 3e-3)];
        let along = balls(&draw(&grains, &[], &bed(), Colour::Displacement, Side::X));
        assert_eq!(along.len(), 2);
        assert!(along[0].1 < along[1].1 && along[0].2 == along[1].2, "{along:?}");
        // to scale: two radii across three
        assert!((along[0].3 / (along[1].1 - along[0].1) - 1.0).abs() < 0.01, "{along:?}");
        // from the other side all are seen, the one of the largest x in front
        let across = balls(&draw(&grains, &[], &bed(), Colour::Displacement, Side::Y));
        assert_eq!(across.len(), 3);
        let middle = across[0].1;
        assert!((across[1].1 - middle) * (across[2].1 - middle) < 0.0, "{across:?}");
    }

    #[test]
    fn colours_follow_the_value_and_what_has_none_is_grey() {
        let mut grains: Vec<Grain> = (0..5).map(|k| grain(f64::from(k), 0.0, 0.0, 0.4, 1e-3 * f64::from(k))).collect();
        grains[4].displacement = None;
        let mut drawn = balls(&draw(&grains, &[], &bed(), Colour::Displacement, Side::X));
        drawn.sort_by(|a, b| a.1.total_cmp(&b.1));
        let paints: Vec<&str> = drawn.iter().map(|ball| ball.0.as_str()).collect();
        assert_eq!(paints, ["url(#g0)", "url(#g8)", "url(#g16)", "url(#g23)", "url(#g24)"]);
        let svg = draw(&grains, &[], &bed(), Colour::Speed, Side::X);
        assert!(svg.contains("speed [mm/s]") && svg.contains("a &lt;bed&gt;"), "{svg}");
        // one stray value does not take the colours from the others, and is told
        let mut many: Vec<Grain> = (0..200).map(|k| grain(f64::from(k), 0.0, 0.0, 0.4, 1e-3)).collect();
        many[7].displacement = Some([1.0, 0.0, 0.0]);
        let svg = draw(&many, &[], &bed(), Colour::Displacement, Side::X);
        assert!(svg.contains("displacement [mm]") && svg.contains("up to 1000"), "{svg}");
    }

    #[test]
    fn walls_and_forces_are_drawn_where_they_are() {
        let mut bed = bed();
        bed.add_plane([0.0, 0.0, -0.1], [0.0, 0.0, 1.0], 0);
        bed.add_plane([0.0, 3.0, 0.0], [0.0, -1.0, 0.0], 0);
        let pose = Pose { position: Vector3::new(0.5, 0.0, 0.5), ..Pose::default() };
        bed.add_wall(Shape::Block { half: Vector3::repeat(0.1) }, pose, 0, Motion::Fixed);
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vector3::from);
        let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]], MeshKind::TwoSided).unwrap();
        let last = bed.add_wall(Shape::Mesh(mesh), Pose::default(), 0, Motion::Fixed);
        assert_eq!(last, WallId(3));
        let grains = [grain(0.0, 0.0, 0.0, 0.1, 0.0), Grain { body: 1, ..grain(0.2, 0.0, 0.0, 0.1, 0.0) }];
        let link = |to: Option<u32>, force: f64| Link {
            from: grains[0].place,
            to: grains[1].place,
            bodies: (0, to),
            force: [-force, 0.0, 0.0],
            normal: [-1.0, 0.0, 0.0],
            overlap: 1e-6,
        };
        let links = [link(Some(1), 50.0), link(None, 100.0), link(Some(1), 0.01)];
        let svg = draw(&grains, &links, &bed, Colour::Force, Side::X);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let of = |class: &str| document.descendants().filter(|n| n.attribute("class") == Some(class)).count();
        // the floor and twelve edges as lines, the triangle as a path; the plane behind the bed would cover it
        assert_eq!(of("wall"), 1 + 12 + 1);
        let chains = document.descendants().find(|n| n.attribute("class") == Some("chains")).unwrap();
        let widths: Vec<f64> =
            chains.children().map(|n| n.attribute("stroke-width").unwrap().parse().unwrap()).collect();
        // the strongest on top, the hair left out
        assert!(widths.len() == 2 && (widths[1] / widths[0] - 2.0).abs() < 0.01, "{widths:?}");
    }

    #[test]
    fn an_empty_bed_is_a_picture_too() {
        let svg = draw(&[], &[], &bed(), Colour::Displacement, Side::X);
        assert!(roxmltree::Document::parse(&svg).is_ok() && balls(&svg).is_empty());
    }
}
