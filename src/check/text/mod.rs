//! The files of a check: the scene and its modules, the standard library, data files.

pub mod files;
mod headers;
pub mod library;
pub mod loader;
pub mod measured;
pub mod modules;
pub mod overrides;
pub mod scope;
mod surface;
pub mod table;
