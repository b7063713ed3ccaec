//! The scalars of `summary.json`, from the tables. Every extreme is taken after the last axle count.

use super::evaluate::subgrade_pressures;
use super::steps::{LONG_BASE, largest_change, settlement_steps};
use super::{BlockRow, LongitudinalLevel, RailRow, Scalar, SleeperRow, TrainRow, longitudinal_level};
use crate::graph::SupportNode;
use crate::nodes::Bonds;
use crate::scenario::{Loading, Scenario, Seat, Train, Vehicle};
use std::collections::{BTreeMap, HashMap};

/// A gap below this is round-off, not a void, m.
pub const VOID_THRESHOLD: f64 = 1e-6;

/// Largest responses along the rail after the last axle count, which no table holds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RailMaxima {
    /// Sagging moment, N m.
    pub moment: Option<f64>,
    /// Downward displacement from the unloaded state, m.
    pub displacement: Option<f64>,
    /// Tension in the foot, Pa.
    pub foot_stress: Option<f64>,
    /// Largest change of the unloaded level between two wheels of a bogie, and over 3 m, m.
    pub change_wheelbase: Option<f64>,
    pub change_3m: Option<f64>,
    /// Longitudinal level D1, largest from its mean and standard deviation, m: of the rail without a vehicle, and under
    /// a standing wheel.
    pub level: Option<(f64, f64)>,
    pub loaded_level: Option<(f64, f64)>,
}

impl RailMaxima {
    /// Scalars of the rail profile after the last axle count, over the places that count.
    pub fn from_profile(scenario: &Scenario, rail: &[RailRow], counts: impl Fn(f64) -> bool) -> Self {
        let last = rail.iter().map(|row| row.axles).max();
        let rows: Vec<&RailRow> = rail.iter().filter(|row| Some(row.axles) == last && counts(row.x_m)).collect();
        let unloaded: Vec<(f64, f64)> = rows.iter().map(|row| (row.x_m, row.level_m)).collect();
        let change = |base: f64| largest_change(&unloaded, base);
        let level =
            |points: Vec<(f64, f64)>| longitudinal_level(&points).map(|l: LongitudinalLevel| (l.peak, l.deviation));
        RailMaxima {
            change_wheelbase: wheelset_spacing(scenario).and_then(change),
            change_3m: change(LONG_BASE),
            level: level(unloaded.clone()),
            loaded_level: level(loaded_level(scenario, rows.iter().copied())),
            ..RailMaxima::default()
        }
    }
}

/// A scalar by name, where it exists, with its unit.
type Entry = (String, Option<f64>, &'static str);

fn entry(name: &str, value: Option<f64>, unit: &'static str) -> Entry {
    (name.to_owned(), value, unit)
}

/// Computes the scalars that the tables allow; quantities that the scene does not have are left out.
pub fn summarise(
    scenario: &Scenario,
    supports: &[SupportNode],
    sleepers: &[SleeperRow],
    blocks: &[BlockRow],
    trains: &[TrainRow],
    rail: RailMaxima,
) -> BTreeMap<String, Scalar> {
    let axles = last_count(sleepers, blocks);
    let last = SleeperRow::that_count(sleepers.iter().filter(|row| row.axles == axles));
    let on_seats = [
        entry("axles", Some(axles as f64), "1"),
        entry("max_rail_seat_load", largest(last.iter().map(|row| row.max_rail_seat_load_N)), "N"),
    ];
    let entries = on_seats
        .into_iter()
        .chain(of_rail(rail))
        .chain(of_ballast(scenario, supports, &last))
        .chain(of_steps(scenario, sleepers, blocks))
        .chain(of_blocks(blocks, trains));
    entries.filter_map(|(name, value, unit)| Some((name, Scalar::new(value?, unit)))).collect()
}

fn of_rail(rail: RailMaxima) -> Vec<Entry> {
    vec![
        entry("max_rail_moment", rail.moment, "N m"),
        entry("max_rail_displacement", rail.displacement, "m"),
        entry("max_rail_foot_stress", rail.foot_stress, "Pa"),
        entry("level_change_wheelbase", rail.change_wheelbase, "m"),
        entry("level_change_3m", rail.change_3m, "m"),
        entry("longitudinal_level_d1", rail.level.map(|l| l.0), "m"),
        entry("longitudinal_level_d1_deviation", rail.level.map(|l| l.1), "m"),
        entry("loaded_longitudinal_level_d1", rail.loaded_level.map(|l| l.0), "m"),
        entry("loaded_longitudinal_level_d1_deviation", rail.loaded_level.map(|l| l.1), "m"),
    ]
}

/// Scalars of the supports of ballasted sleepers.
fn of_ballast(scenario: &Scenario, supports: &[SupportNode], last: &[&SleeperRow]) -> Vec<Entry> {
    let ballasted = ballasted(scenario, last);
    if ballasted.is_empty() {
        return Vec::new();
    }
    let dip = ballasted.iter().map(|(_, row)| *row).max_by(|a, b| a.settlement_m.total_cmp(&b.settlement_m));
    let far_field = far_field(scenario, &ballasted);
    let deepest = dip.map(|row| row.settlement_m);
    let voided = ballasted.iter().filter(|(_, row)| row.void_m > VOID_THRESHOLD).count();
    let pressure =
        |(seat, row): &(&Seat, &SleeperRow)| Some(row.max_contact_force_N / scenario.track.bearing_area(seat)?);
    let forces = ballasted.iter().map(|(_, row)| (row.axles, row.sleeper.as_str(), row.x_m, row.max_contact_force_N));
    let deeper = subgrade_pressures(&scenario.track, supports, forces);
    vec![
        entry("max_settlement", deepest, "m"),
        entry("max_settlement_x", dip.map(|row| row.x_m), "m"),
        entry("far_field_settlement", far_field, "m"),
        entry("differential_settlement", deepest.zip(far_field).map(|(deepest, far)| deepest - far), "m"),
        entry("max_void", largest(ballasted.iter().map(|(_, row)| row.void_m)), "m"),
        entry("voided_sleepers", Some(voided as f64), "1"),
        entry("max_contact_force", largest(ballasted.iter().map(|(_, row)| row.max_contact_force_N)), "N"),
        entry("max_contact_pressure", largest(ballasted.iter().filter_map(pressure)), "Pa"),
        entry("max_subgrade_pressure", largest(deeper.into_iter().map(|(_, pressure)| pressure)), "Pa"),
    ]
}

/// The step at each transition that traffic has made: the largest, and each under the name of its transition. A
/// structure at an end of the model counts, although no train runs over all of it.
fn of_steps(scenario: &Scenario, sleepers: &[SleeperRow], blocks: &[BlockRow]) -> Vec<Entry> {
    if blocks.is_empty() {
        return Vec::new();
    }
    let axles = last_count(sleepers, blocks);
    let last = sleepers.iter().filter(|row| row.axles == axles);
    let settlements: Vec<(f64, f64)> = last.map(|row| (row.x_m, row.settlement_m)).collect();
    let steps = settlement_steps(&scenario.track, &settlements);
    let largest_step = steps.iter().map(|(_, step)| *step).max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let named = steps.iter().filter(|(name, _)| !name.is_empty());
    let named = named.map(|(name, step)| entry(&format!("settlement_step_{name}"), Some(*step), "m"));
    std::iter::once(entry("settlement_step", largest_step, "m")).chain(named).collect()
}

/// Scalars of the exchanges, and of the wheels after the last exchange.
fn of_blocks(blocks: &[BlockRow], trains: &[TrainRow]) -> Vec<Entry> {
    let Some(block) = blocks.last() else { return Vec::new() };
    let worst = |measure: fn(&TrainRow) -> f64| worst_train(trains, measure).map(measure);
    vec![
        entry("update_error", Some(blocks.iter().map(|b| b.error_m).sum()), "m"),
        entry("max_overshoot", largest(blocks.iter().map(|b| b.overshoot)), "1"),
        entry("max_sawtooth", largest(blocks.iter().map(|b| b.sawtooth)), "1"),
        entry("broken_bonds", broken_bonds(block.bonds()), "1"),
        entry("broken_bonds_share", broken_share(block.bonds()), "1"),
        entry("overshot_blocks", Some(blocks.iter().map(|b| b.overshot).sum::<u64>() as f64), "1"),
        entry("max_wheel_force", Some(block.max_wheel_force_N), "N"),
        entry("min_wheel_force", Some(block.min_wheel_force_N), "N"),
        entry("dynamic_amplification", worst(|row| row.dynamic_amplification), "1"),
        entry("wheel_unloading", worst(|row| row.wheel_unloading), "1"),
    ]
}

/// Bonds of glued grains that have broken; `None` if none were made.
pub(super) fn broken_bonds(bonds: Bonds) -> Option<f64> {
    (bonds.made() > 0).then_some(bonds.broken as f64)
}

/// The same, as a share of all that were made.
pub(super) fn broken_share(bonds: Bonds) -> Option<f64> {
    broken_bonds(bonds).map(|broken| broken / bonds.made() as f64)
}

/// Distance of the wheelsets in a bogie of the leading vehicle, m.
fn wheelset_spacing(scenario: &Scenario) -> Option<f64> {
    let Some(Loading::Traffic(traffic)) = &scenario.loading else { return None };
    traffic.train.vehicles.first().map(|vehicle| vehicle.wheel_offsets()[1])
}

/// The static force of a wheel of the train's heaviest vehicle, N; `None` without gravity.
pub fn static_wheel_load(scenario: &Scenario, train: &Train) -> Option<f64> {
    let loads = train.vehicles.iter().map(|v| v.mass() * *scenario.solve.gravity / Vehicle::AXLES as f64);
    largest(loads).filter(|load| *load > 0.0)
}

/// The row of the last count with the worst train, each compared with its own static load.
pub fn worst_train(trains: &[TrainRow], measure: fn(&TrainRow) -> f64) -> Option<&TrainRow> {
    let last = trains.iter().map(|row| row.axles).max();
    let rows = trains.iter().filter(|row| Some(row.axles) == last && row.static_wheel_load_N > 0.0);
    rows.max_by(|a, b| measure(a).total_cmp(&measure(b)))
}

/// The load under which the stiffness at rail level is taken, N; `None` without traffic or without gravity.
pub fn mean_wheel_load(scenario: &Scenario) -> Option<f64> {
    let Some(Loading::Traffic(traffic)) = &scenario.loading else { return None };
    Some(traffic.train.mean_wheel_mass() * *scenario.solve.gravity).filter(|load| *load > 0.0)
}

/// Chainage and level of the rail under a standing mean wheel, m below the level as built; empty without traffic.
pub fn loaded_level<'a>(scenario: &Scenario, rows: impl Iterator<Item = &'a RailRow>) -> Vec<(f64, f64)> {
    let Some(load) = mean_wheel_load(scenario) else { return vec![] };
    rows.map(|row| (row.x_m, row.level_m + load / row.stiffness_N_per_m)).collect()
}

fn last_count(sleepers: &[SleeperRow], blocks: &[BlockRow]) -> u64 {
    let of_sleepers = sleepers.iter().map(|row| row.axles).max();
    of_sleepers.or(blocks.last().map(|block| block.axles + block.block_axles)).unwrap_or(0)
}

/// The ballasted seats with their rows.
fn ballasted<'a>(scenario: &'a Scenario, rows: &[&'a SleeperRow]) -> Vec<(&'a Seat, &'a SleeperRow)> {
    let track = &scenario.track;
    let by_name: HashMap<&str, &SleeperRow> = rows.iter().map(|row| (row.sleeper.as_str(), *row)).collect();
    let seats = track.seats.iter().filter(|seat| seat.is_ballasted());
    seats.filter_map(|seat| Some((seat, *by_name.get(track.seat_name(seat).as_str())?))).collect()
}

/// Median settlement of the seats far from every transition; of the far half if none is far enough.
fn far_field(scenario: &Scenario, ballasted: &[(&Seat, &SleeperRow)]) -> Option<f64> {
    scenario.track.far_field(ballasted.iter().map(|(seat, row)| (seat.x, row.settlement_m)).collect())
}

pub(super) fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.max_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    #[test]
    fn the_example_has_the_scalars_of_its_making() {
        let run = example::transition();
        let scalars = summarise(&run.scenario, &[], &run.sleepers, &run.blocks, &run.trains, RailMaxima::default());
        let value = |name: &str| scalars[name].value;
        assert_eq!(value("axles"), 500.0);
        assert!((value("far_field_settlement") - 1.2e-3).abs() < 1e-9);
        assert!((value("max_settlement_x") + 3.0).abs() < 1e-9);
        assert!((value("differential_settlement") - (value("max_settlement") - 1.2e-3)).abs() < 1e-9);
        assert!(value("voided_sleepers") >= 3.0);
        assert!((value("dynamic_amplification") - value("max_wheel_force") / 98.1e3).abs() < 0.01);
        assert!(!scalars.contains_key("max_rail_moment"));
    }

    #[test]
    fn a_short_track_takes_its_far_half() {
        let mut run = example::transition();
        run.scenario.track.seats.retain(|seat| seat.x > -2.5);
        let scalars = summarise(&run.scenario, &[], &run.sleepers, &run.blocks, &run.trains, RailMaxima::default());
        // seats at -2.4, -1.8, -1.2 and -0.6: the far half is the first two
        let at = |x: f64| run.sleepers.iter().rfind(|r| (r.x_m - x).abs() < 1e-6).unwrap().settlement_m;
        assert!((scalars["far_field_settlement"].value - (at(-2.4) + at(-1.8)) / 2.0).abs() < 1e-12);
    }
}
