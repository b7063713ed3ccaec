//! Flat faces divided into triangles: contacts are everywhere the same as on a plane.

use super::*;

/// A floor in z = 0 of uneven quadrilaterals, each halved at random along one of its diagonals.
fn floor(cells: u32, kind: MeshKind, random: &mut Random) -> Mesh {
    let size = 1.0 / f64::from(cells);
    let mut vertices = Vec::new();
    for (j, i) in (0..=cells).flat_map(|j| (0..=cells).map(move |i| (j, i))) {
        let mut jitter = |k: u32| if k == 0 || k == cells { 0.0 } else { random.between(-0.2, 0.2) };
        let (x, y) = (f64::from(i) + jitter(i), f64::from(j) + jitter(j));
        vertices.push(Vector3::new(x * size - 0.5, y * size - 0.5, 0.0));
    }
    let mut triangles = Vec::new();
    for (j, i) in (0..cells).flat_map(|j| (0..cells).map(move |i| (j, i))) {
        let a = j * (cells + 1) + i;
        let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
        triangles.extend(if random.next() < 0.5 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
    Mesh::new(vertices, triangles, kind).unwrap()
}

/// Centres over vertices, edges and faces, at heights down to far behind the floor.
fn centres(mesh: &Mesh, radius: f64, random: &mut Random) -> Vec<Vector3<f64>> {
    let mut places = mesh.vertices().to_vec();
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|v| mesh.vertices()[v as usize]);
        places.extend([(a + b) / 2.0, (a + b + c) / 3.0, a + (b - a) * random.next(), a + (c - a) * 1e-13]);
        let (u, v) = (random.next(), random.next());
        places.push(a + (b - a) * (u * (1.0 - v)) + (c - a) * (u * v));
    }
    places.retain(|p| p.amax() < 0.5);
    places.iter().map(|p| p + Vector3::z() * radius * random.between(-0.2, 0.999)).collect()
}

#[test]
fn a_floor_of_triangles_is_a_plane_at_every_place() {
    let mut random = Random::new(4);
    let radius = 0.07;
    let straight = floor(14, MeshKind::OneSided, &mut random);
    let plane = Shape::plane(Vector3::z()).unwrap();
    let tilt = UnitQuaternion::from_euler_angles(0.7, 0.3, -1.9);
    let mut worst = [0.0f64; 2];
    for (case, turn) in [UnitQuaternion::identity(), tilt].iter().enumerate() {
        let shape = Shape::Mesh(turned(&straight, turn));
        for centre in centres(&straight, radius, &mut random) {
            let expected = touches(&plane, &centre, radius);
            let found = touches(&shape, &(turn * centre), radius);
            assert_eq!((found.len(), expected.len()), (1, 1), "at {centre}");
            let back = Touch { normal: turn.inverse() * found[0].normal, ..found[0] };
            worst[case] = worst[case].max(difference(&back, &expected[0]));
        }
    }
    println!("floor of triangles against plane: {:.1e}, tilted {:.1e}", worst[0], worst[1]);
    assert!(worst[0] == 0.0 && worst[1] < 1e-13, "{worst:?}");
}

/// Every triangle with separate corners, moved.
fn loose(mesh: &Mesh, place: impl Fn(usize, &Vector3<f64>) -> Vector3<f64>) -> Vec<Vector3<f64>> {
    let corners = |(k, t): (usize, &[u32; 3])| t.map(|v| place(k, &mesh.vertices()[v as usize]));
    mesh.triangles().iter().enumerate().flat_map(corners).collect()
}

#[test]
fn a_floor_whose_triangles_do_not_share_vertices_is_a_plane_too() {
    let mut random = Random::new(11);
    let fine = floor(12, MeshKind::OneSided, &mut random);
    let coarse = floor(5, MeshKind::OneSided, &mut random);
    // like a file in single precision whose corners do not meet exactly
    let skew = Vector3::new(1e-8, -1e-8, 0.0);
    let apart = loose(&fine, |k, p| (p + skew * (k % 7) as f64).map(|x| f64::from(x as f32)));
    // two floors that divide their common line in different ways
    let mut side = loose(&fine, |_, p| *p);
    side.extend(loose(&coarse, |_, p| p + Vector3::x()));
    for (vertices, joint) in [(apart, 0.0), (side, 0.5)] {
        let triangles = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let shape = Shape::Mesh(Mesh::new(vertices, triangles, MeshKind::OneSided).unwrap());
        for _ in 0..5000 {
            let (x, y) = (joint + random.between(-0.3, 0.3), random.between(-0.42, 0.42));
            let centre = Vector3::new(x, y, random.between(0.01, 0.069));
            let found = touches(&shape, &centre, 0.07);
            assert_eq!(found.len(), 1, "{found:?} at {centre}");
            assert!((found[0].distance - centre.z).abs() < 1e-12 && (found[0].normal - Vector3::z()).norm() < 1e-5);
        }
    }
}

#[test]
fn the_faces_of_a_finely_cut_body_are_flat() {
    // a cylinder's cap is a fan: many thin triangles meet above its middle
    let cylinder = Shape::Mesh(Mesh::cylinder(0.5, 1.0, 400).unwrap());
    let mut random = Random::new(5);
    for k in 0..2000 {
        let scale = if k == 0 { 0.0 } else { 10f64.powf(random.between(-16.0, -0.4)) };
        let centre = random.point(1.0).component_mul(&Vector3::new(scale, scale, 0.0)) + Vector3::z() * 0.53;
        let found = touches(&cylinder, &centre, 0.04);
        assert_eq!(found.len(), 1, "at {centre}");
        assert!((found[0].distance - 0.03).abs() < 1e-15 && (found[0].normal - Vector3::z()).norm() < 1e-13);
    }
}

/// A sphere that slides with a spring and friction: its centre after every step.
fn slide(shape: &Shape, start: Vector3<f64>, velocity: Vector3<f64>, turn: &UnitQuaternion<f64>) -> Vec<Vector3<f64>> {
    let (radius, mass, stiffness, friction, dt) = (0.07, 1.0, 1e5, 0.3, 1e-4);
    let gravity = turn * Vector3::new(0.0, 0.0, -9.81);
    let (mut centre, mut velocity) = (turn * start, turn * velocity);
    let (mut facets, mut now, mut heirs) = (Vec::new(), Vec::new(), Vec::new());
    let mut before: Vec<(u32, Vector3<f64>)> = Vec::new();
    let mut shears: Vec<Vector3<f64>> = Vec::new();
    let mut path = Vec::new();
    for _ in 0..6000 {
        shape.near(&centre, radius, &mut facets);
        shape.touches(&centre, radius, &facets, &mut now);
        inherit(&before, &now, &mut heirs);
        let mut force = mass * gravity;
        let mut next = Vec::new();
        for (touch, heir) in now.iter().zip(&heirs) {
            let push = stiffness * (radius - touch.distance);
            let moved = velocity - touch.normal * velocity.dot(&touch.normal);
            let mut shear = heir.map_or(Vector3::zeros(), |old: usize| shears[old]) - stiffness * moved * dt;
            shear *= (friction * push / shear.norm()).min(1.0);
            force += touch.normal * push + shear;
            next.push(shear);
        }
        shears = next;
        before = now.iter().map(|touch| (touch.feature, touch.normal)).collect();
        velocity += force / mass * dt;
        centre += velocity * dt;
        path.push(turn.inverse() * centre);
    }
    path
}

#[test]
fn a_sphere_slides_over_triangles_as_over_a_plane() {
    let mut random = Random::new(6);
    let mesh = floor(20, MeshKind::OneSided, &mut random);
    let plane = Shape::plane(Vector3::z()).unwrap();
    let straight = UnitQuaternion::identity();
    let tilt = UnitQuaternion::from_euler_angles(-0.2, 1.3, 0.5);
    // straight through a vertex, and along the floor's diagonal
    let vertex = mesh.vertices()[21 * 10 + 10];
    let velocity = Vector3::new(1.1, 0.25, 0.0);
    let starts = [(vertex - velocity * 0.2, velocity), (Vector3::new(-0.4, -0.4, 0.0), Vector3::new(1.3, 1.3, 0.0))];
    for (start, velocity) in starts {
        let start = start + Vector3::z() * 0.0699;
        let expected = slide(&plane, start, velocity, &straight);
        let end = expected.last().unwrap();
        assert!((end - start).norm() > 0.15 && end.amax() < 0.5);
        let mut worst = 0.0f64;
        for turn in [&straight, &tilt] {
            for kind in [MeshKind::OneSided, MeshKind::TwoSided] {
                let mesh = Mesh::new(mesh.vertices().to_vec(), mesh.triangles().to_vec(), kind).unwrap();
                let path = slide(&Shape::Mesh(turned(&mesh, turn)), start, velocity, turn);
                worst = path.iter().zip(&expected).fold(worst, |m, (a, b)| m.max((a - b).norm()));
            }
        }
        println!("path over triangles against plane: {worst:.1e} m over {:.2} m", (end - start).norm());
        assert!(worst < 1e-12, "{worst}");
    }
}

#[test]
fn a_sphere_slides_off_a_meshed_block_as_off_a_block() {
    let half = Vector3::new(0.3, 0.2, 0.1);
    let (block, mesh) = (Shape::block(half).unwrap(), Shape::Mesh(Mesh::block(half).unwrap()));
    let start = Vector3::new(0.22, 0.12, 0.1 + 0.0699);
    // over a long edge, over a short one, and over a corner
    for velocity in [Vector3::new(0.1, 0.9, 0.0), Vector3::new(0.9, 0.1, 0.0), Vector3::new(0.8, 0.8, 0.0)] {
        let straight = UnitQuaternion::identity();
        let expected = slide(&block, start, velocity, &straight);
        let end = expected.last().unwrap();
        assert!(end.z < 0.0 && (end.x > 0.3 || end.y > 0.2), "{end}");
        let path = slide(&mesh, start, velocity, &straight);
        let worst = path.iter().zip(&expected).fold(0.0f64, |m, (a, b)| m.max((a - b).norm()));
        println!("path off a meshed block against a block: {worst:.1e} m");
        assert!(worst < 1e-12, "{worst}");
    }
}

#[test]
fn sheets_know_their_sides_and_borders() {
    let mut random = Random::new(7);
    let one = Shape::Mesh(floor(4, MeshKind::OneSided, &mut random));
    let two = Shape::Mesh(floor(4, MeshKind::TwoSided, &mut random));
    let below = Vector3::new(0.1, 0.05, -0.02);
    assert!(!one.contains(&below) && !two.contains(&below));
    // a one-sided sheet pushes towards its front, a two-sided sheet towards the side of the centre
    let [front, back] = [&one, &two].map(|shape| touches(shape, &below, 0.05));
    assert_eq!((front.len(), front[0].distance, front[0].normal), (1, -0.02, Vector3::z()));
    assert_eq!((back.len(), back[0].distance, back[0].normal), (1, 0.02, -Vector3::z()));
    assert!(touches(&one, &Vector3::new(0.1, 0.05, -0.06), 0.05).is_empty());
    // beyond the border both sheets are an edge, and at the end of the border a corner
    for shape in [&one, &two] {
        let edge = touches(shape, &Vector3::new(0.53, 0.1, 0.04), 0.06);
        assert_eq!(edge.len(), 1);
        assert!((edge[0].distance - 0.05).abs() < 1e-15 && (edge[0].normal.x - 0.6).abs() < 1e-14);
        let corner = touches(shape, &Vector3::new(0.51, -0.52, 0.02), 0.06);
        assert_eq!(corner.len(), 1);
        assert!((corner[0].distance - 0.03).abs() < 1e-15);
    }
}
