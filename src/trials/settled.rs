//! The track as a run of the scene leaves it: the state over which variants are compared.

use crate::graph::{self, Block, Checkpoint, Graph, Measured, PassageOutcome, Recorder, RunError, Runner, Unloaded};

/// Settlement after some axles.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    pub axles: u64,
    /// Of every seat, m.
    pub settlement: Vec<f64>,
}

/// Why there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum NotSettled {
    Run(RunError),
    /// No exchange of forces and settlement falls on that count; the nearest ones that do.
    Between {
        below: Option<u64>,
        above: Option<u64>,
    },
}

/// Runs the scene with its own numerics until `after` axles, or to its end.
pub fn settled(graph: &Graph, after: Option<u64>, progress: &mut dyn FnMut(u64, u64)) -> Result<Settled, NotSettled> {
    let mut keeper = Keeper { after, last: None, above: None, progress };
    let ended = graph::execute(graph, &mut keeper, None);
    let Keeper { last, above, .. } = keeper;
    match (last, ended) {
        (_, Err(error @ RunError::Track { .. })) => Err(NotSettled::Run(error)),
        (Some(state), _) if after.is_none_or(|after| after == state.axles) => Ok(state),
        (last, _) => Err(NotSettled::Between { below: last.map(|s| s.axles), above }),
    }
}

/// Keeps the last state up to the wanted count, and stops the run once that is reached or passed.
struct Keeper<'a> {
    after: Option<u64>,
    last: Option<Settled>,
    above: Option<u64>,
    progress: &'a mut dyn FnMut(u64, u64),
}

impl Recorder for Keeper<'_> {
    fn unloaded(&mut self, _: u64, _: &Unloaded) {}
    fn passage(&mut self, _: u64, _: Runner, _: &PassageOutcome) {}
    fn equilibrium(&mut self, _: &Unloaded) {}

    fn block(
        &mut self,
        axles: u64,
        block: Option<(&Block, &Measured)>,
        _: &[&PassageOutcome],
        before: &[f64],
        after: &[f64],
    ) {
        let ends = block.map(|(block, _)| (axles + block.axles, after));
        for (count, settlement) in [(axles, before)].into_iter().chain(ends) {
            if self.after.is_none_or(|after| count <= after) {
                self.last = Some(Settled { axles: count, settlement: settlement.to_vec() });
            } else {
                self.above.get_or_insert(count);
            }
        }
    }

    fn checkpoint(&mut self, _: &Checkpoint) -> Result<(), String> {
        let reached = self.after.is_some() && self.last.as_ref().map(|s| s.axles) == self.after;
        if reached || self.above.is_some() { Err("far enough".into()) } else { Ok(()) }
    }

    fn progress(&mut self, done: u64, all: u64) {
        (self.progress)(done, all);
    }
}
