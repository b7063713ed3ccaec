//! Which parts of the beds are shown: some metres of grains beside each transition, and the edge of the structure.

use crate::report::view::{MARGIN, WIDTH};
use crate::results::{BedsAtCount, Run};
use crate::scenario::Transition;

/// Grains beside a transition that are shown, and structure, m.
const GRAINS: f64 = 6.0;
const STRUCTURE: f64 = 0.9;
/// Grains that are shown where no transition lies beside them, m.
const ALONE: f64 = 7.0;
/// Room at the end of the grains, m: a sleeper may stand there.
const END: f64 = 0.2;
/// Room for the axis, px.
const AXIS: f64 = 40.0;
/// Height of the largest level in the picture, px.
const LEVEL: f64 = 44.0;
const FACTORS: [f64; 9] = [500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0];

/// A part of the track at one scale.
pub struct Window {
    pub from: f64,
    pub to: f64,
    /// The structure that is shown, m.
    pub structure: Option<[f64; 2]>,
    /// Lowest grain, m below the undersides of the sleepers.
    pub depth: f64,
    /// px a metre.
    pub scale: f64,
}

impl Window {
    pub fn x(&self, chainage: f64) -> f64 {
        MARGIN + AXIS + (chainage - self.from) * self.scale
    }

    pub fn holds(&self, chainage: f64) -> bool {
        (self.from..=self.to).contains(&chainage)
    }

    fn new([from, to]: [f64; 2], structure: Option<[f64; 2]>, beds: &BedsAtCount) -> Window {
        let inside = beds.grains.iter().filter(|grain| (from..=to).contains(&grain.place[0]));
        let depth = inside.map(|grain| grain.radius - grain.place[2]).fold(0.1, f64::max);
        Window { from, to, structure, depth, scale: (WIDTH - 2.0 * MARGIN - AXIS) / (to - from) }
    }
}

/// A window beside each transition that has grains beside it; one on the grains where none has.
pub fn windows(run: &Run, beds: &BedsAtCount) -> Vec<Window> {
    let transitions = &run.scenario.track.transitions;
    let windows: Vec<Window> = transitions.iter().filter_map(|transition| beside(transition, beds)).collect();
    if !windows.is_empty() {
        return windows;
    }
    let Some([left, right]) = extent(beds, [f64::NEG_INFINITY, f64::INFINITY]) else { return Vec::new() };
    let middle = 0.5 * (left + right);
    vec![Window::new([left.max(middle - 0.5 * ALONE), right.min(middle + 0.5 * ALONE)], None, beds)]
}

/// The grains on one side of a transition, and some structure on the other.
fn beside(transition: &Transition, beds: &BedsAtCount) -> Option<Window> {
    let x = transition.x;
    let before = extent(beds, [x - GRAINS, x]);
    let behind = extent(beds, [x, x + GRAINS]);
    let length = |extent: Option<[f64; 2]>| extent.map_or(0.0, |[a, b]| b - a);
    if length(before).max(length(behind)) <= 0.0 {
        return None;
    }
    let (span, structure) = if length(before) > length(behind) {
        ([before?[0] - END, x + STRUCTURE], [x, x + STRUCTURE])
    } else {
        ([x - STRUCTURE, behind?[1] + END], [x - STRUCTURE, x])
    };
    Some(Window::new(span, Some(structure), beds))
}

/// Between which places of an interval grains lie, m.
fn extent(beds: &BedsAtCount, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
    let places = beds.grains.iter().map(|grain| grain.place[0]).filter(|x| (from..=to).contains(x));
    places.fold(None, |found: Option<[f64; 2]>, x| {
        let [low, high] = found.unwrap_or([x, x]);
        Some([low.min(x), high.max(x)])
    })
}

/// Enlargement of levels and voids, so that the largest value of all counts fills its room.
pub fn exaggeration(run: &Run, scale: f64) -> f64 {
    let levels = run.rail.iter().map(|row| row.level_m.abs());
    let largest = run.sleepers.iter().map(|row| row.settlement_m.max(row.void_m)).chain(levels).fold(0.0, f64::max);
    let fits = |factor: &f64| largest * factor * scale <= LEVEL;
    FACTORS.into_iter().find(fits).unwrap_or(1.0)
}
