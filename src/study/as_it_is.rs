//! The scene as it is, beside the points of a study: with the lines that the study sets, but without the lines that it
//! varies.

use super::design::Level;
use super::point::{PlannedPoint, Scene, content, leaves_open, settings};
use crate::compile::Compiled;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Axis, Study, Values};

/// The scene as it is, checked and with its cost.
pub(super) struct AsItIs {
    pub point: PlannedPoint,
    compiled: Compiled,
}

impl AsItIs {
    /// Compiles it. Fails with a warning if it cannot run with the settings of the study.
    pub fn new(scene: Scene<'_>, study: &Study) -> Result<AsItIs, Diagnostic> {
        let overrides = settings(study);
        let compiled = scene.compile(&overrides);
        let own = asked(&compiled, &study.name);
        let track = compiled.scenario.as_ref().map(|scenario| &scenario.track);
        let mistake = match own.zip(compiled.runnable()).zip(track) {
            Some(((own, run), track)) => leaves_open(run, track, own),
            None => compiled.diagnostics.iter().find(|d| d.is_error()).or(compiled.diagnostics.first()).cloned(),
        };
        match (mistake, compiled.runnable(), &compiled.scenario) {
            (None, Some(run), Some(scenario)) => {
                let levels = study.axes.iter().map(level).collect();
                let fingerprint = content(study, &compiled);
                let point = PlannedPoint {
                    number: 0,
                    as_it_is: true,
                    levels,
                    overrides,
                    fingerprint,
                    seconds: run.cost.seconds,
                    bytes: run.cost.bytes,
                    seed: scenario.solve.seed,
                };
                Ok(AsItIs { point, compiled })
            }
            (mistake, ..) => Err(cannot_run(study, mistake)),
        }
    }

    /// Whether a point equals the scene as it is: same run and same questions.
    pub fn is(&self, run: &Graph, own: &Study) -> bool {
        let same_run = self.compiled.runnable().is_some_and(|mine| runs_as(mine, run));
        same_run && asked(&self.compiled, &own.name).is_some_and(|mine| asks_as(mine, own))
    }
}

/// The study of a compiled scene.
fn asked<'a>(compiled: &'a Compiled, name: &str) -> Option<&'a Study> {
    compiled.studies.iter().find(|study| study.name == name)
}

/// Whether two plans compute the same; their notes and costs may differ.
fn runs_as(a: &Graph, b: &Graph) -> bool {
    (&a.nodes, &a.edges, &a.schedule, &a.records, &a.supports)
        == (&b.nodes, &b.edges, &b.schedule, &b.records, &b.supports)
}

/// Whether two studies measure and compare the same, at the same places and counts.
fn asks_as(a: &Study, b: &Study) -> bool {
    let measured = |study: &Study| study.measured().into_iter().map(|m| m.expression.clone()).collect::<Vec<_>>();
    let compared = |study: &Study| study.constraints.iter().map(|c| c.operands.clone()).collect::<Vec<_>>();
    measured(a) == measured(b) && compared(a) == compared(b)
}

/// The value of the scene for an axis, as its place in the list of the axis if it is there.
fn level(axis: &Axis) -> Level {
    let (text, number) = match &axis.written {
        Some(written) => (written.text.clone(), written.number),
        None => ("as it is".to_string(), None),
    };
    let choice = match &axis.values {
        Values::Listed(choices) => {
            choices.iter().position(|c| if number.is_some() { c.number == number } else { c.text == text })
        }
        Values::Spread(_) => None,
    };
    Level { text, number, choice }
}

fn cannot_run(study: &Study, mistake: Option<Diagnostic>) -> Diagnostic {
    let why = mistake.map_or_else(
        || "it has nothing to run".to_string(),
        |mistake| match mistake.code {
            Code::E0705 => mistake.message,
            code => format!("{} ({code})", mistake.message),
        },
    );
    let set = if study.set.is_empty() { "" } else { " with the settings of the study" };
    let message = format!("study `{}` has no point for the scene as it is, which cannot run{set}: {why}", study.name);
    Diagnostic::new(Code::E0712, message)
        .label(study.span, "its points are compared with each other only")
        .help("correct the scene itself, so that each point can be compared with it")
}
