//! A ground of another program under the track: what it is asked, what it is told, and what becomes of a run in which
//! it fails or changes.

use super::scene::{Told, ToldBlock, planned};
use super::sinking::{EACH, KIND, Witness, executor, plan};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use trackbed::execute::{Ending, Executor, RunError, execute};
use trackbed::graph::{Clock, Graph, Schedule, Update};
use trackbed::nodes::NodeError;
use trackbed::results::RunRecorder;

/// The blocks of a run that nothing interrupts.
fn blocks(graph: &Graph) -> Vec<ToldBlock> {
    let mut told = Told::default();
    assert_eq!(executor(&Arc::default()).run(graph, &mut told, None), Ok(Ending::Finished));
    told.blocks
}

#[test]
fn it_settles_the_track_and_is_given_whole_histories() {
    let (scenario, on_law) = planned();
    let graph = plan(|_| ());
    let (witness, mut recorder) = (Arc::<Witness>::default(), RunRecorder::new(&scenario, &graph));
    executor(&witness).run(&graph, &mut recorder, None).unwrap();
    let seats = &graph.track().unwrap().seats;
    let last: Vec<f64> =
        recorder.tables.sleepers.iter().filter(|row| row.axles == 24).map(|row| row.settlement_m).collect();
    assert_eq!(last, seats.iter().map(|seat| if seat.is_ballasted() { EACH * 6.0 } else { 0.0 }).collect::<Vec<f64>>());

    // every step of the passage is in them, so that their largest values are the peaks under the wheels
    let heard = witness.heard.lock().unwrap();
    assert_eq!(heard.len(), 6);
    let passed = graph.blocks().unwrap().passed();
    for heard in heard.iter() {
        for (index, seat) in seats.iter().enumerate() {
            assert_eq!(heard.values[index] > 100, seat.is_ballasted(), "seat {}", seat.name);
            if seat.is_ballasted() && passed.contains(&seat.x) {
                assert_eq!(heard.history[index].to_bits(), heard.peak[index].to_bits(), "seat {}", seat.name);
                assert!(heard.peak[index] > 20e3);
            }
        }
    }

    // the track that nobody has loaded yet is that on a law; which takes peaks, so that nobody keeps histories for it
    let mut law = Told::default();
    execute(&on_law, &mut law).unwrap();
    let (ours, theirs) = (&blocks(&graph)[0].passages[0], &law.blocks[0].passages[0]);
    assert_eq!((&ours.seats, &ours.peaks, &ours.rail_moments), (&theirs.seats, &theirs.peaks, &theirs.rail_moments));
    assert!(ours.forces.is_some() && theirs.forces.is_none());
}

#[test]
fn nobody_runs_a_node_without_a_builder() {
    let graph = plan(|_| ());
    let none = NodeError::NoBuilder { node: "substructure".into(), kind: KIND.into() };
    assert_eq!(Executor::default().run(&graph, &mut (), None), Err(RunError::node(Clock::Axles(0), none)));
}

#[test]
fn a_failure_is_rolled_back_named_by_the_clock_and_gone_on_from() {
    let graph = plan(|_| ());
    let witness = Arc::<Witness>::default();
    witness.fails_after.store(2, Ordering::SeqCst);
    let executor = executor(&witness);
    let mut begun = Told::default();
    let error = executor.run(&graph, &mut begun, None).unwrap_err();
    let RunError::Node { clock, .. } = &error else { panic!("{error}") };
    assert_eq!(*clock, Clock::Axles(8));
    assert_eq!(error.to_string(), "after 8 axles: node `sinking`: the ground gave way");
    assert_eq!(*witness.rolled_back_to.lock().unwrap(), [2], "the failed block has left nothing");
    assert_eq!(begun.blocks.len(), 2, "a block that failed is not told");

    let mut rest = Told::default();
    assert_eq!(executor.run(&graph, &mut rest, begun.checkpoint()), Ok(Ending::Finished));
    assert!([begun.blocks, rest.blocks].concat() == blocks(&graph));
}

#[test]
fn the_track_stands_on_what_the_ground_answers_after_a_block() {
    let stiff = blocks(&plan(|_| ()));
    let softening = plan(|sinking| sinking.keeps = 0.8);
    let soft = blocks(&softening);
    assert_eq!(soft[0].passages, stiff[0].passages);
    // as if the second train ran over a track that was so from the beginning
    let second = plan(|sinking| {
        for support in sinking.supports.iter_mut() {
            if let Some(spring) = &mut support.spring {
                spring.stiffness *= 0.8;
                support.settlement = EACH;
            }
        }
    });
    let (ours, theirs) = (&soft[1].passages[0], &blocks(&second)[0].passages[0]);
    assert_eq!((&ours.seats, &ours.peaks, &ours.rail_moments), (&theirs.seats, &theirs.peaks, &theirs.rail_moments));
    assert!(ours.rail_displacements != stiff[1].passages[0].rail_displacements);
    // what was computed ahead, on the ground as it was, is counted and not used
    assert_eq!(stiff.iter().map(|block| block.computed).sum::<u64>(), 6);
    assert_eq!(soft.iter().map(|block| block.computed).sum::<u64>(), 12);
    // the revision alone says that something has changed
    assert!(blocks(&plan(|sinking| (sinking.keeps, sinking.tells) = (0.8, false))) == stiff);

    // and a run that goes on stands on the ground as it was left
    let mut begun = Told::until(3);
    assert_eq!(executor(&Arc::default()).run(&softening, &mut begun, None), Ok(Ending::Stopped));
    let mut rest = Told::default();
    executor(&Arc::default()).run(&softening, &mut rest, begun.checkpoint()).unwrap();
    assert!([begun.blocks, rest.blocks].concat() == soft);
}

#[test]
fn adaptive_blocks_ask_it_alike() {
    let graph = plan(|sinking| sinking.keeps = 0.9);
    let mut adaptive = graph.clone();
    if let Schedule::Blocks(blocks) = &mut adaptive.schedule {
        blocks.update = Update::Adaptive { tolerance: 1e-5, cap: Some(2.5 * EACH) };
    }
    let told = blocks(&adaptive);
    assert_eq!(
        told.last().map(|block| block.settlement.clone()),
        Some(blocks(&graph).last().unwrap().settlement.clone())
    );
    assert!(told.len() < 7, "what settles evenly is done in longer blocks: {}", told.len());
}
