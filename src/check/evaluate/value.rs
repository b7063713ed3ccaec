//! Checked values: what a field holds once its text has been understood.

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
    /// What is asked of the scene, as written, and where its names are looked up: places and counts in it mean something
    /// once the track is laid out and the traffic is known.
    Written(Rc<Value>, ScopeId),
    /// `?`, reported as a warning.
    Hole,
    /// Reported already.
    Error,
}

impl Val {
    /// What it looks like, for a message.
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
    /// Its declared name; of an object in place, that of what it extends, else the kind's.
    pub name: String,
    /// Where it stands: the header of a declaration, or the whole object.
    pub span: Span,
    pub fields: BTreeMap<&'static str, Slot>,
    /// Where the objects stand that it extends, the nearest first.
    pub bases: Vec<Span>,
    /// Part of it could not be understood and has been reported, so that nobody knows what is missing.
    pub partial: bool,
    /// What it says of objects of another kind, in order, those of what it extends first.
    pub changes: Vec<Change>,
}

/// A field as written, to be put into an object later.
#[derive(Debug, Clone)]
pub struct Change {
    pub field: Field,
    /// Where its names are looked up.
    pub scope: ScopeId,
}

impl Record {
    /// An object that says nothing yet.
    pub fn empty(kind: &'static Kind, name: &str, span: Span) -> Record {
        let (fields, bases, changes) = (BTreeMap::new(), Vec::new(), Vec::new());
        Record { kind, name: name.to_string(), span, fields, bases, partial: false, changes }
    }

    /// Notes that it lacks something, unless part of it could not be understood.
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

    /// Whether a field stands there and could not be understood, or is a hole.
    pub fn unknown(&self, name: &str) -> bool {
        matches!(self.slot(name).map(|s| &s.value), Some(Val::Error | Val::Hole))
    }
}
