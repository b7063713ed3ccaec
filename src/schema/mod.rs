//! The vocabulary of the language: every kind, field, word, unit, range and default.
//!
//! Checking, defaults and `trackbed docs` all read this table; a field is added in one place: `kinds.rs`, or the file
//! of its kind.

mod called;
mod docs;
mod fields;
mod kinds;
mod laws;
mod materials;
mod reads;
mod results;
mod solve;
mod traffic;

pub use called::{Names, called};
pub use docs::{field_page, form_text, index, page, section};
pub use kinds::{COMMON, KINDS, RANDOM};
pub use reads::{Reader, Reads};

/// A kind of declaration, or a kind of value that occurs only inside declarations.
#[derive(Debug)]
pub struct Kind {
    pub name: &'static str,
    pub doc: &'static str,
    pub role: Role,
    pub fields: &'static [Field],
    pub alternatives: &'static [Alternative],
    /// Fields of the language that this version does not read yet.
    pub planned: &'static [&'static str],
}

/// The role of a declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A part that other declarations refer to by name.
    Part,
    /// Acts without being referred to, in the main file.
    Scene {
        /// Whether a scene has at most one.
        once: bool,
    },
    /// A part that changes another part of the named kind. It also has the fields of that kind, all optional.
    Changes(&'static str),
    /// Occurs only as the value of a field.
    Nested,
}

/// A field of a kind, or an argument of a word.
#[derive(Debug)]
pub struct Field {
    pub name: &'static str,
    pub form: Form,
    pub need: Need,
    pub doc: &'static str,
    /// Whether no run of this version reads the field.
    pub unread: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    Required,
    Optional,
    /// The value if the field is not given, written in the language itself.
    Default(&'static str),
    /// Required or not, as the [`Alternative`] of the field says.
    Alternative,
}

/// The form of a value.
#[derive(Debug)]
pub enum Form {
    Text,
    Number(Measure),
    /// A plain whole number.
    Integer {
        min: u32,
        max: u32,
    },
    Words(&'static [Word]),
    /// An object of this kind, or the name of one.
    Object(&'static str),
    OneOf(&'static [Form]),
    List(&'static Form),
    /// `[key: value]`; a key without a value has the value `implied`.
    Pairs {
        key: &'static Form,
        value: &'static Form,
        implied: Option<&'static str>,
    },
    /// `from .. to` of numbers.
    Interval(Measure),
    /// A place or a span along the track, in metres or in sleepers.
    Place,
    Span,
    /// A bare name, of a transition.
    Name,
    Response,
    Rule,
    Comparison,
    /// An expression of responses.
    Expression,
    /// `[path: list, range, steps or distribution]`
    Axes,
    /// `[path: value]`
    Settings,
}

/// A number with its unit, range and basis.
#[derive(Debug, Clone, Copy)]
pub struct Measure {
    /// Unit of the range and of messages; empty for a plain number.
    pub unit: &'static str,
    pub min: f64,
    pub max: f64,
    pub basis: Option<&'static Basis>,
    pub varies: Varies,
}

/// Whether a number may vary along the track.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Varies {
    No,
    Yes,
}

/// The basis of a value: one rail, or a unit of both rails, which the model of one rail halves.
#[derive(Debug, PartialEq)]
pub struct Basis {
    /// Names, each with the factor to the value of one rail; the range of the field refers to the first name.
    pub names: &'static [(&'static str, f64)],
    /// The basis if none is written; `None` makes a missing basis an error.
    pub assumed: Option<&'static str>,
}

/// A word that a field knows, bare or with arguments.
#[derive(Debug)]
pub struct Word {
    pub name: &'static str,
    pub doc: &'static str,
    pub arguments: &'static [Field],
    /// Whether the word is in the language but not in this version.
    pub planned: bool,
}

/// Fields that give the same quantity in different ways. A given way removes the other inherited ways. Ways that are
/// given together must agree within 2 %.
#[derive(Debug)]
pub struct Alternative {
    /// Each way is the list of paths that it needs.
    pub ways: &'static [&'static [&'static str]],
    /// Field and value if no way is given; `None` makes one way required.
    pub default: Option<(&'static str, &'static str)>,
    /// Whether only one way may be given, because the ways have different meanings.
    pub exclusive: bool,
}

/// Kinds of the language that this version does not read yet.
pub const PLANNED_KINDS: &[&str] = &[];

/// The kind with this name, including nested kinds.
pub fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|k| k.name == name)
}

/// Whether a value may be `per` this name.
pub fn basis_name(name: &str) -> bool {
    let fields = KINDS.iter().flat_map(|k| k.fields);
    let mut bases = fields.filter_map(|f| f.form.measure()?.basis);
    bases.any(|basis| basis.names.iter().any(|(known, _)| *known == name))
}

/// The kind that an unknown name most likely means.
pub fn meant_kind(name: &str) -> Option<&'static Kind> {
    let stands = || KINDS.iter().filter(|k| k.role != Role::Nested).map(|k| k.name);
    kind(called(Names::Kinds, name, stands()).or_else(|| crate::diag::nearest::nearest(name, stands()))?)
}

/// The word with this name, in any field.
pub fn word(name: &str) -> Option<&'static Word> {
    KINDS.iter().flat_map(|k| k.fields).find_map(|f| f.form.word(name))
}

impl Kind {
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        let own = self.fields.iter().chain(COMMON).find(|f| f.name == name);
        own.or_else(|| self.changed_field(name))
    }

    /// The kind that a declaration of this kind changes.
    pub fn changes(&self) -> Option<&'static Kind> {
        match self.role {
            Role::Changes(of) => kind(of),
            _ => None,
        }
    }

    /// A field of the kind that a declaration of this kind changes.
    pub fn changed_field(&self, name: &str) -> Option<&'static Field> {
        self.changes()?.fields.iter().find(|f| f.name == name)
    }

    /// Names of the fields of this kind, and of the fields that it may change.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> {
        self.fields.iter().chain(self.changes().into_iter().flat_map(|k| k.fields)).map(|f| f.name)
    }

    /// The field that an unknown name most likely means.
    pub fn meant(&self, name: &str) -> Option<&'static str> {
        let known = called(Names::Fields, name, self.field_names());
        known.or_else(|| crate::diag::nearest::nearest(name, self.field_names()))
    }

    /// The field and its word that have an argument with this name.
    pub fn argument(&self, name: &str) -> Option<(&'static Field, &'static Word)> {
        let takes = |word: &&Word| word.arguments.iter().any(|a| a.name == name);
        self.fields.iter().find_map(|field| Some((field, field.form.words().into_iter().find(takes)?)))
    }

    /// Whether the language has this field but this version does not read it.
    pub fn plans(&self, name: &str) -> bool {
        self.planned.contains(&name) || self.changes().is_some_and(|k| k.plans(name))
    }
}

impl Basis {
    pub fn factor(&self, name: &str) -> Option<f64> {
        self.names.iter().find(|(n, _)| *n == name).map(|(_, f)| *f)
    }

    /// `per wheel, per wheelset or per bogie`
    pub fn list(&self) -> String {
        let names: Vec<String> = self.names.iter().map(|(n, _)| format!("`per {n}`")).collect();
        crate::diag::or_list(&names)
    }
}

impl Form {
    /// The expected value, for a message: `a stiffness in MN/m`.
    pub fn describe(&self) -> String {
        match self {
            Form::Text => "text in double quotes".into(),
            Form::Number(m) if m.unit.is_empty() => "a plain number".into(),
            Form::Number(m) => {
                let dimension = crate::units::Dimension::of_unit(m.unit);
                match dimension.name() {
                    Some(name) => format!("{name} in `{}`", m.unit),
                    None if dimension.is_none() => format!("a share in `{}`", m.unit),
                    None => format!("a quantity in `{}`", m.unit),
                }
            }
            Form::Integer { .. } => "a whole number".into(),
            Form::Words(words) => {
                let names: Vec<String> = words.iter().filter(|w| !w.planned).map(|w| format!("`{}`", w.name)).collect();
                crate::diag::or_list(&names)
            }
            Form::Object(kind) => format!("a {kind}"),
            Form::OneOf(forms) => {
                let names: Vec<String> = forms.iter().map(Form::describe).collect();
                crate::diag::or_list(&names)
            }
            Form::List(item) => format!("a list of {}", item.describe()),
            Form::Pairs { key, value, .. } => format!("a list of pairs, {}: {}", key.describe(), value.describe()),
            Form::Interval(m) if m.unit.is_empty() => "`from .. to`".into(),
            Form::Interval(m) => format!("`from .. to` in `{}`", m.unit),
            Form::Place => "a place in `m` or `sleepers`".into(),
            Form::Span => "a span such as `-20 .. -1 sleepers`".into(),
            Form::Name => "a name".into(),
            Form::Response => "a response such as `rail_seat_load`".into(),
            Form::Rule => "the name of a physics rule".into(),
            Form::Comparison => "a comparison such as `max(settlement) < 3 mm`".into(),
            Form::Expression => "an expression of responses such as `max(settlement)`".into(),
            Form::Axes => "a list of pairs, path: values".into(),
            Form::Settings => "a list of pairs, path: value".into(),
        }
    }

    /// The word of the form with this name.
    pub fn word(&self, name: &str) -> Option<&'static Word> {
        match self {
            Form::Words(words) => words.iter().find(|w| w.name == name),
            Form::OneOf(forms) => forms.iter().find_map(|f| f.word(name)),
            Form::List(item) => item.word(name),
            _ => None,
        }
    }

    /// The measure of the number; the first measure if several units are allowed.
    pub fn measure(&self) -> Option<&Measure> {
        match self {
            Form::Number(measure) => Some(measure),
            Form::OneOf(forms) => forms.iter().find_map(Form::measure),
            _ => None,
        }
    }

    /// All words of the form.
    pub fn words(&self) -> Vec<&'static Word> {
        match self {
            Form::Words(words) => words.iter().collect(),
            Form::OneOf(forms) => forms.iter().flat_map(Form::words).collect(),
            Form::List(item) => item.words(),
            _ => Vec::new(),
        }
    }
}
