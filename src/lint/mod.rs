//! Physics rules: checks of the scene and its plan for values that are legal but implausible. One file per rule.
//!
//! A rule is silenced by `scenario { allow = [rule: "reason"] }` and made an error by `deny`. A few are silent until
//! `warn` or `deny` names them.

mod ballast_on_structure;
mod ballast_pressure;
mod ballast_thickness;
mod below_threshold;
mod car_body_frequency;
mod coarse_record;
mod coarse_time_step;
mod critical_speed;
mod dynamic;
mod few_grains_under_sleeper;
mod grain_overlap;
mod grain_step;
mod grains;
mod irregularity_too_sharp;
mod law_outside_calibration;
mod layer_order;
mod narrow_bed;
mod one_packing;
mod outside_tolerance;
mod over_budget;
mod overdamped;
mod passing_frequency;
mod rail_stiffness;
mod rail_stress;
mod reads;
mod reversed_wedge;
mod small_volume;
mod stiffness_jump;
mod strata;
mod support_stiffness;
mod surface_waves;
mod thin_layer;
mod track_level;
mod track_too_short;
mod transition_sides;
mod unchecked_values;
mod update_overshoot;
mod wagon_speed;
mod wavelength;
mod wheel_on_track;
mod wheel_unloading;
mod wide_void;
mod winkler;

pub(crate) use over_budget::LESS_MEMORY;
pub use reads::readers;
pub use winkler::Winkler;

use crate::diag::{Code, Diagnostic, Severity};
use crate::graph::{Blocks, Graph, Schedule};
use crate::scenario::{Loading, Scenario, SettlementLaw, Study, Train};
use std::borrow::Cow;

type Rule = fn(&Scenario, &Graph) -> Vec<Diagnostic>;

const RULES: [Rule; 35] = [
    transition_sides::check,
    stiffness_jump::check,
    ballast_on_structure::check,
    critical_speed::check,
    track_too_short::check,
    law_outside_calibration::check,
    coarse_time_step::check,
    update_overshoot::check,
    passing_frequency::check,
    below_threshold::check,
    irregularity_too_sharp::check,
    wheel_unloading::check,
    rail_stress::check,
    ballast_pressure::check,
    support_stiffness::check,
    car_body_frequency::check,
    overdamped::check,
    coarse_record::check,
    wavelength::check,
    thin_layer::check,
    unchecked_values::check,
    narrow_bed::check,
    few_grains_under_sleeper::check,
    grain_step::check,
    grain_overlap::check,
    over_budget::check,
    outside_tolerance::check,
    small_volume::check,
    wagon_speed::check,
    ballast_thickness::check,
    layer_order::check,
    wide_void::check,
    track_level::check,
    reversed_wedge::check,
    surface_waves::check,
];

/// Applies every rule, at the level that the scene gives it. A rule applies only if the plan has the part that it
/// checks. Rules check one train; for a mix of trains they are applied to each train in turn.
pub fn lint(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let views = led_by_each(scenario, graph);
    let each = |rule: &Rule| views.iter().flat_map(|(scenario, graph)| rule(scenario, graph)).collect::<Vec<_>>();
    levelled(RULES.iter().flat_map(each), scenario)
}

/// Applies the rules of studies to those of a file.
pub fn lint_studies(scenario: &Scenario, graph: &Graph, studies: &[Study]) -> Vec<Diagnostic> {
    levelled(studies.iter().filter_map(|study| one_packing::check(scenario, graph, study)), scenario)
}

/// The traffic for a rule: the leading train, as the scene states it, and the loop over axles.
#[derive(Clone, Copy)]
struct Led<'a> {
    train: &'a Train,
    blocks: &'a Blocks,
}

/// The traffic of a scene and its plan; `None` if no train runs.
fn led<'a>(scenario: &'a Scenario, graph: &'a Graph) -> Option<Led<'a>> {
    let Some(Loading::Traffic(traffic)) = &scenario.loading else { return None };
    Some(Led { train: &traffic.train, blocks: graph.blocks()? })
}

/// Each diagnostic once, at the level that the scene gives its rule.
fn levelled(all: impl Iterator<Item = Diagnostic>, scenario: &Scenario) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = Vec::new();
    for diagnostic in all {
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
        .into_iter()
        .filter(|d| !scenario.allow.iter().any(|(rule, _)| Some(rule.as_str()) == d.code.rule()))
        .filter(|d| !d.code.is_silent() || asked_for(scenario, d.code))
        .map(|d| match d.code.rule() {
            Some(rule) if scenario.deny.iter().any(|denied| denied == rule) => d.severity(Severity::Error),
            _ => d,
        })
        .collect()
}

fn asked_for(scenario: &Scenario, rule: Code) -> bool {
    scenario.warn.iter().chain(&scenario.deny).any(|named| Some(named.as_str()) == rule.rule())
}

/// The scene once for each train, with this train as the leading train.
fn led_by_each<'a>(scenario: &'a Scenario, graph: &'a Graph) -> Vec<(Cow<'a, Scenario>, Cow<'a, Graph>)> {
    let mut views = vec![(Cow::Borrowed(scenario), Cow::Borrowed(graph))];
    let others = graph.blocks().map_or(0, |blocks| blocks.others.len());
    for kind in 1..=others {
        let (mut scenario, mut graph) = (scenario.clone(), graph.clone());
        if let Some(Loading::Traffic(traffic)) = &mut scenario.loading {
            std::mem::swap(&mut traffic.train, &mut traffic.others[kind - 1]);
            traffic.counts.swap(0, kind);
        }
        if let Schedule::Blocks(blocks) = &mut graph.schedule {
            **blocks = blocks.led_by(kind);
        }
        views.push((Cow::Owned(scenario), Cow::Owned(graph)));
    }
    views
}

/// The laws that settle sleepers, then the laws that are evaluated beside them.
fn laws(scenario: &Scenario) -> impl Iterator<Item = &SettlementLaw> {
    scenario.driving_laws().into_iter().chain(&scenario.solve.other_laws)
}

/// Whether a law settles sleepers of a section, or is evaluated beside.
fn acts_in(scenario: &Scenario, law: &SettlementLaw, section: usize) -> bool {
    let mut here = scenario.driving_laws_of(section).into_iter().chain(&scenario.solve.other_laws);
    here.any(|other| other.name == law.name && other.law == law.law)
}

/// Points at the place in the scene that asks for a law; if the law is the default, at the traffic.
fn pointed(diagnostic: Diagnostic, scenario: &Scenario, law: &SettlementLaw, text: &str) -> Diagnostic {
    let traffic = match &scenario.loading {
        Some(Loading::Traffic(traffic)) => traffic.total.origin.span().map(|span| (span, "under this traffic")),
        _ => None,
    };
    match law.origin.span().map(|span| (span, text)).or(traffic) {
        Some((span, text)) => diagnostic.label(span, text),
        None => diagnostic,
    }
}
