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
        // at rest: a step does not move anything
        soil.step(soil.limit()).unwrap();
        assert!(soil.velocities().iter().flatten().all(|v| v.abs() < 1e-12));
    }
}

/// The same result by motion with local damping.
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
    // springs under all nodes hold the soil
    let springs: Vec<_> = (0..27).map(|node| (node, [1e6; 3])).collect();
    free.rest(&springs).unwrap();
    let sum: f64 = free.displacements().iter().map(|u| -1e6 * u[2]).sum();
    assert!((sum / (2100.0 * 9.81) - 1.0).abs() < 1e-9);
}

/// A quiet bottom still carries the weight when motion begins.
#[test]
fn a_quiet_face_bears_what_it_bore_at_rest() {
    let mut soil = soil(block([0.2, 0.2, 1.0], [2, 2, 10], SUBGRADE), Formulation::MeanStrain, 9.81);
    support(&mut soil, &WALLS, Support::Roller);
    support(&mut soil, &[Side::Bottom], Support::Quiet);
    soil.rest(&[]).unwrap();
    (0..200).for_each(|_| soil.step(1e-4).unwrap());
    assert!(soil.velocities().iter().flatten().all(|v| v.abs() < 1e-10));
}

/// The soil under a plate of springs gives the same result as the condensed stiffness.
#[test]
fn a_condensed_soil_answers_as_the_whole() {
    for formulation in FORMULATIONS {
        let mut soil = soil(block([0.6, 0.5, 0.4], [6, 5, 4], SUBGRADE), formulation, 0.0);
        support(&mut soil, &WALLS, Support::Roller);
        support(&mut soil, &[Side::Bottom], Support::Fixed);
        let nodes = [soil.mesh().nearest([0.2, 0.2, 0.4]), soil.mesh().nearest([0.4, 0.3, 0.4])];
        let freedoms: Vec<_> = nodes.iter().flat_map(|&node| (0..3).map(move |axis| (node, axis))).collect();
        let condensed = soil.condensed(&freedoms).unwrap();
        let force = nalgebra::DVector::from_vec(vec![10.0, -20.0, -300.0, 5.0, 7.0, -100.0]);
        let moved = &condensed.flexibility * &force;
        let back = condensed.stiffness().unwrap() * &moved;
        (0..2).for_each(|at| soil.add_force(nodes[at], [0, 1, 2].map(|axis| force[3 * at + axis])));
        soil.rest(&[]).unwrap();
        for (i, &(node, axis)) in freedoms.iter().enumerate() {
            assert!((moved[i] - soil.displacements()[node][axis]).abs() < 1e-10 * moved.amax());
            assert!((back[i] - force[i]).abs() < 1e-8 * force.amax());
        }
    }
}

/// A load below the bearing capacity of a footing comes to rest; a load above it is refused and leaves the soil
/// unchanged.
#[test]
fn a_load_beyond_the_bearing_capacity_is_refused() {
    let clay = Strength { cohesion: 10e3, friction_angle: 0.0, dilation_angle: 0.0, tension: f64::INFINITY };
    let material = Material { density: 2000.0, youngs_modulus: 20e6, poisson_ratio: 0.3, strength: Some(clay) };
    for formulation in FORMULATIONS {
        let mut soil = soil(block([3.0, 0.25, 2.0], [12, 1, 8], material), formulation, 0.0);
        support(&mut soil, &WALLS, Support::Roller);
        support(&mut soil, &[Side::Bottom], Support::Fixed);
        let load = |soil: &mut Soil, pressure: f64| {
            for node in soil.side_nodes(Side::Top) {
                let x = soil.mesh().nodes()[node][0];
                let share = if x < 0.1 || (x - 1.0).abs() < 0.1 { 0.5 } else { f64::from(x < 1.0) };
                soil.add_force(node, [0.0, 0.0, -pressure * share * 0.25 * 0.125]);
            }
        };
        let middle = soil.mesh().nearest([0.0, 0.0, 2.0]);
        load(&mut soil, 10e3);
        soil.rest(&[]).unwrap();
        let elastic = soil.displacements()[middle][2];
        load(&mut soil, 40e3);
        soil.rest(&[]).unwrap();
        let yields = soil.displacements()[middle][2];
        assert!(yields < 1.05 * 4.0 * elastic, "{formulation:?} {elastic} {yields}");
        load(&mut soil, 80e3);
        assert!(matches!(soil.rest(&[]), Err(SoilError::NoRest { .. })), "{formulation:?}");
        assert_eq!(soil.displacements()[middle][2], yields);
    }
}

/// A cantilever of nearly incompressible soil in plane strain: `P L³ / 3 E' I + P L / κ G A` with E' = E / (1 - ν²).
#[test]
fn soil_that_keeps_its_volume_does_not_lock() {
    for (formulation, poisson_ratio) in FORMULATIONS.into_iter().flat_map(|f| [0.3, 0.49, 0.499].map(|nu| (f, nu))) {
        let material = Material { poisson_ratio, ..SUBGRADE };
        let mut soil = soil(block([10.0, 0.125, 1.0], [80, 1, 8], material), formulation, 0.0);
        support(&mut soil, &[Side::XMin], Support::Fixed);
        support(&mut soil, &[Side::YMin, Side::YMax], Support::Roller);
        let end = soil.side_nodes(Side::XMax);
        for &node in &end {
            let z = soil.mesh().nodes()[node][2];
            let share = if (0.1..0.9).contains(&z) { 1.0 } else { 0.5 };
            soil.add_force(node, [0.0, 0.0, -1000.0 * share / 16.0]);
        }
        soil.rest(&[]).unwrap();
        let (_, shear) = material.lame();
        let modulus = material.youngs_modulus / (1.0 - poisson_ratio * poisson_ratio);
        let per_width = 1000.0 / 0.125;
        let exact = per_width * (1000.0 / (3.0 * modulus / 12.0) + 10.0 / (5.0 / 6.0 * shear));
        let found = -end.iter().map(|&node| soil.displacements()[node][2]).sum::<f64>() / end.len() as f64;
        let fine = if formulation == Formulation::MeanStrain { 0.02 } else { 0.05 };
        assert!((found / exact - 1.0).abs() < fine, "{formulation:?} {poisson_ratio} {}", found / exact);
    }
}
