//! The matrices of a meshed track and the forces of the track itself: every part adds its share.

use super::beam::add_element;
use super::ends;
use super::error::TrackError;
use super::mesh::{CarriedSleeper, FootUnknown, Track};
use super::model::{Foot, RailEnds, TrackLevel, TrackModel};
use super::numbering::{Numbering, place_nodes, rail_elements};
use crate::linalg::banded::SymmetricBanded;

impl Track {
    /// Meshes a model and assembles its matrices; fails if the model contradicts itself.
    pub fn new(model: TrackModel) -> Result<Self, TrackError> {
        model.check()?;
        let nodes = place_nodes(&model);
        let numbering = Numbering::new(&model, &nodes);
        let half_band = numbering.half_band();
        let order = numbering.order;
        let mut held = Vec::new();
        for (end, node) in [(0, 0), (1, nodes.len() - 1)] {
            if matches!(model.rail_ends, RailEnds::Clamped | RailEnds::Pinned) {
                held.push((numbering.rail[node], Some(end)));
            }
            if model.rail_ends == RailEnds::Clamped {
                held.push((numbering.rail[node] + 1, None));
            }
        }
        let zeros = SymmetricBanded::zeros(order, half_band);
        let mut track = Self {
            elements: rail_elements(&model, &nodes, &numbering),
            nodes,
            rail: numbering.rail,
            rail_unknowns: numbering.rail_unknowns,
            seat_nodes: numbering.seat_nodes,
            feet: numbering.feet,
            sleepers: numbering.sleepers,
            carried: numbering.carried,
            slabs: numbering.slabs,
            auxiliary_rails: numbering.auxiliary_rails,
            stiffness: zeros.clone(),
            damping: zeros.clone(),
            mass: zeros,
            weight: vec![0.0; order],
            dead_weight: 0.0,
            held,
            model,
        };
        track.assemble();
        Ok(track)
    }

    /// Adds up stiffness, damping, mass and weight, all supports closed.
    fn assemble(&mut self) {
        self.assemble_rail();
        self.assemble_slabs();
        self.assemble_auxiliary_rails();
        self.assemble_seats();
        ends::assemble(self);
    }

    /// Gravity on the nodes, and the forces that hold the rail ends at `level` if the track goes on beyond them.
    pub(super) fn own_forces(&self, level: &TrackLevel) -> Vec<f64> {
        let mut forces = self.weight.clone();
        for (end, unknown, pull) in ends::pulls(self) {
            forces[unknown] += pull * level.ends[end];
        }
        forces
    }

    /// Forces on the nodes that do not change while the track stays at `level`: the forces of the track itself and of
    /// the levels of the closed supports.
    pub(super) fn steady_forces(&self, level: &TrackLevel) -> Vec<f64> {
        let mut forces = self.own_forces(level);
        for sleeper in &self.sleepers {
            forces[sleeper.unknown] +=
                sleeper.support_stiffness * level.settlements[sleeper.seat] + sleeper.seating_loss();
        }
        forces
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
        let mut bodies = Vec::new();
        for (i, seat) in self.model.seats.iter().enumerate() {
            let (rail, foot) = (self.rail[self.seat_nodes[i]], self.foot_unknown(i));
            add_spring(&mut self.stiffness, rail, foot, seat.pad_stiffness);
            add_spring(&mut self.damping, rail, foot, seat.pad_damping);
            match (seat.foot, self.feet[i]) {
                (Foot::Sleeper { mass, support_stiffness, support_damping, .. }, FootUnknown::Sleeper(s)) => {
                    let unknown = self.sleepers[s].unknown;
                    self.stiffness.add(unknown, unknown, support_stiffness);
                    self.damping.add(unknown, unknown, support_damping);
                    bodies.push((unknown, mass));
                }
                (Foot::Carried { mass, pad, pitch }, FootUnknown::Carried(c)) => {
                    let CarriedSleeper { unknown, underside, pitch: turn, .. } = self.carried[c];
                    bodies.push((unknown, mass));
                    if let Some(pad) = pad {
                        bodies.push((underside, pad.mass));
                        add_spring(&mut self.stiffness, unknown, Some(underside), pad.stiffness);
                        add_spring(&mut self.damping, unknown, Some(underside), pad.damping);
                    }
                    if let (Some(pitch), Some(turn)) = (pitch, turn) {
                        // the slope of the rail is its next unknown
                        let damping = pitch.stiffness * seat.pad_damping / seat.pad_stiffness;
                        add_spring(&mut self.stiffness, rail + 1, Some(turn), pitch.stiffness);
                        add_spring(&mut self.damping, rail + 1, Some(turn), damping);
                        self.mass.add(turn, turn, pitch.inertia);
                    }
                }
                _ => {}
            }
        }
        for (unknown, mass) in bodies {
            self.mass.add(unknown, unknown, mass);
            self.weight[unknown] += mass * self.model.gravity;
            self.dead_weight += mass * self.model.gravity;
        }
    }
}

/// Adds a spring or damper between two unknowns, or between an unknown and fixed ground.
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
