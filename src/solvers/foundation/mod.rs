//! What layers of ballast and soil make of the support of one rail seat: half a sleeper presses on a stack of layers.
//!
//! Two methods answer the same question. The [stress cone](Method::StressCone) is the engineer's: the load spreads at an
//! angle, cones of neighbours share what lies below their meeting. The [layered
//! elastic](Method::LayeredElastic) one solves the equations of elasticity for a rectangle on bonded layers. Neither knows
//! tension, wear or water; both give a stiffness that stays the same under any load.

mod cone;
mod elastic;
mod error;
mod kernel;
mod layers;
mod rectangle;
mod sine;
#[cfg(test)]
mod tests;

pub use error::FoundationError;
pub use layers::{Bearing, Below, Layer, Method, Support};

/// The support that layers, from the sleeper down, give to one seat.
///
/// # Errors
/// A length, modulus or density that is not positive, an angle or Poisson's ratio out of its range, or no layer at all.
pub fn support(bearing: &Bearing, layers: &[Layer], below: Below, method: Method) -> Result<Support, FoundationError> {
    Footing::new(*bearing, method).support(layers, below)
}

/// A bearing that is asked for its support on one stack after the other: what is the same for stacks of about the same
/// thickness is worked out once, which is most of the elastic method. No answer depends on those before.
pub struct Footing {
    bearing: Bearing,
    method: Method,
    waves: Vec<elastic::Waves>,
}

impl Footing {
    pub fn new(bearing: Bearing, method: Method) -> Footing {
        Footing { bearing, method, waves: Vec::new() }
    }

    /// The same as [`support`] gives.
    ///
    /// # Errors
    /// The same as there.
    pub fn support(&mut self, layers: &[Layer], below: Below) -> Result<Support, FoundationError> {
        let Footing { bearing, method, waves } = self;
        error::check(bearing, layers, below, *method)?;
        let cone = cone::support(bearing, layers, below);
        Ok(match *method {
            Method::StressCone => cone,
            Method::LayeredElastic { neighbours } => {
                Support { masses: cone.masses, ..elastic::support(bearing, layers, below, neighbours, waves) }
            }
        })
    }
}
