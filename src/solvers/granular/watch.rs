//! What a healthy run never does, and what is said when one does.

use super::bed::Bed;
use super::body::BodyId;
use super::fault::Fault;
use super::lanes::Real;
use super::record::Record;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Bounds that stop a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Overlap over the smaller radius.
    pub overlap: f64,
    /// Way of a pebble in one step over its radius.
    pub stride: f64,
    /// Steps between looks at overlaps.
    pub every: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { overlap: 0.2, stride: 0.1, every: 64 }
    }
}

/// Why a run cannot go on.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// No time step has been set.
    NoTimeStep,
    /// Something in the bed cannot be; nothing was moved.
    Fault(Fault),
    /// The state of a body is no number any more.
    Lost(Culprit),
    /// A body goes too far in a step.
    Stride { culprit: Culprit, share: f64 },
    /// Two bodies are too deep in each other.
    Overlap { culprit: Culprit, share: f64 },
    /// Neighbours more than one cell apart: a period or a bay is too short for its bodies.
    CellTooSmall,
}

/// The body at which a failure showed, and what would have been stable.
#[derive(Debug, Clone, PartialEq)]
pub struct Culprit {
    pub body: BodyId,
    /// \[m\]
    pub place: [f64; 3],
    pub step: u64,
    pub time: f64,
    pub dt: f64,
    /// Largest stable time step of the present contacts \[s\].
    pub stable_dt: f64,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Failure::NoTimeStep => write!(f, "no time step has been set"),
            Failure::Fault(fault) => fault.fmt(f),
            Failure::CellTooSmall => {
                write!(f, "a period or bay is shorter than its bodies reach; make it longer than twice the largest")
            }
            Failure::Lost(c) => write!(f, "the motion of {c} is no number any more{}", c.advice()),
            Failure::Stride { culprit, share } => {
                write!(f, "{culprit} moves by {share:.2} of its radius in one step{}", culprit.advice())
            }
            Failure::Overlap { culprit, share } => {
                write!(f, "{culprit} is {share:.2} of the smaller radius deep in its neighbour{}", culprit.advice())
            }
        }
    }
}

impl std::error::Error for Failure {}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.place;
        write!(f, "body {} at ({x:.4}, {y:.4}, {z:.4}) m, step {}, {:.4e} s", self.body.0, self.step, self.time)
    }
}

impl Culprit {
    fn advice(&self) -> String {
        let (dt, stable) = (self.dt, self.stable_dt);
        if stable.is_finite() && dt > stable {
            format!(": the step of {dt:.3e} s is above the stable {stable:.3e} s of its contacts")
        } else {
            format!(": the step of {dt:.3e} s is stable, so it was pushed too hard or set in too deep")
        }
    }
}

impl<R: Real> Bed<R> {
    /// Changes the bounds that stop a run.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
        self.unchecked = true;
    }

    /// Looks at what the last step did.
    pub(super) fn look(&mut self) -> Result<(), Failure> {
        if let Some(place) = self.tally.lost {
            return Err(Failure::Lost(self.culprit(place)));
        }
        let (square, place) = self.tally.fastest;
        let stride = square.sqrt() * self.dt;
        if stride > 0.0 {
            let share = stride / self.records[self.bodies[place as usize].first as usize].radius();
            if share > self.limits.stride {
                return Err(Failure::Stride { culprit: self.culprit(place), share });
            }
        }
        if self.steps.is_multiple_of(self.limits.every) {
            let (share, pebble) = self.deepest();
            if share > self.limits.overlap {
                return Err(Failure::Overlap { culprit: self.culprit(self.owner[pebble as usize]), share });
            }
        }
        Ok(())
    }

    /// Largest overlap over the smaller radius, and a pebble that has it.
    pub(super) fn deepest(&self) -> (f64, u32) {
        let mut deepest = (0.0, 0);
        for place in 0..self.contacts.len() {
            let (a, b) = (self.contacts.first[place], self.contacts.second[place]);
            if let Some(overlap) = self.overlap(place) {
                let share = overlap / self.records[a as usize].radius().min(self.records[b as usize].radius());
                if share > deepest.0 {
                    deepest = (share, a);
                }
            }
        }
        for entry in &self.wall_contacts.entries {
            for slot in self.wall_contacts.slots(entry).iter().filter(|s| s.touches()) {
                let share = slot.overlap / self.records[entry.pebble as usize].radius();
                if share > deepest.0 {
                    deepest = (share, entry.pebble);
                }
            }
        }
        deepest
    }

    /// Overlap of a contact when its force was computed \[m\], to the precision of an arm; none where it does not touch.
    pub(super) fn overlap(&self, place: usize) -> Option<f64> {
        let outcome = &self.contacts.outcomes[place];
        let radius = self.records[self.contacts.first[place] as usize].radius();
        let touches = outcome[..3].iter().any(|&force| force != R::default());
        touches.then_some(2.0 * (radius - outcome[6].to_f64()).max(0.0))
    }

    fn culprit(&self, place: u32) -> Culprit {
        let body = &self.bodies[place as usize];
        Culprit {
            body: BodyId(body.id),
            place: self.body_state(BodyId(body.id)).place,
            step: self.steps,
            time: self.time,
            dt: self.dt,
            stable_dt: self.body_time_step(),
        }
    }
}
