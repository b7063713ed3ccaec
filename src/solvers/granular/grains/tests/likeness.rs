//! Shape errors against closed forms; they fall with the number of pebbles.

use super::super::super::clump::Template;
use super::super::super::shape::Mesh;
use super::super::*;
use nalgebra::Vector3;

#[test]
fn a_ball_is_like_a_ball() {
    let error = Misfit::between(&Mesh::sphere(0.03, 5).unwrap(), &Template::sphere(1.0).unwrap());
    assert!(error.volume < 5e-3 && error.mean_distance < 1e-3 && error.largest_distance < 2e-3, "{error:?}");
    assert!(error.inertia < 1e-3);
}

#[test]
fn a_ball_in_place_of_a_cube_is_wrong_by_what_it_must() {
    let cube = Mesh::block(Vector3::repeat(0.5)).unwrap();
    let error = Misfit::between(&cube, &Template::sphere(0.1).unwrap());
    // R³ = 3/4π: six caps of the ball stick out, and the same volume of the cube's corners is missing
    let radius = 0.620_350_490_899_4_f64;
    let height = radius - 0.5;
    let caps = 6.0 * std::f64::consts::PI * height * height * (3.0 * radius - height) / 3.0;
    assert!((error.volume - 2.0 * caps).abs() < 1e-2, "{error:?}");
    assert!((error.largest_distance - (0.75f64.sqrt() - radius) / (2.0 * radius)).abs() < 5e-3, "{error:?}");
    assert!((error.inertia - (1.0 - 0.4 * radius * radius * 6.0)).abs() < 1e-9, "{error:?}");
    assert!(error.mean_distance > 0.02 && error.mean_distance < 0.06, "{error:?}");
}

#[test]
fn more_pebbles_are_more_like_the_surface() {
    let of = |pebbles: usize| {
        let shape =
            ClumpShape { rule: Rule { pebbles: [pebbles; 2], ..ClumpShape::default().rule }, ..ClumpShape::default() };
        let fitted = shape.fitted(1).unwrap();
        let error = |f: &Fitted| Misfit::between(&f.surface, &f.template);
        let sum =
            fitted.iter().map(error).fold([0.0; 3], |s, e| [s[0] + e.volume, s[1] + e.mean_distance, s[2] + e.inertia]);
        sum.map(|s| s / fitted.len() as f64)
    };
    let errors = [1, 3, 10, 30].map(of);
    for pair in errors.windows(2) {
        assert!((0..3).all(|k| pair[1][k] < 0.95 * pair[0][k]), "{errors:?}");
    }
}
