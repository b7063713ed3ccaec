//! The runs that a study needs next, by those that are stored: first the least repeats of every point, then round after
//! round one further packing of each point that is not decided yet.

use super::outcome::PointOutcome;
use super::perform::Repeat;
use super::{Answer, Plan};

/// What follows on the stored runs.
#[derive(Debug, Clone, PartialEq)]
pub enum Next {
    /// Runs by the place of their point and their repeat.
    Run(Vec<(usize, u32)>),
    /// The runs of every point that the answer is made of.
    Done(Vec<Vec<Repeat>>),
}

/// What follows on the stored runs of every point, each without a gap. The rounds are played again from the first, so
/// that a study that was killed in a round decides as if it had not been.
pub fn next(plan: &Plan, stored: &[Vec<Repeat>]) -> Next {
    let least = plan.study.repeats.least;
    let mut used: Vec<usize> = vec![least as usize; stored.len()];
    loop {
        let missing = |(point, used): (usize, &usize)| {
            (stored[point].len()..*used).map(|repeat| (point, repeat as u32)).collect::<Vec<_>>()
        };
        let missing: Vec<(usize, u32)> = used.iter().enumerate().flat_map(missing).collect();
        if !missing.is_empty() {
            return Next::Run(missing);
        }
        let runs = || stored.iter().zip(&used).map(|(runs, used)| &runs[..*used]);
        let open = Answer::new("", plan, runs().map(PointOutcome::gathered).collect()).open();
        if open.is_empty() {
            return Next::Done(runs().map(<[Repeat]>::to_vec).collect());
        }
        open.into_iter().for_each(|point| used[point] += 1);
    }
}

impl Next {
    /// Number of points with missing runs.
    pub fn points(&self) -> usize {
        let Next::Run(missing) = self else { return 0 };
        let mut points: Vec<usize> = missing.iter().map(|(point, _)| *point).collect();
        points.dedup();
        points.len()
    }
}
