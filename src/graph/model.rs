//! From the track and train of the scene to those of the solver: plain numbers of one rail.

use super::TrackNode;
use crate::scenario::{self, AuxiliaryRailSpan, Beam, Foot, Integrator, Piece, Profile, RailEnds, Section, Track};
use crate::solvers::track as solver;

/// The solver's model of a track.
pub fn model(node: &TrackNode) -> solver::TrackModel {
    let track = &node.track;
    solver::TrackModel {
        ends: [track.start(), track.end()],
        rail: track.sections.iter().filter_map(|section| rail(section, node.beam)).collect(),
        seats: track.seats.iter().map(seat).collect(),
        slabs: track.sections.iter().filter_map(slab).collect(),
        auxiliary_rails: track.auxiliary_rails.iter().map(auxiliary_rail).collect(),
        joints: Vec::new(),
        rail_ends: match track.rail_ends {
            RailEnds::Clamped => solver::RailEnds::Clamped,
            RailEnds::Pinned => solver::RailEnds::Pinned,
            RailEnds::Free => solver::RailEnds::Free,
            RailEnds::Absorbing => solver::RailEnds::Absorbing,
        },
        irregularity: track.irregularity.as_ref().map(irregularity).unwrap_or_default(),
        elements_per_bay: node.elements_per_bay as usize,
        gravity: node.gravity,
    }
}

fn irregularity(profile: &Profile) -> solver::Irregularity {
    let cubics = profile.pieces.iter().flat_map(Piece::cubics);
    let cubic = |c: scenario::Cubic| solver::Cubic { ends: c.ends, values: c.values, curvatures: c.curvatures };
    solver::Irregularity::cubics(cubics.map(cubic).collect())
}

fn rail(section: &Section, beam: Beam) -> Option<solver::RailSection> {
    let rail = section.rail.as_ref()?;
    Some(solver::RailSection {
        start: section.start,
        end: section.end,
        mass: *rail.mass,
        bending_stiffness: *rail.bending_stiffness,
        shear: match (beam, rail.shear_stiffness) {
            (Beam::Timoshenko, Some(stiffness)) => {
                Some(solver::Shear { stiffness: *stiffness, rotary_inertia: rail.rotary_inertia })
            }
            _ => None,
        },
    })
}

/// A pad or a support that is not there has no stiffness, which the solver refuses.
fn seat(seat: &scenario::Seat) -> solver::Seat {
    let (pad_stiffness, pad_damping) = seat.pad.as_ref().map_or((0.0, 0.0), |pad| (*pad.stiffness, *pad.damping));
    solver::Seat {
        x: seat.x,
        pad_stiffness,
        pad_damping,
        foot: match &seat.foot {
            Foot::Sleeper { mass, .. } => {
                let spring = seat.spring();
                solver::Foot::Sleeper {
                    mass: **mass,
                    support_stiffness: spring.map_or(0.0, |spring| spring.stiffness),
                    support_damping: spring.map_or(0.0, |spring| spring.damping),
                    seating: spring
                        .and_then(|spring| spring.seating)
                        .map(|(stiffness, closure)| solver::Seating { stiffness, closure }),
                }
            }
            Foot::Rigid => solver::Foot::Rigid,
            Foot::Slab => solver::Foot::Slab,
        },
    }
}

fn slab(section: &Section) -> Option<solver::Slab> {
    section.slab.as_ref().map(|slab| solver::Slab {
        start: section.start,
        end: section.end,
        bending_stiffness: *slab.bending_stiffness,
        mass: *slab.mass,
        foundation_stiffness: *slab.foundation_stiffness,
        foundation_damping: *slab.foundation_damping,
    })
}

fn auxiliary_rail(span: &AuxiliaryRailSpan) -> solver::AuxiliaryRail {
    solver::AuxiliaryRail {
        start: span.start,
        end: span.end,
        mass: *span.rails.rail.mass,
        bending_stiffness: *span.rails.rail.bending_stiffness,
        pad_stiffness: *span.rails.pad.stiffness,
        pad_damping: *span.rails.pad.damping,
    }
}

/// The solver's train.
pub fn train(train: &scenario::Train, direction: scenario::Direction) -> solver::Train {
    let vehicles = train.vehicles.iter().map(|v| vehicle(v).into()).zip(train.vehicle_offsets()).collect();
    let direction = match direction {
        scenario::Direction::Backward => solver::Direction::Backward,
        _ => solver::Direction::Forward,
    };
    solver::Train { vehicles, direction }
}

/// How fast it runs.
pub fn motion(train: &scenario::Train) -> solver::Motion {
    let Some(profile) = &train.speed_profile else { return solver::Motion::Constant(*train.speed) };
    let points = profile.pieces.iter().flat_map(|piece| piece.knots().into_iter().map(|x| (x, profile.value(x))));
    let mut knots: Vec<(f64, f64)> = points.collect();
    knots.dedup_by(|next, kept| next.0 <= kept.0);
    solver::Motion::ByChainage(knots)
}

fn vehicle(v: &scenario::Vehicle) -> solver::Vehicle {
    solver::Vehicle {
        car_body_mass: *v.car_body_mass,
        car_body_inertia: *v.car_body_pitch_inertia,
        bogie_mass: *v.bogie_mass,
        bogie_inertia: *v.bogie_pitch_inertia,
        bogie_spacing: *v.bogie_spacing,
        wheel_mass: *v.wheel_mass,
        wheelset_spacing: *v.wheelset_spacing,
        primary_stiffness: *v.primary_stiffness,
        primary_damping: *v.primary_damping,
        secondary_stiffness: *v.secondary_stiffness,
        secondary_damping: *v.secondary_damping,
        hertz: *v.hertz,
    }
}

/// The solver's time integration.
pub fn scheme(integrator: Integrator, time_step: f64) -> Result<solver::Scheme, solver::TrackError> {
    match integrator {
        Integrator::GeneralisedAlpha { rho } => solver::Scheme::generalised_alpha(time_step, rho),
        Integrator::Hht { alpha } => solver::Scheme::hht(time_step, alpha),
        Integrator::Newmark => solver::Scheme::newmark(time_step),
    }
}

/// The settled track: supports where they lie, and the rail ends held at the level of the track there. A clamp that
/// stayed at the level as built would grow a second transition at the end of the model.
pub fn level(node: &TrackNode, settlement: &[f64]) -> solver::TrackLevel {
    let track = &node.track;
    let end = |seat: usize| settlement.get(seat).map_or(0.0, |settled| settled + sag(track, seat, node.gravity));
    let last = track.seats.len().saturating_sub(1);
    solver::TrackLevel { settlements: settlement.to_vec(), ends: [end(0), end(last)] }
}

/// Deflection of the rail under gravity, m, of a long track that is everywhere as at one seat; none without a rail.
fn sag(track: &Track, seat: usize, gravity: f64) -> f64 {
    let per_seat = track.bay(seat) * gravity;
    let seat = &track.seats[seat];
    let form = &track.sections[seat.section];
    let (Some(rail), Some(pad)) = (&form.rail, &seat.pad) else { return 0.0 };
    let on_seat = *rail.mass * per_seat; // N
    let above = track.auxiliary_rails.iter().find(|span| (span.start..=span.end).contains(&seat.x));
    let beside = above.map_or(0.0, |span| *span.rails.rail.mass * per_seat);
    let below = match (&seat.foot, &form.slab) {
        (Foot::Sleeper { mass, .. }, _) => {
            seat.spring().map_or(0.0, |spring| spring.compression(on_seat + beside + **mass * gravity))
        }
        (Foot::Slab, Some(slab)) => *rail.mass * gravity / *slab.foundation_stiffness,
        _ => 0.0,
    };
    on_seat / *pad.stiffness + below
}
