//! Which axle counts a figure shows and in which colour: the same count has the same colour in every figure of a run.

use super::curves::Band;
use super::number::whole;
use crate::results::Run;
use crate::scenario::{Scenario, Section};
use std::collections::BTreeSet;

/// Counts that a reader can tell apart.
const MOST: usize = 6;

/// A recorded axle count that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Count {
    pub axles: u64,
    /// `after 100 axles`.
    pub name: String,
    /// Its colour, from light (early) to dark.
    pub class: String,
}

impl Count {
    /// The count alone, for small charts.
    pub fn short(&self) -> &str {
        self.name.trim_start_matches("after ").trim_end_matches(" axles")
    }
}

/// The counts at which sleepers were recorded; at most six of them, spread evenly.
pub fn shown(run: &Run) -> Vec<Count> {
    let of_sleepers = run.sleepers.iter().map(|row| row.axles);
    let of_levels = run.histories.iter().filter(|row| row.quantity == "rail_level").map(|row| row.axles);
    let all: Vec<u64> = of_sleepers.chain(of_levels).collect::<BTreeSet<_>>().into_iter().collect();
    let chosen: Vec<u64> = match all.len() {
        n if n <= MOST => all,
        n => (0..MOST).map(|k| all[k * (n - 1) / (MOST - 1)]).collect(),
    };
    let last = chosen.len().saturating_sub(1);
    let count = |(index, axles): (usize, u64)| {
        let name = if axles == 0 { "as built".to_owned() } else { format!("after {} axles", whole(axles)) };
        let colour = (index * (MOST - 1)).checked_div(last).unwrap_or(MOST - 1);
        Count { axles, name, class: format!("k{colour}") }
    };
    chosen.into_iter().enumerate().map(count).collect()
}

/// Bands that mark the sections: shaded if no ballast carries the track, named if there are several.
pub fn sections(scenario: &Scenario) -> Vec<Band> {
    let track = &scenario.track;
    let several = track.sections.len() > 1;
    let ballasted = |index: usize| track.seats.iter().any(|seat| seat.section == index && seat.is_ballasted());
    let band = |(index, section): (usize, &Section)| Band {
        from: section.start,
        to: section.end,
        label: if several { section.name.clone() } else { String::new() },
        class: if several && !ballasted(index) { "stiff" } else { "hit" },
    };
    track.sections.iter().enumerate().map(band).collect()
}
