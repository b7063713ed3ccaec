//! The loads and voids of the specimens.

use serde::{Deserialize, Serialize};

/// The trains of a specimen: the forces that the train of the scene adds, times a factor, over a sleeper with a void.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    pub factor: f64,
    /// Gap between the sleeper and its support without a train, m.
    pub void: f64,
}

impl Trial {
    /// The train of the scene over a sleeper without a void.
    pub const OF_SCENE: Trial = Trial { factor: 1.0, void: 0.0 };
}

/// The range that a law must cover.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranges {
    /// The least and the largest factor of the forces of a train.
    pub factors: [f64; 2],
    /// The largest void, m.
    pub void: f64,
    /// Trains that pass each specimen.
    pub trains: u32,
}

/// Specimens with different factors, and with different voids under the train of the scene.
const FACTORS: u32 = 5;
const VOIDS: u32 = 3;

impl Default for Ranges {
    fn default() -> Self {
        Ranges { factors: [0.5, 1.8], void: 0.5e-3, trains: 16 }
    }
}

impl Ranges {
    /// One trial a specimen: factors without a void, voids at factor 1, and half of both.
    pub fn trials(&self) -> Vec<Trial> {
        let [least, most] = self.factors;
        let factor = |at: u32| least * (most / least).powf(f64::from(at) / f64::from(FACTORS - 1));
        let loads = (0..FACTORS).map(|at| Trial { factor: factor(at), void: 0.0 });
        let sunk = |at: u32| Trial { factor: 1.0, void: self.void * f64::from(at) / f64::from(VOIDS) };
        let both = Trial { factor: most.sqrt(), void: 0.5 * self.void };
        loads.chain((1..=VOIDS).map(sunk)).chain([both]).collect()
    }

    /// The loads of a specimen that checks the law: they change from train to train, and the law was not fitted to it.
    pub fn check(&self) -> Vec<Trial> {
        let [least, most] = self.factors;
        let third = self.trains.div_ceil(3) as usize;
        let parts = [
            Trial { factor: 1.0, void: 0.0 },
            Trial { factor: most.sqrt(), void: 0.0 },
            Trial { factor: least.sqrt(), void: 0.25 * self.void },
        ];
        parts.iter().flat_map(|trial| std::iter::repeat_n(*trial, third)).take(self.trains as usize).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specimens_span_the_range() {
        let ranges = Ranges::default();
        let trials = ranges.trials();
        let most = |of: fn(&Trial) -> f64| trials.iter().map(of).fold(0.0, f64::max);
        let least = trials.iter().map(|trial| trial.factor).fold(f64::INFINITY, f64::min);
        assert!((most(|trial| trial.factor) - 1.8).abs() < 1e-12 && (most(|trial| trial.void) - 0.5e-3).abs() < 1e-15);
        assert!((least - 0.5).abs() < 1e-12);
        assert_eq!(trials.len(), 9);
        assert_eq!(ranges.check().len(), 16);
    }
}
