//! The track at rest: sections side by side, the transitions between them, and every rail seat.

use super::{Bed, Given, Layer, Origin, Profile};
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
    /// Bearing area of a whole sleeper, m^2, and distance of its rail seats, m.
    pub sleeper_base_area: Option<f64>,
    pub seat_distance: Option<f64>,
    /// Rails beside the running rails, from one end of the section to the other.
    pub auxiliary_rails: Option<AuxiliaryRails>,
    /// Under the sleepers, downwards; none where the scene has only their supports.
    pub layers: Vec<Layer>,
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

/// Auxiliary rails of a section as **one rail** carries them: half of what they are of the whole track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryRails {
    /// Of the whole track.
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
    /// Under sleeper pad, in series with the support.
    pub usp: Option<Usp>,
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

/// What a sleeper feels under it: plain numbers of one seat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// Stiffness, N/m, of the first compression, and how far that reaches, m.
    pub seating: Option<(f64, f64)>,
}

impl Support {
    /// Support and under sleeper pad in series.
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
    pub fn spring(&self) -> Spring {
        let (k, c) = (*self.stiffness, *self.damping);
        let seating = self.seating.map(|s| (*s.stiffness, *s.closure));
        let Some(usp) = &self.usp else { return Spring { stiffness: k, damping: c, seating } };
        let (pad, pad_damping) = (*usp.stiffness, *usp.damping);
        let series = |k: f64| k * pad / (k + pad);
        Spring {
            stiffness: series(k),
            damping: (c * pad * pad + pad_damping * k * k) / ((k + pad) * (k + pad)),
            seating: seating.map(|(soft, closure)| (series(soft), closure * (1.0 + soft / pad))),
        }
    }
}

impl Spring {
    /// Compression under a force, m.
    pub fn compression(&self, force: f64) -> f64 {
        match self.seating {
            Some((soft, closure)) if force < soft * closure => force / soft,
            Some((soft, closure)) => closure + (force - soft * closure) / self.stiffness,
            None => force / self.stiffness,
        }
    }
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
    /// Permanent settlement of its support at the start, m; 0 where nothing settles.
    pub initial_settlement: f64,
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
        let section = self.sections.get(seat.section)?;
        let [length, base_width, _] = section.sleeper_size?;
        let area = section.sleeper_base_area.unwrap_or(length * base_width);
        seat.is_ballasted().then_some(area / 2.0)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn support(seating: Option<(f64, f64)>, usp: Option<(f64, f64)>) -> Support {
        let given = Given::<f64>::derived;
        Support {
            stiffness: given(40e6),
            damping: given(4e4),
            seating: seating.map(|(k, closure)| Seating { stiffness: given(k), closure: given(closure) }),
            usp: usp.map(|(k, c)| Usp { stiffness: given(k), damping: given(c), thickness: 0.01 }),
        }
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
        let spring = support(None, Some((60e6, 1.2e4))).spring();
        assert!((spring.stiffness - 24e6).abs() < 1e-6);
        let error = |hertz: f64| {
            let (k, c) = exact(40e6, 4e4, 60e6, 1.2e4, 2.0 * std::f64::consts::PI * hertz);
            ((spring.stiffness / k - 1.0).abs(), (spring.damping / c - 1.0).abs())
        };
        let (near, far) = (error(1.0), error(10.0));
        assert!(far.0 < 1e-3 && far.1 < 1e-3, "{far:?}");
        // what is left out is of second order in the frequency
        assert!((far.0 / near.0 - 100.0).abs() < 1.0 && (far.1 / near.1 - 100.0).abs() < 1.0);
        assert_eq!(support(None, None).spring(), Spring { stiffness: 40e6, damping: 4e4, seating: None });
    }

    #[test]
    fn a_seating_support_is_soft_first_with_a_pad_too() {
        let alone = support(Some((5e6, 4e-4)), None).spring();
        assert_eq!(alone.compression(1e3), 2e-4);
        assert_eq!(alone.compression(2e3), 4e-4);
        assert!((alone.compression(42e3) - 1.4e-3).abs() < 1e-12);
        let padded = support(Some((5e6, 4e-4)), Some((60e6, 1.2e4))).spring();
        for force in [0.5e3, 2e3, 10e3, 60e3] {
            assert!((padded.compression(force) - alone.compression(force) - force / 60e6).abs() < 1e-12, "{force}");
        }
    }
}
