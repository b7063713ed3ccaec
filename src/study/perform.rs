//! Runs one point of a study with its repeats, and stores the requested values.

use super::miss::Miss;
use super::point::{PlannedPoint, Scene};
use crate::check::Override;
use crate::diag::Diagnostic;
use crate::execute::{self, Ending, Executor};
use crate::results::{self, RunRecorder, Tables, TestTables};
use crate::scenario::Study;
use crate::scenario::response::Expression;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;

/// A point that has run.
#[derive(Debug, Clone, PartialEq)]
pub struct PointResult {
    pub number: usize,
    pub outcome: PointOutcome,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointOutcome {
    Done {
        /// The measured values, SI, in the order of [`Study::measured`]; means over the repeats.
        values: Vec<f64>,
        /// Standard deviations over the repeats, 0 for one run.
        deviations: Vec<f64>,
        /// The miss of each constraint in the worst run; `None` if all runs meet it.
        #[serde(default)]
        misses: Vec<Option<Miss>>,
    },
    Failed {
        code: Option<String>,
        reason: String,
    },
}

/// A run of a point, one of its repeats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Repeat(Result<OneRun, PointOutcome>);

/// Runs one repeat of a point for a study of the scene, by its name: the scene with these lines edited
/// ([`PlannedPoint::overrides_of`]). `None` if it ended early because `asked` became true. The beds of the executor are
/// shared: points with the same packing pack once.
pub fn perform(
    scene: Scene<'_>,
    study: &str,
    overrides: &[Override],
    executor: &Executor,
    asked: &AtomicBool,
) -> Option<Repeat> {
    run(scene, study, overrides, executor, asked).transpose().map(Repeat)
}

impl PointResult {
    /// The result of all repeats of a point, in order; if repeats failed, the first failure.
    pub fn from_repeats(point: &PlannedPoint, repeats: &[Repeat]) -> PointResult {
        let runs: Result<Vec<OneRun>, PointOutcome> = repeats.iter().map(|repeat| repeat.0.clone()).collect();
        PointResult { number: point.number, outcome: runs.map_or_else(|failed| failed, |runs| gathered(&runs)) }
    }
}

/// The result of one run: the measured values, and the miss of each constraint.
type OneRun = (Vec<f64>, Vec<Option<Miss>>);

fn run(
    scene: Scene<'_>,
    study: &str,
    overrides: &[Override],
    executor: &Executor,
    asked: &AtomicBool,
) -> Result<Option<OneRun>, PointOutcome> {
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
    if ended == Ending::Stopped {
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
fn answered(study: &Study, view: Tables<'_>) -> Result<OneRun, PointOutcome> {
    let value = |text: &str, expression: &Expression| {
        results::evaluate(expression, view).map_err(|why| fail(&format!("`{text}`: {why}")))
    };
    let measured = study.measured().into_iter().map(|m| value(&m.text, &m.expression));
    let values: Vec<f64> = measured.collect::<Result<_, _>>()?;
    let constraints = study.constraints.iter().map(|constraint| {
        let operands = constraint.operands.iter().map(|operand| value(&constraint.text, operand));
        Ok(Miss::against(constraint, &operands.collect::<Result<Vec<f64>, _>>()?))
    });
    let misses: Vec<Option<Miss>> = constraints.collect::<Result<_, PointOutcome>>()?;
    Ok((values, misses))
}

fn failed(mistake: &Diagnostic) -> PointOutcome {
    PointOutcome::Failed { code: Some(mistake.code.to_string()), reason: mistake.message.clone() }
}

fn fail(reason: &str) -> PointOutcome {
    PointOutcome::Failed { code: None, reason: reason.to_string() }
}

/// Mean and standard deviation of every value, and the worst miss of every constraint.
fn gathered(runs: &[OneRun]) -> PointOutcome {
    let n = runs.len() as f64;
    let count = runs.first().map_or(0, |(values, _)| values.len());
    let values: Vec<f64> = (0..count).map(|i| runs.iter().map(|(v, _)| v[i]).sum::<f64>() / n).collect();
    let squares = |i: usize| runs.iter().map(|(v, _)| (v[i] - values[i]).powi(2)).sum::<f64>();
    let deviations = (0..count).map(|i| (squares(i) / (n - 1.0).max(1.0)).sqrt()).collect();
    let constraints = runs.first().map_or(0, |(_, misses)| misses.len());
    let worst = |i: usize| runs.iter().filter_map(|(_, m)| m[i]).max_by(|a, b| a.share.total_cmp(&b.share));
    PointOutcome::Done { values, deviations, misses: (0..constraints).map(worst).collect() }
}
