//! `trackbed docs`: the vocabulary.

use super::{Outcome, terminal};
use crate::diag::nearest::nearest;
use crate::{editor, report, schema};
use clap::ValueEnum;

/// Say what a kind and its fields mean
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The kind; all of them in a line each where it is left out.
    kind: Option<String>,
    /// `markdown` writes the whole reference, or the section of one kind; `textmate` the grammar by which editors colour files.
    #[arg(long, value_enum, default_value = "human")]
    format: DocsFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum DocsFormat {
    Human,
    Markdown,
    Textmate,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    if arguments.format == DocsFormat::Textmate {
        terminal::out(&editor::textmate());
        return Outcome::Fine;
    }
    let markdown = arguments.format == DocsFormat::Markdown;
    let Some(wanted) = &arguments.kind else {
        terminal::out(&if markdown { report::reference() } else { schema::index() });
        return Outcome::Fine;
    };
    match schema::kind(wanted) {
        Some(kind) => {
            terminal::out(&if markdown { schema::section(kind) } else { schema::page(kind) });
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
