//! Search by word over kinds, fields, the library, responses and codes.

use super::Topic;
use crate::check::{LIBRARY, library};
use crate::diag::Code;
use crate::scenario::response::Response;
use crate::schema::{Form, KINDS, Kind};

/// Topics with every word in their name, then topics with every word in their name or meaning, in the order of the
/// vocabulary.
pub(super) fn found(words: &str) -> Vec<Topic> {
    let words: Vec<String> = words.split_whitespace().map(plain).collect();
    if words.is_empty() {
        return Vec::new();
    }
    let (mut by_name, mut by_meaning) = (Vec::new(), Vec::new());
    for topic in all() {
        let (name, text) = (plain(&topic.name()), plain(&searched(&topic)));
        if words.iter().all(|word| name.contains(word)) {
            by_name.push(topic);
        } else if words.iter().all(|word| name.contains(word) || text.contains(word)) {
            by_meaning.push(topic);
        }
    }
    by_name.extend(by_meaning);
    by_name
}

/// Lower case, with blanks where names have underscores.
fn plain(text: &str) -> String {
    text.to_lowercase().replace('_', " ")
}

/// All topics.
fn all() -> Vec<Topic> {
    let kinds = KINDS.iter().map(Topic::Kind);
    let fields =
        KINDS.iter().flat_map(|kind: &'static Kind| kind.fields.iter().map(move |field| Topic::Field(kind, field)));
    let entries = library();
    let of_module = |module: &str| entries.iter().filter(|entry| entry.module == module).cloned().collect();
    let modules = LIBRARY.iter().map(|(module, _)| Topic::Module(module, of_module(module)));
    let responses = Response::ALL.iter().copied().map(Topic::Response);
    let codes = Code::ALL.iter().copied().map(Topic::Code);
    kinds
        .chain(fields)
        .chain(modules)
        .chain(entries.iter().cloned().map(Topic::Entry))
        .chain(responses)
        .chain(codes)
        .collect()
}

/// The text of a topic that is searched in addition to its name.
fn searched(topic: &Topic) -> String {
    match topic {
        Topic::Field(_, field) => format!("{} {}", field.doc, words(&field.form)),
        Topic::Entry(entry) => format!("{} {}", entry.doc, entry.source),
        // the texts of its entries lead to the entries
        Topic::Module(..) => String::new(),
        other => other.meaning(),
    }
}

/// The words of a form with their meanings.
fn words(form: &Form) -> String {
    form.words().into_iter().map(|word| format!("{} {} ", word.name, word.doc)).collect()
}
