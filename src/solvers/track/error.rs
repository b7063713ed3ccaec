//! Errors of a track model and its passages, each with the place and time that a caller needs to report it.

use super::support::SupportPhase;
use std::fmt;

/// Why a track, or a train over it, has no result.
#[derive(Debug, Clone, PartialEq)]
pub enum TrackError {
    /// The model contradicts itself near `x` (m).
    Model { x: f64, flaw: Flaw },
    /// An argument is out of its range.
    Parameter { name: TrackParameter, value: f64, expected: &'static str },
    /// A wheel or a load stands outside the track.
    OffTrack { x: f64, start: f64, end: f64 },
    /// Nothing holds the track near `x` (m), or the vehicle whose leading wheel is at `x`: it moves without resistance.
    Mechanism { x: f64 },
    /// No set of closed supports in equilibrium was found; `x` (m) is the place of the last change.
    NoEquilibrium { x: f64, iterations: usize },
    /// The contacts of a time step did not converge; `x` (m) is the place of the last change, `contact` the contact
    /// there.
    StepNotConverged { step: usize, time: f64, x: f64, contact: Unsettled },
    /// A wheel force (N) is `times` its static value, so large that the result means nothing; `x` (m) is the seat with
    /// the largest load.
    RanAway { x: f64, force: f64, times: f64 },
    /// A step (s) is longer than the `limit` (s) of an explicit contact at `x` (m).
    StepTooLong { time_step: f64, limit: f64, x: f64, contact: Explicit },
    /// A value is beyond its limit or is not a number: the step is too long for the motion at `x` (m).
    Unstable { step: usize, time: f64, x: f64, what: Wild },
}

/// The part of a model that contradicts itself.
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

/// A parameter of a call, by the part that it belongs to; if a part has several parameters, with the name of the
/// parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrackParameter {
    TimeStep,
    /// A damping parameter of a scheme.
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

/// A contact whose force is computed from the state at the beginning of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Explicit {
    /// The support of an ordinary sleeper.
    Support,
    Wheel,
}

/// The contact that changed last in a step whose contacts do not converge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unsettled {
    /// A wheel: its number from 1, its force, N, and its indentation, m.
    Wheel { number: usize, force: f64, indentation: f64 },
    /// A support: the number of its sleeper from 1, its phase, and its gap, m.
    Support { sleeper: usize, phase: SupportPhase, gap: f64 },
    /// None, on a track without wheels and sleepers.
    Nothing,
}

/// A value beyond its limit.
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
            TrackError::Mechanism { x } => write!(f, "nothing holds the track or the vehicle at x = {x} m"),
            TrackError::NoEquilibrium { x, iterations } => {
                write!(f, "no equilibrium after {iterations} iterations; the contacts near x = {x} m still change")
            }
            TrackError::StepNotConverged { step, time, x, contact } => {
                write!(
                    f,
                    "the contacts near x = {x} m did not converge in step {step} at {time} s; the last to change: {contact}"
                )
            }
            TrackError::RanAway { x, force, times } => {
                write!(f, "the wheel force near x = {x} m is {:.0} kN, {times:.0} times the static force", force / 1e3)
            }
            TrackError::StepTooLong { time_step, limit, x, contact } => write!(
                f,
                "a time step of {:.3} us is too long for {contact} at x = {x} m; the longest stable step is {:.3} us",
                1e6 * time_step,
                1e6 * limit
            ),
            TrackError::Unstable { step, time, x, what } => write!(
                f,
                "the motion is unstable: {what} at x = {x} m in step {step} at {time} s; take a shorter \
                 step or more damping of fast motion"
            ),
        }
    }
}

impl std::error::Error for TrackError {}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Flaw::Ends => "the chainage of the right end of the track is not above the chainage of its left end",
            Flaw::Irregularity => "the irregularity is not a finite number or has a gap",
            Flaw::RailGap => "two rail sections leave a gap or overlap, or a section has no length",
            Flaw::Rail => "the rail has no bending stiffness or a negative mass",
            Flaw::RailShear => "the rail has no shear stiffness or a negative rotary inertia",
            Flaw::RailShort => "the rail sections do not reach the end of the track",
            Flaw::Joint => "a joint lies outside the rail",
            Flaw::SlabOverlap => "a slab overlaps another slab or reaches beyond the end of the track",
            Flaw::Slab => "a slab has no bending stiffness or no foundation stiffness, or a negative mass or damping",
            Flaw::SeatOutside => "a seat lies outside the track",
            Flaw::SeatOrder => "two seats lie at the same chainage or are out of order",
            Flaw::Pad => "a pad has no stiffness or a negative damping",
            Flaw::Seating => "a seating is not softer than its support, or has no stiffness or no closure",
            Flaw::Sleeper => "a sleeper has no mass or no support stiffness, or a negative damping",
            Flaw::Carried => "a sleeper that external forces carry has no mass",
            Flaw::UnderPad => "an under sleeper pad has no mass or no stiffness, or a negative damping",
            Flaw::Pitch => "a sleeper that turns has no rotary inertia, or its rail pad has no rotational stiffness",
            Flaw::Unsupported => {
                "external forces carry a sleeper, but this time integration has no external forces: give it a support"
            }
            Flaw::NoSlab => "no slab lies under the seat",
            Flaw::AuxiliaryRailOutside => "an auxiliary rail reaches beyond the track",
            Flaw::AuxiliaryRailShort => "an auxiliary rail lies on fewer than two seats",
            Flaw::AuxiliaryRail => {
                "an auxiliary rail has no bending stiffness or no pad stiffness, or a negative mass or damping"
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
                write!(f, "wheel {number} (force {force:.0} N, indentation {indentation:.3e} m)")
            }
            Unsettled::Support { sleeper, phase, gap } => {
                write!(f, "the support of sleeper {sleeper} ({}, gap {gap:.3e} m)", phase.word())
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
