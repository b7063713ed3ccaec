//! Kinds of requests to a scene: records, expectations, studies.

use super::fields::{AXLE_COUNT, REPEATS, default, number, optional, required, word};
use super::{Field, Form, Kind, Role, Word};

const AXLES_MASS_OR_CYCLES: Form = Form::OneOf(&[AXLE_COUNT, number("MGT", 0.0, 1e4), number("cycles", 0.0, 1e9)]);

const fn sampled(name: &'static str, doc: &'static str) -> Word {
    const POINTS: &[Field] = &[required("points", Form::Integer { min: 1, max: 100_000 }, "number of points")];
    Word { name, doc, arguments: POINTS, planned: false }
}

const VOLUMES: &[Word] = &[
    Word {
        name: "box",
        doc: "a box centred at `depth`, under the middle of the sleeper",
        arguments: &[
            default("along", number("m", 0.01, 10.0), "0.2 m", "length along the track"),
            default(
                "across",
                Form::OneOf(&[number("m", 0.01, 20.0), Form::Words(&[word("bed", "the whole width of the bed")])]),
                "bed",
                "width across the track",
            ),
            default("height", number("m", 0.01, 10.0), "0.2 m", "height of the box"),
        ],
        planned: false,
    },
    Word {
        name: "sphere",
        doc: "a sphere centred at `depth`",
        arguments: &[required("radius", number("m", 0.005, 5.0), "radius of the sphere")],
        planned: false,
    },
];

pub(super) const RECORD: Kind = Kind {
    name: "record",
    doc: "Histories that the run keeps. Tables along the track are always written.",
    role: Role::Scene { once: false },
    fields: &[
        required("quantities", Form::List(&Form::Response), "responses to keep"),
        optional("at", Form::List(&Form::Place), "seats at which they are kept"),
        optional("over", Form::Span, "span in which they are kept at all seats"),
        optional(
            "from",
            Form::List(&Form::Name),
            "the transitions from which places are measured, mirrored at each; needed if there are several transitions",
        ),
        optional(
            "after",
            Form::List(&AXLES_MASS_OR_CYCLES),
            "axle counts of the passages, or cycles of a cyclic load, that are kept; by default the last",
        ),
        optional("every", number("s", 1e-7, 1.0), "sampling interval of the histories"),
        optional(
            "depth",
            number("m", 0.0, 100.0),
            "depth of the volumes below the sleepers; by default half of the top layer",
        ),
        default(
            "volume",
            Form::Words(VOLUMES),
            "box(0.2 m, bed, 0.2 m)",
            "volume over which the responses of the ballast are averaged",
        ),
        default(
            "states",
            Form::Words(&[word("none", "no states, only tables and histories"), word("vtk", "files for ParaView")]),
            "none",
            "complete states of rail, sleepers and grains, at the counts of `after`",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const EXPECT: Kind = Kind {
    name: "expect",
    doc: "Conditions that the results must meet. A condition that is not met is reported and sets the exit code.",
    role: Role::Scene { once: false },
    fields: &[required("that", Form::List(&Form::Comparison), "comparisons of responses")],
    alternatives: &[],
    planned: &[],
};

pub(super) const STUDY: Kind = Kind {
    name: "study",
    doc: "A study: runs of the scene with other values of some fields, one run for each point (`trackbed study`).",
    role: Role::Scene { once: false },
    fields: &[
        required(
            "vary",
            Form::Axes,
            "`[values]`, `a .. b`, `steps(a .. b, by = c)` or `count = n`, `uniform(a .. b)`, `normal(mean, sd)`, \
             `log_normal(median, cov)`",
        ),
        default(
            "sampling",
            Form::Words(&[
                word("grid", "every combination; for lists and steps only"),
                sampled("latin_hypercube", "Latin hypercube: one point in each stratum of every value"),
                sampled("sobol", "Sobol sequence of low discrepancy; best if the number of points is a power of two"),
            ]),
            "grid",
            "how the points are chosen",
        ),
        optional("set", Form::Settings, "fields that have the same new value in every point"),
        default(
            "repeats",
            REPEATS,
            "1",
            "runs of each point, each with another seed; all points have the same seeds. In a range such as `3 .. 12` \
             a point has as many as its difference from the best point needs, or from the scene as it is",
        ),
        default(
            "tolerance",
            number("%", 0.0, 100.0),
            "5 %",
            "difference that does not matter, as a share of the value of the scene as it is; it ends an open range of \
             `repeats`",
        ),
        optional("budget", number("h", 1e-4, 1e5), "computing time on one core; a study that needs more is refused"),
        optional(
            "minimise",
            Form::List(&Form::Expression),
            "expressions to minimise; several objectives give a Pareto front",
        ),
        optional("maximise", Form::List(&Form::Expression), "expressions to maximise"),
        optional("report", Form::List(&Form::Expression), "expressions shown beside the objectives"),
        optional(
            "subject_to",
            Form::List(&Form::Comparison),
            "conditions that a design must meet; a point that violates a condition without responses is not run",
        ),
    ],
    alternatives: &[],
    planned: &[],
};
