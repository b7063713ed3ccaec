//! The passage against an independent solution of the same equations in continuous time, see `oracle`.

use super::oracle::Oracle;
use super::oracle::dormand_prince::Integrator;
use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

/// The state of a passage in the oracle's order.
fn state_of(passage: &Passage<'_>) -> Vec<f64> {
    let track = &*passage.stepper.track;
    let gather = |of_track: &[f64], of_wagon: &[f64]| {
        let mut all: Vec<f64> = track.rail.iter().flat_map(|w| [of_track[*w], of_track[*w + 1]]).collect();
        all.extend(track.sleepers.iter().map(|s| of_track[s.unknown]));
        all.extend_from_slice(of_wagon);
        all
    };
    let wagon = &passage.vehicles[0].0;
    let mut y = gather(&passage.displacement, &wagon.displacement);
    y.extend(gather(&passage.velocity, &wagon.velocity));
    y
}

const SPEED: f64 = 200.0 / 3.6;
const OUTPUT: f64 = 1e-4;
const START: f64 = 11.0;

/// Forces at every output time: wheels, seats, supports; and the time in which each support carried no force.
struct Forces {
    wheels: Vec<[f64; 4]>,
    seats: Vec<Vec<f64>>,
    supports: Vec<Vec<f64>>,
    hanging: Vec<f64>,
}

fn solved(
    model: &TrackModel,
    level: &TrackLevel,
    wagon: Vehicle,
    scheme: Scheme,
    outputs: usize,
) -> (Forces, Vec<f64>) {
    let stepper = Stepper::new(Arc::new(Track::new(model.clone()).unwrap()), scheme).unwrap();
    let train = Train::single(wagon, Direction::Forward);
    let finish = START + SPEED * OUTPUT * outputs as f64 + 1e-6;
    let run = Run { train: &train, start: START, finish, motion: &Motion::Constant(SPEED) };
    let mut passage = Passage::new(&stepper, level, run).unwrap();
    let start = state_of(&passage);
    let every = (OUTPUT / scheme.time_step).round() as usize;
    let count = model.seats.len();
    let mut found = Forces { wheels: vec![], seats: vec![], supports: vec![], hanging: vec![0.0; count] };
    let mut look = |view: &StepView<'_>| {
        for seat in 0..count {
            if view.step() > 0 && view.contact_force(seat) == Some(0.0) {
                found.hanging[seat] += view.time_step();
            }
        }
        if view.step().is_multiple_of(every) {
            found.wheels.push(view.wheel_forces().try_into().unwrap());
            found.seats.push((0..count).map(|seat| view.seat_load(seat)).collect());
            found.supports.push((0..count).filter_map(|seat| view.contact_force(seat)).collect());
        }
    };
    passage.run(&mut look).unwrap();
    (found, start)
}

fn integrated_in_time(oracle: Oracle, start: Vec<f64>, tolerance: f64, outputs: usize) -> (Forces, usize) {
    let mut run = Integrator::new(oracle, start, tolerance);
    let mut found = Forces { wheels: vec![], seats: vec![], supports: vec![], hanging: vec![] };
    for output in 0..=outputs {
        run.advance(output as f64 * OUTPUT);
        let (oracle, y) = (&run.oracle, &run.y);
        found.wheels.push([0, 1, 2, 3].map(|wheel| oracle.wheel_force(wheel, run.time, y)));
        found.seats.push((0..oracle.seats()).map(|s| oracle.seat_load(s, y)).collect());
        found.supports.push((0..oracle.seats()).map(|s| oracle.support_force(s, y)).collect());
    }
    found.hanging = run.hanging;
    (found, run.events)
}

/// Largest differences over time divided by the static wheel force: wheels, seats; impulses of the supports, divided by
/// the impulse of a wheel; time without support force, s.
fn differences(a: &Forces, b: &Forces, still: f64) -> [f64; 4] {
    assert_eq!(a.wheels.len(), b.wheels.len());
    let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs() / still));
    let wheels = a.wheels.iter().zip(&b.wheels).fold(0.0f64, |m, (a, b)| m.max(largest(a, b)));
    let seats = a.seats.iter().zip(&b.seats).fold(0.0f64, |m, (a, b)| m.max(largest(a, b)));
    let steps = a.supports.len() as f64;
    let impulses = (0..a.hanging.len())
        .map(|s| a.supports.iter().zip(&b.supports).map(|(a, b)| (a[s] - b[s]).abs()).sum::<f64>() / (steps * still));
    let hanging = a.hanging.iter().zip(&b.hanging).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    [wheels, seats, impulses.fold(0.0, f64::max), hanging]
}

const TIME_STEPS: [f64; 5] = [1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6];

type Method = (&'static str, fn(f64) -> Result<Scheme, TrackError>);

const METHODS: [Method; 3] = [
    ("generalised-alpha, spectral radius 0.85", |dt| Scheme::generalised_alpha(dt, 0.85)),
    ("HHT-alpha, alpha 0.1", |dt| Scheme::hht(dt, 0.1)),
    ("Newmark", Scheme::newmark),
];

/// The dip of the oracle as a cubic of the solver.
fn parabola([start, length, depth]: [f64; 3]) -> Irregularity {
    let curvatures = [-8.0 * depth / (length * length); 2];
    Irregularity::cubics(vec![Cubic { ends: [start, start + length], values: [0.0; 2], curvatures }])
}

struct Study {
    /// Smallest and largest wheel force of the oracle, divided by the static force.
    wheels: (f64, f64),
    /// Differences between the solver and the oracle for each method and time step.
    errors: Vec<Vec<[f64; 4]>>,
    /// Difference between the oracle and the oracle with a coarser tolerance.
    own: [f64; 4],
    /// Number of changes of supports between carrying and open.
    events: usize,
}

fn study(level_of: impl Fn(&TrackModel) -> TrackLevel, wagon: Vehicle, dip: Option<[f64; 3]>, outputs: usize) -> Study {
    let mut model = ballast(40);
    model.irregularity = dip.map_or(Irregularity::default(), parabola);
    model.elements_per_bay = 2;
    let level = level_of(&model);
    let still = wagon.mass() * 9.81 / 4.0;
    let (_, start) = solved(&model, &level, wagon, METHODS[0].1(1e-4).unwrap(), 1);
    let oracle = |tolerance| {
        let mut oracle = Oracle::new(&model, &level, wagon, START, SPEED);
        oracle.dip = dip;
        integrated_in_time(oracle, start.clone(), tolerance, outputs)
    };
    let (reference, events) = oracle(1e-9);
    let own = differences(&reference, &oracle(1e-7).0, still);
    println!("{events} events; tolerance 1e-7 against 1e-9: {own:?}");
    let mut errors = Vec::new();
    for (name, make) in METHODS {
        println!("{name}");
        let of_method = TIME_STEPS.map(|dt| {
            let found = solved(&model, &level, wagon, make(dt).unwrap(), outputs).0;
            let [wheels, seats, impulses, hanging] = differences(&found, &reference, still);
            println!(
                "  {dt:.2e} s: wheels {wheels:.2e}, seats {seats:.2e}, impulses {impulses:.2e}, hanging {hanging:.2e} s"
            );
            [wheels, seats, impulses, hanging]
        });
        println!("  orders {:.2?}", [0, 1, 2].map(|of| order(&of_method, of)));
        errors.push(of_method.to_vec());
    }
    let forces = reference.wheels.iter().flatten().map(|force| force / still);
    let wheels = forces.fold((f64::INFINITY, 0.0f64), |(low, high), force| (low.min(force), high.max(force)));
    println!("wheel forces of the oracle: {wheels:.3?} of the static one");
    Study { errors, own, events, wheels }
}

/// Slope of the straight line through the logarithms of the errors of the four smaller steps.
fn order(errors: &[[f64; 4]], of: usize) -> f64 {
    let points: Vec<(f64, f64)> = TIME_STEPS.iter().zip(errors).skip(1).map(|(dt, e)| (dt.ln(), e[of].ln())).collect();
    let count = points.len() as f64;
    let (x, y) = (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

/// A light wagon on an even track lifts no sleeper: the motion is smooth.
#[test]
fn closed_contacts_are_of_second_order() {
    let light = Vehicle { car_body_mass: 9e3, car_body_inertia: 9e3 * 3.91 * 3.91, ..wagon() };
    let found = study(TrackLevel::as_built, light, None, 700);
    assert_eq!(found.events, 0);
    assert!(found.own[0] < 1e-6, "the oracle's own error, found 1.1e-7");
    for errors in &found.errors {
        let (coarse, fine) = (errors[0], errors[4]);
        assert!(coarse[0] < 3e-3 && coarse[1] < 2e-4, "found 2.0e-3 and 9.4e-5 at 0.1 ms: {coarse:?}");
        assert!(fine[0] < 3e-5 && fine[1] < 3e-6, "found 1.6e-5 and 1.4e-6 at 6.25 us: {fine:?}");
        let orders = [0, 1, 2].map(|of| order(errors, of));
        // The largest errors are at the start, in motions faster than the coarse steps; the means are of second order.
        assert!(orders[0] > 1.6 && orders[1] > 1.35 && orders[2] > 1.75, "found 1.81, 1.52, 1.92: {orders:?}");
    }
}

/// Five sleepers over voids of up to 3 mm, and the sleepers that a heavy wagon lifts ahead of and behind its bogies.
#[test]
fn lift_off_converges_to_the_exact_motion() {
    let voids = |model: &TrackModel| {
        let mut level = TrackLevel::as_built(model);
        for (seat, void) in [(23, 1e-3), (24, 2e-3), (25, 3e-3), (26, 2e-3), (27, 1e-3)] {
            level.settlements[seat] = void;
        }
        level
    };
    let found = study(voids, wagon(), None, 1300);
    assert!(found.events > 30, "found 37");
    assert!(found.own[0] < 1e-6, "the oracle's own error, found 7.9e-8");
    for errors in &found.errors {
        let (coarse, fine) = (errors[0], errors[4]);
        assert!(coarse[0] < 4e-3 && coarse[1] < 8e-4, "found 2.5e-3 and 4.5e-4 at 0.1 ms: {coarse:?}");
        assert!(fine[0] < 6e-5 && fine[1] < 6e-5, "found 3.3e-5 and 3.3e-5 at 6.25 us: {fine:?}");
        for (dt, error) in TIME_STEPS.iter().zip(errors) {
            assert!(error[3] < 1.5 * dt, "hanging differs by {:.2} steps, found up to 0.9", error[3] / dt);
        }
        // A contact that switches within a step leaves a first-order error in the values that depend on it.
        let orders = [0, 1, 2].map(|of| order(errors, of));
        assert!(orders[0] > 1.5 && orders[1] > 0.6 && orders[2] > 0.6, "found 1.76, 0.85, 0.88: {orders:?}");
    }
}

/// Over a dip 0.9 m long and 4 mm deep wheels lift off the rail and hit it with 3.6 times their static force.
#[test]
fn wheels_that_leave_the_rail() {
    let found = study(TrackLevel::as_built, wagon(), Some([12.0, 0.9, 4e-3]), 500);
    assert_eq!(found.wheels.0, 0.0, "a wheel lifts off");
    assert!((found.wheels.1 - 3.61).abs() < 0.01, "found 3.61");
    assert!(found.own[0] < 1e-6, "the oracle's own error, found 2.6e-8");
    for errors in &found.errors {
        let fine = errors[4];
        assert!(fine[0] < 1.5e-2 && fine[1] < 1.5e-3, "found 8.4e-3 and 7.3e-4 at 6.25 us: {fine:?}");
        for (dt, error) in TIME_STEPS.iter().zip(errors) {
            assert!(error[3] < 3.0 * dt, "hanging differs by {:.2} steps, found up to 1.9", error[3] / dt);
        }
        let orders = [0, 1, 2].map(|of| order(errors, of));
        assert!(orders[0] > 1.5 && orders[1] > 1.1 && orders[2] > 1.1, "found 1.73, 1.32, 1.36: {orders:?}");
    }
}
