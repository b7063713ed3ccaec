//! Grains between the sleepers of a trackform and beyond their ends, checked against its sleepers and layers.

use super::given::given;
use super::material::Ground;
use super::strata::Stratum;
use crate::check::evaluate::value::Record;
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Crib, Given};
use crate::units::number;

/// The cribs of a trackform with these layers, as far as they are understood; `None` if it has none, or if they are
/// impossible.
pub fn crib(form: &Record, layers: Option<&[Stratum]>, findings: &mut Findings) -> Option<Crib> {
    let shoulder = given(form, "shoulder");
    let Some(height) = given(form, "crib") else {
        shoulder_alone(form, shoulder, findings);
        return None;
    };
    // a crib on a slab or a rigid support is reported elsewhere
    let on_sleepers = form.record("slab").is_none() && form.word("support") != Some("rigid");
    let fits = [has_sleepers(form, on_sleepers, findings), is_no_higher(form, height, findings)];
    let filled = !on_sleepers || has_grains(form, layers, findings);
    (on_sleepers && filled && fits == [true; 2]).then_some(Crib { height, shoulder })
}

/// Refuses a shoulder without a crib, because a shoulder is as high as the crib.
fn shoulder_alone(form: &Record, shoulder: Option<Given>, findings: &mut Findings) {
    let (Some(_), Some(slot), false) = (shoulder, form.get("shoulder"), form.unknown("crib")) else { return };
    let mistake =
        Diagnostic::new(Code::E0403, format!("trackform `{}` has a `shoulder` and needs a `crib`", form.name))
            .label(slot.span, "its height is not given")
            .help("write `crib = 150 mm` too: the shoulder is as high as the grains between the sleepers");
    findings.report(mistake);
}

fn has_sleepers(form: &Record, on_sleepers: bool, findings: &mut Findings) -> bool {
    if !on_sleepers || form.record("sleeper").is_some() || form.unknown("sleeper") {
        return true;
    }
    let span = form.get("crib").map_or(form.span, |slot| slot.span);
    let message = format!("trackform `{}` has a `crib` and no sleepers", form.name);
    findings.report(
        Diagnostic::new(Code::E0407, message)
            .label(span, "there are no sleepers")
            .help("give the trackform a `sleeper`, or write `crib = none`"),
    );
    false
}

/// Checks that the crib is not higher than the sleepers.
fn is_no_higher(form: &Record, height: Given, findings: &mut Findings) -> bool {
    let Some(sleeper) = form.record("sleeper") else { return true };
    let Some(most) = sleeper.number("height").map(|n| n.value) else { return true };
    if *height <= most * (1.0 + 1e-9) {
        return true;
    }
    let message = format!(
        "the cribs of trackform `{}` are filled to {} mm, but its sleepers are {} mm high",
        form.name,
        mm(*height),
        mm(most)
    );
    let span = form.get("crib").map_or(form.span, |slot| slot.span);
    let mut mistake = Diagnostic::new(Code::E0407, message).label(span, "higher than the sleepers");
    if let Some(origin) = sleeper.get("height").and_then(|slot| slot.origin.span()) {
        mistake = mistake.label(origin, "height of a sleeper");
    }
    findings.report(mistake.help(format!("write `crib = {} mm` or less", mm(most))));
    false
}

/// Checks that there is a layer of grains to fill the cribs.
fn has_grains(form: &Record, layers: Option<&[Stratum]>, findings: &mut Findings) -> bool {
    let granular = |layer: &Stratum| matches!(layer.ground, Ground::Granular(..));
    if layers.is_none_or(|layers| layers.iter().any(granular)) {
        return true;
    }
    let span = form.get("crib").map_or(form.span, |slot| slot.span);
    let message = format!("trackform `{}` has a `crib` and no layer of grains to fill it", form.name);
    let mut mistake = Diagnostic::new(Code::E0407, message).label(span, "no grains to fill it");
    if let Some(slot) = form.get("layers") {
        mistake = mistake.label(slot.span, "no grains here");
    }
    findings.report(mistake.help("give the trackform `layers` with a `granular`, or write `crib = none`"));
    false
}

/// A length in mm, for a message.
fn mm(length: f64) -> String {
    number((length * 1e4).round() / 10.0)
}
