//! The support of each sleeper: the support that the scene states, or the support computed from the layers under the
//! seat by the method of `solve`. All later steps read it from the plan.

use super::foundation::{Carried, Foundations};
use super::{Draft, Pass};
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::{Rejected, SupportNode};
use crate::scenario::{Base, Foot, Given, Scenario, Seat, Stack, Support, Track};
use crate::solvers::foundation::{FoundationError, Method};

/// Computes the support of every seat, once for each plan.
pub(super) struct Supports;

impl Pass for Supports {
    fn name(&self) -> &'static str {
        "supports"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let scenario = draft.scenario;
        if !scenario.track.has_rails() {
            // the bed carries the sleepers of a test rig
            return;
        }
        let carried = carried(scenario);
        draft.diagnostics.extend(refusals(&scenario.track, &carried));
        draft.supports = nodes(&scenario.track, &carried);
        let Some(what) = done(&scenario.track) else { return };
        let [taken, other] = match scenario.solve.support_method {
            Method::StressCone => ["the stress cone", "layered elasticity"],
            Method::LayeredElastic { .. } => ["layered elasticity", "the stress cone"],
        };
        let rejected = Rejected::new(other, "`support_method` selects the other method");
        let why = "the layers under these sleepers are known";
        draft.decide_against(self.name(), format!("{what}, by {taken}"), why, vec![rejected]);
    }
}

/// Effect of the layers on the supports of a track; `None` if they change none.
fn done(track: &Track) -> Option<String> {
    let count = |of: fn(&Seat) -> bool| track.seats.iter().filter(|seat| of(seat)).count();
    match (count(stands_on_layers), count(goes_with_layers)) {
        (0, 0) => None,
        (made, 0) => Some(format!("the layers give the stiffness of {made} supports")),
        (0, scaled) => Some(format!("the layers change the stated stiffness of {scaled} supports")),
        (made, scaled) => Some(format!("the layers give the stiffness of {made} supports and change that of {scaled}")),
    }
}

/// Support from the layers of each seat; `None` if the layers or their moduli are not known.
type OfSeats = Vec<Option<Result<Carried, FoundationError>>>;

fn carried(scenario: &Scenario) -> OfSeats {
    let track = &scenario.track;
    let mut foundations = Foundations::new(scenario.solve.support_method, track.bed.base == Base::Quiet);
    let stacks: Vec<&Stack> = track.seats.iter().filter_map(|seat| seat.stack.as_ref()).collect();
    let mut found = foundations.carried(&stacks).into_iter();
    track.seats.iter().map(|seat| seat.stack.as_ref().and_then(|_| found.next())).collect()
}

/// Whether the layers give the support of the sleeper, without a stated support.
pub(super) fn stands_on_layers(seat: &Seat) -> bool {
    matches!(seat.foot, Foot::Sleeper { support: None, .. }) && seat.stack.is_some()
}

/// Whether the stated support is scaled with the layers that a stretch has put under the seat.
fn goes_with_layers(seat: &Seat) -> bool {
    seat.stack.as_ref().is_some_and(|stack| stack.before.is_some())
}

/// The supports of a scene, one for each seat, as in the plan.
pub fn supports(scenario: &Scenario) -> Vec<SupportNode> {
    nodes(&scenario.track, &carried(scenario))
}

/// The same scene with every known support as a stated number, for callers that change supports.
pub fn with_stated_supports(scenario: &Scenario) -> Scenario {
    let mut stated = scenario.clone();
    for (seat, carried) in stated.track.seats.iter_mut().zip(carried(scenario)) {
        let found = support(seat, carried.and_then(Result::ok));
        if let Foot::Sleeper { support, .. } = &mut seat.foot {
            *support = found;
        }
        if let Some(stack) = &mut seat.stack {
            stack.before = None;
        }
    }
    stated
}

fn nodes(track: &Track, carried: &OfSeats) -> Vec<SupportNode> {
    let node = |(seat, carried): (&Seat, &Option<Result<Carried, FoundationError>>)| {
        let carried = carried.and_then(Result::ok);
        let support = support(seat, carried);
        SupportNode {
            spring: support.as_ref().map(|support| support.below(seat.usp())),
            support: support.as_ref().map(|support| support.below(None)),
            settlement: *seat.initial_settlement,
            onto_subgrade: carried.map(|carried| carried.onto_subgrade),
            law: seat.own_law().map(|own| own.law),
        }
    };
    track.seats.iter().zip(carried).map(node).collect()
}

/// The support under a sleeper: the stated support, scaled with the layers, or the support from the layers.
fn support(seat: &Seat, carried: Option<Carried>) -> Option<Support> {
    if !seat.is_ballasted() {
        return None;
    }
    if let Some(stated) = seat.support() {
        let by = carried.map_or(1.0, |carried| carried.change);
        let scaled = |given: Given| if by == 1.0 { given } else { Given { value: by * *given, ..given } };
        return Some(Support {
            stiffness: scaled(stated.stiffness),
            damping: scaled(stated.damping),
            ..stated.clone()
        });
    }
    let (stack, carried) = (seat.stack.as_ref()?, carried?);
    let stiffness = Given::derived(carried.stiffness);
    let damping = Given { value: *stack.damping_time * *stiffness, origin: stack.damping_time.origin };
    Some(Support { stiffness, damping, seating: None })
}

/// Diagnostics for layers that cannot carry the sleepers on them, one for each stack of layers.
fn refusals(track: &Track, carried: &OfSeats) -> Vec<Diagnostic> {
    let mut told: Vec<Span> = Vec::new();
    let mut found = Vec::new();
    for (seat, carried) in track.seats.iter().zip(carried) {
        let (Some(stack), Some(Err(wrong))) = (&seat.stack, carried) else { continue };
        if (stands_on_layers(seat) || goes_with_layers(seat)) && !told.contains(&stack.span) {
            told.push(stack.span);
            found.push(carry_nothing(track, seat, stack, wrong));
        }
    }
    found
}

fn carry_nothing(track: &Track, seat: &Seat, stack: &Stack, wrong: &FoundationError) -> Diagnostic {
    let place = match track.transitions.get(seat.transition) {
        Some(transition) if track.transitions.len() > 1 => format!("seat {:+} of `{}`", seat.number, transition.name),
        _ => format!("seat {:+}", seat.number),
    };
    let form = &track.sections[seat.section].name;
    Diagnostic::new(
        Code::E0407,
        format!("the layers of trackform `{form}` cannot carry the sleeper at {place}: {wrong}"),
    )
    .label(stack.span, "the support is computed from these layers")
    .help("give every layer a thickness and a modulus there, and make the spacing larger than the width of a sleeper")
}
