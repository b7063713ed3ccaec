//! Angular surfaces: rounded polyhedra against closed forms, and shape indices against the required values.

use super::super::super::shape::{Mesh, MeshKind};
use super::super::angular::TOLERANCE;
use super::super::polyhedron::{Plane, corners, inscribed_radius, rounded};
use super::super::*;
use nalgebra::Vector3;
use proptest::prelude::*;
use std::f64::consts::PI;

fn block(half: [f64; 3]) -> Vec<Plane> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let both = |(n, height): (&Vector3<f64>, f64)| [*n, -n].map(|normal| Plane { normal, height });
    axes.iter().zip(half).flat_map(both).collect()
}

#[test]
fn a_rounded_block_has_the_volume_and_surface_of_steiner() {
    let (planes, r) = (block([1.0, 0.8, 0.5]), 0.2);
    let places = corners(&planes);
    assert_eq!(places.len(), 8);
    assert!((inscribed_radius(&planes) - 0.5).abs() < 1e-12);
    let (vertices, triangles) = rounded(&planes, &places, r, 24);
    let mesh = Mesh::new(vertices, triangles, MeshKind::Solid).unwrap();
    let (volume, area, edges) = (8.0 * 0.4, 8.0 * (0.8 + 0.5 + 0.4), 8.0 * (1.0 + 0.8 + 0.5));
    let volume = volume + area * r + PI * r * r / 4.0 * edges + 4.0 / 3.0 * PI * r.powi(3);
    let area = area + PI * r / 2.0 * edges + 4.0 * PI * r * r;
    assert!((mesh.volume() / volume - 1.0).abs() < 1e-4, "{} {volume}", mesh.volume());
    assert!((mesh.area() / area - 1.0).abs() < 1e-3, "{} {area}", mesh.area());
}

#[test]
fn a_block_with_sharp_edges_has_twelve_triangles() {
    let planes = block([1.0, 0.8, 0.5]);
    let (vertices, triangles) = rounded(&planes, &corners(&planes), 0.0, 3);
    let mesh = Mesh::new(vertices, triangles, MeshKind::Solid).unwrap();
    assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (8, 12));
    assert!((mesh.volume() - 3.2).abs() < 1e-12);
}

#[test]
fn grains_are_known_by_seed_and_number() {
    let indices = Angular { flatness: 0.7, elongation: 0.8, roundness: 0.2 };
    let [one, same, other, seed] = [(1, 0), (1, 0), (1, 1), (2, 0)].map(|(s, n)| indices.surface(s, n).unwrap());
    assert_eq!(one, same);
    assert!(one != other && one != seed && other != seed);
}

#[test]
fn rounder_grains_are_nearer_to_balls() {
    let sphericity = |roundness: f64| {
        let indices = Angular { flatness: 0.9, elongation: 0.9, roundness };
        (0..4).map(|n| GrainForm::of_surface(&indices.surface(1, n).unwrap()).sphericity()).sum::<f64>() / 4.0
    };
    let found = [0.0, 0.2, 0.4, 0.6].map(sphericity);
    assert!(found.windows(2).all(|pair| pair[1] > pair[0] + 0.01), "{found:?}");
}

#[test]
fn indices_that_no_grain_has_are_refused() {
    let of = |flatness: f64, elongation: f64, roundness: f64| Angular { flatness, elongation, roundness }.surface(1, 0);
    for (wrong, index) in
        [(of(0.1, 0.7, 0.1), "flatness"), (of(0.7, 1.1, 0.1), "elongation"), (of(0.7, 0.7, f64::NAN), "roundness")]
    {
        assert!(matches!(wrong, Err(AngularError::Index { name, .. }) if name == index));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn a_grain_has_the_indices_that_are_asked_for(
        flatness in 0.3..1.0f64, elongation in 0.3..1.0f64, roundness in 0.0..0.6f64, seed in 0u64..10_000,
    ) {
        let surface = Angular { flatness, elongation, roundness }.surface(seed, 0).unwrap();
        let form = GrainForm::of_surface(&surface);
        prop_assert!((form.flatness() / flatness - 1.0).abs() < TOLERANCE, "{} {flatness}", form.flatness());
        prop_assert!((form.elongation() / elongation - 1.0).abs() < TOLERANCE, "{} {elongation}", form.elongation());
        prop_assert!((form.volume / (PI / 6.0) - 1.0).abs() < 1e-9);
        // the ball that rounds its edges is the required share of the largest ball that fits into it
        prop_assert!(GrainForm::of_surface(&surface).sphericity() < 1.0);
    }
}
