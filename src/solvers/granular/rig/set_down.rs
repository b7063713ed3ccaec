//! Sleepers are set down on a bed, and come to rest under their own weight.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::measure::unbalance;
use super::super::motion::{Motion, Pose, Push};
use super::super::shape::Shape;
use super::super::walls::WallId;
use super::super::watch::Failure;
use super::{Rig, RigError, Sleeper};
use nalgebra::Vector3;

/// Steps between looks at forces, and looks in a row that must find rest.
const LOOK: u64 = 400;
const CALM: usize = 3;
/// Force out of balance over the forces that act, mean over all bodies, and share of a sleeper's force that the bed may not carry.
const REST: f64 = 2e-3;
const CARRIED: f64 = 0.01;
/// Time that it may take, s.
const LONGEST: f64 = 6.0;
/// Local damping meanwhile.
const DAMPING: f64 = 0.7;
/// Share of the stable step of bodies that touch, of what the lightest body bears in a dense bed, and of sqrt(m / k) of a
/// sleeper on its contacts.
const SAFE: f64 = 0.8;
const PRIOR: f64 = 0.25;
const SLEEPER: f64 = 0.2;

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
        bed.add_wall(shape, pose, surface, motion(sleeper, rig.gravity, DAMPING, Push::Constant(0.0)))
    });
    walls.collect()
}

/// Of a sleeper under its weight and a push.
pub(super) fn motion(sleeper: &Sleeper, gravity: f64, damping: f64, push: Push) -> Motion {
    Motion::Loaded { axis: -Vector3::z(), mass: sleeper.mass, weight: gravity * sleeper.mass, damping, push }
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
    let mut calm = 0;
    while calm < CALM {
        bed.set_time_step(longest_step(bed, walls));
        bed.run(LOOK).map_err(failed)?;
        let snapshot = bed.snapshot().map_err(failed)?;
        let (unbalance, uncarried) = (unbalance(bed, &snapshot), uncarried(bed, walls));
        calm = if unbalance <= REST && uncarried <= CARRIED { calm + 1 } else { 0 };
        let time = bed.time() - start;
        tell((time / LONGEST).min(1.0));
        if calm < CALM && time > LONGEST {
            return Err(RigError::Restless { stage, unbalance, limit: REST, uncarried, time });
        }
    }
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

/// Time step that grains and sleepers bear now, s.
pub(super) fn longest_step<R: Real>(bed: &Bed<R>, walls: &[WallId]) -> f64 {
    let of_sleeper = |wall: &WallId| {
        let wall = bed.wall(*wall);
        match wall.motion() {
            Motion::Loaded { mass, .. } if wall.felt().stiffness > 0.0 => (mass / wall.felt().stiffness).sqrt(),
            _ => f64::INFINITY,
        }
    };
    let of_sleepers = walls.iter().map(of_sleeper).fold(f64::INFINITY, f64::min);
    (SAFE * bed.body_time_step()).min(PRIOR * lightest_step(bed)).min(SLEEPER * of_sleepers)
}

/// sqrt(m / k) of the lightest body on one of its contacts, s.
fn lightest_step<R: Real>(bed: &Bed<R>) -> f64 {
    let stiffness = |surface: u16| match bed.laws().get(surface, surface) {
        super::super::Law::Linear(law) => law.normal_stiffness.max(law.shear_stiffness),
        // beds of a scene have linear contacts; others are bounded by the contacts of now alone
        super::super::Law::HertzMindlin(_) => 0.0,
    };
    bed.states().map(|body| (body.mass / stiffness(body.surface)).sqrt()).fold(f64::INFINITY, f64::min)
}

/// A failure in a cycle.
pub(super) fn in_cycle(cycle: u64) -> impl Fn(Failure) -> RigError {
    move |failure| RigError::Failure { cycle, failure }
}
