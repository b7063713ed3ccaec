//! Supports of sleepers without grains: springs, and settlement laws.

use crate::solvers::settlement::Law;
use crate::solvers::track::Spring;
use serde::{Deserialize, Serialize};

/// Supports as springs in compression only, without settlement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpringsNode {
    pub supports: Vec<SupportNode>,
}

/// A settlement law under each sleeper. `followers` are evaluated with the forces of a run with `law`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawNode {
    pub supports: Vec<SupportNode>,
    pub law: NamedLaw,
    pub followers: Vec<NamedLaw>,
}

/// The support under one seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SupportNode {
    /// Support and under sleeper pad in series; `None` under a seat without a sleeper, and if only grains give the
    /// stiffness.
    pub spring: Option<Spring>,
    /// The support without the under sleeper pad.
    pub support: Option<Spring>,
    /// Settlement at the start, m.
    pub settlement: f64,
    /// Vertical pressure on the lowest layer per newton of contact force, 1/m^2; `None` if the layers or their moduli
    /// are not known.
    pub onto_subgrade: Option<f64>,
}

/// A settlement law with its name in the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedLaw {
    pub name: String,
    pub law: Law,
    /// Form and parameters of the law as text.
    pub details: String,
    /// Bounds of a fitted law; `None` for a law that may be extrapolated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<LawBounds>,
}

/// The largest values up to which a fitted law holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LawBounds {
    /// Peak force of a wheel on a support, N.
    pub force: f64,
    /// Void under a sleeper, m.
    pub void: f64,
}
