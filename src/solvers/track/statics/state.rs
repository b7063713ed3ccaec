//! The result of an equilibrium: deflections, forces and their balance.

use super::standing::StandingTrain;
use crate::solvers::track::ends;
use crate::solvers::track::mesh::{FootUnknown, RailPoint, Track};
use crate::solvers::track::{SupportPhase, TrackError, TrackLevel};

/// An equilibrium of the track. Lists run over nodes, seats or wheels as the fields say; all positive down.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticState {
    /// Per node, m, from the track as built.
    pub rail_deflection: Vec<f64>,
    /// Per node, rad.
    pub rail_slope: Vec<f64>,
    /// Per node, N m, sagging positive.
    pub rail_moment: Vec<f64>,
    /// Force of the rail on the pad, per seat, N.
    pub seat_loads: Vec<f64>,
    /// Force of the sleeper on its support, per seat, N; 0 for seats without a sleeper. A sleeper carried by external
    /// forces is held: a negative force keeps it down.
    pub contact_forces: Vec<f64>,
    /// Displacement of sleeper or slab under each seat, m, from the track as built; 0 for rigid seats.
    pub foot_displacements: Vec<f64>,
    /// Per wheel, vehicle by vehicle, N.
    pub wheel_forces: Vec<f64>,
    pub balance: Balance,
    /// Number of sets of phases that were tried.
    pub iterations: usize,
    /// All unknowns of the track.
    pub(in super::super) unknowns: Vec<f64>,
    /// Per sleeper.
    pub(in super::super) phases: Vec<SupportPhase>,
    pub(in super::super) vehicles: Vec<Vec<f64>>,
    /// Per wheel, m; 0 under a given force.
    pub(in super::super) indentations: Vec<f64>,
    pub(in super::super) on_rail: Vec<(RailPoint, f64)>,
}

/// The sums of forces in an equilibrium, N, loads downward and supports upward.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// Gravity on rails, sleepers and vehicles, and the point loads; the weight of a slab is not included, because the
    /// slab at rest is the reference.
    pub loads: f64,
    /// Force of the sleepers' supports.
    pub sleeper_supports: f64,
    pub rigid_seats: f64,
    /// Without the weight of the slabs.
    pub slab_foundations: f64,
    pub rail_ends: f64,
}

impl Balance {
    /// All supports together, N.
    pub fn supports(&self) -> f64 {
        self.sleeper_supports + self.rigid_seats + self.slab_foundations + self.rail_ends
    }
}

#[expect(clippy::too_many_arguments, reason = "it only moves what the solve found into its result")]
pub(super) fn describe(
    track: &Track,
    level: &TrackLevel,
    unknowns: Vec<f64>,
    phases: Vec<SupportPhase>,
    on_rail: Vec<(RailPoint, f64)>,
    wheels: StandingTrain,
    point_loads: f64,
    iterations: usize,
) -> StaticState {
    let model = &track.model;
    let u = &unknowns;
    let rail_deflection: Vec<f64> = track.rail.iter().map(|w| u[*w]).collect();
    let moment = |node: usize| {
        let clamping: f64 = on_rail.iter().map(|(point, force)| track.clamping_moment(node, point, *force)).sum();
        track.cubic_moment(node, u) + clamping
    };
    let foot_displacements: Vec<f64> =
        (0..model.seats.len()).map(|seat| track.foot_unknown(seat).map_or(0.0, |unknown| u[unknown])).collect();
    let seat_loads: Vec<f64> = (0..model.seats.len())
        .map(|i| model.seats[i].pad_stiffness * (rail_deflection[track.seat_nodes[i]] - foot_displacements[i]))
        .collect();
    let mut contact_forces = vec![0.0; model.seats.len()];
    for (sleeper, phase) in track.sleepers.iter().zip(&phases) {
        let gap = u[sleeper.unknown] - level.settlements[sleeper.seat];
        contact_forces[sleeper.seat] = sleeper.spring_force(*phase, gap).max(0.0);
    }

    let vehicle_weight = wheels.weight();
    let mut reactions = track.weight.clone();
    for (point, force) in &on_rail {
        track.add_force(point, *force, &mut reactions);
    }
    track.stiffness.subtract_product(u, &mut reactions);
    for carried in &track.carried {
        contact_forces[carried.seat] = reactions[carried.underside];
    }
    let balance = Balance {
        loads: track.dead_weight + vehicle_weight + point_loads,
        sleeper_supports: contact_forces.iter().sum(),
        rigid_seats: (0..model.seats.len())
            .filter(|i| track.feet[*i] == FootUnknown::Rigid)
            .map(|i| seat_loads[i])
            .sum(),
        slab_foundations: slab_reactions(track, u),
        rail_ends: track
            .held
            .iter()
            .filter(|(_, end)| end.is_some())
            .map(|(unknown, _)| reactions[*unknown])
            .sum::<f64>()
            + ends::carried(track, level, u),
    };
    StaticState {
        rail_slope: track.rail.iter().map(|w| u[*w + 1]).collect(),
        rail_moment: (0..track.nodes.len()).map(moment).collect(),
        rail_deflection,
        seat_loads,
        contact_forces,
        foot_displacements,
        wheel_forces: wheels.forces,
        balance,
        iterations,
        unknowns,
        phases,
        vehicles: wheels.vehicles,
        indentations: wheels.indentations,
        on_rail,
    }
}

fn slab_reactions(track: &Track, u: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (slab, mesh) in track.model.slabs.iter().zip(&track.slabs) {
        for (unknowns, beam) in mesh.elements(&track.nodes, slab.bending_stiffness) {
            let load = beam.even_load(slab.foundation_stiffness);
            sum += unknowns.into_iter().zip(load).map(|(unknown, load)| load * u[unknown]).sum::<f64>();
        }
    }
    sum
}

impl StaticState {
    /// Deflection of the rail at x, m, relative to the track as built; exact between nodes under point loads. Fails if
    /// x is off the track.
    pub fn rail_deflection_at(&self, track: &Track, x: f64) -> Result<f64, TrackError> {
        let point = track.rail_point(x)?;
        let local: f64 = self
            .on_rail
            .iter()
            .filter(|(load, _)| load.element == point.element)
            .map(|(load, force)| force * track.local_deflection(&point, load))
            .sum();
        Ok(track.deflection_at(&point, &self.unknowns) + local)
    }
}
