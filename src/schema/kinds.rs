//! The table of kinds and fields. Ranges are in the unit of their field; `per` names the basis of the range first.

use super::fields::*;
use super::{Alternative, Basis, Field, Form, Kind, Measure, Role, Word};
use super::{materials, results, traffic};

const fn side(name: &'static str, doc: &'static str) -> Word {
    const SEATS: &[Field] = &[optional(
        "seats",
        Form::Interval(measure("m", -1.2, 1.2)),
        "where sleeper -1 and seat +1 lie, from the boundary; one spacing before it and on it where absent",
    )];
    Word { name, doc, arguments: SEATS, planned: false }
}
/// What scatters along the track. Its first argument, the mean, and `sd` are of the field that varies.
pub static RANDOM: Word = Word {
    name: "random",
    doc: "scattered about a mean",
    arguments: &[
        default("cov", number("%", 0.1, 100.0), "10 %", "standard deviation over the mean; `sd` gives it as a value"),
        default("correlation", number("m", 0.2, 1000.0), "3 m", "distance over which values become unlike: exp(-1)"),
        default(
            "distribution",
            Form::Words(&[word("normal", ""), word("log_normal", "positive; its logarithm is normal")]),
            "normal",
            "",
        ),
        optional(
            "seed",
            Form::Integer { min: 0, max: 1_000_000_000 },
            "else drawn from `solve.seed` and the field's path",
        ),
        optional("stream", Form::Text, "what it is drawn for, in the place of the field's path"),
    ],
    planned: false,
};

const SLEEPER_OR_SEAT: Basis = Basis { names: &[("sleeper", 0.5), ("seat", 1.0)], assumed: Some("sleeper") };
const SEAT_OR_SLEEPER: Basis = Basis { names: &[("seat", 1.0), ("sleeper", 0.5)], assumed: None };
const RAIL_OR_TRACK: Basis = Basis { names: &[("rail", 1.0), ("track", 0.5)], assumed: None };

const AUTO: &[Word] = &[word("auto", "chosen by the planner")];
const USP: Form = Form::OneOf(&[Form::Object("usp"), Form::Words(NONE)]);
const SEATING: Form = Form::OneOf(&[Form::Object("seating"), Form::Words(NONE)]);
const AUXILIARY_RAILS: Form = Form::OneOf(&[Form::Object("auxiliary_rails"), Form::Words(NONE)]);
const APPROACH_SLAB: Form = Form::OneOf(&[Form::Object("approach_slab"), Form::Words(NONE)]);
const RAIL: Form = Form::OneOf(&[Form::Object("rail"), Form::Words(NONE)]);
const PAD: Form = Form::OneOf(&[Form::Object("pad"), Form::Words(NONE)]);
const SLEEPER: Form = Form::OneOf(&[Form::Object("sleeper"), Form::Words(NONE)]);
const SLAB: Form = Form::OneOf(&[Form::Object("slab"), Form::Words(NONE)]);
const SUPPORT: Form = Form::OneOf(&[
    Form::Object("support"),
    Form::Words(&[word("rigid", "a seat that does not move"), word("none", "absent")]),
]);
const CRIB: Form = Form::OneOf(&[number("mm", 10.0, 500.0), Form::Words(NONE)]);
const SHOULDER: Form = Form::OneOf(&[number("m", 0.01, 3.0), Form::Words(NONE)]);
const TRACK_OR_RAIL: Basis = Basis { names: &[("track", 0.5), ("rail", 1.0)], assumed: Some("track") };
const LAYERS: Form = Form::Pairs {
    key: &Form::OneOf(&[Form::Object("granular"), Form::Object("soil")]),
    value: &Form::OneOf(&[
        along(number("m", 0.0, 100.0)),
        Form::Words(&[word("rest", "what is left of the depth; in stretches only")]),
    ]),
    implied: None,
};

/// Every kind, in the order of `trackbed docs`.
pub const KINDS: &[Kind] = &[
    Kind {
        name: "scenario",
        doc: "What the file is about, and which physics rules it silences or enforces.",
        role: Role::Scene { once: true },
        fields: &[
            optional("title", Form::Text, "heads the report; the file's name where absent"),
            optional(
                "allow",
                Form::Pairs { key: &Form::Rule, value: &Form::Text, implied: None },
                "physics rules silenced, each with a reason",
            ),
            optional("deny", Form::List(&Form::Rule), "physics rules made errors"),
            optional("warn", Form::List(&Form::Rule), "physics rules that are silent unless asked for"),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "rail",
        doc: "One rail as a beam.",
        role: Role::Part,
        fields: &[
            way("mass", number("kg/m", 25.0, 80.0), "of one rail"),
            way("density", number("kg/m^3", 7000.0, 8100.0), "of the steel"),
            way("area", number("cm^2", 30.0, 110.0), "of the cross-section"),
            way(
                "bending_stiffness",
                number("MN m^2", 1.0, 12.0),
                "EI, vertical; a stiffer rail spreads the load further",
            ),
            way("youngs_modulus", number("GPa", 190.0, 220.0), "of the steel"),
            way("second_moment", number("cm^4", 500.0, 5000.0), "about the horizontal axis"),
            optional(
                "shear_stiffness",
                number("MN", 50.0, 500.0),
                "kappa G A, vertical; needed for `solve.beam = timoshenko`",
            ),
            default("height", number("mm", 100.0, 200.0), "172 mm", "for the drawing"),
        ],
        alternatives: &[
            either(&[&["mass"], &["density", "area"]]),
            either(&[&["bending_stiffness"], &["youngs_modulus", "second_moment"]]),
        ],
        planned: &[],
    },
    Kind {
        name: "pad",
        doc: "A rail pad: a spring and a damper between rail and sleeper, under one rail.",
        role: Role::Part,
        fields: &[
            required("stiffness", along(number("MN/m", 5.0, 3000.0)), "dynamic, of one pad"),
            way("damping", along(number("kN s/m", 0.0, 6000.0)), "of one pad"),
            way(
                "damping_time",
                number("ms", 0.0, 2.0),
                "damping / stiffness; by default that of Ahmadi et al. (2026), 5 kN s/m on 40 MN/m",
            ),
        ],
        alternatives: &[Alternative {
            ways: &[&["damping"], &["damping_time"]],
            default: Some(("damping_time", "0.125 ms")),
            exclusive: false,
        }],
        planned: &[],
    },
    Kind {
        name: "usp",
        doc: "An under sleeper pad, in series with the support. It makes the track softer and spreads the load over more sleepers.",
        role: Role::Part,
        fields: &[
            required(
                "bedding_modulus",
                along(number("N/mm^3", 0.01, 1.0)),
                "static, of pad on ballast; times the sleeper's base area it is a stiffness",
            ),
            default("damping_time", number("ms", 0.0, 2.0), "0.2 ms", "damping / stiffness; the default is unchecked"),
            default("thickness", number("mm", 3.0, 30.0), "10 mm", "for the drawing"),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "sleeper",
        doc: "A sleeper, rigid.",
        role: Role::Part,
        fields: &[
            required("mass", per("kg", 50.0, 1000.0, &SLEEPER_OR_SEAT), "heavier sleepers lift less"),
            unread(default(
                "bending",
                Form::Words(&[word("rigid", "does not bend")]),
                "rigid",
                "bending of the sleeper itself",
            )),
            default("length", number("m", 2.0, 3.0), "2.6 m", "across the track"),
            default("base_width", number("m", 0.2, 0.7), "0.3 m", "along the track"),
            default("height", number("m", 0.1, 0.3), "0.21 m", ""),
            optional(
                "base_area",
                number("m^2", 0.3, 1.5),
                "that bears on the ballast; length x base_width where absent",
            ),
            default("seat_distance", number("m", 1.0, 1.8), "1.5 m", "between the rails"),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "slab",
        doc: "A slab: a beam on a Winkler foundation that carries the pads.",
        role: Role::Part,
        fields: &[
            required("bending_stiffness", per("MN m^2", 1.0, 5000.0, &RAIL_OR_TRACK), "EI, vertical"),
            required("mass", per("kg/m", 200.0, 10000.0, &RAIL_OR_TRACK), "per metre of track"),
            required("foundation_stiffness", per("MN/m^2", 5.0, 5000.0, &RAIL_OR_TRACK), "per metre of track"),
            default(
                "foundation_damping_time",
                number("ms", 0.0, 5.0),
                "1 ms",
                "damping / stiffness of the foundation; the default is that of ballast, unchecked",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "support",
        doc: "What carries a sleeper: a spring and a damper that push but do not pull, and that settle.",
        role: Role::Part,
        fields: &[
            required(
                "stiffness",
                along(per("MN/m", 1.0, 1000.0, &SEAT_OR_SLEEPER)),
                "of ballast and subgrade together",
            ),
            way("damping", along(per("kN s/m", 0.0, 5000.0, &SEAT_OR_SLEEPER)), ""),
            way(
                "damping_time",
                number("ms", 0.0, 5.0),
                "damping / stiffness; track models take 0.2 .. 1.2 ms (railFE 1.18, Zhai 2004 0.4), Ahmadi et al. (2026) print none",
            ),
            default(
                "seating",
                SEATING,
                "none",
                "a softer first part of its compression: ballast without load is far softer",
            ),
        ],
        alternatives: &[Alternative {
            ways: &[&["damping"], &["damping_time"]],
            default: Some(("damping_time", "1 ms")),
            exclusive: false,
        }],
        planned: &[],
    },
    Kind {
        name: "seating",
        doc: "The first compression of a support: up to `closure` its force grows with this stiffness, beyond it with that of the support.",
        role: Role::Nested,
        fields: &[
            required("stiffness", per("MN/m", 0.1, 1000.0, &SEAT_OR_SLEEPER), "not above the support's"),
            required("closure", number("mm", 0.01, 20.0), "compression at which ballast and sleeper have closed up"),
        ],
        alternatives: &[],
        planned: &[],
    },
    materials::GRADING,
    materials::GRANULAR,
    materials::PACKING,
    materials::BOND,
    materials::SOIL,
    Kind {
        name: "trackform",
        doc: "A way to build track: what repeats from seat to seat.",
        role: Role::Part,
        fields: &[
            optional("rail", RAIL, ""),
            optional("pad", PAD, ""),
            optional("sleeper", SLEEPER, "a slab has none"),
            optional("usp", USP, "under the sleepers, in series with the support"),
            required(
                "spacing",
                along(number("m", 0.3, 1.2)),
                "of sleepers or seats: at each the distance to its neighbour away from the transition; varies in a stretch",
            ),
            optional(
                "slab",
                SLAB,
                "carries the seats instead of sleepers, layers and support; it drops those inherited",
            ),
            optional(
                "layers",
                LAYERS,
                "under the sleepers, downwards, each with its thickness: what carries them, and what grain tiers model",
            ),
            optional(
                "support",
                SUPPORT,
                "carries the sleepers; beside `layers` it serves where no 3D model gives one, and without it they do",
            ),
            default(
                "settlement",
                along(number("mm", -100.0, 100.0)),
                "0 mm",
                "permanent settlement of the supports at the start; where the rail does not follow it, a void opens",
            ),
            default(
                "auxiliary_rails",
                AUXILIARY_RAILS,
                "none",
                "rails beside the running rails, from one end of the section to the other: they spread the load",
            ),
            default(
                "crib",
                CRIB,
                "none",
                "height of the grains of the top granular layer between the sleepers, above their underside; up to their height",
            ),
            default(
                "shoulder",
                SHOULDER,
                "none",
                "width of such grains beyond the ends of the sleepers, as high as the `crib`, which it needs",
            ),
        ],
        // layers and support stand beside each other, a slab alone
        alternatives: &[Alternative {
            ways: &[&["slab"], &["layers", "support"]],
            default: Some(("slab", "none")),
            exclusive: false,
        }],
        planned: &[],
    },
    Kind {
        name: "auxiliary_rails",
        doc: "Rails beside the running rails on pads of their own. They carry no wheel.",
        role: Role::Nested,
        fields: &[
            required("rail", Form::Object("rail"), "each of them"),
            default("count", Form::Integer { min: 1, max: 4 }, "2", "of the whole track; one rail has half of them"),
            required("pad", Form::Object("pad"), "under each of them at each sleeper; the same along the section"),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "stretch",
        doc: "What differs over a span of the track: it extends the trackform there. A mitigation, or a defect.",
        role: Role::Changes("trackform"),
        fields: &[
            required("over", Form::Span, "from its first to its last end; profiles in it run over it"),
            optional(
                "from",
                Form::List(&Form::Name),
                "the transitions from which `over` counts, mirrored at each; needed where there are several",
            ),
            default("approach_slab", APPROACH_SLAB, "none", "a plate in the layers, towards a structure"),
        ],
        alternatives: &[],
        planned: &[],
    },
    materials::APPROACH_SLAB,
    Kind {
        name: "track",
        doc: "The track: sections of trackform side by side. x = 0 is the first transition.",
        role: Role::Scene { once: true },
        fields: &[
            required(
                "sections",
                Form::Pairs {
                    key: &Form::Object("trackform"),
                    value: &Form::OneOf(&[number("m", 0.3, 100_000.0), number("sleepers", 1.0, 200_000.0)]),
                    implied: None,
                },
                "left to right, each with its length",
            ),
            optional(
                "transitions",
                Form::Pairs {
                    key: &Form::Name,
                    value: &Form::Words(&[
                        side("soft_to_stiff", "the softer side lies at smaller x"),
                        side("stiff_to_soft", "the softer side lies at greater x"),
                    ]),
                    implied: None,
                },
                "names and sides of the boundaries; a single one is `soft_to_stiff`",
            ),
            default(
                "rail_ends",
                Form::Words(&[
                    word("clamped", "held level, at the level of the settled track there"),
                    word("pinned", "held at that level, free to turn"),
                    word("free", "not held"),
                    word("absorbing", "let waves out, as if the track went on"),
                ]),
                "clamped",
                "what holds the rail at the ends of the model",
            ),
            optional(
                "bed_width",
                per("m", 0.5, 20.0, &TRACK_OR_RAIL),
                "of the layers between their side walls; the length of the longest sleeper, and its shoulders, where absent",
            ),
            default(
                "bed_ends",
                Form::Words(&[word("walls", "rigid walls across the track"), word("periodic", "the bed goes on")]),
                "walls",
                "what closes the layers at the ends of the model",
            ),
            default(
                "base",
                Form::Words(&[word("rigid", "does not move"), word("quiet", "lets waves out")]),
                "rigid",
                "under the lowest layer",
            ),
            default(
                "irregularity",
                along(number("mm", -50.0, 50.0)),
                "0 mm",
                "level of the rail as built, positive down; a file of it is read as a smooth curve",
            ),
            default(
                "stretches",
                Form::List(&Form::Object("stretch")),
                "[]",
                "what differs along it; where two overlap they set different things",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    traffic::VEHICLE,
    traffic::CAR_BODY,
    traffic::BOGIE,
    traffic::WHEELSET,
    traffic::PRIMARY_SUSPENSION,
    traffic::SECONDARY_SUSPENSION,
    traffic::TRAIN,
    traffic::TRAFFIC,
    traffic::LOAD,
    Kind {
        name: "law",
        doc: "The settlement of a support under the peaks of its contact force.",
        role: Role::Part,
        fields: &[
            required("form", Form::Words(super::laws::FORMS), ""),
            optional(
                "loads",
                Form::Interval(Measure { basis: Some(&SEAT), ..measure("kN", 0.0, 10_000.0) }),
                "peak forces for which it was calibrated",
            ),
            optional("cycles", Form::Interval(measure("axles", 0.0, 1e12)), "axle counts for which it was calibrated"),
            default(
                "cycle_per",
                Form::Words(&[
                    word("axle", "every axle is a cycle"),
                    word("bogie", "the larger peak of its two axles is one cycle"),
                    word("vehicle", "the largest peak of its four axles is one cycle"),
                ]),
                "axle",
                "what one cycle of the law is: publications differ, by a factor of four",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "tamping",
        doc: "Sleepers lifted and packed anew: brings the level back at some counts. Their settlement law begins afresh.",
        role: Role::Scene { once: false },
        fields: &[
            required("after", Form::List(&AXLES_OR_MASS), "how much traffic; between the first and the last train"),
            optional("over", Form::Span, "which sleepers; all on ballast where absent"),
            optional(
                "from",
                Form::List(&Form::Name),
                "the transitions from which `over` counts, mirrored at each; needed where there are several",
            ),
            default(
                "left",
                number("%", 0.0, 100.0),
                "0 %",
                "share of the settlement that stays, and of the voids with it",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "solve",
        doc: "How the answer is computed.",
        role: Role::Scene { once: true },
        fields: &[
            default(
                "substructure",
                Form::Words(&[
                    word("auto", "the cheapest tier that answers"),
                    word("law", "a settlement law under each sleeper"),
                    word(
                        "cells",
                        "grains under each sleeper that differs, in a periodic cell that no rail joins to the others; tens of minutes",
                    ),
                    word("zone", "grains within 10 m of a transition, springs beyond; hours"),
                    word("full", "grains under all of `window`, springs beyond; a day and more"),
                ]),
                "auto",
                "the tier of the model under the sleepers",
            ),
            default(
                "law",
                Form::OneOf(&[Form::Object("law"), Form::List(&Form::Object("law"))]),
                "laws.varandas_2014",
                "by which the supports settle; of several the first drives, all are shown as a spread",
            ),
            default(
                "support_method",
                Form::Words(&[
                    word("stress_cone", "the load spreads at an angle; neighbours share what lies below their meeting"),
                    Word {
                        name: "layered_elastic",
                        doc: "linear elasticity of bonded layers under a uniform pressure",
                        arguments: &[default(
                            "neighbours",
                            number("", 0.0, 1.0),
                            "0.73",
                            "what the next sleepers bear, as share of the load of this one",
                        )],
                        planned: false,
                    },
                ]),
                "stress_cone",
                "by which layers become the support of a sleeper",
            ),
            default(
                "update_every",
                Form::OneOf(&[
                    number("axles", 1.0, 1e9),
                    Form::Words(&[
                        Word {
                            name: "geometric",
                            doc: "blocks that grow with the axles so far",
                            arguments: &[
                                required("first", number("axles", 1.0, 1e9), "the smallest block"),
                                required("ratio", number("", 0.001, 10.0), "block / axles so far"),
                            ],
                            planned: false,
                        },
                        Word {
                            name: "adaptive",
                            doc: "blocks as long as their estimated error allows",
                            arguments: &[
                                default(
                                    "tolerance",
                                    number("mm", 1e-6, 10.0),
                                    "0.003 mm",
                                    "error of settlement that a block may add at any seat",
                                ),
                                optional(
                                    "cap",
                                    number("mm", 1e-4, 100.0),
                                    "settlement of a block at any seat, at most",
                                ),
                            ],
                            planned: false,
                        },
                    ]),
                ]),
                "adaptive(0.003 mm)",
                "axles between two exchanges of forces and settlement",
            ),
            default(
                "passages",
                Form::Words(&[
                    word("isolated", "trains run one by one, and the track comes to rest between them"),
                    word(
                        "continuous",
                        "those of a block follow each other coupler to coupler; every vehicle needs its `length`",
                    ),
                ]),
                "isolated",
                "of trains over grains",
            ),
            default(
                "beam",
                Form::Words(&[
                    word("euler", "Euler-Bernoulli: bends"),
                    word("timoshenko", "bends and shears; needs the rail's `shear_stiffness`"),
                ]),
                "euler",
                "beam theory of the rail",
            ),
            default("elements_per_bay", Form::Integer { min: 1, max: 32 }, "4", "beam elements between two seats"),
            default(
                "integrator",
                Form::Words(&[
                    Word {
                        name: "generalised_alpha",
                        doc: "Chung and Hulbert (1993)",
                        arguments: &[default(
                            "rho",
                            number("", 0.0, 1.0),
                            "0.85",
                            "spectral radius at infinite frequency",
                        )],
                        planned: false,
                    },
                    Word {
                        name: "hht",
                        doc: "Hilber, Hughes and Taylor (1977)",
                        arguments: &[default(
                            "alpha",
                            number("", 0.0, 1.0 / 3.0),
                            "0.1",
                            "damping of high frequencies",
                        )],
                        planned: false,
                    },
                    word("newmark", "average acceleration, without damping of its own"),
                ]),
                "generalised_alpha(0.85)",
                "time integration of track and vehicle",
            ),
            default(
                "time_step",
                Form::OneOf(&[
                    number("s", 1e-7, 0.01),
                    Form::Words(&[
                        word("auto", "chosen by the planner"),
                        Word {
                            name: "adaptive",
                            doc: "steps as large as the wanted error allows",
                            arguments: &[default(
                                "tolerance",
                                number("", 1e-8, 0.001),
                                "1e-5",
                                "error of a step as part of the rail's largest deflection",
                            )],
                            planned: false,
                        },
                    ]),
                ]),
                "auto",
                "of track and vehicle",
            ),
            default("start", Form::OneOf(&[Form::Place, Form::Words(AUTO)]), "auto", "of the leading wheel"),
            default("finish", Form::OneOf(&[Form::Place, Form::Words(AUTO)]), "auto", "of the leading wheel"),
            default("gravity", number("m/s^2", 0.0, 20.0), "9.81 m/s^2", ""),
            default("seed", Form::Integer { min: 0, max: 1_000_000_000 }, "1", "of everything random"),
            default(
                "window",
                Form::OneOf(&[Form::Span, Form::Words(AUTO)]),
                "auto",
                "where grains are modelled, at every transition; track and vehicle keep their length",
            ),
            default(
                "coupling",
                Form::Words(&[
                    word(
                        "iterated",
                        "track and grains in turn: wheel forces one way, settlement and stiffness the other",
                    ),
                    word("monolithic", "vehicles ride on the rail over the grains, all in one time step"),
                ]),
                "iterated",
                "of track and grains",
            ),
            default(
                "support_from",
                Form::Words(&[
                    word("static_load", "all sleepers pressed at once, on a copy of the grains"),
                    word("passage", "the forces of the last passage"),
                ]),
                "static_load",
                "from which grains give the stiffness of supports",
            ),
            default(
                "sleeper_pitch",
                Form::Words(&[
                    word("held", "sleepers on grains stay level"),
                    word("free", "they turn about their axis across the track, held by their rail pads alone"),
                ]),
                "held",
                "of sleepers on grains",
            ),
            default(
                "cell_bays",
                Form::Integer { min: 1, max: 3 },
                "1",
                "bays of a periodic cell of grains; the next sleepers are loaded by their own forces",
            ),
            default(
                "grain_step",
                Form::OneOf(&[number("s", 1e-9, 1e-2), Form::Words(AUTO)]),
                "auto",
                "time step of grains",
            ),
            default(
                "soil_element",
                Form::OneOf(&[number("m", 0.005, 5.0), Form::Words(AUTO)]),
                "auto",
                "of the elements of soil",
            ),
            default(
                "tolerance",
                number("%", 0.1, 50.0),
                "5 %",
                "of the largest settlement: the change for which `zone` leaves a bay to springs and sleepers share a cell; of that of a cell: the error of the trains that it leaves out",
            ),
            default(
                "budget",
                Form::OneOf(&[number("min", 0.01, 1e6), Form::Words(NONE)]),
                "none",
                "time that the run may take",
            ),
            default(
                "memory",
                Form::OneOf(&[number("GiB", 0.01, 1e5), Form::Words(NONE)]),
                "none",
                "that the run may take",
            ),
            default(
                "symmetry",
                Form::Words(&[word("half", "the bed of one rail"), word("full", "the bed of both rails")]),
                "half",
                "of the bed of grains",
            ),
            default(
                "repeats",
                Form::Integer { min: 1, max: 1000 },
                "1",
                "packings with further seeds, for the band of confidence",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    results::RECORD,
    results::EXPECT,
    results::STUDY,
];

/// Fields that every kind has.
pub const COMMON: &[Field] = &[
    optional("source", Form::Text, "where the data comes from"),
    optional(
        "evidence",
        Form::Words(&[
            word("read", "taken over from its source"),
            word("derived", "computed from other data"),
            word("unchecked", "common knowledge, to be checked before it is relied on"),
        ]),
        "how the data was taken over",
    ),
];
