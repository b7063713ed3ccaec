//! The results of a test, sleeper by sleeper.

use serde::{Deserialize, Serialize};

/// The results of a sleeper over one of its cycles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Index into [`Rig::sleepers`](super::Rig::sleepers).
    pub sleeper: usize,
    /// Number of the cycle, from 1.
    pub number: u64,
    /// Settlement below the position of rest under its own weight, at the end of the cycle, and at the deepest
    /// position, m.
    pub settlement: f64,
    pub deepest: f64,
    /// Range of force divided by the rebound from the deepest position to the end, N/m; 0 without rebound.
    pub stiffness: f64,
    /// Largest force of the bed on the sleeper, N.
    pub contact_force: f64,
    /// Work of the actuator minus the work returned: the energy that stays in the bed, J.
    pub work: f64,
    /// Time steps so far.
    pub steps: u64,
}

/// A sleeper at an instant of a recorded cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CycleSample {
    pub sleeper: usize,
    pub cycle: u64,
    /// Elapsed share of the cycle, 0 .. 1.
    pub phase: f64,
    /// Force of the actuator, and force of the bed on the sleeper, N.
    pub force: f64,
    pub contact_force: f64,
    /// m.
    pub depth: f64,
    /// Downwards, m/s.
    pub velocity: f64,
}
