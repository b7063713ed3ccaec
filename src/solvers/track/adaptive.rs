//! Time steps of varying length: halved if the motion changes within a step, doubled again if the motion is calm.
//!
//! The error of a step is the difference between its displacement and the displacement of the next order
//! (Zienkiewicz and Xie 1991, doi 10.1002/eqe.4290200907):
//!
//! ```text
//! e = |β - 1/6| Δt² max |a_{n+1} - a_n|        over rail deflections, sleepers and vehicles, m
//! ```
//!
//! Rails with shear are left out: their nodes jump whenever a wheel passes a node, because of the mesh and not of the
//! step.
//!
//! A step whose error is above the tolerance is taken back and halved, down to the shortest step of the ladder. The
//! shortest step is kept even if its error is above the tolerance; such steps are counted. As e falls with Δt³, the
//! step is doubled if its error is below a twelfth of the tolerance and the longer step begins on its own grid. So
//! every time that a longer step reaches is also reached by all shorter steps.

use super::error::{TrackError, TrackParameter};
use super::influence::Stepper;
use super::ladder::{Before, Choice, Ladder};
use super::model::TrackLevel;
use super::passage::{Passage, Run};

/// Share of the tolerance below which the step may be doubled. Its error then grows eightfold; a factor of 1.5 is kept
/// as reserve.
const CALM: f64 = 1.0 / 12.0;

impl<'a> Passage<'a> {
    /// Places the train at its start as [`Passage::new`] does, to run in steps of the ladder. The error of a step stays
    /// below `tolerance` times the largest deflection of the rail under the train at its start, if the ladder is long
    /// enough; [`Counters`](super::Counters) counts the other steps. Fails also if the tolerance is not above 0.
    pub fn adaptive(
        ladder: &'a Ladder,
        level: &'a TrackLevel,
        run: Run<'a>,
        tolerance: f64,
    ) -> Result<Self, TrackError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(TrackError::Parameter {
                name: TrackParameter::Tolerance,
                value: tolerance,
                expected: "above 0",
            });
        }
        let mut passage = Self::new(ladder.longest(), level, run)?;
        passage.divide_ticks(ladder.rungs.len() as u32 - 1);
        let rail = passage.stepper.track.rail.iter().zip(&passage.unloaded.rail_deflection);
        let largest = rail.map(|(w, unloaded)| (passage.displacement[*w] - unloaded).abs()).fold(0.0, f64::max);
        let tolerance = tolerance * largest;
        passage.choice = Some(Box::new(Choice { ladder, rung: 0, tolerance, before: Before::default() }));
        Ok(passage)
    }

    /// One step of the length that the error requires.
    pub(super) fn chosen_step(&mut self, choice: &mut Choice<'a>) -> Result<(), TrackError> {
        self.save(&mut choice.before);
        loop {
            let shortest = choice.rung + 1 == choice.ladder.rungs.len();
            let outcome = self.step_once();
            let error = match outcome {
                Ok(()) => self.error_of_step(&choice.before),
                Err(TrackError::StepNotConverged { .. } | TrackError::Unstable { .. }) if !shortest => f64::INFINITY,
                Err(error) => return Err(error),
            };
            if error <= choice.tolerance || shortest {
                self.counters.beyond_tolerance += usize::from(error > choice.tolerance);
                if error < CALM * choice.tolerance && choice.rung > 0 {
                    let longer = choice.rung - 1;
                    if self.tick.is_multiple_of(self.ticks_of(&choice.ladder.rungs[longer])) {
                        choice.rung = longer;
                        self.change_step(&choice.ladder.rungs[longer])?;
                    }
                }
                return Ok(());
            }
            self.restore(&choice.before);
            self.counters.rejected += 1;
            choice.rung += 1;
            self.change_step(&choice.ladder.rungs[choice.rung])?;
        }
    }

    fn error_of_step(&self, before: &Before) -> f64 {
        let (scheme, track) = (&self.stepper.scheme, &self.stepper.track);
        let change = |i: usize| (self.acceleration[i] - before.track[2][i]).abs();
        let of_rail = track.rail.iter().filter(|_| !track.model.shears()).map(|w| change(*w));
        let of_sleepers = track.sleepers.iter().map(|s| change(s.unknown));
        let of_vehicles =
            self.vehicles.iter().zip(&before.vehicles).flat_map(|((vehicle, _), before)| {
                vehicle.acceleration.iter().zip(&before[2]).map(|(a, b)| (a - b).abs())
            });
        let largest = of_rail.chain(of_sleepers).chain(of_vehicles).fold(0.0, f64::max);
        (scheme.beta - 1.0 / 6.0).abs() * scheme.time_step * scheme.time_step * largest
    }

    fn save(&self, before: &mut Before) {
        before.tick = self.tick;
        for (kept, now) in before.track.iter_mut().zip([&self.displacement, &self.velocity, &self.acceleration]) {
            kept.clone_from(now);
        }
        before.vehicles.resize(self.vehicles.len(), Default::default());
        for (kept, (vehicle, _)) in before.vehicles.iter_mut().zip(&self.vehicles) {
            for (kept, now) in kept.iter_mut().zip([&vehicle.displacement, &vehicle.velocity, &vehicle.acceleration]) {
                kept.clone_from(now);
            }
        }
        self.interface.save(&mut before.interface);
        before.support_forces.clone_from(&self.support_forces);
    }

    fn restore(&mut self, before: &Before) {
        self.tick = before.tick;
        let [displacement, velocity, acceleration] = &before.track;
        self.displacement.clone_from(displacement);
        self.velocity.clone_from(velocity);
        self.acceleration.clone_from(acceleration);
        for ((vehicle, _), [displacement, velocity, acceleration]) in self.vehicles.iter_mut().zip(&before.vehicles) {
            vehicle.displacement.clone_from(displacement);
            vehicle.velocity.clone_from(velocity);
            vehicle.acceleration.clone_from(acceleration);
        }
        self.interface.restore(&before.interface);
        self.support_forces.clone_from(&before.support_forces);
        self.counters.steps -= 1;
    }

    /// Continues in steps of another length.
    fn change_step(&mut self, stepper: &'a Stepper) -> Result<(), TrackError> {
        let ratio = stepper.time_step() / self.stepper.time_step();
        self.ticks_per_step = self.ticks_of(stepper);
        self.stepper = stepper;
        if let Some((run, _)) = &self.train {
            for (v, ((vehicle, _), (running, _))) in run.train.vehicles.iter().zip(&mut self.vehicles).enumerate() {
                running.change_step(vehicle, &stepper.scheme)?;
                self.interface.set_compliance(v, running.wheel_compliance(&stepper.scheme));
            }
        }
        self.interface.scale_trends(ratio);
        Ok(())
    }

    fn ticks_of(&self, stepper: &Stepper) -> u64 {
        (stepper.time_step() / self.tick_length).round() as u64
    }
}
