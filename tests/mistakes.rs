//! Mistakes planted in a realistic scene: each gives its code at its line and nothing else, alone and together.

use proptest::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use trackbed::check::{Modules, NoModules, Override};
use trackbed::diag::{Code, Diagnostic};
use trackbed::{Compiled, compile};

mod common {
    pub mod scene;
}
use common::scene::SCENE;

struct Planted {
    name: &'static str,
    find: &'static str,
    replace: &'static str,
    code: Code,
    /// Lines from the first line of `find` to the line of the diagnostic.
    below: isize,
    /// What nobody knows any more: `p`laces along the track, the `v`ehicle, the `t`rain, what uses the `b`ay or the
    /// stiffness of the pads, `k`, the trackform with the slab, `f`,
    /// which `c`ar runs at all, which `s`ections there are, the `g`rains and the ground of their layers, the `l`ength
    /// of sleepers, what the b`a`y is, which st`r`etches there are, where they lie and what they set, `x`, what one of
    /// them changes, `y`, what the study asks, `q`, the number of the pads' stiffness, `z`, when the track is tamped,
    /// `m`.
    breaks: &'static str,
    /// What must be known for the mistake to be seen; `*` is everything.
    needs: &'static str,
}

const fn plant(name: &'static str, find: &'static str, replace: &'static str, code: Code) -> Planted {
    Planted { name, find, replace, code, below: 0, breaks: "", needs: "" }
}
const fn below(lines: isize, p: Planted) -> Planted {
    Planted { below: lines, ..p }
}
const fn breaks(what: &'static str, p: Planted) -> Planted {
    Planted { breaks: what, ..p }
}
const fn needs(what: &'static str, p: Planted) -> Planted {
    Planted { needs: what, ..p }
}

#[rustfmt::skip]
const PLANTED: &[Planted] = &[
    // text
    breaks("vt", plant("a sign that is none", "spacing = 1.78 m }", "spacing = 1.78 m @ }", Code::E0101)),
    plant("an empty value", "  rail_ends   = clamped", "  rail_ends   =", Code::E0101),
    breaks("vt", plant("a decimal comma", "radius_of_gyration = 3.91 m", "radius_of_gyration = 3,91 m", Code::E0105)),
    plant("a semicolon", "  total  = 500 axles", "  total  = 500 axles;", Code::E0105),
    plant("a colon for a field", "  speed     = 70 km/h", "  speed     : 70 km/h", Code::E0105),
    plant("an arrow", "sections    = [open: 42 m,", "sections    = [open => 42 m,", Code::E0105),
    plant("a hash comment", "// an embankment", "# an embankment", Code::E0105),
    plant("single quotes", "\"Embankment to slab\"", "'Embankment to slab'", Code::E0105),
    plant("three dots", "over       = -20 .. -1", "over       = -20 ... -1", Code::E0105),
    plant("an open quote", "title = \"Embankment to slab\"", "title = \"Embankment to slab", Code::E0106),
    plant("an open bracket", "transitions = [edge: soft_to_stiff]", "transitions = [edge: soft_to_stiff", Code::E0104),
    // names
    plant("an unknown law", "law              = mild", "law              = mld", Code::E0201),
    breaks("pb", plant("an unknown let", "  spacing = bay", "  spacing = bya", Code::E0201)),
    breaks("f", plant("an unknown library entry", "slabs.half_width_1600", "slabs.half_width_1700", Code::E0201)),
    breaks("ps", plant("an unknown section", "[open: 42 m, stiff: 24 m]", "[opn: 42 m, stiff: 24 m]", Code::E0201)),
    breaks("vtc", plant("an unknown vehicle", "vehicles  = wagon", "vehicles  = wagno", Code::E0201)),
    breaks("vtc", plant("an unknown train", "  trains = ore", "  trains = oer", Code::E0201)),
    breaks("pf", plant("an unknown base", "trackform stiff : open {", "trackform stiff : opne {", Code::E0201)),
    plant("a name twice", "record bed {", "record forces {", Code::E0202),
    breaks("z", needs("k", plant("a name that depends on itself", "let pad_stiffness = 40 MN/m", "let pad_stiffness = 2 * pad_stiffness", Code::E0203))),
    breaks("pf", plant("an extension of itself", "trackform stiff : open {", "trackform stiff : stiff {", Code::E0203)),
    plant("a module of the library that is not there", "let bay", "use std.ballast, let bay", Code::E0204),
    plant("a base of another kind", "law mild : laws.varandas_2014", "law mild : rails.UIC60", Code::E0205),
    plant("a taken name", "record bed {", "record all {", Code::E0207),
    // units
    breaks("l", plant("no unit", "length = 2.4 m }", "length = 2.4 }", Code::E0301)),
    breaks("vt", plant("a speed without unit", "speed     = 70 km/h", "speed     = 70", Code::E0301)),
    plant("zero without unit", "-12 m < place_of_max(settlement) < 0 m", "-12 m < place_of_max(settlement) < 0", Code::E0305),
    breaks("z", needs("k", plant("a force for a stiffness", "let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MN", Code::E0302))),
    needs("b", breaks("pa", plant("a time for a length", "let bay = 0.6 m", "let bay = 0.6 s", Code::E0302))),
    plant("a force for a mass", "mass = 150 kg per seat", "mass = 1.5 kN per seat", Code::E0302),
    breaks("t", plant("sleepers for axles", "  total  = 500 axles", "  total  = 500 sleepers", Code::E0302)),
    plant("an unknown unit", "density = 7800 kg/m^3", "density = 7800 kgs/m^3", Code::E0303),
    breaks("vt", plant("tonnes written out", "axle_load = 20 t", "axle_load = 20 tonnes", Code::E0303)),
    plant("an exponent left out", "bending_stiffness = 6.4 MN m^2", "bending_stiffness = 6.4 MN m2", Code::E0303),
    breaks("vt", plant("no basis", "mass = 800 kg per bogie", "mass = 800 kg", Code::E0304)),
    breaks("vt", plant("a basis of another field", "stiffness = 30 MN/m per wheelset", "stiffness = 30 MN/m per seat", Code::E0304)),
    breaks("vt", plant("a basis where none belongs", "spacing = 6.77 m }", "spacing = 6.77 m per bogie }", Code::E0304)),
    breaks("pb", plant("a sum of unlike values", "  spacing = bay", "  spacing = bay + 3 s", Code::E0305)),
    plant("a comparison of unlike values", "< 80 kN per seat", "< 80 mm", Code::E0305),
    // fields
    plant("an unknown kind", "record bed {", "recrod bed {", Code::E0401),
    plant("an unknown field", "  time_step        = 1e-4 s", "  timestep         = 1e-4 s", Code::E0402),
    breaks("k", plant("a field misspelt that is needed", "pad     = { stiffness = pad_stiffness,", "pad     = { stifness = pad_stiffness,", Code::E0402)),
    breaks("vtc", plant("another field misspelt that is needed", "  vehicles  = wagon", "  vehicle   = wagon", Code::E0402)),
    plant("an unknown argument of a word", "geometric(4 axles, 0.2)", "geometric(4 axles, rate = 0.2)", Code::E0402),
    needs("s", breaks("pb", below(-4, plant("a missing field, inherited", "  spacing = bay", "", Code::E0403)))),
    needs("s", breaks("k", below(-2, plant("a missing part, inherited", "  pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "", Code::E0403)))),
    below(-1, breaks("vtc", plant("a missing list of trains", "  trains = ore", "", Code::E0403))),
    needs("c", breaks("vt", plant("a missing field of an object", "stiffness = 3.75 MN/m per bogie, damping = 10 kN s/m per bogie", "stiffness = 3.75 MN/m per bogie", Code::E0403))),
    plant("a field twice", "elements_per_bay = 4", "elements_per_bay = 4, elements_per_bay = 5", Code::E0404),
    plant("a field and a path into it", "damping = 50 kN s/m per seat }", "damping = 50 kN s/m per seat }, support.stiffness = 40 MN/m per seat", Code::E0404),
    plant("a soft support", "{ stiffness = 50 MN/m per seat, damping = 50", "{ stiffness = 50 kN/m per seat, damping = 50", Code::E0405),
    breaks("vt", plant("a fast train", "speed     = 70 km/h", "speed     = 70 km/s", Code::E0405)),
    plant("a share of an element", "elements_per_bay = 4", "elements_per_bay = 4.5", Code::E0405),
    plant("half an axle", "geometric(4 axles, 0.2)", "geometric(4.5 axles, 0.2)", Code::E0405),
    breaks("z", needs("k", plant("text for a number", "let pad_stiffness = 40 MN/m", "let pad_stiffness = \"40 MN/m\"", Code::E0406))),
    breaks("f", plant("a number for an object", "slab    = slabs.half_width_1600", "slab    = 1200 kg/m", Code::E0406)),
    plant("no comparison", "max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat", "max(contact_force)", Code::E0406),
    below(-1, breaks("vt", needs("vt", plant("masses against the axle load", "car_body  = { radius", "car_body  = { mass = 111 t, radius", Code::E0407)))),
    breaks("vt", needs("vt", plant("bogies in each other", "spacing = 6.77 m }\n  wheelset  = { mass = 1341 kg per wheelset, spacing = 1.78 m }", "spacing = 3 m }\n  wheelset  = { mass = 1341 kg per wheelset, spacing = 3.5 m }", Code::E0407))),
    needs("f", below(2, plant("a slab and sleepers", "  sleeper = none\n", "  \n", Code::E0407))),
    breaks("vt", plant("an unknown word", "direction = forward", "direction = forwards", Code::E0408)),
    plant("an unknown response", "rail_seat_load, contact_force]", "rail_seat_force, contact_force]", Code::E0408),
    plant("an unknown rule", "allow = [stiffness_jump:", "allow = [stiffness_jumps:", Code::E0408),
    needs("*", plant("cells that are tamped", "substructure     = law", "substructure     = cells", Code::E0604)),
    needs("pl", plant("a narrow bed", "rail_ends   = clamped", "bed_width   = 2 m per track", Code::E0420)),
    plant("a profile without basis", "support = { stiffness = 50 MN/m per seat,", "support = { stiffness = ramp(50 .. 80 MN/m),", Code::E0304),
    breaks("b", needs("p", plant("a gap in the spacing", "  spacing = bay", "  spacing = [-20 m: 0.6 m, 24 m: 0.6 m]", Code::E0506))),
    // what varies along the track
    breaks("l", plant("a profile where none can be", "length = 2.4 m }", "length = ramp(2.4 .. 2.6 m) }", Code::E0406)),
    plant("a misspelt profile", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = rmap(0 .. 2 mm)", Code::E0408),
    plant("an unknown argument of a profile", "settlement = ramp(0 .. 2 mm, over", "settlement = ramp(0 .. 2 mm, along", Code::E0402),
    plant("a profile of something else", "settlement = ramp(0 .. 2 mm,", "settlement = ramp(0 .. 2 kN,", Code::E0302),
    plant("one end of a profile", "settlement = ramp(0 .. 2 mm,", "settlement = ramp(2 mm,", Code::E0406),
    plant("a random profile without its mean", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(cov = 10 %)", Code::E0403),
    plant("a random profile of something else", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 kN)", Code::E0302),
    plant("a scatter of something else", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, sd = 1 kN)", Code::E0302),
    plant("a scatter said twice", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, 20 %, sd = 1 mm)", Code::E0407),
    plant("a scatter given twice", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, sd = 1 mm, sd = 2 mm)", Code::E0404),
    plant("a scatter below zero", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, sd = -1 mm)", Code::E0405),
    plant("a share of nothing", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(0 mm, cov = 20 %)", Code::E0405),
    plant("a positive value that is not", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(-1 mm, distribution = log_normal)", Code::E0405),
    plant("an unknown distribution", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, distribution = log_norml)", Code::E0408),
    plant("an unknown argument of a random profile", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, spread = 2 mm)", Code::E0402),
    plant("a correlation without its unit", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(2 mm, correlation = 3)", Code::E0301),
    needs("p", plant("random values out of range", "settlement = ramp(0 .. 2 mm, over = -6 .. 0 m)", "settlement = random(0 mm, sd = 60 mm)", Code::E0605)),
    plant("a value that is out of range somewhere", "settlement = ramp(0 .. 2 mm,", "settlement = ramp(0 .. 200 mm,", Code::E0405),
    needs("p", plant("a profile off the track", "over = -6 .. 0 m)", "over = -60 .. 0 m)", Code::E0501)),
    plant("a profile the wrong way round", "over = -6 .. 0 m)", "over = 0 .. -6 m)", Code::E0505),
    needs("p", plant("a profile at one place", "over = -6 .. 0 m)", "over = -6 .. -6 m)", Code::E0505)),
    needs("p", plant("a gap in a profile", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 .. -6 m: 0 mm, -5 .. 0 m: 2 mm]", Code::E0506)),
    needs("p", plant("a profile that ends early", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 m: 0 mm, -6 m: 2 mm]", Code::E0506)),
    needs("p", plant("an overlap in a profile", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 .. -5 m: 0 mm, -6 .. 0 m: 2 mm]", Code::E0507)),
    needs("p", plant("places out of order", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 m: 0 mm, -2 m: 1 mm, -6 m: 2 mm, 0 m: 0 mm]", Code::E0507)),
    needs("p", plant("a place twice", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 m: 0 mm, -6 m: 1 mm, -6 m: 2 mm, 0 m: 0 mm]", Code::E0507)),
    plant("a place among spans", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 .. -6 m: 0 mm, 0 m: 2 mm]", Code::E0406),
    plant("a value without its place", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "[-42 m: 0 mm, 2 mm]", Code::E0406),
    plant("a data file that is not there", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "file(\"settled.csv\")", Code::E0508),
    plant("a data file outside the folder", "ramp(0 .. 2 mm, over = -6 .. 0 m)", "file(\"../settled.csv\")", Code::E0508),
    breaks("vt", plant("a train that stands", "speed     = 70 km/h", "speed     = [-42 m: 70, 24 m: 0] km/h", Code::E0405)),
    needs("pc", breaks("vt", plant("a speed that does not cover", "speed     = 70 km/h", "speed     = [-42 m: 70, 20 m: 60] km/h", Code::E0506))),
    // parts that contradict each other
    needs("f", below(-8, plant("an under sleeper pad under a slab", "  usp     = none", "", Code::E0407))),
    needs("f", below(-8, plant("a slab that has settled", "  settlement = 0 mm", "", Code::E0407))),
    needs("p", plant("a support that seats itself stiffly", "damping = 50 kN s/m per seat }", "damping = 50 kN s/m per seat, seating = { stiffness = 60 MN/m per seat, closure = 0.4 mm } }", Code::E0407)),
    needs("p", plant("a base larger than its sleeper", "length = 2.4 m }", "length = 2.4 m, base_area = 1.2 m^2 }", Code::E0407)),
    plant("a thick bed of pads", "usps.stiff { damping_time", "usps.stiff { bedding_modulus = 3 N/mm^3, damping_time", Code::E0405),
    // layers and their materials
    breaks("g", needs("s", plant("sieves out of order", "40 mm: 60 %, 63 mm", "40 mm: 60 %, 35 mm", Code::E0414))),
    breaks("g", needs("s", plant("a curve that falls", "40 mm: 60 %, 63 mm", "40 mm: 60 %, 50 mm: 40 %, 63 mm", Code::E0414))),
    breaks("g", needs("s", plant("a curve that ends early", "63 mm: 100 %", "63 mm: 98 %", Code::E0414))),
    breaks("g", needs("s", plant("a curve that begins late", "[22.4 mm: 0 %,", "[28 mm: 10 %,", Code::E0414))),
    breaks("g", needs("s", plant("one sieve", "[22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %]", "[63 mm: 100 %]", Code::E0414))),
    breaks("g", needs("s", plant("a cut that leaves nothing", "cut_below = 25 mm", "cut_below = 70 mm", Code::E0415))),
    breaks("g", needs("s", plant("a log-normal curve without ends", "[22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %]", "log_normal(40 mm, 0.3)", Code::E0415))),
    breaks("g", needs("s", plant("a cut that leaves little", "cut_below = 25 mm", "cut_below = 55 mm", Code::E0416))),
    breaks("g", plant("a sieve without its share", "40 mm: 60 %,", "40 mm,", Code::E0406)),
    breaks("g", plant("more than everything", "40 mm: 60 %,", "40 mm: 160 %,", Code::E0405)),
    breaks("g", needs("s", plant("a data file of sieves that is not there", "[22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %]", "file(\"sieves.csv\")", Code::E0508))),
    breaks("g", needs("s", plant("a surface that is not there", "  friction = 0.7", "  friction = 0.7, shape = clumps(from = file(\"stone.stl\"))", Code::E0508))),
    breaks("g", needs("s", plant("two forms of one grain", "  friction = 0.7", "  friction = 0.7, shape = clumps(from = worn, flatness = 0.5)", Code::E0407))),
    breaks("g", needs("s", plant("a surface that the library does not have", "  friction = 0.7", "  friction = 0.7, shape = clumps(from = [flat, wron])", Code::E0408))),
    breaks("g", needs("s", plant("a grain like a sheet of paper", "  friction = 0.7", "  friction = 0.7, shape = clumps(flatness = 0.05)", Code::E0405))),
    breaks("g", needs("s", plant("part of a pebble", "  friction = 0.7", "  friction = 0.7, shape = clumps(2 .. 3.5)", Code::E0405))),
    breaks("g", plant("a stiffness of nobody knows what", "  friction = 0.7", "  friction = 0.7, contact_stiffness = 13 MN/m", Code::E0304)),
    breaks("sg", plant("a layer of nothing known", "[stone: 350 mm", "[stoen: 350 mm", Code::E0201)),
    breaks("sg", plant("a layer of something else", "[stone: 350 mm", "[wagon: 350 mm", Code::E0406)),
    breaks("sg", plant("a thickness without unit", "[stone: 350 mm", "[stone: 350", Code::E0301)),
    breaks("sg", plant("a layer without thickness", "[stone: 350 mm", "[stone", Code::E0406)),
    breaks("g", needs("s", plant("what is left of nothing", "fill: 1 m]", "fill: rest]", Code::E0421))),
    needs("psg", plant("a layer of single grains", "[stone: 350 mm", "[stone: 100 mm", Code::E0511)),
    breaks("g", needs("psg", plant("a layer that ends early", "fill: 1 m]", "fill: [-42 m: 1 m, -6 m: 2 m]]", Code::E0506))),
    breaks("g", plant("a soil that grows when it is pulled", "poisson_ratio = 0.3", "poisson_ratio = 0.6", Code::E0405)),
    breaks("g", needs("s", plant("moduli that contradict each other", "youngs_modulus = 90 MPa, poisson_ratio = 0.3", "bulk_modulus = 10 MPa, shear_modulus = 90 MPa", Code::E0407))),
    breaks("g", needs("s", plant("a modulus said twice", "poisson_ratio = 0.3", "poisson_ratio = 0.3, bulk_modulus = 100 MPa, shear_modulus = 34.6 MPa", Code::E0407))),
    breaks("g", needs("s", plant("a soil that makes energy", "= 2000 kg/m^3", "= 2000 kg/m^3, strength = mohr_coulomb(10 kPa, 30 deg, dilation = 35 deg)", Code::E0407))),
    breaks("g", needs("s", below(-2, plant("a missing density", "  density        = 2000 kg/m^3", "", Code::E0403)))),
    needs("p", plant("a window off the track", "elements_per_bay = 4", "window           = -80 .. 6 m", Code::E0501)),
    // stretches
    breaks("r", plant("a stretch of nothing known", "stretches = [firm, low, wedge]", "stretches = [firm, lwo, wedge]", Code::E0201)),
    breaks("r", plant("a stretch that is none", "stretches = [firm, low, wedge]", "stretches = [firm, wagon, wedge]", Code::E0406)),
    breaks("x", below(-1, plant("a stretch without a place", "  over          = -20 .. -1 sleepers", "", Code::E0403))),
    breaks("x", plant("a stretch the wrong way round", "over    = -10 .. -5 sleepers", "over    = -5 .. -10 sleepers", Code::E0505)),
    breaks("x", needs("pr", plant("a stretch off the track", "over    = -10 .. -5 sleepers", "over    = -100 .. -5 sleepers", Code::E0501))),
    breaks("y", needs("pfkrxz", plant("a stretch that reaches over the slab", "over          = -20 .. -1 sleepers", "over          = -20 .. +5 sleepers, settlement = 1 mm", Code::E0418))),
    breaks("x", needs("pr", plant("a stretch from nowhere", "over    = -10 .. -5 sleepers", "over    = -10 .. -5 sleepers, from = west", Code::E0504))),
    needs("py", below(-2, plant("a stretch that changes nothing", "  pad.stiffness = ramp(60 .. 80 MN/m)", "", Code::E0417))),
    breaks("x", needs("prx", below(5, plant("two stretches that set the same", "  pad.stiffness = ramp(60", "  support.stiffness = 40 MN/m per seat, pad.stiffness = ramp(60", Code::E0512)))),
    breaks("x", needs("prx", below(3, plant("two stretches that set the same in two ways", "ramp(60 .. 80 MN/m)\n}\n\nstretch low {\n", "ramp(60 .. 80 MN/m), pad.damping = 5 kN s/m\n}\n\nstretch low { pad.damping_time = 0.1 ms\n", Code::E0512)))),
    breaks("x", needs("psbr", plant("another rail in a stretch", "over    = -10 .. -5 sleepers", "over    = -10 .. -5 sleepers, rail = rails.S49", Code::E0411))),
    breaks("x", plant("a field of something else", "over    = -10 .. -5 sleepers", "over    = -10 .. -5 sleepers, speed = 60 km/h", Code::E0402)),
    plant("a pad of a force", "ramp(60 .. 80 MN/m)", "ramp(60 .. 80 MN)", Code::E0302),
    plant("a pad that is too stiff somewhere", "ramp(60 .. 80 MN/m)", "ramp(60 .. 8000 MN/m)", Code::E0405),
    plant("a support of nobody knows what", "stiffness = 45 MN/m per seat,", "stiffness = 45 MN/m,", Code::E0304),
    plant("a support's field misspelt", "damping_time = 1 ms }", "dampingtime = 1 ms }", Code::E0402),
    needs("*", plant("a damping said twice", "damping_time = 1 ms }", "damping_time = 1 ms, damping = 30 kN s/m per seat }", Code::E0407)),
    // studies
    breaks("q", plant("a path from nowhere", "    low.support.stiffness: steps", "    lwo.support.stiffness: steps", Code::E0704)),
    breaks("q", plant("a path that leads nowhere", "    low.support.stiffness: steps", "    low.support.stifness: steps", Code::E0704)),
    breaks("q", plant("a path into the library", "    low.support.stiffness: steps(30 .. 60 MN/m per seat, by = 10 MN/m per seat)", "    pads.medium.stiffness: [30, 60] MN/m", Code::E0704)),
    needs("a", breaks("q", plant("values of something else", "    bay: [0.55, 0.6, 0.65] m", "    bay: [0.55, 0.6, 0.65] kN", Code::E0302))),
    needs("a", breaks("q", plant("values without unit", "    bay: [0.55, 0.6, 0.65] m", "    bay: [0.55, 0.6, 0.65]", Code::E0301))),
    breaks("q", plant("values without basis", "steps(30 .. 60 MN/m per seat, by = 10 MN/m per seat)", "[30, 60] MN/m", Code::E0304)),
    breaks("q", plant("steps that miss the end", "by = 10 MN/m per seat)", "by = 20 MN/m per seat)", Code::E0706)),
    needs("q", plant("a range in a grid", "    bay: [0.55, 0.6, 0.65] m", "    bay: 0.55 .. 0.65 m", Code::E0706)),
    needs("q", plant("a value varied and set", "set        = [ore.speed: 60 km/h]", "set        = [bay: 0.6 m]", Code::E0707)),
    needs("q", plant("a value varied twice", "set        = [ore.speed: 60 km/h]", "set        = [low.support: { stiffness = 40 MN/m per seat }]", Code::E0707)),
    breaks("q", plant("an unknown sampling", "  minimise   = max(settlement)", "  minimise   = max(settlement), sampling = soboll(16)", Code::E0408)),
    plant("a study of an unknown response", "  minimise   = max(settlement)", "  minimise   = max(setlement)", Code::E0408),
    plant("a goal that is no number", "  minimise   = max(settlement)", "  minimise   = settlement", Code::E0406),
    plant("a limit of something else", "max(wheel_force) < 200 kN per wheel", "max(wheel_force) < 200 mm", Code::E0305),
    plant("a limit that is none", "subject_to = max(wheel_force) < 200 kN per wheel", "subject_to = max(wheel_force)", Code::E0406),
    below(-6, plant("a goal that is missing", "  minimise   = max(settlement)\n  report     = [far_field_settlement, mean(contact_force, over = -20 .. -1 sleepers)]\n", "\n\n", Code::E0403)),
    // tamping, trains, layers of stretches
    needs("tm", plant("tamping in the middle of a train", "  after = 200 axles", "  after = 202 axles", Code::E0602)),
    needs("tm", plant("tamping after the end", "  after = 200 axles", "  after = 600 axles", Code::E0602)),
    plant("tamping after sleepers", "  after = 200 axles", "  after = 200 sleepers", Code::E0302),
    needs("pm", plant("tamping off the track", "  over  = -20 .. -1 sleepers", "  over  = -200 .. -1 sleepers", Code::E0501)),
    plant("more left than there was", "  left  = 10 %", "  left  = 110 %", Code::E0405),
    breaks("m", plant("tamping of another kind", "tamping levelling {", "tmaping levelling {", Code::E0401)),
    breaks("t", plant("half of the traffic", "  trains = ore", "  trains = [ore: 50 %]", Code::E0407)),
    breaks("t", plant("a train twice", "  trains = ore", "  trains = [ore: 50 %, ore: 50 %]", Code::E0404)),
    needs("*", plant("two layers of what is left", "treated: ramp(0.2 .. 0.6 m), fill: rest]", "treated: rest, fill: rest]", Code::E0423)),
    needs("*", plant("a stretch of nothing left", "treated: ramp(0.2 .. 0.6 m), fill: rest]", "treated: ramp(0.2 .. 1.6 m), fill: rest]", Code::E0423)),
    needs("*", plant("a stretch of another depth", "treated: ramp(0.2 .. 0.6 m), fill: rest]", "treated: ramp(0.2 .. 0.6 m), fill: 1 m]", Code::E0424)),
    plant("a layer of a stretch of nothing known", "treated: ramp(0.2 .. 0.6 m), fill: rest]", "treatde: ramp(0.2 .. 0.6 m), fill: rest]", Code::E0201),
    breaks("x", plant("an approach slab without a modulus", "  over   = -12 .. 0 m", "  over   = -12 .. 0 m, approach_slab = { thickness = 0.3 m, density = 2500 kg/m^3, depth = 0.5 m }", Code::E0403)),
    breaks("x", needs("psb", plant("an approach slab that hangs nowhere", "  over   = -12 .. 0 m", "  over   = -12 .. -6 m, approach_slab = { thickness = 0.3 m, youngs_modulus = 34 GPa, density = 2500 kg/m^3, depth = 0.5 m }", Code::E0425))),
    needs("*", plant("an approach slab in the air", "  over   = -12 .. 0 m", "  over   = -12 .. 0 m, approach_slab = { thickness = 0.3 m, youngs_modulus = 34 GPa, density = 2500 kg/m^3, depth = 1.2 m }", Code::E0426)),
    // places
    needs("p", plant("sleeper 0", "[-20, -5, -1, +1] sleepers", "[-20, -5, -1, 0] sleepers", Code::E0501)),
    needs("p", plant("a sleeper off the track", "[-20, -5, -1, +1] sleepers", "[-200, -5, -1, +1] sleepers", Code::E0501)),
    needs("p", plant("an end off the track", "finish           = 15 m", "finish           = 25 m", Code::E0501)),
    needs("p", breaks("p", plant("part of a sleeper", "stiff: 24 m]", "stiff: 24.5 sleepers]", Code::E0502))),
    needs("p", breaks("p", plant("two names for one boundary", "[edge: soft_to_stiff]", "[edge: soft_to_stiff, end: stiff_to_soft]", Code::E0504))),
    plant("a span the wrong way round", "over       = -20 .. -1 sleepers", "over       = -1 .. -20 sleepers", Code::E0505),
    needs("p", plant("a transition that is not there", "at         = [-20,", "from = west, at = [-20,", Code::E0504)),
    // the run
    needs("t", plant("a record in the middle of a train", "after      = [0, 100, 500]", "after      = [0, 102, 500]", Code::E0602)),
    needs("t", plant("a record after the end", "after      = [0, 100, 500]", "after      = [0, 100, 600]", Code::E0602)),
    needs("*", plant("part of a train", "geometric(4 axles, 0.2)", "geometric(6 axles, 0.2)", Code::E0602)),
    needs("*", plant("a coarse step", "time_step        = 1e-4 s", "time_step        = 8 ms", Code::E0603)),
    needs("*", plant("no way to run", "finish           = 15 m", "finish           = -27 m", Code::E0503)),
];

fn line_of(text: &str, offset: usize) -> usize {
    text[..offset].matches('\n').count() + 1
}

impl Planted {
    fn offset(&self) -> usize {
        assert_eq!(SCENE.matches(self.find).count(), 1, "{}: `{}` stands once", self.name, self.find);
        SCENE.find(self.find).unwrap()
    }

    fn line(&self) -> usize {
        line_of(SCENE, self.offset()).saturating_add_signed(self.below)
    }

    fn touched(&self) -> std::ops::RangeInclusive<usize> {
        let (offset, lines) = (self.offset(), self.find.matches('\n').count());
        line_of(SCENE, offset)..=line_of(SCENE, offset) + lines
    }

    /// Whether both can be seen in one text.
    fn goes_with(&self, other: &Planted) -> bool {
        let hides = |a: &Planted, b: &Planted| b.needs.contains('*') || a.breaks.chars().any(|c| b.needs.contains(c));
        let apart = self.touched().end() < other.touched().start() || other.touched().end() < self.touched().start();
        apart && self.line() != other.line() && !hides(self, other) && !hides(other, self)
    }
}

fn planted(mistakes: &[&Planted]) -> String {
    let mut text = SCENE.to_string();
    for mistake in mistakes {
        text = text.replacen(mistake.find, mistake.replace, 1);
    }
    text
}

fn compiled(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

fn line(compiled: &Compiled, diagnostic: &Diagnostic) -> usize {
    let span = diagnostic.labels.first().map(|l| l.span);
    span.map_or(0, |span| compiled.sources.position(span.file, span.start).line)
}

/// Code and line of every diagnostic.
fn found(compiled: &Compiled) -> Vec<(Code, usize)> {
    let mut found: Vec<_> = compiled.diagnostics.iter().map(|d| (d.code, line(compiled, d))).collect();
    found.sort_by_key(|(code, line)| (*line, *code));
    found
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

#[test]
fn the_scene_has_no_mistake() {
    let compiled = compiled(SCENE);
    assert!(compiled.diagnostics.is_empty(), "{}", told(&compiled));
    assert!(compiled.graph.is_some());
}

#[test]
fn a_single_mistake_gives_its_code_at_its_line_and_nothing_else() {
    let mut wrong = String::new();
    for mistake in PLANTED {
        let compiled = compiled(&planted(&[mistake]));
        let expected = vec![(mistake.code, mistake.line())];
        if found(&compiled) != expected {
            wrong.push_str(&format!("## {}: expected {expected:?}\n{}\n", mistake.name, told(&compiled)));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Of a choice of mistakes those that can be seen in one text.
fn together(choice: Vec<prop::sample::Index>) -> Vec<&'static Planted> {
    let mut chosen: Vec<&Planted> = Vec::new();
    for index in choice {
        let mistake = index.get(PLANTED);
        let alone = mistake.needs == "*";
        if chosen.iter().all(|other| mistake.goes_with(other)) && (!alone || chosen.is_empty()) {
            chosen.push(mistake);
        }
    }
    chosen
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn so_many_mistakes_so_many_diagnostics(choice in prop::collection::vec(any::<prop::sample::Index>(), 1..=6)) {
        let chosen = together(choice);
        let compiled = compiled(&planted(&chosen));
        let mut expected: Vec<_> = chosen.iter().map(|m| (m.code, m.line())).collect();
        expected.sort_by_key(|(code, line)| (*line, *code));
        prop_assert_eq!(found(&compiled), expected, "{:?}\n{}", chosen.iter().map(|m| m.name).collect::<Vec<_>>(), told(&compiled));
    }

    #[test]
    fn token_soup_is_refused_without_panic(parts in prop::collection::vec(0..SOUP.len(), 0..60)) {
        let text: Vec<&str> = parts.into_iter().map(|i| SOUP[i]).collect();
        compiled(&text.join(" "));
    }

    #[test]
    fn mutated_scenes_are_read_without_panic(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..SOUP.len()), 1..8),
    ) {
        let mut text: Vec<char> = SCENE.chars().collect();
        for (from, length, part) in cuts {
            let from = from.index(text.len());
            let length = length.index(20).min(text.len() - from);
            text.splice(from..from + length, SOUP[part].chars());
        }
        compiled(&text.into_iter().collect::<String>());
    }
}

const SOUP: &[&str] = &[
    "use",
    "std",
    "let",
    "as",
    "per",
    "track",
    "solve",
    "expect",
    "vehicle",
    "open",
    "wagon",
    "none",
    "?",
    "{",
    "}",
    "[",
    "]",
    "(",
    ")",
    "=",
    ":",
    "..",
    "<",
    ">=",
    "+",
    "-",
    "*",
    "/",
    "^",
    ",",
    "\n",
    "\n\n",
    ".",
    "1",
    "-3",
    "1e300",
    "0",
    "40 MN/m",
    "0.6 m",
    "m",
    "sleepers",
    "per seat",
    "\"text\"",
    "\"",
    "//",
    "µ",
    "²",
    "–",
    "\0",
    "line.sections",
    "max",
    "settlement",
    "geometric(",
    "ramp(1 .. 2)",
    "smooth(0 .. 1 mm, over = -6 .. 0 m)",
    "file(\"a.csv\")",
    "[-6 m: 1 mm, 0 m: 2 mm]",
    "irregularity = ",
    "x = ",
    "load jack { on = rail, at = 1 m, force = 1 kN per rail }",
    "track t { sections = [open: 1e9 m] }",
    "let a = a",
    "pad p : p {}",
    "mass = ",
    "1e999",
    "%",
    "expect { that = 1 < 2 }",
];

#[test]
fn six_mistakes_give_six_diagnostics_at_their_lines() {
    let names = [
        "a force for a mass",
        "no basis",
        "an unknown law",
        "a span the wrong way round",
        "an unknown field",
        "an unknown library entry",
    ];
    let chosen: Vec<&Planted> = names.iter().map(|n| PLANTED.iter().find(|p| p.name == *n).unwrap()).collect();
    let compiled = compiled(&planted(&chosen));
    assert_eq!(
        found(&compiled),
        [
            (Code::E0302, 16),
            (Code::E0201, 26),
            (Code::E0304, 40),
            (Code::E0201, 63),
            (Code::E0402, 66),
            (Code::E0505, 77),
        ],
        "{}",
        told(&compiled)
    );
}

/// Modules in memory, by their file names.
struct Files(BTreeMap<&'static str, Vec<u8>>);

impl Modules for Files {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative.to_str()?).cloned()
    }
}

fn codes(text: &str) -> Vec<Code> {
    compiled(text).diagnostics.iter().map(|d| d.code).collect()
}

#[test]
fn a_file_that_says_nothing_is_told_so() {
    for text in ["", "\n\n", "// only a comment\n", "   \t "] {
        assert_eq!(codes(text), [Code::E0601], "{text:?}");
    }
    assert_eq!(codes("use std\n"), []);
}

/// Nobody waits for so many passages, and no plan lists them.
#[test]
fn a_run_of_too_many_blocks_is_refused_at_once() {
    let long = SCENE.replace("total  = 500 axles", "total  = 1_000_000_000 axles");
    for trains in ["ore", "[ore: 60 %, empty: 40 %]"] {
        let text =
            long.replace("trains = ore", &format!("trains = {trains}")) + "\ntrain empty : ore { speed = 60 km/h }\n";
        let text = text.replace("geometric(4 axles, 0.2)", "4 axles");
        let refused = compiled(&text);
        let limit: Vec<_> = refused.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
        assert_eq!(limit, [Code::E0103], "{}", told(&refused));
    }
}

#[test]
fn deep_nesting_is_refused() {
    for open in ["{ a = ", "[", "(", "f("] {
        let text = format!("let x = {}", open.repeat(10_000));
        assert!(codes(&text).contains(&Code::E0103), "{open}");
    }
    assert!(codes(&format!("let x = {}1", "-".repeat(100_000))).iter().any(|c| *c == Code::E0103 || *c == Code::E0101));
}

#[test]
fn long_chains_of_names_are_followed_or_refused() {
    // forwards each is known when it is needed, backwards none is
    let chain = |order: &mut dyn Iterator<Item = usize>| {
        let lets: String = order.map(|i| format!("let a{} = 1 * a{i}\n", i + 1)).collect();
        format!("let a0 = 0.6 m\n{lets}trackform f {{ spacing = a5000 }}\n")
    };
    assert!(codes(&chain(&mut (0..5000).rev())).contains(&Code::E0103));
    assert!(codes(&chain(&mut (0..5000))).contains(&Code::E0103));
    let pads: String = (0..5000).rev().map(|i| format!("pad p{} : p{i} {{}}\n", i + 1)).collect();
    assert!(codes(&format!("{pads}pad p0 {{ stiffness = 40 MN/m }}\n")).contains(&Code::E0103));
    let short: String = (0..50).map(|i| format!("let a{} = 1 * a{i}\n", i + 1)).collect();
    assert_eq!(codes(&format!("let a0 = 0.6 m\n{short}trackform f {{ spacing = a50 }}\n")), []);
}

#[test]
fn names_that_double_at_every_step_take_no_time() {
    let lets: String = (0..60).map(|i| format!("let a{} = a{i} + a{i}\n", i + 1)).collect();
    codes(&format!("let a0 = 1e-12 m\n{lets}trackform f {{ spacing = a60 }}\n"));
    let lets: String = (0..40).map(|i| format!("let e{} = e{i} + e{i}\n", i + 1)).collect();
    let text = format!("let e0 = max(settlement)\n{lets}expect {{ that = e40 < 1 mm }}\n");
    assert_eq!(codes(&text), [Code::E0103]);
}

#[test]
fn circles_are_reported_once_and_printed() {
    let circle =
        compiled("let a = b\nlet b = c\nlet c = a\ntrackform f { spacing = a }\ntrackform g { spacing = b }\n");
    assert_eq!(found(&circle), [(Code::E0203, 3)], "{}", told(&circle));
    assert!(circle.diagnostics[0].help.as_ref().unwrap().contains("a -> b -> c -> a"));
    let pads = compiled("pad a : b {}\npad b : a { stiffness = 40 MN/m }\n");
    assert_eq!(pads.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [Code::E0203], "{}", told(&pads));
    let values = compiled("pad a { stiffness = b.stiffness }\npad b { stiffness = 2 * a.stiffness }\n");
    assert_eq!(values.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [Code::E0203], "{}", told(&values));
}

#[test]
fn modules_that_use_each_other_are_reported_once() {
    let files = Files(BTreeMap::from([
        ("a.track", b"use b\npad soft { stiffness = 40 MN/m }\n".to_vec()),
        ("b.track", b"use c\npad hard { stiffness = 400 MN/m }\n".to_vec()),
        ("c.track", b"use a\npad soft : a.soft {}\n".to_vec()),
        ("scene.track", b"use scene\n".to_vec()),
    ]));
    let circle = compile("folder/main.track", "use a\npad mine : a.soft { damping = 1 kN s/m }\n", &files, &[]);
    assert_eq!(circle.diagnostics.len(), 1, "{}", told(&circle));
    assert_eq!(circle.diagnostics[0].code, Code::E0206);
    assert!(circle.diagnostics[0].help.as_ref().unwrap().contains("a.track -> b.track -> c.track -> a.track"));
    let itself = compile("folder/scene.track", "use scene\n", &files, &[]);
    assert_eq!(itself.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [Code::E0206], "{}", told(&itself));
}

#[test]
fn a_module_that_is_not_there_hides_what_is_named_in_it() {
    let missing =
        compiled("use site.base\nuse std.pad\npad a : base.soft {}\npad b : pad.soft { stiffness = base.k }\n");
    assert_eq!(found(&missing), [(Code::E0204, 1), (Code::E0204, 2)], "{}", told(&missing));
}

#[test]
fn a_module_that_is_not_text_is_told_at_its_use() {
    let files = Files(BTreeMap::from([("site.track", b"pad a { stiffness = 40 \xFF }".to_vec())]));
    let compiled = compile("main.track", "\nuse site\npad b : site.a {}\n", &files, &[]);
    assert_eq!(found(&compiled), [(Code::E0102, 2)], "{}", told(&compiled));
    for bytes in [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..], b"\xFF\xFEu\0s\0e\0", b"pad a\0 {}"] {
        assert_eq!(trackbed::syntax::decode("scene.track", bytes).unwrap_err().code, Code::E0102);
    }
}

#[test]
fn the_wagon_as_printed_is_refused() {
    // Ahmadi et al. (2026), Table 3, with the axle load of the text
    let text = SCENE.replace("{ radius_of_gyration = 3.91 m }", "{ mass = 111 t, pitch_inertia = 1.7e6 kg m^2 }");
    let refused = compiled(&text);
    assert_eq!(found(&refused), [(Code::E0407, 38)], "{}", told(&refused));
    let diagnostic = &refused.diagnostics[0];
    assert!(diagnostic.message.contains("29.5 t") && diagnostic.message.contains("20 t"), "{}", diagnostic.message);
    assert!(diagnostic.help.as_ref().unwrap().contains("73.04 t"));
    assert_eq!(diagnostic.labels.len(), 2);
}

fn set(overrides: &[&str]) -> Compiled {
    let overrides: Vec<Override> = overrides.iter().map(|o| Override::parse(o).unwrap()).collect();
    compile("scene.track", SCENE, &NoModules, &overrides)
}

#[test]
fn overrides_act_as_if_the_line_had_been_edited() {
    let pad = |c: &Compiled, seat: usize| {
        c.scenario.as_ref().unwrap().track.seats[seat].pad.as_ref().unwrap().stiffness.value
    };
    let total = |c: &Compiled| match &c.scenario.as_ref().unwrap().loading {
        Some(trackbed::scenario::Loading::Traffic(t)) => t.total.value,
        _ => 0,
    };
    assert_eq!(total(&set(&["traffic.total=600 axles"])), 600, "a literal");
    assert_eq!(pad(&set(&["open.pad.stiffness=60 MN/m"]), 0), 60e6, "inside an object");
    let only_stiff = set(&["stiff.pad.stiffness = 60 MN/m"]);
    let last = only_stiff.scenario.as_ref().unwrap().track.seats.len() - 1;
    assert_eq!((pad(&only_stiff, 0), pad(&only_stiff, last)), (40e6, 60e6), "inside what is inherited");
    assert_eq!(pad(&set(&["pad_stiffness=50 MN/m"]), 0), 50e6, "a let");
    let slab = set(&["stiff.slab.mass=1300 kg/m per rail"]);
    let section = &slab.scenario.as_ref().unwrap().track.sections[1];
    assert_eq!(section.slab.as_ref().unwrap().mass.value, 1300.0, "inside a library entry");
    for path in ["mild.form.gamma=6 mm", "mild.form.beta=0.9"] {
        assert!(set(&[path]).diagnostics.is_empty(), "an argument by its name: {}", told(&set(&[path])));
    }
    let first = set(&["solve.update_every.first=8 axles"]);
    assert!(first.diagnostics.is_empty(), "an argument by its place: {}", told(&first));
    let update = first.scenario.unwrap().solve.update;
    assert_eq!(update, trackbed::scenario::Update::Geometric { first: 8, ratio: 0.2 });
    let longer = set(&["line.sections.open=48 m"]);
    assert_eq!(longer.scenario.unwrap().track.sections[0].start, -48.0, "a pair by its key");
    let two = set(&["traffic.total=600 axles", "traffic.total=700 axles"]);
    assert_eq!(total(&two), 700, "the last one counts");
}

#[test]
fn wrong_overrides_get_their_codes() {
    for (path, code) in [
        ("opne.spacing=0.5 m", Code::E0201),
        ("spacing=0.5 m", Code::E0201),
        ("rails.UIC60.mass=60 kg/m", Code::E0201),
        ("open.colour=3", Code::E0402),
        ("open.pad.hardness=3", Code::E0402),
        ("open.spacing=600", Code::E0301),
        ("open.spacing=600 kg", Code::E0302),
        ("open.spacing=600 mmm", Code::E0303),
        ("open.spacing=6 m", Code::E0405),
        ("open.spacing=0.6 m, let y = 3", Code::E0101),
        ("open.spacing=0.6 m, x = 3", Code::E0105),
        ("open.spacing=0.6 m\nlet y = 3", Code::E0101),
        ("solve.substructure=lwa", Code::E0408),
        ("solve.update_every.second=8 axles", Code::E0402),
        ("traffic.total=501 axles", Code::E0602),
    ] {
        let compiled = set(&[path]);
        assert_eq!(
            compiled.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(),
            [code],
            "{path}\n{}",
            told(&compiled)
        );
        let label = &compiled.diagnostics[0].labels[0];
        assert_eq!(compiled.sources.get(label.span.file).name, "--set", "{path}");
    }
    assert!(Override::parse("open.spacing").is_err());
    assert!(Override::parse("=3 m").is_err());
}

#[test]
fn what_a_value_is_of_is_read_everywhere() {
    for (find, replace) in [
        ("< 80 kN per seat", "< 80 kN per seet"),
        ("[-20, -5, -1, +1] sleepers", "[-20 sleepers per seat, -5 sleepers]"),
        ("elements_per_bay = 4", "elements_per_bay = 4 per rail"),
        ("let bay = 0.6 m", "let bay = 0.6 m per sleeper"),
    ] {
        let compiled = compiled(&SCENE.replace(find, replace));
        assert_eq!(codes_of(&compiled), [Code::E0304], "{replace}\n{}", told(&compiled));
    }
    let ratio = SCENE.replace("elements_per_bay = 4", "elements_per_bay = (80 kN per seat) / (20 kN per seat)");
    assert_eq!(codes(&ratio), [], "a ratio is of nothing");
}

#[test]
fn a_hole_names_what_the_library_has_for_it() {
    let compiled = compiled(&SCENE.replace("slab    = slabs.half_width_1600", "slab    = ?"));
    assert_eq!(found(&compiled), [(Code::E0410, 26)], "{}", told(&compiled));
    assert!(compiled.diagnostics[0].help.as_ref().unwrap().contains("`slabs.half_width_1600`"));
    assert!(compiled.scenario.is_none());
}

fn codes_of(compiled: &Compiled) -> Vec<Code> {
    compiled.diagnostics.iter().map(|d| d.code).collect()
}

#[test]
fn functions_hold_their_values_together() {
    let scene = |value: &str| SCENE.replace("let bay = 0.6 m", &format!("let bay = {value}"));
    assert_eq!(codes(&scene("min(0.6 m, 700 mm)")), []);
    assert_eq!(codes(&scene("min(0.6 m, 3 s)")), [Code::E0305]);
    assert_eq!(codes(&scene("max(0.6, 0.5)")), [Code::E0301]);
    let support = |value: &str| {
        SCENE.replace("{ stiffness = 50 MN/m per seat, damping = 50", &format!("{{ stiffness = {value}, damping = 50"))
    };
    assert_eq!(codes(&support("min(50 MN/m per seat, 80 MN/m)")), []);
    assert_eq!(codes(&support("min(50 MN/m per seat, 80 MN/m per sleeper)")), [Code::E0305]);
    assert_eq!(codes(&support("(40 MN/m per seat) + (80 MN/m per sleeper)")), [Code::E0305]);
}
