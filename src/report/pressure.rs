//! Pressure of the sleepers on the ballast along the track, against the usual limit.

use super::along::track_chart;
use super::curves::{Mark, Series};
use super::panels::{Names, panels};
use super::{Figure, counts, limits};
use crate::results::{Run, contact_pressures};

pub fn contact_pressure(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Largest sleeper pressure", "Pa", false);
    for count in counts::shown(run) {
        let rows = run.sleepers.iter().filter(|row| row.axles == count.axles);
        let points = contact_pressures(&run.scenario.track, rows);
        chart.series.push(Series::new(&count.name, &count.class, Mark::Dots, points));
    }
    if chart.is_empty() {
        return None;
    }
    let limit = limits::CONTACT_PRESSURE;
    let highest = chart.series.iter().flat_map(|s| &s.points).map(|point| point.1).fold(0.0, f64::max);
    chart.y.from_zero = true;
    if highest > 0.1 * limit {
        chart.bands.iter_mut().for_each(|band| band.label.clear()); // the limit's name stands there
        chart.levels = vec![(limit, "500 kPa, concrete sleepers (UIC, unchecked)".to_owned())];
    }
    let caption = "Largest force of each half sleeper on its support during one passage, divided by half the sleeper's \
                   bearing area. This is the mean pressure used in design rules, not the peak under single stones.";
    panels(&Names { id: "contact_pressure", title: "Sleeper pressure on the ballast", caption }, &[(chart, 300.0)], 1)
}
