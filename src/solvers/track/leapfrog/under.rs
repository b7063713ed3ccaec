//! What a wheel stands on: the rail, the track that goes on beyond an absorbing end, or level ground beyond another.

use crate::solvers::track::ends::{Continuation, end_unknown};
use crate::solvers::track::mesh::Track;
use crate::solvers::track::model::TrackLevel;

/// The surface under a wheel: `rest + Σ shape u`, and by `compliance` (m/N) lower under the force there, which acts on the
/// unknowns by the same shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Under {
    unknowns: [usize; 4],
    shape: [f64; 4],
    rest: f64,
    pub compliance: f64,
}

/// What goes on beyond the ends of the rail.
pub(super) type Beyond = [Option<Continuation>; 2];

pub(super) fn beyond(track: &Track) -> Beyond {
    [Continuation::new(track, 0), Continuation::new(track, 1)]
}

impl Under {
    /// At a chainage, m; `ground` are the levels (m) before the left and behind the right end where nothing goes on there.
    pub fn wheel_at(track: &Track, beyond: &Beyond, level: &TrackLevel, ground: [f64; 2], x: f64) -> Self {
        if let Ok(point) = track.rail_point(x) {
            let unknowns = track.element_unknowns(point.element);
            return Self { unknowns, shape: point.shape, rest: 0.0, compliance: point.local_compliance };
        }
        let end = usize::from(x > track.model.ends[0]);
        let w = end_unknown(track, end);
        let unknowns = [w, w + 1, w, w + 1];
        match &beyond[end] {
            Some(continuation) => {
                let distance = (x - track.model.ends[end]).abs();
                let (shape, compliance) = continuation.shape_at(distance);
                let [by_deflection, by_rotation] = if distance <= continuation.reach() { shape } else { [0.0; 2] };
                let rest = (1.0 - by_deflection) * level.ends[end];
                Self { unknowns, shape: [by_deflection, by_rotation, 0.0, 0.0], rest, compliance }
            }
            None => Self { unknowns, shape: [0.0; 4], rest: ground[end], compliance: 0.0 },
        }
    }

    /// Level of the surface without a force there, m, with these displacements of the track.
    pub fn surface(&self, u: &[f64]) -> f64 {
        self.rest + self.moved(|i| u[i])
    }

    /// What the place moves, if the unknowns move by `of`, the rest by nothing.
    pub fn moved(&self, of: impl Fn(usize) -> f64) -> f64 {
        self.unknowns.iter().zip(self.shape).map(|(i, shape)| shape * of(*i)).sum()
    }

    /// Adds the nodal forces of `force` (N, down).
    pub fn press(&self, force: f64, nodal: &mut [f64]) {
        for (i, shape) in self.unknowns.iter().zip(self.shape) {
            nodal[*i] += shape * force;
        }
    }

    /// Whether a force here is felt by the track.
    pub fn is_felt(&self) -> bool {
        self.shape != [0.0; 4]
    }
}
