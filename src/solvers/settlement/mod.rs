//! How far a support has settled after the wheels that it has carried: the laws, and what each remembers.
//!
//! A law sees, of every wheel, the [`Peak`] of what its support felt. How many wheels make one of its cycles is the law's
//! [`CyclePer`]: publications differ, and some do not say.

mod calibration;
pub mod fit;
mod guerin;
mod hardening;
mod hettler;
mod nasrollahi;
mod power;
mod sato;
mod shenton;
mod varandas;

pub use calibration::{Measured, Wanted, calibrate, curve};
pub use guerin::Guerin;
pub use hardening::HardeningState;
pub use hettler::{Hettler, Logarithm};
pub use nasrollahi::Nasrollahi;
pub use power::Power;
pub use sato::Sato;
pub use shenton::Shenton;
pub use varandas::{Varandas, VarandasState};

use hardening::Growth;
use serde::{Deserialize, Serialize};

/// The most that a support feels while one wheel passes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Peak {
    /// Contact force of the half sleeper on its support, N.
    pub force: f64,
    /// How far the sleeper presses the support below its unloaded level, m.
    pub deflection: f64,
}

impl Peak {
    /// The larger of both in each respect.
    pub fn max(self, other: Peak) -> Peak {
        Peak { force: self.force.max(other.force), deflection: self.deflection.max(other.deflection) }
    }

    /// The same peak, stronger or weaker by a factor on a linear support.
    pub fn scaled(self, factor: f64) -> Peak {
        Peak { force: self.force * factor, deflection: self.deflection * factor }
    }
}

/// What one cycle of a law is: the wheels of one axle, bogie or vehicle, reduced to their largest peak.
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

/// What one support remembers of its history under a [`Law`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SupportState {
    Varandas(VarandasState),
    Hardening(HardeningState),
    /// Laws whose settlement, m, is all that there is to know.
    Settled(f64),
}

impl Form {
    /// The form of that name with the values of its publication, to be filled through [`Form::parameters`].
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
                vec![("a", &mut l.a), ("m", &mut l.m), ("b", &mut l.b), ("reference_force", &mut l.reference_force)]
            }
        }
    }
}

impl Law {
    /// A support that has carried nothing yet.
    pub fn fresh(&self) -> SupportState {
        match self.form {
            Form::Varandas(_) => SupportState::Varandas(VarandasState::default()),
            Form::Sato(_) | Form::Shenton(_) | Form::Hettler(_) | Form::Power(_) => {
                SupportState::Hardening(HardeningState::default())
            }
            Form::Nasrollahi(_) | Form::Guerin(_) => SupportState::Settled(0.0),
        }
    }

    /// Lets `trains` equal trains pass: `wheels` holds the peak of each wheel of one of them, the leading one first. A cycle
    /// whose force is not positive settles nothing.
    pub fn load(&self, state: &mut SupportState, wheels: &[Peak], trains: u64) {
        let cycles = wheels
            .chunks(self.cycle_per.axles())
            .map(|of_one| of_one.iter().copied().fold(Peak::default(), Peak::max))
            .filter(|peak| peak.force > 0.0 && peak.force.is_finite());
        match (&self.form, state) {
            (Form::Varandas(_), SupportState::Varandas(state)) => {
                cycles.for_each(|peak| state.add_cycles(peak.force, trains));
            }
            (Form::Guerin(law), SupportState::Settled(settlement)) => {
                *settlement += cycles.map(|peak| law.of_cycle(peak.deflection)).sum::<f64>() * trains as f64;
            }
            (Form::Nasrollahi(law), SupportState::Settled(settlement)) => {
                let forces: Vec<f64> = cycles.map(|peak| peak.force).collect();
                *settlement = law.after(*settlement, &forces, trains as f64);
            }
            (form, SupportState::Hardening(state)) => {
                let forces: Vec<f64> = cycles.map(|peak| peak.force).collect();
                if let Some(growth) = form.growth() {
                    state.load(growth, &forces, trains);
                }
            }
            _ => {}
        }
    }

    /// Settlement since the support was fresh, m, positive down.
    pub fn settlement(&self, state: &SupportState) -> f64 {
        match (&self.form, state) {
            (Form::Varandas(law), SupportState::Varandas(state)) => law.settlement(state),
            (_, SupportState::Hardening(state)) => state.settlement(),
            (_, SupportState::Settled(settlement)) => *settlement,
            _ => 0.0,
        }
    }

    /// Force below which a fresh support does not settle, N; `None` for laws without a threshold.
    pub fn threshold(&self) -> Option<f64> {
        match &self.form {
            Form::Nasrollahi(law) => Some(law.initial_threshold),
            _ => None,
        }
    }
}

impl Form {
    /// Laws stated as S(N) under a constant load.
    fn growth(&self) -> Option<&dyn Growth> {
        match self {
            Form::Sato(law) => Some(law),
            Form::Shenton(law) => Some(law),
            Form::Hettler(law) => Some(law),
            Form::Power(law) => Some(law),
            Form::Varandas(_) | Form::Nasrollahi(_) | Form::Guerin(_) => None,
        }
    }
}

#[cfg(test)]
mod tests;
