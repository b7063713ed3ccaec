//! Trackbed: a language and a solver for railway transition zones.

pub mod check;
pub mod diag;
pub mod linalg;
pub mod results;
pub mod scenario;
pub mod schema;
pub mod solvers;
pub mod syntax;
pub mod units;
