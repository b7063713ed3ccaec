//! Reports fields without effect: compares the fields that the user's texts state with the fields that the parts of the
//! program read.
//!
//! A part of the scene (a rail, a granular material, a vehicle) is a data sheet that other plans of the same file read.
//! Its fields are reported only if an edit changes them, or if no plan of this version reads them.

use crate::check::Stated;
use crate::diag::{Code, Diagnostic, Edit, Fix, Sources, Span, and_list};
use crate::schema::{self, Field, Need, Reader, Role};

/// Why a field does nothing.
#[derive(PartialEq)]
enum Why {
    /// No run of this version reads it.
    Unread,
    /// It acts in other plans.
    ActsWhere(Vec<&'static str>),
}

/// One warning for each reason, with all its fields. Without readers only fields that no part reads are reported.
pub(super) fn told(stated: &[Stated], readers: &[Reader], sources: &Sources) -> Vec<Diagnostic> {
    let mut reasons: Vec<(Why, Vec<Stated>)> = Vec::new();
    for one in stated {
        let Some(why) = why(one, readers) else { continue };
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, fields)) => fields.push(*one),
            None => reasons.push((why, vec![*one])),
        }
    }
    let with_fix = |(why, fields): (Why, Vec<Stated>)| {
        let edits: Option<Vec<Edit>> = fields.iter().map(|field| without(field, sources)).collect();
        let fix = edits.map(|edits| Fix { title: "take it out".into(), edits });
        warning(&why, &fields).maybe_fix(fix)
    };
    reasons.into_iter().map(with_fix).collect()
}

/// The reason why a field has no effect in the plan of these readers; `None` if it has an effect, or if it is not
/// reported.
fn why(stated: &Stated, readers: &[Reader]) -> Option<Why> {
    let kind = schema::kind(stated.kind)?;
    let field: &Field = kind.field(stated.field)?;
    if field.unread {
        // a required field is not the writer's choice
        return (field.need != Need::Required || stated.edited).then_some(Why::Unread);
    }
    if matches!(kind.role, Role::Part | Role::Nested) && !stated.edited {
        return None;
    }
    let path = stated.path();
    let mut acts_where: Vec<&'static str> = Vec::new();
    for reader in readers.iter().filter(|reader| reader.reads.has(&path)) {
        if reader.acted {
            return None;
        }
        if !acts_where.contains(&reader.reads.acts_where) {
            acts_where.push(reader.reads.acts_where);
        }
    }
    // fields that no plan reads are read by the check or the drawing
    (!acts_where.is_empty()).then_some(Why::ActsWhere(acts_where))
}

/// The edit that removes a field from the text, with its line if nothing else is on it.
fn without(field: &Stated, sources: &Sources) -> Option<Edit> {
    let (file, end) = (field.span.file, field.span.end as usize);
    let text = &sources.get(file).text;
    let before = text.get(..field.span.start as usize)?.trim_end().strip_suffix('=')?.trim_end();
    let start = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.').len();
    let line = text[..start].rfind('\n').map_or(0, |i| i + 1);
    let (rest, behind) = (&text[end..], text[end..].trim_start_matches([' ', '\t', ',']));
    let ends = behind.is_empty() || behind.starts_with(['\n', '\r']) || behind.starts_with("//");
    let span = if text[line..start].trim().is_empty() && ends {
        let next = rest.find('\n').map_or(text.len(), |i| end + i + 1);
        Span::new(file, line, next)
    } else if rest.trim_start().starts_with(',') {
        Span::new(file, start, text.len() - behind.len())
    } else {
        // the last of several fields: the comma before it is removed too
        let kept = text[..start].trim_end().trim_end_matches(',').trim_end().len();
        Span::new(file, kept.max(line), end)
    };
    (!field.edited).then(|| Edit { span, text: String::new() })
}

fn warning(why: &Why, fields: &[Stated]) -> Diagnostic {
    let mut names: Vec<String> = Vec::new();
    for name in fields.iter().map(|field| format!("`{}`", field.field)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let several = names.len() > 1;
    let names = and_list(&names);
    let (message, label) = match why {
        Why::Unread => (format!("no run of this version reads {names} yet"), "not used"),
        Why::ActsWhere(places) => {
            let act = if several { "act" } else { "acts" };
            (format!("{names} {act} only {}", places.join(", or ")), "not used by this plan")
        }
    };
    let it = if several { "them out: they change" } else { "it out: it changes" };
    let warning = Diagnostic::new(Code::E0429, message).help(format!("take {it} nothing here"));
    fields.iter().fold(warning, |warning, field| warning.label(field.span, label))
}
