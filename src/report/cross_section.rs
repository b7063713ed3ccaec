//! Sections across the track, to scale: rails, sleeper, layers and side walls, with their dimensions.

use super::layers::class;
use super::number::plain;
use super::svg::{Anchor, Frame, Svg};
use super::symbols::{draw_dimension, draw_stones, draw_usp};
use super::view::{WIDTH, height_beside, seat_depth};
use crate::scenario::{Groundwork, Material, Scenario, Seat, Section, SleeperBody, Usp};

/// Sections side by side, at most.
const COLUMNS: usize = 3;
const MARGIN: f64 = 26.0;
/// Room beside a bed for the names of its layers, px.
const NAMES: f64 = 92.0;
/// Largest depth of a layer that is shown, m.
const DEEPEST: f64 = 1.5;
const RAIL_WIDTH: f64 = 0.15;

/// Where a section is drawn: the centre line and the rail's top, px, and px a metre.
struct Place {
    centre: f64,
    top: f64,
    scale: f64,
}

impl Place {
    /// A box of the world, m: left and right of the centre line, top and bottom below the rail's top.
    fn area(&self, left: f64, right: f64, top: f64, bottom: f64) -> Frame {
        Frame {
            x: self.centre + left * self.scale,
            y: self.top + top * self.scale,
            width: (right - left) * self.scale,
            height: (bottom - top) * self.scale,
        }
    }
}

/// A cut: a section, its sleeper, and its ground at a chainage.
struct Cut<'a> {
    section: &'a Section,
    sleeper: &'a SleeperBody,
    usp: Option<&'a Usp>,
    ground: Groundwork,
    /// Whether a stretch changed the ground.
    changed: bool,
    x: f64,
}

/// One cut for each kind of sleeper on each kind of ground; where the ground varies, as near to a transition as
/// sleepers lie.
fn cuts(scenario: &Scenario) -> Vec<Cut<'_>> {
    let track = &scenario.track;
    let grounds: Vec<Vec<Groundwork>> = (0..track.sections.len()).map(|section| track.ground(section)).collect();
    let distance = |x: f64| track.transitions.iter().map(|t| (t.x - x).abs()).fold(f64::INFINITY, f64::min);
    let ground = |seat: &Seat| grounds[seat.section].iter().find(|g| seat.x <= g.end).or(grounds[seat.section].last());
    let mut cuts: Vec<Cut<'_>> = Vec::new();
    for seat in &track.seats {
        let (section, Some(sleeper), Some(ground)) = (&track.sections[seat.section], &seat.sleeper, ground(seat))
        else {
            continue;
        };
        let same = |cut: &&mut Cut<'_>| {
            cut.ground.layers == ground.layers
                && cut.ground.approach_slab.is_some() == ground.approach_slab.is_some()
                && cut.sleeper == sleeper
                && cut.usp.is_some() == seat.usp().is_some()
        };
        match cuts.iter_mut().find(same) {
            Some(cut) if distance(seat.x) < distance(cut.x) => cut.x = seat.x,
            Some(_) => {}
            None => {
                let changed = track.groundworks.iter().any(|work| (work.start, work.end) == (ground.start, ground.end));
                let changed = changed || track.stretches.iter().any(|s| s.start <= seat.x && seat.x <= s.end);
                cuts.push(Cut { section, sleeper, usp: seat.usp(), ground: ground.clone(), changed, x: seat.x });
            }
        }
    }
    cuts
}

/// Draws each kind of section that has sleepers; gives the height.
pub(super) fn draw(svg: &mut Svg, scenario: &Scenario) -> f64 {
    let cuts = cuts(scenario);
    if cuts.is_empty() {
        return 0.0;
    }
    svg.text("strong", (6.0, 18.0), Anchor::Start, "Across the track, to scale");
    let columns = cuts.len().min(COLUMNS) as f64;
    let room = (WIDTH - 2.0 * MARGIN) / columns;
    let widest = cuts.iter().map(|cut| 2.0 * half_width(scenario, cut.sleeper)).fold(0.0, f64::max);
    let scale = ((room - NAMES - 20.0) / widest).min(110.0);
    let mut bottom: f64 = 0.0;
    for (index, cut) in cuts.iter().take(COLUMNS).enumerate() {
        let centre = MARGIN + room * index as f64 + 0.5 * (room - NAMES);
        bottom = bottom.max(draw_section(svg, scenario, cut, &Place { centre, top: 70.0, scale }));
    }
    bottom + 20.0
}

/// Half the width of the bed, m.
fn half_width(scenario: &Scenario, sleeper: &SleeperBody) -> f64 {
    let least = 0.5 * sleeper.length;
    scenario.track.bed.half_width.map_or(least, |half| *half).max(least)
}

fn draw_section(svg: &mut Svg, scenario: &Scenario, cut: &Cut<'_>, place: &Place) -> f64 {
    let (section, sleeper, layers) = (cut.section, cut.sleeper, &cut.ground.layers);
    let (half, length, height) = (half_width(scenario, sleeper), sleeper.length, sleeper.height);
    let gauge = sleeper.seat_distance;
    let name = if cut.changed { format!("{} at {} m", section.name, plain(cut.x, 3)) } else { section.name.clone() };
    svg.text("small halo", (place.centre, place.top - 34.0), Anchor::Middle, &name);
    let foot = seat_depth(section);
    let mut depth = foot + height;
    if let Some(first) = layers.first() {
        draw_beside(svg, scenario, cut, place, (&first.material, depth));
    }
    let mut named = f64::NEG_INFINITY;
    for layer in layers {
        let thickness = layer.thickness.value_at(cut.x);
        if thickness < 1e-3 {
            continue;
        }
        let below = depth + thickness.min(DEEPEST);
        let area = place.area(-half, half, depth, below);
        svg.titled_rect(class(&layer.material), area, &layer.name);
        if layer.granular().is_some() {
            draw_stones(svg, area, place.scale);
        }
        svg.line("ground", (area.x, area.y + area.height), (area.x + area.width, area.y + area.height));
        // names of thin layers make room for each other
        let (x, y) = (area.x + area.width + 8.0, (area.y + 0.5 * area.height).max(named + 28.0));
        named = y;
        let cut = if thickness > DEEPEST { ", cut off" } else { "" };
        svg.text("small", (x, y), Anchor::Start, &layer.name);
        svg.text("small muted", (x, y + 13.0), Anchor::Start, &format!("{} mm{cut}", plain(1e3 * thickness, 4)));
        depth = below;
    }
    if let Some(plate) = &cut.ground.approach_slab {
        let top = foot + height + *plate.depth;
        let area = place.area(-half, half, top, (top + *plate.thickness).min(depth));
        svg.titled_rect("slab", area, "approach slab");
        svg.text("small halo", (place.centre, area.y + 0.5 * area.height + 4.0), Anchor::Middle, "approach slab");
    }
    svg.rect("sleeper", place.area(-0.5 * length, 0.5 * length, foot, foot + height));
    if let Some(usp) = cut.usp {
        draw_usp(svg, place.area(-0.5 * length, 0.5 * length, foot + height, foot + height + usp.thickness));
        let text = format!("under sleeper pad {} mm", plain(1e3 * usp.thickness, 3));
        svg.text("small halo", (place.centre, place.top + (foot + height) * place.scale + 15.0), Anchor::Middle, &text);
    }
    if let Some(rail) = &section.rail {
        [-0.5, 0.5].iter().for_each(|side| draw_rail(svg, place, side * gauge, [rail.height, foot]));
    }
    let wall = place.area(-half, half, foot, depth);
    if !layers.is_empty() {
        for x in [wall.x, wall.x + wall.width] {
            svg.line("wall", (x, wall.y), (x, wall.y + wall.height));
        }
    }
    if section.rail.is_some() {
        draw_widths(svg, place, &[(gauge, place.top - 12.0)]);
    }
    let bottom = place.top + depth * place.scale;
    draw_widths(svg, place, &[(length, bottom + 24.0)]);
    if 2.0 * half <= length + 1e-6 {
        return bottom + 32.0;
    }
    draw_widths(svg, place, &[(2.0 * half, bottom + 50.0)]);
    bottom + 58.0
}

/// Crib and shoulder beside the sleeper, down to its underside, m.
fn draw_beside(svg: &mut Svg, scenario: &Scenario, cut: &Cut<'_>, place: &Place, (ballast, foot): (&Material, f64)) {
    let (half, height) = (half_width(scenario, cut.sleeper), cut.sleeper.height);
    let beside = height_beside(scenario, cut.section, height);
    let Some(crib) = &cut.section.crib else {
        if beside > 0.0 {
            svg.rect(class(ballast), place.area(-half, half, foot - beside, foot));
        }
        return;
    };
    let reach = half.min(0.5 * cut.sleeper.length + crib.beyond());
    let area = place.area(-reach, reach, foot - beside, foot);
    svg.titled_rect(class(ballast), area, "crib");
    draw_stones(svg, area, place.scale);
    let x = place.centre + half * place.scale + 8.0;
    svg.text("small", (x, area.y + 2.0), Anchor::Start, &format!("crib {} mm", plain(1e3 * *crib.height, 3)));
    if crib.beyond() > 0.0 {
        let text = format!("shoulder {} m", plain(crib.beyond(), 3));
        svg.text("small", (x, area.y - 11.0), Anchor::Start, &text);
    }
}

/// A rail of that height on its pad, which ends at the seat, m.
fn draw_rail(svg: &mut Svg, place: &Place, x: f64, [height, seat]: [f64; 2]) {
    svg.rect("pad", place.area(x - 0.5 * RAIL_WIDTH, x + 0.5 * RAIL_WIDTH, height, seat));
    svg.rect("steel", place.area(x - 0.5 * RAIL_WIDTH, x + 0.5 * RAIL_WIDTH, height - 0.02, height));
    svg.rect("steel", place.area(x - 0.012, x + 0.012, 0.04, height));
    svg.rect("steel", place.area(x - 0.036, x + 0.036, 0.0, 0.045));
}

/// Dimension lines of widths \[m\] about the centre line, with their texts.
fn draw_widths(svg: &mut Svg, place: &Place, widths: &[(f64, f64)]) {
    for (width, y) in widths {
        let (a, b) = (place.centre - 0.5 * width * place.scale, place.centre + 0.5 * width * place.scale);
        draw_dimension(svg, a, b, *y);
        svg.text("small halo", (place.centre, y - 5.0), Anchor::Middle, &format!("{} m", plain(*width, 3)));
    }
}
