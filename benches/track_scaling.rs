//! Time per step as trains and tracks grow: ballasted track with a hollow every 12 m, 200 km/h, dt 0.1 ms.
//!
//! Per wagon it should stay about constant, and with one wagon grow as the length of the track.

#[path = "shared/wagon.rs"]
mod wagon;

use std::sync::Arc;
use std::time::Instant;
use trackbed::solvers::track::*;
use wagon::wagon;

/// Length of a wagon over its buffers, m.
const WAGON: f64 = 11.0;

fn model(length: f64) -> TrackModel {
    let foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 50e3, seating: None };
    let seat = |i: usize| Seat { x: 0.3 + 0.6 * i as f64, pad_stiffness: 40e6, pad_damping: 5e3, foot };
    let seats = (length / 0.6) as usize;
    let ends = [0.0, 0.6 * seats as f64];
    TrackModel {
        ends,
        rail: vec![RailSection { start: ends[0], end: ends[1], mass: 60.0, bending_stiffness: 6.4e6, shear: None }],
        seats: (0..seats).map(seat).collect(),
        slabs: Vec::new(),
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends: RailEnds::Clamped,
        irregularity: Irregularity::default(),
        elements_per_bay: 4,
        gravity: 9.81,
    }
}

/// Runs `wagons` over 3 m of a track of `length` (m); best of three.
fn measure(length: f64, wagons: usize) -> Result<(), TrackError> {
    let model = model(length);
    let settlement = |seat: &Seat| 1e-3 * (1.0 + (seat.x * std::f64::consts::TAU / 12.0).sin());
    let level = TrackLevel { settlements: model.seats.iter().map(settlement).collect(), ends: [1e-3; 2] };
    let stepper = Stepper::new(Arc::new(Track::new(model)?), Scheme::generalised_alpha(1e-4, 0.85)?)?;
    let vehicles = (0..wagons).map(|w| (wagon().into(), WAGON * w as f64)).collect();
    let train = Train { vehicles, direction: Direction::Forward };
    let start = 0.5 * (length + train.wheel_base());
    let run = Run { train: &train, start, finish: start + 3.0, motion: &Motion::Constant(55.56) };
    let clock = Instant::now();
    let begun = Passage::new(&stepper, &level, run)?;
    let begin = clock.elapsed().as_secs_f64();
    let mut best = f64::INFINITY;
    let mut counters = Counters::default();
    for _ in 0..3 {
        let mut passage = begun.clone();
        let clock = Instant::now();
        counters = passage.run(&mut ())?;
        best = best.min(1e6 * clock.elapsed().as_secs_f64() / counters.steps as f64);
    }
    println!(
        "{length:>6.0} m, {wagons:>2} wagons: {best:>7.1} us/step, {:>6.2} a wagon, {:>6.3} a metre; begun in {:.0} ms, {:.2} iterations a step, up to {} supports not closed",
        best / wagons as f64,
        best / length,
        1e3 * begin,
        counters.iterations as f64 / counters.steps as f64,
        counters.most_open_supports
    );
    Ok(())
}

fn main() -> Result<(), TrackError> {
    println!("a longer train on a track as much longer");
    for wagons in [1, 4, 16] {
        measure(44.0 * wagons as f64, wagons)?;
    }
    println!("a longer train on one track");
    for wagons in [1, 4, 16] {
        measure(240.0, wagons)?;
    }
    println!("one wagon on a longer track");
    for length in [66.0, 264.0, 1056.0] {
        measure(length, 1)?;
    }
    Ok(())
}
