//! Grains before packing: their sizes, their shapes, and clumps of pebbles that replace the shapes.
//!
//! [`Curve::sample`] gives the sizes of the grains of a solid volume, [`ClumpShape::templates`] the clumps of which
//! they are copies, and [`grains`] combines both. A clump in a bed is a template scaled by the size of the grain.
//!
//! ```
//! use trackbed::solvers::granular::grains::*;
//!
//! let curve = Curve::new(&[[0.032, 0.0], [0.05, 0.6], [0.08, 1.0]])?;
//! let sample = curve.sample(0.02, 1)?;
//! let templates = ClumpShape::default().templates(1)?;
//! let grains = grains(&sample, templates.len(), 1);
//!
//! let clump = templates[grains[0].template].scaled(grains[0].size);
//! assert!((clump.equivalent_diameter() / grains[0].size - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod angular;
mod bubble;
mod form;
mod grading;
mod likeness;
mod points;
mod polyhedron;
mod random;
pub mod stl;
mod templates;

pub use angular::{Angular, AngularError};
pub use bubble::{Bubbles, Rule};
pub use form::GrainForm;
pub use grading::{Class, Curve, GradingError, Sample};
pub use likeness::Misfit;
pub use templates::{ClumpShape, Fitted, Grain, Surfaces, TemplatesError, grains};

pub(super) use random::Random;

#[cfg(test)]
mod tests;
