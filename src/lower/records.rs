//! Histories that a run keeps if the scene has no `record`: the histories of the figures of the report, at sleepers
//! beside each transition and in the far field, before the first and after the last axle.

use super::{Draft, Pass, cost};
use crate::graph::{History, Record, Schedule};
use crate::scenario::{self, Loading, Track};

/// Seats counted from a transition (paper, 4.1): far field, the dip, its edges, the slab's edge and the slab.
const SEATS: [i32; 6] = [-13, -5, -3, -1, 1, 7];
/// Histories are kept only while a wheel is nearer to the seat than this, m; on a long track a seat is at rest most of
/// the time.
const NEAR: f64 = 12.0;
/// Number of transitions with default histories; further transitions of the same form show the same.
const TRANSITIONS: usize = 2;

const QUANTITIES: [History; 6] = [
    History::RailDisplacement,
    History::RailMoment,
    History::RailSeatLoad,
    History::ContactForce,
    History::SleeperVelocity,
    History::SleeperAcceleration,
];

/// Takes the records of the scene; if it has none, adds the histories that the report shows.
pub(super) struct Records;

impl Pass for Records {
    fn name(&self) -> &'static str {
        "record"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        self.choose(draft);
        if let (Some(Schedule::Blocks(blocks)), Some(known)) = (&draft.schedule, &mut draft.cost) {
            cost::with_records(known, blocks, &draft.records);
        }
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(only_asked_for)
    }
}

impl Records {
    fn choose(&self, draft: &mut Draft<'_>) {
        only_asked_for(draft);
        let Some(Loading::Traffic(traffic)) = &draft.scenario.loading else { return };
        let track = &draft.scenario.track;
        let seats = telling_seats(track);
        if !draft.scenario.records.is_empty() || seats.is_empty() {
            return;
        }
        let names: Vec<String> = seats.iter().map(|seat| track.seat_name(&track.seats[*seat])).collect();
        let what = format!("histories at seats {} before the first and after the last axle", names.join(", "));
        let after = vec![0, *traffic.total];
        draft.records = vec![Record { quantities: QUANTITIES.to_vec(), seats, after, near: Some(NEAR) }];
        draft.decide(self.name(), what, "the scene has no `record`, and the report shows these histories");
    }
}

/// Uses only the records of the scene.
fn only_asked_for(draft: &mut Draft<'_>) {
    draft.records = draft.scenario.records.iter().map(record).collect();
}

/// The recorded quantities that vary during a passage; tables hold the other quantities.
fn record(record: &scenario::Record) -> Record {
    Record {
        quantities: record.quantities.iter().filter_map(|quantity| History::named(quantity.name())).collect(),
        seats: record.seats.clone(),
        after: record.after.clone(),
        near: record.near,
    }
}

/// Indices of the existing seats of [`SEATS`]; the middle seat of a track without transitions.
fn telling_seats(track: &Track) -> Vec<usize> {
    if track.transitions.is_empty() {
        return if track.seats.is_empty() { vec![] } else { vec![track.seats.len() / 2] };
    }
    let index = |transition, number| track.seats.iter().position(|s| s.transition == transition && s.number == number);
    let first = 0..track.transitions.len().min(TRANSITIONS);
    first.flat_map(|transition| SEATS.iter().filter_map(move |number| index(transition, *number))).collect()
}
