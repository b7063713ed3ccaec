//! L1036: the tier that the planner takes has an expected error above the tolerance of the scene.
//!
//! A scene that names its tier has decided itself.

use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, Rejected};
use crate::scenario::{Origin, Scenario};
use crate::units::{duration, percent};
use std::cmp::Ordering;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let grains = &scenario.solve.grains;
    let (tolerance, chosen) = (*grains.tolerance, grains.tier.origin == Origin::Derived);
    let Some(error) = graph.error.share().filter(|error| chosen && *error > tolerance) else { return Vec::new() };
    let others = graph.decisions.iter().filter(|decision| decision.pass == "budget").flat_map(|d| &d.rejected);
    let better = others.filter_map(|other| Some((other, other.error.filter(|e| *e < error)?, other.seconds?)));
    // the cheapest within the tolerance, or else the most accurate
    let rank =
        |(_, error, seconds): &(&Rejected, f64, f64)| if *error <= tolerance { [0.0, *seconds] } else { [1.0, *error] };
    let next = better.min_by(|a, b| rank(a).partial_cmp(&rank(b)).unwrap_or(Ordering::Equal));
    let help = match next {
        Some((other, smaller, seconds)) => format!(
            "`substructure = {}` has an expected error of {} and takes about {} on two cores; or write `tolerance = {}`",
            other.what,
            percent(smaller),
            duration(seconds),
            percent(error)
        ),
        None => format!("no tier of this version is better for this scene; write `tolerance = {}`", percent(error)),
    };
    let message = format!(
        "tier `{}` has an expected error of {} of the largest settlement, more than the tolerance of {}",
        grains.tier.name(),
        percent(error),
        percent(tolerance)
    );
    let diagnostic = Diagnostic::new(Code::L1036, message).help(help);
    vec![match grains.budget.and_then(|budget| budget.origin.span()) {
        Some(span) => diagnostic.label(span, "no better tier fits this budget"),
        None => diagnostic,
    }]
}
