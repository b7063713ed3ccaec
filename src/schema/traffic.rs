//! Kinds of what loads the track: vehicles, trains, traffic, test loads.

use super::fields::{
    AXLES_OR_MASS, along, default, either, measure, number, one_of, optional, per, required, unread, way, word,
};
use super::{Basis, Form, Kind, Measure, Role, Word};

const FORCE: Basis = Basis { names: &[("rail", 1.0), ("track", 0.5), ("seat", 1.0), ("sleeper", 0.5)], assumed: None };
const VEHICLE_OR_RAIL: Basis = Basis { names: &[("vehicle", 0.5), ("rail", 1.0)], assumed: Some("vehicle") };
const BOGIE_OR_RAIL: Basis = Basis { names: &[("bogie", 0.5), ("rail", 1.0)], assumed: None };
const WHEELSET_OR_WHEEL: Basis = Basis { names: &[("wheelset", 0.5), ("wheel", 1.0)], assumed: None };
const PRIMARY: Basis =
    Basis { names: &[("wheel", 1.0), ("wheelset", 0.5), ("bogie", 0.25), ("rail", 1.0)], assumed: None };

const CYCLIC: Word = Word {
    name: "cyclic",
    doc: "goes from the smaller to the greater force and back",
    arguments: &[
        required(
            "range",
            Form::Interval(Measure { basis: Some(&FORCE), ..measure("kN", 0.0, 10_000.0) }),
            "smallest and greatest force",
        ),
        required("frequency", number("Hz", 1e-3, 1000.0), ""),
        default("wave", Form::Words(&[word("sine", "")]), "sine", ""),
    ],
    planned: false,
};

const FORCE_FILE: Word = Word {
    name: "file",
    doc: "a table below the main file's folder with the columns `time_s` and `force_kN`, in ascending times",
    arguments: &[
        required("name", Form::Text, "such as \"force.csv\""),
        optional("column", Form::Name, "of the forces, where there are several"),
        optional("per", Form::Name, "what the forces are of, given behind the word: `file(\"force.csv\") per seat`"),
    ],
    planned: false,
};

pub(super) const VEHICLE: Kind = Kind {
    name: "vehicle",
    doc: "A vehicle on two bogies of two axles each: a multibody system of 10 degrees of freedom and four wheel-rail contacts.",
    role: Role::Part,
    fields: &[
        way(
            "axle_load",
            Form::OneOf(&[number("t", 1.0, 40.0), number("kN", 9.81, 392.4)]),
            "of each axle; the car body's mass follows and scales an inherited `pitch_inertia`",
        ),
        required("car_body", Form::Object("car_body"), ""),
        required("bogie", Form::Object("bogie"), "each of the two"),
        required("wheelset", Form::Object("wheelset"), "each of the four"),
        required("primary", Form::Object("primary_suspension"), "between wheelset and bogie"),
        required("secondary", Form::Object("secondary_suspension"), "between bogie and car body"),
        default(
            "contact",
            Form::Words(&[Word {
                name: "hertz",
                doc: "force = constant x indentation^1.5, no tension",
                arguments: &[default(
                    "constant",
                    number("GN/m^1.5", 50.0, 200.0),
                    "100 GN/m^1.5",
                    "the default is that of railFE; Zhai's formulas give 86 (cone) and 115 (worn tread) for wheels of 0.46 m",
                )],
                planned: false,
            }]),
            "hertz(100 GN/m^1.5)",
            "wheel on rail",
        ),
        optional("length", number("m", 5.0, 40.0), "over couplers; needed in trains of several vehicles"),
    ],
    alternatives: &[either(&[&["axle_load"], &["car_body.mass"]])],
    planned: &[],
};

pub(super) const CAR_BODY: Kind = Kind {
    name: "car_body",
    doc: "The car body of a vehicle.",
    role: Role::Nested,
    fields: &[
        way("mass", per("t", 1.0, 200.0, &VEHICLE_OR_RAIL), ""),
        way("pitch_inertia", per("kg m^2", 1e4, 1e8, &VEHICLE_OR_RAIL), "about the transverse axis"),
        way("radius_of_gyration", number("m", 1.0, 12.0), "pitch inertia = mass x radius^2"),
    ],
    alternatives: &[either(&[&["pitch_inertia"], &["radius_of_gyration"]])],
    planned: &[],
};

pub(super) const BOGIE: Kind = Kind {
    name: "bogie",
    doc: "One bogie frame.",
    role: Role::Nested,
    fields: &[
        required("mass", per("kg", 100.0, 20_000.0, &BOGIE_OR_RAIL), ""),
        required("pitch_inertia", per("kg m^2", 50.0, 50_000.0, &BOGIE_OR_RAIL), "about the transverse axis"),
        required("spacing", number("m", 2.0, 25.0), "of the bogie centres"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const WHEELSET: Kind = Kind {
    name: "wheelset",
    doc: "One wheelset.",
    role: Role::Nested,
    fields: &[
        required("mass", per("kg", 300.0, 5000.0, &WHEELSET_OR_WHEEL), ""),
        unread(optional("rolling_inertia", per("kg m^2", 1.0, 1000.0, &WHEELSET_OR_WHEEL), "about the axle")),
        required("spacing", number("m", 1.0, 4.0), "of the axles of a bogie"),
        default("radius", number("m", 0.2, 0.7), "0.46 m", ""),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const PRIMARY_SUSPENSION: Kind = Kind {
    name: "primary_suspension",
    doc: "Springs and dampers between wheelset and bogie.",
    role: Role::Nested,
    fields: &[
        required("stiffness", per("MN/m", 0.1, 100.0, &PRIMARY), ""),
        required("damping", per("kN s/m", 0.0, 1000.0, &PRIMARY), ""),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const SECONDARY_SUSPENSION: Kind = Kind {
    name: "secondary_suspension",
    doc: "Springs and dampers between bogie and car body.",
    role: Role::Nested,
    fields: &[
        required("stiffness", per("MN/m", 0.1, 100.0, &BOGIE_OR_RAIL), ""),
        required("damping", per("kN s/m", 0.0, 1000.0, &BOGIE_OR_RAIL), ""),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const TRAIN: Kind = Kind {
    name: "train",
    doc: "Vehicles that run together.",
    role: Role::Part,
    fields: &[
        required(
            "vehicles",
            Form::Pairs {
                key: &Form::Object("vehicle"),
                value: &Form::Integer { min: 1, max: 100 },
                implied: Some("1"),
            },
            "in order, the leading one first",
        ),
        required("speed", along(number("km/h", 1.0, 600.0)), "by the place of the leading wheel where it varies"),
        default(
            "direction",
            Form::Words(&[
                word("forward", "as x grows"),
                word("backward", "the other way"),
                word("both", "every second train the other way"),
            ]),
            "forward",
            "",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const TRAFFIC: Kind = Kind {
    name: "traffic",
    doc: "The trains of the whole run.",
    role: Role::Scene { once: true },
    fields: &[
        required(
            "trains",
            Form::Pairs { key: &Form::Object("train"), value: &number("%", 0.0, 100.0), implied: Some("100 %") },
            "with their shares of `total`, in its unit",
        ),
        required("total", AXLES_OR_MASS, "axles, or the mass that they carry"),
        default(
            "order",
            Form::Words(&[
                word("interleaved", "every kind of train all along the run"),
                word("in_turn", "all trains of the first kind, then all of the second"),
            ]),
            "interleaved",
            "in which trains of several kinds run",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const LOAD: Kind = Kind {
    name: "load",
    doc: "A test load on a track at rest.",
    role: Role::Scene { once: false },
    fields: &[
        required(
            "on",
            Form::Words(&[
                word("rail", ""),
                word("sleepers", ""),
                word("bed", "on a plate that covers the whole bed of grains, in the place of sleepers"),
            ]),
            "what it stands on",
        ),
        required("at", Form::List(&Form::Place), "one force at each place"),
        optional(
            "from",
            Form::List(&Form::Name),
            "the transitions from which `at` counts, mirrored at each; needed where there are several",
        ),
        way(
            "force",
            Form::OneOf(&[per("kN", 0.0, 10_000.0, &FORCE), Form::Words(&[CYCLIC, FORCE_FILE])]),
            "constant, cyclic or of a file, positive down",
        ),
        way(
            "strain",
            number("%", 0.1, 30.0),
            "of the bed under a plate that is driven down, slowly enough for its grains, instead of a force",
        ),
        optional(
            "confinement",
            number("kPa", 1.0, 2000.0),
            "pressure on all sides of the bed under a plate, which then give way: a triaxial test; the force is the deviator, on top of it",
        ),
        default("total", number("cycles", 1.0, 1e9), "1 cycle", "times that a force that changes comes back"),
        default("speed", number("m/s", 0.0, 200.0), "0 m/s", "with which it moves along the rail"),
    ],
    alternatives: &[one_of(&[&["force"], &["strain"]])],
    planned: &[],
};
