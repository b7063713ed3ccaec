//! The substructure node: forces in, settlement out. One port for every tier.

use super::{SubstructureNode, TrackNode};
use crate::scenario::Track;
use crate::solvers::settlement::{Law, SupportState};
use serde::{Deserialize, Serialize};

/// What a substructure remembers between two blocks: enough to go on with the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SubstructureState {
    /// One support a ballasted seat, left to right.
    Law(Vec<SupportState>),
    Fixed,
}

/// Settlement of every seat before any traffic, m.
pub(super) fn initial_settlement(track: &Track) -> Vec<f64> {
    track.seats.iter().map(|seat| seat.initial_settlement).collect()
}

/// A tier under the sleepers.
pub(super) struct Substructure<'a> {
    law: Option<&'a Law>,
    pub state: SubstructureState,
    /// Seats that have a support, as indices into the track's.
    seats: Vec<usize>,
    /// Settlement of every seat at the start, m.
    initial: Vec<f64>,
}

impl<'a> Substructure<'a> {
    pub fn new(node: &'a SubstructureNode, track: &TrackNode) -> Self {
        let seats: Vec<usize> = (0..track.track.seats.len()).filter(|i| track.track.seats[*i].is_ballasted()).collect();
        let (law, state) = match node {
            SubstructureNode::Law { law, .. } => {
                (Some(law), SubstructureState::Law(seats.iter().map(|_| law.fresh()).collect()))
            }
            SubstructureNode::Fixed => (None, SubstructureState::Fixed),
        };
        Substructure { law, state, seats, initial: initial_settlement(&track.track) }
    }

    /// Settlement of every seat, m: what the scene starts with and what traffic has added.
    pub fn settlement(&self) -> Vec<f64> {
        let mut settlement = self.initial.clone();
        if let (Some(law), SubstructureState::Law(supports)) = (self.law, &self.state) {
            for (seat, support) in self.seats.iter().zip(supports) {
                settlement[*seat] += law.settlement(support);
            }
        }
        settlement
    }

    /// Lets `trains` trains pass: `peaks` holds for every seat the peak contact force of each wheel of one train, N.
    pub fn load(&mut self, peaks: &[Vec<f64>], trains: u64) {
        if let (Some(law), SubstructureState::Law(supports)) = (self.law, &mut self.state) {
            for (seat, support) in self.seats.iter().zip(supports) {
                for peak in &peaks[*seat] {
                    law.add_cycles(support, *peak, trains);
                }
            }
        }
    }
}
