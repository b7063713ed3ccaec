//! Sleepers and the ballast below them in the passage over the grains: velocity and acceleration, shaded while the
//! sleeper has no contact (paper, Figs. 17 and 18).

use super::counts::{self, Count};
use super::curves::{Axis, Chart, Mark, Series};
use super::number::shown_unit;
use super::panels::{Names, panels, share_scale};
use super::seat_clock::{Passages, shown, unloaded, window};
use super::{Figure, over_axles};
use crate::graph::InVolume;
use crate::results::Run;

const HEIGHT: f64 = 215.0;
/// Volumes side by side.
const MOST: usize = 2;

/// Quantities with their titles and SI units; all are drawn downward.
const SHOWN: [(InVolume, &str, &str); 5] = [
    (InVolume::SleeperVelocity, "sleeper velocity", "m/s"),
    (InVolume::SleeperAcceleration, "sleeper acceleration", "m/s^2"),
    (InVolume::BallastVelocity, "ballast velocity", "m/s"),
    (InVolume::BallastAcceleration, "ballast acceleration", "m/s^2"),
    (InVolume::BallastStress, "ballast stress", "Pa"),
];

pub fn ballast_response(run: &Run) -> Option<Figure> {
    let chosen = chosen(run);
    let (counts, passages) = (recorded(run), Passages::new(run));
    let mut charts: Vec<(Chart, f64)> = Vec::new();
    for (quantity, title, unit) in SHOWN {
        let chart = |volume: &String| chart((run, &passages), quantity, (volume, title, unit), &counts);
        let mut row: Vec<Chart> = chosen.iter().map(chart).collect();
        if row.iter().any(|chart| !chart.is_empty()) {
            share_scale(row.iter_mut(), HEIGHT - 70.0);
            charts.extend(row.into_iter().map(|chart| (chart, HEIGHT)));
        }
    }
    let last = counts.last().map_or(String::new(), |count| over_axles::named(count.axles));
    let others = volumes(run).len() - chosen.len();
    let rest = if others > 0 { " Other volumes are in histories.parquet." } else { "" };
    let caption = format!(
        "3D model: the sleeper, and the mean over the grains in the measurement volume below it, while the leading \
         train passes over the grains. Shaded: the sleeper has no contact with the grains, {last}. Velocity and \
         acceleration are positive downward. The acceleration of the ballast is the change of its mean velocity \
         between two samples. Time is zero when the leading wheel stands over the sleeper. The legend gives the number \
         of axles that have passed.{rest}"
    );
    let names = Names { id: "ballast_response", title: "Sleepers and ballast in the 3D model", caption: &caption };
    panels(&names, &charts, chosen.len())
}

/// Volumes with a history, left to right: their names, and places in m.
fn volumes(run: &Run) -> Vec<(String, f64)> {
    let of_volume = |h: &&crate::results::HistoryRow| h.quantity == InVolume::SleeperForce.name();
    let mut volumes: Vec<(&str, f64)> =
        run.histories.iter().filter(of_volume).map(|h| (h.id.as_str(), h.x_m)).collect();
    volumes.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(b.0)));
    volumes.dedup();
    volumes.into_iter().map(|(name, x)| (name.to_owned(), x)).collect()
}

/// The volume nearest to a transition and the one farthest from all.
fn chosen(run: &Run) -> Vec<String> {
    let mut volumes = volumes(run);
    let away = |x: f64| run.scenario.track.transitions.iter().map(|t| (t.x - x).abs()).fold(f64::INFINITY, f64::min);
    volumes.sort_by(|a, b| away(a.1).total_cmp(&away(b.1)));
    if volumes.len() > MOST {
        volumes = [volumes.swap_remove(0), volumes.remove(volumes.len() - 1)].into();
    }
    volumes.into_iter().map(|(name, _)| name).collect()
}

/// The counts at which volumes were recorded, in the colours of the page.
fn recorded(run: &Run) -> Vec<Count> {
    let of_volume =
        |axles: u64| run.histories.iter().any(|h| h.axles == axles && h.quantity == InVolume::SleeperForce.name());
    counts::shown(run).into_iter().filter(|count| of_volume(count.axles)).collect()
}

fn chart(
    (run, passages): (&Run, &Passages<'_>),
    quantity: InVolume,
    (volume, title, unit): (&str, &str, &str),
    counts: &[Count],
) -> Chart {
    let downwards = quantity != InVolume::BallastStress;
    let name = format!("{}: {title}", shown(volume));
    let y = Axis { downwards, ..Axis::new(&name, shown_unit(unit)) };
    let x = Axis { range: Some(window(run)), ..Axis::new("Time after the leading wheel", ("s", 1.0)) };
    let mut chart = Chart::new(x, y);
    for count in counts {
        let points = passages.history(quantity.name(), volume, count.axles);
        if !points.is_empty() {
            chart.series.push(Series::new(count.short(), &count.class, Mark::Line, points));
        }
    }
    if let Some(last) = counts.last() {
        chart.bands = unloaded(&passages.history(InVolume::SleeperForce.name(), volume, last.axles));
    }
    chart
}
