//! Histories of rail and seats while a vehicle passes, at the recorded sleepers (paper, Figs. 13 to 15).

use super::curves::Chart;
use super::panels::{Names, panels, share_scale};
use super::seat_clock::{Passages, seats, shown};
use super::{Figure, counts};
use crate::results::Run;
use crate::scenario::response::Response;

const HEIGHT: f64 = 225.0;

/// Quantities with title and caption of their figure. The motion of sleepers on their supports has its own figure, see
/// `hanging`.
const SHOWN: [(Response, &str, &str); 4] = [
    (
        Response::RailSeatLoad,
        "Rail seat loads during a passage",
        "Force of the rail on each pad, per seat; compression is positive. Below zero the rail lifts the sleeper.",
    ),
    (
        Response::RailDisplacement,
        "Rail displacement during a passage",
        "Displacement of the rail over each seat, measured from the unloaded level at that axle count, positive \
         downward. Earlier settlement is left out, so that the counts can be compared.",
    ),
    (
        Response::RailMoment,
        "Rail moment during a passage",
        "Bending moment of one rail over each seat, drawn on the tension side: sagging is positive and drawn downward. \
         If sleepers hang, the moment is not zero before the vehicle comes.",
    ),
    (
        Response::SleeperDisplacement,
        "Sleeper displacement during a passage",
        "Displacement of each sleeper, measured from the unloaded level at that axle count, positive downward.",
    ),
];

/// One figure for each quantity, one panel for each seat, one curve for each count.
pub fn histories(run: &Run) -> Vec<Figure> {
    let passages = Passages::new(run);
    SHOWN.iter().filter_map(|(quantity, title, what)| history((run, &passages), *quantity, title, what)).collect()
}

fn history((run, passages): (&Run, &Passages<'_>), quantity: Response, title: &str, what: &str) -> Option<Figure> {
    let counts = counts::shown(run);
    let seats = seats(run, quantity);
    let mut charts: Vec<Chart> = seats
        .iter()
        .map(|(seat, _)| passages.panel(quantity, seat, &format!("Seat {}", shown(seat)), &counts))
        .filter(|chart| !chart.is_empty())
        .collect();
    share_scale(charts.iter_mut(), HEIGHT - 70.0);
    let mut caption = format!(
        "{what} Time is zero when the leading wheel stands over the seat. The legend gives the number of axles that \
         have passed. All panels have one scale."
    );
    if charts.iter().any(|chart| !chart.bands.is_empty()) {
        caption += " Shaded: the sleeper has no contact with its support at the last count.";
    }
    let columns = if charts.len() == 1 { 1 } else { 2 };
    let charts: Vec<(Chart, f64)> = charts.into_iter().map(|chart| (chart, HEIGHT)).collect();
    panels(&Names { id: &format!("history_{}", quantity.name()), title, caption: &caption }, &charts, columns)
}
