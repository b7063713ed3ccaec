//! Start and end of a passage, and its time steps.

use super::blocks::WITH_TRAINS;
use super::{Draft, Pass, accuracy};
use crate::diag::{Code, Diagnostic};
use crate::graph::{AdaptiveSteps, PassagePlan};
use crate::scenario::{Direction, Given, Loading, Scenario, TimeStep, Train};
use crate::schema::Reads;
use crate::units::number;

/// Distance between wheels and the ends of the model if the track is long enough, m: about three decay lengths of the
/// static deflection (methods: 1.6 .. 2.7 m).
const MARGIN: f64 = 6.0;
/// The least distance, m.
const LEAST_MARGIN: f64 = 1.0;
/// Default time step, s: forty steps per period of the wheel on its contact spring (about 230 Hz).
const TIME_STEP: f64 = 1e-4;
/// The longest adaptive step, s, and the number of times that it may be halved.
const LONGEST_STEP: f64 = 4e-4;
const HALVINGS: u32 = 5;
/// Default interval of histories, s.
const SAMPLE: f64 = 5e-4;

/// Fields of a passage, and fields that act only under a train.
const READS: Reads = Reads {
    fields: &[
        "solve.integrator",
        "solve.time_step",
        "solve.start",
        "solve.finish",
        "record.every",
        "track.irregularity",
        "pad.damping",
        "pad.damping_time",
        "slab.foundation_damping_time",
    ],
    acts_where: WITH_TRAINS,
};

/// Chooses start and end of passages, and their time steps.
pub(super) struct Passages;

impl Pass for Passages {
    fn name(&self) -> &'static str {
        "passage"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&READS]
    }

    fn acts(&self, scenario: &Scenario) -> bool {
        matches!(scenario.loading, Some(Loading::Traffic(_))) && scenario.track.has_rails()
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let Some(Loading::Traffic(traffic)) = &draft.scenario.loading else { return };
        if !self.acts(draft.scenario) {
            return;
        }
        if *draft.scenario.solve.gravity <= 0.0 {
            draft.diagnostics.push(weightless(draft.scenario));
            return;
        }
        let plans: Vec<Option<PassagePlan>> =
            traffic.trains().map(|train| plan(draft, train, traffic.is_mixed())).collect();
        draft.passages = plans.into_iter().collect::<Option<_>>().unwrap_or_default();
    }
}

fn weightless(scenario: &Scenario) -> Diagnostic {
    let message = "`gravity` is 0: trains have no weight, and wheels do not stay on the rail";
    let mistake = Diagnostic::new(Code::E0618, message).help("write `gravity = 9.81 m/s^2`, or leave it out");
    match scenario.solve.gravity.origin.span() {
        Some(span) => mistake.label(span, "no weight"),
        None => mistake,
    }
}

/// The passage of a train; with `named` the decisions state the name of the train.
fn plan(draft: &mut Draft<'_>, train: &Train, named: bool) -> Option<PassagePlan> {
    let (first, scenario) = (draft.decisions.len(), draft.scenario);
    let (left, right) = ends(draft, scenario, train)?;
    let (time_step, adaptive) = match scenario.solve.time_step {
        TimeStep::Adaptive { tolerance } => varying_steps(draft, train, (*tolerance, LONGEST_STEP)),
        _ => match accuracy::steps(scenario) {
            Some(steps) => varying_steps(draft, train, steps),
            None => (time_step(draft, scenario, train)?, None),
        },
    };
    for decision in draft.decisions[first..].iter_mut().filter(|_| named) {
        decision.what = format!("train `{}`: {}", train.name, decision.what);
    }
    let every = scenario.records.iter().filter_map(|r| r.every).map(|every| *every).reduce(f64::min).unwrap_or(SAMPLE);
    let sample_every = (every / time_step).round().max(1.0) as u64;
    Some(PassagePlan { left, right, time_step, adaptive, integrator: scenario.solve.integrator, sample_every })
}

/// Chainage of the hindmost wheel at the left and of the foremost one at the right.
fn ends(draft: &mut Draft<'_>, scenario: &Scenario, train: &Train) -> Option<(f64, f64)> {
    let track = &scenario.track;
    let (start, end) = (track.start(), track.end());
    let length = end - start;
    let base = train.wheel_base();
    let room = length - base;
    if room < 4.0 * LEAST_MARGIN {
        let span = train.vehicles[0].bogie_spacing.origin.span();
        let mut mistake = Diagnostic::new(
            Code::E0503,
            format!(
                "train `{}` is {} m long from first to last wheel, and the track of {} m is too short for it",
                train.name,
                number(base),
                number(length)
            ),
        )
        .help(format!("make the track at least {} m long", number((base + 4.0 * MARGIN).ceil())));
        if let Some(span) = span {
            mistake = mistake.label(span, "bogie spacing of its first vehicle");
        }
        draft.diagnostics.push(mistake);
        return None;
    }
    let margin = MARGIN.min(room / 4.0);
    let (mut left, mut right) = (start + margin, end - margin);
    // `start` and `finish` are places of the leading wheel
    let forward = train.direction != Direction::Backward;
    let (at_left, at_right) = if forward {
        (scenario.solve.start, scenario.solve.finish)
    } else {
        (scenario.solve.finish, scenario.solve.start)
    };
    let behind = |given: Given, leading_is_right: bool| {
        if leading_is_right { (*given - base, *given) } else { (*given, *given + base) }
    };
    for (given, left_end) in [(at_left, true), (at_right, false)] {
        let Some(given) = given else { continue };
        let (hindmost, foremost) = behind(given, forward);
        if hindmost < start + 1e-9 || foremost > end - 1e-9 {
            let mut mistake = Diagnostic::new(
                Code::E0501,
                format!(
                    "the train's wheels would stand from {} m to {} m, the track reaches from {} m to {} m",
                    number(hindmost),
                    number(foremost),
                    number(start),
                    number(end)
                ),
            );
            if let Some(span) = given.origin.span() {
                mistake = mistake.label(span, "place of the leading wheel");
            }
            draft.diagnostics.push(mistake);
            return None;
        }
        if left_end { left = hindmost } else { right = foremost }
    }
    if right - left < base + LEAST_MARGIN {
        let mut mistake = Diagnostic::new(
            Code::E0503,
            format!("the passage is too short: the train would run {} m", number((right - left - base).max(0.0))),
        );
        for (given, text) in [(scenario.solve.start, "starts here"), (scenario.solve.finish, "ends here")] {
            if let Some(span) = given.and_then(|g| g.origin.span()) {
                mistake = mistake.label(span, text);
            }
        }
        draft.diagnostics.push(mistake);
        return None;
    }
    draft.decide(
        "passage",
        format!(
            "wheels run from {} m to {} m; all wheels are on the track from the start",
            number(left),
            number(right)
        ),
        format!(
            "every wheel stays at least {} m away from the ends of the rail",
            number((left - start).min(end - right))
        ),
    );
    Some((left, right))
}

/// Time in which a wheel crosses the shortest element, s.
fn transit(draft: &Draft<'_>, train: &Train) -> f64 {
    let spacing = draft.scenario.track.shortest_bay();
    spacing / f64::from(draft.elements_per_bay) / *train.speed
}

/// The longest adaptive step, at most `most` (s), and the parameters of the adaptive steps.
fn varying_steps(draft: &mut Draft<'_>, train: &Train, (tolerance, most): (f64, f64)) -> (f64, Option<AdaptiveSteps>) {
    let longest = most.min(transit(draft, train) / 4.0);
    let shortest = longest / f64::from(1u32 << HALVINGS);
    draft.decide(
        "time step",
        format!("{} to {} ms", number(shortest * 1e3), number(longest * 1e3)),
        "halved if the motion changes within a step, doubled if the motion is smooth",
    );
    (longest, Some(AdaptiveSteps { tolerance, halvings: HALVINGS }))
}

fn time_step(draft: &mut Draft<'_>, scenario: &Scenario, train: &Train) -> Option<f64> {
    let (speed, transit) = (*train.speed, transit(draft, train));
    let element = transit * speed;
    if let Some(given) = scenario.solve.time_step.fixed() {
        if *given > transit {
            let mut mistake = Diagnostic::new(
                Code::E0603,
                format!(
                    "a wheel runs {} m in one step, more than one element of {} m",
                    number(*given * speed),
                    number(element)
                ),
            )
            .help(format!("write `time_step = {} s` or less", number(transit / 10.0)));
            if let Some(span) = given.origin.span() {
                mistake = mistake.label(span, "too coarse");
            }
            draft.diagnostics.push(mistake);
            return None;
        }
        return Some(*given);
    }
    let step = TIME_STEP.min(transit / 10.0);
    draft.decide(
        "time step",
        format!("{} ms", number(step * 1e3)),
        "a tenth of the time in which a wheel crosses an element, and at most 0.1 ms for the contact of wheel and rail",
    );
    Some(step)
}
