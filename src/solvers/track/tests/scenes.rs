//! Tracks and vehicles shared by the tests.

use crate::solvers::track::*;
use std::sync::Arc;

pub const SLEEPER: Foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 50e3, seating: None };

pub fn seat(x: f64, foot: Foot) -> Seat {
    Seat { x, pad_stiffness: 40e6, pad_damping: 5e3, foot }
}

/// One kind of rail from end to end.
pub fn rail(ends: [f64; 2], mass: f64, bending_stiffness: f64) -> Vec<RailSection> {
    vec![RailSection { start: ends[0], end: ends[1], mass, bending_stiffness, shear: None }]
}

/// A beam without seats, of `elements` elements.
pub fn beam(length: f64, bending_stiffness: f64, mass: f64, rail_ends: RailEnds, elements: usize) -> TrackModel {
    TrackModel {
        ends: [0.0, length],
        rail: rail([0.0, length], mass, bending_stiffness),
        seats: Vec::new(),
        slabs: Vec::new(),
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends,
        elements_per_bay: elements,
        irregularity: Irregularity::default(),
        gravity: 0.0,
    }
}

/// `seats` sleepers 0.6 m apart, half a bay of rail beyond the outer ones.
pub fn ballast(seats: usize) -> TrackModel {
    let ends = [0.0, 0.6 * seats as f64];
    TrackModel {
        ends,
        rail: rail(ends, 60.0, 6.4e6),
        seats: (0..seats).map(|i| seat(0.3 + 0.6 * i as f64, SLEEPER)).collect(),
        slabs: Vec::new(),
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends: RailEnds::Clamped,
        elements_per_bay: 4,
        irregularity: Irregularity::default(),
        gravity: 9.81,
    }
}

/// Ballast left of x = 0, a slab right of it.
pub fn transition(sleepers: usize, slab_seats: usize) -> TrackModel {
    let ends = [-0.6 * sleepers as f64 - 0.6, 0.6 * slab_seats as f64];
    let mut seats: Vec<Seat> = (1..=sleepers).rev().map(|i| seat(-0.6 * i as f64, SLEEPER)).collect();
    seats.extend((0..slab_seats).map(|i| seat(0.6 * i as f64, Foot::Slab)));
    TrackModel {
        ends,
        rail: rail(ends, 60.0, 6.4e6),
        seats,
        slabs: vec![Slab {
            start: 0.0,
            end: ends[1],
            bending_stiffness: 122e6,
            mass: 1200.0,
            foundation_stiffness: 160e6,
            foundation_damping: 160e3,
        }],
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends: RailEnds::Clamped,
        elements_per_bay: 4,
        irregularity: Irregularity::default(),
        gravity: 9.81,
    }
}

/// A wagon of 20 t axles, over one rail.
pub fn wagon() -> Vehicle {
    Vehicle {
        car_body_mass: 36_518.0,
        car_body_inertia: 36_518.0 * 3.91 * 3.91,
        bogie_mass: 400.0,
        bogie_inertia: 365.0,
        bogie_spacing: 6.77,
        wheel_mass: 670.5,
        wheelset_spacing: 1.78,
        primary_stiffness: 15e6,
        primary_damping: 35e3,
        secondary_stiffness: 1.875e6,
        secondary_damping: 5e3,
        hertz: 100e9,
    }
}

/// A settled level with a smooth hollow `depth` (m) deep and `half_width` (m) wide to each side of `middle`.
pub fn hollow(model: &TrackModel, even: f64, depth: f64, middle: f64, half_width: f64) -> TrackLevel {
    let settlement = |seat: &Seat| match seat.foot {
        Foot::Sleeper { .. } => {
            let s = ((seat.x - middle) / half_width).clamp(-1.0, 1.0);
            even + depth * (0.5 * std::f64::consts::PI * s).cos().powi(2)
        }
        _ => 0.0,
    };
    TrackLevel { settlements: model.seats.iter().map(settlement).collect(), ends: [even, 0.0] }
}

/// A meshed track with a step of `time_step` (s).
pub fn stepper(model: TrackModel, time_step: f64, spectral_radius: f64) -> Stepper {
    Stepper::new(Arc::new(Track::new(model).unwrap()), Scheme::generalised_alpha(time_step, spectral_radius).unwrap())
        .unwrap()
}
