//! Packings of a run on a cluster, each a task that goes on from its checkpoint when it was lost.
//!
//! The task of the run itself of a track goes as far as the last axle and keeps its state. Whoever watches goes on from
//! there when all packings are finished: the last passage, tables and pages of the run need them all.

use super::cluster::{Elsewhere, Executor, keep_ledger, put_json};
use super::task::{Packings, Task};
use super::{Outcome, interrupt};
use crate::cluster::{ClusterError, Ledger, Need, Work};
use crate::execute::{Event, Listener};
use crate::graph::Graph;
use crate::store::{self, Directory, Finished, StoreError, Unfinished};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Says that a run is under way, before anything of it is kept.
const BEGUN: &str = "begun";
/// Says that the run itself has come to its last axle.
const COMPUTED: &str = "computed";

/// Marks a directory as that of a run under way: its further packings are there before anything of itself.
pub(super) fn begin(directory: &Directory) -> Result<(), StoreError> {
    directory.keep(BEGUN, b"").map(drop)
}

/// Says that the run itself has come to its last axle.
pub(super) fn computed(run: &Path) -> Result<(), StoreError> {
    match Unfinished::open(run)? {
        Some(state) => state.add(COMPUTED, b"").map(drop),
        None => Ok(()),
    }
}

/// Where a packing of a run is computed.
pub(super) enum Piece {
    /// In the directory of the run itself, up to its last axle.
    Itself,
    /// In a directory of its own, as this work.
    Apart(PathBuf, store::Work),
}

/// Has other processes compute all packings: gives them to Slurm and waits for them, or writes them for workers.
/// Gives an outcome where the run ends here without its results.
pub(super) fn perform(
    run: Packings,
    asked: &Elsewhere<'_>,
    state: &Unfinished,
    (needs, pieces): (Vec<Need>, Vec<Piece>),
) -> Result<Option<Outcome>, ClusterError> {
    let watched = state.claim("watch")?;
    let _watched = watched.ok_or_else(|| StoreError::Busy { path: state.path().to_owned() })?;
    let pieces = Pieces { run, state, needs, pieces };
    match asked.arguments.executor {
        Executor::Local => Ok(None),
        Executor::Slurm => asked.watch(&pieces, state),
        Executor::Workers => asked.for_workers(&pieces).map(Some),
    }
}

/// The packings of a run as pieces of work, by how much their seeds are above the seed of the scene.
struct Pieces<'a> {
    /// What every task needs.
    run: Packings,
    state: &'a Unfinished,
    needs: Vec<Need>,
    pieces: Vec<Piece>,
}

impl Work for Pieces<'_> {
    fn needs(&self) -> &[Need] {
        &self.needs
    }

    fn missing(&self) -> Result<BTreeSet<usize>, StoreError> {
        let mut missing = BTreeSet::new();
        for (number, piece) in self.pieces.iter().enumerate() {
            let is_done = match piece {
                Piece::Itself => self.state.keys()?.contains(COMPUTED),
                Piece::Apart(directory, work) => {
                    Finished::open(directory)?.is_some_and(|finished| finished.manifest().work == *work)
                }
            };
            if !is_done {
                missing.insert(number);
            }
        }
        Ok(missing)
    }

    fn put(&self, task: usize, pieces: &[usize]) -> Result<(), StoreError> {
        let packings = pieces.iter().map(|piece| *piece as u32).collect();
        put_json(self.state, &Task::key(task), &Task::Packings(Packings { packings, ..self.run.clone() }))
    }

    fn keep(&self, ledger: &Ledger) -> Result<(), StoreError> {
        keep_ledger(self.state, ledger)
    }

    fn logs(&self) -> PathBuf {
        self.state.path().join(".trackbed/logs")
    }
}

/// Stops a run as soon as its last axle has passed, so that its state is kept there.
pub(super) struct ToTheLastAxle {
    total: u64,
    reached: AtomicBool,
}

impl ToTheLastAxle {
    pub fn new(graph: &Graph) -> ToTheLastAxle {
        ToTheLastAxle { total: graph.blocks().map_or(u64::MAX, |blocks| blocks.total), reached: AtomicBool::new(false) }
    }

    /// Becomes true where the run is to stop.
    pub fn reached(&self) -> &AtomicBool {
        &self.reached
    }
}

impl Listener for &ToTheLastAxle {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        let is_last =
            matches!(event, Event::Block { axles, block: Some((block, _)), .. } if axles + block.axles >= self.total);
        if is_last || interrupt::asked().load(Ordering::Relaxed) {
            self.reached.store(true, Ordering::Relaxed);
        }
        ControlFlow::Continue(())
    }
}
