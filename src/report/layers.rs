//! The layers along the track, to scale: each transition from below the rail down to the lowest layer.

use super::number::plain;
use super::scene::{View, WIDTH};
use super::svg::{Anchor, Frame, Svg, text_width};
use super::symbols::draw_stones;
use crate::scenario::{Layer, Material, Scenario, Section};

const MARGIN: f64 = 26.0;
/// Half the length that is shown at each transition, m.
const HALF: f64 = 6.0;
/// Layers below this depth under the sleepers are cut off, m.
const DEEPEST: f64 = 3.0;
/// Points of a boundary between two layers a metre of track.
const POINTS: f64 = 8.0;
const PAD: f64 = 0.035;
const SLAB: f64 = 0.25;

/// Draws the layers at every transition; gives the height. Nothing where the scene has none.
pub(super) fn draw(svg: &mut Svg, scenario: &Scenario) -> f64 {
    let track = &scenario.track;
    if track.sections.iter().all(|section| section.layers.is_empty()) {
        return 0.0;
    }
    let mut places: Vec<(f64, String)> =
        track.transitions.iter().map(|t| (t.x, format!("The layers at transition {}", t.name))).collect();
    if let [(_, title)] = &mut places[..] {
        *title = "The layers at the transition".to_owned();
    }
    if places.is_empty() {
        places.push((0.5 * (track.start() + track.end()), "The layers".to_owned()));
    }
    let mut y = 0.0;
    for (index, (place, title)) in places.iter().take(4).enumerate() {
        y = draw_place(svg, scenario, (*place, title), index, y);
    }
    y
}

fn draw_place(svg: &mut Svg, scenario: &Scenario, (place, title): (f64, &str), index: usize, top: f64) -> f64 {
    let track = &scenario.track;
    let (start, end) = ((place - HALF).max(track.start()), (place + HALF).min(track.end()));
    let view = View { start, end, scale: ((WIDTH - 2.0 * MARGIN) / (end - start)).min(90.0), rail: top + 40.0 };
    svg.text("strong", (6.0, top + 18.0), Anchor::Start, title);
    let shown = |section: &Section| section.end > start && section.start < end;
    let sections = || track.sections.iter().enumerate().filter(|(_, section)| shown(section));
    let deepest = sections().map(|(n, s)| base(scenario, n) + depth(s, start, end)).fold(0.0, f64::max);
    let bottom = view.y(deepest) + 2.0;
    let frame =
        Frame { x: MARGIN, y: view.rail - 4.0, width: (end - start) * view.scale, height: bottom - view.rail + 4.0 };
    svg.clipped(&format!("layers-{index}"), frame, |svg| {
        for (number, section) in sections() {
            draw_section(svg, scenario, &view, number, section);
        }
    });
    svg.line("ground", (view.x(start), bottom), (view.x(end), bottom));
    if place > start && place < end && !track.transitions.is_empty() {
        svg.line("mark", (view.x(place), view.rail - 8.0), (view.x(place), bottom));
    }
    bottom + 24.0
}

/// Depth of the sleepers' base below the rail's top, m.
fn base(scenario: &Scenario, number: usize) -> f64 {
    let sleeper =
        scenario.track.seats.iter().filter(|seat| seat.section == number).find_map(|seat| seat.sleeper.as_ref());
    scenario.track.sections[number].rail.height + PAD + sleeper.map_or(SLAB, |sleeper| sleeper.height)
}

/// Depth of a section's layers below the sleepers where it is drawn, m.
fn depth(section: &Section, start: f64, end: f64) -> f64 {
    let (from, to) = (section.start.max(start), section.end.min(end));
    let all = |x: f64| section.layers.iter().map(|layer| layer.thickness.at(x)).sum::<f64>();
    all(from).max(all(0.5 * (from + to))).max(all(to)).min(DEEPEST)
}

fn draw_section(svg: &mut Svg, scenario: &Scenario, view: &View, number: usize, section: &Section) {
    let (start, end) = (section.start.max(view.start), section.end.min(view.end));
    let steps = (POINTS * (end - start)).ceil().max(1.0);
    let places: Vec<f64> = (0..=steps as usize).map(|k| start + (end - start) * k as f64 / steps).collect();
    let under = base(scenario, number);
    let mut upper: Vec<f64> = vec![under; places.len()];
    for layer in &section.layers {
        let lower: Vec<f64> =
            places.iter().zip(&upper).map(|(x, top)| (top + layer.thickness.at(*x)).min(under + DEEPEST)).collect();
        draw_layer(svg, view, layer, &places, (&upper, &lower));
        upper = lower;
    }
    if section.slab.is_some() {
        svg.rect("slab", view.area(start, end, under - SLAB, under));
    }
    for seat in scenario.track.seats.iter().filter(|s| s.section == number && s.x >= start - 0.3 && s.x <= end + 0.3) {
        if let Some(sleeper) = &seat.sleeper {
            let half = 0.5 * sleeper.base_width;
            svg.rect("sleeper", view.area(seat.x - half, seat.x + half, under - sleeper.height, under));
        }
    }
    svg.rect("steel", view.area(start, end, 0.0, section.rail.height));
}

/// One layer between its upper and its lower boundary, named where it is thick enough.
fn draw_layer(svg: &mut Svg, view: &View, layer: &Layer, places: &[f64], (upper, lower): (&[f64], &[f64])) {
    let edge = |depths: &[f64]| -> Vec<(f64, f64)> {
        places.iter().zip(depths).map(|(x, d)| (view.x(*x), view.y(*d))).collect()
    };
    let mut outline = edge(upper);
    outline.extend(edge(lower).into_iter().rev());
    svg.path(class(&layer.material), &outline, true, &layer.name);
    let level = |depths: &[f64]| depths.iter().all(|d| (d - depths[0]).abs() < 1e-9);
    if layer.granular().is_some() && level(upper) && level(lower) {
        let (left, right) = (places[0], places[places.len() - 1]);
        draw_stones(svg, view.area(left, right, upper[0], lower[0]), view.scale);
    }
    svg.path("ground", &edge(lower), false, "");
    let middle = places.len() / 2;
    let thickness = lower[middle] - upper[middle];
    let text = label(layer, places);
    let room = (places[places.len() - 1] - places[0]) * view.scale;
    if thickness * view.scale > 12.0 && text_width(&text) < room {
        let at = (view.x(places[middle]), view.y(0.5 * (upper[middle] + lower[middle])) + 4.0);
        svg.text("small halo", at, Anchor::Middle, &text);
    }
}

/// `ballast: 300 mm`, `treated: 100 to 800 mm, 150 to 900 MPa`
fn label(layer: &Layer, places: &[f64]) -> String {
    let range = |of: &dyn Fn(f64) -> f64, digits: usize| {
        let (first, last) = (of(places[0]), of(places[places.len() - 1]));
        let show = |value: f64| plain(value, digits);
        if (first - last).abs() < 1e-6 * first.abs() {
            show(first)
        } else {
            format!("{} to {}", show(first), show(last))
        }
    };
    let mut text = format!("{}: {} mm", layer.name, range(&|x| 1e3 * layer.thickness.at(x), 4));
    if let Some(soil) = layer.soil() {
        text += &format!(", {} MPa", range(&|x| 1e-6 * soil.youngs_modulus.at(x), 3));
    }
    text
}

/// How a material is coloured.
pub(super) fn class(material: &Material) -> &'static str {
    match material {
        Material::Granular(granular) if granular.bond.is_some() => "bonded",
        Material::Granular(_) => "stones",
        Material::Soil(_) => "soil",
    }
}
