//! Spacing that varies by places, from a file and at random: seats are laid one after another, each bay as long as the
//! spacing at the sleeper that it leads away from, and what cannot be laid is refused.

use std::path::Path;
use trackbed::check::{DataError, Modules, NoModules};
use trackbed::diag::Code;
use trackbed::execute;
use trackbed::results::RunRecorder;
use trackbed::scenario::Scenario;
use trackbed::{Compiled, compile};

/// A table of spacing beside the scene.
struct Table;

impl Modules for Table {
    fn read(&self, _: &Path) -> Option<Vec<u8>> {
        None
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        let rows = "x_m,spacing_m\n-60,0.65\n-6,0.65\n0,0.5\n";
        (relative == Path::new("spacing.csv")).then(|| rows.into()).ok_or(DataError::Missing)
    }
}

/// An embankment whose sleepers lie so far apart, and what else its track says.
fn text(spacing: &str, length: &str, more: &str) -> String {
    format!(
        "use std
trackform open {{
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = {spacing}
  support = {{ stiffness = 50 MN/m per seat, damping_time = 1 ms }}
}}
trackform deck : open {{ sleeper = none, support = none, slab = slabs.half_width_1600, spacing = 0.6 m }}
track line {{ sections = [open: {length}, deck: 18 m] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 120 km/h }}
traffic {{ trains = ore, total = 4 axles }}
solve {{ elements_per_bay = 1, time_step = 4e-4 s }}
{more}"
    )
}

fn checked(text: &str) -> Compiled {
    compile("scene.track", text, &Table, &[])
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn scene(text: &str) -> Scenario {
    let compiled = checked(text);
    assert!(compiled.diagnostics.iter().all(|d| d.code.rule().is_some()), "{}", told(&compiled));
    compiled.scenario.unwrap()
}

/// Chainages of the sleepers -1, -2, ... of the embankment, outwards.
fn outwards(text: &str) -> Vec<f64> {
    let mut places: Vec<f64> = scene(text).track.seats.iter().map(|s| s.x).filter(|x| *x < 0.0).collect();
    places.reverse();
    places
}

#[track_caller]
fn bays_follow(places: &[f64], spacing: impl Fn(usize, f64) -> f64) {
    for (i, pair) in places.windows(2).enumerate() {
        let (bay, wanted) = (pair[0] - pair[1], spacing(i + 1, pair[0]));
        assert!((bay - wanted).abs() < 1e-6, "behind sleeper -{}, at {} m: {bay}, not {wanted}", i + 1, pair[0]);
    }
}

#[test]
fn places_in_metres_lead_from_sleeper_to_sleeper() {
    let places = outwards(&text("[-30 m: 0.6 m, -10 m: 0.6 m, 0 m: 0.5 m]", "30 m", ""));
    assert_eq!(places[0], -0.5);
    bays_follow(&places, |_, x| if x < -10.0 { 0.6 } else { 0.5 - 0.01 * x });
    assert!(*places.last().unwrap() > -30.0 && places.last().unwrap() - 0.6 <= -30.0 + 1e-6, "the section is full");
}

#[test]
fn places_in_sleepers_go_by_their_numbers() {
    let spacing = "[-50 .. -7 sleepers: 0.65 m, -6 .. -1 sleepers: ramp(0.6 .. 0.5 m)]";
    let places = outwards(&text(spacing, "50 sleepers", ""));
    assert_eq!(places.len(), 50);
    bays_follow(&places, |n, _| if n > 6 { 0.65 } else { 0.5 + 0.02 * (n - 1) as f64 });
}

#[test]
fn a_ramp_with_its_own_span_keeps_its_ends_beyond_it() {
    let places = outwards(&text("ramp(0.65 .. 0.5 m, over = -12 .. -2 sleepers)", "50 sleepers", ""));
    bays_follow(&places, |n, _| (0.5 + 0.015 * (n as f64 - 2.0)).clamp(0.5, 0.65));
}

#[test]
fn a_file_says_it_at_chainages() {
    let places = outwards(&text("file(\"spacing.csv\")", "40 m", ""));
    bays_follow(&places, |_, x| if x < -6.0 { 0.65 } else { 0.5 - 0.025 * x });
}

#[test]
fn random_bays_hang_on_seed_and_chainage_alone() {
    let random = "random(0.6 m, sd = 8 mm, correlation = 2 m)";
    let places = outwards(&text(random, "30 m", ""));
    let bays: Vec<f64> = places.windows(2).map(|pair| pair[0] - pair[1]).collect();
    let mean = bays.iter().sum::<f64>() / bays.len() as f64;
    let deviation = (bays.iter().map(|b| (b - mean).powi(2)).sum::<f64>() / bays.len() as f64).sqrt();
    assert!((mean - 0.6).abs() < 0.008 && (0.003..0.013).contains(&deviation), "{mean} +- {deviation}");
    let longer = outwards(&text(random, "45 m", ""));
    assert_eq!(longer[..places.len()], places[..], "track that goes on changes nothing before it");
    let other = outwards(&text(&random.replace("correlation", "seed = 2, correlation"), "30 m", ""));
    assert_ne!(other[..10], places[..10]);
}

#[test]
fn stretches_vary_it_by_places_too_and_count_from_their_transition() {
    let stretch = "stretch close { over = -10 .. -1 sleepers, spacing = [-10 sleepers: 0.6 m, -1 sleepers: 0.51 m] }\n";
    let text = text("0.6 m", "40 sleepers", stretch).replace("deck: 18 m]", "deck: 18 m], stretches = close");
    let places = outwards(&text);
    bays_follow(&places, |n, _| if n > 10 { 0.6 } else { 0.51 + 0.01 * (n - 1) as f64 });
}

#[test]
fn a_layout_that_cannot_be_is_refused() {
    let wide = text("[-30 m: 0.6 m, 0 m: 0.5 m]", "30 m", "").replace("B70", "B70 { base_width = 0.55 m }");
    let bridge = text("random(0.6 m, cov = 1 %, correlation = 2 m)", "18 m", "")
        .replace("deck: 18 m]", "deck: 18 m, open: 18 m], transitions = [a: soft_to_stiff, b: stiff_to_soft]");
    let cases = [
        (text("[-20 m: 0.6 m, 0 m: 0.5 m]", "30 m", ""), Code::E0506, "the spacing of trackform `open` is not given"),
        (text("[-30 m: 0.6 m, -40 m: 0.5 m]", "30 m", ""), Code::E0501, "the track reaches"),
        (text("random(0.6 m, cov = 40 %, correlation = 2 m)", "30 m", ""), Code::E0605, "are outside 0.3 .. 1.2 m"),
        (text("[-30 m: 0.2 m, 0 m: 0.5 m]", "30 m", ""), Code::E0405, "expected 0.3 .. 1.2 m"),
        (wide, Code::E0407, "overlap: they are"),
        (bridge, Code::E0411, "on a track with several transitions"),
    ];
    for (text, code, message) in cases {
        let compiled = checked(&text);
        let mut found = compiled.diagnostics.iter().filter(|d| d.code.rule().is_none());
        let (first, others) = (found.next().unwrap(), found.count());
        assert_eq!((first.code, others), (code, 0), "{}", told(&compiled));
        assert!(first.message.contains(message), "{}", told(&compiled));
    }
}

#[test]
fn a_track_of_random_bays_runs() {
    let text = text("random(0.6 m, sd = 8 mm, correlation = 2 m)", "30 m", "");
    let compiled = compile("scene.track", &text, &NoModules, &[]);
    let (scene, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scene, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    let rows: Vec<_> = recorder.tables.sleepers.iter().filter(|row| row.axles == 4 && row.x_m < 0.0).collect();
    assert!(rows.len() > 40 && rows.iter().all(|row| row.settlement_m > 0.0 && row.max_contact_force_N > 10e3));
}
