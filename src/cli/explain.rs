//! `trackbed explain`: the page of a code.

use super::{Outcome, terminal};
use crate::diag::{Code, nearest::nearest};

/// Explain a code such as E0302, with a failing and a passing example
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed explain
  trackbed explain E0302
  trackbed explain stiffness_jump")]
pub(super) struct Arguments {
    /// The code; all of them where it is left out.
    code: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(wanted) = &arguments.code else {
        for code in Code::ALL {
            let rule = code.rule().map_or(String::new(), |r| format!(" ({r})"));
            terminal::out(&format!("{code}  {}{rule}\n", code.title()));
        }
        return Outcome::Fine;
    };
    match Code::parse(wanted).or_else(|| Code::of_rule(wanted)) {
        Some(code) => {
            terminal::out(code.page());
            Outcome::Fine
        }
        None => {
            let near = nearest(wanted, Code::ALL.iter().map(|c| c.as_str()));
            let near = near.map_or(String::new(), |n| format!("; did you mean `{n}`?"));
            terminal::error(&format!("there is no code `{wanted}`{near}\n`trackbed explain` lists them"));
            Outcome::Usage
        }
    }
}
