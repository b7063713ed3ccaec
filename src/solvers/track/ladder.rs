//! One time step halved again and again, and the data that a passage needs to choose a step: its state before the step.

use super::error::TrackError;
use super::influence::Stepper;
use super::interface::InterfaceState;
use super::mesh::Track;
use super::scheme::Scheme;
use std::sync::Arc;

/// One time step halved again and again, each prepared for one track; immutable and shared by all passages.
#[derive(Debug, Clone)]
pub struct Ladder {
    /// Longest first.
    pub(super) rungs: Vec<Stepper>,
}

/// How a passage chooses among the steps of a ladder.
#[derive(Debug, Clone)]
pub(super) struct Choice<'a> {
    pub(super) ladder: &'a Ladder,
    pub(super) rung: usize,
    /// m.
    pub(super) tolerance: f64,
    pub(super) before: Before,
}

/// The state before a step.
#[derive(Debug, Clone, Default)]
pub(super) struct Before {
    pub(super) tick: u64,
    /// Displacement, velocity and acceleration of the track, then of each vehicle.
    pub(super) track: [Vec<f64>; 3],
    pub(super) vehicles: Vec<[Vec<f64>; 3]>,
    pub(super) interface: InterfaceState,
    pub(super) support_forces: Vec<f64>,
}

impl Ladder {
    /// Prepares the step of `scheme` and its first `halvings` halves; fails if the track is a mechanism without
    /// mass.
    pub fn new(track: &Arc<Track>, scheme: Scheme, halvings: usize) -> Result<Self, TrackError> {
        let rung = |n: usize| {
            let scheme = scheme.with_time_step(scheme.time_step / (1u64 << n.min(32)) as f64)?;
            Stepper::new(track.clone(), scheme)
        };
        Ok(Self { rungs: (0..=halvings).map(rung).collect::<Result<_, _>>()? })
    }

    /// The longest step.
    pub fn longest(&self) -> &Stepper {
        &self.rungs[0]
    }
}
