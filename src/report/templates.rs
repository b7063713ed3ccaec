//! Templates of grains: surfaces beside their clumps.

use super::grain::{Look, draw_pebbles, draw_surface};
use super::number::plain;
use super::svg::{Anchor, Svg};
use super::view::WIDTH;
use crate::scenario::{Granular, Scenario, Surfaces};
use crate::solvers::granular::clump::Pebble;
use crate::solvers::granular::grains::{self, ClumpShape, Fitted, GrainForm, Misfit};

/// Templates of a material that are shown.
const SHOWN: usize = 6;
/// Room of a grain, px, and how large the ball of its volume is in it.
const CELL: f64 = 140.0;
const SIZE: f64 = 82.0;

/// Draws the templates of every granular layer with clumps; gives the height.
pub(super) fn draw(svg: &mut Svg, scenario: &Scenario) -> f64 {
    let mut found: Vec<(&str, &Granular, ClumpShape)> = Vec::new();
    for layer in scenario.track.sections.iter().flat_map(|section| &section.layers) {
        let Some(granular) = layer.granular() else { continue };
        let known = found.iter().any(|(name, other, _)| *name == layer.name && other.shape == granular.shape);
        if let Some(shape) = granular.shape.clumps().filter(|_| !known) {
            found.push((&layer.name, granular, shape));
        }
    }
    let mut y = 0.0;
    for (number, (name, granular, shape)) in found.into_iter().enumerate() {
        let named = match &granular.shape {
            crate::scenario::Shape::Clumps { surfaces: Surfaces::Meshes(surfaces), .. } => {
                surfaces.iter().map(|surface| surface.name.as_str()).collect()
            }
            _ => Vec::new(),
        };
        y = draw_material(svg, (number, name), shape, &named, scenario.solve.seed, y);
    }
    y
}

fn draw_material(
    svg: &mut Svg,
    (number, name): (usize, &str),
    mut shape: ClumpShape,
    named: &[&str],
    seed: u64,
    top: f64,
) -> f64 {
    let all = match &mut shape.surfaces {
        grains::Surfaces::Angular { count, .. } => std::mem::replace(count, SHOWN.min(*count)),
        grains::Surfaces::Meshes(meshes) => {
            let all = meshes.len();
            meshes.truncate(SHOWN);
            all
        }
    };
    let shown = if all > SHOWN { format!(", the first {SHOWN} of {all}") } else { String::new() };
    svg.text(
        "strong",
        (6.0, top + 18.0),
        Anchor::Start,
        &format!("Grains of {name}: surfaces and their clumps{shown}"),
    );
    let note = "elsewhere: share of the clump's volume outside the surface; the same volume is missing inside";
    svg.text("small muted", (6.0, top + 34.0), Anchor::Start, note);
    let top = top + 12.0;
    let fitted = match shape.fitted(seed) {
        Ok(fitted) => fitted,
        Err(error) => {
            svg.text("small muted", (6.0, top + 40.0), Anchor::Start, &error.to_string());
            return top + 56.0;
        }
    };
    for (k, fitted) in fitted.iter().enumerate() {
        let x = (k as f64 + 0.5) * WIDTH / SHOWN as f64;
        let form = GrainForm::of_surface(&fitted.surface);
        let look = Look::along([form.axes[2], form.axes[1], form.axes[0]], SIZE);
        draw_both(
            svg,
            &format!("grain-{number}-{k}"),
            fitted,
            &look,
            [(x, top + 24.0 + 0.5 * CELL), (x, top + 24.0 + 1.4 * CELL)],
        );
        let error = Misfit::between(&fitted.surface, &fitted.template);
        let lines = [
            named.get(k).map_or(String::new(), |name| (*name).to_string()),
            format!("S/I {}, I/L {}", plain(form.flatness(), 2), plain(form.elongation(), 2)),
            format!("{} pebbles", fitted.template.pebbles.len()),
            format!("{} % elsewhere", plain(50.0 * error.volume, 2)),
        ];
        let mut y = top + 24.0 + 1.98 * CELL;
        for line in lines.iter().filter(|line| !line.is_empty()) {
            svg.text("small muted", (x, y), Anchor::Middle, line);
            y += 15.0;
        }
    }
    top + 24.0 + 2.0 * CELL + 64.0
}

fn draw_both(svg: &mut Svg, id: &str, fitted: &Fitted, look: &Look, [surface, clump]: [(f64, f64); 2]) {
    let solid = fitted.surface.volume();
    // the surface in the size of its grains
    let scale = look.scale * (std::f64::consts::PI / 6.0 / solid).cbrt();
    draw_surface(svg, &fitted.surface, &look.scaled(scale), surface);
    draw_pebbles(svg, id, &placed(fitted), look, clump);
}

/// Pebbles of a template in the frame of its surface, about the centroid.
fn placed(fitted: &Fitted) -> Vec<Pebble> {
    let template = &fitted.template;
    template.pebbles.iter().map(|p| Pebble { centre: template.axes * p.centre, ..*p }).collect()
}

/// Surfaces beside their clumps of ever more pebbles: a row a surface, a column a number of pebbles. Rows are as long
/// as the counts.
pub fn grain_templates_svg(counts: &[usize], rows: &[Vec<Fitted>]) -> String {
    let mut svg = Svg::default();
    let column = (WIDTH - 10.0) / (counts.len() + 1) as f64;
    let (row, head) = (132.0, 44.0);
    svg.text("strong", (6.0, 18.0), Anchor::Start, "Angular grains and their clumps of equal volume");
    let heading = |svg: &mut Svg, k: usize, text: &str| {
        svg.text("small muted", (5.0 + (k as f64 + 0.5) * column, 38.0), Anchor::Middle, text);
    };
    heading(&mut svg, 0, "surface");
    for (k, count) in counts.iter().enumerate() {
        heading(&mut svg, k + 1, &if *count == 1 { "1 pebble".into() } else { format!("{count} pebbles") });
    }
    for (number, fitted) in rows.iter().enumerate() {
        let Some(first) = fitted.first() else { continue };
        let form = GrainForm::of_surface(&first.surface);
        let look = Look::along([form.axes[2], form.axes[1], form.axes[0]], 0.64 * column);
        let y = head + (number as f64 + 0.47) * row;
        let place = |k: usize| (5.0 + (k as f64 + 0.5) * column, y);
        draw_surface(&mut svg, &first.surface, &look, place(0));
        for (k, fitted) in fitted.iter().enumerate() {
            draw_pebbles(&mut svg, &format!("grain-{number}-{k}"), &placed(fitted), &look, place(k + 1));
            let error = Misfit::between(&fitted.surface, &fitted.template);
            let text = format!("{} % elsewhere", plain(50.0 * error.volume, 2));
            svg.text("small muted", (place(k + 1).0, y + 0.5 * row), Anchor::Middle, &text);
        }
    }
    svg.finish(WIDTH, head + rows.len() as f64 * row + 16.0, "Grains and their clumps")
}
