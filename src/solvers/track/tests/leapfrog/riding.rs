//! Trains that arrive, pass and leave.

use super::*;

/// Three wagons arrive from outside, pass and leave: every wheel begins and ends with its static force.
#[test]
fn a_train_enters_and_leaves() {
    for direction in [Direction::Forward, Direction::Backward] {
        let model = ballast(60);
        let level = TrackLevel::as_built(&model);
        let vehicles = [0.0, 10.3, 20.6].map(|offset| (Multibody::from(wagon()), offset)).to_vec();
        let train = Train { vehicles, direction };
        let mut leapfrog = leapfrog(&model, &level, 25e-6);
        let rest: Vec<f64> = (0..60).map(|seat| leapfrog.view().seat_load(seat)).collect();
        let start = if direction == Direction::Forward { -1.0 } else { model.ends[1] + 1.0 };
        leapfrog.ride(&train, &Motion::Constant(SPEED), start).unwrap();
        let still = wagon().mass() * 9.81 / 4.0;
        let (mut most, mut least, mut passed, mut peaks) = (0.0f64, f64::INFINITY, 0, vec![0.0f64; 60]);
        let mut inside = (f64::INFINITY, 0.0f64);
        while passed < 12 {
            leapfrog.step(&[], &WheelLoads::Riding).unwrap();
            let view = leapfrog.view();
            for force in view.wheel_forces() {
                (most, least) = (most.max(force / still), least.min(force / still));
            }
            for (_, force) in view.on_rail().iter().filter(|(x, _)| (12.0..24.0).contains(x)) {
                inside = (inside.0.min(force / still), inside.1.max(force / still));
            }
            for (seat, peak) in peaks.iter_mut().enumerate() {
                *peak = peak.max(view.seat_load(seat));
            }
            let past = |x: &f64| if start < 0.0 { *x > model.ends[1] + 0.5 } else { *x < -0.5 };
            passed = view.wheel_positions().filter(past).count();
        }
        let view = leapfrog.view();
        println!("wheel forces {least:.4} .. {most:.4}, inside {:.4} .. {:.4}", inside.0, inside.1);
        println!("peaks {:.1} .. {:.1} kN", peaks[20] / 1e3, peaks[30] / 1e3);
        // The clamped end of the rail is stiff, and a wheel meets it at once.
        assert!(least > 0.75 && most < 1.25 && inside.0 > 0.95 && inside.1 < 1.05);
        assert!((peaks[20] / peaks[40] - 1.0).abs() < 0.02 && peaks[30] > 0.3 * still);
        assert!(view.on_rail().is_empty());
        for _ in 0..20_000 {
            leapfrog.step(&[], &WheelLoads::Riding).unwrap();
        }
        let view = leapfrog.view();
        assert!((0..60).all(|seat| (view.seat_load(seat) - rest[seat]).abs() < 1.0));
        assert!(view.wheel_forces().all(|force| (force / still - 1.0).abs() < 0.1));
    }
}

/// A ride that is stopped, saved and restored continues bit by bit the same.
#[test]
fn a_checkpoint_gives_the_same_bits() {
    let model = ballast(30);
    let level = TrackLevel::as_built(&model);
    let train = Train::single(wagon(), Direction::Forward);
    let begin = || {
        let mut leapfrog = leapfrog(&carried(model.clone()), &level, 20e-6);
        leapfrog.ride(&train, &Motion::Constant(SPEED), -0.5).unwrap();
        leapfrog.watch();
        leapfrog
    };
    let run = |leapfrog: &mut Leapfrog, steps: usize| {
        let mut springs = Springs::under(&model, &level);
        for _ in 0..steps {
            leapfrog.step(springs.push(leapfrog), &WheelLoads::Riding).unwrap();
        }
    };
    let mut whole = begin();
    run(&mut whole, 8000);
    let text = serde_json::to_string(whole.state()).unwrap();
    run(&mut whole, 4000);
    let mut resumed = begin();
    resumed.restore(&serde_json::from_str(&text).unwrap()).unwrap();
    run(&mut resumed, 4000);
    assert!(!resumed.view().on_rail().is_empty());
    assert_eq!(serde_json::to_string(whole.state()).unwrap(), serde_json::to_string(resumed.state()).unwrap());
    let mut other = self::leapfrog(&carried(model.clone()), &level, 20e-6);
    assert!(other.restore(whole.state()).is_err(), "the state of a ride in a track without one");
}

/// Beyond absorbing ends the track goes on: a wagon enters and leaves without a jump of its forces, at any level.
#[test]
fn a_wagon_comes_along_the_track_that_goes_on() {
    let mut model = ballast(60);
    model.rail_ends = RailEnds::Absorbing;
    let level = TrackLevel { settlements: vec![3e-3; 60], ends: [3e-3; 2] };
    for direction in [Direction::Forward, Direction::Backward] {
        let mut leapfrog = leapfrog(&model, &level, 20e-6);
        let train = Train::single(wagon(), direction);
        leapfrog.ride(&train, &Motion::Constant(SPEED), leapfrog.approach(direction)).unwrap();
        leapfrog.watch();
        let still = wagon().mass() * 9.81 / 4.0;
        let (mut all, mut inside) = ([f64::INFINITY, 0.0f64], [f64::INFINITY, 0.0f64]);
        while leapfrog.time() < leapfrog.ride_ends().unwrap() {
            leapfrog.step(&[], &WheelLoads::Riding).unwrap();
            let view = leapfrog.view();
            for (x, force) in view.wheel_positions().zip(view.wheel_forces()) {
                let share = force / still;
                all = [all[0].min(share), all[1].max(share)];
                if (8.0..28.0).contains(&x) {
                    inside = [inside[0].min(share), inside[1].max(share)];
                }
            }
        }
        let account = leapfrog.energy().unwrap();
        println!("wheel forces {all:.3?}, inside {inside:.4?}, residual {:.1e} J", account.residual());
        assert!(all[0] > 0.8 && all[1] < 1.2 && inside[0] > 0.98 && inside[1] < 1.02);
        assert!(account.residual().abs() < 1e-9 * account.dissipated);
    }
}

/// The forces of a ride, applied as histories, move the track bit by bit the same: the ride and the iteration use the
/// same model.
#[test]
fn histories_of_a_ride_repeat_it() {
    let mut model = ballast(30);
    model.rail_ends = RailEnds::Absorbing;
    let level = TrackLevel::as_built(&model);
    let [mut ridden, mut given] = [(); 2].map(|()| leapfrog(&carried(model.clone()), &level, 25e-6));
    let [mut springs, mut others] = [(); 2].map(|()| Springs::under(&model, &level));
    let train = Train::single(wagon(), Direction::Backward);
    ridden.ride(&train, &Motion::Constant(SPEED), ridden.approach(Direction::Backward)).unwrap();
    let mut most = 0;
    while ridden.time() < ridden.ride_ends().unwrap() {
        ridden.step(springs.push(&ridden), &WheelLoads::Riding).unwrap();
        let wheels = ridden.view().on_rail().to_vec();
        given.step(others.push(&given), &WheelLoads::Given(&wheels)).unwrap();
        most = most.max(wheels.len());
    }
    assert_eq!(most, 4);
    assert!((0..30).all(|seat| ridden.view().seat_load(seat) == given.view().seat_load(seat)));
    assert!((0..30).all(|foot| ridden.underside(foot) == given.underside(foot)));
}

/// A dip of the running surface makes the wheels lift off the rail; they land again, and no wheel force is negative.
#[test]
fn wheels_lift_off() {
    let mut model = ballast(40);
    let dip = |i: i32| (12.0 + 0.05 * f64::from(i), 4e-3 * (0.05 * std::f64::consts::PI * f64::from(i)).sin().powi(2));
    model.irregularity = Irregularity::spline((0..=20).map(dip).collect()).unwrap();
    let level = TrackLevel::as_built(&model);
    let mut leapfrog = leapfrog(&model, &level, 20e-6);
    leapfrog.ride(&Train::single(wagon(), Direction::Forward), &Motion::Constant(SPEED), -0.1).unwrap();
    let still = wagon().mass() * 9.81 / 4.0;
    let (mut most, mut off) = (0.0f64, 0);
    while leapfrog.time() < leapfrog.ride_ends().unwrap() {
        leapfrog.step(&[], &WheelLoads::Riding).unwrap();
        for (x, force) in leapfrog.view().on_rail() {
            assert!(*force >= 0.0);
            off += usize::from(*force == 0.0 && (12.0..14.0).contains(x));
            most = most.max(force / still);
        }
    }
    println!("{off} steps without contact, at most {most:.2} of the static force");
    assert!(off > 100 && most > 1.5);
    let view = leapfrog.view();
    assert_eq!((view.on_rail().len(), view.wheel_positions().count()), (1, 4));
}
