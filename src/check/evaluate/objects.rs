//! Objects to write instead of a number or a word: `{ stiffness = 40 MN/m }` for `40 MN/m`, `[wagon: 10]` for
//! `10 wagon`.

use crate::diag::Help;
use crate::schema::{self, Field, Form, Kind, Need};
use crate::units::{Dimension, parse_unit};

/// The object to write instead of a number, if the object has one required field; `value` is the value of that field.
pub fn of_number(form: &Form, number: &str, value: &str) -> Option<Help> {
    let bare = number.split(" per ").next().unwrap_or(number);
    let (_, unit) = bare.split_once(' ')?;
    let dimension = parse_unit(unit.trim()).ok()?.dimension;
    let takes = |field: &&Field| field.form.measure().is_some_and(|m| Dimension::of_unit(m.unit) == dimension);
    let mut kinds = objects(form).into_iter().filter_map(|kind| {
        let mut needed = kind.fields.iter().filter(|f| f.need == Need::Required);
        let only = needed.next().filter(|_| needed.next().is_none()).filter(takes)?;
        let open = kind.alternatives.iter().all(|a| a.default.is_some());
        open.then_some(only.name)
    });
    let field = kinds.next()?;
    Some(Help::write(format!("{{ {field} = {value} }}")))
}

/// The object that has a field with that word.
pub fn of_word(form: &Form, word: &str, text: &str) -> Option<Help> {
    let mut fields = objects(form).into_iter().flat_map(|kind| kind.fields);
    let field = fields.find(|field| field.form.word(word).is_some())?;
    Some(Help::write(format!("{{ {} = {text} }}", field.name)))
}

/// Help for `10 wagon` and `10 * wagon` in a field that counts objects.
pub fn counted(form: &Form, text: &str) -> Option<Help> {
    let Form::Object("vehicle") = form else { return None };
    let parts: Vec<&str> = text.split([' ', '*']).filter(|part| !part.is_empty()).collect();
    let [first, second] = parts.as_slice() else { return None };
    let (count, name) = if first.parse::<u32>().is_ok() { (first, second) } else { (second, first) };
    count.parse::<u32>().ok().map(|count| Help::write(format!("[{name}: {count}]")))
}

fn objects(form: &Form) -> Vec<&'static Kind> {
    match form {
        Form::Object(kind) => schema::kind(kind).into_iter().collect(),
        Form::OneOf(forms) => forms.iter().flat_map(objects).collect(),
        _ => Vec::new(),
    }
}
