//! A track on grains comes to rest: damped, until forces are in balance and no sleeper moves.

use super::going_on;
use super::step::{Coupled, HOLD, LISTEN};
use crate::nodes::NodeError;
use crate::solvers::granular::measure::unbalance;
use crate::solvers::granular::{Answer, Fading};
use serde::{Deserialize, Serialize};

/// Local damping of grains (Cundall), and drag of the rail (1/s), on the way to rest.
const DAMPING: f64 = 0.7;
const DRAG: f64 = 200.0;
/// Steps between looks at rest.
const LOOK: u64 = HOLD;
/// Conditions of rest, at two looks in a row: unbalanced forces are below this share of the acting forces, and no
/// sleeper is faster than this, m/s.
const UNBALANCE: f64 = 2e-3;
const CREEP: f64 = 2e-5;
const CALM: u32 = 2;
/// Longest time to rest after a passage, s.
pub(super) const AFTER: f64 = 0.25;

/// A track on its way to rest.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Resting {
    /// Local damping of each bed before.
    damping: Vec<f64>,
    pub steps: u64,
    /// Motion relative to the limit for rest at the last look: 1 at the limit. `None` before the first one.
    away: Option<f64>,
    /// Looks in a row that found rest.
    calm: u32,
}

impl Coupled {
    /// Damps everything, and returns the local damping of each bed before.
    pub fn damp(&mut self) -> Result<Vec<f64>, NodeError> {
        let before = self.beds.iter().map(|standing| standing.bed.damping()).collect();
        self.beds.iter_mut().for_each(|standing| standing.bed.set_damping(DAMPING));
        self.rail.set_drag(DRAG)?;
        Ok(before)
    }

    /// Ends it.
    pub fn undamp(&mut self, before: &[f64]) -> Result<(), NodeError> {
        self.rail.set_drag(0.0)?;
        self.beds.iter_mut().zip(before).for_each(|(standing, damping)| standing.bed.set_damping(*damping));
        Ok(())
    }

    /// Runs until everything is at rest, or the time is over (s). Returns the motion relative to the limit for rest.
    /// `tell` may end it.
    pub fn come_to_rest<A: Answer>(&mut self, longest: f64, tell: &mut impl FnMut(f64) -> A) -> Result<f64, NodeError> {
        let (mut resting, mut fading) = (self.begin_rest()?, Fading::default());
        while !self.go_to_rest(&mut resting, longest)? {
            let share = resting.away.map_or(0.0, |away| fading.share(away));
            going_on(tell(share).flow())?;
        }
        Ok(resting.away.unwrap_or_default())
    }

    pub(super) fn begin_rest(&mut self) -> Result<Resting, NodeError> {
        Ok(Resting { damping: self.damp()?, steps: 0, away: None, calm: 0 })
    }

    /// The next steps to rest; returns whether it is over.
    pub(super) fn go_to_rest(&mut self, resting: &mut Resting, longest: f64) -> Result<bool, NodeError> {
        // a rail that was restored on its way has none yet
        self.rail.set_drag(DRAG)?;
        let next = resting.steps..resting.steps + LISTEN;
        resting.steps = next.end;
        self.run_steps(next, &mut |_, loads| loads.clear(), &mut |_, _| {})?;
        if !resting.steps.is_multiple_of(LOOK) {
            return Ok(false);
        }
        let away = self.restlessness()?;
        resting.away = Some(away);
        resting.calm = if away <= 1.0 { resting.calm + 1 } else { 0 };
        let is_over = resting.calm >= CALM || resting.steps >= self.steps_to_rest(longest);
        if is_over {
            self.undamp(&resting.damping)?;
        }
        Ok(is_over)
    }

    /// Steps in this time (s), in whole looks.
    fn steps_to_rest(&self, longest: f64) -> u64 {
        (longest / (LOOK as f64 * self.time_step())).ceil() as u64 * LOOK
    }

    /// Most steps to rest after a passage.
    pub fn steps_after(&self) -> u64 {
        self.steps_to_rest(AFTER)
    }

    /// Motion relative to the limit for rest: 1 at the limit.
    fn restlessness(&mut self) -> Result<f64, NodeError> {
        let mut most: f64 = 0.0;
        for standing in &mut self.beds {
            let snapshot = standing.bed.snapshot()?;
            most = most.max(unbalance(&standing.bed, &snapshot) / UNBALANCE);
        }
        let speed = |foot: usize| self.rail.underside(foot).velocity.abs() / CREEP;
        Ok((0..self.pushes.len()).map(speed).fold(most, f64::max))
    }
}
