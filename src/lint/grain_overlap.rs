//! L1021: grains overlap so much under their load that they no longer act as hard grains.
//!
//! The mean contact force of grains of the median size is `F = pi d^2 p / (Z phi)`. Their approach is F / k (or
//! Hertz's); the overlap is the approach over the radius d / 2. Above a hundredth the bed is softer and denser than a
//! bed of stone.

use super::grains::{approach, beds, contact_force, mm};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Contact, Scenario};
use crate::units::number;

/// Overlap over radius.
const LARGEST: f64 = 0.01;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = Vec::new();
    for bed in beds(scenario, graph) {
        let (pressure, median) = (bed.pressure(scenario, graph), bed.granular.grading.d(50.0));
        let force = contact_force(median, pressure);
        let overlap = approach(&bed.granular.contact, median, force);
        let share = overlap / (median / 2.0);
        if share <= LARGEST {
            continue;
        }
        let diagnostic = Diagnostic::new(
            Code::L1021,
            format!(
                "grains of `{}` overlap by about {} % of their radius: {} N per contact at {} kPa for grains of {} mm",
                bed.layer.name,
                number((share * 1e3).round() / 10.0),
                number(force.round()),
                number((pressure / 1e3).round()),
                mm(median)
            ),
        );
        let (origin, help) = match &bed.granular.contact {
            Contact::Linear { stiffness } => {
                let needed = (**stiffness * share / LARGEST / 1e5).ceil() / 10.0;
                (stiffness.origin, format!("write `contact_stiffness = {} MN/m per contact` or more", number(needed)))
            }
            Contact::Hertz { youngs_modulus, .. } => {
                let needed = (**youngs_modulus * (share / LARGEST).powf(1.5) / 1e8).ceil() / 10.0;
                (youngs_modulus.origin, format!("give the rock `youngs_modulus = {} GPa` or more", number(needed)))
            }
        };
        let diagnostic = diagnostic.help(help);
        let diagnostic = match origin.span() {
            Some(span) => diagnostic.label(span, "too soft for this load"),
            None => diagnostic,
        };
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
}
