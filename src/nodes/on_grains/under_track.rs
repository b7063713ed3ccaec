//! The beds under a track at an instant, for reading.

use super::build::Parts;
use super::step::StandingBed;
use super::{GrainGround, Live};
use crate::nodes::NodeError;
use crate::solvers::granular::shape::Shape;
use crate::solvers::granular::{Bed, Snapshot};

/// A bed under a track, and where it lies.
pub struct BedUnderTrack<'a> {
    pub bed: &'a Bed<f32>,
    pub snapshot: Snapshot,
    /// Chainage of the origin of the bed, m.
    pub start: f64,
    /// Mean height of the undersides of its sleepers when the track was built, above the origin of the bed, m.
    pub top: f64,
}

impl GrainGround<'_> {
    /// The beds as they lie now. Reading does not change the motion afterwards.
    pub fn look(&mut self) -> Result<Vec<BedUnderTrack<'_>>, NodeError> {
        let parts = self.parts();
        let live = self.working()?;
        let tops = live.tops();
        live.look(parts, &tops)
    }
}

impl Live {
    /// Mean height of the undersides of the sleepers on each bed when the track was built, above the origin of the bed,
    /// m. Asked at rest.
    pub(super) fn tops(&self) -> Vec<f64> {
        let rest = &self.books.rest;
        self.coupled.beds.iter().map(|standing| standing.top(|foot| rest[foot].level)).collect()
    }

    /// The beds as they lie now.
    pub(super) fn look(&mut self, parts: Parts<'_>, tops: &[f64]) -> Result<Vec<BedUnderTrack<'_>>, NodeError> {
        let beds = self.coupled.beds.iter_mut().zip(&parts.grains.stretches).zip(tops);
        beds.map(|((standing, stretch), top)| {
            let snapshot = standing.bed.snapshot()?;
            Ok(BedUnderTrack { bed: &standing.bed, snapshot, start: stretch.start, top: *top })
        })
        .collect()
    }
}

impl StandingBed {
    /// Mean height of the undersides of the sleepers when the track was built, m, by how far each has come down since
    /// (m).
    fn top(&self, lowered: impl Fn(usize) -> f64) -> f64 {
        let underside = |(wall, foot): &(_, usize)| {
            let wall = self.bed.wall(*wall);
            let Shape::Block { half } = &wall.shape else { return None };
            Some(wall.pose(self.bed.domain()).position.z - half.z + lowered(*foot))
        };
        let heights: Vec<f64> = self.sleepers.iter().filter_map(underside).collect();
        heights.iter().sum::<f64>() / heights.len().max(1) as f64
    }
}
