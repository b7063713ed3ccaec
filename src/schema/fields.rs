//! Short constructors for the fields, words and forms of the table of kinds.

use super::{Alternative, Basis, Field, Form, Measure, Need, Varies, Word};

/// Basis of a force: one seat, or one sleeper with two seats.
pub(super) const SEAT: Basis = Basis { names: &[("seat", 1.0), ("sleeper", 0.5)], assumed: Some("seat") };
pub(super) const NONE: &[Word] = &[word("none", "absent")];
pub(super) const AXLE_COUNT: Form = number("axles", 0.0, 1e9);
pub(super) const AXLES_OR_MASS: Form = Form::OneOf(&[AXLE_COUNT, number("MGT", 1e-6, 1e4)]);

const fn field(name: &'static str, form: Form, need: Need, doc: &'static str) -> Field {
    Field { name, form, need, doc, unread: false }
}
/// A field that no run reads yet.
pub(super) const fn unread(field: Field) -> Field {
    Field { unread: true, ..field }
}
pub(super) const fn required(name: &'static str, form: Form, doc: &'static str) -> Field {
    field(name, form, Need::Required, doc)
}
pub(super) const fn optional(name: &'static str, form: Form, doc: &'static str) -> Field {
    field(name, form, Need::Optional, doc)
}
pub(super) const fn default(name: &'static str, form: Form, text: &'static str, doc: &'static str) -> Field {
    field(name, form, Need::Default(text), doc)
}
pub(super) const fn way(name: &'static str, form: Form, doc: &'static str) -> Field {
    field(name, form, Need::Alternative, doc)
}

/// Runs with seeds of their own: a number, or a range in which the results decide.
pub(super) const REPEATS: Form =
    Form::OneOf(&[Form::Integer { min: 1, max: 1000 }, Form::Interval(measure("", 1.0, 1000.0))]);

pub(super) const fn measure(unit: &'static str, min: f64, max: f64) -> Measure {
    Measure { unit, min, max, basis: None, varies: Varies::No }
}
pub(super) const fn number(unit: &'static str, min: f64, max: f64) -> Form {
    Form::Number(measure(unit, min, max))
}
pub(super) const fn per(unit: &'static str, min: f64, max: f64, basis: &'static Basis) -> Form {
    Form::Number(Measure { basis: Some(basis), ..measure(unit, min, max) })
}
/// A number that may vary along the track.
pub(super) const fn along(form: Form) -> Form {
    varying(form, Varies::Yes)
}
pub(super) const fn varying(form: Form, varies: Varies) -> Form {
    match form {
        Form::Number(m) => Form::Number(Measure { varies, ..m }),
        other => other,
    }
}
pub(super) const fn word(name: &'static str, doc: &'static str) -> Word {
    Word { name, doc, arguments: &[], planned: false }
}
pub(super) const fn either(ways: &'static [&'static [&'static str]]) -> Alternative {
    Alternative { ways, default: None, exclusive: false }
}
/// Ways with different meanings: exactly one way must be given.
pub(super) const fn one_of(ways: &'static [&'static [&'static str]]) -> Alternative {
    Alternative { exclusive: true, ..either(ways) }
}
