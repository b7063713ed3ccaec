//! Facets of the top.

use super::super::*;
use super::scenes::*;

#[test]
fn facets_are_found_by_their_place() {
    let (x, y, z) = ([0.0, 0.1, 0.4, 0.5, 3.0], lines(1.2, 12), lines(1.0, 2));
    // a trench between the second and the third line, an empty column in the corner
    let material = |i: usize, j: usize, k: usize| match (i, j, k) {
        (1, _, 1) | (3, 11, _) => None,
        _ => Some(0),
    };
    let mesh = Mesh::grid([&x, &y, &z], vec![SUBGRADE], material).unwrap();
    let surface = mesh.surface().unwrap();
    assert_eq!(surface.facets().len(), 4 * 12 - 1);
    let mut numbers = Numbers(11);
    for _ in 0..1000 {
        let place = [1.5 + 1.5 * numbers.next(), 0.6 + 0.6 * numbers.next()];
        let Some(Spot { facet, local }) = surface.locate(place[0], place[1]) else {
            assert!(place[0] > 0.5 && place[1] > 1.1);
            continue;
        };
        let weights = Spot::weights(local);
        let corners = surface.facets()[facet].map(|node| mesh.nodes()[node as usize]);
        let at = [0, 1, 2].map(|axis| (0..4).map(|c| weights[c] * corners[c][axis]).sum::<f64>());
        assert!((at[0] - place[0]).abs() < 1e-14 && (at[1] - place[1]).abs() < 1e-14);
        assert!((at[2] - if (0.1..0.4).contains(&place[0]) { 0.5 } else { 1.0 }).abs() < 1e-14);
    }
    assert_eq!(surface.locate(-0.001, 0.5), None);
    assert_eq!(surface.locate(0.2, f64::NAN), None);
    assert_eq!(surface.columns(0, 0.05, 0.45), (0, 3));
    assert_eq!(surface.columns(1, -3.0, 0.15), (0, 2));
    assert_eq!(surface.columns(0, 3.5, 4.0), (0, 0));
}

/// A force at a point between corners has the same force, moment and power as its shares at the corners.
#[test]
fn shares_keep_force_moment_and_power() {
    let mesh = block([1.0; 3], [3; 3], SUBGRADE);
    let surface = mesh.surface().unwrap();
    let force = [3.0, -5.0, 7.0];
    let Spot { facet, local } = surface.locate(0.41, 0.87).unwrap();
    let weights = Spot::weights(local);
    let corners = surface.facets()[facet].map(|node| mesh.nodes()[node as usize]);
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    let whole = cross([0.41, 0.87, 1.0], force);
    for (axis, whole) in whole.into_iter().enumerate() {
        let moment: f64 = (0..4).map(|c| cross(corners[c], force.map(|f| f * weights[c]))[axis]).sum();
        assert!((moment - whole).abs() < 1e-14);
    }
}

#[test]
fn what_cannot_be_is_told() {
    let lines = [0.0, 1.0, 1.0];
    assert_eq!(
        Mesh::grid([&lines, &[0.0, 1.0], &[0.0, 1.0]], vec![SUBGRADE], |_, _, _| Some(0)),
        Err(SoilError::Lines { axis: 0, at: 2 })
    );
    let one = [0.0, 1.0];
    assert_eq!(Mesh::grid([&one; 3].map(|l| &l[..]), vec![SUBGRADE], |_, _, _| None), Err(SoilError::Empty));
    assert!(matches!(
        Mesh::grid([&one; 3].map(|l| &l[..]), vec![SUBGRADE], |_, _, _| Some(1)),
        Err(SoilError::Missing { element: 0, what: "material", number: 1 })
    ));
    let stiff = Material { poisson_ratio: 0.5, ..SUBGRADE };
    let told = Mesh::grid([&one; 3].map(|l| &l[..]), vec![stiff], |_, _, _| Some(0)).unwrap_err();
    assert_eq!(told.to_string(), "soil material 0: expected Poisson's ratio to be above -1 and below 0.5, found 0.5");
    let good = block([1.0; 3], [1; 3], SUBGRADE);
    let mut turned = good.elements()[0];
    turned.nodes.swap(0, 1);
    let mesh = Mesh::new(good.nodes().to_vec(), vec![turned], vec![SUBGRADE]).unwrap();
    assert!(matches!(Soil::new(mesh, Settings::default()), Err(SoilError::Turned { element: 0, .. })));
}
