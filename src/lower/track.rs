//! Converts the track and the trains of the scene to the graph: plain numbers for one rail.

use super::Draft;
use crate::graph::{Runs, TrackFoot, TrackNode, TrackSeat, TrackSection, Train};
use crate::scenario::{self, AuxiliaryRailSpan, Beam, Direction, Foot, Piece, Profile, RailEnds, Section, Track};
use crate::schema::Reads;
use crate::solvers::track::{self as solver, Motion, Vehicle};

/// Fields of the track, for loads at rest and for trains.
pub(super) const READS: Reads = Reads {
    fields: &[
        "rail.mass",
        "rail.density",
        "rail.area",
        "rail.bending_stiffness",
        "rail.youngs_modulus",
        "rail.second_moment",
        "rail.shear_stiffness",
        "pad.stiffness",
        "sleeper.mass",
        "slab.bending_stiffness",
        "slab.mass",
        "slab.foundation_stiffness",
        "track.rail_ends",
        "solve.beam",
        "solve.elements_per_bay",
        "solve.gravity",
    ],
    acts_where: "where there are rails",
};

/// Fields of the springs under the sleepers, for loads at rest and for trains.
pub(super) const SUPPORTS: Reads = Reads {
    fields: &["support.stiffness", "support.seating", "seating.stiffness", "seating.closure", "usp.bedding_modulus"],
    acts_where: "where springs carry the sleepers: under test loads on a rail, or with `substructure = law`",
};

/// The track node of a plan.
pub(super) fn track(draft: &Draft<'_>) -> TrackNode {
    let scenario = draft.scenario;
    let track = &scenario.track;
    let beam = *scenario.solve.beam;
    TrackNode {
        rail: track.sections.iter().filter_map(|section| rail(section, beam)).collect(),
        sections: track.sections.iter().map(section).collect(),
        seats: (0..track.seats.len()).map(|index| seat(track, index)).collect(),
        slabs: track.sections.iter().filter_map(slab).collect(),
        auxiliary_rails: track.auxiliary_rails.iter().map(auxiliary_rail).collect(),
        rail_ends: match track.rail_ends {
            RailEnds::Clamped => solver::RailEnds::Clamped,
            RailEnds::Pinned => solver::RailEnds::Pinned,
            RailEnds::Free => solver::RailEnds::Free,
            RailEnds::Absorbing => solver::RailEnds::Absorbing,
        },
        irregularity: track.irregularity.as_ref().map(irregularity).unwrap_or_default(),
        elements_per_bay: draft.elements_per_bay,
        gravity: *scenario.solve.gravity,
        shortest_bay: track.shortest_bay(),
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

fn section(section: &Section) -> TrackSection {
    TrackSection {
        name: section.name.clone(),
        start: section.start,
        end: section.end,
        slab_foundation: section.slab.as_ref().map(|slab| *slab.foundation_stiffness),
    }
}

/// A missing pad has stiffness 0, which the solver refuses.
fn seat(track: &Track, index: usize) -> TrackSeat {
    let seat = &track.seats[index];
    let (pad_stiffness, pad_damping) = seat.pad.as_ref().map_or((0.0, 0.0), |pad| (*pad.stiffness, *pad.damping));
    TrackSeat {
        name: track.seat_name(seat),
        x: seat.x,
        section: seat.section,
        bay: track.bay(index),
        pad_stiffness,
        pad_damping,
        foot: match &seat.foot {
            Foot::Sleeper { mass, .. } => TrackFoot::Sleeper { mass: **mass },
            Foot::Rigid => TrackFoot::Rigid,
            Foot::Slab => TrackFoot::Slab,
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

/// A train of the graph.
pub(super) fn train(train: &scenario::Train) -> Train {
    Train {
        name: train.name.clone(),
        vehicles: train.vehicles.iter().map(vehicle).zip(train.vehicle_offsets()).collect(),
        speed: *train.speed,
        motion: motion(train),
        runs: match train.direction {
            Direction::Forward => Runs::Forward,
            Direction::Backward => Runs::Backward,
            Direction::Both => Runs::BothWays,
        },
    }
}

/// The speed of a train, constant or along the track.
fn motion(train: &scenario::Train) -> Motion {
    let Some(profile) = &train.speed_profile else { return Motion::Constant(*train.speed) };
    let points = profile.pieces.iter().flat_map(|piece| piece.knots().into_iter().map(|x| (x, profile.value(x))));
    let mut knots: Vec<(f64, f64)> = points.collect();
    knots.dedup_by(|next, kept| next.0 <= kept.0);
    Motion::ByChainage(knots)
}

fn vehicle(v: &scenario::Vehicle) -> Vehicle {
    Vehicle {
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
