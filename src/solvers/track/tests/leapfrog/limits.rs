//! Steps at their limit, and refused steps.

use super::*;

/// Kinetic energy after steps of a length that is not checked, divided by the energy at the start. Just below the limit
/// a kick causes a long beat.
fn growth(model: &TrackModel, time_step: f64) -> f64 {
    let mut leapfrog = leapfrog(model, &TrackLevel::as_built(model), 1e-6);
    leapfrog.force_time_step(time_step);
    leapfrog.kick(leapfrog.track().sleepers[3].unknown, 1e-6);
    leapfrog.watch();
    let start = leapfrog.energy().unwrap().kinetic;
    for _ in 0..4000 {
        if leapfrog.step(&[], &WheelLoads::None).is_err() {
            return f64::INFINITY;
        }
    }
    leapfrog.energy().unwrap().kinetic / start
}

/// The limit of explicit supports is exact: steps below it are stable, steps above it grow and are refused.
#[test]
fn steps_are_refused_at_their_limit() {
    for (damping, elements) in [(0.0, 4), (50e3, 4), (50e3, 1), (200e3, 4)] {
        let mut model = ballast(8);
        model.elements_per_bay = elements;
        for seat in &mut model.seats {
            seat.pad_damping = 0.0;
            seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: damping, seating: None };
        }
        let track = Arc::new(Track::new(model.clone()).unwrap());
        let level = TrackLevel::as_built(&model);
        let limit = leapfrog(&model, &level, 1e-6).limit().unwrap();
        assert_eq!(limit.contact, Explicit::Support);
        let (below, above) = (growth(&model, 0.998 * limit.time_step), growth(&model, 1.002 * limit.time_step));
        println!("damper {damping}: {:.1} us, below {below:.1e}, above {above:.1e}", 1e6 * limit.time_step);
        assert!(below < 200.0 && above > 1e5);
        assert!(Leapfrog::new(track.clone(), &level, 0.999 * limit.time_step).is_ok());
        let refused = Leapfrog::new(track, &level, 1.001 * limit.time_step).unwrap_err();
        assert!(matches!(refused, TrackError::StepTooLong { .. }), "{refused}");
        assert!(refused.to_string().contains("too long for the support of the sleeper"), "{refused}");
    }
}

/// A wheel on an undamped contact of constant stiffness, over the node at which the effective mass of the rail is
/// smallest.
#[test]
fn wheels_set_a_limit() {
    let mut model = ballast(40);
    model.seats.iter_mut().for_each(|seat| seat.pad_damping = 0.0);
    let level = TrackLevel::as_built(&model);
    let contact = WheelContact::Linear { stiffness: 1.5e9, damping: 0.0 };
    let train = Train::single(Multibody::sprung_wheel(9e3, 1e6, 1e4, 600.0, contact), Direction::Forward);
    let mut leapfrog = leapfrog(&carried(model.clone()), &level, 1e-6);
    leapfrog.ride(&train, &Motion::Constant(1.0), -1.0).unwrap();
    let limit = leapfrog.limit().unwrap();
    assert_eq!(limit.contact, Explicit::Wheel);
    let refused = leapfrog.set_time_step(1.001 * limit.time_step).unwrap_err();
    assert!(matches!(refused, TrackError::StepTooLong { .. }), "{refused}");
    leapfrog.set_time_step(0.999 * limit.time_step).unwrap();

    let stepper = stepper(model.clone(), 1e-4, 0.85);
    let run = Run { train: &train, start: limit.x, finish: limit.x + 1.0, motion: &Motion::Constant(1e-3) };
    let passage = Passage::new(&stepper, &level, run).unwrap();
    let spread = |ratio: f64| {
        let mut leapfrog = self::leapfrog(&model, &level, 1e-6);
        leapfrog.start_from(&passage, &train, limit.x);
        leapfrog.force_time_step(ratio * limit.time_step);
        let mut most = 0.0f64;
        for _ in 0..4000 {
            match leapfrog.step(&[], &WheelLoads::Riding) {
                Ok(()) => most = most.max(leapfrog.view().wheel_forces().sum::<f64>()),
                Err(_) => return f64::INFINITY,
            }
        }
        most / (9600.0 * 9.81)
    };
    let (below, above) = (spread(0.99), spread(1.02));
    println!("limit {:.2} us at {} m: below {below:.4}, above {above:.1e}", 1e6 * limit.time_step, limit.x);
    assert!(below < 1.01 && above > 10.0);
}

#[test]
fn what_cannot_be_is_refused() {
    let model = carried(ballast(20));
    let level = TrackLevel::as_built(&model);
    let track = Arc::new(Track::new(model.clone()).unwrap());
    let unsupported = Stepper::new(track.clone(), Scheme::newmark(1e-4).unwrap()).unwrap_err();
    assert!(unsupported.to_string().contains("give it a support"), "{unsupported}");
    let mut leapfrog = Leapfrog::new(track, &level, 1e-5).unwrap();
    let pushes = vec![0.0; 20];
    assert!(leapfrog.step(&pushes[1..], &WheelLoads::None).is_err());
    assert!(leapfrog.step(&pushes, &WheelLoads::Riding).is_err());
    assert!(leapfrog.step(&pushes, &WheelLoads::Given(&[(f64::NAN, 1.0)])).is_err());
    assert!(leapfrog.step(&pushes, &WheelLoads::Given(&[(-3.0, 1e5), (99.0, 1e5)])).is_ok());
    assert!(leapfrog.view().on_rail().is_empty());
    assert!(leapfrog.set_time_step(0.0).is_err() && leapfrog.set_drag(-1.0).is_err());
    let train = Train::single(wagon(), Direction::Forward);
    assert!(leapfrog.ride(&train, &Motion::Constant(SPEED), 5.0).is_err());
    let mut wild = pushes.clone();
    wild[4] = f64::NAN;
    assert!(matches!(leapfrog.step(&wild, &WheelLoads::None), Err(TrackError::Unstable { .. })));
    for pad in
        [UnderPad { mass: 0.0, stiffness: 1e8, damping: 0.0 }, UnderPad { mass: 5.0, stiffness: 1e8, damping: -1.0 }]
    {
        let mut broken = model.clone();
        broken.seats[2].foot = Foot::Carried { mass: 150.0, pad: Some(pad), pitch: None };
        assert!(matches!(Track::new(broken), Err(TrackError::Model { flaw: Flaw::UnderPad, .. })));
    }
}
