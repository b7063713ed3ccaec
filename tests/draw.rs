//! `trackbed draw`: what a scene says is to be seen, and a scene with mistakes leaves no picture.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn draw(scene: &Path, out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.arg("draw").arg(scene).arg("--out").arg(out).output().unwrap()
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(name)
}

#[test]
fn layers_cross_sections_and_gradings_are_drawn_with_their_dimensions() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("scene.svg");
    let output = draw(&shipped("transition_full.track"), &out);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = std::fs::read_to_string(&out).unwrap();
    for text in [
        "ballast: 300 mm",
        "subgrade: 1000 mm, 472 MPa",
        "1.5 m",
        "2.4 m",
        "Mass passing [%]",
        "32 to 80 mm",
        "Grains of ballast",
        "S/I 0.7, I/L 0.7",
        "2 pebbles",
    ] {
        assert!(picture.contains(text), "no {text}");
    }
}

#[test]
fn stretches_are_drawn_where_they_act() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("usp.svg");
    assert!(draw(&shipped("usp.track"), &out).status.success());
    assert!(std::fs::read_to_string(&out).unwrap().contains("graded: 12 m, usp"));
}

#[test]
fn wedges_and_approach_slabs_are_drawn_in_their_layers() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("scene.svg");
    for (scene, texts) in [
        (
            "wedge.track",
            ["wedge: 20 m, layers", "treated: 100 to 800 mm, 150 to 900 MPa", "fill: 1900 to 1200 mm, 60 MPa"],
        ),
        (
            "bridge.track",
            ["approach: 6 m, approach_slab", "approach slab: 300 mm, 34 GPa, hinged", "ballasted at 60 m"],
        ),
    ] {
        assert!(draw(&shipped(scene), &out).status.success());
        let picture = std::fs::read_to_string(&out).unwrap();
        texts.iter().for_each(|text| assert!(picture.contains(text), "{scene}: no {text}"));
    }
}

#[test]
fn a_scene_with_mistakes_leaves_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (folder.path().join("bad.track"), folder.path().join("bad.svg"));
    std::fs::write(&scene, "track line { sections = [nothing: 3 m] }\n").unwrap();
    let output = draw(&scene, &out);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("E0201"));
    assert!(!out.exists());
}
