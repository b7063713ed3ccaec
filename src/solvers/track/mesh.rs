//! The meshed track: its nodes, unknowns and matrices, and the relation of a place on the rail to them.

use super::beam::Element;
use super::error::{Flaw, TrackError, TrackParameter};
use super::model::{SAME_PLACE, TrackLevel, TrackModel};
use super::support::SleeperSupport;
use crate::linalg::banded::SymmetricBanded;

/// A [`TrackModel`] with its mesh and matrices; immutable and shared by all states and passages.
#[derive(Debug, Clone)]
pub struct Track {
    pub(super) model: TrackModel,
    /// Chainage of the rail nodes, m.
    pub(super) nodes: Vec<f64>,
    /// Unknown of the rail deflection at each node. The rotation is the next unknown; at a joint it is the rotation of
    /// the rail left of it.
    pub(super) rail: Vec<usize>,
    /// Every unknown of the rail, in order.
    pub(super) rail_unknowns: Vec<usize>,
    /// Element between node i and node i + 1.
    pub(super) elements: Vec<RailElement>,
    /// Node of each seat.
    pub(super) seat_nodes: Vec<usize>,
    pub(super) feet: Vec<FootUnknown>,
    pub(super) sleepers: Vec<SleeperSupport>,
    /// Sleepers carried by external forces.
    pub(super) carried: Vec<CarriedSleeper>,
    pub(super) slabs: Vec<BeamMesh>,
    pub(super) auxiliary_rails: Vec<BeamMesh>,
    /// Stiffness with all supports closed and no unknown held.
    pub(super) stiffness: SymmetricBanded,
    pub(super) damping: SymmetricBanded,
    pub(super) mass: SymmetricBanded,
    /// Nodal forces of gravity, N and N m.
    pub(super) weight: Vec<f64>,
    /// Total gravity on rails and sleepers, N.
    pub(super) dead_weight: f64,
    /// Prescribed unknowns, each with the rail end whose level it takes; none for a rotation that is zero.
    pub(super) held: Vec<(usize, Option<usize>)>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct RailElement {
    pub beam: Element,
    pub unknowns: [usize; 4],
    /// Positions of these unknowns in [`Track::rail_unknowns`].
    pub columns: [usize; 4],
}

/// The unknown that moves the foot of a seat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FootUnknown {
    /// Index into [`Track::sleepers`].
    Sleeper(usize),
    Slab {
        unknown: usize,
    },
    Rigid,
    /// Index into [`Track::carried`].
    Carried(usize),
}

/// A sleeper carried by external forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CarriedSleeper {
    pub seat: usize,
    /// Unknown of the sleeper, and unknown of its underside; both are the same if there is no pad under the sleeper.
    pub unknown: usize,
    pub underside: usize,
    /// Its rotation, as the slope of the rail: down with x. None if the sleeper stays level.
    pub pitch: Option<usize>,
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
    /// Deflection at the point per unit force there, minus the deflection of the cubic, m/N.
    pub local_compliance: f64,
}

impl Track {
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

    /// The place x (m) on the rail; fails if x is outside the track.
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

    /// Deflection at one point under a unit force at another point of the same element, minus the deflection of the
    /// cubic, m/N.
    #[inline]
    pub(super) fn local_deflection(&self, at: &RailPoint, load: &RailPoint) -> f64 {
        self.elements[at.element].beam.clamped_deflection(at.offset, load.offset)
    }

    /// The four unknowns of the rail element `element`.
    #[inline]
    pub(super) fn element_unknowns(&self, element: usize) -> [usize; 4] {
        self.elements[element].unknowns
    }

    /// The unknown under the pad of a seat; none for fixed ground.
    pub(super) fn foot_unknown(&self, seat: usize) -> Option<usize> {
        match self.feet[seat] {
            FootUnknown::Sleeper(s) => Some(self.sleepers[s].unknown),
            FootUnknown::Slab { unknown } => Some(unknown),
            FootUnknown::Rigid => None,
            FootUnknown::Carried(c) => Some(self.carried[c].unknown),
        }
    }

    /// The level of a prescribed unknown, m: the level of its rail end, or 0 for a rotation.
    pub(super) fn held_at<'a>(&'a self, level: &'a TrackLevel) -> impl Iterator<Item = (usize, f64)> + 'a {
        self.held.iter().map(|(unknown, end)| (*unknown, end.map_or(0.0, |end| level.ends[end])))
    }

    /// Unknowns that are prescribed at rest, with their levels, m: the unknowns that are always prescribed, and the
    /// undersides of carried sleepers, which lie level.
    pub(super) fn held_at_rest<'a>(&'a self, level: &'a TrackLevel) -> impl Iterator<Item = (usize, f64)> + 'a {
        let undersides = self.carried.iter().map(|c| (c.underside, level.settlements[c.seat]));
        let pitches = self.carried.iter().filter_map(|c| c.pitch).map(|pitch| (pitch, 0.0));
        self.held_at(level).chain(undersides).chain(pitches)
    }

    /// Fails if a sleeper has no support of its own.
    pub(super) fn check_supported(&self) -> Result<(), TrackError> {
        match self.carried.first() {
            Some(c) => Err(TrackError::Model { x: self.model.seats[c.seat].x, flaw: Flaw::Unsupported }),
            None => Ok(()),
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

    /// Sagging rail moment at a node, N m: the mean of both elements, without the moments of loads inside the elements.
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

    /// Moment at `node` by a force inside an element, N m: half the clamping moment, because the mean of both elements
    /// takes half of each; the full clamping moment at an end of the rail.
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

    pub(super) fn check_level(&self, level: &TrackLevel) -> Result<(), TrackError> {
        if level.settlements.len() != self.model.seats.len() {
            let value = level.settlements.len() as f64;
            return Err(TrackError::Parameter {
                name: TrackParameter::Level("settlements"),
                value,
                expected: "one per seat",
            });
        }
        match level.settlements.iter().chain(&level.ends).find(|s| !s.is_finite()) {
            Some(value) => Err(TrackError::Parameter {
                name: TrackParameter::Level("level"),
                value: *value,
                expected: "a finite number",
            }),
            None => Ok(()),
        }
    }

    /// Chainage of an unknown, m.
    pub(super) fn place_of(&self, unknown: usize) -> f64 {
        let node = self.rail.partition_point(|first| *first <= unknown);
        self.nodes[node.saturating_sub(1)]
    }
}
