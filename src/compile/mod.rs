//! From a text to a compiled scene, in memory: check, lower, lint.

mod budget;
mod by_law;
mod unused;

pub use budget::NextTier;

use crate::check::{self, Modules, Override};
use crate::diag::{self, Code, Diagnostic, Severity, Sources};
use crate::execute::{at_rest, diagnose};
use crate::graph::Graph;
use crate::lint::{self, lint, lint_studies};
use crate::lower::{Lowered, Origins, Planner};
use crate::scenario::{Scenario, Study};
use sha2::{Digest, Sha256};

/// The result of compiling a text: every diagnostic, and the scene and its plan if they could be made.
#[derive(Debug)]
pub struct Compiled {
    pub sources: Sources,
    /// In the order of the file; an error stops a run.
    pub diagnostics: Vec<Diagnostic>,
    pub scenario: Option<Scenario>,
    /// `None` if nothing acts on the track. A plan that this version cannot run is given for inspection, see
    /// [`Graph::runs`].
    pub graph: Option<Graph>,
    /// Places in the scene of the parameters of the graph.
    pub origins: Origins,
    /// What follows if the cells that check a law part from it: `substructure = auto` with a `budget`.
    pub next_tier: Option<NextTier>,
    /// The studies of the file that have no mistake of their own.
    pub studies: Vec<Study>,
}

impl Compiled {
    /// A text that could not be compiled.
    pub fn unread(mistake: Diagnostic) -> Compiled {
        Compiled {
            sources: Sources::default(),
            diagnostics: vec![mistake],
            scenario: None,
            graph: None,
            origins: Origins::default(),
            next_tier: None,
            studies: Vec::new(),
        }
    }

    /// The same for a run: a part that this version cannot do is an error for a run, and a warning for a check.
    pub fn to_run(mut self) -> Compiled {
        for diagnostic in self.diagnostics.iter_mut().filter(|d| d.code == Code::E0604) {
            diagnostic.severity = Severity::Error;
        }
        diag::sort(&mut self.diagnostics);
        self
    }

    /// The plan, if this version can run it.
    pub fn runnable(&self) -> Option<&Graph> {
        self.graph.as_ref().filter(|graph| graph.runs)
    }
}

/// Checks a text, lowers it and applies the physics rules; `name` is the name that messages show. It also computes the
/// state of rest at the start of a run, so that a track without support is reported here. A check takes some
/// milliseconds. A check of adaptive blocks or of clumps takes some tenths of a second; a check of
/// `substructure = zone` takes as long as six passages of a train, and at most some twenty.
pub fn compile(name: &str, text: &str, modules: &dyn Modules, overrides: &[Override]) -> Compiled {
    compile_with(&Planner::default(), name, text, modules, overrides)
}

/// The same with another planner.
pub fn compile_with(
    planner: &Planner,
    name: &str,
    text: &str,
    modules: &dyn Modules,
    overrides: &[Override],
) -> Compiled {
    let mut checked = check::check(name, text, modules, overrides);
    let mut diagnostics = std::mem::take(&mut checked.diagnostics);
    let (mut graph, mut origins) = (None, Origins::default());
    // a scene with a mistake has no plan, and a choice takes as long as several plans
    let taken =
        checked.scenario.as_ref().filter(|_| checked.sound).and_then(|scenario| budget::tier(planner, scenario));
    let next_tier = taken.as_ref().and_then(|taken| taken.next);
    let (within, chosen) = taken.map(|taken| (taken.scenario, taken.decision)).unzip();
    checked.scenario = within.or(checked.scenario);
    if let Some(scenario) = &checked.scenario {
        // the run of the law is the longest part of a check, and a scene with a mistake has no plan
        let by_law = if checked.sound { by_law::settlement(planner, scenario) } else { None };
        let lowered: Lowered = planner.lower_with(scenario, by_law.as_deref());
        // beside errors of the text, only further errors are reported
        diagnostics.extend(lowered.diagnostics.into_iter().filter(|d| checked.sound || d.is_error()));
        graph = lowered.graph.filter(|_| checked.sound);
        let was_chosen = chosen.is_some();
        if let (Some(graph), Some(chosen)) = (&mut graph, chosen) {
            graph.decisions.insert(0, chosen);
        }
        origins = lowered.origins;
        diagnostics.extend(graph.iter().flat_map(|graph| lint(scenario, graph)));
        diagnostics.extend(graph.iter().flat_map(|graph| lint_studies(scenario, graph, &checked.studies)));
        // mistakes that would stop the run before the first axle
        let runs = graph.iter().filter(|graph| graph.runs && !diag::has_errors(&diagnostics));
        let failure = runs.filter_map(|graph| Some(diagnose(&at_rest(graph).err()?, graph, &origins))).next();
        diagnostics.extend(failure);
        if checked.sound {
            let of_plan =
                |graph| [check::readers(scenario, &checked.studies), lowered.readers, lint::readers(graph)].concat();
            // a plan that this version cannot run does not show the effect of a line
            let runs = graph.as_ref().filter(|graph| graph.runs);
            let mut readers = runs.map(of_plan).unwrap_or_default();
            // what the tiers that were not taken read is there for another budget
            readers.iter_mut().for_each(|reader| reader.acted |= was_chosen);
            diagnostics.extend(unused::told(&checked.stated, &readers, &checked.sources));
        }
    }
    diag::sort(&mut diagnostics);
    Compiled {
        sources: checked.sources,
        diagnostics,
        scenario: checked.scenario.filter(|_| checked.sound),
        graph,
        origins,
        next_tier,
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
