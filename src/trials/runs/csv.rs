//! The table of a chart of runs: one row a run, shares as numbers, times in seconds.

use super::chart::{Ended, RunChart};
use super::errors::RunErrors;

/// One row a run.
pub fn runs_csv(chart: &RunChart) -> String {
    let errors = RunErrors::ALL.map(|(key, _, _)| format!("{key}_error"));
    let mut out =
        format!("name,group,edits,outcome,estimated_s,seconds,build_s,{},efficient,reason\n", errors.join(","));
    for row in &chart.rows {
        let edits: Vec<String> = row.variant.edits.iter().map(|edit| format!("{}={}", edit.path, edit.value)).collect();
        let (outcome, reason) = match &row.ended {
            Ended::Done(_) => ("done", ""),
            Ended::LeftOut => ("left_out", ""),
            Ended::Stopped { .. } => ("stopped", "a solver has stopped it"),
            Ended::Refused { reason } => ("refused", reason.as_str()),
        };
        let short = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
        let done = row.done();
        let numbers = [short(row.estimated_s), short(row.seconds()), short(done.map(|done| done.took.build_s))];
        let errors = RunErrors::ALL.map(|(_, _, read)| short(done.and_then(|done| read(&done.errors))));
        let efficient = done.map_or("", |done| if done.efficient { "yes" } else { "no" });
        let fields = [
            vec![quoted(&row.variant.name), row.variant.group.name().to_owned(), quoted(&edits.join("; "))],
            vec![outcome.to_owned()],
            numbers.to_vec(),
            errors.to_vec(),
            vec![efficient.to_owned(), quoted(reason)],
        ];
        out.push_str(&fields.concat().join(","));
        out.push('\n');
    }
    out
}

/// A field of text, in quotes where it needs them.
fn quoted(text: &str) -> String {
    let needs = text.contains([',', '"', '\n']);
    if needs { format!("\"{}\"", text.replace('"', "\"\"").replace('\n', " ")) } else { text.to_owned() }
}
