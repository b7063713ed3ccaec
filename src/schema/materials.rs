//! Kinds of materials under the sleepers: gradings, granular materials, soils.

use super::fields::{NONE, along, default, either, measure, number, optional, per, required, way, word};
use super::{Basis, Form, Kind, Role, Word};

/// A contact between two particles has the stiffness of two springs in series.
const CONTACT_OR_PARTICLE: Basis = Basis { names: &[("contact", 1.0), ("particle", 0.5)], assumed: None };

pub(super) const GRADING: Kind = Kind {
    name: "grading",
    doc: "A grading: the sieve curve of the grains, and the range of sizes that is modelled.",
    role: Role::Part,
    fields: &[
        required(
            "passing",
            Form::OneOf(&[
                Form::Pairs { key: &number("mm", 1e-3, 1000.0), value: &number("%", 0.0, 100.0), implied: None },
                Form::Words(&[
                    Word {
                        name: "log_normal",
                        doc: "the logarithm of the size is normally distributed by mass; needs `cut_below` and `cut_above`",
                        arguments: &[
                            required("median", number("mm", 1e-3, 1000.0), "size at which half of the mass is finer"),
                            required(
                                "spread",
                                number("", 0.01, 3.0),
                                "standard deviation of the natural logarithm of the size",
                            ),
                        ],
                        planned: false,
                    },
                    Word {
                        name: "file",
                        doc: "a table in the folder of the main file or below it, with the columns `size_mm` and `passing_%`",
                        arguments: &[required("name", Form::Text, "name of the file, such as \"sieves.csv\"")],
                        planned: false,
                    },
                ]),
            ]),
            "share of the mass that passes each sieve size; between two sieves the share is linear in the logarithm of the size",
        ),
        default("cut_below", CUT, "none", "smaller grains are not modelled"),
        default("cut_above", CUT, "none", "larger grains are not modelled"),
    ],
    alternatives: &[],
    planned: &[],
};

const SPREAD: Form = number("deg", 0.0, 60.0);
const CUT: Form = Form::OneOf(&[number("mm", 1e-3, 1000.0), Form::Words(NONE)]);

pub(super) const GRANULAR: Kind = Kind {
    name: "granular",
    doc: "Ballast or sub-ballast: grains with their sizes, shapes, contacts and packing recipe.",
    role: Role::Part,
    fields: &[
        required("grading", Form::Object("grading"), "grading of the grains"),
        default(
            "scale",
            number("", 1.0, 4.0),
            "1",
            "size of modelled grains / size of real grains; larger grains are fewer, and their contacts are stiffer by the same factor, so that the stiffness of the layer stays the same",
        ),
        required(
            "density",
            number("kg/m^3", 1500.0, 3500.0),
            "density of the solid grain, without pores between grains",
        ),
        default(
            "shape",
            Form::Words(&[word("spheres", "each grain is one sphere"), CLUMPS]),
            "spheres",
            "shape of the grains; every grain has the volume of a sphere with the diameter of its size",
        ),
        default(
            "contact",
            Form::Words(&[
                word("linear", "a linear spring of `contact_stiffness`"),
                Word {
                    name: "hertz",
                    doc: "Hertz contact of elastic bodies: the stiffness grows with the force",
                    arguments: &[
                        required("youngs_modulus", number("GPa", 0.1, 200.0), "Young's modulus of the rock"),
                        required("poisson_ratio", number("", 0.0, 0.49), "Poisson's ratio of the rock"),
                    ],
                    planned: false,
                },
            ]),
            "linear",
            "contact law between two grains",
        ),
        optional(
            "contact_stiffness",
            per("MN/m", 0.1, 1000.0, &CONTACT_OR_PARTICLE),
            "normal stiffness; needed for `contact = linear`",
        ),
        default("shear_ratio", number("", 0.0, 1.5), "1", "tangential stiffness / normal stiffness"),
        required("friction", number("", 0.0, 1.5), "friction coefficient between grains, under traffic"),
        optional(
            "wall_friction",
            number("", 0.0, 1.5),
            "friction coefficient on walls and sleepers; by default equal to `friction`",
        ),
        optional(
            "youngs_modulus",
            along(number("MPa", 1.0, 50_000.0)),
            "Young's modulus of the layer as a continuum, for the support of sleepers; not used by grains",
        ),
        default("poisson_ratio", number("", 0.0, 0.49), "0.3", "Poisson's ratio of the layer as a continuum"),
        default("spread", SPREAD, "35 deg", "angle from the vertical at which the layer spreads a load"),
        default(
            "local_damping",
            number("", 0.0, 0.9),
            "0.2",
            "local damping: share of the unbalanced force that opposes the motion, under traffic",
        ),
        default(
            "viscous_damping",
            number("", 0.0, 1.0),
            "0.3",
            "normal damping of a contact / critical damping, under traffic",
        ),
        default(
            "shear_damping",
            number("", 0.0, 1.0),
            "0",
            "shear damping of a contact / critical damping, under traffic; 0.3 reduces the time step to 0.4 of its length",
        ),
        default(
            "dashpots",
            Form::Words(&[
                word("no_tension", "the sum of spring and dashpot force is never tensile"),
                word("full", "a dashpot may pull on grains that separate"),
            ]),
            "no_tension",
            "dashpots of contacts",
        ),
        default("packing", Form::Object("packing"), "{}", "recipe for packing the periodic cell"),
        default(
            "bond",
            Form::OneOf(&[Form::Object("bond"), Form::Words(NONE)]),
            "none",
            "glue between the grains that are in contact when the sleepers have been placed",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

/// Surfaces of grains: files, and the surfaces of the library, which `examples/grain_shapes.rs` makes.
const SURFACES: &[Word] = &[
    Word {
        name: "file",
        doc: "a closed surface (STL, in any unit) in the folder of the main file or below it, such as a scanned stone",
        arguments: &[required("name", Form::Text, "name of the file, such as \"stone.stl\"")],
        planned: false,
    },
    word("blocky", "surface of the library, generated: flatness 0.85, elongation 0.85, roundness 0.1"),
    word("flat", "surface of the library, generated: flatness 0.5, elongation 0.85, roundness 0.1"),
    word("elongated", "surface of the library, generated: flatness 0.85, elongation 0.5, roundness 0.1"),
    word("bladed", "surface of the library, generated: flatness 0.55, elongation 0.55, roundness 0.1"),
    word("worn", "surface of the library, generated: flatness 0.75, elongation 0.75, roundness 0.5"),
];

const CLUMPS: Word = Word {
    name: "clumps",
    doc: "overlapping spheres that move as one rigid body",
    arguments: &[
        default(
            "pebbles",
            Form::OneOf(&[Form::Integer { min: 1, max: 50 }, Form::Interval(measure("", 1.0, 50.0))]),
            "2 .. 3",
            "number of spheres in a clump",
        ),
        default(
            "ratio",
            number("", 0.05, 1.0),
            "0.8",
            "smallest sphere / largest sphere of a clump, as in bubble-pack",
        ),
        default("distance", number("deg", 0.0, 180.0), "110 deg", "smoothness of the surface, as in bubble-pack"),
        default(
            "templates",
            Form::Integer { min: 1, max: 1000 },
            "5",
            "number of different shapes; each grain is a copy of one shape; the shapes are angular and drawn at random from `solve.seed`",
        ),
        default(
            "flatness",
            number("", 0.3, 1.0),
            "0.7",
            "shortest / intermediate side of the smallest box around an angular shape; crushed ballast has mostly 0.6 .. 0.8 (common knowledge, unchecked)",
        ),
        default(
            "elongation",
            number("", 0.3, 1.0),
            "0.7",
            "intermediate / longest side of the same box; crushed ballast has mostly 0.6 .. 0.8 (common knowledge, unchecked)",
        ),
        default(
            "roundness",
            number("", 0.0, 0.6),
            "0.15",
            "radius of edges and corners / radius of the largest inscribed sphere (Wadell 1932); fresh ballast has 0.1 .. 0.2, worn ballast more (common knowledge, unchecked)",
        ),
        optional(
            "from",
            Form::List(&Form::Words(SURFACES)),
            "surfaces that are filled with spheres instead of angular shapes: one clump shape for each surface",
        ),
    ],
    planned: false,
};

pub(super) const PACKING: Kind = Kind {
    name: "packing",
    doc: "Packing recipe of a granular layer: the layer is built in lifts, each pressed down, with its own friction and damping during packing.",
    role: Role::Nested,
    fields: &[
        default(
            "lifts",
            Form::Integer { min: 1, max: 20 },
            "3",
            "number of lifts that are pressed one after the other",
        ),
        default("pressure", number("kPa", 1.0, 2000.0), "200 kPa", "pressure of the plate on each lift"),
        default("friction", number("", 0.0, 1.5), "0", "friction coefficient between grains during packing"),
        default("local_damping", number("", 0.0, 0.9), "0.7", "local damping during packing"),
        default(
            "viscous_damping",
            number("", 0.0, 1.0),
            "0",
            "normal damping of a contact / critical damping, during packing",
        ),
        default(
            "restored",
            Form::Words(&[
                word("pressed", "under the full pressure of the plate; stresses stay locked in the bed"),
                word("eased", "under the plate after its force is reduced to half the weight of the bed"),
                word("unloaded", "after the plate is removed and the bed is at rest without friction"),
            ]),
            "eased",
            "when friction and damping return to the values for traffic; the value of the top layer holds for the whole bed",
        ),
        default(
            "reloads",
            Form::Integer { min: 0, max: 20 },
            "0",
            "number of times that the plate presses the finished bed again; the value of the top layer holds for the whole bed",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const BOND: Kind = Kind {
    name: "bond",
    doc: "Glue between grains: a spring that acts in compression and tension until it breaks.",
    role: Role::Nested,
    fields: &[
        required(
            "stiffness",
            per("MN/m", 0.1, 1000.0, &CONTACT_OR_PARTICLE),
            "normal stiffness of a bond, parallel to the contact; the shear stiffness is this value x `shear_ratio`",
        ),
        required("tensile_strength", number("kN", 1e-3, 1000.0), "tensile force at which the bond breaks"),
        required("shear_strength", number("kN", 1e-3, 1000.0), "shear force at which the bond breaks"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const SOIL: Kind = Kind {
    name: "soil",
    doc: "A continuous layer: soil, treated soil, concrete or a ballast mat.",
    role: Role::Part,
    fields: &[
        way("youngs_modulus", along(number("MPa", 1.0, 50_000.0)), "Young's modulus"),
        way("poisson_ratio", number("", 0.0, 0.49), "Poisson's ratio"),
        way("bulk_modulus", number("MPa", 0.3, 1e6), "bulk modulus"),
        way("shear_modulus", number("MPa", 0.3, 25_000.0), "shear modulus"),
        required("density", number("kg/m^3", 100.0, 3500.0), "density including pores and water"),
        default("spread", SPREAD, "35 deg", "angle from the vertical at which the layer spreads a load"),
        default(
            "strength",
            Form::Words(&[
                word("elastic", "the soil does not yield"),
                Word {
                    name: "mohr_coulomb",
                    doc: "the soil yields if the shear stress exceeds cohesion + tan(friction_angle) x normal pressure",
                    arguments: &[
                        required("cohesion", number("kPa", 0.0, 10_000.0), "cohesion of the soil"),
                        required("friction_angle", number("deg", 0.0, 60.0), "angle of internal friction"),
                        default(
                            "dilation",
                            number("deg", 0.0, 60.0),
                            "0 deg",
                            "angle of dilation; not above the friction angle",
                        ),
                        default("tension", number("kPa", 0.0, 10_000.0), "0 kPa", "tensile strength"),
                    ],
                    planned: false,
                },
            ]),
            "elastic",
            "whether the soil yields",
        ),
    ],
    alternatives: &[either(&[&["youngs_modulus", "poisson_ratio"], &["bulk_modulus", "shear_modulus"]])],
    planned: &[],
};

pub(super) const APPROACH_SLAB: Kind = Kind {
    name: "approach_slab",
    doc: "A plate in the layers beside a structure. It spreads the load. If it is hinged to the structure, the end at the structure does not settle.",
    role: Role::Nested,
    fields: &[
        required("thickness", number("m", 0.1, 1.0), "thickness of the plate"),
        required("youngs_modulus", number("GPa", 5.0, 60.0), "Young's modulus of the plate, usually concrete"),
        required("density", number("kg/m^3", 1000.0, 3500.0), "density of the plate"),
        required("depth", number("m", 0.1, 5.0), "depth of the top of the plate below the sleepers"),
        default(
            "hinged",
            Form::Words(&[
                word("yes", "the end at the boundary rests on the structure"),
                word("no", "the whole plate lies on the ground"),
            ]),
            "yes",
            "hinge to the structure, at the boundary from which `over` is measured",
        ),
    ],
    alternatives: &[],
    planned: &[],
};
