//! The fields of a scene that the check itself reads.

use crate::scenario::{Scenario, Seat, Study};
use crate::schema::{Reader, Reads};

/// Fields that act in every plan: places, parts, questions about the scene, and the seed of random values.
pub const ALWAYS_READ: &[&str] = &[
    "scenario.title",
    "scenario.allow",
    "scenario.deny",
    "scenario.warn",
    // the size of sleepers: their footprint, and the drawing
    "sleeper.length",
    "sleeper.base_width",
    "sleeper.height",
    "sleeper.base_area",
    "sleeper.seat_distance",
    "trackform.rail",
    "trackform.pad",
    "trackform.sleeper",
    "trackform.usp",
    "trackform.spacing",
    "trackform.slab",
    "trackform.layers",
    "trackform.support",
    "trackform.settlement",
    "trackform.auxiliary_rails",
    "auxiliary_rails.rail",
    "auxiliary_rails.count",
    "auxiliary_rails.pad",
    "stretch.over",
    "stretch.from",
    "stretch.approach_slab",
    "approach_slab.thickness",
    "approach_slab.youngs_modulus",
    "approach_slab.depth",
    "approach_slab.hinged",
    "track.sections",
    "track.transitions",
    "track.stretches",
    "load.on",
    "load.at",
    "load.from",
    "load.force",
    "load.strain",
    "load.confinement",
    "load.speed",
    "solve.substructure",
    "solve.seed",
    "record.quantities",
    "record.at",
    "record.over",
    "record.from",
    "expect.that",
    "study.vary",
    "study.sampling",
    "study.set",
    "study.repeats",
    "study.budget",
    "study.minimise",
    "study.maximise",
    "study.report",
    "study.subject_to",
];

/// Fields by which layers become the support of sleepers.
const LAYERS: Reads = Reads {
    fields: &[
        "solve.support_method",
        "track.base",
        "granular.youngs_modulus",
        "granular.poisson_ratio",
        "granular.spread",
        "soil.youngs_modulus",
        "soil.poisson_ratio",
        "soil.bulk_modulus",
        "soil.shear_modulus",
        "soil.spread",
    ],
    acts_where: "where sleepers of a track lie on layers of known moduli",
};

/// What ends an open range of packings, and tells designs that are equally good.
const SEVERAL: Reads =
    Reads { fields: &["study.tolerance"], acts_where: "where a point of the study has several `repeats`" };

/// Fields that the check reads in addition to the fields that always act; `studies` are those of the file.
pub fn readers(scenario: &Scenario, studies: &[Study]) -> Vec<Reader> {
    let on_layers = |seat: &Seat| seat.stack.is_some();
    let track = &scenario.track;
    vec![
        Reader { reads: &LAYERS, acted: track.has_rails() && track.seats.iter().any(on_layers) },
        Reader { reads: &SEVERAL, acted: studies.iter().any(|study| study.repeats.are_several()) },
    ]
}
