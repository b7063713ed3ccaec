//! Rendering.
use super::{Diagnostic, Sources};
pub fn human(d: &[Diagnostic], s: &Sources, _: bool, _: usize) -> String {
    d.iter()
        .map(|d| {
            let l: Vec<String> = d
                .labels
                .iter()
                .map(|l| {
                    let p = s.position(l.span.file, l.span.start);
                    format!("{}:{}:{} {:?} -- {}", s.get(l.span.file).name, p.line, p.column, s.text(l.span), l.text)
                })
                .collect();
            format!("{} {} {}\n   {}\n   help: {:?}\n", d.severity.as_str(), d.code, d.message, l.join("\n   "), d.help)
        })
        .collect()
}
pub fn json(_: &[Diagnostic], _: &Sources) -> serde_json::Value {
    serde_json::Value::Null
}
