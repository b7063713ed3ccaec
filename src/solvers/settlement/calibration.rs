//! Fits a law to a settlement curve that was measured under known trains.

use super::fit::{Fit, FitError, Parameter, fit};
use super::law::{Form, Law};
use super::peak::Peak;

/// A parameter of a law to be fitted, between bounds, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// The name of the parameter, one of [`Form::parameters`].
    pub name: String,
    pub low: f64,
    pub high: f64,
}

/// The trains under which a curve was measured, and the curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// Peaks of the wheels of one train, the leading one first.
    pub wheels: Vec<Peak>,
    /// Axles passed, ascending.
    pub axles: Vec<u64>,
    /// Settlement of the support after each of these numbers of axles, m.
    pub settlement: Vec<f64>,
}

impl Form {
    /// The parameters that are usually fitted: a test with one force can distinguish them.
    pub fn usual_parameters(&self) -> &'static [&'static str] {
        match self {
            Form::Varandas(_) => &["gamma", "beta"],
            Form::Nasrollahi(_) => &["alpha", "gamma"],
            Form::Sato(_) => &["gamma", "alpha", "beta"],
            Form::Shenton(_) => &["k1", "k2"],
            Form::Hettler(_) => &["s", "c"],
            Form::Guerin(_) => &["alpha"],
            Form::Power(_) => &["a", "b"],
        }
    }
}

/// Settlement after each number of axles, m. If a number ends within a train, the leading wheels of the train are used.
pub fn curve(law: &Law, wheels: &[Peak], axles: &[u64]) -> Vec<f64> {
    let of_train = wheels.len().max(1) as u64;
    let mut support = law.fresh();
    let mut trains = 0;
    let mut settlement = Vec::with_capacity(axles.len());
    for count in axles {
        support.load(wheels, (count / of_train).saturating_sub(trains));
        trains = trains.max(count / of_train);
        let mut there = support.clone();
        there.load(&wheels[..(count % of_train) as usize], 1);
        settlement.push(there.settlement());
    }
    settlement
}

/// The law with the parameters nearest to the curve; the search starts at the parameters of the law. The fit lists them
/// in the order of `wanted`.
pub fn calibrate(law: &Law, wanted: &[Wanted], measured: &Measured) -> Result<(Law, Fit), FitError> {
    let mut start = *law;
    let known = start.form.parameters();
    let parameters: Vec<Parameter> = wanted
        .iter()
        .filter_map(|wanted| {
            let (_, value) = known.iter().find(|(name, _)| *name == wanted.name)?;
            Some(Parameter { start: value.clamp(wanted.low, wanted.high), low: wanted.low, high: wanted.high })
        })
        .collect();
    let with = |values: &[f64]| {
        let mut law = *law;
        for (name, value) in law.form.parameters() {
            if let Some(k) = wanted.iter().position(|wanted| wanted.name == name) {
                *value = values[k];
            }
        }
        law
    };
    let found =
        fit(&parameters, &measured.settlement, |values| curve(&with(values), &measured.wheels, &measured.axles))?;
    Ok((with(&found.values), found))
}
