//! Beds by their recipe.
pub use crate::results::{Beds, BedsError, FoundBed};
