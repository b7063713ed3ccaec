//! Vehicles: eigenfrequencies, moving forces and sprung masses on beams against closed forms and modal integrations.

use super::scenes::*;
use crate::solvers::track::running::RunningVehicle;
use crate::solvers::track::*;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Eigenfrequencies, Hz, ascending, with the last `fixed` unknowns held.
fn frequencies(vehicle: &Multibody, fixed: usize) -> Vec<f64> {
    let n = vehicle.order() - fixed;
    let scaled = |i, j| vehicle.stiffness[(i, j)] / (vehicle.masses[i] * vehicle.masses[j]).sqrt();
    let squares = DMatrix::from_fn(n, n, scaled).symmetric_eigenvalues();
    let mut found: Vec<f64> = squares.iter().map(|s| s.max(0.0).sqrt() / (2.0 * PI)).collect();
    found.sort_by(f64::total_cmp);
    found
}

#[test]
fn wagon_frequencies() {
    let wagon = wagon();
    // Car body and both bogies as a chain of two masses: bounce of the car body and of the bogies.
    let (m, n) = (wagon.car_body_mass, 2.0 * wagon.bogie_mass);
    let (k, l) = (2.0 * wagon.secondary_stiffness, 4.0 * wagon.primary_stiffness);
    let (half, product) = (0.5 * (k / m + (k + l) / n), k * l / (m * n));
    let root = (half * half - product).sqrt();
    let found = frequencies(&wagon.into(), 4);
    for square in [half - root, half + root] {
        let expected = square.sqrt() / (2.0 * PI);
        assert!(found.iter().any(|f| (f / expected - 1.0).abs() < 1e-9), "{expected} not in {found:?}");
    }
    // With stiff primary springs only the secondary springs act.
    let stiff = frequencies(&Vehicle { primary_stiffness: 1e12, ..wagon }.into(), 4);
    assert!(stiff.iter().any(|f| (f - 1.613).abs() < 5e-4), "{stiff:?}");
}

/// A free vehicle vibrates in its modes at its eigenfrequencies.
#[test]
fn a_vehicle_swings_at_its_frequencies() {
    let wagon = Vehicle { primary_damping: 0.0, secondary_damping: 0.0, ..wagon() };
    let body = Multibody::from(wagon);
    let scaled = |i, j| body.stiffness[(i, j)] / (body.masses[i] * body.masses[j]).sqrt();
    let modes = DMatrix::from_fn(10, 10, scaled).symmetric_eigen();
    let scheme = Scheme::generalised_alpha(2e-5, 1.0).unwrap();
    for (square, mode) in modes.eigenvalues.iter().zip(modes.eigenvectors.column_iter()).filter(|(s, _)| **s > 1.0) {
        let (expected, shape) = (square.sqrt() / (2.0 * PI), |i: usize| mode[i] / body.masses[i].sqrt());
        let start: Vec<f64> = (0..10).map(shape).collect();
        let mut running = RunningVehicle::new(&body, 0.0, &scheme, start.clone(), vec![0.0; 10]).unwrap();
        running.acceleration = start.iter().map(|u| -square * u).collect();
        let place = (0..10).max_by(|a, b| start[*a].abs().total_cmp(&start[*b].abs())).unwrap();
        let (mut crossings, mut before) = (Vec::new(), start[place]);
        for step in 1..=(3.2 / expected / 2e-5) as usize {
            running.predict(&scheme, &[0.0; 4]);
            running.finish(&scheme, &[0.0; 4]);
            let now = running.displacement[place];
            if before * now < 0.0 {
                crossings.push(2e-5 * (step as f64 - now / (now - before)));
            }
            before = now;
        }
        let found = 0.5 * (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]);
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }
}

/// The bridge of Yang and Yau (1997): 25 m, 100 km/h, 5750 kg.
const SPAN: f64 = 25.0;
const STIFFNESS: f64 = 8.323e9;
const MASS: f64 = 2303.0;
const SPEED: f64 = 100.0 / 3.6;
const LOAD: f64 = 5750.0 * 9.81;

/// Mid-span deflection and first unknown of a vehicle that crosses a beam, as functions of time.
fn cross(span: f64, vehicle: Multibody, time_step: f64) -> Vec<(f64, f64, f64)> {
    let model = beam(span, STIFFNESS, MASS, RailEnds::Pinned, 40);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, time_step, 0.95);
    let train = Train::single(vehicle, Direction::Forward);
    let run = Run { train: &train, start: 0.0, finish: span, motion: &Motion::Constant(SPEED) };
    let mut seen = Vec::new();
    let mut look = |view: &StepView<'_>| {
        let body = view.passage.vehicles[0].0.displacement.first().copied().unwrap_or(0.0);
        seen.push((view.time(), view.rail_deflection(20), body));
    };
    Passage::new(&stepper, &level, run).unwrap().run(&mut look).unwrap();
    seen
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

/// A constant force over a simply supported beam, mode by mode (Frýba 1999, chapter 1).
#[test]
fn moving_force_on_a_beam() {
    let alpha = SPEED * SPAN / PI * (MASS / STIFFNESS).sqrt();
    let expected = |t: f64| -> f64 {
        let mode = |n: f64| {
            let (forced, own) = (PI * SPEED / SPAN * n, (n * PI / SPAN).powi(2) * (STIFFNESS / MASS).sqrt());
            let size = (0.5 * n * PI).sin() / (n * n * (n * n - alpha * alpha));
            size * ((forced * t).sin() - alpha / n * (own * t).sin())
        };
        2.0 * LOAD * SPAN.powi(3) / (STIFFNESS * PI.powi(4)) * (1..=40).map(|n| mode(f64::from(n))).sum::<f64>()
    };
    let seen = cross(SPAN, Multibody::moving_force(LOAD), 2e-4);
    let most = largest(seen.iter().map(|s| s.1));
    let worst = largest(seen.iter().map(|(t, w, _)| (w - expected(*t)).abs()));
    println!("moving force: {:.4} mm at mid-span, history within {:.1e} of it", 1e3 * most, worst / most);
    assert!((1e3 * most - 2.3971).abs() < 5e-4, "{most}");
    assert!(worst / most < 5e-4, "{worst}");
}

#[test]
fn sprung_mass_on_a_beam() {
    let mut vehicle = Multibody::sprung_mass(5750.0, 1595e3, 0.0);
    vehicle.forces[0] = LOAD;
    let seen = cross(SPAN, vehicle, 2e-4);
    let most = largest(seen.iter().map(|s| s.1));
    let body = largest(seen.iter().map(|s| s.2 - LOAD / 1595e3));
    println!("sprung mass: {:.4} mm at mid-span, {:.4} mm of the mass", 1e3 * most, 1e3 * body);
    assert!((1e3 * most - 2.408).abs() < 1e-3, "{most}");
    assert!((1e3 * body - 2.590).abs() < 1e-3, "{body}");
}

/// The two-mass vehicle of Biggs (1964) on a bridge of 50 m, compared with modes of the bridge and a Runge–Kutta
/// method.
#[test]
fn two_masses_on_a_beam() {
    let (span, wheel, body, k, c, contact) = (50.0, 5750.0, 3000.0, 159.5e6, 1e3, 1e10);
    let law = WheelContact::Linear { stiffness: contact, damping: 0.0 };
    let mut vehicle = Multibody::sprung_wheel(body, k, c, wheel, law);
    vehicle.forces = vec![body * 9.81, wheel * 9.81];
    let seen = cross(span, vehicle, 1e-4);

    const MODES: usize = 15;
    type State = [f64; 2 * MODES + 4]; // modes, body, wheel; then their speeds
    let shape = |n: usize, x: f64| ((n + 1) as f64 * PI * x / span).sin();
    let rate = |t: f64, s: &State| -> State {
        let mut change = [0.0; 2 * MODES + 4];
        let half = MODES + 2;
        change[..half].copy_from_slice(&s[half..]);
        let x = SPEED * t;
        let rail: f64 = (0..MODES).map(|n| s[n] * shape(n, x)).sum();
        let force = contact * (s[MODES + 1] - rail);
        let spring = k * (s[MODES] - s[MODES + 1]) + c * (s[half + MODES] - s[half + MODES + 1]);
        for n in 0..MODES {
            let omega = ((n + 1) as f64 * PI / span).powi(2) * (STIFFNESS / MASS).sqrt();
            change[half + n] = 2.0 * force * shape(n, x) / (MASS * span) - omega * omega * s[n];
        }
        change[half + MODES] = 9.81 - spring / body;
        change[half + MODES + 1] = 9.81 + (spring - force) / wheel;
        change
    };
    let mut s: State = [0.0; 2 * MODES + 4];
    s[MODES + 1] = (wheel + body) * 9.81 / contact;
    s[MODES] = s[MODES + 1] + body * 9.81 / k;
    let (h, most) = (1e-4, largest(seen.iter().map(|s| s.1)));
    let (mut worst, mut worst_body) = (0.0f64, 0.0f64);
    for (step, (t, mid, found)) in seen.iter().enumerate() {
        let expected: f64 = (0..MODES).map(|n| s[n] * shape(n, 0.5 * span)).sum();
        worst = worst.max((mid - expected).abs() / most);
        worst_body = worst_body.max((found - s[MODES]).abs() / most);
        assert!((t - step as f64 * h).abs() < 1e-12);
        let ahead = |factor: f64, k: &State| -> State { std::array::from_fn(|i| s[i] + factor * k[i]) };
        let k1 = rate(*t, &s);
        let k2 = rate(t + 0.5 * h, &ahead(0.5 * h, &k1));
        let k3 = rate(t + 0.5 * h, &ahead(0.5 * h, &k2));
        let k4 = rate(t + h, &ahead(h, &k3));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    println!("two masses: {:.4} mm, differ by {worst:.1e} at mid-span and {worst_body:.1e} of the body", 1e3 * most);
    assert!(worst < 1e-3 && worst_body < 3e-3, "{worst} {worst_body}");
}

/// A slow force on a beam on springs 1 m apart: the deflection of a Winkler foundation moves with the force.
#[test]
fn moving_force_on_springs() {
    let (ei, k, load) = (4.41e5, 2.75e5, 18e3);
    let mut model = beam(100.0, ei, 1e-3, RailEnds::Free, 4);
    let spring = |i: i32| Seat { x: f64::from(i), pad_stiffness: k, pad_damping: 0.0, foot: Foot::Rigid };
    model.seats = (0..=100).map(spring).collect();
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, 1e-3, 0.85);
    let train = Train::single(Multibody::moving_force(load), Direction::Forward);
    let run = Run { train: &train, start: 30.0, finish: 70.0, motion: &Motion::Constant(10.0) };
    let mut range = (f64::INFINITY, 0.0f64);
    let mut look = |view: &StepView<'_>| {
        let x = view.wheel_positions()[0];
        let node = view.track().nodes().iter().position(|n| (n - x).abs() < 1e-6);
        if let Some(w) = node.map(|node| view.rail_deflection(node)) {
            range = (range.0.min(w), range.1.max(w));
        }
    };
    Passage::new(&stepper, &level, run).unwrap().run(&mut look).unwrap();
    println!("slow force on springs: {:.4} .. {:.4} mm", 1e3 * range.0, 1e3 * range.1);
    assert!((range.0 / 20.5645e-3 - 1.0).abs() < 0.01 && (range.1 / 20.5645e-3 - 1.0).abs() < 0.01);
}

/// Statics of every kind of wheel: the track carries the weight, and a given force keeps its value.
#[test]
fn every_kind_of_wheel_stands() {
    let model = ballast(30);
    let level = hollow(&model, 0.0, 2e-3, 9.0, 2.0);
    let level = TrackLevel { ends: [0.0; 2], ..level };
    let track = Track::new(model).unwrap();
    let linear = WheelContact::Linear { stiffness: 1.4e9, damping: 0.0 };
    let train = Train {
        vehicles: vec![
            (Multibody::sprung_wheel(5e3, 1e6, 1e4, 600.0, WheelContact::Hertz(100e9)), 0.0),
            (Multibody::moving_force(40e3), 0.03),
            (Multibody::sprung_mass(3e3, 2e6, 0.0), 2.0),
            (Multibody::sprung_wheel(4e3, 1e6, 1e4, 600.0, linear), 5.0),
        ],
        direction: Direction::Backward,
    };
    let state = solve_static(&track, &level, &Loads { train: Some((&train, 6.3)), ..Loads::default() }).unwrap();
    for (found, expected) in state.wheel_forces.iter().zip([5600.0 * 9.81, 40e3, 3e3 * 9.81, 4600.0 * 9.81]) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
    assert!((state.balance.supports() / state.balance.loads - 1.0).abs() < 1e-9);
}

#[test]
fn impossible_vehicles_are_refused() {
    let model = ballast(20);
    let level = TrackLevel::as_built(&model);
    let track = Track::new(model).unwrap();
    let broken: [fn(&mut Multibody); 8] = [
        |v| v.masses[0] = -1.0,
        |v| v.stiffness[(0, 1)] = 3.0,
        |v| v.damping[(1, 1)] = f64::NAN,
        |v| v.wheels.clear(),
        |v| v.wheels[0].unknown = Some(2),
        |v| v.wheels[0].unknown = None,
        |v| v.wheels[0].contact = WheelContact::Hertz(0.0),
        |v| v.forces = vec![-1e6; 2],
    ];
    for change in broken {
        let mut vehicle = Multibody::sprung_wheel(5e3, 1e6, 1e4, 600.0, WheelContact::Hertz(100e9));
        change(&mut vehicle);
        let train = Train::single(vehicle, Direction::Forward);
        let loads = Loads { train: Some((&train, 6.0)), ..Loads::default() };
        assert!(matches!(solve_static(&track, &level, &loads), Err(TrackError::Parameter { .. })));
    }
    // Nothing holds the upper mass.
    let loose = Multibody::sprung_wheel(5e3, 0.0, 1e4, 600.0, WheelContact::Hertz(100e9));
    let train = Train::single(loose, Direction::Forward);
    let loads = Loads { train: Some((&train, 6.0)), ..Loads::default() };
    assert!(matches!(solve_static(&track, &level, &loads), Err(TrackError::Mechanism { .. })));
}
