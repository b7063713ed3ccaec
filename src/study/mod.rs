//! Studies of a scene: what becomes of it when values vary; what its numerics cost, how exact they are, and where they fail.
//!
//! [`design`](mod@design) chooses the points of a study that a file declares, [`plan`](fn@plan) checks and costs them all,
//! [`perform`](fn@perform) runs one, and [`Answer`] says what came out and which design is best.
//!
//! [`chart`] runs one passage over the settled track with many numerics and sets error against time; [`stability`] tries
//! numerics, contacts and voids that no scene should have, and a list of hard scenes, and says of each how it ends.
//! [`grains`] measures what steps of a bed of grains cost.

mod answer;
pub mod chart;
mod clock;
pub mod design;
pub mod grains;
mod perform;
mod plan;
mod settled;
pub mod stability;
mod stress;
mod tables;
pub mod turns;
mod variant;

pub use answer::{Answer, Row};
pub use chart::{Chart, Level, Outcome, Point, Request, Sweep};
pub use perform::{PointOutcome, PointResult, Repeat, perform};
pub use plan::{Plan, PlannedPoint, Scene, plan, values};
pub use settled::{NotSettled, Settled, settled};
pub use stability::{Cell, Map, Stability, Verdict, Void};
pub use stress::Stress;
pub use tables::{chart_csv, stability_csv};
pub use variant::{Case, Errors, Failure, METHODS, Measured, Prepared, Variant};
