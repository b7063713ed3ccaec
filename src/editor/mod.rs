//! The language server: answers for editors while a text is edited.
//!
//! A [`view::View`] holds one text with its names and values. Each request is a function from a view and a place to
//! plain data, in a separate file. `session` keeps the open documents, `worker` does the longer computations, and only
//! `server` uses the protocol.

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
