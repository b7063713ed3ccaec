//! The surface under a wheel: the rail, the continuation of the track beyond an absorbing end, or level ground beyond
//! another end.

use crate::solvers::track::ends::{Continuation, end_unknown};
use crate::solvers::track::mesh::Track;
use crate::solvers::track::model::TrackLevel;

/// The surface under a wheel: `rest + Σ shape u`. A force there lowers it further by `compliance` (m/N) and acts on the
/// unknowns by the same shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Under {
    unknowns: [usize; 4],
    shape: [f64; 4],
    rest: f64,
    pub compliance: f64,
}

/// The continuations beyond the ends of the rail.
pub(super) type Beyond = [Option<Continuation>; 2];

pub(super) fn beyond(track: &Track) -> Beyond {
    [Continuation::new(track, 0), Continuation::new(track, 1)]
}

impl Under {
    /// The surface at a chainage, m; `ground` are the levels (m) before the left and behind the right end if the rail
    /// has no continuation there.
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

    /// Level of the surface at displacements `u` of the track without a force there, m.
    pub fn surface(&self, u: &[f64]) -> f64 {
        self.rest + self.moved(|i| u[i])
    }

    /// Displacement of the surface if each unknown moves by `of` and nothing else moves.
    pub fn moved(&self, of: impl Fn(usize) -> f64) -> f64 {
        self.unknowns.iter().zip(self.shape).map(|(i, shape)| shape * of(*i)).sum()
    }

    /// Adds the nodal forces of `force` (N, down).
    pub fn press(&self, force: f64, nodal: &mut [f64]) {
        for (i, shape) in self.unknowns.iter().zip(self.shape) {
            nodal[*i] += shape * force;
        }
    }

    /// Whether a force here acts on the track.
    pub fn is_felt(&self) -> bool {
        self.shape != [0.0; 4]
    }
}
