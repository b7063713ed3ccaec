//! Runs one point of a study, as often as it is repeated, and keeps what was asked for.

use super::plan::{PlannedPoint, Scene};
use crate::diag::Diagnostic;
use crate::execute::{self, Executor};
use crate::results::{self, RunRecorder, Tables, TestTables, Verdict};
use crate::scenario::Study;
use serde::{Deserialize, Serialize};

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
        /// What is measured, SI, in the order of [`Study::measured`]; means over the repeats.
        values: Vec<f64>,
        /// Standard deviations over the repeats, 0 for one of them.
        deviations: Vec<f64>,
        /// Whether every run met each constraint.
        met: Vec<bool>,
    },
    Failed {
        code: Option<String>,
        reason: String,
    },
}

/// A run of a point, one of its repeats.
#[derive(Debug, Clone)]
pub struct Repeat(Result<OneRun, PointOutcome>);

/// Runs one repeat of a point. The beds of the executor are shared: of points that pack alike one packs.
pub fn perform(scene: Scene<'_>, study: &Study, point: &PlannedPoint, repeat: u32, executor: &Executor) -> Repeat {
    Repeat(run(scene, study, point, repeat, executor))
}

impl PointResult {
    /// The result of all repeats of a point, in their order; the first that failed speaks for it.
    pub fn from_repeats(point: &PlannedPoint, repeats: &[Repeat]) -> PointResult {
        let runs: Result<Vec<OneRun>, PointOutcome> = repeats.iter().map(|repeat| repeat.0.clone()).collect();
        PointResult { number: point.number, outcome: runs.map_or_else(|failed| failed, |runs| gathered(&runs)) }
    }
}

/// What one run says: what is measured, and whether each constraint is met.
type OneRun = (Vec<f64>, Vec<bool>);

fn run(
    scene: Scene<'_>,
    study: &Study,
    point: &PlannedPoint,
    repeat: u32,
    executor: &Executor,
) -> Result<OneRun, PointOutcome> {
    let compiled = scene.compile(&point.overrides_of(repeat));
    if let Some(mistake) = compiled.diagnostics.iter().find(|d| d.is_error()) {
        return Err(failed(mistake));
    }
    let nothing = || fail("there is nothing to run");
    // places and counts of the point's own track
    let own = compiled.studies.iter().find(|s| s.name == study.name).ok_or_else(nothing)?;
    let scenario = compiled.scenario.as_ref().ok_or_else(nothing)?;
    let graph = compiled.runnable().ok_or_else(nothing)?;
    let mut recorder = RunRecorder::new(scenario, graph);
    let ended = executor.run(graph, &mut recorder, None);
    ended.map_err(|error| failed(&execute::diagnose(&error, graph, &compiled.origins)))?;
    let tables = &recorder.tables;
    if let Some(tests) = &tables.tests {
        return answered(own, TestTables::new(tests).view(&scenario.track));
    }
    let histories = recorder.all_histories();
    let scalars = recorder.scalars();
    answered(own, tables.view(&histories, &scalars, &scenario.track, &graph.supports))
}

/// What a study asks of the tables of a run.
fn answered(study: &Study, view: Tables<'_>) -> Result<OneRun, PointOutcome> {
    let measure = |m: &crate::scenario::Measured| {
        let value = results::evaluate(&m.expression, view).map_err(|why| fail(&format!("`{}`: {why}", m.text)))?;
        if value.is_finite() { Ok(value) } else { Err(fail(&format!("`{}` is not a finite number", m.text))) }
    };
    let values: Vec<f64> = study.measured().into_iter().map(measure).collect::<Result<_, _>>()?;
    let verdicts = study.constraints.iter().map(|c| results::verdict(c, view));
    let met: Vec<bool> = verdicts.map(held).collect::<Result<_, _>>()?;
    Ok((values, met))
}

fn held(verdict: Verdict) -> Result<bool, PointOutcome> {
    match verdict.problem {
        Some(why) => Err(fail(&format!("`{}`: {why}", verdict.text))),
        None => Ok(verdict.met),
    }
}

fn failed(mistake: &Diagnostic) -> PointOutcome {
    PointOutcome::Failed { code: Some(mistake.code.to_string()), reason: mistake.message.clone() }
}

fn fail(reason: &str) -> PointOutcome {
    PointOutcome::Failed { code: None, reason: reason.to_string() }
}

/// Mean and standard deviation of every value, and what all runs met.
fn gathered(runs: &[OneRun]) -> PointOutcome {
    let n = runs.len() as f64;
    let count = runs.first().map_or(0, |(values, _)| values.len());
    let values: Vec<f64> = (0..count).map(|i| runs.iter().map(|(v, _)| v[i]).sum::<f64>() / n).collect();
    let squares = |i: usize| runs.iter().map(|(v, _)| (v[i] - values[i]).powi(2)).sum::<f64>();
    let deviations = (0..count).map(|i| (squares(i) / (n - 1.0).max(1.0)).sqrt()).collect();
    let constraints = runs.first().map_or(0, |(_, met)| met.len());
    let met = (0..constraints).map(|i| runs.iter().all(|(_, met)| met[i])).collect();
    PointOutcome::Done { values, deviations, met }
}
