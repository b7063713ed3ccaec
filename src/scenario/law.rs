//! The settlement law of the supports.

use super::{Origin, Scenario, Seat};
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

impl Scenario {
    /// The laws that settle sleepers, each once: that of `solve` first, if some sleeper has none of its own.
    pub fn driving_laws(&self) -> Vec<&SettlementLaw> {
        self.laws_of(&self.track.seats)
    }

    /// The laws that settle sleepers of a section.
    pub fn driving_laws_of(&self, section: usize) -> Vec<&SettlementLaw> {
        self.laws_of(&self.track.seats[self.track.seats_of(section)])
    }

    fn laws_of<'a>(&'a self, seats: &'a [Seat]) -> Vec<&'a SettlementLaw> {
        let mut laws: Vec<&SettlementLaw> = Vec::new();
        let ballasted = || seats.iter().filter(|seat| seat.is_ballasted());
        if ballasted().next().is_none() || ballasted().any(|seat| seat.own_law().is_none()) {
            laws.push(&self.solve.law);
        }
        for own in ballasted().filter_map(Seat::own_law) {
            if !laws.iter().any(|law| (&law.name, law.law) == (&own.name, own.law)) {
                laws.push(own);
            }
        }
        laws
    }
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
