//! Forces of a train on the sleepers of a cell at equal intervals, for one train among others or one train alone.

use crate::nodes::SeatForces;
use serde::Serialize;

/// A train alone begins and ends so long before and after its forces differ from those at rest, s.
const MARGIN: f64 = 0.02;
/// Smallest difference from the force at rest that counts, as a share of the largest force.
const DIFFERS: f64 = 0.02;
/// Share of the largest force that a train adds, up to which a force is small.
const SMALL: f64 = 0.25;
/// Share of the largest force of a train that both of its halves reach.
const HALF: f64 = 0.5;

/// Forces on the sleepers of a cell while one train passes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrainForces {
    /// Time between two values, s.
    pub interval: f64,
    /// Force of each sleeper from the beginning to the end, N.
    pub sleepers: Vec<Vec<f64>>,
}

/// Forces of trains that follow each other: of one train among others, and of the halves of the first and the last
/// train, which have no other train ahead or behind.
#[derive(Debug, Clone, PartialEq)]
pub struct Following {
    pub among: TrainForces,
    pub first: TrainForces,
    /// `None` if the last train ends where the next one would begin.
    pub last: Option<TrainForces>,
}

impl TrainForces {
    /// The forces at these seats of one train: of a train among others that follow each other every `headway` (s), or
    /// of a train alone.
    pub fn new(forces: &SeatForces, seats: &[usize], middle: usize, headway: Option<f64>) -> Option<TrainForces> {
        let histories = histories(forces, seats)?;
        match headway {
            Some(headway) => Some(among(forces, &histories, middle, headway).1),
            None => Some(span(forces, &histories, acting(&histories, margin(forces)))),
        }
    }

    /// Largest force on the sleeper in the middle over that between two trains, N.
    pub fn load(&self, middle: usize) -> f64 {
        let forces = &self.sleepers[middle];
        forces.iter().fold(0.0, |most: f64, force| most.max(*force)) - forces[0]
    }

    /// How long a train takes, s.
    pub fn time(&self) -> f64 {
        self.interval * (self.sleepers[0].len() - 1) as f64
    }
}

impl Following {
    /// Trains that follow each other every `headway`, s.
    pub fn new(forces: &SeatForces, seats: &[usize], middle: usize, headway: f64) -> Option<Following> {
        let histories = histories(forces, seats)?;
        let (least, among) = among(forces, &histories, middle, headway);
        let [first, last] = acting(&histories, margin(forces));
        let parting = parting(histories[middle], [first, last], least, period(forces, headway)).unwrap_or(last - 1);
        let halves = [[first, parting + 1], [parting, last]].map(|half| span(forces, &histories, half));
        let [first, rear] = halves;
        Some(Following { among, first, last: (parting + 1 < last).then_some(rear) })
    }
}

/// Force histories of these seats; `None` where one has none.
fn histories<'f>(forces: &'f SeatForces, seats: &[usize]) -> Option<Vec<&'f [f64]>> {
    let histories: Vec<&[f64]> =
        seats.iter().map(|seat| forces.seats.get(*seat).map(Vec::as_slice)).collect::<Option<_>>()?;
    histories.iter().all(|history| history.len() > 1).then_some(histories)
}

fn margin(forces: &SeatForces) -> usize {
    (MARGIN / forces.interval).ceil() as usize
}

/// Number of values between two trains.
fn period(forces: &SeatForces, headway: f64) -> usize {
    (headway / forces.interval).round().max(1.0) as usize
}

/// Values in which a train acts on any of the sleepers, and so many before and behind it.
fn acting(histories: &[&[f64]], margin: usize) -> [usize; 2] {
    let differs = |history: &&[f64]| {
        let rest = history[0];
        let most = history.iter().fold(0.0, |most: f64, force| most.max((force - rest).abs()));
        let differ = |force: &&f64| (**force - rest).abs() > DIFFERS * most;
        let first = history.iter().position(|force| differ(&force))?;
        Some([first, history.iter().rposition(|force| differ(&force))?])
    };
    let spans = histories.iter().filter_map(differs);
    let [first, last] = spans.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or([0, 1]);
    [first.saturating_sub(margin), (last + margin).min(histories[0].len())]
}

/// The values from one number to before another.
fn span(forces: &SeatForces, histories: &[&[f64]], [first, last]: [usize; 2]) -> TrainForces {
    let sleepers = histories.iter().map(|history| history[first..last].to_vec()).collect();
    TrainForces { interval: forces.interval, sleepers }
}

/// A train among others. Each train adds its force beyond the force at rest; this is exact for a track that never
/// lifts. It begins and ends where the force on the sleeper in the middle is [`least`]; the number of this value within
/// a period comes with it.
fn among(forces: &SeatForces, histories: &[&[f64]], middle: usize, headway: f64) -> (usize, TrainForces) {
    let period = period(forces, headway);
    let folded = |history: &&[f64]| {
        let rest = history[0];
        let mut sum = vec![rest; period];
        history.iter().enumerate().for_each(|(at, force)| sum[at % period] += force - rest);
        sum.into_iter().map(|force| force.max(0.0)).collect()
    };
    let mut sums: Vec<Vec<f64>> = histories.iter().map(folded).collect();
    let least = least(&sums[middle], histories[middle][0]);
    for sum in &mut sums {
        sum.rotate_left(least);
        sum.push(sum[0]);
    }
    // a headway is not a whole number of intervals: the interval of the values is scaled to fit
    (least, TrainForces { interval: headway / period as f64, sleepers: sums })
}

/// Number of the least force of a period, in its longest stretch of small forces. Where trains run far apart this is
/// the stretch between two of them, also if the rail lifts the sleeper between two bogies.
fn least(forces: &[f64], rest: f64) -> usize {
    let most = forces.iter().fold(rest, |most: f64, force| most.max(*force));
    let small = |at: usize| forces[at % forces.len()] - rest <= SMALL * (most - rest);
    // a stretch may begin in one period and end in the next
    let ends = |at: usize| (at..at + forces.len()).find(|at| !small(*at)).unwrap_or(at + forces.len());
    let stretches = (0..forces.len()).filter(|at| small(*at) && !small(at + forces.len() - 1)).map(|at| at..ends(at));
    let longest = stretches.max_by(|a, b| a.len().cmp(&b.len()).then(b.start.cmp(&a.start))).unwrap_or(0..forces.len());
    let force = |at: &usize| forces[at % forces.len()];
    longest.min_by(|a, b| force(a).total_cmp(&force(b))).unwrap_or(0) % forces.len()
}

/// Where a train among others begins in the history of one train: the last of these places with at least
/// [`HALF`] of the largest force before and behind it. `None` if a train is not parted.
fn parting(history: &[f64], [first, last]: [usize; 2], least: usize, period: usize) -> Option<usize> {
    let rest = history[0];
    let most = |of: &[f64]| of.iter().fold(0.0, |most: f64, force| most.max(force - rest));
    let enough = HALF * most(&history[first..last]);
    let parts = |at: &usize| most(&history[first..*at]) > enough && most(&history[*at..last]) > enough;
    (first + 1..last).filter(|at| at % period == least).rfind(parts)
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
        assert_eq!(train.sleepers[0], vec![22.0; 3], "each instant sees two of the four");
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

    #[test]
    fn a_first_and_a_last_train_are_halves_of_one_alone() {
        // two bogies; the front one of the next train comes between them and its own rear one
        let mut history = vec![2.0; 60];
        history[18..22].copy_from_slice(&[8.0, 12.0, 12.0, 8.0]);
        history[30..34].copy_from_slice(&[8.0, 12.0, 12.0, 8.0]);
        (history[25], history[26]) = (1.0, 1.5);
        let trains = Following::new(&forces(vec![history.clone()]), &[0], 0, 0.18).unwrap();
        assert_eq!(trains.among.sleepers[0].len(), 19);
        assert_eq!((trains.among.sleepers[0][0], trains.among.sleepers[0][18]), (1.0, 1.0));
        let (first, last) = (&trains.first.sleepers[0], &trains.last.as_ref().unwrap().sleepers[0]);
        assert_eq!((first[0], first[first.len() - 1], last[0], last[last.len() - 1]), (2.0, 1.0, 1.0, 2.0));
        assert_eq!([&first[..first.len() - 1], last].concat(), &history[16..35]);
        let whole = Following::new(&forces(vec![history]), &[0], 0, 0.58).unwrap();
        assert_eq!((whole.last, whole.first.sleepers[0].len()), (None, 19), "trains far apart are not parted");
    }
}
