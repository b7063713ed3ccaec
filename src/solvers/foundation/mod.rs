//! The support of one rail seat from layers of ballast and soil: half a sleeper presses on a stack of layers.
//!
//! There are two methods. The [stress cone](Method::StressCone) is an engineering method: the load spreads at an angle,
//! and cones of neighbours share the ground below their intersection. The [layered elastic](Method::LayeredElastic)
//! method solves the equations of elasticity for a rectangle on bonded layers. Neither method includes loss of contact
//! in tension, wear or water; both give a stiffness that is independent of the load.

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

/// The support of one seat by layers, given from the sleeper down.
///
/// # Errors
/// A length, modulus or density that is not positive, an angle or Poisson's ratio out of its range, or no layer.
pub fn support(bearing: &Bearing, layers: &[Layer], below: Below, method: Method) -> Result<Support, FoundationError> {
    Footing::new(*bearing, method).support(layers, below)
}

/// A bearing area for which the supports on several stacks are computed. Data that are equal for stacks of about the
/// same thickness are computed once; they are most of the work of the elastic method. No result depends on earlier
/// results.
pub struct Footing {
    bearing: Bearing,
    method: Method,
    waves: Vec<elastic::Waves>,
}

impl Footing {
    pub fn new(bearing: Bearing, method: Method) -> Footing {
        Footing { bearing, method, waves: Vec::new() }
    }

    /// The same result as [`support`].
    ///
    /// # Errors
    /// The same errors as [`support`].
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
