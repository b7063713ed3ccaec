//! The time steps of passages, factored once for a track.

use crate::graph::{AdaptiveSteps, Blocks};
use crate::solvers::track::{Ladder, Passage, Run, Scheme, Stepper, Track, TrackError, TrackLevel};
use std::sync::Arc;

/// The time steps of all passages, factored once.
pub enum Steps {
    Even(Stepper),
    Chosen { ladder: Ladder, tolerance: f64 },
}

impl Steps {
    fn new(track: &Arc<Track>, scheme: Scheme, adaptive: Option<AdaptiveSteps>) -> Result<Self, TrackError> {
        Ok(match adaptive {
            None => Steps::Even(Stepper::new(track.clone(), scheme)?),
            Some(AdaptiveSteps { tolerance, halvings }) => {
                Steps::Chosen { ladder: Ladder::new(track, scheme, halvings as usize)?, tolerance }
            }
        })
    }

    /// A passage in these steps.
    pub fn begin<'a>(&'a self, level: &'a TrackLevel, run: Run<'a>) -> Result<Passage<'a>, TrackError> {
        match self {
            Steps::Even(stepper) => Passage::new(stepper, level, run),
            Steps::Chosen { ladder, tolerance } => Passage::adaptive(ladder, level, run, *tolerance),
        }
    }
}

/// The steps of every kind of train; those that take the same ones share their factors.
pub(super) fn steps_of_kinds(blocks: &Blocks, track: &Arc<Track>) -> Result<Vec<Arc<Steps>>, TrackError> {
    let mut steps: Vec<Arc<Steps>> = Vec::new();
    let plans: Vec<_> = blocks.kinds().map(|(_, plan)| (plan.integrator, plan.time_step, plan.adaptive)).collect();
    for (kind, plan) in plans.iter().enumerate() {
        let (integrator, time_step, adaptive) = *plan;
        steps.push(match plans[..kind].iter().position(|earlier| earlier == plan) {
            Some(same) => steps[same].clone(),
            None => Arc::new(Steps::new(track, integrator.scheme(time_step)?, adaptive)?),
        });
    }
    Ok(steps)
}
