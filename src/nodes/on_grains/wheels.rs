//! The wheel forces of a passage as they run over the rail: chainage and force of each wheel at any time.

use crate::nodes::WheelHistories;

/// Time in which the first forces grow from nothing, s: forces that start at full size before the grains would make the
/// rail vibrate.
const RAMP: f64 = 0.02;

/// Trains that follow each other over the rail, each with the same forces.
pub struct WheelRun<'a> {
    histories: &'a WheelHistories,
    /// Time at which each train begins, s.
    starts: Vec<f64>,
}

impl<'a> WheelRun<'a> {
    /// So many trains, each so much later than the one before, s.
    pub fn new(histories: &'a WheelHistories, trains: u64, headway: f64) -> Self {
        WheelRun { histories, starts: (0..trains).map(|train| train as f64 * headway).collect() }
    }

    /// Start and end of the time in which a wheel is between two places (m), s; `None` if no wheel ever is.
    pub fn within(&self, [left, right]: [f64; 2]) -> Option<[f64; 2]> {
        let inside = |instant: &[(f64, f64)]| instant.iter().any(|(x, _)| (left..=right).contains(x));
        let instants: Vec<usize> =
            (0..self.histories.instants()).filter(|at| inside(self.histories.instant(*at))).collect();
        let (first, last) = (*instants.first()?, *instants.last()?);
        let time = |at: usize| at as f64 * self.histories.interval;
        Some([self.starts.first()? + time(first), self.starts.last()? + time(last)])
    }

    /// When the first train has passed, s.
    pub fn first_ends(&self) -> f64 {
        let start = self.starts.first().copied().unwrap_or(0.0);
        start + self.histories.instants().saturating_sub(1) as f64 * self.histories.interval
    }

    /// Chainage of the leading wheel of the first train at a time (s), m.
    pub fn leading_at(&self, time: f64) -> Option<f64> {
        let place = (time - self.starts.first()?) / self.histories.interval;
        let instant = (0.0..self.histories.instants() as f64).contains(&place).then_some(place as usize)?;
        self.histories.instant(instant).first().map(|(x, _)| *x)
    }

    /// Chainage (m) and force (N) of every wheel at a time (s), into `out`, which is emptied first; straight between
    /// two instants. The first forces grow from the time `begin` on.
    pub fn loads_at(&self, time: f64, begin: f64, out: &mut Vec<(f64, f64)>) {
        out.clear();
        for start in &self.starts {
            let place = (time - start) / self.histories.interval;
            if !(0.0..=(self.histories.instants().saturating_sub(1)) as f64).contains(&place) {
                continue;
            }
            let first = (place.floor() as usize).min(self.histories.instants().saturating_sub(2));
            let share = place - first as f64;
            let pair = self.histories.instant(first).iter().zip(self.histories.instant(first + 1));
            // a train that begins later stands on the rail at once too
            let grown = ((time - begin.max(*start)) / RAMP).clamp(0.0, 1.0);
            out.extend(pair.map(|((x0, f0), (x1, f1))| (x0 + share * (x1 - x0), grown * (f0 + share * (f1 - f0)))));
        }
    }
}
