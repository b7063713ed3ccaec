//! L1025: histories have too few samples per period, or more samples than the run has steps.
//!
//! A wheel oscillates on the track at f, see [`super::wheel_on_track`]. The axles of a bogie, a apart, pass a seat at v
//! / a. Samples every t miss the peak of an oscillation by up to 1 - cos(pi f t): 5 % at ten samples per period, 100 %
//! at two.

use super::wheel_on_track::resonance;
use super::winkler::Winkler;
use super::{Led, led};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Given, Scenario};
use crate::units::number;
use std::f64::consts::PI;

const SAMPLES_A_PERIOD: f64 = 10.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let intervals = scenario.records.iter().filter_map(|record| record.every);
    let mut found: Vec<Diagnostic> = Vec::new();
    for every in intervals {
        let mistake = too_fine(every, traffic).or_else(|| too_coarse(every, scenario, graph, traffic));
        let mistake = mistake.map(|mistake| match every.origin.span() {
            Some(span) => mistake.label(span, "interval of the samples"),
            None => mistake,
        });
        found.extend(mistake.filter(|mistake| !found.contains(mistake)));
    }
    found
}

/// Histories have at most one value per step; with adaptive steps, one value per longest step.
fn too_fine(every: Given, traffic: Led<'_>) -> Option<Diagnostic> {
    let step = traffic.blocks.passage.time_step;
    let message = format!(
        "samples every {} ms are asked for, but the time step is {} ms: the run gives one sample per step",
        number(*every * 1e3),
        number(step * 1e3)
    );
    let help = format!("write `every = {} s`, or a `time_step` as short as the interval of the samples", number(step));
    let written = format!("{} s", number(step));
    (*every < 0.6 * step)
        .then(|| Diagnostic::new(Code::L1025, message).help(help).rewrite(every.origin.span(), written))
}

fn too_coarse(every: Given, scenario: &Scenario, graph: &Graph, traffic: Led<'_>) -> Option<Diagnostic> {
    let (what, frequency) = fastest(scenario, graph, traffic)?;
    let samples = 1.0 / (*every * frequency);
    if samples >= SAMPLES_A_PERIOD {
        return None;
    }
    let missed = if samples > 2.0 { 100.0 * (1.0 - (PI / samples).cos()) } else { 100.0 };
    let message = format!(
        "a sample every {} ms gives {} per period of {what} ({} Hz): peaks are too small by up to {} %",
        number(*every * 1e3),
        number((10.0 * samples).floor() / 10.0),
        number(frequency.round()),
        number(missed.round())
    );
    let enough = (1e4 / (SAMPLES_A_PERIOD * frequency)).floor() / 1e4;
    let help = format!("write `every = {} s`, or leave it out", number(enough));
    let written = format!("{} s", number(enough));
    Some(Diagnostic::new(Code::L1025, message).help(help).rewrite(every.origin.span(), written))
}

/// The fastest motion in every history, and its frequency, Hz.
fn fastest(scenario: &Scenario, graph: &Graph, traffic: Led<'_>) -> Option<(&'static str, f64)> {
    let (track, speed) = (&scenario.track, *traffic.train.speed);
    let sections = (0..track.sections.len()).filter_map(|section| Winkler::of_section(track, &graph.supports, section));
    let vehicles = &traffic.train.vehicles;
    let wheels = sections.flat_map(|section| vehicles.iter().map(move |v| resonance(&section, v)).collect::<Vec<_>>());
    let axles = vehicles.iter().map(|vehicle| speed / *vehicle.wheelset_spacing);
    let all = wheels.map(|f| ("a wheel on the track", f)).chain(axles.map(|f| ("passing axles", f)));
    all.max_by(|a, b| a.1.total_cmp(&b.1))
}
