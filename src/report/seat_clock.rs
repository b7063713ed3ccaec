//! The time of a passage at a seat: zero when the leading wheel stands over the seat, so that seats can be compared.

use super::counts::Count;
use super::curves::{Axis, Band, Chart, Mark, Series};
use super::number::shown_unit;
use crate::results::{HistoryRow, Run};
use crate::scenario::Loading;
use crate::scenario::response::Response;
use std::collections::HashMap;

/// Distance that the leading wheel is shown before a seat and the last wheel behind it, m.
const BEFORE: f64 = 9.0;
/// Most of a train that is shown: about one vehicle, m.
const MOST: f64 = 22.0;

/// Histories of the leading train by quantity, part of the track and count: gathered once for all panels of a figure.
pub struct Passages<'a> {
    run: &'a Run,
    rows: HashMap<&'a str, HashMap<&'a str, HashMap<u64, Vec<&'a HistoryRow>>>>,
}

impl<'a> Passages<'a> {
    pub fn new(run: &'a Run) -> Self {
        let mut rows: HashMap<&str, HashMap<&str, HashMap<u64, Vec<&HistoryRow>>>> = HashMap::new();
        for row in run.leading_histories() {
            let of_part = rows.entry(&row.quantity).or_default().entry(&row.id).or_default();
            of_part.entry(row.axles).or_default().push(row);
        }
        Passages { run, rows }
    }

    fn rows(&self, quantity: &str, id: &str, axles: u64) -> &[&HistoryRow] {
        let of_part = self.rows.get(quantity).and_then(|parts| parts.get(id));
        of_part.and_then(|counts| counts.get(&axles)).map_or(&[], Vec::as_slice)
    }

    /// A history of a part of the track at a count, over the time of the place. Part and quantity have their names in
    /// files. Empty if there is none.
    pub fn history(&self, quantity: &str, id: &str, axles: u64) -> Vec<(f64, f64)> {
        let rows = self.rows(quantity, id, axles);
        let Some(x) = rows.first().map(|row| row.x_m) else { return vec![] };
        let zero = arrival(self.rows("wheel_force", "wheel 1", axles), x).unwrap_or(0.0);
        rows.iter().map(|row| (row.time_s - zero, row.value)).collect()
    }

    /// A chart of one quantity at one seat, one curve a count, shaded while the seat's sleeper has no contact with its
    /// support at the last one.
    pub fn panel(&self, quantity: Response, seat: &str, title: &str, counts: &[Count]) -> Chart {
        let mut y = Axis::new(title, shown_unit(quantity.unit()));
        y.downwards = is_downward(quantity);
        let x = Axis { range: Some(window(self.run)), ..Axis::new("Time after the leading wheel", ("s", 1.0)) };
        let mut chart = Chart::new(x, y);
        for count in counts {
            let points = self.history(quantity.name(), seat, count.axles);
            if !points.is_empty() {
                chart.series.push(Series::new(count.short(), &count.class, Mark::Line, points));
            }
        }
        if let Some(last) = counts.last() {
            chart.bands = unloaded(&self.history(Response::ContactForce.name(), seat, last.axles));
        }
        chart
    }
}

/// When the leading wheel stands over x, s, by its own history; before its first and after its last sample it keeps its
/// speed there.
fn arrival(wheel: &[&HistoryRow], x: f64) -> Option<f64> {
    let path: Vec<(f64, f64)> = wheel.iter().map(|h| (h.time_s, h.x_m)).collect();
    let forward = path.last()?.1 > path.first()?.1;
    let after = path.partition_point(|(_, place)| if forward { *place < x } else { *place > x });
    let right = after.clamp(1, path.len().checked_sub(1).filter(|last| *last > 0)?);
    let [(t0, x0), (t1, x1)] = [path[right - 1], path[right]];
    let arrival = t0 + (x - x0) * (t1 - t0) / (x1 - x0);
    arrival.is_finite().then_some(arrival)
}

/// The time that panels show, s: the leading vehicle, or a part of it.
pub fn window(run: &Run) -> (f64, f64) {
    let Some(Loading::Traffic(traffic)) = &run.scenario.loading else { return (0.0, 1.0) };
    let train = &traffic.train;
    let base = train.vehicles.first().map_or(0.0, |vehicle| vehicle.wheel_offsets()[3]).min(MOST);
    (-BEFORE / *train.speed, (base + BEFORE) / *train.speed)
}

/// Times at which a force is not above zero.
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
    seats.dedup();
    seats.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(b.0)));
    seats.dedup();
    seats.into_iter().map(|(name, x)| (name.to_owned(), x)).collect()
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
                train: Default::default(),
            };
            run.histories = (0..=10).map(|i| row(0.1 * f64::from(i))).collect();
            let passages = Passages::new(&run);
            let arrival = |x: f64| arrival(passages.rows("wheel_force", "wheel 1", 0), x);
            for time in [0.1, 0.35, 0.8] {
                let found = arrival(row(time).x_m).unwrap();
                assert!((found - time).abs() < 1e-3, "{time} {found}");
            }
            // the speed of the first and of the last tenth goes on
            assert!((arrival(-sign * 1.96).unwrap() + 0.1).abs() < 1e-9);
            assert!((arrival(sign * 17.24).unwrap() - 1.1).abs() < 1e-9);
        }
        assert_eq!(arrival(&[], 0.0), None);
    }
}
