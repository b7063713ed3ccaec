//! Surfaces of grains in a scene: files and those of the library, read, refused, resolved and drawn.

use std::path::Path;
use trackbed::check::Modules;
use trackbed::diag::Code;
use trackbed::scenario::{Shape, Surfaces};
use trackbed::solvers::granular::grains::{Angular, stl};
use trackbed::{Compiled, compile};

/// Files beside the scene.
struct Files(Vec<(&'static str, Vec<u8>)>);

impl Modules for Files {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.iter().find(|(name, _)| relative == Path::new(name)).map(|(_, bytes)| bytes.clone())
    }
}

fn stone() -> Vec<u8> {
    stl::write(&Angular { flatness: 0.7, elongation: 0.6, roundness: 0.1 }.surface(9, 0).unwrap())
}

fn scene(shape: &str, files: Vec<(&'static str, Vec<u8>)>) -> Compiled {
    let text = format!(
        r#"use std
granular stone : ballasts.granite_31_63 {{ shape = {shape} }}
trackform open {{
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m
  layers = [stone: 350 mm, soils.sandy_gravel: 2 m]
  support = {{ stiffness = 40 MN/m per seat }}
}}
track line {{ sections = [open: 42 m] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }}
traffic {{ trains = ore, total = 400 axles }}
"#
    );
    compile("scene.track", &text, &Files(files), &[])
}

fn shape_of(compiled: &Compiled) -> &Shape {
    assert!(compiled.diagnostics.is_empty(), "{:?}", compiled.diagnostics);
    &compiled.scenario.as_ref().unwrap().track.sections[0].layers[0].granular().unwrap().shape
}

/// Code and message of the only mistake.
fn mistake(bytes: Vec<u8>) -> (Code, String) {
    let compiled = scene("clumps(from = file(\"stone.stl\"))", vec![("stone.stl", bytes)]);
    let [one] = &compiled.diagnostics[..] else { panic!("{:?}", compiled.diagnostics) };
    assert!(one.help.is_some());
    (one.code, one.message.clone())
}

#[test]
fn files_and_the_library_give_a_template_each() {
    let compiled = scene("clumps(from = [file(\"stones/a.stl\"), worn, flat])", vec![("stones/a.stl", stone())]);
    let shape = shape_of(&compiled);
    let Shape::Clumps { surfaces: Surfaces::Meshes(surfaces), .. } = shape else { panic!("{shape:?}") };
    let names: Vec<&str> = surfaces.iter().map(|surface| surface.name.as_str()).collect();
    assert_eq!(names, ["stones/a.stl", "worn", "flat"]);
    let templates = shape.clumps().unwrap().templates(1).unwrap();
    assert!(templates.len() == 3 && templates.iter().all(|t| (2..=3).contains(&t.pebbles.len())));
}

#[test]
fn without_surfaces_grains_are_angular() {
    let shape = shape_of(&scene("clumps(5, templates = 3, flatness = 0.6, roundness = 0.3)", vec![])).clone();
    let templates = shape.clumps().unwrap().templates(4).unwrap();
    assert_eq!(templates.iter().map(|t| t.pebbles.len()).collect::<Vec<_>>(), [5, 5, 5]);
    assert_eq!(shape_of(&scene("spheres", vec![])).clumps(), None);
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let whole = stone();
    let facets = (whole.len() - 84) / 50;
    let (code, message) = mistake(whole[..whole.len() - 20].to_vec());
    assert_eq!(code, Code::E0606);
    assert!(
        message.contains(&format!("the header gives {facets} triangles, the file holds {}", facets - 1)),
        "{message}"
    );
    assert_eq!(mistake(b"ply".to_vec()).0, Code::E0606);
    let mut open = whole[..whole.len() - 50].to_vec();
    open[80..84].copy_from_slice(&(facets as u32 - 1).to_le_bytes());
    let (code, message) = mistake(open);
    assert_eq!(code, Code::E0607);
    assert!(message.contains("3 open edges, the first at triangle"), "{message}");
    let inside_out = stl::write(&stl::read(&whole).unwrap().flipped());
    assert!(mistake(inside_out).1.contains("1 part inside out"));
    let text = "solid s\nfacet normal 0 0 0 outer loop\nvertex 1 2 3\nvertx 1 2 3\n";
    assert!(mistake(text.into()).1.contains("expected `vertex`, found `vertx`"));
}

#[test]
fn one_bad_file_of_several_layers_is_said_once() {
    let compiled = scene(
        "clumps(from = [file(\"a.stl\"), file(\"b.stl\")])",
        vec![("a.stl", b"ply".to_vec()), ("b.stl", stone())],
    );
    assert_eq!(compiled.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [Code::E0606]);
}
