//! Broken meshes and shapes are refused, all faults at once.

use super::*;

fn block() -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let mesh = Mesh::block(Vector3::new(0.5, 0.5, 0.5)).unwrap();
    (mesh.vertices().to_vec(), mesh.triangles().to_vec())
}

fn faults(vertices: &[Vector3<f64>], triangles: &[[u32; 3]], kind: MeshKind) -> Vec<(FaultKind, usize)> {
    match Mesh::new(vertices.to_vec(), triangles.to_vec(), kind) {
        Ok(_) => Vec::new(),
        Err(error) => error.faults.iter().map(|fault| (fault.kind, fault.count)).collect(),
    }
}

#[test]
fn every_fault_has_its_kind_and_count() {
    use FaultKind::*;
    let (v, t) = block();
    let solid = |v: &[Vector3<f64>], t: &[[u32; 3]]| faults(v, t, MeshKind::Solid);
    assert_eq!(solid(&v, &t), []);
    assert_eq!(solid(&v, &[]), [(Empty, 1)]);
    assert_eq!(solid(&v, &t[1..]), [(OpenEdge, 3)]);
    assert_eq!(faults(&v, &t[1..], MeshKind::OneSided), []);

    let mut twisted = t.clone();
    twisted[4].swap(0, 1);
    assert_eq!(solid(&v, &twisted), [(Winding, 3)]);
    assert_eq!(faults(&v, &twisted, MeshKind::TwoSided), []);

    let flipped: Vec<_> = t.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    assert_eq!(solid(&v, &flipped), [(InsideOut, 1)]);
    assert_eq!(faults(&v, &flipped, MeshKind::Container), []);
    assert_eq!(faults(&v, &t, MeshKind::Container), [(InsideOut, 1)]);

    let mut doubled = t.clone();
    doubled.push(t[0]);
    assert_eq!(solid(&v, &doubled), [(NonManifoldEdge, 3)]);

    let mut far = t.clone();
    far[2][1] = 8;
    far[5][0] = u32::MAX;
    assert_eq!(solid(&v, &far), [(OutOfRange, 2)]);

    let mut broken = v.clone();
    broken[3].y = f64::NAN;
    broken[6].x = f64::INFINITY;
    assert_eq!(solid(&broken, &far), [(NonFinite, 2), (OutOfRange, 2)]);

    let huge: Vec<_> = v.iter().map(|v| v * 1e200).collect();
    assert_eq!(solid(&huge, &t)[0], (Degenerate, 12));
    // a leaf folded back onto itself encloses nothing
    assert_eq!(solid(&v, &[[0, 1, 2], [0, 2, 1]]), [(Flat, 1)]);
}

#[test]
fn faults_come_together_with_places_and_ways_out() {
    let (v, mut t) = block();
    t[4].swap(0, 1);
    t.remove(9);
    t.push([0, 1, 1]);
    let error = Mesh::new(v, t, MeshKind::Solid).unwrap_err();
    let text = error.to_string();
    let expected = [
        "1 triangle without area (triangle 11 at (0.166667, -0.500000, -0.500000) m)",
        "3 open edges (triangle ",
        "2 edges between triangles that face opposite ways (triangle ",
        "swap two vertices",
    ];
    assert!(expected.iter().all(|part| text.contains(part)), "{text}");
    assert_eq!(error.faults.len(), 3);
}

#[test]
fn a_part_that_faces_the_wrong_way_is_found_among_others() {
    let (v, t) = block();
    let join = |scale: f64, shift: f64, swap: bool| {
        let mut vertices = v.clone();
        vertices.extend(v.iter().map(|p| p * scale + Vector3::x() * shift));
        let mut triangles = t.clone();
        triangles.extend(t.iter().map(|[a, b, c]| if swap { [a + 8, c + 8, b + 8] } else { [a + 8, b + 8, c + 8] }));
        faults(&vertices, &triangles, MeshKind::Solid)
    };
    let wrong = [(FaultKind::InsideOut, 1)];
    assert_eq!(join(0.5, 2.0, false), []);
    assert_eq!(join(0.5, 2.0, true), wrong);
    // a cavity faces inward
    assert_eq!(join(0.5, 0.0, true), []);
    assert_eq!(join(0.5, 0.0, false), wrong);
}

#[test]
fn vertices_at_one_place_become_one() {
    let (v, t) = block();
    // like a file without shared vertices: three per triangle, and one unused vertex
    let mut loose: Vec<_> = t.iter().flatten().map(|corner| v[*corner as usize]).collect();
    loose.push(Vector3::new(9.0, 9.0, 9.0));
    let triangles: Vec<_> = (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    loose[0] += Vector3::repeat(-0.0);
    let mesh = Mesh::new(loose, triangles, MeshKind::Solid).unwrap();
    assert_eq!(mesh.vertices().len(), 8);
    assert_eq!(mesh.bounds()[1], Vector3::repeat(0.5));
}

#[test]
fn generators_refuse_what_is_no_body() {
    assert!(Mesh::block(Vector3::new(1.0, 0.0, 1.0)).is_err());
    assert!(Mesh::block(Vector3::new(1.0, -1.0, 1.0)).is_err());
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Mesh::sphere(length, 1).is_err());
        assert!(Mesh::cylinder(1.0, length, 12).is_err());
    }
    assert!((0..3).all(|sides| Mesh::cylinder(1.0, 1.0, sides).is_err()));
    assert_eq!(Mesh::sphere(1.0, 10).unwrap_err().faults[0].kind, FaultKind::TooMany);
    assert_eq!(Mesh::cylinder(1.0, 1.0, u32::MAX).unwrap_err().faults[0].kind, FaultKind::TooMany);
}

#[test]
fn planes_and_blocks_without_sense_are_refused() {
    let plane = Shape::plane(Vector3::new(0.0, 3e-200, 4e-200)).unwrap();
    assert!(matches!(plane, Shape::Plane { normal } if (normal - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-15));
    for normal in [Vector3::zeros(), Vector3::new(1.0, f64::NAN, 0.0), Vector3::new(f64::INFINITY, 0.0, 0.0)] {
        assert!(Shape::plane(normal).is_err());
    }
    assert!(Shape::Plane { normal: Vector3::new(0.0, 0.0, 2.0) }.check().is_err());
    let error = Shape::block(Vector3::new(0.1, 0.0, 0.2)).unwrap_err();
    assert_eq!(error.to_string(), "expected half lengths of a block above 0 m, found (0.1, 0, 0.2)");
    assert!(Shape::block(Vector3::new(0.1, f64::INFINITY, 0.2)).is_err());
}

#[test]
fn shapes_come_back_from_a_file_with_the_same_bits() {
    let turn = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.3);
    let shapes = [
        Shape::plane(Vector3::new(1.0, 2.0, 3.0)).unwrap(),
        Shape::block(Vector3::new(0.1, 0.2, 0.3)).unwrap(),
        Shape::Mesh(turned(&Mesh::cylinder(0.3, 1.0, 7).unwrap(), &turn)),
        Shape::Mesh(bumpy().flipped()),
    ];
    for shape in shapes {
        let text = serde_json::to_string(&shape).unwrap();
        assert!(serde_json::from_str::<Shape>(&text).unwrap() == shape);
    }
    let text = serde_json::to_string(&Shape::Mesh(Mesh::block(Vector3::repeat(1.0)).unwrap())).unwrap();
    let error = serde_json::from_str::<Shape>(&text.replace("Solid", "Container")).unwrap_err();
    assert!(error.to_string().contains("1 closed part that faces the wrong way"), "{error}");
}
