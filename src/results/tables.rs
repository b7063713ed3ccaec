//! The rows of a run's tables: one struct a file, one field a column. Values are SI.

use crate::graph::UNEVEN;
use crate::nodes::Bonds;
use crate::units::number;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

/// A row of a small table that is kept as CSV.
pub trait Row: Serialize + DeserializeOwned {
    /// Name of the table's file.
    const FILE: &'static str;
    /// Its columns, in the order of the struct's fields.
    const COLUMNS: &'static [&'static str];
}

/// One seat at one recorded axle count (`sleepers.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)] // the names are the file's columns
pub struct SleeperRow {
    pub axles: u64,
    pub sleeper: String,
    pub x_m: f64,
    /// Initial settlement of the scene plus the settlement by traffic.
    pub settlement_m: f64,
    pub void_m: f64,
    pub gravity_contact_force_N: f64,
    pub max_contact_force_N: f64,
    pub max_rail_seat_load_N: f64,
    pub max_sleeper_displacement_m: f64,
    /// Stiffness of support and under sleeper pad in series.
    pub support_stiffness_N_per_m: f64,
    pub contact_loss_s: f64,
    /// Number of train types that pass this seat with every wheel. Wheels start and stop near the ends of the track.
    /// For a train type that does not pass with every wheel, forces, displacement and contact loss are the means of the
    /// nearest ten seats of the section that this type passes. A seat that no type passes is left out of the extremes
    /// of the summary.
    pub trains_passing: usize,
}

impl SleeperRow {
    /// The rows that count in extremes: seats that a train passes with every wheel. All rows count if there is no such
    /// seat, for example on a track shorter than the trains, or in a static check.
    pub fn that_count<'a>(rows: impl Iterator<Item = &'a SleeperRow>) -> Vec<&'a SleeperRow> {
        let all: Vec<&SleeperRow> = rows.collect();
        let whole: Vec<&SleeperRow> = all.iter().copied().filter(|row| row.trains_passing > 0).collect();
        if whole.is_empty() { all } else { whole }
    }
}

impl Row for SleeperRow {
    const FILE: &'static str = "sleepers.csv";
    const COLUMNS: &'static [&'static str] = &[
        "axles",
        "sleeper",
        "x_m",
        "settlement_m",
        "void_m",
        "gravity_contact_force_N",
        "max_contact_force_N",
        "max_rail_seat_load_N",
        "max_sleeper_displacement_m",
        "support_stiffness_N_per_m",
        "contact_loss_s",
        "trains_passing",
    ];
}

/// One place on the rail at one recorded axle count (`rail.csv`). There are four places in each bay that wheels pass,
/// one of them over a seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct RailRow {
    pub axles: u64,
    pub x_m: f64,
    /// Unloaded, below the level as built.
    pub level_m: f64,
    /// Unloaded, sagging.
    pub moment_N_m: f64,
    /// The train's mean wheel load at rest here, divided by the deflection that it adds.
    pub stiffness_N_per_m: f64,
    /// During the passage, sagging; linear between the nodes of the mesh.
    pub max_moment_N_m: f64,
    pub min_moment_N_m: f64,
    /// During the passage, downward from the unloaded state; linear between the nodes of the mesh.
    pub max_displacement_m: f64,
    pub min_displacement_m: f64,
}

impl Row for RailRow {
    const FILE: &'static str = "rail.csv";
    const COLUMNS: &'static [&'static str] = &[
        "axles",
        "x_m",
        "level_m",
        "moment_N_m",
        "stiffness_N_per_m",
        "max_moment_N_m",
        "min_moment_N_m",
        "max_displacement_m",
        "min_displacement_m",
    ];
}

/// One kind of train at one recorded axle count (`trains.csv`): extremes of its passage over the track as it lies then.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct TrainRow {
    pub axles: u64,
    pub train: String,
    /// Trains of its kind that have passed.
    pub passed: u64,
    /// Static force of a wheel of its heaviest vehicle; 0 without gravity.
    pub static_wheel_load_N: f64,
    pub max_wheel_force_N: f64,
    pub min_wheel_force_N: f64,
    pub max_rail_seat_load_N: f64,
    pub max_contact_force_N: f64,
    pub max_rail_moment_N_m: f64,
    /// Largest ratio of a wheel's force to its static force, and the largest unloading of a wheel as a share of its
    /// static force; 0 without gravity.
    pub dynamic_amplification: f64,
    pub wheel_unloading: f64,
}

impl Row for TrainRow {
    const FILE: &'static str = "trains.csv";
    const COLUMNS: &'static [&'static str] = &[
        "axles",
        "train",
        "passed",
        "static_wheel_load_N",
        "max_wheel_force_N",
        "min_wheel_force_N",
        "max_rail_seat_load_N",
        "max_contact_force_N",
        "max_rail_moment_N_m",
        "dynamic_amplification",
        "wheel_unloading",
    ];
}

/// One sleeper that is tamped (`tamping.csv`, where there is tamping).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct TampingRow {
    pub axles: u64,
    pub sleeper: String,
    pub x_m: f64,
    pub settlement_before_m: f64,
    pub settlement_after_m: f64,
}

impl Row for TampingRow {
    const FILE: &'static str = "tamping.csv";
    const COLUMNS: &'static [&'static str] = &["axles", "sleeper", "x_m", "settlement_before_m", "settlement_after_m"];
}

/// One block of the iteration (`blocks.csv`): a passage computed at `axles`, and the axles that it represents.
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
    /// Estimated error of settlement that the block adds at the worst seat; 0 for a block of one train, which has none.
    pub error_m: f64,
    /// Factor by which a disturbance comes back with the opposite sign: the exchange overshoots above 1 and grows above
    /// 2. 0 if the track moved too evenly to measure it.
    pub overshoot: f64,
    /// Sawtooth amplitude of the block's settlement along the track, as a share of `max_settlement_step_m`.
    pub sawtooth: f64,
    /// Largest settlement of the block at a sleeper beside the mean of its two neighbours, as a share of the largest
    /// displacement of the rail under the train: from about 1 the sleeper has lost or gained its load within the block.
    /// 0 for a block of one train, and for adaptive blocks, whose forces follow the settlement.
    #[serde(default)]
    pub unevenness: f64,
    /// Longer blocks that were tried and rejected, and the number of rejected blocks that overshot.
    pub rejected: u64,
    pub overshot: u64,
    /// All passages computed for the block, and their work.
    pub passages: u64,
    pub time_steps: u64,
    pub newton_iterations: u64,
    /// Bonds of glued grains after the block: those that hold, and those that have broken since the grains were glued.
    #[serde(default)]
    pub bonds: u64,
    #[serde(default)]
    pub broken_bonds: u64,
}

/// Above this amplitude a sawtooth is larger than unequal sleeper loads can cause.
const SAWTOOTH: f64 = 0.1;

impl BlockRow {
    /// Bonds of glued grains after the block.
    pub fn bonds(&self) -> Bonds {
        Bonds { intact: self.bonds, broken: self.broken_bonds }
    }

    /// Overshooting in the exchanges of a run, in a sentence; `None` if there is none.
    pub fn overshoot(blocks: &[BlockRow]) -> Option<String> {
        let cured: Vec<&BlockRow> = blocks.iter().filter(|b| b.overshot > 0).collect();
        let worst = blocks.iter().max_by(|a, b| a.sawtooth.total_cmp(&b.sawtooth)).filter(|b| b.sawtooth > SAWTOOTH);
        let sawtooth = worst.map(|b| {
            format!(
                "settlement alternates from sleeper to sleeper by {} % of its largest step after {} axles",
                (b.sawtooth * 100.0).round(),
                b.axles
            )
        });
        let shortest = cured.iter().map(|b| b.block_axles).min();
        let cured = shortest.map(|shortest| {
            let tried: u64 = cured.iter().map(|b| b.overshot).sum();
            format!("{tried} blocks overshot and were repeated with half the length, down to {shortest} axles")
        });
        let uneven = blocks.iter().max_by(|a, b| a.unevenness.total_cmp(&b.unevenness));
        let uneven = uneven.filter(|b| b.unevenness > UNEVEN).map(|b| {
            format!(
                "in the {} axles after {} axles a sleeper settled beside its neighbours by {} times the displacement of \
                 the rail under a train, so its load changed within this block, and the block had the load of its start",
                b.block_axles,
                b.axles,
                number((10.0 * b.unevenness).round() / 10.0)
            )
        });
        let said: Vec<String> = cured.into_iter().chain(sawtooth).chain(uneven).collect();
        (!said.is_empty()).then(|| said.join("; "))
    }
}

impl Row for BlockRow {
    const FILE: &'static str = "blocks.csv";
    const COLUMNS: &'static [&'static str] = &[
        "axles",
        "block_axles",
        "max_wheel_force_N",
        "min_wheel_force_N",
        "max_rail_seat_load_N",
        "max_contact_force_N",
        "max_settlement_m",
        "max_settlement_step_m",
        "error_m",
        "overshoot",
        "sawtooth",
        "unevenness",
        "rejected",
        "overshot",
        "passages",
        "time_steps",
        "newton_iterations",
        "bonds",
        "broken_bonds",
    ];
}

/// One value of a history (`histories.parquet`), in long format. Fields along the track that belong to no moment of
/// a passage (`rail_level`, all of a static check) have `time_s` 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HistoryRow {
    pub axles: u64,
    pub time_s: f64,
    /// A [`crate::scenario::response::Response`] name.
    pub quantity: SmolStr,
    /// Seat name, wheel (`wheel 1` leads) or `rail`.
    pub id: SmolStr,
    /// Chainage, m: of the seat, of the wheel at that moment, or of the place on the rail.
    pub x_m: f64,
    pub value: f64,
    /// Name of the train; empty without a train, for example for settlement.
    pub train: SmolStr,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    #[test]
    fn a_sleeper_that_settles_beside_its_neighbours_is_told() {
        let mut blocks = example::transition().blocks;
        assert_eq!(BlockRow::overshoot(&blocks), None);
        (blocks[3].unevenness, blocks[4].unevenness) = (3.26, 0.7);
        let said = BlockRow::overshoot(&blocks).unwrap();
        assert!(
            said.starts_with("in the 20 axles after 60 axles a sleeper settled beside its neighbours by 3.3 times"),
            "{said}"
        );
    }
}
