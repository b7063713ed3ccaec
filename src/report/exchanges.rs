//! Settlement of named sleepers with the axles, every exchange of forces and settlement marked (paper, Fig. 20).

use super::Figure;
use super::along::ballasted_names;
use super::curves::{Axis, Chart, Mark, Series};
use super::number::shown_unit;
use super::packings::with_thin_curves;
use super::panels::{Names, panels};
use crate::results::{Run, SleeperRow};

/// Curves that a reader can tell apart.
const MOST: usize = 4;
/// Smallest ratio of the last count to the first for which a logarithmic scale is drawn.
const DECADES: f64 = 20.0;
/// Distance from every transition at which the far field begins, m.
const FAR_FIELD: f64 = 10.0;

pub fn settlement_with_axles(run: &Run) -> Option<Figure> {
    let y = Axis { downwards: true, from_zero: true, ..Axis::new("Settlement", shown_unit("m")) };
    let mut chart = Chart::new(Axis::new("Axles", ("", 1.0)), y);
    for (index, (row, why)) in telling_seats(run).into_iter().enumerate() {
        let name = format!("{}{why}", row.sleeper.replace('-', "\u{2212}"));
        let class = format!("s{index}");
        chart.series.push(Series::new(&name, &class, Mark::Dots, of_sleeper(run, &row.sleeper)));
        chart.series.extend(run.packings.iter().map(|packing| {
            let rows = packing.sleepers.iter().filter(|other| other.sleeper == row.sleeper);
            let points = rows.map(|row| (row.axles as f64, row.settlement_m)).collect();
            Series::new("", &class, Mark::Faint, points)
        }));
    }
    chart.uprights = run.tampings.iter().map(|row| row.axles as f64).collect();
    chart.uprights.dedup();
    if chart.series.iter().all(|series| series.points.len() < 2) {
        return None;
    }
    let counts: Vec<f64> = chart.series.iter().flat_map(|s| &s.points).map(|p| p.0).filter(|n| *n > 0.0).collect();
    let first = counts.iter().copied().fold(f64::INFINITY, f64::min);
    let last = counts.iter().copied().fold(0.0, f64::max);
    let mut charts = vec![(chart.clone(), 300.0)];
    let mut caption =
        "Settlement against the axles passed. Each symbol is an exchange of forces and settlement between track and \
                       supports. Sleepers are numbered from the transition, with negative numbers on its softer side."
            .to_owned();
    if !chart.uprights.is_empty() {
        caption += " Dashed lines: tamping of sleepers.";
    }
    if last / first >= DECADES {
        let mut logarithmic = chart;
        logarithmic.x = Axis { logarithmic: true, range: Some((first, last)), ..logarithmic.x };
        for series in &mut logarithmic.series {
            series.points.retain(|point| point.0 > 0.0);
        }
        charts.push((logarithmic, 300.0));
        caption += " Right: the same with a logarithmic scale of axles. A straight line means that settlement grows by \
                    the same amount each time the number of axles grows tenfold.";
    }
    let caption = with_thin_curves(run, &caption);
    let columns = charts.len();
    let names = Names { id: "settlement_with_axles", title: "Settlement with the axles", caption: &caption };
    panels(&names, &charts, columns)
}

/// Axles and settlement of a sleeper, of every block and every recorded count.
fn of_sleeper(run: &Run, sleeper: &str) -> Vec<(f64, f64)> {
    let blocks = run.histories.iter().filter(|h| h.quantity == "settlement" && h.id == sleeper);
    let mut points: Vec<(f64, f64)> = blocks.map(|h| (h.axles as f64, h.value)).collect();
    let counts = run.sleepers.iter().filter(|other| other.sleeper == sleeper);
    let counts = counts.map(|other| (other.axles as f64, other.settlement_m));
    let further: Vec<(f64, f64)> = counts.filter(|(axles, _)| points.iter().all(|point| point.0 != *axles)).collect();
    points.extend(further);
    // a count at which a sleeper is tamped has two: before and after
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// Rows of the last count: the sleeper that settled most, the one nearest to a transition, one of the far field, and
/// further sleepers that the scene records.
fn telling_seats(run: &Run) -> Vec<(&SleeperRow, &'static str)> {
    let names = ballasted_names(&run.scenario);
    let last = run.sleepers.iter().map(|row| row.axles).max();
    let rows: Vec<&SleeperRow> = run
        .sleepers
        .iter()
        .filter(|row| Some(row.axles) == last && names.contains(&row.sleeper) && row.settlement_m.is_finite())
        .collect();
    let distance = |row: &&&SleeperRow| {
        let distances = run.scenario.track.transitions.iter().map(|t| (t.x - row.x_m).abs());
        distances.fold(f64::INFINITY, f64::min)
    };
    let far_field = run.summary.scalars.get("far_field_settlement").map_or(0.0, |s| s.value);
    let track = &run.scenario.track;
    let recorded =
        run.scenario.records.iter().flat_map(|record| &record.seats).filter_map(|seat| track.seats.get(*seat));
    let recorded: Vec<String> = recorded.map(|seat| track.seat_name(seat)).collect();
    // The far-field one: a recorded one or else the one that is nearest to the far-field settlement.
    let mut farther: Vec<&&SleeperRow> = rows.iter().collect();
    farther.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    let far = farther.iter().filter(|row| distance(row) > FAR_FIELD).count();
    farther.truncate(if far > 0 { far } else { rows.len().div_ceil(2) });
    let off = |row: &&&SleeperRow| (!recorded.contains(&row.sleeper), (row.settlement_m - far_field).abs());
    let nearer = |a: &&&SleeperRow, b: &&&SleeperRow| {
        let ((a, a_off), (b, b_off)) = (off(a), off(b));
        a.cmp(&b).then(a_off.total_cmp(&b_off))
    };
    let chosen = [
        (rows.iter().max_by(|a, b| a.settlement_m.total_cmp(&b.settlement_m)), ", largest"),
        (rows.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))), ", nearest"),
        (farther.into_iter().min_by(nearer), ", far field"),
    ];
    let further = recorded.iter().map(|name| (rows.iter().find(|row| row.sleeper == *name), ""));
    let mut seats: Vec<(&SleeperRow, &str)> = Vec::new();
    for (row, why) in chosen.into_iter().chain(further) {
        let Some(row) = row else { continue };
        if seats.len() < MOST && !seats.iter().any(|(other, _)| other.sleeper == row.sleeper) {
            seats.push((row, why));
        }
    }
    seats
}
