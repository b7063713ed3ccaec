//! The time of a passage as a seat sees it: zero when the leading wheel stands over it, so that seats can be compared.

use super::counts::Count;
use super::curves::{Axis, Band, Chart, Mark, Series};
use super::number::shown_unit;
use crate::results::{HistoryRow, Run};
use crate::scenario::Loading;
use crate::scenario::response::Response;

/// Distance that the leading wheel is shown before a seat and the last wheel behind it, m.
const BEFORE: f64 = 9.0;
/// Most of a train that is shown: about one vehicle, m.
const MOST: f64 = 22.0;

/// When the leading wheel stands over x at a count, s; before its first and after its last sample it keeps its speed there.
fn arrival(run: &Run, axles: u64, x: f64) -> Option<f64> {
    let leads = |h: &&HistoryRow| h.quantity == "wheel_force" && h.id == "wheel 1" && h.axles == axles;
    let path: Vec<(f64, f64)> = run.leading_histories().filter(leads).map(|h| (h.time_s, h.x_m)).collect();
    let forward = path.last()?.1 > path.first()?.1;
    let after = path.partition_point(|(_, place)| if forward { *place < x } else { *place > x });
    let right = after.clamp(1, path.len().checked_sub(1).filter(|last| *last > 0)?);
    let [(t0, x0), (t1, x1)] = [path[right - 1], path[right]];
    let arrival = t0 + (x - x0) * (t1 - t0) / (x1 - x0);
    arrival.is_finite().then_some(arrival)
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
    named_history(run, quantity.name(), seat, axles)
}

/// The same of a quantity and a part of the track by the names that they have in files.
pub fn named_history(run: &Run, quantity: &str, id: &str, axles: u64) -> Vec<(f64, f64)> {
    let rows = run.leading_histories().filter(|h| h.quantity == quantity && h.id == id && h.axles == axles);
    let mut rows = rows.peekable();
    let Some(x) = rows.peek().map(|row| row.x_m) else { return vec![] };
    let zero = arrival(run, axles, x).unwrap_or(0.0);
    rows.map(|row| (row.time_s - zero, row.value)).collect()
}

/// When the seat's sleeper has no contact with its support at a count.
pub fn lost(run: &Run, seat: &str, axles: u64) -> Vec<Band> {
    unloaded(&history(run, Response::ContactForce, seat, axles))
}

/// When a force is not above zero.
pub fn unloaded(samples: &[(f64, f64)]) -> Vec<Band> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    #[test]
    fn a_train_that_slows_down_arrives_when_it_does() {
        let mut run = example::transition();
        for sign in [1.0, -1.0] {
            let row = |time_s: f64| HistoryRow {
                axles: 0,
                time_s,
                quantity: "wheel_force".into(),
                id: "wheel 1".into(),
                x_m: sign * (20.0 * time_s - 4.0 * time_s * time_s),
                value: 1e5,
                train: String::new(),
            };
            run.histories = (0..=10).map(|i| row(0.1 * f64::from(i))).collect();
            for time in [0.1, 0.35, 0.8] {
                let found = arrival(&run, 0, row(time).x_m).unwrap();
                assert!((found - time).abs() < 1e-3, "{time} {found}");
            }
            // the speed of the first and of the last tenth goes on
            assert!((arrival(&run, 0, -sign * 1.96).unwrap() + 0.1).abs() < 1e-9);
            assert!((arrival(&run, 0, sign * 17.24).unwrap() - 1.1).abs() < 1e-9);
        }
        assert_eq!(arrival(&run, 7, 0.0), None);
    }
}
