//! L1026: waves of the level as built are too short for the time step or for the elements of the rail.
//!
//! The rms wavelength of a level z(x) is l = 2 pi s' / s'', with the root mean squares of slope and second derivative.
//! It is the wavelength of a sine, twice the length of a smooth step, and twice the mean distance of the turning points
//! of a random level (Rice 1944). At a speed v the level excites with f = v / l. A wheel moves v dt per step. The rail
//! responds in bending waves of length 2 pi (EI / (m (2 pi f)^2))^(1/4). A wave needs four cubic elements: the fourth
//! power of their phase over 720 is then 1 % of the stiffness.

use super::led;
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::Graph;
use crate::scenario::{Cubic, Curve, Piece, Profile, Scenario, Section};
use crate::units::number;
use std::f64::consts::PI;

const STEPS_A_WAVE: f64 = 10.0;
const ELEMENTS_A_WAVE: f64 = 4.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let Some(level) = &scenario.track.irregularity else { return Vec::new() };
    let Some(wave) = wavelength(level) else { return Vec::new() };
    let speed = *traffic.train.speed;
    let told = |message: String, help: String, setting: Option<Span>, what: &str| {
        let diagnostic = Diagnostic::new(Code::L1026, message).help(help);
        let labels = [(level.origin.span(), "these waves"), (setting, what)];
        labels.into_iter().fold(diagnostic, |d, (span, text)| match span {
            Some(span) => d.label(span, text),
            None => d,
        })
    };
    let mut found = Vec::new();

    let stride = speed * traffic.blocks.passage.time_step;
    if traffic.blocks.passage.adaptive.is_none() && wave / stride < STEPS_A_WAVE {
        let message = format!(
            "a wheel at {} km/h moves {} mm per step, {} steps per wave of {} m of the level",
            number((36.0 * speed).round() / 10.0),
            number((stride * 1e4).round() / 10.0),
            number((10.0 * wave / stride).floor() / 10.0),
            rounded(wave)
        );
        let enough = (1e6 * wave / speed / STEPS_A_WAVE).floor() / 1e6;
        let help = format!("write `time_step = {} s`, or smooth the level", number(enough));
        let value = scenario.solve.time_step.fixed().and_then(|step| step.origin.span());
        let mistake = told(message, help, scenario.solve.time_step.span(), "steps");
        found.push(mistake.rewrite(value, format!("{} s", number(enough))));
    }

    let frequency = speed / wave;
    let bending = |section: &Section| {
        let rail = section.rail.as_ref()?;
        Some(2.0 * PI * (*rail.bending_stiffness / (*rail.mass * (2.0 * PI * frequency).powi(2))).powf(0.25))
    };
    let shortest = scenario.track.sections.iter().filter_map(bending).fold(f64::INFINITY, f64::min);
    let element = scenario.track.shortest_bay() / f64::from(*scenario.solve.elements_per_bay);
    if shortest / element < ELEMENTS_A_WAVE {
        let message = format!(
            "waves of {} m at {} km/h excite the rail at {} Hz: its bending waves of {} m have {} elements",
            rounded(wave),
            number((36.0 * speed).round() / 10.0),
            number(frequency.round()),
            rounded(shortest),
            number((10.0 * shortest / element).floor() / 10.0)
        );
        let enough = (ELEMENTS_A_WAVE * scenario.track.shortest_bay() / shortest).ceil();
        let help = format!("write `elements_per_bay = {}`, or smooth the level", number(enough));
        let value = scenario.solve.elements_per_bay.origin.span();
        found.push(told(message, help, value, "elements").rewrite(value, number(enough)));
    }
    found
}

fn rounded(length: f64) -> String {
    number((length * 1e3).round() / 1e3)
}

/// The rms wavelength of the smooth parts of a level, m; `None` without smooth parts.
fn wavelength(level: &Profile) -> Option<f64> {
    let smooth = level.pieces.iter().filter(|piece| !matches!(piece.curve, Curve::Linear(_)));
    let (mut slope, mut curvature) = (0.0, 0.0);
    for Cubic { ends, values, curvatures } in smooth.flat_map(Piece::cubics) {
        let h = ends[1] - ends[0];
        let mean = (values[1] - values[0]) / h;
        let (sum, tilt) = (0.5 * (curvatures[0] + curvatures[1]) * h, (curvatures[1] - curvatures[0]) * h);
        slope += h * (mean * mean + sum * sum / 12.0 + tilt * tilt / 720.0);
        curvature += (sum * sum + tilt * tilt / 12.0) / h;
    }
    (curvature > 0.0).then(|| 2.0 * PI * (slope / curvature).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Origin;

    fn level(z: impl Fn(f64) -> f64) -> Profile {
        let points: Vec<[f64; 2]> = (-2000..=2000).map(|i| f64::from(i) * 0.01).map(|x| [x, z(x)]).collect();
        let piece = Piece { start: -20.0, end: 20.0, curve: Curve::natural(&points) };
        Profile { pieces: vec![piece], origin: Origin::Derived }
    }

    #[test]
    fn a_sine_has_its_length_and_a_straight_level_none() {
        for length in [0.4, 1.0, 5.0] {
            let found = wavelength(&level(|x| 1e-3 * (2.0 * PI * x / length).sin())).unwrap();
            assert!((found / length - 1.0).abs() < 5e-3, "{found} of {length}");
        }
        // the sum of two waves: l^2 = (a^2 + b^2) / (a^2 + b^2 n^2)
        let both = wavelength(&level(|x| (2.0 * PI * x).sin() + 0.1 * (20.0 * PI * x).sin())).unwrap();
        assert!((both / f64::sqrt(2.0 / 101.0) - 1.0).abs() < 1e-2, "{both}");
        // a smooth step is half a wave: 2 pi / sqrt(10) of its length, by its cubic
        let step = Piece { start: 0.0, end: 0.3, curve: Curve::Level([[0.0, 0.0], [0.3, 1e-3]]) };
        let found = wavelength(&Profile { pieces: vec![step], origin: Origin::Derived }).unwrap();
        assert!((found / (0.3 * 2.0 * PI / f64::sqrt(10.0)) - 1.0).abs() < 1e-9, "{found}");
        assert!(wavelength(&level(|x| 1e-3 * x)).is_none_or(|length| length > 1e4), "but for rounding");
    }
}
