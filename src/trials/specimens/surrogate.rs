//! The law of the specimens, and its errors.

use super::bench::Curve;
use super::program::Trial;
use crate::solvers::settlement::fit::{Fit, FitError, Parameter, fit};
use crate::solvers::settlement::{CyclePer, Form, Law, Peak, Power};

/// A law fitted to specimens. Errors are shares of the largest settlement of a specimen.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogate {
    pub law: Power,
    /// Standard errors of the parameters a, m, b and g; `None` for a parameter on a bound.
    pub standard_errors: Vec<Option<f64>>,
    /// Root of the mean square of the residuals.
    pub rms: f64,
    /// Each specimen by a law that was fitted to the others.
    pub left_out: Vec<LeftOut>,
    /// The last train of each specimen by a law that was fitted to the first half of the trains: root of the mean
    /// square.
    pub later: f64,
    /// The specimen whose loads change: the largest error after any train.
    pub check: f64,
    /// Peak forces of the wheels, N.
    pub loads: [f64; 2],
    /// The largest void, m.
    pub void: f64,
    /// Axles that have passed a specimen.
    pub axles: u64,
}

/// A specimen, and how a law of the others predicts it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    pub trial: Trial,
    /// Mean peak of the wheels, N, and the void before the train, m.
    pub force: f64,
    pub void: f64,
    /// After the last train: measured, by the law, and by the law of the others, m.
    pub settled: f64,
    pub fitted: f64,
    pub predicted: f64,
    /// Largest error of the prediction after any train / largest settlement of a specimen.
    pub error: f64,
}

/// Bounds of the parameters, SI, as in the language.
const BOUNDS: [[f64; 2]; 4] = [[1e-12, 1.0], [0.0, 10.0], [1e-3, 1.0], [-2e4, 2e4]];
/// Where the search starts: exponents of force and cycles, decrease with the void, 1/m.
const START: [f64; 3] = [1.0, 0.4, 100.0];
/// Error up to which settlement may be predicted for more axles than were measured.
const BEARABLE: f64 = 0.5;
/// Most axles that a law may be stated for.
const MOST_AXLES: f64 = 1e7;

impl Surrogate {
    /// Error of the law: the larger one of the two errors of specimens that were not used.
    pub fn error(&self) -> f64 {
        self.of_left_out().max(self.check)
    }

    /// Root of the mean square of the errors of the specimens that were left out.
    pub fn of_left_out(&self) -> f64 {
        root_mean_square(self.left_out.iter().map(|one| one.error))
    }

    /// Axles for which the law may be used: with every doubling of the axles the error grows as it does from the first
    /// half of the trains to the last train.
    pub fn most_axles(&self) -> u64 {
        let doublings = ((BEARABLE - self.error()) / self.later).clamp(0.0, 40.0);
        ((self.axles as f64 * doublings.exp2()).min(MOST_AXLES)).floor() as u64
    }
}

/// Fits the law to specimens. `check` is the specimen whose loads change; it takes no part in the fit. `reference` is
/// the force of the law, N.
pub fn fit_curves(curves: &[Curve], check: &Curve, reference: f64) -> Result<Surrogate, FitError> {
    let all: Vec<&Curve> = curves.iter().collect();
    let (law, found) = fitted(&all, reference, usize::MAX)?;
    let ends = || curves.iter().filter_map(|curve| curve.settled.last());
    let largest = ends().fold(0.0, |most: f64, settled| most.max(settled.abs()));
    let left_out = |(number, curve): (usize, &Curve)| {
        let others: Vec<&Curve> =
            curves.iter().enumerate().filter(|(other, _)| *other != number).map(|(_, c)| c).collect();
        let (other, _) = fitted(&others, reference, usize::MAX)?;
        Ok(LeftOut::new(curve, &law, &other, largest))
    };
    let (early, _) = fitted(&all, reference, curves.iter().map(|curve| curve.settled.len() / 2).min().unwrap_or(0))?;
    let at_end = |curve: &Curve| last(&by_law(&early, curve)) - last(&curve.settled);
    let peaks = || curves.iter().flat_map(|curve| curve.peaks.iter().flatten());
    let forces = || peaks().map(|peak| peak.force);
    Ok(Surrogate {
        law,
        standard_errors: found.standard_errors,
        rms: found.rms / largest,
        left_out: curves.iter().enumerate().map(left_out).collect::<Result<_, _>>()?,
        later: root_mean_square(curves.iter().map(at_end)) / largest,
        check: difference(&by_law(&law, check), &check.settled) / largest,
        loads: [forces().fold(f64::INFINITY, f64::min), forces().fold(0.0, f64::max)],
        void: peaks().map(|peak| peak.void).fold(0.0, f64::max),
        axles: curves.iter().map(|curve| curve.peaks.iter().map(Vec::len).sum::<usize>()).min().unwrap_or(0) as u64,
    })
}

impl LeftOut {
    fn new(curve: &Curve, law: &Power, others: &Power, largest: f64) -> LeftOut {
        let first = curve.peaks.first().map_or(&[] as &[Peak], Vec::as_slice);
        let mean = |of: fn(&Peak) -> f64| first.iter().map(of).sum::<f64>() / first.len().max(1) as f64;
        let prediction = by_law(others, curve);
        LeftOut {
            trial: curve.trials.first().copied().unwrap_or(Trial { factor: 1.0, void: 0.0 }),
            force: mean(|peak| peak.force),
            void: mean(|peak| peak.void),
            settled: last(&curve.settled),
            fitted: last(&by_law(law, curve)),
            predicted: last(&prediction),
            error: difference(&prediction, &curve.settled) / largest,
        }
    }
}

/// The law nearest to the first `trains` trains of these specimens.
fn fitted(curves: &[&Curve], reference: f64, trains: usize) -> Result<(Power, Fit), FitError> {
    let measured: Vec<f64> = curves.iter().flat_map(|curve| curve.settled.iter().take(trains).copied()).collect();
    let largest = measured.iter().copied().fold(0.0, f64::max);
    let [force, cycles, void] = START;
    let start = [(largest / 4.0).max(1e-6), force, cycles, void];
    let parameters: Vec<Parameter> =
        start.iter().zip(BOUNDS).map(|(start, [low, high])| Parameter { start: *start, low, high }).collect();
    let law =
        |values: &[f64]| Power { a: values[0], m: values[1], b: values[2], g: values[3], reference_force: reference };
    let found = fit(&parameters, &measured, |values| {
        let law = law(values);
        curves.iter().flat_map(|curve| by_law(&law, curve).into_iter().take(trains)).collect()
    })?;
    Ok((law(&found.values), found))
}

/// Settlement after each train of a specimen by a law, m.
pub fn by_law(law: &Power, curve: &Curve) -> Vec<f64> {
    let mut support = Law { form: Form::Power(*law), cycle_per: CyclePer::Axle }.fresh();
    let after = |peaks: &Vec<Peak>| {
        support.load(peaks, 1);
        support.settlement()
    };
    curve.peaks.iter().map(after).collect()
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (squares, count) = values.fold((0.0, 0.0), |(squares, count), value| (squares + value * value, count + 1.0));
    if count > 0.0 { f64::sqrt(squares / count) } else { 0.0 }
}

fn last(settled: &[f64]) -> f64 {
    settled.last().copied().unwrap_or(0.0)
}

/// Largest difference of two curves, m.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::Ranges;
    use super::*;

    const TRUE: Power = Power { a: 70e-6, m: 1.3, b: 0.6, reference_force: 37e3, g: 400.0 };

    /// A specimen of a law, with a scatter from train to train.
    fn specimen(trials: Vec<Trial>, scatter: f64) -> Curve {
        let peaks: Vec<Vec<Peak>> = trials
            .iter()
            .map(|trial| vec![Peak { force: 37e3 * trial.factor, deflection: 1e-3, void: trial.void }; 4])
            .collect();
        let mut curve = Curve { trials, peaks, settled: Vec::new(), stiffness: None };
        curve.settled = by_law(&TRUE, &curve);
        for (n, settled) in curve.settled.iter_mut().enumerate() {
            *settled *= 1.0 + scatter * ((n as f64 * 0.618).fract() - 0.5);
        }
        curve
    }

    fn specimens(scatter: f64) -> (Vec<Curve>, Curve) {
        let ranges = Ranges::default();
        let steady = |trial: &Trial| specimen(vec![*trial; ranges.trains as usize], scatter);
        (ranges.trials().iter().map(steady).collect(), specimen(ranges.check(), scatter))
    }

    #[test]
    fn a_law_of_force_void_and_cycles_comes_back() {
        let (curves, check) = specimens(0.0);
        let found = fit_curves(&curves, &check, 37e3).unwrap();
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-4;
        let Power { a, m, b, g, .. } = found.law;
        assert!(near(a, TRUE.a) && near(m, TRUE.m) && near(b, TRUE.b) && near(g, TRUE.g), "{found:?}");
        assert!(found.error() < 1e-4 && found.later < 1e-4, "{found:?}");
        assert_eq!((found.axles, found.most_axles()), (64, 10_000_000));
        assert_eq!(found.loads, [18.5e3, 1.8 * 37e3]);
    }

    #[test]
    fn scatter_shows_in_the_errors_and_bounds_the_axles() {
        let (curves, check) = specimens(0.3);
        let found = fit_curves(&curves, &check, 37e3).unwrap();
        assert!((0.02..0.5).contains(&found.error()), "{}", found.error());
        assert!((64..10_000_000).contains(&found.most_axles()), "{}", found.most_axles());
        assert!((found.law.m / TRUE.m - 1.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn beds_that_do_not_settle_tell_no_law() {
        let (mut curves, check) = specimens(0.0);
        curves.truncate(1);
        assert!(fit_curves(&curves, &check, 37e3).is_err(), "one load does not tell force from cycles");
    }
}
