//! What the language says and the solver does not compute yet: refused by name, so that nothing is left out in silence.

use super::Pass;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Foot, Loading, Scenario, TimeStep};

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
    let (track, solve) = (&scenario.track, &scenario.solve);
    let mut found = Vec::new();
    if let TimeStep::Adaptive { tolerance } = solve.time_step {
        found.push(("an `adaptive` time step", tolerance.origin.span()));
    }
    if let Some(irregularity) = &track.irregularity {
        found.push(("an `irregularity` of the rail", irregularity.origin.span()));
    }
    if let Some(Loading::Traffic(traffic)) = &scenario.loading
        && let Some(speed) = &traffic.train.speed_profile
    {
        found.push(("a `speed` that varies", speed.origin.span()));
    }
    let seating = track.seats.iter().find_map(|seat| match &seat.foot {
        Foot::Sleeper { support, .. } => support.seating,
        _ => None,
    });
    if let Some(seating) = seating {
        found.push(("the `seating` of a support", seating.stiffness.origin.span()));
    }
    found
}
