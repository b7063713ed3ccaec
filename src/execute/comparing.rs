//! A run compares one of its passages with a finer one, and goes on with finer passages where both differ too much.

use super::blocks::Run;
use super::comparison::Comparison;
use super::exchange::{Exchange, Work};
use super::machine::RunError;
use super::step::{BlockMeasures, largest};
use crate::graph::{Block, Clock, Compared, Runner};

impl Run<'_, '_> {
    /// Compares the passage of an exchange if that is due, and counts the work; `None` if it is not due, and if the
    /// train settles nothing.
    pub(super) fn compare(
        &mut self,
        here: &mut Exchange,
        work: &mut BlockMeasures,
    ) -> Result<Option<Comparison>, RunError> {
        let is_due = |compared: &Compared| self.compared.is_none() && here.axles >= compared.after;
        let Some(Compared { limit, .. }) = self.pair.blocks.compared.filter(is_due) else { return Ok(None) };
        let at_the_end = here.axles >= self.pair.blocks.total;
        let blocks = self.pair.blocks;
        let runners = if at_the_end { blocks.leading() } else { blocks.block(here.axles, 1).runners() };
        let Some(runner) = runners.first().copied() else { return Ok(None) };
        self.pair.ensure(here, &[runner])?;
        let at = |cause| RunError::node(Clock::Axles(here.axles), cause);
        let finer = self.pair.track.finer().map_err(at)?;
        let mut there = Exchange::new(here.axles, here.settlement.clone(), Vec::new());
        there.ensure(&finer, &[runner], self.pair.forces()).map_err(at)?;
        work.add(&there, Work::default());
        let [planned, fine] = [self.added(here, runner)?, self.added(&there, runner)?];
        let settled = largest(&fine);
        if settled == 0.0 {
            return Ok(None);
        }
        let apart: Vec<f64> = planned.iter().zip(&fine).map(|(a, b)| a - b).collect();
        let found = Comparison { axles: here.axles, difference: largest(&apart) / settled, limit, at_the_end };
        if found.refines() {
            self.pair.track = finer;
            work.add(here, Work::default());
            *here = self.pair.arrive(here.axles, here.settlement.clone())?;
        }
        self.compared = Some(found);
        Ok(Some(found))
    }

    /// Settlement that one train adds to every seat, m.
    fn added(&self, exchange: &Exchange, runner: Runner) -> Result<Vec<f64>, RunError> {
        let one = Block { runs: vec![(runner, 1)], ..self.pair.blocks.block(exchange.axles, 1) };
        let after = self.pair.predict(exchange.axles, &exchange.loads(&[one]))?;
        Ok(after.iter().zip(&exchange.settlement).map(|(after, before)| after - before).collect())
    }
}
