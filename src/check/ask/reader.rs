//! The questions of expectations and studies, read when places and counts are known.

use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::parts::traffic::Counted;
use crate::check::places::chainage::Places;
use crate::diag::Span;
use crate::scenario::response::Expectation;
use crate::scenario::{Axis, Measured, Setting};
use crate::schema::Form;
use std::borrow::Borrow;
use std::collections::{BTreeMap, HashMap};

/// The meaning of places and counts in a scene, as far as its track and its traffic are understood.
#[derive(Clone, Copy, Default)]
pub struct Counting<'a> {
    pub places: Option<&'a Places>,
    /// Whether trains run, so that counts are axles.
    pub traffic: bool,
    pub counted: Option<&'a Counted>,
}

/// Reads expressions of responses, and the values that studies vary.
pub struct Reader<'a, 'm> {
    pub eval: &'a mut Evaluator<'m>,
    pub counting: Counting<'a>,
    /// Operands of the comparison that is being read.
    pub operands: &'a mut usize,
}

/// A question at one place.
#[derive(Clone)]
pub enum Question {
    Comparison(Expectation),
    Measured(Measured),
    Axes(Vec<Axis>),
    Settings(Vec<Setting>),
}

/// The questions of one record, by field; questions that are not understood are left out.
#[derive(Default)]
pub struct Questions(BTreeMap<&'static str, Vec<Question>>);

impl Questions {
    fn under(&self, field: &str) -> impl Iterator<Item = &Question> {
        self.0.get(field).into_iter().flatten()
    }

    /// The comparisons that a field asks for.
    pub fn comparisons(&self, field: &str) -> impl Iterator<Item = Expectation> {
        self.under(field).filter_map(|q| if let Question::Comparison(c) = q { Some(c.clone()) } else { None })
    }

    /// The expressions that a field asks for.
    pub fn measured(&self, field: &str) -> impl Iterator<Item = Measured> {
        self.under(field).filter_map(|q| if let Question::Measured(m) = q { Some(m.clone()) } else { None })
    }

    /// The values that a study varies; `None` if they are not understood.
    pub(super) fn axes(&self) -> Option<Vec<Axis>> {
        self.under("vary").find_map(|q| if let Question::Axes(axes) = q { Some(axes.clone()) } else { None })
    }

    /// The values that a study sets in every point; `None` without settings, or if they are not understood.
    pub fn settings(&self) -> Option<Vec<Setting>> {
        self.under("set").find_map(|q| if let Question::Settings(set) = q { Some(set.clone()) } else { None })
    }
}

/// Questions of the records of the main file. A field that several records inherit is read once, so that a mistake in
/// it is reported once.
pub fn questions(records: &[impl Borrow<Record>], eval: &mut Evaluator<'_>, counting: Counting<'_>) -> Vec<Questions> {
    let mut known: HashMap<Span, Vec<Question>> = HashMap::new();
    let asked = records.iter().map(|record| {
        let record = record.borrow();
        // inside the declaration, so that a question that refers back to it is found as a circle
        let id = eval.item_of(record)?;
        eval.within(id, record.span, |eval| Some(asked_by(record, eval, counting, &mut known)))
    });
    asked.map(Option::unwrap_or_default).collect()
}

fn asked_by(
    record: &Record,
    eval: &mut Evaluator<'_>,
    counting: Counting<'_>,
    known: &mut HashMap<Span, Vec<Question>>,
) -> Questions {
    let mut operands = 0;
    let mut reader = Reader { eval, counting, operands: &mut operands };
    let mut fields: Vec<(&'static str, &Slot)> = record.fields.iter().map(|(name, slot)| (*name, slot)).collect();
    // in the order of the text
    fields.sort_by_key(|(_, slot)| slot.span);
    let mut asked = BTreeMap::new();
    for (name, slot) in fields {
        let Some(field) = record.kind.field(name).filter(|field| asks(&field.form)) else { continue };
        let read = known.entry(slot.span).or_insert_with(|| reader.read(&field.form, slot));
        asked.insert(name, read.clone());
    }
    Questions(asked)
}

/// Whether a form contains questions.
fn asks(form: &Form) -> bool {
    match form {
        Form::Comparison | Form::Expression | Form::Axes | Form::Settings => true,
        Form::List(item) => asks(item),
        _ => false,
    }
}

impl Reader<'_, '_> {
    /// The questions in a value of a form, without those that are not understood.
    pub fn read(&mut self, form: &Form, slot: &Slot) -> Vec<Question> {
        let question = match (form, &slot.value) {
            (Form::List(item), Val::List(slots)) => return slots.iter().flat_map(|s| self.read(item, s)).collect(),
            (Form::Comparison, Val::Written(value, scope)) => self.comparison(value, *scope).map(Question::Comparison),
            (Form::Expression, Val::Written(value, scope)) => self.measured(value, *scope).map(Question::Measured),
            (Form::Axes, Val::Written(value, scope)) => self.axes(value, *scope).map(Question::Axes),
            (Form::Settings, Val::Written(value, scope)) => self.settings(value, *scope).map(Question::Settings),
            _ => None,
        };
        question.into_iter().collect()
    }
}
