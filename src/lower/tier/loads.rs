//! Test loads that the chosen plan cannot take: a plate or sleepers without rails if there is no bed, and `confinement`
//! or `strain` without a plate.

use super::rig;
use crate::diag::{Code, Diagnostic};
use crate::graph::Schedule;
use crate::scenario::{Force, RigLoad, Scenario, Target};

/// Diagnostics for loads that do not fit the schedule; `schedule` is `None` if no tier has a plan.
pub(super) fn refusals(scenario: &Scenario, schedule: Option<&Schedule>) -> Vec<Diagnostic> {
    let loads = rig::loads(scenario);
    let has_bed = matches!(schedule, Some(Schedule::Actuators(_) | Schedule::Custom { .. }));
    // sleepers without rails also need a bed
    let needs_bed = |load: &&RigLoad| match load.on {
        Target::Bed => true,
        Target::Sleepers => !scenario.track.has_rails(),
        Target::Rail => false,
    };
    let without = loads.iter().filter(|_| !has_bed).find(needs_bed);
    without.map(no_bed).into_iter().chain(loads.iter().find_map(sides)).collect()
}

fn no_bed(load: &RigLoad) -> Diagnostic {
    let what = if load.on == Target::Bed { "plate" } else { "load" };
    let message = format!("{what} `{}` acts on a bed of grains, but this scene does not ask for a bed", load.name);
    let help = "write `solve { substructure = full }`, with layers of grains, without rails and without trains";
    Diagnostic::new(Code::E0611, message).label(load.span, "no bed").help(help)
}

/// Diagnostic for `confinement` or `strain` of a load without a plate.
fn sides(load: &RigLoad) -> Option<Diagnostic> {
    let acts_on = match load.on {
        Target::Rail => "rail",
        Target::Sleepers => "sleepers",
        Target::Bed => return None,
    };
    let strain = if let Force::Strain(strain) = &load.force { Some(("strain", strain)) } else { None };
    let (field, stated) = load.confinement.as_ref().map(|given| ("confinement", given)).or(strain)?;
    let message = format!("`{field}` is only for a specimen under a plate, but this load acts on the {acts_on}");
    let refused = Diagnostic::new(Code::E0611, message).help(format!("write `on = bed`, or leave out `{field}`"));
    Some(refused.label(stated.origin.span().unwrap_or(load.span), ""))
}
