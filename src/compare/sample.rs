//! A value on the packings of a result, and the difference of two.

use crate::results::{confidence_of_difference, mean_and_confidence, mean_and_deviation};
use serde::Serialize;

/// A value of each packing by its seed; of one where there is one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// Seeds and values, SI.
    pub values: Vec<(u64, f64)>,
    /// Mean, standard deviation and count where only these are kept.
    pub told: Option<(f64, f64, usize)>,
}

/// Difference of the mean of a value from the mean of the first result, SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Difference {
    pub difference: f64,
    /// The same as a share of the mean of the first; `None` if that is 0.
    pub share: Option<f64>,
    /// Half the width of the 95 % interval of the difference; `None` without packings to tell it.
    pub confidence: Option<f64>,
    /// Packings of both with the same seeds, by whose differences the interval is told; 0 if there are none.
    pub pairs: usize,
}

impl Difference {
    /// Whether the interval leaves no difference possible in the other direction.
    pub fn is_sure(&self) -> Option<bool> {
        self.confidence.map(|half| self.difference.abs() > half)
    }
}

impl Sample {
    /// The value of one result.
    pub fn one(seed: u64, value: f64) -> Sample {
        Sample { values: vec![(seed, value)], told: None }
    }

    fn alone(&self) -> Vec<f64> {
        self.values.iter().map(|(_, value)| *value).collect()
    }

    /// The mean; `None` without a value.
    pub fn mean(&self) -> Option<f64> {
        match self.told {
            Some((mean, ..)) => Some(mean),
            None if self.values.is_empty() => None,
            None => Some(mean_and_deviation(&self.alone()).0),
        }
    }

    /// Mean, standard deviation and count of values.
    fn spread(&self) -> Option<(f64, f64, usize)> {
        match self.told {
            Some(told) => Some(told),
            None => {
                let (mean, deviation) = mean_and_deviation(&self.alone());
                deviation.map(|deviation| (mean, deviation, self.values.len()))
            }
        }
    }

    /// Half the width of the 95 % interval of the mean.
    pub fn confidence(&self) -> Option<f64> {
        match self.told {
            Some(_) => None,
            None => mean_and_confidence(&self.alone()).1,
        }
    }

    /// Difference of another sample from this one.
    pub fn difference(&self, other: &Sample) -> Option<Difference> {
        let pairs: Vec<f64> = self.values.iter().filter_map(|(seed, own)| Some(other.on(*seed)? - own)).collect();
        let (before, after) = (self.mean()?, other.mean()?);
        // equal beds on both sides: the scatter from bed to bed cancels
        let is_paired = pairs.len() >= 2 && pairs.len() == self.values.len() && pairs.len() == other.values.len();
        let (difference, confidence) = match is_paired {
            true => mean_and_confidence(&pairs),
            false => {
                let spreads = self.spread().zip(other.spread());
                let half = spreads.and_then(|((_, a, n), (_, b, m))| confidence_of_difference((a, n), (b, m)));
                (after - before, half)
            }
        };
        let share = (before != 0.0).then(|| difference / before.abs());
        Some(Difference { difference, share, confidence, pairs: if is_paired { pairs.len() } else { 0 } })
    }

    fn on(&self, seed: u64) -> Option<f64> {
        self.values.iter().find(|(other, _)| *other == seed).map(|(_, value)| *value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(values: &[(u64, f64)]) -> Sample {
        Sample { values: values.to_vec(), told: None }
    }

    #[test]
    fn equal_seeds_are_compared_one_by_one() {
        // beds scatter by 1, the design makes 0.1 on each of them
        let (before, after) = (sample(&[(1, 1.0), (2, 2.0), (3, 3.0)]), sample(&[(3, 3.1), (1, 1.1), (2, 2.1)]));
        let paired = before.difference(&after).unwrap();
        assert!((paired.difference - 0.1).abs() < 1e-12 && paired.confidence.unwrap() < 1e-12);
        assert_eq!((paired.pairs, paired.is_sure()), (3, Some(true)));
        // other seeds: the scatter of both stands against the difference
        let apart = before.difference(&sample(&[(4, 1.1), (5, 2.1), (6, 3.1)])).unwrap();
        assert_eq!((apart.pairs, apart.is_sure()), (0, Some(false)));
    }

    #[test]
    fn one_packing_has_no_interval() {
        let difference = Sample::one(1, 2.0).difference(&Sample::one(1, 3.0)).unwrap();
        assert_eq!((difference.difference, difference.share, difference.confidence), (1.0, Some(0.5), None));
        assert_eq!(Sample::one(1, 0.0).difference(&Sample::one(1, 3.0)).unwrap().share, None);
        assert_eq!(Sample::default().difference(&Sample::one(1, 3.0)), None);
    }
}
