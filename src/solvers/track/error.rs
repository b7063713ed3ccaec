//! What can go wrong between a track model and its passages, each with the place and time a caller needs to point at it.

use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub enum TrackError {
    /// The model contradicts itself near `x` (m).
    Model { x: f64, reason: String },
    /// A number of the call is out of its range.
    Parameter { name: &'static str, value: f64, expected: &'static str },
    /// A wheel or a load stands outside the track.
    OffTrack { x: f64, start: f64, end: f64 },
    /// Nothing holds the track near `x` (m), or a vehicle whose leading wheel is there: it moves without resistance.
    Mechanism { x: f64 },
    /// No set of closed supports was found that is in equilibrium; `x` (m) is where it last changed.
    NoEquilibrium { x: f64, iterations: usize },
    /// The contacts of a time step did not settle; `x` (m) is where they last changed, `contact` what is there.
    StepNotConverged { step: usize, time: f64, x: f64, contact: String },
    /// A wheel force (N) is so many times its static value that the answer means nothing; `x` (m) is the seat that bears most.
    RanAway { x: f64, force: f64, times: f64 },
    /// A value has gone beyond sense, or is no number: the step is too long for what happens at `x` (m).
    Unstable { step: usize, time: f64, x: f64, what: &'static str, value: f64, unit: &'static str },
}

impl fmt::Display for TrackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TrackError::Model { x, reason } => write!(f, "{reason} at x = {x} m"),
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
            TrackError::Unstable { step, time, x, what, value, unit } => write!(
                f,
                "the motion is unstable: {what} of {value:.3e} {unit} at x = {x} m in step {step} at {time} s; a shorter \
                 step or more damping of fast motion holds it"
            ),
        }
    }
}

impl std::error::Error for TrackError {}
