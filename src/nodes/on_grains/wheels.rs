//! The wheel forces of a passage as they run over the rail: chainage and force of each wheel at any time.

use crate::nodes::{Joined, WheelHistories};
use std::ops::Range;

/// Time in which the first forces grow from nothing, s: forces that start at full size before the grains would make the
/// rail vibrate.
const RAMP: f64 = 0.02;

/// Trains that follow each other over the rail, each with the same forces.
pub struct WheelRun<'a> {
    histories: &'a WheelHistories,
    /// Wheels that come together, by their numbers in the train, and the time at which their train begins, s.
    groups: Vec<(Range<usize>, f64)>,
}

impl<'a> WheelRun<'a> {
    /// One train with no other one near it.
    pub fn alone(histories: &'a WheelHistories) -> Self {
        WheelRun { histories, groups: vec![(0..histories.wheels, 0.0)] }
    }

    /// So many trains, each so much later than the one before, s.
    ///
    /// Where other trains run ahead, the run begins with the rear half of the last one of them; where others run
    /// behind, it ends with the front half of its last train. So all runs of a long train together have each wheel
    /// once, and the track comes to rest only where no wheel is near.
    pub fn new(histories: &'a WheelHistories, trains: u64, headway: f64, joined: Joined) -> Self {
        let parting = parting(histories, headway);
        let [front, rear] = [0..parting, parting..histories.wheels];
        let start = |train: u64| train as f64 * headway;
        let mut groups = Vec::new();
        for train in 0..=trains {
            // the rear of the train ahead and the front of the next one are on the track together
            if train > 0 || joined.ahead {
                groups.push((rear.clone(), start(train)));
            }
            if train < trains {
                groups.push((front.clone(), start(train + 1)));
            }
        }
        if joined.behind && trains > 0 {
            groups.pop();
        }
        groups.retain(|(wheels, _)| !wheels.is_empty());
        WheelRun { histories, groups }
    }

    /// Start and end of the time in which a wheel is between two places (m), s; `None` if no wheel ever is.
    pub fn within(&self, [left, right]: [f64; 2]) -> Option<[f64; 2]> {
        let inside = |(wheels, start): &(Range<usize>, f64)| {
            let is_inside = |at: &usize| {
                self.histories.instant(*at)[wheels.clone()].iter().any(|(x, _)| (left..=right).contains(x))
            };
            let first = (0..self.histories.instants()).find(is_inside)?;
            let last = (0..self.histories.instants()).rfind(is_inside)?;
            Some([first, last].map(|at| start + at as f64 * self.histories.interval))
        };
        self.groups.iter().filter_map(inside).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// When the first wheels have passed, s.
    pub fn first_ends(&self) -> f64 {
        self.groups[0].1 + self.histories.instants().saturating_sub(1) as f64 * self.histories.interval
    }

    /// Chainage of the leading one of the first wheels at a time (s), m.
    pub fn leading_at(&self, time: f64) -> Option<f64> {
        let (wheels, start) = self.groups.first()?;
        let place = (time - start) / self.histories.interval;
        let instant = (0.0..self.histories.instants() as f64).contains(&place).then_some(place as usize)?;
        self.histories.instant(instant)[wheels.clone()].first().map(|(x, _)| *x)
    }

    /// Chainage (m) and force (N) of every wheel at a time (s), into `out`, which is emptied first; straight between
    /// two instants. The first forces grow from the time `begin` on.
    pub fn loads_at(&self, time: f64, begin: f64, out: &mut Vec<(f64, f64)>) {
        out.clear();
        for (wheels, start) in &self.groups {
            let place = (time - start) / self.histories.interval;
            if !(0.0..=(self.histories.instants().saturating_sub(1)) as f64).contains(&place) {
                continue;
            }
            let first = (place.floor() as usize).min(self.histories.instants().saturating_sub(2));
            let share = place - first as f64;
            let [now, next] = [first, first + 1].map(|at| &self.histories.instant(at)[wheels.clone()]);
            let pair = now.iter().zip(next);
            // a train that begins later stands on the rail at once too
            let grown = ((time - begin.max(*start)) / RAMP).clamp(0.0, 1.0);
            out.extend(pair.map(|((x0, f0), (x1, f1))| (x0 + share * (x1 - x0), grown * (f0 + share * (f1 - f0)))));
        }
    }
}

/// Number of wheels in the front half of a train: those before its longest stretch without a wheel, m. All of them,
/// where the stretch to the next train, so much later (s), is longer.
fn parting(histories: &WheelHistories, headway: f64) -> usize {
    let Some(instant) = (histories.instants() > 0).then(|| histories.instant(0)) else { return histories.wheels };
    let gap = |pair: &[(f64, f64)]| (pair[0].0 - pair[1].0).abs();
    let to_next = headway * histories.speed - (instant[0].0 - instant[instant.len() - 1].0).abs();
    let longest = instant.windows(2).map(gap).enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
    match longest {
        Some((before, gap)) if gap > to_next => before + 1,
        _ => histories.wheels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wagon of 8 m with axles at 0, 2, 6 and 8 m behind its front wheel, at 10 m/s; each force is the number of the
    /// wheel.
    fn wagon() -> WheelHistories {
        let instant = |at: usize| {
            let front = -10.0 + 0.1 * at as f64;
            [0.0, 2.0, 6.0, 8.0].into_iter().zip(1..).map(move |(behind, number)| (front - behind, f64::from(number)))
        };
        WheelHistories { interval: 0.01, speed: 10.0, wheels: 4, values: (0..400).flat_map(instant).collect() }
    }

    /// Numbers of the wheels that pass the place 0, in the order in which they come.
    fn passing(run: &WheelRun<'_>) -> Vec<u32> {
        let mut seen: Vec<(f64, u32)> = Vec::new();
        for (wheels, start) in &run.groups {
            for wheel in wheels.clone() {
                let at = (0..run.histories.instants()).find(|at| run.histories.instant(*at)[wheel].0 >= 0.0).unwrap();
                seen.push((start + 0.01 * at as f64, wheel as u32 + 1));
            }
        }
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        seen.into_iter().map(|(_, number)| number).collect()
    }

    #[test]
    fn runs_of_a_long_train_have_each_wheel_once() {
        let histories = wagon();
        let run = |trains, ahead, behind| passing(&WheelRun::new(&histories, trains, 1.0, Joined { ahead, behind }));
        assert_eq!(run(2, false, false), [1, 2, 3, 4, 1, 2, 3, 4]);
        assert_eq!(run(2, false, true), [1, 2, 3, 4, 1, 2], "it ends between the bogies of the last wagon");
        assert_eq!(run(1, true, true), [3, 4, 1, 2]);
        assert_eq!(run(1, true, false), [3, 4, 1, 2, 3, 4]);
    }

    #[test]
    fn trains_far_apart_are_not_parted() {
        let histories = wagon();
        let all = WheelRun::new(&histories, 2, 5.0, Joined { ahead: true, behind: true });
        assert_eq!(passing(&all), [1, 2, 3, 4, 1, 2, 3, 4]);
    }

    #[test]
    fn a_run_lasts_from_its_first_wheel_to_its_last() {
        let histories = wagon();
        let lasts = |joined| {
            let [begin, end] = WheelRun::new(&histories, 1, 1.0, joined).within([-1.0, 1.0]).unwrap();
            end - begin
        };
        assert!((lasts(Joined::default()) - 1.0).abs() < 0.02, "8 m of wheels and 2 m of track");
        // the rear bogie, and the front bogie 4 m behind it: from 6 m to 12 m
        let both = Joined { ahead: true, behind: true };
        assert!((lasts(both) - 0.8).abs() < 0.02, "{}", lasts(both));
    }
}
