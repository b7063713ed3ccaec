//! Runs in one figure: results along the track at the last axle count that all runs have recorded, and against the
//! axles.

use super::coloured;
use crate::compare::Comparison;
use crate::report::Figure;
use crate::report::along::{ballasted_names, figure, track_chart};
use crate::report::curves::{Axis, Chart, Mark, Series};
use crate::report::number::{shown_unit, whole};
use crate::results::common_count;
use crate::results::{RailRow, Run, SleeperRow};

/// The quantity of each seat that a figure shows.
struct OfSeats {
    id: &'static str,
    title: &'static str,
    label: &'static str,
    unit: &'static str,
    /// Larger values stand lower.
    down: bool,
    ballasted: bool,
    value: fn(&SleeperRow) -> f64,
}

const OF_SEATS: [OfSeats; 4] = [
    OfSeats {
        id: "settlement",
        title: "Settlement along the track",
        label: "Settlement",
        unit: "m",
        down: true,
        ballasted: true,
        value: |row| row.settlement_m,
    },
    OfSeats {
        id: "void",
        title: "Voids under the sleepers",
        label: "Void",
        unit: "m",
        down: true,
        ballasted: true,
        value: |row| row.void_m,
    },
    OfSeats {
        id: "rail_seat_load",
        title: "Rail seat loads",
        label: "Largest rail seat load",
        unit: "N",
        down: false,
        ballasted: false,
        value: |row| row.max_rail_seat_load_N,
    },
    OfSeats {
        id: "gravity_contact_force",
        title: "Contact without a vehicle",
        label: "Contact force without a vehicle",
        unit: "N",
        down: false,
        ballasted: true,
        value: |row| row.gravity_contact_force_N,
    },
];

/// The figures of runs; none if they share no axle count.
pub(super) fn figures(comparison: &Comparison) -> Vec<Figure> {
    let runs = || comparison.subjects.iter().filter_map(|subject| subject.run());
    let Some(axles) = common_count(runs()) else { return Vec::new() };
    let mut figures: Vec<Figure> = OF_SEATS.iter().filter_map(|what| of_seats(comparison, axles, what)).collect();
    figures.extend(of_rail(
        comparison,
        axles,
        ("rail_level", "Rail level without a vehicle", "Rail level below as built", "m", true),
        |row| row.level_m,
    ));
    figures.extend(of_rail(
        comparison,
        axles,
        ("rail_stiffness", "Track stiffness at rail level", "Static stiffness at rail level", "N/m", false),
        |row| row.stiffness_N_per_m,
    ));
    figures.extend(with_axles(comparison));
    figures
}

/// A chart over all tracks, with the sections of the first.
fn chart(comparison: &Comparison, label: &str, unit: &str, down: bool) -> Option<Chart> {
    let runs: Vec<&Run> = comparison.subjects.iter().filter_map(|subject| subject.run()).collect();
    let mut chart = track_chart(runs.first()?, label, unit, down);
    let ends = runs.iter().map(|run| (run.scenario.track.start(), run.scenario.track.end()));
    let range = ends.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)));
    chart.x.range = range;
    chart.bands.iter_mut().for_each(|band| band.label.clear());
    Some(chart)
}

fn of_seats(comparison: &Comparison, axles: u64, what: &OfSeats) -> Option<Figure> {
    let mut chart = chart(comparison, what.label, what.unit, what.down)?;
    for (subject, class) in coloured(comparison) {
        let Some(run) = subject.run() else { continue };
        chart.series.extend(seats_of(run, axles, (&subject.name, &class), what));
    }
    let caption =
        format!("{} Sections and transition (dashed line) are those of the first run.", said(axles, comparison));
    figure(&chart, what.id, what.title, &caption)
}

/// `After 500 axles.`, and the meaning of thin curves.
fn said(axles: u64, comparison: &Comparison) -> String {
    let thin = comparison.subjects.iter().filter_map(|subject| subject.run()).any(|run| !run.packings.is_empty());
    let thin = if thin { " Thin curves: further packings of the same grains." } else { "" };
    format!("After {} axles.{thin}", whole(axles))
}

/// The curve of a run, and thin ones of its further packings.
fn seats_of(run: &Run, axles: u64, (name, class): (&str, &str), what: &OfSeats) -> Vec<Series> {
    let names = ballasted_names(&run.scenario);
    let points = |rows: &[SleeperRow]| -> Vec<(f64, f64)> {
        let shown = |row: &&SleeperRow| row.axles == axles && (!what.ballasted || names.contains(&row.sleeper));
        rows.iter().filter(shown).map(|row| (row.x_m, (what.value)(row))).collect()
    };
    let thin = run.packings.iter().map(|packing| Series::new("", class, Mark::Faint, points(&packing.sleepers)));
    std::iter::once(Series::new(name, class, Mark::Dots, points(&run.sleepers))).chain(thin).collect()
}

fn of_rail(
    comparison: &Comparison,
    axles: u64,
    (id, title, label, unit, down): (&str, &str, &str, &str, bool),
    value: fn(&RailRow) -> f64,
) -> Option<Figure> {
    let mut chart = chart(comparison, label, unit, down)?;
    for (subject, class) in coloured(comparison) {
        let rows = subject.run()?.rail.iter().filter(|row| row.axles == axles);
        let points = rows.map(|row| (row.x_m, value(row))).collect();
        chart.series.push(Series::new(&subject.name, &class, Mark::Line, points));
    }
    let caption = format!("After {} axles.", whole(axles));
    figure(&chart, id, title, &caption)
}

/// Largest settlement of each run against the axles.
fn with_axles(comparison: &Comparison) -> Option<Figure> {
    let y = Axis { downwards: true, from_zero: true, ..Axis::new("Largest settlement", shown_unit("m")) };
    let mut chart = Chart::new(Axis::new("Axles", ("", 1.0)), y);
    for (subject, class) in coloured(comparison) {
        let run = subject.run()?;
        let mut points: Vec<(f64, f64)> = vec![];
        for block in run.blocks.iter().filter(|block| block.block_axles > 0) {
            points.push(((block.axles + block.block_axles) as f64, block.max_settlement_m));
        }
        chart.series.push(Series::new(&subject.name, &class, Mark::Dots, points));
    }
    let caption = "Settlement of the sleeper that has settled most, after each exchange of forces and settlement.";
    figure(&chart, "settlement_with_axles", "Settlement with the axles", caption)
}
