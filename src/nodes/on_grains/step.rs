//! One step of everything that moves together: grains, what stands on them, the rail over it and the soil below.
//!
//! All go by one leapfrog: forces at the present time, then velocities half a step on, then places. A bed computes its
//! forces and moves its grains; its sleepers wait until the forces of all beds are known. Then the rail gives the
//! motion of the sleepers, and the soil the motion of the floor. The interaction of two parts is one number at one
//! time: force, moment and power are the same on both sides. Rail and soil need the forces of sleepers and floors
//! alone, so they are computed beside the contacts between grains.

use super::soil::SoilBelow;
use crate::nodes::NodeError;
use crate::solvers::granular::{Bed, WallId};
use crate::solvers::track::{Leapfrog, WheelLoads};
use std::time::{Duration, Instant};

/// Steps between updates of inertia: loads form contacts.
pub const HOLD: u64 = 200;
/// Steps between reports, after which a run can stop and its state is offered: below 2 s on beds of a million grains. A
/// divisor of [`HOLD`].
pub const LISTEN: u64 = 10;

/// A bed with what stands on it and what lies below.
#[derive(Clone)]
pub struct StandingBed {
    pub bed: Bed<f32>,
    /// The sleepers, from left to right, each with its number among the carried feet of the rail.
    pub sleepers: Vec<(WallId, usize)>,
    pub soil: Option<SoilBelow>,
}

/// A rail over sleepers that stand on beds of grains, and on springs beyond.
#[derive(Clone)]
pub struct Coupled {
    pub rail: Leapfrog,
    pub beds: Vec<StandingBed>,
    /// Force of the grains on each carried foot at the start of the last step, N, positive up.
    pub pushes: Vec<f64>,
    /// Largest share of the mass of a bed that is added as inertia.
    pub added: f64,
    /// Time that the rail, the soil and the updates of inertia took so far.
    pub spent: Spent,
}

/// Time of steps outside the grains.
#[derive(Debug, Clone, Copy, Default)]
pub struct Spent {
    pub rail: Duration,
    pub soil: Duration,
    pub inertia: Duration,
}

impl Coupled {
    /// One step of all, under these wheels.
    pub fn step(&mut self, wheels: &WheelLoads<'_>) -> Result<(), NodeError> {
        in_turn(&mut self.beds, &mut self.rail, &mut self.pushes, &mut self.spent, wheels)
    }

    /// Length of a step, s.
    pub fn time_step(&self) -> f64 {
        self.rail.time_step()
    }

    /// Level of the underside of a carried foot, m below the level as built, at the time of the forces of the last
    /// step.
    pub fn level(&self, foot: usize) -> f64 {
        self.rail.view().underside_displacement(foot)
    }
}

/// The first bed computes the forces on its walls, then all others do; the rail steps when all these forces are known,
/// and each bed continues with the motion of the rail.
fn in_turn(
    beds: &mut [StandingBed],
    rail: &mut Leapfrog,
    pushes: &mut [f64],
    spent: &mut Spent,
    wheels: &WheelLoads<'_>,
) -> Result<(), NodeError> {
    let Some((StandingBed { bed, sleepers, soil }, others)) = beds.split_first_mut() else {
        let start = Instant::now();
        rail.step(pushes, wheels)?;
        spent.rail += start.elapsed();
        return Ok(());
    };
    bed.guided_step(|walls| {
        for (wall, foot) in &*sleepers {
            let felt = walls.felt(*wall);
            pushes[*foot] = felt.force.z;
            rail.hold(*foot, felt.stiffness, felt.dashpot)?;
            rail.turn(*foot, walls.moment(*wall)[1]);
        }
        in_turn(others, rail, pushes, spent, wheels)?;
        for (wall, foot) in &*sleepers {
            walls.drive(*wall, [0.0, 0.0, -rail.underside(*foot).velocity]);
            // a turn about y takes the side of larger x down, as the slope of the rail does
            if let Some(pitch) = rail.pitch(*foot) {
                walls.turn(*wall, [0.0, pitch.velocity, 0.0]);
            }
        }
        let start = Instant::now();
        soil.iter_mut().try_for_each(|soil| soil.step(walls))?;
        spent.soil += start.elapsed();
        Ok(())
    })
}
