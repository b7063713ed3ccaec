//! The quantities of a passage that an observer may read at each step; every quantity takes a few operations on the
//! present state.

use super::counters::Counters;
use super::mesh::{FootUnknown, Track};
use super::passage::Passage;
use super::statics::StaticState;

/// Observes the start of a passage and the end of each of its steps.
pub trait Observer {
    fn observe(&mut self, view: &StepView<'_>);
}

/// Observes nothing.
impl Observer for () {
    fn observe(&mut self, _: &StepView<'_>) {}
}

impl<F: FnMut(&StepView<'_>)> Observer for F {
    fn observe(&mut self, view: &StepView<'_>) {
        self(view);
    }
}

impl<A: Observer, B: Observer> Observer for (&mut A, &mut B) {
    fn observe(&mut self, view: &StepView<'_>) {
        self.0.observe(view);
        self.1.observe(view);
    }
}

/// The state of a passage at one time. Displacements and forces are positive down.
#[derive(Debug, Clone, Copy)]
pub struct StepView<'a> {
    pub(super) passage: &'a Passage<'a>,
}

impl<'a> StepView<'a> {
    pub fn track(&self) -> &'a Track {
        &self.passage.stepper.track
    }

    /// The track without vehicles at this level.
    pub fn unloaded(&self) -> &'a StaticState {
        &self.passage.unloaded
    }

    pub fn counters(&self) -> Counters {
        self.passage.counters
    }

    /// 0 at the start.
    pub fn step(&self) -> usize {
        self.passage.counters.steps
    }

    /// Whether the time is a multiple of `every` times the longest step of the passage: a grid that all steps reach.
    pub fn is_on_grid(&self, every: usize) -> bool {
        self.passage.tick.is_multiple_of(every as u64 * self.passage.ticks_per_longest)
    }

    /// s, since the start.
    pub fn time(&self) -> f64 {
        self.passage.time()
    }

    /// Length of the last step, s.
    pub fn time_step(&self) -> f64 {
        self.passage.last_step
    }

    /// Chainage of each wheel, vehicle by vehicle, m.
    pub fn wheel_positions(&self) -> &'a [f64] {
        &self.passage.wheel_positions
    }

    /// Force of each wheel on the rail, N; never negative on a contact of Hertz.
    pub fn wheel_forces(&self) -> &'a [f64] {
        &self.passage.interface.forces
    }

    /// Force of the rail on the pad, N.
    pub fn seat_load(&self, seat: usize) -> f64 {
        let track = self.track();
        let (model, rail) = (&track.model.seats[seat], track.rail[track.seat_nodes[seat]]);
        let (u, v) = (&self.passage.displacement, &self.passage.velocity);
        let (foot, foot_velocity) = match self.track().foot_unknown(seat) {
            Some(unknown) => (u[unknown], v[unknown]),
            None => (0.0, 0.0),
        };
        model.pad_stiffness * (u[rail] - foot) + model.pad_damping * (v[rail] - foot_velocity)
    }

    /// Force of the sleeper on its support, N, never negative; none for a seat without a sleeper.
    pub fn contact_force(&self, seat: usize) -> Option<f64> {
        match self.track().feet[seat] {
            FootUnknown::Sleeper(s) => Some(self.passage.support_forces[s]),
            _ => None,
        }
    }

    /// Displacement of the support under the sleeper below its unloaded level, m, 0 if the sleeper hangs; none for a
    /// seat without a sleeper.
    pub fn support_deflection(&self, seat: usize) -> Option<f64> {
        match self.track().feet[seat] {
            FootUnknown::Sleeper(s) => {
                let foot = self.passage.displacement[self.track().sleepers[s].unknown];
                Some((foot - self.passage.level.settlements[seat]).max(0.0))
            }
            _ => None,
        }
    }

    /// Displacement of the sleeper or slab under a seat, m, relative to the track as built; 0 for rigid seats. The same
    /// holds for its velocity and acceleration.
    pub fn foot_displacement(&self, seat: usize) -> f64 {
        self.track().foot_unknown(seat).map_or(0.0, |unknown| self.passage.displacement[unknown])
    }

    /// m/s.
    pub fn foot_velocity(&self, seat: usize) -> f64 {
        self.track().foot_unknown(seat).map_or(0.0, |unknown| self.passage.velocity[unknown])
    }

    /// m/s^2.
    pub fn foot_acceleration(&self, seat: usize) -> f64 {
        self.track().foot_unknown(seat).map_or(0.0, |unknown| self.passage.acceleration[unknown])
    }

    /// Deflection of the rail at a node, m, relative to the track as built.
    pub fn rail_deflection(&self, node: usize) -> f64 {
        self.passage.displacement[self.track().rail[node]]
    }

    /// Sagging rail moment at a node, N m.
    pub fn rail_moment(&self, node: usize) -> f64 {
        let wheels = self.passage.interface.points.iter().zip(self.wheel_forces());
        let clamping: f64 = wheels.map(|(point, force)| self.track().clamping_moment(node, point, *force)).sum();
        self.track().cubic_moment(node, &self.passage.displacement) + clamping
    }

    /// Sagging rail moment at every node, N m.
    pub fn rail_moments(&self, moments: &mut [f64]) {
        let track = self.track();
        for (node, moment) in moments.iter_mut().enumerate().take(track.nodes.len()) {
            *moment = track.cubic_moment(node, &self.passage.displacement);
        }
        for (point, force) in self.passage.interface.points.iter().zip(self.wheel_forces()) {
            for node in [point.element, point.element + 1] {
                if let Some(moment) = moments.get_mut(node) {
                    *moment += track.clamping_moment(node, point, *force);
                }
            }
        }
    }
}
