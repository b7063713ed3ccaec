//! What must hold of any text.

use std::cell::RefCell;
use trackbed::check::{NoModules, Remembered};
use trackbed::diag::{Diagnostic, FileId, Sources};
use trackbed::{compile, syntax};

/// Parsing ends, and its diagnostics stand inside the text.
pub fn parse(text: &str) {
    let (_, diagnostics) = syntax::parse(FileId(0), text);
    for diagnostic in &diagnostics {
        for label in &diagnostic.labels {
            let (start, end) = (label.span.start as usize, label.span.end as usize);
            assert!(start <= end && end <= text.len(), "{}: {start}..{end}", diagnostic.message);
            assert!(
                text.is_char_boundary(start) && text.is_char_boundary(end),
                "{}: inside a letter",
                diagnostic.message
            );
        }
    }
}

/// What is formatted once stays as it is, and still parses.
pub fn format(text: &str) {
    let Ok(once) = syntax::format(text) else { return };
    assert_eq!(syntax::format(&once).as_deref(), Ok(once.as_str()), "formatting twice differs");
    assert_eq!(syntax::parse(FileId(0), &once).1, [], "formatted text does not parse");
}

/// Checks between which the texts that are remembered are forgotten: the standard library stays for a while, and memory
/// is kept.
const MEMORY: u32 = 1000;

thread_local! {
    static KNOWN: RefCell<(u32, Remembered<NoModules>)> = RefCell::new((0, Remembered::new(NoModules)));
}

/// Of so many texts that a thread checks, it checks the first one twice. A single run is always checked twice.
const ONCE_AGAIN: u32 = 8;

/// Checking and planning end, the second time with the same diagnostics, whose spans stand in their files.
pub fn check(text: &str) {
    KNOWN.with_borrow_mut(|(runs, known)| {
        check_with(text, known, runs.is_multiple_of(ONCE_AGAIN));
        *runs += 1;
        if runs.is_multiple_of(MEMORY) {
            *known = Remembered::new(NoModules);
        }
    });
}

fn check_with(text: &str, known: &Remembered<NoModules>, twice: bool) {
    let compiled = compile("fuzz.track", text, known, &[]);
    compiled.diagnostics.iter().for_each(|d| inside(d, &compiled.sources));
    if compiled.graph.is_some() {
        let errors: Vec<&str> =
            compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.message.as_str()).collect();
        assert!(compiled.scenario.is_some(), "a plan without a scene beside {errors:?}");
    }
    if !twice {
        return;
    }
    let again = compile("fuzz.track", text, known, &[]);
    assert_eq!(format!("{:?}", compiled.diagnostics), format!("{:?}", again.diagnostics), "checking twice differs");
}

fn inside(diagnostic: &Diagnostic, sources: &Sources) {
    for label in &diagnostic.labels {
        let text = &sources.get(label.span.file).text;
        assert!((label.span.end as usize) <= text.len(), "{} ends beyond its file", diagnostic.message);
    }
}
