//! A track on periodic cells of grains: built, loaded by the forces of their seats, stopped and resumed.

use std::ops::ControlFlow;
use std::path::Path;
use trackbed::check::NoModules;
use trackbed::compile::compile;
use trackbed::diag::Code;
use trackbed::execute::{Checkpoint, Event, Executor, Listener};
use trackbed::graph::{CellsNode, Graph, Model};
use trackbed::store::Beds;

mod common {
    pub mod coarse_cells;
}
use common::coarse_cells::SCENE;

fn graph(text: &str) -> Graph {
    let compiled = compile("scene.track", text, &NoModules, &[]);
    let said = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
    compiled.runnable().cloned().unwrap_or_else(|| panic!("{said}"))
}

fn cells(graph: &Graph) -> &CellsNode {
    let cells =
        graph.nodes.iter().find_map(|node| if let Model::Cells(cells) = &node.model { Some(cells) } else { None });
    cells.expect("cells")
}

/// What a run tells that the tests look at.
#[derive(Default)]
struct Heard {
    /// Settlement of every seat after each block, m.
    settlements: Vec<Vec<f64>>,
    /// Axles and unevenness of each block.
    blocks: Vec<(u64, f64)>,
    /// Stiffness of every support at recorded counts, N/m.
    stiffness: Vec<Vec<f64>>,
    /// Where to stop: at which of the moments at which a state may be kept.
    stop_at: Option<u32>,
    moments: u32,
    kept: Option<Checkpoint>,
}

impl Listener for Heard {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Rest { state, .. } => {
                self.stiffness.push(state.seats.iter().map(|seat| seat.support_stiffness).collect());
            }
            Event::Block { block: Some((block, measured)), after, .. } => {
                self.settlements.push(after.to_vec());
                self.blocks.push((block.axles, measured.unevenness));
            }
            Event::Between(between) => {
                if self.stop_at == Some(self.moments) {
                    self.kept = Some(between.checkpoint().unwrap());
                    return ControlFlow::Break(());
                }
                self.moments += 1;
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fn run(graph: &Graph, beds: &Path, threads: usize, heard: &mut Heard, from: Option<Checkpoint>) {
    let executor = Executor::default().with_beds(Beds::kept_in(beds));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| executor.run(graph, heard, from)).unwrap();
}

fn heard(text: &str, beds: &Path) -> Heard {
    let mut heard = Heard::default();
    run(&graph(text), beds, 2, &mut heard, None);
    heard
}

#[test]
fn sleepers_that_settle_alike_share_a_cell() {
    let count = |tolerance: &str| {
        let graph = graph(&SCENE.replace("20 %", tolerance));
        let node = cells(&graph);
        let ballasted = graph.track().unwrap().seats.iter().filter(|seat| seat.is_ballasted()).count();
        assert_eq!((0..node.cells.len()).map(|cell| node.seats_of(cell)).sum::<usize>(), ballasted);
        node.cells.len()
    };
    let found = ["20 %", "5 %", "1 %"].map(count);
    assert!(found[0] < found[1] && found[1] < found[2], "less tolerance tells more sleepers apart: {found:?}");
    assert!(found[2] < 30, "the far field shares a cell: {found:?}");
}

#[test]
fn a_cell_of_several_bays_is_loaded_by_its_neighbours() {
    for bays in 1..=3 {
        let graph = graph(&SCENE.replace("cells,", &format!("cells, cell_bays = {bays},")));
        for cell in &cells(&graph).cells {
            assert_eq!((cell.copies as usize, cell.sleepers.len()), (bays, bays));
            let middle = cell.seat();
            for (bay, sleeper) in cell.sleepers.iter().enumerate() {
                assert!(sleeper.seat.abs_diff(middle) <= 1 && (bay != cell.middle || sleeper.seat == middle));
                assert!((sleeper.place[0] - 0.6 * bay as f64).abs() < 1e-9, "as in the whole bed");
            }
        }
    }
    let whole = graph(&SCENE.replace("substructure = cells", "substructure = full, window = -3 .. 1.2 m"));
    let grains = whole.nodes.iter().find_map(|node| match &node.model {
        Model::Grains(grains) => Some(grains),
        _ => None,
    });
    for sleeper in grains.expect("grains").stretches.iter().flat_map(|stretch| &stretch.sleepers) {
        let bays = sleeper.place[0] / 0.6;
        assert!((bays - bays.round()).abs() < 1e-6, "{bays}");
    }
}

#[test]
fn every_block_weighs_alike_in_the_progress_of_a_run_on_cells() {
    let graph = graph(SCENE);
    let (weight, blocks) = (graph.block_weight().unwrap(), graph.blocks().unwrap());
    assert_eq!(
        [weight.between(blocks, 0, 40), weight.between(blocks, 0, 8), weight.between(blocks, 8, 40)],
        [5.0, 1.0, 4.0]
    );
}

#[test]
fn vehicles_that_would_ride_over_cells_are_told_where_the_scene_asks_for_cells() {
    let text = SCENE.replace("cells,", "cells, coupling = monolithic,");
    let compiled = compile("scene.track", &text, &NoModules, &[]);
    let told: Vec<_> = compiled.diagnostics.iter().filter(|d| d.code == Code::E0604).collect();
    assert!(told.len() == 1 && told[0].message.contains("the rail does not connect the cells"), "{told:?}");
    assert_eq!(compiled.sources.text(told[0].labels[0].span), "cells");
    assert!(compiled.runnable().is_none());
}

#[test]
fn soil_lies_in_series_with_the_grains() {
    let folder = tempfile::tempdir().unwrap();
    let record = "record { at = [-2] sleepers, after = 0 axles, quantities = rail_seat_load }\n";
    let short = format!("{}{record}", SCENE.replace("40 axles", "4 axles"));
    let first = |text: &str| heard(text, folder.path()).stiffness[0][0];
    let on_rock = first(&short.replace(", clay: 0.5 m", ""));
    let on_soil = first(&short);
    let node = graph(&short);
    let soil = cells(&node).cells[0].soil.expect("soil");
    // 60 MPa under 0.95 m x 0.26 m or so, 0.5 m deep
    assert!((50e6..200e6).contains(&soil), "{soil}");
    let series = |a: f64, b: f64| a * b / (a + b);
    assert!((on_soil / series(on_rock, soil) - 1.0).abs() < 1e-9, "{on_soil} {on_rock} {soil}");
}

#[test]
fn cells_settle_by_less_and_less_and_a_run_that_was_stopped_ends_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let whole = heard(SCENE, folder.path());
    let graph = graph(SCENE);
    assert_eq!(whole.settlements.len(), 5);
    let seats = &graph.track().unwrap().seats;
    for (seat, node) in seats.iter().enumerate() {
        let at = |block: usize| whole.settlements[block][seat];
        if node.is_ballasted() {
            assert!(at(0) > 1e-6 && at(4) < 100e-3 && at(4) > at(0), "seat {seat}: {} .. {} m", at(0), at(4));
            assert!(at(4) - at(3) < at(0), "seat {seat}: the first block settles most");
        } else {
            assert_eq!(at(4), 0.0, "a slab does not settle");
        }
    }
    // in the first block, in a later one and between two; the other number of threads
    for stop in [1, 4, whole.moments - 2] {
        let mut begun = Heard { stop_at: Some(stop), ..Heard::default() };
        run(&graph, folder.path(), 1, &mut begun, None);
        let kept = serde_json::to_string(&begun.kept.expect("stopped")).unwrap();
        let mut resumed = Heard::default();
        run(&graph, folder.path(), 1, &mut resumed, Some(serde_json::from_str(&kept).unwrap()));
        assert_eq!([begun.settlements, resumed.settlements].concat(), whole.settlements, "{stop}");
    }
}

#[test]
fn a_block_ends_before_sleepers_settle_too_unevenly_for_its_forces() {
    let folder = tempfile::tempdir().unwrap();
    // one sleeper on glued grains between others that settle by millimetres, and one block for all trains
    let glued = "granular glued : stone {
  bond = { stiffness = 13 MN/m per contact, tensile_strength = 1 kN, shear_strength = 1 kN }, youngs_modulus = 250 MPa
}
stretch one { over = -9 .. -9 sleepers, layers = [glued: 200 mm, clay: rest] }
track line {";
    let scene = SCENE.replace("track line {", glued).replace("transitions =", "stretches = [one], transitions =");
    let scene = scene.replace("update_every = 8 axles", "update_every = 40 axles");
    let whole = heard(&scene, folder.path());
    assert_eq!(whole.blocks.iter().map(|(axles, _)| axles).sum::<u64>(), 40);
    assert!(whole.blocks[0].0 < 20 && whole.blocks.len() < 10, "shorter at first, then longer: {:?}", whole.blocks);
    assert!(whole.blocks.iter().all(|(_, unevenness)| *unevenness <= 0.5), "{:?}", whole.blocks);
    for stop in [1, 3] {
        let mut begun = Heard { stop_at: Some(stop), ..Heard::default() };
        run(&graph(&scene), folder.path(), 1, &mut begun, None);
        let mut resumed = Heard::default();
        run(&graph(&scene), folder.path(), 1, &mut resumed, begun.kept);
        assert_eq!([begun.settlements, resumed.settlements].concat(), whole.settlements, "{stop}");
    }
}

#[test]
fn glued_grains_get_cells_of_their_own_and_other_grains_are_refused() {
    let stretch = |layers: &str| {
        let glued = "granular glued : stone { bond = { stiffness = 50 MN/m per contact, tensile_strength = 5 kN, shear_strength = 5 kN } }";
        let stretch =
            format!("{glued}\nstretch bonded {{ over = -1.2 .. 0 m, layers = [{layers}, clay: rest] }}\ntrack line {{");
        SCENE.replace("track line {", &stretch).replace("transitions =", "stretches = [bonded], transitions =")
    };
    let graph = graph(&stretch("glued: 200 mm"));
    let cells = cells(&graph);
    let glued: Vec<usize> = (0..cells.cells.len()).filter(|cell| !cells.cells[*cell].glued.is_empty()).collect();
    assert_eq!(glued.iter().map(|cell| cells.seats_of(*cell)).sum::<usize>(), 2, "sleepers -2 and -1");
    assert_eq!(cells.beds.len(), 1, "glued or not, the grains are packed once");
    let compiled = compile("scene.track", &stretch("glued: 150 mm"), &NoModules, &[]);
    let told = compiled.diagnostics.iter().find(|d| d.code == Code::E0604).expect("told");
    assert!(told.message.contains("the layers of grains differ"), "{}", told.message);
}
