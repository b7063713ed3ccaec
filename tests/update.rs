//! The update interval: what a block of axles may be worth, what becomes of one that is too long, and that nothing of a
//! run hangs on where it stopped or on how many threads it had.

use trackbed::check::NoModules;
use trackbed::execute;
use trackbed::graph::{Block, Graph, Schedule};
use trackbed::results::{BlockRow, RunRecorder};
use trackbed::scenario::Scenario;
use trackbed::solvers::track::Direction;
use trackbed::trials::{Planned, exchange_map};
use trackbed::{Compiled, compile};

mod common {
    pub mod stopping;
}
use common::stopping::stops_and_goes_on;

/// A transition zone that runs in a moment.
const SCENE: &str = r#"
use std
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 15 m, stiff: 12 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h, direction = forward }
traffic { trains = ore, total = 256 axles }
law bed : laws.varandas_2014 { form.gamma = 10 mm }
solve { law = bed, update_every = adaptive, elements_per_bay = 2, time_step = 2e-4 s }
record { at = [-3, +1] sleepers, after = [0, 100, 256] axles, quantities = contact_force }
"#;

fn compiled(set: &[(&str, &str)]) -> Compiled {
    let mut text = SCENE.to_owned();
    for (from, to) in set {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let compiled = compile("scene.track", &text, &NoModules, &[]);
    let errors: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    compiled
}

fn parts(compiled: Compiled) -> (Scenario, Graph) {
    (compiled.scenario.unwrap(), compiled.graph.unwrap())
}

/// Blocks, and the settlement of every seat after the last, m.
fn run(set: &[(&str, &str)], cure: bool) -> (Vec<BlockRow>, Vec<f64>) {
    let (scenario, mut graph) = parts(compiled(set));
    if let Schedule::Blocks(blocks) = &mut graph.schedule {
        blocks.cure = cure;
    }
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute::execute(&graph, &mut recorder).unwrap();
    let rows = &recorder.tables.sleepers;
    let last = rows.last().unwrap().axles;
    let settled = rows.iter().filter(|row| row.axles == last).map(|row| row.settlement_m).collect();
    (recorder.tables.blocks, settled)
}

fn every(blocks: &str) -> (&'static str, String) {
    ("update_every = adaptive", format!("update_every = {blocks}"))
}

/// Passages that a run took: every one has as many steps as that after the last block.
fn passages(blocks: &[BlockRow]) -> u64 {
    blocks.iter().map(|b| b.time_steps).sum::<u64>() / blocks.last().unwrap().time_steps
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn deepest(settled: &[f64]) -> f64 {
    settled.iter().copied().fold(0.0, f64::max)
}

#[test]
fn adaptive_blocks_meet_their_tolerance_with_few_passages() {
    let (from, to) = every("4 axles");
    let (single, reference) = run(&[(from, &to)], true);
    assert_eq!(passages(&single), 65);
    assert!(single.iter().all(|b| b.error_m == 0.0), "one train a block is exact");
    let (blocks, settled) = run(&[], true);
    assert!(passages(&blocks) <= 17, "{} passages", passages(&blocks));
    assert!(apart(&settled, &reference) < 3e-6, "{} m", apart(&settled, &reference));
    let estimate: f64 = blocks.iter().map(|b| b.error_m).sum();
    assert!(apart(&settled, &reference) < estimate, "the estimate is above the error");
    // whole trains, up to every recorded count
    assert!(blocks.iter().all(|b| b.axles + b.block_axles <= 256 && b.block_axles.is_multiple_of(4)));
    assert!([0, 100, 256].iter().all(|count| blocks.iter().any(|b| b.axles == *count)));
    assert!(blocks.iter().all(|b| b.error_m <= 3e-6));
    // a tighter tolerance comes closer
    let (from, to) = every("adaptive(0.0005 mm)");
    let (more, closer) = run(&[(from, &to)], true);
    assert!(passages(&more) > passages(&blocks) && apart(&closer, &reference) < apart(&settled, &reference));
}

#[test]
fn a_tolerance_out_of_reach_costs_no_more_than_every_train() {
    let (from, to) = every("adaptive(0.000001 mm)");
    let (blocks, settled) = run(&[(from, &to), ("total = 256", "total = 64"), ("[0, 100, 256]", "[0, 64]")], true);
    let (from, to) = every("4 axles");
    let (single, reference) = run(&[(from, &to), ("total = 256", "total = 64"), ("[0, 100, 256]", "[0, 64]")], true);
    assert_eq!(apart(&settled, &reference), 0.0, "two trains a block are exact");
    assert!(passages(&blocks) <= passages(&single) + blocks.iter().map(|b| b.rejected).sum::<u64>());
}

#[test]
fn forces_follow_the_settlement_within_a_long_block() {
    // ten times as soft a bed: with forces that stay as they are, blocks of 32 axles already overshoot
    let soft = ("form.gamma = 10 mm", "form.gamma = 100 mm");
    let with = |blocks: &str| {
        let (from, to) = every(blocks);
        run(&[soft, (from, &to), ("[0, 100, 256]", "[0, 256]")], true)
    };
    let (single, reference) = with("4 axles");
    let (blocks, settled) = with("adaptive(0.3 mm)");
    assert!(4 * passages(&blocks) < passages(&single), "{} passages in {} blocks", passages(&blocks), blocks.len());
    let off = apart(&settled, &reference) / deepest(&reference);
    assert!(off < 1e-2, "{off} of the largest settlement");
}

#[test]
fn a_cap_bounds_the_settlement_of_a_block() {
    let (from, to) = every("adaptive(0.05 mm, cap = 0.05 mm)");
    let (blocks, _) = run(&[(from, &to)], true);
    let long = blocks.iter().filter(|b| b.block_axles > 8);
    assert!(long.clone().count() > 3);
    assert!(long.clone().all(|b| b.max_settlement_step_m < 0.0505e-3));
}

/// A law without hardening, so that one length of block is as good everywhere.
const STEADY: (&str, &str) =
    ("form.gamma = 10 mm", "form = varandas(beta = 0, gamma = 2 mm, reference_cycles = 500 axles)");

#[test]
fn the_exchange_is_of_first_order_in_the_block() {
    let with = |blocks: &str| {
        let (from, to) = every(blocks);
        run(&[STEADY, (from, &to), ("[0, 100, 256]", "[0, 256]")], true).1
    };
    let reference = with("4 axles");
    let errors = ["128 axles", "64 axles", "32 axles", "16 axles"].map(|blocks| apart(&with(blocks), &reference));
    // what separates a block of n trains from n blocks of one goes with n - 1
    let orders: Vec<f64> = errors
        .windows(2)
        .zip([32.0, 16.0, 8.0])
        .map(|(pair, trains): (&[f64], f64)| (pair[0] / pair[1]).ln() / ((trains - 1.0) / (trains / 2.0 - 1.0)).ln())
        .collect();
    assert!(orders.iter().all(|order| (0.8..1.2).contains(order)), "orders {orders:?}, errors {errors:?} m");
}

#[test]
fn a_block_far_too_long_oscillates_and_is_cured() {
    let fresh = ("form.gamma = 10 mm", "form.gamma = 100 mm");
    let with = |blocks: &str, cure: bool| {
        let (from, to) = every(blocks);
        run(&[fresh, (from, &to), ("[0, 100, 256]", "[0, 256]")], cure)
    };
    let (_, reference) = with("4 axles", true);
    let (wild, far) = with("32 axles", false);
    let worst = |blocks: &[BlockRow], of: fn(&BlockRow) -> f64| blocks.iter().map(of).fold(0.0, f64::max);
    let (overshoot, sawtooth) = (worst(&wild, |b| b.overshoot), worst(&wild, |b| b.sawtooth));
    assert!(overshoot > 2.0 && sawtooth > 0.1, "overshoot {overshoot}, sawtooth {sawtooth}");
    assert!(deepest(&far) > 1.5 * deepest(&reference), "{} m and {} m", deepest(&far), deepest(&reference));
    assert!(BlockRow::overshoot(&wild).unwrap().contains("alternates from sleeper to sleeper"));

    let (cured, near) = with("32 axles", true);
    assert!(worst(&cured, |b| b.sawtooth) < 0.1, "{}", worst(&cured, |b| b.sawtooth));
    let beyond = |b: &&BlockRow| b.block_axles > 4 && b.overshoot > 1.0;
    assert_eq!(cured.iter().filter(beyond).count(), 0, "only single trains cannot be shortened");
    assert!(apart(&near, &reference) < 0.01 * deepest(&reference), "{} m", apart(&near, &reference));
    assert!(BlockRow::overshoot(&cured).unwrap().contains("repeated with half the length"));
}

#[test]
fn a_calm_run_overshoots_nowhere() {
    let (from, to) = every("geometric(4 axles, 0.2)");
    let (blocks, _) = run(&[(from, &to)], true);
    assert!(blocks.iter().all(|b| b.rejected == 0 && b.overshoot < 0.5 && b.sawtooth < 0.1));
    assert_eq!(BlockRow::overshoot(&blocks), None);
    assert!(blocks.iter().any(|b| b.error_m > 0.0), "what a block errs is estimated for every policy");
}

#[test]
fn a_stopped_run_goes_on_with_the_same_bits() {
    for (blocks, direction) in [("adaptive", "both"), ("adaptive", "forward"), ("32 axles", "backward")] {
        let (from, to) = every(blocks);
        let direction = ("direction = forward", format!("direction = {direction}"));
        let law = ("form.gamma = 10 mm", "form.gamma = 60 mm"); // so that some blocks are done again
        let (_, graph) = parts(compiled(&[
            (from, &to),
            (direction.0, &direction.1),
            law,
            ("total = 256", "total = 128"),
            ("[0, 100, 256]", "[0, 64, 128]"),
        ]));
        stops_and_goes_on(&graph, blocks);
    }
}

#[test]
fn both_directions_share_the_trains_of_a_run() {
    let (from, to) = every("12 axles");
    let (_, graph) = parts(compiled(&[(from, &to), ("direction = forward", "direction = both")]));
    let Schedule::Blocks(blocks) = &graph.schedule else { panic!("traffic") };
    let planned = blocks.planned().unwrap();
    let all = |of: fn(&Block) -> u64| planned.iter().map(of).sum::<u64>();
    assert_eq!((all(|b| b.towards(Direction::Forward)), all(|b| b.towards(Direction::Backward))), (32, 32));
    assert_eq!(all(|b| b.axles), 256);
}

#[test]
fn several_scenes_at_once_are_each_alone() {
    let scenes = ["forward", "backward", "both"].map(|direction| {
        let direction = format!("direction = {direction}");
        parts(compiled(&[
            ("direction = forward", &direction),
            ("total = 256", "total = 64"),
            ("[0, 100, 256]", "[0, 64]"),
        ]))
    });
    let mut runs: Vec<(&Graph, RunRecorder<'_>)> =
        scenes.iter().map(|(scenario, graph)| (graph, RunRecorder::new(scenario, graph))).collect();
    assert!(execute::execute_all(&mut runs).iter().all(Result::is_ok));
    for ((scenario, graph), (_, together)) in scenes.iter().zip(&runs) {
        let mut alone = RunRecorder::new(scenario, graph);
        execute::execute(graph, &mut alone).unwrap();
        assert!(alone.tables == together.tables && alone.histories == together.histories);
    }
}

#[test]
fn a_disturbance_grows_in_blocks_beyond_the_limit_unless_the_forces_follow() {
    let (from, to) = every("32 axles");
    let rate = STEADY.1.replace("gamma = 2 mm", "gamma = 100 mm");
    let compiled = compiled(&[(STEADY.0, &rate), (from, &to), ("[0, 100, 256]", "[0, 256]")]);
    let planned = Planned::new(compiled.graph.as_ref().unwrap(), &compiled.origins).unwrap();
    let map = exchange_map(&planned, &mut || ()).unwrap().expect("a law");
    let grows = map.cells.iter().filter(|cell| cell.stays > 1.0).count();
    assert!(grows >= 3 && grows + 3 < map.cells.len(), "both happen: {:#?}", map.cells);
    assert_eq!(map.against_theory(), 0, "{:#?}", map.cells);
    // a law without hardening: A is proportional to the length of the block
    let first: Vec<f64> =
        map.cells.iter().filter(|cell| cell.axles == 0).map(|c| c.amplification / c.block_axles as f64).collect();
    assert!(first.iter().all(|per_axle| (per_axle / first[0] - 1.0).abs() < 0.1), "{first:?}");
    assert!(map.largest_following() < 1.0, "{}", map.largest_following());
    let limit = map.limit(0).expect("a limit");
    let (block, margin) = map.margin().unwrap();
    assert_eq!(block[1], 32);
    assert!((margin - limit / 32.0).abs() < 0.3 * margin, "{limit} {margin}");
}
