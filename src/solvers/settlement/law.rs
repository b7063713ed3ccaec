//! Common parts of all laws: the cycles, their forms and parameters.

use super::guerin::Guerin;
use super::hettler::Hettler;
use super::nasrollahi::Nasrollahi;
use super::power::Power;
use super::sato::Sato;
use super::shenton::Shenton;
use super::varandas::Varandas;
use serde::{Deserialize, Serialize};

/// The unit of one cycle of a law: the wheels of one axle, bogie or vehicle, reduced to their largest peak.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CyclePer {
    Axle,
    Bogie,
    Vehicle,
}

impl CyclePer {
    /// Axles that make one cycle; vehicles have four axles on two bogies.
    pub fn axles(self) -> usize {
        match self {
            CyclePer::Axle => 1,
            CyclePer::Bogie => 2,
            CyclePer::Vehicle => 4,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            CyclePer::Axle => "axle",
            CyclePer::Bogie => "bogie",
            CyclePer::Vehicle => "vehicle",
        }
    }
}

/// The published form of a law, with its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Form {
    Varandas(Varandas),
    Nasrollahi(Nasrollahi),
    Sato(Sato),
    Shenton(Shenton),
    Hettler(Hettler),
    Guerin(Guerin),
    Power(Power),
}

/// A settlement law, the same for all supports.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Law {
    pub form: Form,
    pub cycle_per: CyclePer,
}

impl Form {
    /// The form with this name and the values of its publication, to be changed through [`Form::parameters`].
    pub fn of_name(name: &str) -> Option<Form> {
        Some(match name {
            "varandas" => Form::Varandas(Varandas::default()),
            "nasrollahi" => Form::Nasrollahi(Nasrollahi::default()),
            "sato" => Form::Sato(Sato::default()),
            "shenton" => Form::Shenton(Shenton::default()),
            "hettler" => Form::Hettler(Hettler::default()),
            "guerin" => Form::Guerin(Guerin::default()),
            "power" => Form::Power(Power::default()),
            _ => return None,
        })
    }

    pub fn name(&self) -> &'static str {
        match self {
            Form::Varandas(_) => "varandas",
            Form::Nasrollahi(_) => "nasrollahi",
            Form::Sato(_) => "sato",
            Form::Shenton(_) => "shenton",
            Form::Hettler(_) => "hettler",
            Form::Guerin(_) => "guerin",
            Form::Power(_) => "power",
        }
    }

    /// Every number of the form under its name, SI, per half sleeper.
    pub fn parameters(&mut self) -> Vec<(&'static str, &mut f64)> {
        match self {
            Form::Varandas(l) => vec![
                ("alpha", &mut l.alpha),
                ("beta", &mut l.beta),
                ("gamma", &mut l.gamma),
                ("reference_cycles", &mut l.reference_cycles),
                ("reference_force", &mut l.reference_force),
            ],
            Form::Nasrollahi(l) => vec![
                ("alpha", &mut l.alpha),
                ("beta", &mut l.beta),
                ("gamma", &mut l.gamma),
                ("initial_threshold", &mut l.initial_threshold),
                ("final_threshold", &mut l.final_threshold),
                ("reference_force", &mut l.reference_force),
                ("reference_cycles", &mut l.reference_cycles),
            ],
            Form::Sato(l) => vec![
                ("alpha", &mut l.alpha),
                ("beta", &mut l.beta),
                ("gamma", &mut l.gamma),
                ("exponent", &mut l.exponent),
                ("reference_force", &mut l.reference_force),
            ],
            Form::Shenton(l) => vec![
                ("k1", &mut l.k1),
                ("k2", &mut l.k2),
                ("exponent", &mut l.exponent),
                ("reference_force", &mut l.reference_force),
            ],
            Form::Hettler(l) => vec![
                ("s", &mut l.s),
                ("c", &mut l.c),
                ("exponent", &mut l.exponent),
                ("reference_force", &mut l.reference_force),
            ],
            Form::Guerin(l) => vec![
                ("alpha", &mut l.alpha),
                ("beta", &mut l.beta),
                ("reference_deflection", &mut l.reference_deflection),
            ],
            Form::Power(l) => {
                vec![
                    ("a", &mut l.a),
                    ("m", &mut l.m),
                    ("b", &mut l.b),
                    ("reference_force", &mut l.reference_force),
                    ("g", &mut l.g),
                ]
            }
        }
    }
}

impl Law {
    /// Whether only the force of a wheel on the ballast affects the settlement. Such a law gives more settlement if a
    /// stiffer track loads a sleeper more, and does not include the deflection of the subgrade.
    pub fn knows_forces_alone(&self) -> bool {
        !matches!(self.form, Form::Guerin(_))
    }

    /// Whether the void under a sleeper changes the settlement by a wheel.
    pub fn sees_voids(&self) -> bool {
        matches!(&self.form, Form::Power(law) if law.g != 0.0)
    }

    /// Force below which a fresh support does not settle, N; `None` for laws without a threshold.
    pub fn threshold(&self) -> Option<f64> {
        match &self.form {
            Form::Nasrollahi(law) => Some(law.initial_threshold),
            _ => None,
        }
    }
}
