//! Layers, gradings, granular materials and soils: what the text says is what the scene holds, and what only grains can
//! run is checked and not run.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use trackbed::check::{Modules, NoModules, Override};
use trackbed::diag::{Code, Severity};
use trackbed::scenario::{
    BedEnds, Contact, Force, Loading, Repeats, Scenario, Seat, Shape, Strength, Surfaces, Tier, Volume,
};
use trackbed::{Compiled, compile};

fn shipped(name: &str, overrides: &[&str]) -> Compiled {
    let text = std::fs::read_to_string(format!("scenarios/{name}")).unwrap();
    let overrides: Vec<Override> = overrides.iter().map(|o| Override::parse(o).unwrap()).collect();
    compile(name, &text, &NoModules, &overrides)
}

/// A scene of ballasted track alone, with these layers, under a train.
fn scene(before: &str, layers: &str, after: &str) -> String {
    format!(
        "use std
{before}
trackform open {{
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m
  layers = [{layers}]
  support = {{ stiffness = 40 MN/m per seat }}
}}
track line {{ sections = [open: 42 m] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }}
traffic {{ trains = ore, total = 400 axles }}
{after}
"
    )
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn codes(compiled: &Compiled) -> Vec<Code> {
    compiled.diagnostics.iter().map(|d| d.code).collect()
}

/// The scenario of a text without a mistake; what no run reads yet is told and is none.
fn sound(text: &str, modules: &dyn Modules) -> Scenario {
    let compiled = compile("scene.track", text, modules, &[]);
    assert!(compiled.diagnostics.iter().all(|d| d.code == Code::E0429), "{}", told(&compiled));
    compiled.scenario.unwrap()
}

#[test]
fn the_papers_scene_is_checked_with_all_its_grains() {
    let compiled = shipped("transition_full.track", &[]);
    assert!(compiled.diagnostics.iter().all(|d| d.severity == Severity::Warning), "{}", told(&compiled));
    assert_eq!(codes(&compiled).iter().filter(|c| **c == Code::E0416).count(), 1, "{}", told(&compiled));
    let little = compiled.diagnostics.iter().find(|d| d.code == Code::E0416).unwrap();
    assert!(little.message.contains("24.5 % of its mass"), "{}", little.message);
    assert!(compiled.runnable().is_some(), "{}", told(&compiled));
    let scenario = compiled.scenario.unwrap();
    let [open, stiff] = scenario.track.sections.as_slice() else { panic!("two sections") };
    assert!(stiff.layers.is_empty() && stiff.slab.is_some(), "a slab takes the place of layers");
    let layers: Vec<(&str, f64)> = open.layers.iter().map(|l| (l.name.as_str(), l.thickness.value_at(-10.0))).collect();
    assert_eq!(layers, [("ballast", 0.3), ("subballast", 0.3), ("subgrade", 1.0)]);
    let (ballast, sub) = (open.layers[0].granular().unwrap(), open.layers[1].granular().unwrap());
    assert!(
        matches!(&ballast.shape, Shape::Clumps { pebbles: [2, 3], ratio, distance, surfaces: Surfaces::Angular { templates: 5, .. } }
        if **ratio == 0.8 && (**distance - 110f64.to_radians()).abs() < 1e-12)
    );
    assert_eq!((*ballast.density, *ballast.friction, *ballast.wall_friction), (2700.0, 0.7, 0.7));
    assert_eq!((ballast.grading.smallest(), ballast.grading.largest()), (0.032, 0.08));
    assert!(matches!(sub.contact, Contact::Linear { stiffness } if *stiffness == 5e6));
    assert_eq!((sub.shape.clone(), sub.packing.lifts, *sub.packing.pressure), (Shape::Spheres, 3, 200e3));
    assert_eq!((sub.grading.smallest(), *sub.local_damping, *sub.viscous_damping), (0.025, 0.2, 0.3));
    let subgrade = open.layers[2].soil().unwrap();
    assert_eq!((subgrade.youngs_modulus.value_at(0.0), *subgrade.poisson_ratio), (472e6, 0.25));
    assert_eq!((*subgrade.density, subgrade.strength), (2100.0, Strength::Elastic));
    assert_eq!(scenario.track.bed.half_width.map(|w| *w), Some(1.2));
    assert_eq!(scenario.track.bed.ends, BedEnds::Walls);
    let grains = &scenario.solve.grains;
    assert_eq!(
        (*grains.tier, grains.window.clone(), grains.repeats),
        (Tier::Full, Some(vec![[-24.0, 6.0]]), Repeats::ONCE)
    );
    let [volume] = scenario.volumes.as_slice() else { panic!("one record of ballast") };
    assert_eq!((volume.seats.len(), volume.depth, volume.after.as_slice()), (2, Some(0.2), &[100, 500][..]));
    assert_eq!(volume.volume, Volume::Box { along: 0.2, across: Some(1.2), height: 0.2 });
    assert_eq!(scenario.records.len(), 1, "the track keeps its own record");
}

#[test]
fn with_a_law_the_papers_scene_runs_as_without_grains() {
    let (full, plain) =
        (shipped("transition_full.track", &["solve.substructure=law"]), shipped("transition.track", &[]));
    assert!(full.runnable().is_some(), "{}", told(&full));
    assert!(codes(&full).contains(&Code::E0422), "what grains would have given is noted");
    let supports = |compiled: &Compiled| -> Vec<(f64, Option<(f64, f64)>)> {
        let seats = &compiled.scenario.as_ref().unwrap().track.seats;
        let support = |seat: &Seat| seat.support().map(|support| (*support.stiffness, *support.damping));
        seats.iter().map(|seat| (seat.x, support(seat))).collect()
    };
    assert_eq!(supports(&full), supports(&plain));
}

#[test]
fn the_box_test_is_checked_whole() {
    let compiled = shipped("box_test.track", &[]);
    assert_eq!(codes(&compiled), [], "{}", told(&compiled));
    assert!(
        compiled.runnable().is_some_and(|graph| graph.bed_under_actuators().is_some()),
        "it is run as it is planned"
    );
    for (wrong, code) in [
        ("actuator.force=cyclic(5 .. 60 kN, 5 Hz)", Code::E0304),
        ("actuator.force=cyclic(5 .. 60 kN, 5 Hz) per rail", Code::E0304),
        ("actuator.force=cyclic(60 .. 5 kN, 5 Hz) per sleeper", Code::E0505),
        ("actuator.force=cyclic(5 .. 60 kN, 5 s) per sleeper", Code::E0302),
        ("actuator.force=cyclc(5 .. 60 kN, 5 Hz) per sleeper", Code::E0408),
        ("actuator.total=40 cycles", Code::E0602),
        ("pressure.after=100 axles", Code::E0302),
        ("pressure.after=1.5 cycles", Code::E0405),
        ("box.bed_width=1 m per rail", Code::E0420),
        ("bed.layers.stone=100 mm", Code::E0511),
        ("bed.layers=[]", Code::E0403),
    ] {
        let found = shipped("box_test.track", &[wrong]);
        let errors: Vec<Code> = found.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
        assert!(!errors.is_empty() && errors.iter().all(|c| *c == code), "{wrong}\n{}", told(&found));
    }
}

#[test]
fn a_rig_is_a_scene_without_rails() {
    let scene = |overrides: &[&str]| shipped("box_test.track", overrides).scenario.unwrap();
    let scenario = scene(&[]);
    let Some(Loading::Rig(loads)) = &scenario.loading else { panic!("{:?}", scenario.loading) };
    let Force::Cyclic { range, frequency, .. } = loads[0].force else { panic!("{:?}", loads[0].force) };
    // of one rail: half of what acts on the sleeper
    assert_eq!((*range[0], *range[1], *frequency, loads[0].cycles), (2.5e3, 30e3, 20.0, 50));
    let (section, seat) = (&scenario.track.sections[0], &scenario.track.seats[0]);
    assert!(
        section.rail.is_none() && seat.pad.is_none() && seat.support().is_none() && seat.stack.is_some(),
        "{seat:?}"
    );
    let drawn = trackbed::report::drawing_svg(&scenario);
    assert!(drawn.contains("actuator: 2.5 to 30 kN per seat, 20 Hz, 50 times"), "{drawn}");
    assert!(!drawn.contains("class=\"steel\""), "nothing is drawn that is not there");
    // grains alone know the support of a sleeper on layers without a modulus
    let text = std::fs::read_to_string("scenarios/box_test.track").unwrap();
    let grains = "granular stone { grading = gradings.ballast_16_64, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7 }";
    let edited = |line: &str| if line.starts_with("granular stone") { grains } else { line }.to_owned();
    let text = text.lines().map(edited).collect::<Vec<_>>().join("\n");
    let scenario = compile("box.track", &text, &NoModules, &[]).scenario.unwrap();
    let seat = &scenario.track.seats[0];
    assert!(seat.support().is_none() && seat.stack.is_none() && seat.is_ballasted(), "{seat:?}");
    assert!(trackbed::report::drawing_svg(&scenario).contains("actuator"));
}

#[test]
fn layers_are_replaced_by_their_names() {
    let layers = "ballasts.granite_31_63: 350 mm, soils.sandy_gravel { youngs_modulus = 90 MPa }: 2 m";
    let text = scene("", layers, "").replace("sections = [open: 42 m]", "sections = [deeper: 42 m]")
        + "trackform deeper : open { layers.granite_31_63 = 450 mm }\n";
    let scenario = sound(&text, &NoModules);
    let layers = &scenario.track.sections[0].layers;
    assert_eq!((layers[0].thickness.value_at(0.0), layers[1].thickness.value_at(0.0)), (0.45, 2.0));
    assert_eq!(layers[1].soil().unwrap().youngs_modulus.value_at(0.0), 90e6, "a soil extended in place");
}

#[test]
fn a_wedge_varies_along_the_track() {
    let layers = "ballasts.granite_31_63: 300 mm, wedge: ramp(0.1 .. 0.8 m, over = 10 .. 30 m)";
    let before = "soil wedge : soils.cement_treated { youngs_modulus = [0 m: 200, 21 m: 400, 42 m: 400] MPa }";
    let scenario = sound(&scene(before, layers, ""), &NoModules);
    let wedge = &scenario.track.sections[0].layers[1];
    for (x, thickness, modulus) in [(0.3, 0.1, 202.857142e6), (20.0, 0.45, 390.476190e6), (41.0, 0.8, 400e6)] {
        assert!((wedge.thickness.value_at(x) - thickness).abs() < 1e-9, "{x}");
        assert!((wedge.soil().unwrap().youngs_modulus.value_at(x) / modulus - 1.0).abs() < 1e-6, "{x}");
    }
}

#[test]
fn bulk_and_shear_modulus_are_youngs_modulus_and_poissons_ratio() {
    let soil = |fields: &str| {
        let before = format!("soil fill {{ {fields}, density = 2 t/m^3 }}");
        let scenario = sound(&scene(&before, "ballasts.granite_31_63: 350 mm, fill: 2 m", ""), &NoModules);
        let soil = scenario.track.sections[0].layers[1].soil().unwrap().clone();
        (soil.youngs_modulus.value_at(0.0), *soil.poisson_ratio)
    };
    let (young, poisson) = (90e6, 0.3);
    let (bulk, shear) = (young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)));
    let found = soil(&format!("bulk_modulus = {} MPa, shear_modulus = {} MPa", bulk / 1e6, shear / 1e6));
    assert!((found.0 / young - 1.0).abs() < 1e-9 && (found.1 / poisson - 1.0).abs() < 1e-9, "{found:?}");
    assert_eq!(soil("youngs_modulus = 90 MPa, poisson_ratio = 0.3"), (young, poisson));
}

#[test]
fn who_needs_a_support_is_told() {
    let grains = "granular stone { grading = gradings.ballast_31_63, density = 2650 kg/m^3, friction = 0.7, contact_stiffness = 9 MN/m per contact }";
    let without = |before: &str, layers: &str, solve: &str| {
        let text = scene(before, layers, solve).replace("  support = { stiffness = 40 MN/m per seat }\n", "");
        compile("scene.track", &text, &NoModules, &[])
    };
    let known = without("", "ballasts.granite_31_63: 350 mm, soils.sandy_gravel: 2 m", "");
    assert!(known.diagnostics.is_empty() && known.runnable().is_some(), "{}", told(&known));
    let unknown = |solve: &str| without(grains, "stone: 350 mm, soils.sandy_gravel: 2 m", solve);
    let auto = unknown("");
    assert_eq!(codes(&auto), [Code::E0604], "{}", told(&auto));
    let help = auto.diagnostics[0].help.as_ref().unwrap();
    assert!(help.contains("support") && help.contains("youngs_modulus"), "{help}");
    assert!(help.contains("`substructure = zone`"), "{help}");
    let cells = unknown("solve { substructure = cells }");
    assert!(cells.runnable().is_some(), "{}", told(&cells));
    let law = unknown("solve { substructure = law }");
    assert_eq!(codes(&law), [Code::E0419], "{}", told(&law));
}

struct Files(BTreeMap<&'static str, &'static str>);

impl Modules for Files {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative.to_str()?).map(|text| text.as_bytes().to_vec())
    }
}

#[test]
fn sieves_come_from_a_file() {
    let files = Files(BTreeMap::from([
        ("sieves.csv", "size_mm,passing_%\n22.4,0\n31.5,20\n40,60\n63,100\n"),
        ("retained.csv", "sieve_mm,retained_kg\n22.4,0\n63,12\n"),
        ("fallen.csv", "size_mm,passing_%\n22.4,0\n40,60\n50,40\n63,100\n"),
        ("strange.csv", "size_mm,passing_%\n0,0\n40,60\n63,101\n"),
    ]));
    let text = |name: &str| {
        let before =
            format!("granular stone : ballasts.granite_31_63 {{ grading = {{ passing = file(\"{name}\") }} }}");
        scene(&before, "stone: 350 mm, soils.sandy_gravel: 2 m", "")
    };
    let scenario = sound(&text("sieves.csv"), &files);
    let grading = &scenario.track.sections[0].layers[0].granular().unwrap().grading;
    assert_eq!((grading.d(20.0), grading.d(60.0), grading.largest()), (0.0315, 0.04, 0.063));
    for (name, expected) in [
        ("retained.csv", vec![Code::E0509]),
        ("fallen.csv", vec![Code::E0414]),
        ("strange.csv", vec![Code::E0510, Code::E0510]),
    ] {
        let compiled = compile("scene.track", &text(name), &files, &[]);
        assert_eq!(codes(&compiled), expected, "{name}: {}", told(&compiled));
    }
}

#[test]
fn a_grain_may_be_hertzian_glued_and_log_normal() {
    let before = "granular stone : ballasts.granite_31_63 {
  grading = { passing = log_normal(40 mm, spread = 0.25), cut_below = 22 mm, cut_above = 80 mm }
  contact = hertz(50 GPa, 0.2), dashpots = full, wall_friction = 0.4, packing.friction = 0.1
  bond = { stiffness = 26 MN/m per particle, tensile_strength = 2 kN, shear_strength = 3 kN }
}";
    let scenario = sound(&scene(before, "stone: 350 mm, soils.sandy_gravel: 2 m", ""), &NoModules);
    let stone = scenario.track.sections[0].layers[0].granular().unwrap();
    assert!(matches!(stone.contact, Contact::Hertz { youngs_modulus, poisson_ratio }
        if *youngs_modulus == 50e9 && *poisson_ratio == 0.2));
    let bond = stone.bond.unwrap();
    assert_eq!((*bond.stiffness, *bond.tensile_strength, *bond.shear_strength), (13e6, 2e3, 3e3));
    assert!(stone.dashpots_pull && *stone.wall_friction == 0.4 && *stone.friction == 0.7);
    assert_eq!((*stone.packing.friction, *stone.packing.local_damping), (0.1, 0.7));
    assert!(stone.grading.modelled_share() > 0.98 && stone.grading.modelled_share() < 1.0);
}

fn program(arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_trackbed")).args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn what_cannot_run_is_checked_and_planned() {
    let out = tempfile::tempdir().unwrap();
    let out = out.path().join("run");
    let cells = ["--set", "solve.substructure=cells", "--set", "solve.coupling=monolithic"];
    let scene = [&["scenarios/transition_full.track"], &cells[..]].concat();
    let (status, said) = program(&[&["check"], &scene[..]].concat());
    assert!(status == Some(0) && said.contains("warning E0604"), "{scene:?}: {said}");
    // the plan is there to be looked at
    let (status, said) = program(&[&["plan"], &scene[..]].concat());
    assert!(status == Some(0) && said.contains("warning E0604"), "{said}");
    let (status, said) = program(&[&["run"], &scene[..], &["--out", out.to_str().unwrap()]].concat());
    assert!(status == Some(1) && said.contains("error E0604"), "{said}");
    assert!(!out.exists(), "nothing is written for what cannot be run");
    let (status, said) = program(&["plan", "scenarios/transition_full.track", "--set", "solve.substructure=law"]);
    assert!(status == Some(0) && !said.contains("E0604"), "{said}");
}
