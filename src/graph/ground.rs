//! What carries the sleepers where no grains do: springs, and laws by which they settle.

use crate::solvers::settlement::Law;
use crate::solvers::track::Spring;
use serde::{Deserialize, Serialize};

/// Supports as springs that can only push. Nothing settles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpringsNode {
    pub supports: Vec<SupportNode>,
}

/// A settlement law under each sleeper. `followers` are evaluated under the forces to which the driving law leads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawNode {
    pub supports: Vec<SupportNode>,
    pub law: NamedLaw,
    pub followers: Vec<NamedLaw>,
}

/// What lies under one seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SupportNode {
    /// Support and under sleeper pad in series; `None` under a seat without a sleeper, and where only grains can say.
    pub spring: Option<Spring>,
    /// The support without the pad.
    pub support: Option<Spring>,
    /// Settlement at the start, m.
    pub settlement: f64,
    /// Vertical pressure on the lowest layer for each newton of contact force, 1/m^2; `None` where the layers or their moduli are not
    /// known.
    pub onto_subgrade: Option<f64>,
}

/// A settlement law under the name that the scene gives it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedLaw {
    pub name: String,
    pub law: Law,
    /// Its form and parameters in words.
    pub details: String,
}
