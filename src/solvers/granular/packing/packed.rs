//! A finished bed, and its measurements.

use super::super::bed::Bed;
use super::super::body::BodyId;
use super::super::failure::Failure;
use super::super::grains::Sample;
use super::super::lanes::Real;
use super::super::measure::{Ball, Region, Survey};
use super::describe::{BedState, Stage};
use super::press::LAST;

/// A finished bed, and the record of its packing.
#[derive(Clone)]
pub struct Packed<R: Real> {
    pub bed: Bed<R>,
    /// Sides of the cell along x and across, m.
    pub plan: [f64; 2],
    /// Density of the grains of each layer, kg/m3.
    pub densities: Vec<f64>,
    /// First body of each layer, and the end of the last layer.
    pub bodies: Vec<u32>,
    /// The grains taken from each grading.
    pub samples: Vec<Sample>,
    /// Level of the plate on each layer under its pressure, m.
    pub levels: Vec<f64>,
    /// Each stage at its end.
    pub stages: Vec<Stage>,
}

impl<R: Real> Packed<R> {
    /// The bed under the plate of its last lift, without friction, and the finished bed.
    pub fn pressed_and_at_rest(&self) -> [&BedState; 2] {
        let last = self.stages.len() - 1;
        [last - LAST, last].map(|stage| &self.stages[stage].state)
    }

    /// Porosity between two levels, m, of the whole cell, including the parts at walls.
    pub fn porosity(&self, [low, high]: [f64; 2]) -> f64 {
        1.0 - self.solid([low, high]) / (self.area() * (high - low))
    }

    /// Measurements of the present state. `bed` is the bed of this packing, or a changed copy of it.
    pub fn survey(&self, bed: &mut Bed<R>) -> Result<Survey, Failure> {
        let snapshot = bed.snapshot()?;
        Ok(Survey::from_snapshot(bed, &snapshot, &self.densities))
    }

    /// Area of the plan, m2.
    pub fn area(&self) -> f64 {
        self.plan[0] * self.plan[1]
    }

    /// Lower and upper level of a layer, m: the levels of the plate that pressed it.
    pub fn between(&self, layer: usize) -> [f64; 2] {
        [layer.checked_sub(1).map_or(0.0, |below| self.levels[below]), self.levels[layer]]
    }

    /// Solid volume between two levels, m3; a part inside several pebbles of a body counts once.
    fn solid(&self, [low, high]: [f64; 2]) -> f64 {
        // wider than any bed, so that only the two levels cut it
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
