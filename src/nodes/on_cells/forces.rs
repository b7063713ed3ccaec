//! Forces of a train on the sleepers of a cell at equal intervals, for one train among others or one train alone.

use crate::nodes::SeatForces;
use serde::Serialize;

/// A train alone begins and ends so long before and after its forces differ from those at rest, s.
const MARGIN: f64 = 0.02;
/// Smallest difference from the force at rest that counts, as a share of the largest force.
const DIFFERS: f64 = 0.02;

/// Forces on the sleepers of a cell while one train passes; the next one may follow at once.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrainForces {
    /// Time between two values, s.
    pub interval: f64,
    /// Force of each sleeper, N; the first value and the one after the last are those between two trains.
    pub sleepers: Vec<Vec<f64>>,
}

impl TrainForces {
    /// The forces at these seats. Trains that follow each other every `headway` (s) each add their force beyond the
    /// force at rest; this is exact for a track that never lifts. The train begins when the force on the sleeper
    /// `middle` is smallest.
    pub fn new(forces: &SeatForces, seats: &[usize], middle: usize, headway: Option<f64>) -> Option<TrainForces> {
        let histories: Vec<&[f64]> =
            seats.iter().map(|seat| forces.seats.get(*seat).map(Vec::as_slice)).collect::<Option<_>>()?;
        if histories.iter().any(|history| history.len() < 2) {
            return None;
        }
        let sleepers = match headway {
            Some(headway) => close(&histories, middle, (headway / forces.interval).round().max(1.0) as usize),
            None => alone(&histories, (MARGIN / forces.interval).ceil() as usize),
        };
        // a headway is not a whole number of intervals: the interval of the values is scaled to fit
        let interval = headway.map_or(forces.interval, |headway| headway / sleepers[0].len() as f64);
        Some(TrainForces { interval, sleepers })
    }

    /// Largest force on the sleeper in the middle over that between two trains, N.
    pub fn load(&self, middle: usize) -> f64 {
        let forces = &self.sleepers[middle];
        forces.iter().fold(0.0, |most: f64, force| most.max(*force)) - forces[0]
    }

    /// How long a train takes, s.
    pub fn time(&self) -> f64 {
        self.interval * self.sleepers[0].len() as f64
    }
}

fn alone(histories: &[&[f64]], margin: usize) -> Vec<Vec<f64>> {
    let differs = |history: &&[f64]| {
        let rest = history[0];
        let most = history.iter().fold(0.0, |most: f64, force| most.max((force - rest).abs()));
        let differ = |force: &&f64| (**force - rest).abs() > DIFFERS * most;
        let first = history.iter().position(|force| differ(&force))?;
        Some([first, history.iter().rposition(|force| differ(&force))?])
    };
    let spans = histories.iter().filter_map(differs);
    let [first, last] = spans.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or([0, 1]);
    let span = |history: &&[f64]| history[first.saturating_sub(margin)..(last + margin).min(history.len())].to_vec();
    histories.iter().map(span).collect()
}

fn close(histories: &[&[f64]], middle: usize, period: usize) -> Vec<Vec<f64>> {
    let folded = |history: &&[f64]| {
        let rest = history[0];
        let mut sum = vec![rest; period];
        history.iter().enumerate().for_each(|(at, force)| sum[at % period] += force - rest);
        sum.into_iter().map(|force| force.max(0.0)).collect()
    };
    let mut sums: Vec<Vec<f64>> = histories.iter().map(folded).collect();
    let least = sums[middle].iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(at, _)| at);
    sums.iter_mut().for_each(|sum| sum.rotate_left(least));
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forces(seats: Vec<Vec<f64>>) -> SeatForces {
        SeatForces { interval: 0.01, seats }
    }

    #[test]
    fn a_train_alone_is_cut_to_where_it_acts_on_any_sleeper() {
        let mut seats = vec![vec![2.0; 50], vec![2.0; 50]];
        seats[0][20] = 12.0;
        seats[1][23] = 12.0;
        let train = TrainForces::new(&forces(seats), &[0, 1], 0, None).unwrap();
        assert_eq!(train.sleepers[0].len(), 7, "two intervals before the first wheel, and behind the last one");
        assert_eq!((train.sleepers[0][2], train.sleepers[1][5]), (12.0, 12.0));
    }

    #[test]
    fn trains_that_follow_closely_add_what_each_brings() {
        let history: Vec<f64> = (0..30).map(|at| if (10..14).contains(&at) { 12.0 } else { 2.0 }).collect();
        let train = TrainForces::new(&forces(vec![history]), &[0], 0, Some(0.02)).unwrap();
        assert_eq!(train.sleepers[0], vec![22.0, 22.0], "each instant sees two of the four");
        assert!((train.time() - 0.02).abs() < 1e-12);
    }

    #[test]
    fn a_train_among_others_begins_where_the_sleeper_bears_least() {
        let mut history = vec![5.0; 40];
        (history[11], history[13]) = (9.0, 1.0);
        let train = TrainForces::new(&forces(vec![history]), &[0], 0, Some(0.1)).unwrap();
        assert_eq!(train.sleepers[0][0], 1.0);
        assert_eq!(train.sleepers[0][8], 9.0);
        assert!((train.time() - 0.1).abs() < 1e-12);
    }

    #[test]
    fn seats_without_forces_make_no_train() {
        assert_eq!(TrainForces::new(&forces(vec![vec![]]), &[0], 0, None), None);
    }
}
