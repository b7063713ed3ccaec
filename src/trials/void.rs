//! Gaps under sleepers that a trial opens in an unsettled track.

use crate::scenario::Track;
use serde::Serialize;

/// A gap under sleepers of an unsettled track.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Void {
    /// m.
    pub depth: f64,
    /// Number of sleepers nearest to the transition; if absent, all ballasted supports lie lower.
    pub sleepers: Option<usize>,
}

impl Void {
    /// Every void of a map.
    pub(super) const ALL: [Void; 7] = [
        Void { depth: 0.0, sleepers: Some(0) },
        Void { depth: 0.05e-3, sleepers: Some(1) },
        Void { depth: 1e-3, sleepers: Some(1) },
        Void { depth: 1e-3, sleepers: Some(3) },
        Void { depth: 20e-3, sleepers: Some(1) },
        Void { depth: 20e-3, sleepers: Some(3) },
        Void { depth: 20e-3, sleepers: None },
    ];

    /// The settlement of every seat that leaves this void, m.
    pub fn settlement(self, track: &Track) -> Vec<f64> {
        let middle = middle(track);
        let mut ballasted: Vec<usize> = (0..track.seats.len()).filter(|i| track.seats[*i].is_ballasted()).collect();
        let distance = |i: &usize| (track.seats[*i].x - middle).abs();
        ballasted.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut settlement = vec![0.0; track.seats.len()];
        for seat in ballasted.into_iter().take(self.sleepers.unwrap_or(usize::MAX)) {
            settlement[seat] = self.depth;
        }
        settlement
    }
}

/// Where the first transition is, or the middle of a track that has none, m.
pub(super) fn middle(track: &Track) -> f64 {
    track.transitions.first().map_or((track.start() + track.end()) / 2.0, |t| t.x)
}
