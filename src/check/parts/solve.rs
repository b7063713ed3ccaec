//! The settings of the computation: the words of `solve`.

use super::asked::tier;
use super::given::given;
use super::law::laws;
use super::repeats::repeats;
use super::traffic::whole_axles;
use crate::check::evaluate::number::Number;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Beam, Given, Grains, Integrator, Solve, TimeStep, Update};
use crate::solvers::foundation::Method;

/// The settings of the computation, from a complete `solve`.
pub fn solve(record: &Record, places: Option<&Places>, findings: &mut Findings) -> Option<Solve> {
    let laws = record.get("law").and_then(|slot| laws(slot, findings));
    let update = record.get("update_every")?;
    let exchange = match &update.value {
        Val::Number(n) => whole_axles(n.value, update.span, findings).map(|axles| Update::Fixed { axles }),
        Val::Word { word, arguments } => {
            let of = |name: &str| match arguments.get(name).map(|s| (&s.value, s.span)) {
                Some((Val::Number(n), span)) => Some((n.value, span)),
                _ => None,
            };
            if word.name == "adaptive" {
                adaptive(of("tolerance"), of("cap"), findings)
            } else {
                let first = of("first").and_then(|(axles, span)| whole_axles(axles, span, findings));
                first.zip(of("ratio")).map(|(first, (ratio, _))| Update::Geometric { first, ratio })
            }
        }
        _ => None,
    };
    let mut place = |name: &str| -> Option<Option<Given>> {
        let slot = record.get(name)?;
        match slot.value {
            Val::Number(n) => {
                let places = places?;
                // the passage has no `from`: its ends count from the first transition
                let from = places.transitions.first().filter(|_| places.transitions.len() > 1);
                let x = places.chainage(n, from.map(|t| (t.name.as_str(), slot.span)), slot.span, findings)?;
                Some(Some(Given { value: x, origin: slot.origin }))
            }
            Val::Word { .. } => Some(None),
            _ => None,
        }
    };
    let (start, finish) = (place("start"), place("finish"));
    let beam = Given {
        value: if record.word("beam")? == "timoshenko" { Beam::Timoshenko } else { Beam::Euler },
        origin: record.get("beam")?.origin,
    };
    let (integrator, time_step) = (integrator(record), time_step(record));
    let elements = record.number("elements_per_bay")?;
    let grains = grains(record, places, findings);
    let (law, other_laws) = laws?;
    Some(Solve {
        law,
        other_laws,
        update: exchange?,
        update_span: update.origin.span(),
        support_method: method(record).unwrap_or(Method::StressCone),
        integrator: integrator?,
        beam,
        elements_per_bay: Given { value: elements.value as u32, origin: record.get("elements_per_bay")?.origin },
        time_step: time_step?,
        start: start?,
        finish: finish?,
        gravity: given(record, "gravity")?,
        seed: record.number("seed")?.value as u64,
        grains: grains?,
    })
}

fn method(solve: &Record) -> Option<Method> {
    let Val::Word { word, arguments } = &solve.get("support_method")?.value else { return None };
    if word.name == "stress_cone" {
        return Some(Method::StressCone);
    }
    match arguments.get("neighbours")?.value {
        Val::Number(n) => Some(Method::LayeredElastic { neighbours: n.value }),
        _ => None,
    }
}

fn adaptive(tolerance: Option<(f64, Span)>, cap: Option<(f64, Span)>, findings: &mut Findings) -> Option<Update> {
    let (tolerance, of_error) = tolerance?;
    if let Some((_, of_block)) = cap.filter(|(cap, _)| *cap < tolerance) {
        findings.report(
            Diagnostic::new(Code::E0407, "the settlement limit of a block is below its error limit")
                .label(of_error, "error limit of a block")
                .label(of_block, "settlement limit of a block")
                .help("make `cap` larger than `tolerance`, or leave it out"),
        );
        return None;
    }
    Some(Update::Adaptive { tolerance, cap: cap.map(|(cap, _)| cap) })
}

/// The settings for grains, from a complete `solve`.
pub fn grains(record: &Record, places: Option<&Places>, findings: &mut Findings) -> Option<Grains> {
    let window = window(record.get("window")?, places, findings);
    let optional = |field: &str| match record.get(field).map(|slot| &slot.value) {
        Some(Val::Number(_)) => Some(given(record, field)),
        Some(Val::Word { .. }) => Some(None),
        _ => None,
    };
    Some(Grains {
        tier: Given { value: tier(record), origin: record.get("substructure")?.origin },
        window: window?,
        monolithic: record.word("coupling")? == "monolithic",
        continuous: Given { value: record.word("passages")? == "continuous", origin: record.get("passages")?.origin },
        support_from_passage: record.word("support_from")? == "passage",
        sleepers_pitch: record.word("sleeper_pitch")? == "free",
        cell_bays: record.number("cell_bays")?.value as u32,
        check_cells: Given {
            value: record.number("check_cells")?.value as u32,
            origin: record.get("check_cells")?.origin,
        },
        step: optional("grain_step")?,
        soil_element: optional("soil_element")?,
        tolerance: given(record, "tolerance")?,
        budget: optional("budget")?,
        memory: optional("memory")?,
        both_rails: record.word("symmetry")? == "full",
        repeats: repeats(record, findings)?,
    })
}

/// A span at every transition; on a track without a transition, from its left end.
fn window(slot: &Slot, places: Option<&Places>, findings: &mut Findings) -> Option<Option<Vec<[f64; 2]>>> {
    let (a, b) = match &slot.value {
        Val::Range(a, b) => (*a, *b),
        Val::Word { .. } => return Some(None),
        _ => return None,
    };
    let places = places?;
    let names: Vec<Option<String>> = match places.transitions.as_slice() {
        [] => vec![None],
        several => several.iter().map(|t| Some(t.name.clone())).collect(),
    };
    let mut spans = Vec::new();
    for name in names {
        let mut place = |at: Number| places.chainage(at, name.as_deref().map(|n| (n, slot.span)), slot.span, findings);
        let (a, b) = (place(a)?, place(b)?);
        spans.push([a.min(b), a.max(b)]);
    }
    Some(Some(spans))
}

/// A number among the arguments of a word.
fn argument(record: &Record, field: &str, name: &str) -> Option<Given> {
    let Val::Word { arguments, .. } = &record.get(field)?.value else { return None };
    match arguments.get(name)? {
        Slot { value: Val::Number(n), origin, .. } => Some(Given { value: n.value, origin: *origin }),
        _ => None,
    }
}

fn integrator(record: &Record) -> Option<Integrator> {
    Some(match record.word("integrator")? {
        "hht" => Integrator::Hht { alpha: *argument(record, "integrator", "alpha")? },
        "newmark" => Integrator::Newmark,
        _ => Integrator::GeneralisedAlpha { rho: *argument(record, "integrator", "rho")? },
    })
}

fn time_step(record: &Record) -> Option<TimeStep> {
    if let Some(step) = given(record, "time_step") {
        return Some(TimeStep::Fixed(step));
    }
    Some(match record.word("time_step")? {
        "adaptive" => TimeStep::Adaptive { tolerance: argument(record, "time_step", "tolerance")? },
        _ => TimeStep::Auto,
    })
}
