//! The whole language on one Markdown page: every kind and field, the standard library with its sources, every code.

use crate::check::library;
use crate::diag::Code;
use crate::scenario::response::Response;
use crate::schema::{COMMON, KINDS, PLANNED_KINDS, RANDOM, Role, section};

/// `docs/reference.md`.
pub fn reference() -> String {
    let parts = [head(), kinds(), profiles(), responses(), standard_library(), codes()];
    parts.join("\n")
}

fn head() -> String {
    "# Reference\n\nWritten by `trackbed docs --format markdown > docs/reference.md`, from the tables that the checker reads. \
     [The language](language.md) says how it fits together.\n\n[Declarations](#declarations), [values inside \
     them](#values-inside-them), [random values](#random-values), [responses](#responses), [standard \
     library](#standard-library), [codes](#codes).\n"
        .into()
}

fn kinds() -> String {
    let of = |nested: bool| {
        let kinds = KINDS.iter().filter(move |kind| (kind.role == Role::Nested) == nested);
        kinds.map(section).collect::<Vec<_>>().join("\n")
    };
    let common: Vec<String> = COMMON.iter().map(|f| format!("`{}` ({})", f.name, f.doc)).collect();
    format!(
        "## Declarations\n\nEvery kind also has {}. A value that may vary along the track takes a profile. Starred bases are \
         assumed. Not in this version: {}.\n\n{}\n## Values inside them\n\n{}",
        common.join(" and "),
        PLANNED_KINDS.join(", "),
        of(false),
        of(true)
    )
}

fn profiles() -> String {
    let arguments = RANDOM.arguments.iter().map(|argument| format!("| `{}` | {} |\n", argument.name, argument.doc));
    format!(
        "## Random values\n\n`random(mean, ...)` is a value {}.\n\n| argument | meaning |\n|---|---|\n{}",
        RANDOM.doc,
        arguments.collect::<String>()
    )
}

fn responses() -> String {
    let rows = Response::ALL.iter().map(|r| format!("| `{}` | {} | {} |\n", r.name(), r.doc(), r.unit()));
    format!("## Responses\n\n| response | meaning | unit of its tables |\n|---|---|---|\n{}", rows.collect::<String>())
}

fn standard_library() -> String {
    let cell = |text: &str| text.replace('|', "\\|");
    let rows = library().into_iter().map(|entry| {
        format!(
            "| `{}.{}` | {} | {} | {} | {} |\n",
            entry.module,
            entry.name,
            entry.kind,
            cell(&entry.doc),
            entry.evidence,
            cell(&entry.source)
        )
    });
    format!(
        "## Standard library\n\n`use std` brings in every module. `read` is taken over from its source, `derived` computed from \
         other data, `unchecked` common knowledge: `scenario {{ warn = [unchecked_values] }}` names those that a scene uses, \
         `trackbed resolve` writes out their values.\n\n| entry | kind | | evidence | source |\n|---|---|---|---|---|\n{}",
        rows.collect::<String>()
    )
}

fn codes() -> String {
    let rows = Code::ALL.iter().map(|code| {
        let rule = code.rule().map_or(String::new(), |rule| format!("`{rule}`"));
        format!("| [{code}](../explain/{code}.md) | {} | {} | {rule} |\n", code.severity().as_str(), code.title())
    });
    format!(
        "## Codes\n\n`trackbed explain CODE` says more. The names in the last column stand in `allow`, `deny` and `warn` of a \
         `scenario`.\n\n| code | weight | what is wrong | rule |\n|---|---|---|---|\n{}",
        rows.collect::<String>()
    )
}
