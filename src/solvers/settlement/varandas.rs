//! Settlement of a support by Varandas, Hölscher and Silva (2014): every band of force adds a settlement that is a
//! power of the number of times that the band was reached.
//!
//! The n-th cycle, of peak `F_n`, adds `u_n = (γ/M) ∫₀^{F_n} F^α (h(F) + 1)^-β dF`. Here h(F) is the number of earlier
//! cycles of peak F or more, and `M = F₀^{α+1}/(α+1) · H(N₀)`, so that N₀ cycles of peak F₀ give the settlement γ.
//! Summed for a fixed F, the terms are 1, 2^-β, 3^-β, ..., for any order of the cycles, so
//!
//! ```text
//! S = (γ/M) ∫₀^∞ F^α H(n(F)) dF,   H(n) = Σ_{j=1..n} j^-β,   n(F) = cycles of peak F or more.
//! ```
//!
//! n(F) is a staircase function: a sorted list of peaks with their counts is the complete state, and S is independent
//! of the order of events.

use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Varandas {
    /// Exponent of the force; with a larger exponent large forces cause more of the settlement. Above -1.
    pub alpha: f64,
    /// Exponent of the number of cycles; with a larger exponent settlement ends sooner. 0 or more.
    pub beta: f64,
    /// Settlement after the reference cycles, m.
    pub gamma: f64,
    /// N₀, number of reference cycles, an integer, 1 or more.
    pub reference_cycles: f64,
    /// F₀, peak force of the reference cycles, N.
    pub reference_force: f64,
}

/// The cycles carried by one support.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VarandasState {
    /// Peak force (N) and number of cycles, strongest first, every peak once.
    cycles: Vec<(f64, u64)>,
}

impl Default for Varandas {
    /// The values of the publication: 10 mm after a million cycles of 50 kN.
    fn default() -> Self {
        Self { alpha: 0.6, beta: 0.82, gamma: 0.010, reference_cycles: 1e6, reference_force: 50e3 }
    }
}

impl Varandas {
    /// Settlement after the cycles of `state`, m, positive down.
    pub fn settlement(&self, state: &VarandasState) -> f64 {
        let sums = PowerSum::new(self.beta);
        let area = |peak: f64| (peak / self.reference_force).powf(self.alpha + 1.0);
        let (mut reached, mut total) = (0, 0.0);
        for (i, &(peak, count)) in state.cycles.iter().enumerate() {
            reached += count;
            let below = state.cycles.get(i + 1).map_or(0.0, |next| area(next.0));
            total += sums.up_to(reached) * (area(peak) - below);
        }
        self.gamma * total / sums.up_to(self.reference_cycles as u64)
    }
}

impl VarandasState {
    /// Adds `count` cycles of peak force `peak` (N); a peak that is not positive is ignored.
    pub fn add_cycles(&mut self, peak: f64, count: u64) {
        if count == 0 || peak.is_nan() || peak <= 0.0 {
            return;
        }
        let place = self.cycles.partition_point(|(force, _)| *force > peak);
        match self.cycles.get_mut(place) {
            Some((force, known)) if *force == peak => *known += count,
            _ => self.cycles.insert(place, (peak, count)),
        }
    }

    /// Peak force (N) and number of cycles, strongest first.
    pub fn cycles(&self) -> &[(f64, u64)] {
        &self.cycles
    }
}

/// `H(n) = Σ_{j=1..n} j^-β`: summed up to 32 terms, beyond by the Euler–Maclaurin formula from there.
struct PowerSum {
    beta: f64,
    /// H(0), H(1), ...
    table: [f64; SUMMED + 1],
    /// `x^(1-β)`, and the correction, at `x = SUMMED`.
    power: f64,
    correction: f64,
}

const SUMMED: usize = 32;

impl PowerSum {
    fn new(beta: f64) -> Self {
        let mut table = [0.0; SUMMED + 1];
        for j in 1..=SUMMED {
            table[j] = table[j - 1] + (j as f64).powf(-beta);
        }
        let from = SUMMED as f64;
        Self { beta, table, power: from.powf(1.0 - beta), correction: correction(from, beta) }
    }

    fn up_to(&self, n: u64) -> f64 {
        if let Some(sum) = usize::try_from(n).ok().and_then(|n| self.table.get(n)) {
            return *sum;
        }
        let (n, exponent) = (n as f64, 1.0 - self.beta);
        // ∫ x^-β dx, accurate also near β = 1.
        let ratio = (n / SUMMED as f64).ln();
        let integral = if exponent == 0.0 { ratio } else { self.power * (exponent * ratio).exp_m1() / exponent };
        self.table[SUMMED] + integral + correction(n, self.beta) - self.correction
    }
}

/// `f(x)/2 + Σ B_2k/(2k)! f^(2k-1)(x)` for f = x^-β, to k = 4: the remainder is below 1e-15 from 32 on.
fn correction(x: f64, beta: f64) -> f64 {
    let mut derivative = x.powf(-beta); // of order 0, then 1, 3, 5, 7
    let mut sum = 0.5 * derivative;
    derivative *= -beta / x;
    let coefficients = [1.0 / 12.0, -1.0 / 720.0, 1.0 / 30_240.0, -1.0 / 1_209_600.0];
    for (k, coefficient) in coefficients.into_iter().enumerate() {
        sum += coefficient * derivative;
        let order = 2.0 * k as f64 + 1.0;
        derivative *= (beta + order) * (beta + order + 1.0) / (x * x);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn after(cycles: &[(f64, u64)]) -> f64 {
        let mut state = VarandasState::default();
        for (peak, count) in cycles {
            state.add_cycles(*peak, *count);
        }
        Varandas::default().settlement(&state)
    }

    /// The law as published: one cycle after the other, the integral band by band.
    fn summed(peaks: &[f64]) -> f64 {
        let law = Varandas::default();
        let norm: f64 = (1..=law.reference_cycles as u64).map(|j| (j as f64).powf(-law.beta)).sum();
        let area = |f: f64| (f / law.reference_force).powf(law.alpha + 1.0);
        let mut total = 0.0;
        for (n, peak) in peaks.iter().enumerate() {
            let mut steps: Vec<f64> = peaks[..n].iter().copied().filter(|f| f < peak).collect();
            steps.push(*peak);
            steps.sort_by(f64::total_cmp);
            let mut low = 0.0;
            for high in steps {
                let earlier = peaks[..n].iter().filter(|f| **f >= high).count();
                total += (area(high) - area(low)) * (earlier as f64 + 1.0).powf(-law.beta);
                low = high;
            }
        }
        law.gamma * total / norm
    }

    #[test]
    fn published_values() {
        for (force, expected) in
            [(37e3, [0.10, 1.20, 2.42, 6.18]), (50e3, [0.16, 1.94, 3.91, 10.0]), (60e3, [0.22, 2.60, 5.23, 13.4])]
        {
            for (count, millimetres) in [1, 500, 10_000, 1_000_000].into_iter().zip(expected) {
                let found = 1e3 * after(&[(force, count)]);
                let half_digit = if millimetres == 13.4 { 0.05 } else { 0.005 };
                assert!((found - millimetres).abs() <= half_digit, "{force} N, {count}: {found} mm, {millimetres} mm");
            }
        }
        assert!((after(&[(50e3, 1_000_000)]) - 0.010).abs() < 1e-15);
    }

    #[test]
    fn long_sums_agree_with_addition() {
        for beta in [0.0, 0.3, 0.82, 1.0, 1.7] {
            let sums = PowerSum::new(beta);
            for n in [33u64, 100, 5_000, 300_000] {
                // Smallest terms first.
                let exact: f64 = (1..=n).rev().map(|j| (j as f64).powf(-beta)).sum();
                assert!((sums.up_to(n) / exact - 1.0).abs() < 1e-12, "beta {beta}, n {n}");
            }
        }
    }

    #[test]
    fn nothing_carried_nothing_settled() {
        assert_eq!(after(&[]), 0.0);
        assert_eq!(after(&[(0.0, 5), (-1.0, 5), (f64::NAN, 5), (1e4, 0)]), 0.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn agrees_with_the_law_cycle_by_cycle(peaks in prop::collection::vec(1e3..9e4f64, 1..40), again in 0usize..40) {
            let mut peaks = peaks;
            peaks.push(peaks[again % peaks.len()]); // at least one peak twice
            let cycles: Vec<(f64, u64)> = peaks.iter().map(|p| (*p, 1)).collect();
            let found = after(&cycles);
            prop_assert!((found / summed(&peaks) - 1.0).abs() < 1e-10);
            let backwards: Vec<(f64, u64)> = cycles.iter().rev().copied().collect();
            prop_assert!((after(&backwards) / found - 1.0).abs() < 1e-14);
        }

        #[test]
        fn a_block_is_its_cycles(peak in 1e3..9e4f64, other in 1e3..9e4f64, count in 1u64..50) {
            let mut single = vec![(other, 3)];
            single.extend((0..count).map(|_| (peak, 1)));
            prop_assert_eq!(after(&[(peak, count), (other, 3)]), after(&single));
        }
    }
}
