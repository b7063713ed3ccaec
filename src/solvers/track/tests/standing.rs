//! One load at many places: compared with the plain solver at each place, and with closed forms.

use super::scenes::*;
use crate::solvers::track::*;

/// Winkler: deflection of a long beam on springs `k` (N/m a seat, 0.6 m apart) under a unit load, as a stiffness.
fn winkler(support: f64, pad: f64) -> f64 {
    let seat = 1.0 / (1.0 / support + 1.0 / pad);
    let (foundation, bending) = (seat / 0.6, 6.4e6_f64);
    let decay = (foundation / (4.0 * bending)).powf(0.25);
    2.0 * foundation / decay
}

fn uniform(support_stiffness: f64) -> TrackModel {
    let foot = Foot::Sleeper { mass: 150.0, support_stiffness, support_damping: 0.0, seating: None };
    let seats = (0..101).map(|i| seat(0.6 * f64::from(i), foot)).collect();
    TrackModel { ends: [-0.6, 60.6], rail: rail([-0.6, 60.6], 60.0, 6.4e6), seats, ..ballast(2) }
}

#[test]
fn each_place_is_an_equilibrium_of_its_own() {
    let model = transition(40, 20);
    let level = hollow(&model, 1e-3, 2e-3, -2.4, 2.0);
    let track = Track::new(model).unwrap();
    let places: Vec<f64> = (0..200).map(|k| -23.9 + 0.17 * f64::from(k)).collect();
    let found = standing_deflections(&track, &level, 98.1e3, &places).unwrap();
    for (x, found) in places.iter().zip(&found) {
        let loads = Loads { rail: &[(*x, 98.1e3)], ..Loads::default() };
        let state = solve_static(&track, &level, &loads).unwrap();
        let expected = state.rail_deflection_at(&track, *x).unwrap();
        assert!((found - expected).abs() < 1e-12, "at {x} m: {found} and {expected}");
    }
    let refused = standing_deflections(&track, &level, 1.0, &[0.0, 99.0]).unwrap_err();
    assert!(matches!(refused, TrackError::OffTrack { .. }), "{refused:?}");
}

#[test]
fn a_uniform_track_is_as_stiff_as_winkler_says() {
    // rail-level stiffness of supports of 20, 30, 40 and 60 MN/m under pads of 40 MN/m
    for (support, closed_form) in [(20e6, 46.0e6), (30e6, 55.6e6), (40e6, 62.4e6), (60e6, 71.6e6)] {
        assert!((winkler(support, 40e6) / closed_form - 1.0).abs() < 2e-3);
        let track = Track::new(uniform(support)).unwrap();
        let level = TrackLevel { settlements: vec![0.0; 101], ends: [0.0; 2] };
        let rest = solve_static(&track, &level, &Loads::default()).unwrap();
        let stiffness = |x: f64, load: f64| {
            let deflection = standing_deflections(&track, &level, load, &[x]).unwrap()[0];
            load / (deflection - rest.rail_deflection_at(&track, x).unwrap())
        };
        // a load that lifts no sleeper: the linear track
        let (seat, bay) = (stiffness(30.0, 1e3), stiffness(30.3, 1e3));
        assert!(seat > bay, "softer between the seats");
        for value in [seat, bay] {
            assert!((value / closed_form - 1.0).abs() < 0.02, "{support} N/m: {value} against {closed_form}");
        }
        // under a wheel, sleepers that the rail lifts pull less: the track is slightly softer
        let wheel = stiffness(30.0, 98.1e3);
        assert!(wheel <= seat * (1.0 + 1e-9) && wheel > 0.99 * seat, "{wheel} and {seat}");
    }
}
