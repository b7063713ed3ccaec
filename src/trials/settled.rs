//! The track after a run of the scene: the state on which variants are compared.

use crate::execute::{Event, Listener, RunError, execute};
use crate::graph::Graph;
use std::ops::ControlFlow;

/// Settlement after some axles.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    pub axles: u64,
    /// Settlement of every seat, m.
    pub settlement: Vec<f64>,
}

/// Why there is no such state.
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
    execute(graph, &mut keeper).map_err(NotSettled::Run)?;
    let Keeper { last, above, .. } = keeper;
    match last {
        Some(state) if after.is_none_or(|after| after == state.axles) => Ok(state),
        last => Err(NotSettled::Between { below: last.map(|s| s.axles), above }),
    }
}

/// Keeps the last state up to the wanted count, and stops the run once that is reached or passed.
struct Keeper<'a> {
    after: Option<u64>,
    last: Option<Settled>,
    above: Option<u64>,
    progress: &'a mut dyn FnMut(u64, u64),
}

impl Keeper<'_> {
    fn keep(&mut self, count: u64, settlement: &[f64]) {
        if self.after.is_none_or(|after| count <= after) {
            self.last = Some(Settled { axles: count, settlement: settlement.to_vec() });
        } else {
            self.above.get_or_insert(count);
        }
    }
}

impl Listener for Keeper<'_> {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Block { axles, block, before, after, .. } => {
                self.keep(*axles, before);
                if let Some((block, _)) = block {
                    self.keep(axles + block.axles, after);
                }
            }
            Event::Progress { done, all } => (self.progress)(*done, *all),
            Event::Between(_) => {
                let reached = self.after.is_some() && self.last.as_ref().map(|s| s.axles) == self.after;
                if reached || self.above.is_some() {
                    return ControlFlow::Break(());
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}
