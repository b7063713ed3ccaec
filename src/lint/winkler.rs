//! The track as a beam on a Winkler foundation: the closed forms that several rules need.

use super::Led;
use crate::graph::{Graph, SupportNode};
use crate::scenario::{Foot, Scenario, Section, Track, Vehicle, point_stiffness};
use crate::solvers::settlement::Peak;

/// A section as a continuous foundation along the rail.
pub struct Winkler {
    /// Foundation modulus: seat stiffness over spacing, N/m per metre.
    pub modulus: f64,
    /// EI of the rail, N m^2.
    pub bending_stiffness: f64,
    /// Rail and sleepers, kg/m.
    pub mass: f64,
}

impl Winkler {
    /// A seat is pad and support in series; a slab adds its foundation over one bay. If they vary, the values at the
    /// section's left end are used. `None` without seats, or if rail, pads or supports are not known.
    pub fn of_section(track: &Track, supports: &[SupportNode], section: usize) -> Option<Winkler> {
        let start = track.sections[section].start;
        let from = |index: &usize| (track.seats[*index].x - start).abs();
        Winkler::at_seat(track, supports, track.seats_of(section).min_by(|a, b| from(a).total_cmp(&from(b)))?)
    }

    /// The track at a seat.
    pub fn at_seat(track: &Track, supports: &[SupportNode], index: usize) -> Option<Winkler> {
        let seat = &track.seats[index];
        let Section { rail, slab, .. } = &track.sections[seat.section];
        let spacing = track.bay(index);
        let (below, mass) = match (&seat.foot, slab) {
            (Foot::Sleeper { mass, .. }, _) => (1.0 / supports.get(index)?.spring?.stiffness, **mass / spacing),
            (Foot::Slab, Some(slab)) => (1.0 / (*slab.foundation_stiffness * spacing), 0.0),
            _ => (0.0, 0.0),
        };
        let (rail, pad) = (rail.as_ref()?, seat.pad.as_ref()?);
        let stiffness = 1.0 / (1.0 / *pad.stiffness + below);
        Some(Winkler {
            modulus: stiffness / spacing,
            bending_stiffness: *rail.bending_stiffness,
            mass: *rail.mass + mass,
        })
    }

    /// Reciprocal of the characteristic length, 1/m: (k/4EI)^(1/4).
    pub fn lambda(&self) -> f64 {
        (self.modulus / (4.0 * self.bending_stiffness)).powf(0.25)
    }

    /// Static stiffness at rail level, N/m: 2 k / lambda.
    pub fn rail_stiffness(&self) -> f64 {
        point_stiffness(self.modulus, self.bending_stiffness)
    }

    /// Speed at which a moving load resonates with bending waves, m/s: (4 k EI / m^2)^(1/4).
    pub fn critical_speed(&self) -> f64 {
        (4.0 * self.modulus * self.bending_stiffness / (self.mass * self.mass)).powf(0.25)
    }

    /// Share of a load that the seat under it carries: lambda s / 2.
    pub fn seat_share(&self, spacing: f64) -> f64 {
        self.lambda() * spacing / 2.0
    }
}

/// Load and deflection of the support of a seat in a ballasted section under the heaviest wheel at rest and the track's
/// weight.
pub(super) struct SeatLoad {
    pub section: usize,
    pub winkler: Winkler,
    /// Spacing of the seats, m.
    pub spacing: f64,
    /// N.
    pub wheel: f64,
    pub peak: Peak,
}

/// The ballasted sections under the heaviest wheel of the train.
pub(super) fn seat_loads(scenario: &Scenario, graph: &Graph, traffic: Led<'_>) -> Vec<SeatLoad> {
    (0..scenario.track.sections.len()).filter_map(|section| seat_load(scenario, graph, traffic, section)).collect()
}

/// A ballasted section under the heaviest wheel of the train: the load of a seat with the weight of the track, and the
/// deflection of its support.
pub(super) fn seat_load(scenario: &Scenario, graph: &Graph, traffic: Led<'_>, section: usize) -> Option<SeatLoad> {
    let (track, gravity) = (&scenario.track, *scenario.solve.gravity);
    let heaviest = traffic.train.vehicles.iter().map(Vehicle::mass).fold(0.0, f64::max);
    let wheel = heaviest / Vehicle::AXLES as f64 * gravity;
    let first = track.seats_of(section).find(|seat| track.seats[*seat].is_ballasted())?;
    let winkler = Winkler::of_section(track, &graph.supports, section)?;
    let spacing = track.bay(first);
    let support = graph.supports.get(first)?.support?;
    let force = wheel * winkler.seat_share(spacing) + winkler.mass * spacing * gravity;
    let peak = Peak { force, deflection: force / support.stiffness, void: 0.0 };
    Some(SeatLoad { section, winkler, spacing, wheel, peak })
}
