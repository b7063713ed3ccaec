//! Figures along the track: settlement, level, loads and moments, one curve for each recorded axle count.

use super::Figure;
use super::counts::{self, Count};
use super::curves::{Axis, Chart, Mark, Series};
use super::number::{shown_unit, significant, whole};
use super::packings::with_thin_curves;
use super::svg::{Frame, Svg};
use super::view::WIDTH;
use crate::results::{RailRow, Run, SleeperRow};
use crate::scenario::{Loading, Scenario};

const HEIGHT: f64 = 320.0;

/// Permanent downward move of each support.
pub fn settlement(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Settlement", "m", true);
    chart.series = per_seat(run, true, |row| row.settlement_m);
    chart.series.retain(|series| series.points.iter().any(|point| point.1.is_finite() && point.1 != 0.0));
    let caption = "Permanent settlement of each sleeper's support, positive downward. Seats are numbered from the \
         transition (dashed line), with negative numbers on its softer side. Shaded: seats not carried by ballast. \
         Paler near the ends: not every wheel of a train passes these sleepers, so each takes the mean settlement of \
         ten neighbours.";
    figure(&chart, "settlement", "Settlement along the track", &with_thin_curves(run, caption))
}

/// Level of the rail without a vehicle.
pub fn rail_level(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Rail level below as built", "m", true);
    chart.series = counts::shown(run).iter().map(|count| along_rail(run, "rail_level", count)).collect();
    let caption = "Level of the unloaded rail under its own weight, measured downward from the track as built. If the \
                   rail lies above the settled supports, sleepers hang from it.";
    figure(&chart, "rail_level", "Rail level without a vehicle", caption)
}

/// Largest rail seat load of a passage, per seat.
pub fn seat_loads(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Largest rail seat load", "N", false);
    chart.series = per_seat(run, false, |row| row.max_rail_seat_load_N);
    let caption = "Largest force of the rail on each pad during one passage, per seat; compression is positive. The \
                   seat on the stiff edge also carries the load that the hanging sleepers beside it do not carry.";
    figure(&chart, "rail_seat_load", "Rail seat loads along the track", &with_thin_curves(run, caption))
}

/// Contact forces on the ballast under the dead load of the track.
pub fn gravity_contact(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Contact force without a vehicle", "N", false);
    chart.series = per_seat(run, true, |row| row.gravity_contact_force_N);
    let caption = "Force of each half sleeper on its support under dead load alone. A sleeper with zero force hangs \
                   from the rail, and its neighbours carry its weight.";
    let title = "Sleeper\u{2013}ballast contact under dead load";
    figure(&chart, "gravity_contact_force", title, &with_thin_curves(run, caption))
}

/// Rail deflection of a static check.
pub fn rail_displacement(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Rail deflection", "m", true);
    chart.series = vec![along_rail(run, "rail_displacement", &only())];
    figure(&chart, "rail_displacement", "Rail deflection", "Downward deflection of the rail under the static loads.")
}

/// Rail moment of a static check.
pub fn rail_moment(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Rail moment, sagging positive", "N m", true);
    chart.series = vec![along_rail(run, "rail_moment", &only())];
    figure(&chart, "rail_moment", "Rail bending moment", "Bending moment of one rail, drawn on its tension side.")
}

/// Each seat's share of a static check's load.
pub fn seat_shares(run: &Run) -> Option<Figure> {
    let Some(Loading::Static(loads)) = &run.scenario.loading else { return None };
    let total: f64 = loads.iter().map(|load| *load.force).sum();
    let mut chart = track_chart(run, "Share of the load", "1", false);
    chart.y = Axis { unit: "%".into(), size: 0.01, from_zero: true, ..chart.y };
    let rows: Vec<&SleeperRow> = run.sleepers.iter().filter(|row| row.max_rail_seat_load_N.is_finite()).collect();
    if total <= 0.0 || rows.is_empty() {
        return None;
    }
    let gap = rows.windows(2).map(|pair| pair[1].x_m - pair[0].x_m).fold(f64::INFINITY, f64::min);
    let points = rows.iter().map(|row| (row.x_m, row.max_rail_seat_load_N / total)).collect();
    let mut series = Series::new("", "s0", Mark::Bars(0.6 * if gap.is_finite() { gap } else { 0.6 }), points);
    series.labels = rows.iter().map(|row| row.sleeper.clone()).collect();
    chart.series = vec![series];
    let mut shares: Vec<f64> = rows.iter().map(|row| 100.0 * row.max_rail_seat_load_N / total).collect();
    shares.sort_by(|a, b| b.total_cmp(a));
    let largest = shares.iter().take(3).map(|share| significant(*share, 3)).collect::<Vec<_>>().join(", ");
    let caption = format!(
        "Rail seat loads as shares of the total load of {} kN. The largest shares are {largest} %.",
        whole_kn(total)
    );
    figure(&chart, "seat_shares", "Load shares of the seats", &caption)
}

fn whole_kn(force: f64) -> String {
    if force / 1e3 >= 10.0 { whole((force / 1e3).round() as u64) } else { significant(force / 1e3, 3) }
}

/// The colour of a figure with one curve.
fn only() -> Count {
    Count { axles: 0, name: String::new(), class: "s0".to_owned() }
}

/// A chart over the whole track with its sections and transitions.
pub fn track_chart(run: &Run, label: &str, unit: &str, down: bool) -> Chart {
    let track = &run.scenario.track;
    let axis = Axis { downwards: down, from_zero: down, ..Axis::new(label, shown_unit(unit)) };
    let mut chart = Chart::new(Axis::chainage((track.start(), track.end())), axis);
    chart.bands = counts::sections(&run.scenario);
    chart.uprights = track.transitions.iter().map(|transition| transition.x).collect();
    chart.seats = track.seats.iter().map(|seat| (seat.x, seat.number)).collect();
    chart
}

/// One series of `rail.csv` at a count.
pub fn along_profile(run: &Run, count: &Count, value: fn(&RailRow) -> f64) -> Series {
    let rows = run.rail.iter().filter(|row| row.axles == count.axles);
    Series::new(&count.name, &count.class, Mark::Line, rows.map(|row| (row.x_m, value(row))).collect())
}

/// One series for each count over the seats; only ballasted seats for a quantity of the ballast. Seats that not every
/// train passes with every wheel are in a paler series, further packings in thin ones.
fn per_seat(run: &Run, ballasted: bool, value: fn(&SleeperRow) -> f64) -> Vec<Series> {
    let names = ballasted_names(&run.scenario);
    let trains = match &run.scenario.loading {
        Some(Loading::Traffic(traffic)) => traffic.trains().count(),
        _ => 0,
    };
    let of_count = |count: &Count| {
        let rows: Vec<&SleeperRow> = run.sleepers.iter().filter(|row| row.axles == count.axles).collect();
        let whole: Vec<bool> = rows.iter().map(|row| row.trains_passing >= trains).collect();
        let labels: Vec<String> = rows.iter().map(|row| row.sleeper.replace('-', "\u{2212}")).collect();
        // a seat that has no such value, or belongs to the other series, interrupts the curve
        let series = |shown: &dyn Fn(usize) -> bool| {
            let known = |row: &SleeperRow| !ballasted || names.contains(&row.sleeper);
            let point =
                |(i, row): (usize, &&SleeperRow)| (row.x_m, if known(row) && shown(i) { value(row) } else { f64::NAN });
            let points = rows.iter().enumerate().map(point).collect();
            Series { labels: labels.clone(), ..Series::new(&count.name, &count.class, Mark::Dots, points) }
        };
        // the last whole seat begins the paler curve, so that both meet
        let beside = |i: usize| i > 0 && !whole[i - 1] || whole.get(i + 1) == Some(&false);
        let pale = Series { pale: true, name: String::new(), ..series(&|i| !whole[i] || beside(i)) };
        let shown = |row: &&SleeperRow| row.axles == count.axles && (!ballasted || names.contains(&row.sleeper));
        let thin = run.packings.iter().map(|packing| {
            let points = packing.sleepers.iter().filter(shown).map(|row| (row.x_m, value(row))).collect();
            Series::new("", &count.class, Mark::Faint, points)
        });
        [series(&|i| whole[i]), pale].into_iter().chain(thin.collect::<Vec<_>>())
    };
    let all = counts::shown(run).iter().flat_map(of_count).collect::<Vec<Series>>();
    all.into_iter().filter(|series| series.points.iter().any(|point| point.1.is_finite())).collect()
}

/// Names of the seats that a settling support carries.
pub fn ballasted_names(scenario: &Scenario) -> std::collections::HashSet<String> {
    let track = &scenario.track;
    track.seats.iter().filter(|seat| seat.is_ballasted()).map(|seat| track.seat_name(seat)).collect()
}

fn along_rail(run: &Run, quantity: &str, count: &Count) -> Series {
    let rows = run.histories.iter().filter(|h| h.quantity == quantity && h.id == "rail" && h.axles == count.axles);
    let mut points: Vec<(f64, f64)> = rows.map(|h| (h.x_m, h.value)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Series::new(&count.name, &count.class, Mark::Line, points)
}

/// A figure of one chart over the full width; `None` if the chart is empty.
pub fn figure(chart: &Chart, id: &str, title: &str, caption: &str) -> Option<Figure> {
    if chart.is_empty() {
        return None;
    }
    let mut svg = Svg::default();
    chart.draw(&mut svg, &format!("plane-{id}"), Frame { x: 0.0, y: 0.0, width: WIDTH, height: HEIGHT });
    Some(Figure {
        id: id.to_owned(),
        title: title.to_owned(),
        caption: caption.to_owned(),
        svg: svg.finish(WIDTH, HEIGHT, title),
    })
}
