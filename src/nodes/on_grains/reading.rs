//! What a passage tells of the support under a sleeper: how stiff it is, and at which level it carries nothing.

use serde::{Deserialize, Serialize};

/// A state of the support: level of the sleeper's underside below the level as built, m, and the force on it, N.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Reading {
    pub level: f64,
    pub force: f64,
}

/// Force below which a sleeper counts as lifted, N: a twentieth of its share of the track's weight, or so.
pub const LIFTED: f64 = 100.0;

/// One sleeper over a passage.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Watched {
    /// At rest before it.
    before: Reading,
    peak: Reading,
    last: Reading,
    /// When it last came down on its support, and when it last left it.
    touched: Option<f64>,
    left: Option<f64>,
    /// Time without contact, s.
    pub lost: f64,
}

impl Watched {
    /// A sleeper at rest.
    pub fn from_rest(before: Reading) -> Watched {
        Watched { before, peak: before, last: before, ..Watched::default() }
    }

    /// Takes the state after a step of so long, s.
    pub fn see(&mut self, now: Reading, time_step: f64) {
        if now.force > self.peak.force {
            self.peak = now;
        }
        match (self.last.force > LIFTED, now.force > LIFTED) {
            (false, true) if self.touched.is_none() => self.touched = Some(now.level),
            (true, false) => self.left = Some(now.level),
            _ => {}
        }
        if now.force <= 0.0 {
            self.lost += time_step;
        }
        self.last = now;
    }

    /// Secant of the support from where it begins to carry, or from its state at rest, to the largest force, N/m; `None` where no wheel
    /// loads it.
    pub fn stiffness(&self) -> Option<f64> {
        let begin = match self.touched.filter(|_| self.before.force <= LIFTED) {
            Some(level) => Reading { level, force: LIFTED },
            None => self.before,
        };
        let (way, load) = (self.peak.level - begin.level, self.peak.force - begin.force);
        (way > 0.0 && load > LOADED * LIFTED).then(|| load / way)
    }

    /// Level at which the support carries nothing, by its state at rest and a stiffness (N/m), m; for a sleeper that hangs, the one at
    /// which it last left its support.
    pub fn unloaded_level(&self, rest: Reading, stiffness: f64) -> f64 {
        match self.left {
            Some(level) if rest.force <= LIFTED => level.max(rest.level),
            _ => rest.level - rest.force / stiffness,
        }
    }
}

/// Times [`LIFTED`] that a wheel must add before its secant says anything.
const LOADED: f64 = 20.0;
