//! Kinds of what is asked of a scene: records, expectations, studies.

use super::fields::{AXLE_COUNT, default, number, optional, required, word};
use super::{Field, Form, Kind, Role, Word};

const AXLES_MASS_OR_CYCLES: Form = Form::OneOf(&[AXLE_COUNT, number("MGT", 0.0, 1e4), number("cycles", 0.0, 1e9)]);

const fn sampled(name: &'static str, doc: &'static str) -> Word {
    const POINTS: &[Field] = &[required("points", Form::Integer { min: 1, max: 100_000 }, "how many")];
    Word { name, doc, arguments: POINTS, planned: false }
}

const VOLUMES: &[Word] = &[
    Word {
        name: "box",
        doc: "a box about the depth, under the middle of the sleeper",
        arguments: &[
            default("along", number("m", 0.01, 10.0), "0.2 m", ""),
            default(
                "across",
                Form::OneOf(&[number("m", 0.01, 20.0), Form::Words(&[word("bed", "the whole width of the bed")])]),
                "bed",
                "",
            ),
            default("height", number("m", 0.01, 10.0), "0.2 m", ""),
        ],
        planned: false,
    },
    Word {
        name: "sphere",
        doc: "a sphere about the depth",
        arguments: &[required("radius", number("m", 0.005, 5.0), "")],
        planned: false,
    },
];

pub(super) const RECORD: Kind = Kind {
    name: "record",
    doc: "Histories to keep. Tables along the track are always written.",
    role: Role::Scene { once: false },
    fields: &[
        required("quantities", Form::List(&Form::Response), "what to keep"),
        optional("at", Form::List(&Form::Place), "at these seats"),
        optional("over", Form::Span, "at all seats of a span"),
        optional(
            "from",
            Form::List(&Form::Name),
            "the transitions from which places count, mirrored at each; needed where there are several",
        ),
        optional(
            "after",
            Form::List(&AXLES_MASS_OR_CYCLES),
            "of a passage at these axle counts, or of a cyclic load at these cycles; the last where absent",
        ),
        optional("every", number("s", 1e-7, 1.0), "sampling interval"),
        optional("depth", number("m", 0.0, 100.0), "of volumes, below the sleepers; half the top layer where absent"),
        default(
            "volume",
            Form::Words(VOLUMES),
            "box(0.2 m, bed, 0.2 m)",
            "over which the responses of ballast are averaged",
        ),
        default(
            "states",
            Form::Words(&[word("none", "tables and histories only"), word("vtk", "files that ParaView opens")]),
            "none",
            "rail, sleepers and grains whole, at the counts of `after`",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const EXPECT: Kind = Kind {
    name: "expect",
    doc: "What the run must show; a miss is named and sets the exit code.",
    role: Role::Scene { once: false },
    fields: &[required("that", Form::List(&Form::Comparison), "comparisons of responses")],
    alternatives: &[],
    planned: &[],
};

pub(super) const STUDY: Kind = Kind {
    name: "study",
    doc: "Runs of the scene with some of its lines edited, one a point: `trackbed study`.",
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
                word("grid", "every combination; lists and steps only"),
                sampled("latin_hypercube", "one point in each stratum of every value"),
                sampled("sobol", "low discrepancy; best for powers of two"),
            ]),
            "grid",
            "how points are chosen",
        ),
        optional("set", Form::Settings, "lines edited alike in every point"),
        default("repeats", Form::Integer { min: 1, max: 1000 }, "1", "runs of each point, each with a further seed"),
        optional("budget", number("h", 1e-4, 1e5), "of computing on one core; a study above it is refused"),
        optional("minimise", Form::List(&Form::Expression), "several objectives give a Pareto front"),
        optional("maximise", Form::List(&Form::Expression), ""),
        optional("report", Form::List(&Form::Expression), "shown beside the objectives"),
        optional(
            "subject_to",
            Form::List(&Form::Comparison),
            "what a design must hold; points that break one without a response are left out",
        ),
    ],
    alternatives: &[],
    planned: &[],
};
