//! A settlement law fitted to the grains of a scene: specimens of its cells under trains of several loads and voids.
//!
//! A specimen is one cell of tier `cells`. Trains of the scene pass it, with their forces multiplied by a factor or
//! with a void under the sleeper ([`Ranges`]). The law [`Power`](crate::solvers::settlement::Power) is fitted to the
//! settlement of all specimens; each specimen left out in turn, the later trains, and a specimen whose loads change
//! tell its error ([`Surrogate`]).

mod bench;
mod program;
mod surrogate;

pub use bench::{Bench, Curve, kinds_of_cells};
pub use program::{Ranges, Trial};
pub use surrogate::{LeftOut, Surrogate, by_law, fit_curves};
