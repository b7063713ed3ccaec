//! Histories that a run keeps.

use serde::{Deserialize, Serialize};

/// Histories of some seats at some counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub quantities: Vec<History>,
    /// Indices of seats.
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded; cycles for a rig.
    pub after: Vec<u64>,
    /// Kept only while a wheel is nearer to the seat than this, m; `None` keeps the whole passage.
    pub near: Option<f64>,
}

/// A quantity that varies during a passage. The signs are as in the track solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum History {
    /// Force of a wheel on the rail, N; kept for every wheel of a recorded passage.
    WheelForce,
    /// Force of the rail on a pad, N.
    RailSeatLoad,
    /// Force of half a sleeper on its support, N.
    ContactForce,
    /// Downward displacement of the rail from the unloaded state, m.
    RailDisplacement,
    /// Sagging moment, N m.
    RailMoment,
    /// Downward displacement of a sleeper from the unloaded state, m; its velocity, m/s, and acceleration, m/s^2.
    SleeperDisplacement,
    SleeperVelocity,
    SleeperAcceleration,
}

impl History {
    pub const ALL: [History; 8] = [
        History::WheelForce,
        History::RailSeatLoad,
        History::ContactForce,
        History::RailDisplacement,
        History::RailMoment,
        History::SleeperDisplacement,
        History::SleeperVelocity,
        History::SleeperAcceleration,
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            History::WheelForce => "wheel_force",
            History::RailSeatLoad => "rail_seat_load",
            History::ContactForce => "contact_force",
            History::RailDisplacement => "rail_displacement",
            History::RailMoment => "rail_moment",
            History::SleeperDisplacement => "sleeper_displacement",
            History::SleeperVelocity => "sleeper_velocity",
            History::SleeperAcceleration => "sleeper_acceleration",
        }
    }

    /// The quantity with a name; `None` if no passage keeps it.
    pub fn named(name: &str) -> Option<History> {
        History::ALL.into_iter().find(|history| history.name() == name)
    }
}

/// A quantity of a volume of grains in a passage, or of the sleeper over the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InVolume {
    /// Mean velocity of the grains, m/s, downward.
    BallastVelocity,
    /// Change of this velocity over the interval of the histories, m/s^2, downward.
    BallastAcceleration,
    /// Vertical stress, Pa, positive in compression.
    BallastStress,
    /// Mean number of contacts with neighbours per grain.
    CoordinationNumber,
    /// Velocity and acceleration of the sleeper over the volume, m/s and m/s^2, downward, and its force on the grains,
    /// N.
    SleeperVelocity,
    SleeperAcceleration,
    SleeperForce,
}

impl InVolume {
    const OF_GRAINS: [InVolume; 4] = [
        InVolume::BallastVelocity,
        InVolume::BallastAcceleration,
        InVolume::BallastStress,
        InVolume::CoordinationNumber,
    ];

    /// The name in files. Quantities of the sleeper have other names than the quantities of the plane track.
    pub fn name(self) -> &'static str {
        match self {
            InVolume::BallastVelocity => "ballast_velocity",
            InVolume::BallastAcceleration => "ballast_acceleration",
            InVolume::BallastStress => "ballast_stress",
            InVolume::CoordinationNumber => "coordination_number",
            InVolume::SleeperVelocity => "sleeper_velocity_on_grains",
            InVolume::SleeperAcceleration => "sleeper_acceleration_on_grains",
            InVolume::SleeperForce => "contact_force_on_grains",
        }
    }

    /// The quantity of the grains with a name; `None` if no passage keeps it.
    pub fn named(name: &str) -> Option<InVolume> {
        InVolume::OF_GRAINS.into_iter().find(|quantity| quantity.name() == name)
    }
}
