//! One support under one law: the cycles that it has carried, and its settlement.
//!
//! The parameters of a law are stored together with the state for this law, so that a state is never used with another
//! law.

use super::guerin::Guerin;
use super::hardening::HardeningState;
use super::hettler::Hettler;
use super::law::{CyclePer, Form, Law};
use super::nasrollahi::Nasrollahi;
use super::peak::Peak;
use super::power::Power;
use super::sato::Sato;
use super::shenton::Shenton;
use super::varandas::{Varandas, VarandasState};
use serde::{Deserialize, Serialize};

/// A support under a [`Law`], with the complete state on which its further settlement depends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SupportState {
    cycle_per: CyclePer,
    memory: Memory,
}

/// The form of a law, and its state: a settlement, m, if nothing else is needed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Memory {
    Varandas(Varandas, VarandasState),
    Nasrollahi(Nasrollahi, f64),
    Guerin(Guerin, f64),
    Sato(Sato, HardeningState),
    Shenton(Shenton, HardeningState),
    Hettler(Hettler, HardeningState),
    Power(Power, HardeningState),
}

impl Law {
    /// A support that has carried no load yet.
    pub fn fresh(&self) -> SupportState {
        let memory = match self.form {
            Form::Varandas(law) => Memory::Varandas(law, VarandasState::default()),
            Form::Nasrollahi(law) => Memory::Nasrollahi(law, 0.0),
            Form::Guerin(law) => Memory::Guerin(law, 0.0),
            Form::Sato(law) => Memory::Sato(law, HardeningState::default()),
            Form::Shenton(law) => Memory::Shenton(law, HardeningState::default()),
            Form::Hettler(law) => Memory::Hettler(law, HardeningState::default()),
            Form::Power(law) => Memory::Power(law, HardeningState::default()),
        };
        SupportState { cycle_per: self.cycle_per, memory }
    }
}

impl SupportState {
    /// Applies `trains` equal trains: `wheels` holds the peak of each wheel of one train, the leading wheel first. A
    /// cycle without a positive force causes no settlement.
    pub fn load(&mut self, wheels: &[Peak], trains: u64) {
        let cycles = wheels
            .chunks(self.cycle_per.axles())
            .map(|of_one| of_one.iter().copied().fold(Peak::default(), Peak::max))
            .filter(|peak| peak.force > 0.0 && peak.force.is_finite());
        let forces = cycles.clone().map(|peak| peak.force);
        match &mut self.memory {
            Memory::Varandas(_, state) => forces.for_each(|force| state.add_cycles(force, trains)),
            Memory::Nasrollahi(law, settlement) => {
                *settlement = law.after(*settlement, &forces.collect::<Vec<f64>>(), trains as f64);
            }
            Memory::Guerin(law, settlement) => {
                *settlement += cycles.map(|peak| law.of_cycle(peak.deflection)).sum::<f64>() * trains as f64;
            }
            Memory::Sato(law, state) => state.load(law, &cycles.collect::<Vec<Peak>>(), trains),
            Memory::Shenton(law, state) => state.load(law, &cycles.collect::<Vec<Peak>>(), trains),
            Memory::Hettler(law, state) => state.load(law, &cycles.collect::<Vec<Peak>>(), trains),
            Memory::Power(law, state) => state.load(law, &cycles.collect::<Vec<Peak>>(), trains),
        }
    }

    /// The law under which the support settles.
    pub fn law(&self) -> Law {
        let form = match self.memory {
            Memory::Varandas(law, _) => Form::Varandas(law),
            Memory::Nasrollahi(law, _) => Form::Nasrollahi(law),
            Memory::Guerin(law, _) => Form::Guerin(law),
            Memory::Sato(law, _) => Form::Sato(law),
            Memory::Shenton(law, _) => Form::Shenton(law),
            Memory::Hettler(law, _) => Form::Hettler(law),
            Memory::Power(law, _) => Form::Power(law),
        };
        Law { form, cycle_per: self.cycle_per }
    }

    /// Settlement since the support was fresh, m, positive down.
    pub fn settlement(&self) -> f64 {
        match &self.memory {
            Memory::Varandas(law, state) => law.settlement(state),
            Memory::Nasrollahi(_, settlement) | Memory::Guerin(_, settlement) => *settlement,
            Memory::Sato(_, state)
            | Memory::Shenton(_, state)
            | Memory::Hettler(_, state)
            | Memory::Power(_, state) => state.settlement(),
        }
    }
}
