//! What a railway engineer types at first: each slip gives one diagnostic at its line, with what to write instead, and
//! nothing else.

use std::path::Path;
use trackbed::check::{Modules, NoModules};
use trackbed::diag::Code;
use trackbed::{Compiled, compile};

mod common {
    pub mod fixes;
    pub mod scene;
}
use common::fixes::{offers_a_text, useless};
use common::scene::SCENE;

/// What stands in the scene, what is typed in its place, the code, and the way out.
#[rustfmt::skip]
const SLIPS: &[(&str, &str, Code, &str)] = &[
    ("axle_load = 20 t", "axle_load = 22.5 tonnes", Code::E0303, "did you mean `t`?"),
    ("axle_load = 20 t", "axle_load = 20", Code::E0301, "write `20 t`, if that is the unit you meant"),
    ("axle_load = 20 t", "axle_load = 200 kn", Code::E0303, "did you mean `kN`?"),
    ("axle_load = 20 t", "axle_load = 20 t per axle", Code::E0304, "write `20 t`"),
    ("axle_load = 20 t", "axleload = 20 t", Code::E0402, "did you mean `axle_load`?"),
    ("axle_load = 20 t", "axle load = 20 t", Code::E0101, "a name has no blanks: write `axle_load = 20 t`"),
    ("axle_load = 20 t", "axle_load := 20 t", Code::E0105, "write `axle_load = 20 t`"),
    ("axle_load = 20 t", "axle_load => 20 t", Code::E0105, "write `axle_load = 20 t`"),
    ("axle_load = 20 t", "axle_load 20 t", Code::E0101, "write `axle_load = 20 t`"),
    ("axle_load = 20 t", "axle_load = -20 t", Code::E0405, "write `20 t`, without the sign"),
    ("axle_load = 20 t", "axle_load = 20,5 t", Code::E0105, "write `20.5 t`"),
    ("axle_load = 20 t", "axle_load = ?", Code::E0410, "write a value here, or give one with `--set`"),
    ("speed     = 70 km/h", "speed     = 70 km/hr", Code::E0303, "did you mean `km/h`?"),
    ("speed     = 70 km/h", "speed     = 70 kmh", Code::E0303, "did you mean `km/h`?"),
    ("speed     = 70 km/h", "speed     = 45 mph", Code::E0303, "write km/h (1 mph = 1.609 km/h)"),
    ("speed     = 70 km/h", "speed     = 70 km / h", Code::E0201, "if `h` is a unit, write it without blanks around `/` and `*`: `km/h`, `kN s/m`"),
    ("speed     = 70 km/h", "velocity  = 70 km/h", Code::E0402, "did you mean `speed`?"),
    ("speed     = 70 km/h", "speed     = \"70 km/h\"", Code::E0406, "write `70 km/h`, without quotes"),
    ("speed     = 70 km/h", "speed     = 60 to 70 km/h", Code::E0105, "write `60 .. 70 km/h`"),
    ("speed     = 70 km/h", "speed     = 60 .. 70 km/h", Code::E0406, "write `ramp(60 .. 70 km/h)`, if the value changes from one end to the other along the track"),
    ("speed     = 70 km/h", "speed     = 70 m/s^2", Code::E0302, "write `70 m/s`, if that is what you meant"),
    ("spacing = bay", "spacing = 60 cm per sleeper", Code::E0304, "write `60 cm`"),
    ("spacing = bay", "spacing = 0,6 m", Code::E0105, "write `0.6 m`"),
    ("spacing = bay", "spacing = 24 in", Code::E0303, "write mm (1 in = 25.4 mm)"),
    ("spacing = bay", "spacing = 600 mm;", Code::E0105, "write `spacing = 600 mm`"),
    ("spacing = bay", "sleeper_spacing = bay", Code::E0402, "did you mean `spacing`?"),
    ("damping = 5 kN s/m }", "damping = 5 kNs/m }", Code::E0303, "did you mean `kN s/m`?"),
    ("damping = 5 kN s/m }", "damping = 5 kN.s/m }", Code::E0101, "separate the factors of a unit by a blank: write `5 kN s/m`"),
    ("damping = 5 kN s/m }", "damping = 5 kN s / m }", Code::E0201, "if `m` is a unit, write it without blanks around `/` and `*`: `km/h`, `kN s/m`"),
    ("damping = 5 kN s/m }", "damping = 5 kN m/s }", Code::E0302, "write `5 kN s/m`, if that is what you meant"),
    ("damping = 5 kN s/m }", "damping = 5 % }", Code::E0302, "a dashpot is given in `kN s/m`, not as a damping ratio: `damping = 5 kN s/m`, or as a time, damping / stiffness: `damping_time = 0.125 ms`"),
    ("damping = 5 kN s/m }", "dampening = 5 kN s/m }", Code::E0402, "did you mean `damping`?"),
    ("damping = 5 kN s/m }", "damping = 5 kN s/m", Code::E0104, "add `}`, most likely at the end of line 15"),
    ("pad     = { stiffness = pad_stiffness,", "pad     { stiffness = pad_stiffness,", Code::E0105, "write `pad = { stiffness = pad_stiffness, damping = 5 kN s/m }`"),
    ("pad     = { stiffness = pad_stiffness,", "pad     = { k = pad_stiffness,", Code::E0402, "did you mean `stiffness`?"),
    ("pad     = { stiffness = pad_stiffness,", "pad     = { stiffness: pad_stiffness,", Code::E0105, "write `stiffness = pad_stiffness`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = medium", Code::E0201, "did you mean `pads.medium` of the standard library?"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = usps.medium", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = 40 MN/m", Code::E0406, "write `{ stiffness = 40 MN/m }`"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 mN/m", Code::E0405, "`40 MN/m` would be in range: is the prefix of the unit right?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 Mpa", Code::E0303, "did you mean `MPa`?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 N/mm", Code::E0405, "`40 MN/m` would be in range: is the prefix of the unit right?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MN/m²", Code::E0302, "write `40 MN/m`, if that is what you meant"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MNm^-1", Code::E0303, "did you mean `MN m^-1`?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40*10^6 N/m", Code::E0305, "write powers of ten in the number: `40e6 N/m`"),
    ("let pad_stiffness = 40 MN/m", "const pad_stiffness = 40 MN/m", Code::E0105, "write `let pad_stiffness = 40 MN/m` to name a value"),
    ("let pad_stiffness = 40 MN/m", "pad_stiffness = 40 MN/m", Code::E0105, "write `let pad_stiffness = 40 MN/m`"),
    ("rails.UIC60 {", "UIC60 {", Code::E0201, "did you mean `rails.UIC60` of the standard library?"),
    ("rails.UIC60 {", "rails.UIC61 {", Code::E0201, "did you mean `rails.UIC60`?"),
    ("bending_stiffness = 6.4 MN m^2", "bending_stiffness = 6.4 MN m2", Code::E0303, "did you mean `MN m^2`?"),
    ("bending_stiffness = 6.4 MN m^2", "EI = 6.4 MN m^2", Code::E0402, "did you mean `bending_stiffness`?"),
    ("bending_stiffness = 6.4 MN m^2", "bending_stiffness = 6.4 kN m^2", Code::E0405, "`6.4 MN m^2` would be in range: is the prefix of the unit right?"),
    ("sleepers.concrete {", "sleepers.B90 {", Code::E0201, "did you mean `sleepers.B70`?"),
    ("mass = 150 kg per seat", "mass = 150 kg per half sleeper", Code::E0101, "`per` takes one word: not `half sleeper`, but for example `seat` or `sleeper`"),
    ("mass = 150 kg per seat", "mass = 150 m²per seat", Code::E0101, "a blank stands before `per`: write `150 m² per seat`"),
    ("mass = 150 kg per seat", "mass = 150 kg/seat", Code::E0303, "write `kg per seat`"),
    ("stiffness = 50 MN/m per seat,", "stiffness = 50 MN/m,", Code::E0304, "write `50 MN/m per seat`, if that is what you meant"),
    ("stiffness = 50 MN/m per seat,", "stiffness = 50 MN/m per track,", Code::E0304, "write `50 MN/m per seat`, if that is what you meant"),
    ("mass = 150 kg per seat", "mass = 0.15 t per wheel", Code::E0304, "write `0.15 t per sleeper`, if that is what you meant"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = (open: 42 m, stiff: 24 m)", Code::E0101, "put lists in `[ ]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: 42, stiff: 24]", Code::E0301, "write `[open: 42, stiff: 24] m` or `[open: 42, stiff: 24] sleepers`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: 42 m; stiff: 24 m]", Code::E0105, "write `[open: 42 m, stiff: 24 m]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: -42 m, stiff: 24 m]", Code::E0405, "write `42 m`, without the sign"),
    ("sections    = [open: 42 m, stiff: 24 m]", "section     = [open: 42 m, stiff: 24 m]", Code::E0402, "did you mean `sections`?"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [wagon: 42 m, stiff: 24 m]", Code::E0406, "name one, such as `open` or `stiff`, or write `{ field = value }`"),
    ("transitions = [edge: soft_to_stiff]", "transitions = edge", Code::E0406, "write `[key: value]`"),
    ("transitions = [edge: soft_to_stiff]", "transition  = [edge: soft_to_stiff]", Code::E0402, "did you mean `transitions`?"),
    ("rail_ends   = clamped", "rail_ends   = clamp", Code::E0408, "did you mean `clamped`?"),
    ("rail_ends   = clamped", "rail_ends   = \"clamped\"", Code::E0406, "write `clamped`, without quotes"),
    ("direction = forward", "direction = Forward", Code::E0408, "did you mean `forward`?"),
    ("trains = ore", "trains = wagon", Code::E0406, "name one, such as `ore`, or write `{ field = value }`"),
    ("trains = ore", "trains = [ore: 100]", Code::E0405, "write `100 %`"),
    ("trains = ore", "trains = [ore: 60 %]", Code::E0407, "a train that runs alone needs no share: leave it out"),
    ("total  = 500 axles", "total  = 10 Mt", Code::E0303, "did you mean `MGT`?"),
    ("total  = 500 axles", "total  = 10 MGT per year", Code::E0304, "write `10 MGT`"),
    ("total  = 500 axles", "total  = 502 axles", Code::E0602, "write `500 axles` or `504 axles`"),
    ("time_step        = 1e-4 s", "time_step        = 0.1 milliseconds", Code::E0303, "did you mean `ms`?"),
    ("time_step        = 1e-4 s", "dt               = 1e-4 s", Code::E0402, "did you mean `time_step`?"),
    ("law              = mild", "law              = varandas", Code::E0201, "did you mean `laws.varandas_2014` of the standard library?"),
    ("law              = mild", "law              = \"mild\"", Code::E0406, "write `mild`, without quotes"),
    ("law mild : laws.varandas_2014 {", "law mild = laws.varandas_2014 {", Code::E0105, "write `law mild : laws.varandas_2014 {`"),
    ("law mild : laws.varandas_2014 {", "law mild extends laws.varandas_2014 {", Code::E0105, "write `law mild : laws.varandas_2014 {`"),
    ("form.gamma = 8 mm", "form.gama = 8 mm", Code::E0402, "give the whole value: `form = ...`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = [-20, -5, -1, +1]", Code::E0301, "write `[-20, -5, -1, +1] sleepers` or `[-20, -5, -1, +1] m`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 - -1 sleepers", Code::E0406, "write `-20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = [-20, -1] sleepers", Code::E0406, "write `-20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 .. -1", Code::E0301, "write `-20 .. -1 sleepers` or `-20 .. -1 m`"),
    ("over       = -20 .. -1 sleepers", "over       = -12 m .. -1 sleepers", Code::E0305, "write both ends in `m`, or both in `sleepers`"),
    ("quantities = settlement", "quantities = \"settlement\"", Code::E0406, "write `settlement`, without quotes"),
    ("ramp(0 .. 2 mm, over", "Ramp(0 .. 2 mm, over", Code::E0408, "did you mean `ramp`?"),
    ("poisson_ratio = 0.3", "poissons_ratio = 0.3", Code::E0402, "did you mean `poisson_ratio`?"),
    ("poisson_ratio = 0.3", "nu = 0.3", Code::E0402, "did you mean `poisson_ratio`?"),
    ("youngs_modulus = 90 MPa", "youngs_modulus = 90 MN/m", Code::E0302, "write `90 MN/m^2`, if that is what you meant"),
    ("[stone: 350 mm", "[stone: 350", Code::E0301, "write `350 mm`, if that is the unit you meant"),
    ("trackform stiff : open {", "trackform stiff = open {", Code::E0105, "write `trackform stiff : open {`"),
    ("track line {", "track line = {", Code::E0105, "write `track line {`, without `=`"),
    ("use std", "import std", Code::E0101, "write `use std`"),
    ("use std", "use stdlib", Code::E0204, "the standard library is called `std`: write `use std`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force, -20 .. -1 sleepers) < 80 kN per seat", Code::E0402, "it takes `over = span`, `from = transition` and `after = axles`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "contact_force < 80 kN per seat", Code::E0406, "write `max(contact_force)`, or use `min`, `mean`, `rms`, `percentile` or `place_of_max`"),
    ("primary   = { stiffness = 30 MN/m per wheelset", "primary   = { stiffness = 30 MN/m per axle", Code::E0304, "did you mean `30 MN/m per wheelset`?"),
    ("car_body  = { radius_of_gyration = 3.91 m }", "carbody   = { radius_of_gyration = 3.91 m }", Code::E0402, "did you mean `car_body`?"),
    ("allow = [stiffness_jump: \"this is what the scene is about\"]", "allow = stiffness_jump", Code::E0406, "write `[key: value]`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = ( stiffness = pad_stiffness, damping = 5 kN s/m )", Code::E0105, "write `{ stiffness = pad_stiffness, damping = 5 kN s/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = (stiffness = 40 MN/m)", Code::E0105, "write `{ stiffness = 40 MN/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = [stiffness = 40 MN/m]", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = stiffness = 40 MN/m", Code::E0101, "write `pad.stiffness = 40 MN/m`, or `pad = { stiffness = 40 MN/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = stiffness 40 MN/m", Code::E0101, "put arguments in parentheses, `stiffness(...)`, and fields in braces, `{ name = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads.medium(stiffness = 40 MN/m)", Code::E0101, "put fields in braces: `pads.medium { name = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads.medium + { damping = 5 kN s/m }", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { pads.medium, damping = 5 kN s/m }", Code::E0101, "a field is `name = value`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = {{ stiffness = 40 MN/m }}", Code::E0101, "write `{ stiffness = 40 MN/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = [{ stiffness = 40 MN/m }]", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "\"pad\"   = { stiffness = 40 MN/m }", Code::E0101, "names have no quotes, and fields are given with `=`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { \"stiffness\": 40 MN/m }", Code::E0101, "write `{ stiffness = 40 MN/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = null", Code::E0201, "expected `none`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad:", Code::E0101, "write a value behind it, or remove the line"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad.stiffness: 40 MN/m", Code::E0105, "write `pad.stiffness = 40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 [MN/m] }", Code::E0101, "write a unit without brackets: `40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m -- static\n }", Code::E0105, "write `// static`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m } % comment of Matlab", Code::E0105, "write `// comment of Matlab`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m } /* the pad */", Code::E0105, "write `// the pad`, with nothing behind it on its line"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m } ' the pad", Code::E0105, "write `// the pad`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m } # the pad", Code::E0105, "write `// the pad`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m } ! the pad", Code::E0105, "write `// the pad`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "% the pad\n  pad = { stiffness = 40 MN/m }", Code::E0105, "write `// the pad`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "-- the pad\n  pad = { stiffness = 40 MN/m }", Code::E0105, "write `// the pad`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "-- the pad is soft\n  pad = { stiffness = 40 MN/m }", Code::E0105, "write `// the pad is soft`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = \"40\" MN/m }", Code::E0101, "numbers have no quotes: write `40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = \"40 MN/m\" }", Code::E0406, "write `40 MN/m`, without quotes"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = ~40 MN/m }", Code::E0101, "write the number alone"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = approx 40 MN/m }", Code::E0101, "put arguments in parentheses, `approx(...)`, and fields in braces, `{ name = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m ± 5 MN/m }", Code::E0101, "a value has no tolerance: `random(mean, sd = ...)` scatters along the track, a study varies"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 +- 5 MN/m }", Code::E0305, "give `40` its unit too"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40.000,0 kN/m }", Code::E0105, "write `40000.0 kN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40,000 kN/m }", Code::E0105, "write `40.000 kN/m`, or `40_000 kN/m` if the comma separates thousands"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40'000 kN/m }", Code::E0101, "group digits by `_`: `40_000 kN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 000 kN/m }", Code::E0101, "group digits by `_`: `40_000 kN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 4*10^7 N/m }", Code::E0305, "write powers of ten in the number: `40e6 N/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 4 x 10^7 N/m }", Code::E0101, "write powers of ten in the number: `4e7 N/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 4·10^7 N/m }", Code::E0101, "write powers of ten in the number: `4e7 N/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 4.e7 N/m }", Code::E0105, "write `4.0e7 N/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m; damping = 5 kN s/m }", Code::E0105, "write `stiffness = 40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m damping = 5 kN s/m }", Code::E0101, "write `, damping`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN / m }", Code::E0201, "if `m` is a unit, write it without blanks around `/` and `*`: `km/h`, `kN s/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN per m }", Code::E0302, "write `40 MN/m`, if that is what you meant"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN m-1 }", Code::E0305, "a negative power is written `40 MN m^-1`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN·m⁻¹ }", Code::E0101, "a negative power is written `m^-1`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 meganewton/m }", Code::E0303, "did you mean `MN/m`?"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/metre }", Code::E0303, "did you mean `MN/m`?"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40MN/m, damping = 5kNs/m }", Code::E0303, "did you mean `kN s/m`?"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 40 MN/m, damping = 5000 Ns/m }", Code::E0303, "did you mean `N s/m`?"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = $pad_stiffness }", Code::E0101, "write the name without a sign before it"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = @pad_stiffness }", Code::E0101, "write the name without a sign before it"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = ${pad_stiffness} }", Code::E0101, "write the name without a sign before it"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = {pad_stiffness} }", Code::E0101, "write `pad_stiffness`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = (40) MN/m }", Code::E0101, "a unit follows its number: write `40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = 2 pad_stiffness }", Code::E0101, "a product needs its sign: `2 * pad_stiffness`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness = pad_stiffness**2 }", Code::E0101, "powers are written `m^3`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness == 40 MN/m }", Code::E0101, "`=` gives a value, `<=` and `>=` compare"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = { stiffness -> 40 MN/m }", Code::E0105, "write `stiffness = 40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     <- { stiffness = 40 MN/m }", Code::E0101, "a field is given with `=`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     =", Code::E0101, "write a value behind it, or remove the line"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     += { stiffness = 40 MN/m }", Code::E0101, "a field is `name = value`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "set pad = { stiffness = 40 MN/m }", Code::E0101, "a name has no blanks: write `set_pad = { stiffness = 40 MN/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads[\"medium\"]", Code::E0101, "a list cannot follow a name: put arguments in `( )`, names of a module behind a dot"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads::medium", Code::E0101, "join names by dots: `pads.medium`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads.medium { stiffness: 40 MN/m }", Code::E0105, "write `stiffness = 40 MN/m`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads.medium with { stiffness = 40 MN/m }", Code::E0101, "write the base before the braces: `base { field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     : pads.medium", Code::E0105, "write `pad = pads.medium`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     : pads.medium { stiffness = 40 MN/m }", Code::E0105, "write `pad = pads.medium { stiffness = 40 MN/m }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "- pad   = pads.medium", Code::E0101, "a field has no dash before it: write `pad   = pads.medium`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pads.medium; // the pad", Code::E0105, "write `pad     = pads.medium`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = „medium“", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = “pads.medium”", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("trackform open {", "trackform open (", Code::E0105, "write `trackform open {`"),
    ("trackform open {", "trackform open :", Code::E0105, "write `trackform open {`"),
    ("trackform open {", "trackform open [", Code::E0105, "write `trackform open {`"),
    ("trackform open {", "trackform open = {", Code::E0105, "write `trackform open {`, without `=`"),
    ("trackform open {", "trackform \"open\" {", Code::E0105, "write `trackform open {`"),
    ("trackform open {", "trackform: open {", Code::E0201, "write `trackform open {`, without the colon"),
    ("trackform open {", "trackform open: {", Code::E0101, "write the name of the base, or remove the `:`"),
    ("trackform open {", "open = trackform {", Code::E0105, "write `trackform open {`"),
    ("trackform open {", "def trackform open {", Code::E0105, "write `trackform open {`"),
    ("trackform open {", "Trackform open {", Code::E0401, "did you mean `trackform`?"),
    ("trackform open {", "trackforms open {", Code::E0401, "did you mean `trackform`?"),
    ("trackform open {", "trackform open-line {", Code::E0101, "a declaration is `kind name : base { field = value }`"),
    ("trackform stiff : open {", "track stiff : open {", Code::E0205, "write `trackform stiff : open`"),
    ("trackform stiff : open {", "trackform stiff < open {", Code::E0105, "write `trackform stiff : open {`"),
    ("trackform stiff : open {", "trackform stiff(open) {", Code::E0105, "write `trackform stiff : open {`"),
    ("trackform stiff : open {", "trackform stiff from open {", Code::E0105, "write `trackform stiff : open {`"),
    ("trackform stiff : open {", "trackform stiff : trackform open {", Code::E0105, "write `trackform stiff : open {`"),
    ("trackform stiff : open {", "trackform stiff : opne {", Code::E0201, "did you mean `open`?"),
    ("trackform stiff : open {", "trackform stiff :: open {", Code::E0105, "write `trackform stiff : open {`"),
    ("trackform stiff : open {", "trackform stiff -> open {", Code::E0105, "write `trackform stiff : open {`"),
    ("track line {", "track line :", Code::E0105, "write `track line {`"),
    ("track line {", "track line", Code::E0105, "write `track line {`"),
    ("track line {", "track line(", Code::E0105, "write `track line {`"),
    ("use std", "use std;", Code::E0105, "write `use std`"),
    ("use std", "use \"std\"", Code::E0101, "write `use std`"),
    ("use std", "use <std>", Code::E0101, "write `use std`"),
    ("use std", "use std::pads", Code::E0101, "join names by dots: `pads.medium`"),
    ("use std", "using std", Code::E0101, "write `use std`"),
    ("use std", "include std", Code::E0101, "write `use std`"),
    ("use std", "use std as s", Code::E0204, "write `use std`, and for example `rails.UIC60` for an entry of its module `rails`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = -20, -5 sleepers", Code::E0101, "write `at = [-20, -5] sleepers`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = -20, -5, -1, +1 sleepers", Code::E0101, "write `at = [-20, -5, -1, +1] sleepers`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = -20 -5 -1 +1 sleepers", Code::E0305, "write several values in brackets, separated by commas"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = (-20, -5, -1, +1) sleepers", Code::E0101, "put lists in `[ ]`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = {-20, -5, -1, +1} sleepers", Code::E0101, "write `[-20, -5, -1, +1]`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = [-20; -5; -1; +1] sleepers", Code::E0105, "write `[-20, -5, -1, +1]`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = [-20:-1] sleepers", Code::E0406, "several places are `[-20, -5] sleepers`, a span is `-20 .. -1 sleepers`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = -20:5:-1 sleepers", Code::E0101, "a span is written `-20 .. -1 sleepers`, several values are written in brackets"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = [-20, 0, +1] sleepers", Code::E0501, "the track has sleepers -69 .. -1 and +1 .. +40"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = sleepers [-20, -5, -1, +1]", Code::E0101, "a list cannot follow a name: put arguments in `( )`, names of a module behind a dot"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = [-20, -5, -1, +1] Schwellen", Code::E0303, "did you mean `sleepers`?"),
    ("after      = [0, 100, 500] axles", "after      = 0, 100, 500 axles", Code::E0101, "write `after = [0, 100, 500] axles`"),
    ("after      = [0, 100, 500] axles", "after      = [0, 100, 500] axels", Code::E0303, "did you mean `axles`?"),
    ("after      = [0, 100, 500] axles", "after      = [0, 100, 500] wheelsets", Code::E0303, "did you mean `axles`?"),
    ("after      = [0, 100, 500] axles", "after      = [0, 100, 500] cycles", Code::E0302, "counts are in `axles` or as the mass carried, `MGT`, if trains run; in `cycles` if a load is cyclic"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) =< 80 kN per seat", Code::E0105, "write `max(contact_force) <= 80 kN per seat`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) ≤ 80 kN per seat", Code::E0105, "write `max(contact_force) <= 80 kN per seat`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) <80kN per seat and max(contact_force) > 10 kN per seat", Code::E0101, "write each comparison on its own line or behind a comma; `a < x < b` is one comparison"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) < 80 kN per seat && max(contact_force) > 10 kN per seat", Code::E0101, "write each comparison on its own line or behind a comma; `a < x < b` is one comparison"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) < 80 kN per seat & max(contact_force) > 10 kN per seat", Code::E0101, "write each comparison on its own line or behind a comma; `a < x < b` is one comparison"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) < 80 kN per seat or max(contact_force) > 10 kN per seat", Code::E0101, "there is no `or`: write comparisons that must all hold"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) < 80 kN per seat || max(contact_force) > 10 kN per seat", Code::E0101, "there is no `or`: write comparisons that must all hold"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "not max(contact_force) > 80 kN per seat", Code::E0101, "there is no `not`: reverse the comparison"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "!(max(contact_force) > 80 kN per seat)", Code::E0101, "there is no `not`: reverse the comparison"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) = 80 kN per seat", Code::E0406, "comparisons are `<`, `<=`, `>` and `>=`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) == 80 kN per seat", Code::E0101, "`=` gives a value, `<=` and `>=` compare"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) != 80 kN per seat", Code::E0101, "comparisons are `<`, `<=`, `>` and `>=`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) <> 80 kN per seat", Code::E0101, "comparisons are `<`, `<=`, `>` and `>=`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) << 80 kN per seat", Code::E0101, "comparisons are `<`, `<=`, `>` and `>=`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max contact_force < 80 kN per seat", Code::E0101, "put arguments in parentheses: `max(...)`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max[contact_force] < 80 kN per seat", Code::E0101, "a list cannot follow a name: put arguments in `( )`, names of a module behind a dot"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "if max(contact_force) > 80 kN per seat", Code::E0101, "write the comparison without `if`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force; over = -20 .. -1 sleepers) < 80 kN per seat", Code::E0105, "write `(contact_force, over = -20 .. -1 sleepers)`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force, over: -20 .. -1 sleepers) < 80 kN per seat", Code::E0105, "write `over = -20 .. -1 sleepers`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "\"max(contact_force) < 80 kN per seat\"", Code::E0406, "write `max(contact_force) < 80 kN per seat`, without quotes"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force) < 80 kN per seat.", Code::E0101, "remove the point at the end"),
    ("over       = -20 .. -1 sleepers", "over       = -20 - 45 mm", Code::E0406, "write `-20 .. 45 mm`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 sleepers - -1 sleepers", Code::E0406, "write `-20 sleepers .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = [-20 .. -1] sleepers", Code::E0406, "from one end to the other: `-20 .. -1 sleepers`, `-6 .. 0 m`"),
    ("over       = -20 .. -1 sleepers", "over       = (-20 .. -1) sleepers", Code::E0101, "a unit follows its number: write `-20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = (-20, -1) sleepers", Code::E0101, "put lists in `[ ]`"),
    ("over       = -20 .. -1 sleepers", "over       = -20:-1 sleepers", Code::E0101, "a span is written `-20 .. -1 sleepers`, several values are written in brackets"),
    ("over       = -20 .. -1 sleepers", "over       = -20 … -1 sleepers", Code::E0105, "write `over       = -20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 – -1 sleepers", Code::E0105, "write `over       = -20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 through -1 sleepers", Code::E0406, "from one end to the other: `-20 .. -1 sleepers`, `-6 .. 0 m`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 until -1 sleepers", Code::E0406, "from one end to the other: `-20 .. -1 sleepers`, `-6 .. 0 m`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 and -1 sleepers", Code::E0406, "from one end to the other: `-20 .. -1 sleepers`, `-6 .. 0 m`"),
    ("over       = -20 .. -1 sleepers", "over       = -1 .. -20 sleepers", Code::E0505, "write the smaller end first: `-20 .. -1 sleepers`"),
    ("speed     = 70 km/h", "speed     = 70 kph", Code::E0303, "did you mean `km/h`?"),
    ("speed     = 70 km/h", "speed     = 70 Km/h", Code::E0303, "did you mean `km/h`?"),
    ("speed     = 70 km/h", "speed     = 70 km/h.", Code::E0101, "remove the point at the end"),
    ("speed     = 70 km/h", "speed     = 70 km/h;", Code::E0105, "write `speed     = 70 km/h`"),
    ("speed     = 70 km/h", "speed     = 70 kmph", Code::E0303, "did you mean `km/h`?"),
    ("speed     = 70 km/h", "speed     = 70 km per h", Code::E0302, "write `70 km/h`, if that is what you meant"),
    ("speed     = 70 km/h", "speed     = 70 km/hour", Code::E0303, "did you mean `km/h`?"),
    ("speed     = 70 km/h", "speed     = 19.4 m/sec", Code::E0303, "did you mean `m/s`?"),
    ("speed     = 70 km/h", "speed     = 19.4 m s-1", Code::E0305, "a negative power is written `19.4 m s^-1`"),
    ("speed     = 70 km/h", "speed     = 19,4 m/s", Code::E0105, "write `19.4 m/s`"),
    ("speed     = 70 km/h", "speed     = 70", Code::E0301, "write `70 km/h`, if that is the unit you meant"),
    ("speed     = 70 km/h", "speed     = 70 kms/h", Code::E0303, "did you mean `km s/h`?"),
    ("speed     = 70 km/h", "Speed     = 70 km/h", Code::E0402, "did you mean `speed`?"),
    ("speed     = 70 km/h", "speed 70 km/h", Code::E0101, "write `speed = 70 km/h`"),
    ("speed     = 70 km/h", "speed: 70 km/h", Code::E0105, "write `speed = 70 km/h`"),
    ("speed     = 70 km/h", "speed     = 60-80 km/h", Code::E0305, "a range is written `60 .. 80 km/h`"),
    ("speed     = 70 km/h", "speed     = max 70 km/h", Code::E0101, "put arguments in parentheses, `max(...)`, and fields in braces, `{ name = value }`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = {open: 42 m, stiff: 24 m}", Code::E0406, "write `[key: value]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = {open = 42 m, stiff = 24 m}", Code::E0406, "write `[key: value]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open = 42 m, stiff = 24 m]", Code::E0105, "write `open: 42 m`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: 42 m stiff: 24 m]", Code::E0101, "separate pairs by commas"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open 42 m, stiff 24 m]", Code::E0101, "write `open: 42 m`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [(open, 42 m), (stiff, 24 m)]", Code::E0105, "write `[open: 42 m, stiff: 24 m]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [[open, 42 m], [stiff, 24 m]]", Code::E0406, "write `[key: value]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [[\"open\", 42 m], [\"stiff\", 24 m]]", Code::E0406, "write `[key: value]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = open: 42 m, stiff: 24 m", Code::E0101, "pairs need brackets: write `[open: 42 m, stiff: 24 m]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: 42m; stiff: 24m]", Code::E0105, "write `[open: 42m, stiff: 24m]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [{open: 42 m}, {stiff: 24 m}]", Code::E0406, "write `[key: value]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open -> 42 m, stiff -> 24 m]", Code::E0105, "write `open: 42 m`"),
    ("sleeper = none\n", "sleeper = None\n", Code::E0201, "did you mean `none`?"),
    ("sleeper = none\n", "sleeper = null\n", Code::E0201, "expected `none`"),
    ("sleeper = none\n", "sleeper = no\n", Code::E0201, "expected `none`"),
    ("sleeper = none\n", "sleeper = false\n", Code::E0201, "expected `none`"),
    ("sleeper = none\n", "sleeper = NaN\n", Code::E0201, "expected `none`"),
    ("friction = 0.7", "friction = .7", Code::E0105, "write `0.7`"),
    ("friction = 0.7", "friction = 0,7", Code::E0105, "write `0.7`"),
    ("friction = 0.7", "friction = \"0.7\"", Code::E0406, "write `0.7`, without quotes"),
    ("friction = 0.7", "friction = 0.7 [-]", Code::E0101, "write a unit without brackets: `40 MN/m`"),
    ("friction = 0.7", "friction = tan(35 deg)", Code::E0408, "functions of numbers are `sqrt`, `abs`, `min` and `max`"),
    ("friction = 0.7", "friction = tan 35", Code::E0101, "put arguments in parentheses, `tan(...)`, and fields in braces, `{ name = value }`"),
    ("friction = 0.7", "friction = 35 deg", Code::E0302, "write `0.7002`: a coefficient of friction is the tangent of its angle"),
    ("friction = 0.7", "friction = 35°", Code::E0303, "degrees are written `deg`: `35 deg`"),
    ("friction = 0.7", "friction = μ", Code::E0101, "names are made of ASCII letters, digits and `_`"),
    ("grading  = { passing = [22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %], cut_below = 25 mm }", "grading  = { passing = { 22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 % }, cut_below = 25 mm }", Code::E0101, "write `[22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %]`"),
    ("grading  = { passing = [22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %], cut_below = 25 mm }", "grading  = { passing = [(22.4 mm, 0 %), (40 mm, 60 %), (63 mm, 100 %)], cut_below = 25 mm }", Code::E0105, "write `[22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %]`"),
    ("grading  = { passing = [22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %], cut_below = 25 mm }", "grading  = 31.5/63", Code::E0406, "name one, such as `gradings.ballast_32_80`, `gradings.subballast_0_150` or `gradings.ballast_16_64`, or write `{ field = value }`"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg/m3", Code::E0303, "did you mean `kg/m^3`?"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg/m**3", Code::E0101, "powers are written `m^3`"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg/cbm", Code::E0303, "did you mean `kg/m^3`?"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg m-3", Code::E0305, "a negative power is written `2000 kg m^-3`"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg.m^-3", Code::E0101, "separate the factors of a unit by a blank: write `2000 kg m^-3`"),
    ("density        = 2000 kg/m^3", "density        = 2.0 g/cm3", Code::E0303, "did you mean `g/cm^3`?"),
    ("density        = 2000 kg/m^3", "density        = 20 kN/m^3", Code::E0302, "write `2039 kg/m^3`: a weight divided by 9.81 m/s^2 is a mass"),
    ("density        = 2000 kg/m^3", "density        = 2.000,0 kg/m^3", Code::E0105, "write `2000.0 kg/m^3`"),
    ("density        = 2000 kg/m^3", "density        = 2,000.0 kg/m^3", Code::E0105, "write `2000.0 kg/m^3`"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg/m³ # dry", Code::E0105, "write `// dry`"),
    ("density        = 2000 kg/m^3", "ρ              = 2000 kg/m³", Code::E0101, "names are made of ASCII letters, digits and `_`"),
    ("density        = 2000 kg/m^3", "density        = 2000 kg / m^3", Code::E0201, "if `m` is a unit, write it without blanks around `/` and `*`: `km/h`, `kN s/m`"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 90 N/mm2,", Code::E0303, "did you mean `N/mm^2`?"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 90 MN/m2,", Code::E0303, "did you mean `MN/m^2`?"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 90 mpa,", Code::E0303, "did you mean `MPa`?"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 90 Mpa,", Code::E0303, "did you mean `MPa`?"),
    ("youngs_modulus = 90 MPa,", "young's_modulus = 90 MPa,", Code::E0101, "a name has no quotes: write `youngs_modulus = 90 MPa`"),
    ("youngs_modulus = 90 MPa,", "young's modulus = 90 MPa,", Code::E0101, "a name has no quotes: write `youngs_modulus = 90 MPa`"),
    ("youngs_modulus = 90 MPa,", "Youngs_Modulus = 90 MPa,", Code::E0402, "did you mean `youngs_modulus`?"),
    ("youngs_modulus = 90 MPa,", "youngsModulus = 90 MPa,", Code::E0402, "did you mean `youngs_modulus`?"),
    ("youngs_modulus = 90 MPa,", "youngs-modulus = 90 MPa,", Code::E0101, "a name has no dashes: write `youngs_modulus = 90 MPa`"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 90e6,", Code::E0301, "write `90e6 Pa`, if that is the unit you meant"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 90 bar,", Code::E0303, "write kPa (1 bar = 100 kPa)"),
    ("youngs_modulus = 90 MPa,", "youngs_modulus = 13 ksi,", Code::E0303, "write MPa (1 ksi = 6.895 MPa)"),
    ("total  = 500 axles", "total  = 500 Achsen", Code::E0303, "did you mean `axles`?"),
    ("total  = 500 axles", "total  = 1,000 axles", Code::E0105, "write `1.000 axles`, or `1_000 axles` if the comma separates thousands"),
    ("total  = 500 axles", "total  = 1.000.000 axles", Code::E0101, "a number has one point"),
    ("total  = 500 axles", "total  = 10 mgt", Code::E0303, "did you mean `MGT`?"),
    ("total  = 500 axles", "total  = 10 GT", Code::E0303, "did you mean `MGT`?"),
    ("deny  = [critical_speed]", "deny  = [critical_speed: \"x\"]", Code::E0406, "write `critical_speed` alone"),
    ("title = \"Embankment to slab\"", "title = Embankment to slab", Code::E0406, "write `\"Embankment to slab\"`"),
    ("title = \"Embankment to slab\"", "title = 'Embankment to slab'", Code::E0105, "write `\"Embankment to slab\"`"),
    ("title = \"Embankment to slab\"", "title = “Embankment to slab”", Code::E0105, "write `\"Embankment to slab\"`"),
    ("title = \"Embankment to slab\"", "title = \"Embankment to slab", Code::E0106, "write `\"Embankment to slab\"`"),
    ("title = \"Embankment to slab\"", "title : \"Embankment to slab\"", Code::E0105, "write `title = \"Embankment to slab\"`"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric 4 axles, 0.2", Code::E0101, "put arguments in parentheses, `geometric(...)`, and fields in braces, `{ name = value }`"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric[4 axles, 0.2]", Code::E0101, "a list cannot follow a name: put arguments in `( )`, names of a module behind a dot"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric{4 axles, 0.2}", Code::E0101, "write `geometric(4 axles, 0.2)`"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric(first: 4 axles, ratio: 0.2)", Code::E0105, "write `first = 4 axles`"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric()", Code::E0403, "write `geometric(first = ..., ratio = ...)`"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric(4, 0.2)", Code::E0301, "write `4 axles`, if that is the unit you meant"),
    ("update_every     = geometric(4 axles, 0.2)", "update_every     = geometric(4 axles; 0.2)", Code::E0105, "write `(4 axles, 0.2)`"),
    ("elements_per_bay = 4", "elements per bay = 4", Code::E0101, "a name has no blanks: write `elements_per_bay = 4`"),
    ("elements_per_bay = 4", "elements-per-bay = 4", Code::E0101, "a name has no dashes: write `elements_per_bay = 4`"),
    ("finish           = 15 m", "finish           = 15 m.", Code::E0101, "remove the point at the end"),
    ("finish           = 15 m", "finish           = end", Code::E0201, "expected `auto`"),
    ("quantities = settlement", "quantities = settlement and void", Code::E0101, "write several values in brackets: `[a, b]`"),
    ("quantities = settlement", "quantities = settlement, void", Code::E0101, "write `quantities = [settlement, void]`"),
    ("quantities = settlement", "quantities = (settlement, void)", Code::E0101, "put lists in `[ ]`"),
    ("quantities = [rail_seat_load, contact_force]", "quantities = [rail_seat_load contact_force]", Code::E0101, "write `rail_seat_load, contact_force` for several, `rail_seat_load_contact_force` for one: a name has no blanks"),
    ("quantities = [rail_seat_load, contact_force]", "quantities = [rail_seat_load; contact_force]", Code::E0105, "write `[rail_seat_load, contact_force]`"),
    ("quantities = [rail_seat_load, contact_force]", "quantities = {rail_seat_load, contact_force}", Code::E0101, "write `[rail_seat_load, contact_force]`"),
    ("quantities = [rail_seat_load, contact_force]", "quantities = rail_seat_load, contact_force", Code::E0101, "write `quantities = [rail_seat_load, contact_force]`"),
    ("ramp(0 .. 2 mm, over = -6 .. 0 m)", "ramp(0, 2 mm, over = -6 .. 0 m)", Code::E0402, "after its value it takes `over = ...`"),
    ("ramp(0 .. 2 mm, over = -6 .. 0 m)", "ramp(0 mm, 2 mm)", Code::E0402, "after its value it takes `over = ...`"),
    ("ramp(0 .. 2 mm, over = -6 .. 0 m)", "ramp(0 to 2 mm, over = -6 .. 0 m)", Code::E0105, "write `0 .. 2 mm`"),
    ("ramp(0 .. 2 mm, over = -6 .. 0 m)", "ramp(from = 0 mm, to = 2 mm)", Code::E0402, "after its value it takes `over = ...`"),
    ("ramp(0 .. 2 mm, over = -6 .. 0 m)", "ramp 0 .. 2 mm", Code::E0101, "put arguments in parentheses, `ramp(...)`, and fields in braces, `{ name = value }`"),
    ("ramp(0 .. 2 mm, over = -6 .. 0 m)", "ramp(0 .. 2 mm, over = (-6, 0) m)", Code::E0101, "put lists in `[ ]`"),
];

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

#[test]
fn a_slip_is_said_once_with_its_way_out() {
    assert!(SLIPS.len() >= 100, "{}", SLIPS.len());
    let mut wrong = Vec::new();
    for (right, typed, code, way_out) in SLIPS {
        assert_eq!(SCENE.matches(right).count(), 1, "`{right}` stands once");
        let compiled = compile("scene.track", &SCENE.replace(right, typed), &NoModules, &[]);
        let line = SCENE[..SCENE.find(right).unwrap()].matches('\n').count() + 1;
        let sound = match compiled.diagnostics.as_slice() {
            [found] => {
                let place = found.labels[0].span;
                (found.code, found.help.as_deref()) == (*code, Some(*way_out))
                    && compiled.sources.position(place.file, place.start).line == line
            }
            _ => false,
        };
        if !sound {
            wrong.push(format!("`{typed}`: expected {code:?} in line {line} with {way_out:?}\n{}", told(&compiled)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_way_out_that_is_an_edit_can_be_applied() {
    let again = |text: &str| compile("scene.track", text, &NoModules, &[]);
    let (mut wrong, mut without) = (Vec::new(), Vec::new());
    for (right, typed, _, way_out) in SLIPS {
        let text = SCENE.replace(right, typed);
        let found = again(&text);
        wrong.extend(useless(&text, &found, again).into_iter().map(|what| format!("`{typed}`: {what}")));
        if found.diagnostics.iter().any(|d| offers_a_text(d) && d.fixes.is_empty()) {
            without.push(format!("`{typed}`: {way_out}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(without.is_empty(), "{} offers are no edits:\n{}", without.len(), without.join("\n"));
}

#[test]
fn the_scene_itself_is_without_a_slip() {
    let compiled = compile("scene.track", SCENE, &NoModules, &[]);
    assert!(compiled.diagnostics.is_empty(), "{}", told(&compiled));
}

/// A module beside the scene, with values of another dimension and out of range.
struct Site;

impl Modules for Site {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        let text = "let force = 40 kN\nlet soft = 40 kN/m\npad ours { stiffness = 40 MN/m }\n";
        (relative == Path::new("site.track")).then(|| text.as_bytes().to_vec())
    }
}

#[test]
fn a_value_of_another_file_is_shown_in_both() {
    for (value, code) in [("site.force", Code::E0302), ("site.soft", Code::E0405)] {
        let text = SCENE.replace("let pad_stiffness = 40 MN/m", &format!("use site\nlet pad_stiffness = {value}"));
        let compiled = compile("scene.track", &text, &Site, &[]);
        let [found] = compiled.diagnostics.as_slice() else { panic!("{}", told(&compiled)) };
        assert_eq!(found.code, code, "{}", told(&compiled));
        let files: Vec<&str> =
            found.labels.iter().map(|label| compiled.sources.get(label.span.file).name.as_str()).collect();
        assert_eq!(files[0], "site.track", "the literal is what is wrong");
        assert!(files[1..].contains(&"scene.track"), "and this is where it is used: {files:?}");
    }
}

#[test]
fn an_object_of_another_kind_from_another_file_is_pointed_at() {
    let text =
        SCENE.replace("usps.stiff { damping_time", "site.ours { damping_time").replace("use std", "use std\nuse site");
    let compiled = compile("scene.track", &text, &Site, &[]);
    let [found] = compiled.diagnostics.as_slice() else { panic!("{}", told(&compiled)) };
    assert_eq!(found.code, Code::E0205, "{}", told(&compiled));
    assert_eq!(found.labels.len(), 2, "the base is shown too:\n{}", told(&compiled));
}
