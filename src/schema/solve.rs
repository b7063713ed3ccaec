//! The settings of the computation: the kind `solve`.

use super::fields::{NONE, REPEATS, default, number, optional, required, word};
use super::{Form, Kind, Role, Word};

const AUTO: &[Word] = &[word("auto", "chosen by the planner")];

pub(super) const SOLVE: Kind = Kind {
    name: "solve",
    doc: "Settings of the computation.",
    role: Role::Scene { once: true },
    fields: &[
        default(
            "substructure",
            Form::Words(&[
                word("auto", "the cheapest tier that can run the scene"),
                word("law", "a settlement law under each sleeper"),
                word(
                    "cells",
                    "grains in one periodic cell for each distinct sleeper; the rail does not connect the cells; takes tens of minutes",
                ),
                word("zone", "grains within 10 m of a transition, springs beyond; takes hours"),
                word("full", "grains in the whole `window`, springs beyond; takes a day or more"),
            ]),
            "auto",
            "tier: the type of model under the sleepers",
        ),
        default(
            "law",
            Form::OneOf(&[Form::Object("law"), Form::List(&Form::Object("law"))]),
            "laws.varandas_2014",
            "settlement law of the supports; if several are given, the run uses the first and the report shows the spread of all",
        ),
        default(
            "support_method",
            Form::Words(&[
                word(
                    "stress_cone",
                    "the load spreads at an angle; neighbouring sleepers share the ground below the depth at which their cones meet",
                ),
                Word {
                    name: "layered_elastic",
                    doc: "linear elasticity of bonded layers under a uniform pressure",
                    arguments: &[default(
                        "neighbours",
                        number("", 0.0, 1.0),
                        "0.73",
                        "load on each neighbouring sleeper / load on this sleeper",
                    )],
                    planned: false,
                },
            ]),
            "stress_cone",
            "method that computes the support of a sleeper from the layers",
        ),
        default(
            "update_every",
            Form::OneOf(&[
                number("axles", 1.0, 1e9),
                Form::Words(&[
                    Word {
                        name: "geometric",
                        doc: "blocks that grow with the number of axles so far",
                        arguments: &[
                            required("first", number("axles", 1.0, 1e9), "length of the smallest block"),
                            required("ratio", number("", 0.001, 10.0), "length of a block / axles so far"),
                        ],
                        planned: false,
                    },
                    Word {
                        name: "adaptive",
                        doc: "blocks as long as the estimated error allows",
                        arguments: &[
                            default(
                                "tolerance",
                                number("mm", 1e-6, 10.0),
                                "0.003 mm",
                                "largest error of settlement that a block may add at any seat",
                            ),
                            optional("cap", number("mm", 1e-4, 100.0), "largest settlement of any seat in a block"),
                        ],
                        planned: false,
                    },
                ]),
            ]),
            "adaptive(0.003 mm)",
            "number of axles in a block, after which forces and settlements are exchanged",
        ),
        default(
            "passages",
            Form::Words(&[
                word("isolated", "trains run one by one, and the track comes to rest between two trains"),
                word("continuous", "the trains of a block run coupler to coupler; every vehicle needs a `length`"),
            ]),
            "isolated",
            "how trains follow each other over grains",
        ),
        default(
            "beam",
            Form::Words(&[
                word("euler", "Euler-Bernoulli beam: bending only"),
                word("timoshenko", "Timoshenko beam: bending and shear; the rail needs `shear_stiffness`"),
            ]),
            "euler",
            "beam theory of the rail",
        ),
        default(
            "elements_per_bay",
            Form::Integer { min: 1, max: 32 },
            "4",
            "number of beam elements between two seats",
        ),
        default(
            "integrator",
            Form::Words(&[
                Word {
                    name: "generalised_alpha",
                    doc: "Chung and Hulbert (1993)",
                    arguments: &[default("rho", number("", 0.0, 1.0), "0.85", "spectral radius at infinite frequency")],
                    planned: false,
                },
                Word {
                    name: "hht",
                    doc: "Hilber, Hughes and Taylor (1977)",
                    arguments: &[default(
                        "alpha",
                        number("", 0.0, 1.0 / 3.0),
                        "0.1",
                        "parameter of the damping of high frequencies",
                    )],
                    planned: false,
                },
                word("newmark", "average acceleration, without numerical damping"),
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
                        doc: "steps as long as the tolerance allows",
                        arguments: &[default(
                            "tolerance",
                            number("", 1e-8, 0.001),
                            "1e-5",
                            "error of a step / largest deflection of the rail",
                        )],
                        planned: false,
                    },
                ]),
            ]),
            "auto",
            "time step of track and vehicle",
        ),
        default(
            "start",
            Form::OneOf(&[Form::Place, Form::Words(AUTO)]),
            "auto",
            "place of the leading wheel at the start",
        ),
        default(
            "finish",
            Form::OneOf(&[Form::Place, Form::Words(AUTO)]),
            "auto",
            "place of the leading wheel at the end",
        ),
        default("gravity", number("m/s^2", 0.0, 20.0), "9.81 m/s^2", "gravitational acceleration"),
        default("seed", Form::Integer { min: 0, max: 1_000_000_000 }, "1", "seed of all random numbers"),
        default(
            "window",
            Form::OneOf(&[Form::Span, Form::Words(AUTO)]),
            "auto",
            "span of the track with grains, at every transition; it does not change the length of track and vehicle model",
        ),
        default(
            "coupling",
            Form::Words(&[
                word(
                    "iterated",
                    "track and grains are computed in turn: forces go to the grains, settlement and stiffness go back to the track",
                ),
                word("monolithic", "vehicles, rail and grains are computed together in one time step"),
            ]),
            "iterated",
            "coupling of track and grains",
        ),
        default(
            "support_from",
            Form::Words(&[
                word("static_load", "all sleepers are loaded at once, on a copy of the grains"),
                word("passage", "forces of the last passage"),
            ]),
            "static_load",
            "load from which the support stiffness of the grains is computed",
        ),
        default(
            "sleeper_pitch",
            Form::Words(&[
                word("held", "sleepers on grains do not rotate"),
                word("free", "sleepers rotate about their axis across the track; only their rail pads hold them"),
            ]),
            "held",
            "rotation of sleepers on grains",
        ),
        default(
            "cell_bays",
            Form::Integer { min: 1, max: 3 },
            "2",
            "number of bays in a periodic cell of grains; each sleeper in it has the forces of its own seat. With one bay neighbours are loaded at the same time, and the bed settles by a quarter less",
        ),
        default(
            "check_cells",
            Form::Integer { min: 0, max: 20 },
            "0",
            "by a law: number of sleepers of each kind whose settlement is compared with a cell of grains under the same forces while the law runs; 0 for no comparison",
        ),
        default(
            "grain_step",
            Form::OneOf(&[number("s", 1e-9, 1e-2), Form::Words(AUTO)]),
            "auto",
            "time step of the grains",
        ),
        default(
            "soil_element",
            Form::OneOf(&[number("m", 0.005, 5.0), Form::Words(AUTO)]),
            "auto",
            "size of the soil elements",
        ),
        default(
            "tolerance",
            number("%", 0.1, 100.0),
            "5 %",
            "error of settlement / largest settlement that the planner may make. By a law: blocks, steps and elements that the scene does not state follow from it, if it is stated; `auto` with a `budget`: the cheapest model of the ground within it; `zone`: sleepers get grains if they settle otherwise than the far field by more than this share of the largest settlement; `cells`, 10 % if none is stated: alike sleepers share a cell if their settlements differ by at most twice this share, and a cell leaves out trains if the error is below this share of its settlement",
        ),
        default(
            "budget",
            Form::OneOf(&[number("min", 0.01, 1e6), Form::Words(NONE)]),
            "none",
            "longest time that the run may take; with it `substructure = auto` may choose grains",
        ),
        default(
            "memory",
            Form::OneOf(&[number("GiB", 0.01, 1e5), Form::Words(NONE)]),
            "none",
            "largest memory that the run may take",
        ),
        default(
            "symmetry",
            Form::Words(&[word("half", "the bed under one rail"), word("full", "the bed under both rails")]),
            "half",
            "part of the bed of grains that is modelled",
        ),
        default(
            "repeats",
            REPEATS,
            "1",
            "packings, each with another seed; in a range such as `3 .. 12` as many as give the largest settlement \
             and the step at the structure within `tolerance`",
        ),
    ],
    alternatives: &[],
    planned: &[],
};
