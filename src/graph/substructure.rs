//! The substructure node: forces in, settlement out. One port for every tier.

use super::{SubstructureNode, TrackNode};
use crate::solvers::settlement::{Law, SupportState};
use serde::{Deserialize, Serialize};

/// What a substructure remembers between two blocks: enough to go on with the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SubstructureState {
    /// One support a ballasted seat, left to right.
    Law(Vec<SupportState>),
    Fixed,
}

/// A tier under the sleepers.
#[derive(Clone)]
pub(super) struct Substructure<'a> {
    law: Option<&'a Law>,
    pub state: SubstructureState,
    /// Seats that have a support, as indices into the track's.
    seats: Vec<usize>,
    all_seats: usize,
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
        Substructure { law, state, seats, all_seats: track.track.seats.len() }
    }

    /// Settlement of every seat, m; zero where nothing settles.
    pub fn settlement(&self) -> Vec<f64> {
        let mut settlement = vec![0.0; self.all_seats];
        if let (Some(law), SubstructureState::Law(supports)) = (self.law, &self.state) {
            for (seat, support) in self.seats.iter().zip(supports) {
                settlement[*seat] = law.settlement(support);
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
