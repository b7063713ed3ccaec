//! The substructure node: forces in, settlement out. One port for every tier.

use super::{NamedLaw, SubstructureNode, TrackNode};
use crate::scenario::Track;
use crate::solvers::settlement::{Law, Peak, SupportState};
use serde::{Deserialize, Serialize};

/// What a substructure remembers between two blocks: enough to go on with the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SubstructureState {
    /// Law by law, the driving one first: one support a ballasted seat, left to right.
    Law(Vec<Vec<SupportState>>),
    Fixed,
}

/// Settlement of every seat before any traffic, m.
pub(super) fn initial_settlement(track: &Track) -> Vec<f64> {
    track.seats.iter().map(|seat| seat.initial_settlement).collect()
}

/// A tier under the sleepers.
#[derive(Clone)]
pub(super) struct Substructure<'a> {
    /// The driving law first; empty where nothing settles.
    laws: Vec<&'a Law>,
    pub state: SubstructureState,
    /// Seats that have a support, as indices into the track's.
    seats: Vec<usize>,
    /// Settlement of every seat at the start, m.
    initial: Vec<f64>,
}

impl<'a> Substructure<'a> {
    pub fn new(node: &'a SubstructureNode, track: &TrackNode) -> Self {
        let seats: Vec<usize> = (0..track.track.seats.len()).filter(|i| track.track.seats[*i].is_ballasted()).collect();
        let (laws, state) = match node {
            SubstructureNode::Law { law, followers } => {
                let laws: Vec<&Law> =
                    std::iter::once(law).chain(followers).map(|named: &NamedLaw| &named.law).collect();
                let fresh = laws.iter().map(|law| seats.iter().map(|_| law.fresh()).collect()).collect();
                (laws, SubstructureState::Law(fresh))
            }
            SubstructureNode::Fixed => (Vec::new(), SubstructureState::Fixed),
        };
        Substructure { laws, state, seats, initial: initial_settlement(&track.track) }
    }

    /// Settlement of every seat by the driving law, m: what the scene starts with and what traffic has added.
    pub fn settlement(&self) -> Vec<f64> {
        self.settlement_by_law().into_iter().next().unwrap_or_else(|| self.initial.clone())
    }

    /// Settlement of every seat by each law, m.
    pub fn settlement_by_law(&self) -> Vec<Vec<f64>> {
        let SubstructureState::Law(states) = &self.state else { return Vec::new() };
        let of_law = |(law, supports): (&&Law, &Vec<SupportState>)| {
            let mut settlement = self.initial.clone();
            for (seat, support) in self.seats.iter().zip(supports) {
                settlement[*seat] += law.settlement(support);
            }
            settlement
        };
        self.laws.iter().zip(states).map(of_law).collect()
    }

    /// Lets `trains` trains pass: `peaks` holds for every seat the peak of each wheel of one train.
    pub fn load(&mut self, peaks: &[Vec<Peak>], trains: u64) {
        let SubstructureState::Law(states) = &mut self.state else { return };
        for (law, supports) in self.laws.iter().zip(states) {
            for (seat, support) in self.seats.iter().zip(supports) {
                law.load(support, &peaks[*seat], trains);
            }
        }
    }
}
