//! Numbers of one rail, taken out of records with their origin.

use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic};
use crate::scenario::Given;
use crate::units::number;
use std::collections::BTreeMap;

/// Arguments of a word by name.
pub type Arguments = BTreeMap<&'static str, Slot>;

/// A number of one rail with its origin; `None` if there is none.
pub fn given(record: &Record, field: &str) -> Option<Given> {
    let slot = record.slot(field)?;
    match slot.value {
        Val::Number(n) => Some(Given { value: n.of_rail(), origin: slot.origin }),
        _ => None,
    }
}

/// A number of one rail among the arguments of a word, with its origin.
pub fn argument(arguments: &Arguments, name: &str) -> Option<Given> {
    match arguments.get(name)? {
        Slot { value: Val::Number(n), origin, .. } => Some(Given { value: n.of_rail(), origin: *origin }),
        _ => None,
    }
}

/// The first of several ways to give one quantity; the given ways must agree within 2 %.
pub fn agree(
    record: &Record,
    what: &str,
    ways: &[(&str, Option<Given>)],
    unit: &str,
    findings: &mut Findings,
) -> Option<Given> {
    let known: Vec<(&str, Given)> = ways.iter().filter_map(|(name, g)| Some((*name, (*g)?))).collect();
    let (_, first) = *known.first()?;
    if let Some((name, other)) = known[1..].iter().find(|(_, g)| (**g - *first).abs() > 0.02 * first.abs()) {
        let size = crate::units::parse_unit(unit).map_or(1.0, |u| u.factor);
        let show = |g: Given| format!("{} {unit}", number(*g / size));
        let span = first.origin.span().unwrap_or(record.span);
        findings.report(
            Diagnostic::new(
                Code::E0407,
                format!("the {what} of {} `{}` is given twice with different values", record.kind.name, record.name),
            )
            .label(span, format!("{}: {}", known[0].0, show(first)))
            .label(record.span, format!("{name}: {}", show(*other)))
            .help("keep one of the two"),
        );
    }
    Some(first)
}
