//! L1023: a damper is so strong that its mass creeps and does not oscillate.
//!
//! Damping ratio `c / 2 sqrt(k m)` of a sleeper between pad and support, a bogie on its wheelsets, a car body on its
//! bogies. Track has 0.05 .. 0.5, suspensions 0.01 .. 0.4; above 1 nothing oscillates. The usual causes are a damping
//! time written as a damping, and a value per wheel written as a value per bogie.

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Foot, Origin, Scenario, Vehicle};
use crate::units::number;

/// Critical damping.
const LARGEST: f64 = 1.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    if graph.track().is_none() {
        return Vec::new();
    }
    let sections = 0..scenario.track.sections.len();
    let mut swinging: Vec<Swinging> = sections.filter_map(|section| sleeper(scenario, graph, section)).collect();
    if let Some(traffic) = led(scenario, graph) {
        swinging.extend(traffic.train.vehicles.iter().flat_map(|v| [bogie(v), car_body(v)]));
    }
    let mut found = Vec::new();
    for diagnostic in swinging.iter().filter(|s| s.ratio() > LARGEST).map(Swinging::said) {
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
}

/// A mass on a spring and a damper.
struct Swinging {
    what: String,
    /// kg.
    mass: f64,
    /// N/m.
    stiffness: f64,
    /// N s/m.
    damping: f64,
    origin: Origin,
}

impl Swinging {
    fn ratio(&self) -> f64 {
        self.damping / (2.0 * (self.stiffness * self.mass).sqrt())
    }

    fn said(&self) -> Diagnostic {
        let critical = LARGEST * 2.0 * (self.stiffness * self.mass).sqrt();
        let diagnostic = Diagnostic::new(
            Code::L1023,
            format!(
                "{} has {} times its critical damping: {} kN s/m with {} MN/m and {} kg",
                self.what,
                number((self.ratio() * 100.0).round() / 100.0),
                number((self.damping / 1e2).round() / 10.0),
                number((self.stiffness / 1e4).round() / 100.0),
                number(self.mass.round())
            ),
        )
        .help(format!(
            "write less than {} kN s/m: is the value per wheel, per wheelset or per bogie, per seat or per sleeper?",
            number((critical / 1e3).floor())
        ));
        match self.origin.span() {
            Some(span) => diagnostic.label(span, "this damper"),
            None => diagnostic,
        }
    }
}

/// The sleeper of a section with the strongest dampers: pad and support on the same mass.
fn sleeper(scenario: &Scenario, graph: &Graph, section: usize) -> Option<Swinging> {
    let track = &scenario.track;
    let swinging = track.seats_of(section).filter_map(|index| {
        let seat = &track.seats[index];
        let Foot::Sleeper { mass, .. } = &seat.foot else { return None };
        let (pad, spring) = (seat.pad.as_ref()?, graph.supports.get(index)?.spring?);
        let stated = seat.support().map_or(Origin::Derived, |support| support.damping.origin);
        let origin = if *pad.damping > spring.damping { pad.damping.origin } else { stated };
        Some(Swinging {
            what: format!("a sleeper of `{}` between pad and support", track.sections[section].name),
            mass: **mass,
            stiffness: *pad.stiffness + spring.stiffness,
            damping: *pad.damping + spring.damping,
            origin,
        })
    });
    swinging.max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
}

fn bogie(vehicle: &Vehicle) -> Swinging {
    Swinging {
        what: format!("a bogie of `{}` on its wheelsets", vehicle.name),
        mass: *vehicle.bogie_mass,
        stiffness: 2.0 * *vehicle.primary_stiffness + *vehicle.secondary_stiffness,
        damping: 2.0 * *vehicle.primary_damping + *vehicle.secondary_damping,
        origin: vehicle.primary_damping.origin,
    }
}

fn car_body(vehicle: &Vehicle) -> Swinging {
    Swinging {
        what: format!("the car body of `{}` on its bogies", vehicle.name),
        mass: *vehicle.car_body_mass,
        stiffness: 2.0 * *vehicle.secondary_stiffness,
        damping: 2.0 * *vehicle.secondary_damping,
        origin: vehicle.secondary_damping.origin,
    }
}
