//! The state of a bed at the end of a stage.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::measure::{Coordination, neighbours};
use super::super::snapshot::{ContactState, Snapshot};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The stages of packing a bed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StageKind {
    /// A lift of a layer falls and is pressed; lifts count from 1.
    Lift { layer: String, lift: u32, lifts: u32 },
    /// The pressure of the plate is reduced.
    Eased,
    /// The friction of the finished bed is set.
    Restored,
    /// The plate is removed.
    Lifted,
    /// The plate presses the finished bed again; repetitions count from 1.
    Reloaded { number: u32, of: u32 },
    /// Cells are laid side by side as the bed of a track.
    SideBySide,
}

impl fmt::Display for StageKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StageKind::Lift { layer, lift, lifts } => write!(f, "{layer}, lift {lift} of {lifts}"),
            StageKind::Eased => write!(f, "plate eased"),
            StageKind::Restored => write!(f, "friction restored"),
            StageKind::Lifted => write!(f, "plate lifted"),
            StageKind::Reloaded { number, of } => write!(f, "loaded again, {number} of {of}"),
            StageKind::SideBySide => write!(f, "cells side by side"),
        }
    }
}

/// A stage at its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    pub name: String,
    /// Duration of the stage, s.
    pub time: f64,
    /// Pressure of the plate, Pa; 0 without it.
    pub pressure: f64,
    /// Level of the plate, m; `None` without it.
    pub level: Option<f64>,
    pub state: BedState,
}

/// A bed at an instant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedState {
    /// Mean force out of balance divided by the mean acting force.
    pub unbalance: f64,
    /// J.
    pub kinetic: f64,
    /// State of each layer; layers not packed yet are empty.
    pub layers: Vec<LayerState>,
}

/// Neighbours of the bodies of one layer, including neighbours in other layers.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerState {
    pub bodies: usize,
    /// Mean number of neighbours of a body.
    pub coordination: f64,
    /// The same for bodies that are not rattlers.
    pub without_rattlers: f64,
    /// Bodies with fewer than two neighbours.
    pub rattlers: usize,
}

impl BedState {
    pub(super) fn from_snapshot<R: Real>(bed: &Bed<R>, snapshot: &Snapshot, unbalance: f64) -> BedState {
        let pair = |contact: &ContactState| Some((contact.first.body()?.0, contact.second.body()?.0));
        let pairs: Vec<(u32, u32)> = snapshot.contacts.iter().filter_map(pair).collect();
        let neighbours = neighbours(bed.len(), &pairs);
        let mut layers = vec![Vec::new(); bed.laws.surfaces() - 1];
        for (state, count) in bed.states().zip(neighbours) {
            layers[usize::from(state.surface)].push(count);
        }
        let kinetic = snapshot.translation + snapshot.rotation;
        BedState {
            unbalance,
            kinetic,
            layers: layers.iter().map(|counts| LayerState::from_neighbours(counts)).collect(),
        }
    }
}

impl LayerState {
    fn from_neighbours(neighbours: &[u32]) -> LayerState {
        let Coordination { mean, without_rattlers, rattlers, .. } = Coordination::from_neighbours(neighbours);
        LayerState { bodies: neighbours.len(), coordination: mean, without_rattlers, rattlers }
    }
}
