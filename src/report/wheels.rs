//! Wheel-rail force of each wheel against the place where it stands (paper, Fig. 9).

use super::Figure;
use super::along::track_chart;
use super::counts;
use super::curves::{Chart, Mark, Series};
use super::number::significant;
use super::panels::{Names, panels, share_scale};
use crate::results::{Run, static_wheel_load};
use crate::scenario::Loading;
use crate::scenario::Track;

const HEIGHT: f64 = 250.0;
/// Wheels that get a panel: those of the leading vehicle.
const WHEELS: usize = 4;
/// Half the length that is shown, m: the ripple of single sleepers must be visible.
const CLOSE: f64 = 15.0;

/// The range near the first transition, if the track is longer.
fn close_up(track: &Track) -> Option<(f64, f64)> {
    let x = track.transitions.first()?.x;
    let (left, right) = ((x - CLOSE).max(track.start()), (x + CLOSE).min(track.end()));
    (right - left < track.end() - track.start()).then_some((left, right))
}

pub fn wheel_force(run: &Run) -> Option<Figure> {
    let counts = counts::shown(run);
    let load = match &run.scenario.loading {
        Some(Loading::Traffic(traffic)) => static_wheel_load(&run.scenario, &traffic.train),
        _ => None,
    };
    let close = close_up(&run.scenario.track);
    let mut charts: Vec<Chart> = Vec::new();
    for wheel in 1..=WHEELS {
        let id = format!("wheel {wheel}");
        let name = if wheel == 1 { "Wheel 1, leading".to_owned() } else { format!("Wheel {wheel}") };
        let mut chart = track_chart(run, &name, "N", false);
        chart.x.range = close.or(chart.x.range);
        for count in &counts {
            let rows = run.leading_histories().filter(|h| h.quantity == "wheel_force" && h.id == id);
            let points: Vec<(f64, f64)> = rows.filter(|h| h.axles == count.axles).map(|h| (h.x_m, h.value)).collect();
            if !points.is_empty() {
                chart.series.push(Series::new(count.short(), &count.class, Mark::Line, points));
            }
        }
        if let Some(load) = load {
            chart.levels = vec![(load, String::new())];
        }
        if !chart.is_empty() {
            charts.push(chart);
        }
    }
    share_scale(charts.iter_mut(), HEIGHT - 90.0);
    let load = load.map_or(String::new(), |f| format!(", {} kN", significant(f / 1e3, 3)));
    let place = if close.is_some() { " around the first transition" } else { "" };
    let caption = format!(
        "Force of each wheel of the leading vehicle on one rail, at the place of the wheel{place}. Dotted: static \
         load{load}. The legend gives the number of axles that have passed. The ripple comes from the sleepers: the \
         track is stiffer over a sleeper than between sleepers. All panels have one scale."
    );
    let charts: Vec<(Chart, f64)> = charts.into_iter().map(|chart| (chart, HEIGHT)).collect();
    panels(&Names { id: "wheel_force", title: "Wheel\u{2013}rail forces", caption: &caption }, &charts, 2)
}
