//! Histories that a run keeps.

use serde::{Deserialize, Serialize};

/// Histories of some seats at some counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub quantities: Vec<History>,
    /// Indices of seats.
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded; of a rig cycles.
    pub after: Vec<u64>,
    /// Kept only while a wheel is nearer to the seat than this, m; `None` keeps the whole passage.
    pub near: Option<f64>,
}

/// A quantity that varies during a passage. Signs are those of the track solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum History {
    /// Force of a wheel on the rail, N; kept of every wheel of a recorded passage.
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
    const ALL: [History; 8] = [
        History::WheelForce,
        History::RailSeatLoad,
        History::ContactForce,
        History::RailDisplacement,
        History::RailMoment,
        History::SleeperDisplacement,
        History::SleeperVelocity,
        History::SleeperAcceleration,
    ];

    /// Its name in files.
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

    /// The quantity of a name; `None` of one that no passage keeps.
    pub fn named(name: &str) -> Option<History> {
        History::ALL.into_iter().find(|history| history.name() == name)
    }
}
