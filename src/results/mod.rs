//! What a run leaves behind: tables, histories, a summary with what made it, and the files that hold them.
//!
//! Values are SI; signs and names are those of the language guide.

use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Everything that a run's directory says, as data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    pub scenario: Scenario,
    pub summary: Summary,
    pub sleepers: Vec<SleeperRow>,
    pub blocks: Vec<BlockRow>,
    pub histories: Vec<HistoryRow>,
}

/// `summary.json`: scalars by name, and the provenance of the whole run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    pub scalars: BTreeMap<String, Scalar>,
    pub expectations: Vec<Verdict>,
    pub provenance: Provenance,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    pub value: f64,
    pub unit: String,
}

/// An expectation of the scene and how it came out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    pub text: String,
    pub met: bool,
    /// The operands as computed, in `unit`.
    pub values: Vec<f64>,
    pub unit: String,
}

/// What made a run: enough to make it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    pub program: String,
    pub version: String,
    /// Name of the main file.
    pub file: String,
    /// Text of the main file, and the SHA-256 of all texts and overrides.
    pub source: String,
    pub source_sha256: String,
    pub seed: u64,
    /// The solver graph as `trackbed plan` prints it.
    pub plan: String,
}

/// One seat at one recorded axle count (`sleepers.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)] // the names are the file's columns
pub struct SleeperRow {
    pub axles: u64,
    pub sleeper: String,
    pub x_m: f64,
    pub settlement_m: f64,
    pub void_m: f64,
    pub gravity_contact_force_N: f64,
    pub max_contact_force_N: f64,
    pub max_rail_seat_load_N: f64,
    pub max_sleeper_displacement_m: f64,
    pub support_stiffness_N_per_m: f64,
    pub contact_loss_s: f64,
}

/// One block of the iteration (`blocks.csv`): a passage computed at `axles`, and the axles that it stands for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct BlockRow {
    /// Axles that had passed before the block.
    pub axles: u64,
    /// Axles of the block; 0 for the passage after the last block, computed for the record only.
    pub block_axles: u64,
    pub max_wheel_force_N: f64,
    pub min_wheel_force_N: f64,
    pub max_rail_seat_load_N: f64,
    pub max_contact_force_N: f64,
    /// After the block.
    pub max_settlement_m: f64,
    /// Largest settlement of the block at any sleeper.
    pub max_settlement_step_m: f64,
    pub time_steps: u64,
    pub newton_iterations: u64,
}

/// One value of a history (`histories.parquet`), in long format. Fields along the track that belong to no moment of
/// a passage (`rail_level`, all of a static check) have `time_s` 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HistoryRow {
    pub axles: u64,
    pub time_s: f64,
    /// A [`crate::scenario::response::Response`] name.
    pub quantity: String,
    /// Seat name, wheel (`wheel 1` leads) or `rail`.
    pub id: String,
    /// Chainage, m: of the seat, of the wheel at that moment, or of the place on the rail.
    pub x_m: f64,
    pub value: f64,
}
