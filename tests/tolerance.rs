//! What the planner makes of the tolerance and the budget of a scene, and that a run keeps to it.

use std::ops::ControlFlow;
use trackbed::check::{NoModules, Override};
use trackbed::diag::Code;
use trackbed::execute::{Checkpoint, Comparison, Event, Executor, Listener, execute};
use trackbed::graph::{Decision, Graph, Schedule, Update};
use trackbed::results::{RunRecorder, SleeperRow};
use trackbed::{Compiled, compile};

const SCENE: &str = r#"
use std
granular stone {
  grading = gradings.ballast_32_80, density = 2700 kg/m^3, friction = 0.7
  contact_stiffness = 13 MN/m per contact
}
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  layers = [stone: 300 mm]
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600, layers = [] }
track line { sections = [open: 21 m, stiff: 12 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h, direction = forward }
traffic { trains = ore, total = 200 axles }
solve { window = -3 .. 0 m }
"#;

fn compiled(edits: &[&str]) -> Compiled {
    let edit = |text: &&str| {
        let (path, value) = text.split_once('=').unwrap();
        Override { path: path.trim().into(), value: value.trim().into() }
    };
    let edits: Vec<Override> = edits.iter().map(edit).collect();
    let compiled = compile("scene.track", SCENE, &NoModules, &edits);
    let errors: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    compiled
}

fn plan(edits: &[&str]) -> Graph {
    compiled(edits).graph.unwrap()
}

/// Settlement of every seat after the last axle, m.
fn settlement(edits: &[&str]) -> Vec<f64> {
    let compiled = compiled(edits);
    let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scenario, &graph);
    execute(&graph, &mut recorder).unwrap();
    let rows = recorder.tables.sleepers.iter().filter(|row| row.axles == 200);
    SleeperRow::that_count(rows).iter().map(|row| row.settlement_m).collect()
}

fn error_of_blocks(graph: &Graph) -> f64 {
    let Schedule::Blocks(blocks) = &graph.schedule else { panic!("trains run") };
    let Update::Adaptive { tolerance, .. } = blocks.update else { panic!("{:?}", blocks.update) };
    tolerance
}

#[test]
fn a_tolerance_chooses_what_the_scene_leaves_open() {
    let [fine, coarse, open] = [&[][..], &["solve.tolerance = 5 %"], &["solve.tolerance = 1 %"]].map(plan);
    let elements = |graph: &Graph| graph.track().unwrap().elements_per_bay;
    assert_eq!([&fine, &coarse, &open].map(elements), [4, 2, 2]);
    let longest = |graph: &Graph| graph.blocks().unwrap().passage.time_step;
    assert_eq!([&fine, &coarse, &open].map(longest), [1e-4, 8e-4, 4e-4]);
    assert_eq!(error_of_blocks(&fine), 3e-6);
    assert!(error_of_blocks(&coarse) > 4.5 * error_of_blocks(&open));

    let stated = plan(&[
        "solve.tolerance = 5 %",
        "solve.elements_per_bay = 8",
        "solve.time_step = 0.05 ms",
        "solve.update_every = adaptive(0.001 mm)",
    ]);
    assert_eq!((elements(&stated), longest(&stated), error_of_blocks(&stated)), (8, 5e-5, 1e-6));
}

#[test]
fn a_run_keeps_to_its_tolerance_and_to_the_expected_error() {
    let reference = settlement(&["solve.update_every = 4 axles"]);
    let largest = reference.iter().copied().fold(0.0, f64::max);
    for (tolerance, most) in [("5 %", 0.05), ("1 %", 0.01)] {
        let edit = format!("solve.tolerance = {tolerance}");
        let apart = settlement(&[&edit]).iter().zip(&reference).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let expected = plan(&[&edit]).error.numerical.unwrap();
        assert!(apart / largest <= expected && expected <= most, "{} of {expected}", apart / largest);
    }
}

/// The decision about the tier; `None` if there was no choice.
fn choice(graph: &Graph) -> Option<&Decision> {
    graph.decisions.iter().find(|decision| decision.pass == "budget")
}

#[test]
fn a_budget_lets_the_planner_choose_the_ground() {
    assert!(choice(&plan(&[])).is_none(), "without a budget the law runs");
    let with = |edits: &[&str]| {
        let graph = plan(edits);
        (graph.node("grains").is_some(), choice(&graph).unwrap().clone())
    };
    let (grains, law) = with(&["solve.budget = 1000 h", "solve.tolerance = 80 %"]);
    assert!(!grains && law.what.contains("`substructure = law`"), "the law is within this, and cheapest: {law:?}");
    let (grains, cells) = with(&["solve.budget = 1000 h", "solve.tolerance = 45 %"]);
    assert!(grains && cells.what.contains("`substructure = cells`"), "{cells:?}");
    let (_, full) = with(&["solve.budget = 1000 h", "solve.tolerance = 10 %"]);
    assert!(full.what.contains("`substructure = full`"), "{full:?}");
    let zone = full.rejected.iter().find(|other| other.what == "zone").unwrap();
    assert!(zone.why.contains("expected error is above") && zone.error.unwrap() > 0.1, "{zone:?}");
    let (_, tiny) = with(&["solve.budget = 0.01 min", "solve.memory = 0.01 GiB"]);
    assert!(tiny.why.contains("no tier fits; it is the cheapest, but it needs"), "{tiny:?}");
    let (grains, short) = with(&["solve.budget = 0.2 min", "solve.tolerance = 10 %"]);
    assert!(!grains && short.why.contains("smallest expected error within the budget of 12 s"), "{short:?}");
    let (_, little) = with(&["solve.budget = 1000 h", "solve.memory = 0.06 GiB", "solve.tolerance = 10 %"]);
    assert!(little.what.contains("`substructure = cells`"), "{little:?}");
    let full = little.rejected.iter().find(|other| other.what == "full").unwrap();
    assert!(full.why.contains("more than the limit of 62 MiB"), "{full:?}");
}

/// Trains that cells leave out need not be more accurate than the cells.
#[test]
fn the_error_of_cells_has_a_part_that_the_tolerance_sets() {
    let parts = |edits: &[&str]| {
        let error = plan(edits).error;
        (error.numerical.unwrap(), error.of_tier.unwrap(), error.share().unwrap())
    };
    let cells = "solve.substructure = cells";
    let (numerical, of_tier, share) = parts(&[cells]);
    assert_eq!((numerical, of_tier), (0.1, 0.42));
    assert!((share - 0.1f64.hypot(0.42)).abs() < 1e-12);
    assert_eq!(parts(&[cells, "solve.tolerance = 2 %"]).0, 0.02);
    // here the tolerance is for both parts
    let budget = "solve.budget = 1000 h";
    let (numerical, _, share) = parts(&[budget, "solve.tolerance = 43 %"]);
    assert!(numerical > 0.07 && numerical < 0.1 && share <= 0.43, "{numerical} {share}");
    assert_eq!(parts(&[budget, "solve.tolerance = 45 %"]).0, 0.1);
    let little = parts(&[budget, "solve.memory = 0.06 GiB", "solve.tolerance = 10 %"]);
    assert_eq!(little.0, 0.1, "the cells themselves are 42 % off");
}

#[test]
fn a_plan_that_misses_its_tolerance_says_what_would_keep_it() {
    let told = |edits: &[&str]| {
        let found = compiled(edits).diagnostics.into_iter().find(|found| found.code == Code::L1036);
        found.map(|found| (found.message.clone(), format!("{:?}", found.help)))
    };
    let (message, help) = told(&["solve.budget = 0.2 min"]).unwrap();
    assert!(message.starts_with("tier `law` has an expected error of 78 %"), "{message}");
    assert!(message.ends_with("more than the tolerance of 5 %"), "{message}");
    assert!(help.contains("`substructure = full` has an expected error of 1 %"), "{help}");
    assert_eq!(told(&["solve.budget = 0.2 min", "solve.tolerance = 80 %"]), None);
    assert_eq!(told(&["solve.budget = 0.2 min", "solve.substructure = law"]), None, "the scene has decided");
}

/// What a run tells of its comparison with a finer passage.
#[derive(Default)]
struct Heard {
    compared: Vec<Comparison>,
    /// Settlement of every seat after each block, m.
    settlements: Vec<Vec<f64>>,
    stop_after: Option<usize>,
    kept: Option<Checkpoint>,
}

impl Listener for Heard {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Compared(compared) => self.compared.push(**compared),
            Event::Block { block: Some(_), after, .. } => self.settlements.push(after.to_vec()),
            Event::Between(between) if self.stop_after == Some(self.settlements.len()) => {
                self.kept = Some(between.checkpoint().unwrap());
                return ControlFlow::Break(());
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fn heard(graph: &Graph, stop_after: Option<usize>, from: Option<Checkpoint>) -> Heard {
    let mut heard = Heard { stop_after, ..Heard::default() };
    Executor::default().run(graph, &mut heard, from).unwrap();
    heard
}

/// The same plan with another limit of the comparison.
fn with_limit(mut graph: Graph, limit: f64) -> Graph {
    let Schedule::Blocks(blocks) = &mut graph.schedule else { panic!("trains run") };
    blocks.compared.as_mut().expect("compared").limit = limit;
    graph
}

#[test]
fn only_passages_that_the_planner_chose_are_compared() {
    let compared = |edits: &[&str]| plan(edits).blocks().unwrap().compared;
    assert!(compared(&[]).is_none());
    let found = compared(&["solve.tolerance = 5 %"]).expect("compared");
    assert!(found.after == 20 && (found.limit - 0.005).abs() < 1e-12, "{found:?}");
    assert!(compared(&["solve.tolerance = 5 %", "solve.elements_per_bay = 8", "solve.time_step = 0.05 ms"]).is_none());
}

#[test]
fn a_passage_within_the_limit_changes_nothing_and_one_beyond_it_refines_the_run() {
    let once = heard(&plan(&["solve.tolerance = 5 %"]), None, None);
    assert!(once.settlements.len() < 3 && once.compared[0].at_the_end, "a block over all axles: {:?}", once.compared);
    assert!(!once.compared[0].exceeds());
    // more blocks
    let graph = plan(&["solve.tolerance = 5 %", "solve.update_every = 20 axles"]);
    let planned = heard(&graph, None, None);
    let [Comparison { axles, difference, .. }] = planned.compared[..] else { panic!("{:?}", planned.compared) };
    assert!(axles >= 20 && difference > 0.0 && difference < 0.005, "{axles} {difference}");
    let mut alone = graph.clone();
    let Schedule::Blocks(blocks) = &mut alone.schedule else { panic!("trains run") };
    blocks.compared = None;
    assert_eq!(heard(&alone, None, None).settlements, planned.settlements);

    let strict = with_limit(graph, 0.5 * difference);
    let refined = heard(&strict, None, None);
    assert!(refined.compared[0].refines());
    let before = planned.settlements.iter().zip(&refined.settlements).take_while(|(a, b)| a == b).count();
    assert!(before >= 1 && before < planned.settlements.len(), "it refines on the way: {before}");
    // a run that was stopped after the comparison goes on with the finer passages
    let begun = heard(&strict, Some(before + 1), None);
    let kept = serde_json::to_string(&begun.kept.expect("stopped")).unwrap();
    let resumed = heard(&strict, None, Some(serde_json::from_str(&kept).unwrap()));
    assert!(resumed.compared.is_empty(), "compared once");
    assert_eq!([begun.settlements, resumed.settlements].concat(), refined.settlements);
}
