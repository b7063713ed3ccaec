//! Topics as text for a terminal.

use super::Topic;
use crate::check::{Entry, library};
use crate::schema;

/// Everything about a topic.
pub(super) fn page(topic: &Topic) -> String {
    match topic {
        Topic::Kind(kind) => schema::page(kind),
        Topic::Field(kind, field) => schema::field_page(kind, field),
        Topic::Module(module, entries) => {
            format!("{module}: {}\n\n{}", topic.meaning(), lines(entries.iter().map(line)))
        }
        Topic::Entry(entry) => entry_page(entry),
        Topic::Response(response) => {
            let (name, doc, unit) = (response.name(), response.doc(), super::unit(response));
            format!("{name}: a response, {unit}\n\n  {doc}\n\nUse it in `expect`, `study` and `record`.\n")
        }
        Topic::Code(code) => code.page().to_string(),
    }
}

/// An entry with its numbers, its source and what it extends.
fn entry_page(entry: &Entry) -> String {
    let mut out = format!("{}.{}, a `{}`\n\n{}\n\n", entry.module, entry.name, entry.kind, entry.doc);
    if let Some(base) = &entry.base {
        out.push_str(&format!("  as `{}.{base}`, but\n", entry.module));
    }
    out.push_str(&values(entry));
    if let Some(base) = base_of(entry) {
        out.push_str(&format!("\n`{}.{}`\n\n{}", base.module, base.name, values(&base)));
    }
    out.push_str(&format!("\nevidence: {}\nsource: {}\n", entry.evidence, entry.source));
    out.push_str(&format!(
        "\nwrite: use std\n       ... = {0}.{1}\n       ... = {0}.{1} {{ FIELD = VALUE }}\n",
        entry.module, entry.name
    ));
    out
}

/// The entry that this entry extends.
fn base_of(entry: &Entry) -> Option<Entry> {
    let base = entry.base.as_deref()?;
    library().into_iter().find(|other| other.module == entry.module && other.name == base)
}

fn values(entry: &Entry) -> String {
    let width = entry.fields.iter().map(|(path, _)| path.len()).max().unwrap_or(0);
    entry.fields.iter().map(|(path, value)| format!("  {path:<width$} = {value}\n")).collect()
}

/// The name and the meaning of an entry.
fn line(entry: &Entry) -> (String, String) {
    (format!("{}.{}", entry.module, entry.name), entry.doc.clone())
}

/// One line per topic, under a heading for each kind of topic.
pub(super) fn listing(topics: &[Topic]) -> String {
    let headings =
        ["Kinds", "Fields", "Modules of the standard library", "Entries of the standard library", "Responses", "Codes"];
    let sections = headings.iter().enumerate().filter_map(|(sort, heading)| {
        let mut rows = topics.iter().filter(|topic| sort_of(topic) == sort).peekable();
        rows.peek()?;
        Some(format!("{heading}\n\n{}", lines(rows.map(|topic| (topic.name(), topic.meaning())))))
    });
    sections.collect::<Vec<_>>().join("\n")
}

/// The index of the heading of a topic.
fn sort_of(topic: &Topic) -> usize {
    match topic {
        Topic::Kind(_) => 0,
        Topic::Field(..) => 1,
        Topic::Module(..) => 2,
        Topic::Entry(_) => 3,
        Topic::Response(_) => 4,
        Topic::Code(_) => 5,
    }
}

fn lines(rows: impl Iterator<Item = (String, String)>) -> String {
    let rows: Vec<(String, String)> = rows.collect();
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    rows.iter().map(|(name, meaning)| format!("  {name:<width$}  {meaning}\n")).collect()
}
