//! How far a support has settled after the peaks of force that it has carried: the laws, and what each remembers.

mod varandas;

pub use varandas::{Varandas, VarandasState};

use serde::{Deserialize, Serialize};

/// A settlement law with its parameters, the same for all supports.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Law {
    Varandas(Varandas),
}

/// What one support remembers of its history under a [`Law`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SupportState {
    Varandas(VarandasState),
}

impl Law {
    /// A support that has carried nothing yet.
    pub fn fresh(&self) -> SupportState {
        match self {
            Law::Varandas(_) => SupportState::Varandas(VarandasState::default()),
        }
    }

    /// Adds `count` cycles whose contact force peaks at `peak` (N). A peak that is not positive settles nothing.
    pub fn add_cycles(&self, state: &mut SupportState, peak: f64, count: u64) {
        match (self, state) {
            (Law::Varandas(_), SupportState::Varandas(state)) => state.add_cycles(peak, count),
        }
    }

    /// Settlement since the support was fresh, m, positive down.
    pub fn settlement(&self, state: &SupportState) -> f64 {
        match (self, state) {
            (Law::Varandas(law), SupportState::Varandas(state)) => law.settlement(state),
        }
    }
}
