//! The meshed track: nodes, the numbering of unknowns, and the matrices with all supports closed.
//!
//! Nodes stand at every seat, joint, section boundary, end of a slab or auxiliary rail and rail end, with `elements_per_bay` elements between two seats and
//! proportionally fewer in shorter stretches. Unknowns are numbered node by node - rail deflection and rotation (two
//! rotations at a joint), sleeper, slab, auxiliary rails - so the half band is 5 with sleepers on one side and a slab on the
//! other, 7 where two slabs meet or beside one auxiliary rail.

use super::beam::Element;
use super::ends;
use super::model::SAME_PLACE;
use super::{Foot, RailEnds, Seating, TrackError, TrackLevel, TrackModel};
use crate::linalg::banded::SymmetricBanded;

/// A [`TrackModel`] with its mesh and matrices; immutable and shared by all states and passages.
#[derive(Debug, Clone)]
pub struct Track {
    pub(super) model: TrackModel,
    /// Chainage of the rail nodes, m.
    pub(super) nodes: Vec<f64>,
    /// Unknown of the rail deflection at each node; the rotation is the next one, at a joint that of the rail left of it.
    pub(super) rail: Vec<usize>,
    /// Every unknown of the rail, in order.
    pub(super) rail_unknowns: Vec<usize>,
    /// Between node i and node i + 1.
    pub(super) elements: Vec<RailElement>,
    /// Node of each seat.
    pub(super) seat_nodes: Vec<usize>,
    pub(super) feet: Vec<FootUnknown>,
    pub(super) sleepers: Vec<Sleeper>,
    pub(super) slabs: Vec<BeamMesh>,
    pub(super) auxiliary_rails: Vec<BeamMesh>,
    /// All supports closed, nothing held.
    pub(super) stiffness: SymmetricBanded,
    pub(super) damping: SymmetricBanded,
    pub(super) mass: SymmetricBanded,
    /// Nodal forces of gravity, N and N m.
    pub(super) weight: Vec<f64>,
    /// Gravity on rails and sleepers in all, N.
    pub(super) dead_weight: f64,
    /// Unknowns that are prescribed, and the rail end whose level they take; none for a rotation that is zero.
    pub(super) held: Vec<(usize, Option<usize>)>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct RailElement {
    pub beam: Element,
    pub unknowns: [usize; 4],
    /// Where these stand in [`Track::rail_unknowns`].
    pub columns: [usize; 4],
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
    pub seating: Option<Seating>,
}

/// A beam below or beside the rail, over some of its nodes.
#[derive(Debug, Clone)]
pub(super) struct BeamMesh {
    pub first_node: usize,
    /// Unknown of its deflection at each of its nodes; the slope is the next one.
    pub unknowns: Vec<usize>,
}

impl BeamMesh {
    /// Its elements, each with its unknowns.
    pub fn elements<'a>(
        &'a self,
        nodes: &'a [f64],
        bending_stiffness: f64,
    ) -> impl Iterator<Item = ([usize; 4], Element)> + 'a {
        self.unknowns
            .windows(2)
            .zip(nodes[self.first_node..].windows(2))
            .map(move |(u, x)| ([u[0], u[0] + 1, u[1], u[1] + 1], Element::new(x[1] - x[0], bending_stiffness, None)))
    }
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
        let beam = &self.elements[element].beam;
        let offset = (x - self.nodes[element]).clamp(0.0, beam.length);
        let local_compliance = beam.clamped_deflection(offset, offset);
        RailPoint { element, offset, shape: beam.shape(offset), local_compliance }
    }

    /// Deflection at one point under a unit force at another of the same element, beyond that of the cubic, m/N.
    #[inline]
    pub(super) fn local_deflection(&self, at: &RailPoint, load: &RailPoint) -> f64 {
        self.elements[at.element].beam.clamped_deflection(at.offset, load.offset)
    }

    /// The four unknowns of the rail element `element`.
    #[inline]
    pub(super) fn element_unknowns(&self, element: usize) -> [usize; 4] {
        self.elements[element].unknowns
    }

    /// The unknown of what a seat's pad stands on; none for ground that does not move.
    pub(super) fn foot_unknown(&self, seat: usize) -> Option<usize> {
        match self.feet[seat] {
            FootUnknown::Sleeper(s) => Some(self.sleepers[s].unknown),
            FootUnknown::Slab { unknown } => Some(unknown),
            FootUnknown::Rigid => None,
        }
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
        let moments = |element: &RailElement| element.beam.end_moments(element.unknowns.map(|i| u[i]));
        let left = node.checked_sub(1).map(|element| moments(&self.elements[element])[1]);
        let right = self.elements.get(node).map(|element| moments(element)[0]);
        match (left, right) {
            (Some(left), Some(right)) => 0.5 * (left + right),
            (left, right) => left.or(right).unwrap_or(0.0),
        }
    }

    /// What a force inside an element adds to the moment at `node`, N m: half the clamping moment, as the mean of both
    /// elements takes half of each; all of it at an end of the rail.
    #[inline]
    pub(super) fn clamping_moment(&self, node: usize, point: &RailPoint, force: f64) -> f64 {
        let share = if node == 0 || node == self.elements.len() { 1.0 } else { 0.5 };
        if node == point.element {
            -share * force * point.shape[1]
        } else if node == point.element + 1 {
            share * force * point.shape[3]
        } else {
            0.0
        }
    }

    /// Gravity on the nodes, and what pulls the rail ends to `level` where the track goes on beyond them.
    pub(super) fn own_forces(&self, level: &TrackLevel) -> Vec<f64> {
        let mut forces = self.weight.clone();
        if self.model.rail_ends == RailEnds::Absorbing {
            ends::add_forces(self, level, &mut forces);
        }
        forces
    }

    /// Forces on the nodes that do not change while the track stays at `level`: its own and the closed supports' levels.
    pub(super) fn steady_forces(&self, level: &TrackLevel) -> Vec<f64> {
        let mut forces = self.own_forces(level);
        for sleeper in &self.sleepers {
            forces[sleeper.unknown] +=
                sleeper.support_stiffness * level.settlements[sleeper.seat] + sleeper.seating_loss();
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

/// The unknowns of every part, in the order of the nodes.
struct Numbering {
    order: usize,
    rail: Vec<usize>,
    rail_unknowns: Vec<usize>,
    /// At each node, the rotation of the rail right of it.
    right_rotation: Vec<usize>,
    seat_nodes: Vec<usize>,
    feet: Vec<FootUnknown>,
    sleepers: Vec<Sleeper>,
    slabs: Vec<BeamMesh>,
    auxiliary_rails: Vec<BeamMesh>,
}

impl Numbering {
    fn new(model: &TrackModel, nodes: &[f64]) -> Self {
        let node_at = |x: f64| nearest(nodes, x);
        let seat_nodes: Vec<usize> = model.seats.iter().map(|seat| node_at(seat.x)).collect();
        let joints: Vec<usize> = model.joints.iter().map(|x| node_at(*x)).collect();
        let spans = |ends: &[(f64, f64)]| -> Vec<(usize, usize)> {
            ends.iter().map(|(start, end)| (node_at(*start), node_at(*end))).collect()
        };
        let slab_spans = spans(&model.slabs.iter().map(|s| (s.start, s.end)).collect::<Vec<_>>());
        let auxiliary_spans = spans(&model.auxiliary_rails.iter().map(|r| (r.start, r.end)).collect::<Vec<_>>());
        let empty = |spans: &[(usize, usize)]| -> Vec<BeamMesh> {
            spans.iter().map(|(first, _)| BeamMesh { first_node: *first, unknowns: Vec::new() }).collect()
        };
        let mut this = Self {
            order: 0,
            rail: Vec::with_capacity(nodes.len()),
            rail_unknowns: Vec::with_capacity(2 * nodes.len()),
            right_rotation: Vec::with_capacity(nodes.len()),
            feet: vec![FootUnknown::Rigid; model.seats.len()],
            sleepers: Vec::new(),
            slabs: empty(&slab_spans),
            auxiliary_rails: empty(&auxiliary_spans),
            seat_nodes,
        };
        let mut next_seat = 0;
        for node in 0..nodes.len() {
            this.number_rail(joints.contains(&node));
            let seat = Some(next_seat).filter(|seat| this.seat_nodes.get(*seat) == Some(&node));
            next_seat += usize::from(seat.is_some());
            this.number_sleeper(model, seat);
            for (slab, (first, last)) in slab_spans.iter().enumerate() {
                if (*first..=*last).contains(&node) {
                    this.number_slab(model, slab, seat);
                }
            }
            for (rail, (first, last)) in auxiliary_spans.iter().enumerate() {
                if (*first..=*last).contains(&node) {
                    this.auxiliary_rails[rail].unknowns.push(this.order);
                    this.order += 2;
                }
            }
        }
        this
    }

    fn number_rail(&mut self, joint: bool) {
        let unknowns = if joint { 3 } else { 2 };
        self.rail.push(self.order);
        self.rail_unknowns.extend(self.order..self.order + unknowns);
        self.order += unknowns;
        self.right_rotation.push(self.order - 1);
    }

    fn number_sleeper(&mut self, model: &TrackModel, seat: Option<usize>) {
        if let Some(seat) = seat
            && let Foot::Sleeper { support_stiffness, support_damping, seating, .. } = model.seats[seat].foot
        {
            self.feet[seat] = FootUnknown::Sleeper(self.sleepers.len());
            self.sleepers.push(Sleeper { seat, unknown: self.order, support_stiffness, support_damping, seating });
            self.order += 1;
        }
    }

    fn number_slab(&mut self, model: &TrackModel, slab: usize, seat: Option<usize>) {
        if let Some(seat) = seat
            && model.seats[seat].foot == Foot::Slab
        {
            self.feet[seat] = FootUnknown::Slab { unknown: self.order };
        }
        self.slabs[slab].unknowns.push(self.order);
        self.order += 2;
    }

    /// The largest distance of two unknowns that act on each other.
    fn half_band(&self) -> usize {
        let mut half_band = 3;
        for (node, pair) in self.rail.windows(2).enumerate() {
            half_band = half_band.max(pair[1] + 1 - pair[0]).max(pair[1] + 1 - self.right_rotation[node]);
        }
        for pair in self.slabs.iter().chain(&self.auxiliary_rails).flat_map(|beam| beam.unknowns.windows(2)) {
            half_band = half_band.max(pair[1] + 1 - pair[0]);
        }
        for (node, foot) in self.seat_nodes.iter().zip(&self.feet) {
            let foot = match foot {
                FootUnknown::Sleeper(s) => self.sleepers[*s].unknown,
                FootUnknown::Slab { unknown } => *unknown,
                FootUnknown::Rigid => self.rail[*node],
            };
            half_band = half_band.max(foot - self.rail[*node]);
            for beam in &self.auxiliary_rails {
                let at_node = node.checked_sub(beam.first_node).and_then(|i| beam.unknowns.get(i));
                half_band = half_band.max(at_node.map_or(0, |unknown| unknown - foot));
            }
        }
        half_band
    }
}

fn rail_elements(model: &TrackModel, nodes: &[f64], numbering: &Numbering) -> Vec<RailElement> {
    let column_of = |unknown: usize| numbering.rail_unknowns.partition_point(|u| *u < unknown);
    let mut elements = Vec::with_capacity(nodes.len());
    for (node, pair) in nodes.windows(2).enumerate() {
        let (length, middle) = (pair[1] - pair[0], 0.5 * (pair[0] + pair[1]));
        let Some(section) = model.rail.iter().find(|s| middle <= s.end).or(model.rail.last()) else { continue };
        let [left, right] = [numbering.rail[node], numbering.rail[node + 1]];
        let unknowns = [left, numbering.right_rotation[node], right, right + 1];
        let beam = Element::new(length, section.bending_stiffness, section.shear.map(|s| s.stiffness));
        elements.push(RailElement { beam, unknowns, columns: unknowns.map(column_of) });
    }
    elements
}

fn place_nodes(model: &TrackModel) -> Vec<f64> {
    let mut breaks: Vec<f64> = model.ends.to_vec();
    breaks.extend(model.seats.iter().map(|s| s.x));
    breaks.extend(model.rail.iter().map(|s| s.end));
    breaks.extend(&model.joints);
    breaks.extend(model.slabs.iter().flat_map(|s| [s.start, s.end]));
    breaks.extend(model.auxiliary_rails.iter().flat_map(|r| [r.start, r.end]));
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
