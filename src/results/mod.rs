//! Results of a run: tables, histories, a summary with the provenance, and the files that hold them.
//!
//! Values are SI; signs and names are as in the language guide. [`summarise`] and [`verdicts`] make numbers of the
//! tables, [`write()`] and [`read`] move a [`Run`] to a directory and back, bit for bit.

mod about;
mod bed;
mod bed_readings;
mod bed_tests;
mod check;
mod columns;
mod compared;
mod confidence;
mod error;
mod evaluate;
mod files;
mod gather;
mod grains;
mod histories;
mod kept_beds;
mod labels;
mod laws;
mod level;
mod packings;
mod recorder;
mod reliance;
mod so_far;
mod states;
mod steps;
mod summarise;
mod summary;
mod tables;
mod test_loads;
mod under_track;
mod under_track_files;
mod vtk;

#[cfg(test)]
pub(crate) mod example;

pub use bed::{BedLayer, BedSummary, bed_summary};
pub use bed_readings::{BedReadings, Directions, PlateTest, ProfileRow, keep_readings, kept_readings, read_bed};
pub use bed_tests::{
    BedTest, BedTests, BedTestsView, CycleRow, LoopRow, MeanCycleRow, SensorRow, SpecimenRow, TestTables, VolumeRow,
    read_tests, test_files, tests_file,
};
pub use check::{CheckRow, Parting};
use check::{check_rows, parted_by, summarise_check};
pub use compared::compared_passage;
use compared::summarise_compared;
pub use confidence::{
    confidence_of_difference, is_known_within, mean_and_confidence, mean_and_deviation, mean_and_interval,
};
pub use error::ResultsError;
pub use evaluate::{SleeperTable, Tables, contact_pressures, evaluate, holds, known, verdict, verdicts};
pub use files::{NamedBytes, RESOLVED, files, read, read_summary, read_timings, timings_file, write, write_files};
pub use gather::Source;
pub use grains::{Grain, Link, grains, links, places};
pub use labels::{Label, OF_TESTS, OF_TRACKS};
pub use laws::{LawCount, LawRow, law_rows, summarise_laws, unsettled};
pub use level::{LongitudinalLevel, longitudinal_level};
pub use packings::{Mean, OVER_PACKINGS, Packing, Scatter, packing_directory, read_packing, read_packings};
pub use recorder::{RunRecorder, RunTables};
pub use reliance::{Reliance, Silenced, Unchecked, Warned};
pub use so_far::SoFar;
pub use states::remove as remove_states;
pub use summarise::{
    RailMaxima, VOID_THRESHOLD, loaded_level, mean_wheel_load, static_wheel_load, summarise, worst_train,
};
use summarise::{broken_bonds, broken_share};
pub use summary::{Provenance, Scalar, Summary, Verdict};
pub use tables::{BlockRow, HistoryRow, RailRow, Row, SleeperRow, TampingRow, TrainRow};
pub use under_track::BedsAtCount;
pub use vtk::{bodies_vtk, contacts_vtk};

pub use crate::store::{Beds, FoundBed, bed_hash, write_atomically};

use crate::scenario::{Loading, Scenario};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Everything in a run's directory, as data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    pub scenario: Scenario,
    pub summary: Summary,
    pub sleepers: Vec<SleeperRow>,
    pub blocks: Vec<BlockRow>,
    /// Settlement by each law; empty if there is only one.
    pub laws: Vec<LawRow>,
    /// Settlement by the law and in cells of grains; empty if no cells check the law.
    #[serde(default)]
    pub check: Vec<CheckRow>,
    pub rail: Vec<RailRow>,
    /// Passages of each kind of train; empty if there is only one.
    pub trains: Vec<TrainRow>,
    /// Sleepers that were tamped; empty without tamping.
    pub tampings: Vec<TampingRow>,
    pub histories: Vec<HistoryRow>,
    /// Beds of grains under the track at the recorded counts; empty if it stands on something else.
    pub beds: Vec<BedsAtCount>,
    /// Tests of packed beds; a track has none.
    pub tests: Option<BedTests>,
    /// The same on further packings of the grains under the track; empty if there is one.
    pub packings: Vec<Packing>,
}

/// The last axle count that all runs have recorded; `None` if they share none.
pub fn common_count<'a>(runs: impl IntoIterator<Item = &'a Run>) -> Option<u64> {
    let counts = |run: &Run| run.sleepers.iter().map(|row| row.axles).collect::<BTreeSet<u64>>();
    let shared = runs.into_iter().map(counts).reduce(|all, own| all.intersection(&own).copied().collect())?;
    shared.into_iter().next_back()
}

impl Run {
    /// Histories of no train, and of the train that leads the traffic: figures of one passage show the leading train.
    pub fn leading_histories(&self) -> impl Iterator<Item = &HistoryRow> {
        let leading = match &self.scenario.loading {
            Some(Loading::Traffic(traffic)) => traffic.train.name.as_str(),
            _ => "",
        };
        self.histories.iter().filter(move |row| row.train.is_empty() || row.train == leading)
    }
}
