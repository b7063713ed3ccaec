//! Rail ends behind which the track goes on.
//!
//! The static stiffness of the track beyond an end is that of a half-infinite beam on a Winkler foundation (deflection and
//! rotation, λ⁴ = k/4EI):
//!
//! ```text
//! F = 4EIλ³ w ± 2EIλ² θ,   M = ±2EIλ² w + 2EIλ θ      (+ at the right end, - at the left)
//! ```
//!
//! Waves are met by dampers along the rail before the end, `c(x) = c_end ξ²` with ξ from 0 at the layer's inner end to 1 at the
//! rail's end: damping that starts at once would reflect them.

use super::beam::add_element;
use super::mesh::Track;
use super::model::{Foot, RailEnds, TrackLevel};

/// Length of the damped layer, m, where the track is at least four times as long.
const LAYER: f64 = 5.0;
/// Damping at the very end in units of √(k m), k the foundation and m the rail, both per metre.
const DAMPING: f64 = 3.0;

/// What continues a rail beyond one of its ends.
struct Continuation {
    /// EI, N m^2.
    bending_stiffness: f64,
    /// kg/m.
    mass: f64,
    /// k, N/m per metre.
    foundation: f64,
    /// +1 beyond the right end, -1 beyond the left.
    side: f64,
}

impl Continuation {
    fn new(track: &Track, end: usize) -> Option<Self> {
        let model = &track.model;
        let (section, seat) = match end {
            0 => (model.rail.first()?, model.seats.first()?),
            _ => (model.rail.last()?, model.seats.last()?),
        };
        let bay = model.usual_bay();
        let below = match seat.foot {
            Foot::Sleeper { support_stiffness, .. } => 1.0 / support_stiffness,
            Foot::Slab => model.slab_under(seat.x).map_or(0.0, |s| 1.0 / (model.slabs[s].foundation_stiffness * bay)),
            Foot::Carried { pad: Some(pad), .. } => 1.0 / pad.stiffness,
            Foot::Rigid | Foot::Carried { pad: None, .. } => 0.0,
        };
        Some(Self {
            bending_stiffness: section.bending_stiffness,
            mass: section.mass,
            foundation: 1.0 / (bay * (1.0 / seat.pad_stiffness + below)),
            side: if end == 0 { -1.0 } else { 1.0 },
        })
    }

    /// Over deflection and rotation of the end.
    fn stiffness(&self) -> [[f64; 2]; 2] {
        let ei = self.bending_stiffness;
        let decay = (self.foundation / (4.0 * ei)).powf(0.25);
        let coupling = self.side * 2.0 * ei * decay * decay;
        [[4.0 * ei * decay.powi(3), coupling], [coupling, 2.0 * ei * decay]]
    }
}

/// Adds both continuations to the matrices of the track.
pub(super) fn assemble(track: &mut Track) {
    let [start, stop] = track.model.ends;
    let layer = LAYER.min(0.25 * (stop - start));
    for end in [0, 1] {
        let Some(beyond) = Continuation::new(track, end) else { continue };
        let w = end_unknown(track, end);
        let stiffness = beyond.stiffness();
        track.stiffness.add(w, w, stiffness[0][0]);
        track.stiffness.add(w + 1, w, stiffness[1][0]);
        track.stiffness.add(w + 1, w + 1, stiffness[1][1]);
        let largest = DAMPING * (beyond.foundation * beyond.mass).sqrt();
        for (element, pair) in track.elements.iter().zip(track.nodes.windows(2)) {
            let depth = layer - (0.5 * (pair[0] + pair[1]) - track.model.ends[end]).abs();
            if depth > 0.0 {
                let damping = largest * (depth / layer).powi(2);
                add_element(&mut track.damping, element.unknowns, element.beam.spread(damping));
            }
        }
    }
}

/// The forces by which the settled track beyond the ends pulls them to its level: end, unknown and N or N m per metre of level.
pub(super) fn pulls(track: &Track) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let continued = track.model.rail_ends == RailEnds::Absorbing;
    let of_end = move |end: usize| {
        Continuation::new(track, end)
            .filter(|_| continued)
            .map(|beyond| (end, end_unknown(track, end), beyond.stiffness()))
    };
    [0, 1].into_iter().filter_map(of_end).flat_map(|(end, w, k)| [(end, w, k[0][0]), (end, w + 1, k[1][0])])
}

/// What the track beyond both ends carries, N.
pub(super) fn carried(track: &Track, level: &TrackLevel, u: &[f64]) -> f64 {
    let of_end = |end: usize| {
        Continuation::new(track, end).map_or(0.0, |beyond| {
            let (w, stiffness) = (end_unknown(track, end), beyond.stiffness());
            stiffness[0][0] * (u[w] - level.ends[end]) + stiffness[0][1] * u[w + 1]
        })
    };
    of_end(0) + of_end(1)
}

fn end_unknown(track: &Track, end: usize) -> usize {
    if end == 0 { track.rail[0] } else { track.rail[track.rail.len() - 1] }
}
