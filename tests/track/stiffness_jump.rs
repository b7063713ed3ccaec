//! A beam on an elastic foundation whose stiffness jumps tenfold: EI = 12.8 MN m², 120 kg/m, 0.8 and 8 MN/m², 18 kN.

use crate::modal::Modes;
use crate::scenes::*;
use trackbed::solvers::track::*;

pub const EI: f64 = 1.28e7;
pub const SOFT: f64 = 8e5;
pub const STIFF: f64 = 8e6;
pub const MASS: f64 = 120.0;
pub const LOAD: f64 = 18e3;

/// Springs in place of a foundation; the one on the jump takes half of each side.
pub fn jump(half: f64, spacing: f64) -> TrackModel {
    let mut model = beam([-half, half], EI, MASS, RailEnds::Free, 1);
    let count = (half / spacing).round() as i64;
    model.seats = (-count..=count)
        .map(|i| {
            let x = spacing * i as f64;
            let whole = if i == 0 {
                0.5 * (SOFT + STIFF)
            } else if i < 0 {
                SOFT
            } else {
                STIFF
            };
            spring(x, spacing * whole * if i.abs() == count { 0.5 } else { 1.0 }, 0.0)
        })
        .collect();
    model
}

/// Deflection under a load that stands far from the jump.
#[test]
fn standing_load() {
    let model = jump(50.0, 0.5);
    let level = TrackLevel::as_built(&model);
    let track = Track::new(model).unwrap();
    let modes = Modes::of(&track);
    let at = |x: f64| {
        let found = solve_static(&track, &level, &Loads { rail: &[(x, LOAD)], ..Loads::default() }).unwrap();
        let node = track.nodes().iter().position(|n| (n - x).abs() < 1e-9).unwrap();
        let dense = modes.at_rest(&modes.force(x, LOAD))[2 * node];
        assert!((found.rail_deflection[node] / dense - 1.0).abs() < 1e-8, "dense matrices at {x} m");
        found.rail_deflection[node]
    };
    let far = |k: f64| LOAD * (k / (4.0 * EI)).powf(0.25) / (2.0 * k);
    assert!((far(SOFT) - 3.97748e-3).abs() < 1e-8 && (far(STIFF) - 0.70731e-3).abs() < 1e-8);
    let (soft, stiff) = (at(-25.0), at(25.0));
    println!("{:.5} mm and {:.5} mm", soft * 1e3, stiff * 1e3);
    assert!((soft / 3.97748e-3 - 1.0).abs() < 5e-4, "found {soft}");
    assert!((stiff / 0.70731e-3 - 1.0).abs() < 5e-4, "found {stiff}");
}

/// On the jump two half beams share deflection, slope and moment: force and moment on the end of one are `4EIλ³ w +
/// 2EIλ² w'` and `2EIλ² w + 2EIλ w'`. The springs come closer to it with the square of their spacing.
#[test]
fn load_on_the_jump() {
    let [a, b] = [SOFT, STIFF].map(|k| (k / (4.0 * EI)).powf(0.25));
    let (force, moment, turn) = (4.0 * EI * (a.powi(3) + b.powi(3)), 2.0 * EI * (a * a - b * b), 2.0 * EI * (a + b));
    let expected = LOAD / (force - moment * moment / turn);
    let errors = [0.5, 0.25, 0.125].map(|spacing| {
        let model = jump(30.0, spacing);
        let level = TrackLevel::as_built(&model);
        let track = Track::new(model).unwrap();
        let state = solve_static(&track, &level, &Loads { rail: &[(0.0, LOAD)], ..Loads::default() }).unwrap();
        (spacing, (state.rail_deflection_at(&track, 0.0).unwrap() / expected - 1.0).abs())
    });
    let found = order(&errors);
    println!("{:.5} mm, springs differ by {errors:?}, order {found:.2}", expected * 1e3);
    assert!(errors[2].1 < 1e-3 && (found - 2.0).abs() < 0.2, "found 4e-4 and 2.0");
}
