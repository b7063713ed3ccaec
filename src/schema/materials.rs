//! Kinds of what lies under the sleepers: gradings, granular materials, soils.

use super::fields::{NONE, along, default, either, measure, number, optional, per, required, way, word};
use super::{Basis, Form, Kind, Role, Word};

/// A contact is two particles in series.
const CONTACT_OR_PARTICLE: Basis = Basis { names: &[("contact", 1.0), ("particle", 0.5)], assumed: None };

pub(super) const GRADING: Kind = Kind {
    name: "grading",
    doc: "How the sizes of grains share the mass: the curve of a sieve test, and the part of it that is modelled.",
    role: Role::Part,
    fields: &[
        required(
            "passing",
            Form::OneOf(&[
                Form::Pairs { key: &number("mm", 1e-3, 1000.0), value: &number("%", 0.0, 100.0), implied: None },
                Form::Words(&[
                    Word {
                        name: "log_normal",
                        doc: "the logarithm of the size is normally distributed by mass; it needs both cuts",
                        arguments: &[
                            required("median", number("mm", 1e-3, 1000.0), "half of the mass is finer"),
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
                        doc: "a table below the main file's folder with the columns `size_mm` and `passing_%`",
                        arguments: &[required("name", Form::Text, "such as \"sieves.csv\"")],
                        planned: false,
                    },
                ]),
            ]),
            "share of the mass that passes a sieve, by its size; straight over the logarithm of the size between sieves",
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
    doc: "Ballast or sub-ballast: grains with their sizes, shapes, contacts and the recipe by which they are packed.",
    role: Role::Part,
    fields: &[
        required("grading", Form::Object("grading"), "of the grains"),
        default(
            "scale",
            number("", 1.0, 4.0),
            "1",
            "size of modelled over real grains: fewer and larger ones, whose contacts are as much stiffer that the layer stays as stiff",
        ),
        required("density", number("kg/m^3", 1500.0, 3500.0), "of a grain, without pores between grains"),
        default(
            "shape",
            Form::Words(&[word("spheres", "one sphere a grain"), CLUMPS]),
            "spheres",
            "of the grains; a grain of any shape has the volume of the sphere of its size",
        ),
        default(
            "contact",
            Form::Words(&[
                word("linear", "a spring of `contact_stiffness`"),
                Word {
                    name: "hertz",
                    doc: "elastic bodies that touch: the stiffness grows with the force",
                    arguments: &[
                        required("youngs_modulus", number("GPa", 0.1, 200.0), "of the rock"),
                        required("poisson_ratio", number("", 0.0, 0.49), "of the rock"),
                    ],
                    planned: false,
                },
            ]),
            "linear",
            "law of two grains that touch",
        ),
        optional(
            "contact_stiffness",
            per("MN/m", 0.1, 1000.0, &CONTACT_OR_PARTICLE),
            "normal; needed for `contact = linear`",
        ),
        default("shear_ratio", number("", 0.0, 1.5), "1", "tangential stiffness / normal stiffness"),
        required("friction", number("", 0.0, 1.5), "between grains, under traffic"),
        optional("wall_friction", number("", 0.0, 1.5), "to walls and sleepers; that between grains where absent"),
        optional(
            "youngs_modulus",
            along(number("MPa", 1.0, 50_000.0)),
            "of the layer as a continuum, from which supports are computed; grains do not read it",
        ),
        default("poisson_ratio", number("", 0.0, 0.49), "0.3", "of the layer as a continuum"),
        default("spread", SPREAD, "35 deg", "angle against the vertical at which the layer spreads a load"),
        default(
            "local_damping",
            number("", 0.0, 0.9),
            "0.2",
            "share of the force out of balance that opposes motion, under traffic",
        ),
        default(
            "viscous_damping",
            number("", 0.0, 1.0),
            "0.3",
            "normal dashpot of a contact as share of its critical damping, under traffic",
        ),
        default(
            "shear_damping",
            number("", 0.0, 1.0),
            "0",
            "shear dashpot of a contact as share of its critical damping, under traffic; 0.3 cuts the step to 0.4 of its length",
        ),
        default(
            "dashpots",
            Form::Words(&[
                word("no_tension", "spring and dashpot together never pull"),
                word("full", "a dashpot may pull grains that part"),
            ]),
            "no_tension",
            "of contacts",
        ),
        default("packing", Form::Object("packing"), "{}", "recipe by which the periodic cell is packed"),
        default(
            "bond",
            Form::OneOf(&[Form::Object("bond"), Form::Words(NONE)]),
            "none",
            "glue between grains that touch once sleepers stand on them",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

/// Surfaces of grains: files, and those of the library, which `examples/grain_shapes.rs` makes.
const SURFACES: &[Word] = &[
    Word {
        name: "file",
        doc: "a closed surface (STL, in any unit) below the main file's folder, such as a scanned stone",
        arguments: &[required("name", Form::Text, "such as \"stone.stl\"")],
        planned: false,
    },
    word("blocky", "of the library, generated: flatness 0.85, elongation 0.85, roundness 0.1"),
    word("flat", "of the library, generated: flatness 0.5, elongation 0.85, roundness 0.1"),
    word("elongated", "of the library, generated: flatness 0.85, elongation 0.5, roundness 0.1"),
    word("bladed", "of the library, generated: flatness 0.55, elongation 0.55, roundness 0.1"),
    word("worn", "of the library, generated: flatness 0.75, elongation 0.75, roundness 0.5"),
];

const CLUMPS: Word = Word {
    name: "clumps",
    doc: "overlapping spheres that move as one",
    arguments: &[
        default(
            "pebbles",
            Form::OneOf(&[Form::Integer { min: 1, max: 50 }, Form::Interval(measure("", 1.0, 50.0))]),
            "2 .. 3",
            "spheres a clump",
        ),
        default(
            "ratio",
            number("", 0.05, 1.0),
            "0.8",
            "smallest sphere / largest sphere of a clump, as in bubble-pack",
        ),
        default("distance", number("deg", 0.0, 180.0), "110 deg", "how smooth the surface is, as in bubble-pack"),
        default(
            "templates",
            Form::Integer { min: 1, max: 1000 },
            "5",
            "shapes that grains are copies of: angular ones, made by chance from the scene's seed",
        ),
        default(
            "flatness",
            number("", 0.3, 1.0),
            "0.7",
            "shortest / intermediate side of the smallest box round an angular shape; of crushed ballast mostly 0.6 .. 0.8 (common knowledge, unchecked)",
        ),
        default(
            "elongation",
            number("", 0.3, 1.0),
            "0.7",
            "intermediate / longest side of that box; of crushed ballast mostly 0.6 .. 0.8 (common knowledge, unchecked)",
        ),
        default(
            "roundness",
            number("", 0.0, 0.6),
            "0.15",
            "radius of edges and corners / radius of the largest ball inside (Wadell 1932); fresh ballast 0.1 .. 0.2, worn ballast more (common knowledge, unchecked)",
        ),
        optional(
            "from",
            Form::List(&Form::Words(SURFACES)),
            "surfaces to fill with spheres in place of angular ones: one template each",
        ),
    ],
    planned: false,
};

pub(super) const PACKING: Kind = Kind {
    name: "packing",
    doc: "How a granular layer is made: lift by lift, each pressed down, with properties of its own meanwhile.",
    role: Role::Nested,
    fields: &[
        default("lifts", Form::Integer { min: 1, max: 20 }, "3", "layers that are pressed one after the other"),
        default("pressure", number("kPa", 1.0, 2000.0), "200 kPa", "on each lift"),
        default("friction", number("", 0.0, 1.5), "0", "between grains, while they are packed"),
        default("local_damping", number("", 0.0, 0.9), "0.7", "while they are packed"),
        default("viscous_damping", number("", 0.0, 1.0), "0", "normal dashpot, while they are packed"),
        default(
            "restored",
            Form::Words(&[
                word("pressed", "under the whole pressure of the plate, which locks stresses in"),
                word("eased", "under the plate once it is eased to half of the bed's own weight"),
                word("unloaded", "after the plate has gone, on a bed at rest without friction"),
            ]),
            "eased",
            "when friction and damping come back after packing; a bed goes by its top layer",
        ),
        default(
            "reloads",
            Form::Integer { min: 0, max: 20 },
            "0",
            "times that the plate presses the finished bed again; a bed goes by its top layer",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const BOND: Kind = Kind {
    name: "bond",
    doc: "Glue between grains: a spring that also pulls, until it breaks.",
    role: Role::Nested,
    fields: &[
        required(
            "stiffness",
            per("MN/m", 0.1, 1000.0, &CONTACT_OR_PARTICLE),
            "of a bond beside the contact, normal; along it times `shear_ratio`",
        ),
        required("tensile_strength", number("kN", 1e-3, 1000.0), "force at which it breaks when pulled"),
        required("shear_strength", number("kN", 1e-3, 1000.0), "force at which it breaks when sheared"),
    ],
    alternatives: &[],
    planned: &[],
};

pub(super) const SOIL: Kind = Kind {
    name: "soil",
    doc: "A continuous layer: soil, treated soil, concrete or a ballast mat.",
    role: Role::Part,
    fields: &[
        way("youngs_modulus", along(number("MPa", 1.0, 50_000.0)), ""),
        way("poisson_ratio", number("", 0.0, 0.49), ""),
        way("bulk_modulus", number("MPa", 0.3, 1e6), ""),
        way("shear_modulus", number("MPa", 0.3, 25_000.0), ""),
        required("density", number("kg/m^3", 100.0, 3500.0), "with its pores and water"),
        default("spread", SPREAD, "35 deg", "angle against the vertical at which the layer spreads a load"),
        default(
            "strength",
            Form::Words(&[
                word("elastic", "it does not yield"),
                Word {
                    name: "mohr_coulomb",
                    doc: "it yields where shear exceeds cohesion + tan(friction_angle) x pressure",
                    arguments: &[
                        required("cohesion", number("kPa", 0.0, 10_000.0), ""),
                        required("friction_angle", number("deg", 0.0, 60.0), ""),
                        default("dilation", number("deg", 0.0, 60.0), "0 deg", "not above the friction angle"),
                        default("tension", number("kPa", 0.0, 10_000.0), "0 kPa", "tensile strength"),
                    ],
                    planned: false,
                },
            ]),
            "elastic",
            "",
        ),
    ],
    alternatives: &[either(&[&["youngs_modulus", "poisson_ratio"], &["bulk_modulus", "shear_modulus"]])],
    planned: &[],
};

pub(super) const APPROACH_SLAB: Kind = Kind {
    name: "approach_slab",
    doc: "A plate in the layers before a structure. It spreads the load; hinged to the structure, it keeps its end from sinking.",
    role: Role::Nested,
    fields: &[
        required("thickness", number("m", 0.1, 1.0), ""),
        required("youngs_modulus", number("GPa", 5.0, 60.0), "of the plate, such as concrete"),
        required("density", number("kg/m^3", 1000.0, 3500.0), "of the plate"),
        required("depth", number("m", 0.1, 5.0), "of its top below the sleepers"),
        default(
            "hinged",
            Form::Words(&[
                word("yes", "its end at the boundary rests on the structure"),
                word("no", "it lies on the ground"),
            ]),
            "yes",
            "at the boundary from which `over` counts",
        ),
    ],
    alternatives: &[],
    planned: &[],
};
