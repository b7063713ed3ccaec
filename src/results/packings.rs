//! The same run on further packings of its grains: scatter from bed to bed.

use super::summary::Scalar;
use super::{ResultsError, Run, SleeperRow};
use super::{is_known_within, mean_and_confidence, mean_and_deviation};
use crate::scenario::{Grains, Solve};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Folder in a run's directory that holds the runs on further packings, each called by its seed.
const FOLDER: &str = "packings";

/// Scalars that are reported over packings.
pub const OVER_PACKINGS: [&str; 9] = [
    "settlement_step",
    "max_settlement",
    "far_field_settlement",
    "max_void",
    "voided_sleepers",
    "max_rail_seat_load",
    "max_contact_force",
    "max_wheel_force",
    "max_rail_displacement",
];

/// A run on another packing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Packing {
    pub seed: u64,
    pub sleepers: Vec<SleeperRow>,
    pub scalars: BTreeMap<String, Scalar>,
}

/// A scalar over packings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    pub mean: f64,
    /// Half the width of the 95 % interval of the mean.
    pub confidence: f64,
    /// Standard deviation of one packing.
    pub deviation: f64,
    pub least: f64,
    pub largest: f64,
}

/// The directory of a run on the packing of another seed.
pub fn packing_directory(run: &Path, seed: u64) -> PathBuf {
    run.join(FOLDER).join(seed.to_string())
}

/// Runs on the further packings that a run asks for, as far as they are finished, by their seeds: in an open range of
/// repeats the first that suffice.
pub fn read_packings(run: &Path, own: &BTreeMap<String, Scalar>, solve: &Solve) -> Result<Vec<Packing>, ResultsError> {
    let mut found = Vec::new();
    for seed in (1..u64::from(solve.grains.repeats.most)).map(|number| solve.seed + number) {
        if solve.grains.repeats.are_open() && Mean::over(own, &found).is_enough(&solve.grains) {
            break;
        }
        match read_packing(run, seed)? {
            Some(packing) => found.push(packing),
            // those of a range are in order
            None if solve.grains.repeats.are_open() => break,
            None => {}
        }
    }
    Ok(found)
}

/// The run on the packing of another seed; `None` if it is not finished.
pub fn read_packing(run: &Path, seed: u64) -> Result<Option<Packing>, ResultsError> {
    let directory = packing_directory(run, seed);
    if !super::files::is_finished(&directory) {
        return Ok(None);
    }
    let (scalars, sleepers) = (super::read_summary(&directory)?.scalars, super::files::read_sleepers(&directory)?);
    Ok(Some(Packing { seed, sleepers, scalars }))
}

/// The values over packings by which an open range of repeats ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Mean {
    /// The largest settlement on each packing, m.
    settlement: Vec<f64>,
    /// The step at the structure; empty if the track has none.
    step: Vec<f64>,
}

impl Mean {
    /// Values of a run and of its further packings.
    pub fn over(own: &BTreeMap<String, Scalar>, further: &[Packing]) -> Mean {
        let values = |name: &str| {
            let all = std::iter::once(own).chain(further.iter().map(|packing| &packing.scalars));
            all.map(|scalars| Some(scalars.get(name)?.value)).collect::<Option<Vec<f64>>>().unwrap_or_default()
        };
        Mean { settlement: values("max_settlement"), step: values("settlement_step") }
    }

    /// Mean of the largest settlement, m, and half the width of its 95 % interval.
    pub fn settlement(&self) -> (f64, Option<f64>) {
        mean_and_confidence(&self.settlement)
    }

    /// Whether the means are known to within the tolerance, which is a share of the largest settlement, and the least
    /// number of packings is there.
    pub fn is_enough(&self, grains: &Grains) -> bool {
        let reach = *grains.tolerance * self.settlement().0.abs();
        let known = |values: &[f64]| values.is_empty() || is_known_within(values, reach);
        self.settlement.len() >= grains.repeats.least as usize && known(&self.settlement) && known(&self.step)
    }
}

impl Run {
    /// How a scalar scatters over this packing and the further ones; `None` if there are none, or one of them has no
    /// such scalar.
    pub fn scatter(&self, name: &str) -> Option<Scatter> {
        let of = |scalars: &BTreeMap<String, Scalar>| scalars.get(name).map(|scalar| scalar.value);
        let all = std::iter::once(&self.summary.scalars).chain(self.packings.iter().map(|packing| &packing.scalars));
        let values: Vec<f64> = all.map(of).collect::<Option<_>>()?;
        let (mean, confidence) = mean_and_confidence(&values);
        let (_, deviation) = mean_and_deviation(&values);
        let (least, largest) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
        Some(Scatter { mean, confidence: confidence?, deviation: deviation?, least, largest })
    }

    /// Takes the runs on further packings, and adds mean, 95 % interval of the mean and standard deviation of scalars
    /// over all of them: `max_settlement_mean`, `max_settlement_mean_confidence`, `max_settlement_deviation`.
    pub fn with_packings(mut self, packings: Vec<Packing>) -> Run {
        self.packings = packings;
        for name in OVER_PACKINGS {
            let (Some(scatter), Some(own)) = (self.scatter(name), self.summary.scalars.get(name)) else { continue };
            let scalar = |value: f64| Scalar { value, ..own.clone() };
            let of = [
                ("mean", scalar(scatter.mean)),
                ("mean_confidence", scalar(scatter.confidence)),
                ("deviation", scalar(scatter.deviation)),
            ];
            self.summary.scalars.extend(of.map(|(what, scalar)| (format!("{name}_{what}"), scalar)));
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;
    use crate::scenario::Repeats;

    #[test]
    fn mean_and_deviation_are_those_of_all_packings() {
        let run = example::transition();
        let own = run.scalar("max_settlement").unwrap();
        let other = |seed: u64, times: f64| {
            let mut scalars = run.summary.scalars.clone();
            scalars.get_mut("max_settlement").unwrap().value *= times;
            Packing { seed, sleepers: run.sleepers.clone(), scalars }
        };
        assert_eq!(run.scatter("max_settlement"), None, "one packing has no scatter");
        let told = run.clone().with_packings(vec![other(2, 2.0), other(3, 3.0)]);
        assert!((told.scalar("max_settlement_mean").unwrap() / own - 2.0).abs() < 1e-12);
        assert!((told.scalar("max_settlement_deviation").unwrap() / own - 1.0).abs() < 1e-12);
        let scatter = told.scatter("max_settlement").unwrap();
        assert!((scatter.least / own - 1.0).abs() < 1e-12 && (scatter.largest / own - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_directory_without_packings_has_none() {
        let folder = tempfile::tempdir().unwrap();
        let mut solve = example::transition().scenario.solve;
        solve.grains.repeats = Repeats::times(3);
        let none = BTreeMap::new();
        assert_eq!(read_packings(folder.path(), &none, &solve).unwrap(), Vec::new());
        std::fs::create_dir_all(packing_directory(folder.path(), solve.seed + 1)).unwrap();
        assert_eq!(read_packings(folder.path(), &none, &solve).unwrap(), Vec::new(), "not finished");
    }

    #[test]
    fn a_range_of_packings_ends_where_the_means_are_known() {
        let mut grains = example::transition().scenario.solve.grains;
        grains.repeats = Repeats { least: 3, most: 12 };
        // 3 values of deviation 0.1: their interval reaches 4.303 * 0.1 / sqrt(3) = 0.248
        let around = |step: f64| Mean { settlement: vec![9.9, 10.0, 10.1], step: vec![3.0 - step, 3.0, 3.0 + step] };
        for (tolerance, step, enough) in [(0.025, 0.1, true), (0.0248, 0.1, false), (0.025, 0.2, false)] {
            grains.tolerance.value = tolerance;
            assert_eq!(around(step).is_enough(&grains), enough, "{tolerance} {step}");
        }
        grains.tolerance.value = 0.5;
        let two = Mean { settlement: vec![10.0, 10.0], step: Vec::new() };
        assert!(!two.is_enough(&grains), "fewer than the least");
    }
}
