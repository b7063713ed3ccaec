//! A run that is stopped between its blocks and goes on must give the bits of one that was not.

use std::ops::ControlFlow;
use trackbed::execute::{Checkpoint, Ending, Event, Executor, Listener};
use trackbed::graph::Graph;

/// Stops a run after some blocks, and keeps what it would take to go on.
struct Stopping {
    left: usize,
    kept: Option<Checkpoint>,
    blocks: Vec<(u64, Vec<u64>)>,
}

impl Listener for Stopping {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Block { axles, after, .. } => {
                self.blocks.push((*axles, after.iter().map(|s| s.to_bits()).collect()));
            }
            Event::Between(between) => {
                let text = serde_json::to_string(&between.checkpoint().unwrap()).unwrap();
                self.kept = Some(serde_json::from_str(&text).unwrap());
                self.left -= 1;
                if self.left == 0 {
                    return ControlFlow::Break(());
                }
            }
            Event::Progress { done, all } => assert!(done <= all),
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

/// Runs a graph whole, and stopped after its first block, in its middle and before its last block; `what` names it
/// where they part.
pub fn stops_and_goes_on(graph: &Graph, what: &str) {
    let run = |left: usize, from: Option<Checkpoint>| {
        let mut listener = Stopping { left, kept: None, blocks: Vec::new() };
        let ending = Executor::default().run(graph, &mut listener, from);
        (listener, ending)
    };
    let (whole, ending) = run(usize::MAX, None);
    assert_eq!(ending, Ok(Ending::Finished));
    for stop in [1, whole.blocks.len() / 2, whole.blocks.len() - 2] {
        let (mut begun, ending) = run(stop, None);
        assert_eq!(ending, Ok(Ending::Stopped));
        begun.blocks.extend(run(usize::MAX, begun.kept.take()).0.blocks);
        assert!(begun.blocks == whole.blocks, "{what}, stopped after {stop} blocks");
    }
}
