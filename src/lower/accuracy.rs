//! Mesh, time steps and blocks that follow from the `tolerance` of a scene: as coarse as this error of settlement
//! allows, where the scene does not state them. A scene without `tolerance` has the fine settings of the language.
//!
//! The constants are read from whole runs, `trackbed chart FILE --of run` (docs/validation.md, "Whole runs").

use super::dry_run::as_built;
use super::outlook::Outlook;
use super::{Draft, Pass, track};
use crate::graph::{Blocks, Compared, PassagePlan, Rejected, Update};
use crate::scenario::{Beam, Loading, Origin, Scenario, TimeStep};
use crate::schema::Reads;
use crate::units::{number, percent, rounded_down};

/// Elements a bay of a rail without shear: two of them change wheel forces, seat loads and rail moments by at most
/// 0.2 %; a single one misses the rail moment by 11 %.
const ELEMENTS: u32 = 2;
/// Least tolerance for which they are enough.
const COARSE: f64 = 0.005;

/// Error / largest settlement by the dynamic part of the forces, which does not follow the settlement within a block:
/// at most half of the error limit of a block, and no more than this (`benches/tolerances.py`).
const OF_DYNAMICS: f64 = 1.5e-3;

/// Error of a step / tolerance, and the longest step at a tolerance of 1 %, s. The error of forces grows with the
/// square of the step.
const OF_STEPS: f64 = 0.02;
const LONGEST: f64 = 4e-4;
/// The longest step at any tolerance, s: an eighth of the period of a sleeper between pad and support.
const ANY_LONGEST: f64 = 8e-4;

/// Axles / all axles after which a passage is compared with a finer one, when sleepers hang already; difference of both
/// / tolerance above which the finer ones are taken.
const OF_AXLES: f64 = 0.1;
const OF_PASSAGES: f64 = 0.1;

/// How often the error limit of a block is halved until the expected error of the run is within the tolerance.
const HALVINGS: u32 = 6;

/// The field that all other settings follow from.
const READS: Reads = Reads {
    fields: &["solve.tolerance"],
    acts_where: "where trains run and `solve` does not state `update_every`, `time_step` or `elements_per_bay`",
};

/// The error of settlement / largest settlement that the scene allows, if it states one. Passages over grains cost
/// little beside the grains and keep their fine settings.
fn stated(scenario: &Scenario) -> Option<f64> {
    let grains = &scenario.solve.grains;
    let is_stated = grains.tolerance.origin != Origin::Default && !grains.tier.has_grains();
    (is_stated && matches!(scenario.loading, Some(Loading::Traffic(_)))).then_some(*grains.tolerance)
}

/// Tolerance of a step and the longest step (s) of a scene that states a tolerance and no step.
pub(super) fn steps(scenario: &Scenario) -> Option<(f64, f64)> {
    let tolerance = stated(scenario).filter(|_| scenario.solve.time_step == TimeStep::Auto)?;
    Some((OF_STEPS * tolerance, ANY_LONGEST.min(LONGEST * (tolerance / 0.01).sqrt())))
}

/// Expected error of a run by a law / its largest settlement, by blocks and steps: the errors of the blocks on a track
/// at rest, the dynamic part, and the steps. `None` if the blocks are prescribed, because only the run can tell their
/// error.
pub(super) fn expected(blocks: &Blocks, outlook: &Outlook) -> Option<f64> {
    let (limit, _) = blocks.adaptive()?;
    let settled = Some(outlook.settled).filter(|settled| *settled > 0.0)?;
    let of_steps = |plan: &PassagePlan| match plan.adaptive {
        Some(steps) => 0.2 * steps.tolerance,
        None => 0.2 * OF_STEPS * 0.01 * (plan.time_step / LONGEST).powi(2),
    };
    let steps = blocks.kinds().map(|(_, plan)| of_steps(plan)).fold(0.0, f64::max);
    Some(outlook.error / settled + OF_DYNAMICS.min(0.5 * limit / settled) + steps)
}

/// Chooses the elements of the rail.
pub(super) struct Mesh;

impl Mesh {
    fn elements(scenario: &Scenario) -> Option<u32> {
        let solve = &scenario.solve;
        let is_open = solve.elements_per_bay.origin == Origin::Default;
        // a rail with shear has a kink over each seat, and short waves of the level need short elements
        let is_smooth = *solve.beam == Beam::Euler && scenario.track.irregularity.is_none();
        (is_open && is_smooth && stated(scenario)? >= COARSE).then_some(ELEMENTS)
    }
}

impl Pass for Mesh {
    fn name(&self) -> &'static str {
        "mesh"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&READS]
    }

    /// The pass that chooses the steps acts in every scene with trains, so this one also speaks for it.
    fn acts(&self, scenario: &Scenario) -> bool {
        Mesh::elements(scenario).is_some() || steps(scenario).is_some()
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let Some(elements) = Mesh::elements(draft.scenario) else { return };
        let fine = draft.elements_per_bay;
        draft.elements_per_bay = elements;
        let rejected = Rejected::new(format!("{fine} elements per bay"), "they change forces by less than 0.2 %");
        let why = "the scene states a `tolerance`, and the rail bends without shear on a smooth level";
        draft.decide_against(self.name(), format!("{elements} elements per bay"), why, vec![rejected]);
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(|_| ())
    }
}

/// Compares a passage on the way with a finer one.
pub(super) struct Compare;

impl Pass for Compare {
    fn name(&self) -> &'static str {
        "compare"
    }

    fn acts(&self, scenario: &Scenario) -> bool {
        Mesh::elements(scenario).is_some() || steps(scenario).is_some()
    }

    fn run(&self, draft: &mut Draft<'_>) {
        if !self.acts(draft.scenario) {
            return;
        }
        let Some(blocks) = &mut draft.blocks else { return };
        let (after, limit) =
            ((OF_AXLES * blocks.total as f64) as u64, OF_PASSAGES * *draft.scenario.solve.grains.tolerance);
        blocks.compared = Some(Compared { after, limit });
        let what =
            format!("a passage after {after} axles or more beside one with twice the elements and shorter steps");
        let why =
            format!("the run goes on with the finer passages if settlement differs by more than {}", percent(limit));
        draft.decide(self.name(), what, why);
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(|_| ())
    }
}

/// Chooses the error of a block at which forces and settlement are exchanged.
pub(super) struct Exchange;

impl Exchange {
    fn tolerance(scenario: &Scenario) -> Option<f64> {
        stated(scenario).filter(|_| scenario.solve.update_span.is_none())
    }
}

impl Pass for Exchange {
    fn name(&self) -> &'static str {
        "exchange"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&READS]
    }

    fn acts(&self, scenario: &Scenario) -> bool {
        Exchange::tolerance(scenario).is_some()
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let solve = &draft.scenario.solve;
        let (Some(tolerance), Some(mut blocks), true) =
            (Exchange::tolerance(draft.scenario), draft.blocks.clone(), draft.is_sprung())
        else {
            return;
        };
        let Update::Adaptive { tolerance: finest, cap } = solve.update else { return };
        let (node, law) = (track::track(draft), &solve.law.law);
        // too large beside a structure, where sleepers that settle lose load
        let mut limit = tolerance * as_built(&node, &draft.supports, law, &blocks);
        let (mut taken, mut settled) = (limit, 0.0);
        for _ in 0..HALVINGS {
            if limit <= finest {
                return;
            }
            taken = rounded_down(limit);
            blocks.update = Update::Adaptive { tolerance: taken, cap };
            let outlook = Outlook::new(&node, &draft.supports, law, &blocks);
            settled = outlook.settled;
            let fits = expected(&blocks, &outlook).is_none_or(|error| error <= tolerance);
            if fits && taken <= tolerance * settled {
                break;
            }
            limit = (tolerance * settled).min(if fits { limit } else { 0.5 * limit });
        }
        let what = format!("blocks with an error of at most {} mm", number(1e3 * taken));
        let why = format!(
            "{} of {} mm, the expected largest settlement (`tolerance`)",
            percent(taken / settled),
            number(rounded_down(1e3 * settled))
        );
        draft.blocks = Some(blocks);
        draft.decide(self.name(), what, why);
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(|_| ())
    }
}
