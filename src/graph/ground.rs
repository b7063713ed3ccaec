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
    /// Laws of some sleepers in place of `law`, each in [`SupportNode::law`] too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own: Vec<OwnLaw>,
}

/// A law of some sleepers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OwnLaw {
    pub law: NamedLaw,
    /// Indices of their seats, ascending.
    pub seats: Vec<usize>,
}

impl LawNode {
    /// The law that settles a seat.
    pub fn of_seat(&self, seat: usize) -> &NamedLaw {
        let own = self.own.iter().find(|own| own.seats.binary_search(&seat).is_ok());
        own.map_or(&self.law, |own| &own.law)
    }
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
    /// The law by which it settles; `None` for the law of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<Law>,
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
