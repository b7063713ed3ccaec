//! The runs of a chart, compared with the finest of them.

use super::errors::{RunErrors, compared};
use super::variants::{Group, RunVariant};
use crate::graph::Graph;
use crate::results::Run;
use serde::Serialize;

/// Time of a run, s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Took {
    /// All of it; nothing of it was computed before.
    pub seconds: f64,
    /// Until the first train: packing, laying, coming to rest. 0 without grains.
    pub build_s: f64,
}

/// A run that came to its end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Done {
    #[serde(flatten)]
    pub took: Took,
    pub errors: RunErrors,
    /// On the frontier: no faster run has a smaller error of settlement.
    pub efficient: bool,
}

/// What became of a variant.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ended {
    Done(Done),
    /// It was not run: it is expected to take too long.
    LeftOut,
    /// A solver has stopped it after so many seconds, such as for a step that is not stable.
    Stopped {
        seconds: f64,
    },
    /// It does not apply to the scene, or a check has refused it.
    Refused {
        reason: String,
    },
}

/// A way of computing the scene, and its result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunRow {
    #[serde(flatten)]
    pub variant: RunVariant,
    /// Expected time on two cores, s; `None` if it cannot run.
    pub estimated_s: Option<f64>,
    pub ended: Ended,
}

impl RunRow {
    /// Seconds until its end, or until a solver stopped it.
    pub fn seconds(&self) -> Option<f64> {
        match &self.ended {
            Ended::Done(done) => Some(done.took.seconds),
            Ended::Stopped { seconds } => Some(*seconds),
            Ended::LeftOut | Ended::Refused { .. } => None,
        }
    }

    pub fn done(&self) -> Option<&Done> {
        if let Ended::Done(done) = &self.ended { Some(done) } else { None }
    }
}

/// Whole runs of a scene, with their errors against the finest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunChart {
    pub title: String,
    pub axles: u64,
    /// How the scene was shortened, as sentences; empty if it was not.
    pub shortened: Vec<String>,
    /// The finest run: its name and its time.
    pub reference: String,
    pub took: Took,
    /// Error of settlement that the scene allows / largest settlement (`solve.tolerance`).
    pub tolerance: f64,
    /// Chainages between which seats are compared, m; infinite for all.
    #[serde(skip)]
    pub span: [f64; 2],
    pub rows: Vec<RunRow>,
}

/// A variant with its run, or the reason why there is none.
pub type Ran = (RunVariant, Option<f64>, Result<(Run, Took), Ended>);

impl RunChart {
    /// Compares runs with the reference.
    pub fn new(
        (reference, graph, run, took): (&RunVariant, &Graph, &Run, Took),
        shortened: &[String],
        others: Vec<Ran>,
    ) -> RunChart {
        let span = compared(graph);
        let ended = |ran: Result<(Run, Took), Ended>| match ran {
            Err(ended) => ended,
            Ok((other, took)) => match RunErrors::between(&other, run, span) {
                Some(errors) => Ended::Done(Done { took, errors, efficient: false }),
                None => Ended::Refused { reason: "it has no seat to compare with the reference".to_owned() },
            },
        };
        let row = |(variant, estimated_s, ran)| RunRow { variant, estimated_s, ended: ended(ran) };
        let mut rows: Vec<RunRow> = others.into_iter().map(row).collect();
        mark_efficient(&mut rows);
        RunChart {
            title: run.scenario.title.clone(),
            axles: run.sleepers.iter().map(|row| row.axles).max().unwrap_or(0),
            shortened: shortened.to_vec(),
            reference: reference.name.clone(),
            took,
            tolerance: *run.scenario.solve.grains.tolerance,
            span,
            rows,
        }
    }

    /// The fastest run whose settlement error stays within a tolerance; another packing is no other method.
    pub fn fastest_within(&self, tolerance: f64) -> Option<(&RunRow, &Done)> {
        let methods = self.rows.iter().filter(|row| row.variant.group != Group::Packing);
        let done = methods.filter_map(|row| Some((row, row.done()?)));
        let within = done.filter(|(_, done)| done.errors.settlement <= tolerance);
        within.min_by(|a, b| a.1.took.seconds.total_cmp(&b.1.took.seconds))
    }

    /// Largest settlement error of another packing: what a difference between methods must be measured against.
    pub fn band(&self) -> Option<f64> {
        let packings = self.rows.iter().filter(|row| row.variant.group == Group::Packing);
        packings.filter_map(|row| Some(row.done()?.errors.settlement)).reduce(f64::max)
    }
}

/// Marks the runs that no faster run beats. Another packing is no other method, and takes no part.
fn mark_efficient(rows: &mut [RunRow]) {
    let known = |row: &RunRow| row.done().map(|done| (done.took.seconds, done.errors.settlement));
    let methods: Vec<(f64, f64)> =
        rows.iter().filter(|row| row.variant.group != Group::Packing).filter_map(known).collect();
    for row in rows.iter_mut().filter(|row| row.variant.group != Group::Packing) {
        if let Ended::Done(done) = &mut row.ended {
            let (seconds, error) = (done.took.seconds, done.errors.settlement);
            let beats = |&(s, e): &(f64, f64)| s <= seconds && e <= error && (s, e) != (seconds, error);
            done.efficient = !methods.iter().any(beats);
        }
    }
}
