//! Studies of a scene: what becomes of it when values vary.
//!
//! [`design`](mod@design) chooses the points of a study that a file declares, [`plan`](fn@plan) checks and costs them all,
//! [`perform`](fn@perform) runs one, and [`Answer`] says what came out and which design is best;
//! [`StudyFolder`] is its directory.

mod answer;
pub mod design;
mod folder;
mod perform;
mod plan;
pub mod turns;

pub use answer::{Answer, Row};
pub use folder::StudyFolder;
pub use perform::{PointOutcome, PointResult, Repeat, perform};
pub use plan::{Plan, PlannedPoint, Scene, plan, values};
