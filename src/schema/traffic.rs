//! Kinds of loads on the track: vehicles, trains, traffic, test loads.

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
    doc: "the force changes from the smaller to the greater value and back",
    arguments: &[
        required(
            "range",
            Form::Interval(Measure { basis: Some(&FORCE), ..measure("kN", 0.0, 10_000.0) }),
            "smallest and greatest force of a cycle",
        ),
        required("frequency", number("Hz", 1e-3, 1000.0), "number of cycles per second"),
        default("wave", Form::Words(&[word("sine", "")]), "sine", "shape of a cycle"),
    ],
    planned: false,
};

const FORCE_FILE: Word = Word {
    name: "file",
    doc: "a table in the folder of the main file or below it, with the columns `time_s` and `force_kN`, in ascending times",
    arguments: &[
        required("name", Form::Text, "name of the file, such as \"force.csv\""),
        optional("column", Form::Name, "column of the forces, if there are several"),
        optional("per", Form::Name, "basis of the forces, written after the word: `file(\"force.csv\") per seat`"),
    ],
    planned: false,
};

pub(super) const VEHICLE: Kind = Kind {
    name: "vehicle",
    doc: "A vehicle with two bogies of two axles each: a multibody system with 10 degrees of freedom and four wheel-rail contacts.",
    role: Role::Part,
    fields: &[
        way(
            "axle_load",
            Form::OneOf(&[number("t", 1.0, 40.0), number("kN", 9.81, 392.4)]),
            "load of each axle; it determines the mass of the car body and scales an inherited `pitch_inertia`",
        ),
        required("car_body", Form::Object("car_body"), "the car body"),
        required("bogie", Form::Object("bogie"), "each of the two bogies"),
        required("wheelset", Form::Object("wheelset"), "each of the four wheelsets"),
        required("primary", Form::Object("primary_suspension"), "suspension between wheelset and bogie"),
        required("secondary", Form::Object("secondary_suspension"), "suspension between bogie and car body"),
        default(
            "contact",
            Form::Words(&[Word {
                name: "hertz",
                doc: "Hertz contact: force = constant x indentation^1.5, without tension",
                arguments: &[default(
                    "constant",
                    number("GN/m^1.5", 50.0, 200.0),
                    "100 GN/m^1.5",
                    "contact constant; the default is the value of railFE; Zhai's formulas give 86 (cone) and 115 (worn tread) for wheels of radius 0.46 m",
                )],
                planned: false,
            }]),
            "hertz(100 GN/m^1.5)",
            "contact between wheel and rail",
        ),
        optional("length", number("m", 5.0, 40.0), "length over couplers; needed in trains with several vehicles"),
    ],
    alternatives: &[either(&[&["axle_load"], &["car_body.mass"]])],
    planned: &[],
};

pub(super) const CAR_BODY: Kind = Kind {
    name: "car_body",
    doc: "The car body of a vehicle.",
    role: Role::Nested,
    fields: &[
        way("mass", per("t", 1.0, 200.0, &VEHICLE_OR_RAIL), "mass of the car body"),
        way("pitch_inertia", per("kg m^2", 1e4, 1e8, &VEHICLE_OR_RAIL), "pitch inertia about the transverse axis"),
        way("radius_of_gyration", number("m", 1.0, 12.0), "radius of gyration: pitch inertia = mass x radius^2"),
    ],
    alternatives: &[either(&[&["pitch_inertia"], &["radius_of_gyration"]])],
    planned: &[],
};

pub(super) const BOGIE: Kind = Kind {
    name: "bogie",
    doc: "One bogie frame.",
    role: Role::Nested,
    fields: &[
        required("mass", per("kg", 100.0, 20_000.0, &BOGIE_OR_RAIL), "mass of one bogie frame"),
        required(
            "pitch_inertia",
            per("kg m^2", 50.0, 50_000.0, &BOGIE_OR_RAIL),
            "pitch inertia about the transverse axis",
        ),
        required("spacing", number("m", 2.0, 25.0), "distance between the bogie centres"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const WHEELSET: Kind = Kind {
    name: "wheelset",
    doc: "One wheelset.",
    role: Role::Nested,
    fields: &[
        required("mass", per("kg", 300.0, 5000.0, &WHEELSET_OR_WHEEL), "mass of one wheelset"),
        unread(optional(
            "rolling_inertia",
            per("kg m^2", 1.0, 1000.0, &WHEELSET_OR_WHEEL),
            "moment of inertia about the axle",
        )),
        required("spacing", number("m", 1.0, 4.0), "distance between the axles of a bogie"),
        default("radius", number("m", 0.2, 0.7), "0.46 m", "radius of the wheels"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const PRIMARY_SUSPENSION: Kind = Kind {
    name: "primary_suspension",
    doc: "Springs and dampers between wheelset and bogie.",
    role: Role::Nested,
    fields: &[
        required("stiffness", per("MN/m", 0.1, 100.0, &PRIMARY), "vertical stiffness"),
        required("damping", per("kN s/m", 0.0, 1000.0, &PRIMARY), "vertical damping"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const SECONDARY_SUSPENSION: Kind = Kind {
    name: "secondary_suspension",
    doc: "Springs and dampers between bogie and car body.",
    role: Role::Nested,
    fields: &[
        required("stiffness", per("MN/m", 0.1, 100.0, &BOGIE_OR_RAIL), "vertical stiffness"),
        required("damping", per("kN s/m", 0.0, 1000.0, &BOGIE_OR_RAIL), "vertical damping"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const TRAIN: Kind = Kind {
    name: "train",
    doc: "A train: vehicles that run coupled.",
    role: Role::Part,
    fields: &[
        required(
            "vehicles",
            Form::Pairs {
                key: &Form::Object("vehicle"),
                value: &Form::Integer { min: 1, max: 100 },
                implied: Some("1"),
            },
            "vehicles in order, the leading vehicle first",
        ),
        required(
            "speed",
            along(number("km/h", 1.0, 600.0)),
            "speed of the train; a speed that varies is a function of the place of the leading wheel",
        ),
        default(
            "direction",
            Form::Words(&[
                word("forward", "in the direction of growing x"),
                word("backward", "in the direction of falling x"),
                word("both", "the direction alternates from train to train"),
            ]),
            "forward",
            "direction in which the train runs",
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
            "trains, each with its share of `total`, in the unit of `total`",
        ),
        required("total", AXLES_OR_MASS, "total traffic: number of axles, or mass in MGT"),
        default(
            "order",
            Form::Words(&[
                word("interleaved", "all kinds of train are mixed over the whole run"),
                word("in_turn", "all trains of the first kind run first, then all trains of the second kind"),
            ]),
            "interleaved",
            "order in which trains of several kinds run",
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
                word("rail", "on the rail"),
                word("sleepers", "on sleepers"),
                word("bed", "on a plate that covers the whole bed of grains, instead of sleepers"),
            ]),
            "the part on which the load acts",
        ),
        required("at", Form::List(&Form::Place), "places of the load; one force acts at each place"),
        optional(
            "from",
            Form::List(&Form::Name),
            "the transitions from which `at` is measured, mirrored at each; needed if there are several transitions",
        ),
        way(
            "force",
            Form::OneOf(&[per("kN", 0.0, 10_000.0, &FORCE), Form::Words(&[CYCLIC, FORCE_FILE])]),
            "force, constant, cyclic or from a file, positive downwards",
        ),
        way(
            "strain",
            number("%", 0.1, 30.0),
            "strain of the bed under a plate that moves down slowly (quasi-statically), instead of a force",
        ),
        optional(
            "confinement",
            number("kPa", 1.0, 2000.0),
            "pressure on the four sides of the bed under a plate, which can then move: a triaxial test; the force is the deviator, added to the pressure",
        ),
        default("total", number("cycles", 1.0, 1e9), "1 cycle", "number of cycles of a cyclic force"),
        default("speed", number("m/s", 0.0, 200.0), "0 m/s", "speed of the load along the rail"),
    ],
    alternatives: &[one_of(&[&["force"], &["strain"]])],
    planned: &[],
};
