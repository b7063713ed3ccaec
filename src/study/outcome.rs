//! The result of a point: its repeats together.

use super::miss::Miss;
use super::perform::Repeat;

/// The result of a point.
#[derive(Debug, Clone, PartialEq)]
pub enum PointOutcome {
    Done {
        /// Means of the measured values over the repeats, SI, in the order of
        /// [`Study::measured`](crate::scenario::Study::measured).
        values: Vec<f64>,
        /// Standard deviations over the repeats, 0 for one run.
        deviations: Vec<f64>,
        /// The measured values of each repeat; repeats of equal place have equal seeds in all points.
        runs: Vec<Vec<f64>>,
        /// The miss of each constraint in the worst run; `None` if all runs meet it.
        misses: Vec<Option<Miss>>,
    },
    Failed {
        code: Option<String>,
        reason: String,
    },
}

impl PointOutcome {
    /// The result of repeats, in order; if some failed, the first failure.
    pub fn gathered(repeats: &[Repeat]) -> PointOutcome {
        let mut runs: Vec<Vec<f64>> = Vec::new();
        let mut all_misses: Vec<&[Option<Miss>]> = Vec::new();
        for repeat in repeats {
            match repeat {
                Repeat::Failed { code, reason } => {
                    return PointOutcome::Failed { code: code.clone(), reason: reason.clone() };
                }
                Repeat::Done { values, misses } => {
                    runs.push(values.clone());
                    all_misses.push(misses);
                }
            }
        }
        let n = runs.len() as f64;
        let count = runs.first().map_or(0, Vec::len);
        let values: Vec<f64> = (0..count).map(|i| runs.iter().map(|run| run[i]).sum::<f64>() / n).collect();
        let squares = |i: usize| runs.iter().map(|run| (run[i] - values[i]).powi(2)).sum::<f64>();
        let deviations = (0..count).map(|i| (squares(i) / (n - 1.0).max(1.0)).sqrt()).collect();
        let constraints = all_misses.first().map_or(0, |misses| misses.len());
        let worst = |i: usize| all_misses.iter().filter_map(|m| m[i]).max_by(|a, b| a.share.total_cmp(&b.share));
        let misses = (0..constraints).map(worst).collect();
        PointOutcome::Done { values, deviations, runs, misses }
    }
}
