//! Energy balance: a ledger of energies by kind.

use super::chunk::Held;
use serde::{Deserialize, Serialize};

/// Energies at the start of the last step \[J\], and work and losses since the watch began.
///
/// Work is force times displacement by the trapezoidal rule, so the residual decreases with the square of the step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    pub kinetic: f64,
    /// Strain energy of the elements, including hourglass patterns.
    pub strain: f64,
    /// Energy lost to plastic flow, to stiffness damping and local damping, and through quiet faces.
    pub plastic: f64,
    pub damping: f64,
    pub quiet: f64,
    /// Work done by gravity, by forces of the caller, and by driven nodes.
    pub gravity: f64,
    pub external: f64,
    pub driven: f64,
    /// Kinetic and strain energy when the watch began.
    pub start: f64,
}

impl Energy {
    /// Stored and lost energy, minus initial energy and work: 0 except for the error of the scheme \[J\].
    pub fn residual(&self) -> f64 {
        let there = self.kinetic + self.strain + self.plastic + self.damping + self.quiet;
        there - self.start - self.gravity - self.external - self.driven
    }
}

/// Work of the forces of one step over the half step before it and the half step after it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Halves {
    pub before: f64,
    pub after: f64,
}

/// Sums over the nodes in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Tally {
    /// Sum of the squares of velocities \[m²/s²\]: not a number if a velocity is not a number.
    pub speed: f64,
    pub kinetic: f64,
    pub damping: Halves,
    pub quiet: Halves,
    pub gravity: Halves,
    pub external: Halves,
    pub driven: Halves,
}

impl Halves {
    fn join(&mut self, other: Halves) {
        self.before += other.before;
        self.after += other.after;
    }
}

impl Tally {
    pub fn join(mut self, other: Tally) -> Tally {
        self.speed += other.speed;
        self.kinetic += other.kinetic;
        self.damping.join(other.damping);
        self.quiet.join(other.quiet);
        self.gravity.join(other.gravity);
        self.external.join(other.external);
        self.driven.join(other.driven);
        self
    }
}

/// The running account.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Ledger {
    pub watched: bool,
    /// Whether a step has been recorded.
    begun: bool,
    pub now: Energy,
    /// Second halves of the work and loss of the last step: damping, quiet, gravity, external, driven.
    pending: [f64; 5],
}

impl Ledger {
    pub fn begin(watched: bool) -> Ledger {
        Ledger { watched, ..Ledger::default() }
    }

    pub fn enter(&mut self, held: Held, tally: &Tally) {
        let now = &mut self.now;
        now.kinetic = tally.kinetic;
        now.strain = held.strain;
        let sums = [&mut now.damping, &mut now.quiet, &mut now.gravity, &mut now.external, &mut now.driven];
        let halves = [tally.damping, tally.quiet, tally.gravity, tally.external, tally.driven];
        if self.begun {
            now.plastic += held.plastic;
            for ((sum, pending), halves) in sums.into_iter().zip(&self.pending).zip(halves) {
                *sum += pending + halves.before;
            }
        } else {
            now.start = now.kinetic + now.strain;
        }
        self.pending = halves.map(|halves| halves.after);
        self.begun = true;
    }
}
