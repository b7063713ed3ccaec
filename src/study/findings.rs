//! Diagnostics of the points of a study, shown at the place where the study gives the values, and once for all points
//! with the same diagnostic.

use super::design::Level;
use super::point::values;
use crate::diag::{Code, Diagnostic, FileId, Label, Severity, Sources, Span};
use crate::scenario::{Study, Values};
use std::collections::BTreeMap;

/// The place of a point's diagnostic in the scene of the study.
pub(super) type Place = Vec<Label>;

/// Finds places of a point's sources in the sources of the scene.
pub(super) struct Places<'a> {
    pub base: &'a Sources,
    pub own: &'a Sources,
    /// Overrides of the command line, common to both.
    pub given: usize,
    pub study: &'a Study,
    pub levels: &'a [Level],
}

impl Places<'_> {
    pub fn place_of(&self, diagnostic: &Diagnostic) -> Option<Place> {
        let labels: Vec<Label> = diagnostic
            .labels
            .iter()
            .filter_map(|label| Some(Label { span: self.span(label.span)?, text: label.text.clone() }))
            .collect();
        (!labels.is_empty()).then_some(labels)
    }

    /// The axes and settings of the study for the edited lines of a diagnostic; `None` if it has no edited lines.
    pub fn of_edits(&self, diagnostic: &Diagnostic) -> Option<Place> {
        let settings = self.study.set.iter().map(|setting| setting.span);
        let edits: Vec<Span> = settings.chain(self.study.axes.iter().map(|axis| axis.span)).collect();
        let edited = |label: &Label| {
            let index = (label.span.file.0 as usize).checked_sub(self.given + 1)?;
            Some(Label { span: *edits.get(index)?, text: label.text.clone() })
        };
        let labels: Vec<Label> = diagnostic.labels.iter().filter_map(edited).collect();
        (!labels.is_empty()).then_some(labels)
    }

    /// Overrides follow the main file, in order; an edited line is shown at the place where the study gives its value.
    fn span(&self, span: Span) -> Option<Span> {
        let file = span.file.0 as usize;
        if file <= self.given {
            return Some(span);
        }
        let edited = file - self.given - 1;
        if let Some(setting) = self.study.set.get(edited) {
            return Some(setting.span);
        }
        if let Some(axis) = self.study.axes.get(edited - self.study.set.len()) {
            let choice = self.levels[edited - self.study.set.len()].choice;
            return Some(match (&axis.values, choice) {
                (Values::Listed(choices), Some(choice)) => choices[choice].span,
                _ => axis.span,
            });
        }
        let own = self.own.get(span.file);
        let same = self.base.iter().find(|(_, s)| s.name == own.name && s.text == own.text);
        same.map(|(file, _): (FileId, _)| Span { file, ..span })
    }
}

/// Diagnostics of points, grouped by message and place.
#[derive(Default)]
pub(super) struct Findings {
    order: Vec<Finding>,
    known: BTreeMap<(Code, Option<Span>), usize>,
}

struct Finding {
    diagnostic: Diagnostic,
    place: Option<Place>,
    points: usize,
    /// Number and levels of the first point.
    first: (usize, Vec<Level>),
}

impl Findings {
    pub fn add(&mut self, diagnostic: Diagnostic, place: Option<Place>, number: usize, levels: &[Level]) {
        let key = (diagnostic.code, place.as_ref().map(|labels| labels[0].span));
        match self.known.get(&key) {
            Some(index) => {
                let finding = &mut self.order[*index];
                // a point may have several diagnostics at one place, and counts once
                finding.points += usize::from(finding.first.0 != number);
            }
            None => {
                self.known.insert(key, self.order.len());
                self.order.push(Finding { diagnostic, place, points: 1, first: (number, levels.to_vec()) });
            }
        }
    }

    pub fn told(self, study: &Study, all: usize) -> Vec<Diagnostic> {
        self.order.into_iter().map(|finding| finding.told(study, all)).collect()
    }
}

impl Finding {
    fn told(self, study: &Study, all: usize) -> Diagnostic {
        let (number, levels) = &self.first;
        let Diagnostic { code, severity, message, help, .. } = self.diagnostic;
        let many = match self.points {
            1 => format!("point {number} of {all}"),
            n => format!("{n} of {all} points"),
        };
        let first = format!("{}with {}", if self.points == 1 { "" } else { "the first " }, values(study, levels));
        let labels = self.place.unwrap_or_else(|| vec![Label { span: study.span, text: "varied here".into() }]);
        if severity != Severity::Error {
            let message = format!("{message} ({many} of study `{}`, {first})", study.name);
            return Diagnostic { code, severity, message, labels, help, fixes: Vec::new() };
        }
        let help = match help {
            Some(help) => help,
            None => "narrow the varied values, or leave such points out with a condition in `subject_to`".to_string(),
        };
        let code = if code == Code::E0705 { String::new() } else { format!(" ({code})") };
        let message = format!("{many} of study `{}` cannot run: {message}{code}, {first}", study.name);
        Diagnostic { code: Code::E0705, severity, message, labels, help: Some(help), fixes: Vec::new() }
    }
}
