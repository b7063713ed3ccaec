//! Results of tests on packed beds: cycles, loops, sensor readings, a summary, and the files that hold them.

mod files;
mod summarise;
mod view;

pub use files::{test_files, tests_file};
pub use summarise::{MeanCycleRow, TestTables};
pub use view::{BedTestsView, read_tests};

use super::{BedSummary, Row};
use crate::graph::BedNode;
use crate::nodes::Tested;
use crate::solvers::granular::rig::{Cycle, CycleSample, SensorReading, SpecimenState};
use serde::{Deserialize, Serialize};

/// One packing, and its test as it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedTest {
    pub bed: BedSummary,
    #[serde(flatten)]
    pub answer: Tested,
}

/// Tests of beds under actuators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedTests {
    /// Names and chainages of the sleepers on the bed, m.
    pub sleepers: Vec<(String, f64)>,
    /// Names and chainages of the sensors, m.
    pub sensors: Vec<(String, f64)>,
    /// Area of a plate over the whole bed in the place of sleepers, m2.
    pub plate: Option<f64>,
    /// One for each seed.
    pub tests: Vec<BedTest>,
}

/// A sleeper over one cycle (`cycles.csv`). Forces are for one rail or for both, as the bed models them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)] // the names are the file's columns
pub struct CycleRow {
    pub seed: u64,
    pub sleeper: String,
    pub cycle: u64,
    /// At the end of the cycle, measured from rest under its own weight.
    pub settlement_m: f64,
    pub deepest_m: f64,
    /// Range of force divided by rebound; 0 without rebound.
    pub stiffness_N_per_m: f64,
    pub max_contact_force_N: f64,
    pub work_J: f64,
    pub steps: u64,
}

/// A sleeper at an instant of a cycle that is kept (`loops.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct LoopRow {
    pub seed: u64,
    pub sleeper: String,
    pub cycle: u64,
    /// Share of the cycle that is over.
    pub phase: f64,
    pub force_N: f64,
    pub contact_force_N: f64,
    pub depth_m: f64,
    pub velocity_m_per_s: f64,
}

/// A sensor at an instant of a cycle that is kept (`sensors.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct SensorRow {
    pub seed: u64,
    pub sensor: String,
    pub cycle: u64,
    pub phase: f64,
    pub stress_Pa: f64,
    pub velocity_m_per_s: f64,
    pub coordination_number: f64,
}

/// A sensor over a cycle that is kept (`volumes.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct VolumeRow {
    pub seed: u64,
    pub sensor: String,
    pub cycle: u64,
    /// At its end.
    pub porosity: f64,
    pub min_stress_Pa: f64,
    pub max_stress_Pa: f64,
}

/// A specimen at an instant of a cycle that is kept (`specimen.csv`); compression and shortening are positive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct SpecimenRow {
    pub seed: u64,
    pub cycle: u64,
    pub phase: f64,
    pub axial_strain: f64,
    pub volume_strain: f64,
    pub axial_stress_Pa: f64,
    pub lateral_stress_Pa: f64,
    pub deviator_Pa: f64,
}

impl Row for CycleRow {
    const FILE: &'static str = "cycles.csv";
    const COLUMNS: &'static [&'static str] = &[
        "seed",
        "sleeper",
        "cycle",
        "settlement_m",
        "deepest_m",
        "stiffness_N_per_m",
        "max_contact_force_N",
        "work_J",
        "steps",
    ];
}

impl Row for LoopRow {
    const FILE: &'static str = "loops.csv";
    const COLUMNS: &'static [&'static str] =
        &["seed", "sleeper", "cycle", "phase", "force_N", "contact_force_N", "depth_m", "velocity_m_per_s"];
}

impl Row for SensorRow {
    const FILE: &'static str = "sensors.csv";
    const COLUMNS: &'static [&'static str] =
        &["seed", "sensor", "cycle", "phase", "stress_Pa", "velocity_m_per_s", "coordination_number"];
}

impl Row for VolumeRow {
    const FILE: &'static str = "volumes.csv";
    const COLUMNS: &'static [&'static str] = &["seed", "sensor", "cycle", "porosity", "min_stress_Pa", "max_stress_Pa"];
}

impl Row for SpecimenRow {
    const FILE: &'static str = "specimen.csv";
    const COLUMNS: &'static [&'static str] = &[
        "seed",
        "cycle",
        "phase",
        "axial_strain",
        "volume_strain",
        "axial_stress_Pa",
        "lateral_stress_Pa",
        "deviator_Pa",
    ];
}

impl BedTests {
    /// Tests of a bed; none yet.
    pub fn new(bed: &BedNode) -> BedTests {
        BedTests {
            sleepers: bed.bodies.iter().map(|body| (body.name.clone(), body.x)).collect(),
            sensors: bed.sensors.iter().map(|sensor| (sensor.name.clone(), sensor.x)).collect(),
            plate: bed.plate,
            tests: Vec::new(),
        }
    }

    /// Height of the bed of a test as it was packed, m.
    pub fn height(test: &BedTest) -> f64 {
        test.bed.layers.iter().map(|layer| layer.thickness_m).sum()
    }

    pub fn cycles(&self) -> Vec<CycleRow> {
        let row = |test: &BedTest, cycle: &Cycle| CycleRow {
            seed: test.answer.seed,
            sleeper: self.sleepers[cycle.sleeper].0.clone(),
            cycle: cycle.number,
            settlement_m: cycle.settlement,
            deepest_m: cycle.deepest,
            stiffness_N_per_m: cycle.stiffness,
            max_contact_force_N: cycle.contact_force,
            work_J: cycle.work,
            steps: cycle.steps,
        };
        self.tests.iter().flat_map(|test| test.answer.cycles.iter().map(move |cycle| row(test, cycle))).collect()
    }

    pub fn loops(&self) -> Vec<LoopRow> {
        let row = |test: &BedTest, sample: &CycleSample| LoopRow {
            seed: test.answer.seed,
            sleeper: self.sleepers[sample.sleeper].0.clone(),
            cycle: sample.cycle,
            phase: sample.phase,
            force_N: sample.force,
            contact_force_N: sample.contact_force,
            depth_m: sample.depth,
            velocity_m_per_s: sample.velocity,
        };
        self.tests.iter().flat_map(|test| test.answer.samples.iter().map(move |sample| row(test, sample))).collect()
    }

    pub fn readings(&self) -> Vec<SensorRow> {
        let row = |test: &BedTest, reading: &SensorReading| SensorRow {
            seed: test.answer.seed,
            sensor: self.sensors[reading.sensor].0.clone(),
            cycle: reading.cycle,
            phase: reading.phase,
            stress_Pa: reading.stress,
            velocity_m_per_s: reading.velocity,
            coordination_number: reading.coordination,
        };
        self.tests.iter().flat_map(|test| test.answer.readings.iter().map(move |reading| row(test, reading))).collect()
    }

    pub fn specimen(&self) -> Vec<SpecimenRow> {
        let row = |test: &BedTest, state: &SpecimenState| SpecimenRow {
            seed: test.answer.seed,
            cycle: state.cycle,
            phase: state.phase,
            axial_strain: state.axial_strain,
            volume_strain: state.volume_strain,
            axial_stress_Pa: state.axial_stress,
            lateral_stress_Pa: state.lateral_stress,
            deviator_Pa: state.deviator(),
        };
        self.tests.iter().flat_map(|test| test.answer.specimen.iter().map(move |state| row(test, state))).collect()
    }

    pub fn volumes(&self) -> Vec<VolumeRow> {
        let mut rows = Vec::new();
        for test in &self.tests {
            for end in &test.answer.readings {
                let Some(porosity) = end.porosity else { continue };
                let same = test.answer.readings.iter().filter(|r| (r.sensor, r.cycle) == (end.sensor, end.cycle));
                let stresses = same.map(|reading| reading.stress);
                rows.push(VolumeRow {
                    seed: test.answer.seed,
                    sensor: self.sensors[end.sensor].0.clone(),
                    cycle: end.cycle,
                    porosity,
                    min_stress_Pa: stresses.clone().fold(f64::INFINITY, f64::min),
                    max_stress_Pa: stresses.fold(f64::NEG_INFINITY, f64::max),
                });
            }
        }
        rows
    }
}
