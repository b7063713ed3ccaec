//! Trackbed: a language and a solver for railway transition zones.
//!
//! A `.track` file reads like the data sheet of a scene. [`compile`] checks it and lowers it into a solver graph,
//! [`graph::execute`] runs the graph block by block, [`results`] keeps what came out and [`report`] shows it. The
//! modules below stand in the order of that flow; each knows only what stands before it.
//!
//! ```
//! let text = r#"
//! use std
//! trackform seats {
//!   rail = { mass = 60 kg/m, bending_stiffness = 6.4 MN m^2 }
//!   pad = { stiffness = 40 MN/m, damping = 5 kN s/m }
//!   spacing = 0.6 m
//!   support = rigid
//! }
//! track bench { sections = [seats: 20 sleepers], rail_ends = free }
//! load jack { on = rail, at = 10 sleepers, force = 100 kN per rail }
//! solve { gravity = 0 m/s^2 }
//! "#;
//! let compiled = trackbed::compile("bench.track", text, &trackbed::check::NoModules, &[]);
//! let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
//! let mut recorder = trackbed::results::RunRecorder::new(&scenario, None, |_, _| {});
//! trackbed::graph::execute(&graph, &mut recorder, None).unwrap();
//! assert!((recorder.tables.max_rail_moment.unwrap() / 17.66e3 - 1.0).abs() < 1e-3);
//! ```

pub mod diag;
pub mod units;

pub mod linalg;
pub mod solvers;

pub mod schema;
pub mod syntax;

pub mod check;
pub mod scenario;

pub mod graph;
pub mod lint;
pub mod lower;

pub mod results;

pub mod study;

pub mod report;

pub mod cli;

use check::{Modules, Override};
use diag::{Code, Diagnostic, Severity, Sources};
use graph::Graph;
use scenario::{Scenario, Study};
use sha2::{Digest, Sha256};

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
