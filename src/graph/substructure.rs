//! The substructure node: forces in, settlement out. One port for every tier.

use super::{NamedLaw, SubstructureNode, TrackNode};
use crate::solvers::settlement::{Law, Peak, SupportState};
use serde::{Deserialize, Serialize};

/// What a substructure remembers between two blocks: enough to go on with the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SubstructureState {
    /// Law by law, the driving one first: one support a ballasted seat, left to right.
    Law(Vec<Vec<SupportState>>),
    Fixed,
}

/// A tier under the sleepers.
pub(super) struct Substructure<'a> {
    /// The driving law first; empty where nothing settles.
    laws: Vec<&'a Law>,
    pub state: SubstructureState,
    /// Seats that have a support, as indices into the track's.
    seats: Vec<usize>,
    all_seats: usize,
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
        Substructure { laws, state, seats, all_seats: track.track.seats.len() }
    }

    /// Settlement of every seat by the driving law, m; zero where nothing settles.
    pub fn settlement(&self) -> Vec<f64> {
        self.settlement_by_law().into_iter().next().unwrap_or_else(|| vec![0.0; self.all_seats])
    }

    /// Settlement of every seat by each law, m.
    pub fn settlement_by_law(&self) -> Vec<Vec<f64>> {
        let SubstructureState::Law(states) = &self.state else { return Vec::new() };
        let of_law = |(law, supports): (&&Law, &Vec<SupportState>)| {
            let mut settlement = vec![0.0; self.all_seats];
            for (seat, support) in self.seats.iter().zip(supports) {
                settlement[*seat] = law.settlement(support);
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
