//! What each part of the track's physics does to a scene that runs: from the text to the forces.

use std::collections::BTreeMap;
use std::path::Path;
use trackbed::check::Modules;
use trackbed::results::{RunRecorder, SleeperRow};
use trackbed::{compile, diag, execute};

/// Files in memory.
#[derive(Default)]
struct Files(BTreeMap<&'static str, String>);

impl Modules for Files {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative.to_str()?).map(|text| text.clone().into_bytes())
    }
}

/// A wagon over 60 sleepers; `trackform`, `track`, `train` and `solve` say what is different.
#[derive(Default, Clone, Copy)]
struct Scene<'a> {
    trackform: &'a str,
    track: &'a str,
    speed: Option<&'a str>,
    solve: &'a str,
    support: Option<&'a str>,
}

/// What a passage over the fresh track showed.
struct Found {
    max_wheel_force: f64,
    min_wheel_force: f64,
    sleepers: Vec<SleeperRow>,
    /// Time of the passage, s.
    duration: f64,
    steps: u64,
}

impl Found {
    fn middle(&self) -> &SleeperRow {
        self.sleepers.iter().find(|row| row.axles == 0 && row.sleeper == "+30").unwrap()
    }
}

fn run(scene: Scene<'_>, files: Files) -> Found {
    let support = scene.support.unwrap_or("stiffness = 50 MN/m per seat, damping_time = 1 ms");
    let text = format!(
        "use std
trackform open {{
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = {{ {support} }}
  {}
}}
track line {{ sections = [open: 60 sleepers], {} }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = {} }}
traffic {{ trains = ore, total = 4 axles }}
record {{ at = 30 sleepers, after = [0, 4] axles, quantities = wheel_force }}
solve {{ {} }}
",
        scene.trackform,
        scene.track,
        scene.speed.unwrap_or("150 km/h"),
        scene.solve
    );
    let compiled = compile("scene.track", &text, &files, &[]);
    let told = diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
    assert!(!compiled.diagnostics.iter().any(|d| d.is_error()), "{told}");
    let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    let first = recorder.tables.blocks[0].clone();
    let duration = recorder.histories.iter().filter(|h| h.axles == 0).map(|h| h.time_s).fold(0.0, f64::max);
    Found {
        max_wheel_force: first.max_wheel_force_N,
        min_wheel_force: first.min_wheel_force_N,
        sleepers: recorder.tables.sleepers.clone(),
        duration,
        steps: first.time_steps,
    }
}

fn plain() -> Found {
    run(Scene::default(), Files::default())
}

const WHEEL: f64 = 98.1e3;

#[test]
fn a_rail_that_shears_spreads_its_load_less() {
    let (euler, timoshenko) =
        (plain(), run(Scene { solve: "beam = timoshenko", ..Scene::default() }, Files::default()));
    let ratio = timoshenko.middle().max_rail_seat_load_N / euler.middle().max_rail_seat_load_N;
    println!("seat load {ratio:.4} times that of Euler and Bernoulli");
    assert!((1.02..1.10).contains(&ratio), "{ratio}");
}

#[test]
fn integrators_and_steps_of_varying_length_agree() {
    let reference = plain();
    for solve in ["integrator = hht", "integrator = newmark", "time_step = 5e-5 s", "time_step = adaptive(1e-5)"] {
        let found = run(Scene { solve, ..Scene::default() }, Files::default());
        let ratio = found.middle().max_contact_force_N / reference.middle().max_contact_force_N;
        println!("{solve}: {:.2e}, {} steps, reference {}", ratio - 1.0, found.steps, reference.steps);
        assert!((ratio - 1.0).abs() < 1e-3, "{solve}: {ratio}");
    }
    let calm = run(Scene { solve: "time_step = adaptive(1e-4)", ..Scene::default() }, Files::default());
    assert!(calm.steps < reference.steps, "{} {}", calm.steps, reference.steps);
}

#[test]
fn an_absorbing_end_disturbs_no_more_than_a_clamp() {
    let (clamped, absorbing) =
        (plain(), run(Scene { track: "rail_ends = absorbing", ..Scene::default() }, Files::default()));
    for (a, b) in clamped.sleepers.iter().zip(&absorbing.sleepers).filter(|(a, _)| (10.0..26.0).contains(&a.x_m)) {
        assert!((a.max_contact_force_N / b.max_contact_force_N - 1.0).abs() < 2e-3, "{}", a.sleeper);
        assert!((a.gravity_contact_force_N / b.gravity_contact_force_N - 1.0).abs() < 1e-6, "{}", a.sleeper);
    }
    // At rest the rail bends at no end.
    let outer = &absorbing.sleepers[0];
    assert!((outer.gravity_contact_force_N / absorbing.middle().gravity_contact_force_N - 1.0).abs() < 0.02);
}

#[test]
fn auxiliary_rails_take_load_from_a_sleeper() {
    let beside = "auxiliary_rails = { rail = rails.UIC60, count = 2, pad = pads.ahmadi_2026 }";
    let (alone, helped) = (plain(), run(Scene { trackform: beside, ..Scene::default() }, Files::default()));
    let ratio = helped.middle().max_contact_force_N / alone.middle().max_contact_force_N;
    println!("contact force {ratio:.3} times that without");
    assert!((0.93..0.99).contains(&ratio), "{ratio}");
    let dead = helped.middle().gravity_contact_force_N - alone.middle().gravity_contact_force_N;
    assert!((dead / (60.21 * 0.6 * 9.81) - 1.0).abs() < 0.02, "the weight of a rail more: {dead} N");
}

#[test]
fn a_seating_support_gives_before_it_carries() {
    let soft = "stiffness = 50 MN/m per seat, damping_time = 1 ms, seating = { stiffness = 5 MN/m per seat, closure = 0.6 mm }";
    let (stiff, seating) = (plain(), run(Scene { support: Some(soft), ..Scene::default() }, Files::default()));
    // The dead load of some 1.7 kN closes 0.34 mm of the 0.6 mm.
    let more = seating.middle().max_sleeper_displacement_m - stiff.middle().max_sleeper_displacement_m;
    println!("sleeper sinks {:.3} mm further", 1e3 * more);
    assert!((0.15e-3..0.3e-3).contains(&more), "{more}");
    let dead = seating.middle().gravity_contact_force_N / stiff.middle().gravity_contact_force_N;
    assert!((dead - 1.0).abs() < 1e-3, "{dead}");
}

#[test]
fn a_dip_of_the_rail_is_felt() {
    let dip =
        |x: f64| if (17.0..19.0).contains(&x) { 0.5 * (1.0 + (std::f64::consts::PI * (x - 18.0)).cos()) } else { 0.0 };
    let rows: String = (0..=360).map(|i| f64::from(i) * 0.1).map(|x| format!("{x:.1},{:.6}\n", dip(x))).collect();
    let file = format!("x_m,level_mm\n{rows}");
    let files = Files([("level.csv", file)].into());
    let found = run(Scene { track: "irregularity = file(\"level.csv\")", ..Scene::default() }, files);
    println!(
        "wheel force {:.3} .. {:.3} of the static one",
        found.min_wheel_force / WHEEL,
        found.max_wheel_force / WHEEL
    );
    assert!(found.max_wheel_force > 1.1 * WHEEL && found.min_wheel_force < 0.9 * WHEEL);
    let even = plain();
    assert!(even.max_wheel_force < 1.02 * WHEEL && even.min_wheel_force > 0.98 * WHEEL);
}

#[test]
fn a_train_that_slows_down_takes_its_time() {
    let speed = Some("[0 .. 18 m: 108 km/h, 18 .. 36 m: ramp(108 .. 54 km/h)]");
    let solve = "start = 15 m, finish = 30 m";
    let found = run(Scene { speed, solve, ..Scene::default() }, Files::default());
    // 3 m at 30 m/s, then dx/v with v = 30 m/s - 15 m/s (x - 18 m)/18 m.
    let exact = 3.0 / 30.0 + 18.0 / 15.0 * (30.0f64 / 20.0).ln();
    assert!((found.duration - exact).abs() < 1e-3, "{} {exact}", found.duration);
}

#[test]
fn all_of_it_at_once() {
    let found = run(
        Scene {
            trackform: "auxiliary_rails = { rail = rails.S49, count = 2, pad = pads.soft }, settlement = [0 .. 17 m: 0 mm, 17 .. 19 m: 1.5 mm, 19 .. 36 m: 0 mm]",
            track: "rail_ends = absorbing, irregularity = [0 m: 0 mm, 16 m: 0 mm, 18 m: 0.8 mm, 20 m: 0 mm, 36 m: 0 mm]",
            speed: Some("[0 m: 120 km/h, 36 m: 160 km/h]"),
            solve: "beam = timoshenko, integrator = hht, time_step = adaptive(1e-5)",
            support: Some(
                "stiffness = 50 MN/m per seat, damping_time = 1 ms, seating = { stiffness = 10 MN/m per seat, closure = 0.2 mm }",
            ),
        },
        Files::default(),
    );
    println!(
        "wheel force {:.3} .. {:.3} of the static one",
        found.min_wheel_force / WHEEL,
        found.max_wheel_force / WHEEL
    );
    assert!(found.min_wheel_force > 0.5 * WHEEL && found.max_wheel_force < 1.6 * WHEEL);
    assert!(
        found.sleepers.iter().any(|row| row.void_m > 1e-4 && row.gravity_contact_force_N == 0.0),
        "a sleeper hangs"
    );
}

/// A bench under a jack of 100 kN, its state of rest with gravity or without; what is recorded of its seats, and its
/// scalars.
fn jacked(gravity: &str, support: &str) -> trackbed::results::Run {
    let text = format!(
        "use std
trackform seats {{
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m, support = {support}
}}
track bench {{ sections = [seats: 41 sleepers], rail_ends = free }}
load jack {{ on = rail, at = 21 sleepers, force = 100 kN per rail }}
record {{ quantities = [rail_seat_load, contact_force, sleeper_displacement] }}
solve {{ gravity = {gravity} m/s^2 }}
"
    );
    trackbed::Scene::from_text(&text).run().unwrap_or_else(|stopped| panic!("{stopped:?}"))
}

#[test]
fn displacements_under_test_loads_count_from_the_track_at_rest() {
    let [with, without] = ["9.81", "0"].map(|gravity| jacked(gravity, "rigid"));
    let of = |run: &trackbed::results::Run, name: &str| run.scalar(name).unwrap();
    let deepest = of(&with, "max_rail_displacement") / of(&without, "max_rail_displacement");
    assert!((deepest - 1.0).abs() < 1e-9, "gravity bends nothing more: {deepest}");
    // the rail alone weighs on the pads
    let level: Vec<f64> = with.histories.iter().filter(|h| h.quantity == "rail_level").map(|h| h.value).collect();
    assert!(!level.is_empty() && level.iter().all(|deep| (1e-6..1e-4).contains(deep)), "{level:?}");
}

#[test]
fn seat_loads_under_a_jack_carry_it_and_the_weight() {
    let rail = 60.21 * 41.0 * 0.6 * 9.81;
    for (support, sleepers) in [("rigid", 0.0), ("{ stiffness = 50 MN/m per seat }", 145.0 * 41.0 * 9.81)] {
        let run = jacked("9.81", support);
        let sum = |name: &str| -> f64 { run.histories.iter().filter(|h| h.quantity == name).map(|h| h.value).sum() };
        let found = sum("rail_seat_load");
        assert!((found / (100e3 + rail) - 1.0).abs() < 1e-3, "{support}: {found} N");
        let middle = run.sleepers.iter().find(|row| row.sleeper == "+21").unwrap();
        if sleepers > 0.0 {
            let found = sum("contact_force");
            assert!((found / (100e3 + rail + sleepers) - 1.0).abs() < 1e-3, "{found} N");
            let weight = (rail + sleepers) / 41.0;
            assert!((middle.gravity_contact_force_N / weight - 1.0).abs() < 0.01, "without the jack: {middle:?}");
            let share = middle.max_contact_force_N - middle.gravity_contact_force_N;
            assert!((share / 50e6 / middle.max_sleeper_displacement_m - 1.0).abs() < 1e-9, "{middle:?}");
        }
    }
}
