//! Packings of the grains: a number of them, or a range in which the results decide.

use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic};
use crate::scenario::Repeats;
use crate::units::number;

/// The `repeats` of a complete `solve` or `study`.
pub fn repeats(record: &Record, findings: &mut Findings) -> Option<Repeats> {
    let slot = record.get("repeats")?;
    let (least, most) = match slot.value {
        Val::Number(n) => return Some(Repeats::times(n.value as u32)),
        Val::Range(least, most) => (least.value, most.value),
        _ => return None,
    };
    let mistake = if let Some(part) = [least, most].iter().find(|n| n.fract() != 0.0) {
        Some(("not whole", format!("expected a whole number of packings, found {}", number(*part))))
    } else if least < 2.0 {
        Some(("one packing has no scatter", "a range of packings begins with at least 2, found 1".to_owned()))
    } else {
        None
    };
    if let Some((label, message)) = mistake {
        findings.report(
            Diagnostic::new(Code::E0405, message)
                .label(slot.span, label)
                .help("write a range such as `3 .. 12`: the results decide how many of them are run"),
        );
        return None;
    }
    Some(Repeats { least: least as u32, most: most as u32 })
}
