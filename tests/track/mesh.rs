//! What the length of the elements moves.

use crate::frequencies::amplitude;
use crate::scenes::*;
use trackbed::solvers::track::*;

/// Two stretches of sleepers on supports of 132 and 1320 MN/m under the wagon, 1, 2, 4 and 8 elements a bay: the rail over the
/// first stiff sleeper, against the finest mesh and, as is usual, against the coarsest.
#[test]
fn elements_between_seats() {
    let run = |elements: usize| {
        let mut model = ballast(50);
        model.elements_per_bay = elements;
        for (i, seat) in model.seats.iter_mut().enumerate() {
            let support_stiffness = if i < 25 { 132e6 } else { 1320e6 };
            seat.foot = Foot::Sleeper { mass: 140.0, support_stiffness, support_damping: 30e3 };
        }
        let level = TrackLevel::as_built(&model);
        let stepper = stepper(model, scheme(1e-4));
        let node = stepper.track().seat_node(25);
        let mut values = Vec::new();
        pass(&stepper, &level, 11.0, 24.0, |view| values.push(view.rail_deflection(node)));
        values
    };
    let runs = [1, 2, 4, 8].map(run);
    let peak = largest(runs[3].iter().copied());
    let against = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| (a - b) / peak));
    let fine: Vec<f64> = runs[..3].iter().map(|r| against(r, &runs[3])).collect();
    let coarse: Vec<f64> = runs[1..].iter().map(|r| against(r, &runs[0])).collect();
    println!("1, 2, 4 against 8 elements {fine:?}; 2, 4, 8 against 1 {coarse:?}; parts of {:.3} mm", peak * 1e3);
    assert!(coarse.iter().all(|c| *c < 1e-3), "found 3.7e-4");
    assert!(fine[0] < 1e-3 && fine[1] < 1e-4 && fine[2] < 2e-5, "found 3.7e-4, 3.2e-5, 7.8e-6");
}

/// A wheel that crosses the nodes of its mesh feels none: the wheel force at all multiples of the passing of sleepers, where
/// the nodes of 2, 3 or 8 elements a bay would be heard, is that of a mesh of 6.
#[test]
fn nodes_are_not_felt() {
    let passing = SPEED / 0.6;
    for shear in [None, Some(SHEAR)] {
        let spectrum = |elements: usize| {
            let mut model = ballast(75);
            (model.elements_per_bay, model.rail[0].shear) = (elements, shear);
            let level = TrackLevel::as_built(&model);
            let forces = wheel_forces(&stepper(model, scheme(5e-5)), &level, 17.0, 35.0);
            let late: Vec<f64> = forces[forces.len() / 3..].iter().map(|f| f[0] / static_force()).collect();
            [1, 2, 3, 4, 5, 6, 8].map(|n| amplitude(&late, 5e-5, n as f64 * passing))
        };
        let fine = spectrum(12);
        println!("{shear:?}: {:.2?} parts of 10 000 of the static force with 6 elements", fine.map(|a| 1e4 * a));
        for (elements, found) in [1, 2, 3, 4, 5, 6, 8].map(|elements| (elements, spectrum(elements))) {
            let differences: Vec<f64> = found.iter().zip(&fine).map(|(a, b)| 1e4 * (a - b)).collect();
            println!("{elements} elements differ by {differences:.3?}");
            // One element of 0.6 m hands the inertia of its bay to the seats only: 8 % less of the passing of sleepers,
            // which is 2.4e-3 itself.
            let largest = largest(differences.iter().copied().skip(usize::from(elements == 1)));
            assert!(shear.is_some() || largest < 1.0, "found 0.77, 0.85 and less: {largest}");
            assert!(shear.is_some() || differences[0].abs() < if elements == 1 { 2.5 } else { 1e-2 }, "found 1.8 and 5e-4");
        }
    }
}
