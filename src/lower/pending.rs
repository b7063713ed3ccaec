//! What the language says and the solver does not compute yet: refused by name, so that nothing is left out in silence.

use super::Pass;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Scenario, TimeStep};

/// Refuses what no solver takes.
pub(super) fn refuse(pass: &mut Pass, scenario: &Scenario) {
    for (what, span) in pending(scenario) {
        let mistake = Diagnostic::new(Code::E0411, format!("this version does not compute {what} yet"));
        pass.diagnostics.push(match span {
            Some(span) => mistake.at(span, "planned"),
            None => mistake,
        });
    }
}

fn pending(scenario: &Scenario) -> Vec<(&'static str, Option<Span>)> {
    let solve = &scenario.solve;
    let mut found = Vec::new();
    if let TimeStep::Adaptive { tolerance } = solve.time_step {
        found.push(("an `adaptive` time step", tolerance.origin.span()));
    }
    found
}
