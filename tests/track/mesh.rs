//! What the length of the elements moves.

use crate::frequencies::amplitude;
use crate::scenes::*;
use trackbed::solvers::track::*;

/// Two stretches of sleepers on supports of 132 and 1320 MN/m under the wagon, 1, 2, 4 and 8 elements a bay: the rail
/// over the first stiff sleeper, against the finest mesh and, as is usual, against the coarsest.
#[test]
fn elements_between_seats() {
    let run = |elements: usize| {
        let mut model = ballast(50);
        model.elements_per_bay = elements;
        for (i, seat) in model.seats.iter_mut().enumerate() {
            let support_stiffness = if i < 25 { 132e6 } else { 1320e6 };
            seat.foot = Foot::Sleeper { mass: 140.0, support_stiffness, support_damping: 30e3, seating: None };
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

/// A wheel that crosses the nodes of its mesh hardly feels them: at the multiples of the passing of sleepers, where the
/// nodes of 1 to 8 elements a bay are heard, the wheel force is that of a mesh of 12.
///
/// A rail that shears has a kink under the wheel. Between two nodes it stands in the contact, without mass, and at a
/// node in the rail, with it: the nodes are felt at any length of the elements.
#[test]
fn nodes_are_hardly_felt() {
    let passing = SPEED / 0.6;
    for (shear, passing_found, most) in [(None, 24.2, 1.0), (Some(SHEAR), 85.7, 25.0)] {
        let spectrum = |elements: usize| {
            let mut model = ballast(75);
            (model.elements_per_bay, model.rail[0].shear) = (elements, shear);
            let level = TrackLevel::as_built(&model);
            let forces = wheel_forces(&stepper(model, scheme(5e-5)), &level, 17.0, 35.0);
            let late: Vec<f64> = forces[forces.len() / 3..].iter().map(|f| f[0] / static_force()).collect();
            [1, 2, 3, 4, 5, 6, 8].map(|n| 1e4 * amplitude(&late, 5e-5, n as f64 * passing))
        };
        let fine = spectrum(12);
        println!("{shear:?}: {fine:.2?} parts of 10 000 of the static force");
        assert!((fine[0] - passing_found).abs() < 0.2);
        for (elements, found) in [1, 2, 4, 8].map(|elements| (elements, spectrum(elements))) {
            let differences: Vec<f64> = found.iter().zip(&fine).map(|(a, b)| a - b).collect();
            println!("{elements} elements differ by {differences:.3?}");
            // One element of 0.6 m also hands the inertia of its bay to the seats only: 8 % less of the passing itself.
            let largest = largest(differences.iter().copied().skip(usize::from(elements == 1)));
            assert!(largest < most, "found 0.77, 0.85, 0.12, 0.11, with shear 24 and less: {largest}");
            assert!(differences[0].abs() < if elements == 1 { 9.0 } else { 0.05 }, "found 1.8 or 7.6, then up to 0.03");
        }
    }
}
