//! The directory of a study: its design, a file for each finished point, and the answer. A study that was killed finds there
//! what it has.

use crate::compile::{Compiled, fingerprint};
use crate::results::write_atomically;
use crate::study::{Answer, Plan, PlannedPoint, PointResult, values};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const DESIGN: &str = "design.json";
const POINTS: &str = "points";
const ANSWERS: [&str; 4] = ["study.csv", "study.json", "study.html", "timings.json"];

pub(super) struct StudyFolder {
    directory: PathBuf,
}

/// Why a directory cannot be used.
pub(super) enum Taken {
    /// What it holds is of another study.
    ByAnother(String),
    Unusable(String),
}

impl StudyFolder {
    /// Makes the directory ready and keeps the design.
    pub fn prepare(out: &Path, plan: &Plan, compiled: &Compiled, resume: bool, force: bool) -> Result<Self, Taken> {
        let shown = out.display();
        let unusable = |what: String| Taken::Unusable(what);
        if out.is_file() {
            return Err(unusable(format!("`{shown}` is a file, not a directory")));
        }
        let path = out.join(DESIGN);
        let design = design(plan, compiled);
        let folder = StudyFolder { directory: out.to_path_buf() };
        if force {
            folder.clear().map_err(|e| unusable(format!("cannot replace what is in `{shown}`: {e}")))?;
        }
        if path.exists() {
            if !resume {
                return Err(unusable(format!("`{shown}` holds a study")));
            }
            let kept = std::fs::read(&path).map_err(|e| unusable(format!("cannot read `{}`: {e}", path.display())))?;
            if serde_json::from_slice::<Value>(&kept).ok().as_ref() != Some(&design) {
                return Err(Taken::ByAnother(format!("`{shown}` holds points of another study or of a changed scene")));
            }
        } else if out.join("summary.json").exists() {
            return Err(unusable(format!("`{shown}` holds the results of a run")));
        }
        std::fs::create_dir_all(out.join(POINTS))
            .map_err(|e| unusable(format!("cannot make the directory `{shown}`: {e}")))?;
        write(&path, &text(&design).map_err(unusable)?).map_err(unusable)?;
        Ok(folder)
    }

    fn clear(&self) -> std::io::Result<()> {
        let points = self.directory.join(POINTS);
        // only what a study has written
        if self.directory.join(DESIGN).exists() && points.is_dir() {
            std::fs::remove_dir_all(points)?;
        }
        for name in [DESIGN].iter().chain(&ANSWERS) {
            let path = self.directory.join(name);
            if path.exists() {
                std::fs::remove_file(path)?;
            }
        }
        Ok(())
    }

    fn point(&self, number: usize) -> PathBuf {
        self.directory.join(POINTS).join(format!("{number:06}.json"))
    }

    /// The result of a point that has been kept.
    pub fn known(&self, point: &PlannedPoint) -> Option<PointResult> {
        let bytes = std::fs::read(self.point(point.number)).ok()?;
        serde_json::from_slice(&bytes).ok().filter(|result: &PointResult| result.number == point.number)
    }

    pub fn keep(&self, result: &PointResult) -> Result<(), String> {
        write(&self.point(result.number), &text(&json!(result))?)
    }

    /// Writes the answer; equal studies leave equal bytes but for the timings.
    pub fn finish(
        &self,
        answer: &Answer,
        page: &str,
        compiled: &Compiled,
        seconds: f64,
        jobs: usize,
    ) -> Result<(), String> {
        let mut found = answer.json();
        found["provenance"] = provenance(compiled);
        let timings = json!({ "total_s": seconds, "jobs": jobs });
        let texts = [answer.csv()?, text(&found)?, page.to_string(), text(&timings)?];
        ANSWERS.iter().zip(texts).try_for_each(|(name, text)| write(&self.directory.join(name), &text))
    }
}

/// What names a study: its scene, its points, and the program that runs them.
fn design(plan: &Plan, compiled: &Compiled) -> Value {
    let points = plan.points.iter().map(|p| json!({ "point": p.number, "values": values(&plan.study, &p.levels) }));
    json!({
        "study": plan.study.name,
        "provenance": provenance(compiled),
        "points": points.collect::<Vec<_>>(),
    })
}

fn provenance(compiled: &Compiled) -> Value {
    let main = compiled.sources.iter().next().map(|(_, source)| source);
    // the name alone: equal scenes give equal files wherever they lie
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

fn text(value: &Value) -> Result<String, String> {
    serde_json::to_string_pretty(value).map(|text| text + "\n").map_err(|e| e.to_string())
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    write_atomically(path, text.as_bytes()).map_err(|e| e.to_string())
}
