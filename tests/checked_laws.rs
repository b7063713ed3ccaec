//! A settlement law that cells of grains check while it runs.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use trackbed::check::NoModules;
use trackbed::compile::{Compiled, compile};
use trackbed::diag::Code;
use trackbed::execute::{Checkpoint, Event, Executor, Listener};
use trackbed::graph::Graph;
use trackbed::nodes::Checked;
use trackbed::scenario::Tier;
use trackbed::store::Beds;

mod common {
    pub mod coarse_cells;
    pub mod program;
}
use common::coarse_cells::SCENE;
use common::program::{said, trackbed};

const LAW: &str =
    "law own { form = power(a = 0.1 mm, reference_force = 40 kN per seat, m = 1, b = 0.5), error = 5 % }\ntraffic {";

/// The small track by a law, with cells under so many sleepers.
fn checked(cells: u32) -> String {
    let solve = format!("substructure = law, law = own, check_cells = {cells}, seed = 1,");
    SCENE.replace("traffic {", LAW).replace("substructure = cells,", &solve)
}

fn compiled(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

fn graph(text: &str) -> Graph {
    let compiled = compiled(text);
    let said = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
    compiled.runnable().cloned().unwrap_or_else(|| panic!("{said}"))
}

/// What a run tells of its check.
#[derive(Default)]
struct Heard {
    axles: Vec<u64>,
    seats: Vec<usize>,
    settled: Vec<Vec<f64>>,
    cells: Vec<Vec<Checked>>,
    /// Settlement of every seat after each block, m.
    track: Vec<Vec<f64>>,
    stop_after: Option<u64>,
    kept: Option<Checkpoint>,
}

impl Listener for Heard {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Checked { axles, seats, settled, cells } => {
                self.axles.push(*axles);
                self.seats = seats.to_vec();
                self.settled.push(settled.to_vec());
                self.cells.push(cells.to_vec());
            }
            Event::Block { block: Some(_), after, .. } => self.track.push(after.to_vec()),
            Event::Between(between) if self.stop_after.is_some() && self.axles.last() == self.stop_after.as_ref() => {
                self.kept = Some(between.checkpoint().unwrap());
                return ControlFlow::Break(());
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fn heard(text: &str, beds: &Path, threads: usize, stop_after: Option<u64>, from: Option<Checkpoint>) -> Heard {
    let mut heard = Heard { stop_after, ..Heard::default() };
    let executor = Executor::default().with_beds(Beds::kept_in(beds));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| executor.run(&graph(text), &mut heard, from)).unwrap();
    heard
}

#[test]
fn cells_follow_the_law_without_changing_it_and_a_run_that_was_stopped_ends_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let whole = heard(&checked(2), folder.path(), 2, None, None);
    assert_eq!(whole.axles, [8, 16, 24, 32, 40]);
    let node = graph(&checked(2));
    let seats = &node.track().unwrap().seats;
    assert_eq!(whole.seats.len(), 2);
    assert!(whole.seats.iter().all(|seat| seats[*seat].is_ballasted()));
    for (after, (settled, cells)) in whole.track.iter().zip(whole.settled.iter().zip(&whole.cells)) {
        for ((seat, settled), cell) in whole.seats.iter().zip(settled).zip(cells) {
            assert_eq!(after[*seat], *settled, "the track begins level");
            assert!(cell.settled > 1e-6 && cell.settled < 0.1 && cell.error >= 0.0, "{cell:?}");
        }
    }
    let last = |at: usize| whole.cells[at][0].settled;
    assert!(last(4) > last(0), "the grains go on settling");
    let alone = heard(&checked(0), folder.path(), 2, None, None);
    assert_eq!(alone.track, whole.track, "nothing returns to the track");
    assert!(alone.axles.is_empty());
    let begun = heard(&checked(2), folder.path(), 1, Some(16), None);
    let kept = serde_json::to_string(&begun.kept.expect("stopped")).unwrap();
    let resumed = heard(&checked(2), folder.path(), 1, None, Some(serde_json::from_str(&kept).unwrap()));
    assert_eq!([begun.cells, resumed.cells].concat(), whole.cells);
}

#[test]
fn sleepers_at_even_ranks_of_settlement_are_checked() {
    let checking = |count: u32| {
        let graph = graph(&checked(count));
        graph.check().map_or(Vec::new(), |node| node.cells.iter().map(|cell| cell.seat()).collect::<Vec<_>>())
    };
    assert_eq!(checking(0), Vec::<usize>::new());
    let [one, two, three] = [1, 2, 3].map(checking);
    assert_eq!([one.len(), two.len(), three.len()], [1, 2, 3]);
    assert!(two.contains(&one[0]), "the one that settles most comes first: {one:?} {two:?}");
    assert!(two.iter().all(|seat| three.contains(seat)), "{two:?} {three:?}");
}

#[test]
fn the_summary_the_table_and_the_page_say_how_far_both_part() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("scene.track"), folder.path().join("out"));
    fs::write(&file, checked(1)).unwrap();
    let cache = folder.path().join("beds");
    let run =
        trackbed(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()]);
    assert!(run.status.success(), "{}", said(&run));
    let rows: Vec<(u64, String, f64, f64, f64, f64)> =
        csv::Reader::from_path(out.join("check.csv")).unwrap().deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 5);
    let largest = rows.iter().map(|row| row.4).fold(0.0, f64::max);
    let share = rows.iter().map(|row| (row.3 - row.4).abs()).fold(0.0, f64::max) / largest;
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert!((summary["check_difference"]["value"].as_f64().unwrap() - share).abs() < 1e-12);
    assert!(share > 0.05, "the law of this scene was not fitted to it: {share}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for text in [said(&run), page] {
        assert!(text.contains("more than the 5 % that the law states"), "{text}");
    }
}

#[test]
fn a_check_that_cannot_be_made_is_refused_at_its_cause() {
    let without_grains = checked(1).replace("stone: 200 mm, ", "");
    let mixed = checked(1)
        .replace("traffic {", "train slow : ore { speed = 100 km/h }\ntraffic {")
        .replace("trains = ore,", "trains = [ore: 50 %, slow: 50 %],");
    let messages = |text: &str| {
        let told = compiled(text).to_run().diagnostics;
        let errors = told.iter().filter(|d| d.is_error());
        errors.map(|d| (d.code, d.message.clone())).collect::<Vec<_>>()
    };
    let told = messages(&without_grains);
    let refused = compiled(&without_grains).to_run();
    let place = refused.diagnostics.iter().find(|d| d.is_error()).map(|d| refused.sources.text(d.labels[0].span));
    assert_eq!(place, Some("1"));
    assert!(matches!(&told[..], [(Code::E0604, why)] if why.contains("no section has a layer of grains")), "{told:?}");
    let told = messages(&mixed);
    assert!(matches!(&told[..], [(Code::E0604, why)] if why.contains("trains of several kinds")), "{told:?}");
}

/// The small track whose planner chooses the law, within a wide tolerance, and has it checked.
fn chosen(tolerance: &str) -> String {
    checked(0)
        .replace("substructure = law, law = own, check_cells = 0,", "law = own, budget = 100 h,")
        .replace("tolerance = 20 %", &format!("tolerance = {tolerance}"))
}

#[test]
fn a_law_that_the_planner_chooses_is_checked() {
    // the law states 5 %, and cells 42 %
    let found = compiled(&chosen("57 %"));
    let next = found.next_tier.expect("a check");
    assert_eq!(next.tier, Tier::Cells);
    assert!((next.limit - 0.15).abs() < 1e-9, "{next:?}");
    let graph = found.graph.unwrap();
    assert_eq!(graph.check().map(|node| node.cells.len()), Some(2));
    let why = &graph.decisions.iter().find(|decision| decision.pass == "budget").unwrap().why;
    assert!(why.contains("part by more than 15 % of the largest settlement"), "{why}");

    let next = |text: &str| compiled(text).next_tier;
    assert_eq!(next(&chosen("45 %")), None, "cells are chosen, and nothing checks them");
    assert_eq!(next(&chosen("57 %").replace("budget", "check_cells = 0, budget")), None, "the scene wants no check");
    assert_eq!(next(&chosen("57 %").replace("budget", "substructure = law, budget")), None, "the scene has decided");
}

#[test]
fn a_run_begins_again_on_grains_where_its_law_parts_from_them() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("scene.track"), folder.path().join("out"));
    fs::write(&file, chosen("57 %")).unwrap();
    let cache = folder.path().join("beds");
    let arguments = |more: &[&str]| {
        let own = ["run", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()];
        trackbed(&[&own[..], more].concat())
    };
    let run = arguments(&[]);
    assert!(run.status.success(), "{}", said(&run));
    let told = said(&run);
    assert!(told.contains("begins again with `substructure = cells`") && told.contains("more than the 15 %"), "{told}");
    let resolved = fs::read_to_string(out.join("resolved.track")).unwrap();
    let tier = resolved.lines().find(|line| line.trim_start().starts_with("substructure")).unwrap();
    assert!(tier.contains("= cells"), "{tier}");
    assert!(!out.join("check.csv").exists());
    let page = fs::read(out.join("sleepers.csv")).unwrap();

    // the same command finds the run that began again, finished
    let again = arguments(&["--resume"]);
    assert!(again.status.success() && said(&again).contains("was finished before"), "{}", said(&again));
    // the same as a run in that tier from the beginning
    let of_cells = ["--set", "solve.substructure=cells", "--set", "solve.tolerance=10 %"];
    let cells = arguments(&[&of_cells[..], &["--force"]].concat());
    assert!(cells.status.success(), "{}", said(&cells));
    assert_eq!(fs::read(out.join("sleepers.csv")).unwrap(), page);
}
