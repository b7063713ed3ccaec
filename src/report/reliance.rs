//! Warnings, assumptions and confidence on the first page, so that a reader sees them before using a number.

use super::prose::prose;
use super::svg::escape;
use crate::results::Reliance;
use std::fmt::Write;

/// Writes the section; nothing if it is empty.
pub fn reliance(html: &mut String, reliance: &Reliance) {
    if *reliance == Reliance::default() {
        return;
    }
    *html += "<section id=\"reliance\"><h2>Before these numbers are used</h2><dl class=\"reliance\">";
    group(html, "Confidence", reliance.confidence.iter().map(|told| prose(told)));
    let warned = reliance.warnings.iter().map(|warned| {
        let place = if warned.place.is_empty() { String::new() } else { format!(", {}", warned.place) };
        format!("{} <small>({}{})</small>", prose(&warned.message), warned.code, escape(&place))
    });
    group(html, "Warnings", warned);
    let silenced = reliance.silenced.iter().map(|silenced| {
        format!(
            "{}: <q>{}</q> <small>({})</small>",
            escape(&silenced.title),
            prose(&silenced.reason),
            escape(&silenced.rule)
        )
    });
    group(html, "Silenced", silenced);
    group(html, "Assumed", reliance.assumptions.iter().map(|told| prose(told)));
    let names = reliance
        .unchecked
        .iter()
        .map(|entry| format!("<span title=\"{}\"><code>{}</code></span>", escape(&entry.source), escape(&entry.name)));
    let names: Vec<String> = names.collect();
    let unchecked = (!names.is_empty())
        .then(|| format!("{} of the library: data not checked against the source", names.join(", ")));
    group(html, "Unchecked", unchecked.into_iter());
    *html += "</dl></section>\n";
}

/// A group of sentences, already HTML; nothing if there is none.
fn group(html: &mut String, name: &str, sentences: impl Iterator<Item = String>) {
    let items: Vec<String> = sentences.map(|sentence| format!("<li>{}</li>", capitalised(&sentence))).collect();
    if !items.is_empty() {
        let _ = write!(html, "<dt>{name}</dt><dd><ul>{}</ul></dd>", items.concat());
    }
}

/// A sentence with a capital and a full stop.
fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map_or(String::new(), |letter| letter.to_uppercase().collect());
    let stop = if sentence.ends_with(['.', '>']) { "" } else { "." };
    format!("{first}{}{stop}", letters.as_str())
}
