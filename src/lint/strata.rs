//! Common parts of the rules for layers: the layers along a track with trains, and which of them are ballast.

use crate::graph::Graph;
use crate::scenario::{Granular, Layer, Scenario};

/// Half of a ballast by mass is coarser than this, m; sub-ballast of sand and gravel is far finer (EN 13450: sieves of
/// 22.4 mm and more).
const COARSE: f64 = 15e-3;

/// Layers under the sleepers of a section, whole or changed by a stretch.
pub(super) struct Ground {
    pub section: String,
    pub layers: Vec<Layer>,
}

/// The ground of every section with sleepers; none for a rig, because a rig tests its layers.
pub(super) fn grounds(scenario: &Scenario, graph: &Graph) -> Vec<Ground> {
    if graph.track().is_none() {
        return Vec::new();
    }
    let track = &scenario.track;
    let with_sleepers = |section: &usize| track.seats[track.seats_of(*section)].iter().any(|seat| seat.is_ballasted());
    let of_section = |section: usize| {
        let name = &track.sections[section].name;
        track.ground(section).into_iter().map(move |part| Ground { section: name.clone(), layers: part.layers })
    };
    (0..track.sections.len()).filter(with_sleepers).flat_map(of_section).collect()
}

/// Whether grains are as coarse as ballast, before any cut or scaling for a model of grains.
pub(super) fn is_ballast(granular: &Granular) -> bool {
    granular.grading.passing.size(0.5) / *granular.scale >= COARSE
}
