//! `trackbed docs`: the vocabulary.

use super::{Outcome, terminal};
use crate::diag::nearest::nearest;
use crate::schema;

/// Say what a kind and its fields mean
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The kind; all of them in a line each where it is left out.
    kind: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(wanted) = &arguments.kind else {
        terminal::out(&schema::index());
        return Outcome::Fine;
    };
    match schema::kind(wanted) {
        Some(kind) => {
            terminal::out(&schema::page(kind));
            Outcome::Fine
        }
        None => {
            let near = nearest(wanted, schema::KINDS.iter().map(|k| k.name));
            let near = near.map_or(String::new(), |n| format!("; did you mean `{n}`?"));
            terminal::error(&format!("there is no kind `{wanted}`{near}\n`trackbed docs` lists them"));
            Outcome::Usage
        }
    }
}
