//! Settlement laws: the kind `law` and the words of `law.form` with their arguments. The letters are taken from the
//! publications.

use super::fields::{SEAT, default, measure, number, optional, per, required, word};
use super::{Field, Form, Kind, Measure, Role, Word};

const fn law(name: &'static str, doc: &'static str, arguments: &'static [Field]) -> Word {
    Word { name, doc, arguments, planned: false }
}

const FORCE: Form = per("kN", 0.1, 1000.0, &SEAT);
const CYCLES: Form = Form::OneOf(&[number("cycles", 1.0, 1e12), number("axles", 1.0, 1e12)]);
const EXPONENT: Form = number("", 0.0, 10.0);

pub(super) const LAW: Kind = Kind {
    name: "law",
    doc: "A settlement law: settlement of a support from the peaks of its contact force.",
    role: Role::Part,
    fields: &[
        required("form", Form::Words(FORMS), "equation of the law, with its parameters"),
        optional(
            "loads",
            Form::Interval(Measure { basis: Some(&SEAT), ..measure("kN", 0.0, 10_000.0) }),
            "peak forces for which the law was calibrated",
        ),
        optional("cycles", Form::Interval(measure("axles", 0.0, 1e12)), "axle counts for which the law was calibrated"),
        optional("voids", Form::Interval(measure("mm", 0.0, 100.0)), "voids for which the law was calibrated"),
        optional(
            "error",
            number("%", 0.0, 1000.0),
            "largest error against what the law was fitted to / largest settlement; a law that states it is refused beyond its `loads`, `cycles` and `voids`",
        ),
        default(
            "cycle_per",
            Form::Words(&[
                word("axle", "every axle is a cycle"),
                word("bogie", "the larger peak of the two axles of a bogie is one cycle"),
                word("vehicle", "the largest peak of the four axles of a vehicle is one cycle"),
            ]),
            "axle",
            "meaning of one cycle in the law; publications differ by a factor of four",
        ),
    ],
    alternatives: &[],
    planned: &[],
};

const FORMS: &[Word] = &[
    law(
        "varandas",
        "Varandas, Hölscher and Silva (2014): integral over the force of the settlement that each exceedance of this force adds",
        &[
            default("alpha", number("", 0.0, 5.0), "0.6", "exponent of the force"),
            default("beta", number("", 0.0, 5.0), "0.82", "decay of the effect of repeated loads"),
            default(
                "gamma",
                number("mm", 0.01, 1000.0),
                "10 mm",
                "settlement after `reference_cycles` of `reference_force`",
            ),
            default("reference_cycles", CYCLES, "1_000_000 axles", "N0: reference number of cycles"),
            default("reference_force", FORCE, "50 kN per seat", "F0: reference force"),
        ],
    ),
    law(
        "nasrollahi",
        "Nasrollahi et al. (2023): dS/dN = (alpha / N0) (<F - Fth> / F0)^beta; the threshold Fth rises with settlement from the initial to the final threshold",
        &[
            default(
                "alpha",
                number("mm", 1e-6, 100.0),
                "0.02 mm",
                "settlement after N0 cycles at F0 above the threshold",
            ),
            default("beta", number("", 1.0, 10.0), "2.8", "exponent of the force above the threshold"),
            default(
                "gamma",
                number("mm^-1", 0.0, 100.0),
                "0.11 mm^-1",
                "rate at which the threshold rises with settlement",
            ),
            default(
                "initial_threshold",
                per("kN", 0.0, 1000.0, &SEAT),
                "35 kN per seat",
                "threshold force of a new support",
            ),
            default(
                "final_threshold",
                per("kN", 0.0, 1000.0, &SEAT),
                "90 kN per seat",
                "threshold force after long settlement",
            ),
            default("reference_force", FORCE, "1 kN per seat", "F0: reference force"),
            default("reference_cycles", CYCLES, "100_000 axles", "N0: reference number of cycles"),
        ],
    ),
    law(
        "sato",
        "Sato (1995): S = (F/F0)^exponent (gamma (1 - e^(-alpha N)) + beta N)",
        &[
            default("alpha", number("", 1e-9, 10.0), "1e-4", "rate of the initial settlement [1 per cycle]"),
            default("beta", number("mm", 0.0, 1.0), "1e-5 mm", "settlement per cycle of the long-term part"),
            default("gamma", number("mm", 1e-3, 1000.0), "5 mm", "total initial settlement"),
            default("exponent", EXPONENT, "0", "exponent of the force; the published law does not depend on the force"),
            default(
                "reference_force",
                FORCE,
                "50 kN per seat",
                "F0: reference force; without effect if `exponent` is 0",
            ),
        ],
    ),
    law(
        "shenton",
        "Shenton (1985): S = (F/F0)^exponent (k1 N^0.2 + k2 N)",
        &[
            required("k1", number("mm", 1e-6, 100.0), "settlement in the first cycle of `reference_force`"),
            required("k2", number("mm", 0.0, 1.0), "settlement per cycle of `reference_force` in the long-term part"),
            default("exponent", EXPONENT, "1", "exponent of the force"),
            required("reference_force", FORCE, "F0: the seat force for which `k1` and `k2` hold"),
        ],
    ),
    law(
        "hettler",
        "Hettler (1984): S = s (F/F0)^exponent (1 + c log N)",
        &[
            default("s", number("mm", 1e-9, 100.0), "0.00095 mm", "settlement in the first cycle of `reference_force`"),
            default("c", number("", 1e-3, 10.0), "0.43", "growth per e-fold or per decade of cycles, relative to `s`"),
            default("exponent", EXPONENT, "1.6", "exponent of the force"),
            default("reference_force", FORCE, "1 kN per seat", "F0: reference force"),
            required(
                "logarithm",
                Form::Words(&[word("natural", "base e"), word("decimal", "base 10")]),
                "base of the logarithm; sources differ, which changes the term by a factor of 2.3",
            ),
        ],
    ),
    law(
        "guerin",
        "Guérin (1996): dS/dN = alpha (d/d0)^beta; d is the elastic deflection of the support",
        &[
            default("alpha", number("mm", 1e-12, 1.0), "1.44e-6 mm", "settlement per cycle at `reference_deflection`"),
            default("beta", EXPONENT, "2.51", "exponent of the deflection"),
            default("reference_deflection", number("mm", 1e-3, 100.0), "1 mm", "d0: reference deflection"),
        ],
    ),
    law(
        "power",
        "user-defined law, or one that `trackbed calibrate --grains` fits: S = a (F/F0)^m e^(-g v) N^b; v is the void under the sleeper",
        &[
            required("a", number("mm", 1e-9, 1000.0), "settlement in the first cycle of `reference_force`"),
            required("m", EXPONENT, "exponent of the force"),
            required("b", number("", 1e-3, 1.0), "exponent of the number of cycles"),
            required("reference_force", FORCE, "F0: reference force"),
            default(
                "g",
                number("mm^-1", -20.0, 20.0),
                "0 mm^-1",
                "rate at which settlement decreases with the void; 0: only the force counts",
            ),
        ],
    ),
];
