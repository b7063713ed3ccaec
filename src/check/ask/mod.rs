//! What is asked of a scene: expectations, what studies measure and what they vary.

mod expression;
pub mod reader;
mod reduction;
pub mod study;
mod vary;
mod written;
