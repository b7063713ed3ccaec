//! What a wheel feels of a long track: its stiffness at the rail and how the seats share a load.

use crate::modal::Modes;
use crate::scenes::*;
use trackbed::solvers::track::*;

/// Pad 40 MN/m on supports of 20 to 60 MN/m and on rock, against the beam on a foundation smeared over 0.6 m and
/// against the same springs in dense matrices.
#[test]
fn stiffness_at_the_rail() {
    for (support, stiffness, share) in [
        (Some(20e6), 46.0e6, 0.29),
        (Some(30e6), 55.6e6, 0.31),
        (Some(40e6), 62.4e6, 0.32),
        (Some(60e6), 71.6e6, 0.34),
        (None, 105e6, 0.38),
    ] {
        let mut model = TrackModel { gravity: 0.0, elements_per_bay: 2, ..ballast(61) };
        for seat in &mut model.seats {
            seat.foot = support.map_or(Foot::Rigid, |k| Foot::Sleeper {
                mass: 150.0,
                support_stiffness: k,
                support_damping: 0.0,
                seating: None,
            });
        }
        let middle = model.seats[30].x;
        // Nothing holds a sleeper down without gravity: only a lifted one would differ.
        model.gravity = 9.81;
        let track = Track::new(model.clone()).unwrap();
        let level = TrackLevel::as_built(&model);
        let rest = solve_static(&track, &level, &Loads::default()).unwrap();
        let load = 1e3;
        let state = solve_static(&track, &level, &Loads { rail: &[(middle, load)], ..Loads::default() }).unwrap();
        let node = track.seat_node(30);
        let deflection = state.rail_deflection[node] - rest.rail_deflection[node];
        let modes = Modes::of(&track);
        let dense = modes.at_rest(&modes.force(middle, load))[2 * node];
        assert!((deflection / dense - 1.0).abs() < 1e-8, "springs in dense matrices");
        let found = load / deflection;
        let seat = (state.seat_loads[30] - rest.seat_loads[30]) / load;
        // Smeared: 2 k/λ per metre, and λ s/2 of the load on a seat under it.
        let series = support.map_or(40e6, |k: f64| k * 40e6 / (k + 40e6));
        let lambda = (series / 0.6 / (4.0 * 6.4e6)).powf(0.25);
        let smeared = 2.0 * series / 0.6 / lambda;
        println!(
            "{:.2} MN/m (smeared {:.2}), seat share {:.4} (smeared {:.4})",
            found / 1e6,
            smeared / 1e6,
            seat,
            0.3 * lambda
        );
        assert!((smeared / stiffness - 1.0).abs() < 2e-3 && (0.3 * lambda - share).abs() < 5e-3, "published");
        assert!((found / smeared - 1.0).abs() < 5e-3, "found {found}");
        assert!((seat - share).abs() < 0.01, "found {seat}");
    }
}
