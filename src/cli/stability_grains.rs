//! The part of `trackbed stability` for a scene with grains under its track: the maps of its own bed.

use super::scene::SceneArguments;
use super::{Outcome, interrupt, pack, progress, terminal};
use crate::check::Override;
use crate::compile::Compiled;
use crate::diag::Severity;
use crate::execute::{self, RunError};
use crate::nodes::{Builders, NodeError};
use crate::trials::{GrainMap, MATTERS, grain_map, grain_trials};
use crate::units::{number, percent};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Maps the grains of a scene; `None` if it has no trains over grains, and if no cell can be built of them, which is
/// said.
pub(super) fn mapped(scene: &SceneArguments, cache: Option<&Path>) -> Result<Option<GrainMap>, Outcome> {
    let on_cells = Override { path: "solve.substructure".into(), value: "cells".into() };
    let of_cells =
        SceneArguments { file: scene.file.clone(), set: scene.set.iter().cloned().chain([on_cells]).collect() };
    let Some(compiled) = of_cells.compile().map(Compiled::to_run) else { return Err(Outcome::Usage) };
    let Some(graph) = compiled.runnable() else {
        let why = compiled.diagnostics.iter().find(|found| found.severity == Severity::Error);
        let why = why.map_or(String::new(), |diagnostic| format!(": {}", diagnostic.message));
        terminal::note(&format!("no map of the grains, because no cell can be built of them{why}\n"));
        return Ok(None);
    };
    let stop = interrupt::asked();
    let (builders, beds) = (Builders::default(), pack::beds(cache));
    let (mut bar, mut shown) = (progress::Patient::seen("building the cells"), None);
    let (done, trials) = (AtomicU64::new(0), Mutex::new(progress::Patient::new("trials of grains")));
    let tried = || {
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        trials.lock().unwrap_or_else(PoisonError::into_inner).show(done, grain_trials() as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mapped = grain_map(
        graph,
        &builders,
        &beds,
        &mut |stage, share| {
            if shown.replace(stage) != Some(stage) {
                bar = progress::Patient::new(stage.to_string());
            }
            bar.show((1e3 * share) as u64, 1000);
            if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        },
        &tried,
    );
    mapped.map_err(|error| {
        match &error {
            RunError::Node { cause, .. } if **cause == NodeError::Stopped => terminal::note("stopped\n"),
            _ => {
                terminal::diagnostics(&[execute::diagnose(&error, graph, &compiled.origins)], &compiled.sources);
            }
        }
        Outcome::Failed
    })
}

/// What the maps say.
pub(super) fn told(map: &GrainMap) -> String {
    let GrainMap { section, sleeper, at_rest, loaded, .. } = map;
    let micro = |seconds: f64| number((1e8 * seconds).round() / 100.0);
    let mut out = format!(
        "\ngrains of section {section}, a cell under sleeper {sleeper}: {} runs and passages\n",
        map.steps.len() + map.speeds.len()
    );
    out += &format!(
        "  the scene steps by {} us with {} of the mass as added inertia; its bed runs away at {} us at rest, at {} us \
         under 40 kN: {} times as long\n",
        micro(at_rest.step),
        percent(at_rest.added),
        micro(at_rest.limit),
        micro(loaded.limit),
        number((100.0 * map.margin()).round() / 100.0)
    );
    out += &format!(
        "  {} of {} runs go on or are stopped against theory (the limit of the network of contacts)\n",
        map.against_theory(),
        map.steps.len()
    );
    let shown = |factor: f64| format!("{} km/h", number((3.6 * map.speed * factor).round()));
    for allowed in map.inertias() {
        out += &match map.matters_from(allowed) {
            Some(factor) => format!(
                "  inertia of {} of the mass changes the stiffness under the train by more than {} from {} on\n",
                percent(allowed),
                percent(MATTERS),
                shown(factor)
            ),
            None => format!(
                "  inertia of {} of the mass changes the stiffness under the train by less than {} up to {}\n",
                percent(allowed),
                percent(MATTERS),
                shown(map.fastest())
            ),
        };
    }
    out
}
