//! `trackbed run` of a test rig: packs its bed, sets the sleepers down and loads them, once for each packing.

use super::{Outcome, pack, progress, report, run, terminal};
use crate::diag::{Code, Diagnostic, render};
use crate::lower::{self, RigPlan};
use crate::results::{self, RigRun, RigView, Tested, checkpoint};
use crate::scenario::{Loading, RigLoad, Scenario, Target};
use crate::solvers::granular::Bed;
use crate::solvers::granular::packing::Packed;
use crate::solvers::granular::rig::{RigError, Stored, Trial};
use crate::units::number;
use crate::{Compiled, fingerprint};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two checkpoints.
const KEEP: Duration = Duration::from_secs(20);

/// Where a rig is run, and how.
pub(super) struct Options<'a> {
    pub out: &'a Path,
    /// Where packed beds are kept.
    pub cache: Option<PathBuf>,
    pub resume: bool,
}

/// An unfinished run.
#[derive(Serialize, Deserialize)]
struct Unfinished {
    done: Vec<Tested>,
    running: Option<Stored<f32>>,
}

/// A rig on its way.
struct Work<'a> {
    scenario: &'a Scenario,
    options: &'a Options<'a>,
    hash: String,
}

/// Runs the rig of a scene into a directory that is ready for it.
pub(super) fn run_rig(compiled: &Compiled, scenario: &Scenario, options: &Options<'_>) -> Outcome {
    let started = Instant::now();
    let work = Work { scenario, options, hash: fingerprint(&compiled.sources) };
    match work.tests() {
        Ok((plan, tests, bed)) => {
            let computed = started.elapsed().as_secs_f64();
            let (sources, hash) = (&compiled.sources, work.hash.clone());
            let rig = RigRun::gather(scenario, &plan, tests, sources, hash, listing(scenario));
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

impl Work<'_> {
    /// A test of each packing, and the bed of the last as it ended.
    fn tests(&self) -> Result<(RigPlan, Vec<Tested>, Bed<f32>), Vec<Diagnostic>> {
        let Unfinished { mut done, mut running } = self.unfinished().map_err(|mistake| vec![mistake])?;
        let repeats = u64::from(self.scenario.solve.grains.repeats.max(1));
        loop {
            let mut scenario = self.scenario.clone();
            scenario.solve.seed = self.scenario.solve.seed.wrapping_add(done.len() as u64);
            let plan = lower::rig(&scenario)?;
            let cache = self.options.cache.as_deref();
            let (packed, _) = pack::kept_or_built(cache, &plan.bed).map_err(|mistake| vec![mistake])?;
            let (tested, bed) = self
                .test(&plan, packed, running.take(), &done, scenario.solve.seed)
                .map_err(|mistake| vec![mistake])?;
            done.push(tested);
            if done.len() as u64 == repeats {
                return Ok((plan, done, bed));
            }
            self.keep(&done, None).map_err(|mistake| vec![mistake])?;
        }
    }

    fn unfinished(&self) -> Result<Unfinished, Diagnostic> {
        let read = || checkpoint::read(self.options.out, &self.hash);
        let found = self.options.resume.then(read).transpose().map_err(|error| {
            Diagnostic::new(Code::E0803, error.to_string()).help("run without `--resume`, with `--force`")
        })?;
        Ok(found.flatten().unwrap_or(Unfinished { done: Vec::new(), running: None }))
    }

    /// Keeps what there is, to go on from.
    fn keep(&self, done: &[Tested], running: Option<Stored<f32>>) -> Result<(), Diagnostic> {
        checkpoint::write(self.options.out, &self.hash, &Unfinished { done: done.to_vec(), running })
            .map_err(|error| Diagnostic::new(Code::E0802, error.to_string()))
    }

    fn test(
        &self,
        plan: &RigPlan,
        mut packed: Packed<f32>,
        running: Option<Stored<f32>>,
        done: &[Tested],
        seed: u64,
    ) -> Result<(Tested, Bed<f32>), Diagnostic> {
        let bed = results::bed_summary(&self.scenario.title, &plan.bed, &packed, None);
        let rig = plan.on(packed.levels.last().copied().unwrap_or_default());
        let mut bar = progress::Patient::new("the test");
        let mut trial = match running {
            Some(stored) => Trial::restore(stored, &rig)
                .map_err(|error| Diagnostic::new(Code::E0803, error.to_string()).help("run with `--force`"))?,
            None => {
                let failed = |failure| diagnose(&RigError::Failure { cycle: 0, failure });
                let whole =
                    if plan.copies == 1 { packed.bed } else { packed.bed.replicate(plan.copies).map_err(failed)? };
                Trial::new(whole, &rig, |_| {}).map_err(|error| diagnose(&error))?
            }
        };
        self.load(&mut trial, done, &mut bar)?;
        let tested = Tested {
            seed,
            bed,
            cycles: trial.cycles().to_vec(),
            samples: trial.samples().to_vec(),
            readings: trial.readings().to_vec(),
            specimen: trial.specimen().to_vec(),
            steps: trial.steps(),
        };
        Ok((tested, trial.bed))
    }

    /// Runs a test to its end, and keeps what there is from time to time.
    fn load(&self, trial: &mut Trial<'_, f32>, done: &[Tested], bar: &mut progress::Patient) -> Result<(), Diagnostic> {
        let mut kept = Instant::now();
        let pieces = trial.pieces();
        while trial.advance().map_err(|error| diagnose(&error))? {
            bar.at(trial.done(), pieces);
            if trial.at_end_of_cycle() && kept.elapsed() > KEEP {
                self.keep(done, Some(trial.store()))?;
                kept = Instant::now();
            }
        }
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

fn diagnose(error: &RigError) -> Diagnostic {
    match error {
        RigError::Restless { .. } => Diagnostic::new(Code::E0811, error.to_string())
            .help("give the `packing` of the material more `pressure`, or its grains more `friction`"),
        _ => Diagnostic::new(Code::E0812, error.to_string()).help("is the `force` meant `per sleeper` or `per seat`?"),
    }
}

/// What the plan says of a rig.
pub(super) fn listing(scenario: &Scenario) -> String {
    let Some(cost) = lower::rig_cost(scenario) else { return String::new() };
    let rounded = |value: f64| number(format!("{value:.2e}").parse().unwrap_or(value));
    let time = match cost.seconds {
        seconds if seconds < 120.0 => format!("{} s", seconds.ceil()),
        seconds if seconds < 7200.0 => format!("{} min", (seconds / 60.0).ceil()),
        seconds => format!("{} h", (seconds / 3600.0).ceil()),
    };
    format!(
        "test rig: {} on a packed bed\n\
         grains: about {} of {} pebbles in all, step {} us\n\
         steps: about {} to pack the bed, {} to test it{}\n\
         time: about {time} on two cores, within a factor of two\n",
        what_stands(scenario),
        rounded(cost.grains),
        rounded(cost.pebbles),
        number((cost.time_step * 1e7).round() / 10.0),
        rounded(cost.packing_steps),
        rounded(cost.test_steps),
        if cost.repeats > 1 { format!(", {} times", cost.repeats) } else { String::new() }
    )
}

fn what_stands(scenario: &Scenario) -> String {
    let count = scenario.track.seats.len();
    let plate = |load: &RigLoad| load.on == Target::Bed;
    if matches!(&scenario.loading, Some(Loading::Rig(loads)) if loads.iter().any(|load| load.confinement.is_some())) {
        "a plate on a specimen whose sides give way,".to_owned()
    } else if matches!(&scenario.loading, Some(Loading::Rig(loads)) if loads.iter().any(plate)) {
        "a plate".to_owned()
    } else if count == 1 {
        "1 sleeper".to_owned()
    } else {
        format!("{count} sleepers")
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
            terminal::out(&format!("{}{notes}", listing(scenario)));
            Outcome::Fine
        }
        Err(mistakes) => {
            terminal::note(&render::human(&mistakes, &compiled.sources, terminal::colour(), terminal::width()));
            Outcome::Failed
        }
    }
}
