//! Grains between and beside the sleepers (cribs and shoulders): their data in the plan, their volume, and whether they
//! fit.

use crate::diag::{Code, Diagnostic};
use crate::scenario::{Scenario, Section};
use crate::solvers::granular::packing::Recipe;
use crate::solvers::granular::rig::Crib;
use crate::units::number;

/// The cribs of a section in the plan.
pub(super) fn planned(section: &Section) -> Option<Crib> {
    section.crib.map(|crib| Crib { height: *crib.height, shoulder: crib.beyond() })
}

/// The cribs of a section as a sentence.
pub(super) fn note(section: &Section) -> Option<String> {
    let crib = planned(section)?;
    let grains = section.layers.iter().find(|layer| layer.granular().is_some())?;
    let shoulder = match crib.shoulder {
        0.0 => "; there are no grains beyond the ends of the sleepers".to_owned(),
        width => format!(", and {} mm beyond the ends of the sleepers", mm(width)),
    };
    let height = mm(crib.height);
    Some(format!(
        "Grains of `{}` lie between the sleepers, up to {height} mm above the underside of the sleepers{shoulder}.",
        grains.name
    ))
}

/// Volume between and beside the sleepers over a length of a section, for one rail, m3.
pub(super) fn space(scenario: &Scenario, number: usize, length: f64) -> f64 {
    let track = &scenario.track;
    let section = &track.sections[number];
    let sleeper = track.seats[track.seats_of(number)].iter().find_map(|seat| seat.sleeper);
    let (Some(crib), Some(sleeper)) = (planned(section), sleeper) else { return 0.0 };
    let between = (1.0 - sleeper.base_width / *section.spacing).max(0.0);
    crib.height * length * (between * 0.5 * sleeper.length + crib.shoulder)
}

/// Fails where the largest grain of the top layer does not fit between two sleepers.
pub(super) fn holds_grains(scenario: &Scenario, number: usize, recipe: &Recipe) -> Result<(), Diagnostic> {
    let track = &scenario.track;
    let section = &track.sections[number];
    let sleeper = track.seats[track.seats_of(number)].iter().find_map(|seat| seat.sleeper);
    let (Some(crib), Some(sleeper), Some(top)) = (section.crib, sleeper, recipe.layers.last()) else { return Ok(()) };
    let (gap, widest) = (*section.spacing - sleeper.base_width, top.widest());
    if gap >= widest {
        return Ok(());
    }
    let message = format!(
        "the cribs cannot be filled: grains of `{}` are up to {} mm wide, and the gap between the sleepers is {} mm",
        top.name,
        mm(widest),
        mm(gap.max(0.0))
    );
    let told = Diagnostic::new(Code::E0610, message).help(
        "write a larger `spacing`, a smaller `base_width`, or `crib = none`; or cut off large grains with `cut_above`",
    );
    Err(match crib.height.origin.span() {
        Some(span) => told.label(span, "the grains do not fit between the sleepers"),
        None => told,
    })
}

/// A length in mm.
fn mm(length: f64) -> String {
    number((length * 1e3).round())
}
