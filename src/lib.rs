//! Trackbed: a language and a solver for railway transition zones.
//!
//! A `.track` file reads like the data sheet of a scene. A program needs [`Scene`] and what it gives: [`Scene::check`]
//! says everything that is wrong, [`Scene::set`] edits a line by its path, [`Scene::run`] gives a [`results::Run`] with
//! its tables.
//!
//! ```
//! let jack = trackbed::Scene::from_text(r#"
//!   trackform seats {
//!     rail = { mass = 60 kg/m, bending_stiffness = 6.4 MN m^2 }
//!     pad = { stiffness = 40 MN/m, damping = 5 kN s/m }
//!     spacing = 0.6 m, support = rigid
//!   }
//!   track bench { sections = [seats: 20 sleepers], rail_ends = free }
//!   load jack { on = rail, at = 10 sleepers, force = 100 kN per rail }
//!   solve { gravity = 0 m/s^2 }
//! "#);
//! let moment = jack.run()?.scalar("max_rail_moment").unwrap();
//! assert!((moment / 17.66e3 - 1.0).abs() < 1e-3);
//! # Ok::<(), trackbed::Stopped>(())
//! ```
//!
//! Inside, [`compile`](compile()) checks a text and lowers it into a solver graph, [`execute`] runs the graph by its
//! schedule, [`results`] keeps what came out and [`report`] shows it. The modules below stand in the order of that
//! flow; each knows only what stands before it.

pub mod diag;
pub mod units;

pub mod linalg;
pub mod solvers;

pub mod schema;
pub mod syntax;

pub mod check;
pub mod scenario;

pub mod graph;
pub mod lint;
pub mod lower;

pub mod execute;
pub mod nodes;
pub mod store;

pub mod compile;
pub mod results;

pub mod compare;
pub mod embed;
pub mod study;
pub mod trials;

pub mod cluster;
pub mod report;

pub mod editor;

pub mod cli;

pub use compile::{Compiled, compile, fingerprint};
pub use embed::{Scene, Stopped};
