//! From the tree to the scenario: names, dimensions, fields, ranges, places.
//!
//! Everything is checked, whatever else is wrong: a value that could not be understood is marked and hides only what
//! depends on it. The rooms in the order of the flow, each of which uses those before it: `text` reads files, `evaluate` makes
//! typed records of their declarations, `places` says where on the track something lies, `parts` makes the parts of the scenario,
//! `ask` reads what is asked of them; `scene` goes through all of it once, and `resolve` writes it out again.

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
pub use text::modules::{DataError, Folder, LARGEST_DATA_FILE, Modules, NoModules, Parsed, Remembered, read_all, read_bounded};
pub use text::overrides::{EDIT, Override};
pub use text::scope::{ItemId, Scope, ScopeId};

use crate::diag::{self, Code, Diagnostic, Severity, Sources, Span};
use crate::scenario::{Scenario, Study};
use crate::syntax::limits;
use evaluate::evaluator::Evaluator;
use text::library::Part;
use text::loader::{load, seeming_texts};

/// What became of a file: every diagnostic, and the scene where nothing stands against it.
#[derive(Debug)]
pub struct Checked {
    pub sources: Sources,
    pub diagnostics: Vec<Diagnostic>,
    /// `None` for a library, and where a mistake or a hole leaves a part unknown. Beside errors it serves to find more of
    /// them; it is not to be run.
    pub scenario: Option<Scenario>,
    /// The studies of the main file; those without a mistake.
    pub studies: Vec<Study>,
    /// What the user's own texts state of the objects that take part, in the order of the texts.
    pub stated: Vec<Stated>,
    /// Whether nothing stands against a run.
    pub sound: bool,
}

/// Checks a text that a person calls `name`.
pub fn check(name: &str, text: &str, modules: &dyn Modules, overrides: &[Override]) -> Checked {
    with_evaluator(name, text, modules, overrides, |_| ()).0
}

/// Checks a text, and asks something of what was found out about it.
///
/// Only what the user's texts name is read of the library. Where anything is amiss the whole of it is: what was meant may stand
/// there.
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

/// Leaves the first of very many errors and of very many warnings, and counts the rest in one more.
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
    let rest =
        Diagnostic::new(Code::E0103, said).severity(severity).help("mend those that are shown, then check again");
    diagnostics.push(match last {
        Some(span) => rest.label(Span { start: span.end, ..span }, "the last one that is shown"),
        None => rest,
    });
}

/// A name that is not known is told once, with every place that asks for it; so is a stretch that its place does not bear, at the
/// first of its transitions. Takes them in order.
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
                // one edit mends every place
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
