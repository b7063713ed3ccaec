//! Settlement laws: the word after `form` and its arguments as the numbers of a law.

use crate::check::evaluate::value::{Slot, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic};
use crate::scenario::SettlementLaw;
use crate::solvers::settlement::{CyclePer, Form, Law, Logarithm};
use crate::units::{Dimension, number};
use std::collections::BTreeMap;

/// The law that drives the run and the laws beside it.
pub fn laws(slot: &Slot, findings: &mut Findings) -> Option<(SettlementLaw, Vec<SettlementLaw>)> {
    let slots = match &slot.value {
        Val::List(slots) => slots.as_slice(),
        Val::Record(_) => std::slice::from_ref(slot),
        _ => return None,
    };
    if slots.is_empty() {
        findings.report(
            Diagnostic::new(Code::E0403, "`law` needs at least one law")
                .label(slot.span, "empty")
                .help("write `law = laws.varandas_2014`"),
        );
        return None;
    }
    let mut laws: Vec<SettlementLaw> = Vec::with_capacity(slots.len());
    let mut sound = true;
    for slot in slots {
        match settlement_law(slot, findings) {
            Some(law) if laws.iter().any(|other| other.name == law.name) => {
                findings.report(
                    Diagnostic::new(Code::E0404, format!("two laws are called `{}`", law.name))
                        .label(slot.span, "again here")
                        .help("declare the second law under another name: `law other : laws.NAME { ... }`"),
                );
                sound = false;
            }
            Some(law) => laws.push(law),
            None => sound = false,
        }
    }
    let others = laws.split_off(laws.len().min(1));
    laws.pop().filter(|_| sound).map(|law| (law, others))
}

/// One law.
pub fn settlement_law(slot: &Slot, findings: &mut Findings) -> Option<SettlementLaw> {
    let Val::Record(record) = &slot.value else { return None };
    let Val::Word { word, arguments } = &record.get("form")?.value else { return None };
    let cycle_per = match record.word("cycle_per")? {
        "bogie" => CyclePer::Bogie,
        "vehicle" => CyclePer::Vehicle,
        _ => CyclePer::Axle,
    };
    let mut form = Form::of_name(word.name)?;
    for (name, value) in form.parameters() {
        *value = parameter(arguments, name, cycle_per)?;
    }
    if let Form::Hettler(law) = &mut form {
        law.logarithm = match &arguments.get("logarithm")?.value {
            Val::Word { word, .. } if word.name == "decimal" => Logarithm::Decimal,
            Val::Word { .. } => Logarithm::Natural,
            _ => return None,
        };
    }
    consistent(&mut form, arguments, findings)?;
    let range = |name: &str| match record.get(name).map(|s| &s.value) {
        Some(Val::Range(a, b)) => Some((a.of_rail(), b.of_rail())),
        _ => None,
    };
    let error = match record.get("error").map(|slot| &slot.value) {
        Some(Val::Number(error)) => Some(error.value),
        _ => None,
    };
    Some(SettlementLaw {
        name: record.name.clone(),
        law: Law { form, cycle_per },
        loads: range("loads"),
        cycles: range("cycles"),
        voids: range("voids"),
        error,
        origin: slot.origin,
    })
}

/// Checks that the arguments do not contradict each other.
fn consistent(form: &mut Form, arguments: &BTreeMap<&'static str, Slot>, findings: &mut Findings) -> Option<()> {
    match form {
        Form::Nasrollahi(law) if law.final_threshold < law.initial_threshold => {
            let span = |name: &str| arguments.get(name).map(|s| s.span);
            findings.report(
                Diagnostic::new(
                    Code::E0407,
                    format!(
                        "the threshold would fall from {} to {} kN per seat as the support settles",
                        number(law.initial_threshold / 1e3),
                        number(law.final_threshold / 1e3)
                    ),
                )
                .label(span("final_threshold")?, "the threshold of a support that has settled")
                .label(span("initial_threshold")?, "the threshold of a fresh support")
                .help("a law that hardens has `final_threshold` at or above `initial_threshold`"),
            );
            None
        }
        Form::Varandas(law) => {
            law.reference_cycles = law.reference_cycles.round().max(1.0);
            Some(())
        }
        _ => Some(()),
    }
}

/// A number among the arguments, SI, of one rail; axles as cycles of the law.
fn parameter(arguments: &BTreeMap<&'static str, Slot>, name: &str, cycle_per: CyclePer) -> Option<f64> {
    match arguments.get(name)?.value {
        Val::Number(n) if n.dimension == Dimension::AXLES => Some(n.value / cycle_per.axles() as f64),
        Val::Number(n) => Some(n.of_rail()),
        _ => None,
    }
}
