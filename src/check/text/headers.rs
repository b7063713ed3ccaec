//! Headers of declarations with one mistake. The rest of the declaration shows which header was meant; this header is
//! used, so that one slip gives one mistake.

use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Fix};
use crate::schema::{self, Kind, Names, Role, called};
use crate::syntax::tree::{Declaration, Item, Tree, ValueKind};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Corrects the headers of a tree.
pub fn mended(tree: &mut Arc<Tree>) -> Vec<Diagnostic> {
    let mut kinds: BTreeMap<&str, Option<&'static Kind>> = BTreeMap::new();
    for item in &tree.items {
        match item {
            Item::Declaration(d) => {
                let name = d.name.as_ref().unwrap_or(&d.kind);
                let kind = schema::kind(&d.kind.text).or_else(|| called_kind(d));
                kinds.insert(&name.text, kind);
            }
            Item::Let(binding) => {
                kinds.insert(&binding.name.text, None);
            }
            Item::Use(used) => {
                let name = used.alias.as_ref().or(used.path.names.last());
                kinds.extend(name.map(|name| (name.text.as_str(), None)));
            }
        }
    }
    let of_kinds: Vec<(usize, Declaration)> =
        tree.items.iter().enumerate().filter_map(|(i, item)| Some((i, kind_as_let(item)?))).collect();
    let mut found = Vec::new();
    for (i, item) in tree.items.iter().enumerate() {
        let Item::Declaration(d) = item else { continue };
        let mended = other_kind(d, &kinds).or_else(|| name_behind_colon(d, &kinds)).or_else(|| foreign_kind(d));
        found.extend(mended.map(|mended| (i, mended)));
    }
    for (i, declaration) in of_kinds {
        Arc::make_mut(tree).items[i] = Item::Declaration(declaration);
    }
    let mut mistakes = Vec::new();
    for (i, (mended, mistake)) in found {
        Arc::make_mut(tree).items[i] = Item::Declaration(mended);
        mistakes.push(mistake);
    }
    mistakes
}

/// `track stiff : open { ... }`, if `open` is a trackform and the fields are fields of a trackform.
fn other_kind(d: &Declaration, kinds: &BTreeMap<&str, Option<&'static Kind>>) -> Option<(Declaration, Diagnostic)> {
    let kind = schema::kind(&d.kind.text)?;
    let [base] = d.base.as_ref()?.names.as_slice() else { return None };
    let of_base = (*kinds.get(base.text.as_str())?)?;
    let fits = |kind: &Kind| d.fields.iter().all(|f| kind.field(&f.path.names[0].text).is_some());
    if of_base.name == kind.name || d.fields.is_empty() || !fits(of_base) || fits(kind) {
        return None;
    }
    let name = d.name.as_ref().map_or(String::new(), |name| format!(" {}", name.text));
    let message = format!("a {} cannot extend `{}`, which is a {}", kind.name, base.text, of_base.name);
    let mistake = Diagnostic::new(Code::E0205, message)
        .label(d.kind.span, format!("its fields are fields of a {}", of_base.name))
        .help(format!("write `{}{name} : {}`", of_base.name, base.text))
        .fix(Fix::replace(d.kind.span, of_base.name));
    let mut mended = d.clone();
    mended.kind.text = of_base.name.to_string();
    Some((mended, mistake))
}

/// `trackform: open { ... }`, if nothing is called `open`.
fn name_behind_colon(
    d: &Declaration,
    kinds: &BTreeMap<&str, Option<&'static Kind>>,
) -> Option<(Declaration, Diagnostic)> {
    let kind = schema::kind(&d.kind.text)?;
    let [base] = d.base.as_ref()?.names.as_slice() else { return None };
    if d.name.is_some() || d.fields.is_empty() || kind.role == (Role::Scene { once: true }) {
        return None;
    }
    // last, because it compares the base with every name of the file
    if kinds.contains_key(base.text.as_str()) || nearest(&base.text, kinds.keys().copied()).is_some() {
        return None;
    }
    let mistake = Diagnostic::new(Code::E0201, format!("nothing is called `{}`", base.text))
        .label(base.span, "the name behind `:` is the base")
        .help(format!("write `{} {} {{`, without the colon", kind.name, base.text))
        .fix(Fix::replace(d.kind.span.to(base.span), format!("{} {}", kind.name, base.text)));
    let mut mended = d.clone();
    mended.name = mended.base.take().and_then(|path| path.names.into_iter().next());
    Some((mended, mistake))
}

/// The kind of a declaration with a name from other programs.
fn called_kind(d: &Declaration) -> Option<&'static Kind> {
    let stands = schema::KINDS.iter().filter(|k| k.role != Role::Nested).map(|k| k.name);
    if schema::kind(&d.kind.text).is_some() || d.fields.is_empty() && d.base.is_none() {
        return None;
    }
    schema::kind(called(Names::Kinds, &d.kind.text, stands)?)
}

/// `ballast stone { ... }` is read as a granular.
fn foreign_kind(d: &Declaration) -> Option<(Declaration, Diagnostic)> {
    let kind = called_kind(d)?;
    let mistake = Diagnostic::new(Code::E0401, format!("unknown kind `{}`", d.kind.text))
        .label(d.kind.span, "not a kind")
        .meant(d.kind.span, kind.name);
    let mut mended = d.clone();
    // without a name it takes the name of its kind
    mended.kind.text = kind.name.to_string();
    Some((mended, mistake))
}

/// `traffic = { ... }`, which has been reported, is the declaration of that kind.
fn kind_as_let(item: &Item) -> Option<Declaration> {
    let Item::Let(binding) = item else { return None };
    let ValueKind::Object { base: None, fields } = &binding.value.kind else { return None };
    schema::kind(&binding.name.text).filter(|k| k.role != Role::Nested)?;
    let (kind, fields, docs, span) = (binding.name.clone(), fields.clone(), binding.docs.clone(), binding.span);
    Some(Declaration { kind, name: None, base: None, fields, docs, span })
}
