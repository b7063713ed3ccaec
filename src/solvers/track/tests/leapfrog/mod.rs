//! The leapfrog against closed forms, against passages over the same track, and against itself with other steps.

mod energy;
mod limits;
mod passages;
mod rest;
mod riding;

use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

pub const SPEED: f64 = 200.0 / 3.6;

pub const FORCE: f64 = 98.1e3;

/// The same track with sleepers carried by external forces.
pub fn carried(mut model: TrackModel) -> TrackModel {
    for seat in &mut model.seats {
        if let Foot::Sleeper { mass, .. } = seat.foot {
            seat.foot = Foot::Carried { mass, pad: None, pitch: None };
        }
    }
    model
}

pub fn leapfrog(model: &TrackModel, level: &TrackLevel, time_step: f64) -> Leapfrog {
    Leapfrog::new(Arc::new(Track::new(model.clone()).unwrap()), level, time_step).unwrap()
}

/// From 0 to 1 in `steps` steps, smoothly.
pub fn gradually(step: usize, steps: usize) -> f64 {
    let t = (step as f64 / steps as f64).min(1.0);
    t * t * t * (10.0 - t * (15.0 - 6.0 * t))
}

/// Forces of springs under the carried feet: the law of an ordinary support, computed outside the solver.
pub struct Springs {
    stiffness: f64,
    damping: f64,
    settlements: Vec<f64>,
    pub pushes: Vec<f64>,
}

impl Springs {
    pub fn under(model: &TrackModel, level: &TrackLevel) -> Self {
        let seats = model.seats.iter().zip(&level.settlements);
        let settlements: Vec<f64> =
            seats.filter(|(seat, _)| matches!(seat.foot, Foot::Sleeper { .. })).map(|(_, s)| *s).collect();
        Self { stiffness: 50e6, damping: 50e3, pushes: vec![0.0; settlements.len()], settlements }
    }

    pub fn push(&mut self, leapfrog: &Leapfrog) -> &[f64] {
        for (i, (push, settlement)) in self.pushes.iter_mut().zip(&self.settlements).enumerate() {
            let foot = leapfrog.underside(i);
            let gap = foot.level - settlement;
            let force = self.stiffness * gap + self.damping * foot.present_velocity;
            *push = if gap > 0.0 { force.max(0.0) } else { 0.0 };
        }
        &self.pushes
    }
}
