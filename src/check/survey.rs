//! Information for an editor: the files of a text with their names, and the final fields of every object, also after
//! mistakes.

use super::evaluate::evaluator::Evaluator;
use super::evaluate::number::Number;
use super::evaluate::value::{Record, Slot, Val};
use super::resolve::literal;
use super::text::library::Part;
use super::text::loader::load;
use super::text::scope::{ItemId, Scope, ScopeId};
use super::{Checked, Modules, evaluated};
use crate::diag::{Sources, Span};
use crate::scenario::Origin;
use crate::schema::{COMMON, Field, Kind};
use crate::units::Dimension;
use std::collections::BTreeMap;

/// The files of a scene, each with its declarations and its modules.
pub struct Files {
    pub scopes: Vec<Scope>,
    /// The main file.
    pub main: ScopeId,
    /// The scope in which every module of the standard library is known.
    pub standard: ScopeId,
}

/// All information about a text.
pub struct Survey {
    pub checked: Checked,
    pub files: Files,
    /// Understood declarations that the scene reads, also of the standard library.
    pub objects: BTreeMap<ItemId, Object>,
}

/// An object with its own, inherited and default fields.
#[derive(Debug, Clone)]
pub struct Object {
    pub kind: &'static Kind,
    pub fields: Vec<Held>,
}

/// A field of an object, and its content.
#[derive(Debug, Clone)]
pub struct Held {
    pub field: &'static Field,
    pub span: Span,
    pub origin: Origin,
    pub content: Content,
}

/// The content of a field, by kind.
#[derive(Debug, Clone)]
pub enum Content {
    Number {
        /// The value of one rail, SI.
        of_rail: f64,
        dimension: Dimension,
        /// The value in the words of the language.
        text: String,
    },
    /// An object: its name and its own fields.
    Object(String, Object),
    /// Any other understood value, at the place of the field.
    Other,
    /// A hole, or not understood.
    Unknown,
}

/// Checks a text and returns all information about it.
pub fn survey(name: &str, text: &str, modules: &dyn Modules) -> Survey {
    let eval = Evaluator::new(load(name, text, &[], Part::Whole, modules));
    let (main, standard) = (eval.main, eval.standard);
    let (checked, (scopes, objects)) = evaluated(eval, &|eval: &mut Evaluator<'_>| {
        let objects = objects(eval);
        (std::mem::take(&mut eval.scopes), objects)
    });
    Survey { checked, files: Files { scopes, main, standard }, objects }
}

/// The names of a text and of all that it uses; nothing is evaluated.
pub fn surveyed_names(name: &str, text: &str, modules: &dyn Modules) -> (Sources, Files) {
    let loaded = load(name, text, &[], Part::Whole, modules);
    (loaded.files.sources, Files { scopes: loaded.scopes, main: loaded.main, standard: loaded.standard })
}

fn objects(eval: &mut Evaluator<'_>) -> BTreeMap<ItemId, Object> {
    eval.known_objects().into_iter().map(|(id, record)| (id, object(&eval.complete(&record)))).collect()
}

fn object(record: &Record) -> Object {
    let changed = record.kind.changes().into_iter().flat_map(|kind| kind.fields);
    let fields = record.kind.fields.iter().chain(changed).chain(COMMON);
    let held = fields.filter_map(|field| Some(held(field, record.get(field.name)?)));
    Object { kind: record.kind, fields: held.collect() }
}

fn held(field: &'static Field, slot: &Slot) -> Held {
    let content = match &slot.value {
        Val::Number(number) => quantity(*number, field),
        Val::Record(record) => Content::Object(record.name.clone(), object(record)),
        Val::Hole | Val::Error => Content::Unknown,
        _ => Content::Other,
    };
    Held { field, span: slot.span, origin: slot.origin, content }
}

fn quantity(number: Number, field: &'static Field) -> Content {
    let text = literal::number(number, &field.form);
    Content::Number { of_rail: number.of_rail(), dimension: number.dimension, text }
}

impl Object {
    /// The content of a field, by its path through inner objects.
    pub fn held(&self, path: &[&str]) -> Option<&Held> {
        let (first, rest) = path.split_first()?;
        let held = self.fields.iter().find(|held| held.field.name == *first)?;
        match (&held.content, rest) {
            (_, []) => Some(held),
            (Content::Object(_, inner), rest) => inner.held(rest),
            _ => None,
        }
    }

    /// The number at a path: the value of one rail, SI.
    pub fn number(&self, path: &[&str]) -> Option<f64> {
        match self.held(path)?.content {
            Content::Number { of_rail, .. } => Some(of_rail),
            _ => None,
        }
    }
}
