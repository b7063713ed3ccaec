//! Brings sleepers or grains on a bed to rest: with damping and additional inertia, until forces are in balance.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::rest::{Criterion, Look};
use super::super::stride::{Sharing, Stride};
use super::error::{Resting, RigError, in_cycle};

/// Sleepers at rest: the bed carries all but a hundredth of their force.
pub(super) const AT_REST: Criterion =
    Criterion { unbalance: 2e-3, missed: 0.01, every: 400, looks: 3, longest: 6.0, look_first: false };
/// Poured grains at rest before the next pour: the same limit as for a lift of a bed.
pub(super) const POURED: Criterion = Criterion { unbalance: 0.01, ..AT_REST };
/// Local damping during this.
pub(super) const DAMPING: f64 = 0.7;
/// Additional inertia during this, divided by all mass: forces at rest do not depend on it.
const ADDED: f64 = 0.2;

/// Does `work` on a bed with damping and additional inertia, and then restores the parameters of the bed.
pub(super) fn calmed<R: Real, T>(
    bed: &mut Bed<R>,
    work: impl FnOnce(&mut Bed<R>, Stride) -> Result<T, RigError>,
) -> Result<T, RigError> {
    let damping = bed.damping;
    bed.set_damping(DAMPING);
    let stride = Stride::with_added(bed, Sharing::Even, ADDED).map_err(in_cycle(0))?;
    let done = work(bed, stride)?;
    bed.unscale_masses();
    bed.set_damping(damping);
    Ok(done)
}

/// The error of a stage that has not come to rest.
pub(super) fn restless(stage: Resting, limit: f64, look: &Look) -> RigError {
    let &Look { unbalance, missed: uncarried, time, .. } = look;
    RigError::Restless { stage, unbalance, limit, uncarried, time }
}
