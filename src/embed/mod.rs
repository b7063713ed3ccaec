//! A scene for use in programs: a text, edits by path, and a run in memory.

use crate::check::{self, Folder, Modules, Override};
use crate::compile::{Compiled, compile, fingerprint};
use crate::diag::{Diagnostic, Sources, render};
use crate::execute::{self, Both, Executor, Listener};
use crate::results::{Run, RunRecorder, Source};
use crate::syntax;
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

    /// A scene in a file; its modules and data lie in the folder of the file or below it.
    pub fn open(path: impl AsRef<Path>) -> Result<Scene, Stopped> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes =
            check::read_bounded(path).map_err(|error| Stopped::NotRead(format!("cannot read `{name}`: {error}")))?;
        let text =
            syntax::decode(&name, &bytes).map_err(|mistake| Stopped::refused(vec![mistake], &Sources::default()))?;
        let folder = Folder(path.parent().unwrap_or(Path::new("")).to_path_buf());
        Ok(Scene { name, text, modules: Rc::new(folder), edits: Vec::new() })
    }

    /// Adds files in memory beside the main file, by their paths: `site/gravel.track`, `level.csv`.
    pub fn with_files<P: Into<PathBuf>, B: Into<Vec<u8>>>(self, files: impl IntoIterator<Item = (P, B)>) -> Scene {
        let files = files.into_iter().map(|(path, bytes)| (path.into(), bytes.into())).collect();
        Scene { modules: Rc::new(InMemory(files)), ..self }
    }

    /// Sets the name of the scene in messages.
    pub fn named(self, name: impl Into<String>) -> Scene {
        Scene { name: name.into(), ..self }
    }

    /// Replaces the value at a path for this scene; the file stays as it is. Example: `open.pad.stiffness` and
    /// `60 MN/m`. A path may also be the name of a `let`.
    pub fn set(mut self, path: impl Into<String>, value: impl Into<String>) -> Scene {
        self.edits.push(Override { path: path.into(), value: value.into() });
        self
    }

    /// Checks the scene: its diagnostics, and its scenario and solver graph if there are no errors. Takes milliseconds.
    pub fn check(&self) -> Compiled {
        compile(&self.name, &self.text, &*self.modules, &self.edits)
    }

    /// The scene as one file, with every default and library value and its source; `None` if it has errors.
    pub fn resolve(&self) -> Option<String> {
        check::resolve(&self.name, &self.text, &*self.modules, &self.edits)
    }

    /// Runs the scene in memory; beds of grains are packed again.
    pub fn run(&self) -> Result<Run, Stopped> {
        self.run_with(&Executor::default(), &mut ())
    }

    /// Runs the scene with stored beds or user-defined nodes, and reports to a listener. If the listener ends the run,
    /// the results so far remain.
    pub fn run_with(&self, executor: &Executor, listener: &mut dyn Listener) -> Result<Run, Stopped> {
        let compiled = self.check().to_run();
        let refused = || Stopped::refused(compiled.diagnostics.clone(), &compiled.sources);
        if compiled.diagnostics.iter().any(Diagnostic::is_error) {
            return Err(refused());
        }
        let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else { return Err(refused()) };
        let mut recorder = RunRecorder::new(scenario, graph);
        executor.run(graph, &mut Both(&mut recorder, listener), None).map_err(|error| {
            let mistake = execute::diagnose(&error, graph, &compiled.origins);
            Stopped::refused(vec![mistake], &compiled.sources)
        })?;
        let sha256 = fingerprint(&compiled.sources);
        let source = Source { sources: &compiled.sources, sha256: &sha256, diagnostics: &compiled.diagnostics };
        Ok(Run::gather(&recorder, scenario, graph, source))
    }
}

/// The reason why there is no run. It displays like the command line.
#[derive(Debug, Clone, PartialEq)]
pub enum Stopped {
    /// The file cannot be read.
    NotRead(String),
    /// The scene has errors, this version cannot run it, or its run failed.
    Refused {
        diagnostics: Vec<Diagnostic>,
        /// The diagnostics as text, with excerpts of the scene.
        shown: String,
    },
}

/// Width of a displayed error, columns.
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
}
