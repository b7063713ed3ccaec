//! The scalars of runs and tests side by side.

use super::{Difference, Subject};
use crate::results::{Label, OF_TESTS, OF_TRACKS};
use std::collections::BTreeMap;

/// One scalar over all results.
#[derive(Debug, Clone, PartialEq)]
pub struct NumberRow {
    /// Its name in `summary.json`.
    pub name: String,
    /// SI; `1` for a count or a ratio.
    pub unit: String,
    /// Its label and shown unit, if it is one of the most important scalars.
    pub label: Option<Label>,
    /// `None` if a result has no such scalar.
    pub values: Vec<Option<Number>>,
}

/// A scalar of one result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// Its mean over packings, SI.
    pub value: f64,
    /// Half the width of the 95 % interval of that mean; `None` of one packing.
    pub confidence: Option<f64>,
    /// From the first result; `None` for the first result, and if the first result has no such scalar.
    pub from_first: Option<Difference>,
}

impl NumberRow {
    /// Whether the results do not all have one value.
    pub fn differs(&self) -> bool {
        self.values.iter().any(|value| value.map(|value| value.value) != self.values[0].map(|first| first.value))
    }
}

/// Whether a scalar is one of the most important.
pub fn is_named(row: &NumberRow) -> bool {
    row.label.is_some()
}

/// A row for each scalar: those with a label in their order, then the others by name.
pub fn numbers(subjects: &[Subject]) -> Vec<NumberRow> {
    let all: Vec<_> = subjects.iter().map(Subject::scalars).collect();
    let mut units: BTreeMap<&String, &String> = BTreeMap::new();
    for scalars in &all {
        for (name, (_, unit)) in scalars {
            units.entry(name).or_insert(unit);
        }
    }
    // told of each value already
    let is_told = |name: &str| {
        let ends = ["_mean", "_deviation", "_confidence"];
        let base = ends.iter().find_map(|end| name.strip_suffix(end));
        base.is_some_and(|base| units.contains_key(&base.to_owned()))
    };
    let is_test = subjects.iter().any(|subject| subject.tests().is_some());
    let labels: &[Label] = if is_test { &OF_TESTS } else { &OF_TRACKS };
    let row = |(name, unit): (&&String, &&String)| {
        let first = all[0].get(*name).map(|(sample, _)| sample);
        let value = |(index, scalars): (usize, &BTreeMap<String, (super::Sample, String)>)| {
            let (sample, _) = scalars.get(*name)?;
            let from_first = first.filter(|_| index > 0).and_then(|first| first.difference(sample));
            Some(Number { value: sample.mean()?, confidence: sample.confidence(), from_first })
        };
        let label = labels.iter().find(|label| label.name == **name).copied();
        let values = all.iter().enumerate().map(value).collect();
        NumberRow { name: (*name).clone(), unit: (*unit).clone(), label, values }
    };
    let mut rows: Vec<NumberRow> = units.iter().filter(|(name, _)| !is_told(name)).map(row).collect();
    let place = |row: &NumberRow| labels.iter().position(|label| label.name == row.name).unwrap_or(labels.len());
    rows.sort_by_key(place); // stable: names stay sorted
    rows
}
