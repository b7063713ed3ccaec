//! A resolved scene is a file like any other, makes the same run to the last bit, and resolves to itself.

use std::path::{Path, PathBuf};
use trackbed::check::{DataError, Folder, Modules, Override, resolve};
use trackbed::results::RunRecorder;
use trackbed::{Compiled, compile, execute};

fn sets(texts: &[&str]) -> Vec<Override> {
    texts.iter().map(|text| Override::parse(text).unwrap()).collect()
}

fn errors(compiled: &Compiled) -> Vec<String> {
    compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| format!("{} {}", d.code, d.message)).collect()
}

/// Without the comments at the ends of lines and the lines that are comments.
fn bare(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.trim_start().starts_with("// "));
    let kept: Vec<&str> = lines.map(|line| line.split("  // ").next().unwrap_or_default().trim_end()).collect();
    // how far comments stand out moves no value
    kept.iter().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect::<Vec<_>>().join("\n")
}

/// Resolves a text, and checks what holds of every resolved one.
fn resolved(name: &str, text: &str, modules: &dyn Modules, set: &[Override]) -> String {
    let once = resolve(name, text, modules, set).unwrap_or_else(|| panic!("{name} is a scene"));
    let compiled = compile(name, &once, modules, &[]);
    assert_eq!(errors(&compiled), Vec::<String>::new(), "{name}:\n{once}");
    assert_eq!(trackbed::syntax::format(&once).as_deref(), Ok(once.as_str()), "{name} is laid out");
    let twice = resolve(name, &once, modules, &[]).unwrap();
    assert_eq!(bare(&twice), bare(&once), "{name}");
    assert!(!once.contains("\nuse ") && !once.contains("\nlet "), "{name} stands alone:\n{once}");
    once
}

fn tables(compiled: Compiled) -> (trackbed::results::RunTables, Vec<trackbed::results::HistoryRow>) {
    assert_eq!(errors(&compiled), Vec::<String>::new());
    let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    (recorder.tables.clone(), recorder.all_histories())
}

/// Runs a text and what it resolves to.
fn runs_the_same(name: &str, text: &str, modules: &dyn Modules, set: &[Override]) {
    let once = resolved(name, text, modules, set);
    let (a, b) = (tables(compile(name, text, modules, set)), tables(compile(name, &once, modules, &[])));
    assert!(!a.0.sleepers.is_empty());
    assert!(a == b, "{name} runs as\n{once}");
}

#[test]
fn every_shipped_scene_that_runs_runs_the_same() {
    let short = ["traffic.total=4 axles", "solve.elements_per_bay=1", "solve.time_step=4e-4 s"];
    let mut ran = 0;
    for entry in std::fs::read_dir("scenarios").unwrap() {
        let path: PathBuf = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "track") {
            continue;
        }
        let name = path.display().to_string();
        let text = std::fs::read_to_string(&path).unwrap();
        let folder = Folder("scenarios".into());
        resolved(&name, &text, &folder, &[]);
        let law = sets(&["solve.substructure=law"]);
        let set = match (is_on_grains(&text), text.contains("traffic")) {
            (true, _) => [law, sets(&short)].concat(),
            (_, true) => sets(&short),
            _ => Vec::new(),
        };
        let set: Vec<Override> = set.into_iter().filter(|s| !text.contains(&format!("// fixed {}", s.path))).collect();
        let again = without_counts(&text);
        if compile(&name, &again, &folder, &set).to_run().runnable().is_some_and(|graph| graph.track().is_some()) {
            runs_the_same(&name, &again, &folder, &set);
            ran += 1;
        }
    }
    assert!(ran >= 8, "{ran} scenes ran");
}

/// Whether a scene asks for grains under its track.
fn is_on_grains(text: &str) -> bool {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//") && line.contains("substructure"));
    code.into_iter().any(|line| ["full", "zone", "cells"].iter().any(|tier| line.contains(tier)))
}

/// A record after more axles than a short run has says nothing of it.
fn without_counts(text: &str) -> String {
    text.lines().filter(|line| !line.trim_start().starts_with("after ")).map(|line| format!("{line}\n")).collect()
}

/// A module and two surveys.
struct Site;

impl Modules for Site {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        let text = match relative.to_str()? {
            "yard.track" => {
                "use std
let ground = 30 MN/m per seat
pad medium { stiffness = 65 MN/m, damping = 8 kN s/m }
/// What lies there.
trackform old {
  rail    = rails.UIC60 { bending_stiffness = 6.2 MN m^2 }
  pad     = medium
  sleeper = sleepers.B70
  spacing = 0.6 m
  layers  = [ballasts.granite_31_63: 350 mm, soils.sandy_gravel: 2 m]
  support = { stiffness = random(ground, cov = 20 %, seed = 7), damping_time = 0.8 ms }
}
solve { update_every = 8 axles, elements_per_bay = 2, time_step = 2e-4 s }
train slow { vehicles = [vehicles.ore_wagon_20t { axle_load = 17.3 t }: 1], speed = 80 km/h }
traffic { trains = slow, total = 8 axles }
stretch soft { over = -12 .. -1 sleepers, sleeper.mass = 180 kg per seat, usp = usps.soft }
"
            }
            "level.csv" => "x_m,level_mm\n-31,0\n-20,0.4\n-6,1.1\n0,0.3\n9,0\n",
            "speed.csv" => "x_m,speed_km/h\n-31,80\n0,75\n9,70\n",
            _ => return None,
        };
        Some(text.as_bytes().to_vec())
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        self.read(relative).ok_or(DataError::Missing)
    }
}

const SCENE: &str = r#"use std
use yard
let bumps = random(0.2 mm, sd = 0.1 mm, correlation = 1.5 m, distribution = log_normal)
let longest = -1 - 19
granular medium : ballasts.basalt_31_63 { friction = 0.65 }
trackform open : yard.old { pad.stiffness = 0.1 kN/um + 7 MN/m, settlement = bumps, layers.granite_31_63 = 300 mm }
trackform deck : open { sleeper = none, settlement = 0 mm, slab = slabs.half_width_1600 }
stretch behind { over = longest * 0.3 m .. -1 m, layers = [ballasts.granite_31_63: ramp(300 .. 500 mm), soils.sandy_gravel: rest], support.damping_time = 0.5 ms }
stretch before : yard.soft { usp.bedding_modulus = ramp(0.1 .. 0.3 N/mm^3) }
stretch beside { over = 1 .. 8 sleepers, pad = pads.medium { stiffness = smooth(20 .. 40 MN/m) } }
track line {
  sections = [open: 50 sleepers, deck: 9 m], stretches = [before, beside, behind]
  irregularity = file("level.csv")
}
train slow : yard.slow { speed = file("speed.csv"), direction = both }
traffic : yard.traffic { trains = slow, total = 16 axles }
law mild : laws.varandas_2014 { form.gamma = 8 mm }
solve : yard.solve { law = [mild, laws.hettler_1984], integrator = hht(0.05), seed = 5 }
record near { at = [-5, -1, +1] sleepers, after = [0, 8, 16] axles, quantities = [contact_force, rail_seat_load] }
let deepest = max(settlement) - mean(settlement, over = -40 .. -30 sleepers)
expect { that = [deepest < 3 * open.rail.height, 0 mm < max(settlement, after = 16 axles) < 2 mm + 1 cm], source = "a \"guess\"" }
"#;

#[test]
fn modules_profiles_stretches_and_random_fields_survive() {
    let set = sets(&["train.x=1"]);
    assert!(resolve("scene.track", SCENE, &Site, &set).is_none(), "a text with errors is not resolved");
    runs_the_same("scene.track", SCENE, &Site, &[]);
    runs_the_same(
        "scene.track",
        SCENE,
        &Site,
        &sets(&["slow.direction=backward", "mild.form.gamma=20 mm", "bumps=0.3 mm"]),
    );
}

#[test]
fn every_value_says_where_it_comes_from() {
    let text = resolved("scene.track", SCENE, &Site, &sets(&["solve.integrator=newmark"]));
    let line = |start: &str| {
        let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
        lines.into_iter().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("no `{start}` in\n{text}"))
    };
    assert_eq!(line("integrator"), "integrator = newmark // --set");
    assert_eq!(line("seed "), "seed = 5 // line 18");
    assert_eq!(line("beam"), "beam = euler // default");
    assert!(line("height = 172").contains("// std/rails.track:"), "{}", line("height = 172"));
    assert!(line("update_every").ends_with("= 8 axles // yard.track:13"), "{}", line("update_every"));
    assert!(line("trackform open").ends_with("{ // extends yard.old"));
    // a name that two objects have, and one that the file gives to something else
    assert!(text.contains("\npad pad_medium {") && text.contains("\npad pad_medium_2 {"), "{text}");
    assert!(text.contains("\n/// A soft pad"), "{text}");
}

#[test]
fn a_study_stays_where_its_lines_are() {
    let text = std::fs::read_to_string("scenarios/study_usp.track").unwrap();
    let once = resolved("scenarios/study_usp.track", &text, &Folder("scenarios".into()), &[]);
    assert!(once.contains("// its studies stay there") && !once.contains("\nstudy "));
}

#[test]
fn a_library_is_no_scene() {
    assert_eq!(resolve("stone.track", "use std\npad soft : pads.medium { stiffness = 30 MN/m }\n", &Site, &[]), None);
}
