//! Runs one repeat of a point of a study, and reads the requested values.

use super::miss::Miss;
use super::point::Scene;
use crate::check::Override;
use crate::diag::Diagnostic;
use crate::execute::{self, Ending, Executor};
use crate::results::{self, RunRecorder, Tables, TestTables};
use crate::scenario::Study;
use crate::scenario::response::Expression;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// A run of a point, one of its repeats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Repeat {
    Done {
        /// The measured values, SI, in the order of [`Study::measured`].
        values: Vec<f64>,
        /// The miss of each constraint; `None` if it is met.
        misses: Vec<Option<Miss>>,
    },
    Failed {
        code: Option<String>,
        reason: String,
    },
}

/// Runs one repeat of a point for a study of the scene, by its name: the scene with these lines edited
/// ([`PlannedPoint::overrides_of`](super::PlannedPoint::overrides_of)). `None` if it ended early because `asked` became
/// true. The beds of the executor are shared: points with the same packing pack once.
pub fn perform(
    scene: Scene<'_>,
    study: &str,
    overrides: &[Override],
    executor: &Executor,
    asked: &AtomicBool,
) -> Option<Repeat> {
    run(scene, study, overrides, executor, asked).unwrap_or_else(Some)
}

fn run(
    scene: Scene<'_>,
    study: &str,
    overrides: &[Override],
    executor: &Executor,
    asked: &AtomicBool,
) -> Result<Option<Repeat>, Repeat> {
    let compiled = scene.compile(overrides);
    if let Some(mistake) = compiled.diagnostics.iter().find(|d| d.is_error()) {
        return Err(failed(mistake));
    }
    let nothing = || fail("there is nothing to run");
    // places and counts refer to the point's own track
    let own = compiled.studies.iter().find(|s| s.name == study).ok_or_else(nothing)?;
    let scenario = compiled.scenario.as_ref().ok_or_else(nothing)?;
    let graph = compiled.runnable().ok_or_else(nothing)?;
    let mut recorder = RunRecorder::new(scenario, graph).interrupted_by(asked);
    let ended = executor.run(graph, &mut recorder, None);
    let ended = ended.map_err(|error| failed(&execute::diagnose(&error, graph, &compiled.origins)))?;
    if ended == Ending::Stopped && !recorder.has_enough() {
        return Ok(None);
    }
    let tables = &recorder.tables;
    if let Some(tests) = &tables.tests {
        return answered(own, TestTables::new(tests).view(&scenario.track)).map(Some);
    }
    let histories = recorder.all_histories();
    let scalars = recorder.scalars();
    answered(own, tables.view(&histories, &scalars, &scenario.track, &graph.supports)).map(Some)
}

/// The values that a study needs from the tables of a run.
fn answered(study: &Study, view: Tables<'_>) -> Result<Repeat, Repeat> {
    let value = |text: &str, expression: &Expression| {
        results::evaluate(expression, view).map_err(|why| fail(&format!("`{text}`: {why}")))
    };
    let measured = study.measured().into_iter().map(|m| value(&m.text, &m.expression));
    let values: Vec<f64> = measured.collect::<Result<_, _>>()?;
    let constraints = study.constraints.iter().map(|constraint| {
        let operands = constraint.operands.iter().map(|operand| value(&constraint.text, operand));
        Ok(Miss::against(constraint, &operands.collect::<Result<Vec<f64>, _>>()?))
    });
    let misses: Vec<Option<Miss>> = constraints.collect::<Result<_, Repeat>>()?;
    Ok(Repeat::Done { values, misses })
}

fn failed(mistake: &Diagnostic) -> Repeat {
    Repeat::Failed { code: Some(mistake.code.to_string()), reason: mistake.message.clone() }
}

fn fail(reason: &str) -> Repeat {
    Repeat::Failed { code: None, reason: reason.to_string() }
}
