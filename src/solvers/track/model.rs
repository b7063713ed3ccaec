//! The track as numbers before it is meshed, and the checks on which a mesh relies. All values are per rail.

use super::error::{Flaw, TrackError, TrackParameter};
use super::irregularity::Irregularity;
use super::support::{Seating, Spring};
use serde::{Deserialize, Serialize};

/// The parts of the track of one rail; SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackModel {
    /// Chainage of the left and right end of the rail, m.
    pub ends: [f64; 2],
    /// Left to right, from end to end without gaps.
    pub rail: Vec<RailSection>,
    /// Left to right, no two at the same place.
    pub seats: Vec<Seat>,
    /// Left to right; two slabs may touch but not overlap.
    pub slabs: Vec<Slab>,
    /// Beside the rail; they may overlap.
    pub auxiliary_rails: Vec<AuxiliaryRail>,
    /// Chainages at which the rail is hinged, m.
    pub joints: Vec<f64>,
    pub rail_ends: RailEnds,
    /// Unevenness of the rail's running surface.
    pub irregularity: Irregularity,
    /// Rail elements between neighbouring seats; more resolve higher frequencies. Statics are exact with one.
    pub elements_per_bay: usize,
    /// m/s^2, 0 or more.
    pub gravity: f64,
}

/// A stretch of rail.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RailSection {
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// kg/m, 0 or more.
    pub mass: f64,
    /// EI, N m^2.
    pub bending_stiffness: f64,
    /// Shear of a Timoshenko beam; none for Euler–Bernoulli.
    pub shear: Option<Shear>,
}

/// Additional properties of a Timoshenko beam, compared with Euler–Bernoulli.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shear {
    /// κGA, N.
    pub stiffness: f64,
    /// ρI, kg m^2 per metre, 0 or more.
    pub rotary_inertia: f64,
}

/// Further rails on the same sleepers or slab, together one beam with free ends, on a separate pad at every seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryRail {
    /// Chainage of its ends, m; the seats between them carry it.
    pub start: f64,
    pub end: f64,
    /// kg/m.
    pub mass: f64,
    /// EI, N m^2.
    pub bending_stiffness: f64,
    /// N/m and N s/m, at each seat.
    pub pad_stiffness: f64,
    pub pad_damping: f64,
}

/// A rail seat: a pad between the rail and its foot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat {
    /// Chainage, m.
    pub x: f64,
    /// N/m, in both directions: the clips hold the rail down.
    pub pad_stiffness: f64,
    /// N s/m.
    pub pad_damping: f64,
    pub foot: Foot,
}

/// The support under a pad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// Half a sleeper (kg) on a support (N/m, N s/m) that pushes and never pulls; with a seating the stiffness is lower
    /// at first.
    Sleeper { mass: f64, support_stiffness: f64, support_damping: f64, seating: Option<Seating> },
    /// Fixed ground.
    Rigid,
    /// The slab under the seat; the right slab if two slabs meet there.
    Slab,
    /// Half a sleeper (kg) carried step by step by external forces, for example of grains under it. At rest its
    /// underside is held at the settlement of its seat.
    Carried { mass: f64, pad: Option<UnderPad>, pitch: Option<Pitch> },
}

/// Rotation of a carried sleeper about its axis across the track: a rigid body held by the rail pad alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pitch {
    /// kg m^2, above 0.
    pub inertia: f64,
    /// Stiffness of the rail pad against rotation, N m/rad, above 0. The ratio of its damping to its stiffness is the
    /// same as for the pad.
    pub stiffness: f64,
}

/// An under sleeper pad: a spring and a damper between a sleeper and its underside, on which the ground pushes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UnderPad {
    /// kg, of what moves with the underside, above 0.
    pub mass: f64,
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
}

impl UnderPad {
    /// The spring under the sleeper if the pad lies on a support: both in series, in the slow limit (k1 k2 / (k1 + k2);
    /// each damper is weighted by the square of its share of the compression).
    pub fn on(&self, support: Spring) -> Spring {
        let (k, c) = (support.stiffness, support.damping);
        let series = |k: f64| k * self.stiffness / (k + self.stiffness);
        let both = (k + self.stiffness) * (k + self.stiffness);
        Spring {
            stiffness: series(k),
            damping: (c * self.stiffness * self.stiffness + self.damping * k * k) / both,
            seating: support.seating.map(|(soft, closure)| (series(soft), closure * (1.0 + soft / self.stiffness))),
        }
    }
}

/// Half a slab: a beam with free ends on a Winkler foundation that acts in both directions. The level as built is the
/// level of the slab at rest. The slab lies there before the rail does, so its own weight causes no further
/// displacement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Slab {
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// EI, N m^2.
    pub bending_stiffness: f64,
    /// kg/m.
    pub mass: f64,
    /// N/m per metre of track.
    pub foundation_stiffness: f64,
    /// N s/m per metre of track.
    pub foundation_damping: f64,
}

/// The support of the rail at both ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RailEnds {
    /// Level given, rotation zero.
    Clamped,
    /// Level given.
    Pinned,
    Free,
    /// The track goes on beyond the end: the static stiffness of the continuation is kept, and waves are damped in a
    /// layer before the end, with a damping that grows towards the end.
    Absorbing,
}

/// Settlement of the track; zeros are the track as built.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackLevel {
    /// Downward displacement of the support under each seat, m; used for sleepers only. Feet carried by external forces
    /// are held at this level at rest, and leave it as they move.
    pub settlements: Vec<f64>,
    /// Level at which rail ends are held unless they are free, m below the level as built. At the level of the rail at
    /// rest, including its deflection under gravity, a clamped end has no bending.
    pub ends: [f64; 2],
}

impl TrackLevel {
    /// The track as built.
    pub fn as_built(model: &TrackModel) -> Self {
        Self { settlements: vec![0.0; model.seats.len()], ends: [0.0; 2] }
    }
}

/// Places closer than this count as one place, m.
pub(super) const SAME_PLACE: f64 = 1e-6;

impl AuxiliaryRail {
    /// Whether the auxiliary rail lies on the seat at x.
    pub(super) fn carries(&self, x: f64) -> bool {
        self.start - SAME_PLACE <= x && x <= self.end + SAME_PLACE
    }
}

fn fail(x: f64, flaw: Flaw) -> Result<(), TrackError> {
    Err(TrackError::Model { x, flaw })
}

/// Written so that a value that is not a number fails; the same holds below.
fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

impl TrackModel {
    /// Refuses a model that cannot be meshed.
    pub(super) fn check(&self) -> Result<(), TrackError> {
        let [start, end] = self.ends;
        if !(start.is_finite() && positive(end - start)) {
            return fail(start, Flaw::Ends);
        }
        if self.elements_per_bay == 0 {
            return Err(TrackError::Parameter {
                name: TrackParameter::ElementsPerBay,
                value: 0.0,
                expected: "of 1 or more",
            });
        }
        if !not_negative(self.gravity) {
            return Err(TrackError::Parameter {
                name: TrackParameter::Gravity,
                value: self.gravity,
                expected: "of 0 or more",
            });
        }
        self.check_rail()?;
        self.check_slabs()?;
        self.check_seats()?;
        self.check_auxiliary_rails()?;
        match self.irregularity.flaw(SAME_PLACE) {
            Some(x) => fail(x, Flaw::Irregularity),
            None => Ok(()),
        }
    }

    fn check_rail(&self) -> Result<(), TrackError> {
        let [start, end] = self.ends;
        let mut reached = start;
        for section in &self.rail {
            if (section.start - reached).abs() > SAME_PLACE || !positive(section.end - section.start) {
                return fail(reached, Flaw::RailGap);
            }
            if !positive(section.bending_stiffness) || !not_negative(section.mass) {
                return fail(section.start, Flaw::Rail);
            }
            if section.shear.is_some_and(|s| !positive(s.stiffness) || !not_negative(s.rotary_inertia)) {
                return fail(section.start, Flaw::RailShear);
            }
            reached = section.end;
        }
        if (reached - end).abs() > SAME_PLACE {
            return fail(reached, Flaw::RailShort);
        }
        match self.joints.iter().find(|x| !(**x > start + SAME_PLACE && **x < end - SAME_PLACE)) {
            Some(x) => fail(*x, Flaw::Joint),
            None => Ok(()),
        }
    }

    fn check_slabs(&self) -> Result<(), TrackError> {
        let [start, end] = self.ends;
        let mut reached = start - SAME_PLACE;
        for slab in &self.slabs {
            if slab.start < reached || !positive(slab.end - slab.start) || slab.end > end + SAME_PLACE {
                return fail(slab.start, Flaw::SlabOverlap);
            }
            if !positive(slab.bending_stiffness)
                || !positive(slab.foundation_stiffness)
                || !not_negative(slab.mass)
                || !not_negative(slab.foundation_damping)
            {
                return fail(slab.start, Flaw::Slab);
            }
            reached = slab.end - SAME_PLACE;
        }
        Ok(())
    }

    fn check_seats(&self) -> Result<(), TrackError> {
        let [start, end] = self.ends;
        let mut reached = f64::NEG_INFINITY;
        for seat in &self.seats {
            if seat.x < start - SAME_PLACE || seat.x > end + SAME_PLACE || seat.x.is_nan() {
                return fail(seat.x, Flaw::SeatOutside);
            }
            if seat.x - reached <= SAME_PLACE {
                return fail(seat.x, Flaw::SeatOrder);
            }
            if !positive(seat.pad_stiffness) || !not_negative(seat.pad_damping) {
                return fail(seat.x, Flaw::Pad);
            }
            match seat.foot {
                Foot::Rigid => {}
                Foot::Sleeper { mass, support_stiffness, support_damping, seating } => {
                    let soft = |s: Seating| positive(s.stiffness) && s.stiffness <= support_stiffness;
                    if seating.is_some_and(|s| !soft(s) || !positive(s.closure)) {
                        return fail(seat.x, Flaw::Seating);
                    }
                    if !positive(mass) || !positive(support_stiffness) || !not_negative(support_damping) {
                        return fail(seat.x, Flaw::Sleeper);
                    }
                }
                Foot::Carried { mass, pad, pitch } => {
                    let sound = |p: UnderPad| positive(p.mass) && positive(p.stiffness) && not_negative(p.damping);
                    if !positive(mass) {
                        return fail(seat.x, Flaw::Carried);
                    }
                    if pad.is_some_and(|p| !sound(p)) {
                        return fail(seat.x, Flaw::UnderPad);
                    }
                    if pitch.is_some_and(|p| !positive(p.inertia) || !positive(p.stiffness)) {
                        return fail(seat.x, Flaw::Pitch);
                    }
                }
                Foot::Slab if self.slab_under(seat.x).is_none() => return fail(seat.x, Flaw::NoSlab),
                Foot::Slab => {}
            }
            reached = seat.x;
        }
        Ok(())
    }

    fn check_auxiliary_rails(&self) -> Result<(), TrackError> {
        let [start, end] = self.ends;
        for rail in &self.auxiliary_rails {
            if !(rail.start >= start - SAME_PLACE && rail.end <= end + SAME_PLACE) {
                return fail(rail.start, Flaw::AuxiliaryRailOutside);
            }
            if self.seats.iter().filter(|seat| rail.carries(seat.x)).count() < 2 {
                return fail(rail.start, Flaw::AuxiliaryRailShort);
            }
            if !positive(rail.bending_stiffness)
                || !positive(rail.pad_stiffness)
                || !not_negative(rail.mass)
                || !not_negative(rail.pad_damping)
            {
                return fail(rail.start, Flaw::AuxiliaryRail);
            }
        }
        Ok(())
    }

    /// Whether a part of the rail has shear.
    pub(super) fn shears(&self) -> bool {
        self.rail.iter().any(|section| section.shear.is_some())
    }

    /// Index of the slab under x; the right slab if two slabs meet there.
    pub(super) fn slab_under(&self, x: f64) -> Option<usize> {
        self.slabs.iter().rposition(|s| s.start - SAME_PLACE <= x && x <= s.end + SAME_PLACE)
    }

    /// The median distance between neighbouring seats, m; the length of the track if it has none.
    pub(super) fn usual_bay(&self) -> f64 {
        let mut bays: Vec<f64> = self.seats.windows(2).map(|pair| pair[1].x - pair[0].x).collect();
        bays.sort_by(f64::total_cmp);
        bays.get(bays.len() / 2).copied().unwrap_or(self.ends[1] - self.ends[0])
    }
}
