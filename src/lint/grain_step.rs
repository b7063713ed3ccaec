//! L1020: a stated step of grains needs so much additional inertia that sleepers settle less.
//!
//! A track on grains gives each grain the mass `m'` that its step needs ([`mass_for_step`]), so a longer step makes
//! light grains heavier and is not unstable. The share of inertia that this adds to a layer is the mean of `m' / m - 1`
//! over the mass in grains that are lighter than `m'`. `docs/charts/grain_inertia.csv` has the settlement for 1, 9 and
//! 42 %; on the spheres of that scene the share found here agrees with the run to 0.2 %.

use super::grains::{GrainLayer, beds};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::nodes::mass_for_step;
use crate::scenario::{Contact, Scenario};
use crate::units::number;
use std::f64::consts::PI;

/// Additional inertia / mass of a section up to which settlement does not change by more than its scatter.
const MOST: f64 = 0.1;
/// Parts of equal mass into which a grading is split.
const PARTS: u32 = 1000;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(step) = scenario.solve.grains.step.filter(|_| graph.has_grains_under_track()) else { return Vec::new() };
    let layers = beds(scenario, graph);
    let Some((added, bed)) = worst(&layers, *step).filter(|(added, _)| *added > MOST) else { return Vec::new() };
    let lighter = heavier_below(&bed, *step);
    let smaller = (6.0 * lighter / (PI * *bed.granular.density)).cbrt();
    let diagnostic = Diagnostic::new(
        Code::L1020,
        format!(
            "a step of {} us adds {} % of inertia to the grains of `{}`: those below {} mm become as heavy as one of {} g",
            micro(*step),
            number((added * 100.0).round()),
            bed.section.name,
            number((smaller * 1e3).round()),
            number((lighter * 1e4).round() / 10.0)
        ),
    )
    .help(format!(
        "write `grain_step = auto`, or at most {} us; with more than {} % sleepers settle less than they should",
        micro(longest(&layers, *step)),
        number(MOST * 100.0)
    ))
    .rewrite(step.origin.span(), "auto");
    let (set_by, what) = match (bed.granular.grading.cut_below, &bed.granular.contact) {
        (Some(cut), _) => (cut.origin, "the smallest grains"),
        (None, Contact::Linear { stiffness }) => (stiffness.origin, "these contacts"),
        (None, Contact::Hertz { youngs_modulus, .. }) => (youngs_modulus.origin, "these contacts"),
    };
    let places = [(step.origin, "too long"), (set_by, what)];
    vec![places.into_iter().fold(diagnostic, |diagnostic, (origin, text)| match origin.span() {
        Some(span) => diagnostic.label(span, text),
        None => diagnostic,
    })]
}

/// The section with the largest share of additional inertia, by its layer that gets most of it.
fn worst<'a>(layers: &[GrainLayer<'a>], step: f64) -> Option<(f64, GrainLayer<'a>)> {
    let of_section = |section: usize| {
        let layers = layers.iter().filter(|bed| bed.index == section);
        let weights = |bed: &GrainLayer<'_>| bed.layer.thickness.value_at(bed.section.start) * *bed.granular.density;
        let mass: f64 = layers.clone().map(weights).sum();
        let of_layer = |bed: &GrainLayer<'a>| (weights(bed) / mass * added(bed, step), *bed);
        let shares: Vec<(f64, GrainLayer<'a>)> = layers.map(of_layer).collect();
        let most = shares.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((shares.iter().map(|(share, _)| share).sum::<f64>(), most.1))
    };
    let sections = layers.iter().filter_map(|bed| of_section(bed.index));
    sections.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Longest step without too much inertia, s: at most `step`, to 1 %.
fn longest(layers: &[GrainLayer<'_>], step: f64) -> f64 {
    let fits = |step: &f64| worst(layers, *step).is_none_or(|(added, _)| added <= MOST);
    (0..1000).map(|times| step * 0.99f64.powi(times)).find(fits).unwrap_or(0.0)
}

/// Additional inertia / mass of a layer.
fn added(bed: &GrainLayer<'_>, step: f64) -> f64 {
    let lighter = heavier_below(bed, step);
    let part = |number: u32| {
        let size = bed.granular.grading.d(100.0 * (f64::from(number) + 0.5) / f64::from(PARTS));
        (lighter / (PI / 6.0 * size.powi(3) * *bed.granular.density) - 1.0).max(0.0)
    };
    (0..PARTS).map(part).sum::<f64>() / f64::from(PARTS)
}

/// Mass below which grains of a layer get more inertia, kg.
fn heavier_below(bed: &GrainLayer<'_>, step: f64) -> f64 {
    match bed.granular.contact {
        Contact::Linear { stiffness } => mass_for_step(step, *stiffness),
        // a track on such grains is refused
        Contact::Hertz { .. } => 0.0,
    }
}

/// A time, s, in us to a tenth.
fn micro(time: f64) -> String {
    number((time * 1e7).round() / 10.0)
}
