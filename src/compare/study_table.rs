//! Results of a study, read from its directory: one row for each point, with varied and measured values.

use super::made::Made;
use super::{CompareError, Sample};
use crate::store::{Finished, StoreError};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// Results of a study, read from its directory.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyTable {
    pub name: String,
    /// Varied values: paths and units.
    pub axes: Vec<(String, String)>,
    /// Measured values: expressions and units.
    pub measured: Vec<(String, String)>,
    pub points: Vec<StudyPoint>,
    /// The lines of the best designs.
    pub best: Vec<Vec<String>>,
    pub(super) made: Made,
}

#[derive(Debug, Clone, PartialEq)]
pub struct StudyPoint {
    pub number: usize,
    pub as_it_is: bool,
    /// The texts of the varied values, in the order of the axes.
    pub levels: Vec<String>,
    /// By the measured expressions, in their units; nothing if the point failed.
    pub values: Vec<Sample>,
    pub best: bool,
}

impl StudyTable {
    /// Reads the directory of a study.
    pub(super) fn read(finished: &Finished, path: &Path) -> Result<StudyTable, CompareError> {
        let file = |name: &str| -> Result<Vec<u8>, CompareError> {
            finished.read(name)?.ok_or_else(|| damaged(path, name, "it is not named in the manifest"))
        };
        let found: Value =
            serde_json::from_slice(&file("study.json")?).map_err(|cause| damaged(path, "study.json", cause))?;
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
        let axes: Vec<(String, String)> =
            list(&found["vary"]).iter().map(|axis| (text(&axis["path"]), text(&axis["unit"]))).collect();
        let repeats = most_repeats(&found["repeats"]);
        let made = &found["provenance"];
        let mut study = StudyTable {
            name: text(&found["study"]),
            axes,
            measured: Vec::new(),
            points: Vec::new(),
            best: list(&found["best"]).iter().map(|best| list(&best["lines"]).iter().map(text).collect()).collect(),
            made: Made {
                title: text(&found["title"]),
                version: text(&made["version"]),
                file: text(&made["file"]),
                sha256: text(&made["source_sha256"]),
                seed: made["seed"].as_u64(),
            },
        };
        study.rows(&file("study.csv")?, repeats).map_err(|cause| damaged(path, "study.csv", cause))?;
        Ok(study)
    }

    /// Reads the table of points.
    fn rows(&mut self, csv: &[u8], repeats: usize) -> Result<(), csv::Error> {
        let mut reader = csv::Reader::from_reader(csv);
        let header: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
        let from = 2 + self.axes.len();
        // each measured value and its difference to the scene as it is; where points are repeated, its deviation
        // between both and the interval of the difference behind
        let with_interval = header.iter().any(|name| named(name).0.ends_with(" difference +-"));
        let (width, at) = match repeats {
            0 | 1 => (2, 1),
            _ => (if with_interval { 4 } else { 3 }, 2),
        };
        let until = (from..header.len()).step_by(width).find(|index| !is_difference(&header, index + at));
        let until = until.unwrap_or(header.len());
        self.measured = (from..until).step_by(width).map(|index| named(&header[index])).collect();
        let place = |name: &str| header.iter().position(|own| own == name);
        let (best, packings) = (place("best"), place("packings"));
        for row in reader.records() {
            let row = row?;
            let cell = |index: usize| row.get(index).unwrap_or_default();
            let number = |index: usize| cell(index).parse::<f64>().ok();
            let packings = packings.and_then(|index| cell(index).parse().ok()).unwrap_or(repeats);
            let sample = |index: usize| match (number(index), number(index + 1)) {
                (Some(mean), Some(deviation)) if packings > 1 => {
                    Sample { values: Vec::new(), told: Some((mean, deviation, packings)) }
                }
                (Some(value), _) => Sample::one(0, value),
                (None, _) => Sample::default(),
            };
            self.points.push(StudyPoint {
                number: cell(0).parse().unwrap_or(0),
                as_it_is: cell(1) == "yes",
                levels: (2..from).map(|index| cell(index).to_owned()).collect(),
                values: (from..until).step_by(width).map(sample).collect(),
                best: best.is_some_and(|index| cell(index) == "yes"),
            });
        }
        Ok(())
    }

    /// A measured value of a point by its expression.
    pub(super) fn value(&self, key: &Key, of: &(String, String)) -> Option<&Sample> {
        let index = self.measured.iter().position(|measured| measured == of)?;
        let point = self.points.iter().find(|point| self.key(point) == *key)?;
        point.values.get(index)
    }

    pub(super) fn key(&self, point: &StudyPoint) -> Key {
        if point.as_it_is && point.number == 0 {
            return Key::AsItIs;
        }
        let names = self.axes.iter().map(|(path, _)| path.clone());
        Key::Levels(names.zip(point.levels.iter().cloned()).collect())
    }
}

/// Key by which points are equal.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Key {
    AsItIs,
    Levels(BTreeMap<String, String>),
}

/// Repeats of a point at most: the end of a range, or the number that older versions wrote.
fn most_repeats(repeats: &Value) -> usize {
    repeats[1].as_u64().or(repeats.as_u64()).unwrap_or(1) as usize
}

fn is_difference(header: &[String], index: usize) -> bool {
    header.get(index).is_some_and(|name| named(name).0.ends_with(" difference"))
}

/// `max(void) [mm]` is `max(void)` in mm.
fn named(header: &str) -> (String, String) {
    match header.strip_suffix(']').and_then(|text| text.rsplit_once(" [")) {
        Some((name, unit)) => (name.to_owned(), unit.to_owned()),
        None => (header.to_owned(), String::new()),
    }
}

/// A file of a study that is not as this version writes it.
fn damaged(path: &Path, file: &str, cause: impl fmt::Display) -> CompareError {
    StoreError::damaged(&path.join(file), cause).into()
}
