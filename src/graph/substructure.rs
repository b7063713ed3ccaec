//! The substructure node: forces in, settlement out. One port for every tier.

use super::{NamedLaw, SubstructureNode, TrackNode};
use crate::scenario::Track;
use crate::solvers::settlement::{Law, Peak, SupportState};
use serde::{Deserialize, Serialize};

/// What a substructure remembers between two blocks: enough to go on with the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SubstructureState {
    /// Law by law, the driving one first.
    Law {
        /// One a ballasted seat, left to right.
        supports: Vec<Vec<SupportState>>,
        /// Settlement of every seat from which its law counts, m: that of the start, later what tamping has left.
        level: Vec<Vec<f64>>,
    },
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
    /// Settlement of every seat at the start, m: all that there is where nothing settles.
    initial: Vec<f64>,
}

impl<'a> Substructure<'a> {
    pub fn new(node: &'a SubstructureNode, track: &TrackNode) -> Self {
        let seats: Vec<usize> = (0..track.track.seats.len()).filter(|i| track.track.seats[*i].is_ballasted()).collect();
        let initial = initial_settlement(&track.track);
        let (laws, state) = match node {
            SubstructureNode::Law { law, followers } => {
                let laws: Vec<&Law> =
                    std::iter::once(law).chain(followers).map(|named: &NamedLaw| &named.law).collect();
                let supports = laws.iter().map(|law| seats.iter().map(|_| law.fresh()).collect()).collect();
                let level = vec![initial.clone(); laws.len()];
                (laws, SubstructureState::Law { supports, level })
            }
            SubstructureNode::Fixed => (Vec::new(), SubstructureState::Fixed),
        };
        Substructure { laws, state, seats, initial }
    }

    /// Settlement of every seat by the driving law, m: what the scene starts with and what traffic has added.
    pub fn settlement(&self) -> Vec<f64> {
        self.settlement_by_law().into_iter().next().unwrap_or_else(|| self.initial.clone())
    }

    /// Settlement of every seat by each law, m.
    pub fn settlement_by_law(&self) -> Vec<Vec<f64>> {
        let SubstructureState::Law { supports, level } = &self.state else { return Vec::new() };
        let of_law = |(supports, level): (&Vec<SupportState>, &Vec<f64>)| {
            let mut settlement = level.clone();
            for (seat, support) in self.seats.iter().zip(supports) {
                settlement[*seat] += support.settlement();
            }
            settlement
        };
        supports.iter().zip(level).map(of_law).collect()
    }

    /// Lets `trains` trains pass: `peaks` holds for every seat the peak of each wheel of one train.
    pub fn load(&mut self, peaks: &[Vec<Peak>], trains: u64) {
        let SubstructureState::Law { supports, .. } = &mut self.state else { return };
        for supports in supports {
            for (seat, support) in self.seats.iter().zip(supports) {
                support.load(&peaks[*seat], trains);
            }
        }
    }

    /// Lifts seats, ascending, until only the share `left` of their settlement stays. Tamping loosens the ballast that traffic had
    /// packed, so that each law begins afresh there: in the published curves N counts from the last tamping, and the fast
    /// settlement of the first cycles comes back (Dahlberg 2001; Selig and Waters 1994, section 8).
    pub fn tamp(&mut self, seats: &[usize], left: f64) {
        let settled = self.settlement_by_law();
        let SubstructureState::Law { supports, level } = &mut self.state else { return };
        for (((law, supports), level), settled) in self.laws.iter().zip(supports).zip(level).zip(settled) {
            let tamped = self.seats.iter().zip(supports).filter(|(seat, _)| seats.binary_search(seat).is_ok());
            for (seat, support) in tamped {
                level[*seat] = left * settled[*seat];
                *support = law.fresh();
            }
        }
    }
}
