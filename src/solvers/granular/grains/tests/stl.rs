//! Surfaces written to files and read back, and files that are not valid.

use super::super::super::shape::{FaultKind, Mesh};
use super::super::stl::{StlError, read, write};
use super::super::*;
use nalgebra::Vector3;
use proptest::prelude::*;

fn stone() -> Mesh {
    Angular { flatness: 0.7, elongation: 0.7, roundness: 0.1 }.surface(1, 0).unwrap()
}

/// The surface as text, its corners with `digits` digits.
fn text(mesh: &Mesh, digits: usize) -> String {
    let mut text = "solid a stone of facets\n".to_string();
    for corners in mesh.triangles() {
        text += "facet normal 0 0 0\n  outer loop\n";
        for v in corners.map(|v| mesh.vertices()[v as usize]) {
            text += &format!("    vertex {:.digits$} {:.digits$e} {:.digits$}\n", v.x, v.y, v.z);
        }
        text += "  endloop\nendfacet\n";
    }
    text + "endsolid a stone\n"
}

#[test]
fn a_binary_file_gives_the_surface_back() {
    let (stone, again) = (stone(), read(&write(&stone())).unwrap());
    assert_eq!(again.triangles().len(), stone.triangles().len());
    assert!((again.volume() / stone.volume() - 1.0).abs() < 1e-6);
    assert_eq!(read(&write(&again)).unwrap(), again);
}

#[test]
fn a_binary_file_may_say_solid() {
    let mut bytes = write(&stone());
    bytes[..5].copy_from_slice(b"solid");
    assert_eq!(read(&bytes).unwrap(), read(&write(&stone())).unwrap());
}

#[test]
fn a_text_gives_the_surface_back_and_close_corners_are_one() {
    let block = Mesh::block(Vector3::new(30.0, 20.0, 10.0)).unwrap();
    assert_eq!(read(text(&block, 9).as_bytes()).unwrap().vertices().len(), 8);
    // in capitals; with one corner slightly moved
    let moved = text(&block, 9).to_uppercase().replacen("-30.000000000 ", "-29.999990000 ", 1);
    let again = read(moved.as_bytes()).unwrap();
    assert_eq!((again.vertices().len(), again.triangles().len()), (8, 12));
}

#[test]
fn what_is_no_stl_is_told() {
    assert_eq!(read(b""), Err(StlError::NotStl));
    assert_eq!(read(b"ply\nformat ascii 1.0\n"), Err(StlError::NotStl));
    let whole = write(&stone());
    let facets = stone().triangles().len();
    assert_eq!(read(&whole[..whole.len() - 10]), Err(StlError::Cut { facets, found: facets - 1 }));
    let block = text(&Mesh::block(Vector3::repeat(1.0)).unwrap(), 3);
    let at = block.find("vertex").unwrap();
    let wrong = block.replacen("vertex", "vertx", 1);
    let expected = StlError::Text { expected: "vertex", found: "vertx".into(), bytes: at..at + 5 };
    assert_eq!(read(wrong.as_bytes()), Err(expected));
    let comma = block.replacen("1.000", "1,000", 1);
    assert!(matches!(read(comma.as_bytes()), Err(StlError::Text { expected: "a number", .. })));
    let cut = &block[..block.find("endsolid").unwrap()];
    assert!(
        matches!(read(cut.as_bytes()), Err(StlError::Text { expected: "endsolid", found, .. }) if found.is_empty())
    );
}

#[test]
fn what_is_no_body_is_told() {
    let kinds = |bytes: &[u8]| -> Vec<FaultKind> {
        let Err(StlError::Mesh(error)) = read(bytes) else { return Vec::new() };
        error.faults.iter().map(|fault| fault.kind).collect()
    };
    let mut open = write(&stone());
    let facets = stone().triangles().len() as u32;
    open.truncate(open.len() - 50);
    open[80..84].copy_from_slice(&(facets - 1).to_le_bytes());
    assert_eq!(kinds(&open), [FaultKind::OpenEdge]);
    assert_eq!(kinds(&write(&stone().flipped())), [FaultKind::InsideOut]);
    assert_eq!(kinds(b"solid nothing\nendsolid\n"), [FaultKind::Empty]);
    let block = Mesh::block(Vector3::repeat(1.0)).unwrap();
    let far: Vec<_> = block.vertices().iter().map(|v| v + Vector3::new(9.0, 0.0, 0.0)).collect();
    let other = Mesh::new(far, block.triangles().to_vec(), block.kind()).unwrap();
    assert_eq!(read((text(&block, 3) + &text(&other, 3)).as_bytes()), Err(StlError::Bodies { count: 2 }));
}

proptest! {
    #[test]
    fn any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..400), words in prop::collection::vec(
        prop::sample::select("solid facet normal outer loop vertex 1 -2e3 x endloop endfacet endsolid".split(' ').collect::<Vec<_>>()), 0..60,
    )) {
        let _ = read(&bytes);
        let text = format!("solid\n{}", words.join(" "));
        prop_assert!(read(text.as_bytes()).is_err());
    }
}
