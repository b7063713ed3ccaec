//! The law of jumps: the n-th train on a bed settles `kappa n^-q + c` under a load that stays. It is fitted to the
//! results of the cells.
//!
//! The constant `c` is what a bed goes on to do: nothing if it comes to rest, less than nothing if it rises. A power
//! alone has no place for this, and its error does not tell that a bed may rise later (docs/validation.md, cells). The
//! exponent is common to the cells of a bed; the load of each cell gives its own `kappa` and `c`.
//!
//! A cell that has computed `a` of the `n` trains that have passed is younger than its track, so a train that it
//! computes as its a-th counts as `kappa (a^-q - n^-q)` less than it does.
//!
//! A few trains under a new load have nearly one age, and their scatter alone would give a `kappa` of any size. So
//! `kappa` has a known size before it is fitted: what a train adds / its `a^-q`, of either sign (ridge regression).

use serde::{Deserialize, Serialize};

/// The law of the cells on a bed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hardening {
    /// Exponent by which the settlement added per train decreases.
    pub exponent: f64,
    /// Its standard error.
    pub error: f64,
    /// Standard deviation of a train from the law, m.
    pub scatter: f64,
}

/// A train that was computed: its number among those that the cell has computed, and what it added, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Computed {
    pub age: f64,
    pub added: f64,
}

/// Trains of a run that fix its two constants and show a deviation from them.
const FEWEST: usize = 3;
/// Trains of all cells beyond those that fix the constants, from which a law may be fitted.
const FEWEST_FREE: usize = 4;
/// Exponents that are tried, from a decrease by the logarithm of the number to a finite total settlement.
const SMALLEST: f64 = 0.05;
const LARGEST: f64 = 1.5;
const TRIED: usize = 291;

impl Hardening {
    /// The law of cells on equal beds, by least squares over all exponents; each run of trains under one load has its
    /// own constants. `None` while too few trains have been computed.
    pub fn fitted(runs: &[&[Computed]]) -> Option<Hardening> {
        let told = || runs.iter().filter(|trains| trains.len() >= FEWEST);
        let free = told().map(|trains| trains.len() - 2).sum::<usize>().checked_sub(1)?;
        if free < FEWEST_FREE {
            return None;
        }
        let exponent = |at: usize| SMALLEST + (LARGEST - SMALLEST) * at as f64 / (TRIED - 1) as f64;
        let misfit = |q: f64| told().map(|trains| Line::through(trains, q).misfit(trains)).sum::<f64>();
        let misfits: Vec<f64> = (0..TRIED).map(|at| misfit(exponent(at))).collect();
        let (best, least) = misfits.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        // the misfit grows by the variance of a train where the exponent is one standard error off
        let variance = least / free as f64;
        let beyond = |at: &usize| misfits[*at] > least + variance;
        let below = (0..best).rev().find(beyond).map_or(exponent(best), |at| exponent(best) - exponent(at));
        let above = (best + 1..TRIED).find(beyond).map_or(LARGEST - exponent(best), |at| exponent(at) - exponent(best));
        Some(Hardening { exponent: exponent(best), error: below.max(above), scatter: variance.sqrt() })
    }

    /// Settlement added by a run of `trains` after `passed` other trains. A cell has computed `known` trains under such
    /// forces; the last `now` of them are the first trains of this run. `None` if these are too few to know its law and
    /// trains are left.
    pub fn settled(&self, known: &[Computed], now: usize, passed: u64, trains: u64) -> Option<Jump> {
        let computed = &known[known.len() - now..];
        let numbers: Vec<f64> = (1..=trains).map(|at| (passed + at) as f64).collect();
        let left = numbers.len().saturating_sub(now) as f64;
        let added: f64 = computed.iter().map(|train| train.added).sum();
        if known.len() < FEWEST {
            // what the age of the cell changes is not known yet: at most as much as without a constant
            let younger = |(train, n): (&Computed, &f64)| train.added * (1.0 - (train.age / n).powf(self.exponent));
            let error = computed.iter().zip(&numbers).map(younger).sum::<f64>().abs();
            return (left == 0.0).then_some(Jump { settled: added, error });
        }
        let of = |exponent: f64| {
            let line = Line::through(known, exponent).held(known, self.scatter);
            let rate = |number: f64| number.powf(-exponent);
            let younger = |(train, n): (&Computed, &f64)| rate(*n) - rate(train.age);
            let lever = computed.iter().zip(&numbers).map(younger).sum::<f64>()
                + numbers.iter().skip(now).map(|n| rate(*n) - line.rate).sum::<f64>();
            let settled = added + left * line.added + lever * line.slope;
            let weight = left * left / known.len() as f64 + lever * lever / line.spread;
            (settled, self.scatter * weight.sqrt())
        };
        let (settled, of_constants) = of(self.exponent);
        let off = |exponent: f64| (of(exponent.clamp(SMALLEST, LARGEST)).0 - settled).abs();
        let of_exponent = off(self.exponent - self.error).max(off(self.exponent + self.error));
        Some(Jump { settled, error: of_constants.hypot(of_exponent) })
    }
}

/// Settlement added by a run of trains, and its standard error, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    pub settled: f64,
    pub error: f64,
}

/// The straight line of `added` over `rate = age^-q` through trains of different ages, about their mean.
struct Line {
    exponent: f64,
    /// Means of both.
    rate: f64,
    added: f64,
    slope: f64,
    /// Sum of squared distances of the rates from their mean.
    spread: f64,
}

impl Line {
    fn through(trains: &[Computed], exponent: f64) -> Line {
        let count = trains.len() as f64;
        let rate = trains.iter().map(|train| train.age.powf(-exponent)).sum::<f64>() / count;
        let added = trains.iter().map(|train| train.added).sum::<f64>() / count;
        let (mut spread, mut products) = (0.0, 0.0);
        for train in trains {
            let distance = train.age.powf(-exponent) - rate;
            spread += distance * distance;
            products += distance * train.added;
        }
        Line { exponent, rate, added, slope: products / spread, spread }
    }

    /// The line by ridge regression: before a train is seen, its slope is 0 with a standard deviation, the root mean
    /// square of what a train adds / the mean rate. Trains deviate from the line by `scatter`, m.
    fn held(self, trains: &[Computed], scatter: f64) -> Line {
        let squares = trains.iter().map(|train| train.added * train.added).sum::<f64>() / trains.len() as f64;
        if squares == 0.0 {
            return Line { slope: 0.0, ..self };
        }
        let spread = self.spread + scatter * scatter * self.rate * self.rate / squares;
        Line { slope: self.slope * self.spread / spread, spread, ..self }
    }

    /// Sum of squared differences between trains and the line.
    fn misfit(&self, trains: &[Computed]) -> f64 {
        let off =
            |train: &Computed| train.added - self.added - self.slope * (train.age.powf(-self.exponent) - self.rate);
        trains.iter().map(|train| off(train).powi(2)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KAPPA: f64 = 200e-6;

    fn by_law(ages: std::ops::RangeInclusive<u64>, q: f64, constant: f64) -> Vec<Computed> {
        ages.map(|age| Computed { age: age as f64, added: KAPPA * (age as f64).powf(-q) + constant }).collect()
    }

    /// The trains with a fixed scatter of so many metres at most, by an irrational turn.
    fn scattered(trains: Vec<Computed>, scatter: f64, seed: u64) -> Vec<Computed> {
        let off = |age: f64| 2.0 * (((age as u64 + 97 * seed) as f64 * 0.618_033_988_75).fract() - 0.5);
        trains.into_iter().map(|train| Computed { added: train.added + scatter * off(train.age), ..train }).collect()
    }

    #[test]
    fn a_law_that_holds_is_found_and_its_jumps_are_exact() {
        for constant in [0.0, -10e-6, 5e-6] {
            let trains = by_law(1..=20, 0.6, constant);
            let law = Hardening::fitted(&[&trains]).unwrap();
            assert!((law.exponent - 0.6).abs() < 0.003, "{law:?}");
            // the cell is 20 trains old, the track 100; two of ten trains are computed
            let jump = law.settled(&by_law(1..=22, 0.6, constant), 2, 100, 10).unwrap();
            let exact: f64 = (101..=110).map(|n| KAPPA * f64::from(n).powf(-0.6) + constant).sum();
            let scale = 10.0 * KAPPA * 100f64.powf(-0.6);
            assert!((jump.settled - exact).abs() < 5e-3 * scale, "{} {exact}", jump.settled);
            assert!(jump.error < 0.05 * scale, "{}", jump.error);
        }
    }

    #[test]
    fn what_is_computed_whole_is_not_changed_by_the_law() {
        let trains = by_law(1..=8, 0.4, 0.0);
        let law = Hardening { exponent: 1.1, error: 0.3, scatter: 5e-6 };
        let all: f64 = trains.iter().map(|train| train.added).sum();
        for known in [&trains[..], &trains[..2]] {
            let all = all - trains[known.len()..].iter().map(|train| train.added).sum::<f64>();
            let jump = law.settled(known, known.len(), 0, known.len() as u64).unwrap();
            assert!((jump.settled - all).abs() < 1e-18);
            assert!(jump.error < 1e-18, "{}", jump.error);
        }
    }

    #[test]
    fn two_trains_under_a_load_do_not_tell_what_the_next_ones_add() {
        let law = Hardening { exponent: 0.6, error: 0.05, scatter: 5e-6 };
        let known = by_law(21..=22, 0.6, 0.0);
        assert_eq!(law.settled(&known, 2, 100, 10), None);
        // if no train is left, only the age of the cell is open: 21 trains instead of 101
        let jump = law.settled(&known, 2, 100, 2).unwrap();
        assert!((jump.error / jump.settled - (1.0 - (21.5f64 / 101.5).powf(0.6))).abs() < 0.01, "{jump:?}");
    }

    /// Trains under a new load, late: their ages tell nothing, and the track is three times as old as the cell.
    #[test]
    fn scatter_of_trains_of_one_age_does_not_become_settlement() {
        let law = Hardening { exponent: 0.3, error: 0.1, scatter: 20e-6 };
        let added = [60e-6, 95e-6, 40e-6, 70e-6];
        for turned in 0..4 {
            let train = |at: usize| Computed { age: 40.0 + at as f64, added: added[(at + turned) % 4] };
            let known: Vec<Computed> = (0..4).map(train).collect();
            let jump = law.settled(&known, 1, 120, 1).unwrap();
            let now = known[3].added;
            assert!((jump.settled - now).abs() < jump.error && jump.error < 0.6 * now.max(60e-6), "{jump:?} {now}");
            assert!(jump.settled > 0.0);
        }
        let nothing: Vec<Computed> = (40..44).map(|age| Computed { age: f64::from(age), added: 0.0 }).collect();
        assert_eq!(law.settled(&nothing, 1, 120, 5).unwrap().settled, 0.0);
    }

    #[test]
    fn an_error_of_the_exponent_widens_what_is_extrapolated() {
        let known = by_law(1..=22, 0.6, 0.0);
        let sum = |q: f64| Hardening { exponent: q, error: 0.0, scatter: 0.0 }.settled(&known, 0, 100, 10).unwrap();
        let law = Hardening { exponent: 0.6, error: 0.05, scatter: 0.0 };
        let jump = law.settled(&known, 0, 100, 10).unwrap();
        let exact: f64 = (101..=110).map(|n| KAPPA * f64::from(n).powf(-0.6)).sum();
        assert!((jump.settled / exact - 1.0).abs() < 1e-9);
        let off = [0.55, 0.65].map(|q| (sum(q).settled - jump.settled).abs());
        assert!((jump.error / off[0].max(off[1]) - 1.0).abs() < 1e-9, "{jump:?} {off:?}");
    }

    #[test]
    fn cells_of_other_loads_share_the_exponent() {
        let light = by_law(1..=6, 0.7, 0.0);
        let heavy: Vec<Computed> =
            light.iter().map(|train| Computed { added: 3.0 * train.added + 8e-6, ..*train }).collect();
        assert!((Hardening::fitted(&[&light, &heavy]).unwrap().exponent - 0.7).abs() < 0.003);
    }

    #[test]
    fn scatter_widens_the_error_and_it_covers_the_truth() {
        // exponents, and jumps from 25 trains to 50, for a bed that comes to rest and for one that rises
        for constant in [0.0, -12e-6] {
            let (mut off, mut missed, mut all) = (0, 0, 0);
            for seed in 0..50u64 {
                let trains = scattered(by_law(1..=25, 0.8, constant), 8e-6, seed);
                let law = Hardening::fitted(&[&trains]).unwrap();
                let jump = law.settled(&trains, 0, 25, 25).unwrap();
                let exact: f64 = (26..=50).map(|n| KAPPA * f64::from(n).powf(-0.8) + constant).sum();
                all += 1;
                off += u32::from((law.exponent - 0.8).abs() > 2.0 * law.error);
                missed += u32::from((jump.settled - exact).abs() > 2.0 * jump.error);
            }
            assert!(off * 5 < all && missed * 5 < all, "{off} and {missed} of {all}");
        }
    }

    /// A cell of the paper's bed, every train computed: it settles for 25 trains and rises in the next 25.
    const RISES: [f64; 50] = [
        192.2, 147.8, 69.4, 39.7, 44.5, 26.6, 20.7, 22.9, 16.7, 20.3, 11.8, 16.5, 17.2, 10.7, 9.8, 7.2, 16.3, 12.8,
        16.8, 9.5, 3.7, 7.7, 2.3, 6.3, 4.3, 0.6, -1.4, 1.8, -9.1, 0.0, -7.8, -6.2, -8.7, -9.4, -11.1, -12.5, -19.0,
        -17.7, 0.6, 3.3, -9.3, 2.5, -3.9, -13.4, -8.7, 6.3, -1.1, -12.9, 5.3, -8.8,
    ];

    #[test]
    fn the_error_tells_that_a_bed_may_rise() {
        let trains: Vec<Computed> =
            RISES.iter().enumerate().map(|(i, added)| Computed { age: i as f64 + 1.0, added: 1e-6 * added }).collect();
        let mut last = f64::INFINITY;
        for age in [16, 20, 25, 30, 35, 40] {
            let law = Hardening::fitted(&[&trains[..age]]).unwrap();
            let jump = law.settled(&trains[..age], 0, age as u64, 50 - age as u64).unwrap();
            let whole: f64 = trains[age..].iter().map(|train| train.added).sum();
            assert!((jump.settled - whole).abs() < 1.5 * jump.error, "after {age}: {jump:?} for {whole}");
            assert!(jump.error < last, "the error falls with what is known");
            last = jump.error;
        }
        assert!(last < 30e-6);
    }

    #[test]
    fn few_trains_tell_no_law() {
        assert_eq!(Hardening::fitted(&[&by_law(1..=6, 0.5, 0.0)]), None);
        assert_eq!(Hardening::fitted(&[by_law(1..=2, 0.5, 0.0).as_slice(); 9]), None);
        assert_eq!(Hardening::fitted(&[]), None);
    }
}
