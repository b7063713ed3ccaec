//! Trackbed: a language and a solver for railway transition zones.
//!
//! A `.track` file reads like the data sheet of a scene. A program needs [`Scene`] and what it gives: [`Scene::check`] says
//! everything that is wrong, [`Scene::set`] edits a line by its path, [`Scene::run`] gives a [`results::Run`] with its tables.
//!
//! ```
//! let jack = trackbed::Scene::from_text(r#"
//!   trackform seats {
//!     rail = { mass = 60 kg/m, bending_stiffness = 6.4 MN m^2 }
//!     pad = { stiffness = 40 MN/m, damping = 5 kN s/m }
//!     spacing = 0.6 m, support = rigid
//!   }
//!   track bench { sections = [seats: 20 sleepers], rail_ends = free }
//!   load jack { on = rail, at = 10 sleepers, force = 100 kN per rail }
//!   solve { gravity = 0 m/s^2 }
//! "#);
//! let moment = jack.run()?.scalar("max_rail_moment").unwrap();
//! assert!((moment / 17.66e3 - 1.0).abs() < 1e-3);
//! # Ok::<(), trackbed::Stopped>(())
//! ```
//!
//! Inside, [`compile`] checks a text and lowers it into a solver graph, [`graph::execute`] runs the graph block by block,
//! [`results`] keeps what came out and [`report`] shows it. The modules below stand in the order of that flow; each knows only
//! what stands before it.

pub mod diag;
pub mod units;

pub mod linalg;
pub mod solvers;

pub mod store;

pub mod schema;
pub mod syntax;

pub mod check;
pub mod scenario;

pub mod graph;
pub mod lint;
pub mod lower;

pub mod results;

pub mod study;
pub mod trials;

pub mod report;

pub mod cli;

use check::{DataError, Folder, Modules, Override};
use diag::{Code, Diagnostic, Severity, Sources, render};
use graph::Graph;
use results::{Run, RunRecorder};
use scenario::{Scenario, Study};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A scene: the text of its main file, the files beside it, and edits by path.
///
/// ```
/// use trackbed::Scene;
///
/// let scene = Scene::from_text(r#"
///   use std
///   trackform open {
///     rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m
///     support = { stiffness = 40 MN/m per seat }
///   }
///   trackform deck : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
///   track line { sections = [open: 15 m, deck: 12 m] }
///   train ore { vehicles = vehicles.ore_wagon_20t, speed = 80 km/h }
///   traffic { trains = ore, total = 4 axles }
///   solve { elements_per_bay = 1, time_step = 4e-4 s }
/// "#);
/// let mut settled = Vec::new();
/// for stiffness in [20, 60] {
///     let softer = scene.clone().set("open.support.stiffness", format!("{stiffness} MN/m per seat"));
///     let run = softer.run()?;
///     settled.push(run.scalar("max_settlement").unwrap());
///     assert!(run.sleepers.iter().any(|row| row.sleeper == "-3" && row.settlement_m > 0.0));
/// }
/// assert!(settled[0] != settled[1]);
///
/// let wrong = scene.set("open.pad.stiffness", "40 kN").run().unwrap_err();
/// assert!(wrong.to_string().contains("expected a stiffness in `MN/m`, found a force"));
/// # Ok::<(), trackbed::Stopped>(())
/// ```
#[derive(Clone)]
pub struct Scene {
    name: String,
    text: String,
    modules: Rc<dyn Modules>,
    edits: Vec<Override>,
}

impl Scene {
    /// A scene in memory, without files beside it.
    pub fn from_text(text: impl Into<String>) -> Scene {
        let modules = Rc::new(InMemory(BTreeMap::new()));
        Scene { name: "scene.track".into(), text: text.into(), modules, edits: Vec::new() }
    }

    /// A scene in a file; its modules and data lie below the folder of that file.
    pub fn open(path: impl AsRef<Path>) -> Result<Scene, Stopped> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|error| Stopped::NotRead(format!("cannot read `{name}`: {error}")))?;
        let text =
            syntax::decode(&name, &bytes).map_err(|mistake| Stopped::refused(vec![mistake], &Sources::default()))?;
        let folder = Folder(path.parent().unwrap_or(Path::new("")).to_path_buf());
        Ok(Scene { name, text, modules: Rc::new(folder), edits: Vec::new() })
    }

    /// With files beside it that stand in memory, by their paths: `site/gravel.track`, `level.csv`.
    pub fn with_files<P: Into<PathBuf>, B: Into<Vec<u8>>>(self, files: impl IntoIterator<Item = (P, B)>) -> Scene {
        let files = files.into_iter().map(|(path, bytes)| (path.into(), bytes.into())).collect();
        Scene { modules: Rc::new(InMemory(files)), ..self }
    }

    /// With the name by which messages call it.
    pub fn named(self, name: impl Into<String>) -> Scene {
        Scene { name: name.into(), ..self }
    }

    /// As if the line at a path were edited: `open.pad.stiffness` and `60 MN/m`, or the name of a `let`.
    pub fn set(mut self, path: impl Into<String>, value: impl Into<String>) -> Scene {
        self.edits.push(Override { path: path.into(), value: value.into() });
        self
    }

    /// Everything that is to be said of it, and its scenario and solver graph where it has them. Costs milliseconds.
    pub fn check(&self) -> Compiled {
        compile(&self.name, &self.text, &*self.modules, &self.edits)
    }

    /// The scene as one file, with every default and library value and where it comes from; `None` where it has errors.
    pub fn resolve(&self) -> Option<String> {
        check::resolve(&self.name, &self.text, &*self.modules, &self.edits)
    }

    /// Runs it in memory.
    pub fn run(&self) -> Result<Run, Stopped> {
        self.run_with(|_, _| {})
    }

    /// Runs a test rig in memory: its bed is packed, or taken from where beds are kept, and tested, which takes minutes.
    pub fn run_rig(&self, beds: &results::Beds) -> Result<results::RigRun, Stopped> {
        let compiled = self.check().to_run();
        let refused = |diagnostics: Vec<Diagnostic>| Stopped::refused(diagnostics, &compiled.sources);
        if compiled.diagnostics.iter().any(Diagnostic::is_error) {
            return Err(refused(compiled.diagnostics.clone()));
        }
        let Some(scenario) = compiled.scenario.as_ref().filter(|scenario| lower::is_rig(scenario)) else {
            let message = "this scene is no test rig: loads on `sleepers` or a `bed`, layers of grains, no rails";
            return Err(refused(vec![Diagnostic::new(Code::E0611, message).help("from a program: `Scene::run`")]));
        };
        let performed =
            results::perform_rig(scenario, beds, results::Unfinished::default(), &mut ()).map_err(refused)?;
        Ok(results::RigRun::gather(scenario, performed, &compiled.sources, fingerprint(&compiled.sources)).0)
    }

    /// Runs it and tells from time to time how many axles of how many have passed.
    pub fn run_with(&self, progress: impl FnMut(u64, u64) + Send) -> Result<Run, Stopped> {
        let compiled = self.check().to_run();
        let refused = || Stopped::refused(compiled.diagnostics.clone(), &compiled.sources);
        if compiled.diagnostics.iter().any(Diagnostic::is_error) {
            return Err(refused());
        }
        if compiled.scenario.as_ref().is_some_and(lower::is_rig) {
            let message = "a test rig has cycles in the place of passages";
            let help = "from a program: `Scene::run_rig`";
            let mistake = Diagnostic::new(Code::E0611, message).help(help);
            return Err(Stopped::refused(vec![mistake], &compiled.sources));
        }
        let (Some(scenario), Some(graph)) = (&compiled.scenario, &compiled.graph) else { return Err(refused()) };
        let mut recorder = RunRecorder::new(scenario, None, progress);
        graph::execute(graph, &mut recorder, None)
            .map_err(|error| Stopped::refused(vec![results::diagnose(&error, scenario, graph)], &compiled.sources))?;
        Ok(Run::gather(&recorder, scenario, graph, &compiled.sources, fingerprint(&compiled.sources)))
    }
}

/// Why there is no run. It shows itself as the command line would.
#[derive(Debug, Clone, PartialEq)]
pub enum Stopped {
    /// The file cannot be read.
    NotRead(String),
    /// The scene has mistakes, cannot be run yet, or its run failed.
    Refused {
        diagnostics: Vec<Diagnostic>,
        /// The same, drawn over the text.
        shown: String,
    },
}

/// Columns of what an error shows.
const WIDTH: usize = 110;

impl Stopped {
    fn refused(diagnostics: Vec<Diagnostic>, sources: &Sources) -> Stopped {
        let shown = match diagnostics.is_empty() {
            true => "nothing to run: a file without a `track` is a library".into(),
            false => render::human(&diagnostics, sources, false, WIDTH),
        };
        Stopped::Refused { diagnostics, shown }
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stopped::NotRead(message) => f.write_str(message),
            Stopped::Refused { shown, .. } => f.write_str(shown),
        }
    }
}

impl std::error::Error for Stopped {}

/// Files by their paths.
struct InMemory(BTreeMap<PathBuf, Vec<u8>>);

impl Modules for InMemory {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative).cloned()
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        self.read(relative).ok_or(DataError::Missing)
    }
}

/// What became of a text: every diagnostic, and the scene and its graph where they could be made.
#[derive(Debug)]
pub struct Compiled {
    pub sources: Sources,
    /// Down the file; errors among them stop a run.
    pub diagnostics: Vec<Diagnostic>,
    pub scenario: Option<Scenario>,
    /// `None` where nothing acts on the track, too, and where only grains could answer.
    pub graph: Option<Graph>,
    /// The studies of the file that have no mistake of their own.
    pub studies: Vec<Study>,
}

impl Compiled {
    /// The same for a run: what a scene needs and this version cannot do is an error there, and a warning to a check.
    pub fn to_run(mut self) -> Compiled {
        for diagnostic in self.diagnostics.iter_mut().filter(|d| d.code == Code::E0604) {
            diagnostic.severity = Severity::Error;
        }
        diag::sort(&mut self.diagnostics);
        self
    }
}

/// Checks a text that a person calls `name`, lowers it and applies the physics rules. Costs milliseconds.
pub fn compile(name: &str, text: &str, modules: &dyn Modules, overrides: &[Override]) -> Compiled {
    let checked = check::check(name, text, modules, overrides);
    let mut diagnostics = checked.diagnostics;
    let mut graph = None;
    if let Some(scenario) = &checked.scenario {
        let (lowered, found) = lower::lower(scenario);
        // beside errors of the text, only further errors are worth a word
        diagnostics.extend(found.into_iter().filter(|d| checked.sound || d.is_error()));
        if checked.sound && lowered.is_none() && lower::is_rig(scenario) {
            diagnostics.extend(lint::lint_rig(scenario));
        }
        if let Some(lowered) = lowered.filter(|_| checked.sound) {
            diagnostics.extend(lint::lint(scenario, &lowered));
            // track and trains of a scene with grains are planned and looked at; its substructure cannot be run
            graph = Some(lowered).filter(|_| !scenario.solve.grains.tier.has_grains());
        }
    }
    diag::sort(&mut diagnostics);
    Compiled {
        sources: checked.sources,
        diagnostics,
        scenario: checked.scenario.filter(|_| checked.sound),
        graph,
        studies: checked.studies,
    }
}

/// SHA-256 over every text that a scene is made of, overrides included, in hexadecimal.
pub fn fingerprint(sources: &Sources) -> String {
    let mut hash = Sha256::new();
    for (_, source) in sources.iter() {
        hash.update((source.text.len() as u64).to_le_bytes());
        hash.update(source.text.as_bytes());
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
