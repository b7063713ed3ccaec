//! What the commands that study a scene share: the scene, its state after some axles, and their files.
use super::scene::{SceneArguments, failed, not_yet, show};
use super::{Outcome, terminal};
use crate::compile::Compiled;
use crate::diag::{Code, Diagnostic};
use crate::execute::{self, RunError};
use crate::graph::Clock;
use crate::nodes::NodeError;
use crate::results;
use crate::scenario::Scenario;
use crate::solvers::track::TrackError;
use crate::trials::{self, NotSettled, Planned, Settled};
use serde::Serialize;
use std::path::Path;

/// A scene with traffic.
pub(super) struct Subject<'a> {
    compiled: &'a Compiled,
    pub scenario: &'a Scenario,
    pub planned: Planned,
}

/// Compiles the scene of a study.
pub(super) fn compile(scene: &SceneArguments) -> Result<Compiled, Outcome> {
    let Some(compiled) = scene.compile().map(Compiled::to_run) else { return Err(Outcome::Usage) };
    show(&compiled);
    if failed(&compiled) { Err(Outcome::Failed) } else { Ok(compiled) }
}

impl<'a> Subject<'a> {
    pub fn new(compiled: &'a Compiled, command: &str) -> Result<Subject<'a>, Outcome> {
        let (Some(scenario), Some(graph)) = (&compiled.scenario, &compiled.graph) else {
            return Err(not_yet(compiled));
        };
        match Planned::new(graph, &compiled.origins) {
            Some(planned) => Ok(Subject { compiled, scenario, planned }),
            None => Err(stop(
                compiled,
                Diagnostic::new(
                    Code::E0701,
                    format!("`{command}` compares passages, and no train passes in this scene"),
                )
                .help("give the scene a `train` and a `traffic`"),
            )),
        }
    }

    /// The track after some axles, or after all of them.
    pub fn settled(&self, after: Option<u64>, progress: &mut dyn FnMut(u64, u64)) -> Result<Settled, Outcome> {
        trials::settled(&self.planned.graph, after, progress).map_err(|why| match why {
            NotSettled::Run(error) => {
                stop(self.compiled, execute::diagnose(&error, &self.planned.graph, &self.planned.origins))
            }
            NotSettled::Between { below, above } => {
                let known: Vec<String> = [below, above].into_iter().flatten().map(|n| n.to_string()).collect();
                let wanted = after.unwrap_or_default();
                let message = format!("forces and settlement are not exchanged after {wanted} axles");
                let diagnostic = Diagnostic::new(Code::E0702, message)
                    .help(format!("write `--after {}`", known.join("` or `--after ")));
                stop(self.compiled, diagnostic)
            }
        })
    }

    /// A run that the study needs has failed.
    pub fn stopped(&self, error: &RunError) -> Outcome {
        stop(self.compiled, execute::diagnose(error, &self.planned.graph, &self.planned.origins))
    }

    /// A passage that the study needs has failed.
    pub fn failed(&self, cause: TrackError, axles: u64) -> Outcome {
        let error = RunError::node(Clock::Axles(axles), NodeError::Track(cause));
        stop(self.compiled, execute::diagnose(&error, &self.planned.graph, &self.planned.origins))
    }
}

fn stop(compiled: &Compiled, diagnostic: Diagnostic) -> Outcome {
    terminal::diagnostics(&[diagnostic], &compiled.sources);
    Outcome::Failed
}

/// Writes the files of a study where a directory is given.
pub(super) fn write(directory: Option<&Path>, files: &[(&str, String)]) -> Result<(), Outcome> {
    let Some(directory) = directory else { return Ok(()) };
    let written = std::fs::create_dir_all(directory).map_err(|e| e.to_string()).and_then(|()| {
        files.iter().try_for_each(|(name, text)| {
            results::write_atomically(&directory.join(name), text.as_bytes()).map_err(|e| e.to_string())
        })
    });
    written.map_err(|cause| {
        let diagnostic = Diagnostic::new(Code::E0802, format!("cannot write into `{}`: {cause}", directory.display()))
            .help("give another `--out`");
        terminal::diagnostics(&[diagnostic], &Default::default());
        Outcome::Failed
    })
}

/// Prints an answer for a program.
pub(super) fn json(answer: &impl Serialize) -> Outcome {
    match serde_json::to_string_pretty(answer) {
        Ok(json) => {
            terminal::out(&format!("{json}\n"));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&format!("cannot write the answer as JSON: {error}"));
            Outcome::Failed
        }
    }
}
