//! What is compared between runs: values at given pressures and after given cycles, their mean and scatter over seeds,
//! and how far the mean is from a reference.

use super::cycles::Cycle;
use super::experiment::Row;
use serde::Serialize;

/// Pressures of the first loading at which runs are compared \[kPa\].
pub const LEVELS: [f64; 8] = [0.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0];

/// How far two codes may be apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bar {
    /// In the unit of the value.
    Absolute(f64),
    /// Share of the reference.
    Share(f64),
}

impl Bar {
    /// In the unit of the value.
    pub fn width(self, reference: f64) -> f64 {
        match self {
            Bar::Absolute(width) => width,
            Bar::Share(share) => share * reference.abs(),
        }
    }
}

/// A number that a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Observable {
    pub name: &'static str,
    pub unit: &'static str,
    /// Pressure \[kPa\] or number of load cycles.
    pub at: f64,
    pub value: f64,
    pub bar: Option<Bar>,
}

/// First row of a first loading at or over a pressure \[kPa\]; the first row at all for 0.
pub fn at_pressure(rows: &[Row], level: f64) -> Option<&Row> {
    rows.iter().find(|row| level == 0.0 || row.plate_kpa >= level)
}

/// Everything that is compared, in the same order for every run.
pub fn observables(compression: &[Row], cycles: &[Cycle]) -> Vec<Observable> {
    let mut found = Vec::new();
    for level in LEVELS {
        // the last row of all stands a step after the upper pressure was met
        let last = compression.last().filter(|row| row.plate_kpa >= level - 0.1);
        if let Some(row) = at_pressure(compression, level).or(last) {
            let of = |name, unit, value, bar| Observable { name, unit, at: level, value, bar };
            found.push(of("plate height", "mm", 1e3 * row.plate_height_m, None));
            found.push(of("porosity", "-", row.porosity, Some(Bar::Absolute(0.002))));
            found.push(of("coordination", "-", row.coordination, Some(Bar::Absolute(0.2))));
        }
    }
    for cycle in cycles {
        let [before, loaded, after] = cycle.heights;
        let of = |name, value, bar| Observable { name, unit: "mm", at: cycle.number as f64, value: 1e3 * value, bar };
        let tenth = (cycle.number == 10).then_some(Bar::Share(0.2));
        if cycle.number == 0 {
            found.push(of("rebound", after - loaded, Some(Bar::Share(0.1))));
        } else {
            found.push(of("settlement of the cycle", before - after, None));
            found.push(of("settlement since unloading", cycles[0].heights[2] - after, None));
        }
        found.push(of("settlement since seating", cycle.settlement, tenth));
    }
    found
}

/// An observable over all seeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scatter {
    pub observable: &'static str,
    pub unit: &'static str,
    pub at: f64,
    pub runs: usize,
    pub mean: f64,
    /// Of the runs (divided by their number less one); none for a single one.
    pub standard_deviation: Option<f64>,
    pub min: f64,
    pub max: f64,
    pub reference: Option<f64>,
    /// In the unit of the value.
    pub bar: Option<f64>,
    pub within: Option<bool>,
}

/// Mean and scatter of observables that all runs have, in the order of the first run.
pub fn scatter(runs: &[Vec<Observable>], reference: &[Observable]) -> Vec<Scatter> {
    let same = |all: &[Observable], one: &Observable| {
        all.iter().find(|o| (o.name, o.at) == (one.name, one.at)).map(|o| o.value)
    };
    let mut found = Vec::new();
    for one in runs.iter().take(1).flatten() {
        let values: Vec<f64> = runs.iter().filter_map(|run| same(run, one)).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let reference = same(reference, one);
        let bar = reference.and_then(|reference| one.bar.map(|bar| bar.width(reference)));
        found.push(Scatter {
            observable: one.name,
            unit: one.unit,
            at: one.at,
            runs: values.len(),
            mean,
            standard_deviation: (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt()),
            min: values.iter().copied().fold(f64::INFINITY, f64::min),
            max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            reference,
            bar,
            within: reference.zip(bar).map(|(reference, bar)| (mean - reference).abs() <= bar),
        });
    }
    found
}
