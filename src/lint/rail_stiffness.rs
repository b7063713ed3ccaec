//! The static stiffness at rail level on both sides of a place, by the function that makes the table of a run. It
//! includes the bending of rail and slab, seatings, and sleepers that lift beside the wheel.

use crate::graph::{Graph, LoadedPart, Responses, Schedule};
use crate::solvers::track::{Loads, Track, solve_static, standing_stiffness};

/// Bays of the uniform track that repeats one seat: 24 m to each side, eight decay lengths of a soft track.
const BAYS: usize = 81;
/// Wheel load if the scene has none, N.
const USUAL_LOAD: f64 = 100e3;

/// The force on the rail, N: the heaviest mean wheel load of a train, else the largest test load on the
/// rail.
pub(super) fn load(graph: &Graph) -> f64 {
    let gravity = graph.track().map_or(0.0, |track| track.gravity);
    let heaviest = match &graph.schedule {
        Schedule::Blocks(blocks) => {
            blocks.kinds().map(|(train, _)| train.mean_wheel_mass() * gravity).fold(0.0, f64::max)
        }
        Schedule::Static { loads } => {
            let on_rail = loads.iter().filter(|load| matches!(load.on, LoadedPart::Rail { .. }));
            on_rail.map(|load| load.force).fold(0.0, f64::max)
        }
        _ => 0.0,
    };
    if heaviest > 0.0 { heaviest } else { USUAL_LOAD }
}

/// Stiffness over a seat, N/m, of a uniform track that repeats this seat. `None` if rail, pad or support are not known.
pub(super) fn as_at(graph: &Graph, seat: usize, load: f64) -> Option<f64> {
    let node = graph.track()?.everywhere_as_at(seat, BAYS)?;
    let spring = graph.supports.get(seat).and_then(|support| support.spring);
    if node.seats[0].is_ballasted() && spring.is_none() {
        return None;
    }
    let responses = Responses { revision: 0, seats: vec![spring; BAYS] };
    let level = node.level(&[0.0; BAYS], &responses);
    let track = Track::new(node.model(&responses)).ok()?;
    let unloaded = solve_static(&track, &level, &Loads::default()).ok()?;
    standing_stiffness(&track, &level, &unloaded, load, &[node.seats[BAYS / 2].x]).ok()?.first().copied()
}
