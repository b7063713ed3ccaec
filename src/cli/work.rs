//! `trackbed work`: computes runs of a study, or packings of a run, that another process has begun, beside any number
//! of others.

use super::task::{Packings, Task};
use super::{Outcome, interrupt, pack, run_packings, stored, terminal};
use crate::check::{self, Folder, Remembered};
use crate::compile::fingerprint;
use crate::diag::{Code, Diagnostic, Sources};
use crate::execute::Executor;
use crate::store::{StoreError, Unfinished};
use crate::study::{self, Runs, Scene, TaskRun};
use crate::syntax;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Compute what a study or a run with `--executor workers` or `slurm` has left to other processes
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed work pads
  trackbed work pads 3")]
pub(super) struct Arguments {
    /// The directory of the study or of the run.
    directory: PathBuf,
    /// Numbers of tasks; all where none is given. What is kept, and what another worker computes, is left out.
    tasks: Vec<usize>,
    /// Threads of a run; all cores where it is not given. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool,
        Err(error) => {
            terminal::error(&format!("cannot start {threads} threads: {error}"));
            return Outcome::Failed;
        }
    };
    pool.install(|| work(arguments)).map_or_else(|outcome| outcome, |()| Outcome::Fine)
}

fn fail(diagnostic: Diagnostic) -> Outcome {
    terminal::diagnostics(&[diagnostic], &Sources::default());
    Outcome::Failed
}

fn of_store(error: &StoreError) -> Outcome {
    fail(stored::diagnostic(error))
}

fn work(arguments: &Arguments) -> Result<(), Outcome> {
    let path = &arguments.directory;
    let nothing = || {
        let said = Diagnostic::new(Code::E0802, format!("no study and no run is under way in `{}`", path.display()));
        fail(said.help("begin one with `--executor workers --out DIR`"))
    };
    let state = Unfinished::open(path).map_err(|error| of_store(&error))?.ok_or_else(nothing)?;
    let asked = interrupt::asked();
    let _endable = interrupt::endable(stopped);
    let numbers = match arguments.tasks.as_slice() {
        [] => Task::numbers(&state).map_err(|error| of_store(&error))?,
        some => some.to_vec(),
    };
    for number in numbers {
        let missing = || fail(Diagnostic::new(Code::E0802, format!("`{}` holds no task {number}", path.display())));
        match Task::read(&state, number).map_err(|error| of_store(&error))?.ok_or_else(missing)? {
            Task::Runs(runs) => some_runs(&state, &runs, asked)?,
            Task::Packings(packings) => some_packings(&state, &packings, number)?,
        }
    }
    if asked.load(Ordering::Relaxed) { Err(stopped()) } else { Ok(()) }
}

fn stopped() -> Outcome {
    terminal::note("stopped: finished runs are kept, and the same command computes the rest\n");
    Outcome::Failed
}

/// Computes packings of a run, unless somebody else computes them.
fn some_packings(state: &Unfinished, packings: &Packings, number: usize) -> Result<(), Outcome> {
    match state.claim(&Task::key(number)).map_err(|error| of_store(&error))? {
        Some(_claim) => run_packings::compute_shared(state, packings),
        None => Ok(()),
    }
}

fn some_runs(study: &Unfinished, task: &Runs, asked: &AtomicBool) -> Result<(), Outcome> {
    let name = task.scene.display().to_string();
    let unreadable = |why: String| fail(Diagnostic::new(Code::E0802, format!("cannot read `{name}`: {why}")));
    let bytes = check::read_bounded(&task.scene).map_err(|error| unreadable(error.to_string()))?;
    let text = syntax::decode(&name, &bytes).map_err(|_| unreadable("it is not readable text".into()))?;
    let modules = Remembered::new(Folder(task.scene.parent().unwrap_or(Path::new("")).to_owned()));
    let scene = Scene { name: &name, text: &text, modules: &modules, set: &task.set };
    if fingerprint(&scene.compile(&[]).sources) != study.work().scene_sha256 {
        let said = Diagnostic::new(Code::E0809, format!("`{name}` is not the scene of the study any more"));
        return Err(fail(said.help("take the edit back, or begin the study anew with `--force`")));
    }
    let executor = Executor::default().with_beds(pack::beds(task.cache.as_deref()));
    for run in &task.runs {
        if asked.load(Ordering::Relaxed) || !one_run(study, task, run, scene, &executor, asked)? {
            return Ok(());
        }
    }
    Ok(())
}

/// Computes a run, unless it is kept or somebody else computes it. Gives `false` where the study has ended.
fn one_run(
    study: &Unfinished,
    task: &Runs,
    run: &TaskRun,
    scene: Scene<'_>,
    executor: &Executor,
    asked: &AtomicBool,
) -> Result<bool, Outcome> {
    let Some(_claim) = study.claim(&run.key).map_err(|error| of_store(&error))? else { return Ok(true) };
    // a damaged one is computed again
    if study.kept(&run.key).is_ok_and(|kept| kept.is_some()) {
        return Ok(true);
    }
    let started = Instant::now();
    let Some(done) = study::perform(scene, &task.study, &run.overrides, executor, asked) else { return Ok(true) };
    let bytes = done.bytes().map_err(|cause| of_store(&StoreError::unwritable(study.path(), cause)))?;
    let is_kept = interrupt::writing(|| study.add(&run.key, &bytes)).map_err(|error| of_store(&error))?;
    terminal::summary(&match is_kept {
        true => format!("{}: {:.1} s\n", run.name, started.elapsed().as_secs_f64()),
        false => "the study has ended: nothing is left to do\n".to_owned(),
    });
    Ok(is_kept)
}
