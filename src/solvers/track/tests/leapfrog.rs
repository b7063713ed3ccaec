//! The leapfrog against closed forms, against passages over the same track, and against itself in other steps.

use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

const SPEED: f64 = 200.0 / 3.6;

/// The same track whose sleepers are carried from outside.
fn carried(mut model: TrackModel) -> TrackModel {
    for seat in &mut model.seats {
        if let Foot::Sleeper { mass, .. } = seat.foot {
            seat.foot = Foot::Carried { mass, pad: None };
        }
    }
    model
}

fn leapfrog(model: &TrackModel, level: &TrackLevel, time_step: f64) -> Leapfrog {
    Leapfrog::new(Arc::new(Track::new(model.clone()).unwrap()), level, time_step).unwrap()
}

/// From 0 to 1 in so many steps, smoothly.
fn gradually(step: usize, steps: usize) -> f64 {
    let t = (step as f64 / steps as f64).min(1.0);
    t * t * t * (10.0 - t * (15.0 - 6.0 * t))
}

/// What springs under the carried feet give: the law of an ordinary support, computed outside.
struct Springs {
    stiffness: f64,
    damping: f64,
    settlements: Vec<f64>,
    pushes: Vec<f64>,
}

impl Springs {
    fn under(model: &TrackModel, level: &TrackLevel) -> Self {
        let seats = model.seats.iter().zip(&level.settlements);
        let settlements: Vec<f64> =
            seats.filter(|(seat, _)| matches!(seat.foot, Foot::Sleeper { .. })).map(|(_, s)| *s).collect();
        Self { stiffness: 50e6, damping: 50e3, pushes: vec![0.0; settlements.len()], settlements }
    }

    fn push(&mut self, leapfrog: &Leapfrog) -> &[f64] {
        for (i, (push, settlement)) in self.pushes.iter_mut().zip(&self.settlements).enumerate() {
            let foot = leapfrog.underside(i);
            let gap = foot.level - settlement;
            let force = self.stiffness * gap + self.damping * foot.present_velocity;
            *push = if gap > 0.0 { force.max(0.0) } else { 0.0 };
        }
        &self.pushes
    }
}

/// Twenty fixed sleepers under 100 kN over one of them: the moment is 17.66 kN m, where published figures are 16 and 19.
#[test]
fn fixed_sleepers() {
    let mut model = ballast(20);
    model.seats.iter_mut().for_each(|seat| seat.foot = Foot::Rigid);
    (model.rail_ends, model.gravity) = (RailEnds::Free, 0.0);
    let x = model.seats[10].x;
    let mut leapfrog = leapfrog(&model, &TrackLevel::as_built(&model), 1e-4);
    leapfrog.set_drag(1000.0).unwrap();
    for step in 0..6000 {
        leapfrog.step(&[], &WheelLoads::Given(&[(x, gradually(step, 2000) * 100e3)])).unwrap();
    }
    let (view, node) = (leapfrog.view(), leapfrog.track().seat_node(10));
    let shares: Vec<f64> = (10..14).map(|seat| view.seat_load(seat) / 1e3).collect();
    let (moment, deflection) = (view.rail_moment(node), view.rail_deflection(node));
    let rest = solve_static(leapfrog.track(), leapfrog.level(), &Loads { rail: &[(x, 100e3)], ..Loads::default() });
    let rest = rest.unwrap();
    println!(
        "{:.3} kN m ({:.3}), {:.4} mm, {shares:.3?} %",
        moment / 1e3,
        rest.rail_moment[node] / 1e3,
        deflection * 1e3
    );
    assert!((moment / 17.66e3 - 1.0).abs() < 1e-3 && (deflection - 0.9498e-3).abs() < 1e-7);
    assert!((moment / rest.rail_moment[node] - 1.0).abs() < 1e-9, "{}", rest.rail_moment[node]);
    for (share, expected) in shares.iter().zip([37.99, 25.10, 8.67, 0.39]) {
        assert!((share - expected).abs() < 0.01, "{share} {expected}");
    }
    let mut moments = vec![0.0; leapfrog.track().nodes().len()];
    view.rail_moments(&mut moments);
    assert_eq!(moments[node], moment);
}

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

/// The same passage, from its start, in the leapfrog; `outside`: with springs that push from outside.
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
            let wheels: Vec<(f64, f64)> = offsets.iter().map(|offset| (x + offset, FORCE)).collect();
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

const FORCE: f64 = 98.1e3;

/// Largest difference of seat loads and of displacements, of the largest value.
fn difference(a: &History, b: &History) -> [f64; 2] {
    assert_eq!(a.len(), b.len());
    [0, 1].map(|k| {
        let largest = b.iter().fold(0.0f64, |m, b| m.max(b[k].abs()));
        a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a[k] - b[k]).abs())) / largest
    })
}

/// The limit of histories in steps of Δt and Δt/2 whose error falls with the square of the step.
fn extrapolated(coarse: &History, fine: &History) -> History {
    coarse.iter().zip(fine).map(|(c, f)| [0, 1].map(|k| f[k] + (f[k] - c[k]) / 3.0)).collect()
}

fn forces() -> Train {
    let vehicles = [0.0, 1.78].map(|offset| (Multibody::moving_force(FORCE), offset)).to_vec();
    Train { vehicles, direction: Direction::Forward }
}

fn shown([load, displacement]: [f64; 2]) -> String {
    format!("{load:.1e} of seat loads, {displacement:.1e} of displacements")
}

/// Errors of the leapfrog in halved steps against the extrapolated passage: in seat loads and in displacements.
fn converges(model: &TrackModel, train: &Train, outside: bool) -> (Vec<[f64; 2]>, [f64; 2]) {
    let level = TrackLevel::as_built(model);
    let passages = [20e-6, 10e-6].map(|dt| by_passage(model, &level, train, dt));
    let reference = extrapolated(&passages[0], &passages[1]);
    println!("passage at 20 us: {}", shown(difference(&passages[0], &reference)));
    let found: Vec<History> = [40e-6, 20e-6, 10e-6].map(|dt| by_leapfrog(model, &level, train, dt, outside)).into();
    let errors: Vec<[f64; 2]> = found.iter().map(|history| difference(history, &reference)).collect();
    let limit = difference(&extrapolated(&found[1], &found[2]), &reference);
    for pair in errors.windows(2) {
        let orders = [0, 1].map(|k| (pair[0][k] / pair[1][k]).log2());
        println!("{} -> {}: orders {orders:.2?}", shown(pair[0]), shown(pair[1]));
    }
    println!("extrapolated: {}", shown(limit));
    (errors, limit)
}

/// Order 2 in the step, 1e-4 at 20 us, 1e-6 extrapolated.
fn assert_converges(model: &TrackModel, train: &Train, outside: bool) {
    let (errors, limit) = converges(model, train, outside);
    for k in [0, 1] {
        let order = (errors[1][k] / errors[2][k]).log2();
        assert!((order - 2.0).abs() < 0.1, "{order}");
        assert!(errors[1][k] < 1e-4 && limit[k] < 1e-6);
    }
}

#[test]
fn springs_from_outside_under_given_forces() {
    assert_converges(&ballast(40), &forces(), true);
}

#[test]
fn explicit_supports_under_given_forces() {
    assert_converges(&ballast(40), &forces(), false);
}

#[test]
fn springs_from_outside_under_a_wagon() {
    assert_converges(&ballast(40), &Train::single(wagon(), Direction::Forward), true);
}

#[test]
fn explicit_supports_under_a_wagon() {
    assert_converges(&ballast(40), &Train::single(wagon(), Direction::Forward), false);
}

/// A sleeper that strikes its support again and again under a wagon: the jump of the damper at contact leaves order 1.
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

/// What forces bring, pads and drag take and the track holds, under forces that move and springs that push.
#[test]
fn energy_is_accounted_for() {
    let model = ballast(40);
    let level = TrackLevel::as_built(&model);
    for drag in [0.0, 30.0] {
        let mut leapfrog = leapfrog(&carried(model.clone()), &level, 20e-6);
        leapfrog.set_drag(drag).unwrap();
        let mut springs = Springs::under(&model, &level);
        leapfrog.step(springs.push(&leapfrog), &WheelLoads::None).unwrap();
        leapfrog.watch();
        for step in 0..5000 {
            let x = 8.0 + SPEED * 20e-6 * f64::from(step);
            leapfrog.step(springs.push(&leapfrog), &WheelLoads::Given(&[(x, FORCE), (x + 1.78, FORCE)])).unwrap();
        }
        let account = leapfrog.energy().unwrap();
        println!("{account:.3?}, residual {:.1e} J", account.residual());
        assert!(account.wheels > 0.0 && account.pushes < 0.0 && account.dissipated > 0.1);
        assert!(account.residual().abs() < 1e-9 * account.dissipated, "found 1e-12");
    }
}

/// Three wagons come from outside, pass and leave: every wheel begins and ends with its static force.
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
        // The clamped end of the rail is a stiff place that a wheel meets at once.
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

/// A ride that is stopped, written down and read back goes on to the same bits.
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

/// Kinetic energy after steps of a length that no check refuses, of the start's. Just below the limit a kick makes a long beat.
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

/// A wheel on an undamped contact of constant stiffness, over the node where the rail is lightest.
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

/// Pads under sleepers and the ground under them yield in series.
#[test]
fn pads_under_sleepers() {
    let (stiff, model) = (150e6, ballast(20));
    let mut padded = model.clone();
    for seat in &mut padded.seats {
        seat.foot = Foot::Carried { mass: 145.0, pad: Some(UnderPad { mass: 5.0, stiffness: stiff, damping: 10e3 }) };
    }
    let level = TrackLevel::as_built(&model);
    let mut leapfrog = leapfrog(&padded, &level, 2e-5);
    leapfrog.set_drag(500.0).unwrap();
    assert_eq!(leapfrog.carried(), (0..20).collect::<Vec<_>>());
    let mut springs = Springs::under(&model, &level);
    let x = 6.1;
    for step in 0..40_000 {
        let force = 1e5 * gradually(step, 10_000);
        leapfrog.step(springs.push(&leapfrog), &WheelLoads::Given(&[(x, force)])).unwrap();
    }
    let mut series = model.clone();
    for seat in &mut series.seats {
        let support_stiffness = 1.0 / (1.0 / 50e6 + 1.0 / stiff);
        seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness, support_damping: 0.0, seating: None };
    }
    let track = Track::new(series).unwrap();
    let rest = solve_static(&track, &level, &Loads { rail: &[(x, 1e5)], ..Loads::default() }).unwrap();
    let view = leapfrog.view();
    for seat in 0..20 {
        // The weight of the underside does not press the pad.
        let difference = view.foot_displacement(seat) - rest.foot_displacements[seat];
        let underside = view.foot_displacement(seat) - view.underside_displacement(seat);
        let force = view.contact_force(seat).unwrap();
        assert!(difference.abs() < 5.0 * 9.81 / stiff * 1.5, "{difference}");
        assert!(force == 0.0 || (underside - (force - 5.0 * 9.81) / stiff).abs() < 1e-10);
        assert!((force - rest.contact_forces[seat]).abs() < 10.0, "{force} {}", rest.contact_forces[seat]);
    }
}

/// Supports that settle take the sleepers along; at rest again the track is where statics put it.
#[test]
fn levels_change_while_it_runs() {
    let model = transition(20, 20);
    let settled = hollow(&model, 2e-3, 1e-3, -3.0, 2.4);
    let mut leapfrog = leapfrog(&model, &TrackLevel::as_built(&model), 1e-4);
    leapfrog.move_level(&settled, 0.1).unwrap();
    leapfrog.set_drag(100.0).unwrap();
    for step in 0..10_000 {
        if step == 5000 {
            assert_eq!(leapfrog.level(), &settled);
            leapfrog.set_time_step(1.5e-4).unwrap();
        }
        leapfrog.step(&[], &WheelLoads::None).unwrap();
    }
    let rest = solve_static(leapfrog.track(), &settled, &Loads::default()).unwrap();
    let view = leapfrog.view();
    let largest = (0..40).map(|seat| (view.seat_load(seat) - rest.seat_loads[seat]).abs()).fold(0.0, f64::max);
    println!("seat loads within {largest:.1e} N of statics");
    assert!(largest < 1.0 && rest.contact_forces.iter().any(|force| *force > 3e3));
}

/// Held at their levels, carried feet bear the track.
#[test]
fn carried_feet_at_rest() {
    let model = carried(ballast(20));
    let mut level = TrackLevel::as_built(&model);
    level.settlements[7] = 1e-3;
    let track = Track::new(model.clone()).unwrap();
    let rest = solve_static(&track, &level, &Loads { rail: &[(6.0, 5e4)], ..Loads::default() }).unwrap();
    assert!((rest.balance.supports() / rest.balance.loads - 1.0).abs() < 1e-9);
    assert_eq!(rest.foot_displacements[7], 1e-3);
    assert!(rest.contact_forces[7] < rest.contact_forces[4]);
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
        broken.seats[2].foot = Foot::Carried { mass: 150.0, pad: Some(pad) };
        assert!(matches!(Track::new(broken), Err(TrackError::Model { flaw: Flaw::UnderPad, .. })));
    }
}
