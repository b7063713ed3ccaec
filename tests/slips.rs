//! What a railway engineer types at first: each slip gives one diagnostic at its line, with what to write instead, and nothing else.

use std::path::Path;
use trackbed::check::{Modules, NoModules};
use trackbed::diag::Code;
use trackbed::{Compiled, compile};

/// A scene without a mistake and without a warning.
const SCENE: &str = r#"// an embankment meets a slab
use std

let pad_stiffness = 40 MN/m
let bay = 0.6 m

scenario {
  title = "Embankment to slab"
  allow = [stiffness_jump: "this is what the scene is about"]
  deny  = [critical_speed]
}

trackform open {
  rail    = rails.UIC60 { density = 7800 kg/m^3, bending_stiffness = 6.4 MN m^2 }
  pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }
  sleeper = sleepers.concrete { mass = 150 kg per seat, length = 2.4 m }
  spacing = bay
  support = { stiffness = 50 MN/m per seat, damping = 50 kN s/m per seat }
  usp     = usps.stiff { damping_time = 0.1 ms }
  settlement = ramp(0 .. 2 mm, over = -6 .. 0 m), layers = [stone: 350 mm, fill: 1 m]
}

trackform stiff : open {
  sleeper = none
  support = none
  slab    = slabs.half_width_1600
  usp     = none
  settlement = 0 mm
}

track line {
  sections    = [open: 42 m, stiff: 24 m]
  transitions = [edge: soft_to_stiff]
  rail_ends   = clamped
}

vehicle wagon {
  axle_load = 20 t
  car_body  = { radius_of_gyration = 3.91 m }
  bogie     = { mass = 800 kg per bogie, pitch_inertia = 730 kg m^2 per bogie, spacing = 6.77 m }
  wheelset  = { mass = 1341 kg per wheelset, spacing = 1.78 m }
  primary   = { stiffness = 30 MN/m per wheelset, damping = 70 kN s/m per wheelset }
  secondary = { stiffness = 3.75 MN/m per bogie, damping = 10 kN s/m per bogie }
}

train ore {
  vehicles  = wagon
  speed     = 70 km/h
  direction = forward
}

law mild : laws.varandas_2014 {
  form.gamma = 8 mm
}

traffic {
  trains = ore
  total  = 500 axles
}

solve {
  substructure     = law
  law              = mild
  update_every     = geometric(4 axles, 0.2)
  elements_per_bay = 4
  time_step        = 1e-4 s
  finish           = 15 m
}

record forces {
  at         = [-20, -5, -1, +1] sleepers
  after      = [0, 100, 500] axles
  quantities = [rail_seat_load, contact_force]
}

record bed {
  over       = -20 .. -1 sleepers
  quantities = settlement
}

expect {
  that = [
    max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat
    -12 m < place_of_max(settlement) < 0 m
  ]
}

granular stone : ballasts.granite_31_63 {
  grading  = { passing = [22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %], cut_below = 25 mm }
  friction = 0.7
}

soil fill {
  youngs_modulus = 90 MPa, poisson_ratio = 0.3
  density        = 2000 kg/m^3
}
"#;

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
    ("speed     = 70 km/h", "speed     = 70 km / h", Code::E0201, "is `h` a unit? it stands without blanks around `/` and `*`: `km/h`, `kN s/m`"),
    ("speed     = 70 km/h", "velocity  = 70 km/h", Code::E0402, "did you mean `speed`?"),
    ("speed     = 70 km/h", "speed     = \"70 km/h\"", Code::E0406, "write `70 km/h`, without quotes"),
    ("speed     = 70 km/h", "speed     = 60 to 70 km/h", Code::E0105, "write `60 .. 70 km/h`"),
    ("speed     = 70 km/h", "speed     = 60 .. 70 km/h", Code::E0406, "write `ramp(60 .. 70 km/h)`, if it goes from one to the other along the track"),
    ("speed     = 70 km/h", "speed     = 70 m/s^2", Code::E0302, "expected  length x time^-1   [a speed]\nfound     length x time^-2   [an acceleration]"),
    ("spacing = bay", "spacing = 60 cm per sleeper", Code::E0304, "write `60 cm`"),
    ("spacing = bay", "spacing = 0,6 m", Code::E0105, "write `0.6 m`"),
    ("spacing = bay", "spacing = 24 in", Code::E0303, "write mm (1 in = 25.4 mm)"),
    ("spacing = bay", "spacing = 600 mm;", Code::E0105, "write `spacing = 600 mm`"),
    ("spacing = bay", "sleeper_spacing = bay", Code::E0402, "did you mean `spacing`?"),
    ("damping = 5 kN s/m }", "damping = 5 kNs/m }", Code::E0303, "did you mean `kN s/m`?"),
    ("damping = 5 kN s/m }", "damping = 5 kN.s/m }", Code::E0101, "the factors of a unit are parted by a blank: `kN s/m`"),
    ("damping = 5 kN s/m }", "damping = 5 kN s / m }", Code::E0201, "is `m` a unit? it stands without blanks around `/` and `*`: `km/h`, `kN s/m`"),
    ("damping = 5 kN s/m }", "damping = 5 kN m/s }", Code::E0302, "expected  mass x time^-1   [a damping]\nfound     mass x time^-3 x length^2   [a power]"),
    ("damping = 5 kN s/m }", "damping = 5 % }", Code::E0302, "expected  mass x time^-1   [a damping]\nfound     no dimension"),
    ("damping = 5 kN s/m }", "dampening = 5 kN s/m }", Code::E0402, "did you mean `damping`?"),
    ("damping = 5 kN s/m }", "damping = 5 kN s/m", Code::E0104, "add `}`, most likely at the end of line 15"),
    ("pad     = { stiffness = pad_stiffness,", "pad     { stiffness = pad_stiffness,", Code::E0105, "write `pad = { stiffness = pad_stiffness, damping = 5 kN s/m }`"),
    ("pad     = { stiffness = pad_stiffness,", "pad     = { k = pad_stiffness,", Code::E0402, "did you mean `stiffness`?"),
    ("pad     = { stiffness = pad_stiffness,", "pad     = { stiffness: pad_stiffness,", Code::E0105, "write `stiffness = pad_stiffness`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = medium", Code::E0201, "did you mean `pads.medium` of the standard library?"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = usps.medium", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = 40 MN/m", Code::E0406, "name one, such as `pads.ahmadi_2026`, `pads.soft` or `pads.medium`, or write `{ field = value }`"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 mN/m", Code::E0405, "`40 MN/m` would be in range: is the prefix of the unit right?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 Mpa", Code::E0303, "did you mean `MPa`?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 N/mm", Code::E0405, "`40 MN/m` would be in range: is the prefix of the unit right?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MN/m²", Code::E0302, "expected  mass x time^-2   [a stiffness]\nfound     mass x time^-2 x length^-1   [a pressure or modulus]"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MNm^-1", Code::E0303, "did you mean `MN m^-1`?"),
    ("let pad_stiffness = 40 MN/m", "let pad_stiffness = 40*10^6 N/m", Code::E0305, "powers of ten stand in the number: `40e6 N/m`"),
    ("let pad_stiffness = 40 MN/m", "const pad_stiffness = 40 MN/m", Code::E0105, "write `let pad_stiffness = 40 MN/m` to name a value"),
    ("let pad_stiffness = 40 MN/m", "pad_stiffness = 40 MN/m", Code::E0105, "write `let pad_stiffness = 40 MN/m`"),
    ("rails.UIC60 {", "UIC60 {", Code::E0201, "did you mean `rails.UIC60` of the standard library?"),
    ("rails.UIC60 {", "rails.UIC61 {", Code::E0201, "did you mean `rails.UIC60`?"),
    ("bending_stiffness = 6.4 MN m^2", "bending_stiffness = 6.4 MN m2", Code::E0303, "did you mean `MN m^2`?"),
    ("bending_stiffness = 6.4 MN m^2", "EI = 6.4 MN m^2", Code::E0402, "did you mean `bending_stiffness`?"),
    ("bending_stiffness = 6.4 MN m^2", "bending_stiffness = 6.4 kN m^2", Code::E0405, "`6.4 MN m^2` would be in range: is the prefix of the unit right?"),
    ("sleepers.concrete {", "sleepers.B90 {", Code::E0201, "did you mean `sleepers.B70`?"),
    ("mass = 150 kg per seat", "mass = 150 kg per half sleeper", Code::E0101, "behind `per` stands one word: not `half sleeper`, but such as `seat` or `sleeper`"),
    ("mass = 150 kg per seat", "mass = 150 kg/seat", Code::E0303, "write `kg per seat`"),
    ("stiffness = 50 MN/m per seat,", "stiffness = 50 MN/m,", Code::E0304, "write `50 MN/m per seat`, if that is what it is"),
    ("stiffness = 50 MN/m per seat,", "stiffness = 50 MN/m per track,", Code::E0304, "write `50 MN/m per seat`, if that is what it is"),
    ("mass = 150 kg per seat", "mass = 0.15 t per wheel", Code::E0304, "write `0.15 t per sleeper`, if that is what it is"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = (open: 42 m, stiff: 24 m)", Code::E0101, "lists stand in `[ ]`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: 42, stiff: 24]", Code::E0301, "write `[open: 42, stiff: 24] m`"),
    ("sections    = [open: 42 m, stiff: 24 m]", "sections    = [open: 42 m; stiff: 24 m]", Code::E0105, "write `open: 42 m`"),
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
    ("law mild : laws.varandas_2014 {", "law mild extends laws.varandas_2014 {", Code::E0101, "a declaration is `kind name : base { field = value }`"),
    ("form.gamma = 8 mm", "form.gama = 8 mm", Code::E0402, "give the whole of it: `form = ...`"),
    ("at         = [-20, -5, -1, +1] sleepers", "at         = [-20, -5, -1, +1]", Code::E0301, "write `[-20, -5, -1, +1] sleepers` or `[-20, -5, -1, +1] m`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 - -1 sleepers", Code::E0406, "write `-20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = [-20, -1] sleepers", Code::E0406, "write `-20 .. -1 sleepers`"),
    ("over       = -20 .. -1 sleepers", "over       = -20 .. -1", Code::E0301, "write `-20 .. -1 sleepers` or `-20 .. -1 m`"),
    ("over       = -20 .. -1 sleepers", "over       = -12 m .. -1 sleepers", Code::E0305, "a sleeper lies at its number times the spacing: write both ends in one of the two"),
    ("quantities = settlement", "quantities = \"settlement\"", Code::E0406, "write `settlement`, without quotes"),
    ("ramp(0 .. 2 mm, over", "Ramp(0 .. 2 mm, over", Code::E0408, "did you mean `ramp`?"),
    ("poisson_ratio = 0.3", "poissons_ratio = 0.3", Code::E0402, "did you mean `poisson_ratio`?"),
    ("poisson_ratio = 0.3", "nu = 0.3", Code::E0402, "did you mean `poisson_ratio`?"),
    ("youngs_modulus = 90 MPa", "youngs_modulus = 90 MN/m", Code::E0302, "expected  mass x length^-1 x time^-2   [a pressure or modulus]\nfound     mass             x time^-2   [a stiffness]"),
    ("[stone: 350 mm", "[stone: 350", Code::E0301, "write `350 m`, if that is the unit you meant"),
    ("trackform stiff : open {", "trackform stiff = open {", Code::E0105, "write `trackform stiff : open {`"),
    ("track line {", "track line = {", Code::E0105, "write `track line {`, without `=`"),
    ("use std", "import std", Code::E0101, "write `use std`"),
    ("use std", "use stdlib", Code::E0204, "the standard library is called `std`: write `use std`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force, -20 .. -1 sleepers) < 80 kN per seat", Code::E0402, "it takes `over = span`, `from = transition` and `after = axles`"),
    ("max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "contact_force < 80 kN per seat", Code::E0406, "write `max(contact_force)`, or `min`, `mean`, `rms`, `percentile` or `place_of_max` of it"),
    ("primary   = { stiffness = 30 MN/m per wheelset", "primary   = { stiffness = 30 MN/m per axle", Code::E0304, "did you mean `30 MN/m per wheelset`?"),
    ("car_body  = { radius_of_gyration = 3.91 m }", "carbody   = { radius_of_gyration = 3.91 m }", Code::E0402, "did you mean `car_body`?"),
    ("allow = [stiffness_jump: \"this is what the scene is about\"]", "allow = stiffness_jump", Code::E0406, "write `[key: value]`"),
];

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

#[test]
fn a_slip_is_said_once_with_its_way_out() {
    assert!(SLIPS.len() >= 100, "{}", SLIPS.len());
    for (right, typed, code, way_out) in SLIPS {
        assert_eq!(SCENE.matches(right).count(), 1, "`{right}` stands once");
        let compiled = compile("scene.track", &SCENE.replace(right, typed), &NoModules, &[]);
        let [found] = compiled.diagnostics.as_slice() else {
            panic!("`{typed}`: {} diagnostics\n{}", compiled.diagnostics.len(), told(&compiled));
        };
        assert_eq!((found.code, found.help.as_deref()), (*code, Some(*way_out)), "`{typed}`:\n{}", told(&compiled));
        let place = found.labels[0].span;
        let line = SCENE[..SCENE.find(right).unwrap()].matches('\n').count() + 1;
        assert_eq!(compiled.sources.position(place.file, place.start).line, line, "`{typed}`:\n{}", told(&compiled));
    }
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
