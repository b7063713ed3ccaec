//! Extreme scenes: a passage gives a correct result, or an error with place and time.

use super::scenes::*;
use crate::solvers::track::*;

/// Mean of the total wheel force over a passage, divided by the weight; the largest and smallest wheel force, divided
/// by the static force.
struct Outcome {
    mean: f64,
    most: f64,
    least: f64,
}

fn pass(
    model: TrackModel,
    level: &TrackLevel,
    vehicle: Vehicle,
    dt: f64,
    speed: f64,
    ends: (f64, f64),
) -> Result<Outcome, TrackError> {
    let stepper = stepper(model, dt, 0.85);
    let still = vehicle.mass() * 9.81 / 4.0;
    let direction = if ends.1 > ends.0 { Direction::Forward } else { Direction::Backward };
    let train = Train::single(vehicle, direction);
    let run = Run { train: &train, start: ends.0, finish: ends.1, motion: &Motion::Constant(speed) };
    let (mut sum, mut count) = (0.0, 0);
    let mut outcome = Outcome { mean: 0.0, most: 0.0, least: f64::INFINITY };
    let mut look = |view: &StepView<'_>| {
        for force in view.wheel_forces() {
            assert!(force.is_finite());
            (sum, count) = (sum + force / still, count + 1);
            outcome.most = outcome.most.max(force / still);
            outcome.least = outcome.least.min(force / still);
        }
    };
    Passage::new(&stepper, level, run)?.run(&mut look)?;
    Ok(Outcome { mean: sum / f64::from(count), ..outcome })
}

/// Every scene runs, no wheel force is negative, and the mean of the wheel forces is the weight.
#[test]
fn harsh_scenes_are_sound() {
    let plain = || transition(45, 20);
    let level = |model: &TrackModel| hollow(model, 2e-3, 1e-3, -3.0, 2.4);
    let undamped = {
        let mut model = plain();
        for seat in &mut model.seats {
            seat.pad_damping = 0.0;
            if let Foot::Sleeper { support_damping, .. } = &mut seat.foot {
                *support_damping = 0.0;
            }
        }
        model.slabs[0].foundation_damping = 0.0;
        model
    };
    let loose = Vehicle { primary_damping: 0.0, secondary_damping: 0.0, ..wagon() };
    let mut stiff_slab = plain();
    stiff_slab.slabs[0].bending_stiffness *= 1e3;
    stiff_slab.slabs[0].foundation_stiffness *= 1e3;
    let hanging = TrackLevel { settlements: vec![20e-3; 65], ends: [0.0; 2] };
    let mut step = TrackLevel::as_built(&plain());
    step.settlements[..40].iter_mut().for_each(|s| *s = 20e-3);
    step.ends[0] = 20e-3;
    let usual = || (plain(), level(&plain()), wagon());
    let here = (-14.0, 4.0);
    let scenes = [
        ("no damper anywhere", (undamped, level(&plain()), loose), 1e-4, 55.56, here),
        ("all sleepers hang", (plain(), hanging, wagon()), 1e-4, 55.56, here),
        ("a step of 20 mm", (plain(), step, wagon()), 1e-4, 55.56, here),
        (
            "contact 100 times stiffer",
            (plain(), level(&plain()), Vehicle { hertz: 100e11, ..wagon() }),
            1e-4,
            55.56,
            here,
        ),
        ("slab 1000 times stiffer", (stiff_slab, level(&plain()), wagon()), 1e-4, 55.56, here),
        ("300 km/h", usual(), 1e-4, 83.33, here),
        ("steps of 5 ms", usual(), 5e-3, 55.56, here),
        ("steps of 1 ms", usual(), 1e-3, 55.56, here),
        ("steps of 1 us", usual(), 1e-6, 55.56, (-14.0, -13.5)),
        ("from the left end", usual(), 1e-4, 55.56, (-27.6 + 6.77 + 1.78, 4.0)),
        ("to the left end", usual(), 1e-4, 55.56, (-14.0, -27.6)),
        ("to the right end", usual(), 1e-4, 55.56, (4.0, 12.0)),
    ];
    for (name, (model, level, vehicle), dt, speed, ends) in scenes {
        match pass(model, &level, vehicle, dt, speed, ends) {
            Ok(o) => {
                println!("{name}: mean {:.4}, {:.3} .. {:.3} of the static wheel force", o.mean, o.least, o.most);
                assert!(o.least >= 0.0 && (o.mean - 1.0).abs() < 0.1, "{name}");
            }
            Err(error) => panic!("{name}: {error}"),
        }
    }
}

/// A growing motion is stopped when it passes the limits.
#[test]
fn growth_is_found_early() {
    let model = ballast(40);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, 1e-4, 0.85);
    let train = Train::single(wagon(), Direction::Forward);
    let run = Run { train: &train, start: 10.0, finish: 20.0, motion: &Motion::Constant(50.0) };
    let mut passage = Passage::new(&stepper, &level, run).unwrap();
    let middle = stepper.track().rail[80];
    passage.velocity[middle] = 1e6;
    let error = passage.run(&mut ()).unwrap_err();
    let TrackError::Unstable { step: 1, x, .. } = error else { panic!("{error}") };
    assert!((0.0..24.0).contains(&x));
    assert!(error.to_string().contains("shorter step"), "{error}");
}
