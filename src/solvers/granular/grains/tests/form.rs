//! Boxes, moments and indices of bodies with closed forms.

use super::super::super::shape::{Mesh, MeshKind};
use super::super::form::{Box, Solid, extent};
use super::super::*;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::f64::consts::PI;

/// A mesh with moved vertices.
fn moved(mesh: &Mesh, to: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Mesh {
    Mesh::new(mesh.vertices().iter().map(to).collect(), mesh.triangles().to_vec(), MeshKind::Solid).unwrap()
}

fn turn() -> Rotation3<f64> {
    Rotation3::new(Vector3::new(0.7, -1.1, 0.4))
}

#[test]
fn a_turned_block_has_its_sides() {
    let block = Mesh::block(Vector3::new(0.02, 0.05, 0.03)).unwrap();
    let form = GrainForm::of_surface(&moved(&block, |v| turn() * v + Vector3::new(1.0, 2.0, 3.0)));
    for (found, side) in form.sides.iter().zip([0.04, 0.06, 0.10]) {
        assert!((found / side - 1.0).abs() < 1e-4, "{:?}", form.sides);
    }
    assert!((form.flatness() - 0.04 / 0.06).abs() < 1e-4 && (form.elongation() - 0.6).abs() < 1e-4);
    let area = 2.0 * (0.04 * 0.06 + 0.06 * 0.10 + 0.04 * 0.10);
    assert!((form.sphericity() - PI.cbrt() * (6.0 * 0.04 * 0.06 * 0.1f64).powf(2.0 / 3.0) / area).abs() < 1e-9);
}

#[test]
fn an_ellipsoid_has_its_axes_and_its_moments() {
    let half = Vector3::new(1.0, 0.75, 0.5);
    let ball = Mesh::sphere(1.0, 4).unwrap();
    let surface = moved(&ball, |v| turn() * v.component_mul(&half));
    let form = GrainForm::of_surface(&surface);
    assert!((form.flatness() - 2.0 / 3.0).abs() < 2e-3 && (form.elongation() - 0.75).abs() < 2e-3, "{form:?}");
    let solid = Solid::inside(surface.vertices(), surface.triangles());
    let volume = 4.0 / 3.0 * PI * half.product();
    assert!((solid.volume / volume - 1.0).abs() < 3e-3 && solid.centroid.norm() < 1e-9);
    let own = Matrix3::from_diagonal(&half.component_mul(&half)) * (volume / 5.0);
    let expected = turn() * own * turn().inverse();
    assert!((solid.second - expected).norm() < 5e-3 * expected.norm());
}

#[test]
fn a_ball_is_round() {
    let form = GrainForm::of_surface(&Mesh::sphere(0.03, 4).unwrap());
    assert!((form.sphericity() - 1.0).abs() < 2e-3 && form.flatness() > 0.99 && form.elongation() > 0.99);
}

#[test]
fn the_box_is_the_smallest_one() {
    // a regular tetrahedron in a cube of side 1: the volume of this box is 1, and no other box is smaller
    let corners =
        [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]].map(|c| turn() * Vector3::from(c));
    let around = Box::round(|n| extent(&corners, n));
    assert!((around.sides.iter().product::<f64>() - 1.0).abs() < 1e-3, "{:?}", around.sides);
    assert!(around.axes.iter().all(|a| (a.norm() - 1.0).abs() < 1e-12));
}
