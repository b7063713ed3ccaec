//! The layers along the track, to scale: each transition from below the rail down to the lowest layer.

use super::number::plain;
use super::svg::{Anchor, Frame, Svg, text_width};
use super::symbols::{draw_stones, draw_usp};
use super::view::{View, WIDTH, scale, seat_depth};
use crate::scenario::{ApproachSlab, Groundwork, Layer, Material, Scenario, Section};

const MARGIN: f64 = 26.0;
/// Half the length that is shown at each transition, m; more where stretches change the layers, but not beyond this.
const HALF: f64 = 6.0;
const FARTHEST: f64 = 30.0;
/// Layers below this depth under the sleepers are cut off, m.
const DEEPEST: f64 = 3.0;
/// Points of a boundary between two layers a metre of track.
const POINTS: f64 = 8.0;
/// Soils are coloured by Young's modulus, Pa: treated ground and concrete from here on, mats up to here.
const FIRM: f64 = 300e6;
const SOFT: f64 = 5e6;
const SLAB: f64 = 0.25;

/// Draws the layers at every transition; gives the height. Nothing if the scene has none.
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
    let (start, end) = shown(scenario, place);
    let view = View { start, end, scale: scale(end - start), rail: top + 40.0 };
    svg.text("strong", (6.0, top + 18.0), Anchor::Start, title);
    if track.seats.iter().any(|seat| seat.usp().is_some() && view.shows(seat.x)) {
        draw_usp(svg, Frame { x: WIDTH - MARGIN - 130.0, y: top + 12.0, width: 14.0, height: 4.0 });
        svg.text("small muted", (WIDTH - MARGIN, top + 18.0), Anchor::End, "under sleeper pad");
    }
    let inside = |section: &Section| section.end > start && section.start < end;
    let sections = || track.sections.iter().enumerate().filter(|(_, section)| inside(section));
    let deepest = sections().map(|(n, _)| base(scenario, n) + depth(scenario, n, start, end)).fold(0.0, f64::max);
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
    seat_depth(&scenario.track.sections[number]) + sleeper.map_or(SLAB, |sleeper| sleeper.height)
}

/// Range in which a transition is drawn, m: with the stretches near it that change the layers.
fn shown(scenario: &Scenario, place: f64) -> (f64, f64) {
    let track = &scenario.track;
    let near = |work: &&Groundwork| work.start < place + HALF && work.end > place - HALF;
    let works = || track.groundworks.iter().filter(near);
    let start = works().map(|work| work.start - 1.0).fold(place - HALF, f64::min);
    let end = works().map(|work| work.end + 1.0).fold(place + HALF, f64::max);
    (start.max(place - FARTHEST).max(track.start()), end.min(place + FARTHEST).min(track.end()))
}

/// Depth of a section's layers below the sleepers where it is drawn, m.
fn depth(scenario: &Scenario, number: usize, start: f64, end: f64) -> f64 {
    let parts = scenario.track.ground(number);
    let deepest = |part: &Groundwork| {
        let (from, to) = (part.start.max(start), part.end.min(end));
        let all = |x: f64| part.layers.iter().map(|layer| layer.thickness.value_at(x)).sum::<f64>();
        if from < to { all(from).max(all(0.5 * (from + to))).max(all(to)) } else { 0.0 }
    };
    parts.iter().map(deepest).fold(0.0, f64::max).min(DEEPEST)
}

fn draw_section(svg: &mut Svg, scenario: &Scenario, view: &View, number: usize, section: &Section) {
    let (start, end) = (section.start.max(view.start), section.end.min(view.end));
    let under = base(scenario, number);
    for part in scenario.track.ground(number) {
        draw_part(svg, view, &part, under);
    }
    if section.slab.is_some() {
        svg.rect("slab", view.area(start, end, under - SLAB, under));
    }
    for seat in scenario.track.seats.iter().filter(|s| s.section == number && s.x >= start - 0.3 && s.x <= end + 0.3) {
        if let Some(sleeper) = &seat.sleeper {
            let half = 0.5 * sleeper.base_width;
            svg.rect("sleeper", view.area(seat.x - half, seat.x + half, under - sleeper.height, under));
            if let Some(usp) = seat.usp() {
                draw_usp(svg, view.area(seat.x - half, seat.x + half, under, under + usp.thickness));
            }
        }
    }
    if let Some(rail) = &section.rail {
        svg.rect("steel", view.area(start, end, 0.0, rail.height));
    }
}

/// The layers of a part of a section, and the plate in them.
fn draw_part(svg: &mut Svg, view: &View, part: &Groundwork, under: f64) {
    let (start, end) = (part.start.max(view.start), part.end.min(view.end));
    if start >= end {
        return;
    }
    let steps = (POINTS * (end - start)).ceil().max(1.0);
    let places: Vec<f64> = (0..=steps as usize).map(|k| start + (end - start) * k as f64 / steps).collect();
    let mut upper: Vec<f64> = vec![under; places.len()];
    for layer in &part.layers {
        let lower: Vec<f64> = places
            .iter()
            .zip(&upper)
            .map(|(x, top)| (top + layer.thickness.value_at(*x)).min(under + DEEPEST))
            .collect();
        draw_layer(svg, view, layer, &places, (&upper, &lower));
        upper = lower;
    }
    if let Some(plate) = &part.approach_slab {
        draw_plate(svg, view, plate, under);
    }
}

fn draw_plate(svg: &mut Svg, view: &View, plate: &ApproachSlab, under: f64) {
    let [structure, far] = plate.ends;
    let (top, bottom) = (under + *plate.depth, under + *plate.depth + *plate.thickness);
    let area = view.area(structure.min(far), structure.max(far), top, bottom);
    let hinged = if plate.hinged { ", hinged" } else { "" };
    let text = format!(
        "approach slab: {} mm, {} GPa{hinged}",
        plain(1e3 * *plate.thickness, 4),
        plain(1e-9 * *plate.youngs_modulus, 3)
    );
    svg.titled_rect("slab", area, &text);
    if plate.hinged {
        let (x, y) = (view.x(structure), view.y(0.5 * (top + bottom)));
        let corner = |k: u32| (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
        let ring: Vec<(f64, f64)> = (0..8).map(corner).map(|(sin, cos)| (x + 4.0 * cos, y + 4.0 * sin)).collect();
        svg.path("ring", &ring, true, "hinge");
    }
    let y = area.y + if area.height > 12.0 { 0.5 * area.height + 4.0 } else { area.height + 12.0 };
    svg.text("small halo", (area.x + 0.5 * area.width, y), Anchor::Middle, &text);
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
    let mut text = format!("{}: {} mm", layer.name, range(&|x| 1e3 * layer.thickness.value_at(x), 4));
    if let Some(modulus) = layer.youngs_modulus() {
        text += &format!(", {} MPa", range(&|x| 1e-6 * modulus.value_at(x), 3));
    }
    text
}

/// Colour of a material.
pub(super) fn class(material: &Material) -> &'static str {
    match material {
        Material::Granular(granular) if granular.bond.is_some() => "bonded",
        Material::Granular(_) => "stones",
        Material::Soil(soil) if soil.youngs_modulus.largest() >= FIRM => "firm",
        Material::Soil(soil) if soil.youngs_modulus.largest() <= SOFT => "mat",
        Material::Soil(_) => "soil",
    }
}
