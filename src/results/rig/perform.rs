//! A rig from its scene to its answer: beds are packed, or taken from where they are kept, and each is tested.

use super::super::{Beds, FoundBed, bed_summary};
use super::Tested;
use crate::diag::{Code, Diagnostic};
use crate::lower::{self, RigPlan};
use crate::scenario::Scenario;
use crate::solvers::granular::Bed;
use crate::solvers::granular::packing::{Packed, Progress};
use crate::solvers::granular::rig::{Rig, RigError, StoredTrial, Trial};
use serde::{Deserialize, Serialize};

/// Who follows a rig and may keep what there is; `()` does neither. What it answers with a diagnostic ends the rig.
pub trait Follow {
    /// How far the bed is.
    fn packing(&mut self, _: &Progress) {}

    /// The bed is there.
    fn found(&mut self, _: &FoundBed) {}

    /// A piece of a cycle is over; beside the packings that are done.
    fn piece(&mut self, _: &[Tested], _: &Trial<'_, f32>) -> Result<(), Diagnostic> {
        Ok(())
    }

    /// A packing is done, and another one comes.
    fn tested(&mut self, _: &[Tested]) -> Result<(), Diagnostic> {
        Ok(())
    }
}

impl Follow for () {}

/// What there is of a rig that is not finished.
#[derive(Default, Serialize, Deserialize)]
pub struct Unfinished {
    pub done: Vec<Tested>,
    pub running: Option<StoredTrial<f32>>,
}

/// A rig that has answered: one test for each packing, and the bed of the last as it ended.
pub struct Performed {
    pub plan: RigPlan,
    pub tests: Vec<Tested>,
    pub bed: Bed<f32>,
}

/// Runs a rig from where it was left. Packings after the first have the seeds after that of the scene.
pub fn perform_rig(
    scenario: &Scenario,
    beds: &Beds,
    Unfinished { mut done, mut running }: Unfinished,
    follow: &mut impl Follow,
) -> Result<Performed, Vec<Diagnostic>> {
    let repeats = u64::from(scenario.solve.grains.repeats.max(1));
    let alone = |mistake| vec![mistake];
    loop {
        let mut packing = scenario.clone();
        packing.solve.seed = scenario.solve.seed.wrapping_add(done.len() as u64);
        let plan = lower::rig(&packing)?;
        let found = beds.bed(&plan.bed.recipe, |progress| follow.packing(progress)).map_err(alone)?;
        follow.found(&found);
        let (tested, bed) = test(&packing, &plan, found.packed, running.take(), &done, follow).map_err(alone)?;
        done.push(tested);
        if done.len() as u64 >= repeats {
            return Ok(Performed { plan, tests: done, bed });
        }
        follow.tested(&done).map_err(alone)?;
    }
}

/// Tests a packing, from what was stored of it on.
fn test(
    scenario: &Scenario,
    plan: &RigPlan,
    packed: Packed<f32>,
    running: Option<StoredTrial<f32>>,
    done: &[Tested],
    follow: &mut impl Follow,
) -> Result<(Tested, Bed<f32>), Diagnostic> {
    let bed = bed_summary(&scenario.title, &plan.bed, &packed, None);
    let rig = plan.on(packed.levels.last().copied().unwrap_or_default());
    let mut trial = match running {
        Some(stored) => Trial::restore(stored, &rig)
            .map_err(|error| Diagnostic::new(Code::E0803, error.to_string()).help("run with `--force`"))?,
        None => stand(plan, packed, &rig).map_err(|error| diagnose(&error))?,
    };
    while trial.advance().map_err(|error| diagnose(&error))? {
        follow.piece(done, &trial)?;
    }
    let tested = Tested {
        seed: scenario.solve.seed,
        bed,
        cycles: trial.cycles().to_vec(),
        samples: trial.samples().to_vec(),
        readings: trial.readings().to_vec(),
        specimen: trial.specimen().to_vec(),
        steps: trial.steps(),
    };
    Ok((tested, trial.bed))
}

/// Sleepers, or a plate, at rest on the bed of the whole rig.
fn stand<'a>(plan: &RigPlan, mut packed: Packed<f32>, rig: &'a Rig) -> Result<Trial<'a, f32>, RigError> {
    let failed = |failure| RigError::Failure { cycle: 0, failure };
    let whole = if plan.copies == 1 { packed.bed } else { packed.bed.replicate(plan.copies).map_err(failed)? };
    Trial::new(whole, rig, |_| {})
}

fn diagnose(error: &RigError) -> Diagnostic {
    match error {
        RigError::Restless { .. } => Diagnostic::new(Code::E0811, error.to_string())
            .help("give the `packing` of the material more `pressure`, or its grains more `friction`"),
        _ => Diagnostic::new(Code::E0812, error.to_string()).help("is the `force` meant `per sleeper` or `per seat`?"),
    }
}
