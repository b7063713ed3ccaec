//! Longitudinal level D1, as a recording car reports it, of the unloaded rail and under a standing wheel.

use super::Figure;
use super::along::track_chart;
use super::counts::{self, Count};
use super::curves::{Chart, Mark, Series};
use super::limits::{self, LevelLimits};
use super::number::significant;
use super::panels::{Names, panels, share_scale};
use crate::results::{RailRow, Run, loaded_level, longitudinal_level};
use crate::scenario::Loading;

const HEIGHT: f64 = 260.0;
/// A limit is drawn if the curves reach this share of it.
const NEAR: f64 = 0.4;

/// Chainage and level of the rail at one count, m.
type Profile = fn(&Run, &[&RailRow]) -> Vec<(f64, f64)>;

pub fn level_d1(run: &Run) -> Option<Figure> {
    let chart = |label: &str, of: Profile| {
        let mut chart = track_chart(run, label, "m", true);
        chart.series = counts::shown(run).iter().filter_map(|count| filtered(run, count, of)).collect();
        chart
    };
    let unloaded = chart("D1 of the unloaded rail", |_, rows| rows.iter().map(|row| (row.x_m, row.level_m)).collect());
    let loaded = chart("D1 under a standing wheel", |run, rows| loaded_level(&run.scenario, rows.iter().copied()));
    let mut charts = [unloaded, loaded];
    let limits = match &run.scenario.loading {
        Some(Loading::Traffic(traffic)) => limits::longitudinal_level(traffic.line_speed()),
        _ => None,
    };
    let limit = limits.map_or(String::new(), |limits| add_limits(&mut charts, limits));
    share_scale(charts.iter_mut(), HEIGHT - 90.0);
    let caption = format!(
        "Level of the rail after the EN 13848-1 filter for wavelengths of 3 to 25 m, positive downward. The filter is \
         a fourth-order Butterworth band-pass, run forward and backward, so that nothing is shifted. Beyond the range \
         of the wheels the profile continues level for 150 m. Top: without a vehicle. Bottom: under the mean wheel \
         load standing at each place, as a loaded recording car measures it.{limit}"
    );
    let names = Names { id: "longitudinal_level", title: "Longitudinal level, 3 to 25 m (D1)", caption: &caption };
    panels(&names, &charts.map(|chart| (chart, HEIGHT)), 1)
}

fn filtered(run: &Run, count: &Count, of: Profile) -> Option<Series> {
    let rows: Vec<&RailRow> = run.rail.iter().filter(|row| row.axles == count.axles).collect();
    let level = longitudinal_level(&of(run, &rows))?;
    Some(Series::new(&count.name, &count.class, Mark::Line, level.points))
}

/// Draws the limits that the curves come near to, and returns all limits as text.
fn add_limits(charts: &mut [Chart; 2], limits: LevelLimits) -> String {
    let peaks = charts.iter().flat_map(|chart| &chart.series).flat_map(|series| &series.points);
    let peak = peaks.map(|point| point.1.abs()).fold(0.0, f64::max);
    let mm = |value: f64| significant(value * 1e3, 2);
    let all =
        [(limits.alert.0, "alert"), (limits.intervention.0, "intervention"), (limits.immediate, "immediate action")];
    for (limit, name) in all.into_iter().filter(|(limit, _)| peak > NEAR * limit) {
        for chart in charts.iter_mut() {
            for sign in [1.0, -1.0] {
                let name = if sign > 0.0 { format!("{name}, {} mm", mm(limit)) } else { String::new() };
                chart.levels.push((sign * limit, name));
            }
        }
    }
    format!(
        " EN 13848-5 at this speed (unchecked): alert from {} to {} mm, intervention from {} to {} mm, immediate \
         action {} mm. Limits far above the curves are not drawn.",
        mm(limits.alert.0),
        mm(limits.alert.1),
        mm(limits.intervention.0),
        mm(limits.intervention.1),
        mm(limits.immediate)
    )
}
