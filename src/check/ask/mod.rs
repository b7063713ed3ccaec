//! Questions about a scene: expectations, and the values that studies measure and vary.

mod expression;
pub mod reader;
mod reduction;
pub mod study;
mod vary;
mod written;
