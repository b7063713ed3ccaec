//! Topics as JSON.

use super::Topic;
use crate::check::{Entry, library};
use crate::diag::Code;
use crate::scenario::response::Response;
use crate::schema::{Field, Form, KINDS, Kind, Need, Role, form_text};
use serde_json::{Map, Value, json};

/// The whole vocabulary.
pub fn everything() -> Value {
    json!({
        "kinds": KINDS.iter().map(kind).collect::<Vec<_>>(),
        "library": library().iter().map(entry).collect::<Vec<_>>(),
        "responses": Response::ALL.iter().map(response).collect::<Vec<_>>(),
        "codes": Code::ALL.iter().map(code).collect::<Vec<_>>(),
    })
}

/// One topic; its field `topic` gives the kind of topic.
pub(super) fn topic(topic: &Topic) -> Value {
    let (sort, data) = match topic {
        Topic::Kind(it) => ("kind", kind(it)),
        Topic::Field(of, it) => ("field", with("kind", json!(of.name), field(it))),
        Topic::Module(module, entries) => {
            ("module", json!({ "name": module, "entries": entries.iter().map(entry).collect::<Vec<_>>() }))
        }
        Topic::Entry(it) => ("entry", entry(it)),
        Topic::Response(it) => ("response", response(it)),
        Topic::Code(it) => ("code", code(it)),
    };
    with("topic", json!(sort), data)
}

fn with(name: &str, value: Value, data: Value) -> Value {
    let mut object = match data {
        Value::Object(object) => object,
        _ => Map::new(),
    };
    object.insert(name.into(), value);
    Value::Object(object)
}

fn kind(kind: &Kind) -> Value {
    let role = match kind.role {
        Role::Part => "part",
        Role::Scene { once: true } => "scene, once",
        Role::Scene { once: false } => "scene",
        Role::Changes(_) => "changes",
        Role::Nested => "value",
    };
    json!({
        "name": kind.name,
        "role": role,
        "meaning": kind.doc,
        "changes": kind.changes().map(|changed| changed.name),
        "fields": kind.fields.iter().map(field).collect::<Vec<_>>(),
    })
}

fn field(field: &Field) -> Value {
    let (need, default) = match field.need {
        Need::Required => ("required", None),
        Need::Optional => ("optional", None),
        Need::Default(text) => ("default", Some(text)),
        Need::Alternative => ("alternative", None),
    };
    let words: Vec<Value> = field.form.words().into_iter().filter(|word| !word.planned).map(word).collect();
    json!({
        "name": field.name,
        "meaning": field.doc,
        "value": form_text(&field.form),
        "need": need,
        "default": default,
        "unit": field.form.measure().map(|measure| measure.unit),
        "range": field.form.measure().map(|measure| [measure.min, measure.max]),
        "bases": field.form.measure().and_then(|measure| measure.basis).map(bases),
        "kind": object(&field.form),
        "words": words,
    })
}

fn bases(basis: &crate::schema::Basis) -> Vec<&'static str> {
    basis.names.iter().map(|(name, _)| *name).collect()
}

/// The kind of the object in a form.
fn object(form: &Form) -> Option<&'static str> {
    match form {
        Form::Object(kind) => Some(kind),
        Form::OneOf(forms) => forms.iter().find_map(object),
        Form::List(item) => object(item),
        _ => None,
    }
}

fn word(word: &crate::schema::Word) -> Value {
    json!({ "name": word.name, "meaning": word.doc, "arguments": word.arguments.iter().map(field).collect::<Vec<_>>() })
}

fn entry(entry: &Entry) -> Value {
    let fields: Map<String, Value> = entry.fields.iter().map(|(path, value)| (path.clone(), json!(value))).collect();
    json!({
        "name": format!("{}.{}", entry.module, entry.name),
        "kind": entry.kind,
        "meaning": entry.doc,
        "extends": entry.base.as_ref().map(|base| format!("{}.{base}", entry.module)),
        "fields": fields,
        "evidence": entry.evidence,
        "source": entry.source,
    })
}

fn response(response: &Response) -> Value {
    json!({ "name": response.name(), "unit": response.unit(), "meaning": response.doc() })
}

fn code(code: &Code) -> Value {
    json!({
        "name": code.as_str(),
        "severity": code.severity().as_str(),
        "meaning": code.title(),
        "rule": code.rule(),
        "page": code.page(),
    })
}
