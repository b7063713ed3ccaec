//! The track at rest: sections side by side, the transitions between them, and every rail seat.

use super::{Given, Origin};
use serde::{Deserialize, Serialize};

/// The whole track of the model, of one rail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Track {
    pub name: String,
    /// Left to right, without gaps.
    pub sections: Vec<Section>,
    /// One between each two neighbouring sections.
    pub transitions: Vec<Transition>,
    /// Left to right; every seat belongs to one section.
    pub seats: Vec<Seat>,
    pub rail_ends: RailEnds,
}

/// What holds the rail at both ends of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RailEnds {
    Clamped,
    Pinned,
    Free,
}

/// A stretch of track of one trackform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// The name of its trackform.
    pub name: String,
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// Where its length is given.
    pub length_origin: Origin,
    pub rail: Rail,
    /// Sleeper or seat spacing, m.
    pub spacing: Given,
    pub slab: Option<Slab>,
    /// Sleeper dimensions for the drawing: length, base width and height, m.
    pub sleeper_size: Option<[f64; 3]>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// Empty where there is only one and it has no name.
    pub name: String,
    /// Chainage, m.
    pub x: f64,
    pub side: Side,
}

/// Which side of a transition is the softer one, as x grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    SoftToStiff,
    StiffToSoft,
}

/// One rail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rail {
    /// kg/m.
    pub mass: Given,
    /// Vertical bending stiffness EI, N m^2.
    pub bending_stiffness: Given,
    /// m, for the drawing and the stress in the foot.
    pub height: f64,
}

/// Young's modulus of rail steel, Pa.
const RAIL_STEEL: f64 = 210e9;

impl Rail {
    /// Section modulus of the foot, m^3: `I / (h / 2)`, with I of the bending stiffness and steel of 210 GPa and with the
    /// neutral axis at half the height. It lies lower in a real rail: 353 cm^3 of 60E1 are tabulated as 375 (unchecked), so
    /// that stresses come out too high rather than too low.
    pub fn foot_modulus(&self) -> f64 {
        *self.bending_stiffness / RAIL_STEEL / (0.5 * self.height)
    }
}

/// One rail pad.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pad {
    /// N/m.
    pub stiffness: Given,
    /// N s/m.
    pub damping: Given,
}

/// Half a slab: a beam on a Winkler foundation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slab {
    /// N m^2.
    pub bending_stiffness: Given,
    /// kg/m.
    pub mass: Given,
    /// N/m per metre of track.
    pub foundation_stiffness: Given,
    /// N s/m per metre of track.
    pub foundation_damping: Given,
}

/// What carries half a sleeper: a spring and a damper without tension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// N/m.
    pub stiffness: Given,
    /// N s/m.
    pub damping: Given,
}

/// A rail seat: the pad under the rail and what it stands on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seat {
    /// Counted from the transition `transition`: ..., -2, -1 on its softer side, +1, +2, ... on its stiffer side.
    pub number: i32,
    /// Index into [`Track::transitions`]; 0 too on a track without one, where seats count from the left end.
    pub transition: usize,
    /// Chainage, m.
    pub x: f64,
    /// Index into [`Track::sections`].
    pub section: usize,
    pub pad: Pad,
    pub foot: Foot,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Foot {
    /// A rigid sleeper, its half mass in kg, on a support that can only push.
    Sleeper { mass: Given, support: Support },
    /// A seat that does not move.
    Rigid,
    /// A seat on the slab of its section.
    Slab,
}

impl Track {
    /// Chainage of the left end, m.
    pub fn start(&self) -> f64 {
        self.sections.first().map_or(0.0, |s| s.start)
    }

    /// Chainage of the right end, m.
    pub fn end(&self) -> f64 {
        self.sections.last().map_or(0.0, |s| s.end)
    }

    /// The rail at a chainage.
    pub fn rail_at(&self, x: f64) -> Option<&Rail> {
        self.sections.iter().find(|s| x <= s.end).or(self.sections.last()).map(|s| &s.rail)
    }

    /// Area on which half a sleeper lies, m^2; `None` for a seat without a sleeper or with one of unknown size.
    pub fn bearing_area(&self, seat: &Seat) -> Option<f64> {
        let [length, base_width, _] = self.sections.get(seat.section)?.sleeper_size?;
        seat.is_ballasted().then_some(length * base_width / 2.0)
    }

    /// What a table calls a seat: its number, led by the transition's name where there are several.
    pub fn seat_name(&self, seat: &Seat) -> String {
        match self.transitions.get(seat.transition) {
            Some(t) if self.transitions.len() > 1 => format!("{}:{:+}", t.name, seat.number),
            _ => format!("{:+}", seat.number),
        }
    }
}

impl Seat {
    /// Whether a settling support carries it.
    pub fn is_ballasted(&self) -> bool {
        matches!(self.foot, Foot::Sleeper { .. })
    }
}
