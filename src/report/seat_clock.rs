//! The time of a passage as a seat sees it: zero when the leading wheel stands over it, so that seats can be compared.

use super::chart::{Axis, Band, Chart, Mark, Series};
use super::counts::Count;
use super::number::shown_unit;
use crate::results::{HistoryRow, Run};
use crate::scenario::Loading;
use crate::scenario::response::Response;

/// Distance that the leading wheel is shown before a seat and the last wheel behind it, m.
const BEFORE: f64 = 9.0;
/// Most of a train that is shown: about one vehicle, m.
const MOST: f64 = 22.0;

/// The leading wheel's place at one count: `x = start + speed t`.
#[derive(Debug, Clone, Copy)]
struct Motion {
    start: f64,
    /// m/s, negative for a train that runs backward.
    speed: f64,
}

impl Motion {
    fn of(run: &Run, axles: u64) -> Option<Motion> {
        let leads = |h: &&HistoryRow| h.quantity == "wheel_force" && h.id == "wheel 1" && h.axles == axles;
        let first = run.histories.iter().find(leads)?;
        let last = run.histories.iter().rfind(leads)?;
        let speed = (last.x_m - first.x_m) / (last.time_s - first.time_s);
        (speed.is_finite() && speed != 0.0).then_some(Motion { start: first.x_m - speed * first.time_s, speed })
    }

    /// When the leading wheel stands over x, s.
    fn arrival(self, x: f64) -> f64 {
        (x - self.start) / self.speed
    }
}

/// The time that panels show, s: the leading vehicle, or as much of it as tells something.
pub fn window(run: &Run) -> (f64, f64) {
    let Some(Loading::Traffic(traffic)) = &run.scenario.loading else { return (0.0, 1.0) };
    let train = &traffic.train;
    let base = train.vehicles.first().map_or(0.0, |vehicle| vehicle.wheel_offsets()[3]).min(MOST);
    (-BEFORE / *train.speed, (base + BEFORE) / *train.speed)
}

/// A history of a seat at a count, over the seat's time; empty where there is none.
pub fn history(run: &Run, quantity: Response, seat: &str, axles: u64) -> Vec<(f64, f64)> {
    let rows = run.histories.iter().filter(|h| h.quantity == quantity.name() && h.id == seat && h.axles == axles);
    let mut rows = rows.peekable();
    let Some(x) = rows.peek().map(|row| row.x_m) else { return vec![] };
    let zero = Motion::of(run, axles).map_or(0.0, |motion| motion.arrival(x));
    rows.map(|row| (row.time_s - zero, row.value)).collect()
}

/// When the seat's sleeper has no contact with its support at a count.
pub fn lost(run: &Run, seat: &str, axles: u64) -> Vec<Band> {
    let samples = history(run, Response::ContactForce, seat, axles);
    let pieces = samples.chunk_by(|a, b| (a.1 <= 0.0) == (b.1 <= 0.0));
    let bands = pieces.filter(|piece| piece[0].1 <= 0.0).map(|piece| Band {
        from: piece[0].0,
        to: piece[piece.len() - 1].0,
        label: String::new(),
        class: "lost",
    });
    bands.collect()
}

/// Seats with a history of a quantity, left to right.
pub fn seats(run: &Run, quantity: Response) -> Vec<(String, f64)> {
    let rows = run.histories.iter().filter(|h| h.quantity == quantity.name() && h.id != "rail" && h.time_s > 0.0);
    let mut seats: Vec<(&str, f64)> = rows.map(|h| (h.id.as_str(), h.x_m)).collect();
    seats.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(b.0)));
    seats.dedup();
    seats.into_iter().map(|(name, x)| (name.to_owned(), x)).collect()
}

/// A chart of one quantity at one seat, one curve a count, shaded while contact is lost at the last one.
pub fn panel(run: &Run, quantity: Response, seat: &str, title: &str, counts: &[Count]) -> Chart {
    let mut y = Axis::new(title, shown_unit(quantity.unit()));
    y.downwards = is_downward(quantity);
    let x = Axis { range: Some(window(run)), ..Axis::new("Time after the leading wheel", ("s", 1.0)) };
    let mut chart = Chart::new(x, y);
    for count in counts {
        let points = history(run, quantity, seat, count.axles);
        if !points.is_empty() {
            chart.series.push(Series::new(count.short(), &count.class, Mark::Line, points));
        }
    }
    if let Some(last) = counts.last() {
        chart.bands = lost(run, seat, last.axles);
    }
    chart
}

/// Quantities that are positive downward, or on the lower side, are drawn downward.
fn is_downward(quantity: Response) -> bool {
    matches!(
        quantity,
        Response::RailDisplacement
            | Response::RailMoment
            | Response::SleeperDisplacement
            | Response::SleeperVelocity
            | Response::SleeperAcceleration
    )
}

/// `-3` with a true minus sign.
pub fn shown(seat: &str) -> String {
    seat.replace('-', "\u{2212}")
}
