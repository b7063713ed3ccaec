//! Descriptions of one track that give one result: sections of equal form, places shifted along the line, longer
//! models.

use crate::scenes::*;
use trackbed::solvers::track::*;

/// Voids between 12 and 15 m.
fn hollow(model: &TrackModel, shift: f64) -> TrackLevel {
    let depth = |x: f64| if (x - 13.5 - shift).abs() < 1.5 { 1.5e-3 } else { 0.0 };
    TrackLevel { settlements: model.seats.iter().map(|s| depth(s.x)).collect(), ends: [0.0; 2] }
}

fn change(a: &[[f64; 4]], b: &[[f64; 4]]) -> f64 {
    assert_eq!(a.len(), b.len());
    largest(a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) / static_force()))
}

/// A rail in one piece and in pieces from seat to seat are the same rail.
#[test]
fn sections_of_equal_form() {
    let model = ballast(45);
    let level = hollow(&model, 0.0);
    let mut pieces = model.clone();
    let whole = pieces.rail[0];
    let cuts: Vec<f64> = [0.0].into_iter().chain(model.seats.iter().step_by(3).map(|s| s.x)).chain([27.0]).collect();
    pieces.rail = cuts.windows(2).map(|c| RailSection { start: c[0], end: c[1], ..whole }).collect();
    let forces = |model: &TrackModel| wheel_forces(&stepper(model.clone(), scheme(1e-4)), &level, 11.0, 19.0);
    let found = change(&forces(&model), &forces(&pieces));
    println!("sixteen sections instead of one: {found:.1e} of the static force");
    assert!(found < 1e-12, "found {found:.1e}");
}

/// The chainage at which a line begins is a name.
#[test]
fn shifted_along_the_line() {
    let model = ballast(45);
    let shift = 4096.0; // keeps the places of the seats exact to 1e-12 m
    let mut moved = model.clone();
    moved.ends = model.ends.map(|x| x + shift);
    moved.rail[0] = RailSection { start: shift, end: shift + 27.0, ..model.rail[0] };
    moved.seats.iter_mut().for_each(|seat| seat.x += shift);
    let here = wheel_forces(&stepper(model.clone(), scheme(1e-4)), &hollow(&model, 0.0), 11.0, 19.0);
    let there = wheel_forces(&stepper(moved.clone(), scheme(1e-4)), &hollow(&moved, shift), 11.0 + shift, 19.0 + shift);
    let found = change(&here, &there);
    println!("{shift} m further on: {found:.1e} of the static force");
    assert!(found < 1e-7, "found {found:.1e}");
}

/// Twice the track around the same window changes its largest wheel force by less than 1 %.
#[test]
fn twice_the_length() {
    let extremes = |seats: usize| {
        let model = ballast(seats);
        let shift = 0.3 * (seats - 45) as f64;
        let forces =
            wheel_forces(&stepper(model.clone(), scheme(1e-4)), &hollow(&model, shift), 11.0 + shift, 19.0 + shift);
        let all = forces.into_iter().flatten();
        all.fold((f64::INFINITY, 0.0f64), |(low, high), f| (low.min(f), high.max(f)))
    };
    let (once, twice) = (extremes(45), extremes(91));
    println!("27 m: {once:?} N, 54.6 m: {twice:?} N");
    assert!((once.1 / twice.1 - 1.0).abs() < 0.01, "largest force");
    assert!((once.0 / twice.0 - 1.0).abs() < 0.01, "smallest force");
}
