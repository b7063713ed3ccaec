//! Forces of standing bogies on the supports: the part of the forces of a train that follows the settlement at once.
//!
//! A passage gives the forces on the track as it lies then. While trains settle the track, the rail shifts load from
//! sleepers that settle more to others. This part is static, and it is cheap beside a passage:
//!
//! ```text
//! F(s) = F(passage at s0) + F_standing(s) - F_standing(s0)
//! ```
//!
//! What is left for the next passage is the change of the dynamic part. Voids under the sleepers without a train follow
//! in the same way, for laws that see them.

use crate::graph::{Blocks, Bogie, Responses, TrackNode};
use crate::solvers::settlement::Peak;
use crate::solvers::track::{Loads, Track, TrackError, TrackLevel, forces_under_wheels, solve_static};
use rayon::prelude::*;

/// Standing bogies of every kind of train on a track with one element a bay.
pub struct StandingBogies {
    rows: Vec<Row>,
    /// The bogies of each kind of train.
    kinds: Vec<Vec<Bogie>>,
}

/// Some seats, on the part of the track that bears a bogie over them.
struct Row {
    node: TrackNode,
    track: Track,
    responses: Responses,
    /// Index of the first seat of the part among all seats.
    first: usize,
    /// The seats on springs for which this row is there, by their index in the part.
    seats: Vec<usize>,
}

/// Forces of standing bogies on one settlement; index by kind of train, kind of bogie and seat of the track.
#[derive(Debug, Clone, PartialEq)]
pub struct StandingForces(Vec<Vec<Vec<Peak>>>);

/// Seats of a row, and seats beside it that bear with it: five decay lengths of the deflection.
const ROW: usize = 16;
const BESIDE: usize = 14;

impl Row {
    fn new(track: &TrackNode, responses: &Responses, seats: &[usize]) -> Result<Option<Row>, TrackError> {
        let [Some(left), Some(right)] = [seats.first(), seats.last()] else { return Ok(None) };
        let first = left.saturating_sub(BESIDE);
        let last = (right + BESIDE).min(track.seats.len() - 1);
        let Some(node) = track.part(first, last) else { return Ok(None) };
        let part = responses.seats.get(first..=last).unwrap_or_default().to_vec();
        let responses = Responses { revision: responses.revision, seats: part };
        let seats = seats.iter().map(|seat| seat - first).collect();
        Ok(Some(Row { track: Track::new(node.model(&responses))?, node, responses, first, seats }))
    }

    /// The part of a settlement of every seat (m).
    fn here<'s>(&self, settlement: &'s [f64]) -> &'s [f64] {
        &settlement[self.first..self.first + self.node.seats.len()]
    }

    fn level(&self, settlement: &[f64]) -> TrackLevel {
        self.node.level(self.here(settlement), &self.responses)
    }

    /// Forces of a bogie on the supports of its seats, N, and deflections of these supports, m.
    fn forces(&self, settlement: &[f64], bogie: &Bogie) -> Result<Vec<[f64; 2]>, TrackError> {
        forces_under_wheels(&self.track, &self.level(settlement), bogie.wheels, &self.seats)
    }

    /// Gaps under the sleepers of its seats without a train, m.
    fn voids(&self, settlement: &[f64]) -> Result<Vec<f64>, TrackError> {
        let state = solve_static(&self.track, &self.level(settlement), &Loads::default())?;
        let here = self.here(settlement);
        Ok(self.seats.iter().map(|seat| (here[*seat] - state.foot_displacements[*seat]).max(0.0)).collect())
    }
}

impl StandingBogies {
    /// Fails if the track is a mechanism.
    pub fn new(track: &TrackNode, responses: &Responses, blocks: &Blocks) -> Result<Self, TrackError> {
        let settles = |seat: &usize| responses.seats.get(*seat).copied().flatten().is_some();
        let seats: Vec<usize> = (0..track.seats.len()).filter(settles).collect();
        let rows = seats.chunks(ROW).filter_map(|seats| Row::new(track, responses, seats).transpose());
        let kinds = blocks.kinds().map(|(train, _)| train.bogies(track.gravity)).collect();
        Ok(StandingBogies { rows: rows.collect::<Result<_, _>>()?, kinds })
    }

    /// The forces on a settlement of every seat (m), and the voids if they are asked for; fails if the track has no
    /// equilibrium.
    pub fn forces(&self, settlement: &[f64], with_voids: bool) -> Result<StandingForces, TrackError> {
        let tasks: Vec<(usize, usize, &Row)> = (0..self.kinds.len())
            .flat_map(|kind| (0..self.kinds[kind].len()).map(move |bogie| (kind, bogie)))
            .flat_map(|(kind, bogie)| self.rows.iter().map(move |row| (kind, bogie, row)))
            .collect();
        let of_task = |(kind, bogie, row): &(usize, usize, &Row)| row.forces(settlement, &self.kinds[*kind][*bogie]);
        let found: Vec<Result<Vec<[f64; 2]>, TrackError>> = tasks.par_iter().map(of_task).collect();
        let none = vec![Peak::default(); settlement.len()];
        let mut forces: Vec<Vec<Vec<Peak>>> = self.kinds.iter().map(|kind| vec![none.clone(); kind.len()]).collect();
        for ((kind, bogie, row), found) in tasks.into_iter().zip(found) {
            for ([force, deflection], seat) in found?.into_iter().zip(&row.seats) {
                forces[kind][bogie][row.first + seat] = Peak { force, deflection, void: 0.0 };
            }
        }
        if with_voids {
            let voids: Vec<Result<Vec<f64>, TrackError>> =
                self.rows.par_iter().map(|row| row.voids(settlement)).collect();
            for (row, voids) in self.rows.iter().zip(voids) {
                for (seat, void) in row.seats.iter().zip(voids?) {
                    forces.iter_mut().flatten().for_each(|bogie| bogie[row.first + seat].void = void);
                }
            }
        }
        Ok(StandingForces(forces))
    }

    /// Peak forces of a passage over a settlement with the forces `from`, on a settlement with the forces `to`. Index
    /// by seat, then by wheel of the train.
    pub fn follow(
        &self,
        kind: usize,
        peaks: &[Vec<Peak>],
        from: &StandingForces,
        to: &StandingForces,
    ) -> Vec<Vec<Peak>> {
        let mut followed = peaks.to_vec();
        for (number, bogie) in self.kinds[kind].iter().enumerate() {
            let (from, to) = (&from.0[kind][number], &to.0[kind][number]);
            for (seat, peaks) in followed.iter_mut().enumerate() {
                for wheel in &bogie.wheels_of_train {
                    if let Some(peak) = peaks.get_mut(*wheel) {
                        *peak = peak.followed(from[seat], to[seat]);
                    }
                }
            }
        }
        followed
    }
}

impl StandingForces {
    /// Forces between these (0) and others (1).
    pub fn towards(&self, end: &StandingForces, share: f64) -> StandingForces {
        let bogie = |(a, b): (&Vec<Peak>, &Vec<Peak>)| a.iter().zip(b).map(|(a, b)| a.towards(*b, share)).collect();
        let kind = |(a, b): (&Vec<Vec<Peak>>, &Vec<Vec<Peak>>)| a.iter().zip(b).map(bogie).collect();
        StandingForces(self.0.iter().zip(&end.0).map(kind).collect())
    }
}
