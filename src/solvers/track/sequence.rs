//! The order of the trains of a mix.
//!
//! Trains of an interleaved mix are spread evenly: of `n` trains, train `j` (from 0) is due when `(j + 1/2) / n` of all
//! traffic has passed, and trains run in the order in which they are due. This is the rule of Webster and Sainte-Laguë
//! for dividing seats by votes: at any time every kind of train has had its share, to within one train.

use serde::{Deserialize, Serialize};

/// In which order the trains of a mix run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Order {
    /// Mixed along the whole run, each kind in its share.
    Interleaved,
    /// All trains of the first kind, then all of the second.
    InTurn,
}

/// Trains of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// How many of them run.
    pub trains: u64,
    /// Axles of one.
    pub axles: u64,
    /// Mass of one, on both rails, kg.
    pub mass: f64,
}

/// Every train of a run, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sequence {
    pub order: Order,
    pub shares: Vec<Share>,
}

impl Sequence {
    /// Trains of the whole run.
    pub fn trains(&self) -> u64 {
        self.shares.iter().map(|share| share.trains).sum()
    }

    /// How many trains of each kind are among the first `position` trains.
    pub fn counts(&self, position: u64) -> Vec<u64> {
        let position = position.min(self.trains());
        match self.order {
            Order::InTurn => {
                let mut left = position;
                let turn = |share: &Share| {
                    let run = left.min(share.trains);
                    left -= run;
                    run
                };
                self.shares.iter().map(turn).collect()
            }
            Order::Interleaved => (0..self.shares.len())
                .map(|kind| {
                    let of = self.shares[kind].trains;
                    partition(of, part(position, of, self.trains()), |train| self.place(kind, train) < position)
                })
                .collect(),
        }
    }

    /// Trains that run before train `train` of a kind: the trains due earlier, and among trains due at the same time
    /// the kinds named earlier.
    fn place(&self, kind: usize, train: u64) -> u64 {
        let (of, due) = (u128::from(self.shares[kind].trains), 2 * u128::from(train) + 1);
        let earlier = |(other, share): (usize, &Share)| {
            // those with (2 j + 1) of <= due trains, or < if the other is named later
            let trains = u128::from(share.trains);
            let ticks = due * trains;
            let ticks = if other <= kind { ticks } else { ticks - 1 };
            (ticks / of).div_ceil(2).min(trains) as u64
        };
        let before: u64 = self.shares.iter().enumerate().filter(|(_, s)| s.trains > 0).map(earlier).sum();
        before - 1 // itself is among them
    }

    /// Axles of the first `position` trains.
    pub fn axles(&self, position: u64) -> u64 {
        self.counts(position).iter().zip(&self.shares).map(|(count, share)| count * share.axles).sum()
    }

    /// Mass of the first `position` trains, kg.
    pub fn mass(&self, position: u64) -> f64 {
        self.counts(position).iter().zip(&self.shares).map(|(count, share)| *count as f64 * share.mass).sum()
    }

    /// The largest number of trains that have at most `axles` axles together.
    pub fn within(&self, axles: u64) -> u64 {
        let trains = self.trains();
        let usual = part(axles, trains, self.axles(trains)).min(trains);
        partition(trains + 1, usual + 1, |position| self.axles(position) <= axles).saturating_sub(1)
    }

    /// The number of trains for which `carried`, which grows with this number, is nearest to `amount`.
    pub fn nearest(&self, amount: f64, carried: impl Fn(&Sequence, u64) -> f64) -> u64 {
        let (trains, all) = (self.trains(), carried(self, self.trains()));
        let usual = (amount / all * trains as f64).clamp(0.0, trains as f64) as u64;
        let above = partition(trains, usual, |position| carried(self, position) < amount);
        let below = above.saturating_sub(1);
        if amount - carried(self, below) < carried(self, above) - amount { below } else { above }
    }

    /// Numbers of trains at which another kind begins, if they run in turn.
    pub fn turns(&self) -> Vec<u64> {
        if self.order == Order::Interleaved {
            return Vec::new();
        }
        let ends = self.shares.iter().scan(0, |end, share| {
            *end += share.trains;
            Some(*end)
        });
        ends.filter(|end| *end < self.trains()).collect()
    }
}

/// `of * some / all`, rounded down.
fn part(some: u64, of: u64, all: u64) -> u64 {
    (u128::from(of) * u128::from(some) / u128::from(all.max(1))).min(u128::from(u64::MAX)) as u64
}

/// The number from 0 to `count` at which `below` changes from true to false. The nearer the guess, the faster the
/// search.
fn partition(count: u64, guess: u64, below: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (guess.min(count), guess.min(count));
    let mut reach = 1;
    while low > 0 && !below(low - 1) {
        high = low - 1;
        low = high.saturating_sub(reach);
        reach *= 2;
    }
    while high < count && below(high) {
        low = high + 1;
        high = (low + reach).min(count);
        reach *= 2;
    }
    while low < high {
        let middle = low + (high - low) / 2;
        if below(middle) { low = middle + 1 } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sequence(order: Order, trains: &[u64]) -> Sequence {
        let share = |(kind, trains): (usize, &u64)| Share { trains: *trains, axles: 4 * (kind as u64 + 1), mass: 80e3 };
        Sequence { order, shares: trains.iter().enumerate().map(share).collect() }
    }

    #[test]
    fn trains_of_a_mix_are_spread_evenly() {
        let mix = sequence(Order::Interleaved, &[4, 2]);
        let counts: Vec<Vec<u64>> = (0..=6).map(|position| mix.counts(position)).collect();
        assert_eq!(counts, [[0, 0], [1, 0], [1, 1], [2, 1], [3, 1], [3, 2], [4, 2]]);
        let turns = sequence(Order::InTurn, &[4, 2]);
        assert_eq!(turns.counts(5), [4, 1]);
        assert_eq!((turns.turns(), turns.axles(5)), (vec![4], 24));
    }

    #[test]
    fn counts_go_to_the_nearest_train() {
        let mix = sequence(Order::Interleaved, &[4, 2]); // axles 4, 12, 16, 20, 28, 32
        let axles = |sequence: &Sequence, position: u64| sequence.axles(position) as f64;
        let nearest = [0.0, 1.9, 7.9, 8.1, 13.0, 31.0, 99.0].map(|amount| mix.nearest(amount, axles));
        assert_eq!(nearest, [0, 0, 1, 2, 2, 6, 6]);
        assert_eq!([0, 3, 4, 11, 12, 99].map(|axles| mix.within(axles)), [0, 0, 1, 1, 2, 6]);
    }

    proptest! {
        #[test]
        fn every_train_has_its_share_whenever_one_stops(
            trains in prop::collection::vec(1u64..200, 1..4), stop in 0u64..600
        ) {
            let mix = sequence(Order::Interleaved, &trains);
            let all = mix.trains();
            let stop = stop.min(all);
            let counts = mix.counts(stop);
            prop_assert_eq!(counts.iter().sum::<u64>(), stop);
            prop_assert_eq!(mix.counts(all), trains.clone());
            for (count, of) in counts.iter().zip(&trains) {
                let due = stop as f64 * *of as f64 / all as f64;
                prop_assert!((*count as f64 - due).abs() <= 1.0, "{} of {}", count, due);
            }
            if stop > 0 {
                // one train a step, and never backwards
                let before = mix.counts(stop - 1);
                prop_assert!(counts.iter().zip(&before).all(|(now, then)| now >= then));
            }
        }
    }
}
