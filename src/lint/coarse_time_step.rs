//! L1005: the time step does not resolve the fastest motion: the wheel on its contact spring, a sleeper between pad and
//! support, or the passage from sleeper to sleeper.
//!
//! f = sqrt(k / m) / 2 pi, twenty steps per period. For the contact k = 1.5 C^(2/3) F^(1/3) at the static wheel load;
//! for a sleeper k is the sum of pad and support. Sleepers pass at f = v / spacing.

use super::{Led, led};
use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, SupportNode};
use crate::scenario::{Foot, Scenario, Seat};
use crate::units::{number, rounded_down};
use std::f64::consts::PI;

const STEPS_A_PERIOD: f64 = 20.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let fast = [
        ("the wheel on its contact spring", contact(scenario, traffic)),
        ("a sleeper between pad and support", sleeper(scenario, graph)),
        ("the passage from sleeper to sleeper", passing(scenario, traffic)),
    ];
    let Some((what, frequency)) = fast.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    let needed = 1.0 / (STEPS_A_PERIOD * frequency);
    let step = traffic.blocks.passage.time_step;
    if step <= needed || traffic.blocks.passage.adaptive.is_some() {
        return Vec::new();
    }
    let diagnostic = Diagnostic::new(
        Code::L1005,
        format!(
            "a time step of {} ms gives {} steps per period of {what} ({} Hz), which is too few",
            number(step * 1e3),
            number((1.0 / (step * frequency)).round()),
            number(frequency.round())
        ),
    )
    .help(format!("write `time_step = {} s`", number(rounded_down(needed))))
    .rewrite(
        scenario.solve.time_step.fixed().and_then(|step| step.origin.span()),
        format!("{} s", number(rounded_down(needed))),
    );
    vec![match scenario.solve.time_step.span() {
        Some(span) => diagnostic.label(span, "too coarse"),
        None => diagnostic,
    }]
}

fn contact(scenario: &Scenario, traffic: Led<'_>) -> f64 {
    let of_vehicle = |v: &crate::scenario::Vehicle| {
        let load = v.mass() / 4.0 * *scenario.solve.gravity;
        let tangent = 1.5 * v.hertz.powf(2.0 / 3.0) * load.powf(1.0 / 3.0);
        (tangent / *v.wheel_mass).sqrt() / (2.0 * PI)
    };
    traffic.train.vehicles.iter().map(of_vehicle).fold(0.0, f64::max)
}

fn sleeper(scenario: &Scenario, graph: &Graph) -> f64 {
    let of_seat = |(seat, node): (&Seat, &SupportNode)| {
        let Foot::Sleeper { mass, .. } = &seat.foot else { return None };
        let (pad, support) = (seat.pad.as_ref()?, node.support?);
        Some(((*pad.stiffness + support.stiffness) / **mass).sqrt() / (2.0 * PI))
    };
    scenario.track.seats.iter().zip(&graph.supports).filter_map(of_seat).fold(0.0, f64::max)
}

fn passing(scenario: &Scenario, traffic: Led<'_>) -> f64 {
    let shortest = scenario.track.shortest_bay();
    *traffic.train.speed / shortest
}
