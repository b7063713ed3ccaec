//! L1020: the step of grains is longer than the stability limit of the smallest grain.
//!
//! A grain of mass m among larger grains, held by Z contacts of stiffness k and tangential ratio r, oscillates with
//! `w^2 = K / m`, `K = Z k (1 + 2 r) / 3`. A leapfrog with dashpots of ratio beta, shear dashpots of ratio beta_s and
//! local damping alpha is stable up to `dt = (2 / w) (sqrt(1 + xi^2) - xi) / sqrt(1 + alpha)`,
//! `xi = (beta + 2 beta_s sqrt(r)) sqrt(Z / (3 (1 + 2 r)))`. The message names the material with the smallest limit.

use super::grains::{GrainLayer, approach, beds, contact_force};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Contact, Scenario};
use crate::units::number;
use std::f64::consts::PI;

/// Number of contacts of a grain in the rule.
const CONTACTS: f64 = 6.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(step) = scenario.solve.grains.step else { return Vec::new() };
    let limits = beds(scenario, graph).into_iter().map(|bed| (limit(&bed, bed.pressure(scenario, graph)), bed));
    let Some((limit, bed)) = limits.min_by(|a, b| a.0.total_cmp(&b.0)) else { return Vec::new() };
    if *step <= limit {
        return Vec::new();
    }
    let granular = bed.granular;
    let smallest = granular.grading.smallest();
    let diagnostic = Diagnostic::new(
        Code::L1020,
        format!(
            "a step of {} us is {} times the limit for the grains of `{}`, {} us: the smallest have {} g and {} mm",
            number((*step * 1e8).round() / 100.0),
            number((*step / limit * 10.0).round() / 10.0),
            bed.layer.name,
            number((limit * 1e8).round() / 100.0),
            number((mass(&bed) * 1e4).round() / 10.0),
            number((smallest * 1e4).round() / 10.0)
        ),
    )
    .help("write `grain_step = auto`; a larger `cut_below` or softer contacts allow a longer step")
    .rewrite(step.origin.span(), "auto");
    let (set_by, what) = match granular.grading.cut_below {
        Some(cut) => (cut.origin, "the smallest grains"),
        None => match granular.contact {
            Contact::Linear { stiffness } => (stiffness.origin, "these contacts"),
            Contact::Hertz { youngs_modulus, .. } => (youngs_modulus.origin, "these contacts"),
        },
    };
    let places = [(step.origin, "too long"), (set_by, what)];
    vec![places.into_iter().fold(diagnostic, |diagnostic, (origin, text)| match origin.span() {
        Some(span) => diagnostic.label(span, text),
        None => diagnostic,
    })]
}

/// Mass of the smallest grain, kg.
fn mass(bed: &GrainLayer<'_>) -> f64 {
    PI / 6.0 * bed.granular.grading.smallest().powi(3) * *bed.granular.density
}

/// s.
fn limit(bed: &GrainLayer<'_>, pressure: f64) -> f64 {
    let granular = bed.granular;
    let size = granular.grading.smallest();
    let (_, stiffness) = approach(&granular.contact, size, contact_force(size, pressure));
    let shear = *granular.shear_ratio;
    let held = CONTACTS * (1.0 + 2.0 * shear) / 3.0;
    let frequency = (held * stiffness / mass(bed)).sqrt();
    let ratio = *granular.viscous_damping + 2.0 * *granular.shear_damping * shear.sqrt();
    let damping = ratio * (CONTACTS / (3.0 * (1.0 + 2.0 * shear))).sqrt();
    2.0 / frequency * ((1.0 + damping * damping).sqrt() - damping) / (1.0 + *granular.local_damping).sqrt()
}
