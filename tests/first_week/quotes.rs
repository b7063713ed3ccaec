//! Quotes that are lost, doubled or of another kind: shown where they were lost.

use crate::{B, J, S, Slip};
use trackbed::diag::Code::*;

#[rustfmt::skip]
pub const SLIPS: &[Slip] = &[
    (S, "title = \"Embankment to slab\"", "title = \"Embankment to slab", E0106, "`\"Embankment to slab\"`", "\"Embankment to slab"),
    (S, "title = \"Embankment to slab\"", "title = Embankment to slab\"", E0106, "`\"Embankment to slab\"`", "Embankment to slab\""),
    (S, "title = \"Embankment to slab\"", "title = \"Embankment\n  to slab\"", E0106, "one line", ""),
    (S, "title = \"Embankment to slab\"", "title = \"Embankment: [to slab, 2 m] {x}", E0106, "`\"Embankment: [to slab, 2 m] {x}\"`", "\"Embankment: [to slab, 2 m] {x}"),
    (S, "title = \"Embankment to slab\"", "title = \"\"Embankment to slab\"\"", E0105, "`\"Embankment to slab\"`", "\"\"Embankment to slab\"\""),
    (S, "title = \"Embankment to slab\"", "title = \"The \"soft\" embankment\"", E0105, "`\\\"`", ""),
    (S, "title = \"Embankment to slab\"", "title = `Embankment to slab`", E0105, "`\"Embankment to slab\"`", "`Embankment to slab`"),
    (S, "title = \"Embankment to slab\"", "title = «Embankment to slab»", E0105, "`\"Embankment to slab\"`", "«Embankment to slab»"),
    (S, "title = \"Embankment to slab\"", "title = 「Embankment to slab」", E0105, "`\"Embankment to slab\"`", "「Embankment to slab」"),
    (S, "title = \"Embankment to slab\"", "title = ‚Embankment to slab‘", E0105, "`\"Embankment to slab\"`", "‚Embankment to slab‘"),
    (S, "title = \"Embankment to slab\"", "title = \"\"\"Embankment to slab\"\"\"", E0105, "`\"Embankment to slab\"`", "\"\"\"Embankment to slab\"\"\""),
    (S, "title = \"Embankment to slab\"", "title = Embankment", E0406, "`\"Embankment\"`", "Embankment"),
    (S, "[stiffness_jump: \"this is what the scene is about\"]", "[stiffness_jump: \"this is what the scene is about]", E0106, "`\"this is what the scene is about\"`", "\"this is what the scene is about"),
    (S, "[stiffness_jump: \"this is what the scene is about\"]", "[stiffness_jump: this is what the scene is about]", E0101, "`\"this is what the scene is about\"`", "this is what the scene is about"),
    (S, "[stiffness_jump: \"this is what the scene is about\"]", "[stiffness_jump: this is what the scene is about\"]", E0106, "`\"this is what the scene is about\"`", "this is what the scene is about\""),
    (B, "allow = [stiffness_jump: \"softer pads on the slab and approach slabs are there against it\"]", "allow = [stiffness_jump: \"softer pads, and slabs]", E0106, "`\"softer pads, and slabs\"`", "\"softer pads, and slabs"),
    (B, "  title = \"Approach slabs before and behind a bridge\"\n", "  title = \"Approach slabs before and behind a bridge\n", E0106, "`\"Approach slabs before and behind a bridge\"`", "\"Approach slabs before and behind a bridge"),
    (J, "scenario { title = \"100 kN on twenty fixed sleepers\" }", "scenario { title = \"100 kN on twenty fixed sleepers }", E0106, "`\"100 kN on twenty fixed sleepers\"`", "\"100 kN on twenty fixed sleepers"),
    (J, "source = \"closed form; published 16 and 19 kN m\"", "source = \"closed form; published 16 and 19 kN m'", E0106, "`\"closed form; published 16 and 19 kN m\"`", "\"closed form; published 16 and 19 kN m'"),
    (S, "ramp(0 .. 2 mm, over = -6 .. 0 m)", "file(\"level.csv)", E0106, "`\"level.csv\"`", ""),
    (S, "ramp(0 .. 2 mm, over = -6 .. 0 m)", "file(level.csv\")", E0106, "`\"level.csv\"`", ""),
    (S, "spacing = bay", "spacing = 24\"", E0106, "25.4 mm", ""),
    (S, "spacing = bay", "spacing = 2'", E0101, "0.3048 m", ""),
];
