//! Responses that a run of a plan keeps, with their counts and places. Expectations and studies are checked against
//! them before the run.

use crate::diag::{Code, Diagnostic};
use crate::graph::{BedNode, Clock, Graph, Record, Schedule, VolumeUnderTrack};
use crate::scenario::response::{Expectation, Expression, Measure, Place, Response};
use crate::scenario::{Scenario, Track};

/// Tolerance at the ends of an interval of chainage, m, because places are sums of spacings.
pub const PLACE_TOLERANCE: f64 = 1e-6;

/// The measure of an expression that a run of the graph will not have; `None` if the run has all of them.
pub fn not_kept(expression: &Expression, graph: &Graph, track: &Track) -> Option<String> {
    let (measure, _) = missing(expression, graph, track)?;
    Some(absent(measure, graph.schedule.clock()))
}

/// Message that no value was recorded for a measure; `clock` turns a count into axles or cycles.
pub fn absent(measure: &Measure, clock: fn(u64) -> Clock) -> String {
    let mut text = format!("no value of `{}`", measure.response.name());
    if let Some((from, to)) = measure.over {
        text += &format!(" between {from} m and {to} m");
    }
    if let Some(after) = measure.after {
        text += &format!(" after {}", clock(after));
    }
    text + " was recorded"
}

/// Condition for the response `broken_bonds`.
const BOND: &str = "glued grains: a `granular` with a `bond`, under a track on grains or on a test rig";

/// Expectations of a scene that a run of its plan cannot answer.
pub(super) fn refusals(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let refused = |expectation: &Expectation| {
        let (measure, lack) = expectation.operands.iter().find_map(|e| missing(e, graph, &scenario.track))?;
        let name = measure.response.name();
        let message = match &lack {
            Lack::Response(_) => format!("this run will have no `{name}`"),
            Lack::Count(_) => {
                let count = graph.schedule.clock()(measure.after.unwrap_or_default());
                format!("`{name}` will not be recorded after {count}")
            }
            Lack::Place => format!("`{name}` will not be recorded anywhere on this span"),
            Lack::Record => format!("`{name}` will not be recorded"),
        };
        let help = match lack {
            Lack::Response(needs) => format!("`{name}` needs {needs}"),
            Lack::Count(counts) => {
                let counts: Vec<String> = counts.iter().map(u64::to_string).collect();
                format!(
                    "recorded counts: {}. Use one of these counts, or add the count to `after` of a `record`",
                    counts.join(", ")
                )
            }
            Lack::Place => "use a longer span, or a span with recorded seats".to_owned(),
            Lack::Record => format!("add `record {{ quantities = [{name}], at = ... }}`"),
        };
        Some(Diagnostic::new(Code::E0616, message).label(expectation.span, "cannot be answered").help(help))
    };
    scenario.expectations.iter().filter_map(refused).collect()
}

/// Reason why a run has no value of a measure.
enum Lack {
    /// This kind of run never has the response; the text states what the response needs.
    Response(&'static str),
    /// The response is recorded at these counts only.
    Count(Vec<u64>),
    /// No part with the response lies in the span.
    Place,
    /// No `record` asks for the response.
    Record,
}

/// The first measure of an expression for which a run will have no value.
fn missing<'a>(expression: &'a Expression, graph: &Graph, track: &Track) -> Option<(&'a Measure, Lack)> {
    match expression {
        Expression::Number(_) => None,
        Expression::Measure(measure) => lack(measure, graph, track).map(|lack| (measure, lack)),
        Expression::Negate(inner) => missing(inner, graph, track),
        Expression::Function(_, of) => of.iter().find_map(|e| missing(e, graph, track)),
        Expression::Binary(left, _, right) => missing(left, graph, track).or_else(|| missing(right, graph, track)),
    }
}

fn lack(measure: &Measure, graph: &Graph, track: &Track) -> Option<Lack> {
    match &graph.schedule {
        Schedule::Actuators(tests) => {
            let (bed, actuators) = graph.bed_under_actuators()?;
            match measure.response {
                Response::BrokenBonds => (!graph.has_bonds()).then_some(Lack::Response(BOND)),
                _ => lack_of_tests(measure, bed, actuators.cycles, &tests.kept),
            }
        }
        Schedule::Blocks(blocks) => lack_on_track(measure, graph, track, &blocks.recorded),
        Schedule::Static { .. } => lack_on_track(measure, graph, track, &[0]),
        // another program knows the responses of its own schedule
        Schedule::Custom { .. } => None,
    }
}

/// Reason why a track has no value of a measure. A track keeps tables at the recorded counts, and the histories of each
/// `record`.
fn lack_on_track(measure: &Measure, graph: &Graph, track: &Track, counts: &[u64]) -> Option<Lack> {
    let response = measure.response;
    let trains = graph.blocks().is_some();
    let ballasted = graph.supports.iter().any(|support| support.spring.is_some());
    let needs = match response.place() {
        Place::Volume if !graph.volumes().is_empty() => return lack_in_volumes(measure, graph),
        Place::Volume => Some("grains: a test rig, or a track on grains, whose `record` has a `volume`"),
        Place::Wheel if !trains => Some("trains: `traffic`"),
        Place::Rail if !trains && response == Response::RailStiffness => Some("trains: `traffic`"),
        Place::Scene => match response {
            Response::SettlementStep if track.transitions.is_empty() => Some("a transition between two sections"),
            Response::SettlementStep | Response::LevelChangeWheelbase | Response::LevelChange3m if !trains => {
                Some("trains: `traffic`")
            }
            Response::BrokenBonds if !graph.has_bonds() => Some(BOND),
            Response::FarFieldSettlement | Response::DifferentialSettlement | Response::VoidedSleepers
                if !ballasted =>
            {
                Some("sleepers on supports that are not rigid")
            }
            _ => None,
        },
        Place::Seat if response == Response::SubgradePressure => {
            let known = graph.supports.iter().any(|support| support.onto_subgrade.is_some());
            (!known).then_some("`layers` under the sleepers")
        }
        _ => None,
    };
    if let Some(needs) = needs {
        return Some(Lack::Response(needs));
    }
    if response.place() != Place::Seat {
        return off_the_counts(measure, counts);
    }
    let inside = |seat: &usize| track.seats.get(*seat).is_some_and(|seat| covers(measure, seat.x));
    if !has_a_column(response) {
        let named = |record: &&Record| record.quantities.iter().any(|history| history.name() == response.name());
        let records: Vec<&Record> = graph.records.iter().filter(named).collect();
        if records.is_empty() {
            return Some(Lack::Record);
        }
        let there: Vec<&Record> = records.into_iter().filter(|record| record.seats.iter().any(inside)).collect();
        let mut counts: Vec<u64> = there.iter().flat_map(|record| record.after.iter().copied()).collect();
        counts.sort_unstable();
        counts.dedup();
        return if there.is_empty() { Some(Lack::Place) } else { off_the_counts(measure, &counts) };
    }
    let any_seat = (0..track.seats.len()).any(|seat| inside(&seat));
    if any_seat { off_the_counts(measure, counts) } else { Some(Lack::Place) }
}

/// Reason why volumes of grains under a track have no value of a measure.
fn lack_in_volumes(measure: &Measure, graph: &Graph) -> Option<Lack> {
    let name = measure.response.name();
    let keeps = |volume: &&VolumeUnderTrack| volume.quantities.iter().any(|quantity| quantity.name() == name);
    let keeping: Vec<&VolumeUnderTrack> = graph.volumes().iter().filter(keeps).collect();
    let there: Vec<&&VolumeUnderTrack> = keeping.iter().filter(|volume| covers(measure, volume.sensor.x)).collect();
    let mut counts: Vec<u64> = there.iter().flat_map(|volume| volume.after.iter().copied()).collect();
    counts.sort_unstable();
    counts.dedup();
    match (keeping.is_empty(), there.is_empty()) {
        (true, _) => Some(Lack::Record),
        (_, true) => Some(Lack::Place),
        _ => off_the_counts(measure, &counts),
    }
}

fn off_the_counts(measure: &Measure, counts: &[u64]) -> Option<Lack> {
    measure.after.filter(|after| !counts.contains(after)).map(|_| Lack::Count(counts.to_vec()))
}

fn covers(measure: &Measure, x: f64) -> bool {
    measure.over.is_none_or(|(a, b)| x >= a.min(b) - PLACE_TOLERANCE && x <= a.max(b) + PLACE_TOLERANCE)
}

/// Reason why a test rig has no value of a measure. A rig keeps the responses of sleepers in every cycle, and the
/// responses of volumes in the recorded cycles.
fn lack_of_tests(measure: &Measure, bed: &BedNode, cycles: u64, kept: &[u64]) -> Option<Lack> {
    match measure.response {
        Response::ContactPressure if bed.plate.is_some() => {
            Some(Lack::Response("sleepers: a plate has no `contact_pressure`"))
        }
        Response::BallastStress | Response::BallastVelocity | Response::CoordinationNumber | Response::Porosity => {
            if bed.sensors.is_empty() {
                Some(Lack::Record)
            } else {
                off_the_counts(measure, kept)
            }
        }
        Response::ContactForce
        | Response::ContactPressure
        | Response::Settlement
        | Response::SleeperDisplacement
        | Response::SleeperVelocity
        | Response::SupportStiffness => {
            let every = measure.after.is_none_or(|after| (1..=cycles).contains(&after));
            if every { None } else { Some(Lack::Count(vec![1, cycles])) }
        }
        _ => Some(Lack::Response("rails and trains: this is a test rig")),
    }
}

/// Whether `sleepers.csv` holds a value of every seat at every recorded count; other responses come from histories.
fn has_a_column(response: Response) -> bool {
    response.place() == Place::Seat && !matches!(response, Response::SleeperVelocity | Response::SleeperAcceleration)
}
