//! The settlement law of the supports.

use super::Origin;
use crate::schema;
use crate::solvers::settlement::{Form, Law, Logarithm};
use crate::units::{number, parse_unit};
use serde::{Deserialize, Serialize};

/// A settlement law of the scene, for half a sleeper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettlementLaw {
    pub name: String,
    pub law: Law,
    /// Range of peak forces per seat for which the law was calibrated, N.
    pub loads: Option<(f64, f64)>,
    /// Range of axle counts for which the law was calibrated.
    pub cycles: Option<(f64, f64)>,
    /// Range of voids for which the law was calibrated, m.
    pub voids: Option<(f64, f64)>,
    /// Largest error against what the law was fitted to / largest settlement; a law that states it is not used beyond
    /// its ranges.
    pub error: Option<f64>,
    /// Place in the text that names the law.
    pub origin: Origin,
}

/// An argument of a law in the notation of the language, from its SI value: `35 kN per seat`, `0.11 mm^-1`.
pub fn law_argument(form: &str, argument: &str, value: f64) -> String {
    let word = schema::kind("law").and_then(|k| k.field("form")?.form.word(form));
    let field = word.and_then(|w| w.arguments.iter().find(|a| a.name == argument));
    let Some(measure) = field.and_then(|f| f.form.measure()) else { return number(value) };
    let size = parse_unit(measure.unit).map_or(1.0, |u| u.factor);
    let unit = if measure.unit.is_empty() { String::new() } else { format!(" {}", measure.unit) };
    let basis = measure.basis.map_or(String::new(), |b| format!(" per {}", b.names[0].0));
    format!("{}{unit}{basis}", number(value / size))
}

/// A form with its arguments in the notation of the language.
pub fn law_form(mut form: Form) -> String {
    let name = form.name();
    let arguments = form.parameters().into_iter();
    let mut values: Vec<String> =
        arguments.map(|(argument, value)| format!("{argument} = {}", law_argument(name, argument, *value))).collect();
    if let Form::Hettler(hettler) = form {
        let word = if hettler.logarithm == Logarithm::Decimal { "decimal" } else { "natural" };
        values.push(format!("logarithm = {word}"));
    }
    format!("{name}({})", values.join(", "))
}
