//! The stiffness of a track whose supports are in given phases.

use crate::linalg::banded::BandedFactor;
use crate::solvers::track::mesh::Track;
use crate::solvers::track::support::SupportPhase;

/// Factors the stiffness for the phases of the supports; fails with the row of a mechanism.
pub(super) fn factor(track: &Track, phases: &[SupportPhase]) -> Result<BandedFactor, usize> {
    let mut stiffness = track.stiffness.clone();
    for (sleeper, phase) in track.sleepers.iter().zip(phases) {
        stiffness.add(sleeper.unknown, sleeper.unknown, -sleeper.lacking_stiffness(*phase));
    }
    let carried = track.carried.iter().flat_map(|c| [Some(c.underside), c.pitch]).flatten();
    track.held.iter().map(|(unknown, _)| *unknown).chain(carried).for_each(|unknown| stiffness.pin(unknown));
    stiffness.factor().map_err(|e| e.row)
}

/// Computes `y -= K u` for the phases of the supports, without the reactions of the held unknowns.
pub(super) fn subtract_stiffness(track: &Track, phases: &[SupportPhase], u: &[f64], y: &mut [f64]) {
    track.stiffness.subtract_product(u, y);
    for (sleeper, phase) in track.sleepers.iter().zip(phases) {
        y[sleeper.unknown] += sleeper.lacking_stiffness(*phase) * u[sleeper.unknown];
    }
}
