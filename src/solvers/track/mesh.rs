//! The meshed track: nodes, the numbering of unknowns, and the matrices with all supports closed.
//!
//! Nodes stand at every seat, section boundary, slab end and rail end, with `elements_per_bay` elements between two seats and
//! proportionally fewer in shorter stretches. Unknowns are numbered node by node - rail deflection and slope, sleeper, slab
//! deflection and slope - so the half band is 5 with sleepers on one side and a slab on the other, 7 where two slabs meet.

use super::beam::{self, ElementMatrix};
use super::model::SAME_PLACE;
use super::{Foot, RailEnds, TrackError, TrackLevel, TrackModel};
use crate::linalg::banded::SymmetricBanded;

/// A [`TrackModel`] with its mesh and matrices; immutable and shared by all states and passages.
#[derive(Debug, Clone)]
pub struct Track {
    pub(super) model: TrackModel,
    /// Chainage of the rail nodes, m.
    pub(super) nodes: Vec<f64>,
    /// Unknown of the rail deflection at each node; the slope is the next one.
    pub(super) rail: Vec<usize>,
    /// Between node i and node i + 1.
    pub(super) elements: Vec<RailElement>,
    /// Node of each seat.
    pub(super) seat_nodes: Vec<usize>,
    pub(super) feet: Vec<FootUnknown>,
    pub(super) sleepers: Vec<Sleeper>,
    pub(super) slabs: Vec<SlabMesh>,
    /// All supports closed, nothing held.
    pub(super) stiffness: SymmetricBanded,
    pub(super) damping: SymmetricBanded,
    pub(super) mass: SymmetricBanded,
    /// Nodal forces of gravity, N and N m.
    pub(super) weight: Vec<f64>,
    /// Unknowns that are prescribed, and the rail end whose level they take; none for a rotation that is zero.
    pub(super) held: Vec<(usize, Option<usize>)>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct RailElement {
    pub length: f64,
    pub bending_stiffness: f64,
}

/// What the foot of a seat moves with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FootUnknown {
    /// Index into [`Track::sleepers`].
    Sleeper(usize),
    Slab {
        unknown: usize,
    },
    Rigid,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Sleeper {
    pub seat: usize,
    pub unknown: usize,
    pub support_stiffness: f64,
    pub support_damping: f64,
}

#[derive(Debug, Clone)]
pub(super) struct SlabMesh {
    pub first_node: usize,
    /// Unknown of its deflection at each of its nodes; the slope is the next one.
    pub unknowns: Vec<usize>,
}

/// A place on the rail: its element and how a force there acts on the nodes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct RailPoint {
    pub element: usize,
    /// Distance from the element's left node, m.
    pub offset: f64,
    pub shape: [f64; 4],
    /// Deflection at the point beyond that of the cubic per unit force there, m/N.
    pub local_compliance: f64,
}

impl Track {
    /// Meshes a model and assembles its matrices; fails where the model contradicts itself.
    pub fn new(model: TrackModel) -> Result<Self, TrackError> {
        model.check()?;
        let nodes = place_nodes(&model);
        let node_at = |x: f64| nearest(&nodes, x);
        let seat_nodes: Vec<usize> = model.seats.iter().map(|seat| node_at(seat.x)).collect();
        let mut slabs: Vec<SlabMesh> = Vec::new();
        let slab_nodes: Vec<(usize, usize)> = model.slabs.iter().map(|s| (node_at(s.start), node_at(s.end))).collect();
        slabs.extend(slab_nodes.iter().map(|(first, _)| SlabMesh { first_node: *first, unknowns: Vec::new() }));

        let mut rail = Vec::with_capacity(nodes.len());
        let mut feet = vec![FootUnknown::Rigid; model.seats.len()];
        let mut sleepers = Vec::new();
        let mut seats = seat_nodes.iter().copied().enumerate().peekable();
        let mut order = 0;
        for node in 0..nodes.len() {
            rail.push(order);
            order += 2;
            let seat = seats.next_if(|(_, at)| *at == node).map(|(seat, _)| seat);
            if let Some(seat) = seat
                && let Foot::Sleeper { support_stiffness, support_damping, .. } = model.seats[seat].foot
            {
                feet[seat] = FootUnknown::Sleeper(sleepers.len());
                sleepers.push(Sleeper { seat, unknown: order, support_stiffness, support_damping });
                order += 1;
            }
            for (slab, (first, last)) in slabs.iter_mut().zip(&slab_nodes) {
                if (*first..=*last).contains(&node) {
                    if let Some(seat) = seat
                        && model.seats[seat].foot == Foot::Slab
                    {
                        feet[seat] = FootUnknown::Slab { unknown: order };
                    }
                    slab.unknowns.push(order);
                    order += 2;
                }
            }
        }

        let section_at = |x: f64| model.rail.iter().find(|s| x <= s.end).or(model.rail.last());
        let mut elements = Vec::with_capacity(nodes.len());
        for pair in nodes.windows(2) {
            let length = pair[1] - pair[0];
            let bending_stiffness = section_at(pair[0] + 0.5 * length).map_or(0.0, |s| s.bending_stiffness);
            elements.push(RailElement { length, bending_stiffness });
        }
        let mut held = Vec::new();
        for (end, node) in [(0, 0), (1, nodes.len() - 1)] {
            if model.rail_ends != RailEnds::Free {
                held.push((rail[node], Some(end)));
            }
            if model.rail_ends == RailEnds::Clamped {
                held.push((rail[node] + 1, None));
            }
        }

        let mut half_band = 3;
        for node in 0..elements.len() {
            half_band = half_band.max(rail[node + 1] + 1 - rail[node]);
        }
        for pair in slabs.iter().flat_map(|s| s.unknowns.windows(2)) {
            half_band = half_band.max(pair[1] + 1 - pair[0]);
        }
        for (node, foot) in seat_nodes.iter().zip(&feet) {
            if let FootUnknown::Slab { unknown } = foot {
                half_band = half_band.max(unknown - rail[*node]);
            }
        }
        let zeros = SymmetricBanded::zeros(order, half_band);
        let mut track = Self {
            nodes,
            rail,
            elements,
            seat_nodes,
            feet,
            sleepers,
            slabs,
            stiffness: zeros.clone(),
            damping: zeros.clone(),
            mass: zeros,
            weight: vec![0.0; order],
            held,
            model,
        };
        track.assemble();
        Ok(track)
    }

    fn assemble(&mut self) {
        let gravity = self.model.gravity;
        for node in 0..self.elements.len() {
            let RailElement { length, bending_stiffness } = self.elements[node];
            let middle = self.nodes[node] + 0.5 * length;
            let mass =
                self.model.rail.iter().find(|s| middle <= s.end).or(self.model.rail.last()).map_or(0.0, |s| s.mass);
            let unknowns = [self.rail[node], self.rail[node + 1]];
            add_element(&mut self.stiffness, unknowns, beam::stiffness(bending_stiffness, length));
            add_element(&mut self.mass, unknowns, beam::spread(mass, length));
            add_load(&mut self.weight, unknowns, beam::even_load(mass * gravity, length));
        }
        for (slab, mesh) in self.model.slabs.iter().zip(&self.slabs) {
            for (i, pair) in mesh.unknowns.windows(2).enumerate() {
                let node = mesh.first_node + i;
                let (unknowns, length) = ([pair[0], pair[1]], self.nodes[node + 1] - self.nodes[node]);
                add_element(&mut self.stiffness, unknowns, beam::stiffness(slab.bending_stiffness, length));
                add_element(&mut self.stiffness, unknowns, beam::spread(slab.foundation_stiffness, length));
                add_element(&mut self.damping, unknowns, beam::spread(slab.foundation_damping, length));
                add_element(&mut self.mass, unknowns, beam::spread(slab.mass, length));
            }
        }
        for (i, seat) in self.model.seats.iter().enumerate() {
            let rail = self.rail[self.seat_nodes[i]];
            let mut matrices = [(&mut self.stiffness, seat.pad_stiffness), (&mut self.damping, seat.pad_damping)];
            for (matrix, value) in &mut matrices {
                matrix.add(rail, rail, *value);
                let foot = match self.feet[i] {
                    FootUnknown::Sleeper(s) => self.sleepers[s].unknown,
                    FootUnknown::Slab { unknown } => unknown,
                    FootUnknown::Rigid => continue,
                };
                matrix.add(foot, foot, *value);
                matrix.add(rail, foot, -*value);
            }
            if let (Foot::Sleeper { mass, support_stiffness, support_damping }, FootUnknown::Sleeper(s)) =
                (seat.foot, self.feet[i])
            {
                let unknown = self.sleepers[s].unknown;
                self.stiffness.add(unknown, unknown, support_stiffness);
                self.damping.add(unknown, unknown, support_damping);
                self.mass.add(unknown, unknown, mass);
                self.weight[unknown] += mass * gravity;
            }
        }
    }

    pub fn model(&self) -> &TrackModel {
        &self.model
    }

    /// Chainage of the rail nodes, m, left to right.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The rail node at a seat.
    pub fn seat_node(&self, seat: usize) -> usize {
        self.seat_nodes[seat]
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.weight.len()
    }

    /// The place x (m) on the rail; fails outside the track.
    pub(super) fn rail_point(&self, x: f64) -> Result<RailPoint, TrackError> {
        let [start, end] = self.model.ends;
        let inside = start - SAME_PLACE <= x && x <= end + SAME_PLACE;
        if !inside {
            return Err(TrackError::OffTrack { x, start, end });
        }
        let element = self.nodes.partition_point(|node| *node <= x).clamp(1, self.elements.len()) - 1;
        Ok(self.point_in(element, x))
    }

    /// The place x (m) near `element`, for a point that has moved a little.
    #[inline]
    pub(super) fn moved_point(&self, mut element: usize, x: f64) -> RailPoint {
        while element > 0 && x < self.nodes[element] {
            element -= 1;
        }
        while element + 1 < self.elements.len() && x >= self.nodes[element + 1] {
            element += 1;
        }
        self.point_in(element, x)
    }

    fn point_in(&self, element: usize, x: f64) -> RailPoint {
        let RailElement { length, bending_stiffness } = self.elements[element];
        let offset = (x - self.nodes[element]).clamp(0.0, length);
        RailPoint {
            element,
            offset,
            shape: beam::shape(offset, length),
            local_compliance: beam::clamped_deflection(offset, offset, bending_stiffness, length),
        }
    }

    /// Deflection at one point under a unit force at another of the same element, beyond that of the cubic, m/N.
    #[inline]
    pub(super) fn local_deflection(&self, at: &RailPoint, load: &RailPoint) -> f64 {
        let RailElement { length, bending_stiffness } = self.elements[at.element];
        beam::clamped_deflection(at.offset, load.offset, bending_stiffness, length)
    }

    /// The four unknowns of the rail element `element`.
    #[inline]
    pub(super) fn element_unknowns(&self, element: usize) -> [usize; 4] {
        let (left, right) = (self.rail[element], self.rail[element + 1]);
        [left, left + 1, right, right + 1]
    }

    /// Deflection of the cubic at a point of the rail, m.
    #[inline]
    pub(super) fn deflection_at(&self, point: &RailPoint, u: &[f64]) -> f64 {
        let unknowns = self.element_unknowns(point.element);
        (0..4).map(|k| point.shape[k] * u[unknowns[k]]).sum()
    }

    /// Adds the nodal forces of `force` (N, down) at a point of the rail.
    #[inline]
    pub(super) fn add_force(&self, point: &RailPoint, force: f64, nodal: &mut [f64]) {
        let unknowns = self.element_unknowns(point.element);
        for k in 0..4 {
            nodal[unknowns[k]] += point.shape[k] * force;
        }
    }

    /// Sagging rail moment at a node, N m: the mean of both elements, without what loads inside them add.
    #[inline]
    pub(super) fn cubic_moment(&self, node: usize, u: &[f64]) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        if node > 0 {
            let RailElement { length: h, bending_stiffness } = self.elements[node - 1];
            let [w0, t0, w1, t1] = self.element_unknowns(node - 1).map(|i| u[i]);
            sum -= bending_stiffness * (6.0 * (w0 - w1) / h + 2.0 * t0 + 4.0 * t1) / h;
            count += 1.0;
        }
        if node < self.elements.len() {
            let RailElement { length: h, bending_stiffness } = self.elements[node];
            let [w0, t0, w1, t1] = self.element_unknowns(node).map(|i| u[i]);
            sum += bending_stiffness * (6.0 * (w0 - w1) / h + 4.0 * t0 + 2.0 * t1) / h;
            count += 1.0;
        }
        sum / count
    }

    /// What a force inside an element adds to the moment at `node`, N m: half the clamping moment, as the mean of both
    /// elements takes half of each; all of it at an end of the rail.
    #[inline]
    pub(super) fn clamping_moment(&self, node: usize, point: &RailPoint, force: f64) -> f64 {
        let h = self.elements[point.element].length;
        let (a, b) = (point.offset, h - point.offset);
        let share = if node == 0 || node == self.elements.len() { 1.0 } else { 0.5 };
        if node == point.element {
            -share * force * a * b * b / (h * h)
        } else if node == point.element + 1 {
            -share * force * a * a * b / (h * h)
        } else {
            0.0
        }
    }

    /// Forces on the nodes that do not change while the track stays at `level`: gravity and the closed supports' levels.
    pub(super) fn steady_forces(&self, level: &TrackLevel) -> Vec<f64> {
        let mut forces = self.weight.clone();
        for sleeper in &self.sleepers {
            forces[sleeper.unknown] += sleeper.support_stiffness * level.settlements[sleeper.seat];
        }
        forces
    }

    pub(super) fn check_level(&self, level: &TrackLevel) -> Result<(), TrackError> {
        if level.settlements.len() != self.model.seats.len() {
            let value = level.settlements.len() as f64;
            return Err(TrackError::Parameter { name: "settlements", value, expected: "one per seat" });
        }
        match level.settlements.iter().chain(&level.ends).find(|s| !s.is_finite()) {
            Some(value) => Err(TrackError::Parameter { name: "level", value: *value, expected: "a finite number" }),
            None => Ok(()),
        }
    }

    /// Chainage of an unknown, m.
    pub(super) fn place_of(&self, unknown: usize) -> f64 {
        let node = self.rail.partition_point(|first| *first <= unknown);
        self.nodes[node.saturating_sub(1)]
    }
}

fn place_nodes(model: &TrackModel) -> Vec<f64> {
    let mut breaks: Vec<f64> = model.ends.to_vec();
    breaks.extend(model.seats.iter().map(|s| s.x));
    breaks.extend(model.rail.iter().map(|s| s.end));
    breaks.extend(model.slabs.iter().flat_map(|s| [s.start, s.end]));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|next, kept| *next - *kept <= SAME_PLACE);
    let bay = usual_bay(model);

    let mut nodes = vec![breaks[0]];
    for pair in breaks.windows(2) {
        let wanted = model.elements_per_bay as f64 * (pair[1] - pair[0]) / bay;
        let count = (wanted - 1e-6).ceil().max(1.0) as usize;
        nodes.extend((1..count).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / count as f64));
        nodes.push(pair[1]);
    }
    nodes
}

/// The median distance of neighbouring seats, m; the length of the track where there are none.
pub(super) fn usual_bay(model: &TrackModel) -> f64 {
    let mut bays: Vec<f64> = model.seats.windows(2).map(|pair| pair[1].x - pair[0].x).collect();
    bays.sort_by(f64::total_cmp);
    bays.get(bays.len() / 2).copied().unwrap_or(model.ends[1] - model.ends[0])
}

fn nearest(nodes: &[f64], x: f64) -> usize {
    let after = nodes.partition_point(|node| *node < x).min(nodes.len() - 1);
    if after > 0 && x - nodes[after - 1] < nodes[after] - x { after - 1 } else { after }
}

fn add_element(matrix: &mut SymmetricBanded, nodes: [usize; 2], element: ElementMatrix) {
    let unknowns = [nodes[0], nodes[0] + 1, nodes[1], nodes[1] + 1];
    for (r, row) in element.iter().enumerate() {
        for c in 0..=r {
            matrix.add(unknowns[r], unknowns[c], row[c]);
        }
    }
}

fn add_load(forces: &mut [f64], nodes: [usize; 2], load: [f64; 4]) {
    for (unknown, value) in [nodes[0], nodes[0] + 1, nodes[1], nodes[1] + 1].into_iter().zip(load) {
        forces[unknown] += value;
    }
}
