//! Which histories a run keeps where the scene asks for none: those that the report's figures need, at sleepers beside each
//! transition and in the far field, before the first and after the last axle.

use super::Pass;
use crate::scenario::response::Response;
use crate::scenario::{Loading, Record, Scenario, Track};

/// Seats counted from a transition (paper, 4.1): far field, the dip, its edges, the slab's edge and the slab.
const SEATS: [i32; 6] = [-13, -5, -3, -1, 1, 7];
/// Distance of the nearest wheel from which nothing happens at a seat, m: a long track would keep hours of rest.
const NEAR: f64 = 12.0;
/// Transitions that get them; of the same form they show the same.
const TRANSITIONS: usize = 2;

const QUANTITIES: [Response; 6] = [
    Response::RailDisplacement,
    Response::RailMoment,
    Response::RailSeatLoad,
    Response::ContactForce,
    Response::SleeperVelocity,
    Response::SleeperAcceleration,
];

pub(super) fn records(pass: &mut Pass, scenario: &Scenario) -> Vec<Record> {
    let Some(Loading::Traffic(traffic)) = &scenario.loading else { return scenario.records.clone() };
    let seats = telling_seats(&scenario.track);
    if !scenario.records.is_empty() || seats.is_empty() {
        return scenario.records.clone();
    }
    let track = &scenario.track;
    let names: Vec<String> = seats.iter().map(|seat| track.seat_name(&track.seats[*seat])).collect();
    pass.decide(
        "record",
        format!("histories at seats {} before the first and after the last axle", names.join(", ")),
        "the scene has no `record`, and its report shows them",
    );
    vec![Record {
        quantities: QUANTITIES.to_vec(),
        seats,
        after: vec![0, *traffic.total],
        every: None,
        near: Some(NEAR),
        states: false,
    }]
}

/// Indices of the seats, those that exist; the middle one of a track without transitions.
fn telling_seats(track: &Track) -> Vec<usize> {
    if track.transitions.is_empty() {
        return if track.seats.is_empty() { vec![] } else { vec![track.seats.len() / 2] };
    }
    let index = |transition, number| track.seats.iter().position(|s| s.transition == transition && s.number == number);
    let first = 0..track.transitions.len().min(TRANSITIONS);
    first.flat_map(|transition| SEATS.iter().filter_map(move |number| index(transition, *number))).collect()
}
