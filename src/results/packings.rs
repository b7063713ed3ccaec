//! The same run on further packings of its grains: scatter from bed to bed.

use super::summary::Scalar;
use super::{ResultsError, Run, SleeperRow};
use crate::scenario::Solve;
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
    /// Standard deviation of one packing.
    pub deviation: f64,
    pub least: f64,
    pub largest: f64,
}

/// The directory of a run on the packing of another seed.
pub fn packing_directory(run: &Path, seed: u64) -> PathBuf {
    run.join(FOLDER).join(seed.to_string())
}

/// Runs on the further packings that a scene asks for, as far as they are finished, by their seeds.
pub fn read_packings(run: &Path, solve: &Solve) -> Result<Vec<Packing>, ResultsError> {
    let seeds = (1..u64::from(solve.grains.repeats)).map(|number| solve.seed + number);
    let directories = seeds.map(|seed| (seed, packing_directory(run, seed)));
    let finished = directories.filter(|(_, directory)| super::files::is_finished(directory));
    finished.map(|(seed, directory)| read_packing(seed, &directory)).collect()
}

fn read_packing(seed: u64, directory: &Path) -> Result<Packing, ResultsError> {
    let (scalars, sleepers) = (super::read_summary(directory)?.scalars, super::files::read_sleepers(directory)?);
    Ok(Packing { seed, sleepers, scalars })
}

impl Run {
    /// How a scalar scatters over this packing and the further ones; `None` if there are none, or one of them has no
    /// such scalar.
    pub fn scatter(&self, name: &str) -> Option<Scatter> {
        let of = |scalars: &BTreeMap<String, Scalar>| scalars.get(name).map(|scalar| scalar.value);
        let all = std::iter::once(&self.summary.scalars).chain(self.packings.iter().map(|packing| &packing.scalars));
        let values: Vec<f64> = all.map(of).collect::<Option<_>>()?;
        if values.len() < 2 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let (least, largest) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
        Some(Scatter { mean, deviation: (squares / (values.len() - 1) as f64).sqrt(), least, largest })
    }

    /// Takes the runs on further packings, and adds mean and standard deviation of scalars over all of them:
    /// `max_settlement_mean`, `max_settlement_deviation`.
    pub fn with_packings(mut self, packings: Vec<Packing>) -> Run {
        self.packings = packings;
        for name in OVER_PACKINGS {
            let (Some(scatter), Some(own)) = (self.scatter(name), self.summary.scalars.get(name)) else { continue };
            let scalar = |value: f64| Scalar { value, ..own.clone() };
            let [mean, deviation] = [scalar(scatter.mean), scalar(scatter.deviation)];
            self.summary.scalars.insert(format!("{name}_mean"), mean);
            self.summary.scalars.insert(format!("{name}_deviation"), deviation);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

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
        solve.grains.repeats = 3;
        assert_eq!(read_packings(folder.path(), &solve).unwrap(), Vec::new());
        std::fs::create_dir_all(packing_directory(folder.path(), solve.seed + 1)).unwrap();
        assert_eq!(read_packings(folder.path(), &solve).unwrap(), Vec::new(), "not finished");
    }
}
