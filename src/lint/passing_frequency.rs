//! L1007 and L1012: sleepers pass at a rate near the resonance of a bogie on its springs or of a wheel on the track.
//!
//! f = v / s is compared with sqrt(2 k1 / m_b) / 2 pi (bounce), sqrt(2 k1 (w/2)^2 / J_b) / 2 pi (pitch) and the
//! resonance of a wheel on the track. Ranges of speed near two resonances often overlap. One warning names them as one
//! range, so that no speed outside the range is near another resonance.

use super::led;
use super::wheel_on_track::resonance;
use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic, and_list};
use crate::graph::Graph;
use crate::scenario::{Scenario, Track, Train, Vehicle};
use crate::units::number;
use std::f64::consts::PI;

/// Largest relative difference of near frequencies.
const NEAR: f64 = 0.1;
/// Ranges of speed with a smaller gap are joined, km/h, because no train keeps its speed in such a gap.
const GAP: f64 = 5.0;

/// A resonance that passing sleepers excite at one speed.
#[derive(PartialEq)]
struct Resonance {
    rule: Code,
    what: String,
    /// Hz.
    frequency: f64,
    /// Distance of the sleepers that excite it, m.
    spacing: f64,
}

impl Resonance {
    fn is_near(&self, speed: f64) -> bool {
        (speed / self.spacing / self.frequency - 1.0).abs() <= NEAR
    }

    /// Whole km/h around the speeds that are near.
    fn range(&self) -> [f64; 2] {
        let speed = self.frequency * self.spacing * 3.6;
        [(speed * (1.0 - NEAR)).floor(), (speed * (1.0 + NEAR)).ceil()]
    }
}

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let speed = traffic.train.speed;
    let allowed = |rule: Code| scenario.allow.iter().any(|(name, _)| Some(name.as_str()) == rule.rule());
    let denied = |rule: Code| scenario.deny.iter().any(|name| Some(name.as_str()) == rule.rule());
    let mut all = resonances(scenario, graph, traffic.train);
    all.retain(|resonance| !allowed(resonance.rule));
    let near: Vec<&Resonance> = all.iter().filter(|resonance| resonance.is_near(*speed)).collect();
    // a denied rule comes first, then the first rule
    let Some(rule) = near.iter().map(|resonance| resonance.rule).min_by_key(|rule| (!denied(*rule), *rule)) else {
        return Vec::new();
    };
    let diagnostic = Diagnostic::new(rule, message(*speed, &near)).help(help(*speed, &all));
    vec![match speed.origin.span() {
        Some(span) => diagnostic.label(span, "this speed"),
        None => diagnostic,
    }]
}

fn message(speed: f64, near: &[&Resonance]) -> String {
    let mut rates: Vec<String> = near.iter().map(|resonance| number((speed / resonance.spacing).round())).collect();
    rates.dedup();
    let resonances: Vec<String> =
        near.iter().map(|r| format!("{} at {} Hz", r.what, number(r.frequency.round()))).collect();
    format!(
        "at {} km/h sleepers pass at {} Hz, near {}",
        number((speed * 36.0).round() / 10.0),
        and_list(&rates),
        and_list(&resonances)
    )
}

/// All speeds that are near a resonance, the range with this one first.
fn help(speed: f64, all: &[Resonance]) -> String {
    let mut ranges = joined(all.iter().map(Resonance::range).collect());
    let here = |range: &[f64; 2]| (range[0]..=range[1]).contains(&(speed * 3.6));
    ranges.sort_by_key(|range| !here(range));
    let ranges: Vec<String> =
        ranges.iter().map(|[from, to]| format!("from {} to {} km/h", number(*from), number(*to))).collect();
    format!("avoid speeds {}: a resonance is near; at other speeds there is none", and_list(&ranges))
}

/// Ranges by ascending speed; ranges that meet become one.
fn joined(mut ranges: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for range in ranges {
        match joined.last_mut().filter(|last| range[0] < last[1] + GAP) {
            Some(last) => last[1] = last[1].max(range[1]),
            None => joined.push(range),
        }
    }
    joined
}

/// Resonances that passing sleepers can excite, each once.
fn resonances(scenario: &Scenario, graph: &Graph, train: &Train) -> Vec<Resonance> {
    let track = &scenario.track;
    let mut found: Vec<Resonance> = Vec::new();
    let mut add = |resonance: Resonance| {
        if !found.contains(&resonance) {
            found.push(resonance);
        }
    };
    for (i, section) in track.sections.iter().enumerate() {
        let (spacing, beam) = (usual_bay(track, i), Winkler::of_section(track, &graph.supports, i));
        for vehicle in &train.vehicles {
            for (name, frequency) in of_bogies(vehicle) {
                let what = format!("the bogie {name} of `{}`", vehicle.name);
                add(Resonance { rule: Code::L1007, what, frequency, spacing });
            }
            if let Some(beam) = &beam {
                let what = format!("a wheel of `{}` on the track of `{}`", vehicle.name, section.name);
                add(Resonance { rule: Code::L1012, what, frequency: resonance(beam, vehicle), spacing });
            }
        }
    }
    found
}

/// A bogie on its primary springs, Hz.
fn of_bogies(vehicle: &Vehicle) -> [(&'static str, f64); 2] {
    let stiffness = 2.0 * *vehicle.primary_stiffness;
    let half = *vehicle.wheelset_spacing / 2.0;
    let bounce = (stiffness / *vehicle.bogie_mass).sqrt() / (2.0 * PI);
    let pitch = (stiffness * half * half / *vehicle.bogie_pitch_inertia).sqrt() / (2.0 * PI);
    [("bounce", bounce), ("pitch", pitch)]
}

/// The median distance of the seats of a section, m.
fn usual_bay(track: &Track, section: usize) -> f64 {
    let seats = track.seats_of(section);
    let mut bays: Vec<f64> = seats.map(|seat| track.bay(seat)).collect();
    bays.sort_by(f64::total_cmp);
    bays.get(bays.len() / 2).copied().unwrap_or(*track.sections[section].spacing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_meet_are_one() {
        assert_eq!(
            joined(vec![[78.0, 97.0], [20.0, 30.0], [84.0, 104.0], [108.0, 120.0]]),
            [[20.0, 30.0], [78.0, 120.0]]
        );
        assert_eq!(joined(vec![[10.0, 50.0], [20.0, 30.0], [55.0, 60.0]]), [[10.0, 50.0], [55.0, 60.0]]);
    }
}
