//! The places of the largest differences between runs along the track, at the last axle count that all runs have
//! recorded.

use super::Subject;
use crate::results::{Run, SleeperRow, common_count};
use serde::Serialize;
use std::collections::BTreeSet;

/// Chainages that are one place, m.
const SAME_PLACE: f64 = 0.01;

/// A column of `sleepers.csv`.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    pub name: &'static str,
    /// Its label, its unit, and the size of this unit in SI.
    pub text: &'static str,
    pub unit: &'static str,
    pub size: f64,
    /// Whether seats without ballast have none.
    pub of_ballast: bool,
    pub value: fn(&SleeperRow) -> f64,
}

impl Column {
    /// Columns compared along the track.
    pub const ALL: [Column; 7] = [
        Column::new("settlement_m", ("settlement", "mm", 1e-3), true, |row| row.settlement_m),
        Column::new("void_m", ("void", "mm", 1e-3), true, |row| row.void_m),
        Column::new("gravity_contact_force_N", ("contact without a vehicle", "kN", 1e3), true, |row| {
            row.gravity_contact_force_N
        }),
        Column::new("max_contact_force_N", ("largest contact force", "kN", 1e3), true, |row| row.max_contact_force_N),
        Column::new("max_rail_seat_load_N", ("largest rail seat load", "kN", 1e3), false, |row| {
            row.max_rail_seat_load_N
        }),
        Column::new("max_sleeper_displacement_m", ("largest sleeper displacement", "mm", 1e-3), true, |row| {
            row.max_sleeper_displacement_m
        }),
        Column::new("support_stiffness_N_per_m", ("support stiffness", "MN/m", 1e6), true, |row| {
            row.support_stiffness_N_per_m
        }),
    ];

    const fn new(
        name: &'static str,
        (text, unit, size): (&'static str, &'static str, f64),
        of_ballast: bool,
        value: fn(&SleeperRow) -> f64,
    ) -> Column {
        Column { name, text, unit, size, of_ballast, value }
    }
}

/// The place where a run differs most from the first one in a column, SI.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeatDifference {
    /// The run's number, from 1 for the second directory.
    pub run: usize,
    pub column: &'static str,
    pub axles: u64,
    pub sleeper: String,
    pub x_m: f64,
    pub first: f64,
    pub value: f64,
    pub difference: f64,
    /// Root of the mean square of the differences over the seats of both.
    pub rms: f64,
    pub seats: usize,
}

/// A row for each further run and column. Seats are the same where they lie at one chainage; both must be passed by
/// whole trains.
pub fn seat_differences(subjects: &[Subject]) -> Vec<SeatDifference> {
    let runs: Vec<&Run> = subjects.iter().filter_map(Subject::run).collect();
    let (Some(axles), Some((first, others))) = (common_count(runs.iter().copied()), runs.split_first()) else {
        return Vec::new();
    };
    let of_run = |(index, other): (usize, &&Run)| {
        let columns = Column::ALL.iter().filter_map(|column| largest(column, axles, first, other));
        columns.map(|row| SeatDifference { run: index + 1, ..row }).collect::<Vec<_>>()
    };
    others.iter().enumerate().flat_map(of_run).collect()
}

fn largest(column: &Column, axles: u64, first: &Run, other: &Run) -> Option<SeatDifference> {
    let (before, after) = (seats(column, axles, first), seats(column, axles, other));
    let pair = |row: &&SleeperRow| {
        let same = after.iter().find(|other| (other.x_m - row.x_m).abs() < SAME_PLACE)?;
        Some((row.sleeper.clone(), row.x_m, (column.value)(row), (column.value)(same)))
    };
    let pairs: Vec<(String, f64, f64, f64)> = before.iter().filter_map(pair).collect();
    let by = |pair: &(String, f64, f64, f64)| pair.3 - pair.2;
    let squares: f64 = pairs.iter().map(|pair| by(pair).powi(2)).sum();
    let worst = pairs.iter().max_by(|a, b| by(a).abs().total_cmp(&by(b).abs()))?;
    Some(SeatDifference {
        run: 0,
        column: column.name,
        axles,
        sleeper: worst.0.clone(),
        x_m: worst.1,
        first: worst.2,
        value: worst.3,
        difference: by(worst),
        rms: (squares / pairs.len() as f64).sqrt(),
        seats: pairs.len(),
    })
}

/// The seats that have a column at a count.
fn seats<'a>(column: &Column, axles: u64, run: &'a Run) -> Vec<&'a SleeperRow> {
    let track = &run.scenario.track;
    let ballasted: BTreeSet<String> =
        track.seats.iter().filter(|seat| seat.is_ballasted()).map(|seat| track.seat_name(seat)).collect();
    let has = |row: &&SleeperRow| !column.of_ballast || ballasted.contains(&row.sleeper);
    let rows = run.sleepers.iter().filter(|row| row.axles == axles).filter(has);
    SleeperRow::that_count(rows).into_iter().filter(|row| (column.value)(row).is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    #[test]
    fn the_largest_difference_is_found_at_its_seat() {
        let run = example::transition();
        let last = run.sleepers.iter().map(|row| row.axles).max().unwrap();
        let mut other = run.clone();
        let at = other.sleepers.iter().position(|row| row.axles == last && row.sleeper == "-5").unwrap();
        other.sleepers[at].settlement_m += 1e-3;
        assert_eq!(common_count([&run, &other]), Some(last));
        let found = largest(&Column::ALL[0], last, &run, &other).unwrap();
        assert_eq!((found.sleeper.as_str(), found.axles), ("-5", last));
        assert!((found.difference - 1e-3).abs() < 1e-12);
        assert!((found.rms - 1e-3 / (found.seats as f64).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn seats_that_lie_elsewhere_are_not_the_same() {
        let run = example::transition();
        let last = run.sleepers.iter().map(|row| row.axles).max().unwrap();
        let mut other = run.clone();
        other.sleepers.iter_mut().for_each(|row| row.x_m += 0.3);
        assert_eq!(largest(&Column::ALL[0], last, &run, &other), None);
        other.sleepers.retain(|row| row.axles != last);
        assert!(common_count([&run, &other]).is_some_and(|count| count < last));
    }
}
