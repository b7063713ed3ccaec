//! The law of jumps: each train adds less than the one before, as a power of their number. It is fitted to the results
//! of the cells.
//!
//! The n-th train on a bed settles `kappa n^-q` under a load that stays. A cell that has computed `a` of the `n` trains
//! that have passed is younger than its track, so a train that it computes as its a-th counts as `(a / n)^q` of what it
//! does.

use serde::{Deserialize, Serialize};

/// Exponent by which the settlement added per train decreases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hardening {
    pub exponent: f64,
    /// Its standard error.
    pub error: f64,
}

/// A train that was computed: its number among those that the cell has computed, and what it added, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Computed {
    pub age: f64,
    pub added: f64,
}

/// Trains of all cells from which a law may be fitted.
const FEWEST: usize = 6;
/// Trains of a cell that are used to predict the next trains.
const RECENT: usize = 8;
/// Exponents that are tried, from no decrease to a finite total settlement.
const LARGEST: f64 = 1.5;
const TRIED: usize = 301;

impl Hardening {
    /// The law of cells on equal beds, by least squares over all exponents; each cell has its own factor. `None` while
    /// too few trains have been computed.
    pub fn fitted(cells: &[&[Computed]]) -> Option<Hardening> {
        let count: usize = cells.iter().map(|trains| trains.len()).sum();
        let free = count.checked_sub(cells.len() + 1)?;
        if count < FEWEST || free == 0 {
            return None;
        }
        let exponent = |at: usize| LARGEST * at as f64 / (TRIED - 1) as f64;
        let misfit = |q: f64| cells.iter().map(|trains| misfit(trains, q)).sum::<f64>();
        let misfits: Vec<f64> = (0..TRIED).map(|at| misfit(exponent(at))).collect();
        let (best, least) = misfits.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        // the misfit grows by the variance of a train where the exponent is one standard error off
        let variance = least / free as f64;
        let beyond = |at: &usize| misfits[*at] > least + variance;
        let below = (0..best).rev().find(beyond).map_or(exponent(best), |at| exponent(best) - exponent(at));
        let above = (best + 1..TRIED).find(beyond).map_or(LARGEST - exponent(best), |at| exponent(at) - exponent(best));
        Some(Hardening { exponent: exponent(best), error: below.max(above) })
    }

    /// Settlement added by a run of `trains` after `passed` other trains. A cell has computed `known` trains under such
    /// forces; the last `now` of them are the first trains of this run.
    pub fn settled(&self, known: &[Computed], now: usize, passed: u64, trains: u64) -> Jump {
        let q = self.exponent;
        let number = |at: usize| (passed + at as u64 + 1) as f64;
        let (mut settled, mut by_exponent) = (0.0, 0.0);
        for (at, train) in known[known.len() - now..].iter().enumerate() {
            let counted = train.added * (train.age / number(at)).powf(q);
            settled += counted;
            by_exponent += counted * (number(at) / train.age).ln();
        }
        let left: Vec<f64> = (now..trains as usize).map(number).collect();
        // the last trains predict the next trains: a curved law is straight over a few trains
        let recent = &known[known.len().saturating_sub(RECENT)..];
        let squares: f64 = recent.iter().map(|train| train.age.powf(-2.0 * q)).sum();
        if left.is_empty() || squares == 0.0 {
            return Jump { settled, error: by_exponent.abs() * self.error };
        }
        let factor = recent.iter().map(|train| train.added * train.age.powf(-q)).sum::<f64>() / squares;
        let age = recent.iter().map(|train| train.age.ln()).sum::<f64>() / recent.len() as f64;
        let rates: f64 = left.iter().map(|number| number.powf(-q)).sum();
        by_exponent += factor * left.iter().map(|number| number.powf(-q) * (number.ln() - age)).sum::<f64>();
        let free = recent.len().saturating_sub(1).max(1) as f64;
        let of_factor = rates * (misfit(recent, q) / free / squares).sqrt();
        Jump { settled: settled + factor * rates, error: of_factor.hypot(by_exponent * self.error) }
    }
}

/// Settlement added by a run of trains, and its standard error, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    pub settled: f64,
    pub error: f64,
}

/// Sum of squared differences between trains and the law with the best factor.
fn misfit(trains: &[Computed], exponent: f64) -> f64 {
    let (mut rates, mut squares, mut all) = (0.0, 0.0, 0.0);
    for train in trains {
        let law = train.age.powf(-exponent);
        rates += train.added * law;
        squares += law * law;
        all += train.added * train.added;
    }
    if squares > 0.0 { (all - rates * rates / squares).max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KAPPA: f64 = 20e-6;

    fn by_law(ages: std::ops::RangeInclusive<u64>, q: f64) -> Vec<Computed> {
        ages.map(|age| Computed { age: age as f64, added: KAPPA * (age as f64).powf(-q) }).collect()
    }

    #[test]
    fn a_law_that_holds_is_found_and_its_jumps_are_exact() {
        let trains = by_law(1..=20, 0.6);
        let law = Hardening::fitted(&[&trains]).unwrap();
        assert!((law.exponent - 0.6).abs() < 0.003, "{law:?}");
        // the cell is 20 trains old, the track 100; two of ten trains are computed
        let jump = law.settled(&by_law(1..=22, 0.6), 2, 100, 10);
        let exact: f64 = (101..=110).map(|n| KAPPA * f64::from(n).powf(-0.6)).sum();
        assert!((jump.settled / exact - 1.0).abs() < 5e-3, "{} {exact}", jump.settled);
        assert!(jump.error < 0.05 * exact, "{}", jump.error);
    }

    #[test]
    fn what_is_computed_whole_is_not_changed_by_the_law() {
        let trains = by_law(1..=8, 0.4);
        let law = Hardening { exponent: 1.1, error: 0.3 };
        let jump = law.settled(&trains, 8, 0, 8);
        let all: f64 = trains.iter().map(|train| train.added).sum();
        assert!((jump.settled - all).abs() < 1e-18);
        assert!(jump.error < 1e-18, "{}", jump.error);
    }

    #[test]
    fn a_run_of_which_nothing_is_computed_goes_on_as_before() {
        let law = Hardening { exponent: 0.6, error: 0.05 };
        let jump = law.settled(&by_law(1..=22, 0.6), 0, 100, 10);
        let exact: f64 = (101..=110).map(|n| KAPPA * f64::from(n).powf(-0.6)).sum();
        assert!((jump.settled / exact - 1.0).abs() < 1e-9);
        // from the 18th train to the 105th, by an exponent that may be off by 0.05
        assert!((jump.error / exact - 0.05 * (105.0f64 / 18.4).ln()).abs() < 5e-3, "{}", jump.error / exact);
    }

    #[test]
    fn cells_of_other_loads_share_the_exponent() {
        let (light, heavy) = (by_law(1..=6, 0.7), by_law(1..=6, 0.7));
        let heavy: Vec<Computed> =
            heavy.into_iter().map(|train| Computed { added: 3.0 * train.added, ..train }).collect();
        assert!((Hardening::fitted(&[&light, &heavy]).unwrap().exponent - 0.7).abs() < 0.003);
    }

    #[test]
    fn scatter_widens_the_error_and_it_covers_the_truth() {
        let (mut off, mut all) = (0, 0);
        for seed in 0..50u64 {
            // a fixed scatter of 30 %, by an irrational turn
            let scattered = |train: Computed| {
                let turn = ((train.age as u64 + 97 * seed) as f64 * 0.618_033_988_75).fract();
                Computed { added: train.added * (1.0 + 0.6 * (turn - 0.5)), ..train }
            };
            let trains: Vec<Computed> = by_law(1..=25, 0.5).into_iter().map(scattered).collect();
            let law = Hardening::fitted(&[&trains]).unwrap();
            all += 1;
            off += u32::from((law.exponent - 0.5).abs() > 2.0 * law.error);
        }
        assert!(off * 5 < all, "{off} of {all}");
    }

    #[test]
    fn few_trains_tell_no_law() {
        assert_eq!(Hardening::fitted(&[&by_law(1..=5, 0.5)]), None);
        assert_eq!(Hardening::fitted(&[]), None);
    }
}
