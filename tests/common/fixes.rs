//! Applies the edits that diagnostics carry, and says which of them leave the mistake where it was.

use trackbed::Compiled;
use trackbed::diag::{Diagnostic, FileId};

/// What is wrong with the edits of the diagnostics of a text; `again` compiles another text in the same way.
pub fn useless(text: &str, compiled: &Compiled, again: impl Fn(&str) -> Compiled) -> Vec<String> {
    let same = |one: &Diagnostic, other: &Diagnostic| one.code == other.code && one.message == other.message;
    let count = |all: &[Diagnostic], one: &Diagnostic| all.iter().filter(|other| same(one, other)).count();
    let mut wrong = Vec::new();
    for mistake in &compiled.diagnostics {
        for fix in mistake.fixes.iter().filter(|fix| fix.edits.iter().all(|edit| edit.span.file == FileId(0))) {
            let mended = fix.applied(FileId(0), text);
            let left = again(&mended);
            // one mistake may stand for several of its line: the edit mends the first, and the next one is told then
            let end = fix.edits.iter().map(|edit| edit.span.start as usize + edit.text.len()).max().unwrap_or(0);
            let is_next = |other: &&Diagnostic| other.labels.first().is_some_and(|l| l.span.start as usize >= end);
            let mut same_left = left.diagnostics.iter().filter(|other| same(mistake, other));
            let has_moved_on = fix.edits.len() == 1 && same_left.all(|other| is_next(&other));
            if !has_moved_on && count(&left.diagnostics, mistake) >= count(&compiled.diagnostics, mistake) {
                let (code, message) = (mistake.code, &mistake.message);
                wrong.push(format!("{code}: {message}\n  `{}` leaves it:\n{mended}", fix.title));
            }
        }
    }
    wrong
}

/// Whether the words of a diagnostic offer a text to be written, and not only its form.
pub fn offers_a_text(mistake: &Diagnostic) -> bool {
    let help = mistake.help.as_deref().unwrap_or_default();
    if ["`{ field = value }`", "`[key: value]`"].iter().any(|form| help.contains(form)) {
        return false;
    }
    ["write `", "did you mean `"].iter().any(|offer| help.contains(offer)) && !help.contains("...")
}
