//! The positions of the nodes of a track, and the numbering of its unknowns.
//!
//! Nodes lie at every seat, joint, section boundary, end of a slab or auxiliary rail, and rail end. Between two seats
//! there are `elements_per_bay` elements, in shorter stretches proportionally fewer. Unknowns are numbered node by
//! node: rail deflection and rotation (two rotations at a joint), sleeper, its underside, slab, auxiliary rails. So the
//! half band is 5 with sleepers on one side and a slab on the other or with pads under sleepers; it is 7 if two slabs
//! meet or beside one auxiliary rail.

use super::beam::Element;
use super::mesh::{BeamMesh, CarriedSleeper, FootUnknown, RailElement};
use super::model::{Foot, SAME_PLACE, TrackModel};
use super::support::SleeperSupport;

/// The unknowns of every part, in the order of the nodes.
pub(super) struct Numbering {
    pub order: usize,
    pub rail: Vec<usize>,
    pub rail_unknowns: Vec<usize>,
    /// At each node, the rotation of the rail right of it.
    right_rotation: Vec<usize>,
    pub seat_nodes: Vec<usize>,
    pub feet: Vec<FootUnknown>,
    pub sleepers: Vec<SleeperSupport>,
    pub carried: Vec<CarriedSleeper>,
    pub slabs: Vec<BeamMesh>,
    pub auxiliary_rails: Vec<BeamMesh>,
}

impl Numbering {
    pub fn new(model: &TrackModel, nodes: &[f64]) -> Self {
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
            carried: Vec::new(),
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
        let Some(seat) = seat else { return };
        let unknown = self.order;
        match model.seats[seat].foot {
            Foot::Sleeper { support_stiffness, support_damping, seating, .. } => {
                self.feet[seat] = FootUnknown::Sleeper(self.sleepers.len());
                self.sleepers.push(SleeperSupport { seat, unknown, support_stiffness, support_damping, seating });
                self.order += 1;
            }
            Foot::Carried { pad, pitch, .. } => {
                let underside = unknown + usize::from(pad.is_some());
                self.feet[seat] = FootUnknown::Carried(self.carried.len());
                let pitch = pitch.map(|_| underside + 1);
                self.carried.push(CarriedSleeper { seat, unknown, underside, pitch });
                self.order = pitch.unwrap_or(underside) + 1;
            }
            Foot::Rigid | Foot::Slab => {}
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

    /// The largest difference between two unknowns that act on each other.
    pub fn half_band(&self) -> usize {
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
                FootUnknown::Carried(c) => self.carried[*c].pitch.unwrap_or(self.carried[*c].unknown),
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

/// The elements of the rail between the nodes.
pub(super) fn rail_elements(model: &TrackModel, nodes: &[f64], numbering: &Numbering) -> Vec<RailElement> {
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

/// Chainage of the rail nodes, m, left to right.
pub(super) fn place_nodes(model: &TrackModel) -> Vec<f64> {
    let mut breaks: Vec<f64> = model.ends.to_vec();
    breaks.extend(model.seats.iter().map(|s| s.x));
    breaks.extend(model.rail.iter().map(|s| s.end));
    breaks.extend(&model.joints);
    breaks.extend(model.slabs.iter().flat_map(|s| [s.start, s.end]));
    breaks.extend(model.auxiliary_rails.iter().flat_map(|r| [r.start, r.end]));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|next, kept| *next - *kept <= SAME_PLACE);
    let bay = model.usual_bay();

    let mut nodes = vec![breaks[0]];
    for pair in breaks.windows(2) {
        let wanted = model.elements_per_bay as f64 * (pair[1] - pair[0]) / bay;
        let count = (wanted - 1e-6).ceil().max(1.0) as usize;
        nodes.extend((1..count).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / count as f64));
        nodes.push(pair[1]);
    }
    nodes
}

fn nearest(nodes: &[f64], x: f64) -> usize {
    let after = nodes.partition_point(|node| *node < x).min(nodes.len() - 1);
    if after > 0 && x - nodes[after - 1] < nodes[after] - x { after - 1 } else { after }
}
