//! Soil that yields: stress paths of one element, and Prandtl's footing.

use super::super::yields::{Yield, principal};
use super::super::*;
use super::scenes::*;

const STRENGTH: Strength =
    Strength { cohesion: 10e3, friction_angle: 0.5235987755982988, dilation_angle: 0.17453292519943295, tension: 5e3 };
const CONFINED: f64 = 100e3;

/// A cube under a confining pressure with a driven top; axial stress, axial and volumetric strain when it begins to
/// flow, and later.
fn triaxial(formulation: Formulation, pressure: f64, speed: f64) -> [[f64; 3]; 2] {
    let material = Material { density: 2000.0, youngs_modulus: 50e6, poisson_ratio: 0.3, strength: Some(STRENGTH) };
    let settings = Settings { formulation, damping: Damping { local: 0.8, stiffness: 0.0 }, ..Settings::default() };
    let mut soil = Soil::new(block([0.1; 3], [1; 3], material), settings).unwrap();
    support(&mut soil, &[Side::XMin, Side::YMin, Side::Bottom], Support::Roller);
    let faces = [(Side::XMax, 0), (Side::YMax, 1), (Side::Top, 2)].map(|(side, axis)| (soil.side_nodes(side), axis));
    let step = |soil: &mut Soil, faces: &[(Vec<usize>, usize)]| {
        for (nodes, axis) in faces {
            for &node in nodes {
                let mut force = [0.0; 3];
                force[*axis] = -pressure * 0.01 / 4.0;
                soil.add_force(node, force);
            }
        }
        soil.step(0.9 * soil.limit()).unwrap();
    };
    (0..2000).for_each(|_| step(&mut soil, &faces));
    faces[2].0.iter().for_each(|&node| soil.drive(node, 2, speed).unwrap());
    [30_000, 30_000].map(|steps| {
        (0..steps).for_each(|_| step(&mut soil, &faces[..2]));
        let corner = soil.displacements()[soil.mesh().nearest([0.1; 3])];
        [soil.stress(0)[2], corner[2] / 0.1, (corner[0] + corner[1] + corner[2]) / 0.1]
    })
}

/// `σ3 = -(p N + 2 c √N)` with N = (1 + sin φ) / (1 - sin φ) in compression, `σ1 = -(p - 2 c √N) / N` in extension; the
/// volume grows by `2 sin ψ / (1 - sin ψ)` of the shortening, and by `2 sin ψ / (1 + sin ψ)` of the lengthening.
#[test]
fn triaxial_paths_of_one_element() {
    let n = 3.0;
    for formulation in FORMULATIONS {
        let [first, last] = triaxial(formulation, CONFINED, -3e-4);
        let exact = -(CONFINED * n + 2.0 * 10e3 * f64::sqrt(n));
        assert!((last[0] / exact - 1.0).abs() < 1e-3, "{formulation:?} {} {exact}", last[0]);
        let dilates = -(last[2] - first[2]) / (last[1] - first[1]);
        let sine = STRENGTH.dilation_angle.sin();
        assert!((dilates / (2.0 * sine / (1.0 - sine)) - 1.0).abs() < 1e-2, "{formulation:?} {dilates}");

        let [first, last] = triaxial(formulation, CONFINED, 3e-4);
        let exact = -(CONFINED - 2.0 * 10e3 * f64::sqrt(n)) / n;
        assert!((last[0] / exact - 1.0).abs() < 1e-3, "{formulation:?} {} {exact}", last[0]);
        let dilates = (last[2] - first[2]) / (last[1] - first[1]);
        assert!((dilates / (2.0 * sine / (1.0 + sine)) - 1.0).abs() < 1e-2, "{formulation:?} {dilates}");

        let [_, last] = triaxial(formulation, 0.0, 3e-4);
        assert!((last[0] / STRENGTH.tension - 1.0).abs() < 1e-3, "{formulation:?} {}", last[0]);
    }
}

/// For any trial: the stress is allowed, the flow has the right sign, and an allowed stress does not change.
#[test]
fn the_return_ends_on_the_strength() {
    let mut numbers = Numbers(5);
    for (friction, dilation, tension) in
        [(0.6, 0.6, 1e3), (0.6, 0.0, 1e9), (0.5, 0.2, 0.0), (0.0, 0.0, 4e3), (0.0, 0.0, f64::INFINITY)]
    {
        let strength = Strength { cohesion: 10e3, friction_angle: friction, dilation_angle: dilation, tension };
        let (lambda, mu) = SUBGRADE.lame();
        let yields = Yield::new(&strength, lambda, mu);
        let reach = 2.0 * 10e3 * friction.cos();
        let limit = tension.min(10e3 / friction.tan());
        for _ in 0..20_000 {
            let trial: [f64; 6] = [(); 6].map(|()| 50e3 * numbers.next());
            let Some(stress) = yields.correct(&trial) else {
                let (s, _) = principal(&trial);
                assert!(
                    s[0] - s[2] + (s[0] + s[2]) * friction.sin() <= reach * (1.0 + 1e-12)
                        && s[0] <= limit * (1.0 + 1e-12)
                );
                continue;
            };
            let (s, _) = principal(&stress);
            assert!(s[0] - s[2] + (s[0] + s[2]) * friction.sin() <= reach + 1e-6, "{trial:?} {stress:?}");
            assert!(s[0] <= limit + 1e-6, "{trial:?} {stress:?}");
            // energy is lost and never gained
            let flow: Vec<f64> = yields.strain(&trial).iter().zip(yields.strain(&stress)).map(|(a, b)| a - b).collect();
            let lost: f64 = (0..6).map(|i| stress[i] * flow[i] * if i < 3 { 1.0 } else { 2.0 }).sum();
            assert!(lost > -1e-9, "{trial:?} {stress:?} {lost}");
            let again = yields.correct(&stress).unwrap_or(stress);
            assert!((0..6).all(|i| (again[i] - stress[i]).abs() < 1e-6));
        }
    }
}

/// Half of a strip footing on clay, driven down by 30 mm until the soil flows: its pressure divided by the cohesion.
/// Nodes under the footing are driven; its edge lies in the middle of the next element.
fn footing(formulation: Formulation, half: usize, steps: u64) -> f64 {
    let clay = Strength { cohesion: 10e3, friction_angle: 0.0, dilation_angle: 0.0, tension: f64::INFINITY };
    let material = Material { density: 2000.0, youngs_modulus: 20e6, poisson_ratio: 0.3, strength: Some(clay) };
    let size = 1.0 / (half as f64 + 0.5);
    let [wide, deep] = [4 * half, 2 * half].map(|count| count as f64 * size);
    let mesh = block([wide, size, deep], [4 * half, 1, 2 * half], material);
    let settings = Settings { formulation, damping: Damping { local: 0.8, stiffness: 0.0 }, ..Settings::default() };
    let mut soil = Soil::new(mesh, settings).unwrap();
    support(&mut soil, &WALLS, Support::Roller);
    support(&mut soil, &[Side::Bottom], Support::Fixed);
    let below = |node: &usize| soil.mesh().nodes()[*node][0] < 1.0 - 0.1 * size;
    let below: Vec<usize> = soil.side_nodes(Side::Top).into_iter().filter(below).collect();
    let dt = 0.9 * soil.measure_limit(40).unwrap();
    let speed = 0.03 / (steps as f64 * dt);
    below.iter().for_each(|&node| soil.drive(node, 2, -speed).unwrap());
    soil.watch(true);
    (0..steps).for_each(|_| soil.step(dt).unwrap());
    let energy = soil.energy();
    assert!(energy.plastic > 0.8 * energy.driven && energy.residual().abs() < 1e-4 * energy.driven, "{energy:?}");
    below.iter().map(|&node| soil.internal_force(node)[2]).sum::<f64>() / size / 10e3
}

/// Prandtl: `q = (2 + π) c`.
#[test]
fn a_strip_footing_fails_as_prandtl_says() {
    for (formulation, half) in [(Formulation::MeanStrain, 6), (Formulation::MixedDiscretisation, 4)] {
        let found = footing(formulation, half, 2000);
        assert!((found / (2.0 + std::f64::consts::PI) - 1.0).abs() < 0.01, "{formulation:?} {found}");
    }
}

/// With meshes twice as fine: 5.130 and 5.141.
#[test]
fn a_finer_footing_comes_nearer() {
    for (formulation, half) in [(Formulation::MeanStrain, 12), (Formulation::MixedDiscretisation, 8)] {
        let found = footing(formulation, half, 4000);
        assert!((found / (2.0 + std::f64::consts::PI) - 1.0).abs() < 0.004, "{formulation:?} {found}");
    }
}
