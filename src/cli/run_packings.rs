//! Packings of a run, on this machine or in a process that another one watches.
//!
//! A track on grains is a run of its own on each further packing, in a directory that stays. The packings of a test
//! rig are one run; where processes share it, each packing is a part of it.

use super::parts::Parts;
use super::run_elsewhere::{self, Piece, ToTheLastAxle};
use super::running::{self, Recording, Request, Running};
use super::scene::{not_yet, show};
use super::task::Packings;
use super::{Outcome, stored, terminal};
use crate::cluster::Need;
use crate::diag::{Code, Diagnostic};
use crate::execute::{self, Both};
use crate::graph::Graph;
use crate::results::{self, Mean, Packing, Run, RunRecorder};
use crate::scenario::{Grains, Scenario};
use crate::store::{Directory, Mode, StoreError, Unfinished};
use crate::units::number;
use std::sync::atomic::Ordering;

/// Number of packings that are computed each on its own.
fn separate(graph: &Graph, scenario: &Scenario) -> u32 {
    let under_track = graph.has_grains_under_track().then_some(scenario.solve.grains.repeats.most);
    under_track.or(graph.tested_packings()).unwrap_or(1)
}

/// What a run takes, once for each packing.
pub(super) fn needs(graph: &Graph, scenario: &Scenario) -> Vec<Need> {
    let packings = separate(graph, scenario);
    let seconds = graph.cost.seconds / f64::from(packings);
    (0..packings).map(|_| Need { seconds, bytes: graph.cost.bytes, goes_on: true }).collect()
}

/// Makes a directory ready for packings that other processes compute.
pub(super) fn share(directory: &Directory, running: &Running<'_>) -> Result<(), StoreError> {
    if running.graph.tested_packings().is_some() { Parts::divide(directory) } else { run_elsewhere::begin(directory) }
}

/// Where each packing of a shared run is computed, by its place.
pub(super) fn pieces(run: &Unfinished, running: &Running<'_>) -> Result<Vec<Piece>, Outcome> {
    let parts = Parts::directories(run, running.graph).map_err(|error| running.stop(stored::diagnostic(&error)))?;
    if !parts.is_empty() {
        return Ok(parts.into_iter().map(|directory| Piece::Apart(directory, running.work.clone())).collect());
    }
    let further = further_seeds(running).map(|seed| {
        let request = running.request.with_seed(seed);
        let work = request.work(&request.compile().ok_or(Outcome::Usage)?.sources);
        Ok(Piece::Apart(results::packing_directory(&request.out, seed), work))
    });
    std::iter::once(Ok(Piece::Itself)).chain(further).collect()
}

/// Begins a run in this process. Packings of a rig that processes shared before are computed here.
pub(super) fn begin(directory: &Directory, running: &Running<'_>) -> Result<(), Outcome> {
    let of_store = |error: StoreError| running.stop(stored::diagnostic(&error));
    let parts = Parts::directories(directory.shared(), running.graph).map_err(of_store)?;
    for place in 0..parts.len() as u32 {
        tell(place, running, "");
        part(directory.shared(), place, running)?;
    }
    if parts.is_empty() && further_seeds(running).next().is_some() {
        // what is kept first may be a further packing
        run_elsewhere::begin(directory).map_err(of_store)?;
        tell(0, running, "");
    }
    Ok(())
}

/// Computes the further packings of a track after the run itself, each unless it is finished: in an open range of
/// repeats as many as the means need.
pub(super) fn further(directory: &Directory, running: &Running<'_>, run: &Run) -> Result<Vec<Packing>, Outcome> {
    let (own, solve) = (&run.summary.scalars, &running.scenario.solve);
    let (repeats, grains) = (solve.grains.repeats, &solve.grains);
    let mut found: Vec<Packing> = Vec::new();
    for seed in further_seeds(running) {
        let so_far = Mean::over(own, &found);
        if repeats.are_open() && so_far.is_enough(grains) {
            break;
        }
        let read = || results::read_packing(directory.path(), seed).map_err(|error| running.refuse(&error));
        let is_open = repeats.are_open() && found.len() + 1 >= repeats.least as usize;
        let why = if is_open { format!(", {}", said(&so_far, grains)) } else { String::new() };
        tell((seed - solve.seed) as u32, running, &why);
        another(running.request, seed)?;
        found.extend(read()?);
    }
    let all = Mean::over(own, &found);
    if repeats.are_open() && !found.is_empty() && !all.is_enough(grains) {
        terminal::note(&format!("{repeats} packings are too few: {}\n", said(&all, grains)));
    }
    Ok(found)
}

/// `the largest settlement is 0.68 +- 0.15 mm, asked to within 0.03 mm as is the step at the structure`
fn said(mean: &Mean, grains: &Grains) -> String {
    let digits = |metres: f64| number(format!("{:.2e}", metres * 1e3).parse().unwrap_or(metres * 1e3));
    let (settlement, half) = mean.settlement();
    let half = half.map_or(String::new(), |half| format!(" +- {}", digits(half)));
    format!(
        "the largest settlement is {}{half} mm; it and the step at the structure are asked to within {} mm",
        digits(settlement),
        digits(settlement.abs() * *grains.tolerance)
    )
}

/// Says which packing comes.
fn tell(place: u32, running: &Running<'_>, why: &str) {
    let solve = &running.scenario.solve;
    let (number, seed) = (place + 1, solve.seed + u64::from(place));
    terminal::note(&format!("packing {number} of {}: seed {seed}{why}\n", solve.grains.repeats));
}

/// Computes packings of a run that another process watches.
pub(super) fn compute_shared(run: &Unfinished, packings: &Packings) -> Result<(), Outcome> {
    let request = Request::of_packings(run.path(), packings);
    let compiled = request.compile().ok_or(Outcome::Usage)?;
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        show(&compiled);
        return Err(not_yet(&compiled));
    };
    let running = Running::new(&request, &compiled, (scenario, graph));
    if running.work != *run.work() {
        let said = format!("`{}` is not the scene of the run any more", packings.scene.display());
        let help = "take the edit back, or begin the run anew with `--force`";
        return Err(running.stop(Diagnostic::new(Code::E0809, said).help(help)));
    }
    for place in &packings.packings {
        match place {
            place if graph.tested_packings().is_some() => part(run, *place, &running)?,
            0 => to_the_last_axle(&running)?,
            further_place => another(&request, scenario.solve.seed + u64::from(*further_place))?,
        }
    }
    Ok(())
}

/// Seeds of the further packings of a track on grains.
fn further_seeds(running: &Running<'_>) -> impl Iterator<Item = u64> {
    let solve = &running.scenario.solve;
    let further = if running.graph.has_grains_under_track() { solve.grains.repeats.most - 1 } else { 0 };
    let seed = solve.seed;
    (1..=u64::from(further)).map(move |place| seed + place)
}

/// Computes the test of one packing, or goes on with it.
fn part(run: &Unfinished, place: u32, running: &Running<'_>) -> Result<(), Outcome> {
    let directory = Directory::open(&run.part(&place.to_string()), running.work.clone(), Mode::Resume);
    let directory = directory.map_err(|error| running.stop(stored::diagnostic(&error)))?;
    if directory.finished().is_some() { Ok(()) } else { running::compute_part(directory, place, running) }
}

/// Runs the scene of a track on the packing of another seed, or goes on with it.
fn another(request: &Request, seed: u64) -> Result<(), Outcome> {
    let request = request.with_seed(seed);
    let compiled = request.compile().ok_or(Outcome::Usage)?;
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        show(&compiled);
        return Err(not_yet(&compiled));
    };
    let running = Running::new(&request, &compiled, (scenario, graph));
    let open = |mode| Directory::open(&results::packing_directory(&request.out, seed), running.work.clone(), mode);
    let directory = match (request.force, request.is_worker) {
        (true, false) => open(Mode::Force),
        // an earlier attempt at this very packing goes on
        (true, true) => open(Mode::Resume).or_else(|error| match error.is_of_another() {
            true => open(Mode::Force),
            false => Err(error),
        }),
        (false, _) => open(Mode::Resume),
    };
    let directory = directory.map_err(|error| running.stop(stored::diagnostic(&error)))?;
    if directory.finished().is_some() {
        Ok(())
    } else {
        running::compute(directory, &running, &|_, _| Ok(Vec::new())).map(drop)
    }
}

/// Computes a run up to its last axle, and keeps its state there.
fn to_the_last_axle(running: &Running<'_>) -> Result<(), Outcome> {
    let Running { request, compiled, scenario, graph, .. } = running;
    let of_store = |error: &StoreError| running.stop(stored::diagnostic(error));
    let directory =
        Directory::open(&request.out, running.work.clone(), Mode::Resume).map_err(|error| of_store(&error))?;
    let end = ToTheLastAxle::new(graph);
    let mut recorder =
        RunRecorder::new(scenario, graph).kept_in(&directory).made_by(running.source()).interrupted_by(end.reached());
    let from = recorder.resume().map_err(|error| running.refuse(&error))?;
    let (mut recording, endable) = Recording::endable(&mut recorder, request);
    let ended = running.executor().run(graph, &mut Both(&mut &end, &mut recording), from);
    drop(endable);
    match (ended, recorder.failure()) {
        (Err(error), _) => return Err(running.stop(execute::diagnose(&error, graph, &compiled.origins))),
        (Ok(_), Some(error)) => return Err(running.refuse(&error)),
        (Ok(_), None) if running.asked.load(Ordering::Relaxed) => {
            return Err(running::stopped(request, recorder.has_kept()));
        }
        (Ok(_), None) => {}
    }
    drop(recorder);
    // whoever sees the word takes up the directory
    drop(directory);
    run_elsewhere::computed(&request.out).map_err(|error| of_store(&error))
}
