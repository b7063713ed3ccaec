//! Steps of the track at its transitions, and changes of its level over a base; both move a wheel up and down.

use super::level::value_at;
use crate::scenario::{Side, Track};

/// Seats within this distance of a transition lie beside it, m: two bogies of a wagon stand there.
const BESIDE: f64 = 5.0;
/// The longer base over which level changes are taken, m: twist and level are commonly measured over 3 m (EN 13848-1).
pub const LONG_BASE: f64 = 3.0;

/// By how much the softer side of each transition lies below the stiffer one, m, with its name: the mean settlement of
/// the seats within 5 m on the softer side, minus the mean on the stiffer side. With a negative step the ballast on the
/// structure settles more. `settlements` are of seats by chainage, m; a transition without seats on both sides is left
/// out.
pub fn settlement_steps<'t>(track: &'t Track, settlements: &[(f64, f64)]) -> Vec<(&'t str, f64)> {
    let mean = |from: f64, to: f64| {
        let beside: Vec<f64> = settlements.iter().filter(|(x, _)| (from..to).contains(x)).map(|(_, s)| *s).collect();
        (!beside.is_empty()).then(|| beside.iter().sum::<f64>() / beside.len() as f64)
    };
    let step = |transition: &'t crate::scenario::Transition| {
        let x = transition.x;
        let rise = mean(x - BESIDE, x)? - mean(x, x + BESIDE)?;
        let softer_first = transition.side == Side::SoftToStiff;
        Some((transition.name.as_str(), if softer_first { rise } else { -rise }))
    };
    track.transitions.iter().filter_map(step).collect()
}

/// The largest change of a profile over a base, m, up or down; `None` if the profile is shorter. Points are chainage
/// and level, m, ascending; between them it is straight, so that the largest change stands where one end of the base
/// lies at a point.
pub fn largest_change(profile: &[(f64, f64)], base: f64) -> Option<f64> {
    let (first, last) = (profile.first()?.0, profile.last()?.0);
    let starts = profile.iter().flat_map(|(x, _)| [*x, *x - base]);
    let whole = starts.filter(|x| *x >= first && *x + base <= last);
    let change = |x: f64| (value_at(profile, x + base) - value_at(profile, x)).abs();
    whole.map(change).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    #[test]
    fn the_open_track_lies_below_the_slab() {
        let track = example::transition().scenario.track;
        let sides = |before: f64, behind: f64| -> Vec<(f64, f64)> {
            track.seats.iter().map(|seat| (seat.x, if seat.x < 0.0 { before } else { behind })).collect()
        };
        let settlements = sides(3e-3, 0.5e-3);
        let [(_, step)] = settlement_steps(&track, &settlements)[..] else { panic!() };
        assert!((step - 2.5e-3).abs() < 1e-12);
        // the other way round the ballast on the structure has settled
        assert!((settlement_steps(&track, &sides(0.5e-3, 3e-3))[0].1 + 2.5e-3).abs() < 1e-12);
        assert_eq!(settlement_steps(&track, &settlements[..3]), []);
    }

    #[test]
    fn a_ramp_changes_by_its_slope() {
        let ramp: Vec<(f64, f64)> =
            (0..=100).map(|k| 0.1 * f64::from(k)).map(|x| (x, 1e-3 * (x - 4.0).clamp(0.0, 2.0))).collect();
        assert!((largest_change(&ramp, 1.78).unwrap() - 1.78e-3).abs() < 1e-12);
        assert!((largest_change(&ramp, 3.0).unwrap() - 2e-3).abs() < 1e-12, "longer than the ramp");
        assert_eq!(largest_change(&ramp, 12.0), None);
        assert_eq!(largest_change(&[], 1.0), None);
    }
}
