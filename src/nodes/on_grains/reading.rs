//! Reads the support under a sleeper during a passage: its stiffness, and the level at which its force is zero.

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
///
/// A wheel, a bogie, or the bogies of two neighbours press it down and let it go again: its force rises and falls. A
/// long train does this many times while the support settles, so only the last loading gives the present stiffness of
/// the support.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Watched {
    /// The loading under way, or about to begin.
    now: Loading,
    /// Whether its force has risen.
    rises: bool,
    /// The last complete loading that was more than ringing, and the largest force added by any loading, N.
    last: Option<Loading>,
    largest: f64,
    before: Reading,
    /// Level at which it last left its support, m.
    left: Option<f64>,
    /// Time without contact, s.
    pub lost: f64,
}

/// One rise of the force under a sleeper: where it begins, and where the force is largest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Loading {
    begin: Reading,
    peak: Reading,
}

impl Loading {
    fn from(begin: Reading) -> Loading {
        Loading { begin, peak: begin }
    }

    /// Force that it adds, N.
    fn added(&self) -> f64 {
        self.peak.force - self.begin.force
    }
}

impl Watched {
    /// A sleeper at rest.
    pub fn from_rest(before: Reading) -> Watched {
        Watched { now: Loading::from(before), before, ..Watched::default() }
    }

    /// Takes the state after a step of so long, s.
    pub fn see(&mut self, now: Reading, time_step: f64) {
        self.follow(now);
        if self.before.force > LIFTED && now.force <= LIFTED {
            self.left = Some(now.level);
        }
        if now.force <= 0.0 {
            self.lost += time_step;
        }
        self.before = now;
    }

    fn follow(&mut self, now: Reading) {
        if self.rises {
            if now.force > self.now.peak.force {
                self.now.peak = now;
            } else if self.now.peak.force - now.force > LET_GO * self.now.added() {
                self.last = self.told();
                self.largest = self.largest.max(self.now.added());
                (self.now, self.rises) = (Loading::from(now), false);
            }
        } else if now.force <= self.now.begin.force.max(LIFTED) {
            // its level in the air does not matter; the level at which it lands does
            self.now = Loading::from(now);
        } else if now.force - self.now.begin.force > LOADED * LIFTED {
            (self.now.peak, self.rises) = (now, true);
        }
    }

    /// The last loading that gives the stiffness of the support.
    fn told(&self) -> Option<Loading> {
        let ringing = self.now.added() < RINGING * self.largest.max(self.now.added());
        if self.rises && !ringing { Some(self.now) } else { self.last }
    }

    /// Secant of the support from where the last loading begins to its largest force, N/m; `None` if no wheel loads it.
    pub fn stiffness(&self) -> Option<f64> {
        let told = self.told()?;
        let way = told.peak.level - told.begin.level;
        (way > 0.0).then(|| told.added() / way)
    }

    /// Level at which the support carries nothing, m, by its state at rest and a stiffness (N/m); for a sleeper that
    /// hangs, the one at which it last left its support. `None` if it hangs and no wheel has pressed it down: the level
    /// of its support is not known.
    pub fn unloaded_level(&self, rest: Reading, stiffness: f64) -> Option<f64> {
        match self.left {
            _ if rest.force > LIFTED => Some(rest.level - rest.force / stiffness),
            Some(level) => Some(level.max(rest.level)),
            None => None,
        }
    }
}

/// Smallest force added by a wheel, as a multiple of [`LIFTED`], for which the secant stiffness is used.
const LOADED: f64 = 20.0;
/// Share of the force that must disappear before a loading is over: between the wheels of a bogie the force drops less.
const LET_GO: f64 = 0.75;
/// A loading below this share of the passage's largest loading is ringing of the track.
const RINGING: f64 = 0.5;

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
        assert!((seen.stiffness().unwrap() - 40e3 / 1.5e-3).abs() < 1.0, "from the last look before it touched");
        assert_eq!(seen.lost, 2.0 * DT);
    }

    #[test]
    fn a_long_train_tells_the_support_of_its_last_bogie() {
        let rest = Reading { level: 0.0, force: 2e3 };
        // the first bogie makes the bed settle by 1 mm, the second finds it at 50 MN/m, and the track rings behind it
        let train = [[1.2e-3, 20e3], [2.0e-3, 42e3], [1.04e-3, 4e3], [1.4e-3, 22e3], [1.8e-3, 42e3], [1.0e-3, 2e3]];
        let seen = watched(rest, &[train.as_slice(), &[[1.1e-3, 6e3], [1.0e-3, 2e3]]].concat());
        assert!((seen.stiffness().unwrap() - 38e3 / 0.76e-3).abs() < 1.0, "{:?}", seen.stiffness());
        let underway = watched(rest, &train[..5]);
        assert_eq!(underway.stiffness(), seen.stiffness(), "the bogie that has come counts");
        assert!((watched(rest, &train[..3]).stiffness().unwrap() - 40e3 / 2e-3).abs() < 1.0);
    }

    #[test]
    fn a_sleeper_that_no_wheel_presses_down_tells_nothing() {
        let rest = Reading { level: 1e-3, force: 0.0 };
        let seen = watched(rest, &[[2e-3, 0.0], [1e-3, 0.0]]);
        assert_eq!((seen.unloaded_level(rest, 100e6), seen.stiffness()), (None, None));
    }
}
