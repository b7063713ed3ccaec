//! L1031: the level of the rail as built exceeds the alert limit at that speed.
//!
//! EN 13848-5 limits the longitudinal level in waves of 3 .. 25 m (D1), from mean to peak, by speed. Its alert limits,
//! at which repair is planned, are ranges; the rule uses their lower ends, from memory and unchecked. The mean level is
//! taken over 25 m around each place, over less near the ends of the track.

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Profile, Scenario};
use crate::units::number;

/// Speed, km/h, and the largest difference of the level from its mean up to this speed, m.
const LIMITS: [(f64, f64); 5] = [(80.0, 12e-3), (120.0, 10e-3), (160.0, 8e-3), (230.0, 7e-3), (f64::INFINITY, 6e-3)];
/// Half the length over which the mean is taken, m.
const HALF: f64 = 12.5;
/// Distance between the places that are checked, m.
const STEP: f64 = 0.25;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let Some(level) = &scenario.track.irregularity else { return Vec::new() };
    let speed = *traffic.train.speed * 3.6;
    let within = |limit: &&(f64, f64)| speed <= limit.0 * (1.0 + 1e-9);
    let (Some((_, limit)), Some((x, off))) = (LIMITS.iter().find(within), furthest(level)) else { return Vec::new() };
    if off.abs() <= *limit {
        return Vec::new();
    }
    let mm = |length: f64| number((length * 1e4).round() / 10.0);
    let side = if off > 0.0 { "below" } else { "above" };
    let message = format!(
        "at x = {} m the rail lies {} mm {side} its mean level over 25 m: the alert limit at {} km/h is {} mm",
        number((x * 1e2).round() / 1e2),
        mm(off.abs()),
        number((speed * 10.0).round() / 10.0),
        mm(*limit)
    );
    let slower = LIMITS.iter().rev().find(|(_, allowed)| off.abs() <= *allowed);
    let slower = slower.map_or(String::new(), |(speed, _)| format!(", or run at {} km/h or less", number(*speed)));
    let help = format!("write a smaller `irregularity`{slower}; write a settlement that opens voids as `settlement`");
    let diagnostic = Diagnostic::new(Code::L1031, message).help(help);
    vec![match level.origin.span() {
        Some(span) => diagnostic.label(span, "this level"),
        None => diagnostic,
    }]
}

/// The place at which a level is furthest from its mean, and the difference, m.
fn furthest(level: &Profile) -> Option<(f64, f64)> {
    let (start, end) = (level.pieces.first()?.start, level.pieces.last()?.end);
    let count = ((end - start) / STEP).floor() as usize + 1;
    let place = |i: usize| start + i as f64 * STEP;
    let values: Vec<f64> = (0..count).map(|i| level.value(place(i))).collect();
    let mut sums = vec![0.0];
    for value in &values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let reach = (HALF / STEP) as usize;
    let off = |i: usize| {
        // equally far to the left and to the right, so that a constant slope has no difference
        let half = reach.min(i).min(count - 1 - i);
        values[i] - (sums[i + half + 1] - sums[i - half]) / (2 * half + 1) as f64
    };
    (0..count).map(|i| (place(i), off(i))).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}
