//! Rail ends beyond which the track goes on.

use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

/// Ballasted track with a vibrating rail: light damping everywhere.
fn ringing(seats: usize, rail_ends: RailEnds) -> TrackModel {
    let mut model = ballast(seats);
    model.rail_ends = rail_ends;
    model.seats.iter_mut().for_each(|s| {
        s.pad_damping = 500.0;
        s.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 5e3, seating: None };
    });
    model
}

/// Near an end the track is as stiff as if it were continuous.
#[test]
fn the_track_goes_on_at_rest() {
    let deflection = |bays: usize, x: f64, rail_ends| {
        let model = ringing(bays, rail_ends);
        let level = TrackLevel::as_built(&model);
        let track = Track::new(model).unwrap();
        let loads = Loads { rail: &[(x, 100e3)], ..Loads::default() };
        let state = solve_static(&track, &level, &loads).unwrap();
        assert!((state.balance.supports() / state.balance.loads - 1.0).abs() < 1e-9);
        state.rail_deflection_at(&track, x).unwrap()
    };
    let endless = deflection(200, 60.3, RailEnds::Free);
    for from_end in [0.3, 0.9, 1.5, 2.7] {
        let error = |rail_ends| (deflection(40, 24.0 - from_end, rail_ends) / endless - 1.0).abs();
        let (found, held) = (error(RailEnds::Absorbing), error(RailEnds::Clamped));
        println!("{from_end} m from the end: absorbing {found:.4}, clamped {held:.4}");
        assert!(found < 0.02 && found < held + 0.001, "{from_end}: {found} {held}");
    }
}

/// Deflection of the rail 9 m from the right end after a load there is removed.
fn ring(bays: usize, rail_ends: RailEnds) -> Vec<f64> {
    let model = ringing(bays, rail_ends);
    let level = TrackLevel::as_built(&model);
    let x = model.ends[1] - 9.3;
    let scheme = Scheme::generalised_alpha(2e-5, 1.0).unwrap();
    let stepper = Stepper::new(Arc::new(Track::new(model).unwrap()), scheme).unwrap();
    let track = stepper.track();
    let node = track.nodes().iter().position(|n| (n - x).abs() < 1e-9).unwrap();
    let state = solve_static(track, &level, &Loads { rail: &[(x, 1e3)], ..Loads::default() }).unwrap();
    let mut deflections = Vec::new();
    let mut look = |view: &StepView<'_>| deflections.push(view.rail_deflection(node));
    Passage::released(&stepper, &level, state, 3000).unwrap().run(&mut look).unwrap();
    deflections
}

/// Waves reflected by an absorbing end are weaker than by a clamped end. The reference is a track so long that its
/// reflections arrive later.
#[test]
fn waves_leave_through_an_absorbing_end() {
    let model = |ends| ring(60, ends);
    // The node lies 9.3 m from the right end; with 120 bays more to the right it lies in the middle.
    let reference = {
        let model = ringing(240, RailEnds::Free);
        let level = TrackLevel::as_built(&model);
        let x = 0.3 + 0.6 * 120.0;
        let scheme = Scheme::generalised_alpha(2e-5, 1.0).unwrap();
        let stepper = Stepper::new(Arc::new(Track::new(model).unwrap()), scheme).unwrap();
        let node = stepper.track().nodes().iter().position(|n| (n - x).abs() < 1e-9).unwrap();
        let state = solve_static(stepper.track(), &level, &Loads { rail: &[(x, 1e3)], ..Loads::default() }).unwrap();
        let mut deflections = Vec::new();
        let mut look = |view: &StepView<'_>| deflections.push(view.rail_deflection(node));
        Passage::released(&stepper, &level, state, 3000).unwrap().run(&mut look).unwrap();
        deflections
    };
    let rest = |values: &[f64]| *values.last().unwrap();
    let error = |ends| {
        let values: Vec<f64> = model(ends);
        let difference: f64 =
            values.iter().zip(&reference).map(|(a, b)| (a - rest(&values) - (b - rest(&reference))).powi(2)).sum();
        let size: f64 = reference.iter().map(|b| (b - rest(&reference)).powi(2)).sum();
        (difference / size).sqrt()
    };
    let (absorbing, clamped, free) = (error(RailEnds::Absorbing), error(RailEnds::Clamped), error(RailEnds::Free));
    println!("echo: absorbing {absorbing:.4}, clamped {clamped:.4}, free {free:.4}");
    assert!(absorbing < 0.25 * clamped.min(free));
}
