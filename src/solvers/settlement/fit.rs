//! Fits parameters of a model to measured values: least squares by Levenberg and Marquardt, within bounds.
//!
//! The sum of squares uses absolute residuals: all measurements are assumed to be equally uncertain. A parameter with a
//! positive lower bound is varied by its logarithm, so that the method works equally for sizes from micrometres to
//! metres; other parameters are varied as shares of their start. A step that would leave the bounds ends on them, and a
//! parameter that the data press against its bound stays there.

use nalgebra::{DMatrix, DVector};

/// A parameter to be fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Between the bounds.
    pub start: f64,
    pub low: f64,
    pub high: f64,
}

/// The best parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    pub values: Vec<f64>,
    /// From the curvature of the sum of squares and its value; `None` for a parameter at a bound.
    pub standard_errors: Vec<Option<f64>>,
    /// Root of the mean square of the residuals, in the unit of the measurements.
    pub rms: f64,
    /// Evaluations of the model.
    pub evaluations: usize,
}

/// Why there is no best set of parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum FitError {
    /// There are not more measurements than parameters.
    TooFew { needed: usize },
    /// The model does not depend on these parameters.
    NoEffect { parameters: Vec<usize> },
    /// These parameters have the same effect as other parameters of the list.
    Alike { parameters: Vec<usize> },
    /// The model gives no finite number at the start.
    NotFinite,
}

/// Largest number of steps; ten to thirty are usual.
const MOST_STEPS: usize = 300;
/// Relative change of the sum of squares at which the search ends.
const SETTLED: f64 = 1e-15;
/// Step of finite differences, as a share of a coordinate.
const DIFFERENCE: f64 = 1e-5;
/// Below this share of the largest singular value, a direction in the space of parameters counts as without effect.
const SINGULAR: f64 = 1e-5;

/// Fits `model`, which gives one value per measurement.
pub fn fit(parameters: &[Parameter], measured: &[f64], model: impl Fn(&[f64]) -> Vec<f64>) -> Result<Fit, FitError> {
    if measured.len() <= parameters.len() {
        return Err(FitError::TooFew { needed: parameters.len() + 1 });
    }
    let mut problem = Problem { parameters, measured, model, evaluations: 0 };
    let mut at: Vec<f64> = parameters.iter().map(|p| p.coordinate(p.start)).collect();
    let mut residuals = problem.residuals(&at).ok_or(FitError::NotFinite)?;
    let mut damping = 1e-3;
    for _ in 0..MOST_STEPS {
        let jacobian = problem.jacobian(&at, &residuals);
        let Some((next, next_residuals)) = problem.step(&at, &residuals, &jacobian, &mut damping) else { break };
        let (before, after) = (residuals.norm_squared(), next_residuals.norm_squared());
        (at, residuals) = (next, next_residuals);
        if before - after <= SETTLED * before {
            break;
        }
    }
    let jacobian = problem.jacobian(&at, &residuals);
    let free = problem.free(&at, &jacobian.tr_mul(&residuals));
    problem.identifiable(&jacobian, &free)?;
    Ok(problem.finish(&at, &residuals, &jacobian, &free))
}

impl Parameter {
    fn by_logarithm(&self) -> bool {
        self.low > 0.0
    }

    /// Value of a coordinate of 1 if the coordinate is not a logarithm: the start, or a part of the range.
    fn unit(&self) -> f64 {
        if self.start == 0.0 { 1e-3 * (self.high - self.low) } else { self.start.abs() }
    }

    /// The coordinate of a value.
    fn coordinate(&self, value: f64) -> f64 {
        if self.by_logarithm() { value.ln() } else { value / self.unit() }
    }

    /// The value of a coordinate; never outside the bounds.
    fn value(&self, coordinate: f64) -> f64 {
        let value = if self.by_logarithm() { coordinate.exp() } else { coordinate * self.unit() };
        value.clamp(self.low, self.high)
    }

    /// d value / d coordinate.
    fn scale(&self, coordinate: f64) -> f64 {
        if self.by_logarithm() { self.value(coordinate) } else { self.unit() }
    }

    fn bounds(&self) -> (f64, f64) {
        (self.coordinate(self.low), self.coordinate(self.high))
    }
}

struct Problem<'a, M> {
    parameters: &'a [Parameter],
    measured: &'a [f64],
    model: M,
    evaluations: usize,
}

impl<M: Fn(&[f64]) -> Vec<f64>> Problem<'_, M> {
    fn values(&self, at: &[f64]) -> Vec<f64> {
        self.parameters.iter().zip(at).map(|(p, c)| p.value(*c)).collect()
    }

    /// Model minus measurement; `None` if the model fails.
    fn residuals(&mut self, at: &[f64]) -> Option<DVector<f64>> {
        self.evaluations += 1;
        let found = (self.model)(&self.values(at));
        let residuals = found.iter().zip(self.measured).map(|(f, m)| f - m);
        Some(DVector::from_iterator(self.measured.len(), residuals)).filter(|r| r.iter().all(|r| r.is_finite()))
    }

    /// Derivatives of the residuals by the coordinates, one column per parameter; one-sided beside a bound.
    fn jacobian(&mut self, at: &[f64], here: &DVector<f64>) -> DMatrix<f64> {
        let mut jacobian = DMatrix::zeros(self.measured.len(), at.len());
        for (i, parameter) in self.parameters.iter().enumerate() {
            let (low, high) = parameter.bounds();
            let mut side = |distance: f64| {
                let mut moved = at.to_vec();
                moved[i] = (at[i] + distance).clamp(low, high);
                let residuals = self.residuals(&moved).unwrap_or_else(|| here.clone());
                (moved[i], residuals)
            };
            let ((left, below), (right, above)) = (side(-DIFFERENCE), side(DIFFERENCE));
            if right > left {
                jacobian.set_column(i, &((above - below) / (right - left)));
            }
        }
        jacobian
    }

    /// Parameters that the data do not press against a bound, from the gradient of half the sum of squares.
    fn free(&self, at: &[f64], gradient: &DVector<f64>) -> Vec<usize> {
        let rests = |i: &usize| {
            let (low, high) = self.parameters[*i].bounds();
            (at[*i] <= low && gradient[*i] >= 0.0) || (at[*i] >= high && gradient[*i] <= 0.0)
        };
        (0..at.len()).filter(|i| !rests(i)).collect()
    }

    /// A step that reduces the sum of squares; `None` if no step does.
    fn step(
        &mut self,
        at: &[f64],
        residuals: &DVector<f64>,
        jacobian: &DMatrix<f64>,
        damping: &mut f64,
    ) -> Option<(Vec<f64>, DVector<f64>)> {
        let gradient = jacobian.tr_mul(residuals);
        let free = self.free(at, &gradient);
        if free.is_empty() {
            return None;
        }
        let columns = jacobian.select_columns(&free);
        let normal = columns.tr_mul(&columns);
        let right = DVector::from_iterator(free.len(), free.iter().map(|i| -gradient[*i]));
        let largest = normal.diagonal().max();
        while *damping < 1e15 {
            let mut damped = normal.clone();
            for i in 0..free.len() {
                damped[(i, i)] += *damping * normal[(i, i)].max(1e-12 * largest).max(f64::MIN_POSITIVE);
            }
            if let Some(factor) = damped.cholesky() {
                let change = factor.solve(&right);
                let mut next = at.to_vec();
                for (i, change) in free.iter().zip(change.iter()) {
                    let (low, high) = self.parameters[*i].bounds();
                    // by a factor of at most e^2, or by at most ten times the start
                    let most = if self.parameters[*i].by_logarithm() { 2.0 } else { 10.0 };
                    next[*i] = (at[*i] + change.clamp(-most, most)).clamp(low, high);
                }
                if let Some(there) = self.residuals(&next).filter(|r| r.norm_squared() < residuals.norm_squared()) {
                    *damping = (*damping / 10.0).max(1e-12);
                    return Some((next, there));
                }
            }
            *damping *= 10.0;
        }
        *damping = 1e-3;
        None
    }

    /// Fails unless every free parameter has an effect that differs from the others.
    fn identifiable(&self, jacobian: &DMatrix<f64>, free: &[usize]) -> Result<(), FitError> {
        let size = self.measured.iter().map(|m| m * m).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        let without: Vec<usize> = free.iter().copied().filter(|i| jacobian.column(*i).norm() < 1e-9 * size).collect();
        if !without.is_empty() {
            return Err(FitError::NoEffect { parameters: without });
        }
        if free.is_empty() {
            return Ok(());
        }
        let mut columns = jacobian.select_columns(free);
        for mut column in columns.column_iter_mut() {
            column /= column.norm();
        }
        let decomposed = columns.svd(false, true);
        let least = decomposed.singular_values.imin();
        let Some(directions) = decomposed.v_t else { return Ok(()) };
        if decomposed.singular_values[least] > SINGULAR * decomposed.singular_values.max() {
            return Ok(());
        }
        let alike = free.iter().enumerate().filter(|(k, _)| directions[(least, *k)].abs() > 0.1).map(|(_, i)| *i);
        Err(FitError::Alike { parameters: alike.collect() })
    }

    fn finish(&self, at: &[f64], residuals: &DVector<f64>, jacobian: &DMatrix<f64>, free: &[usize]) -> Fit {
        let count = self.measured.len();
        let variance = residuals.norm_squared() / (count - free.len()) as f64;
        let columns = jacobian.select_columns(free);
        let inverse = columns.tr_mul(&columns).try_inverse();
        let mut standard_errors = vec![None; at.len()];
        for (k, i) in free.iter().enumerate() {
            let spread = inverse.as_ref().map(|m| (variance * m[(k, k)]).max(0.0).sqrt());
            standard_errors[*i] = spread.map(|s| s * self.parameters[*i].scale(at[*i]));
        }
        Fit {
            values: self.values(at),
            standard_errors,
            rms: (residuals.norm_squared() / count as f64).sqrt(),
            evaluations: self.evaluations,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CyclePer, Form, Law, Peak, Varandas};
    use super::*;

    const COUNTS: [u64; 8] = [1, 10, 50, 200, 1_000, 5_000, 20_000, 100_000];

    /// Settlement in m after each count of equal peaks of 40 kN.
    fn curve(form: Form) -> Vec<f64> {
        let law = Law { form, cycle_per: CyclePer::Axle };
        let settled = |count: &u64| {
            let mut state = law.fresh();
            state.load(&[Peak { force: 40e3, deflection: 1e-3, void: 0.0 }], *count);
            state.settlement()
        };
        COUNTS.iter().map(settled).collect()
    }

    /// Fits some parameters of a form, from its values times `off`.
    fn refit(form: Form, names: &[&str], off: f64, measured: &[f64]) -> Result<Fit, FitError> {
        let mut first = form;
        let known = first.parameters();
        let parameters: Vec<Parameter> = names
            .iter()
            .filter_map(|name| known.iter().find(|(n, _)| n == name))
            .map(|(_, value)| Parameter { start: **value * off, low: **value * 1e-3, high: **value * 1e3 })
            .collect();
        fit(&parameters, measured, |values| {
            let mut form = form;
            for (name, value) in form.parameters() {
                if let Some(k) = names.iter().position(|n| *n == name) {
                    *value = values[k];
                }
            }
            curve(form)
        })
    }

    fn forms() -> Vec<(Form, &'static [&'static str])> {
        let named = |name: &str| Form::of_name(name).unwrap();
        vec![
            (named("varandas"), &["beta", "gamma"]),
            (named("nasrollahi"), &["alpha", "gamma"]),
            (named("sato"), &["alpha", "beta", "gamma"]),
            (named("shenton"), &["k1", "k2"]),
            (named("hettler"), &["s", "c"]),
            (named("guerin"), &["alpha"]),
            (named("power"), &["a", "b"]),
        ]
    }

    #[test]
    fn fits_its_own_curve() {
        for (mut form, names) in forms() {
            let measured = curve(form);
            let fit = refit(form, names, 1.4, &measured).unwrap();
            let known = form.parameters();
            for (name, value) in names.iter().zip(&fit.values) {
                let truth = known.iter().find(|(n, _)| n == name).map(|(_, v)| **v).unwrap();
                assert!((value / truth - 1.0).abs() < 1e-6, "{name}: {value} {truth}");
            }
            assert!(fit.rms < 1e-6 * measured[7] && fit.evaluations < 400, "{fit:?}");
        }
    }

    /// Noise of 2 % of the last value, the same at every run: the truth within three standard errors.
    #[test]
    fn noise_shows_in_the_standard_errors() {
        for (mut form, names) in forms() {
            let mut measured = curve(form);
            let size = 0.02 * measured[7];
            let mut seed = 7u64;
            for value in &mut measured {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                *value += size * ((seed >> 33) as f64 / 2f64.powi(30) - 1.0);
            }
            let fit = refit(form, names, 1.2, &measured).unwrap();
            assert!(fit.rms > 0.1 * size && fit.rms < 1.2 * size, "{}: {}", form.name(), fit.rms / size);
            let known = form.parameters();
            for ((name, value), error) in names.iter().zip(&fit.values).zip(&fit.standard_errors) {
                let truth = known.iter().find(|(n, _)| n == name).map(|(_, v)| **v).unwrap();
                // a parameter whose effect is hidden by noise may be at its bound
                let Some(error) = error else { continue };
                assert!((value - truth).abs() < 3.0 * error, "{name}: {value} {truth} {error}");
            }
        }
    }

    #[test]
    fn what_cannot_be_told_is_said() {
        let form = Form::Varandas(Varandas::default());
        let measured = curve(form);
        let alike = refit(form, &["gamma", "reference_force"], 1.1, &measured);
        assert_eq!(alike, Err(FitError::Alike { parameters: vec![0, 1] }));
        let idle = refit(Form::of_name("sato").unwrap(), &["gamma", "reference_force"], 1.1, &measured);
        assert_eq!(idle, Err(FitError::NoEffect { parameters: vec![1] }));
        let few = refit(form, &["gamma", "beta"], 1.0, &measured[..2]);
        assert_eq!(few, Err(FitError::TooFew { needed: 3 }));
    }

    /// If the data require a parameter beyond its bound, it stays at the bound, and the others are fitted.
    #[test]
    fn bounds_hold() {
        let measured = [1.0, 2.0, 3.0, 4.0];
        let parameters =
            [Parameter { start: 0.5, low: 0.0, high: 0.8 }, Parameter { start: 0.3, low: -1.0, high: 1.0 }];
        let line = |v: &[f64]| (1..5).map(|x| v[0] * f64::from(x) + v[1]).collect();
        let found = fit(&parameters, &measured, line).unwrap();
        assert_eq!(found.values[0], 0.8);
        assert!(found.standard_errors[0].is_none() && found.standard_errors[1].is_some());
        assert!((found.values[1] - 0.5).abs() < 1e-9);
    }
}
