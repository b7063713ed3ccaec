//! `trackbed run` of a test rig: packs its bed, sets the sleepers down and loads them, once for each packing.

use super::{Outcome, pack, progress, report, run, terminal};
use crate::diag::{Code, Diagnostic, render};
use crate::lower;
use crate::results::{self, Beds, Follow, FoundBed, RigRun, RigView, Tested, Unfinished, checkpoint};
use crate::scenario::Scenario;
use crate::solvers::granular::Bed;
use crate::solvers::granular::packing::Progress;
use crate::solvers::granular::rig::{StoredTrial, Trial};
use crate::units::number;
use crate::{Compiled, fingerprint};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time between two checkpoints.
const KEEP: Duration = Duration::from_secs(20);

/// Where a rig is run, and how.
pub(super) struct Options<'a> {
    pub out: &'a Path,
    pub beds: Beds,
    pub resume: bool,
}

/// A rig on its way.
struct Work<'a> {
    options: &'a Options<'a>,
    hash: String,
    /// Of the bed, then of its test.
    bar: progress::Patient,
    /// When something was kept last.
    kept: Instant,
}

/// Runs the rig of a scene into a directory that is ready for it.
pub(super) fn run_rig(compiled: &Compiled, scenario: &Scenario, options: &Options<'_>) -> Outcome {
    let started = Instant::now();
    let mut work = Work { options, hash: fingerprint(&compiled.sources), bar: bed_bar(), kept: started };
    let performed = work.unfinished().map_err(|mistake| vec![mistake]);
    match performed.and_then(|from| results::perform_rig(scenario, &options.beds, from, &mut work)) {
        Ok(performed) => {
            let computed = started.elapsed().as_secs_f64();
            let (rig, bed) = RigRun::gather(scenario, performed, &compiled.sources, work.hash.clone());
            let expectations = rig.summary.expectations.clone();
            match work.write(rig, bed, computed) {
                Ok(told) => terminal::out(&told),
                Err(message) => return run::stop(compiled, Diagnostic::new(Code::E0802, message)),
            }
            run::verdicts(&expectations, scenario, compiled)
        }
        Err(mistakes) => {
            let shown = render::human(&mistakes, &compiled.sources, terminal::colour(), terminal::width());
            terminal::note(&shown);
            Outcome::Failed
        }
    }
}

fn bed_bar() -> progress::Patient {
    progress::Patient::new("the bed")
}

impl Follow for Work<'_> {
    fn packing(&mut self, progress: &Progress) {
        pack::at(&mut self.bar, progress);
    }

    fn found(&mut self, found: &FoundBed) {
        pack::tell_loss(found);
        self.bar = progress::Patient::new("the test");
    }

    fn piece(&mut self, done: &[Tested], trial: &Trial<'_, f32>) -> Result<(), Diagnostic> {
        self.bar.at(trial.done(), trial.pieces());
        if trial.at_end_of_cycle() && self.kept.elapsed() > KEEP {
            self.keep(done, Some(trial.store()))?;
        }
        Ok(())
    }

    fn tested(&mut self, done: &[Tested]) -> Result<(), Diagnostic> {
        self.bar = bed_bar();
        self.keep(done, None)
    }
}

impl Work<'_> {
    fn unfinished(&self) -> Result<Unfinished, Diagnostic> {
        let read = || checkpoint::read(self.options.out, &self.hash);
        let found = self.options.resume.then(read).transpose().map_err(|error| {
            Diagnostic::new(Code::E0803, error.to_string()).help("run without `--resume`, with `--force`")
        })?;
        Ok(found.flatten().unwrap_or_default())
    }

    /// Keeps what there is, to go on from.
    fn keep(&mut self, done: &[Tested], running: Option<StoredTrial<f32>>) -> Result<(), Diagnostic> {
        checkpoint::write(self.options.out, &self.hash, &Unfinished { done: done.to_vec(), running })
            .map_err(|error| Diagnostic::new(Code::E0802, error.to_string()))?;
        self.kept = Instant::now();
        Ok(())
    }

    /// Tables, pictures and page; gives what is told of them.
    fn write(&self, rig: RigRun, mut bed: Bed<f32>, computed: f64) -> Result<String, String> {
        let out = self.options.out;
        let failure = |error: &dyn std::fmt::Display| format!("cannot write the results: {error}");
        let view = RigView::of(rig, &mut bed).map_err(|error| failure(&error))?;
        let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
        results::bodies_vtk(&view.grains, &mut bodies)
            .and(results::contacts_vtk(&view.links, &mut contacts))
            .map_err(|error| failure(&error))?;
        [("bodies.vtp", bodies), ("contacts.vtp", contacts)].iter().try_for_each(|(name, bytes)| {
            results::write_atomically(&out.join(name), bytes).map_err(|error| failure(&error))
        })?;
        let page = report::write_rig(&view, out, false).map_err(|error| failure(&error))?;
        let timings = BTreeMap::from([
            ("total_s".to_string(), computed),
            ("threads".to_string(), rayon::current_num_threads() as f64),
        ]);
        results::write_timings(&timings, out).map_err(|error| failure(&error))?;
        results::write_rig(&view, out).map_err(|error| failure(&error))?;
        checkpoint::remove(out).map_err(|error| failure(&error))?;
        Ok(summary(&view.run, &page, computed))
    }
}

/// The few numbers that people ask for first.
fn summary(rig: &RigRun, page: &Path, seconds: f64) -> String {
    let mut out = format!("{}\n", rig.scenario.title);
    let lines: [(&str, &str, &str, f64); 10] = [
        ("max_settlement", "settlement", "mm", 1e-3),
        ("first_settlement", "  after one cycle", "mm", 1e-3),
        ("support_stiffness", "resilient stiffness", "MN/m", 1e6),
        ("oedometric_modulus", "oedometric modulus", "MPa", 1e6),
        ("peak_deviator", "largest deviator", "kPa", 1e3),
        ("peak_friction_angle", "largest angle of friction", "deg", 1.0_f64.to_radians()),
        ("peak_strain", "  at a strain of", "%", 0.01),
        ("cycles", "cycles", "", 1.0),
        ("repeats", "packings", "", 1.0),
        ("grains", "grains", "", 1.0),
    ];
    run::headline(&mut out, &rig.summary.scalars, &lines);
    out.push_str(&format!("{} ({} s)\n", page.display(), number((seconds * 10.0).round() / 10.0)));
    out
}

/// Says what a rig would take, and whether it can be run; there is no graph to draw.
pub(super) fn plan(scenario: &Scenario, compiled: &Compiled, json: bool) -> Outcome {
    match lower::rig(scenario) {
        Ok(_) if json => match serde_json::to_string_pretty(&lower::rig_cost(scenario)) {
            Ok(json) => {
                terminal::out(&format!("{json}\n"));
                Outcome::Fine
            }
            Err(error) => {
                terminal::error(&format!("cannot write the plan as JSON: {error}"));
                Outcome::Failed
            }
        },
        Ok(plan) => {
            let notes: String = plan.bed.notes.iter().map(|note| format!("{note}\n")).collect();
            terminal::out(&format!("{}{notes}", lower::rig_listing(scenario)));
            Outcome::Fine
        }
        Err(mistakes) => {
            terminal::note(&render::human(&mistakes, &compiled.sources, terminal::colour(), terminal::width()));
            Outcome::Failed
        }
    }
}
