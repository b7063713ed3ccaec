//! Passages: linear limits, orders of convergence, symmetry, steadiness and lift-off.

use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

const RHO: f64 = 0.85;

fn stepper(model: TrackModel, time_step: f64) -> Stepper {
    super::scenes::stepper(model, time_step, RHO)
}

/// Runs one wagon and passes every step to `look`.
fn run(
    stepper: &Stepper,
    level: &TrackLevel,
    vehicle: Vehicle,
    ends: (f64, f64),
    mut look: impl FnMut(&StepView<'_>),
) -> Counters {
    let direction = if ends.1 > ends.0 { Direction::Forward } else { Direction::Backward };
    let train = Train::single(vehicle, direction);
    let run = Run { train: &train, start: ends.0, finish: ends.1, motion: &Motion::Constant(55.56) };
    Passage::new(stepper, level, run).unwrap().run(&mut look).unwrap()
}

fn envelope(stepper: &Stepper, level: &TrackLevel, ends: (f64, f64)) -> Envelope {
    let mut envelope = Envelope::default();
    run(stepper, level, wagon(), ends, |view| envelope.observe(view));
    envelope
}

/// Deflection of a node over time after a load there is removed.
fn release(model: TrackModel, x: f64, load: f64, time_step: f64, steps: usize) -> Vec<f64> {
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, time_step);
    let track = stepper.track();
    let node = track.nodes().iter().position(|n| (n - x).abs() < 1e-9).unwrap();
    let state = solve_static(track, &level, &Loads { rail: &[(x, load)], ..Loads::default() }).unwrap();
    let mut deflections = Vec::new();
    let mut look = |view: &StepView<'_>| deflections.push(view.rail_deflection(node));
    Passage::released(&stepper, &level, state, steps).unwrap().run(&mut look).unwrap();
    deflections
}

/// Inverse of the mean time between upward zero crossings.
fn frequency(values: &[f64], time_step: f64) -> f64 {
    let crossings: Vec<f64> = (1..values.len())
        .filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0)
        .map(|i| i as f64 - values[i] / (values[i] - values[i - 1]))
        .collect();
    (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]) / time_step
}

#[test]
fn first_frequencies() {
    let values = release(beam(10.0, 2e8, 2000.0, RailEnds::Pinned, 20), 5.0, 1e3, 5e-4, 4000);
    assert!((values[0] - 0.104_166_7e-3).abs() < 1e-9);
    let found = frequency(&values, 5e-4);
    assert!((found / 4.9673 - 1.0).abs() < 2e-3, "pinned {found}");

    // Two stiff seats close to each other clamp the left end.
    let mut model = beam(1.001, 2e3, 20.0, RailEnds::Free, 20);
    let rigid = |x: f64| Seat { x, pad_stiffness: 1e13, pad_damping: 0.0, foot: Foot::Rigid };
    (model.seats, model.elements_per_bay) = (vec![rigid(0.0), rigid(0.001)], 1);
    model.rail = (0..10)
        .map(|i| RailSection { start: 0.001 + 0.1 * (i as f64), end: 0.101 + 0.1 * i as f64, ..model.rail[0] })
        .collect();
    model.rail[0].start = 0.0;
    let (stiff, time_step) = (model, 5e-4);
    let values = release(stiff, 1.001, 1e3, time_step, 4000);
    assert!((values[0] / 0.166_667 - 1.0).abs() < 3e-3, "{}", values[0]);
    let found = frequency(&values, time_step);
    assert!((found / 5.596 - 1.0).abs() < 4e-3, "cantilever {found}");
}

/// The error of a linear motion falls with the square of the step, for every method.
#[test]
fn second_order_in_time() {
    let schemes = [
        ("generalised-alpha", Scheme::generalised_alpha(1e-4, RHO)),
        ("HHT", Scheme::hht(1e-4, 0.1)),
        ("Newmark", Scheme::newmark(1e-4)),
    ];
    let mut model = beam(10.0, 2e8, 2000.0, RailEnds::Pinned, 4);
    let spring = Seat { x: 2.5, pad_stiffness: 1e7, pad_damping: 2e4, foot: Foot::Rigid };
    model.seats = vec![spring, Seat { x: 5.0, ..spring }, Seat { x: 7.5, ..spring }];
    let level = TrackLevel::as_built(&model);
    let track = Arc::new(Track::new(model).unwrap());
    for (name, scheme) in schemes {
        let end = |steps: usize| {
            let scheme = scheme.clone().unwrap().with_time_step(0.2 / steps as f64).unwrap();
            let stepper = Stepper::new(track.clone(), scheme).unwrap();
            // A load with the shape of the first mode, so that no motion is faster than a step.
            let load = |x: &f64| (*x, 1e3 * (std::f64::consts::PI * x / 10.0).sin());
            let loads: Vec<(f64, f64)> = track.nodes().iter().map(load).collect();
            let state = solve_static(&track, &level, &Loads { rail: &loads, ..Loads::default() }).unwrap();
            let mut passage = Passage::released(&stepper, &level, state, steps).unwrap();
            passage.run(&mut ()).unwrap();
            passage.view().rail_deflection(track.seat_node(1))
        };
        let values = [400, 800, 1600, 3200].map(end);
        let changes: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
        for pair in changes.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            println!("{name}: observed order {order:.3}");
            assert!((order - 2.0).abs() < 0.1, "{name}: observed order {order}");
        }
    }
}

/// On rigid ground every wheel keeps its static force.
#[test]
fn rigid_track() {
    let mut model = ballast(50);
    model.rail[0].bending_stiffness = 6.4e14;
    model.seats.iter_mut().for_each(|s| (s.foot, s.pad_stiffness) = (Foot::Rigid, 4e16));
    let level = TrackLevel::as_built(&model);
    let mut worst = 0.0f64;
    run(&stepper(model, 1e-4), &level, wagon(), (10.0, 20.0), |view| {
        for force in view.wheel_forces() {
            worst = worst.max((force / (wagon().mass() * 9.81 / 4.0) - 1.0).abs());
        }
    });
    println!("rigid track: wheel forces within {worst:.1e}");
    assert!(worst < 1e-9, "{worst:.3e}");
}

/// On an even track only the sleeper passing moves the wheels, from the first step on.
#[test]
fn even_track_is_steady() {
    let model = ballast(80);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, 1e-4);
    let (mut early, mut late) = ((f64::INFINITY, 0.0f64), (f64::INFINITY, 0.0f64));
    let still = wagon().mass() * 9.81 / 4.0;
    run(&stepper, &level, wagon(), (15.0, 40.0), |view| {
        let range = if view.time() < 0.05 { &mut early } else { &mut late };
        for force in view.wheel_forces() {
            *range = (range.0.min(force / still), range.1.max(force / still));
        }
    });
    println!("wheel forces: first 50 ms {early:?}, later {late:?}");
    let within = |range: (f64, f64)| range.0 > 0.99 && range.1 < 1.01;
    assert!(within(early) && within(late));
}

/// A rail with shear has a kink over each seat, which acts on a wheel all along an even track; a start on a kink causes
/// no additional motion.
#[test]
fn a_start_on_a_kink_is_steady() {
    let mut model = ballast(80);
    model.rail[0].shear = Some(Shear { stiffness: 248e6, rotary_inertia: 0.24 });
    let level = TrackLevel::as_built(&model);
    let seat = model.seats[25].x;
    let stepper = stepper(model, 5e-5);
    let (mut early, mut late) = ((f64::INFINITY, 0.0f64), (f64::INFINITY, 0.0f64));
    let still = wagon().mass() * 9.81 / 4.0;
    run(&stepper, &level, wagon(), (seat, 40.0), |view| {
        let range = if view.time() < 0.05 { &mut early } else { &mut late };
        for force in view.wheel_forces() {
            *range = (range.0.min(force / still), range.1.max(force / still));
        }
    });
    println!("wheel forces under shear: first 50 ms {early:?}, later {late:?}");
    assert!(late.0 > 0.96 && late.1 < 1.04);
    assert!(early.0 > late.0 - 0.01 && early.1 < late.1 + 0.01);
}

#[test]
fn direction_mirrors() {
    let model = ballast(40);
    let level = hollow(&model, 1e-3, 1.5e-3, 9.0, 2.0);
    let level = TrackLevel { ends: [1e-3; 2], ..level };
    let length = model.ends[1];
    let mut mirrored = level.clone();
    mirrored.settlements.reverse();
    let stepper = stepper(model, 1e-4);
    let (mut there, mut back) = (Vec::new(), Vec::new());
    run(&stepper, &level, wagon(), (10.0, 20.0), |view| there.extend_from_slice(view.wheel_forces()));
    run(&stepper, &mirrored, wagon(), (length - 10.0, length - 20.0), |view| {
        back.extend_from_slice(view.wheel_forces())
    });
    assert_eq!(there.len(), back.len());
    for (a, b) in there.iter().zip(&back) {
        assert!((a - b).abs() < 1e-8 * a, "{a} {b}");
    }
}

/// Sleepers that are lifted and released bounce on their supports and lose energy.
#[test]
fn bouncing_loses_energy() {
    let seats = Some(Seating { stiffness: 10e6, closure: 0.2e-3 });
    for (damping, depth, seating) in [
        (50e3, 0.0, None),
        (50e3, 2e-3, None),
        (0.0, 0.0, None),
        (0.0, 2e-3, None),
        (50e3, 0.0, seats),
        (50e3, 2e-3, seats),
        (0.0, 0.0, seats),
    ] {
        let mut model = ballast(20);
        for seat in &mut model.seats {
            seat.pad_damping = 0.0;
            seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: damping, seating };
        }
        let level = TrackLevel { ends: [0.0; 2], ..hollow(&model, 0.0, depth, 6.0, 3.0) };
        let stepper = stepper(model, 1e-4);
        let up = Loads { sleepers: &[(8, -60e3), (9, -60e3), (10, -60e3)], ..Loads::default() };
        let state = solve_static(stepper.track(), &level, &up).unwrap();
        assert!(state.contact_forces[9] == 0.0);
        let mut passage = Passage::released(&stepper, &level, state, 3000).unwrap();
        let rest = {
            let still = solve_static(stepper.track(), &level, &Loads::default()).unwrap();
            Passage::released(&stepper, &level, still, 1).unwrap().energy()
        };
        let start = passage.energy() - rest;
        let (mut lowest, mut growth, mut opened) = (start, 0.0f64, false);
        for _ in 0..3000 {
            passage.step().unwrap();
            let energy = passage.energy() - rest;
            growth = growth.max((energy - lowest) / start);
            lowest = lowest.min(energy);
            let view = passage.view();
            let forces: Vec<f64> = (0..20).filter_map(|seat| view.contact_force(seat)).collect();
            assert!(forces.iter().all(|f| *f >= 0.0));
            opened |= forces[..8].contains(&0.0);
        }
        println!(
            "damping {damping}, hollow {depth}, {seating:?}: largest growth {growth:.2e}, left {:.2e}",
            lowest / start
        );
        assert!(opened && start > 0.0);
        assert!(growth < if damping > 0.0 { 1e-4 } else { 5e-3 }, "{growth:.3e}");
        assert!(lowest / start > -1e-6);
    }
}

/// Voids open and close under a wagon: with half the step, the peaks are the same.
#[test]
fn peaks_do_not_hang_on_the_step() {
    let model = transition(45, 20);
    let level = hollow(&model, 2e-3, 1e-3, -3.0, 2.4);
    let peaks = |time_step: f64| envelope(&stepper(model.clone(), time_step), &level, (-14.0, 5.0));
    let (coarse, fine) = (peaks(1e-4), peaks(5e-5));
    let largest = fine.contact_forces.iter().fold(0.0f64, |m, f| m.max(*f));
    let mut worst = 0.0f64;
    for (a, b) in coarse.contact_forces.iter().zip(&fine.contact_forces) {
        worst = worst.max((a - b).abs() / largest);
    }
    for (a, b) in coarse.wheel_forces.iter().zip(&fine.wheel_forces) {
        worst = worst.max((a.1 - b.1).abs() / b.1);
    }
    for (a, b) in coarse.seat_loads.iter().zip(&fine.seat_loads) {
        worst = worst.max((a.1 - b.1).abs() / largest);
    }
    println!("peaks change by {worst:.2e} with half the step; largest contact force {largest:.0} N");
    assert!(worst < 0.02);
    assert!(fine.contact_losses.iter().any(|t| *t > 0.0));
    // Every axle gives a peak, and the largest axle peak is the peak of the seat.
    for seat in 20..40 {
        let axles = fine.axle_peaks_of(seat);
        assert_eq!(axles.len(), 4);
        let most = axles.iter().fold(0.0f64, |m, f| m.max(*f));
        assert_eq!(most, fine.contact_forces[seat]);
        // The spring carries nearly all of it, the damper the rest.
        let deflection = fine.axle_deflections_of(seat).iter().fold(0.0f64, |m, d| m.max(*d));
        let Foot::Sleeper { support_stiffness, .. } = transition(45, 20).seats[seat].foot else { continue };
        let share = support_stiffness * deflection / most;
        assert!((0.75..1.25).contains(&share), "seat {seat}: {share}");
    }
}

/// A bay of four elements is fine enough, and one of eight agrees.
#[test]
fn peaks_do_not_hang_on_the_mesh() {
    let peaks = |elements: usize| {
        let mut model = transition(45, 20);
        model.elements_per_bay = elements;
        let level = hollow(&model, 2e-3, 1e-3, -3.0, 2.4);
        envelope(&stepper(model, 1e-4), &level, (-14.0, 5.0))
    };
    let (coarse, fine) = (peaks(4), peaks(8));
    let largest = fine.contact_forces.iter().fold(0.0f64, |m, f| m.max(*f));
    let change = coarse.contact_forces.iter().zip(&fine.contact_forces).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    println!("peaks change by {:.2e} with half the elements", change / largest);
    assert!(change / largest < 0.02);
}

/// Vehicles coupled only by the track: two wagons far apart each behave like one.
#[test]
fn wagons_of_a_train() {
    let model = ballast(90);
    let level = hollow(&model, 1e-3, 1e-3, 40.0, 2.0);
    let level = TrackLevel { ends: [1e-3; 2], ..level };
    let stepper = stepper(model, 1e-4);
    let train = Train { vehicles: vec![(wagon().into(), 0.0), (wagon().into(), 12.0)], direction: Direction::Forward };
    let mut both = Envelope::default();
    let run_ = Run { train: &train, start: 26.0, finish: 50.0, motion: &Motion::Constant(55.56) };
    Passage::new(&stepper, &level, run_).unwrap().run(&mut both).unwrap();
    let single = envelope(&stepper, &level, (26.0, 50.0));
    assert_eq!(both.wheel_forces.len(), 8);
    for (a, b) in both.wheel_forces.iter().zip(&single.wheel_forces) {
        assert!((a.1 / b.1 - 1.0).abs() < 0.02, "{a:?} {b:?}");
    }
}

#[test]
fn impossible_runs_are_refused() {
    assert!(matches!(Scheme::generalised_alpha(0.0, RHO), Err(TrackError::Parameter { .. })));
    assert!(matches!(Scheme::generalised_alpha(1e-4, 1.1), Err(TrackError::Parameter { .. })));
    let model = ballast(40);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, 1e-4);
    let train = Train::single(wagon(), Direction::Forward);
    let run = Run { train: &train, start: 10.0, finish: 20.0, motion: &Motion::Constant(50.0) };
    for broken in [
        Run { start: 5.0, ..run },
        Run { finish: 30.0, ..run },
        Run { motion: &Motion::Constant(0.0), ..run },
        Run { finish: 9.0, ..run },
    ] {
        assert!(Passage::new(&stepper, &level, broken).is_err());
    }
    let short = TrackLevel { settlements: vec![0.0; 3], ends: [0.0; 2] };
    assert!(matches!(Passage::new(&stepper, &short, run), Err(TrackError::Parameter { .. })));
}
