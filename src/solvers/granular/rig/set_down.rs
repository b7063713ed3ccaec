//! Sleepers are set down on a bed, and come to rest under their own weight.

use super::super::bed::Bed;
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::super::measure::unbalance;
use super::super::motion::{Motion, Pose, Push};
use super::super::shape::Shape;
use super::super::stride::Stride;
use super::super::walls::WallId;
use super::{Rig, RigError, Sleeper};
use nalgebra::Vector3;

/// Steps between looks at forces, and looks in a row that must find rest.
pub(super) const LOOK: u64 = 400;
pub(super) const CALM: usize = 3;
/// Force out of balance over the forces that act, mean over all bodies, and share of a sleeper's force that the bed may not carry.
pub(super) const REST: f64 = 2e-3;
pub(super) const CARRIED: f64 = 0.01;
/// Time that it may take, s.
pub(super) const LONGEST: f64 = 6.0;
/// Local damping meanwhile.
pub(super) const DAMPING: f64 = 0.7;
/// Inertia that may be added meanwhile, over all mass: forces at rest do not know it.
pub(super) const ADDED: f64 = 0.2;

/// Puts the sleepers on the bed, each where it touches its first grain.
pub(super) fn place<R: Real>(bed: &mut Bed<R>, rig: &Rig) -> Vec<WallId> {
    // walls, floor and plate are of one surface, the last; sleepers are too
    let surface = bed.laws().surfaces() as u16 - 1;
    let stand = |sleeper: &Sleeper| {
        let [length, width, height] = sleeper.size;
        let [x, y] = sleeper.place;
        let position = Vector3::new(x, y, highest(bed, sleeper) + height / 2.0);
        (Shape::Block { half: Vector3::new(length, width, height) / 2.0 }, Pose { position, ..Pose::default() })
    };
    let blocks: Vec<_> = rig.sleepers.iter().map(stand).collect();
    let walls = blocks.into_iter().zip(&rig.sleepers).map(|((shape, pose), sleeper)| {
        let weight = rig.gravity * sleeper.mass;
        bed.add_wall(shape, pose, surface, motion(sleeper, weight, DAMPING, Push::Constant(0.0)))
    });
    walls.collect()
}

/// Of a sleeper under its weight, N, and a push.
pub(super) fn motion(sleeper: &Sleeper, weight: f64, damping: f64, push: Push) -> Motion {
    Motion::Loaded { axis: -Vector3::z(), mass: sleeper.mass, weight, damping, push }
}

/// Highest point of the grains that reach under a sleeper, m.
fn highest<R: Real>(bed: &Bed<R>, sleeper: &Sleeper) -> f64 {
    let period = bed.domain().period(0);
    let under = |place: [f64; 3], radius: f64| {
        let away = place[0] - sleeper.place[0];
        let along = period.map_or(away, |period| away - period * (away / period).round());
        let across = place[1] - sleeper.place[1];
        along.abs() < sleeper.size[0] / 2.0 + radius && across.abs() < sleeper.size[1] / 2.0 + radius
    };
    bed.pebbles().filter(|p| under(p.place, p.radius)).map(|p| p.place[2] + p.radius).fold(0.0, f64::max)
}

/// Runs until forces are in balance and the bed carries the sleepers. `tell` hears the share of the longest time.
pub(super) fn until_rest<R: Real>(
    bed: &mut Bed<R>,
    walls: &[WallId],
    stage: &'static str,
    mut tell: impl FnMut(f64),
) -> Result<(), RigError> {
    let failed = |failure| RigError::Failure { cycle: 0, failure };
    let (start, damping) = (bed.time(), bed.damping);
    bed.set_damping(DAMPING);
    let stride = Stride::with_added(bed, ADDED).map_err(failed)?;
    let mut calm = 0;
    while calm < CALM {
        stride.run_steps(bed, walls, LOOK).map_err(failed)?;
        let snapshot = bed.snapshot().map_err(failed)?;
        let (unbalance, uncarried) = (unbalance(bed, &snapshot), uncarried(bed, walls));
        calm = if unbalance <= REST && uncarried <= CARRIED { calm + 1 } else { 0 };
        let time = bed.time() - start;
        tell((time / LONGEST).min(1.0));
        if calm < CALM && time > LONGEST {
            return Err(RigError::Restless { stage, unbalance, limit: REST, uncarried, time });
        }
    }
    bed.unscale_masses();
    bed.set_damping(damping);
    Ok(())
}

/// Largest share of the force on a sleeper that its contacts do not carry.
fn uncarried<R: Real>(bed: &Bed<R>, walls: &[WallId]) -> f64 {
    let of = |wall: &WallId| {
        let wall = bed.wall(*wall);
        let Motion::Loaded { weight, push, .. } = wall.motion() else { return 0.0 };
        let force = weight + push.at(bed.time());
        if force > 0.0 { (wall.felt().force.z / force - 1.0).abs() } else { 0.0 }
    };
    walls.iter().map(of).fold(0.0, f64::max)
}

/// A failure in a cycle.
pub(super) fn in_cycle(cycle: u64) -> impl Fn(Failure) -> RigError {
    move |failure| RigError::Failure { cycle, failure }
}
