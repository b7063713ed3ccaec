//! Soil: eight-node hexahedra with small strains, explicit in time; states of rest by a sparse factorisation.
//!
//! ```
//! use trackbed::solvers::continuum::{Material, Mesh, Settings, Side, Soil, Support};
//! let clay = Material { density: 2000.0, youngs_modulus: 50e6, poisson_ratio: 0.3, strength: None };
//! let lines = [0.0, 0.5, 1.0];
//! let mesh = Mesh::grid([&lines, &lines, &lines], vec![clay], |_, _, _| Some(0))?;
//! let mut soil = Soil::new(mesh, Settings { gravity: [0.0, 0.0, -9.81], ..Settings::default() })?;
//! for side in [Side::XMin, Side::XMax, Side::YMin, Side::YMax] {
//!     soil.support(side, Support::Roller)?;
//! }
//! soil.support(Side::Bottom, Support::Fixed)?;
//! soil.rest(&[])?;
//! // a column under its own weight settles by ρ g h² / 2M
//! let top = soil.mesh().nearest([0.5, 0.5, 1.0]);
//! let settles = 2000.0 * 9.81 / (2.0 * clay.constrained_modulus());
//! assert!((soil.displacements()[top][2] / -settles - 1.0).abs() < 1e-9);
//! # Ok::<(), trackbed::solvers::continuum::SoilError>(())
//! ```

mod boundary;
mod brick;
mod checkpoint;
mod chunk;
mod condensed;
mod energy;
mod error;
mod flow;
mod kernel;
mod lanes;
mod limit;
mod look;
mod material;
mod mesh;
mod nodes;
mod rest;
mod shape;
mod shapes;
mod soil;
mod step;
mod stiffness;
mod surface;
mod tensor;
#[cfg(test)]
mod tests;
mod tetra;
mod yields;

pub use boundary::{Side, Support};
pub use checkpoint::State;
pub use condensed::Condensed;
pub use energy::Energy;
pub use error::SoilError;
pub use material::{Material, Strength};
pub use mesh::{Element, Mesh};
pub use rest::Factor;
pub use shape::Formulation;
pub use soil::{Damping, Settings, Soil};
pub use surface::{Facet, Spot, Surface};
