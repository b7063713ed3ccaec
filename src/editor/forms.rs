//! The parts of a value by its form: from a field down to its content.

use crate::schema::{self, COMMON, Field, Form, Kind, RANDOM, Word};

/// The kind of object that a form takes.
pub fn object_kind(form: &Form) -> Option<&'static Kind> {
    object_kinds(form).into_iter().next()
}

/// Every kind of object that a form takes.
pub fn object_kinds(form: &Form) -> Vec<&'static Kind> {
    match form {
        Form::Object(kind) => schema::kind(kind).into_iter().collect(),
        Form::OneOf(forms) => forms.iter().flat_map(object_kinds).collect(),
        _ => Vec::new(),
    }
}

/// The form of an item of a list; the form itself if it takes no list, because a list may also be a profile.
pub fn item_form(form: &'static Form) -> &'static Form {
    match form {
        Form::List(item) => item,
        Form::OneOf(forms) => forms.iter().find(|f| matches!(f, Form::List(_))).map_or(form, item_form),
        _ => form,
    }
}

/// Key and value of the pairs of a list.
pub fn pair_forms(form: &'static Form) -> Option<(&'static Form, &'static Form)> {
    match form {
        Form::Pairs { key, value, .. } => Some((key, value)),
        Form::OneOf(forms) => forms.iter().find_map(pair_forms),
        Form::Number(_) => Some((&Form::Place, form)),
        _ => None,
    }
}

/// Whether a form, or one of its alternatives, satisfies `wanted`.
pub fn has(form: &Form, wanted: fn(&Form) -> bool) -> bool {
    match form {
        Form::OneOf(forms) => forms.iter().any(|f| has(f, wanted)),
        Form::List(item) => has(item, wanted),
        _ => wanted(form),
    }
}

/// The field that a path of names leads to, with the kind that has it.
pub fn follow(kind: &'static Kind, path: &[&str]) -> Option<(&'static Kind, &'static Field)> {
    let (first, rest) = path.split_first()?;
    let field = kind.field(first)?;
    match rest {
        [] => Some((kind, field)),
        _ => follow(object_kind(&field.form)?, rest),
    }
}

/// The argument that a path names inside a word of a field: `form.gamma`.
pub fn argument(form: &'static Form, name: &str) -> Option<(&'static Word, &'static Field)> {
    form.words().into_iter().find_map(|word| Some((word, word.arguments.iter().find(|a| a.name == name)?)))
}

/// The word with this name: a word of the form, or `random`.
pub fn word_of(form: Option<&'static Form>, name: &str) -> Option<&'static Word> {
    form.and_then(|form| form.word(name)).or_else(|| (name == RANDOM.name).then_some(&RANDOM))
}

/// All fields of a kind, with the fields that it may change and the common fields.
pub fn fields(kind: &'static Kind) -> impl Iterator<Item = &'static Field> {
    let changed = kind.changes().into_iter().flat_map(|changed| changed.fields);
    kind.fields.iter().chain(changed).chain(COMMON)
}
