//! Checked values: the content of a field after its text has been understood.

use super::number::Number;
use super::shape::Shape;
use super::written::looks_like;
use crate::check::findings::Findings;
use crate::check::text::scope::ScopeId;
use crate::diag::{Diagnostic, Span};
use crate::scenario::Origin;
use crate::scenario::response::Response;
use crate::schema::{Kind, Word};
use crate::syntax::tree::{Field, Value};
use std::collections::BTreeMap;
use std::rc::Rc;

/// A value with its place.
#[derive(Debug, Clone)]
pub struct Slot {
    pub value: Val,
    pub span: Span,
    pub origin: Origin,
}

#[derive(Debug, Clone)]
pub enum Val {
    Number(Number),
    Text(String),
    Word {
        word: &'static Word,
        arguments: BTreeMap<&'static str, Slot>,
    },
    Record(Rc<Record>),
    List(Vec<Slot>),
    Pairs(Vec<(Slot, Slot)>),
    Range(Number, Number),
    /// A number that varies along the track.
    Profile(Rc<Shape>),
    Response(Response),
    /// A question about the scene, as written, and the scope of its names. Its places and counts are evaluated when the
    /// track is laid out and the traffic is known.
    Written(Rc<Value>, ScopeId),
    /// `?`, reported as a warning.
    Hole,
    /// Reported already.
    Error,
}

impl Val {
    /// The kind of value, for a message.
    pub fn describe(&self) -> &'static str {
        match self {
            Val::Number(_) => "a number",
            Val::Text(_) => "text",
            Val::Word { .. } => "a word",
            Val::Record(_) => "an object",
            Val::List(_) | Val::Pairs(_) => "a list",
            Val::Range(..) => "a range",
            Val::Profile(_) => "a profile along the track",
            Val::Response(_) => "a response",
            Val::Written(value, _) => looks_like(&value.kind),
            Val::Hole => "a hole",
            Val::Error => "something unreadable",
        }
    }
}

/// An object of a kind: a declaration, or an object written in place.
#[derive(Debug, Clone)]
pub struct Record {
    pub kind: &'static Kind,
    /// Its declared name; for an object in place the name of its base, else the name of the kind.
    pub name: String,
    /// Its place: the header of a declaration, or the whole object.
    pub span: Span,
    pub fields: BTreeMap<&'static str, Slot>,
    /// Places of the objects that it extends, the nearest first.
    pub bases: Vec<Span>,
    /// A part could not be understood and has been reported, so that missing fields are not known.
    pub partial: bool,
    /// Its changes to objects of another kind, in order; changes of its base come first.
    pub changes: Vec<Change>,
}

/// A field as written, to be put into an object later.
#[derive(Debug, Clone)]
pub struct Change {
    pub field: Field,
    /// The scope of its names.
    pub scope: ScopeId,
}

impl Record {
    /// An object without fields.
    pub fn empty(kind: &'static Kind, name: &str, span: Span) -> Record {
        let (fields, bases, changes) = (BTreeMap::new(), Vec::new(), Vec::new());
        Record { kind, name: name.to_string(), span, fields, bases, partial: false, changes }
    }

    /// Notes a missing part, unless a part could not be understood.
    pub fn lacks(&self, what: &str, mistake: Diagnostic, findings: &mut Findings) {
        if !self.partial {
            findings.lacks(self.span, &self.bases, what, mistake);
        }
    }

    /// The slot of a field.
    pub fn get(&self, name: &str) -> Option<&Slot> {
        self.fields.get(name)
    }

    /// The slot at a dotted path through nested objects.
    pub fn slot(&self, path: &str) -> Option<&Slot> {
        match path.split_once('.') {
            None => self.get(path),
            Some((first, rest)) => match &self.get(first)?.value {
                Val::Record(inner) => inner.slot(rest),
                _ => None,
            },
        }
    }

    /// The number at a dotted path.
    pub fn number(&self, name: &str) -> Option<Number> {
        match self.slot(name)?.value {
            Val::Number(n) => Some(n),
            _ => None,
        }
    }

    /// The object at a dotted path.
    pub fn record(&self, name: &str) -> Option<&Rc<Record>> {
        match &self.slot(name)?.value {
            Val::Record(r) => Some(r),
            _ => None,
        }
    }

    /// The text at a dotted path.
    pub fn text(&self, name: &str) -> Option<&str> {
        match &self.slot(name)?.value {
            Val::Text(t) => Some(t),
            _ => None,
        }
    }

    /// The bare or leading word of a field.
    pub fn word(&self, name: &str) -> Option<&'static str> {
        match &self.slot(name)?.value {
            Val::Word { word, .. } => Some(word.name),
            _ => None,
        }
    }

    /// Whether a field is given but could not be understood, or is a hole.
    pub fn unknown(&self, name: &str) -> bool {
        matches!(self.slot(name).map(|s| &s.value), Some(Val::Error | Val::Hole))
    }
}
