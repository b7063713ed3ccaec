//! What is kept of a plan and of its run gives the same bits back.

use super::scene::{Told, planned};
use super::sinking::{Witness, executor, plan};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use trackbed::check::Folder;
use trackbed::compile;
use trackbed::execute::{Both, Ending, Event, Executor, execute};
use trackbed::graph::Graph;
use trackbed::results::RunRecorder;
use trackbed::store::{Directory, Mode, Work};

fn through_a_file(graph: &Graph) -> Graph {
    serde_json::from_str(&serde_json::to_string(graph).unwrap()).unwrap()
}

#[test]
fn a_run_that_a_listener_ends_goes_on_with_the_same_bits() {
    let (scenario, graph) = planned();
    let mut whole = RunRecorder::new(&scenario, &graph);
    execute(&graph, &mut whole).unwrap();

    let directory = tempfile::tempdir().unwrap();
    let work = Work { name: "run".into(), scene_sha256: "the scene".into() };
    let open = |mode| Directory::open(directory.path(), work.clone(), mode).unwrap();
    let kept = open(Mode::New);
    let mut begun = RunRecorder::new(&scenario, &graph).kept_in(&kept);
    let mut blocks = 0;
    let mut at_the_third = |event: &Event<'_>| {
        blocks += u32::from(matches!(event, Event::Between(_)));
        if blocks == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let ended = Executor::default().run(&graph, &mut Both(&mut begun, &mut at_the_third), None);
    assert_eq!(ended, Ok(Ending::Stopped));
    assert_eq!(begun.tables.blocks.len(), 3);

    drop(begun);
    drop(kept);
    let kept = open(Mode::Resume);
    let mut rest = RunRecorder::new(&scenario, &graph).kept_in(&kept);
    let from = rest.resume().unwrap().expect("a block was kept");
    assert_eq!(Executor::default().run(&graph, &mut rest, Some(from)), Ok(Ending::Finished));
    assert!(rest.tables == whole.tables && rest.histories == whole.histories);
}

#[test]
fn every_shipped_plan_survives_a_file() {
    let mut plans = 0;
    for entry in std::fs::read_dir("scenarios").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "track") {
            continue;
        }
        let (name, text) = (path.display().to_string(), std::fs::read_to_string(&path).unwrap());
        let compiled = compile(&name, &text, &Folder(Path::new("scenarios").into()), &[]);
        let Some(graph) = compiled.graph else { continue };
        assert!(through_a_file(&graph) == graph, "{name}");
        plans += 1;
    }
    assert!(plans > 12, "{plans} plans");
}

#[test]
fn a_plan_from_a_file_runs_to_the_same_bits() {
    for graph in [planned().1, plan(|sinking| sinking.keeps = 0.9)] {
        let again = through_a_file(&graph);
        assert!(again == graph);
        let [before, after] = [&graph, &again].map(|graph| {
            let mut told = Told::default();
            executor(&Arc::<Witness>::default()).run(graph, &mut told, None).unwrap();
            told.blocks
        });
        assert!(before == after && before.len() == 7);
    }
}
