//! One time step of one track, factored once: the effective matrix, and the displacements by forces at the contacts
//! within the step.
//!
//! With all supports closed the equation of a step is linear in the acceleration at its end,
//! `M̂ a_{n+1} = r_n + (1-αf) q`. Here q are the wheel forces and the forces by which supports that are not closed
//! differ from closed supports. The displacement by q is `A q` with `A = (1-αf) β Δt² M̂⁻¹`. For short steps A decays
//! within a fraction of a metre, so each of its columns is kept only at the unknowns at which it is not negligible.
//! Memory grows with the length of the track, not with its square.

use super::scheme::Scheme;
use super::{Track, TrackError};
use crate::linalg::banded::{NotPositiveDefinite, SymmetricBanded, Window};
use crate::linalg::twisted::TwistedFactor;
use std::sync::Arc;

/// A time step prepared for one track; immutable and shared by all passages.
#[derive(Debug, Clone)]
pub struct Stepper {
    pub(super) track: Arc<Track>,
    pub(super) scheme: Scheme,
    pub(super) factor: TwistedFactor,
    /// Columns of A for the unknowns of the rail: displacement of all unknowns per force, m/N.
    pub(super) of_rail: Vec<Window>,
    /// The same columns at the sleepers alone, counted by sleeper.
    pub(super) of_rail_at_sleepers: Vec<Window>,
    /// Columns of A for each sleeper, at all unknowns and at the sleepers alone.
    pub(super) of_sleeper: Vec<Window>,
    pub(super) of_sleeper_at_sleepers: Vec<Window>,
}

/// Share of the largest entry of a column below which the rest of the column is dropped.
const NEGLIGIBLE: f64 = 1e-18;

impl Stepper {
    /// Factors one step; fails if the track is a mechanism without mass, or if a sleeper has no support of its own.
    pub fn new(track: Arc<Track>, scheme: Scheme) -> Result<Self, TrackError> {
        track.check_supported()?;
        let (of_mass, of_damping, of_stiffness) = scheme.effective();
        let mut matrix = SymmetricBanded::zeros(track.order(), track.mass.half_band());
        matrix.add_scaled(of_mass, &track.mass);
        matrix.add_scaled(of_damping, &track.damping);
        matrix.add_scaled(of_stiffness, &track.stiffness);
        for (unknown, _) in &track.held {
            matrix.pin(*unknown);
        }
        let mechanism = |e: NotPositiveDefinite| TrackError::Mechanism { x: track.place_of(e.row) };
        let factor = matrix.factor().map_err(mechanism)?;

        let mut scratch = vec![0.0; track.order()];
        let mut column = |unknown: usize| {
            if track.held.iter().any(|(held, _)| *held == unknown) {
                return Window { start: unknown, values: Vec::new() };
            }
            let mut column = factor.inverse_column(unknown, NEGLIGIBLE, &mut scratch);
            column.values.iter_mut().for_each(|a| *a *= of_stiffness);
            column
        };
        let of_rail: Vec<Window> = track.rail_unknowns.iter().map(|u| column(*u)).collect();
        let of_sleeper: Vec<Window> = track.sleepers.iter().map(|s| column(s.unknown)).collect();
        let at_sleepers = |column: &Window| {
            let start = track.sleepers.partition_point(|s| s.unknown < column.start);
            let end = track.sleepers.partition_point(|s| s.unknown < column.end());
            Window { start, values: track.sleepers[start..end].iter().map(|s| column.entry(s.unknown)).collect() }
        };
        Ok(Self {
            of_rail_at_sleepers: of_rail.iter().map(at_sleepers).collect(),
            of_sleeper_at_sleepers: of_sleeper.iter().map(at_sleepers).collect(),
            of_rail,
            of_sleeper,
            factor: TwistedFactor::new(&matrix).map_err(mechanism)?,
            scheme,
            track,
        })
    }

    /// Columns of A for the unknowns of a rail element.
    #[inline]
    pub(super) fn columns(&self, element: usize) -> [&Window; 4] {
        self.track.elements[element].columns.map(|column| &self.of_rail[column])
    }

    /// The same at the sleepers alone, counted by sleeper.
    #[inline]
    pub(super) fn columns_at_sleepers(&self, element: usize) -> [&Window; 4] {
        self.track.elements[element].columns.map(|column| &self.of_rail_at_sleepers[column])
    }

    pub fn track(&self) -> &Track {
        &self.track
    }

    /// s.
    pub fn time_step(&self) -> f64 {
        self.scheme.time_step
    }
}
