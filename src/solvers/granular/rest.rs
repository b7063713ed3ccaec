//! Steps until a bed is at rest: the one loop of all that wait for it, a lift under its plate, a plate load test, sleepers,
//! a specimen, cells side by side.
//!
//! Forces are looked at every so many steps. A bed is at rest when some looks in a row find its forces in balance, and what
//! presses on it as strong as it should be. One that is not at rest in time is an error of whoever waits.

use super::bed::Bed;
use super::failure::Failure;
use super::lanes::Real;
use super::measure::unbalance;
use super::snapshot::Snapshot;

/// When a bed counts as at rest, and for how long it is waited for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Criterion {
    /// Largest force out of balance over the forces that act, mean over all bodies.
    pub unbalance: f64,
    /// Largest share by which what presses on the bed may miss its force.
    pub missed: f64,
    /// Steps between two looks.
    pub every: u64,
    /// Looks in a row that must find rest.
    pub looks: usize,
    /// Time after which the bed counts as restless, s.
    pub longest: f64,
    /// Whether the first look comes before the first step; a bed at rest for which no time has passed needs no other look.
    pub look_first: bool,
}

/// What a look has found.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub snapshot: Snapshot,
    /// Force out of balance over the forces that act, mean over all bodies.
    pub unbalance: f64,
    /// Share by which what presses on the bed misses its force.
    pub missed: f64,
    /// Time of the wait so far, s.
    pub time: f64,
}

/// A bed that somebody waits for, with what presses on it.
pub(super) trait Waiting<R: Real> {
    type Error;

    fn bed(&mut self) -> &mut Bed<R>;

    /// Does the steps up to the next look.
    fn advance(&mut self, steps: u64) -> Result<(), Failure>;

    /// Share by which what presses on the bed misses its force; 0 where nothing presses.
    fn missed(&self) -> f64 {
        0.0
    }

    /// Hears of every look.
    fn hear(&mut self, _look: &Look) {}

    /// Fails where it is in vain to wait on for a bed that is not at rest.
    fn worth_waiting(&self, _look: &Look) -> Result<(), Self::Error> {
        Ok(())
    }

    /// The error of a bed that is not at rest in time; `look` is the last one.
    fn restless(&self, look: &Look) -> Self::Error;

    /// The error of a bed that cannot do its steps.
    fn failed(&self, failure: Failure) -> Self::Error;
}

/// Runs a bed until it is at rest, and gives the look that found it so. The wait counts from the time `since`, s.
pub(super) fn until_rest<R: Real, W: Waiting<R>>(
    waiting: &mut W,
    criterion: &Criterion,
    since: f64,
) -> Result<Look, W::Error> {
    let (mut calm, mut moves) = (0, !criterion.look_first);
    loop {
        if moves {
            waiting.advance(criterion.every).map_err(|failure| waiting.failed(failure))?;
        }
        let look = look_at(waiting, since)?;
        let rests = look.unbalance <= criterion.unbalance && look.missed <= criterion.missed;
        calm = if rests { calm + 1 } else { 0 };
        waiting.hear(&look);
        if calm >= criterion.looks || rests && look.time == 0.0 {
            return Ok(look);
        }
        waiting.worth_waiting(&look)?;
        if look.time > criterion.longest {
            return Err(waiting.restless(&look));
        }
        moves = true;
    }
}

fn look_at<R: Real, W: Waiting<R>>(waiting: &mut W, since: f64) -> Result<Look, W::Error> {
    let snapshot = waiting.bed().snapshot().map_err(|failure| waiting.failed(failure))?;
    let bed = waiting.bed();
    let (unbalance, time) = (unbalance(bed, &snapshot), bed.time() - since);
    Ok(Look { snapshot, unbalance, missed: waiting.missed(), time })
}
