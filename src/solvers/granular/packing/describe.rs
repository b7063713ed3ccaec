//! What a bed is like at the end of a stage, and when it is finished.

use super::super::bed::Bed;
use super::super::body::BodyId;
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::super::measure::{Ball, Coordination, Region, Survey, neighbours};
use super::super::snapshot::Snapshot;
use super::Packed;
use serde::{Deserialize, Serialize};

/// A stage as it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    pub name: String,
    /// That it took, s.
    pub time: f64,
    /// Of the plate, Pa; 0 without it.
    pub pressure: f64,
    /// Of the plate, m; `None` without it.
    pub level: Option<f64>,
    pub state: State,
}

/// A bed at an instant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Mean force out of balance over mean force that acts.
    pub unbalance: f64,
    /// J.
    pub kinetic: f64,
    /// Of each layer; those that are still to come are empty.
    pub layers: Vec<LayerState>,
}

/// Neighbours of the bodies of one layer, those of other layers among them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerState {
    pub bodies: usize,
    /// Neighbours a body.
    pub coordination: f64,
    /// The same of bodies that are no rattlers.
    pub without_rattlers: f64,
    /// Bodies with fewer than two neighbours.
    pub rattlers: usize,
}

impl State {
    pub(super) fn of<R: Real>(bed: &Bed<R>, snapshot: &Snapshot, unbalance: f64) -> State {
        let pair =
            |contact: &super::super::snapshot::ContactState| Some((contact.first.body()?.0, contact.second.body()?.0));
        let pairs: Vec<(u32, u32)> = snapshot.contacts.iter().filter_map(pair).collect();
        let neighbours = neighbours(bed.len(), &pairs);
        let mut layers = vec![Vec::new(); bed.laws.surfaces() - 1];
        for (state, count) in bed.states().zip(neighbours) {
            layers[usize::from(state.surface)].push(count);
        }
        let kinetic = snapshot.translation + snapshot.rotation;
        State { unbalance, kinetic, layers: layers.iter().map(|counts| LayerState::of(counts)).collect() }
    }
}

impl LayerState {
    fn of(neighbours: &[u32]) -> LayerState {
        let Coordination { mean, without_rattlers, rattlers, .. } = Coordination::of(neighbours);
        LayerState { bodies: neighbours.len(), coordination: mean, without_rattlers, rattlers }
    }
}

impl<R: Real> Packed<R> {
    /// Porosity between two levels, m: of the whole cell, walls included.
    pub fn porosity(&self, [low, high]: [f64; 2]) -> f64 {
        1.0 - self.solid([low, high]) / (self.area() * (high - low))
    }

    /// All that can be measured of it now. `bed` is its own, or a copy that something was done to.
    pub fn survey(&self, bed: &mut Bed<R>) -> Result<Survey, Failure> {
        let snapshot = bed.snapshot()?;
        Ok(Survey::of(bed, &snapshot, &self.densities))
    }

    /// Of the plan, m2.
    pub fn area(&self) -> f64 {
        self.plan[0] * self.plan[1]
    }

    /// From where to where a layer lies, m: the levels of the plate that pressed it.
    pub fn between(&self, layer: usize) -> [f64; 2] {
        [layer.checked_sub(1).map_or(0.0, |below| self.levels[below]), self.levels[layer]]
    }

    /// Solid volume between two levels, m3: what several pebbles of a body hold counts once.
    fn solid(&self, [low, high]: [f64; 2]) -> f64 {
        // wider than any bed, so that nothing is cut but by the two levels
        const WIDE: f64 = 1e4;
        let Ok(slab) = Region::block([-WIDE, -WIDE, low], [WIDE, WIDE, high]) else { return 0.0 };
        let mut pebbles: Vec<(BodyId, Ball)> = self.bed.pebbles().map(|p| (p.body, (p.place, p.radius))).collect();
        pebbles.sort_by_key(|(body, _)| *body);
        let share = |body: &[(BodyId, Ball)]| {
            let balls: Vec<Ball> = body.iter().map(|(_, ball)| *ball).collect();
            let state = self.bed.body_state(body[0].0);
            slab.share_of_clump(&balls, state.mass / self.densities[usize::from(state.surface)])
        };
        pebbles.chunk_by(|a, b| a.0 == b.0).map(share).sum()
    }
}
