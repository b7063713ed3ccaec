//! What becomes of a scene: checked, or checked and run.

use super::draw::Aim;
use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use trackbed::check::{Modules, Remembered};
use trackbed::results::Run;
use trackbed::{Compiled, Scene, Stopped, compile};

/// How a scene ended.
pub enum Outcome {
    /// Nothing stands against it.
    Accepted { warnings: BTreeSet<&'static str> },
    /// It has errors, of these codes.
    Refused { errors: BTreeSet<&'static str> },
    /// Its plan takes longer than it may.
    TooLong,
    /// It has nothing to run, or this version does not run it.
    Idle,
    /// It ran to its end.
    Finished,
    /// Its run ended with these codes.
    Stopped { errors: BTreeSet<&'static str> },
    /// What must never happen.
    Failed(String),
}

impl Outcome {
    /// Whether a run has begun.
    pub fn has_begun(&self) -> bool {
        matches!(self, Outcome::Finished | Outcome::Stopped { .. } | Outcome::Failed(_))
    }

    pub fn failure(&self) -> Option<&str> {
        if let Outcome::Failed(why) = self { Some(why) } else { None }
    }
}

/// The aims of scenes that are checked: mostly trains over a law.
pub fn aim(number: u64) -> Aim {
    match number % 20 {
        0..=2 => Aim::Rig,
        3 => Aim::Plate,
        4 | 5 => Aim::Rail,
        6 => Aim::Grains,
        _ => Aim::Law,
    }
}

/// The aims of scenes with grains that are run: mostly boxes under a plate, which are small.
pub fn grains(number: u64) -> Aim {
    if number.is_multiple_of(4) { Aim::Rig } else { Aim::Plate }
}

/// The texts of the library and of the shipped scenes.
pub fn shipped(root: &Path) -> Vec<String> {
    let mut texts = Vec::new();
    for folder in ["stdlib", "scenarios"] {
        let entries = std::fs::read_dir(root.join(folder)).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        texts.extend(paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()));
    }
    texts
}

/// The files that the vocabulary names, beside every scene.
#[derive(Clone)]
pub struct Beside(BTreeMap<PathBuf, Vec<u8>>);

impl Beside {
    pub fn new(root: &Path) -> Beside {
        let stone = std::fs::read(root.join("stdlib/shapes/blocky.stl")).unwrap_or_default();
        let files: [(&str, Vec<u8>); 3] = [
            ("force.csv", b"time_s,force_kN\n0,5\n0.02,40\n0.04,5\n".to_vec()),
            ("sieves.csv", b"size_mm,passing_%\n50,0\n57,60\n65,100\n".to_vec()),
            ("stone.stl", stone),
        ];
        Beside(files.into_iter().map(|(name, bytes)| (name.into(), bytes)).collect())
    }
}

impl Modules for Beside {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative).cloned()
    }
}

/// Scenes between which the parsed library is forgotten.
const MEMORY: u64 = 1000;

/// Checks and plans scenes.
pub fn checked(root: &Path) -> impl FnMut(u64, &str) -> Outcome + use<> {
    let files = Beside::new(root);
    let mut known = Remembered::new(files.clone());
    let mut scenes = 0;
    move |_, text| {
        scenes += 1;
        if scenes % MEMORY == 0 {
            known = Remembered::new(files.clone());
        }
        let found = catch_unwind(AssertUnwindSafe(|| judged(&compile("drawn.track", text, &known, &[]))));
        found.unwrap_or_else(|panic| Outcome::Failed(format!("panic: {}", said(&*panic))))
    }
}

/// What the check says of a scene.
pub fn told(root: &Path, text: &str) -> Vec<String> {
    let compiled = compile("drawn.track", text, &Beside::new(root), &[]);
    compiled.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect()
}

/// Checks scenes and runs those whose plan takes less than `most` seconds.
pub fn run(root: &Path, most: f64) -> impl FnMut(u64, &str) -> Outcome + use<> {
    let files = Beside::new(root);
    move |_, text| {
        let tried = catch_unwind(AssertUnwindSafe(|| run_once(text, &files, most)));
        tried.unwrap_or_else(|panic| Outcome::Failed(format!("panic: {}", said(&*panic))))
    }
}

fn run_once(text: &str, files: &Beside, most: f64) -> Outcome {
    let scene = Scene::from_text(text).with_files(files.0.clone());
    let compiled = scene.check();
    match judged(&compiled) {
        Outcome::Accepted { .. } => {}
        other => return other,
    }
    let Some(graph) = compiled.to_run().graph.filter(|graph| graph.runs) else { return Outcome::Idle };
    if graph.cost.seconds > most {
        return Outcome::TooLong;
    }
    match scene.run() {
        Ok(run) => match not_finite(&run) {
            Some(table) => Outcome::Failed(format!("{table} is not finite")),
            None => Outcome::Finished,
        },
        Err(Stopped::Refused { diagnostics, shown }) => match holds_nan(&shown) {
            true => Outcome::Failed(format!("a message holds a number that is none: {shown}")),
            false => {
                let errors = diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code.as_str()).collect();
                Outcome::Stopped { errors }
            }
        },
        Err(Stopped::NotRead(why)) => Outcome::Failed(why),
    }
}

/// What a check says, and whether what it says can be.
fn judged(compiled: &Compiled) -> Outcome {
    for diagnostic in &compiled.diagnostics {
        let told = [Some(&diagnostic.message), diagnostic.help.as_ref()];
        if told.into_iter().flatten().any(|text| holds_nan(text)) {
            return Outcome::Failed(format!("{}: {}", diagnostic.code, diagnostic.message));
        }
        let misplaced = |label: &trackbed::diag::Label| {
            let text = &compiled.sources.get(label.span.file).text;
            label.span.start > label.span.end || text.get(label.span.start as usize..label.span.end as usize).is_none()
        };
        if diagnostic.labels.iter().any(misplaced) {
            return Outcome::Failed(format!("{}: a label stands outside its file", diagnostic.code));
        }
    }
    let errors: BTreeSet<&str> =
        compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code.as_str()).collect();
    if !errors.is_empty() {
        return Outcome::Refused { errors };
    }
    match &compiled.graph {
        Some(graph) if holds_nan(&format!("{:?}", graph.cost)) => Outcome::Failed(format!("cost {:?}", graph.cost)),
        _ => Outcome::Accepted { warnings: compiled.diagnostics.iter().map(|d| d.code.as_str()).collect() },
    }
}

/// The first table of a run that holds a number which is none.
fn not_finite(run: &Run) -> Option<&'static str> {
    let tables = [
        ("summary", format!("{:?}", run.summary)),
        ("sleepers", format!("{:?}", run.sleepers)),
        ("blocks", format!("{:?}", run.blocks)),
        ("laws", format!("{:?}", run.laws)),
        ("rail", format!("{:?}", run.rail)),
        ("trains", format!("{:?}", run.trains)),
        ("tampings", format!("{:?}", run.tampings)),
        ("histories", format!("{:?}", run.histories)),
        ("tests", format!("{:?}", run.tests)),
    ];
    tables.iter().find(|(_, text)| holds_nan(text)).map(|(name, _)| *name)
}

/// Whether a text says `NaN` or `inf`.
fn holds_nan(text: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric()).any(|word| word == "NaN" || word == "inf")
}

/// What a panic said.
fn said(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_string())).unwrap_or_default()
}
