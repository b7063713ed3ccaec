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
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
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

    /// Level at which the support carries nothing, m, by its state at rest and a stiffness (N/m); for a sleeper that hangs, the one at
    /// which it last left its support. `None` where it hangs and no wheel has pressed it down: nobody has seen its support.
    pub fn unloaded_level(&self, rest: Reading, stiffness: f64) -> Option<f64> {
        match self.left {
            _ if rest.force > LIFTED => Some(rest.level - rest.force / stiffness),
            Some(level) => Some(level.max(rest.level)),
            None => None,
        }
    }
}

/// Times [`LIFTED`] that a wheel must add before its secant says anything.
const LOADED: f64 = 20.0;

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-5;

    /// Levels (m) and forces (N) that a sleeper goes through.
    fn watched(before: Reading, through: &[[f64; 2]]) -> Watched {
        let mut watched = Watched::from_rest(before);
        through.iter().for_each(|[level, force]| watched.see(Reading { level: *level, force: *force }, DT));
        watched
    }

    #[test]
    fn a_sleeper_that_rests_tells_its_support_by_its_stiffness() {
        let rest = Reading { level: 1e-3, force: 2e3 };
        let seen = watched(rest, &[[1.2e-3, 20e3], [1.4e-3, 42e3], [1.1e-3, 3e3]]);
        assert!((seen.stiffness().unwrap() - 40e3 / 0.4e-3).abs() < 1.0);
        assert!((seen.unloaded_level(rest, 100e6).unwrap() - 0.98e-3).abs() < 1e-12);
    }

    #[test]
    fn a_sleeper_that_hangs_tells_where_it_left_its_support() {
        let rest = Reading { level: 1e-3, force: 0.0 };
        let seen = watched(rest, &[[2e-3, 0.0], [3e-3, 500.0], [3.5e-3, 40e3], [3.2e-3, 50.0], [1e-3, 0.0]]);
        assert_eq!(seen.unloaded_level(rest, 100e6), Some(3.2e-3));
        assert!((seen.stiffness().unwrap() - 39.9e3 / 0.5e-3).abs() < 1.0, "from where it touched");
        assert_eq!(seen.lost, 2.0 * DT);
    }

    #[test]
    fn a_sleeper_that_no_wheel_presses_down_tells_nothing() {
        let rest = Reading { level: 1e-3, force: 0.0 };
        let seen = watched(rest, &[[2e-3, 0.0], [1e-3, 0.0]]);
        assert_eq!((seen.unloaded_level(rest, 100e6), seen.stiffness()), (None, None));
    }
}
