//! Mixes of trains: their shares and order, what they do to the track together, and what is said against a mix that is
//! none.

use trackbed::check::NoModules;
use trackbed::diag::{Code, render};
use trackbed::execute;
use trackbed::graph::{Graph, Schedule};
use trackbed::results::RunRecorder;
use trackbed::scenario::Scenario;
use trackbed::{Compiled, compile};

mod common {
    pub mod stopping;
}
use common::stopping::stops_and_goes_on;

/// A transition zone that runs in a moment, and trains to run over it.
const SCENE: &str = r#"use std
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 15 m, stiff: 12 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 120 km/h }
train twin : ore { }
train heavy { vehicles = vehicles.ore_wagon_30t, speed = 60 km/h }
law bed : laws.varandas_2014 { form.gamma = 10 mm }
law hard : laws.hettler_1984 { }
scenario { allow = [stiffness_jump: "a test", passing_frequency: "a test", wheel_on_track: "a test"] }
"#;

fn check(rest: &str) -> Compiled {
    compile("scene.track", &format!("{SCENE}{rest}"), &NoModules, &[])
}

fn told(compiled: &Compiled) -> String {
    render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn parts(rest: &str) -> (Scenario, Graph) {
    let compiled = check(rest);
    assert!(compiled.diagnostics.iter().all(|d| !d.is_error()), "{}", told(&compiled));
    (compiled.scenario.unwrap(), compiled.graph.unwrap())
}

/// Traffic, how it is run, and the histories kept.
fn traffic(trains: &str, law: &str) -> String {
    format!(
        "traffic {{ {trains}, total = 120 axles }}
solve {{ law = {law}, update_every = 20 axles, elements_per_bay = 2, time_step = 2e-4 s }}
record {{ at = -3 sleepers, after = [0, 60, 120] axles, quantities = contact_force }}"
    )
}

/// Settlement of every seat after the last train, m.
fn settled(rest: &str) -> Vec<f64> {
    let (scenario, graph) = parts(rest);
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut recorder).unwrap();
    recorder.tables.sleepers.iter().filter(|row| row.axles == 120).map(|row| row.settlement_m).collect()
}

#[test]
fn two_trains_that_are_one_settle_the_track_as_one() {
    for law in ["bed", "hard"] {
        let one = settled(&traffic("trains = ore", law));
        for order in ["interleaved", "in_turn"] {
            let both = settled(&traffic(&format!("trains = [ore: 50 %, twin: 50 %], order = {order}"), law));
            let apart = one.iter().zip(&both).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-9, "{law} {order}: {apart} m");
        }
    }
}

#[test]
fn a_mix_settles_more_than_its_lighter_train_and_less_than_its_heavier() {
    let light = settled(&traffic("trains = ore", "bed"));
    let heavy = settled(&traffic("trains = heavy", "bed"));
    let deepest = |settled: &[f64]| settled.iter().copied().fold(0.0, f64::max);
    let mut last = deepest(&light);
    for share in [20, 50, 80] {
        let mix = settled(&traffic(&format!("trains = [ore: {} %, heavy: {share} %]", 100 - share), "bed"));
        // far from the transition both load every seat alike
        for seat in 5..15 {
            assert!(light[seat] < mix[seat] && mix[seat] < heavy[seat], "{share} %: seat {seat}");
        }
        assert!(deepest(&mix) > last, "{share} %");
        last = deepest(&mix);
    }
    assert!(last < deepest(&heavy));
}

#[test]
fn results_name_the_train() {
    let (scenario, graph) = parts(&traffic("trains = [ore: 50 %, heavy: 50 %]", "bed"));
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut recorder).unwrap();
    let force = |train: &str, quantity: &str| {
        let of =
            recorder.histories.iter().filter(|row| row.train == train && row.quantity == quantity && row.axles == 60);
        of.map(|row| row.value).fold(0.0, f64::max)
    };
    // 20 t and 30 t an axle
    assert!((95e3..130e3).contains(&force("ore", "wheel_force")), "{}", force("ore", "wheel_force"));
    assert!((140e3..180e3).contains(&force("heavy", "wheel_force")), "{}", force("heavy", "wheel_force"));
    assert!(force("heavy", "contact_force") > 1.2 * force("ore", "contact_force"));
    let tables = &recorder.tables;
    let rows: Vec<(u64, &str, u64)> = tables.trains.iter().map(|r| (r.axles, r.train.as_str(), r.passed)).collect();
    let expected = [(0, 0), (60, 8), (120, 15)];
    assert_eq!(rows.len(), 6);
    for ((axles, passed), pair) in expected.iter().zip(rows.chunks(2)) {
        assert_eq!((pair[0].0, pair[0].1, pair[1].1), (*axles, "ore", "heavy"));
        assert!(pair[0].2 + pair[1].2 == axles / 4 && pair[0].2.abs_diff(*passed) <= 1);
    }
    // tables along the track hold the larger of both
    let heavy = tables.trains.iter().find(|r| r.train == "heavy" && r.axles == 120);
    let row = tables.sleepers.iter().filter(|r| r.axles == 120).map(|r| r.max_contact_force_N).fold(0.0, f64::max);
    assert_eq!(Some(row), heavy.map(|r| r.max_contact_force_N));
    assert!(tables.laws.is_empty() && scenario.loading.is_some());
}

#[test]
fn trains_in_turn_end_a_block_where_they_change() {
    let mix = "trains = [ore: 60 %, heavy: 40 %], order = in_turn";
    let (_, graph) = parts(&traffic(mix, "bed"));
    let Schedule::Blocks(blocks) = &graph.schedule else { panic!("traffic") };
    let kinds: Vec<(u64, Vec<usize>)> =
        blocks.planned().unwrap().iter().map(|b| (b.before, b.runners().iter().map(|r| r.kind).collect())).collect();
    assert!(kinds.iter().all(|(before, kinds)| kinds == &[usize::from(*before >= 72)]), "{kinds:?}");
    assert!(kinds.iter().any(|(before, _)| *before == 72));
    // the mix says what it has become
    assert!(
        graph.listing().text().contains("pass mix: 18 of `ore` (60 % of the axles), 12 of `heavy` (40 % of the axles)")
    );
}

/// Passages that the plan expects, those that a run computes, and how many blocks it takes back.
fn passages(rest: &str) -> (u64, u64, u64) {
    let (scenario, graph) = parts(rest);
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut recorder).unwrap();
    let blocks = &recorder.tables.blocks;
    let sum = |of: fn(&trackbed::results::BlockRow) -> u64| blocks.iter().map(of).sum();
    (graph.cost.passages().passages, sum(|block| block.passages), sum(|block| block.rejected))
}

const BOTH_WAYS: &str = "train ore_both : ore { direction = both }
train heavy_both : heavy { direction = both }
";

#[test]
fn the_plan_counts_every_passage_of_prescribed_blocks() {
    let tamped = "tamping spring { after = 60 axles }";
    let back = "train back : ore { direction = backward }";
    for (trains, rest) in [
        ("trains = ore", ""),
        ("trains = ore_both", ""),
        ("trains = [ore: 60 %, heavy_both: 40 %]", ""),
        ("trains = [ore_both: 70 %, heavy: 30 %], order = in_turn", ""),
        ("trains = [ore: 90 %, back: 10 %]", back),
        ("trains = [ore: 60 %, heavy: 40 %]", tamped),
    ] {
        let scene = format!("{BOTH_WAYS}{rest}\n{}", traffic(trains, "bed"));
        let (planned, run, rejected) = passages(&scene);
        assert_eq!((planned, rejected), (run, 0), "{trains} {rest}");
    }
}

#[test]
fn the_plan_knows_about_how_many_passages_an_adaptive_run_takes() {
    for (trains, law, tolerance) in [
        ("[ore: 60 %, heavy: 40 %]", "bed", "0.003 mm"),
        ("[ore_both: 70 %, heavy_both: 30 %]", "bed", "0.02 mm"),
        ("[ore: 80 %, heavy: 20 %]", "hard", "0.003 mm"),
    ] {
        let scene = format!(
            "{BOTH_WAYS}traffic {{ trains = {trains}, total = 400 axles }}
solve {{ law = {law}, update_every = adaptive({tolerance}), elements_per_bay = 2, time_step = 4e-4 s }}
record {{ at = -3 sleepers, after = [0, 60, 400] axles, quantities = contact_force }}"
        );
        let (planned, run, _) = passages(&scene);
        let off = planned as f64 / run as f64 - 1.0;
        assert!(off.abs() < 0.3, "{trains}, {law}: {planned} planned, {run} run");
    }
}

#[test]
fn a_track_that_cannot_settle_is_planned_as_it_runs() {
    let slab = SCENE.replace("[open: 15 m, stiff: 12 m]", "[stiff: 27 m]");
    let compiled =
        compile("scene.track", &format!("{slab}traffic {{ trains = ore, total = 80 axles }}"), &NoModules, &[]);
    let (scenario, graph) = (compiled.scenario.as_ref().unwrap(), compiled.graph.as_ref().unwrap());
    let mut recorder = RunRecorder::new(scenario, graph);
    execute::execute(graph, &mut recorder).unwrap();
    let passages: u64 = recorder.tables.blocks.iter().map(|block| block.passages).sum();
    assert_eq!(
        (graph.cost.passages().passages, graph.cost.passages().blocks + 1),
        (passages, recorder.tables.blocks.len() as u64)
    );
}

#[test]
fn counts_may_be_the_mass_that_trains_carry() {
    // wagons of 80 t and 120 t
    let (scenario, graph) = parts(
        "traffic { trains = [ore: 40 %, heavy: 60 %], total = 0.004 MGT }
record { at = -3 sleepers, after = [0, 0.001, 0.004] MGT, quantities = contact_force }
expect { that = [max(settlement, after = 0.001 MGT) < max(settlement, after = 0.004 MGT)] }",
    );
    let Schedule::Blocks(blocks) = &graph.schedule else { panic!("traffic") };
    assert_eq!(blocks.sequence.shares.iter().map(|share| share.trains).collect::<Vec<_>>(), [20, 20]);
    assert_eq!((blocks.total, blocks.recorded.clone()), (160, vec![0, 40, 160]));
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut recorder).unwrap();
    assert!(recorder.tables.sleepers.iter().any(|row| row.axles == 40));
}

#[test]
fn every_train_of_a_mix_is_held_against_the_rules() {
    let springs = "vehicle stiff_wagon : vehicles.ore_wagon_20t { secondary.stiffness = 90 MN/m per bogie, \
                   primary.stiffness = 100 MN/m per wheel }
train hard_riding { vehicles = stiff_wagon, speed = 60 km/h }
";
    let found = |trains: &str| {
        let compiled = check(&format!("{springs}traffic {{ trains = {trains}, total = 80 axles }}"));
        compiled.diagnostics.iter().filter(|d| d.code == Code::L1017).count()
    };
    assert_eq!((found("ore"), found("[ore: 50 %, hard_riding: 50 %]"), found("hard_riding")), (0, 1, 1));
}

#[test]
fn a_mix_that_is_none_is_refused() {
    let refusals = [
        ("traffic { trains = [ore: 70 %, heavy: 40 %], total = 120 axles }", Code::E0407, "sum to 110 %"),
        ("traffic { trains = [ore, heavy], total = 120 axles }", Code::E0407, "sum to 200 %"),
        ("traffic { trains = [ore: 60 %, ore: 40 %], total = 120 axles }", Code::E0404, "`ore` is given twice"),
        (
            "traffic { trains = [ore: 99 %, heavy: 1 %], total = 120 axles }",
            Code::E0602,
            "1.2 axles, less than half of one train",
        ),
        ("traffic { trains = [ore: 50 %, heavy: 50 %], total = 120 axles, order = mixed }", Code::E0408, "mixed"),
        ("traffic { trains = [], total = 120 axles }", Code::E0403, "needs a train"),
    ];
    for (text, code, says) in refusals {
        let compiled = check(text);
        let found: Vec<Code> = compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
        assert_eq!(found, [code], "{text}: {}", told(&compiled));
        assert!(told(&compiled).contains(says), "{}", told(&compiled));
    }
}

#[test]
fn each_train_is_held_against_its_own_static_load() {
    let (scenario, graph) = parts(&traffic("trains = [ore: 50 %, heavy: 50 %]", "bed"));
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut recorder).unwrap();
    let last: Vec<_> = recorder.tables.trains.iter().filter(|row| row.axles == 120).collect();
    assert_eq!(last.iter().map(|row| row.train.as_str()).collect::<Vec<_>>(), ["ore", "heavy"]);
    for (row, tonnes) in last.iter().zip([20.0, 30.0]) {
        // half an axle's load; ore wagons of the library are named by their axle load
        assert!((row.static_wheel_load_N / (tonnes * 0.5e3 * 9.81) - 1.0).abs() < 0.03, "{row:?}");
        assert_eq!(row.dynamic_amplification, row.max_wheel_force_N / row.static_wheel_load_N);
        assert_eq!(row.wheel_unloading, 1.0 - row.min_wheel_force_N / row.static_wheel_load_N);
    }
    let scalars = recorder.scalars();
    let worst = |of: fn(&trackbed::results::TrainRow) -> f64| last.iter().map(|row| of(row)).fold(0.0, f64::max);
    assert_eq!(scalars["dynamic_amplification"].value, worst(|row| row.dynamic_amplification));
    assert_eq!(scalars["wheel_unloading"].value, worst(|row| row.wheel_unloading));
    // the light train's least force is no sign that the heavy train loses a third of its load
    let mistaken = 1.0 - scalars["min_wheel_force"].value / last[1].static_wheel_load_N;
    assert!(mistaken > 0.3 && scalars["wheel_unloading"].value < 0.2, "{mistaken}: {scalars:?}");
}

#[test]
fn a_stopped_mix_goes_on_with_the_same_bits() {
    let (_, graph) = parts(
        "train back : heavy { direction = both }
traffic { trains = [ore: 70 %, back: 30 %], total = 80 axles }
solve { law = bed, elements_per_bay = 2, time_step = 2e-4 s }
record { at = -3 sleepers, after = [0, 40, 80] axles, quantities = contact_force }",
    );
    stops_and_goes_on(&graph, "a mix");
}

#[test]
fn a_tamped_track_begins_afresh() {
    let scene = |tamping: &str| {
        format!(
            "traffic {{ trains = ore, total = 120 axles }}
solve {{ law = [bed, hard], update_every = 12 axles, elements_per_bay = 2, time_step = 2e-4 s }}
record {{ at = -3 sleepers, after = [0, 60, 120] axles, quantities = contact_force }}
{tamping}"
        )
    };
    let run = |tamping: &str| {
        let (scenario, graph) = parts(&scene(tamping));
        let mut recorder = RunRecorder::new(&scenario, &graph);
        execute::execute(&graph, &mut recorder).unwrap();
        recorder.tables
    };
    let at = |tables: &trackbed::results::RunTables, axles: u64, sleeper: &str| {
        let row = tables.sleepers.iter().find(|row| row.axles == axles && row.sleeper == sleeper);
        row.unwrap().settlement_m
    };
    let plain = run("");
    let all = run("tamping spring { after = 60 axles }");
    // as if the run began anew: the record at that count shows the track before
    assert_eq!(at(&all, 60, "-3"), at(&plain, 60, "-3"));
    let again = (at(&all, 120, "-3") / at(&plain, 60, "-3") - 1.0).abs();
    assert!(again < 1e-9, "{again}");
    // some sleepers only, and a tenth stays
    let some = run("tamping spring { after = 60 axles, over = -8 .. -1 sleepers, left = 10 % }");
    assert_eq!(some.tampings.len(), 8);
    for row in &some.tampings {
        assert_eq!(row.axles, 60);
        assert!((row.settlement_after_m - 0.1 * row.settlement_before_m).abs() < 1e-15);
    }
    assert!(at(&some, 120, "-3") < at(&plain, 120, "-3"));
    assert!((at(&some, 120, "-20") / at(&plain, 120, "-20") - 1.0).abs() < 0.02, "far away nothing changes");
    // both laws begin afresh, and both stand in their table before and after
    let counts: Vec<u64> = some.laws.iter().map(|count| count.axles).collect();
    assert_eq!(counts.iter().filter(|axles| **axles == 60).count(), 2);
    let (_, graph) = parts(&scene("tamping spring { after = [24, 60] axles, over = -8 .. -1 sleepers, left = 10 % }"));
    stops_and_goes_on(&graph, "a tamped track");
}

#[test]
fn a_tamping_that_changes_nothing_is_refused() {
    let traffic = "traffic { trains = ore, total = 120 axles }
";
    let refusals = [
        ("tamping a { after = 60 axles, over = 1 .. 4 sleepers }", Code::E0427, "no sleeper on ballast"),
        ("tamping a { after = [0, 60] axles }", Code::E0427, "before the first train"),
        ("tamping a { after = 120 axles }", Code::E0427, "the run ends there"),
        ("tamping a { after = [60, 60] axles }", Code::E0427, "tamped twice after 60 axles"),
        (
            "tamping a { after = 60 axles }
tamping b { after = 60 axles, over = -2 .. -1 sleepers }",
            Code::E0427,
            "tamped twice",
        ),
        ("tamping a { after = 62 axles }", Code::E0602, "in the middle of a train"),
        ("tamping a { after = 600 axles }", Code::E0602, "never reached"),
        ("tamping a { over = -2 .. -1 sleepers }", Code::E0403, "after"),
        ("tamping a { after = 60 axles, left = 110 % }", Code::E0405, "0 .. 100"),
    ];
    for (text, code, says) in refusals {
        let compiled = check(&format!("{traffic}{text}"));
        let found: Vec<Code> = compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
        assert_eq!(found, [code], "{text}: {}", told(&compiled));
        assert!(told(&compiled).contains(says), "{}", told(&compiled));
    }
    let without = check(
        "tamping a { after = 60 axles }
load jack { on = rail, at = -3 sleepers, force = 100 kN per rail }",
    );
    assert!(without.diagnostics.iter().any(|d| d.code == Code::E0427), "{}", told(&without));
}

#[test]
fn records_and_loads_are_mirrored_at_several_transitions() {
    let scene = |rest: &str| {
        let bridge = "track bridge { sections = [stiff: 12 m, open: 40 sleepers, stiff: 12 m], \
                      transitions = [west: stiff_to_soft, east: soft_to_stiff] }
";
        let text =
            format!("{SCENE}{bridge}{rest}").replace("track line { sections = [open: 15 m, stiff: 12 m] }\n", "");
        compile("scene.track", &text, &NoModules, &[])
    };
    let compiled = scene(
        "traffic { trains = ore, total = 8 axles }
record near { from = [west, east], at = [-3, +1] sleepers, quantities = contact_force }
record edge { from = east, over = -1.2 .. 0 m, quantities = rail_moment }",
    );
    let scenario = compiled.scenario.as_ref().unwrap_or_else(|| panic!("{}", told(&compiled)));
    let track = &scenario.track;
    let names = |record: usize| -> Vec<String> {
        scenario.records[record].seats.iter().map(|seat| track.seat_name(&track.seats[*seat])).collect()
    };
    assert_eq!(names(0), ["west:+1", "west:-3", "east:-3", "east:+1"], "{}", told(&compiled));
    assert_eq!(names(1), ["east:-2", "east:-1"], "a span in metres that ends at 0 stays on its side");
    let pressed = scene("load jack { on = sleepers, from = [west, east], at = -3 sleepers, force = 40 kN per seat }");
    let Some(trackbed::scenario::Loading::Static(loads)) = &pressed.scenario.as_ref().unwrap().loading else {
        panic!("{}", told(&pressed))
    };
    assert_eq!(loads.len(), 2);
    assert!((loads[0].x + loads[1].x - track.transitions.iter().map(|t| t.x).sum::<f64>()).abs() < 1e-9);
    for (from, code) in [("[west, west]", Code::E0404), ("[west, weest]", Code::E0504)] {
        let wrong = scene(&format!(
            "traffic {{ trains = ore, total = 8 axles }}
record {{ from = {from}, at = -3 sleepers, quantities = contact_force }}"
        ));
        assert!(wrong.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).eq([code]), "{}", told(&wrong));
    }
}

/// Chainages of the seats, m.
fn seats(track: &str, lets: &str) -> Vec<f64> {
    let text =
        SCENE.replace("track line { sections = [open: 15 m, stiff: 12 m] }", track).replace("  spacing = 0.6 m", lets);
    let compiled = compile("scene.track", &text, &NoModules, &[]);
    let scenario = compiled.scenario.as_ref().unwrap_or_else(|| panic!("{}", told(&compiled)));
    scenario.track.seats.iter().map(|seat| seat.x).collect()
}

fn about(found: &[f64], expected: &[f64]) {
    assert!(found.len() == expected.len(), "{found:?}");
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
}

#[test]
fn seats_beside_a_transition_lie_where_it_says() {
    let usual = "  spacing = 0.6 m";
    let track =
        |side: &str| format!("track line {{ sections = [open: 2 m, stiff: 2 m], transitions = [edge: {side}] }}");
    about(&seats(&track("soft_to_stiff"), usual), &[-1.8, -1.2, -0.6, 0.0, 0.6, 1.2, 1.8]);
    let moved = seats(&track("soft_to_stiff(seats = -0.3 .. 0.3 m)"), usual);
    about(&moved, &[-1.5, -0.9, -0.3, 0.3, 0.9, 1.5]);
    let seated = seats(&track("soft_to_stiff(seats = -0.4 .. 0 m)"), usual);
    about(&seated, &[-1.6, -1.0, -0.4, 0.0, 0.6, 1.2, 1.8]);
    // the other way round, and counted in sleepers
    let mirrored = "track line { sections = [stiff: 3 sleepers, open: 2 sleepers, stiff: 2 sleepers], transitions = \
                    [west: stiff_to_soft(seats = -0.5 .. 0.2 m), east: soft_to_stiff(seats = -0.3 .. 0.3 m)] }";
    about(&seats(mirrored, usual), &[-1.4, -0.8, -0.2, 0.5, 1.1, 1.7, 2.3]);
    let wrong = SCENE.replace(
        "[open: 15 m, stiff: 12 m]",
        "[open: 15 m, stiff: 12 m], transitions = [edge: soft_to_stiff(seats = 0 .. 0.3 m)]",
    );
    let compiled = compile("scene.track", &wrong, &NoModules, &[]);
    assert!(
        compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).eq([Code::E0514]),
        "{}",
        told(&compiled)
    );
}

#[test]
fn the_spacing_of_a_whole_section_varies() {
    let fixed = "trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }";
    let stiff =
        "trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600, spacing = 0.6 m }";
    let of = |track: &str, spacing: &str| {
        let text = SCENE
            .replace("track line { sections = [open: 15 m, stiff: 12 m] }", track)
            .replace("  spacing = 0.6 m", &format!("  spacing = {spacing}"))
            .replace(fixed, stiff);
        let compiled = compile("scene.track", &text, &NoModules, &[]);
        let scenario = compiled.scenario.as_ref().unwrap_or_else(|| panic!("{}", told(&compiled)));
        scenario.track.seats.iter().map(|seat| seat.x).collect::<Vec<f64>>()
    };
    // sleepers -3 .. -1 at 0.6, 0.55 and 0.5 m: each bay is that of the sleeper from which it leads away
    let track = "track line { sections = [open: 3 sleepers, stiff: 2 sleepers] }";
    about(&of(track, "ramp(0.6 .. 0.5 m)"), &[-1.55, -1.0, -0.5, 0.0, 0.6]);
    let behind = "track line { sections = [stiff: 2 sleepers, open: 3 sleepers], transitions = [edge: stiff_to_soft] }";
    about(&of(behind, "ramp(0.5 .. 0.6 m)"), &[-0.6, 0.0, 0.5, 1.0, 1.55]);
    let alone = "track line { sections = [open: 3 sleepers] }";
    let alone = of(alone, "ramp(0.6 .. 0.5 m)");
    about(&[alone[1] - alone[0], alone[2] - alone[1]], &[0.6, 0.55]);
    // in metres as many as fit
    let metres = of("track line { sections = [open: 12 m, stiff: 6 m] }", "ramp(0.7 .. 0.5 m)");
    let bays: Vec<f64> = metres.windows(2).map(|pair| pair[1] - pair[0]).take_while(|bay| *bay < 0.7).collect();
    assert!(metres[0] > -12.0 && metres[0] < -11.0, "{metres:?}");
    assert!(bays.windows(2).take(15).all(|pair| pair[1] < pair[0]), "{bays:?}");
    // and between two transitions
    let bridge = "track line { sections = [stiff: 2 sleepers, open: 3 sleepers, stiff: 2 sleepers], transitions = \
                  [west: stiff_to_soft, east: soft_to_stiff] }";
    about(&of(bridge, "ramp(0.5 .. 0.6 m)"), &[-0.6, 0.0, 0.5, 1.0, 1.55, 2.15, 2.75]);
}
