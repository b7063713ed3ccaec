//! What the physics rules of grains and of cost say in numbers, against the closed forms they state.

use std::f64::consts::PI;
use trackbed::check::NoModules;
use trackbed::diag::{Code, Diagnostic, Span};
use trackbed::graph::{BedPlan, TestWork, Work};
use trackbed::{Compiled, compile};

/// 42 m of track on a layer of stone and a metre of soil; each part may be replaced.
#[derive(Clone, Copy)]
struct Scene<'a> {
    stone: &'a str,
    layers: &'a str,
    sleeper: &'a str,
    pad: &'a str,
    track: &'a str,
    solve: &'a str,
    rest: &'a str,
}

/// Stones of 20 to 80 mm: D50 is 40 mm, D90 69.6 mm.
const STONE: &str = "grading = { passing = [20 mm: 0 %, 80 mm: 100 %] }, density = 2700 kg/m^3, friction = 0.7, \
                     contact_stiffness = 10 MN/m per contact";

const SCENE: Scene<'_> = Scene {
    stone: "",
    layers: "[stone: 400 mm, soils.sandy_gravel: 1 m]",
    sleeper: "sleepers.B70",
    pad: "{ stiffness = 40 MN/m }",
    track: "sections = [open: 42 m]",
    solve: "substructure = cells",
    rest: "",
};

impl Scene<'_> {
    fn says(self, code: Code) -> Vec<String> {
        let Scene { stone, layers, sleeper, pad, track, solve, rest } = self;
        let text = format!(
            "use std
granular base {{ {STONE} }}
granular stone : base {{ {stone} }}
trackform open {{
  rail = rails.UIC60, pad = {pad}, sleeper = {sleeper}, spacing = 0.6 m, layers = {layers}
  support = {{ stiffness = 40 MN/m per seat }}
}}
track line {{ {track} }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }}
traffic {{ trains = ore, total = 400 axles }}
solve {{ {solve} }}
{rest}
"
        );
        let compiled = compile("scene.track", &text, &NoModules, &[]);
        let told = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
        assert!(compiled.diagnostics.iter().all(|d| !d.is_error()), "{told}");
        compiled.diagnostics.iter().filter(|d| d.code == code).map(|d| d.message.clone()).collect()
    }
}

/// Size below which a share of the mass of the stones lies, m.
fn size(share: f64) -> f64 {
    0.02 * 4f64.powf(share)
}

#[test]
fn a_layer_is_four_coarse_grains() {
    let least = 4.0 * size(0.9);
    let of = |thickness: f64| {
        let layers = format!("[stone: {} mm, soils.sandy_gravel: 1 m]", thickness * 1e3);
        Scene { layers: &layers, ..SCENE }.says(Code::L1009)
    };
    assert!(of(least + 1e-3).is_empty());
    let said = format!(
        "layer `stone` of `open` is 250 mm thick, only {:.2} of its coarse grains, D90 = {:.1} mm",
        0.25 / size(0.9),
        size(0.9) * 1e3
    );
    assert_eq!(of(0.25), [said]);
    // a ramp counts where it is thinnest
    let ramp = "[stone: ramp(250 .. 500 mm), soils.sandy_gravel: 1 m]";
    assert_eq!(Scene { layers: ramp, ..SCENE }.says(Code::L1009), of(0.25));
    // a settlement law knows no grains
    let thin = "[stone: 250 mm, soils.sandy_gravel: 1 m]";
    assert!(Scene { layers: thin, solve: "substructure = law", ..SCENE }.says(Code::L1009).is_empty());
}

#[test]
fn a_bed_has_room_for_six_coarse_grains() {
    let window = |length: f64| {
        let solve = format!("substructure = full, window = 10 .. {} m", 10.0 + length);
        Scene { solve: &solve, ..SCENE }.says(Code::L1018)
    };
    let least = 6.0 * size(0.9);
    assert!(window(least + 1e-3).is_empty());
    assert_eq!(
        window(0.4),
        [format!(
            "the bed is 0.4 m long, only {:.1} coarse grains of `stone`, D90 = {:.1} mm",
            0.4 / size(0.9),
            size(0.9) * 1e3
        )]
    );
    // half of a bed between walls, the whole of one with both rails
    let narrow = |symmetry: &str| {
        let solve = format!("substructure = full, symmetry = {symmetry}");
        let coarse = "grading.cut_below = 79 mm, contact_stiffness = 100 MN/m per contact";
        let layers = "[stone: 900 mm, soils.sandy_gravel: 1 m]";
        let track = "sections = [open: 42 m], bed_width = 2.6 m";
        let stone = format!("{coarse}, grading.passing = [70 mm: 0 %, 300 mm: 100 %]");
        Scene { solve: &solve, stone: &stone, layers, track, ..SCENE }.says(Code::L1018).len()
    };
    assert_eq!((narrow("half"), narrow("full")), (1, 0));
}

#[test]
fn a_sleeper_stands_on_three_median_grains() {
    let on = |median: f64| {
        let stone = format!("grading.passing = [{} mm: 0 %, {} mm: 100 %]", median * 0.8, median * 1.25);
        let layers = "[stone: 900 mm, soils.sandy_gravel: 1 m]";
        Scene { stone: &stone, layers, sleeper: "sleepers.B70 { base_width = 0.3 m }", ..SCENE }.says(Code::L1019)
    };
    assert!(on(99.0).is_empty());
    assert_eq!(on(120.0), ["sleepers of `open` are 300 mm wide, only 2.5 median grains of `stone`, d50 = 120 mm"]);
}

#[test]
fn a_step_of_grains_adds_inertia_to_the_light_ones() {
    // grains below the size D of the mass m' = k (0.8 dt / 0.27)^2 get more; their sizes are uniform in the logarithm
    let share = |step: f64, stiffness: f64, [smallest, largest]: [f64; 2]| {
        let size = (6.0 * stiffness * (0.8 * step / 0.27).powi(2) / (PI * 2700.0)).cbrt();
        let over = f64::max(size / smallest, 1.0);
        ((over.powi(3) - 1.0) / 3.0 - over.ln()) / (largest / smallest).ln()
    };
    let of_stones = |step: f64| share(step, 10e6, [0.02, 0.08]);
    let with = |step: f64, stone: &str| {
        let solve = format!("substructure = cells, grain_step = {step:e} s");
        Scene { solve: &solve, stone, ..SCENE }.says(Code::L1020)
    };
    let limit = bisected(|step| of_stones(step) - 0.1);
    assert!(with(limit * 0.995, "").is_empty());
    let found = with(limit * 1.005, "");
    assert!(found.len() == 1 && found[0].contains(" adds 10 % of inertia to the grains of `open`"), "{found:?}");
    let much = bisected(|step| of_stones(step) - 0.42);
    assert!(with(much, "")[0].contains(" adds 42 % of inertia"), "{:?}", with(much, ""));
    // half as stiff contacts bear a step longer by the root of two
    assert!(with(limit * 1.405, "contact_stiffness = 5 MN/m per contact").is_empty());
    assert!(!with(limit * 1.425, "contact_stiffness = 5 MN/m per contact").is_empty());
    // a second layer with smaller grains gets more, as much as it weighs
    let layers = "[stone: 400 mm, gravel: 300 mm, soils.sandy_gravel: 1 m]";
    let gravel = "granular gravel : base { grading = { passing = [10 mm: 0 %, 20 mm: 100 %] } }";
    let both = |step: f64| (4.0 * of_stones(step) + 3.0 * share(step, 10e6, [0.01, 0.02])) / 7.0;
    let limit = bisected(|step| both(step) - 0.1);
    let on_both = |step: f64| {
        let solve = format!("substructure = cells, grain_step = {step:e} s");
        Scene { layers, solve: &solve, rest: gravel, ..SCENE }.says(Code::L1020)
    };
    assert!(on_both(limit * 0.995).is_empty() && on_both(limit * 1.005).len() == 1);
}

/// Where a growing function of a step is zero, s.
fn bisected(value: impl Fn(f64) -> f64) -> f64 {
    let halved = |[low, high]: [f64; 2], _: i32| {
        let middle = 0.5 * (low + high);
        if value(middle) < 0.0 { [middle, high] } else { [low, middle] }
    };
    (0..60).fold([1e-6, 1e-3], halved)[0]
}

#[test]
fn grains_overlap_by_their_mean_contact_force() {
    // under the 200 kPa of their packing
    let force = PI * 0.04 * 0.04 * 200e3 / (6.0 * 0.6);
    let least = force / (0.01 * 0.02);
    let with = |stiffness: f64| {
        let stone = format!("contact_stiffness = {} MN/m per contact", stiffness / 1e6);
        Scene { stone: &stone, ..SCENE }.says(Code::L1021)
    };
    assert!(with(least * 1.01).is_empty());
    let said = format!(
        "grains of `stone` overlap by about 2 % of their radius: {force:.0} N per contact at 200 kPa for grains of 40 mm"
    );
    assert_eq!(with(least / 2.0), [said]);
    // per particle is half per contact
    let stone = format!("contact_stiffness = {} MN/m per particle", least * 1.01 / 1e6);
    assert_eq!(Scene { stone: &stone, ..SCENE }.says(Code::L1021).len(), 1);
    // Hertz: the approach over the radius goes with (p / E*)^(2/3)
    let rock = |modulus: f64| {
        let stone = format!("contact = hertz({modulus} GPa, 0.2)");
        Scene { stone: &stone, ..SCENE }.says(Code::L1021)
    };
    let needed = force / (4.0 / 3.0 * 0.01f64.sqrt() * (0.01 * 0.02f64).powf(1.5)) * 2.0 * (1.0 - 0.04) / 1e9;
    assert!(rock(needed * 1.01).is_empty() && rock(needed * 0.99).len() == 1, "{needed} GPa");
}

#[test]
fn a_run_is_held_against_its_budget() {
    let with = |solve: &str| Scene { solve, ..SCENE }.says(Code::L1022);
    assert!(with("substructure = law, update_every = 4 axles, budget = 100 min, memory = 8 GiB").is_empty());
    let time = with("substructure = law, update_every = 4 axles, budget = 0.6 s");
    assert!(time.len() == 1 && time[0].contains("more than its budget of 0.6 s: 101 passages"), "{time:?}");
    let memory = with("substructure = law, memory = 0.01 GiB");
    assert!(memory.is_empty() || memory[0].contains("more than the limit of 10 MiB"), "{memory:?}");
    assert_eq!(with("substructure = cells, budget = 0.6 s").len(), 1);
    assert!(with("substructure = cells, budget = 1000 h").is_empty());
}

#[test]
fn a_damper_is_held_against_the_critical_one() {
    // a B70 on a pad of 100 and a support of 40 MN/m, 1 ms
    let mass = 145.0;
    let critical = 2.0 * (140e6f64 * mass).sqrt();
    let with = |damping: f64| {
        let pad = format!("{{ stiffness = 100 MN/m, damping = {} kN s/m }}", damping / 1e3);
        Scene { pad: &pad, ..SCENE }.says(Code::L1023)
    };
    assert!(with((critical - 40e3) * 0.99).is_empty());
    let found = with(2.0 * critical - 40e3);
    let said = format!(
        "a sleeper of `open` between pad and support has 2 times its critical damping: {:.1} kN s/m with 140 MN/m and 145 kg",
        2.0 * critical / 1e3
    );
    assert_eq!(found, [said]);
}

#[test]
fn a_volume_is_three_median_grains() {
    let with = |volume: &str| {
        let rest = format!(
            "record inside {{ at = 35 sleepers, depth = 150 mm, volume = {volume}, quantities = ballast_velocity }}"
        );
        Scene { rest: &rest, ..SCENE }.says(Code::L1024)
    };
    assert!(with("sphere(60 mm)").is_empty() && with("box(0.12 m, bed, 0.2 m)").is_empty());
    let said = ["a volume of 100 mm is only 2.5 median grains of `stone` wide, d50 = 40 mm"];
    assert_eq!(with("sphere(50 mm)"), said);
    assert_eq!(with("box(0.2 m, 0.1 m, 0.3 m)"), said);
    // in the soil below there are no grains to count
    let rest =
        "record inside { at = 35 sleepers, depth = 900 mm, volume = sphere(20 mm), quantities = ballast_stress }";
    assert!(Scene { rest, ..SCENE }.says(Code::L1024).is_empty());
}

#[test]
fn unchecked_values_are_named_when_asked_for() {
    let named = |rest: &str| Scene { rest, solve: "substructure = law", ..SCENE }.says(Code::L1010);
    assert!(named("").is_empty());
    let found = named("scenario { warn = [unchecked_values] }");
    let of = |name: &str| found.iter().any(|m| m.starts_with(&format!("`{name}` has not been checked: ")));
    assert!(of("sleepers.B70") && of("soils.sandy_gravel"), "{found:?}");
    // a default is named too, entries with another evidence are not
    assert!(!of("vehicles.ore_wagon_20t") && !of("gradings.ballast_31_63"), "{found:?}");
    assert!(named("scenario { warn = [unchecked_values], allow = [unchecked_values: \"a sketch\"] }").is_empty());
}

/// A box of ballast under a sleeper, with something more in its materials and in `solve`.
fn box_test(stone: &str, solve: &str) -> Compiled {
    let text = format!(
        "use std
granular base {{ {STONE} }}
granular stone : base {{ {stone} }}
trackform bed {{ sleeper = sleepers.concrete, spacing = 0.6 m, layers = [stone: 400 mm] }}
track box {{ sections = [bed: 1 sleeper], bed_width = 2.6 m per track }}
load actuator {{ on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 20 Hz) per sleeper, total = 10 cycles }}
solve {{ substructure = full, {solve} }}
"
    );
    compile("box.track", &text, &NoModules, &[])
}

fn told(compiled: &Compiled) -> Vec<(Code, &str)> {
    compiled.diagnostics.iter().map(|d| (d.code, d.message.as_str())).collect()
}

#[test]
fn rules_hold_for_test_rigs() {
    assert_eq!(told(&box_test("scale = 1", "budget = 1000 h")), []);
    let compiled = box_test("scale = 1", "budget = 1 s");
    let [(Code::L1022, message)] = told(&compiled)[..] else { panic!("{:?}", compiled.diagnostics) };
    assert!(message.starts_with("the test is expected to take") && message.contains("its budget of 1 s:"), "{message}");
    // soft contacts under the plate that packs them
    let soft = box_test("contact_stiffness = 0.5 MN/m per contact", "");
    assert!(told(&soft).iter().any(|(code, _)| *code == Code::L1021), "{:?}", soft.diagnostics);
    // a rig chooses its own step
    let long = box_test("scale = 1", "grain_step = 1 ms");
    assert!(told(&long).iter().all(|(code, _)| *code != Code::L1020), "{:?}", long.diagnostics);
}

#[test]
fn larger_grains_are_fewer_and_as_much_stiffer() {
    let bed = |scale: &str| -> (BedPlan, TestWork) {
        let graph = box_test(&format!("scale = {scale}"), "").graph.unwrap();
        let Work::Tests(work) = graph.cost.work else { panic!("{:?}", graph.cost) };
        (graph.beds().next().unwrap().clone(), work)
    };
    let ((fine, many), (coarse, few)) = (bed("1"), bed("1.5"));
    let [one, other] = [&fine.numbers().layers[0], &coarse.numbers().layers[0]];
    let near = |value: f64, wanted: f64| assert!((value / wanted - 1.0).abs() < 1e-12, "{value} {wanted}");
    (0..2).for_each(|end| near(other.curve.ends()[end], 1.5 * one.curve.ends()[end]));
    near(other.surface.normal_stiffness, 1.5 * one.surface.normal_stiffness);
    near(many.grains / few.grains, 1.5f64.powi(3));
    near(few.time_step / many.time_step, 1.5);
    assert!(coarse.notes.iter().any(|note| note.contains("`stone` are 1.5 times as large")), "{:?}", coarse.notes);
    // a layer of fewer than four of its coarse grains is told, of fewer than two of its largest refused
    assert!(told(&box_test("scale = 2.4", "")).iter().any(|(code, _)| *code == Code::L1009));
    let thin = box_test("scale = 3", "");
    let refused = thin.diagnostics.iter().find(|d| d.code == Code::E0511).unwrap();
    assert!(refused.help.as_deref().is_some_and(|help| help.contains("a smaller `scale`")), "{refused:?}");
}

/// A rig of one sleeper on 200 mm of coarse stone.
fn rig(tier: &str) -> Vec<(Code, String, Option<Span>)> {
    let text = format!(
        "use std
granular stone {{ {STONE} }}
trackform bed {{ sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 200 mm] }}
track box {{ sections = [bed: 1 sleeper] }}
load jack {{ on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 4 cycles }}
solve {{ substructure = {tier} }}
"
    );
    let compiled = compile("rig.track", &text, &NoModules, &[]);
    let place = |d: &Diagnostic| d.labels.first().map(|label| label.span);
    compiled.diagnostics.iter().map(|d| (d.code, d.message.clone(), place(d))).collect()
}

#[test]
fn rules_of_grains_speak_where_the_plan_has_grains_whatever_the_spelling() {
    let full = rig("full");
    assert_eq!(full.iter().filter(|(said, ..)| *said == Code::L1009).count(), 1, "{full:?}");
    assert_eq!(rig("auto"), full);
}

#[test]
fn rules_speak_of_a_plan_that_is_refused() {
    let text = "use std
granular stone { grading = { passing = [20 mm: 0 %, 80 mm: 100 %] }, density = 2700 kg/m^3, friction = 0.7
                 contact_stiffness = 10 MN/m per contact }
trackform open { rail = rails.UIC60, pad = pads.soft, sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 250 mm] }
track line { sections = [open: 42 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }
traffic { trains = ore, total = 400 axles }
";
    let compiled = compile("scene.track", text, &NoModules, &[]);
    let codes: Vec<Code> = compiled.diagnostics.iter().map(|d| d.code).collect();
    assert!(codes.contains(&Code::E0604) && codes.contains(&Code::L1009), "{codes:?}");
    assert!(compiled.graph.is_some() && compiled.runnable().is_none());
}
