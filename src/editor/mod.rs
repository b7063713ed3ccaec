//! What editors ask of a text while it is typed, over the language server protocol.
//!
//! A [`view::View`] holds one text with its names and values; each request is a function from a view and a place to plain data, in a
//! file of its own. `session` keeps the open documents, `worker` computes what takes longer than a key, and `server` alone speaks
//! the protocol.

mod actions;
mod completion;
mod context;
mod definition;
mod diagnostics;
mod files;
mod forms;
mod grammar;
mod hints;
mod hover;
mod layout;
mod library;
mod marks;
mod names;
mod outline;
mod positions;
mod references;
mod server;
mod session;
mod tokens;
mod view;
mod worker;

pub use grammar::textmate;
pub use server::{Settings, serve, serve_stdio};
