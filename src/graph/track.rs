//! The track node as data: rail, pads, sleepers and slabs for one rail. The supports of the sleepers come from another
//! node.

use crate::solvers::track::{
    AuxiliaryRail, Foot, Irregularity, RailEnds, RailSection, Seat, Seating, Slab, Spring, TrackLevel, TrackModel,
};
use serde::{Deserialize, Serialize};

/// The 2D track of one rail. Track and vehicles of the schedule are one coupled system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackNode {
    /// From left to right, without gaps, one for each section.
    pub rail: Vec<RailSection>,
    pub sections: Vec<TrackSection>,
    pub seats: Vec<TrackSeat>,
    pub slabs: Vec<Slab>,
    pub auxiliary_rails: Vec<AuxiliaryRail>,
    pub rail_ends: RailEnds,
    pub irregularity: Irregularity,
    pub elements_per_bay: u32,
    /// m/s^2.
    pub gravity: f64,
    /// The shortest distance between two neighbouring seats, m.
    pub shortest_bay: f64,
}

/// A part of the track with one trackform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackSection {
    /// Name of the trackform.
    pub name: String,
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// Stiffness of the foundation of its slab, N/m per metre; `None` without a slab.
    pub slab_foundation: Option<f64>,
}

/// A rail seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackSeat {
    /// Number of the seat, after the name of its transition if there are several transitions.
    pub name: String,
    /// Chainage, m.
    pub x: f64,
    /// Index into [`TrackNode::sections`].
    pub section: usize,
    /// Length of track that it carries, m.
    pub bay: f64,
    /// Stiffness (N/m) and damping (N s/m) of the pad.
    pub pad_stiffness: f64,
    pub pad_damping: f64,
    pub foot: TrackFoot,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrackFoot {
    /// Half a sleeper, with its mass in kg, on a support in compression only.
    Sleeper { mass: f64 },
    /// A seat that does not move.
    Rigid,
    /// A seat on the slab of its section.
    Slab,
}

/// The springs of the ground at every seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Responses {
    /// Increases with every change of a spring; the track is factored again only then.
    pub revision: u64,
    /// The spring under each seat; `None` without a sleeper.
    pub seats: Vec<Option<Spring>>,
}

impl TrackFoot {
    /// Mass of half the sleeper, kg; 0 without a sleeper.
    pub fn mass(&self) -> f64 {
        if let TrackFoot::Sleeper { mass } = self { *mass } else { 0.0 }
    }
}

impl TrackSeat {
    /// Whether a support that can settle carries the seat.
    pub fn is_ballasted(&self) -> bool {
        matches!(self.foot, TrackFoot::Sleeper { .. })
    }
}

impl TrackNode {
    /// Chainage of both ends of the rail, m.
    pub fn ends(&self) -> [f64; 2] {
        [self.sections.first().map_or(0.0, |s| s.start), self.sections.last().map_or(0.0, |s| s.end)]
    }

    /// The model of the solver on the supports `responses`. A sleeper without a spring has a support of stiffness 0,
    /// which the solver refuses.
    pub fn model(&self, responses: &Responses) -> TrackModel {
        let seats = self.seats.iter().enumerate();
        TrackModel {
            ends: self.ends(),
            rail: self.rail.clone(),
            seats: seats.map(|(i, seat)| seat.model(responses.seats.get(i).copied().flatten())).collect(),
            slabs: self.slabs.clone(),
            auxiliary_rails: self.auxiliary_rails.clone(),
            joints: Vec::new(),
            rail_ends: self.rail_ends,
            irregularity: self.irregularity.clone(),
            elements_per_bay: self.elements_per_bay as usize,
            gravity: self.gravity,
        }
    }

    /// A uniform track of `seats` seats with the rail, pad, foot and slab of one seat, clamped at both ends. `None` if
    /// there is no such seat or no rail over it.
    pub fn everywhere_as_at(&self, index: usize, seats: usize) -> Option<TrackNode> {
        let seat = self.seats.get(index)?;
        let over = |start: f64, end: f64| start - 1e-6 <= seat.x && seat.x <= end + 1e-6;
        let [start, end] = [0.0, seat.bay * seats as f64];
        let rail = RailSection { start, end, ..*self.rail.get(seat.section)? };
        let slab = self.slabs.iter().rfind(|slab| over(slab.start, slab.end) && seat.foot == TrackFoot::Slab);
        let beside = self.auxiliary_rails.iter().filter(|rail| over(rail.start, rail.end));
        let at = |n: usize| TrackSeat { x: (n as f64 + 0.5) * seat.bay, section: 0, ..seat.clone() };
        Some(TrackNode {
            rail: vec![rail],
            sections: vec![TrackSection { start, end, ..self.sections.get(seat.section)?.clone() }],
            seats: (0..seats).map(at).collect(),
            slabs: slab.map(|slab| Slab { start, end, ..*slab }).into_iter().collect(),
            auxiliary_rails: beside.map(|rail| AuxiliaryRail { start, end, ..*rail }).collect(),
            rail_ends: RailEnds::Clamped,
            irregularity: Irregularity::default(),
            ..self.clone()
        })
    }

    /// The part of the track from one seat to another, clamped at both ends. A few decay lengths away from its ends the
    /// statics are equal to the statics of the whole track. `None` if it has no rail.
    pub fn part(&self, first: usize, last: usize) -> Option<TrackNode> {
        let (left, right) = (self.seats.get(first)?, self.seats.get(last)?);
        let [start, end] = [left.x - left.bay / 2.0, right.x + right.bay / 2.0];
        let within = |a: f64, b: f64| [a.max(start), b.min(end)];
        let there = |a: f64, b: f64| b.min(end) - a.max(start) > 1e-6;
        let rail = self.rail.iter().filter(|rail| there(rail.start, rail.end));
        let rail = rail.map(|rail| {
            let [start, end] = within(rail.start, rail.end);
            RailSection { start, end, ..*rail }
        });
        let slabs = self.slabs.iter().filter(|slab| there(slab.start, slab.end));
        let slabs = slabs.map(|slab| {
            let [start, end] = within(slab.start, slab.end);
            Slab { start, end, ..*slab }
        });
        let sections = self.sections.iter().filter(|section| there(section.start, section.end));
        let sections = sections.map(|section| {
            let [start, end] = within(section.start, section.end);
            TrackSection { start, end, ..section.clone() }
        });
        let before = self.sections.iter().position(|section| there(section.start, section.end))?;
        let seats = self.seats[first..=last].iter();
        Some(TrackNode {
            rail: rail.collect(),
            sections: sections.collect(),
            seats: seats
                .map(|seat| TrackSeat { section: seat.section.saturating_sub(before), ..seat.clone() })
                .collect(),
            slabs: slabs.collect(),
            auxiliary_rails: Vec::new(),
            rail_ends: RailEnds::Clamped,
            irregularity: Irregularity::default(),
            elements_per_bay: 1,
            ..self.clone()
        })
    }

    /// The settled track: the settlements of the supports, and the rail ends held at the level of the settled track. A
    /// clamp at the level as built would become a second transition at the end of the model.
    pub fn level(&self, settlement: &[f64], responses: &Responses) -> TrackLevel {
        let end = |seat: usize| settlement.get(seat).map_or(0.0, |settled| settled + self.sag(seat, responses));
        let last = self.seats.len().saturating_sub(1);
        TrackLevel { settlements: settlement.to_vec(), ends: [end(0), end(last)] }
    }

    /// Deflection of the rail under gravity, m, of a long uniform track with the properties of one seat.
    fn sag(&self, index: usize, responses: &Responses) -> f64 {
        let Some(seat) = self.seats.get(index) else { return 0.0 };
        let Some(rail) = self.rail.get(seat.section) else { return 0.0 };
        let per_seat = seat.bay * self.gravity;
        let on_seat = rail.mass * per_seat; // N
        let above = self.auxiliary_rails.iter().find(|span| (span.start..=span.end).contains(&seat.x));
        let beside = above.map_or(0.0, |span| span.mass * per_seat);
        let below = match (seat.foot, self.sections[seat.section].slab_foundation) {
            (TrackFoot::Sleeper { mass }, _) => {
                let spring = responses.seats.get(index).copied().flatten();
                spring.map_or(0.0, |spring| spring.compression(on_seat + beside + mass * self.gravity))
            }
            (TrackFoot::Slab, Some(foundation)) => rail.mass * self.gravity / foundation,
            _ => 0.0,
        };
        on_seat / seat.pad_stiffness + below
    }
}

impl TrackSeat {
    fn model(&self, spring: Option<Spring>) -> Seat {
        let foot = match self.foot {
            TrackFoot::Sleeper { mass } => Foot::Sleeper {
                mass,
                support_stiffness: spring.map_or(0.0, |spring| spring.stiffness),
                support_damping: spring.map_or(0.0, |spring| spring.damping),
                seating: spring
                    .and_then(|spring| spring.seating)
                    .map(|(stiffness, closure)| Seating { stiffness, closure }),
            },
            TrackFoot::Rigid => Foot::Rigid,
            TrackFoot::Slab => Foot::Slab,
        };
        Seat { x: self.x, pad_stiffness: self.pad_stiffness, pad_damping: self.pad_damping, foot }
    }
}
