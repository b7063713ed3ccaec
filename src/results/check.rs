//! Settlement by the law of a run beside the settlement of cells of grains under the same forces: the table
//! `check.csv`, and how far both part.

use super::{Row, Scalar};
use crate::nodes::Checked;
use crate::scenario::{Scenario, Track};
use crate::units::{number, percent};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Settlement that trains have added at one sleeper after a block: by the law, and in its cell of grains
/// (`check.csv`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckRow {
    pub axles: u64,
    pub sleeper: String,
    pub x_m: f64,
    pub law_m: f64,
    pub cell_m: f64,
    /// Standard error of the cell from the trains that it left out.
    pub cell_error_m: f64,
}

impl Row for CheckRow {
    const FILE: &'static str = "check.csv";
    const COLUMNS: &'static [&'static str] = &["axles", "sleeper", "x_m", "law_m", "cell_m", "cell_error_m"];
}

/// The rows after a block: `settled` (m) by the law, and the cells of the same seats.
pub(super) fn check_rows(
    track: &Track,
    axles: u64,
    seats: &[usize],
    (settled, cells): (&[f64], &[Checked]),
) -> Vec<CheckRow> {
    let row = |((seat, law), cell): ((&usize, &f64), &Checked)| CheckRow {
        axles,
        sleeper: track.seat_name(&track.seats[*seat]),
        x_m: track.seats[*seat].x,
        law_m: *law,
        cell_m: cell.settled,
        cell_error_m: cell.error,
    };
    seats.iter().zip(settled).zip(cells).map(row).collect()
}

/// How far the rows of a block part beyond the error of the cells, as a share of their largest settlement, if this is
/// above a limit.
pub(super) fn parted_by(rows: &[CheckRow], limit: f64) -> Option<f64> {
    let largest = rows.iter().map(|row| row.cell_m.abs()).fold(0.0, f64::max);
    let beyond = |row: &CheckRow| (row.law_m - row.cell_m).abs() - row.cell_error_m;
    let share = rows.iter().map(beyond).fold(0.0, f64::max) / largest;
    (largest > 0.0 && share > limit).then_some(share)
}

/// How far a law and the cells that check it part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parting<'a> {
    /// The row with the largest difference.
    pub row: &'a CheckRow,
    /// The largest difference / largest settlement of a cell.
    pub share: f64,
    /// The error that the laws of the scene state at most, if each of them states one.
    pub stated: Option<f64>,
}

impl<'a> Parting<'a> {
    /// The largest difference after any block; `None` without a check, and where no cell has settled.
    pub fn of_rows(scenario: &Scenario, rows: &'a [CheckRow]) -> Option<Parting<'a>> {
        let largest = rows.iter().map(|row| row.cell_m.abs()).fold(0.0, f64::max);
        let difference = |row: &CheckRow| (row.law_m - row.cell_m).abs();
        let row = rows.iter().max_by(|a, b| difference(a).total_cmp(&difference(b)))?;
        let laws = scenario.driving_laws();
        let stated = laws.iter().map(|law| law.error).collect::<Option<Vec<f64>>>();
        let stated = stated.filter(|all| !all.is_empty()).map(|all| all.into_iter().fold(0.0, f64::max));
        (largest > 0.0).then(|| Parting { row, share: difference(row) / largest, stated })
    }

    /// Whether the difference exceeds the error that the laws state.
    pub fn exceeds(&self) -> bool {
        self.stated.is_some_and(|stated| self.share > stated)
    }

    /// One sentence: where they part, and by how much.
    pub fn sentence(&self) -> String {
        let mm = |length: f64| number((length * 1e6).round() / 1e3);
        let CheckRow { axles, sleeper, law_m, cell_m, .. } = self.row;
        let stated = match self.stated {
            Some(stated) if self.exceeds() => format!(", more than the {} that the law states", percent(stated)),
            Some(stated) => format!(", within the {} that the law states", percent(stated)),
            None => String::new(),
        };
        format!(
            "law and grains differ by at most {} of the largest settlement{stated}: after {axles} axles sleeper \
             {sleeper} has settled {} mm by the law and {} mm in its cell of grains",
            percent(self.share),
            mm(*law_m),
            mm(*cell_m)
        )
    }

    /// What helps where the difference exceeds the stated error.
    pub fn help(&self) -> &'static str {
        "fit the law again with more trains (`trackbed calibrate FILE --grains --trains N`), or write `substructure = \
         cells`"
    }
}

/// `check_difference`: the largest difference of a law and the cells that check it / largest settlement of a cell.
pub(super) fn summarise_check(scenario: &Scenario, rows: &[CheckRow]) -> BTreeMap<String, Scalar> {
    let parting = Parting::of_rows(scenario, rows);
    parting.map(|it| ("check_difference".to_owned(), Scalar::new(it.share, "1"))).into_iter().collect()
}
