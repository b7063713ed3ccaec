//! Rail ends beyond which the track goes on.
//!
//! The static stiffness of the track beyond an end is the stiffness of a half-infinite beam on a Winkler foundation
//! (deflection and rotation, λ⁴ = k/4EI):
//!
//! ```text
//! F = 4EIλ³ w ± 2EIλ² θ,   M = ±2EIλ² w + 2EIλ θ      (+ at the right end, - at the left)
//! ```
//!
//! A wheel at distance d beyond an end acts on the end through that beam, by the shape of the beam. Its deflection is
//! larger than the shape by the deflection of a beam clamped at the end:
//!
//! ```text
//! φ_w = e^{-λd} (cos λd + sin λd),   φ_θ = ±e^{-λd} sin λd/λ,   c = λ/2k (1 - φ_w² - 2 e^{-2λd} sin² λd)
//! ```
//!
//! Waves are damped by dampers along the rail before the end, `c(x) = c_end ξ²`, with ξ from 0 at the inner end of the
//! layer to 1 at the end of the rail. A damping that begins with a jump would reflect the waves.

use super::beam::add_element;
use super::mesh::Track;
use super::model::{Foot, RailEnds, TrackLevel};
use crate::linalg::banded::SymmetricBanded;

/// Length of the damped layer, m, if the track is at least four times as long.
const LAYER: f64 = 5.0;
/// Damping at the very end in units of √(k m); k is the foundation and m the rail, both per metre.
const DAMPING: f64 = 3.0;

/// Distance beyond an end, in units of 1/λ, from which a wheel has no effect on the end.
const FELT: f64 = 10.0;

/// The continuation of a rail beyond one of its ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Continuation {
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
    /// None if the track ends with its rail.
    pub fn new(track: &Track, end: usize) -> Option<Self> {
        let model = &track.model;
        if model.rail_ends != RailEnds::Absorbing {
            return None;
        }
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

    /// λ, 1/m.
    fn decay(&self) -> f64 {
        (self.foundation / (4.0 * self.bending_stiffness)).powf(0.25)
    }

    /// Distance beyond the end within which a wheel acts on the end, m.
    pub fn reach(&self) -> f64 {
        FELT / self.decay()
    }

    /// φ_w, φ_θ and c (m/N) at a distance beyond the end, m.
    pub fn shape_at(&self, distance: f64) -> ([f64; 2], f64) {
        let decay = self.decay();
        let (sin, cos) = (decay * distance).sin_cos();
        let fade = (-decay * distance).exp();
        let shape = fade * (cos + sin);
        let compliance = 0.5 * decay / self.foundation * (1.0 - shape * shape - 2.0 * (fade * sin).powi(2));
        ([shape, self.side * fade * sin / decay], compliance)
    }

    /// Mass that moves with deflection and rotation of the end in the shapes φ: kg, kg m, kg m^2.
    fn mass(&self) -> [[f64; 2]; 2] {
        let decay = self.decay();
        let coupling = self.side * self.mass / (4.0 * decay * decay);
        [[0.75 * self.mass / decay, coupling], [coupling, self.mass / (8.0 * decay.powi(3))]]
    }

    /// Stiffness over deflection and rotation of the end.
    fn stiffness(&self) -> [[f64; 2]; 2] {
        let ei = self.bending_stiffness;
        let decay = self.decay();
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

/// Adds the mass of the rails beyond both ends.
pub(super) fn add_mass(track: &Track, matrix: &mut SymmetricBanded) {
    for end in [0, 1] {
        let Some(beyond) = Continuation::new(track, end) else { continue };
        let (w, mass) = (end_unknown(track, end), beyond.mass());
        matrix.add(w, w, mass[0][0]);
        matrix.add(w + 1, w, mass[1][0]);
        matrix.add(w + 1, w + 1, mass[1][1]);
    }
}

/// The forces by which the settled track beyond the ends pulls the ends to its level: end, unknown, and N or N m per
/// metre of level.
pub(super) fn pulls(track: &Track) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let of_end =
        |end: usize| Continuation::new(track, end).map(|beyond| (end, end_unknown(track, end), beyond.stiffness()));
    [0, 1].into_iter().filter_map(of_end).flat_map(|(end, w, k)| [(end, w, k[0][0]), (end, w + 1, k[1][0])])
}

/// Force carried by the track beyond both ends, N.
pub(super) fn carried(track: &Track, level: &TrackLevel, u: &[f64]) -> f64 {
    let of_end = |end: usize| {
        Continuation::new(track, end).map_or(0.0, |beyond| {
            let (w, stiffness) = (end_unknown(track, end), beyond.stiffness());
            stiffness[0][0] * (u[w] - level.ends[end]) + stiffness[0][1] * u[w + 1]
        })
    };
    of_end(0) + of_end(1)
}

/// Unknown of the deflection of an end of the rail; its rotation is the next one.
pub(super) fn end_unknown(track: &Track, end: usize) -> usize {
    if end == 0 { track.rail[0] } else { track.rail[track.rail.len() - 1] }
}
