//! A track on grains without traffic: it must not move.

use super::{GrainGround, Stage, Telling};
use crate::nodes::NodeError;

impl GrainGround<'_> {
    /// Largest movement of the underside of a sleeper during a time (s) without a train, on a copy, m.
    pub fn idle(&self, seconds: f64, tell: &mut Telling<'_>) -> Result<f64, NodeError> {
        let mut coupled = self.live_at_rest()?.coupled.clone();
        // levels are known from the first step on
        coupled.run(0.5 * coupled.time_step(), |_, loads| loads.clear(), |_, _| {})?;
        let levels = |coupled: &super::Coupled| -> Vec<f64> {
            (0..coupled.pushes.len()).map(|foot| coupled.level(foot)).collect()
        };
        let (before, mut farthest) = (levels(&coupled), 0.0_f64);
        coupled.run(
            seconds,
            |_, loads| loads.clear(),
            |time, coupled| {
                let moved = levels(coupled).into_iter().zip(&before).map(|(now, before)| (now - before).abs());
                farthest = moved.fold(farthest, f64::max);
                tell(Stage::Rest, time / seconds)
            },
        )?;
        Ok(farthest)
    }
}
