//! Bodies and containers: the same contacts as for a block, the direction out of a solid, and points inside.

use super::super::triangles::winding;
use super::*;

#[test]
fn a_meshed_block_touches_as_a_block() {
    let half = Vector3::new(0.3, 0.2, 0.15);
    let turn = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.3);
    let block = Shape::block(half).unwrap();
    let straight = Shape::Mesh(Mesh::block(half).unwrap());
    let oblique = Shape::Mesh(turned(&Mesh::block(half).unwrap(), &turn));
    let mut random = Random::new(1);
    let (mut worst, mut sides, mut inside) = ([0.0f64; 2], [0; 27], 0);
    for _ in 0..100_000 {
        let centre = random.point(0.4);
        let reach = random.between(0.05, 0.3);
        let expected = touches(&block, &centre, reach);
        if expected.first().is_some_and(|touch| touch.distance <= -reach) {
            continue;
        }
        for touch in &expected {
            sides[touch.feature as usize] += 1;
            inside += usize::from(touch.distance < 0.0);
        }
        let found = touches(&straight, &centre, reach);
        let found_turned = touches(&oblique, &(turn * centre), reach);
        assert_eq!((found.len(), found_turned.len()), (expected.len(), expected.len()), "at {centre}");
        for (e, (f, t)) in expected.iter().zip(found.iter().zip(&found_turned)) {
            worst[0] = worst[0].max(difference(e, f));
            worst[1] = worst[1].max(difference(e, &Touch { normal: turn.inverse() * t.normal, ..*t }));
        }
    }
    assert!(sides.iter().enumerate().all(|(side, count)| side == 13 || *count > 100), "{sides:?}");
    assert!(inside > 1000);
    println!("meshed block against block: {:.1e}, turned {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 1e-14 && worst[1] < 1e-12, "{worst:?}");
}

#[test]
fn a_block_names_its_faces_edges_and_corners() {
    let block = Shape::block(Vector3::new(1.0, 2.0, 3.0)).unwrap();
    let one = |x, y, z| {
        let found = touches(&block, &Vector3::new(x, y, z), 0.5);
        assert_eq!(found.len(), 1);
        found[0]
    };
    assert_eq!(one(1.3, 0.2, 0.1), Touch { normal: Vector3::x(), distance: 1.3 - 1.0, feature: 14 });
    assert_eq!(one(1.3, -2.3, 0.1).feature, 2 + 9);
    assert!((one(1.3, -2.3, 0.1).distance - 0.3 * 2f64.sqrt()).abs() < 1e-15);
    assert_eq!(one(-1.2, -2.2, -3.2).feature, 0);
    assert_eq!(one(0.0, 1.75, 0.0), Touch { normal: Vector3::y(), distance: -0.25, feature: 16 });
    // on a face and on a corner, to the last bit
    assert_eq!(one(1.0, 0.0, 0.0).distance, 0.0);
    assert_eq!(one(1.0, 2.0, 3.0).distance, 0.0);
    assert!(touches(&block, &Vector3::new(1.4, 2.4, 0.0), 0.5).is_empty());
}

#[test]
fn the_nearest_contact_is_the_signed_distance() {
    let solid = bumpy();
    let container = Shape::Mesh(solid.flipped());
    let shape = Shape::Mesh(solid.clone());
    let mut random = Random::new(2);
    let mut worst = 0.0f64;
    let mut several = 0;
    for _ in 0..4000 {
        let centre = random.point(1.4);
        let apart = distance(&solid, &centre);
        let within = winding(solid.vertices(), solid.triangles().iter(), &centre) == 1;
        let signed = if within { -apart } else { apart };
        assert_eq!(shape.contains(&centre), within);
        assert_eq!(container.contains(&centre), !within);
        let (out, back) = (touches(&shape, &centre, 0.3), touches(&container, &centre, 0.3));
        assert_eq!(out.is_empty(), apart >= 0.3);
        if apart < 0.3 {
            worst = worst.max((out[0].distance - signed).abs()).max((back[0].distance + signed).abs());
            assert_eq!(out[0].normal, -back[0].normal);
            // inside there is one contact, towards the outside
            let (touched, other) = if within { (&back, &out) } else { (&out, &back) };
            assert_eq!(other.len(), 1);
            several += usize::from(touched.len() > 1);
        }
    }
    assert!(several > 100);
    println!("nearest contact against a search through all facets: {worst:.1e}");
    assert!(worst < 1e-14, "{worst}");
}

#[test]
fn every_contact_is_a_local_minimum_of_the_distance() {
    let mesh = bumpy();
    let shape = Shape::Mesh(mesh.clone());
    let mut random = Random::new(3);
    for _ in 0..1500 {
        let centre = random.point(1.3);
        for touch in touches(&shape, &centre, 0.4).iter().skip(1) {
            let at = centre - touch.normal * touch.distance;
            assert!(distance(&mesh, &at) < 1e-14);
            // no point of the surface near this point is closer
            for triangle in mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])) {
                if (nearest_point(&at, triangle) - at).norm() < 1e-9 {
                    assert!((nearest_point(&centre, triangle) - centre).norm() > touch.distance - 1e-12);
                }
            }
        }
    }
}

#[test]
fn a_sphere_behind_the_surface_of_a_closed_mesh_is_pushed_out() {
    // a plate thinner than the sphere: its far face must not pull the sphere through
    let plate = Shape::Mesh(Mesh::block(Vector3::new(1.0, 1.0, 0.005)).unwrap());
    for (height, distance) in [(0.0149, 0.0099), (0.004, -0.001), (0.0051, 0.0001)] {
        let found = touches(&plate, &Vector3::new(0.1, 0.3, height), 0.02);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].normal, Vector3::z());
        assert!((found[0].distance - distance).abs() < 1e-15);
    }
    let cavity = Shape::Mesh(Mesh::sphere(1.0, 2).unwrap().flipped());
    let out = Vector3::new(0.31, 0.62, -0.85).normalize() * 1.01;
    let back = touches(&cavity, &out, 0.2);
    assert!(back.len() == 1 && back[0].distance < 0.0 && back[0].normal.dot(&out) < -0.9);
}

#[test]
fn the_corner_of_a_container_is_three_contacts() {
    let half = Vector3::new(0.5, 0.4, 0.3);
    let container = Shape::Mesh(Mesh::block(half).unwrap().flipped());
    let centre = half - Vector3::new(0.09, 0.08, 0.07);
    let found = touches(&container, &centre, 0.1);
    let expected = [(-Vector3::z(), 0.07), (-Vector3::y(), 0.08), (-Vector3::x(), 0.09)];
    assert_eq!(found.len(), 3);
    for (touch, (normal, distance)) in found.iter().zip(expected) {
        assert!((touch.distance - distance).abs() < 1e-15 && (touch.normal - normal).norm() < 1e-15);
    }
    assert_eq!(touches(&container, &centre, 0.085).len(), 2);
    assert_eq!(touches(&container, &centre, 0.05).len(), 0);
}

#[test]
fn bodies_hold_what_their_surface_winds_round() {
    let sphere = Mesh::sphere(1.0, 2).unwrap();
    let inner = sphere.flipped();
    // a hollow sphere beside a block: one mesh of three parts
    let mut vertices = sphere.vertices().to_vec();
    let mut triangles = sphere.triangles().to_vec();
    let mut join = |mesh: &Mesh, scale: f64, shift: Vector3<f64>| {
        let first = vertices.len() as u32;
        vertices.extend(mesh.vertices().iter().map(|v| v * scale + shift));
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| v + first)));
    };
    join(&inner, 0.5, Vector3::zeros());
    join(&Mesh::block(Vector3::new(0.5, 0.5, 0.5)).unwrap(), 1.0, Vector3::new(2.0, 0.0, 0.0));
    let mesh = Mesh::new(vertices, triangles, MeshKind::Solid).unwrap();
    let full = sphere.volume();
    assert!((mesh.volume() - (full * (1.0 - 0.125) + 1.0)).abs() < 1e-13);
    let shape = Shape::Mesh(mesh);
    for (x, inside) in [(0.0, false), (0.7, true), (1.2, false), (1.6, true), (2.6, false)] {
        assert_eq!(shape.contains(&Vector3::new(x, 0.01, 0.02)), inside, "x = {x}");
    }
    let plane = Shape::plane(Vector3::new(0.0, 3.0, 4.0)).unwrap();
    assert!(plane.contains(&Vector3::new(9.0, -0.1, 0.0)) && !plane.contains(&Vector3::new(9.0, 0.1, 0.0)));
}

#[test]
fn generated_bodies_have_the_areas_and_volumes_of_geometry() {
    let half = Vector3::new(0.3, 0.2, 0.1);
    let block = Mesh::block(half).unwrap();
    assert!((block.volume() - 8.0 * 0.006).abs() < 1e-16 && block.triangles().len() == 12);
    assert!((block.area() - Shape::block(half).unwrap().area()).abs() < 1e-15);
    assert_eq!(block.bounds(), [-half, half]);
    assert_eq!(block.flipped().volume(), -block.volume());
    assert_eq!((block.flipped().kind(), block.flipped().flipped()), (MeshKind::Container, block));

    let (radius, height, sides) = (0.4, 1.5, 24);
    let cylinder = Mesh::cylinder(radius, height, sides).unwrap();
    let polygon = f64::from(sides) / 2.0 * radius.powi(2) * (std::f64::consts::TAU / f64::from(sides)).sin();
    assert!((cylinder.volume() - polygon * height).abs() < 1e-14);

    let miss = |subdivisions| {
        let sphere = Mesh::sphere(2.0, subdivisions).unwrap();
        assert_eq!(sphere.triangles().len(), 20 << (2 * subdivisions));
        1.0 - sphere.volume() / (4.0 / 3.0 * std::f64::consts::PI * 8.0)
    };
    // second order in the length of an edge
    assert!((miss(2) / miss(3) - 4.0).abs() < 0.1 && miss(3) < 0.01);
}
