//! What can go wrong between a track model and its passages, each with the place and time a caller needs to point at it.

use super::support::SupportPhase;
use std::fmt;

/// Why a track, or a train over it, has no answer.
#[derive(Debug, Clone, PartialEq)]
pub enum TrackError {
    /// The model contradicts itself near `x` (m).
    Model { x: f64, flaw: Flaw },
    /// A number of the call is out of its range.
    Parameter { name: TrackParameter, value: f64, expected: &'static str },
    /// A wheel or a load stands outside the track.
    OffTrack { x: f64, start: f64, end: f64 },
    /// Nothing holds the track near `x` (m), or a vehicle whose leading wheel is there: it moves without resistance.
    Mechanism { x: f64 },
    /// No set of closed supports was found that is in equilibrium; `x` (m) is where it last changed.
    NoEquilibrium { x: f64, iterations: usize },
    /// The contacts of a time step did not settle; `x` (m) is where they last changed, `contact` what is there.
    StepNotConverged { step: usize, time: f64, x: f64, contact: Unsettled },
    /// A wheel force (N) is so many times its static value that the answer means nothing; `x` (m) is the seat that bears most.
    RanAway { x: f64, force: f64, times: f64 },
    /// A step (s) is longer than a contact bears whose force acts from one step to the next: at `x` (m) by `limit` (s).
    StepTooLong { time_step: f64, limit: f64, x: f64, contact: Explicit },
    /// A value has gone beyond sense, or is no number: the step is too long for what happens at `x` (m).
    Unstable { step: usize, time: f64, x: f64, what: Wild },
}

/// What contradicts itself in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    Ends,
    Irregularity,
    RailGap,
    Rail,
    RailShear,
    RailShort,
    Joint,
    SlabOverlap,
    Slab,
    SeatOutside,
    SeatOrder,
    Pad,
    Seating,
    Sleeper,
    Carried,
    UnderPad,
    Pitch,
    Unsupported,
    NoSlab,
    AuxiliaryRailOutside,
    AuxiliaryRailShort,
    AuxiliaryRail,
}

/// A number of a call, by the part that it belongs to; where a part has several, with the words for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrackParameter {
    TimeStep,
    /// A share by which a scheme damps.
    Damping(&'static str),
    /// The tolerance of a step.
    Tolerance,
    Gravity,
    ElementsPerBay,
    Irregularity(&'static str),
    Level(&'static str),
    /// A load on the track at rest.
    Load(&'static str),
    Speed,
    SpeedProfile(&'static str),
    /// From the start of a passage to its finish.
    Distance,
    Train(&'static str),
    Vehicle(&'static str),
    Wheel(&'static str),
}

/// A contact whose force is computed from what is known at the beginning of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Explicit {
    /// The support of an ordinary sleeper.
    Support,
    Wheel,
}

/// The contact that was last moved in a step whose contacts do not settle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unsettled {
    /// A wheel by its number from 1 with its force, N, and indentation, m.
    Wheel { number: usize, force: f64, indentation: f64 },
    /// A support by the number of its sleeper from 1 with its gap, m.
    Support { sleeper: usize, phase: SupportPhase, gap: f64 },
    /// None, on a track without wheels and sleepers.
    Nothing,
}

/// A value that has gone beyond sense.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wild {
    /// Force of a wheel, N.
    WheelForce(f64),
    /// Displacement of the track, m; a rotation, rad.
    Displacement(f64),
}

impl fmt::Display for TrackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TrackError::Model { x, flaw } => write!(f, "{flaw} at x = {x} m"),
            TrackError::Parameter { name, value, expected } => write!(f, "expected {name} {expected}, found {value}"),
            TrackError::OffTrack { x, start, end } => {
                write!(f, "x = {x} m lies outside the track, which reaches from {start} m to {end} m")
            }
            TrackError::Mechanism { x } => write!(f, "nothing holds the track or vehicle at x = {x} m"),
            TrackError::NoEquilibrium { x, iterations } => {
                write!(f, "no equilibrium after {iterations} iterations, the supports near x = {x} m keep changing")
            }
            TrackError::StepNotConverged { step, time, x, contact } => {
                write!(f, "contacts near x = {x} m did not settle in step {step} at {time} s, last {contact}")
            }
            TrackError::RanAway { x, force, times } => {
                write!(f, "a wheel force of {:.0} kN near x = {x} m, {times:.0} times the static one", force / 1e3)
            }
            TrackError::StepTooLong { time_step, limit, x, contact } => write!(
                f,
                "a time step of {:.3} us is too long for {contact} at x = {x} m, which allows {:.3} us",
                1e6 * time_step,
                1e6 * limit
            ),
            TrackError::Unstable { step, time, x, what } => write!(
                f,
                "the motion is unstable: {what} at x = {x} m in step {step} at {time} s; a shorter \
                 step or more damping of fast motion holds it"
            ),
        }
    }
}

impl std::error::Error for TrackError {}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Flaw::Ends => "the right end of the track is not right of its left end",
            Flaw::Irregularity => "the irregularity is not a number or has a gap",
            Flaw::RailGap => "the rail sections do not follow each other",
            Flaw::Rail => "the rail has no bending stiffness or a negative mass",
            Flaw::RailShear => "the rail has no shear stiffness or a negative rotary inertia",
            Flaw::RailShort => "the rail sections do not reach the end of the track",
            Flaw::Joint => "a joint does not lie between the ends of the rail",
            Flaw::SlabOverlap => "a slab overlaps another one or the end of the track",
            Flaw::Slab => "a slab lacks bending or foundation stiffness, or has a negative mass or damping",
            Flaw::SeatOutside => "a seat lies outside the track",
            Flaw::SeatOrder => "two seats share a place or are out of order",
            Flaw::Pad => "a pad has no stiffness or a negative damping",
            Flaw::Seating => "a seating is not softer than its support, or lacks stiffness or closure",
            Flaw::Sleeper => "a sleeper lacks mass or support stiffness, or has a negative damping",
            Flaw::Carried => "a sleeper carried from outside has no mass",
            Flaw::UnderPad => "an under sleeper pad lacks mass or stiffness, or has a negative damping",
            Flaw::Pitch => "a sleeper that turns lacks inertia, or its rail pad stiffness against turning",
            Flaw::Unsupported => {
                "a sleeper is carried by forces from outside, which this time step does not have: give it a support"
            }
            Flaw::NoSlab => "no slab under the seat",
            Flaw::AuxiliaryRailOutside => "an auxiliary rail reaches beyond the track",
            Flaw::AuxiliaryRailShort => "an auxiliary rail lies on fewer than two seats",
            Flaw::AuxiliaryRail => {
                "an auxiliary rail lacks bending or pad stiffness, or has a negative mass or damping"
            }
        })
    }
}

impl fmt::Display for TrackParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            TrackParameter::TimeStep => "time step",
            TrackParameter::Tolerance => "tolerance of a step",
            TrackParameter::Gravity => "gravity",
            TrackParameter::ElementsPerBay => "elements per bay",
            TrackParameter::Speed => "speed",
            TrackParameter::Distance => "distance",
            TrackParameter::Damping(words)
            | TrackParameter::Irregularity(words)
            | TrackParameter::Level(words)
            | TrackParameter::Load(words)
            | TrackParameter::SpeedProfile(words)
            | TrackParameter::Train(words)
            | TrackParameter::Vehicle(words)
            | TrackParameter::Wheel(words) => words,
        })
    }
}

impl fmt::Display for Explicit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Explicit::Support => "the support of the sleeper",
            Explicit::Wheel => "a wheel on the rail",
        })
    }
}

impl fmt::Display for Unsettled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unsettled::Wheel { number, force, indentation } => {
                write!(f, "wheel {number} with {force:.0} N at an indentation of {indentation:.3e} m")
            }
            Unsettled::Support { sleeper, phase, gap } => {
                write!(f, "the support of sleeper {sleeper}, {} at a gap of {gap:.3e} m", phase.word())
            }
            Unsettled::Nothing => write!(f, "no support"),
        }
    }
}

impl fmt::Display for Wild {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Wild::WheelForce(force) => write!(f, "a wheel force of {force:.3e} N"),
            Wild::Displacement(displacement) => write!(f, "a displacement of {displacement:.3e} m"),
        }
    }
}
