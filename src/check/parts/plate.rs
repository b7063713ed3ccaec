//! Approach slabs of stretches, and checks that a hinged slab ends at its structure.

use super::given::given;
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::{Places, TINY};
use crate::diag::{Code, Diagnostic};
use crate::scenario::ApproachSlab;
use crate::units::number;

/// The approach slab of a stretch that covers some seats; the outer `None` if it is not understood.
pub fn approach_slab(
    stretch: &Record,
    transition: usize,
    reach: (f64, f64),
    places: &Places,
    findings: &mut Findings,
) -> Option<Option<ApproachSlab>> {
    let slot = stretch.get("approach_slab")?;
    let record = match &slot.value {
        Val::Record(record) => record.clone(),
        Val::Word { .. } => return Some(None),
        _ => return None,
    };
    let hinged = record.word("hinged")? == "yes";
    let boundary = places.transitions.get(transition).map(|t| t.x);
    let ends = match boundary {
        Some(x) if (reach.0 - x).abs() < (reach.1 - x).abs() => [reach.0, reach.1],
        _ => [reach.1, reach.0],
    };
    let between = |seat: &&(f64, usize, usize, i32)| {
        let x = boundary.unwrap_or(f64::INFINITY);
        seat.0 > ends[0].min(x) + TINY && seat.0 < ends[0].max(x) - TINY
    };
    let apart = places.seats.iter().filter(between).count();
    if hinged && (boundary.is_none() || apart > 0) {
        let message = match boundary {
            None => format!("the approach slab of stretch `{}` has no structure to be hinged to", stretch.name),
            Some(x) => format!(
                "the approach slab of stretch `{}` is hinged to the structure at {} m and ends at {} m",
                stretch.name,
                number(x),
                number((ends[0] * 1e3).round() / 1e3)
            ),
        };
        let over = stretch.get("over").map_or(stretch.span, |over| over.span);
        findings.report(
            Diagnostic::new(Code::E0425, message)
                .label(over, "its span")
                .label(
                    record.get("hinged").filter(|s| s.span.file == record.span.file).map_or(record.span, |s| s.span),
                    "hinged",
                )
                .help("let the span end at the transition, as `over = -6 .. 0 m` does, or write `hinged = no`"),
        );
        return None;
    }
    Some(Some(ApproachSlab {
        thickness: given(&record, "thickness")?,
        youngs_modulus: given(&record, "youngs_modulus")?,
        density: given(&record, "density")?,
        depth: given(&record, "depth")?,
        ends: if hinged { [boundary.unwrap_or(ends[0]), ends[1]] } else { ends },
        hinged,
    }))
}
