//! The track at rest: sections side by side, the transitions between them, and every rail seat.

use super::{Bed, Given, Layer, Origin, Profile};
use crate::diag::Span;
use crate::solvers::foundation;
use crate::solvers::track::{Spring, UnderPad};
use crate::units::number;
use serde::{Deserialize, Serialize};
use std::ops::Range;

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
    /// Rails beside the running rails, left to right, without overlap.
    pub auxiliary_rails: Vec<AuxiliaryRailSpan>,
    /// What was said of parts of it: seats and rails have it already.
    pub stretches: Vec<Stretch>,
    /// Where stretches change the layers of a section, left to right, without overlap.
    pub groundworks: Vec<Groundwork>,
    pub rail_ends: RailEnds,
    /// Level of the rail as built, m, positive down, over the whole track; `None` is level.
    pub irregularity: Option<Profile>,
    /// What holds the layers.
    pub bed: Bed,
}

/// What holds the rail at both ends of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RailEnds {
    Clamped,
    Pinned,
    Free,
    /// Ends that let waves out, as if the track went on.
    Absorbing,
}

/// What differs along a part of the track, for its drawing and for rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stretch {
    pub name: String,
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// The paths that it sets: `usp`, `pad.stiffness`.
    pub changes: String,
    /// Where its `over` stands.
    pub span: Span,
}

/// The layers over a part of a section where they are not those of the section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Groundwork {
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// Under the sleepers, downwards.
    pub layers: Vec<Layer>,
    pub approach_slab: Option<ApproachSlab>,
}

/// A plate in the layers, which it displaces.
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
    /// Chainage of its ends, m; the first is that at the structure.
    pub ends: [f64; 2],
    /// Whether it rests on the structure there.
    pub hinged: bool,
}

/// A part of the track of one trackform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// The name of its trackform.
    pub name: String,
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// Where its length is given.
    pub length_origin: Origin,
    /// `None` in a rig, which loads sleepers.
    pub rail: Option<Rail>,
    /// Sleeper or seat spacing where no stretch says another, m.
    pub spacing: Given,
    pub slab: Option<Slab>,
    /// Under the sleepers, downwards; none where the scene has only their supports.
    pub layers: Vec<Layer>,
    /// Where they are given; where they are not, its trackform.
    pub layers_span: Option<Span>,
    /// Grains between and beside its sleepers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crib: Option<Crib>,
}

/// Grains of the top layer between the sleepers and beyond their ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Crib {
    /// Above the underside of the sleepers, m.
    pub height: Given,
    /// Width beyond the ends of the sleepers, m; `None` fills no more than the space between them.
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

impl Side {
    /// The side of a word of the language.
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

/// A stiffness of the ground or of a structure in words: `40 MN/m per seat`.
pub fn seat_stiffness(stiffness: f64) -> String {
    match stiffness {
        k if k.is_finite() => format!("{} MN/m per seat", number((k / 1e5).round() / 10.0)),
        _ => "no give at all".to_owned(),
    }
}

/// Static stiffness under a point load, N/m, of a long beam of a bending stiffness EI, N m^2, on a Winkler foundation of a modulus k,
/// N/m per metre: `2 k / lambda`, lambda = (k / 4 EI)^(1/4). So stiff is a track at rail level, and a slab under one seat.
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
    /// Shear stiffness kappa G A, N; where Timoshenko's theory is asked for it is given.
    pub shear_stiffness: Option<Given>,
    /// Rotary inertia rho I of the cross-section, kg m.
    pub rotary_inertia: f64,
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

/// Auxiliary rails from one chainage to another, m, with free ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryRailSpan {
    pub start: f64,
    pub end: f64,
    pub rails: AuxiliaryRails,
}

impl AuxiliaryRailSpan {
    /// What is left of it outside of a span.
    pub fn without(self, start: f64, end: f64) -> Vec<AuxiliaryRailSpan> {
        let left = AuxiliaryRailSpan { end: self.end.min(start), ..self.clone() };
        let right = AuxiliaryRailSpan { start: self.start.max(end), ..self };
        [left, right].into_iter().filter(|span| span.end > span.start).collect()
    }
}

/// Auxiliary rails as **one rail** carries them: half of what they are of the whole track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryRails {
    /// How many the whole track has.
    pub count: Given<u32>,
    /// `count / 2` times mass, stiffnesses and rotary inertia of one of them.
    pub rail: Rail,
    /// Under them at each sleeper: `count / 2` times one pad.
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

/// What carries half a sleeper: a spring and a damper without tension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// N/m.
    pub stiffness: Given,
    /// N s/m.
    pub damping: Given,
    /// Softer while the sleeper seats itself.
    pub seating: Option<Seating>,
}

/// The first part of a support's compression: unloaded ballast is far softer than ballast under a wheel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Seating {
    /// N/m, not above that of the support.
    pub stiffness: Given,
    /// Compression up to which it holds, m.
    pub closure: Given,
}

/// The under sleeper pad under half a sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Usp {
    /// Bedding modulus times half the sleeper's base area, N/m.
    pub stiffness: Given,
    /// N s/m.
    pub damping: Given,
    /// m, for the drawing.
    pub thickness: f64,
}

impl Support {
    /// Support and under sleeper pad, where there is one, in series.
    ///
    /// Each is a spring beside a damper: Z = k + i w c. In series 1/Z = 1/Z1 + 1/Z2, and to first order in the frequency w
    ///
    /// ```text
    /// Z = k1 k2 / (k1 + k2) + i w (c1 k2^2 + c2 k1^2) / (k1 + k2)^2
    /// ```
    ///
    /// because a part takes the share k2 / (k1 + k2) or k1 / (k1 + k2) of the compression, and dissipates with its square.
    /// The next term is of the order (w c / k)^2: with damping times below 1 ms it is 4 % at 30 Hz, the passing of axles, and the
    /// stiffness of the two dampers alone takes over far above. The softer first part of a support runs in series too: it ends
    /// at the same force, so the pad's compression under that force is added to its closure.
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

/// A difference of two places without the last digits of their sums.
fn tidy(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}

/// A rail seat: the pad under the rail and what it stands on; in a rig half a sleeper.
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
    /// `None` where there is no rail.
    pub pad: Option<Pad>,
    pub foot: Foot,
    /// The whole sleeper, where there is one whose size is known.
    pub sleeper: Option<SleeperBody>,
    /// Permanent settlement of its support at the start, m; 0 where nothing settles.
    pub initial_settlement: Given,
    /// What lies under it; `None` where layers or their moduli are not known.
    pub stack: Option<Stack>,
}

/// The layers under one seat, as plain numbers of its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stack {
    /// How half of the sleeper lies, and how far its neighbours are.
    pub bearing: foundation::Bearing,
    /// Downwards.
    pub layers: Vec<foundation::Layer>,
    /// An approach slab in these layers, and how far the seat is from its hinge, as share of its length.
    pub plate: Option<(ApproachSlab, f64)>,
    /// The layers with which the stated support of the seat goes, where a stretch has replaced them.
    pub before: Option<Vec<foundation::Layer>>,
    /// Damping over stiffness of a support that these layers make, s.
    pub damping_time: Given,
    /// Where they are given.
    pub span: Span,
}

/// Size of a whole sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SleeperBody {
    /// Across and along the track, and height, m.
    pub length: f64,
    pub base_width: f64,
    pub height: f64,
    /// Area that bears on the ballast, m^2.
    pub base_area: f64,
    /// Between the rails, m.
    pub seat_distance: f64,
}

/// Nearer to its hinge than this share of its length a plate is as stiff as there: the ground must keep a modulus.
const AT_HINGE: f64 = 0.05;

impl ApproachSlab {
    /// How far a load at a chainage (m) is from the hinge, as share of the length: by the lever, what of the load the ground bears.
    pub fn lever(&self, x: f64) -> f64 {
        let [structure, far] = self.ends;
        if self.hinged { ((x - structure) / (far - structure)).abs().clamp(AT_HINGE, 1.0) } else { 1.0 }
    }
}

impl SleeperBody {
    /// How half a sleeper lies, its neighbours so far away on the left and on the right, m: its bearing area under the seat as far as the
    /// sleeper reaches.
    pub fn bearing(&self, spacings: [f64; 2]) -> foundation::Bearing {
        let half = 0.5 * self.length;
        let length = (0.5 * self.base_area / self.base_width).min(half);
        let to_centre = (0.5 * (self.seat_distance - length)).clamp(0.0, half - length);
        foundation::Bearing { width: self.base_width, length, spacings, to_centre: Some(to_centre) }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Foot {
    /// A rigid sleeper, its half mass in kg, on a support that can only push.
    Sleeper {
        mass: Given,
        /// The support as it is stated; `None` where the layers, or only grains, say what it is.
        support: Option<Support>,
        /// In series with the support.
        usp: Option<Usp>,
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

    /// Whether rails lie all along it.
    pub fn has_rails(&self) -> bool {
        self.sections.iter().all(|section| section.rail.is_some())
    }

    /// The rail at a chainage.
    pub fn rail_at(&self, x: f64) -> Option<&Rail> {
        self.sections.iter().find(|s| x <= s.end).or(self.sections.last())?.rail.as_ref()
    }

    /// What lies under a section, from left to right: chainage of both ends, m, layers, and a plate in them.
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

    /// Area on which half a sleeper lies, m^2; `None` for a seat without a sleeper or with one of unknown size.
    pub fn bearing_area(&self, seat: &Seat) -> Option<f64> {
        seat.sleeper.filter(|_| seat.is_ballasted()).map(|sleeper| sleeper.base_area / 2.0)
    }

    /// Indices of the seats of a section, which lie side by side.
    pub fn seats_of(&self, section: usize) -> Range<usize> {
        let first = |section: usize| self.seats.partition_point(|seat| seat.section < section);
        first(section)..first(section + 1)
    }

    /// Distance between two neighbouring seats, m, the shortest of all.
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

    /// Under its sleeper, as it is stated; `None` without a sleeper, or where layers or grains say what it is.
    pub fn support(&self) -> Option<&Support> {
        if let Foot::Sleeper { support, .. } = &self.foot { support.as_ref() } else { None }
    }

    /// Under its sleeper.
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
        // what is left out is of second order in the frequency
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
