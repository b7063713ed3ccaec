//! What a drawn scene is for, and what that asks of its fields beyond the schema: that a scene has trains or a load,
//! and is small.
//!
//! A field that has no line here is drawn by its form, its range and its need alone, so that a new one joins by itself.

/// What a scene is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// Trains over supports that settle by a law.
    Law,
    /// A load on a rail at rest.
    Rail,
    /// A load on sleepers or a plate over a small bed of coarse grains.
    Rig,
    /// Trains over grains, to be planned and not run.
    Grains,
    /// A load on a plate that covers a box of coarse grains: some hundred grains, so that it runs in seconds.
    Plate,
}

impl Aim {
    /// Whether the load acts on grains without rails.
    pub fn is_rig(self) -> bool {
        RIGS.contains(&self)
    }
}

use Aim::{Grains, Law, Plate, Rail, Rig};

/// What an aim asks of a field; `None` and empty lists ask nothing.
#[derive(Default)]
pub struct Want {
    /// How often the field is written, 0 .. 1.
    pub chance: Option<f64>,
    /// Ranges by the unit of the field.
    pub ranges: &'static [(&'static str, f64, f64)],
    /// Words, responses, kinds of forms or units that may stand; all where empty.
    pub only: &'static [&'static str],
    /// Number of items of a list.
    pub items: Option<[usize; 2]>,
}

const ANY: &[Aim] = &[Law, Rail, Rig, Grains, Plate];
const RIGS: &[Aim] = &[Rig, Plate];
const TRAINS: &[Aim] = &[Law, Grains];
const RAILS: &[Aim] = &[Law, Rail, Grains];
const NOTHING: Want = Want { chance: None, ranges: &[], only: &[], items: None };

const fn often(chance: f64) -> Want {
    Want { chance: Some(chance), ..NOTHING }
}
const fn within(ranges: &'static [(&'static str, f64, f64)]) -> Want {
    Want { ranges, ..NOTHING }
}
const fn only(words: &'static [&'static str]) -> Want {
    Want { only: words, ..NOTHING }
}

/// What the aim asks of the field of that path.
pub fn want(aim: Aim, path: &str) -> Option<&'static Want> {
    WANTS.iter().find(|(known, aims, _)| *known == path && aims.contains(&aim)).map(|(_, _, want)| want)
}

/// Paths with the aims for which they hold. Kinds of which a scene has some stand by their name alone.
const WANTS: &[(&str, &[Aim], Want)] = &[
    // what there is
    ("track", ANY, often(1.0)),
    ("traffic", TRAINS, often(1.0)),
    ("traffic", ANY, often(0.0)),
    ("load", TRAINS, often(0.0)),
    ("load", ANY, Want { chance: Some(1.0), items: Some([1, 2]), ..NOTHING }),
    ("tamping", &[Law], often(0.15)),
    ("tamping", ANY, often(0.0)),
    ("study", &[Law], often(0.12)),
    ("study", RIGS, often(0.05)),
    ("study", ANY, often(0.0)),
    ("solve", &[Law], often(0.8)),
    ("solve", ANY, often(1.0)),
    ("record", ANY, often(0.4)),
    ("expect", ANY, often(0.25)),
    ("scenario", ANY, often(0.3)),
    // the track
    ("track.sections", &[Law, Rail], Want { items: Some([1, 3]), ranges: SECTIONS, ..NOTHING }),
    ("track.sections", RIGS, Want { items: Some([1, 1]), ranges: RIG_SECTIONS, only: &["sleepers"], chance: None }),
    ("track.sections", &[Grains], Want { items: Some([1, 2]), ranges: SECTIONS, ..NOTHING }),
    ("track.stretches", &[Law, Grains], often(0.25)),
    ("track.stretches", ANY, often(0.05)),
    ("track.irregularity", ANY, within(&[("mm", -2.0, 2.0)])),
    ("track.bed_width", &[Plate], within(&[("m", 0.6, 0.9)])),
    ("track.bed_width", RAILS, within(&[("m", 3.2, 8.0)])),
    ("track.bed_width", RIGS, within(&[("m", 2.7, 3.2)])),
    ("track.base", RIGS, often(0.0)),
    ("trackform.rail", RAILS, often(1.0)),
    ("trackform.pad", RAILS, often(1.0)),
    ("trackform.rail", ANY, often(0.0)),
    ("trackform.pad", ANY, often(0.0)),
    ("trackform.sleeper", &[Plate], often(0.0)),
    ("trackform.usp", &[Plate], often(0.0)),
    ("trackform.sleeper", ANY, often(1.0)),
    ("trackform.usp", ANY, often(0.15)),
    ("trackform.spacing", ANY, within(&[("m", 0.5, 0.75)])),
    ("trackform.slab", RIGS, often(0.0)),
    ("trackform.support", RIGS, often(0.0)),
    (
        "trackform.layers",
        RIGS,
        Want { chance: Some(1.0), ranges: &[("m", 0.14, 0.22)], items: Some([1, 1]), only: &["granular", "m"] },
    ),
    ("trackform.layers", ANY, Want { ranges: &[("m", 0.15, 2.0)], items: Some([1, 3]), ..NOTHING }),
    ("trackform.crib", RAILS, often(0.02)),
    ("trackform.crib", ANY, within(&[("mm", 60.0, 150.0)])),
    ("trackform.shoulder", ANY, often(0.02)),
    ("trackform.settlement", ANY, within(&[("mm", 0.0, 5.0)])),
    ("trackform.auxiliary_rails", RIGS, often(0.0)),
    ("trackform.slab", RAILS, often(0.25)),
    ("trackform.auxiliary_rails", ANY, often(0.04)),
    ("sleeper.base_area", ANY, often(0.02)),
    ("support.stiffness", ANY, within(&[("MN/m", 15.0, 200.0)])),
    ("seating.stiffness", ANY, within(&[("MN/m", 1.0, 10.0)])),
    ("seating.closure", ANY, within(&[("mm", 0.05, 1.0)])),
    ("stretch.approach_slab", ANY, often(0.02)),
    ("stretch.layers", ANY, often(0.1)),
    ("stretch.spacing", ANY, often(0.5)),
    ("track.transitions.soft_to_stiff.seats", ANY, often(0.1)),
    ("track.transitions.stiff_to_soft.seats", ANY, often(0.1)),
    ("stretch.rail", ANY, often(0.0)),
    ("stretch.slab", ANY, often(0.0)),
    ("stretch.crib", ANY, often(0.0)),
    ("stretch.shoulder", ANY, often(0.0)),
    // what loads it
    ("train.vehicles", ANY, Want { items: Some([1, 1]), ranges: &[("", 1.0, 2.0)], ..NOTHING }),
    ("train.speed", ANY, within(&[("km/h", 30.0, 260.0)])),
    ("vehicle.axle_load", ANY, within(&[("t", 10.0, 25.0), ("kN", 100.0, 250.0)])),
    ("study.report", ANY, often(1.0)),
    ("vehicle.length", ANY, Want { chance: Some(1.0), ranges: &[("m", 12.0, 26.0)], ..NOTHING }),
    ("traffic.trains", ANY, Want { items: Some([1, 2]), ..NOTHING }),
    ("traffic.total", ANY, Want { ranges: &[("axles", 16.0, 96.0), ("MGT", 1e-4, 2e-3)], ..NOTHING }),
    ("load.on", &[Rail], only(&["rail", "sleepers"])),
    ("load.on", &[Plate], only(&["bed"])),
    ("load.on", RIGS, only(&["sleepers", "bed"])),
    ("load.at", RIGS, Want { items: Some([1, 1]), ..NOTHING }),
    ("load.force", &[Rail], Want { only: &["kN"], ranges: &[("kN", 1.0, 200.0)], ..NOTHING }),
    ("load.force.cyclic.range", ANY, within(&[("kN", 1.0, 60.0)])),
    ("load.force.cyclic.frequency", ANY, within(&[("Hz", 20.0, 60.0)])),
    ("load.strain", &[Rail], often(0.0)),
    ("load.strain", ANY, within(&[("%", 0.1, 1.0)])),
    ("load.confinement", ANY, often(0.03)),
    ("load.speed", ANY, often(0.03)),
    ("load.total", &[Rail], often(0.0)),
    ("load.total", ANY, within(&[("cycles", 1.0, 3.0)])),
    (
        "tamping.after",
        ANY,
        Want { items: Some([1, 1]), ranges: &[("axles", 16.0, 48.0), ("MGT", 2e-4, 2e-3)], ..NOTHING },
    ),
    // grains, few and coarse where they are run
    ("library.granular", RIGS, often(0.0)),
    ("library.grading", RIGS, often(0.0)),
    ("grading.passing:key", RIGS, within(&[("mm", 55.0, 65.0)])),
    ("grading.passing.log_normal.median", RIGS, within(&[("mm", 60.0, 75.0)])),
    ("grading.passing.log_normal.spread", RIGS, within(&[("", 0.05, 0.2)])),
    ("grading.cut_below", RIGS, Want { chance: Some(0.15), ranges: &[("mm", 50.0, 58.0)], ..NOTHING }),
    ("grading.cut_above", RIGS, Want { chance: Some(0.15), ranges: &[("mm", 75.0, 90.0)], ..NOTHING }),
    ("granular.youngs_modulus", RAILS, Want { chance: Some(1.0), ranges: &[("MPa", 80.0, 400.0)], ..NOTHING }),
    ("granular.contact_stiffness", ANY, often(1.0)),
    ("granular.packing", RIGS, often(1.0)),
    ("granular.scale", RIGS, within(&[("", 1.0, 1.3)])),
    ("packing.lifts", ANY, within(&[("", 1.0, 2.0)])),
    ("packing.reloads", ANY, within(&[("", 0.0, 1.0)])),
    ("packing.friction", RIGS, Want { chance: Some(1.0), ranges: &[("", 0.0, 0.4)], ..NOTHING }),
    ("granular.shape.clumps.templates", ANY, within(&[("", 1.0, 3.0)])),
    ("granular.shape.clumps.pebbles", ANY, within(&[("", 1.0, 4.0)])),
    ("random.cov", ANY, Want { chance: Some(1.0), ranges: &[("%", 0.5, 5.0)], ..NOTHING }),
    ("random.correlation", ANY, within(&[("m", 0.5, 10.0)])),
    // how it is solved
    ("solve.substructure", &[Law, Rail], only(&["auto", "law"])),
    ("solve.substructure", RIGS, Want { chance: Some(1.0), only: &["full"], ..NOTHING }),
    ("solve.substructure", &[Grains], Want { chance: Some(1.0), only: &["cells", "full", "zone"], ..NOTHING }),
    ("solve.elements_per_bay", ANY, Want { chance: Some(0.8), ranges: &[("", 1.0, 4.0)], ..NOTHING }),
    ("solve.time_step", ANY, Want { chance: Some(0.6), ranges: &[("s", 1e-4, 5e-4)], ..NOTHING }),
    ("solve.update_every", &[Law], Want { chance: Some(0.7), ranges: &[("axles", 16.0, 100.0)], ..NOTHING }),
    ("solve.update_every.adaptive.tolerance", ANY, within(&[("mm", 3e-3, 0.5)])),
    ("solve.update_every.geometric.first", ANY, within(&[("axles", 16.0, 40.0)])),
    ("solve.update_every.geometric.ratio", ANY, within(&[("", 0.05, 1.0)])),
    ("solve.time_step.adaptive.tolerance", ANY, within(&[("", 1e-5, 1e-3)])),
    ("solve.start", ANY, often(0.02)),
    ("solve.finish", ANY, often(0.02)),
    ("solve.window", RAILS, often(0.1)),
    ("solve.window", ANY, often(0.0)),
    ("solve.grain_step", ANY, often(0.02)),
    ("solve.budget", ANY, often(0.03)),
    ("solve.memory", ANY, often(0.03)),
    ("solve.gravity", ANY, within(&[("m/s^2", 9.0, 10.0)])),
    ("solve.repeats", ANY, Want { chance: Some(0.03), ranges: &[("", 1.0, 2.0)], ..NOTHING }),
    ("study.repeats", ANY, within(&[("", 1.0, 2.0)])),
    ("study.sampling.latin_hypercube.points", ANY, within(&[("", 1.0, 8.0)])),
    ("study.sampling.sobol.points", ANY, within(&[("", 1.0, 8.0)])),
    // what is asked of it
    ("record.quantities", &[Law, Grains], Want { items: Some([1, 3]), only: OF_TRAINS, ..NOTHING }),
    ("record.quantities", &[Rail], Want { items: Some([1, 2]), only: OF_RAIL, ..NOTHING }),
    ("record.quantities", RIGS, Want { items: Some([1, 2]), only: OF_RIG, ..NOTHING }),
    ("record.at", ANY, often(0.7)),
    ("record.over", ANY, often(0.2)),
    (
        "record.after",
        TRAINS,
        Want {
            only: &["axles", "MGT"],
            ranges: &[("axles", 0.0, 16.0), ("MGT", 0.0, 1e-4)],
            items: Some([1, 1]),
            ..NOTHING
        },
    ),
    ("record.after", ANY, Want { only: &["cycles"], ranges: &[("cycles", 1.0, 1.0)], items: Some([1, 1]), ..NOTHING }),
    ("record.every", ANY, within(&[("s", 5e-4, 1e-2)])),
    ("record.depth", ANY, within(&[("m", 0.05, 0.12)])),
    ("record.states", ANY, often(0.02)),
    ("expect.that", &[Law, Grains], only(OF_TRAINS)),
    ("expect.that", &[Rail], only(OF_RAIL)),
    ("expect.that", RIGS, only(OF_RIG)),
    ("study.minimise", &[Law], only(OF_TRAINS)),
    ("study.maximise", &[Law], only(OF_TRAINS)),
    ("study.report", &[Law], only(OF_TRAINS)),
    ("study.subject_to", &[Law], only(OF_TRAINS)),
];

const SECTIONS: &[(&str, f64, f64)] = &[("m", 24.0, 48.0), ("sleepers", 40.0, 70.0)];
const RIG_SECTIONS: &[(&str, f64, f64)] = &[("m", 0.5, 0.8), ("sleepers", 1.0, 2.0)];
const OF_TRAINS: &[&str] = &[
    "settlement",
    "rail_seat_load",
    "contact_force",
    "wheel_force",
    "rail_displacement",
    "void",
    "sleeper_displacement",
];
const OF_RAIL: &[&str] =
    &["rail_seat_load", "contact_force", "rail_displacement", "rail_moment", "sleeper_displacement"];
const OF_RIG: &[&str] = &["settlement", "ballast_stress", "porosity", "coordination_number", "contact_force"];

/// Fields that leave no room for others of their object.
pub const ALONE: &[(&str, &str, &[&str])] = &[
    ("trackform", "slab", &["sleeper", "usp", "layers", "support", "crib", "shoulder", "settlement"]),
    ("load", "strain", &["total"]),
];
