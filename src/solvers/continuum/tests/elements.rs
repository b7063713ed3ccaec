//! Elements: linear fields, stability of single elements, order of convergence in their size.

use super::super::*;
use super::scenes::*;
use crate::solvers::continuum::kernel::elastic;
use crate::solvers::continuum::lanes::Lanes;
use crate::solvers::continuum::mesh::CORNERS;
use crate::solvers::continuum::shape::Shape;
use crate::solvers::continuum::tensor::Corners;

/// Gradient of a linear field of displacement: row by axis of displacement.
const GRADIENT: [[f64; 3]; 3] = [[1e-3, 2e-4, -3e-4], [-1e-4, -7e-4, 5e-4], [4e-4, 1e-4, 6e-4]];

fn linear(place: [f64; 3]) -> [f64; 3] {
    GRADIENT.map(|row| (0..3).map(|k| row[k] * place[k]).sum())
}

/// If the outer nodes have the displacements of a linear field, the inner nodes have them too, and the stress is exact
/// everywhere.
#[test]
fn a_linear_field_is_exact_in_distorted_elements() {
    for formulation in FORMULATIONS {
        let mut soil = soil(distorted(4, 0.3), formulation, 0.0);
        let places = soil.mesh().nodes().to_vec();
        for side in Side::ALL {
            for node in soil.side_nodes(side) {
                (0..3).for_each(|axis| soil.drive(node, axis, 0.0).unwrap());
                soil.set_motion(node, linear(places[node]), [0.0; 3]);
            }
        }
        soil.rest(&[]).unwrap();
        for (place, u) in places.iter().zip(soil.displacements()) {
            let exact = linear(*place);
            (0..3).for_each(|axis| assert!((u[axis] - exact[axis]).abs() < 1e-12 * 1e-3, "{u:?} {exact:?}"));
        }
        let (lambda, mu) = SUBGRADE.lame();
        let trace: f64 = (0..3).map(|axis| GRADIENT[axis][axis]).sum();
        let exact =
            |i: usize, j: usize| mu * (GRADIENT[i][j] + GRADIENT[j][i]) + if i == j { lambda * trace } else { 0.0 };
        for element in 0..soil.mesh().elements().len() {
            for (found, (i, j)) in soil.stress(element).iter().zip([(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)]) {
                assert!((found - exact(i, j)).abs() < 1e-12 * 1e6, "{found} {}", exact(i, j));
            }
        }
    }
}

#[test]
fn moving_and_turning_as_a_whole_costs_no_force() {
    for formulation in FORMULATIONS {
        let mut soil = soil(distorted(3, 0.3), formulation, 0.0);
        for (node, p) in soil.mesh().nodes().to_vec().into_iter().enumerate() {
            soil.set_motion(node, [0.1 - 1e-3 * p[1], 0.2 + 1e-3 * p[0], -0.3], [0.0; 3]);
        }
        soil.watch(true);
        soil.step(1e-6).unwrap();
        assert!(soil.energy().strain < 1e-12, "{}", soil.energy().strain);
        assert!(soil.velocities().iter().flatten().all(|v| v.abs() < 1e-9));
    }
}

/// Cubes: `h / sqrt(3 K / rho)` for the mean strain (methods 2.2), for a volumetric vibration.
#[test]
fn the_limit_of_a_cube() {
    let (lambda, mu) = SUBGRADE.lame();
    let bulk = lambda + 2.0 * mu / 3.0;
    let mut cube = soil(block([0.1; 3], [1; 3], SUBGRADE), Formulation::MeanStrain, 0.0);
    let theory = 0.1 / (3.0 * bulk / SUBGRADE.density).sqrt();
    assert!((cube.limit() / theory - 1.0).abs() < 1e-12, "{} {theory}", cube.limit());
    assert!((2.0 / cube.lanczos(24).unwrap().sqrt() / theory - 1.0).abs() < 1e-9);
    assert!(matches!(cube.step(1.001 * theory), Err(SoilError::Step { .. })));
    let springs: Vec<(usize, f64)> =
        (0..8).map(|node| (node, cube.masses()[node] * 3.0 * 4.0 / theory.powi(2))).collect();
    assert!((cube.limit_with(&springs) / theory - 0.5).abs() < 1e-12);
}

/// Below the limit no motion grows; two per cent above it the fastest vibration grows.
#[test]
fn motion_is_stable_up_to_the_limit() {
    for formulation in FORMULATIONS {
        let start = |soil: &mut Soil| {
            let mut numbers = Numbers(3);
            (0..soil.masses().len())
                .for_each(|node| soil.set_motion(node, [(); 3].map(|()| 1e-6 * numbers.next()), [0.0; 3]));
        };
        let mut block = soil(block([0.4, 0.3, 0.3], [4, 3, 3], SUBGRADE), formulation, 0.0);
        support(&mut block, &[Side::Bottom], Support::Fixed);
        let measured = 2.0 / block.lanczos(80).unwrap().sqrt();
        let bound = block.limit();
        assert!(bound <= measured && measured < 1.3 * bound, "{bound} {measured}");
        let allowed = block.measure_limit(40).unwrap();
        assert!(allowed > bound && allowed < measured, "{bound} {allowed} {measured}");
        let largest = |soil: &Soil| soil.displacements().iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
        for (dt, stable) in [(bound, true), (allowed, true), (0.999 * measured, true), (1.02 * measured, false)] {
            start(&mut block);
            (0..3000).try_for_each(|_| block.advance(dt)).ok();
            assert_eq!(largest(&block) < 1e-4, stable, "{formulation:?} {dt} {}", largest(&block));
        }
    }
}

/// A box on rollers on all sides under the body forces that cause `u_x = A sin(kx) cos(qz)`, `u_z = A cos(kx) sin(qz)`:
/// the error falls with the square of the size of the elements.
#[test]
fn the_error_is_of_second_order_in_the_size() {
    let (lambda, mu) = SUBGRADE.lame();
    let (k, q) = (std::f64::consts::PI / 2.0, std::f64::consts::PI);
    let stiff = (lambda + mu) * (k + q);
    for formulation in FORMULATIONS {
        let error = |spaces: usize| {
            let mut soil = soil(block([2.0, 0.5, 1.0], [2 * spaces, 2, spaces], SUBGRADE), formulation, 0.0);
            support(&mut soil, &Side::ALL, Support::Roller);
            let field = |[x, _, z]: [f64; 3]| [(k * x).sin() * (q * z).cos(), 0.0, (k * x).cos() * (q * z).sin()];
            for (node, place) in soil.mesh().nodes().to_vec().into_iter().enumerate() {
                let volume = soil.masses()[node] / SUBGRADE.density;
                let factors = [k, 0.0, q].map(|along| volume * (stiff * along + mu * (k * k + q * q)));
                let u = field(place);
                soil.add_force(node, [0, 1, 2].map(|axis| 1e-3 * factors[axis] * u[axis]));
            }
            soil.rest(&[]).unwrap();
            let nodes = soil.mesh().nodes().iter().zip(soil.displacements()).zip(soil.masses());
            let squares = nodes.map(|((place, u), mass)| {
                let exact = field(*place);
                mass * (0..3).map(|axis| (u[axis] / 1e-3 - exact[axis]).powi(2)).sum::<f64>()
            });
            (squares.sum::<f64>() / 2100.0).sqrt()
        };
        let [coarse, fine] = [6, 12].map(error);
        assert!(fine < 0.01, "{formulation:?} {fine}");
        assert!((coarse / fine).log2() > 1.9, "{formulation:?} {coarse} {fine} {}", (coarse / fine).log2());
    }
}

/// Sums over the edges of a brick give what its gradient and its patterns give.
#[test]
fn a_brick_answers_as_any_other_element() {
    let corners = CORNERS.map(|[x, y, z]| [0.05 * x + 3.0, 0.04 * y - 1.0, 0.07 * z + 0.2]);
    let brick = Shape::new(&corners, &SUBGRADE, Formulation::MeanStrain).unwrap();
    assert!(brick.edges.is_some());
    let general = Shape { edges: None, ..brick.clone() };
    let mut numbers = Numbers(5);
    let u: Corners = std::array::from_fn(|_| std::array::from_fn(|_| Lanes(std::array::from_fn(|_| numbers.next()))));
    let answer = |shape: &Shape| {
        let mut force: Corners = [[Lanes::ZERO; 8]; 3];
        (elastic(shape, &u, &mut force), force)
    };
    let ((energy, force), (other_energy, other_force)) = (answer(&brick), answer(&general));
    let largest = force.iter().flatten().flat_map(|lanes| lanes.0).fold(0.0, |size: f64, f| size.max(f.abs()));
    for (lanes, other) in force.iter().flatten().zip(other_force.iter().flatten()) {
        lanes.0.iter().zip(&other.0).for_each(|(f, other)| assert!((f - other).abs() < 1e-14 * largest, "{f} {other}"));
    }
    energy.0.iter().zip(&other_energy.0).for_each(|(e, other)| assert!((e / other - 1.0).abs() < 1e-13));
    let mut moved = corners;
    moved[2][1] += 1e-9;
    assert!(Shape::new(&moved, &SUBGRADE, Formulation::MeanStrain).unwrap().edges.is_none());
}
