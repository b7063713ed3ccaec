//! The track at rest: sections, the transitions between them, and every rail seat.

use super::{Bed, Given, Layer, Origin, Profile, SettlementLaw};
use crate::diag::Span;
use crate::solvers::foundation;
use crate::solvers::track::{Spring, UnderPad};
use crate::units::number;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The whole track of the model, for one rail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Track {
    pub name: String,
    /// From left to right, without gaps.
    pub sections: Vec<Section>,
    /// One for each two neighbouring sections.
    pub transitions: Vec<Transition>,
    /// From left to right; every seat belongs to one section.
    pub seats: Vec<Seat>,
    /// Rails beside the running rails, left to right, without overlap.
    pub auxiliary_rails: Vec<AuxiliaryRailSpan>,
    /// The stretches of the track; their values are already in seats and rails.
    pub stretches: Vec<Stretch>,
    /// Parts in which stretches change the layers of a section, from left to right, without overlap.
    pub groundworks: Vec<Groundwork>,
    pub rail_ends: RailEnds,
    /// Level of the rail as built, m, positive downwards, over the whole track; `None` for a level rail.
    pub irregularity: Option<Profile>,
    /// The box of the layers.
    pub bed: Bed,
}

/// Boundary condition of the rail at both ends of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RailEnds {
    Clamped,
    Pinned,
    Free,
    /// Waves leave the model, as if the track continued.
    Absorbing,
}

/// A stretch of the track, for its drawing and for rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stretch {
    pub name: String,
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// The paths that the stretch sets: `usp`, `pad.stiffness`.
    pub changes: String,
    /// Place of its `over` in the text.
    pub span: Span,
}

/// A part of a section with other layers than the section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Groundwork {
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// Layers under the sleepers, from top to bottom.
    pub layers: Vec<Layer>,
    pub approach_slab: Option<ApproachSlab>,
}

/// An approach slab, which replaces the layers at its depth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ApproachSlab {
    /// m.
    pub thickness: Given,
    /// Pa.
    pub youngs_modulus: Given,
    /// kg/m^3.
    pub density: Given,
    /// Depth of its top below the sleepers, m.
    pub depth: Given,
    /// Chainage of its ends, m; the first is at the structure.
    pub ends: [f64; 2],
    /// Whether it rests on the structure.
    pub hinged: bool,
}

/// A part of the track with one trackform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Name of the trackform.
    pub name: String,
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// Origin of its length.
    pub length_origin: Origin,
    /// `None` in a test rig.
    pub rail: Option<Rail>,
    /// Spacing of sleepers or seats outside stretches that change it, m.
    pub spacing: Given,
    pub slab: Option<Slab>,
    /// Layers under the sleepers, from top to bottom; empty if the scene has only supports.
    pub layers: Vec<Layer>,
    /// Place of the layers in the text, or of the trackform if there are none.
    pub layers_span: Option<Span>,
    /// Grains between and beside its sleepers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crib: Option<Crib>,
}

/// Grains of the top layer between the sleepers and beyond their ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Crib {
    /// Height above the underside of the sleepers, m.
    pub height: Given,
    /// Width beyond the ends of the sleepers, m; `None` if only the space between the sleepers is filled.
    pub shoulder: Option<Given>,
}

impl Crib {
    /// Width beyond the ends of the sleepers, m.
    pub fn beyond(&self) -> f64 {
        self.shoulder.map_or(0.0, |shoulder| *shoulder)
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// Name; empty if there is only one transition without a name.
    pub name: String,
    /// Chainage, m.
    pub x: f64,
    pub side: Side,
}

/// The softer side of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    SoftToStiff,
    StiffToSoft,
}

impl Side {
    /// The side from its word in the language.
    pub fn of_word(word: &str) -> Option<Side> {
        [Side::SoftToStiff, Side::StiffToSoft].into_iter().find(|side| side.word() == word)
    }

    /// Its word in the language.
    pub fn word(self) -> &'static str {
        match self {
            Side::SoftToStiff => "soft_to_stiff",
            Side::StiffToSoft => "stiff_to_soft",
        }
    }
}

/// A stiffness of the ground or of a structure as text: `40 MN/m per seat`.
pub fn seat_stiffness(stiffness: f64) -> String {
    match stiffness {
        k if k.is_finite() => format!("{} MN/m per seat", number((k / 1e5).round() / 10.0)),
        _ => "infinite stiffness".to_owned(),
    }
}

/// Static stiffness under a point load, N/m, of a long beam with bending stiffness EI, N m^2, on a Winkler foundation
/// with modulus k, N/m per metre: `2 k / lambda`, lambda = (k / 4 EI)^(1/4). It is used for a track at rail level, and
/// for a slab under one seat.
pub fn point_stiffness(modulus: f64, bending_stiffness: f64) -> f64 {
    2.0 * modulus / (modulus / (4.0 * bending_stiffness)).powf(0.25)
}

/// One rail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rail {
    /// kg/m.
    pub mass: Given,
    /// Vertical bending stiffness EI, N m^2.
    pub bending_stiffness: Given,
    /// Shear stiffness kappa G A, N; always given for `beam = timoshenko`.
    pub shear_stiffness: Option<Given>,
    /// Rotary inertia rho I of the cross-section, kg m.
    pub rotary_inertia: f64,
    /// Height, m, for the drawing and the stress in the foot.
    pub height: f64,
}

/// Young's modulus of rail steel, Pa.
const RAIL_STEEL: f64 = 210e9;

impl Rail {
    /// Section modulus of the foot, m^3: `I / (h / 2)`, with I from the bending stiffness and steel of 210 GPa, and the
    /// neutral axis at half the height. The neutral axis of a real rail lies lower: for 60E1 the formula gives 353
    /// cm^3, tables give 375 cm^3 (unchecked). The stresses are therefore rather too high than too low.
    pub fn foot_modulus(&self) -> f64 {
        *self.bending_stiffness / RAIL_STEEL / (0.5 * self.height)
    }
}

/// Auxiliary rails from one chainage to another, m, with free ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryRailSpan {
    pub start: f64,
    pub end: f64,
    pub rails: AuxiliaryRails,
}

impl AuxiliaryRailSpan {
    /// The parts outside a span.
    pub fn without(self, start: f64, end: f64) -> Vec<AuxiliaryRailSpan> {
        let left = AuxiliaryRailSpan { end: self.end.min(start), ..self.clone() };
        let right = AuxiliaryRailSpan { start: self.start.max(end), ..self };
        [left, right].into_iter().filter(|span| span.end > span.start).collect()
    }
}

/// Auxiliary rails for **one rail**: half of the auxiliary rails of the whole track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryRails {
    /// Number of auxiliary rails of the whole track.
    pub count: Given<u32>,
    /// `count / 2` times mass, stiffnesses and rotary inertia of one auxiliary rail.
    pub rail: Rail,
    /// Pads at each sleeper: `count / 2` times one pad.
    pub pad: Pad,
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

/// The support of half a sleeper: a spring and a damper without tension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// N/m.
    pub stiffness: Given,
    /// N s/m.
    pub damping: Given,
    /// The softer first part of the compression, if there is one.
    pub seating: Option<Seating>,
}

/// The first part of the compression of a support: unloaded ballast is much softer than ballast under a wheel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Seating {
    /// N/m, not above the stiffness of the support.
    pub stiffness: Given,
    /// Compression at which the full stiffness of the support begins, m.
    pub closure: Given,
}

/// The under sleeper pad under half a sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Usp {
    /// Bedding modulus x half the base area of the sleeper, N/m.
    pub stiffness: Given,
    /// N s/m.
    pub damping: Given,
    /// m, for the drawing and for the mass of the pad on grains.
    pub thickness: f64,
}

impl Support {
    /// Support and under sleeper pad in series, if there is a pad.
    ///
    /// Each is a spring beside a damper: Z = k + i w c. In series 1/Z = 1/Z1 + 1/Z2, and to first order in the
    /// frequency w
    ///
    /// ```text
    /// Z = k1 k2 / (k1 + k2) + i w (c1 k2^2 + c2 k1^2) / (k1 + k2)^2
    /// ```
    ///
    /// because the parts have the shares k2 / (k1 + k2) and k1 / (k1 + k2) of the compression, and dissipate with the
    /// square of these shares. The next term is of the order (w c / k)^2: with damping times below 1 ms it is 4 % at 30
    /// Hz, the frequency of passing axles; far above, the two dampers alone determine the stiffness. The softer first
    /// part of a support is also in series with the pad: it ends at the same force, so the compression of the pad under
    /// this force is added to its closure.
    pub fn below(&self, usp: Option<&Usp>) -> Spring {
        let (k, c) = (*self.stiffness, *self.damping);
        let seating = self.seating.map(|s| (*s.stiffness, *s.closure));
        let support = Spring { stiffness: k, damping: c, seating };
        match usp {
            Some(usp) => UnderPad { mass: 0.0, stiffness: *usp.stiffness, damping: *usp.damping }.on(support),
            None => support,
        }
    }
}

/// A difference of two chainages, rounded to remove rounding errors.
fn tidy(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}

/// A rail seat: the rail pad and its foot; in a test rig half a sleeper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seat {
    /// Number counted from the transition `transition`: ..., -2, -1 on its softer side, +1, +2, ... on its stiffer
    /// side.
    pub number: i32,
    /// Index into [`Track::transitions`]; also 0 on a track without a transition, with seats counted from the left end.
    pub transition: usize,
    /// Chainage, m.
    pub x: f64,
    /// Index into [`Track::sections`].
    pub section: usize,
    /// `None` if there is no rail.
    pub pad: Option<Pad>,
    pub foot: Foot,
    /// The whole sleeper, if there is one of known size.
    pub sleeper: Option<SleeperBody>,
    /// Permanent settlement of its support at the start, m; 0 if the support cannot settle.
    pub initial_settlement: Given,
    /// The layers under it; `None` if the layers or their moduli are not known.
    pub stack: Option<Stack>,
}

/// The layers under one seat, as plain numbers at its chainage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stack {
    /// Bearing area of half the sleeper, and the distances of its neighbours.
    pub bearing: foundation::Bearing,
    /// From top to bottom.
    pub layers: Vec<foundation::Layer>,
    /// An approach slab in these layers, and distance of the seat from its hinge / length of the slab.
    pub plate: Option<(ApproachSlab, f64)>,
    /// The layers to which the stated support of the seat refers, if a stretch has replaced them.
    pub before: Option<Vec<foundation::Layer>>,
    /// Damping / stiffness of a support from these layers, s.
    pub damping_time: Given,
    /// Place of the layers in the text.
    pub span: Span,
}

/// Size of a whole sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SleeperBody {
    /// Length across the track, width along the track, and height, m.
    pub length: f64,
    pub base_width: f64,
    pub height: f64,
    /// Area that rests on the ballast, m^2.
    pub base_area: f64,
    /// Distance between the two rail seats, m.
    pub seat_distance: f64,
}

/// Least distance from the hinge / length of a plate: the modulus of the ground below must stay finite.
const AT_HINGE: f64 = 0.05;

impl ApproachSlab {
    /// Distance of a load at a chainage (m) from the hinge / length of the slab: the share of the load that the ground
    /// carries by the lever rule.
    pub fn lever(&self, x: f64) -> f64 {
        let [structure, far] = self.ends;
        if self.hinged { ((x - structure) / (far - structure)).abs().clamp(AT_HINGE, 1.0) } else { 1.0 }
    }
}

impl SleeperBody {
    /// Bearing area of half a sleeper under its seat, limited by the length of the sleeper; the arguments are the
    /// distances of the neighbours on the left and on the right, m.
    pub fn bearing(&self, spacings: [f64; 2]) -> foundation::Bearing {
        let half = 0.5 * self.length;
        let length = (0.5 * self.base_area / self.base_width).min(half);
        let to_centre = (0.5 * (self.seat_distance - length)).clamp(0.0, half - length);
        foundation::Bearing { width: self.base_width, length, spacings, to_centre: Some(to_centre) }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Foot {
    /// A rigid sleeper, with half its mass in kg, on a support in compression only.
    Sleeper {
        mass: Given,
        /// The stated support; `None` if the layers or grains determine it.
        support: Option<Support>,
        /// Under sleeper pad in series with the support.
        usp: Option<Usp>,
        /// The law by which it settles; `None` for the law of `solve`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        law: Option<Box<SettlementLaw>>,
    },
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

    /// Whether all sections have rails.
    pub fn has_rails(&self) -> bool {
        self.sections.iter().all(|section| section.rail.is_some())
    }

    /// The rail at a chainage.
    pub fn rail_at(&self, x: f64) -> Option<&Rail> {
        self.sections.iter().find(|s| x <= s.end).or(self.sections.last())?.rail.as_ref()
    }

    /// The ground under a section, from left to right: chainage of both ends, m, layers, and an approach slab in them.
    pub fn ground(&self, section: usize) -> Vec<Groundwork> {
        let whole = &self.sections[section];
        let own = |start: f64, end: f64| Groundwork { start, end, layers: whole.layers.clone(), approach_slab: None };
        let mut parts = Vec::new();
        let mut from = whole.start;
        for part in self.groundworks.iter().filter(|g| g.start < whole.end && g.end > whole.start) {
            let (start, end) = (part.start.max(whole.start), part.end.min(whole.end));
            parts.extend((start > from).then(|| own(from, start)));
            parts.push(Groundwork { start, end, ..part.clone() });
            from = end;
        }
        parts.extend((from < whole.end).then(|| own(from, whole.end)));
        parts
    }

    /// Bearing area of half a sleeper, m^2; `None` for a seat without a sleeper of known size.
    pub fn bearing_area(&self, seat: &Seat) -> Option<f64> {
        seat.sleeper.filter(|_| seat.is_ballasted()).map(|sleeper| sleeper.base_area / 2.0)
    }

    /// Indices of the seats of a section, which are consecutive.
    pub fn seats_of(&self, section: usize) -> Range<usize> {
        let first = |section: usize| self.seats.partition_point(|seat| seat.section < section);
        first(section)..first(section + 1)
    }

    /// Shortest distance between two neighbouring seats, m.
    pub fn shortest_bay(&self) -> f64 {
        let bays = self.seats.windows(2).map(|pair| tidy(pair[1].x - pair[0].x)).reduce(f64::min);
        bays.unwrap_or_else(|| self.sections.iter().map(|s| *s.spacing).fold(f64::INFINITY, f64::min))
    }

    /// Length of track that a seat carries, m: the mean distance to its neighbours in its section.
    pub fn bay(&self, seat: usize) -> f64 {
        let Some(here) = self.seats.get(seat) else { return 0.0 };
        let beside = |i: Option<usize>| {
            let other = self.seats.get(i?).filter(|other| other.section == here.section)?;
            Some(tidy((other.x - here.x).abs()))
        };
        let bays: Vec<f64> = [seat.checked_sub(1), seat.checked_add(1)].into_iter().filter_map(beside).collect();
        match bays.len() {
            0 => *self.sections[here.section].spacing,
            n => bays.iter().sum::<f64>() / n as f64,
        }
    }

    /// Name of a seat in tables: its number, after the name of its transition if there are several transitions.
    pub fn seat_name(&self, seat: &Seat) -> String {
        match self.transitions.get(seat.transition) {
            Some(t) if self.transitions.len() > 1 => format!("{}:{:+}", t.name, seat.number),
            _ => format!("{:+}", seat.number),
        }
    }
}

impl Seat {
    /// Whether a support that can settle carries the seat.
    pub fn is_ballasted(&self) -> bool {
        matches!(self.foot, Foot::Sleeper { .. })
    }

    /// The stated support under its sleeper; `None` without a sleeper, or if layers or grains determine it.
    pub fn support(&self) -> Option<&Support> {
        if let Foot::Sleeper { support, .. } = &self.foot { support.as_ref() } else { None }
    }

    /// The under sleeper pad of its sleeper.
    /// The law by which the sleeper settles, if it has one of its own.
    pub fn own_law(&self) -> Option<&SettlementLaw> {
        if let Foot::Sleeper { law, .. } = &self.foot { law.as_deref() } else { None }
    }

    pub fn usp(&self) -> Option<&Usp> {
        if let Foot::Sleeper { usp, .. } = &self.foot { usp.as_ref() } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spring(seating: Option<(f64, f64)>, usp: Option<(f64, f64)>) -> Spring {
        let given = Given::<f64>::derived;
        let support = Support {
            stiffness: given(40e6),
            damping: given(4e4),
            seating: seating.map(|(k, closure)| Seating { stiffness: given(k), closure: given(closure) }),
        };
        let usp = usp.map(|(k, c)| Usp { stiffness: given(k), damping: given(c), thickness: 0.01 });
        support.below(usp.as_ref())
    }

    /// Real and imaginary part / w of the exact series at a circular frequency.
    fn exact(k1: f64, c1: f64, k2: f64, c2: f64, w: f64) -> (f64, f64) {
        let (a, b) = ((k1, w * c1), (k2, w * c2));
        let product = (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let sum = (a.0 + b.0, a.1 + b.1);
        let size = sum.0 * sum.0 + sum.1 * sum.1;
        let real = (product.0 * sum.0 + product.1 * sum.1) / size;
        let imaginary = (product.1 * sum.0 - product.0 * sum.1) / size;
        (real, imaginary / w)
    }

    #[test]
    fn a_pad_and_a_support_are_a_series_at_low_frequency() {
        let spring = spring(None, Some((60e6, 1.2e4)));
        assert!((spring.stiffness - 24e6).abs() < 1e-6);
        let error = |hertz: f64| {
            let (k, c) = exact(40e6, 4e4, 60e6, 1.2e4, 2.0 * std::f64::consts::PI * hertz);
            ((spring.stiffness / k - 1.0).abs(), (spring.damping / c - 1.0).abs())
        };
        let (near, far) = (error(1.0), error(10.0));
        assert!(far.0 < 1e-3 && far.1 < 1e-3, "{far:?}");
        // the neglected terms are of second order in the frequency
        assert!((far.0 / near.0 - 100.0).abs() < 1.0 && (far.1 / near.1 - 100.0).abs() < 1.0);
        assert_eq!(self::spring(None, None), Spring { stiffness: 40e6, damping: 4e4, seating: None });
    }

    #[test]
    fn a_seating_support_is_soft_first_with_a_pad_too() {
        let alone = spring(Some((5e6, 4e-4)), None);
        assert_eq!(alone.compression(1e3), 2e-4);
        assert_eq!(alone.compression(2e3), 4e-4);
        assert!((alone.compression(42e3) - 1.4e-3).abs() < 1e-12);
        let padded = spring(Some((5e6, 4e-4)), Some((60e6, 1.2e4)));
        for force in [0.5e3, 2e3, 10e3, 60e3] {
            assert!((padded.compression(force) - alone.compression(force) - force / 60e6).abs() < 1e-12, "{force}");
        }
    }
}
