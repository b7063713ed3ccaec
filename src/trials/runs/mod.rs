//! Error against time of whole runs: one scene, computed by every tier and with other exchanges, windows and packings.
//!
//! [`subject`](fn@subject) shortens the scene by stated rules, [`variants`] lists what applies to it, and [`RunChart`]
//! compares the runs with the finest of them.

mod chart;
mod csv;
mod errors;
mod shorten;
mod variants;

pub use chart::{Done, Ended, RunChart, RunRow, Took};
pub use csv::runs_csv;
pub use errors::RunErrors;
pub use shorten::{RunSubject, SHARE, subject};
pub use variants::{Group, RunVariant, reference, variants};
