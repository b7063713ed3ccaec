//! States of rest.

use super::super::*;
use super::scenes::*;

fn column(formulation: Formulation) -> Soil {
    let mut soil = soil(block([0.2, 0.2, 2.0], [2, 2, 20], SUBGRADE), formulation, 9.81);
    support(&mut soil, &WALLS, Support::Roller);
    support(&mut soil, &[Side::Bottom], Support::Fixed);
    soil
}

/// `u(z) = -ρ g (H z - z²/2) / M`, exact at the nodes.
#[test]
fn a_column_settles_under_its_weight() {
    for formulation in FORMULATIONS {
        let mut soil = column(formulation);
        soil.rest(&[]).unwrap();
        for (place, u) in soil.mesh().nodes().iter().zip(soil.displacements()) {
            let exact =
                -SUBGRADE.density * 9.81 * (2.0 * place[2] - 0.5 * place[2].powi(2)) / SUBGRADE.constrained_modulus();
            assert!((u[2] - exact).abs() < 1e-11 * 1e-4, "{} {exact}", u[2]);
            assert!(u[0].abs() < 1e-15 && u[1].abs() < 1e-15);
        }
        // at rest: a step moves nothing
        soil.step(soil.limit()).unwrap();
        assert!(soil.velocities().iter().flatten().all(|v| v.abs() < 1e-12));
    }
}

/// The same by motion with local damping.
#[test]
fn damped_motion_ends_at_rest() {
    for formulation in FORMULATIONS {
        let mut still = column(formulation);
        still.rest(&[]).unwrap();
        let damping = Damping { local: 0.8, ..Damping::default() };
        let settings = Settings { formulation, gravity: [0.0, 0.0, -9.81], damping };
        let mut moving = Soil::new(still.mesh().clone(), settings).unwrap();
        support(&mut moving, &WALLS, Support::Roller);
        support(&mut moving, &[Side::Bottom], Support::Fixed);
        let dt = 0.95 * moving.limit();
        (0..3000).for_each(|_| moving.step(dt).unwrap());
        for (a, b) in still.displacements().iter().flatten().zip(moving.displacements().iter().flatten()) {
            assert!((a - b).abs() < 1e-6 * 1e-4, "{a} {b}");
        }
    }
}

#[test]
fn soil_that_nothing_holds_has_no_rest() {
    let mut free = soil(block([1.0; 3], [2; 3], SUBGRADE), Formulation::MeanStrain, 9.81);
    assert_eq!(free.rest(&[]), Err(SoilError::NotHeld));
    // springs under all nodes hold it
    let springs: Vec<_> = (0..27).map(|node| (node, [1e6; 3])).collect();
    free.rest(&springs).unwrap();
    let sum: f64 = free.displacements().iter().map(|u| -1e6 * u[2]).sum();
    assert!((sum / (2100.0 * 9.81) - 1.0).abs() < 1e-9);
}

/// A quiet bottom goes on bearing the weight when motion begins.
#[test]
fn a_quiet_face_bears_what_it_bore_at_rest() {
    let mut soil = soil(block([0.2, 0.2, 1.0], [2, 2, 10], SUBGRADE), Formulation::MeanStrain, 9.81);
    support(&mut soil, &WALLS, Support::Roller);
    support(&mut soil, &[Side::Bottom], Support::Quiet);
    soil.rest(&[]).unwrap();
    (0..200).for_each(|_| soil.step(1e-4).unwrap());
    assert!(soil.velocities().iter().flatten().all(|v| v.abs() < 1e-10));
}
