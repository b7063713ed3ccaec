//! The points of a study before the first one runs: each is the scene with some lines edited, checked and costed like any
//! other. What stands against points is said once, with how many it concerns and the values of the first.

use super::design::{Level, design};
use crate::check::{Modules, Override};
use crate::compile::{Compiled, compile, fingerprint};
use crate::diag::{Code, Diagnostic, FileId, Label, Severity, Sources, Span};
use crate::graph::Graph;
use crate::lower;
use crate::results;
use crate::scenario::response::Expectation;
use crate::scenario::{Study, Track, Values};
use crate::store::sha256;
use crate::syntax::tree::Comparison;
use crate::units::number;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A scene that can be compiled again and again.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub name: &'a str,
    pub text: &'a str,
    pub modules: &'a (dyn Modules + Sync),
    /// Overrides of every point, those of the command line.
    pub set: &'a [Override],
}

/// A point that will run.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPoint {
    /// Its place in the design, from 1.
    pub number: usize,
    /// One for each axis.
    pub levels: Vec<Level>,
    pub overrides: Vec<Override>,
    /// Names what runs: SHA-256 over the study's name and every text of the point, its own lines included.
    pub fingerprint: String,
    /// Time of one run on one core, estimated, s.
    pub seconds: f64,
    pub seed: u64,
}

/// A study that has been checked.
#[derive(Debug)]
pub struct Plan {
    pub study: Study,
    pub points: Vec<PlannedPoint>,
    /// Points of the design that break a condition.
    pub left_out: usize,
    /// What stands against the study, over the sources of the scene itself.
    pub diagnostics: Vec<Diagnostic>,
}

impl Scene<'_> {
    pub fn compile(&self, overrides: &[Override]) -> Compiled {
        let all = [self.set, overrides].concat();
        compile(self.name, self.text, self.modules, &all)
    }
}

impl PlannedPoint {
    /// The lines of one of its runs: the first has the seed of the scene, each further one the next.
    pub fn overrides_of(&self, repeat: u32) -> Vec<Override> {
        let seed = self.seed + u64::from(repeat);
        let further = (repeat > 0).then(|| Override { path: "solve.seed".into(), value: seed.to_string() });
        self.overrides.iter().cloned().chain(further).collect()
    }
}

impl Plan {
    /// Time of all runs on one core, estimated, s.
    pub fn seconds(&self) -> f64 {
        self.points.iter().map(|p| p.seconds).sum::<f64>() * f64::from(self.study.repeats)
    }
}

/// What became of a point when it was checked.
enum Checked {
    LeftOut,
    Legal { fingerprint: String, seconds: f64, seed: u64, remarks: Vec<(Diagnostic, Option<Place>)> },
    Illegal(Vec<(Diagnostic, Option<Place>)>),
}

/// Where a diagnostic of a point stands in the scene of the study.
type Place = Vec<Label>;

/// Checks every point. `base` is the scene as it stands, without errors.
pub fn plan(scene: Scene<'_>, base: &Compiled, study: &Study) -> Plan {
    let seed = base.scenario.as_ref().map_or(1, |s| s.solve.seed);
    let points: Vec<(Vec<Level>, Vec<Override>)> = design(study, seed)
        .into_iter()
        .map(|levels| {
            let overrides = overrides(study, &levels);
            (levels, overrides)
        })
        .collect();
    let all = points.len();
    let checked: Vec<Checked> =
        points.par_iter().map(|(levels, overrides)| check(scene, base, study, levels, overrides)).collect();
    let mut plan = Plan { study: study.clone(), points: Vec::new(), left_out: 0, diagnostics: Vec::new() };
    let mut found = Findings::default();
    for (index, (checked, (levels, overrides))) in checked.into_iter().zip(points).enumerate() {
        let number = index + 1;
        match checked {
            Checked::LeftOut => plan.left_out += 1,
            Checked::Legal { fingerprint, seconds, seed, remarks } => {
                remarks.into_iter().for_each(|(d, place)| found.add(d, place, number, &levels));
                plan.points.push(PlannedPoint { number, levels, overrides, fingerprint, seconds, seed });
            }
            Checked::Illegal(mistakes) => {
                mistakes.into_iter().for_each(|(d, place)| found.add(d, place, number, &levels));
            }
        }
    }
    plan.diagnostics = found.told(study, all);
    plan.diagnostics.extend(against_the_whole(&plan, all));
    plan.diagnostics.extend(without_seed(scene, &plan));
    plan
}

fn overrides(study: &Study, levels: &[Level]) -> Vec<Override> {
    let fixed = study.set.iter().map(|s| Override { path: s.path.clone(), value: s.value.clone() });
    let varied = study.axes.iter().zip(levels);
    fixed.chain(varied.map(|(axis, level)| Override { path: axis.path.clone(), value: level.text.clone() })).collect()
}

fn check(scene: Scene<'_>, base: &Compiled, study: &Study, levels: &[Level], overrides: &[Override]) -> Checked {
    let compiled = scene.compile(overrides);
    let own = compiled.studies.iter().find(|s| s.name == study.name);
    // a condition may be there against the very mistakes that the point has
    if own.is_some_and(|s| s.constraints.iter().any(|c| condition(c) == Some(false))) {
        return Checked::LeftOut;
    }
    let places = Places { base: &base.sources, own: &compiled.sources, given: scene.set.len(), study, levels };
    let placed = |d: &Diagnostic| (d.clone(), places.place_of(d));
    let mut errors: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).map(placed).collect();
    let run = compiled.runnable();
    let track = compiled.scenario.as_ref().map(|scenario| &scenario.track);
    errors.extend(
        own.zip(run).zip(track).and_then(|((own, run), track)| leaves_open(run, track, own)).map(|d| (d, None)),
    );
    match (&compiled.scenario, run) {
        (Some(scenario), Some(run)) if errors.is_empty() => {
            // an edited line may leave what it stood for unused
            let known = |d: &Diagnostic| base.diagnostics.iter().any(|known| known.code == d.code);
            let new = |d: &&Diagnostic| d.code != Code::E0412 && d.code != Code::E0429 && !known(d);
            // what the scene's own lines do not do is told there, and that of an axis once for all of its values
            let idle = compiled.diagnostics.iter().filter(|d| d.code == Code::E0429);
            let idle = idle.filter_map(|d| Some((d.clone(), Some(places.of_edits(d)?))));
            let remarks = compiled.diagnostics.iter().filter(new).map(placed).chain(idle).collect();
            let fingerprint = content(study, &compiled);
            Checked::Legal { fingerprint, seconds: run.cost.seconds, seed: scenario.solve.seed, remarks }
        }
        _ if errors.is_empty() => {
            // a hole of the scene itself is told there
            let told = |d: &&Diagnostic| base.diagnostics.iter().any(|b| (b.code, &b.message) == (d.code, &d.message));
            Checked::Illegal(compiled.diagnostics.iter().filter(|d| !told(d)).map(placed).collect())
        }
        _ => Checked::Illegal(errors),
    }
}

/// Names what a point asks and of what: two studies of one file ask other things of one scene.
fn content(study: &Study, compiled: &Compiled) -> String {
    sha256(format!("{}\n{}", study.name, fingerprint(&compiled.sources)).as_bytes())
}

/// A study that asks for what no run keeps would learn so after the first one.
fn leaves_open(graph: &Graph, track: &Track, study: &Study) -> Option<Diagnostic> {
    let measured = study.measured();
    let compared = study.constraints.iter().flat_map(|c| &c.operands);
    let why = measured.iter().map(|m| &m.expression).chain(compared).find_map(|e| lower::not_kept(e, graph, track))?;
    let help = "ask for what the tables hold (see section 6 of the guide), or `record` it at the seats of interest";
    Some(Diagnostic::new(Code::E0705, why).help(help))
}

/// Budget, and whether anything is left.
fn against_the_whole(plan: &Plan, all: usize) -> Option<Diagnostic> {
    let study = &plan.study;
    if plan.left_out == all {
        let broken = study.constraints.iter().find(|c| condition(c).is_some()).map_or(study.span, |c| c.span);
        let message = format!("every one of the {all} points of study `{}` breaks a condition", study.name);
        return Some(
            Diagnostic::new(Code::E0708, message)
                .label(broken, "no point is left")
                .help("take the condition out, or vary further"),
        );
    }
    let (budget, span) = study.budget?;
    let seconds = plan.seconds();
    (seconds > budget).then(|| {
        let hours = |s: f64| number((s / 36.0).round() / 100.0);
        let runs = plan.points.len() * study.repeats as usize;
        let message = format!(
            "study `{}` takes about {} h of computing for {runs} runs, more than its {} h",
            study.name,
            hours(seconds),
            hours(budget)
        );
        Diagnostic::new(Code::E0709, message)
            .label(span, "the budget")
            .help("take fewer points or axles, or raise the budget")
    })
}

/// Repeats differ by their seed, which needs a line to stand in.
fn without_seed(scene: Scene<'_>, plan: &Plan) -> Option<Diagnostic> {
    let point = plan.points.first().filter(|_| plan.study.repeats > 1)?;
    let compiled = scene.compile(&point.overrides_of(1));
    let mistake = compiled.diagnostics.iter().find(|d| d.is_error())?;
    let name = &plan.study.name;
    let message = format!("study `{name}` cannot be repeated with another seed: {}", mistake.message);
    let help = mistake.help.clone();
    Some(Diagnostic::new(Code::E0705, message).label(plan.study.span, "has `repeats`").maybe_help(help))
}

/// Finds places of a point's sources in those of the scene.
struct Places<'a> {
    base: &'a Sources,
    own: &'a Sources,
    /// Overrides of the command line, which both have.
    given: usize,
    study: &'a Study,
    levels: &'a [Level],
}

impl Places<'_> {
    fn place_of(&self, diagnostic: &Diagnostic) -> Option<Place> {
        let labels: Vec<Label> = diagnostic
            .labels
            .iter()
            .filter_map(|label| Some(Label { span: self.span(label.span)?, text: label.text.clone() }))
            .collect();
        (!labels.is_empty()).then_some(labels)
    }

    /// The axes and settings of the study by which a diagnostic speaks of edited lines; `None` where it speaks of none.
    fn of_edits(&self, diagnostic: &Diagnostic) -> Option<Place> {
        let settings = self.study.set.iter().map(|setting| setting.span);
        let edits: Vec<Span> = settings.chain(self.study.axes.iter().map(|axis| axis.span)).collect();
        let edited = |label: &Label| {
            let index = (label.span.file.0 as usize).checked_sub(self.given + 1)?;
            Some(Label { span: *edits.get(index)?, text: label.text.clone() })
        };
        let labels: Vec<Label> = diagnostic.labels.iter().filter_map(edited).collect();
        (!labels.is_empty()).then_some(labels)
    }

    /// Overrides stand behind the main file, in their order; an edited line is told where the study gives its value.
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

/// Diagnostics of points, gathered where they say the same of the same place.
#[derive(Default)]
struct Findings {
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
    fn add(&mut self, diagnostic: Diagnostic, place: Option<Place>, number: usize, levels: &[Level]) {
        let key = (diagnostic.code, place.as_ref().map(|labels| labels[0].span));
        match self.known.get(&key) {
            Some(index) => {
                let finding = &mut self.order[*index];
                // a point may say several things of one place, and counts once
                finding.points += usize::from(finding.first.0 != number);
            }
            None => {
                self.known.insert(key, self.order.len());
                self.order.push(Finding { diagnostic, place, points: 1, first: (number, levels.to_vec()) });
            }
        }
    }

    fn told(self, study: &Study, all: usize) -> Vec<Diagnostic> {
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
            return Diagnostic { code, severity, message, labels, help };
        }
        let help = match help {
            Some(help) => help,
            None => "narrow what varies, or leave such points out with a condition in `subject_to`".to_string(),
        };
        let code = if code == Code::E0705 { String::new() } else { format!(" ({code})") };
        let message = format!("{many} of study `{}` cannot run: {message}{code}, {first}", study.name);
        Diagnostic { code: Code::E0705, severity, message, labels, help: Some(help) }
    }
}

/// `open.pad.stiffness = 40 MN/m, ore.speed = 200 km/h`
pub fn values(study: &Study, levels: &[Level]) -> String {
    let lines = study.axes.iter().zip(levels).map(|(axis, level)| format!("{} = {}", axis.path, level.text));
    lines.collect::<Vec<_>>().join(", ")
}

/// What a comparison that needs no run says; `None` for the others.
fn condition(comparison: &Expectation) -> Option<bool> {
    if comparison.operands.iter().any(|e| e.needs_a_run()) {
        return None;
    }
    let values: Vec<f64> = comparison.operands.iter().map(results::known).collect::<Option<_>>()?;
    let holds = |(pair, operator): (&[f64], &Comparison)| results::holds(pair[0], *operator, pair[1]);
    Some(values.windows(2).zip(&comparison.operators).all(holds))
}
