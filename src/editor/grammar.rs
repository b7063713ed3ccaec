//! The vocabulary as a TextMate grammar, for editors that colour by patterns before the language server starts, or
//! without it.

use crate::scenario::response::Response;
use crate::schema::{COMMON, Field, KINDS, RANDOM, Role, Word};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// The grammar as a file for editors.
pub fn textmate() -> String {
    format!("{:#}\n", grammar())
}

fn grammar() -> Value {
    let kinds = KINDS.iter().filter(|kind| kind.role != Role::Nested).map(|kind| kind.name);
    let (mut fields, mut words) = (BTreeSet::new(), BTreeSet::new());
    for field in KINDS.iter().flat_map(|kind| kind.fields).chain(COMMON).chain(RANDOM.arguments) {
        collect(field, &mut fields, &mut words);
    }
    words.extend(["auto", "none", "yes", "no", "rest", "all"]);
    let functions = ["ramp", "smooth", "random", "file", "sqrt", "abs", "min", "max", "mean", "rms", "percentile"];
    let functions = functions.into_iter().chain(["place_of_max", "misfit", "steps", "uniform", "normal", "log_normal"]);
    let responses = Response::ALL.iter().map(|response| response.name());
    let header = format!("^\\s*({})\\b(?:[ \\t]+([A-Za-z]\\w*))?(?=\\s*[:{{])", either(kinds));
    let number = "\\d[\\d_]*(?:\\.\\d+)?(?:[eE][+-]?\\d+)?";
    let factor = "(?!(?:use|let|as|per|to)\\b)[A-Za-zµ%‰°]+(?:\\^-?[\\d.]+|[²³])?";
    json!({
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "Trackbed",
        "scopeName": "source.track",
        "fileTypes": ["track"],
        "patterns": [
            { "name": "comment.line.documentation.track", "match": "///.*$" },
            { "name": "comment.line.double-slash.track", "match": "//.*$" },
            {
                "name": "string.quoted.double.track",
                "begin": "\"",
                "end": "\"|$",
                "patterns": [{ "name": "constant.character.escape.track", "match": "\\\\[\"\\\\]" }],
            },
            {
                "match": header,
                "captures": {
                    "1": { "name": "storage.type.track" },
                    "2": { "name": "entity.name.type.track" },
                },
            },
            {
                "match": "^\\s*(let)[ \\t]+([A-Za-z]\\w*)",
                "captures": {
                    "1": { "name": "keyword.other.track" },
                    "2": { "name": "variable.other.constant.track" },
                },
            },
            { "name": "keyword.other.track", "match": "\\b(?:use|let|as|per)\\b" },
            {
                "match": format!("({number})(?:[ \\t]*({factor}(?:[ \\t·/*]{factor})*))?"),
                "captures": {
                    "1": { "name": "constant.numeric.track" },
                    "2": { "name": "keyword.other.unit.track" },
                },
            },
            { "name": "variable.other.property.track", "match": format!("\\b(?:{})\\b(?=\\s*[=.])", either(fields)) },
            { "name": "entity.name.function.track", "match": format!("\\b(?:{})\\b(?=\\()", either(functions)) },
            { "name": "constant.language.track", "match": format!("\\b(?:{})\\b(?!\\s*[=.:])", either(words)) },
            { "name": "support.function.track", "match": format!("\\b(?:{})\\b", either(responses)) },
            { "name": "keyword.operator.track", "match": "\\.\\.|<=|>=|[=<>+\\-*/^?:]" },
            { "name": "punctuation.separator.track", "match": "," },
        ],
    })
}

/// Collects the names of a field, of its words and of their arguments.
fn collect(field: &'static Field, fields: &mut BTreeSet<&'static str>, words: &mut BTreeSet<&'static str>) {
    fields.insert(field.name);
    for word in field.form.words() {
        let Word { name, arguments, planned, .. } = word;
        if !planned {
            words.insert(name);
        }
        arguments.iter().for_each(|argument| collect(argument, fields, words));
    }
}

/// `a|b` with longer names first, so that a name does not hide a longer one.
fn either(names: impl IntoIterator<Item = &'static str>) -> String {
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_by_key(|name| (std::cmp::Reverse(name.len()), *name));
    names.dedup();
    names.join("|")
}
