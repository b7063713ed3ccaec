//! Responses by name, and expressions of responses for `expect`.

use crate::diag::Span;
use crate::syntax::tree::{BinaryOp, Comparison};
use serde::{Deserialize, Serialize};

/// A response: a quantity that a run computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Response {
    /// Force of the rail on a pad, N, per seat.
    RailSeatLoad,
    /// Force of half a sleeper on its support, N, never negative.
    ContactForce,
    /// Force of half a sleeper on its support without a vehicle, N.
    GravityContactForce,
    /// `contact_force` / bearing area of half a sleeper, Pa.
    ContactPressure,
    /// Vertical pressure on the lowest layer under `contact_force`, Pa, if the layers are known.
    SubgradePressure,
    /// Force of a wheel on the rail, N.
    WheelForce,
    /// Downward displacement of the rail from the unloaded state at the same axle count, m.
    RailDisplacement,
    /// Level of the unloaded rail below the level as built, m.
    RailLevel,
    /// Sagging rail moment, N m.
    RailMoment,
    /// Static stiffness at rail level under a standing wheel, N/m.
    RailStiffness,
    /// Permanent downward displacement of a support, including the settlement at the start, m.
    Settlement,
    /// Gap under a sleeper of the unloaded track, m.
    Void,
    /// Downward displacement of a sleeper from the unloaded state, m.
    SleeperDisplacement,
    /// Velocity of a sleeper, m/s, downward.
    SleeperVelocity,
    /// Acceleration of a sleeper, m/s^2, downward.
    SleeperAcceleration,
    /// Stiffness of support and under sleeper pad in series, N/m per seat.
    SupportStiffness,
    /// Time without contact between sleeper and support during a passage, s.
    ContactLoss,
    /// Mean velocity of the grains in a volume, m/s, downward.
    BallastVelocity,
    /// Mean acceleration of the grains in a volume, m/s^2, downward.
    BallastAcceleration,
    /// Vertical stress in a volume of grains, Pa.
    BallastStress,
    /// Porosity of a volume.
    Porosity,
    /// Mean number of contacts per grain in a volume.
    CoordinationNumber,
    /// Median settlement far from every transition, m.
    FarFieldSettlement,
    /// Largest settlement - far-field settlement, m.
    DifferentialSettlement,
    /// Number of sleepers with a void.
    VoidedSleepers,
    /// Share of broken bonds between glued grains.
    BrokenBonds,
    /// Level of the stiffer side of a transition above the softer side, m; the largest value of all transitions.
    SettlementStep,
    /// Largest change of the unloaded level between two wheels of a bogie, m.
    LevelChangeWheelbase,
    /// Largest change of the unloaded level over 3 m, m.
    LevelChange3m,
}

/// The place of a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    Seat,
    Rail,
    Wheel,
    /// In volumes of grains.
    Volume,
    Scene,
}

/// The reduction of a field of values to one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reduction {
    Max,
    Min,
    Mean,
    /// Root of the mean square.
    Rms,
    /// The value that this share of all values, 0 .. 1, does not exceed; linear between two values.
    Percentile(f64),
    /// Root mean square of the difference between the response and measured values by chainage, m; linear between
    /// places.
    Misfit(Vec<(f64, f64)>),
    /// Chainage of the largest value, m.
    PlaceOfMax,
    /// A response that is a single number.
    Itself,
}

/// `max(contact_force, over = -20 .. -1 sleepers, after = 100 axles)`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    pub reduction: Reduction,
    pub response: Response,
    /// Chainages, m, ends included; `None` for the whole track.
    pub over: Option<(f64, f64)>,
    /// Axle count; `None` for the last.
    pub after: Option<u64>,
}

impl Measure {
    /// The measure over the whole track, after the last count.
    pub fn new(reduction: Reduction, response: Response) -> Measure {
        Measure { reduction, response, over: None, after: None }
    }
}

/// A function of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Function {
    Abs,
    Sqrt,
    Min,
    Max,
}

/// An expression over measures, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Expression {
    Number(f64),
    Measure(Measure),
    Binary(Box<Expression>, BinaryOp, Box<Expression>),
    Negate(Box<Expression>),
    /// A function of one or more values.
    Function(Function, Vec<Expression>),
}

impl Expression {
    /// Whether its value needs a run; otherwise it is known from the text.
    pub fn needs_a_run(&self) -> bool {
        match self {
            Expression::Number(_) => false,
            Expression::Measure(_) => true,
            Expression::Binary(left, _, right) => left.needs_a_run() || right.needs_a_run(),
            Expression::Negate(inner) => inner.needs_a_run(),
            Expression::Function(_, of) => of.iter().any(Expression::needs_a_run),
        }
    }
}

/// A comparison that must hold after the run, with one more operand than operators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Expectation {
    /// The expression as written, for messages.
    pub text: String,
    pub span: Span,
    pub operands: Vec<Expression>,
    pub operators: Vec<Comparison>,
    /// The unit for display, and its size in SI.
    pub unit: (String, f64),
}

impl Response {
    pub const ALL: &'static [Response] = &[
        Response::RailSeatLoad,
        Response::ContactForce,
        Response::GravityContactForce,
        Response::ContactPressure,
        Response::SubgradePressure,
        Response::WheelForce,
        Response::RailDisplacement,
        Response::RailLevel,
        Response::RailMoment,
        Response::RailStiffness,
        Response::Settlement,
        Response::Void,
        Response::SleeperDisplacement,
        Response::SleeperVelocity,
        Response::SleeperAcceleration,
        Response::SupportStiffness,
        Response::ContactLoss,
        Response::BallastVelocity,
        Response::BallastAcceleration,
        Response::BallastStress,
        Response::Porosity,
        Response::CoordinationNumber,
        Response::FarFieldSettlement,
        Response::DifferentialSettlement,
        Response::VoidedSleepers,
        Response::BrokenBonds,
        Response::SettlementStep,
        Response::LevelChangeWheelbase,
        Response::LevelChange3m,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Response::RailSeatLoad => "rail_seat_load",
            Response::ContactForce => "contact_force",
            Response::GravityContactForce => "gravity_contact_force",
            Response::ContactPressure => "contact_pressure",
            Response::SubgradePressure => "subgrade_pressure",
            Response::WheelForce => "wheel_force",
            Response::RailDisplacement => "rail_displacement",
            Response::RailLevel => "rail_level",
            Response::RailMoment => "rail_moment",
            Response::RailStiffness => "rail_stiffness",
            Response::Settlement => "settlement",
            Response::Void => "void",
            Response::SleeperDisplacement => "sleeper_displacement",
            Response::SleeperVelocity => "sleeper_velocity",
            Response::SleeperAcceleration => "sleeper_acceleration",
            Response::SupportStiffness => "support_stiffness",
            Response::ContactLoss => "contact_loss",
            Response::BallastVelocity => "ballast_velocity",
            Response::BallastAcceleration => "ballast_acceleration",
            Response::BallastStress => "ballast_stress",
            Response::Porosity => "porosity",
            Response::CoordinationNumber => "coordination_number",
            Response::FarFieldSettlement => "far_field_settlement",
            Response::DifferentialSettlement => "differential_settlement",
            Response::VoidedSleepers => "voided_sleepers",
            Response::BrokenBonds => "broken_bonds_share",
            Response::SettlementStep => "settlement_step",
            Response::LevelChangeWheelbase => "level_change_wheelbase",
            Response::LevelChange3m => "level_change_3m",
        }
    }

    pub fn of_name(name: &str) -> Option<Response> {
        Response::ALL.iter().copied().find(|r| r.name() == name)
    }

    pub fn place(self) -> Place {
        match self {
            Response::WheelForce => Place::Wheel,
            Response::RailDisplacement | Response::RailLevel | Response::RailMoment | Response::RailStiffness => {
                Place::Rail
            }
            Response::BallastVelocity
            | Response::BallastAcceleration
            | Response::BallastStress
            | Response::Porosity
            | Response::CoordinationNumber => Place::Volume,
            Response::FarFieldSettlement
            | Response::DifferentialSettlement
            | Response::VoidedSleepers
            | Response::BrokenBonds
            | Response::SettlementStep
            | Response::LevelChangeWheelbase
            | Response::LevelChange3m => Place::Scene,
            _ => Place::Seat,
        }
    }

    /// Its meaning, in words that follow its name.
    pub fn doc(self) -> &'static str {
        match self {
            Response::RailSeatLoad => "force of the rail on a rail seat",
            Response::ContactForce => "force between a sleeper and its support during a passage, never negative",
            Response::GravityContactForce => "force between a sleeper and its support without a vehicle",
            Response::ContactPressure => "largest contact force divided by half the bearing area of the sleeper",
            Response::SubgradePressure => "pressure on the lowest layer, if layers are known",
            Response::WheelForce => "force between a wheel and the rail",
            Response::RailDisplacement => {
                "displacement of the rail from its unloaded state at that axle count, downward"
            }
            Response::RailLevel => "level of the unloaded rail, downward from the level as built",
            Response::RailMoment => "bending moment of the rail",
            Response::RailStiffness => "mean wheel load divided by the additional deflection under a standing wheel",
            Response::Settlement => "permanent settlement of the ballast below a sleeper",
            Response::Void => "gap between an unloaded sleeper and its support",
            Response::SleeperDisplacement => "displacement of a sleeper during a passage, downward",
            Response::SleeperVelocity => "velocity of a sleeper during a passage, downward",
            Response::SleeperAcceleration => "acceleration of a sleeper during a passage, downward",
            Response::SupportStiffness => "stiffness of the support and the under sleeper pad in series, of one seat",
            Response::ContactLoss => "time without contact between a sleeper and its support during a passage",
            Response::BallastVelocity => "mean velocity of the grains in a volume, downward",
            Response::BallastAcceleration => "mean acceleration of the grains in a volume, downward",
            Response::BallastStress => "vertical stress in a volume of grains",
            Response::Porosity => "share of voids in a volume of grains",
            Response::CoordinationNumber => "mean number of contacts of a grain in a volume",
            Response::FarFieldSettlement => {
                "median settlement of the sleepers on ballast more than 10 m away from every transition"
            }
            Response::DifferentialSettlement => {
                "largest settlement of a sleeper on ballast minus the far-field settlement"
            }
            Response::VoidedSleepers => "number of sleepers with a void",
            Response::BrokenBonds => "share of broken bonds between glued grains",
            Response::SettlementStep => {
                "mean settlement within 5 m on the softer side of a transition minus the mean on the stiffer side"
            }
            Response::LevelChangeWheelbase => {
                "largest change of the unloaded rail level over the wheelset spacing of the leading vehicle"
            }
            Response::LevelChange3m => "largest change of the unloaded rail level over 3 m",
        }
    }

    /// The SI unit of its values.
    pub fn unit(self) -> &'static str {
        match self {
            Response::RailSeatLoad | Response::ContactForce | Response::GravityContactForce | Response::WheelForce => {
                "N"
            }
            Response::RailMoment => "N m",
            Response::SleeperVelocity | Response::BallastVelocity => "m/s",
            Response::SleeperAcceleration | Response::BallastAcceleration => "m/s^2",
            Response::SupportStiffness | Response::RailStiffness => "N/m",
            Response::ContactPressure | Response::SubgradePressure | Response::BallastStress => "Pa",
            Response::ContactLoss => "s",
            Response::VoidedSleepers | Response::BrokenBonds | Response::Porosity | Response::CoordinationNumber => "1",
            _ => "m",
        }
    }
}
