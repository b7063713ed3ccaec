//! Physics rules over the scene and its plan: what a careful colleague would point out. One rule a file.
//!
//! A rule is silenced by `scenario { allow = [rule: "reason"] }` and made an error by `deny`.

mod coarse_time_step;
mod critical_speed;
mod irregularity_too_sharp;
mod law_outside_calibration;
mod passing_frequency;
mod stiffness_jump;
mod track_too_short;
mod update_overshoot;
mod winkler;

use crate::diag::{Diagnostic, Severity};
use crate::graph::Graph;
use crate::scenario::Scenario;

type Rule = fn(&Scenario, &Graph) -> Vec<Diagnostic>;

const RULES: [Rule; 8] = [
    stiffness_jump::check,
    critical_speed::check,
    track_too_short::check,
    law_outside_calibration::check,
    coarse_time_step::check,
    update_overshoot::check,
    passing_frequency::check,
    irregularity_too_sharp::check,
];

/// Applies every rule, at the level that the scene gives it.
pub fn lint(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    RULES
        .iter()
        .flat_map(|rule| rule(scenario, graph))
        .filter(|d| !scenario.allow.iter().any(|(rule, _)| Some(rule.as_str()) == d.code.rule()))
        .map(|d| match d.code.rule() {
            Some(rule) if scenario.deny.iter().any(|denied| denied == rule) => d.severity(Severity::Error),
            _ => d,
        })
        .collect()
}
