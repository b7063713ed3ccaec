//! From the tree to the scenario: names, dimensions, fields, ranges, places.
//!
//! The check continues after every mistake: a value that could not be understood is marked and hides only values that
//! depend on it. The modules in the order of the flow, each of which uses the modules before it: `text` reads files,
//! `evaluate` makes typed records of their declarations, `places` finds places on the track, `parts` makes the parts of
//! the scenario, `ask` reads the questions about them. `scene` runs these steps once, and `resolve` writes the scene as
//! text.

mod ask;
mod evaluate;
mod findings;
mod parts;
mod places;
mod reads;
mod resolve;
mod scene;
mod stated;
mod survey;
mod text;

pub use reads::{ALWAYS_READ, readers};
pub use resolve::resolve;
pub use stated::Stated;
pub use survey::{Content, Files, Held, Object, Survey, survey, surveyed_names};
pub use text::library::{Entry, MODULES as LIBRARY, library};
pub use text::measured::{MeasuredCurve, measured_curve};
pub use text::modules::{
    DataError, Folder, LARGEST_DATA_FILE, Modules, NoModules, Parsed, Remembered, read_all, read_bounded,
};
pub use text::overrides::{EDIT, Override};
pub use text::scope::{ItemId, Scope, ScopeId};

use crate::diag::{self, Code, Diagnostic, Severity, Sources, Span};
use crate::scenario::{Scenario, Study};
use crate::syntax::limits;
use evaluate::evaluator::Evaluator;
use text::library::Part;
use text::loader::{load, seeming_texts};

/// The result of a check: every diagnostic, and the scene.
#[derive(Debug)]
pub struct Checked {
    pub sources: Sources,
    pub diagnostics: Vec<Diagnostic>,
    /// `None` for a library, and if a mistake or a hole leaves a part unknown. A scene beside errors is used to find
    /// more errors; it must not be run.
    pub scenario: Option<Scenario>,
    /// The studies of the main file that have no mistake.
    pub studies: Vec<Study>,
    /// Fields that the user's own texts state for the objects of the scene, in the order of the texts.
    pub stated: Vec<Stated>,
    /// Whether the scene can be run.
    pub sound: bool,
}

/// Checks a text; `name` is the name that messages show.
pub fn check(name: &str, text: &str, modules: &dyn Modules, overrides: &[Override]) -> Checked {
    with_evaluator(name, text, modules, overrides, |_| ()).0
}

/// Checks a text, and passes the result to a function.
///
/// Only entries of the library that the user's texts name are read. After a mistake the whole library is read, because
/// it may hold the entry that was meant.
fn with_evaluator<T>(
    name: &str,
    text: &str,
    modules: &dyn Modules,
    overrides: &[Override],
    ask: impl Fn(&mut Evaluator<'_>) -> T,
) -> (Checked, T) {
    let texts = seeming_texts(text, modules);
    let edits = overrides.iter().map(|edit| edit.value.as_str());
    let part = Part::named_in(texts.iter().map(|text| text.as_ref()).chain(edits));
    if let Part::Named(_) = part {
        let found = evaluated(Evaluator::new(load(name, text, overrides, part, modules)), &ask);
        if found.0.sound {
            return found;
        }
    }
    evaluated(Evaluator::new(load(name, text, overrides, Part::Whole, modules)), &ask)
}

/// Keeps the first errors and the first warnings if there are very many, and counts the rest in one more diagnostic.
fn bound(diagnostics: &mut Vec<Diagnostic>) {
    let (mut errors, mut warnings) = (0_usize, 0_usize);
    let mut last = None;
    diagnostics.retain(|diagnostic| {
        let count = if diagnostic.is_error() { &mut errors } else { &mut warnings };
        *count += 1;
        let is_kept = *count <= limits::DIAGNOSTICS;
        if is_kept {
            last = diagnostic.labels.first().map(|label| label.span).or(last);
        }
        is_kept
    });
    let more = |count: usize| count.saturating_sub(limits::DIAGNOSTICS);
    let said = match (more(errors), more(warnings)) {
        (0, 0) => return,
        (errors, 0) => format!("{errors} more errors are not shown"),
        (0, warnings) => format!("{warnings} more warnings are not shown"),
        (errors, warnings) => format!("{errors} more errors and {warnings} more warnings are not shown"),
    };
    let severity = if more(errors) > 0 { Severity::Error } else { Severity::Warning };
    let rest = Diagnostic::new(Code::E0103, said)
        .severity(severity)
        .help("correct the mistakes that are shown, then check again");
    diagnostics.push(match last {
        Some(span) => rest.label(Span { start: span.end, ..span }, "the last one shown"),
        None => rest,
    });
}

/// An unknown name is reported once, with every place that uses it. A stretch that does not fit its place is reported
/// once, at the first of its transitions. Expects diagnostics in order.
fn one_cause_once(diagnostics: &mut Vec<Diagnostic>) {
    for mistake in std::mem::take(diagnostics) {
        let place = |d: &Diagnostic| d.labels.first().map(|label| label.span);
        let same = |d: &&mut Diagnostic| match mistake.code {
            Code::E0201 => d.code == mistake.code && d.message == mistake.message && d.help == mistake.help,
            Code::E0418 | Code::E0426 => d.code == mistake.code && place(d) == place(&mistake),
            _ => false,
        };
        match diagnostics.iter_mut().find(same) {
            Some(first) if mistake.code == Code::E0201 => {
                first.labels.extend(mistake.labels);
                // one edit corrects every place
                for (fix, other) in first.fixes.iter_mut().zip(mistake.fixes) {
                    fix.edits.extend(other.edits);
                }
            }
            Some(_) => {}
            None => diagnostics.push(mistake),
        }
    }
}

fn evaluated<T>(mut eval: Evaluator<'_>, ask: &impl Fn(&mut Evaluator<'_>) -> T) -> (Checked, T) {
    let (scenario, studies) = scene::scene(&mut eval);
    let stated = stated::stated(&eval);
    let known = eval.findings.diagnostics.len();
    let answer = ask(&mut eval);
    eval.findings.diagnostics.truncate(known);
    eval.drop_superseded();
    let mut diagnostics = eval.findings.diagnostics;
    diag::sort(&mut diagnostics);
    bound(&mut diagnostics);
    one_cause_once(&mut diagnostics);
    let sound = !diagnostics.iter().any(|d| d.is_error() || d.code == Code::E0410);
    (Checked { sources: eval.files.sources, diagnostics, scenario, studies, stated, sound }, answer)
}
