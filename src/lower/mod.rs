//! From the scenario to the solver graph: passes that choose models, places, steps and blocks, and say why.

mod bed;
mod estimate;
mod outlook;
mod passage;
mod records;
mod rig;
mod schedule;

pub use bed::{BedPlan, beds};
pub use rig::{RigCost, RigPlan, is_rig, rig, rig_cost, rig_listing};

use crate::diag::{Code, Diagnostic, Severity};
use crate::graph::{Decision, Graph, NamedLaw, Schedule, SubstructureNode, TrackNode};
use crate::scenario::{Loading, Origin, Scenario, Seat, SettlementLaw};
use outlook::Outlook;

/// Lowers a scene. Without a graph there is at least one diagnostic, here or of the check: what only grains can run is told
/// there.
pub fn lower(scenario: &Scenario) -> (Option<Graph>, Vec<Diagnostic>) {
    let mut pass = Pass { decisions: Vec::new(), diagnostics: Vec::new() };
    if !scenario.track.is_sprung() {
        return (None, rig::refusals(scenario));
    }
    let (substructure, schedule) = match &scenario.loading {
        Some(Loading::Rig(_)) => return (None, pass.diagnostics),
        None => {
            pass.diagnostics.push(
                Diagnostic::new(Code::E0601, "nothing acts on the track: there is neither `traffic` nor `load`")
                    .severity(Severity::Warning)
                    .help("add `traffic { trains = ..., total = 500 axles }` to run the scene"),
            );
            return (None, pass.diagnostics);
        }
        Some(Loading::Static(loads)) => {
            pass.decide("tier", "no settlement", "test loads act on a track at rest");
            (SubstructureNode::Fixed, Some(Schedule::Static { loads: loads.clone() }))
        }
        Some(Loading::Traffic(traffic)) => {
            let stated = "the scene gives the stiffness of its supports";
            let why = if stands_on_layers(scenario) { "the layers give the stiffness of the supports" } else { stated };
            pass.decide("tier", "a settlement law under each sleeper", why);
            let law = SubstructureNode::Law {
                law: named(&scenario.solve.law),
                followers: scenario.solve.other_laws.iter().map(named).collect(),
            };
            (law, schedule::blocks(&mut pass, scenario, traffic).map(|blocks| Schedule::Blocks(Box::new(blocks))))
        }
    };
    let Some(schedule) = schedule.filter(|_| !crate::diag::has_errors(&pass.diagnostics)) else {
        return (None, pass.diagnostics);
    };
    let track = TrackNode {
        track: scenario.track.clone(),
        beam: *scenario.solve.beam,
        elements_per_bay: *scenario.solve.elements_per_bay,
        gravity: *scenario.solve.gravity,
    };
    let outlook = match (&schedule, &substructure) {
        (Schedule::Blocks(blocks), SubstructureNode::Law { law, .. }) => {
            let outlook = Outlook::of(&track, &law.law, blocks);
            schedule::share(&mut pass, blocks, outlook.passages.iter().sum());
            outlook
        }
        _ => Outlook::default(),
    };
    let estimate = estimate::estimate(&track, &schedule, &outlook);
    let records = records::records(&mut pass, scenario);
    let graph = Graph { track, substructure, schedule, records, decisions: pass.decisions, estimate };
    (Some(graph), pass.diagnostics)
}

/// Whether a sleeper stands on layers alone.
fn stands_on_layers(scenario: &Scenario) -> bool {
    let derived = |seat: &Seat| seat.support().is_some_and(|support| support.stiffness.origin == Origin::Derived);
    scenario.track.seats.iter().any(|seat| derived(seat) && seat.onto_subgrade.is_some())
}

fn named(law: &SettlementLaw) -> NamedLaw {
    NamedLaw { name: law.name.clone(), law: law.law }
}

/// What the passes collect on their way.
struct Pass {
    decisions: Vec<Decision>,
    diagnostics: Vec<Diagnostic>,
}

impl Pass {
    fn decide(&mut self, pass: &str, what: impl Into<String>, why: impl Into<String>) {
        self.decisions.push(Decision { pass: pass.into(), what: what.into(), why: why.into() });
    }
}
