//! What a run would refuse before its first step is refused by the check, with its line.

use trackbed::check::NoModules;
use trackbed::compile;
use trackbed::diag::{Code, render};

/// The errors of a text: their codes, messages and the texts that they point at.
fn errors(text: &str) -> Vec<(Code, String, Vec<String>)> {
    let compiled = compile("scene.track", text, &NoModules, &[]);
    println!("{}", render::human(&compiled.diagnostics, &compiled.sources, false, 120));
    let (_, source) = compiled.sources.iter().next().unwrap();
    let pointed = |span: trackbed::diag::Span| {
        source.text.get(span.start as usize..span.end as usize).unwrap_or_default().to_owned()
    };
    let of_scene = |d: &trackbed::diag::Diagnostic| d.labels.iter().map(|label| pointed(label.span)).collect();
    let errors = compiled.diagnostics.iter().filter(|d| d.is_error());
    errors.map(|d| (d.code, d.message.clone(), of_scene(d))).collect()
}

/// A plate on a box of ballast, or on a bed that goes on along; its clumps are 1.75 times as long as wide.
fn oedometer(bed: &str, load: &str) -> String {
    format!(
        "use std
granular stone : ballasts.granite_31_63 {{ grading.cut_below = 40 mm, packing.lifts = 1 }}
trackform specimen {{ spacing = 0.6 m, layers = [stone: 300 mm] }}
track cell {{ sections = [specimen: {bed} }}
load press {{ on = bed, at = 0.1 m, {load} }}
solve {{ substructure = full }}
"
    )
}

const PRESS: &str = "force = cyclic(1 .. 72 kN, 5 Hz) per rail, total = 3 cycles";

#[test]
fn a_cell_too_small_for_its_clumps_is_refused_where_it_is_stated() {
    assert!(errors(&oedometer("0.6 m], bed_width = 1.2 m per track", PRESS)).is_empty());
    // spheres of 63 mm would fit into 250 mm, clumps of 110 mm do not
    let found = errors(&oedometer("0.6 m], bed_width = 0.5 m per track", PRESS));
    let [(Code::E0610, message, at)] = &found[..] else { panic!("{found:?}") };
    assert!(message.contains("up to 110 mm wide, more than a third of the cell side of 250 mm"), "{message}");
    assert_eq!(at, &["0.5 m per track"]);
    let boxed = oedometer("0.3 m], bed_width = 1.2 m per track", "strain = 5 %, confinement = 60 kPa");
    let found = errors(&boxed.replace("spacing = 0.6 m", "spacing = 0.3 m"));
    let [(Code::E0610, message, at)] = &found[..] else { panic!("{found:?}") };
    assert!(message.contains("the cell side of 300 mm"), "{message}");
    assert_eq!(at, &["0.3 m"]);
}

#[test]
fn a_cell_that_goes_on_has_as_many_bays_as_its_clumps_need() {
    let scene = oedometer("0.6 m], bed_width = 1.6 m per track", PRESS);
    let larger = scene.replace("packing.lifts = 1", "packing.lifts = 1, scale = 2").replace("300 mm]", "500 mm]");
    let compiled = compile("scene.track", &larger, &NoModules, &[]);
    let bed = compiled.graph.as_ref().unwrap().beds().next().unwrap();
    // 220 mm long, three times: 660 mm
    assert_eq!(bed.numbers().plan, [1.2, 0.8]);
    assert!(bed.ready(bed.seed()).is_ok());
}

/// Twenty sleepers under a jack.
fn bench(sections: &str, support: &str, load: &str, rest: &str) -> String {
    format!(
        "use std
trackform seats {{
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m, support = {support}
}}
track bench {{ sections = [seats: {sections}], rail_ends = free }}
load jack {{ at = 1 sleeper, {load} }}
{rest}
"
    )
}

const JACK: &str = "on = rail, force = 100 kN per rail";

#[test]
fn a_track_that_nothing_holds_and_loads_that_nothing_bears_are_refused() {
    assert!(errors(&bench("20 sleepers", "rigid", JACK, "")).is_empty());
    let [(Code::E0801, message, at)] = &errors(&bench("1 sleeper", "rigid", JACK, ""))[..] else { panic!() };
    assert!(message.contains("nothing holds the track"), "{message}");
    assert_eq!(at, &["1 sleeper"]);
    let on_sleeper = "on = sleepers, force = 100 kN per sleeper";
    let [(Code::E0617, message, _)] = &errors(&bench("20 sleepers", "rigid", on_sleeper, ""))[..] else { panic!() };
    assert!(message.contains("its sleeper does not move"), "{message}");
    assert!(errors(&bench("20 sleepers", "{ stiffness = 50 MN/m per seat }", on_sleeper, "")).is_empty());
}

#[test]
fn expectations_that_the_run_cannot_answer_are_refused() {
    let expecting = |that: &str| bench("20 sleepers", "rigid", JACK, &format!("expect {{ that = [{that}] }}"));
    for answered in ["max(rail_displacement) < 2 mm", "max(rail_level) < 1 mm", "max(rail_seat_load) > 1 kN per seat"] {
        assert!(errors(&expecting(answered)).is_empty(), "{answered}");
    }
    for (that, said) in [
        ("mean(rail_stiffness) > 1 MN/m", "this run will have no `rail_stiffness`"),
        ("voided_sleepers < 3", "this run will have no `voided_sleepers`"),
        ("max(ballast_stress) < 1 MPa", "this run will have no `ballast_stress`"),
        ("max(sleeper_velocity) < 1 m/s", "`sleeper_velocity` will not be recorded"),
        (
            "max(rail_seat_load, over = 1 .. 1.1 m) < 1 kN per seat",
            "`rail_seat_load` will not be recorded anywhere on this span",
        ),
    ] {
        let found = errors(&expecting(that));
        let [(Code::E0616, message, at)] = &found[..] else { panic!("{that}: {found:?}") };
        assert_eq!((message.as_str(), at[0].as_str()), (said, that));
    }
}
