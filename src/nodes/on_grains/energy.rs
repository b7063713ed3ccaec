//! Energy balance of a passage: rail, grains, soil, and the loss between them.

use super::passage::REACH;
use super::step::Coupled;
use super::wheels::WheelRun;
use super::{GrainGround, Stage, Telling};
use crate::nodes::{Load, NodeError};
use serde::Serialize;

/// Energies of one passage, J.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct PassageEnergy {
    /// Work of the wheels on the rail, as far as the rail moved under them.
    pub wheels: f64,
    /// Lost in rail, pads and springs beyond the grains.
    pub lost_in_track: f64,
    /// Lost by slip, by dashpots and by local damping of grains.
    pub slip: f64,
    pub dashpots: f64,
    pub local_damping: f64,
    /// Lost in the soil: by plastic flow, damping and through quiet faces.
    pub lost_in_soil: f64,
    /// Energy that one part gave and the next part did not receive.
    pub interfaces: f64,
    /// Energy that the balances of the parts do not explain, without interfaces.
    pub unaccounted: f64,
}

impl Coupled {
    /// Begins an account.
    pub fn watch_energy(&mut self) {
        self.rail.watch();
        for standing in &mut self.beds {
            standing.bed.watch_energy(true);
            if let Some(soil) = &mut standing.soil {
                soil.soil.watch(true);
            }
        }
    }

    /// The balance so far. The balance of the rail is half a step ahead of the others, so the work of its feet in that
    /// half step is subtracted.
    pub fn energy(&self) -> PassageEnergy {
        let rail = self.rail.energy().unwrap_or_default();
        let half = 0.5 * self.time_step();
        let turning = |foot: usize| self.rail.pitch(foot).map_or(0.0, |pitch| self.rail.turned(foot) * pitch.velocity);
        let ahead = |(foot, push): (usize, &f64)| half * (push * self.rail.underside(foot).velocity - turning(foot));
        let mut sum = PassageEnergy {
            wheels: rail.wheels,
            lost_in_track: rail.dissipated - rail.supports,
            interfaces: rail.pushes + self.pushes.iter().enumerate().map(ahead).sum::<f64>(),
            unaccounted: rail.residual(),
            ..PassageEnergy::default()
        };
        for standing in &self.beds {
            let grains = standing.bed.energy();
            sum.slip += grains.slip;
            sum.dashpots += grains.dashpot;
            sum.local_damping += grains.damping;
            sum.interfaces += grains.walls;
            sum.unaccounted += grains.residual();
            if let Some(soil) = &standing.soil {
                let soil = soil.soil.energy();
                sum.lost_in_soil += soil.plastic + soil.damping + soil.quiet;
                sum.interfaces += soil.external;
                sum.unaccounted += soil.residual();
            }
        }
        sum
    }
}

impl GrainGround<'_> {
    /// The balance of a passage with these wheel forces, on a copy. `tell` gets the progress.
    pub fn energy_of(&self, load: &Load<'_>, tell: &mut Telling<'_>) -> Result<PassageEnergy, NodeError> {
        let mut coupled = self.live_at_rest()?.coupled.clone();
        let none = || NodeError::Other { node: "grains".into(), why: "a passage brings no wheel forces".into() };
        let wheels = WheelRun::alone(load.passage.wheels.as_ref().ok_or_else(none)?);
        let [left, right] = self.parts().ends();
        let [begin, end] = wheels.within([left - REACH, right + REACH]).ok_or_else(none)?;
        coupled.watch_energy();
        coupled.run(
            end - begin,
            |time, loads| wheels.loads_at(begin + time, begin, loads),
            |time, _| tell(Stage::Passage, time / (end - begin)),
        )?;
        Ok(coupled.energy())
    }
}
