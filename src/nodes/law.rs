//! The ground where no grains carry the sleepers: springs that do not settle, or a settlement law under each seat.

use super::{Load, Mark, NodeError, Substructure};
use crate::graph::{LawBounds, LawNode, NamedLaw, Responses, SupportNode};
use crate::solvers::settlement::{Law, Peak, SupportState};
use serde::{Deserialize, Serialize};

/// Springs with laws that settle them; without a law nothing settles.
pub struct LawGround<'a> {
    /// The driving one first, then those beside it: of every seat that settles.
    laws: Vec<Vec<&'a Law>>,
    /// Name and bounds of the driving law of every seat that settles, if it has bounds.
    bounded: Vec<Option<(&'a str, LawBounds)>>,
    /// Indices of the seats that settle.
    seats: Vec<usize>,
    /// Settlement of every seat at the start, m.
    initial: Vec<f64>,
    responses: Responses,
    state: State,
}

/// By law, then by support.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct State {
    supports: Vec<Vec<SupportState>>,
    /// Settlement of every seat from which its law counts, m: the settlement at the start, or after tamping.
    level: Vec<Vec<f64>>,
}

impl<'a> LawGround<'a> {
    /// Supports that do not settle.
    pub fn springs(supports: &[SupportNode]) -> LawGround<'a> {
        LawGround::new(supports, Vec::new())
    }

    /// Supports under laws, as the scene starts them.
    pub fn law(node: &'a LawNode) -> LawGround<'a> {
        let seats = settling(&node.supports);
        let driving: Vec<&NamedLaw> = seats.iter().map(|seat| node.of_seat(*seat)).collect();
        let beside = node.followers.iter().map(|named| vec![&named.law; seats.len()]);
        let laws = std::iter::once(driving.iter().map(|named| &named.law).collect()).chain(beside).collect();
        let bounded = driving.iter().map(|named| named.bounds.map(|bounds| (named.name.as_str(), bounds))).collect();
        LawGround { bounded, ..LawGround::new(&node.supports, laws) }
    }

    fn new(supports: &[SupportNode], laws: Vec<Vec<&'a Law>>) -> LawGround<'a> {
        let seats = settling(supports);
        let initial: Vec<f64> = supports.iter().map(|support| support.settlement).collect();
        let state = State {
            supports: laws.iter().map(|laws| laws.iter().map(|law| law.fresh()).collect()).collect(),
            level: vec![initial.clone(); laws.len()],
        };
        let responses = Responses { revision: 0, seats: supports.iter().map(|support| support.spring).collect() };
        LawGround { laws, bounded: Vec::new(), seats, initial, responses, state }
    }

    fn settlements(&self, state: &State) -> Vec<Vec<f64>> {
        (0..self.laws.len()).map(|law| self.settlement_of(law, state)).collect()
    }

    fn settlement_of(&self, law: usize, state: &State) -> Vec<f64> {
        let mut settlement = state.level[law].clone();
        for (seat, support) in self.seats.iter().zip(&state.supports[law]) {
            settlement[*seat] += support.settlement();
        }
        settlement
    }

    /// Fails if a wheel loads a support beyond the bounds of the law.
    fn within_bounds(&self, loads: &[Load<'_>]) -> Result<(), NodeError> {
        for load in loads {
            for (seat, bounded) in self.seats.iter().zip(&self.bounded) {
                let Some((law, bounds)) = *bounded else { continue };
                let beyond = |peak: &&Peak| peak.force > bounds.force || peak.void > bounds.void;
                if let Some(peak) = load.peaks()[*seat].iter().find(beyond) {
                    let found = LawBounds { force: peak.force, void: peak.void };
                    return Err(NodeError::BeyondLaw { law: law.to_owned(), seat: *seat, found, bounds });
                }
            }
        }
        Ok(())
    }

    fn load(&self, state: &mut State, laws: usize, loads: &[Load<'_>]) {
        for load in loads {
            for supports in &mut state.supports[..laws] {
                for (seat, support) in self.seats.iter().zip(supports) {
                    support.load(&load.peaks()[*seat], load.trains);
                }
            }
        }
    }
}

impl Substructure for LawGround<'_> {
    fn responses(&self) -> &Responses {
        &self.responses
    }

    fn settlement(&self) -> Vec<f64> {
        if self.laws.is_empty() { self.initial.clone() } else { self.settlement_of(0, &self.state) }
    }

    fn settlement_by_law(&self) -> Vec<Vec<f64>> {
        self.settlements(&self.state)
    }

    fn sees_voids(&self) -> bool {
        self.laws.iter().flatten().any(|law| law.sees_voids()) || self.bounded.iter().any(Option::is_some)
    }

    /// Laws are exact: this equals the result of [`Substructure::advance`], to the last bit.
    fn predict(&self, loads: &[Load<'_>]) -> Result<Vec<f64>, NodeError> {
        if self.laws.is_empty() {
            return Ok(self.initial.clone());
        }
        // followers change nothing
        let mut state =
            State { supports: vec![self.state.supports[0].clone()], level: vec![self.state.level[0].clone()] };
        self.load(&mut state, 1, loads);
        Ok(self.settlement_of(0, &state))
    }

    fn advance(&mut self, loads: &[Load<'_>]) -> Result<(), NodeError> {
        self.within_bounds(loads)?;
        let mut state = std::mem::replace(&mut self.state, State { supports: Vec::new(), level: Vec::new() });
        self.load(&mut state, self.laws.len(), loads);
        self.state = state;
        Ok(())
    }

    fn mark(&self) -> Mark {
        Mark(Box::new(self.state.clone()))
    }

    fn roll_back(&mut self, mark: Mark) {
        if let Ok(state) = mark.0.downcast::<State>() {
            self.state = *state;
        }
    }

    /// Tamping loosens the ballast that traffic had packed, so that each law begins afresh there: in the published
    /// curves N counts from the last tamping, and the fast settlement of the first cycles comes back (Dahlberg 2001;
    /// Selig and Waters 1994, section 8).
    fn tamp(&mut self, seats: &[usize], left: f64) -> Result<(), NodeError> {
        let settled = self.settlements(&self.state);
        let State { supports, level } = &mut self.state;
        for (((laws, supports), level), settled) in self.laws.iter().zip(supports).zip(level).zip(settled) {
            let all = self.seats.iter().zip(laws).zip(supports);
            for ((seat, law), support) in all.filter(|((seat, _), _)| seats.binary_search(seat).is_ok()) {
                level[*seat] = left * settled[*seat];
                *support = law.fresh();
            }
        }
        Ok(())
    }

    fn save(&self) -> Result<serde_json::Value, NodeError> {
        serde_json::to_value(&self.state).map_err(foreign)
    }

    fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError> {
        let state: State = serde_json::from_value(state.clone()).map_err(foreign)?;
        let laws = self.laws.len();
        let fits = state.supports.len() == laws
            && state.level.len() == laws
            && state.supports.iter().all(|supports| supports.len() == self.seats.len())
            && state.level.iter().all(|level| level.len() == self.initial.len())
            && self.laws.iter().flatten().zip(state.supports.iter().flatten()).all(|(law, s)| s.law() == **law);
        if !fits {
            return Err(foreign("it holds other laws or another number of seats"));
        }
        let settled = state.supports.iter().flatten().map(SupportState::settlement);
        if !settled.chain(state.level.iter().flatten().copied()).all(f64::is_finite) {
            return Err(foreign("it holds a settlement that is no number"));
        }
        self.state = state;
        Ok(())
    }
}

/// Indices of the seats that settle.
fn settling(supports: &[SupportNode]) -> Vec<usize> {
    (0..supports.len()).filter(|seat| supports[*seat].spring.is_some()).collect()
}

fn foreign(why: impl ToString) -> NodeError {
    NodeError::Foreign { node: "settlement laws", why: why.to_string() }
}
