//! The longest stable step of contacts whose force is explicit in time.

use crate::linalg::banded::SymmetricBanded;
use crate::solvers::track::Multibody;
use crate::solvers::track::contact::WheelLaw;
use crate::solvers::track::error::Explicit;
use crate::solvers::track::mesh::Track;
use crate::solvers::track::model::Foot;
use crate::solvers::track::{Seat, WheelContact};
use std::cmp::Ordering;

/// Wheel force at which the limit of its contact is computed, as a multiple of the static wheel force.
const PEAK: f64 = 3.0;

/// The longest stable step of an explicit contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepLimit {
    /// s.
    pub time_step: f64,
    /// Chainage of the contact, m; for a wheel, the place where the effective mass of the rail is smallest.
    pub x: f64,
    pub contact: Explicit,
}

impl StepLimit {
    pub(super) fn shorter(&self, other: &Self) -> Ordering {
        self.time_step.total_cmp(&other.time_step)
    }
}

/// `2 m/(c + √(c² + k m))` for a mass (kg) on an explicit spring (N/m) and damper (N s/m), s.
fn longest_step(mass: f64, stiffness: f64, damping: f64) -> f64 {
    2.0 * mass / (damping + (damping * damping + stiffness * mass).sqrt())
}

/// The limit by the supports of ordinary sleepers; none without such sleepers.
pub(super) fn of_track(track: &Track) -> Option<StepLimit> {
    let limit = |seat: &Seat| match seat.foot {
        Foot::Sleeper { mass, support_stiffness, support_damping, .. } => Some(StepLimit {
            time_step: longest_step(mass, support_stiffness, support_damping),
            x: seat.x,
            contact: Explicit::Support,
        }),
        _ => None,
    };
    track.model.seats.iter().filter_map(limit).min_by(StepLimit::shorter)
}

/// The place of the smallest effective mass of the rail under a wheel: a chainage, m, and eᵀ M⁻¹ e there, 1/kg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LightestRail {
    x: f64,
    inverse_mass: f64,
}

impl LightestRail {
    /// Between nodes the effective mass of an element is larger than at its nodes. A rail without mass has none.
    pub fn new(track: &Track, mass: &SymmetricBanded) -> Self {
        let mut mass = mass.clone();
        let held = track.held.iter().map(|(unknown, _)| *unknown);
        let others = (0..track.order()).filter(|i| track.rail_unknowns.binary_search(i).is_err());
        held.chain(others).for_each(|unknown| mass.pin(unknown));
        let Ok(factor) = mass.factor() else { return Self { x: track.nodes[0], inverse_mass: f64::INFINITY } };
        let mut scratch = vec![0.0; track.order()];
        let free = track.rail.iter().zip(&track.nodes).filter(|(w, _)| track.held.iter().all(|(held, _)| held != *w));
        let lent =
            free.map(|(w, x)| Self { x: *x, inverse_mass: factor.inverse_column(*w, 1e-6, &mut scratch).entry(*w) });
        lent.max_by(|a, b| a.inverse_mass.total_cmp(&b.inverse_mass))
            .unwrap_or(Self { x: track.nodes[0], inverse_mass: 0.0 })
    }

    /// The limit by the wheels of a vehicle on this rail.
    pub fn limit(&self, vehicle: &Multibody, gravity: f64) -> Option<StepLimit> {
        let load = PEAK * vehicle.wheel_load(gravity);
        let steps = vehicle.wheels.iter().filter_map(|wheel| {
            let inverse_mass = self.inverse_mass + 1.0 / vehicle.masses[wheel.unknown?];
            let law = WheelLaw::at_rest(wheel.contact);
            let damping = if let WheelContact::Linear { damping, .. } = wheel.contact { damping } else { 0.0 };
            Some(longest_step(1.0 / inverse_mass, law.stiffness(law.indentation(load)), damping))
        });
        let shortest = steps.min_by(f64::total_cmp)?;
        Some(StepLimit { time_step: shortest, x: self.x, contact: Explicit::Wheel })
    }
}
