//! The scene to scale: the whole track with its vehicle at the start, and each transition close up.
//!
//! Lengths that the scene states (places, spacings, sleepers, rail, wheels, bogies) are true, and equal in both
//! directions. The depth of ballast and slab, the car body's height and the springs are symbols.

use super::number::{plain, tick_label, ticks, whole};
use super::svg::{Anchor, Frame, Svg, text_width};
use super::symbols::{draw_dimension, draw_spring, draw_stones, draw_usp};
use super::vehicle;
use super::view::{MARGIN, View, WIDTH, height_beside, scale, seat_depth};
use crate::graph::SupportNode;
use crate::lower::supports;
use crate::scenario::{Foot, Force, Loading, RigLoad, Scenario, Seat, Section, StaticLoad, Tamping, Target};

/// Half the length of a close-up, m.
const CLOSE: f64 = 6.0;
/// Depth of the drawn bed under the sleepers' base, m.
const BED: f64 = 0.40;
const SLAB: f64 = 0.25;
/// Width of small letters over that of common ones.
const SMALL: f64 = 0.85;

/// Draws the scene as one picture, valid on its own.
pub fn scene_svg(scenario: &Scenario) -> String {
    let mut svg = Svg::default();
    let bottom = draw_scene(&mut svg, scenario);
    svg.finish(WIDTH, bottom, &format!("{}: the scene to scale", scenario.title))
}

/// Draws the track as a whole and each transition close up; gives the height.
pub(super) fn draw_scene(svg: &mut Svg, scenario: &Scenario) -> f64 {
    let track = &scenario.track;
    let mut bottom = draw_whole(svg, scenario);
    let length = track.end() - track.start();
    if length > 3.0 * CLOSE {
        let supports = supports(scenario);
        let places: Vec<f64> = match &scenario.loading {
            Some(Loading::Static(loads)) if track.transitions.is_empty() => loads.iter().map(|load| load.x).collect(),
            Some(Loading::Rig(loads)) if track.transitions.is_empty() => loads.iter().map(|load| load.x).collect(),
            _ => track.transitions.iter().map(|transition| transition.x).collect(),
        };
        for (index, place) in places.iter().take(4).enumerate() {
            bottom = draw_close(svg, scenario, &supports, *place, index, bottom);
        }
    }
    bottom
}

fn draw_whole(svg: &mut Svg, scenario: &Scenario) -> f64 {
    let track = &scenario.track;
    let length = (track.end() - track.start()).max(1e-3);
    let scale = scale(length);
    let head = if matches!(scenario.loading, Some(Loading::Static(_) | Loading::Rig(_))) {
        76.0
    } else {
        48.0 + 3.9 * scale.min(30.0)
    };
    let view = View { start: track.start(), end: track.end(), scale, rail: head };
    svg.text("strong", (6.0, 16.0), Anchor::Start, "The track to scale");
    let place = Frame { x: MARGIN - 8.0, y: 0.0, width: length * scale + 16.0, height: 1000.0 };
    svg.clipped("scene-whole", place, |svg| {
        draw_track(svg, scenario, &view);
        if let Some(Loading::Traffic(traffic)) = &scenario.loading {
            vehicle::draw_train(svg, scenario, traffic, &view);
        }
    });
    let mut bottom = draw_loads(svg, scenario, &view);
    if track.sections.first().is_some_and(|section| scale * *section.spacing > 26.0) {
        bottom = draw_numbers(svg, scenario, &view, bottom);
    }
    for transition in &track.transitions {
        let x = view.x(transition.x);
        svg.line("mark", (x, 44.0), (x, bottom + 6.0));
        let name = if transition.name.is_empty() { "transition" } else { &transition.name };
        svg.text("small halo", (x, 38.0), Anchor::Middle, name);
    }
    let bottom = draw_stretches(svg, scenario, &view, bottom + 12.0);
    let bottom = draw_spans(svg, scenario, &view, bottom);
    draw_chainage(svg, &view, bottom)
}

fn draw_close(svg: &mut Svg, scenario: &Scenario, supports: &[SupportNode], place: f64, index: usize, top: f64) -> f64 {
    let track = &scenario.track;
    let (start, end) = ((place - CLOSE).max(track.start()), (place + CLOSE).min(track.end()));
    let scale = (WIDTH - 2.0 * MARGIN) / (end - start);
    let view = View { start, end, scale, rail: top + 92.0 };
    let name = track.transitions.get(index).map_or("", |t| t.name.as_str());
    let title = match (track.transitions.is_empty(), name) {
        (true, _) => "Around the load".to_owned(),
        (_, "") => format!("The transition, \u{b1}{} m", plain(CLOSE, 2)),
        (_, name) => format!("Transition {name}, \u{b1}{} m", plain(CLOSE, 2)),
    };
    svg.text("strong", (6.0, top + 18.0), Anchor::Start, &title);
    draw_key(svg, scenario, top + 18.0);
    let clip = Frame { x: MARGIN, y: top + 26.0, width: WIDTH - 2.0 * MARGIN, height: 400.0 };
    svg.clipped(&format!("scene-close-{index}"), clip, |svg| draw_track(svg, scenario, &view));
    let bottom = draw_loads(svg, scenario, &view);
    draw_spacings(svg, scenario, supports, &view);
    let bottom = draw_numbers(svg, scenario, &view, bottom);
    if let Some(transition) = track.transitions.get(index) {
        let x = view.x(transition.x);
        svg.line("mark", (x, view.rail - 44.0), (x, view.y(ground(scenario))));
    }
    draw_chainage(svg, &view, bottom + 4.0)
}

/// Meaning of the colours of a close-up.
fn draw_key(svg: &mut Svg, scenario: &Scenario, y: f64) {
    let mut x = WIDTH - MARGIN;
    let under_sleepers = has_usps(scenario).then_some(("usp", "under sleeper pad"));
    let entries =
        [("slab", "slab"), ("stones", "ballast"), ("spring", "support"), ("sleeper", "sleeper"), ("pad", "rail pad")];
    for (class, name) in under_sleepers.into_iter().chain(entries) {
        x -= text_width(name) + 30.0;
        match class {
            "spring" => draw_spring(svg, (x + 7.0, y - 11.0), y + 2.0, 4.0),
            _ => svg.rect(class, Frame { x, y: y - 9.0, width: 14.0, height: 9.0 }),
        }
        svg.text("small muted", (x + 19.0, y), Anchor::Start, name);
    }
}

/// Whether pads lie under sleepers anywhere.
pub(super) fn has_usps(scenario: &Scenario) -> bool {
    scenario.track.seats.iter().any(|seat| seat.usp().is_some())
}

/// Width and height of a seat's sleeper.
fn sleeper_size(seat: &Seat) -> (f64, f64) {
    seat.sleeper.map_or((0.26, 0.2), |sleeper| (sleeper.base_width, sleeper.height))
}

/// Depth of the ground below the rail's top, m: one level for the whole track.
fn ground(scenario: &Scenario) -> f64 {
    let track = &scenario.track;
    let depth = |seat: &Seat| seat_depth(&track.sections[seat.section]) + sleeper_size(seat).1.max(SLAB) + BED;
    track.seats.iter().map(depth).fold(0.0, f64::max)
}

fn draw_track(svg: &mut Svg, scenario: &Scenario, view: &View) {
    let ground = ground(scenario);
    for (index, section) in scenario.track.sections.iter().enumerate() {
        if section.end <= view.start || section.start >= view.end {
            continue;
        }
        let base = seat_depth(section);
        let seats: Vec<&Seat> = scenario.track.seats.iter().filter(|s| s.section == index && view.shows(s.x)).collect();
        if let Some(seat) = seats.iter().find(|seat| seat.is_ballasted()) {
            let (_, height) = sleeper_size(seat);
            let beside = height_beside(scenario, section, height);
            let area = view.area(section.start, section.end, base + height - beside, ground);
            svg.rect("stones", area);
            draw_stones(svg, area, view.scale);
        }
        if section.slab.is_some() {
            svg.rect("slab", view.area(section.start, section.end, base, base + SLAB));
        }
        for seat in &seats {
            draw_seat(svg, view, section, seat, ground);
        }
        if let Some(rail) = &section.rail {
            svg.rect("steel", view.area(section.start, section.end, 0.0, rail.height.max(2.0 / view.scale)));
        }
    }
    let y = view.y(ground);
    svg.line("ground", (view.x(view.start), y), (view.x(view.end), y));
    let step = if view.scale > 30.0 { 14.0 } else { 9.0 };
    let mut x = view.x(view.start);
    while x < view.x(view.end) {
        svg.line("ground", (x, y + 5.0), (x + 5.0, y));
        x += step;
    }
}

fn draw_seat(svg: &mut Svg, view: &View, section: &Section, seat: &Seat, ground: f64) {
    let base = seat_depth(section);
    let (width, height) = sleeper_size(seat);
    let close = view.scale > 30.0;
    if let Some(rail) = section.rail.as_ref().filter(|_| close) {
        svg.rect("pad", view.area(seat.x - 0.08, seat.x + 0.08, rail.height, base));
    }
    let x = view.x(seat.x);
    match &seat.foot {
        Foot::Sleeper { .. } | Foot::Rigid => {
            svg.rect("sleeper", view.area(seat.x - width / 2.0, seat.x + width / 2.0, base, base + height));
            let under = base + height;
            if let Some(usp) = seat.usp().filter(|_| close) {
                let area = view.area(seat.x - width / 2.0, seat.x + width / 2.0, under, under + usp.thickness);
                draw_usp(svg, area);
            }
            if matches!(seat.foot, Foot::Rigid) {
                let area = view.area(seat.x - width / 2.0, seat.x + width / 2.0, under, ground);
                svg.rect("slab", area);
            } else if close {
                draw_spring(svg, (x, view.y(under)), view.y(ground), 0.09 * view.scale);
            }
        }
        Foot::Slab if close => draw_spring(svg, (x, view.y(base + SLAB)), view.y(ground), 0.07 * view.scale),
        Foot::Slab => {}
    }
}

/// Arrows of a static check; gives the lower edge of the track.
fn draw_loads(svg: &mut Svg, scenario: &Scenario, view: &View) -> f64 {
    let loads: Vec<(f64, String)> = match &scenario.loading {
        Some(Loading::Static(loads)) => {
            let text = |load: &StaticLoad| format!("{}: {} kN {}", load.name, plain(*load.force / 1e3, 4), on(load.on));
            loads.iter().map(|load| (load.x, text(load))).collect()
        }
        Some(Loading::Rig(loads)) => {
            loads.iter().map(|load| (load.x, format!("{}: {}", load.name, force(load)))).collect()
        }
        _ => Vec::new(),
    };
    for (x, text) in loads.iter().filter(|(x, _)| view.shows(*x)) {
        draw_load(svg, view, *x, text);
    }
    view.y(ground(scenario)) + 6.0
}

fn on(target: Target) -> &'static str {
    if target == Target::Sleepers { "per seat" } else { "per rail" }
}

/// `2.5 to 30 kN per seat, 5 Hz, 10000 times`
pub(super) fn force(load: &RigLoad) -> String {
    let kilonewtons = |force: f64| plain(force / 1e3, 4);
    let mut text = match &load.force {
        Force::History(history) => {
            let most = history.iter().map(|[_, force]| *force).fold(0.0, f64::max);
            format!("up to {} kN {}, as in its file", kilonewtons(most), on(load.on))
        }
        Force::Constant(force) => format!("{} kN {}", kilonewtons(**force), on(load.on)),
        Force::Strain(strain) => format!("{} % shorter", plain(100.0 * **strain, 3)),
        Force::Cyclic { range: [least, most], frequency, .. } => {
            let (least, most, frequency) = (kilonewtons(**least), kilonewtons(**most), plain(**frequency, 3));
            format!("{least} to {most} kN {}, {frequency} Hz, {} times", on(load.on), whole(load.cycles))
        }
    };
    if let Some(pressure) = load.confinement {
        text += &format!(", {} kPa on all sides", plain(*pressure / 1e3, 4));
    }
    if *load.speed > 0.0 {
        text += &format!(", {} m/s", plain(*load.speed, 3));
    }
    text
}

fn draw_load(svg: &mut Svg, view: &View, x: f64, text: &str) {
    let (x, tip) = (view.x(x), view.rail - 1.0);
    svg.path("push", &[(x, tip - 34.0), (x, tip)], false, "");
    svg.path("push", &[(x - 5.0, tip - 9.0), (x, tip), (x + 5.0, tip - 9.0)], false, "");
    svg.text("halo", (x + 9.0, tip - 22.0), Anchor::Start, text);
}

fn draw_numbers(svg: &mut Svg, scenario: &Scenario, view: &View, bottom: f64) -> f64 {
    let seats: Vec<&Seat> = scenario.track.seats.iter().filter(|seat| view.shows(seat.x)).collect();
    let gap = seats.windows(2).map(|pair| view.x(pair[1].x) - view.x(pair[0].x)).fold(f64::INFINITY, f64::min);
    let every = (24.0 / gap).ceil().max(1.0) as i32;
    for seat in seats.iter().filter(|seat| seat.number % every == 0 || seat.number.abs() == 1) {
        svg.text("small", (view.x(seat.x), bottom + 14.0), Anchor::Middle, &signed(seat.number));
    }
    bottom + 18.0
}

fn signed(number: i32) -> String {
    if number < 0 { format!("\u{2212}{}", number.abs()) } else { format!("+{number}") }
}

/// The spacing of each section in a close-up, above the rail, with the supports of its seats.
fn draw_spacings(svg: &mut Svg, scenario: &Scenario, supports: &[SupportNode], view: &View) {
    for (index, section) in scenario.track.sections.iter().enumerate() {
        let standing = scenario.track.seats.iter().zip(supports);
        let (seats, supports): (Vec<&Seat>, Vec<&SupportNode>) =
            standing.filter(|(seat, _)| seat.section == index && view.shows(seat.x)).unzip();
        let middle = seats.len() / 2;
        let (Some(from), Some(to)) = (seats.get(middle.wrapping_sub(1)), seats.get(middle)) else { continue };
        let (a, b, y) = (view.x(from.x), view.x(to.x), view.rail - 12.0);
        draw_dimension(svg, a, b, y);
        let text = format!("{} m", plain(to.x - from.x, 3));
        svg.text("small halo", ((a + b) / 2.0, y - 6.0), Anchor::Middle, &text);
        let (left, right) = (view.x(section.start.max(view.start)), view.x(section.end.min(view.end)));
        // one line, or two where the section is short
        let parts = carried(section, &seats, &supports);
        let whole = parts.join(", ");
        let lines = if SMALL * text_width(&whole) < right - left { vec![whole] } else { parts };
        for (line, text) in lines.iter().rev().enumerate() {
            let y = view.rail - 34.0 - 14.0 * line as f64;
            svg.text("small muted halo", ((left + right) / 2.0, y), Anchor::Middle, text);
        }
    }
}

/// `ballasted: pads 40 MN/m` and `support 60 MN/m per seat`
fn carried(section: &Section, seats: &[&Seat], supports: &[&SupportNode]) -> Vec<String> {
    let range = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        let show = |value: f64| plain(value / 1e6, 3);
        if high - low < 1e-3 * high { show(high) } else { format!("{} to {}", show(low), show(high)) }
    };
    let pads: Vec<f64> = seats.iter().filter_map(|seat| Some(*seat.pad.as_ref()?.stiffness)).collect();
    let supports: Vec<f64> = supports.iter().filter_map(|node| Some(node.spring?.stiffness)).collect();
    let mut parts = Vec::new();
    if !pads.is_empty() {
        parts.push(format!("pads {} MN/m", range(pads)));
    }
    if !supports.is_empty() {
        let series = if seats.iter().any(|seat| seat.usp().is_some()) { " with its under sleeper pad" } else { "" };
        parts.push(format!("support{series} {} MN/m per seat", range(supports)));
    } else if let Some(slab) = &section.slab {
        parts.push(format!("foundation {} MN/m per m", plain(*slab.foundation_stiffness / 1e6, 3)));
    }
    match parts.first_mut() {
        Some(first) => *first = format!("{}: {first}", section.name),
        None => parts.push(section.name.clone()),
    }
    parts
}

/// Name, length and content of each stretch and tamping, one below the other if they overlap.
fn draw_stretches(svg: &mut Svg, scenario: &Scenario, view: &View, y: f64) -> f64 {
    let mut rows: Vec<f64> = Vec::new(); // right ends
    let stretches = scenario.track.stretches.iter().map(|s| (s.name.as_str(), s.start, s.end, s.changes.to_string()));
    for (name, start, end, changes) in stretches.chain(scenario.tampings.iter().flat_map(|t| tamped(scenario, t))) {
        let (a, b) = (view.x(start), view.x(end));
        let text = format!("{name}: {} m, {changes}", plain(end - start, 3));
        let half = 0.5 * text_width(&text).max(b - a);
        let middle = (0.5 * (a + b)).clamp(MARGIN + half, (WIDTH - MARGIN - half).max(MARGIN + half));
        let row = rows.iter().position(|end| *end < middle - half - 4.0).unwrap_or(rows.len());
        rows.resize(rows.len().max(row + 1), 0.0);
        rows[row] = middle + half;
        let y = y + 24.0 * row as f64;
        draw_dimension(svg, a, b, y);
        svg.text("small halo", (middle, y + 15.0), Anchor::Middle, &text);
    }
    y + 24.0 * rows.len() as f64
}

/// Ranges of a tamping, neighbouring seats joined: its name, start and end, m, and count.
fn tamped<'a>(scenario: &'a Scenario, tamping: &'a Tamping) -> Vec<(&'a str, f64, f64, String)> {
    let track = &scenario.track;
    let after: Vec<String> = tamping.after.iter().map(|count| whole(*count)).collect();
    let text = format!("tamped after {} axles", after.join(", "));
    let reach = |seats: &[usize]| {
        let [first, last] = [seats[0], seats[seats.len() - 1]];
        let half = |seat: usize| 0.5 * track.bay(seat);
        (tamping.name.as_str(), track.seats[first].x - half(first), track.seats[last].x + half(last), text.clone())
    };
    tamping.seats.chunk_by(|a, b| a + 1 == *b).map(reach).collect()
}

/// Name, length and seats of each section.
fn draw_spans(svg: &mut Svg, scenario: &Scenario, view: &View, y: f64) -> f64 {
    for (index, section) in scenario.track.sections.iter().enumerate() {
        let (a, b) = (view.x(section.start), view.x(section.end));
        draw_dimension(svg, a, b, y);
        let seats = scenario.track.seats.iter().filter(|seat| seat.section == index).count();
        let spacing = spacings(scenario, index);
        let length = plain(section.end - section.start, 3);
        let full = format!("{}: {length} m, {} seats at {spacing} m", section.name, whole(seats as u64));
        let short = [full, format!("{}: {length} m", section.name), format!("{length} m")];
        if let Some(text) = short.iter().find(|text| 0.9 * text_width(text) < b - a) {
            svg.text("small", ((a + b) / 2.0, y + 15.0), Anchor::Middle, text);
        }
    }
    y + 22.0
}

/// `0.6`, or `0.5 to 0.65` where it varies.
fn spacings(scenario: &Scenario, section: usize) -> String {
    let track = &scenario.track;
    let bays = (0..track.seats.len()).filter(|i| track.seats[*i].section == section).map(|i| track.bay(i));
    let (low, high) = bays.fold((f64::INFINITY, 0.0_f64), |(low, high), bay| (low.min(bay), high.max(bay)));
    let show = |bay: f64| plain(bay, 3);
    if high - low > 1e-6 { format!("{} to {}", show(low), show(high)) } else { show(*track.sections[section].spacing) }
}

fn draw_chainage(svg: &mut Svg, view: &View, y: f64) -> f64 {
    let y = y + 4.0;
    let (left, right) = (view.x(view.start), view.x(view.end));
    svg.line("axis", (left, y), (right, y));
    let room = ((right - left) / 60.0).clamp(1.0, 10.0);
    let marks = ticks(view.start, view.end, room as usize);
    let step = marks.windows(2).next().map_or(1.0, |pair| pair[1] - pair[0]);
    for mark in marks {
        svg.line("axis", (view.x(mark), y), (view.x(mark), y + 4.0));
        svg.text("small muted", (view.x(mark), y + 16.0), Anchor::Middle, &tick_label(mark, step));
    }
    svg.text("small muted", ((left + right) / 2.0, y + 31.0), Anchor::Middle, "Chainage [m]");
    y + 42.0
}
