//! Forces of a test load from a data file: ascending times, each with a force in the range of constant forces.

use crate::check::evaluate::value::{Slot, Val};
use crate::check::findings::Findings;
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic, Span};
use crate::units::{Dimension, number};
use std::collections::BTreeMap;

/// The largest force of a load, N.
const LARGEST: f64 = 1e7;

/// Reads `file("force.csv")`: times, s, and forces, N, as given there; `None` if a diagnostic has been given.
pub fn force_history(
    arguments: &BTreeMap<&'static str, Slot>,
    whole: Span,
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Option<Vec<[f64; 2]>> {
    let slot = arguments.get("name")?;
    let Val::Text(name) = &slot.value else { return None };
    let table = files.table(name, slot.span, findings)?;
    let of = |dimension: Dimension| {
        move |i: &usize, columns: &[crate::check::text::table::Column]| columns[*i].unit.dimension == dimension
    };
    let (is_time, is_force) = (of(Dimension::TIME), of(Dimension::FORCE));
    let all = 0..table.columns.len();
    let time = all.clone().find(|i| is_time(i, &table.columns));
    let forces: Vec<usize> = all.filter(|i| is_force(i, &table.columns)).collect();
    let wanted = match arguments.get("column").map(|slot| &slot.value) {
        Some(Val::Text(column)) => table.column(column).filter(|i| forces.contains(i)),
        _ => forces.first().copied().filter(|_| forces.len() == 1),
    };
    let (Some(time), Some(force)) = (time, wanted) else {
        let what = match (time, forces.as_slice()) {
            (None, _) => "no column of times, such as `time_s`",
            (_, []) => "no column of forces, such as `force_kN`",
            _ if arguments.contains_key("column") => "no such column of forces",
            _ => "several columns of forces: name one with `column = name`",
        };
        let mistake = Diagnostic::new(Code::E0509, format!("`{name}` has {what}"));
        let listed = table.columns.iter().map(|c| format!("`{}`", c.name)).collect::<Vec<_>>().join(", ");
        let help = "a file of forces has the columns `time_s,force_kN`";
        findings.report(mistake.label(table.header, format!("has {listed}")).label(whole, "read here").help(help));
        return None;
    };
    let mut last: Option<crate::check::text::table::Cell> = None;
    let mut history: Vec<[f64; 2]> = Vec::new();
    for cells in table.rows() {
        let (at, value) = (cells[time], cells[force]);
        if let Some(before) = last.filter(|before| before.value >= at.value) {
            findings.report(
                Diagnostic::new(Code::E0510, "the times of a data file must ascend from row to row")
                    .label(at.span, "not later than in the row before")
                    .label(before.span, "the row before")
                    .label(whole, "read here"),
            );
            return None;
        }
        if !(0.0..=LARGEST).contains(&value.value) {
            let message = format!("expected 0 .. 10000 kN, found {} kN", number(value.value / 1e3));
            let mistake = Diagnostic::new(Code::E0405, message).label(value.span, "out of range");
            findings.report(
                mistake.label(whole, "read here").help("forces are positive down; a load does not lift the track"),
            );
            return None;
        }
        last = Some(at);
        history.push([at.value, value.value]);
    }
    if history.len() < 2 {
        let message = format!("expected at least two rows of numbers, found {}", history.len());
        let mistake = Diagnostic::new(Code::E0510, message).label(table.header, "too few rows below");
        findings.report(mistake.label(whole, "read here"));
        return None;
    }
    Some(history)
}
