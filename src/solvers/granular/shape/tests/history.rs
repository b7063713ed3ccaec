//! Shear forces that continue from facet to facet.

use super::*;

fn touch(feature: u32, normal: Vector3<f64>) -> Touch {
    Touch { normal, distance: 0.01, feature }
}

fn heirs(before: &[(u32, Vector3<f64>)], now: &[Touch]) -> Vec<Option<usize>> {
    let mut heirs = vec![Some(77)];
    inherit(before, now, &mut heirs);
    heirs
}

#[test]
fn a_feature_goes_on_and_a_new_one_takes_over_from_a_vanished_one() {
    let tilted = |degrees: f64| Vector3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
    let up = Vector3::z();
    assert_eq!(heirs(&[], &[touch(3, up)]), [None]);
    assert_eq!(heirs(&[(3, up)], &[]), []);
    // the same feature, even if its normal has rotated far
    assert_eq!(heirs(&[(9, up), (3, up)], &[touch(3, Vector3::x())]), [Some(1)]);
    // from facet to facet, below 30 degrees
    assert_eq!(heirs(&[(3, up)], &[touch(4, tilted(29.9))]), [Some(0)]);
    assert_eq!(heirs(&[(3, up)], &[touch(4, tilted(30.1))]), [None]);
    // not from a feature that is still touched
    assert_eq!(heirs(&[(3, up)], &[touch(3, up), touch(4, tilted(5.0))]), [Some(0), None]);
    // the closest pair first, no history twice
    let before = [(1, up), (2, tilted(20.0))];
    assert_eq!(heirs(&before, &[touch(5, tilted(12.0)), touch(6, tilted(1.0))]), [Some(1), Some(0)]);
    assert_eq!(heirs(&before[..1], &[touch(5, tilted(12.0)), touch(6, tilted(1.0))]), [None, Some(0)]);
}

#[test]
fn a_sphere_that_rolls_round_a_body_never_loses_its_history() {
    let shape = Shape::Mesh(Mesh::sphere(1.0, 3).unwrap());
    let mut before: Vec<(u32, Vector3<f64>)> = Vec::new();
    let mut features = Vec::new();
    for k in 0..20_000 {
        let angle = 1e-3 * f64::from(k);
        let centre = Vector3::new(angle.cos(), angle.sin(), (0.37 * angle).sin()).normalize() * 1.05;
        let now = touches(&shape, &centre, 0.1);
        assert_eq!(now.len(), 1);
        if k > 0 {
            assert_eq!(heirs(&before, &now), [Some(0)]);
        }
        before = now.iter().map(|t| (t.feature, t.normal)).collect();
        features.push(now[0].feature);
    }
    features.dedup();
    assert!(features.len() > 300, "{}", features.len());
}
