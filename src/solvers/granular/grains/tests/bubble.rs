//! Pebbles in surfaces: inside the surface, by the rule, and in the required number.

use super::super::super::clump::Pebble;
use super::super::super::shape::Mesh;
use super::super::*;
use nalgebra::Vector3;
use std::f64::consts::PI;

const PAPER: Rule = Rule { pebbles: [1, 50], ratio: 0.8, distance: 110.0 * PI / 180.0 };

/// φ of two overlapping balls, deg.
fn angle(a: &Pebble, b: &Pebble) -> f64 {
    let apart = (a.centre - b.centre).norm();
    let theta = (a.radius.powi(2) + b.radius.powi(2) - apart * apart) / (2.0 * a.radius * b.radius);
    180.0 - theta.clamp(-1.0, 1.0).acos().to_degrees()
}

#[test]
fn pebbles_are_inscribed_and_keep_their_distance() {
    for number in 0..6 {
        let surface = Angular { flatness: 0.6, elongation: 0.6, roundness: 0.1 }.surface(5, number).unwrap();
        let bubbles = Bubbles::fill(&surface, &PAPER);
        let largest = bubbles.pebbles[0].radius;
        assert_eq!((bubbles.by_rule, bubbles.ratio, bubbles.distance), (bubbles.pebbles.len(), 0.8, PAPER.distance));
        for (k, pebble) in bubbles.pebbles.iter().enumerate() {
            let depth = surface.nearest(&pebble.centre, 10.0).unwrap().distance;
            assert!(surface.contains(&pebble.centre) && depth >= pebble.radius * (1.0 - 1e-5));
            assert!(pebble.radius >= 0.8 * largest && pebble.radius <= largest);
            assert!(bubbles.pebbles[..k].iter().all(|other| angle(pebble, other) <= 110.0 + 1e-9));
        }
    }
}

#[test]
fn a_bar_is_a_row_of_pebbles_along_its_axis() {
    let bar = Mesh::block(Vector3::new(0.06, 0.02, 0.02)).unwrap();
    let mut pebbles = Bubbles::fill(&bar, &PAPER).pebbles;
    pebbles.sort_by(|a, b| a.centre.x.total_cmp(&b.centre.x));
    // 1.147 r apart, from one end to the other
    assert!(
        (3..=4).contains(&pebbles.len()) && pebbles[0].centre.x < -0.02 && pebbles[pebbles.len() - 1].centre.x > 0.02
    );
    assert!(pebbles.iter().all(|p| p.radius >= 0.016 && p.centre.yz().norm() < 0.006), "{pebbles:?}");
}

#[test]
fn the_largest_pebble_is_the_largest_ball() {
    let wedge = Mesh::block(Vector3::new(0.03, 0.02, 0.01)).unwrap();
    let largest = Bubbles::fill(&wedge, &PAPER).pebbles[0];
    assert!((largest.radius / 0.01 - 1.0).abs() < 1e-5);
}

#[test]
fn more_is_cut_off_and_fewer_relaxes_the_rule() {
    let surface = Angular { flatness: 0.6, elongation: 0.5, roundness: 0.1 }.surface(3, 0).unwrap();
    let free = Bubbles::fill(&surface, &PAPER);
    assert!(free.by_rule >= 2);
    let most = Bubbles::fill(&surface, &Rule { pebbles: [1, 1], ..PAPER });
    assert_eq!(most.pebbles, free.pebbles[..1]);
    let fewest = Bubbles::fill(&surface, &Rule { pebbles: [12, 20], ..PAPER });
    assert_eq!((fewest.pebbles.len(), fewest.by_rule), (12, free.by_rule));
    assert!(fewest.ratio < 0.8 && fewest.distance > PAPER.distance);
    assert_eq!(fewest, Bubbles::fill(&surface, &Rule { pebbles: [12, 20], ..PAPER }));
}

#[test]
fn a_ball_is_one_pebble_whatever_is_asked_for() {
    let ball = Mesh::sphere(0.03, 3).unwrap();
    let bubbles = Bubbles::fill(&ball, &PAPER);
    assert_eq!(bubbles.pebbles.len(), 1);
    assert!((bubbles.pebbles[0].radius / 0.03 - 1.0).abs() < 6e-3);
    let shape = ClumpShape { surfaces: Surfaces::Meshes(vec![ball.into()]), rule: Rule { pebbles: [2, 3], ..PAPER } };
    assert!(matches!(shape.templates(1), Err(TemplatesError::TooFew { surface: 0, fewest: 2, .. })));
}

#[test]
fn templates_have_the_volume_of_the_ball_of_diameter_one() {
    let fitted = ClumpShape::default().fitted(1).unwrap();
    assert_eq!(fitted.len(), 5);
    for template in &fitted {
        assert!((2..=3).contains(&template.template.pebbles.len()));
        assert!((template.template.equivalent_diameter() - 1.0).abs() < 1e-12);
        assert!((template.surface.volume() / (PI / 6.0) - 1.0).abs() < 1e-9);
    }
    assert_eq!(ClumpShape::default().templates(1).unwrap(), ClumpShape::default().templates(1).unwrap());
}
