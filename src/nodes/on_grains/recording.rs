//! Volumes of grains in a passage that is recorded, and the sleepers over them (the paper's Figs. 17 and 18).
//!
//! The grains of a volume are those whose middle lies inside as the passage begins. Velocities are means over their
//! mass; their acceleration is the change of this mean over the interval of the histories, so that nothing between two
//! samples is lost. Stress and coordination are read where inertia is looked at.

use super::build::Parts;
use super::step::Coupled;
use crate::graph::{InVolume, VolumeUnderTrack};
use crate::nodes::NodeError;
use crate::solvers::granular::rig::Sensor;
use crate::solvers::granular::{Bed, BodyId};
use serde::{Deserialize, Serialize};

/// One value of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VolumeSample {
    /// Index into the volumes of the node.
    pub volume: usize,
    pub quantity: InVolume,
    /// On the clock of the wheels, s.
    pub time: f64,
    pub value: f64,
}

/// A passage that is recorded.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Recording {
    volumes: Vec<Inside>,
    pub samples: Vec<VolumeSample>,
    /// Heights of the undersides of the sleepers on each bed as built, m.
    pub tops: Vec<f64>,
    /// Place of the leading wheel at the last check, m, before it reaches the place at which the beds are recorded.
    leading: Option<f64>,
    has_come: bool,
}

/// A volume that is recorded.
#[derive(Clone, Serialize, Deserialize)]
struct Inside {
    volume: usize,
    /// Number of the sleeper over it among the carried feet.
    foot: usize,
    /// Height of the undersides of the sleepers as built, m.
    top: f64,
    bodies: Vec<u32>,
    /// Mean velocity at the last sample, m/s, and when that was, s.
    before: Option<(f64, f64)>,
}

impl Recording {
    /// Begins the record of a passage after so many axles.
    pub fn begin(coupled: &Coupled, tops: Vec<f64>, parts: Parts<'_>, axles: u64) -> Recording {
        let wanted = parts.grains.volumes.iter().enumerate().filter(|(_, volume)| volume.after.contains(&axles));
        let inside = |(number, volume): (usize, &VolumeUnderTrack)| {
            let (bed, top) = (&coupled.beds[volume.stretch].bed, tops[volume.stretch]);
            let region = volume.sensor.region(top)?;
            let inside = bed.states().filter(|state| region.holds(&state.place));
            let bodies = inside.map(|state| state.id.0).collect();
            let foot = coupled.rail.carried().binary_search(&volume.seat).ok()?;
            Some(Inside { volume: number, foot, top, bodies, before: None })
        };
        let volumes = wanted.filter_map(inside).collect();
        Recording { volumes, samples: Vec::new(), tops, leading: None, has_come: false }
    }

    /// Whether the leading wheel comes to a place (m) with this look; it is told once.
    pub fn wheel_comes(&mut self, leading: f64, place: f64) -> bool {
        let before = self.leading.replace(leading);
        let comes = !self.has_come && before.is_some_and(|before| (before - place) * (leading - place) <= 0.0);
        self.has_come |= comes;
        comes
    }

    /// Looks after a step, where a sample is due.
    pub fn see(&mut self, coupled: &Coupled, parts: Parts<'_>, step: u64, time: f64) {
        let view = coupled.rail.view();
        for inside in &mut self.volumes {
            let volume = &parts.grains.volumes[inside.volume];
            let every = (volume.every / coupled.time_step()).round().max(1.0) as u64;
            if !step.is_multiple_of(every) {
                continue;
            }
            let velocity = inside.velocity(&coupled.beds[volume.stretch].bed);
            let before = inside.before.replace((time, velocity));
            let acceleration = before.map(|(then, before)| (velocity - before) / (time - then));
            let mut put = |quantity: InVolume, value: f64| {
                self.samples.push(VolumeSample { volume: inside.volume, quantity, time, value });
            };
            if volume.quantities.contains(&InVolume::BallastVelocity) {
                put(InVolume::BallastVelocity, velocity);
            }
            if let Some(acceleration) =
                acceleration.filter(|_| volume.quantities.contains(&InVolume::BallastAcceleration))
            {
                put(InVolume::BallastAcceleration, acceleration);
            }
            put(InVolume::SleeperVelocity, view.foot_velocity(volume.seat));
            put(InVolume::SleeperAcceleration, view.foot_acceleration(volume.seat));
            put(InVolume::SleeperForce, coupled.pushes[inside.foot]);
        }
    }

    /// Reads stress and coordination, where they are asked for.
    pub fn read_contacts(&mut self, coupled: &mut Coupled, parts: Parts<'_>, time: f64) -> Result<(), NodeError> {
        for inside in &self.volumes {
            let volume = &parts.grains.volumes[inside.volume];
            let asked = |quantity| volume.quantities.contains(&quantity);
            let (stress, coordination) = (asked(InVolume::BallastStress), asked(InVolume::CoordinationNumber));
            let Some(region) = volume.sensor.region(inside.top).filter(|_| stress || coordination) else { continue };
            let bed = &mut coupled.beds[volume.stretch].bed;
            let snapshot = bed.snapshot()?;
            let reading = Sensor { region }.read(bed, &snapshot);
            let both = [
                (stress, InVolume::BallastStress, reading.stress),
                (coordination, InVolume::CoordinationNumber, reading.coordination),
            ];
            let asked = both.into_iter().filter(|(asked, ..)| *asked);
            let sample = |(_, quantity, value)| VolumeSample { volume: inside.volume, quantity, time, value };
            self.samples.extend(asked.map(sample));
        }
        Ok(())
    }
}

impl Inside {
    /// Mean over the mass of its grains, downward, m/s.
    fn velocity(&self, bed: &Bed<f32>) -> f64 {
        let states = self.bodies.iter().map(|body| bed.body_state(BodyId(*body)));
        let add = |(mass, momentum), (m, v): (f64, f64)| (mass + m, momentum - m * v);
        let (mass, momentum) = states.map(|state| (state.mass, state.velocity[2])).fold((0.0, 0.0), add);
        if mass > 0.0 { momentum / mass } else { 0.0 }
    }
}
