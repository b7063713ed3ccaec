//! A field that does nothing says so: what the user's texts state is held against what the parts of the program read.
//!
//! A part of the scene (a rail, a granular material, a vehicle) is a data sheet, which other plans of the same file read, and which is
//! true in each. What it states is told only where an edit asks for a change of it, or where no plan of this version reads it.

use crate::check::Stated;
use crate::diag::{Code, Diagnostic, and_list};
use crate::schema::{self, Field, Need, Reader, Role};

/// Why a field does nothing.
#[derive(PartialEq)]
enum Why {
    /// No run of this version reads it.
    Unread,
    /// It acts elsewhere.
    ActsWhere(Vec<&'static str>),
}

/// One warning for each reason, with every field of which it holds. Without readers only those are told that nobody reads.
pub(super) fn told(stated: &[Stated], readers: &[Reader]) -> Vec<Diagnostic> {
    let mut reasons: Vec<(Why, Vec<Stated>)> = Vec::new();
    for one in stated {
        let Some(why) = why(one, readers) else { continue };
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, fields)) => fields.push(*one),
            None => reasons.push((why, vec![*one])),
        }
    }
    reasons.into_iter().map(|(why, fields)| warning(&why, &fields)).collect()
}

/// Why a field does nothing in the plan of these readers; `None` where it does something, or where its word is not worth telling.
fn why(stated: &Stated, readers: &[Reader]) -> Option<Why> {
    let kind = schema::kind(stated.kind)?;
    let field: &Field = kind.field(stated.field)?;
    if field.unread {
        // what an object cannot be without is not the choice of whoever writes it
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
    // what no plan reads, checking or the drawing does
    (!acts_where.is_empty()).then_some(Why::ActsWhere(acts_where))
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
        Why::Unread => (format!("no run of this version reads {names} yet"), "read by nothing"),
        Why::ActsWhere(places) => {
            let act = if several { "act" } else { "acts" };
            (format!("{names} {act} only {}", places.join(", or ")), "not used by this plan")
        }
    };
    let it = if several { "them out: they change" } else { "it out: it changes" };
    let warning = Diagnostic::new(Code::E0429, message).help(format!("take {it} nothing here"));
    fields.iter().fold(warning, |warning, field| warning.label(field.span, label))
}
