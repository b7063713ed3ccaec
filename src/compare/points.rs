//! Studies side by side: points with equal varied values, and their measured values.

use super::study_table::{Key, StudyPoint, StudyTable};
use super::{Difference, Sample, Subject};

/// A point over all studies.
#[derive(Debug, Clone, PartialEq)]
pub struct PointRow {
    /// `the scene as it is`, or `pad.stiffness = 40 MN/m, ...`
    pub point: String,
    /// The texts of the varied values; empty for the scene as it is.
    pub levels: Vec<String>,
    pub measured: String,
    pub unit: String,
    /// In that unit; `None` if a study has no such point, or it failed there.
    pub values: Vec<Option<f64>>,
    /// From the first study.
    pub from_first: Vec<Option<Difference>>,
}

/// A row for each point and measured value, in the order of the first study that has it.
pub fn points(subjects: &[Subject]) -> Vec<PointRow> {
    let studies: Vec<&StudyTable> = subjects.iter().filter_map(Subject::study).collect();
    let mut keys: Vec<(Key, String, Vec<String>)> = Vec::new();
    let mut measured: Vec<&(String, String)> = Vec::new();
    for study in &studies {
        for point in &study.points {
            let key = study.key(point);
            if !keys.iter().any(|(known, ..)| *known == key) {
                let levels = if key == Key::AsItIs { Vec::new() } else { point.levels.clone() };
                keys.push((key, called(study, point), levels));
            }
        }
        let new: Vec<&(String, String)> = study.measured.iter().filter(|of| !measured.contains(of)).collect();
        measured.extend(new);
    }
    let row = |(key, point, levels): &(Key, String, Vec<String>), of: &(String, String)| {
        let samples: Vec<Option<&Sample>> = studies.iter().map(|study| study.value(key, of)).collect();
        let first = samples[0];
        let difference = |index: usize| first.filter(|_| index > 0)?.difference(samples[index]?);
        PointRow {
            point: point.clone(),
            levels: levels.clone(),
            measured: of.0.clone(),
            unit: of.1.clone(),
            values: samples.iter().map(|sample| sample.and_then(Sample::mean)).collect(),
            from_first: (0..samples.len()).map(difference).collect(),
        }
    };
    keys.iter().flat_map(|key| measured.iter().map(move |of| row(key, of))).collect()
}

/// A point in words.
fn called(study: &StudyTable, point: &StudyPoint) -> String {
    if point.as_it_is && point.number == 0 {
        return "the scene as it is".to_owned();
    }
    let level = |((path, unit), text): (&(String, String), &String)| {
        let text = format!("{path} = {text} {unit}");
        text.trim_end().to_owned()
    };
    study.axes.iter().zip(&point.levels).map(level).collect::<Vec<_>>().join(", ")
}
