//! The matrices of a meshed track: every part adds its own.

use super::beam::ElementMatrix;
use super::ends;
use super::mesh::{FootUnknown, Track};
use super::{Foot, RailEnds};
use crate::linalg::banded::SymmetricBanded;

impl Track {
    /// Adds up stiffness, damping, mass and weight, all supports closed.
    pub(super) fn assemble(&mut self) {
        self.assemble_rail();
        self.assemble_slabs();
        self.assemble_auxiliary_rails();
        self.assemble_seats();
        if self.model.rail_ends == RailEnds::Absorbing {
            ends::assemble(self);
        }
    }

    fn assemble_rail(&mut self) {
        for (element, pair) in self.elements.iter().zip(self.nodes.windows(2)) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let Some(section) = self.model.rail.iter().find(|s| middle <= s.end).or(self.model.rail.last()) else {
                continue;
            };
            let (beam, unknowns) = (element.beam, element.unknowns);
            add_element(&mut self.stiffness, unknowns, beam.stiffness());
            add_element(&mut self.mass, unknowns, beam.spread(section.mass));
            if let Some(shear) = section.shear {
                add_element(&mut self.mass, unknowns, beam.rotary(shear.rotary_inertia));
            }
            let weight = section.mass * self.model.gravity;
            add_load(&mut self.weight, unknowns, beam.even_load(weight));
            self.dead_weight += weight * beam.length;
        }
    }

    fn assemble_slabs(&mut self) {
        for (slab, mesh) in self.model.slabs.iter().zip(&self.slabs) {
            for (unknowns, beam) in mesh.elements(&self.nodes, slab.bending_stiffness) {
                add_element(&mut self.stiffness, unknowns, beam.stiffness());
                add_element(&mut self.stiffness, unknowns, beam.spread(slab.foundation_stiffness));
                add_element(&mut self.damping, unknowns, beam.spread(slab.foundation_damping));
                add_element(&mut self.mass, unknowns, beam.spread(slab.mass));
            }
        }
    }

    fn assemble_auxiliary_rails(&mut self) {
        for (rail, mesh) in self.model.auxiliary_rails.iter().zip(&self.auxiliary_rails) {
            for (unknowns, beam) in mesh.elements(&self.nodes, rail.bending_stiffness) {
                let weight = rail.mass * self.model.gravity;
                add_element(&mut self.stiffness, unknowns, beam.stiffness());
                add_element(&mut self.mass, unknowns, beam.spread(rail.mass));
                add_load(&mut self.weight, unknowns, beam.even_load(weight));
                self.dead_weight += weight * beam.length;
            }
            for (seat, node) in self.seat_nodes.iter().enumerate() {
                if !rail.carries(self.model.seats[seat].x) {
                    continue;
                }
                let (unknown, foot) = (mesh.unknowns[node - mesh.first_node], self.foot_unknown(seat));
                add_spring(&mut self.stiffness, unknown, foot, rail.pad_stiffness);
                add_spring(&mut self.damping, unknown, foot, rail.pad_damping);
            }
        }
    }

    fn assemble_seats(&mut self) {
        for (i, seat) in self.model.seats.iter().enumerate() {
            let (rail, foot) = (self.rail[self.seat_nodes[i]], self.foot_unknown(i));
            add_spring(&mut self.stiffness, rail, foot, seat.pad_stiffness);
            add_spring(&mut self.damping, rail, foot, seat.pad_damping);
            if let (Foot::Sleeper { mass, support_stiffness, support_damping, .. }, FootUnknown::Sleeper(s)) =
                (seat.foot, self.feet[i])
            {
                let unknown = self.sleepers[s].unknown;
                self.stiffness.add(unknown, unknown, support_stiffness);
                self.damping.add(unknown, unknown, support_damping);
                self.mass.add(unknown, unknown, mass);
                self.weight[unknown] += mass * self.model.gravity;
                self.dead_weight += mass * self.model.gravity;
            }
        }
    }
}

/// Adds the matrix of an element over its unknowns.
pub(super) fn add_element(matrix: &mut SymmetricBanded, unknowns: [usize; 4], element: ElementMatrix) {
    for (r, row) in element.iter().enumerate() {
        for c in 0..=r {
            matrix.add(unknowns[r], unknowns[c], row[c]);
        }
    }
}

/// Adds a spring or damper between an unknown and another, or ground that does not move.
fn add_spring(matrix: &mut SymmetricBanded, unknown: usize, foot: Option<usize>, value: f64) {
    matrix.add(unknown, unknown, value);
    if let Some(foot) = foot {
        matrix.add(foot, foot, value);
        matrix.add(unknown, foot, -value);
    }
}

fn add_load(forces: &mut [f64], unknowns: [usize; 4], load: [f64; 4]) {
    for (unknown, value) in unknowns.into_iter().zip(load) {
        forces[unknown] += value;
    }
}
