//! `random(mean, cov = 10 %)`: a value that scatters along the track.

use super::evaluator::Evaluator;
use super::number::{Number, Raw};
use super::shape::{Random, ShapeKind};
use super::value::{Slot, Val};
use super::written::Per;
use crate::check::text::scope::ScopeId;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::Origin;
use crate::schema::{Measure, RANDOM};
use crate::syntax::tree::{Argument, Field, Item, Name, Value, ValueKind};
use crate::units::Dimension;

impl Evaluator<'_> {
    /// Reads `random(...)`; `None` if a diagnostic has been given.
    pub fn random(
        &mut self,
        measure: &'static Measure,
        word: &Name,
        arguments: &[Argument],
        per: Per,
        scope: ScopeId,
    ) -> Option<ShapeKind> {
        let Some(first) = arguments.first().filter(|a| a.name.is_none()) else {
            self.findings.report(
                Diagnostic::new(Code::E0403, "`random` needs its mean")
                    .label(word.span, "no mean given")
                    .help("write something like `random(mean, cov = 10 %)`"),
            );
            return None;
        };
        let (sds, others): (Vec<&Argument>, Vec<&Argument>) =
            arguments[1..].iter().partition(|a| a.name.as_ref().is_some_and(|n| n.text == "sd"));
        let sd = self.one_sd(&sds)?;
        let others: Vec<Argument> = others.into_iter().cloned().collect();
        let mut slot = Slot {
            value: self.word(&RANDOM, &others, word, scope)?,
            span: word.span,
            origin: Origin::Written(word.span),
        };
        self.one_scatter(&slot, sd)?;
        self.complete_slot(&mut slot);
        let Val::Word { arguments: given, .. } = slot.value else { return None };
        let mean = self.raw(&first.value, scope)?;
        let mean = self.hold(measure, Raw { basis: mean.basis.clone().or(per.clone()), ..mean })?;
        let plain = |name: &str| match given.get(name)?.value {
            Val::Number(n) => Some(n.value),
            _ => None,
        };
        let (cov, correlation) = (plain("cov")?, plain("correlation")?);
        let seed = if given.contains_key("seed") { Some(plain("seed")? as u64) } else { None };
        let Val::Word { word: distribution, .. } = &given.get("distribution")?.value else { return None };
        let log_normal = distribution.name == "log_normal";
        let deviation = match sd {
            Some(sd) => self.deviation(measure, &mean, &sd.value, per, scope)?,
            None => cov * mean.value.abs(),
        };
        self.scatters(&mean, deviation, log_normal, first.value.span)?;
        let path = match given.get("stream").map(|slot| &slot.value) {
            Some(Val::Text(stream)) => stream.clone(),
            _ => self.path_of(word.span, scope),
        };
        Some(ShapeKind::Random(Random { mean, deviation, correlation, log_normal, seed, path, measure }))
    }

    /// Checks that `sd` is given at most once.
    fn one_sd<'a>(&mut self, sds: &[&'a Argument]) -> Option<Option<&'a Argument>> {
        if let [_, again, ..] = sds {
            self.findings.report(
                Diagnostic::new(Code::E0404, "`sd` of `random` is given twice").label(again.value.span, "again here"),
            );
            return None;
        }
        Some(sds.first().copied())
    }

    /// Refuses `cov` beside `sd`.
    fn one_scatter(&mut self, slot: &Slot, sd: Option<&Argument>) -> Option<()> {
        let Val::Word { arguments, .. } = &slot.value else { return None };
        let (Some(sd), Some(cov)) = (sd, arguments.get("cov")) else { return Some(()) };
        // an unknown argument has been reported; missing arguments are then not reported
        if !matches!(cov.value, Val::Error) {
            self.findings.report(
                Diagnostic::new(Code::E0407, "`cov` and `sd` both give the scatter of a random value")
                    .label(sd.value.span, "as a value")
                    .label(cov.span, "as a share of the mean")
                    .help("keep one of the two"),
            );
        }
        None
    }

    /// A standard deviation of the field's dimension, in the basis of the mean.
    fn deviation(
        &mut self,
        measure: &'static Measure,
        mean: &Number,
        value: &Value,
        per: Per,
        scope: ScopeId,
    ) -> Option<f64> {
        let raw = self.raw(value, scope)?;
        let raw = Raw { basis: raw.basis.clone().or(per).or(mean.basis.map(|b| (b.to_string(), raw.span))), ..raw };
        if raw.dimension != Dimension::of_unit(measure.unit) {
            self.wrong_dimension(&raw, &[measure], "expected a standard deviation of the same dimension as the mean");
            return None;
        }
        let (_, factor) = self.basis(measure, &raw)?;
        if raw.value <= 0.0 {
            self.findings.report(
                Diagnostic::new(Code::E0405, "expected a positive standard deviation").label(raw.span, "out of range"),
            );
            return None;
        }
        Some(raw.value * factor / mean.factor)
    }

    /// Checks that the distribution exists.
    fn scatters(&mut self, mean: &Number, deviation: f64, log_normal: bool, span: Span) -> Option<()> {
        let mistake = if log_normal && mean.value <= 0.0 {
            Diagnostic::new(Code::E0405, "the mean of a log-normal value must be positive")
                .label(span, "not above zero")
                .help("`distribution = normal` takes any mean")
        } else if deviation == 0.0 {
            Diagnostic::new(Code::E0405, "a share of a mean of zero is zero")
                .label(span, "no scatter")
                .help("give the scatter as a value: `sd = ...` instead of `cov`")
        } else {
            return Some(());
        };
        self.findings.report(mistake);
        None
    }

    /// The path of the field, or the name of the `let`, in which a place of the text lies.
    fn path_of(&self, place: Span, scope: ScopeId) -> String {
        let inside = |span: Span| span.file == place.file && span.start <= place.start && place.end <= span.end;
        let tree = &self.scopes[scope].tree;
        let path = tree.items.iter().find_map(|item| match item {
            Item::Let(binding) => inside(binding.value.span).then(|| binding.name.text.clone()),
            Item::Declaration(d) => {
                let name = d.name.as_ref().map_or(&d.kind.text, |name| &name.text);
                Some(format!("{name}.{}", path_in(&d.fields, &inside)?))
            }
            Item::Use(_) => None,
        });
        path.unwrap_or_default()
    }
}

fn path_in(fields: &[Field], inside: &dyn Fn(Span) -> bool) -> Option<String> {
    let field = fields.iter().find(|field| inside(field.value.span))?;
    let own = field.path.text();
    let inner = match &field.value.kind {
        ValueKind::Object { fields, .. } => path_in(fields, inside),
        _ => None,
    };
    Some(inner.map_or(own.clone(), |inner| format!("{own}.{inner}")))
}
