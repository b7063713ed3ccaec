//! Walls with a mass, against closed forms.

use nalgebra::Vector3;
use std::f64::consts::TAU;
use trackbed::solvers::granular::motion::Push;
use trackbed::solvers::granular::*;

/// N/m of the contact, kg of the wall.
const STIFFNESS: f64 = 1e6;
const MASS: f64 = 100.0;
/// s; 300 of them a swing.
const STEP: f64 = TAU / 100.0 / 300.0;

fn elastic() -> ContactLaws {
    ContactLaws::single(ContactLaw::Linear(Linear {
        normal_stiffness: STIFFNESS,
        shear_stiffness: 0.0,
        friction: 0.0,
        dashpot: Dashpot::Ratio { normal: 0.0, shear: 0.0 },
        mode: DashpotMode::default(),
        limit: FrictionLimit::default(),
    }))
}

fn loaded(weight: f64, damping: f64, push: Push) -> WallMotion {
    WallMotion::Loaded { axis: -Vector3::z(), mass: MASS, weight, damping, push }
}

/// A block whose base touches a sphere that stays where it is, without a force.
fn on_a_spring(motion: WallMotion) -> (Bed<f64>, WallId) {
    let mut bed: Bed<f64> = Bed::new(Domain::open(), elastic());
    let sphere = bed.add_sphere(&Sphere { centre: [0.0, 0.0, -0.05], radius: 0.05, density: 2700.0, surface: 0 });
    bed.fix(sphere);
    let shape = Shape::block(Vector3::new(0.1, 0.1, 0.1)).unwrap();
    let pose = Pose { position: Vector3::new(0.0, 0.0, 0.1), ..Pose::default() };
    let wall = bed.add_wall(shape, pose, 0, motion);
    bed.set_time_step(STEP);
    (bed, wall)
}

fn depth(bed: &Bed<f64>, wall: WallId) -> f64 {
    0.1 - bed.wall(wall).pose(bed.domain()).position.z
}

#[test]
fn a_wall_that_touches_nothing_falls_freely() {
    let mut bed: Bed<f64> = Bed::new(Domain::open(), elastic());
    let shape = Shape::block(Vector3::new(0.1, 0.1, 0.1)).unwrap();
    let wall = bed.add_wall(shape, Pose::default(), 0, loaded(9.81 * MASS, 0.0, Push::Constant(0.0)));
    bed.set_time_step(1e-3);
    bed.run(1000).unwrap();
    // g dt^2 (1 + 2 + ... + n): the speed of the start stands half a step early
    let fallen = -bed.wall(wall).pose(bed.domain()).position.z;
    assert!((fallen / (9.81e-6 * 500.0 * 1001.0) - 1.0).abs() < 1e-12, "{fallen}");
    // what holds it falls with it, and what it had as speed stays
    bed.set_motion(wall, loaded(0.0, 0.0, Push::Constant(0.0)));
    bed.run(1000).unwrap();
    let further = -bed.wall(wall).pose(bed.domain()).position.z - fallen;
    assert!((further / 9.81 - 1.0).abs() < 1e-12, "{further}");
}

#[test]
fn on_a_spring_it_swings_with_its_mass_about_where_it_would_rest() {
    let force = 500.0;
    let (mut bed, wall) = on_a_spring(loaded(0.0, 0.0, Push::Constant(force)));
    let mut depths = vec![0.0];
    for _ in 0..3000 {
        bed.step().unwrap();
        depths.push(depth(&bed, wall));
    }
    // x = F/k (1 - cos wt), w = sqrt(k/m) = 100 rad/s: ten swings
    for (step, depth) in depths.iter().enumerate() {
        let phase = TAU * step as f64 / 300.0;
        let expected = force / STIFFNESS * (1.0 - phase.cos());
        assert!((depth - expected).abs() < 0.02 * force / STIFFNESS, "{step}: {depth}, {expected}");
    }
    let most = depths.iter().copied().fold(0.0, f64::max);
    assert!((most / (2.0 * force / STIFFNESS) - 1.0).abs() < 1e-3, "{most}");
}

#[test]
fn damped_it_settles_under_weight_and_push() {
    let (mut bed, wall) = on_a_spring(loaded(9.81 * MASS, 0.5, Push::Constant(2000.0)));
    bed.run(20_000).unwrap();
    let expected = (9.81 * MASS + 2000.0) / STIFFNESS;
    assert!((depth(&bed, wall) / expected - 1.0).abs() < 1e-5, "{}", depth(&bed, wall));
    assert!((bed.wall(wall).felt().force.z / (9.81 * MASS + 2000.0) - 1.0).abs() < 1e-5);
}

#[test]
fn a_slow_cyclic_push_is_followed_from_its_lower_force() {
    let (start, frequency) = (1.0, 0.5);
    let push = Push::Cyclic { low: 1000.0, high: 3000.0, frequency, start, ramp: 0.5 };
    let (mut bed, wall) = on_a_spring(loaded(0.0, 0.3, push));
    let mut to = |time: f64| {
        while bed.time() < time {
            bed.step().unwrap();
        }
        STIFFNESS * depth(&bed, wall)
    };
    for (time, force) in [(0.5, 0.0), (0.75, 500.0), (1.0, 1000.0), (2.0, 3000.0), (2.5, 2000.0), (3.0, 1000.0)] {
        let felt = to(time);
        assert!((felt - force).abs() < 20.0, "at {time} s: {felt} N, {force} N");
    }
}

#[test]
fn it_gives_a_grain_the_momentum_that_it_loses() {
    let mut bed: Bed<f64> = Bed::new(Domain::open(), elastic());
    let sphere = bed.add_sphere(&Sphere { centre: [0.0, 0.0, -0.06], radius: 0.05, density: 2700.0, surface: 0 });
    let shape = Shape::block(Vector3::new(0.1, 0.1, 0.1)).unwrap();
    let pose = Pose { position: Vector3::new(0.0, 0.0, 0.1), ..Pose::default() };
    let down = WallMotion::Velocity { linear: Vector3::new(0.0, 0.0, -1.0), angular: Vector3::zeros() };
    let wall = bed.add_wall(shape, pose, 0, down);
    bed.set_time_step(1e-5);
    bed.set_motion(wall, loaded(0.0, 0.0, Push::Constant(0.0)));
    bed.run(5000).unwrap();
    let grain = bed.body_state(sphere);
    let of_wall = bed.wall(wall).velocity().0[2];
    assert!(((MASS * of_wall + grain.mass * grain.velocity[2]) / -MASS - 1.0).abs() < 1e-9);
    // elastic: they part as fast as they met
    assert!((grain.velocity[2] - of_wall + 1.0).abs() < 1e-3, "{} {of_wall}", grain.velocity[2]);
}

#[test]
fn pushes_that_cannot_be_are_refused() {
    let table = |times: &[f64], forces: &[f64]| Push::Table { times: times.to_vec(), forces: forces.to_vec() };
    for (push, said) in [
        (Push::Constant(f64::NAN), "applied force"),
        (table(&[], &[]), "times of an applied force"),
        (table(&[0.0, 1.0], &[0.0]), "number of applied forces"),
        (table(&[1.0, 0.0], &[0.0, 1.0]), "each above the time before it"),
        (Push::Cyclic { low: 0.0, high: 1.0, frequency: -1.0, start: 0.0, ramp: 0.0 }, "frequency"),
    ] {
        let refused = loaded(0.0, 0.0, push).check().unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}");
    }
    let massless =
        WallMotion::Loaded { axis: -Vector3::z(), mass: 0.0, weight: 0.0, damping: 0.0, push: Push::Constant(1.0) };
    assert!(massless.check().unwrap_err().to_string().contains("mass of a wall"));
    let push = table(&[1.0, 2.0], &[10.0, 30.0]);
    assert_eq!([0.0, 1.0, 1.5, 2.0, 9.0].map(|t| push.force_at(t)), [10.0, 10.0, 20.0, 30.0, 30.0]);
}
