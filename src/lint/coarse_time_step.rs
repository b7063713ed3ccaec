//! L1005: the time step does not resolve the wheel on its contact spring.
//!
//! f = sqrt(k_H / m_w) / 2 pi with the tangent k_H = 1.5 C^(2/3) F^(1/3) at the static wheel load; twenty steps a period.

use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, Schedule};
use crate::scenario::Scenario;
use crate::units::number;

const STEPS_A_PERIOD: f64 = 20.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Schedule::Blocks(blocks) = &graph.schedule else { return Vec::new() };
    let frequency = blocks
        .train
        .vehicles
        .iter()
        .map(|v| {
            let load = v.mass() / 4.0 * *scenario.solve.gravity;
            let tangent = 1.5 * v.hertz.powf(2.0 / 3.0) * load.powf(1.0 / 3.0);
            (tangent / *v.wheel_mass).sqrt() / (2.0 * std::f64::consts::PI)
        })
        .fold(0.0, f64::max);
    let needed = 1.0 / (STEPS_A_PERIOD * frequency);
    let step = blocks.passage.time_step;
    if step <= needed {
        return Vec::new();
    }
    let diagnostic = Diagnostic::new(
        Code::L1005,
        format!(
            "a step of {} ms leaves {} steps to a period of the wheel on its contact spring, {} Hz",
            number(step * 1e3),
            number((1.0 / (step * frequency)).round()),
            number(frequency.round())
        ),
    )
    .help(format!("write `time_step = {} s`", number((needed * 1e5).floor() / 1e5)));
    vec![match scenario.solve.time_step.fixed().and_then(|t| t.origin.span()) {
        Some(span) => diagnostic.at(span, "coarse"),
        None => diagnostic,
    }]
}
