//! What a test gives, sleeper by sleeper.

use serde::{Deserialize, Serialize};

/// A sleeper over one of its cycles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Index into [`Rig::sleepers`](super::Rig::sleepers).
    pub sleeper: usize,
    /// The first is 1.
    pub number: u64,
    /// Below the place of rest under its own weight: at the end of the cycle, and where it was deepest, m.
    pub settlement: f64,
    pub deepest: f64,
    /// Range of force over the rebound from the deepest place to the end, N/m; 0 where nothing rebounds.
    pub stiffness: f64,
    /// Largest force of the bed on the sleeper, N.
    pub contact_force: f64,
    /// Work of the actuator less what came back: the bed keeps it, J.
    pub work: f64,
    /// Time steps so far.
    pub steps: u64,
}

/// A sleeper at an instant of a cycle that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CycleSample {
    pub sleeper: usize,
    pub cycle: u64,
    /// Share of the cycle that is over, 0 .. 1.
    pub phase: f64,
    /// Force of the actuator, and of the bed on the sleeper, N.
    pub force: f64,
    pub contact_force: f64,
    /// m.
    pub depth: f64,
    /// Downwards, m/s.
    pub velocity: f64,
}
