//! Scenes that give no test rig, refused before anything is packed.

use super::{acts_on, has_grains, loads};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Foot, Force, RigLoad, Scenario, Seat, Target};
use crate::units::number;

/// Every mistake of a rig.
pub(super) fn refusals(scenario: &Scenario) -> Vec<Diagnostic> {
    if let Some(section) = scenario.track.sections.iter().find(|section| !has_grains(section)) {
        let message = format!("a test rig needs a bed of grains, and `{}` has no layer of grains", section.name);
        return vec![refused(
            message,
            section.layers_span,
            "no grains",
            "give its trackform `layers` with a `granular` on top",
        )];
    }
    let mut found = Vec::new();
    one_bed(scenario, &mut found);
    let loads = loads(scenario);
    no_crib_under_a_plate(scenario, &loads, &mut found);
    if let [first, second, ..] = loads.as_slice()
        && loads.iter().any(|load| load.on == Target::Bed)
    {
        let message = format!("`{}` and `{}` act together with a plate over the whole bed", first.name, second.name);
        let help = "a plate covers the whole bed: keep one load";
        found.push(refused(message, Some(second.span), "a second load", help));
    } else if loads.iter().all(|load| load.on == Target::Sleepers) {
        sleepers(scenario, &loads, &mut found);
        one_load_each(scenario, &loads, &mut found);
    }
    one_rhythm(&loads, &mut found);
    found
}

fn refused(message: String, at: Option<Span>, text: &str, help: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0611, message).help(help);
    match at {
        Some(span) => diagnostic.label(span, text),
        None => diagnostic,
    }
}

fn one_bed(scenario: &Scenario, found: &mut Vec<Diagnostic>) {
    let sections = &scenario.track.sections;
    if let [first, second, ..] = sections.as_slice() {
        let message =
            format!("a test rig has one bed, but section `{}` lies beside section `{}`", second.name, first.name);
        let help = "keep one section, and run the other section in a separate scene";
        found.push(refused(message, second.length_origin.span(), "a second bed", help));
    }
}

fn no_crib_under_a_plate(scenario: &Scenario, loads: &[RigLoad], found: &mut Vec<Diagnostic>) {
    let plate = loads.iter().find(|load| load.on == Target::Bed);
    let crib = scenario.track.sections.iter().find_map(|section| section.crib);
    if let (Some(plate), Some(crib)) = (plate, crib) {
        let message = format!("`{}` acts on a plate over the whole bed, so there is no `crib` to fill", plate.name);
        let help = "write `crib = none`, or let the load act on sleepers";
        found.push(refused(message, crib.height.origin.span(), "no sleepers here", help));
    }
}

fn sleepers(scenario: &Scenario, loads: &[RigLoad], found: &mut Vec<Diagnostic>) {
    let track = &scenario.track;
    let Some(seat) = track.seats.first() else { return };
    let spacing = track.sections[seat.section].spacing;
    let Some(body) = seat.sleeper.filter(|_| matches!(seat.foot, Foot::Sleeper { .. })) else {
        let message = "the load acts on sleepers, but this track has no sleepers".to_owned();
        let at = loads.first().map(|load| load.span);
        found.push(refused(message, at, "acts on a sleeper", "give the trackform a `sleeper`"));
        return;
    };
    if let Some(usp) = track.seats.iter().find_map(Seat::usp) {
        let message = "a test rig cannot have under sleeper pads in this version".to_owned();
        let help = "leave out `usp`: the sleepers of a test rig lie directly on the grains";
        found.push(refused(message, usp.stiffness.origin.span(), "an under sleeper pad", help));
    }
    if body.base_width >= track.shortest_bay() {
        let message = format!(
            "sleepers are {} mm wide and stand {} mm apart; a test rig needs a gap between sleepers",
            number((body.base_width * 1e3).round()),
            number((track.shortest_bay() * 1e3).round())
        );
        let help = "write a larger `spacing`, or a smaller `base_width`";
        found.push(refused(message, spacing.origin.span(), "too close", help));
    }
}

fn one_load_each(scenario: &Scenario, loads: &[RigLoad], found: &mut Vec<Diagnostic>) {
    for seat in &scenario.track.seats {
        let acting: Vec<&RigLoad> = loads.iter().filter(|load| acts_on(load, seat)).collect();
        if let [first, second, ..] = acting.as_slice() {
            let name = scenario.track.seat_name(seat);
            let message = format!("`{}` and `{}` both act on sleeper {name}", first.name, second.name);
            let help = "a sleeper has one actuator: leave out one load";
            found.push(refused(message, Some(second.span), "a second actuator", help));
            return;
        }
    }
}

/// All cyclic actuators must have the same frequency and number of cycles, because the run counts cycles.
fn one_rhythm(loads: &[RigLoad], found: &mut Vec<Diagnostic>) {
    let mut first: Option<(&RigLoad, f64)> = None;
    for load in loads {
        let frequency = match &load.force {
            Force::Constant(_) => continue,
            Force::Cyclic { frequency, .. } => {
                if **frequency <= 0.0 {
                    let message = format!("`{}` has a frequency of 0 Hz", load.name);
                    let help = "write a frequency above 0 Hz, or a constant force";
                    found.push(refused(message, frequency.origin.span(), "0 Hz", help));
                    continue;
                }
                **frequency
            }
            Force::History(points) => {
                if load.cycles > 1 || *load.speed > 0.0 {
                    let message = format!(
                        "the forces of a file act once and at one place, but `{}` repeats or moves them",
                        load.name
                    );
                    let help = "write every cycle into the file; leave out `total` and `speed`";
                    found.push(refused(message, load.changes, "not with a file", help));
                }
                1.0 / (points.last().map_or(0.0, |p| p[0]) - points.first().map_or(0.0, |p| p[0]))
            }
            // a plate is alone on its bed
            Force::Strain(_) => continue,
        };
        match first {
            Some((other, rhythm)) if rhythm != frequency || other.cycles != load.cycles => {
                let message = format!("`{}` and `{}` differ in frequency or number of cycles", other.name, load.name);
                let help = "all actuators of a test rig need the same frequency and the same number of cycles";
                found.push(refused(message, Some(load.span), "differs", help));
                return;
            }
            Some(_) => {}
            None => first = Some((load, frequency)),
        }
    }
}
