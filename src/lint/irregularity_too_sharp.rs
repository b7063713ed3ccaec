//! L1011: a wheel cannot follow the rail's level as built: the radius of a dip is smaller than the radius of the wheel.
//!
//! A smooth level z (positive down) has the radius 1 / |z''|; in a dip z'' < 0. A wheel of radius R touches the bottom
//! if 1 / |z''| > R. At a corner that opens upwards by the angle a the wheel stays R a^2 / 8 above the bottom. Every
//! wheel can follow a crest (z'' > 0).

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Curve, Profile, Scenario};
use crate::units::number;

/// Gap between wheel and corner below which the wheel follows the corner, m: a tenth of its indentation.
const BRIDGED: f64 = 1e-5;
/// Half the interval over which the angle of a corner is taken, m.
const REACH: f64 = 1e-3;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let Some(profile) = &scenario.track.irregularity else { return Vec::new() };
    let radius = traffic.train.vehicles.iter().map(|v| v.wheel_radius).fold(0.0, f64::max);
    too_sharp(profile, radius).into_iter().collect()
}

fn too_sharp(profile: &Profile, radius: f64) -> Option<Diagnostic> {
    let (x, sharpest) = sharpest_dip(profile).filter(|(_, r)| *r < radius)?;
    let (found, wheel) = (number((sharpest * 1e3).round() / 1e3), number(radius));
    let message = match sharpest {
        0.0 => format!(
            "the rail has a corner at x = {} m; a wheel of radius {wheel} m does not touch its bottom",
            number(round(x))
        ),
        _ => {
            format!(
                "the rail has a dip of radius {found} m at x = {} m, less than the wheel radius of {wheel} m",
                number(round(x))
            )
        }
    };
    let diagnostic = Diagnostic::new(Code::L1011, message).help(
        "smooth the data: a real wheel bridges such a place, but the wheel of the model has one contact point and \
         follows it",
    );
    Some(match profile.origin.span() {
        Some(span) => diagnostic.label(span, "sharper than the wheel"),
        None => diagnostic,
    })
}

fn round(x: f64) -> f64 {
    (x * 1e3).round() / 1e3
}

/// Chainage and radius of the sharpest dip, m; the radius of a corner that wheels bridge is 0.
fn sharpest_dip(profile: &Profile) -> Option<(f64, f64)> {
    let curved = profile.pieces.iter().flat_map(|piece| {
        let within = |x: f64| x > piece.start - REACH && x < piece.end + REACH;
        let second = second_derivatives(&piece.curve);
        second.into_iter().filter(move |(x, _)| within(*x))
    });
    let dips = curved.filter(|(_, z)| *z < 0.0).map(|(x, z)| (x, -1.0 / z));
    let first = profile.pieces.first()?.start;
    let last = profile.pieces.last()?.end;
    let corners = profile.pieces.iter().flat_map(|piece| match &piece.curve {
        Curve::Linear(_) => piece.knots(),
        _ => vec![piece.start, piece.end],
    });
    let bridged = corners.filter(|x| *x > first + REACH && *x < last - REACH && bridges(profile, *x)).map(|x| (x, 0.0));
    dips.chain(bridged).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Places at which a curve may have its smallest radius, with the second derivative there, 1/m.
fn second_derivatives(curve: &Curve) -> Vec<(f64, f64)> {
    match curve {
        Curve::Linear(_) => Vec::new(),
        Curve::Level([a, b]) => {
            let second = 6.0 * (b[1] - a[1]) / ((b[0] - a[0]) * (b[0] - a[0]));
            vec![(a[0], second), (b[0], -second)]
        }
        Curve::Natural(points) => points.iter().map(|p| (p[0], p[2])).collect(),
    }
}

/// Whether a wheel of a usual radius bridges a corner or step at x.
fn bridges(profile: &Profile, x: f64) -> bool {
    const RADIUS: f64 = 0.5; // m: a corner has no radius of its own
    let z = |dx: f64| profile.value(x + dx);
    let angle = ((z(0.0) - z(-REACH)) - (z(REACH) - z(0.0))) / REACH;
    let step = (z(REACH) - z(-REACH)).abs() > 0.1 * REACH;
    step || angle > 0.0 && RADIUS * angle * angle / 8.0 > BRIDGED
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Origin, Piece};

    fn profile(curve: Curve) -> Profile {
        Profile { pieces: vec![Piece { start: -10.0, end: 10.0, curve }], origin: Origin::Derived }
    }

    /// A wave of 1 mm and that length, sampled every 10 mm; it begins and ends without curvature, as the spline does.
    fn wave(length: f64) -> Profile {
        let points: Vec<[f64; 2]> = (-1000..=1000)
            .map(|i| f64::from(i) * 0.01)
            .map(|x| [x, 1e-3 * (2.0 * std::f64::consts::PI * x / length).sin()])
            .collect();
        profile(Curve::natural(&points))
    }

    #[test]
    fn a_wave_is_too_sharp_where_its_closed_form_says_so() {
        // radius of a wave of amplitude a and length l: l^2 / (4 pi^2 a)
        let radius = |length: f64| length * length / (4.0 * std::f64::consts::PI.powi(2) * 1e-3);
        let (_, found) = sharpest_dip(&wave(0.2)).unwrap();
        assert!((found / radius(0.2) - 1.0).abs() < 0.03, "{found} {}", radius(0.2));
        assert!(too_sharp(&wave(0.2), 0.46).is_none());
        assert!(too_sharp(&wave(0.1), 0.46).is_some());
    }

    #[test]
    fn steps_and_deep_corners_are_too_sharp_and_crests_never() {
        let bend = |z: f64| profile(Curve::Linear(vec![[-10.0, 0.0], [0.0, z], [10.0, 0.0]]));
        assert!(too_sharp(&bend(5e-3), 0.46).is_none(), "1 mm/m is bridged by nothing that matters");
        assert!(too_sharp(&bend(200e-3), 0.46).is_some());
        assert!(too_sharp(&bend(-200e-3), 0.46).is_none(), "a crest");
        let step = Profile {
            pieces: vec![
                Piece { start: -10.0, end: 0.0, curve: Curve::constant(0.0) },
                Piece { start: 0.0, end: 10.0, curve: Curve::constant(1e-3) },
            ],
            origin: Origin::Derived,
        };
        assert!(too_sharp(&step, 0.46).is_some());
    }
}
