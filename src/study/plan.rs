//! The points of a study before the first run: each is the scene with some lines edited, checked and with its cost. A
//! diagnostic of several points is reported once, with their number and the values of the first.

use super::as_it_is::AsItIs;
use super::design::{Level, design};
use super::findings::{Findings, Place, Places};
use super::miss::Miss;
use super::point::{PlannedPoint, Scene, content, leaves_open, settings};
use crate::check::Override;
use crate::compile::Compiled;
use crate::diag::{Code, Diagnostic, has_errors};
use crate::graph::Cost;
use crate::results;
use crate::scenario::response::Expectation;
use crate::scenario::{Repeats, Study};
use crate::units::number;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// A study that has been checked.
#[derive(Debug)]
pub struct Plan {
    pub study: Study,
    /// The scene as it is first, if it can run; then the points of the design in order.
    pub points: Vec<PlannedPoint>,
    /// Points of the design that break a condition.
    pub left_out: usize,
    /// Diagnostics of the study, in the sources of the scene itself.
    pub diagnostics: Vec<Diagnostic>,
}

impl Plan {
    /// Points of the design that will run.
    pub fn designs(&self) -> usize {
        self.points.iter().filter(|point| point.number > 0).count()
    }

    /// Runs of all points, at least and at most.
    pub fn runs(&self) -> [usize; 2] {
        let Repeats { least, most } = self.study.repeats;
        [least, most].map(|repeats| self.points.len() * repeats as usize)
    }

    /// Time of all these runs on one core, estimated, s.
    pub fn seconds(&self) -> [f64; 2] {
        let Repeats { least, most } = self.study.repeats;
        let once = self.points.iter().map(|p| p.seconds).sum::<f64>();
        [least, most].map(|repeats| once * f64::from(repeats))
    }

    /// The most memory of this number of simultaneous runs, estimated, bytes.
    pub fn bytes(&self, at_a_time: usize) -> u64 {
        let each = self.points.iter().flat_map(|p| (0..self.study.repeats.least).map(|_| p.bytes));
        let mut each: Vec<u64> = each.collect();
        each.sort_unstable_by(|a, b| b.cmp(a));
        each.iter().take(at_a_time).fold(0, |sum, bytes| sum.saturating_add(*bytes))
    }
}

/// The result of checking a point.
enum Checked {
    LeftOut,
    Legal { fingerprint: String, cost: Cost, seed: u64, as_it_is: bool, remarks: Vec<(Diagnostic, Option<Place>)> },
    Illegal(Vec<(Diagnostic, Option<Place>)>),
}

/// Checks every point. `base` is the scene as it is, without errors.
pub fn plan(scene: Scene<'_>, base: &Compiled, study: &Study) -> Plan {
    plan_told(scene, base, study, &|_, _| {})
}

/// The same, and reports the number of checked points; from any thread, in any order.
pub fn plan_told(scene: Scene<'_>, base: &Compiled, study: &Study, tell: &(dyn Fn(u64, u64) + Sync)) -> Plan {
    let seed = base.scenario.as_ref().map_or(1, |s| s.solve.seed);
    let points: Vec<(Vec<Level>, Vec<Override>)> = design(study, seed)
        .into_iter()
        .map(|levels| {
            let overrides = overrides(study, &levels);
            (levels, overrides)
        })
        .collect();
    let all = points.len();
    let as_it_is = AsItIs::new(scene, study);
    let known = as_it_is.as_ref().ok();
    let done = AtomicU64::new(0);
    let check_one = |(levels, overrides): &(Vec<Level>, Vec<Override>)| {
        let checked = check(scene, base, study, levels, overrides, known);
        tell(done.fetch_add(1, Ordering::Relaxed) + 1, all as u64);
        checked
    };
    let checked: Vec<Checked> = points.par_iter().map(check_one).collect();
    let mut plan = Plan { study: study.clone(), points: Vec::new(), left_out: 0, diagnostics: Vec::new() };
    let mut found = Findings::default();
    for (index, (checked, (levels, overrides))) in checked.into_iter().zip(points).enumerate() {
        let number = index + 1;
        match checked {
            Checked::LeftOut => plan.left_out += 1,
            Checked::Legal { fingerprint, cost: Cost { seconds, bytes, .. }, seed, as_it_is, remarks } => {
                remarks.into_iter().for_each(|(d, place)| found.add(d, place, number, &levels));
                let point = PlannedPoint { number, as_it_is, levels, overrides, fingerprint, seconds, bytes, seed };
                plan.points.push(point);
            }
            Checked::Illegal(mistakes) => {
                mistakes.into_iter().for_each(|(d, place)| found.add(d, place, number, &levels));
            }
        }
    }
    plan.diagnostics = found.told(study, all);
    match as_it_is {
        Ok(as_it_is) => plan.points = with_as_it_is(plan.points, as_it_is.point),
        // a scene that cannot run has been reported, and a mistake of all points is reported for the points
        Err(_) if base.runnable().is_none() || has_errors(&plan.diagnostics) => {}
        Err(warning) => plan.diagnostics.push(warning),
    }
    plan.diagnostics.extend(against_the_whole(&plan, all));
    plan.diagnostics.extend(without_seed(scene, &plan));
    plan
}

/// The points with the scene as it is in front: the equal point of the design, else an additional point.
fn with_as_it_is(mut points: Vec<PlannedPoint>, as_it_is: PlannedPoint) -> Vec<PlannedPoint> {
    let same = points.iter().position(|point| point.as_it_is).map(|index| points.remove(index));
    points.iter_mut().for_each(|point| point.as_it_is = false);
    points.insert(0, same.unwrap_or(as_it_is));
    points
}

fn overrides(study: &Study, levels: &[Level]) -> Vec<Override> {
    let varied = study.axes.iter().zip(levels);
    let varied = varied.map(|(axis, level)| Override { path: axis.path.clone(), value: level.text.clone() });
    settings(study).into_iter().chain(varied).collect()
}

fn check(
    scene: Scene<'_>,
    base: &Compiled,
    study: &Study,
    levels: &[Level],
    overrides: &[Override],
    as_it_is: Option<&AsItIs>,
) -> Checked {
    let compiled = scene.compile(overrides);
    let own = compiled.studies.iter().find(|s| s.name == study.name);
    // a condition may exclude exactly the mistakes of the point
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
            // an edited line may leave an object unused
            let known = |d: &Diagnostic| base.diagnostics.iter().any(|known| known.code == d.code);
            let new = |d: &&Diagnostic| d.code != Code::E0412 && d.code != Code::E0429 && !known(d);
            // unused lines of the scene are reported for the scene, and unused lines of an axis once for all its values
            let idle = compiled.diagnostics.iter().filter(|d| d.code == Code::E0429);
            let idle = idle.filter_map(|d| Some((d.clone(), Some(places.of_edits(d)?))));
            let remarks = compiled.diagnostics.iter().filter(new).map(placed).chain(idle).collect();
            let fingerprint = content(study, &compiled);
            let as_it_is = as_it_is.zip(own).is_some_and(|(as_it_is, own)| as_it_is.is(run, own));
            Checked::Legal { fingerprint, cost: run.cost, seed: scenario.solve.seed, as_it_is, remarks }
        }
        _ if errors.is_empty() => {
            // a hole of the scene itself is reported for the scene
            let told = |d: &&Diagnostic| base.diagnostics.iter().any(|b| (b.code, &b.message) == (d.code, &d.message));
            Checked::Illegal(compiled.diagnostics.iter().filter(|d| !told(d)).map(placed).collect())
        }
        _ => Checked::Illegal(errors),
    }
}

/// Checks the budget, and whether any point is left.
fn against_the_whole(plan: &Plan, all: usize) -> Option<Diagnostic> {
    let study = &plan.study;
    if plan.left_out == all {
        let broken = study.constraints.iter().find(|c| condition(c).is_some()).map_or(study.span, |c| c.span);
        let message = format!("every one of the {all} points of study `{}` breaks a condition", study.name);
        return Some(
            Diagnostic::new(Code::E0708, message)
                .label(broken, "no point is left")
                .help("remove the condition, or vary over a wider range"),
        );
    }
    let (budget, span) = study.budget?;
    let [_, seconds] = plan.seconds();
    (seconds > budget).then(|| {
        let hours = |s: f64| number((s / 36.0).round() / 100.0);
        let [_, runs] = plan.runs();
        let message = format!(
            "study `{}` takes {} {} h of computing for {runs} runs, more than its budget of {} h",
            study.name,
            if study.repeats.are_open() { "up to" } else { "about" },
            hours(seconds),
            hours(budget)
        );
        Diagnostic::new(Code::E0709, message)
            .label(span, "the budget")
            .help("use fewer points or axles, or increase the budget")
    })
}

/// Repeats differ by their seed, which needs a line in the scene.
fn without_seed(scene: Scene<'_>, plan: &Plan) -> Option<Diagnostic> {
    let point = plan.points.first().filter(|_| plan.study.repeats.are_several())?;
    let compiled = scene.compile(&point.overrides_of(1));
    let mistake = compiled.diagnostics.iter().find(|d| d.is_error())?;
    let name = &plan.study.name;
    let message = format!("study `{name}` cannot be repeated with another seed: {}", mistake.message);
    let help = mistake.help.clone();
    Some(Diagnostic::new(Code::E0705, message).label(plan.study.span, "has `repeats`").maybe_help(help))
}

/// The result of a comparison that needs no run; `None` for other comparisons.
fn condition(comparison: &Expectation) -> Option<bool> {
    if comparison.operands.iter().any(|e| e.needs_a_run()) {
        return None;
    }
    let values: Vec<f64> = comparison.operands.iter().map(results::known).collect::<Option<_>>()?;
    Some(Miss::against(comparison, &values).is_none())
}
