//! The same passage with the leapfrog and with implicit steps.

use super::*;

/// Seat loads and sleeper displacements of some seats every millisecond.
type History = Vec<[f64; 2]>;

const SEATS: std::ops::Range<usize> = 12..28;

const DURATION: f64 = 0.09;

const SAMPLE: f64 = 1e-3;

fn by_passage(model: &TrackModel, level: &TrackLevel, train: &Train, time_step: f64) -> History {
    let track = Arc::new(Track::new(model.clone()).unwrap());
    let stepper = Stepper::new(track, Scheme::newmark(time_step).unwrap()).unwrap();
    let run = Run { train, start: 10.0, finish: 10.0 + 1.001 * SPEED * DURATION, motion: &Motion::Constant(SPEED) };
    let every = (SAMPLE / time_step).round() as usize;
    let mut history = History::new();
    let mut look = |view: &StepView<'_>| {
        if view.is_on_grid(every) && view.step() as f64 * time_step < DURATION + 1e-9 {
            history.extend(SEATS.map(|seat| [view.seat_load(seat), view.foot_displacement(seat)]));
        }
    };
    Passage::new(&stepper, level, run).unwrap().run(&mut look).unwrap();
    history
}

/// The same passage, from its start, with the leapfrog; `outside`: with springs that push as external forces.
fn by_leapfrog(model: &TrackModel, level: &TrackLevel, train: &Train, time_step: f64, outside: bool) -> History {
    let stepper = stepper(model.clone(), time_step, 0.85);
    let run = Run { train, start: 10.0, finish: 16.0, motion: &Motion::Constant(SPEED) };
    let start = Passage::new(&stepper, level, run).unwrap();
    let of_leapfrog = if outside { carried(model.clone()) } else { model.clone() };
    let mut leapfrog = leapfrog(&of_leapfrog, level, time_step);
    leapfrog.start_from(&start, train, 10.0);
    let mut springs = Springs::under(model, level);
    let offsets: Vec<f64> = train.wheel_positions(0.0).collect();
    let (every, steps) = ((SAMPLE / time_step).round() as usize, (DURATION / time_step).round() as usize);
    let mut history = History::new();
    let given = matches!(train.vehicles[0].0.wheels[0].contact, WheelContact::Given(_));
    for step in 0..=steps {
        let pushes = if outside { springs.push(&leapfrog) } else { &[] };
        if given {
            let x = 10.0 + SPEED * step as f64 * time_step;
            let wheels: Vec<(f64, f64)> = offsets.iter().map(|offset| (x + offset, LIGHT)).collect();
            leapfrog.step(pushes, &WheelLoads::Given(&wheels)).unwrap();
        } else {
            leapfrog.step(pushes, &WheelLoads::Riding).unwrap();
        }
        if step % every == 0 {
            let view = leapfrog.view();
            history.extend(SEATS.map(|seat| [view.seat_load(seat), view.foot_displacement(seat)]));
        }
    }
    history
}

/// Largest difference of seat loads and of displacements, divided by the largest value.
fn difference(a: &History, b: &History) -> [f64; 2] {
    assert_eq!(a.len(), b.len());
    [0, 1].map(|k| {
        let largest = b.iter().fold(0.0f64, |m, b| m.max(b[k].abs()));
        a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a[k] - b[k]).abs())) / largest
    })
}

/// The limit of histories with steps Δt and Δt/2 and an error that falls with the square of the step.
fn extrapolated(coarse: &History, fine: &History) -> History {
    coarse.iter().zip(fine).map(|(c, f)| [0, 1].map(|k| f[k] + (f[k] - c[k]) / 3.0)).collect()
}

/// Forces at which no sleeper lifts off, N.
const LIGHT: f64 = 30e3;

fn forces() -> Train {
    let vehicles = [0.0, 1.78].map(|offset| (Multibody::moving_force(LIGHT), offset)).to_vec();
    Train { vehicles, direction: Direction::Forward }
}

fn shown([load, displacement]: [f64; 2]) -> String {
    format!("{load:.1e} of seat loads, {displacement:.1e} of displacements")
}

/// Errors of the leapfrog with steps of 40, 20 and 10 us compared with the passage with shorter steps, in seat loads
/// and displacements; and the difference between both, extrapolated from 20 and 10 us.
fn converges(model: &TrackModel, train: &Train, outside: bool) -> ([[f64; 2]; 3], [f64; 2]) {
    let level = TrackLevel::as_built(model);
    let passages = [20e-6, 10e-6, 5e-6].map(|dt| by_passage(model, &level, train, dt));
    let reference = extrapolated(&passages[1], &passages[2]);
    println!("passage at 20 us: {}", shown(difference(&passages[0], &reference)));
    let found = [40e-6, 20e-6, 10e-6].map(|dt| by_leapfrog(model, &level, train, dt, outside));
    let errors = found.each_ref().map(|history| difference(history, &reference));
    for pair in errors.windows(2) {
        let orders = [0, 1].map(|k| (pair[0][k] / pair[1][k]).log2());
        println!("{} -> {}: orders {orders:.2?}", shown(pair[0]), shown(pair[1]));
    }
    let apart = difference(&extrapolated(&found[1], &found[2]), &extrapolated(&passages[0], &passages[1]));
    println!("extrapolated: {}", shown(apart));
    (errors, apart)
}

/// If no sleeper lifts off: order 2 in the step, 1e-6 of the displacements at 20 us, extrapolated equal to the passage.
/// Dampers of pads respond to the fastest bending of the rail, which a step of 10 us does not resolve: 1e-5 of the seat
/// loads.
fn assert_second_order(model: &TrackModel, train: &Train, outside: bool) {
    let (errors, apart) = converges(model, train, outside);
    let order = (errors[1][1] / errors[2][1]).log2();
    assert!((order - 2.0).abs() < 0.05, "{order}");
    assert!(errors[1][0] < 3e-5 && errors[1][1] < 1e-6);
    assert!(apart[0] < 1e-6 && apart[1] < 1e-8);
}

/// A train so light that no sleeper lifts off beside its bogies.
fn light() -> Train {
    Train::single(Vehicle { car_body_mass: 9_000.0, ..wagon() }, Direction::Forward)
}

fn wavy() -> TrackModel {
    let wave = |i: i32| (0.7 * f64::from(i), 0.1e-3 * (1.3 * f64::from(i)).sin());
    TrackModel { irregularity: Irregularity::spline((0..35).map(wave).collect()).unwrap(), ..ballast(40) }
}

#[test]
fn springs_from_outside_under_given_forces() {
    assert_second_order(&ballast(40), &forces(), true);
}

#[test]
fn explicit_supports_under_given_forces() {
    assert_second_order(&ballast(40), &forces(), false);
}

#[test]
fn springs_from_outside_under_a_light_wagon() {
    assert_second_order(&ballast(40), &light(), true);
}

#[test]
fn explicit_supports_under_a_light_wagon_on_waves() {
    assert_second_order(&wavy(), &light(), false);
}

/// Beside a loaded wagon sleepers lift off a little and come down again; then the damper force jumps at the next step:
/// order 1, 5e-5 at 20 us, and the same in both methods.
#[test]
fn a_loaded_wagon() {
    let train = Train::single(wagon(), Direction::Forward);
    for outside in [true, false] {
        let (errors, apart) = converges(&ballast(40), &train, outside);
        assert!(errors[1].iter().all(|error| *error < 1e-4) && errors[2].iter().all(|error| *error < 5e-5));
        assert!(apart[0] < 1e-6 && apart[1] < 1e-8);
    }
}

/// A sleeper that hits its support repeatedly under a wagon: the jump of the damper force at contact gives order 1.
#[test]
fn a_void_converges() {
    let model = ballast(40);
    let mut level = TrackLevel::as_built(&model);
    level.settlements[20] = 0.3e-3;
    let train = Train::single(wagon(), Direction::Forward);
    let passages = [5e-6, 2.5e-6].map(|dt| by_passage(&model, &level, &train, dt));
    println!("passage: {}", shown(difference(&passages[0], &passages[1])));
    let of_void = |history: &History| history.iter().skip(8).step_by(16).map(|seat| seat[1]).collect::<Vec<_>>();
    let down: Vec<bool> = of_void(&passages[1]).iter().map(|u| *u > 0.3e-3).collect();
    assert!(!down[0] && down.contains(&true), "it strikes");
    for microseconds in [40.0, 20.0, 10.0, 5.0] {
        let found = by_leapfrog(&model, &level, &train, 1e-6 * microseconds, true);
        let error = difference(&found, &passages[1]);
        println!("{microseconds} us: {}", shown(error));
        assert!(error[0] < 1e-5 * microseconds && error[1] < 1e-5 * microseconds);
    }
}
