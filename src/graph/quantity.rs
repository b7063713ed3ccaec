//! Quantities that nodes exchange: each with its unit, its basis and its rate.
//!
//! The quantities of this version stand below; a node of another program may have its own, which are checked in the
//! same way.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// A quantity that one node gives and another takes. Two ports fit if name, unit, basis and rate are equal.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Quantity {
    pub name: Cow<'static, str>,
    /// The letter of the equations: `s`, `R(t)`.
    pub symbol: Cow<'static, str>,
    /// SI, as `N/m`.
    pub unit: Cow<'static, str>,
    pub basis: Basis,
    pub rate: Rate,
}

/// The basis of one value of a quantity. All values are for one rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    Seat,
    Wheel,
    /// Half a sleeper, or a whole sleeper if the bed models both rails.
    Sleeper,
    /// A facet of the surface of the soil.
    Facet,
}

/// How often a quantity is exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rate {
    /// Once between two blocks of axles.
    Block,
    /// At every time step of a coupled substructure.
    Step,
}

impl Quantity {
    /// A quantity by its words.
    pub const fn new(
        name: &'static str,
        symbol: &'static str,
        unit: &'static str,
        basis: Basis,
        rate: Rate,
    ) -> Quantity {
        Quantity { name: Cow::Borrowed(name), symbol: Cow::Borrowed(symbol), unit: Cow::Borrowed(unit), basis, rate }
    }
}

/// Static stiffness of the support of each sleeper, with the stiffness of the first compression if it has a seating.
pub const SUPPORT_STIFFNESS: Quantity =
    Quantity::new("support stiffness and seating", "k", "N/m", Basis::Seat, Rate::Block);
/// Damping of the support of each sleeper.
pub const SUPPORT_DAMPING: Quantity = Quantity::new("support damping", "c", "N s/m", Basis::Seat, Rate::Block);
/// Permanent downward displacement of the support of each sleeper.
pub const SETTLEMENT: Quantity = Quantity::new("settlement", "s", "m", Basis::Seat, Rate::Block);
/// The largest force of each sleeper on its support under each wheel, with the deflection of the support at this force.
pub const SLEEPER_FORCE_PEAKS: Quantity =
    Quantity::new("peaks of sleeper forces", "max R", "N", Basis::Seat, Rate::Block);
/// The force of each sleeper on its support over a passage.
pub const SLEEPER_FORCES: Quantity = Quantity::new("sleeper forces", "R(t)", "N", Basis::Seat, Rate::Block);
/// The force of each wheel on the rail over a passage.
pub const WHEEL_FORCES: Quantity = Quantity::new("wheel forces", "F(t)", "N", Basis::Wheel, Rate::Block);
/// The force of an actuator on its sleeper or plate.
pub const ACTUATOR_FORCE: Quantity = Quantity::new("actuator force", "F", "N", Basis::Sleeper, Rate::Step);
/// The downward speed of a plate under an actuator.
pub const ACTUATOR_VELOCITY: Quantity = Quantity::new("actuator velocity", "v", "m/s", Basis::Sleeper, Rate::Step);
/// The downward displacement of a sleeper on grains.
pub const SLEEPER_DISPLACEMENT: Quantity = Quantity::new("sleeper displacement", "u", "m", Basis::Sleeper, Rate::Step);
/// The force of grains on a sleeper, upwards.
pub const GRAIN_PUSH: Quantity = Quantity::new("push of the grains", "R", "N", Basis::Sleeper, Rate::Step);
/// The velocity of a sleeper on grains, downwards.
pub const SLEEPER_VELOCITY: Quantity = Quantity::new("sleeper velocity", "v", "m/s", Basis::Sleeper, Rate::Step);
/// The force of grains on a facet of the soil under them.
pub const GRAIN_FORCE: Quantity = Quantity::new("forces of grains", "f", "N", Basis::Facet, Rate::Step);
/// The velocity of the facets of the soil under grains.
pub const SOIL_VELOCITY: Quantity = Quantity::new("velocity of the soil", "v", "m/s", Basis::Facet, Rate::Step);

impl Basis {
    /// The word after `per`.
    pub fn name(self) -> &'static str {
        match self {
            Basis::Seat => "seat",
            Basis::Wheel => "wheel",
            Basis::Sleeper => "sleeper",
            Basis::Facet => "facet",
        }
    }
}

impl Rate {
    /// The rate in words.
    pub fn name(self) -> &'static str {
        match self {
            Rate::Block => "once a block",
            Rate::Step => "once a step",
        }
    }
}

/// `settlement s [m per seat, once a block]`
impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Quantity { name, symbol, unit, basis, rate } = self;
        write!(f, "{name} {symbol} [{unit} per {}, {}]", basis.name(), rate.name())
    }
}
