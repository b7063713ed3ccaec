//! The table of kinds and fields. Ranges are in the unit of their field; `per` names the basis of the range first.

use super::fields::*;
use super::{Alternative, Basis, Field, Form, Kind, Role, Word};
use super::{laws, materials, results, solve, traffic};

const fn side(name: &'static str, doc: &'static str) -> Word {
    const SEATS: &[Field] = &[optional(
        "seats",
        Form::Interval(measure("m", -1.2, 1.2)),
        "places of sleeper -1 and seat +1, measured from the boundary; by default one spacing before the boundary and on the boundary",
    )];
    Word { name, doc, arguments: SEATS, planned: false }
}
/// A value that scatters along the track. Its mean, the first argument, and `sd` have the unit of the varying field.
pub static RANDOM: Word = Word {
    name: "random",
    doc: "scattered about a mean",
    arguments: &[
        default(
            "cov",
            number("%", 0.1, 100.0),
            "10 %",
            "standard deviation / mean; `sd` gives the standard deviation itself",
        ),
        default(
            "correlation",
            number("m", 0.2, 1000.0),
            "3 m",
            "distance at which the correlation of two values is exp(-1)",
        ),
        default(
            "distribution",
            Form::Words(&[
                word("normal", "normally distributed"),
                word("log_normal", "always positive; the logarithm of the value is normally distributed"),
            ]),
            "normal",
            "distribution of the value",
        ),
        optional(
            "seed",
            Form::Integer { min: 0, max: 1_000_000_000 },
            "by default computed from `solve.seed` and the path of the field",
        ),
        optional(
            "stream",
            Form::Text,
            "text that replaces the path of the field in the seed; fields with the same text get the same pattern",
        ),
    ],
    planned: false,
};

const SLEEPER_OR_SEAT: Basis = Basis { names: &[("sleeper", 0.5), ("seat", 1.0)], assumed: Some("sleeper") };
const SEAT_OR_SLEEPER: Basis = Basis { names: &[("seat", 1.0), ("sleeper", 0.5)], assumed: None };
const RAIL_OR_TRACK: Basis = Basis { names: &[("rail", 1.0), ("track", 0.5)], assumed: None };

const USP: Form = Form::OneOf(&[Form::Object("usp"), Form::Words(NONE)]);
const LAW: Form = Form::OneOf(&[Form::Object("law"), Form::Words(NONE)]);
const SEATING: Form = Form::OneOf(&[Form::Object("seating"), Form::Words(NONE)]);
const AUXILIARY_RAILS: Form = Form::OneOf(&[Form::Object("auxiliary_rails"), Form::Words(NONE)]);
const APPROACH_SLAB: Form = Form::OneOf(&[Form::Object("approach_slab"), Form::Words(NONE)]);
const RAIL: Form = Form::OneOf(&[Form::Object("rail"), Form::Words(NONE)]);
const PAD: Form = Form::OneOf(&[Form::Object("pad"), Form::Words(NONE)]);
const SLEEPER: Form = Form::OneOf(&[Form::Object("sleeper"), Form::Words(NONE)]);
const SLAB: Form = Form::OneOf(&[Form::Object("slab"), Form::Words(NONE)]);
const SUPPORT: Form = Form::OneOf(&[
    Form::Object("support"),
    Form::Words(&[word("rigid", "the support does not move"), word("none", "absent")]),
]);
const CRIB: Form = Form::OneOf(&[number("mm", 10.0, 500.0), Form::Words(NONE)]);
const SHOULDER: Form = Form::OneOf(&[number("m", 0.01, 3.0), Form::Words(NONE)]);
const TRACK_OR_RAIL: Basis = Basis { names: &[("track", 0.5), ("rail", 1.0)], assumed: Some("track") };
const LAYERS: Form = Form::Pairs {
    key: &Form::OneOf(&[Form::Object("granular"), Form::Object("soil")]),
    value: &Form::OneOf(&[
        along(number("m", 0.0, 100.0)),
        Form::Words(&[word("rest", "the remaining depth of the layers; in stretches only")]),
    ]),
    implied: None,
};

/// Every kind, in the order of `trackbed docs`.
pub const KINDS: &[Kind] = &[
    Kind {
        name: "scenario",
        doc: "Title of the file, and the physics rules that it silences or enforces.",
        role: Role::Scene { once: true },
        fields: &[
            optional("title", Form::Text, "heading of the report; by default the name of the file"),
            optional(
                "allow",
                Form::Pairs { key: &Form::Rule, value: &Form::Text, implied: None },
                "physics rules that are silenced, each with a reason",
            ),
            optional("deny", Form::List(&Form::Rule), "physics rules that become errors"),
            optional("warn", Form::List(&Form::Rule), "physics rules to switch on that are off by default"),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "rail",
        doc: "One rail, modelled as a beam.",
        role: Role::Part,
        fields: &[
            way("mass", number("kg/m", 25.0, 80.0), "mass of one rail per metre"),
            way("density", number("kg/m^3", 7000.0, 8100.0), "density of the steel"),
            way("area", number("cm^2", 30.0, 110.0), "area of the cross-section of one rail"),
            way(
                "bending_stiffness",
                number("MN m^2", 1.0, 12.0),
                "EI for vertical bending; a stiffer rail spreads the load over more sleepers",
            ),
            way("youngs_modulus", number("GPa", 190.0, 220.0), "Young's modulus of the steel"),
            way("second_moment", number("cm^4", 500.0, 5000.0), "second moment of area about the horizontal axis"),
            optional(
                "shear_stiffness",
                number("MN", 50.0, 500.0),
                "kappa G A for vertical shear; needed for `solve.beam = timoshenko`",
            ),
            default("height", number("mm", 100.0, 200.0), "172 mm", "height of the rail in the drawing"),
        ],
        alternatives: &[
            either(&[&["mass"], &["density", "area"]]),
            either(&[&["bending_stiffness"], &["youngs_modulus", "second_moment"]]),
        ],
        planned: &[],
    },
    Kind {
        name: "pad",
        doc: "A rail pad: a spring and a damper between one rail and the sleeper.",
        role: Role::Part,
        fields: &[
            required("stiffness", along(number("MN/m", 5.0, 3000.0)), "dynamic stiffness of one pad"),
            way("damping", along(number("kN s/m", 0.0, 6000.0)), "damping of one pad"),
            way(
                "damping_time",
                number("ms", 0.0, 2.0),
                "damping / stiffness; the default is from Ahmadi et al. (2026): 5 kN s/m and 40 MN/m",
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
                "static bedding modulus of the pad on ballast; times the base area of the sleeper it gives the stiffness",
            ),
            default(
                "damping_time",
                number("ms", 0.0, 2.0),
                "0.2 ms",
                "damping / stiffness; no source was checked for the default",
            ),
            default(
                "thickness",
                number("mm", 3.0, 30.0),
                "10 mm",
                "thickness of the pad, for the drawing and for its mass on grains (there at least 7 mm)",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "sleeper",
        doc: "A sleeper, modelled as a rigid body.",
        role: Role::Part,
        fields: &[
            required(
                "mass",
                per("kg", 50.0, 1000.0, &SLEEPER_OR_SEAT),
                "mass of the sleeper; a heavier sleeper lifts less",
            ),
            unread(default(
                "bending",
                Form::Words(&[word("rigid", "the sleeper does not bend")]),
                "rigid",
                "whether the sleeper itself bends",
            )),
            default("length", number("m", 2.0, 3.0), "2.6 m", "length across the track"),
            default("base_width", number("m", 0.2, 0.7), "0.3 m", "width of the base, along the track"),
            default("height", number("m", 0.1, 0.3), "0.21 m", "height of the sleeper"),
            optional(
                "base_area",
                number("m^2", 0.3, 1.5),
                "area that rests on the ballast; by default length x base_width",
            ),
            default(
                "seat_distance",
                number("m", 1.0, 1.8),
                "1.5 m",
                "distance between the two rail seats of a sleeper",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "slab",
        doc: "A slab under the rail pads: a beam on a Winkler foundation.",
        role: Role::Part,
        fields: &[
            required("bending_stiffness", per("MN m^2", 1.0, 5000.0, &RAIL_OR_TRACK), "EI for vertical bending"),
            required("mass", per("kg/m", 200.0, 10000.0, &RAIL_OR_TRACK), "mass per metre of track"),
            required(
                "foundation_stiffness",
                per("MN/m^2", 5.0, 5000.0, &RAIL_OR_TRACK),
                "stiffness of the foundation per metre of track",
            ),
            default(
                "foundation_damping_time",
                number("ms", 0.0, 5.0),
                "1 ms",
                "damping / stiffness of the foundation; the default is the value for ballast, and no source was checked for it",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "support",
        doc: "The support of a sleeper: a spring and a damper that act in compression only, and that settle.",
        role: Role::Part,
        fields: &[
            required(
                "stiffness",
                along(per("MN/m", 1.0, 1000.0, &SEAT_OR_SLEEPER)),
                "stiffness of ballast and subgrade together",
            ),
            way(
                "damping",
                along(per("kN s/m", 0.0, 5000.0, &SEAT_OR_SLEEPER)),
                "damping of ballast and subgrade together",
            ),
            way(
                "damping_time",
                number("ms", 0.0, 5.0),
                "damping / stiffness; published track models use 0.2 .. 1.2 ms (railFE 1.18, Zhai 2004 0.4); Ahmadi et al. (2026) give no value",
            ),
            default(
                "seating",
                SEATING,
                "none",
                "lower stiffness at the start of the compression: unloaded ballast is much softer than loaded ballast",
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
        doc: "The first part of the compression of a support: up to `closure` the force grows with this stiffness, beyond it with the stiffness of the support.",
        role: Role::Nested,
        fields: &[
            required(
                "stiffness",
                per("MN/m", 0.1, 1000.0, &SEAT_OR_SLEEPER),
                "stiffness up to `closure`; not above the stiffness of the support",
            ),
            required(
                "closure",
                number("mm", 0.01, 20.0),
                "compression at which the full stiffness of the support begins",
            ),
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
        doc: "A type of track: the parts that repeat from seat to seat.",
        role: Role::Part,
        fields: &[
            optional("rail", RAIL, "the running rails"),
            optional("pad", PAD, "the rail pads"),
            optional("sleeper", SLEEPER, "the sleepers; a slab has none"),
            optional("usp", USP, "pad under each sleeper, in series with the support"),
            optional("law", LAW, "law by which these sleepers settle; without it the law of `solve`"),
            required(
                "spacing",
                along(number("m", 0.3, 1.2)),
                "distance between sleepers (on a slab: between seats), measured to the next one away from the transition; it may vary in a stretch",
            ),
            optional(
                "slab",
                SLAB,
                "the slab that carries the seats instead of sleepers, layers and support; it removes inherited layers and an inherited support",
            ),
            optional(
                "layers",
                LAYERS,
                "layers under the sleepers from top to bottom, each with its thickness; they carry the sleepers, and the tiers with grains model them",
            ),
            optional(
                "support",
                SUPPORT,
                "spring and damper under each sleeper; used instead of `layers` where no grains are modelled; if absent, the layers give the support",
            ),
            default(
                "settlement",
                along(number("mm", -100.0, 100.0)),
                "0 mm",
                "permanent settlement of the supports at the start; a void opens under a sleeper that the rail holds above its settled support",
            ),
            default(
                "auxiliary_rails",
                AUXILIARY_RAILS,
                "none",
                "rails beside the running rails over the whole section, which spread the load",
            ),
            default(
                "crib",
                CRIB,
                "none",
                "height of grains of the top granular layer between the sleepers, above the underside of the sleepers; at most the height of a sleeper",
            ),
            default(
                "shoulder",
                SHOULDER,
                "none",
                "width of grains beyond the ends of the sleepers; they are as high as the `crib`, which must be given too",
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
        doc: "Rails beside the running rails, on their own pads. Wheels do not run on them.",
        role: Role::Nested,
        fields: &[
            required("rail", Form::Object("rail"), "type of each auxiliary rail"),
            default(
                "count",
                Form::Integer { min: 1, max: 4 },
                "2",
                "number of auxiliary rails of the whole track; the model of one rail has half of them",
            ),
            required(
                "pad",
                Form::Object("pad"),
                "pad under each auxiliary rail at each sleeper; the same along the whole section",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    Kind {
        name: "stretch",
        doc: "Changes of the trackform over a span of the track, such as a mitigation or a defect.",
        role: Role::Changes("trackform"),
        fields: &[
            required("over", Form::Span, "the span; profiles in the stretch run from one end of the span to the other"),
            optional(
                "from",
                Form::List(&Form::Name),
                "the transitions from which `over` is measured, mirrored at each; needed if there are several transitions",
            ),
            default("approach_slab", APPROACH_SLAB, "none", "a plate in the layers, beside a structure"),
        ],
        alternatives: &[],
        planned: &[],
    },
    materials::APPROACH_SLAB,
    Kind {
        name: "track",
        doc: "The track: sections one after the other, each with its trackform. x = 0 is the first transition.",
        role: Role::Scene { once: true },
        fields: &[
            required(
                "sections",
                Form::Pairs {
                    key: &Form::Object("trackform"),
                    value: &Form::OneOf(&[number("m", 0.3, 100_000.0), number("sleepers", 1.0, 200_000.0)]),
                    implied: None,
                },
                "trackforms from left to right, each with its length",
            ),
            optional(
                "transitions",
                Form::Pairs {
                    key: &Form::Name,
                    value: &Form::Words(&[
                        side("soft_to_stiff", "the softer side is at smaller x"),
                        side("stiff_to_soft", "the softer side is at greater x"),
                    ]),
                    implied: None,
                },
                "name and soft side of each boundary between two sections; by default a single boundary is `soft_to_stiff`",
            ),
            default(
                "rail_ends",
                Form::Words(&[
                    word("clamped", "held horizontal, at the level of the settled track at the end"),
                    word("pinned", "held at the same level, free to rotate"),
                    word("free", "not held"),
                    word("absorbing", "waves leave the model, as if the track continued"),
                ]),
                "clamped",
                "boundary condition of the rail at the ends of the model",
            ),
            optional(
                "bed_width",
                per("m", 0.5, 20.0, &TRACK_OR_RAIL),
                "width of the layers between the side walls; by default the length of the longest sleeper plus its shoulders",
            ),
            default(
                "bed_ends",
                Form::Words(&[
                    word("walls", "rigid walls across the track"),
                    word("periodic", "the bed repeats periodically"),
                ]),
                "walls",
                "boundary of the layers at the ends of the model",
            ),
            default(
                "base",
                Form::Words(&[
                    word("rigid", "the base does not move"),
                    word("quiet", "waves leave the model downwards"),
                ]),
                "rigid",
                "boundary below the lowest layer",
            ),
            default(
                "irregularity",
                along(number("mm", -50.0, 50.0)),
                "0 mm",
                "level of the rail as built, positive downwards; a file is read as a smooth curve",
            ),
            default(
                "stretches",
                Form::List(&Form::Object("stretch")),
                "[]",
                "changes along the track; two stretches that overlap must set different fields",
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
    laws::LAW,
    Kind {
        name: "tamping",
        doc: "Tamping: at given axle counts sleepers are lifted back to level and packed. Their settlement law starts again from the beginning.",
        role: Role::Scene { once: false },
        fields: &[
            required(
                "after",
                Form::List(&AXLES_OR_MASS),
                "axle counts or traffic [MGT] at which the track is tamped; between the first and the last train",
            ),
            optional("over", Form::Span, "sleepers that are tamped; by default all sleepers on ballast"),
            optional(
                "from",
                Form::List(&Form::Name),
                "the transitions from which `over` is measured, mirrored at each; needed if there are several transitions",
            ),
            default(
                "left",
                number("%", 0.0, 100.0),
                "0 %",
                "share of the settlement that remains; the voids remain in proportion",
            ),
        ],
        alternatives: &[],
        planned: &[],
    },
    solve::SOLVE,
    results::RECORD,
    results::EXPECT,
    results::STUDY,
];

/// Fields that every kind has.
pub const COMMON: &[Field] = &[
    optional("source", Form::Text, "source of the data"),
    optional(
        "evidence",
        Form::Words(&[
            word("read", "taken from the source"),
            word("derived", "computed from other data"),
            word("unchecked", "common knowledge; check it before use"),
        ]),
        "how the data was obtained",
    ),
];
