//! Fields that the user's own texts state for the objects of a scene, without defaults and without the standard
//! library.

use super::evaluate::evaluator::Evaluator;
use super::evaluate::value::{Record, Slot, Val};
use super::text::overrides::EDIT;
use super::text::scope::ItemId;
use crate::diag::{Sources, Span};
use crate::scenario::Origin;
use crate::schema::{self, Role};
use crate::syntax::tree::Item;
use std::collections::BTreeSet;

/// A field that a user's text states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stated {
    /// Its value.
    pub span: Span,
    pub kind: &'static str,
    pub field: &'static str,
    /// Whether an edit states it, such as `--set` or a point of a study.
    pub edited: bool,
}

impl Stated {
    /// The field as `kind.field`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.kind, self.field)
    }
}

/// Fields stated for every object that acts in the main file, and for all objects that these name, in the order of the
/// texts.
pub(super) fn stated(eval: &Evaluator<'_>) -> Vec<Stated> {
    let mut found = Found { sources: &eval.files.sources, stated: BTreeSet::new() };
    for (item, declared) in eval.scopes[eval.main].tree.items.iter().enumerate() {
        let Item::Declaration(declaration) = declared else { continue };
        let acts = matches!(schema::kind(&declaration.kind.text).map(|kind| kind.role), Some(Role::Scene { .. }));
        if let Some(record) = eval.known(ItemId { scope: eval.main, item }).filter(|_| acts) {
            found.object(record);
        }
    }
    found.stated.into_iter().collect()
}

struct Found<'a> {
    sources: &'a Sources,
    stated: BTreeSet<Stated>,
}

impl Found<'_> {
    fn object(&mut self, record: &Record) {
        for (field, slot) in &record.fields {
            self.field(record, field, slot);
            self.value(&slot.value);
        }
    }

    fn field(&mut self, record: &Record, field: &'static str, slot: &Slot) {
        let source = self.sources.get(slot.span.file);
        if source.library || !matches!(slot.origin, Origin::Written(_)) {
            return;
        }
        let own = record.kind.fields.iter().any(|known| known.name == field);
        let changed = record.kind.changes().filter(|_| !own && record.kind.changed_field(field).is_some());
        // fields of every kind give the origin of data and do not affect the scene
        let Some(kind) = changed.or(Some(record.kind).filter(|_| own)) else { return };
        let edited = source.name == EDIT;
        self.stated.insert(Stated { span: slot.span, kind: kind.name, field, edited });
    }

    fn value(&mut self, value: &Val) {
        match value {
            Val::Record(record) => self.object(record),
            Val::List(slots) => slots.iter().for_each(|slot| self.value(&slot.value)),
            Val::Pairs(pairs) => pairs.iter().for_each(|(key, value)| {
                self.value(&key.value);
                self.value(&value.value);
            }),
            _ => {}
        }
    }
}
