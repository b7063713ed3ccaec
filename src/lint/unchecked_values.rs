//! L1010: the scene takes values from the library that have not been checked against their source. Silent until a scene
//! asks for it.

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Evidence, Scenario};

pub(super) fn check(scenario: &Scenario, _: &Graph) -> Vec<Diagnostic> {
    let unchecked = scenario.library.iter().filter(|entry| entry.evidence == Evidence::Unchecked);
    unchecked
        .map(|entry| {
            let message = format!("`{}` has not been checked: {}", entry.name, entry.source);
            let diagnostic = Diagnostic::new(Code::L1010, message).help(
                "give the values of your data sheet with a `source`; `trackbed resolve` shows the values of the entry",
            );
            match entry.span {
                Some(span) => diagnostic.label(span, "unchecked"),
                None => diagnostic,
            }
        })
        .collect()
}
