//! Folded sheets: two contacts in a valley, one on a ridge, no additional contacts if facets are nearly flat.

use super::*;

/// Two long strips that meet in the line x = z = 0 and rise by an angle on either side of it.
fn fold(angle: f64, kind: MeshKind) -> Shape {
    let (c, s) = (angle.cos(), angle.sin());
    let at = |x: f64, y: f64| Vector3::new(x * c, y, x.abs() * s);
    let vertices = vec![at(-1.0, -1.0), at(0.0, -1.0), at(1.0, -1.0), at(-1.0, 1.0), at(0.0, 1.0), at(1.0, 1.0)];
    let triangles = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
    Shape::Mesh(Mesh::new(vertices, triangles, kind).unwrap())
}

#[test]
fn a_valley_is_two_contacts_and_a_ridge_is_one() {
    for angle in [0.06f64, 0.5, 1.2] {
        let valley = fold(angle, MeshKind::OneSided);
        for y in [0.0, 0.31] {
            let found = touches(&valley, &Vector3::new(0.0, y, 0.1 / angle.cos()), 0.11);
            assert_eq!(found.len(), 2, "{found:?}");
            assert!(found.iter().all(|t| (t.distance - 0.1).abs() < 1e-15));
            assert!((found[0].normal + found[1].normal - Vector3::z() * 2.0 * angle.cos()).norm() < 1e-14);
        }
        let ridge = fold(-angle, MeshKind::OneSided);
        let found = touches(&ridge, &Vector3::new(0.01, 0.2, 0.1), 0.11);
        assert_eq!(found.len(), 1);
        // over the strip if it is not steep, otherwise over the edge
        let over_strip = 0.01 * angle.cos() > 0.1 * angle.sin();
        let expected = if over_strip { 0.1 * angle.cos() + 0.01 * angle.sin() } else { 0.1f64.hypot(0.01) };
        assert!((found[0].distance - expected).abs() < 1e-15);
    }
}

#[test]
fn both_sides_of_a_folded_sheet_touch() {
    let sheet = fold(0.5, MeshKind::TwoSided);
    assert_eq!(touches(&sheet, &Vector3::new(0.0, 0.0, 0.1), 0.11).len(), 2);
    let under = touches(&sheet, &Vector3::new(0.0, 0.0, -0.1), 0.11);
    assert_eq!(under.len(), 1);
    assert!((under[0].normal + Vector3::z()).norm() < 1e-15);
}

#[test]
fn facets_that_hardly_turn_are_one_contact_with_the_nearer_one() {
    for angle in [1e-9, 1e-5, 0.01, 0.02] {
        let valley = fold(angle, MeshKind::OneSided);
        let mut last: Option<f64> = None;
        for k in -200..=200 {
            let x = 1e-4 * f64::from(k);
            let found = touches(&valley, &Vector3::new(x, 0.1, 0.0999), 0.1);
            assert_eq!(found.len(), 1, "{angle} at {x}");
            // the nearer of the two planes, so that the overlap has no jump
            let nearer = 0.0999 * angle.cos() - x.abs() * angle.sin();
            assert!((found[0].distance - nearer).abs() < 1e-15);
            assert!(last.is_none_or(|d| (d - found[0].distance).abs() <= 1e-4 * angle + 1e-15));
            last = Some(found[0].distance);
        }
    }
}

#[test]
fn contacts_do_not_depend_on_the_order_of_facets_nor_on_further_ones() {
    let shape = Shape::Mesh(bumpy());
    let mut random = Random::new(8);
    let (mut near, mut far, mut a, mut b) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for _ in 0..500 {
        let centre = random.point(1.2);
        shape.near(&centre, 0.3, &mut near);
        shape.near(&centre, 0.7, &mut far);
        assert!(near.iter().all(|facet| far.contains(facet)));
        shape.touches(&centre, 0.3, &near, &mut a);
        far.reverse();
        far.extend_from_within(..);
        shape.touches(&centre, 0.3, &far, &mut b);
        assert_eq!(a, b);
    }
}

#[test]
fn the_neighbour_search_finds_what_is_in_reach() {
    let mesh = bumpy();
    let shape = Shape::Mesh(mesh.clone());
    let mut random = Random::new(9);
    let mut facets = Vec::new();
    for _ in 0..300 {
        let (centre, reach) = (random.point(2.0), random.between(0.0, 0.8));
        let any = shape.near(&centre, reach, &mut facets);
        assert_eq!(any, !facets.is_empty());
        facets.sort_unstable();
        let within =
            |t: &[u32; 3]| (centre - nearest_point(&centre, t.map(|v| mesh.vertices()[v as usize]))).norm() <= reach;
        let expected: Vec<u32> =
            mesh.triangles().iter().enumerate().filter(|(_, t)| within(t)).map(|(i, _)| i as u32).collect();
        assert_eq!(facets, expected);
    }
    let block = Shape::block(Vector3::new(1.0, 1.0, 1.0)).unwrap();
    assert!(block.near(&Vector3::new(1.2, 1.2, 0.0), 0.29, &mut facets) && facets.is_empty());
    assert!(!block.near(&Vector3::new(1.2, 1.2, 0.0), 0.28, &mut facets));
    assert!(block.near(&Vector3::zeros(), 0.1, &mut facets));
}
