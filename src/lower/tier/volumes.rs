//! Volumes of grains under a track in which passages are recorded.

use super::refused::waits;
use crate::diag::Diagnostic;
use crate::graph::{BedPlan, GrainStretch, InVolume, SensorNode, SensorVolume, VolumeUnderTrack};
use crate::scenario::response::Response;
use crate::scenario::{Scenario, Volume, VolumeRecord};

/// A volume under each recorded seat that stands on grains. `every` is the interval of histories, s.
pub(super) fn volumes(
    scenario: &Scenario,
    beds: &[BedPlan],
    stretches: &[GrainStretch],
    every: f64,
) -> Vec<VolumeUnderTrack> {
    let seats = scenario.volumes.iter().flat_map(|record| record.seats.iter().map(move |seat| (record, *seat)));
    let volume = |(record, seat): (&VolumeRecord, usize)| {
        let stands = |stretch: &GrainStretch| stretch.sleepers.iter().any(|sleeper| sleeper.seat == seat);
        let stretch = stretches.iter().position(stands)?;
        let GrainStretch { bed, start, copies, .. } = &stretches[stretch];
        let [cell, width] = beds[*bed].numbers().plan;
        Some(VolumeUnderTrack {
            sensor: sensor(scenario, record, seat, (*start, [cell * f64::from(*copies), width])),
            seat,
            stretch,
            quantities: record.quantities.iter().filter_map(|quantity| InVolume::named(quantity.name())).collect(),
            after: record.after.clone(),
            every: record.every.unwrap_or(every),
        })
    };
    seats.filter_map(volume).collect()
}

/// The volume under a seat. `start` is the chainage at which the bed begins, `bed` its length and width, m. The volume
/// lies below the rail seat, or beside it if the sides of the bed are too near.
fn sensor(scenario: &Scenario, record: &VolumeRecord, seat: usize, (start, bed): (f64, [f64; 2])) -> SensorNode {
    let track = &scenario.track;
    let seat = &track.seats[seat];
    let top = track.sections[seat.section].layers.first().map_or(0.0, |layer| layer.thickness.value_at(seat.x));
    let depth = record.depth.unwrap_or(top / 2.0);
    let (reach, volume) = match record.volume {
        Volume::Sphere { radius } => (radius, SensorVolume::Sphere { radius }),
        Volume::Box { along, across, height } => {
            (across.unwrap_or(bed[1]) / 2.0, SensorVolume::Block { along, across, height })
        }
    };
    let half = seat.sleeper.map_or(0.0, |sleeper| sleeper.seat_distance / 2.0);
    let y = half.min(bed[1] - reach).max(reach.min(bed[1] / 2.0));
    let name = format!("{} at {} mm", track.seat_name(seat), (depth * 1e3).round());
    SensorNode { name, x: seat.x, place: [seat.x - start, y, depth], volume, bed }
}

/// Diagnostic for a response that passages over grains cannot record.
pub(super) fn refusals(scenario: &Scenario) -> Option<Diagnostic> {
    let record = scenario.volumes.iter().find(|record| record.quantities.contains(&Response::Porosity))?;
    let message = "this version cannot record `porosity` under a track".to_owned();
    Some(waits(message, record.span, "leave out `porosity`; only a test rig records it"))
}
