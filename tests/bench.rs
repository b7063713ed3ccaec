//! `trackbed bench` from end to end: what it prints, and that the number of threads changes only the time.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn grains(bed: &Path, more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.args(["bench", "grains", "--bed"]).arg(bed).args(more).env("NO_COLOR", "1").output().unwrap()
}

fn measured(bed: &Path, more: &[&str]) -> Value {
    let output = grains(bed, &[more, &["--format", "json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Exit code and what was said of the mistake.
fn refused(bed: &Path, more: &[&str]) -> (i32, String) {
    let output = grains(bed, more);
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn number(of: &Value, name: &str) -> f64 {
    let value = name.split('.').fold(of, |value, part| &value[part]);
    value.as_f64().unwrap_or_else(|| panic!("no number {name} in {of:#}"))
}

const HEADER: &str = "# periodic x 0.3 m, y 0.3 m; rigid floor z = 0; columns x y z r [m]\n";

/// Three layers of spheres that lie in each other's hollows and touch a little.
fn spheres(dir: &Path) -> PathBuf {
    let mut text = HEADER.to_owned();
    for layer in 0..3 {
        let (shift, z) = (0.015 * f64::from(layer % 2), 0.0149 + 0.0211 * f64::from(layer));
        for (i, j) in (0..10).flat_map(|i| (0..10).map(move |j| (f64::from(i), f64::from(j)))) {
            text += &format!("{:.4} {:.4} {z:.4} 0.015\n", 0.03 * i + shift, 0.03 * j + shift);
        }
    }
    let path = dir.join("layers.xyzr");
    fs::write(&path, text).unwrap();
    path
}

/// Pairs of spheres in one layer on the floor.
fn clumps(dir: &Path) -> PathBuf {
    let mut text = HEADER.replace("columns", "columns clump");
    for clump in 0..36 {
        let (x, y) = (0.05 * f64::from(clump % 6), 0.05 * f64::from(clump / 6));
        text += &format!("{clump} {x:.4} {y:.4} 0.0149 0.015\n{clump} {:.4} {y:.4} 0.0149 0.014\n", x + 0.012);
    }
    let path = dir.join("pairs.txt");
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_small_bed_gives_every_number() {
    let dir = tempfile::tempdir().unwrap();
    let json = measured(&spheres(dir.path()), &["--steps", "40", "--warm", "10", "--repeat", "2", "--threads", "1"]);
    let wanted = [("bodies", 300.0), ("pebbles", 300.0), ("steps", 40.0), ("threads", 1.0)];
    for (name, value) in wanted {
        assert_eq!(number(&json, name), value, "{name}");
    }
    assert_eq!(json["precision"], "mixed");
    assert!(json["clump_steps_per_second"].is_null());
    // four above and four below for the middle layer, four for the others, and the four beside
    assert!((4.0..10.0).contains(&number(&json, "contacts_per_sphere")), "{json:#}");
    for name in ["kinetic_energy", "contact_updates_per_second", "lists_made", "skin_m", "setup_seconds"] {
        assert!(number(&json, name) > 0.0, "{name}");
    }
    assert!(number(&json, "rotational_energy") >= 0.0);
    assert_eq!(json["all_seconds"].as_array().unwrap().len(), 2);
    let speed = 300.0 * 40.0 / number(&json, "seconds");
    assert!((number(&json, "sphere_steps_per_second") / speed - 1.0).abs() < 1e-12);
    let parts = ["search", "forces", "walls", "motion", "other"];
    let shares: f64 = parts.iter().map(|part| number(&json, &format!("time.{part}.share"))).sum();
    assert!((shares - 1.0).abs() < 1e-6, "the shares of the time sum up to {shares}");
    let bandwidth =
        number(&json, "bandwidth.used_bytes_per_second") / number(&json, "bandwidth.measured_bytes_per_second");
    assert!((number(&json, "bandwidth.share") / bandwidth - 1.0).abs() < 1e-12);
    assert!(number(&json, "bandwidth.bytes_per_step") > 300.0 * 64.0);
    if cfg!(target_os = "linux") {
        let each = number(&json, "peak_memory_bytes") / 300.0;
        assert!((number(&json, "bytes_per_sphere") / each - 1.0).abs() < 1e-12);
    }
}

#[test]
fn threads_reach_of_lists_and_repetition_change_no_energy() {
    let dir = tempfile::tempdir().unwrap();
    let bed = spheres(dir.path());
    let energies = |more: &[&str]| {
        let json = measured(&bed, &[&["--steps", "50"], more].concat());
        ["kinetic_energy", "rotational_energy", "contacts_per_sphere"].map(|name| number(&json, name).to_bits())
    };
    let one = energies(&["--threads", "1"]);
    assert_eq!(energies(&["--threads", "2"]), one);
    assert_eq!(energies(&["--skin", "1.5 mm", "--repeat", "2"]), one);
    let reference = measured(&bed, &["--steps", "50", "--precision", "f64"]);
    assert_eq!(reference["precision"], "f64");
    let (exact, found) = (number(&reference, "kinetic_energy"), f64::from_bits(one[0]));
    assert!((found / exact - 1.0).abs() < 1e-4, "{found} J in mixed precision, {exact} J in double");
}

#[test]
fn clumps_and_copies_are_counted() {
    let dir = tempfile::tempdir().unwrap();
    let bed = clumps(dir.path());
    let one = measured(&bed, &["--steps", "20"]);
    let many = measured(&bed, &["--steps", "20", "--copies", "3x2"]);
    assert_eq!([number(&one, "bodies"), number(&one, "pebbles")], [36.0, 72.0]);
    assert_eq!([number(&many, "bodies"), number(&many, "pebbles")], [216.0, 432.0]);
    let ratio = number(&one, "sphere_steps_per_second") / number(&one, "clump_steps_per_second");
    assert!((ratio - 2.0).abs() < 1e-12);
    let (energy, of_copies) = (number(&one, "kinetic_energy"), number(&many, "kinetic_energy"));
    assert!((of_copies / (6.0 * energy) - 1.0).abs() < 1e-6, "{of_copies} J in six copies of {energy} J");
    assert!((number(&one, "contacts_per_body") - number(&many, "contacts_per_body")).abs() < 1e-12);
}

#[test]
fn people_get_a_table() {
    let dir = tempfile::tempdir().unwrap();
    let output = grains(&spheres(dir.path()), &["--steps", "5", "--threads", "2"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for part in
        ["layers.xyzr: 300 spheres", "5 steps in", "2 threads, mixed precision", "sphere-steps", "forces", "triad"]
    {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
}

#[test]
fn mistakes_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = dir.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let (code, said) = refused(&dir.path().join("nothing.xyzr"), &[]);
    assert!(code == 2 && said.contains("cannot read") && said.contains("nothing.xyzr"), "{said}");
    let (code, said) = refused(&write("words.xyzr", &format!("{HEADER}0.1 0.1 0.1 0.01\n0.1 0.2 high 0.01\n")), &[]);
    assert!(code == 1 && said.contains("words.xyzr`, line 3: expected a number, found `high`"), "{said}");
    let (code, said) = refused(&write("bare.xyzr", "0.1 0.1 0.1 0.01\n"), &[]);
    assert!(code == 1 && said.contains("line 1: expected the limits of the bed: `# periodic x"), "{said}");
    let small = HEADER.replace("0.3 m", "0.02 m");
    let (code, said) =
        refused(&write("tight.xyzr", &format!("{small}0.001 0.01 0.02 0.03\n0.011 0.01 0.05 0.03\n")), &[]);
    assert!(code == 1 && said.contains("line 1: a period of 0.02 m is too short"), "{said}");
    // deep in each other: the kernel says which
    let (code, said) = refused(&write("deep.xyzr", &format!("{HEADER}0.1 0.1 0.1 0.03\n0.1 0.1 0.11 0.03\n")), &[]);
    assert!(code == 1 && said.contains("body"), "{said}");
    let bed = spheres(dir.path());
    for (more, part) in [
        (["--threads", "0"], "1..=1024"),
        (["--steps", "0"], "1..=1000000000"),
        (["--copies", "5"], "such as `5x2`"),
        (["--copies", "0x2"], "from 1 to 1000"),
        (["--skin", "2"], "such as `2 mm`"),
        (["--skin", "-2 mm"], "above 0"),
        (["--skin", "1 m"], "more than the largest radius"),
        (["--precision", "half"], "mixed, f64"),
    ] {
        let (code, said) = refused(&bed, &[&format!("{}={}", more[0], more[1])]);
        assert!(code == 2 && said.contains(part), "{more:?}: {said}");
    }
    let floor_only = write("open.xyzr", "# rigid floor z = 0\n0.1 0.1 0.029 0.03\n");
    let (code, said) = refused(&floor_only, &["--copies", "2x1"]);
    assert!(code == 2 && said.contains("not periodic along x"), "{said}");
    assert_eq!(number(&measured(&floor_only, &["--steps", "3"]), "contacts"), 1.0);
}

#[test]
fn a_bed_is_drawn_and_written_for_others() {
    let dir = tempfile::tempdir().unwrap();
    let bed = spheres(dir.path());
    let (picture, folder) = (dir.path().join("bed.svg"), dir.path().join("vtk"));
    let (drawn, written) = (picture.to_str().unwrap(), folder.to_str().unwrap());
    for color in ["displacement", "speed", "force"] {
        measured(&bed, &["--steps", "20", "--picture", drawn, "--color-by", color, "--chains", "--vtk", written]);
        let text = fs::read_to_string(&picture).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let circles = document.descendants().filter(|n| n.has_tag_name("circle")).count();
        // the front row hides most of the ten behind it
        assert!((30..300).contains(&circles), "{circles} of 300 spheres are drawn");
        assert!(text.contains("layers.xyzr after 20 steps, 0.20 ms") && text.contains(color), "{color}");
    }
    let pieces = ["bodies.vtp", "contacts.vtp"].map(|name| {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let piece = document.descendants().find(|n| n.has_tag_name("Piece")).unwrap();
        ["NumberOfVerts", "NumberOfLines"].map(|n| piece.attribute(n).unwrap().parse::<f64>().unwrap())
    });
    let json = measured(&bed, &["--steps", "20"]);
    assert_eq!(pieces, [[300.0, 0.0], [0.0, number(&json, "contacts")]]);
    // what cannot be written is said
    let (code, said) =
        refused(&bed, &["--steps", "2", "--picture", dir.path().join("no/such/bed.svg").to_str().unwrap()]);
    assert!(code == 1 && said.contains("cannot write"), "{said}");
    let (code, said) = refused(&bed, &["--steps", "2", "--vtk", bed.to_str().unwrap()]);
    assert!(code == 1 && said.contains("cannot make the directory"), "{said}");
}
