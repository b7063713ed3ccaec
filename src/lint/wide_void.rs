//! L1030: sleepers hang so far above their supports that no wheel presses them onto the supports.
//!
//! Between two carrying seats, L apart, the rail sags at most as a beam on two simple supports. The heaviest wheel Q,
//! amplified by its speed, bends it by Q a^2 b^2 / (3 EI L), with a and b the distances to the two ends. The weight of
//! rail and sleepers bends it by 5 m g L^4 / (384 EI). The seats at the ends deflect by Q / k. A sleeper never touches
//! a support that lies deeper below the line between the ends: traffic cannot have made this void, and no settlement
//! law continues it.

use super::dynamic::amplification;
use super::led;
use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Seat, Track, Vehicle};
use crate::units::number;

/// Measured voids under hanging sleepers are some millimetres; the rule allows voids smaller than this, m.
const USUAL: f64 = 10e-3;

/// A support that the sleeper above it does not reach.
struct Void {
    seat: usize,
    /// Depth below the line between two other supports, m.
    depth: f64,
    /// Largest deflection of the rail there under a wheel, m.
    closed: f64,
}

/// Loads on the rail.
struct Load {
    /// N.
    wheel: f64,
    /// m/s^2.
    gravity: f64,
}

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let track = &scenario.track;
    let heaviest = traffic.train.vehicles.iter().map(Vehicle::mass).fold(0.0, f64::max) / Vehicle::AXLES as f64;
    let gravity = *scenario.solve.gravity;
    let load = Load { wheel: heaviest * gravity * amplification(*traffic.train.speed), gravity };
    let levels = track.seats.iter().map(|seat| *seat.initial_settlement);
    let range = levels.clone().fold(f64::NEG_INFINITY, f64::max) - levels.fold(f64::INFINITY, f64::min);
    if range <= USUAL {
        return Vec::new();
    }
    let sections = 0..track.sections.len();
    let beams: Vec<Option<Winkler>> = sections.map(|i| Winkler::of_section(track, &graph.supports, i)).collect();
    let seats = (0..track.seats.len()).filter(|seat| track.seats[*seat].is_ballasted());
    let voids = seats.filter_map(|seat| void(track, seat, beams[track.seats[seat].section].as_ref()?, range, &load));
    let voids: Vec<Void> = voids.collect();
    let Some(worst) = voids.iter().max_by(|a, b| (a.depth - a.closed).total_cmp(&(b.depth - b.closed))) else {
        return Vec::new();
    };
    let mm = |length: f64| number((length * 1e4).round() / 10.0);
    let seat = &track.seats[worst.seat];
    let (count, hang) =
        if voids.len() == 1 { ("1 sleeper".into(), "hangs") } else { (format!("{} sleepers", voids.len()), "hang") };
    let message = format!(
        "{count} {hang} above supports that no wheel reaches: the void at {} is {} mm, but a wheel bends the rail \
         down by {} mm at most",
        track.seat_name(seat),
        mm(worst.depth),
        mm(worst.closed)
    );
    let diagnostic = Diagnostic::new(Code::L1030, message).help(format!(
        "measured voids are some millimetres: write a `settlement` that differs less from seat to seat, by less than \
         {} mm there",
        number((worst.closed.max(USUAL) * 1e3).floor())
    ));
    vec![match seat.initial_settlement.origin.span() {
        Some(span) => diagnostic.label(span, "this settlement"),
        None => diagnostic,
    }]
}

/// The void that is the furthest from being closed, under a seat between any two others.
fn void(track: &Track, seat: usize, beam: &Winkler, range: f64, load: &Load) -> Option<Void> {
    let here = &track.seats[seat];
    let stiffness = beam.modulus * track.bay(seat);
    let closed = |a: f64, b: f64| {
        let (length, bending) = (a + b, beam.bending_stiffness);
        let wheel = load.wheel * a * a * b * b / (3.0 * bending * length);
        let weight = 5.0 * beam.mass * load.gravity * length.powi(4) / (384.0 * bending);
        wheel + weight + load.wheel / stiffness
    };
    let mut worst: Option<Void> = None;
    for left in track.seats[..seat].iter().rev() {
        let a = here.x - left.x;
        // with the nearest right end; from a more distant left end the wheel closes even more
        if closed(a, track.bay(seat).min(a)) > range {
            break;
        }
        for right in &track.seats[seat + 1..] {
            let closed = closed(a, right.x - here.x);
            if closed > range {
                break;
            }
            let depth = below(here, left, right);
            if depth > closed.max(USUAL) && worst.as_ref().is_none_or(|w| depth - closed > w.depth - w.closed) {
                worst = Some(Void { seat, depth, closed });
            }
        }
    }
    worst
}

/// Depth of the support of a seat below the line between the supports of two other seats, m.
fn below(here: &Seat, left: &Seat, right: &Seat) -> f64 {
    let share = (here.x - left.x) / (right.x - left.x);
    let line = *left.initial_settlement + share * (*right.initial_settlement - *left.initial_settlement);
    *here.initial_settlement - line
}
