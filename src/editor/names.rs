//! Looks up names in the files of a scene, as the check does, but without diagnostics for unknown names.

use crate::check::{Files, ItemId, ScopeId};
use crate::diag::Span;
use crate::schema::{self, Kind};
use crate::syntax::tree::{Declaration, Field, Item, Path, ValueKind};

/// The item at the beginning of a path, and the number of names that lead to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    pub id: ItemId,
    pub taken: usize,
}

impl Files {
    /// The item with this id.
    pub fn item(&self, id: ItemId) -> &Item {
        &self.scopes[id.scope].tree.items[id.item]
    }

    /// The item that a path begins with.
    pub fn target(&self, path: &Path, scope: ScopeId) -> Option<Target> {
        let first = &path.names.first()?.text;
        let here = &self.scopes[scope];
        let inside = || {
            let (module, second) = (*here.modules.get(first)?, path.names.get(1)?);
            self.named(module, &second.text).map(|id| Target { id, taken: 2 })
        };
        inside().or_else(|| self.named(scope, first).map(|id| Target { id, taken: 1 }))
    }

    /// The item with this name in a file.
    pub fn named(&self, scope: ScopeId, name: &str) -> Option<ItemId> {
        self.scopes[scope].names.get(name).map(|item| ItemId { scope, item: *item })
    }

    /// The declaration with this id.
    pub fn declaration(&self, id: ItemId) -> Option<&Declaration> {
        match self.item(id) {
            Item::Declaration(declaration) => Some(declaration),
            _ => None,
        }
    }

    /// The kind of the declaration with this id.
    pub fn kind(&self, id: ItemId) -> Option<&'static Kind> {
        kind_of(self.declaration(id)?)
    }

    /// The name of an item and its place.
    pub fn name(&self, id: ItemId) -> (&str, Span) {
        name_of(self.item(id))
    }

    /// The place that gives a path inside a declaration: in the declaration or in its base.
    pub fn given(&self, id: ItemId, path: &[&str]) -> Option<Span> {
        self.given_within(id, path, 16)
    }

    fn given_within(&self, id: ItemId, path: &[&str], deepest: u32) -> Option<Span> {
        let declared = self.declaration(id)?;
        if let Some(found) = self.given_in(&declared.fields, path, id.scope, deepest) {
            return Some(found);
        }
        let base = self.target(declared.base.as_ref()?, id.scope)?;
        self.given_within(base.id, path, deepest.checked_sub(1)?)
    }

    fn given_in(&self, fields: &[Field], path: &[&str], scope: ScopeId, deepest: u32) -> Option<Span> {
        fields.iter().rev().find_map(|field| {
            let own = &field.path.names;
            if own.len() > path.len() || !own.iter().zip(path).all(|(name, wanted)| name.text == *wanted) {
                return None;
            }
            let rest = &path[own.len()..];
            if rest.is_empty() {
                return Some(field.path.span);
            }
            let (base, inner) = match &field.value.kind {
                ValueKind::Object { base, fields } => (base.as_ref(), fields.as_slice()),
                ValueKind::Path(base) => (Some(base), &[][..]),
                _ => return None,
            };
            self.given_in(inner, rest, scope, deepest).or_else(|| {
                let target = self.target(base?, scope)?;
                self.given_within(target.id, rest, deepest.checked_sub(1)?)
            })
        })
    }
}

/// The kind of a declaration.
pub fn kind_of(declaration: &Declaration) -> Option<&'static Kind> {
    schema::kind(&declaration.kind.text).or_else(|| schema::meant_kind(&declaration.kind.text))
}

/// The name of an item, or the name of its kind if it has none, and its place.
pub fn name_of(item: &Item) -> (&str, Span) {
    let name = match item {
        Item::Let(binding) => &binding.name,
        Item::Declaration(d) => d.name.as_ref().unwrap_or(&d.kind),
        Item::Use(used) => match used.alias.as_ref().or(used.path.names.last()) {
            Some(name) => name,
            None => return ("", used.span),
        },
    };
    (&name.text, name.span)
}
