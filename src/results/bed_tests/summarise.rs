//! The scalars of a test over its packings, and the expectations of the scene.

use super::super::{
    HistoryRow, Scalar, SleeperTable, Tables, broken_bonds, broken_share, is_known_within, mean_and_confidence,
};
use super::{BedTest, BedTests};
use crate::scenario::response::Response;
use crate::scenario::{Grains, Track};
use crate::solvers::granular::rig::{Cycle, SpecimenState};
use smol_str::SmolStr;
use std::collections::BTreeMap;

/// Scalars of the sleeper that settles most in each packing: mean over packings, and its confidence where there are
/// several.
fn scalars(tests: &[BedTest], plate: Option<f64>) -> BTreeMap<String, Scalar> {
    let mut scalars = BTreeMap::new();
    let last = tests.iter().flat_map(|test| &test.answer.cycles).map(|cycle| cycle.number).max().unwrap_or(0);
    let worst = |test: &BedTest, number: u64| -> Option<Cycle> {
        let of = test.answer.cycles.iter().filter(|cycle| cycle.number == number);
        of.copied().max_by(|a, b| a.settlement.total_cmp(&b.settlement))
    };
    let mut put = |name: &str, unit: &str, of: &dyn Fn(&BedTest) -> Option<f64>| {
        let values: Vec<f64> = tests.iter().filter_map(of).collect();
        if values.is_empty() {
            return;
        }
        let (mean, confidence) = mean_and_confidence(&values);
        scalars.insert(name.to_owned(), Scalar::new(mean, unit));
        if let Some(half) = confidence {
            scalars.insert(format!("{name}_confidence"), Scalar::new(half, unit));
        }
    };
    put("max_settlement", "m", &|test| Some(worst(test, last)?.settlement));
    put("first_settlement", "m", &|test| Some(worst(test, 1)?.settlement));
    // what is driven has none
    let stiffness = |cycle: Cycle| Some(cycle.stiffness).filter(|stiffness| *stiffness > 0.0);
    put("support_stiffness", "N/m", &|test| stiffness(worst(test, last)?));
    put("first_support_stiffness", "N/m", &|test| stiffness(worst(test, 1)?));
    // of a specimen: the largest recorded deviator, the friction angle that it mobilises, and the secant modulus to
    // half of this deviator
    let peak =
        |test: &BedTest| test.answer.specimen.iter().copied().max_by(|a, b| a.deviator().total_cmp(&b.deviator()));
    put("peak_deviator", "Pa", &|test| Some(peak(test)?.deviator()));
    put("peak_friction_angle", "rad", &|test| Some(peak(test)?.mobilised_friction()));
    put("peak_strain", "1", &|test| Some(peak(test)?.axial_strain));
    put("secant_modulus", "Pa", &|test| {
        let half = 0.5 * peak(test)?.deviator();
        // a state of no strain has no secant
        let strained = |state: &&SpecimenState| state.deviator() >= half && state.axial_strain != 0.0;
        let state = test.answer.specimen.iter().find(strained)?;
        Some(state.deviator() / state.axial_strain)
    });
    put("least_volume_strain", "1", &|test| {
        test.answer.specimen.iter().map(|state| state.volume_strain).reduce(f64::min)
    });
    put("greatest_volume_strain", "1", &|test| {
        test.answer.specimen.iter().map(|state| state.volume_strain).reduce(f64::max)
    });
    // of a plate: E = (F / A) / (u / h), and that of the virgin loading from its first to its deepest place
    if let Some(area) = plate.filter(|_| tests.iter().all(|test| test.answer.specimen.is_empty())) {
        let modulus = |test: &BedTest, stiffness: f64| stiffness * BedTests::height(test) / area;
        put("oedometric_modulus", "Pa", &|test| Some(modulus(test, stiffness(worst(test, last)?)?)));
        put("first_oedometric_modulus", "Pa", &|test| {
            let samples = || test.answer.samples.iter().filter(|sample| sample.cycle == 1);
            let deepest = samples().max_by(|a, b| a.depth.total_cmp(&b.depth))?;
            let first = samples().next()?;
            let (added, way) = (deepest.force - first.force, deepest.depth - first.depth);
            // a constant force adds nothing in its cycle
            (added > 0.0 && way > 0.0).then(|| modulus(test, added / way))
        });
    }
    put("max_contact_force", "N", &|test| test.answer.cycles.iter().map(|cycle| cycle.contact_force).reduce(f64::max));
    put("broken_bonds", "1", &|test| broken_bonds(test.answer.bonds));
    put("broken_bonds_share", "1", &|test| broken_share(test.answer.bonds));
    put("steps", "1", &|test| Some(test.answer.steps as f64));
    put("grains", "1", &|test| Some(test.bed.bodies as f64));
    put("porosity", "1", &|test| Some(test.bed.layers.last()?.inner_porosity));
    put("coordination_number", "1", &|test| Some(test.bed.layers.last()?.coordination));
    scalars.insert("cycles".to_owned(), Scalar::new(last as f64, "1"));
    scalars.insert("repeats".to_owned(), Scalar::new(tests.len() as f64, "1"));
    scalars
}

impl BedTests {
    /// Whether these packings suffice for an open range of repeats: the mean of the largest settlement is known to
    /// within the tolerance, of a specimen its largest deviator.
    pub fn are_enough(&self, grains: &Grains) -> bool {
        let value = |test: &BedTest| match test.answer.specimen.is_empty() {
            true => test.answer.cycles.iter().map(|cycle| (cycle.number, cycle.settlement)).max_by(later_and_deeper),
            false => test.answer.specimen.iter().map(|state| (0, state.deviator())).max_by(later_and_deeper),
        };
        let values: Vec<f64> = self.tests.iter().filter_map(value).map(|(_, value)| value).collect();
        let reach = *grains.tolerance * mean_and_confidence(&values).0.abs();
        values.len() >= grains.repeats.least as usize && is_known_within(&values, reach)
    }
}

fn later_and_deeper(one: &(u64, f64), other: &(u64, f64)) -> std::cmp::Ordering {
    one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
}

/// Quantities that expressions can use, as means over packings.
pub struct TestTables {
    sleepers: Vec<MeanCycleRow>,
    histories: Vec<HistoryRow>,
    pub scalars: BTreeMap<String, Scalar>,
}

/// A sleeper after a cycle: the values of [`Cycle`] as means over packings, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct MeanCycleRow {
    pub cycle: u64,
    pub sleeper: String,
    /// Chainage, m.
    pub x_m: f64,
    /// m.
    pub settlement: f64,
    pub deepest: f64,
    /// N/m.
    pub stiffness: f64,
    /// N.
    pub max_contact_force: f64,
}

impl TestTables {
    /// The tables of all tests.
    pub fn new(of: &BedTests) -> TestTables {
        let BedTests { sleepers, sensors, plate, tests } = of;
        TestTables {
            sleepers: mean_cycles(sleepers, tests),
            histories: histories(sensors, sleepers, tests),
            scalars: scalars(tests, *plate),
        }
    }

    /// The tables that expressions read.
    pub fn view<'a>(&'a self, track: &'a Track) -> Tables<'a> {
        let TestTables { sleepers, histories, scalars } = self;
        Tables {
            sleepers: SleeperTable::Cycles(sleepers),
            blocks: &[],
            rail: &[],
            histories,
            scalars,
            track,
            supports: &[],
        }
    }
}

/// A row for each sleeper and cycle.
fn mean_cycles(sleepers: &[(String, f64)], tests: &[BedTest]) -> Vec<MeanCycleRow> {
    let Some(first) = tests.first() else { return Vec::new() };
    let row = |(index, cycle): (usize, &Cycle)| {
        // packings of one scene end their cycles in the same order
        let mean = |of: fn(&Cycle) -> f64| {
            let values: Vec<f64> = tests.iter().filter_map(|test| test.answer.cycles.get(index)).map(of).collect();
            mean_and_confidence(&values).0
        };
        let (name, x) = &sleepers[cycle.sleeper];
        MeanCycleRow {
            cycle: cycle.number,
            sleeper: name.clone(),
            x_m: *x,
            settlement: mean(|c| c.settlement),
            deepest: mean(|c| c.deepest),
            stiffness: mean(|c| c.stiffness),
            max_contact_force: mean(|c| c.contact_force),
        }
    };
    first.answer.cycles.iter().enumerate().map(row).collect()
}

/// Readings of sensors and sleepers in the recorded cycles, for all packings.
fn histories(sensors: &[(String, f64)], sleepers: &[(String, f64)], tests: &[BedTest]) -> Vec<HistoryRow> {
    let mut rows = Vec::new();
    let mut put = |cycle: u64, phase: f64, quantity: Response, (id, x): &(String, f64), value: f64| {
        let (quantity, id) = (quantity.name().to_owned(), id.clone());
        let (quantity, id) = (quantity.into(), id.into());
        rows.push(HistoryRow { axles: cycle, time_s: phase, quantity, id, x_m: *x, value, train: SmolStr::default() });
    };
    for test in tests {
        for reading in &test.answer.readings {
            let at = &sensors[reading.sensor];
            put(reading.cycle, reading.phase, Response::BallastStress, at, reading.stress);
            put(reading.cycle, reading.phase, Response::BallastVelocity, at, reading.velocity);
            put(reading.cycle, reading.phase, Response::CoordinationNumber, at, reading.coordination);
            if let Some(porosity) = reading.porosity {
                put(reading.cycle, reading.phase, Response::Porosity, at, porosity);
            }
        }
        for sample in &test.answer.samples {
            put(sample.cycle, sample.phase, Response::SleeperVelocity, &sleepers[sample.sleeper], sample.velocity);
        }
    }
    rows
}
