//! Settlement laws from the text to the run: what the words mean, several laws under the same forces, and a law under
//! which nothing settles.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use trackbed::check::NoModules;
use trackbed::diag::Code;
use trackbed::execute::{self, Checkpoint, Event, Executor, Listener};
use trackbed::results::{RunRecorder, law_rows, summarise_laws, unsettled};
use trackbed::scenario::SettlementLaw;
use trackbed::solvers::settlement::*;
use trackbed::{Compiled, compile};

/// A transition zone that runs in a moment, with its laws.
fn scene(laws: &str) -> String {
    format!(
        "use std
trackform open {{
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = {{ stiffness = 50 MN/m per seat, damping_time = 1 ms }}
}}
trackform stiff : open {{ sleeper = none, support = none, slab = slabs.half_width_1600 }}
track line {{ sections = [open: 12 m, stiff: 12 m] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }}
traffic {{ trains = ore, total = 24 axles }}
{laws}
solve : numerics {{ law = law_list }}
"
    )
    .replace("solve : numerics {", "solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s,")
    .replace("law_list", if laws.contains("law second") { "[first, second]" } else { "first" })
}

fn compiled(laws: &str) -> Compiled {
    compile("scene.track", &scene(laws), &NoModules, &[])
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn first(laws: &str) -> SettlementLaw {
    let compiled = compiled(laws);
    compiled.scenario.as_ref().unwrap_or_else(|| panic!("{}", told(&compiled))).solve.law.clone()
}

#[test]
fn the_library_holds_the_published_values() {
    for (name, form) in [
        ("varandas_2014", Form::Varandas(Varandas::default())),
        ("nasrollahi_2023", Form::Nasrollahi(Nasrollahi::default())),
        ("sato_1995", Form::Sato(Sato::default())),
        ("shenton_1985", Form::Shenton(Shenton::default())),
        ("hettler_1984", Form::Hettler(Hettler::default())),
        ("guerin_1996", Form::Guerin(Guerin::default())),
        ("selig_waters_1994", Form::Power(Power { m: 0.0, ..Power::default() })),
    ] {
        let law = first(&format!("law first : laws.{name} {{ cycle_per = axle }}"));
        let (mut expected, mut found) = (form, law.law.form);
        for ((name, a), (_, b)) in expected.parameters().into_iter().zip(found.parameters()) {
            assert!((*a - *b).abs() <= 1e-12 * a.abs(), "{} {name}: {a} {b}", law.name);
        }
        assert_eq!((expected.name(), law.law.cycle_per), (law.law.form.name(), CyclePer::Axle));
    }
}

#[test]
fn a_cycle_has_its_basis() {
    let cycles = |text: &str| match first(&format!("law first {{ {text} }}")).law.form {
        Form::Varandas(law) => law.reference_cycles,
        _ => f64::NAN,
    };
    assert_eq!(cycles("form = varandas"), 1e6);
    assert_eq!(cycles("form = varandas, cycle_per = vehicle"), 250e3);
    assert_eq!(cycles("form = varandas(reference_cycles = 1e5 cycles), cycle_per = vehicle"), 1e5);
    assert_eq!(cycles("form = varandas(reference_cycles = 1e5 axles), cycle_per = bogie"), 50e3);
    let power =
        first("law first { form = power(1 mm, 2, 0.2, reference_force = 80 kN per sleeper), cycle_per = bogie }");
    assert_eq!(power.law.cycle_per, CyclePer::Bogie);
    assert_eq!(power.law.form, Form::Power(Power { a: 1e-3, m: 2.0, b: 0.2, reference_force: 40e3, g: 0.0 }));
    let decimal = first("law first { form = hettler(logarithm = decimal) }").law.form;
    assert!(matches!(decimal, Form::Hettler(Hettler { logarithm: Logarithm::Decimal, .. })));
}

#[test]
fn contradictions_are_told() {
    let codes = |laws: &str| -> Vec<Code> {
        compiled(laws).diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect()
    };
    let falling =
        "law first { form = nasrollahi(initial_threshold = 50 kN per seat, final_threshold = 40 kN per seat) }";
    assert_eq!(codes(falling), [Code::E0407]);
    assert_eq!(codes("law first { form = hettler }"), [Code::E0403]);
    assert_eq!(codes("law first { form = shenton(k1 = 1 mm, reference_force = 30 kN per seat) }"), [Code::E0403]);
    assert_eq!(codes("law first { form = guerin(alpha = 1 kN) }"), [Code::E0302]);
    let solve = |text: &str| {
        let text = scene("law first { form = varandas }").replace("law = first", text);
        let compiled = compile("scene.track", &text, &NoModules, &[]);
        compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect::<Vec<_>>()
    };
    assert_eq!(solve("law = [first, first]"), [Code::E0404]);
    assert_eq!(solve("law = []"), [Code::E0403]);
    assert_eq!(solve("law = [first, laws.varandas_2014]"), []);
    assert_eq!(solve("law = [first, nobody]"), [Code::E0201]);
}

/// Every law of the scene gets its own warning, at the place that asks for it.
#[test]
fn rules_speak_of_every_law_at_its_place() {
    let compiled = compiled(
        "law first { form = nasrollahi, loads = 35 .. 90 kN per seat }
law second { form = nasrollahi(alpha = 1 mm), cycles = 1 .. 10 axles }",
    );
    let of = |code: Code| compiled.diagnostics.iter().filter(move |d| d.code == code).collect::<Vec<_>>();
    let asked =
        |code: Code| -> Vec<&str> { of(code).iter().map(|d| compiled.sources.text(d.labels[0].span)).collect() };
    assert_eq!(asked(Code::L1008), ["first", "second"], "{}", told(&compiled));
    assert_eq!(asked(Code::L1004), ["first", "second"], "{}", told(&compiled));
    assert!(of(Code::L1008)[0].message.contains("35 kN per seat, but wheels of 98.1 kN at rest give at most about 3"));
}

/// Keeps what laws say, and the checkpoint after some blocks as it would lie on a disk.
#[derive(Default)]
struct Laws {
    counts: Vec<(u64, Vec<Vec<f64>>)>,
    saved: Vec<String>,
}

impl Listener for Laws {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Laws { axles, settlement } => self.counts.push((*axles, settlement.to_vec())),
            Event::Between(between) => {
                self.saved.push(serde_json::to_string(&between.checkpoint().unwrap()).unwrap());
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

const TWO: &str = "law first : laws.varandas_2014 { }
law second : laws.hettler_1984 { }";

#[test]
fn followers_settle_under_the_forces_of_the_first_law() {
    let compiled = compiled(TWO);
    let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut both = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut both).unwrap();
    let rows = law_rows(&scenario, &both.tables.laws);
    assert_eq!(rows.len(), 7 * 2 * 19);

    // the first law alone makes the same run
    let alone = crate::compiled("law first : laws.varandas_2014 { }");
    let (single, graph) = (alone.scenario.unwrap(), alone.graph.unwrap());
    let mut one = RunRecorder::new(&single, &graph);
    execute::execute(&graph, &mut one).unwrap();
    assert_eq!(one.tables.sleepers, both.tables.sleepers);
    assert!(one.tables.laws.is_empty());

    // its rows are those of the sleepers, and the scalars those of the rows; all wheels pass the last metres of this
    // short track
    let of = |law: &str, name: &str| {
        rows.iter().rfind(|r| r.law == law && r.sleeper == name).map(|r| r.settlement_m).unwrap()
    };
    for row in both.tables.sleepers.iter().filter(|row| row.axles == 24 && (-4.0..-0.1).contains(&row.x_m)) {
        assert_eq!(of("first", &row.sleeper), row.settlement_m);
        // 24 axles of 33 to 45 kN by the closed form
        let closed = |force: f64| 0.95e-6 * force.powf(1.6) * (1.0 + 0.43 * 24f64.ln());
        let found = of("second", &row.sleeper);
        assert!(found > closed(30.0) && found < closed(48.0), "{} {found}", row.sleeper);
    }
    let scalars = summarise_laws(&scenario, &rows);
    let most = |law: &str| rows.iter().filter(|r| r.law == law).map(|r| r.settlement_m).fold(0.0, f64::max);
    assert_eq!(scalars["laws.second.max_settlement"].value, most("second"));
    assert!(scalars["laws.first.far_field_settlement"].value > 0.0);
    let (a, b) = (most("first"), most("second"));
    assert_eq!(scalars["law_spread"].value, a.max(b) / a.min(b));
}

#[test]
fn followers_resume_with_the_same_bits() {
    let compiled = compiled(TWO);
    let graph = compiled.graph.unwrap();
    let mut whole = Laws::default();
    execute::execute(&graph, &mut whole).unwrap();
    assert_eq!(whole.counts.len(), 7);
    let checkpoint: Checkpoint = serde_json::from_str(&whole.saved[2]).unwrap();
    let mut rest = Laws::default();
    Executor::default().run(&graph, &mut rest, Some(checkpoint)).unwrap();
    assert_eq!(rest.counts, whole.counts[4..]);
    assert_eq!(rest.saved, whole.saved[3..]);
}

#[test]
fn a_run_in_which_nothing_settles_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("scene.track");
    let heavy = "law first { form = nasrollahi(initial_threshold = 60 kN per seat) }";
    std::fs::write(&file, scene(heavy)).unwrap();
    let out = dir.path().join("out");
    let output = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()])
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("nothing settled under law `first`: the largest contact force was "), "{said}");
    assert!(said.contains("kN per seat, and the threshold of the law is 60 kN"), "{said}");
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("nothing settled under law <code>first</code>"));
    assert!(!Path::new(&out.join("laws.csv")).exists(), "one law is no comparison");
    let run = trackbed::results::read(&out).unwrap();
    assert_eq!(unsettled(&run.scenario, &run.blocks, &run.laws).len(), 1);

    // several laws leave their table, and it comes back
    std::fs::write(&file, scene(TWO)).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(["run", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--force"])
        .output()
        .unwrap();
    assert!(String::from_utf8_lossy(&output.stdout).contains("spread between laws"));
    let run = trackbed::results::read(&out).unwrap();
    assert_eq!(run.laws.len(), 7 * 2 * 19);
    assert!(unsettled(&run.scenario, &run.blocks, &run.laws).is_empty());
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("id=\"laws_along_the_track\"") && page.contains("a ratio of"));
}
