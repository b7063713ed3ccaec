//! The directory of a study: each point is stored as soon as it is finished, and the result is written at once. A study
//! that was killed continues with the stored points.
//!
//! Runs are stored by the content of their points and not by a number, so that no result can be taken for a result of
//! another scene, and any number of processes can add results.

use super::{Answer, Plan, PlannedPoint, Repeat, values};
use crate::compile::{Compiled, fingerprint};
use crate::results::RESOLVED;
use crate::store::{Directory, Mode, StoreError, Work};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// Runs of a finished study by the fingerprints of their points.
const POINTS: &str = "points.json";
/// File name of the page of a study.
pub const PAGE: &str = "study.html";

/// The directory of a running or finished study.
#[derive(Debug)]
pub struct StudyFolder {
    directory: Directory,
    /// The runs of a finished study, without results that an older version stored in another form.
    finished: Option<BTreeMap<String, Vec<Repeat>>>,
    /// Constraints of the study: an older version did not store the misses.
    constraints: usize,
    /// Runs of each point at most.
    most: u32,
}

impl StudyFolder {
    /// Opens the directory of a study. Fails as [`Directory::open`] does.
    pub fn open(out: &Path, plan: &Plan, compiled: &Compiled, mode: Mode) -> Result<StudyFolder, StoreError> {
        let work = Work { name: format!("study `{}`", plan.study.name), scene_sha256: fingerprint(&compiled.sources) };
        let directory = Directory::open(out, work, mode)?;
        let points = directory.finished().map(|finished| finished.read(POINTS)).transpose()?.flatten();
        let read = |bytes: Vec<u8>| {
            let all: BTreeMap<String, Value> =
                serde_json::from_slice(&bytes).map_err(|cause| StoreError::damaged(&out.join(POINTS), cause))?;
            let runs = |value: Value| serde_json::from_value(value).ok();
            Ok(all.into_iter().filter_map(|(point, value)| Some((point, runs(value)?))).collect())
        };
        let constraints = plan.study.constraints.len();
        let (finished, most) = (points.map(read).transpose()?, plan.study.repeats.most);
        Ok(StudyFolder { directory, finished, constraints, most })
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        self.directory.path()
    }

    /// Whether the study has been finished here before, by this version or by another one.
    pub fn is_finished(&self) -> bool {
        self.finished.is_some()
    }

    /// The stored runs of a point from the first to the last without a gap; results of an older version that stored
    /// less are left out. Fails if a file is damaged.
    pub fn runs(&self, point: &PlannedPoint) -> Result<Vec<Repeat>, StoreError> {
        let mut runs = Vec::new();
        for repeat in 0..self.most {
            match self.known_run(point, repeat)? {
                Some(run) => runs.push(run),
                None => break,
            }
        }
        Ok(runs)
    }

    /// The stored run of a point; `None` if it has not run. Fails if its file is damaged.
    pub fn known_run(&self, point: &PlannedPoint, repeat: u32) -> Result<Option<Repeat>, StoreError> {
        let is_whole = |run: &Repeat| match run {
            Repeat::Done { misses, .. } => misses.len() == self.constraints,
            Repeat::Failed { .. } => true,
        };
        if let Some(runs) = self.finished.as_ref().and_then(|finished| finished.get(&point.fingerprint)) {
            return Ok(runs.get(repeat as usize).filter(|run| is_whole(run)).cloned());
        }
        let Some(bytes) = self.directory.kept(&point.key(repeat))? else { return Ok(None) };
        let run = serde_json::from_slice(&bytes);
        run.map(Some).map_err(|cause| StoreError::damaged(self.directory.path(), cause))
    }

    /// Stores a run of a point until the study is finished; a study that was finished before keeps its old results
    /// until then.
    pub fn keep(&self, point: &PlannedPoint, repeat: u32, run: &Repeat) -> Result<(), StoreError> {
        if self.is_finished() {
            return Ok(());
        }
        self.directory.keep(&point.key(repeat), &self.text("a run", run)?).map(drop)
    }

    /// The directory; other processes may work on the study in it.
    pub fn directory(&self) -> &Directory {
        &self.directory
    }

    /// Writes the result; equal studies give equal bytes except for the timings.
    pub fn finish(
        mut self,
        plan: &Plan,
        (answer, runs): (&Answer, &[Vec<Repeat>]),
        (page, resolved): (&str, Option<&str>),
        compiled: &Compiled,
        timings: &BTreeMap<String, f64>,
    ) -> Result<(), StoreError> {
        let csv =
            answer.csv().map_err(|cause| StoreError::unwritable(&self.directory.path().join("study.csv"), cause))?;
        let mut found = answer.json();
        found["provenance"] = provenance(compiled);
        let runs: BTreeMap<&String, &Vec<Repeat>> =
            plan.points.iter().map(|point| &point.fingerprint).zip(runs).collect();
        let files = [
            ("design.json", self.text("design.json", &design(plan, compiled))?),
            (POINTS, self.text(POINTS, &runs)?),
            ("study.csv", csv.into_bytes()),
            ("study.json", self.text("study.json", &found)?),
            (PAGE, page.as_bytes().to_vec()),
        ];
        files.iter().try_for_each(|(name, bytes)| self.directory.stage(name, bytes))?;
        resolved.map_or(Ok(()), |text| self.directory.stage(RESOLVED, text.as_bytes()))?;
        self.directory.stage_changing("timings.json", &self.text("timings.json", timings)?)?;
        self.directory.commit().map(drop)
    }

    /// Writes the page of a study that was finished before. Fails if another process is at work in the directory, or if
    /// the page cannot be written.
    pub fn show_again(self, page: &str) -> Result<(), StoreError> {
        let path = self.directory.path().to_owned();
        // its lock is for whoever amends it
        drop(self);
        let mut directory = Directory::amend(&path)?;
        directory.stage(PAGE, page.as_bytes())?;
        directory.commit().map(drop)
    }

    fn text(&self, name: &str, value: &impl Serialize) -> Result<Vec<u8>, StoreError> {
        let text = serde_json::to_string_pretty(value).map(|text| text + "\n");
        text.map(String::into_bytes).map_err(|cause| StoreError::unwritable(&self.directory.path().join(name), cause))
    }
}

/// The identity of a study: its scene, its points, and the program that runs them.
fn design(plan: &Plan, compiled: &Compiled) -> Value {
    let point = |p: &PlannedPoint| {
        let values = values(&plan.study, &p.levels);
        json!({ "point": p.number, "as_it_is": p.as_it_is, "values": values, "sha256": p.fingerprint })
    };
    json!({
        "study": plan.study.name,
        "provenance": provenance(compiled),
        "points": plan.points.iter().map(point).collect::<Vec<_>>(),
    })
}

fn provenance(compiled: &Compiled) -> Value {
    let main = compiled.sources.iter().next().map(|(_, source)| source);
    // only the name, so that equal scenes in different folders give equal files
    let name = main.map_or("", |s| s.name.rsplit(['/', '\\']).next().unwrap_or(&s.name));
    json!({
        "program": env!("CARGO_PKG_NAME"),
        "version": env!("CARGO_PKG_VERSION"),
        "file": name,
        "source": main.map_or("", |s| s.text.as_str()),
        "source_sha256": fingerprint(&compiled.sources),
        "seed": compiled.scenario.as_ref().map(|s| s.solve.seed),
    })
}
