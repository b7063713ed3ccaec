//! Sets sleepers down on a bed and lets them come to rest under their own weight.

use super::super::bed::Bed;
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::super::listen::{Answer, unless_stopped};
use super::super::motion::{Pose, Push, WallMotion};
use super::super::rest::{self, Criterion, Fading, Look, Waiting};
use super::super::shape::Shape;
use super::super::stride::Stride;
use super::super::walls::WallId;
use super::calm::{AT_REST, DAMPING, calmed, restless};
use super::description::Sleeper;
use super::error::{Resting, RigError, in_cycle};
use nalgebra::Vector3;
use std::ops::ControlFlow;

/// Sets sleepers down on a bed, each at the level where it touches its first grain, and lets them come to rest under
/// their own weight; their loads are not used. Returns their walls, in the order of the sleepers.
pub fn stand<R: Real, A: Answer>(
    bed: &mut Bed<R>,
    sleepers: &[Sleeper],
    gravity: f64,
    mut tell: impl FnMut(f64) -> A,
) -> Result<Vec<WallId>, RigError> {
    let walls = place(bed, sleepers, gravity);
    until_rest(bed, &walls, (Resting::Sleepers, &AT_REST), |share| tell(share).flow())?;
    Ok(walls)
}

/// Puts the sleepers on the bed, each at the level where it touches its first grain.
pub(super) fn place<R: Real>(bed: &mut Bed<R>, sleepers: &[Sleeper], gravity: f64) -> Vec<WallId> {
    // walls, floor and plate have the last surface; sleepers have it, too
    let surface = bed.laws().surfaces() as u16 - 1;
    let stand = |sleeper: &Sleeper| {
        let [length, width, height] = sleeper.size;
        let [x, y] = sleeper.place;
        let position = Vector3::new(x, y, highest(bed, sleeper) + height / 2.0);
        (Shape::Block { half: Vector3::new(length, width, height) / 2.0 }, Pose { position, ..Pose::default() })
    };
    let blocks: Vec<_> = sleepers.iter().map(stand).collect();
    let walls = blocks.into_iter().zip(sleepers).map(|((shape, pose), sleeper)| {
        let weight = gravity * sleeper.mass;
        bed.add_wall(shape, pose, surface, motion(sleeper, weight, DAMPING, Push::Constant(0.0)))
    });
    walls.collect()
}

/// Motion of a sleeper under its weight, N, and an applied force.
pub(super) fn motion(sleeper: &Sleeper, weight: f64, damping: f64, push: Push) -> WallMotion {
    WallMotion::Loaded { axis: -Vector3::z(), mass: sleeper.mass, weight, damping, push }
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

/// Runs a stage until forces are in balance and the bed carries the sleepers. `tell` receives the progress.
pub(super) fn until_rest<R: Real>(
    bed: &mut Bed<R>,
    walls: &[WallId],
    (stage, criterion): (Resting, &Criterion),
    tell: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<(), RigError> {
    calmed(bed, |bed, stride| {
        let start = bed.time();
        let mut standing = Standing { bed, walls, stage, criterion, stride, fading: Fading::default(), tell };
        rest::until_rest(&mut standing, criterion, start).map(|_| ())
    })
}

/// Sleepers before they are at rest.
struct Standing<'s, R: Real, T> {
    bed: &'s mut Bed<R>,
    walls: &'s [WallId],
    stage: Resting,
    criterion: &'s Criterion,
    stride: Stride,
    fading: Fading,
    tell: T,
}

impl<R: Real, T: FnMut(f64) -> ControlFlow<()>> Waiting<R> for Standing<'_, R, T> {
    type Error = RigError;

    fn bed(&mut self) -> &mut Bed<R> {
        self.bed
    }

    fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        self.stride.run_steps(self.bed, self.walls, steps)
    }

    fn missed(&self) -> f64 {
        uncarried(self.bed, self.walls)
    }

    fn hear(&mut self, look: &Look) -> Result<(), RigError> {
        let times = (look.unbalance / self.criterion.unbalance).max(look.missed / self.criterion.missed);
        unless_stopped((self.tell)(self.fading.share(times)), RigError::Stopped)
    }

    fn restless(&self, look: &Look) -> RigError {
        restless(self.stage, self.criterion.unbalance, look)
    }

    fn failed(&self, failure: Failure) -> RigError {
        in_cycle(0)(failure)
    }
}

/// Largest share of the force on a sleeper that its contacts do not carry.
fn uncarried<R: Real>(bed: &Bed<R>, walls: &[WallId]) -> f64 {
    let of = |wall: &WallId| {
        let wall = bed.wall(*wall);
        let WallMotion::Loaded { weight, push, .. } = wall.motion() else { return 0.0 };
        let force = weight + push.force_at(bed.time());
        if force > 0.0 { (wall.felt().force.z / force - 1.0).abs() } else { 0.0 }
    };
    walls.iter().map(of).fold(0.0, f64::max)
}
