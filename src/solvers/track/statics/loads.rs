//! The loads on a track at rest.

use crate::solvers::track::train::Train;

/// The loads on the track besides its own weight.
#[derive(Debug, Clone, Copy, Default)]
pub struct Loads<'a> {
    /// Chainage (m) and force (N, down) on the rail.
    pub rail: &'a [(f64, f64)],
    /// Index of a seat with a sleeper and force (N, down) on that sleeper.
    pub sleepers: &'a [(usize, f64)],
    /// A train with its leading wheel at this chainage, m.
    pub train: Option<(&'a Train, f64)>,
}

/// Additional nodal forces for states in motion: on the track and on each vehicle.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Inertia {
    pub track: Vec<f64>,
    pub vehicles: Vec<Vec<f64>>,
}
