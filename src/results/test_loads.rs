//! Records of seats under test loads: one state at rest with the loads, one without.

use super::HistoryRow;
use crate::graph::{History, Record};
use crate::nodes::Unloaded;
use crate::scenario::Track;
use smol_str::SmolStr;

/// Rows of the recorded quantities of a seat, at every seat if a record names no seat. Forces are total values;
/// displacements are measured from the track without the loads. The whole rail is recorded too. There are no
/// velocities.
pub(super) fn at_seats(track: &Track, records: &[Record], unloaded: &Unloaded, loaded: &Unloaded) -> Vec<HistoryRow> {
    let every: Vec<usize> = (0..track.seats.len()).collect();
    let mut rows = Vec::new();
    for record in records {
        let seats = if record.seats.is_empty() { &every } else { &record.seats };
        for quantity in &record.quantities {
            for &seat in seats {
                let (state, rest) = (&loaded.seats[seat], &unloaded.seats[seat]);
                let value = match quantity {
                    History::RailSeatLoad => state.seat_load,
                    History::ContactForce => state.contact_force,
                    History::SleeperDisplacement => state.sleeper_level - rest.sleeper_level,
                    _ => continue,
                };
                rows.push(HistoryRow {
                    axles: 0,
                    time_s: 0.0,
                    quantity: quantity.name().into(),
                    id: track.seat_name(&track.seats[seat]).into(),
                    x_m: track.seats[seat].x,
                    value,
                    train: SmolStr::default(),
                });
            }
        }
    }
    rows
}
