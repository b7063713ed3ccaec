//! Trials of numerics: one scene computed with many settings.
//!
//! [`chart`] runs one passage over the settled track with many numerics and sets error against time; [`stability`]
//! tries extreme numerics, contacts and voids, and a list of hard scenes, and reports the result of each.
//! [`exchange_map`] tries lengths of blocks, [`grain_map`] steps and speeds of the grains of the scene. [`grains`]
//! measures the cost of steps of a bed of grains. [`runs`] compares whole runs of a scene by every tier. [`specimens`]
//! fits a settlement law to the grains of a scene.

pub mod chart;
mod clock;
mod exchange;
mod grain_map;
pub mod grains;
mod planned;
pub mod runs;
mod settled;
pub mod specimens;
pub mod stability;
mod stress;
mod tables;
mod variant;
mod verdict;
mod void;

pub use chart::{Chart, Level, Outcome, Point, Request, Sweep};
pub use exchange::{ExchangeMap, exchange_map, most_cells};
pub use grain_map::{GrainMap, MATTERS, SpeedTrial, StepTrial, grain_map, grain_trials};
pub use planned::Planned;
pub use settled::{NotSettled, Settled, settled};
pub use stability::{Cell, Map, Stability};
pub use stress::Stress;
pub use tables::{chart_csv, exchange_csv, grain_speeds_csv, grain_steps_csv, stability_csv};
pub use variant::{Case, Errors, Failure, METHODS, Measured, Prepared, Variant};
pub use verdict::{TOLERATED, Verdict};
pub use void::Void;
