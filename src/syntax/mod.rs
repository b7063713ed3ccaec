//! From text to a tree, and from text to formatted text.
//!
//! [`parse`] reads a file whole and reports all its mistakes at once: `token` cuts it; `uses`, `quotes`, `declared`,
//! `indented`, `header`, `foreign` and `balance` repair it so that `grammar/track.pest` can read it to the end, `build`
//! makes the tree, and `explain` explains the parts that could not be read. [`format()`] formats the tokens.

mod balance;
mod brackets;
mod build;
mod builder;
mod declared;
mod decode;
mod draft;
mod explain;
mod foreign;
mod format;
mod grammar;
mod habits;
mod header;
mod indented;
mod layout;
mod parse;
mod prepare;
mod quotes;
mod token;
pub mod tree;
mod unfit;
mod uses;
mod value;

pub use decode::decode;
pub use format::format;
pub use parse::parse;
pub use token::{Kind as TokenKind, Token, tokens};

/// The bounds of the language, for generated files.
pub mod limits {
    /// Length of a file.
    pub const BYTES: usize = 8 << 20;
    /// Brackets inside brackets.
    pub const DEPTH: usize = 64;
    /// Powers of powers in one value.
    pub const POWERS: usize = 64;
    /// Operations inside operations in one value.
    pub const OPERATIONS: usize = 512;
    /// Declarations in a file.
    pub const DECLARATIONS: usize = 100_000;
    /// Largest exponent, either sign.
    pub const EXPONENT: f64 = 9.0;
    /// Mistakes reported for one file.
    pub const DIAGNOSTICS: usize = 500;
}
