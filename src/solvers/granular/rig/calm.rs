//! How what stands on a bed is brought to rest: damped, with inertia added, until forces are in balance.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::rest::{Criterion, Look};
use super::super::stride::{Sharing, Stride};
use super::error::{Resting, RigError, in_cycle};

/// When sleepers are at rest: the bed carries them but for a hundredth of their force.
pub(super) const AT_REST: Criterion =
    Criterion { unbalance: 2e-3, missed: 0.01, every: 400, looks: 3, longest: 6.0, look_first: false };
/// When poured grains are calm enough for the next ones: as a lift of a bed is.
pub(super) const POURED: Criterion = Criterion { unbalance: 0.01, ..AT_REST };
/// Local damping meanwhile.
pub(super) const DAMPING: f64 = 0.7;
/// Inertia that may be added meanwhile, over all mass: forces at rest do not know it.
const ADDED: f64 = 0.2;

/// Does `work` on a bed that is damped and has inertia added, and gives it back as it was.
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
