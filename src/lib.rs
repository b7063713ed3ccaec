//! Trackbed: a language and a solver for railway transition zones.

pub mod diag;
pub mod linalg;
pub mod report;
pub mod results;
pub mod scenario;
pub mod solvers;
pub mod syntax;
