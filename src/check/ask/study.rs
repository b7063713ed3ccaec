//! Studies: `minimise = max(settlement)`, and checks within one study. `vary` reads the values that vary.

use super::reader::{Counting, Questions, questions};
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::parts::repeats::repeats;
use crate::check::text::scope::Scope;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Axis, Goal, Objective, Sampling, Study, Values};

/// Points of one study.
const MOST_POINTS: usize = 100_000;
/// Axes of a Sobol sequence: as many as it has direction numbers.
const MOST_SOBOL_AXES: usize = 21;

/// Every study of the main file that has no mistake.
pub fn studies(eval: &mut Evaluator<'_>, counting: Counting<'_>) -> Vec<Study> {
    let records = eval.all("study");
    let asked = questions(&records, eval, counting);
    records.iter().zip(&asked).filter_map(|(record, asked)| study(record, asked, eval)).collect()
}

fn study(record: &Record, asked: &Questions, eval: &mut Evaluator<'_>) -> Option<Study> {
    let goals = [(Goal::Minimise, "minimise"), (Goal::Maximise, "maximise")];
    let findings = &mut eval.findings;
    if !record.partial && !goals.iter().any(|(_, name)| record.get(name).is_some()) && record.get("report").is_none() {
        findings.report(
            Diagnostic::new(Code::E0403, format!("study `{}` has no objective and no report", record.name))
                .label(record.span, "needs `minimise`, `maximise` or `report`")
                .help("write something like `minimise = differential_settlement`"),
        );
    }
    let axes = asked.axes()?;
    let set = if record.get("set").is_some() { asked.settings()? } else { Vec::new() };
    let sampling = sampling(record)?;
    let repeats = repeats(record, findings)?;
    let own = axes.iter().map(|a| (&a.path, a.span)).chain(set.iter().map(|s| (&s.path, s.span)));
    let own: Vec<(String, Span)> = own.map(|(path, span)| (path.clone(), span)).collect();
    let apart = varied_once(&own, findings) & of_this_file(&own, &eval.scopes[eval.main], findings);
    if !sampled(sampling, &axes, record, findings) || !apart {
        return None;
    }
    let objectives = goals.iter().flat_map(|(goal, name)| asked.measured(name).map(|of| Objective { goal: *goal, of }));
    let budget = record.number("budget").map(|b| b.value).zip(record.get("budget").map(|slot| slot.span));
    Some(Study {
        name: record.name.clone(),
        span: record.span,
        axes,
        sampling,
        set,
        repeats,
        tolerance: record.number("tolerance")?.value,
        budget,
        objectives: objectives.collect(),
        report: asked.measured("report").collect(),
        constraints: asked.comparisons("subject_to").collect(),
    })
}

/// Checks that no value varies twice, and that no varied value lies inside another.
fn varied_once(paths: &[(String, Span)], findings: &mut Findings) -> bool {
    let inside = |a: &str, b: &str| a == b || b.strip_prefix(a).is_some_and(|rest| rest.starts_with('.'));
    let mut once = true;
    for (i, (later, span)) in paths.iter().enumerate() {
        let Some((first, place)) = paths[..i].iter().find(|(p, _)| inside(p, later) || inside(later, p)) else {
            continue;
        };
        once = false;
        let message = if first == later {
            format!("`{later}` is varied twice")
        } else {
            format!("`{first}` and `{later}` overlap")
        };
        findings.report(
            Diagnostic::new(Code::E0707, message)
                .label(*span, "again here")
                .label(*place, "first here")
                .help("keep one of the two; values that belong together vary as entries of one list"),
        );
    }
    once
}

/// A study from a module varies declarations of this file.
fn of_this_file(paths: &[(String, Span)], main: &Scope, findings: &mut Findings) -> bool {
    let mut known = true;
    for (path, span) in paths {
        let first = path.split('.').next().unwrap_or(path);
        if !main.names.contains_key(first) {
            known = false;
            findings.report(
                Diagnostic::new(Code::E0704, format!("this file declares nothing called `{first}` to vary"))
                    .label(*span, "varied here")
                    .help(format!("declare `{first}` in the main file; it may extend an entry of a module")),
            );
        }
    }
    known
}

fn sampled(sampling: Sampling, axes: &[Axis], record: &Record, findings: &mut Findings) -> bool {
    let place = record.get("sampling").map_or(record.span, |slot| slot.span);
    let mistake = match sampling {
        Sampling::Grid => {
            let spread = axes.iter().find(|a| matches!(a.values, Values::Spread(_)));
            let points = axes.iter().fold(1_usize, |n, a| n.saturating_mul(levels(a)));
            match spread {
                Some(axis) => Diagnostic::new(
                    Code::E0706,
                    format!("a grid needs lists or steps, and `{}` has neither", axis.path),
                )
                .label(axis.span, "a continuous range")
                .help("write `steps(a .. b, count = 5)`, or `sampling = sobol(32)`"),
                None if points > MOST_POINTS => {
                    Diagnostic::new(Code::E0706, format!("the grid has more than {MOST_POINTS} points"))
                        .label(record.span, "too many combinations")
                        .help("write `sampling = sobol(64)`, which spreads 64 points over all of them")
                }
                None => return true,
            }
        }
        Sampling::Sobol { .. } if axes.len() > MOST_SOBOL_AXES => Diagnostic::new(
            Code::E0706,
            format!("`sobol` can vary at most {MOST_SOBOL_AXES} values, found {}", axes.len()),
        )
        .label(place, "too many values vary")
        .help("write `latin_hypercube`"),
        _ => return true,
    };
    findings.report(mistake);
    false
}

fn levels(axis: &Axis) -> usize {
    match &axis.values {
        Values::Listed(choices) => choices.len(),
        Values::Spread(_) => 1,
    }
}

fn sampling(record: &Record) -> Option<Sampling> {
    let Some(Val::Word { word, arguments }) = record.get("sampling").map(|slot| &slot.value) else { return None };
    let points = || match arguments.get("points")?.value {
        Val::Number(n) => Some(n.value as u32),
        _ => None,
    };
    match word.name {
        "sobol" => Some(Sampling::Sobol { points: points()? }),
        "latin_hypercube" => Some(Sampling::LatinHypercube { points: points()? }),
        _ => Some(Sampling::Grid),
    }
}
