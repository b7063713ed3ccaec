//! One grain as it looks: its surface in light and shadow, or the pebbles of a clump, each cut where it meets the
//! others.

use super::svg::Svg;
use crate::solvers::granular::clump::Pebble;
use crate::solvers::granular::shape::Mesh;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};
use std::f64::consts::TAU;

/// Corners of the outline of a pebble.
const OUTLINE: usize = 60;
/// Points across a pebble among which one that shows is looked for.
const GRID: i32 = 12;
/// Overlap of facets over their edges, px, so that no gaps are visible.
const OVER: f64 = 0.35;
/// Colours of stone in shadow and in light.
const DARK: [f64; 3] = [104.0, 88.0, 66.0];
const LIGHT: [f64; 3] = [244.0, 236.0, 220.0];

/// View of the grains: an upright plane in front of them, x to the right, y up, z to the eye.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    turn: Matrix3<f64>,
    /// px for a unit of length.
    pub scale: f64,
}

impl Look {
    /// Along the third of the axes, the first to the right, and a little from the side and above.
    pub fn along([right, up, eye]: [Vector3<f64>; 3], scale: f64) -> Self {
        // axes of a box may be mirrored
        let eye = if right.cross(&up).dot(&eye) < 0.0 { -eye } else { eye };
        let lying = Matrix3::from_rows(&[right.transpose(), up.transpose(), eye.transpose()]);
        let tilt =
            Rotation3::from_axis_angle(&Vector3::x_axis(), 0.45) * Rotation3::from_axis_angle(&Vector3::y_axis(), 0.35);
        Self { turn: tilt.matrix() * lying, scale }
    }

    /// The same, so many px for a unit of length.
    pub fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    fn seen(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.turn * point * self.scale
    }
}

/// Towards the light: above, to the left, before the grain.
fn brightness(normal: &Vector3<f64>) -> f64 {
    let light = Vector3::new(-0.4, 0.62, 0.68);
    (0.25 + 0.75 * normal.dot(&light).max(0.0) / light.norm()).min(1.0)
}

fn paint(brightness: f64) -> String {
    let [r, g, b] = [0, 1, 2].map(|k| (DARK[k] + (LIGHT[k] - DARK[k]) * brightness).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Draws a surface about a place (px), the far facets first.
pub fn draw_surface(svg: &mut Svg, surface: &Mesh, look: &Look, at: (f64, f64)) {
    let seen: Vec<Vector3<f64>> = surface.vertices().iter().map(|v| look.seen(v)).collect();
    let mut facets: Vec<(f64, [Vector3<f64>; 3], Vector3<f64>)> = surface
        .triangles()
        .iter()
        .map(|corners| corners.map(|v| seen[v as usize]))
        .map(|corners| {
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
            (corners.iter().map(|c| c.z).sum(), corners, normal)
        })
        .filter(|(.., normal)| normal.z > 0.0)
        .collect();
    facets.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, corners, normal) in facets {
        let middle = corners.iter().sum::<Vector3<f64>>() / 3.0;
        let corner = |c: &Vector3<f64>| {
            let out = (c - middle).xy();
            let place = c.xy() + out * (OVER / out.norm().max(1.0));
            (at.0 + place.x, at.1 - place.y)
        };
        svg.polygon(&paint(brightness(&normal)), &corners.each_ref().map(corner));
    }
}

/// Draws the union of pebbles about a place (px). The far ones come first, each only where it is before all that came
/// before it: there the eye sees a convex part of it, since the plane in which two balls meet faces the nearer one's
/// side. `id` is unique on a page.
pub fn draw_pebbles(svg: &mut Svg, id: &str, pebbles: &[Pebble], look: &Look, at: (f64, f64)) {
    let mut seen: Vec<Pebble> =
        pebbles.iter().map(|p| Pebble { centre: look.seen(&p.centre), radius: p.radius * look.scale }).collect();
    seen.sort_by(|a, b| a.centre.z.total_cmp(&b.centre.z));
    for (k, pebble) in seen.iter().enumerate() {
        let shows = |x: f64, y: f64| {
            let front = |p: &Pebble| {
                let square = p.radius.powi(2) - (x - p.centre.x).powi(2) - (y - p.centre.y).powi(2);
                (square >= 0.0).then(|| p.centre.z + square.sqrt())
            };
            front(pebble).is_some_and(|own| seen[..k].iter().filter_map(front).all(|other| own >= other))
        };
        let Some(outline) = outline(pebble, shows) else { continue };
        let points: Vec<(f64, f64)> = outline.iter().map(|(x, y)| (at.0 + x, at.1 - y)).collect();
        let (x, y, r) = (at.0 + pebble.centre.x, at.1 - pebble.centre.y, pebble.radius);
        let [light, half, dark] = [1.0, 0.7, 0.15].map(paint);
        let (fx, fy) = (x - 0.35 * r, y - 0.45 * r);
        let place =
            format!(r#"gradientUnits="userSpaceOnUse" cx="{x:.1}" cy="{y:.1}" r="{r:.1}" fx="{fx:.1}" fy="{fy:.1}""#);
        let stop = |offset: f64, colour: &str| format!(r#"<stop offset="{offset}" stop-color="{colour}"/>"#);
        let stops = [stop(0.0, &light), stop(0.6, &half), stop(1.0, &dark)].concat();
        svg.define(&format!(r#"<radialGradient id="{id}-{k}" {place}>{stops}</radialGradient>"#));
        svg.group(r##"stroke="#685842" stroke-width=".6""##, |svg| svg.polygon(&format!("url(#{id}-{k})"), &points));
    }
}

/// The outline of the convex part of a ball that shows; `None` if nothing does.
fn outline(pebble: &Pebble, shows: impl Fn(f64, f64) -> bool) -> Option<Vec<(f64, f64)>> {
    let centre = pebble.centre;
    let place = |k: i32| {
        centre.xy().map(|c| c)
            + nalgebra::Vector2::new(f64::from(k % (2 * GRID + 1) - GRID), f64::from(k / (2 * GRID + 1) - GRID))
                * (pebble.radius / f64::from(GRID))
    };
    let shown: Vec<_> = (0..(2 * GRID + 1).pow(2)).map(place).filter(|p| shows(p.x, p.y)).collect();
    let middle = shown.iter().sum::<Vector2<f64>>() / shown.len().max(1) as f64;
    if shown.is_empty() || !shows(middle.x, middle.y) {
        return None;
    }
    let edge = |k: usize| {
        let (sine, cosine) = (TAU * k as f64 / OUTLINE as f64).sin_cos();
        let (mut inside, mut outside) = (0.0, 2.0 * pebble.radius);
        for _ in 0..12 {
            let reach = 0.5 * (inside + outside);
            if shows(middle.x + reach * cosine, middle.y + reach * sine) { inside = reach } else { outside = reach }
        }
        (middle.x + inside * cosine, middle.y + inside * sine)
    };
    Some((0..OUTLINE).map(edge).collect())
}
