//! The tracks, the wagon and the runs that the cases share.

use std::sync::Arc;
use trackbed::solvers::track::*;

pub use crate::wagon::wagon;

pub const SPEED: f64 = 200.0 / 3.6;

/// One kind of rail from end to end on seats; no gravity.
pub fn beam(ends: [f64; 2], bending_stiffness: f64, mass: f64, rail_ends: RailEnds, elements: usize) -> TrackModel {
    TrackModel {
        ends,
        rail: vec![RailSection { start: ends[0], end: ends[1], mass, bending_stiffness, shear: None }],
        seats: Vec::new(),
        slabs: Vec::new(),
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends,
        irregularity: Irregularity::default(),
        elements_per_bay: elements,
        gravity: 0.0,
    }
}

/// A seat on fixed ground.
pub fn spring(x: f64, stiffness: f64, damping: f64) -> Seat {
    Seat { x, pad_stiffness: stiffness, pad_damping: damping, foot: Foot::Rigid }
}

/// `seats` sleepers 0.6 m apart in ballast, half a bay of rail beyond the outer ones.
pub fn ballast(seats: usize) -> TrackModel {
    let foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 50e3, seating: None };
    let seat = |i: usize| Seat { x: 0.3 + 0.6 * i as f64, pad_stiffness: 40e6, pad_damping: 5e3, foot };
    TrackModel {
        seats: (0..seats).map(seat).collect(),
        gravity: 9.81,
        ..beam([0.0, 0.6 * seats as f64], 6.4e6, 60.0, RailEnds::Clamped, 4)
    }
}

/// Static force of each of its wheels, N.
pub fn static_force() -> f64 {
    wagon().mass() * 9.81 / 4.0
}

pub fn stepper(model: TrackModel, scheme: Scheme) -> Stepper {
    Stepper::new(Arc::new(Track::new(model).unwrap()), scheme).unwrap()
}

/// Generalised-alpha of the program's default.
pub fn scheme(time_step: f64) -> Scheme {
    Scheme::generalised_alpha(time_step, 0.85).unwrap()
}

/// The member of the family that damps nothing and takes all forces in the middle of a step.
pub fn undamped(time_step: f64) -> Scheme {
    Scheme::generalised_alpha(time_step, 1.0).unwrap()
}

pub fn newmark(time_step: f64) -> Scheme {
    Scheme::newmark(time_step).unwrap()
}

pub fn hht(time_step: f64) -> Scheme {
    Scheme::hht(time_step, 0.1).unwrap()
}

type Method = (&'static str, fn(f64) -> Scheme);

/// All methods of time integration.
pub const METHODS: [Method; 4] = [
    ("generalised-alpha, spectral radius 0.85", scheme),
    ("generalised-alpha, spectral radius 1", undamped),
    ("HHT-alpha, alpha 0.1", hht),
    ("Newmark", newmark),
];

/// A 60E1 rail as a Timoshenko beam: kappa 0.4.
pub const SHEAR: Shear = Shear { stiffness: 0.4 * 80.77e9 * 76.70e-4, rotary_inertia: 0.2385 };

/// Runs the wagon at 200 km/h and hands every step to `look`.
pub fn pass(
    stepper: &Stepper,
    level: &TrackLevel,
    from: f64,
    to: f64,
    mut look: impl FnMut(&StepView<'_>),
) -> Counters {
    let train = Train::single(wagon(), Direction::Forward);
    let run = Run { train: &train, start: from, finish: to, motion: &Motion::Constant(SPEED) };
    Passage::new(stepper, level, run).unwrap().run(&mut look).unwrap()
}

/// Forces of the four wheels at every step.
pub fn wheel_forces(stepper: &Stepper, level: &TrackLevel, from: f64, to: f64) -> Vec<[f64; 4]> {
    let mut forces = Vec::new();
    pass(stepper, level, from, to, |view| forces.push(view.wheel_forces().try_into().unwrap()));
    forces
}

pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, value| f64::max(m, value.abs()))
}

/// Slope of the straight line through the logarithms of step and error.
pub fn order(points: &[(f64, f64)]) -> f64 {
    let points: Vec<(f64, f64)> = points.iter().map(|(h, e)| (h.ln(), e.ln())).collect();
    let count = points.len() as f64;
    let (x, y) = (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}
