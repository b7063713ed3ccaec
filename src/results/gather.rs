//! Everything that a finished run says, from its recorder.

use super::{Provenance, Reliance, Run, RunRecorder, Summary, TestTables, law_rows, summarise_laws, verdicts};
use crate::diag::{Diagnostic, Sources};
use crate::graph::Graph;
use crate::scenario::Scenario;

impl Run {
    /// Takes together what a recorder has of a finished run. `sources` are the texts that made it, the main file first, `sha256` is
    /// their hash, and `diagnostics` are what the check said of them.
    pub fn gather(
        recorder: &RunRecorder<'_>,
        scenario: &Scenario,
        graph: &Graph,
        (sources, sha256): (&Sources, String),
        diagnostics: &[Diagnostic],
    ) -> Run {
        let provenance = Provenance::new(sources, sha256, scenario.solve.seed, graph.listing().text());
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
        let view = tables.view(&histories, &scalars, &scenario.track, &graph.supports);
        let expectations = verdicts(scenario, view);
        let reliance = Reliance::new(scenario, graph, (diagnostics, sources), tables, &scalars);
        Run {
            sleepers: tables.sleepers.clone(),
            blocks: tables.blocks.clone(),
            laws,
            rail: tables.rail.clone(),
            trains: tables.trains.clone(),
            tampings: tables.tampings.clone(),
            histories,
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
            rail: Vec::new(),
            trains: Vec::new(),
            tampings: Vec::new(),
            histories: Vec::new(),
            tests: None,
        }
    }

    /// A scalar of `summary.json` by its name, such as `max_settlement`, in SI.
    pub fn scalar(&self, name: &str) -> Option<f64> {
        self.summary.scalars.get(name).map(|scalar| scalar.value)
    }
}
