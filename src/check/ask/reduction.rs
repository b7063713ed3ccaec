//! Reductions of a response to one number: `max(contact_force, over = -20 .. -1 sleepers, after = 100 axles)`.

use super::expression::Typed;
use super::reader::Reader;
use crate::check::evaluate::shape::ShapeKind;
use crate::check::evaluate::value::Val;
use crate::check::evaluate::written::looks_like;
use crate::check::text::scope::ScopeId;
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Help};
use crate::scenario::response::{Expression, Measure, Place, Reduction, Response};
use crate::schema::{self, Names, Varies, called};
use crate::syntax::tree::{Argument, Item, Name, ValueKind};
use crate::units::Dimension;

const REDUCTIONS: [&str; 7] = ["max", "min", "mean", "rms", "percentile", "place_of_max", "misfit"];

/// Measure of a measured column, by the SI unit of the response that is compared with it.
static MEASURED: [schema::Measure; 8] =
    [any_in("N"), any_in("N m"), any_in("m"), any_in("m/s"), any_in("m/s^2"), any_in("N/m"), any_in("Pa"), any_in("s")];

const fn any_in(unit: &'static str) -> schema::Measure {
    schema::Measure { unit, min: f64::MIN, max: f64::MAX, basis: None, varies: Varies::No }
}

impl Reader<'_, '_> {
    /// Whether a call reduces a response. Otherwise `max` and `min` are functions of numbers.
    pub(super) fn reduces(&self, word: &Name, arguments: &[Argument], scope: ScopeId) -> bool {
        if !REDUCTIONS.contains(&word.text.as_str()) {
            return false;
        }
        if !matches!(word.text.as_str(), "max" | "min") {
            return true;
        }
        match arguments.first().map(|argument| (&argument.name, &argument.value.kind)) {
            None | Some((Some(_), _)) => true,
            Some((None, ValueKind::Path(path))) if path.names.len() == 1 => {
                // a word that is not a name of the file is a misspelt response
                let name = path.names[0].text.as_str();
                let item =
                    self.eval.scopes[scope].names.get(name).map(|item| &self.eval.scopes[scope].tree.items[*item]);
                let of_scene = Response::of_name(name).is_some_and(|response| response.place() == Place::Scene);
                !matches!(item, Some(Item::Let(_))) && !of_scene
            }
            _ => false,
        }
    }

    /// Refuses a reduction with a name from other programs.
    pub(super) fn foreign_reduction(&mut self, word: &Name, arguments: &[Argument]) -> bool {
        let response = match arguments.first().map(|a| &a.value.kind) {
            Some(ValueKind::Path(path)) => path.text(),
            _ => return false,
        };
        let share = word.text.strip_prefix(['p', 'P']).and_then(|digits| digits.parse::<u32>().ok());
        let share = if word.text == "median" { Some(50) } else { share.filter(|share| *share <= 100) };
        let help = match share {
            Some(share) => Help::say(format!("write `percentile({response}, {share} %)`")),
            None => match called(Names::Reductions, &word.text, REDUCTIONS.into_iter()) {
                Some(ours) => Help::meant(ours),
                None => return false,
            },
        };
        self.eval.findings.report(
            Diagnostic::new(Code::E0408, format!("`{}` is not a reduction of a response", word.text))
                .label(word.span, "unknown word")
                .advise(word.span, help),
        );
        true
    }

    /// `max(contact_force, over = -20 .. -1 sleepers, after = 100 axles)`
    pub fn measure(&mut self, word: &Name, arguments: &[Argument], scope: ScopeId) -> Option<Typed> {
        let response = match arguments.first().map(|a| (&a.name, &a.value.kind)) {
            Some((None, ValueKind::Path(path))) if path.names.len() == 1 => self.eval.response(&path.names[0])?,
            _ => {
                self.eval.findings.report(
                    Diagnostic::new(Code::E0406, format!("`{}` needs a response", word.text))
                        .label(word.span, "no response given")
                        .help(format!("write something like `{}(settlement)`", word.text)),
                );
                return None;
            }
        };
        let (reduction, taken) = self.reduction(word, arguments, response, scope)?;
        let by_place = reduction == Reduction::PlaceOfMax;
        let mut measure = Measure::new(reduction, response);
        let named = |wanted: &str| {
            arguments.iter().skip(1).find(|a| a.name.as_ref().is_some_and(|n| n.text == wanted)).map(|a| &a.value)
        };
        let transition = match named("from").map(|v| (&v.kind, v.span)) {
            Some((ValueKind::Path(path), span)) if path.names.len() == 1 => Some((path.text(), span)),
            Some((other, span)) => {
                self.eval.findings.report(
                    Diagnostic::new(
                        Code::E0406,
                        format!("expected the name of a transition, found {}", looks_like(other)),
                    )
                    .label(span, "not a transition"),
                );
                return None;
            }
            None => None,
        };
        for argument in &arguments[taken..] {
            let name = argument.name.as_ref().map_or("", |n| n.text.as_str());
            match (name, &argument.value.kind) {
                ("over", ValueKind::Range(from, to)) => {
                    let Val::Range(a, b) = self.eval.span(from, to, scope)? else { return None };
                    // without places the track is not understood, and there is no scene
                    let Some(places) = self.counting.places else { continue };
                    let from = transition.as_ref().map(|(name, span)| (name.as_str(), *span));
                    measure.over = Some(places.span(a, b, from, argument.value.span, &mut self.eval.findings)?);
                }
                ("from", _) => {}
                ("after", _) => measure.after = Some(self.count(&argument.value, scope)?),
                _ => {
                    let place = argument.name.as_ref().map_or(argument.value.span, |n| n.span);
                    let known = ["over", "from", "after"];
                    let near = called(Names::Fields, name, known.into_iter()).or_else(|| nearest(name, known));
                    self.eval.findings.report(
                        Diagnostic::new(Code::E0402, format!("`{}` has no such argument", word.text))
                            .label(place, "unknown argument")
                            .help("it takes `over = span`, `from = transition` and `after = axles`")
                            .maybe_meant(place, near),
                    );
                    return None;
                }
            }
        }
        let unit = if by_place { "m" } else { response.unit() };
        Some((Expression::Measure(measure), Dimension::of_unit(unit)))
    }

    /// The reduction that a word names, and how many arguments by place it and its response take.
    fn reduction(
        &mut self,
        word: &Name,
        arguments: &[Argument],
        response: Response,
        scope: ScopeId,
    ) -> Option<(Reduction, usize)> {
        Some(match word.text.as_str() {
            "min" => (Reduction::Min, 1),
            "mean" => (Reduction::Mean, 1),
            "rms" => (Reduction::Rms, 1),
            "place_of_max" => (Reduction::PlaceOfMax, 1),
            "percentile" => (self.percentile(word, arguments, scope)?, 2),
            "misfit" => (self.misfit(word, arguments, response)?, 2),
            _ => (Reduction::Max, 1),
        })
    }

    /// `percentile(wheel_force, 95 %)`
    fn percentile(&mut self, word: &Name, arguments: &[Argument], scope: ScopeId) -> Option<Reduction> {
        let Some(share) = arguments.get(1).filter(|argument| argument.name.is_none()) else {
            self.eval.findings.report(
                Diagnostic::new(Code::E0403, "`percentile` needs the share of values that lie below")
                    .label(word.span, "no share given")
                    .help("write something like `percentile(wheel_force, 95 %)`"),
            );
            return None;
        };
        let raw = self.eval.raw(&share.value, scope)?;
        if !raw.dimension.is_none() {
            let text = format!("expected a share in `%`, found {}", raw.dimension.describe());
            self.eval.findings.report(Diagnostic::new(Code::E0302, text).label(raw.span, "not a share"));
            return None;
        }
        if !(0.0..=1.0).contains(&raw.value) {
            let text = format!("expected 0 .. 100 %, found {} %", crate::units::number(100.0 * raw.value));
            let written = (0.0..=100.0)
                .contains(&raw.value)
                .then(|| Help::write(format!("{} %", crate::units::number(raw.value))));
            let mistake = Diagnostic::new(Code::E0405, text).label(raw.span, "out of range");
            self.eval.findings.report(mistake.maybe_advise(raw.span, written));
            return None;
        }
        Some(Reduction::Percentile(raw.value))
    }

    /// `misfit(settlement, file("measured.csv"))`
    fn misfit(&mut self, word: &Name, arguments: &[Argument], response: Response) -> Option<Reduction> {
        let file = match arguments.get(1).map(|argument| (&argument.name, &argument.value.kind, argument.value.span)) {
            Some((None, ValueKind::Call { word, arguments }, span)) if word.text == "file" => {
                Some((word, arguments, span))
            }
            _ => None,
        };
        let Some((file, columns, span)) = file else {
            self.eval.findings.report(
                Diagnostic::new(Code::E0403, "`misfit` needs a file of measured values")
                    .label(word.span, "no file given")
                    .help(format!("write something like `misfit({}, file(\"measured.csv\"))`", response.name())),
            );
            return None;
        };
        let Some(measure) = MEASURED.iter().find(|measure| measure.unit == response.unit()) else {
            let text = format!("`{}` is not a value along the track", response.name());
            self.eval.findings.report(
                Diagnostic::new(Code::E0406, text).label(arguments[0].value.span, "cannot be compared with a file"),
            );
            return None;
        };
        let Some(ShapeKind::Table { rows, .. }) = self.eval.data_profile(measure, file, columns, None, span) else {
            return None;
        };
        Some(Reduction::Misfit(rows.into_iter().map(|(x, value)| (x, value.value)).collect()))
    }
}
