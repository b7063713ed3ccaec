//! The results of a run, from its recorder.

use super::{
    Provenance, Reliance, Run, RunRecorder, Summary, TestTables, law_rows, summarise_check, summarise_compared,
    summarise_laws, verdicts,
};
use crate::diag::{Diagnostic, Sources};
use crate::graph::Graph;
use crate::scenario::Scenario;

/// The source texts of a run, and their diagnostics.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The main file first.
    pub sources: &'a Sources,
    /// Their hash.
    pub sha256: &'a str,
    pub diagnostics: &'a [Diagnostic],
}

impl Run {
    /// Collects the results of a run from its recorder.
    pub fn gather(recorder: &RunRecorder<'_>, scenario: &Scenario, graph: &Graph, source: Source<'_>) -> Run {
        let Source { sources, sha256, diagnostics } = source;
        let provenance = Provenance::new(sources, sha256.to_owned(), scenario.solve.seed, graph.listing().text());
        let tables = &recorder.tables;
        if let Some(tests) = &tables.tests {
            let means = TestTables::new(tests);
            let expectations = verdicts(scenario, means.view(&scenario.track));
            let told = (diagnostics, sources);
            let reliance = Reliance::new(scenario, graph, told, tables, &means.scalars);
            let summary = Summary { scalars: means.scalars, expectations, reliance, provenance };
            return Run { tests: Some(tests.clone()), ..Run::empty(scenario, summary) };
        }
        let histories = recorder.all_histories();
        let laws = law_rows(scenario, &tables.laws);
        let mut scalars = recorder.scalars();
        scalars.extend(summarise_laws(scenario, &laws));
        scalars.extend(summarise_check(scenario, &tables.check));
        scalars.extend(summarise_compared(tables.compared.as_ref()));
        let view = tables.view(&histories, &scalars, &scenario.track, &graph.supports);
        let expectations = verdicts(scenario, view);
        let reliance = Reliance::new(scenario, graph, (diagnostics, sources), tables, &scalars);
        Run {
            sleepers: tables.sleepers.clone(),
            blocks: tables.blocks.clone(),
            laws,
            check: tables.check.clone(),
            rail: tables.rail.clone(),
            trains: tables.trains.clone(),
            tampings: tables.tampings.clone(),
            histories,
            beds: recorder.beds.told.clone(),
            ..Run::empty(scenario, Summary { scalars, expectations, reliance, provenance })
        }
    }

    /// A run without a row.
    fn empty(scenario: &Scenario, summary: Summary) -> Run {
        Run {
            scenario: scenario.clone(),
            summary,
            sleepers: Vec::new(),
            blocks: Vec::new(),
            laws: Vec::new(),
            check: Vec::new(),
            rail: Vec::new(),
            trains: Vec::new(),
            tampings: Vec::new(),
            histories: Vec::new(),
            beds: Vec::new(),
            tests: None,
            packings: Vec::new(),
        }
    }

    /// A scalar of `summary.json` by its name, such as `max_settlement`, in SI.
    pub fn scalar(&self, name: &str) -> Option<f64> {
        self.summary.scalars.get(name).map(|scalar| scalar.value)
    }
}
