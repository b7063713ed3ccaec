//! `trackbed docs`: the vocabulary.

use super::{Outcome, terminal};
use crate::report::{self, Topic};
use crate::{editor, schema};
use clap::ValueEnum;
use serde_json::{Value, json};

/// Say what a kind, a field, a library entry or a response means, or search for a word
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed docs
  trackbed docs sleeper
  trackbed docs usp.bedding_modulus
  trackbed docs usps
  trackbed docs usps.medium
  trackbed docs bedding
  trackbed docs --search sleeper
  trackbed docs usps --format json")]
pub(super) struct Arguments {
    /// The name of a kind, field, module, library entry, response or code, else a word to search for; all kinds if it
    /// is left out
    name: Option<String>,
    /// Search for words in the names and meanings of all kinds, fields, library entries, responses and codes
    #[arg(long, value_name = "WORDS", conflicts_with = "name")]
    search: Option<String>,
    /// `markdown` writes the whole reference, or the section of one kind; `textmate` writes the grammar for colours in
    /// editors
    #[arg(long, value_enum, default_value = "human")]
    format: DocsFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum DocsFormat {
    Human,
    Json,
    Markdown,
    Textmate,
}

/// The topics that the command line asks for.
enum Asked {
    Everything,
    One(Topic),
    Found(Vec<Topic>),
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let asked = match asked(arguments) {
        Ok(asked) => asked,
        Err(why) => {
            terminal::error(&why);
            return Outcome::Usage;
        }
    };
    let told = match arguments.format {
        DocsFormat::Human => Ok(human(&asked)),
        DocsFormat::Json => Ok(format!("{:#}\n", data(&asked))),
        DocsFormat::Markdown => markdown(&asked),
        DocsFormat::Textmate => Ok(editor::textmate()),
    };
    match told {
        Ok(text) => {
            terminal::out(&text);
            Outcome::Fine
        }
        Err(why) => {
            terminal::error(&why);
            Outcome::Usage
        }
    }
}

fn asked(arguments: &Arguments) -> Result<Asked, String> {
    let words = match (&arguments.name, &arguments.search) {
        (None, None) => return Ok(Asked::Everything),
        (Some(name), _) => match Topic::named(name) {
            Some(topic) => return Ok(Asked::One(topic)),
            None => name,
        },
        (None, Some(words)) => words,
    };
    let found = Topic::found(words);
    if !found.is_empty() {
        return Ok(Asked::Found(found));
    }
    let near = report::nearest_topic(words).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    Err(format!("nothing is called `{words}`, and no text has this word{near}\n`trackbed docs` lists all kinds"))
}

fn human(asked: &Asked) -> String {
    match asked {
        Asked::Everything => format!("{}\n{HINT}", schema::index()),
        Asked::One(topic) => topic.page(),
        Asked::Found(topics) => report::listing(topics),
    }
}

/// The last lines of the list of kinds.
const HINT: &str =
    "`trackbed docs NAME` describes a kind (`sleeper`), a field (`usp.bedding_modulus`), a module of the standard
library (`usps`), one of its entries (`usps.medium`) or a response (`settlement`).
`trackbed docs WORD` searches for any other word.
";

fn data(asked: &Asked) -> Value {
    match asked {
        Asked::Everything => report::vocabulary(),
        Asked::One(topic) => topic.data(),
        Asked::Found(topics) => json!({ "found": topics.iter().map(Topic::data).collect::<Vec<_>>() }),
    }
}

fn markdown(asked: &Asked) -> Result<String, String> {
    match asked {
        Asked::Everything => Ok(report::reference()),
        Asked::One(Topic::Kind(kind)) => Ok(schema::section(kind)),
        Asked::One(_) | Asked::Found(_) => {
            Err("`--format markdown` writes the whole reference or one kind: leave the name out, or name a kind".into())
        }
    }
}
