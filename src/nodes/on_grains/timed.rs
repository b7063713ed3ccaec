//! Speed of the steps of a track on grains, and the time of each part.

use super::Live;
use super::build::Parts;
use super::energy::PassageEnergy;
use super::passage::{REACH, median};
use super::rest::AFTER;
use super::step::{Coupled, HOLD, Spent, StandingBed};
use super::wheels::WheelRun;
use crate::nodes::{Load, NodeError};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Steps of a track on grains under wheels, and the time of each part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimedSteps {
    pub grains: usize,
    pub pebbles: usize,
    pub sleepers: usize,
    pub time_step_us: f64,
    /// Share of the mass of the beds that is added as inertia.
    pub added_inertia: f64,
    pub steps: u64,
    /// Median of parts of the steps, each as long as from one look at inertia to the next.
    pub milliseconds_per_step: f64,
    /// Mean over all steps, by part.
    pub parts_ms: Parted,
    /// Computing a simulated second, s, and an axle of the traffic of the scene.
    pub seconds_a_simulated_second: f64,
    pub seconds_an_axle: f64,
    /// The account of a whole passage, where it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<PassageEnergy>,
    /// Farthest move of a sleeper in a second without a train, m, where it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub idle_m: Option<f64>,
}

/// Milliseconds of a step by part. Rail and soil are computed beside forces and motion: with several threads the parts
/// add up to more than the step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Parted {
    pub lists: f64,
    pub forces: f64,
    pub walls: f64,
    pub motion: f64,
    pub rail: f64,
    pub soil: f64,
    pub inertia: f64,
}

impl Live {
    /// Times steps on a copy, from where the first wheel of a passage reaches the grains.
    pub fn time_steps(&self, parts: Parts<'_>, load: &Load<'_>, steps: u64) -> Result<TimedSteps, NodeError> {
        let mut coupled = self.coupled.clone();
        let none = || NodeError::Other { node: "grains".into(), why: "a passage brings no wheel forces".into() };
        let histories = load.passage.wheels.as_ref().ok_or_else(none)?;
        let axles = load.passage.peaks.iter().map(Vec::len).max().unwrap_or(1) as f64;
        let run = WheelRun::alone(histories);
        let [left, right] = parts.ends();
        let Some([begin, _]) = run.within([left, right]) else { return Err(none()) };
        let Some([first, last]) = run.within([left - REACH, right + REACH]) else { return Err(none()) };
        // the first step makes all lists of a bed that was stored, which a run does once
        coupled.run(
            0.5 * coupled.time_step(),
            |now, loads| run.loads_at(begin + now, begin - 1.0, loads),
            |_, _| {},
        )?;
        let before = coupled.parted();
        let (mut times, mut all) = (Vec::new(), 0);
        for _ in 0..steps.div_ceil(HOLD) {
            let count = HOLD.min(steps - all);
            let start = Instant::now();
            let shift = begin + all as f64 * coupled.time_step();
            let time = (count as f64 - 0.5) * coupled.time_step();
            coupled.run(time, |now, loads| run.loads_at(shift + now, begin - 1.0, loads), |_, _| {})?;
            times.push(1e3 * start.elapsed().as_secs_f64() / count as f64);
            all += count;
        }
        let milliseconds_per_step = median(times.clone());
        let after = coupled.parted();
        let mean = |of: fn(&Parted) -> f64| (of(&after) - of(&before)) / all as f64;
        let [lists, forces, walls] = [mean(|p| p.lists), mean(|p| p.forces), mean(|p| p.walls)];
        let [motion, inertia] = [mean(|p| p.motion), mean(|p| p.inertia)];
        let [rail, soil] = [mean(|p| p.rail), mean(|p| p.soil)];
        let seconds_a_simulated_second = 1e-3 * milliseconds_per_step / coupled.time_step();
        let time_an_axle = match parts.grains.headway {
            Some(distance) => distance / histories.speed,
            None => last - first + AFTER,
        } / axles;
        let beds = || coupled.beds.iter().map(|standing| &standing.bed);
        Ok(TimedSteps {
            grains: beds().map(|bed| bed.len()).sum(),
            pebbles: beds().map(|bed| bed.pebbles().count()).sum(),
            sleepers: coupled.pushes.len(),
            time_step_us: 1e6 * coupled.time_step(),
            added_inertia: coupled.added,
            steps: all,
            milliseconds_per_step,
            parts_ms: Parted { lists, forces, walls, motion, rail, soil, inertia },
            seconds_a_simulated_second,
            seconds_an_axle: seconds_a_simulated_second * time_an_axle,
            energy: None,
            idle_m: None,
        })
    }
}

impl Coupled {
    /// Milliseconds spent so far, by part.
    fn parted(&self) -> Parted {
        let ms = |time: Duration| 1e3 * time.as_secs_f64();
        let of_bed = |sum: Parted, standing: &StandingBed| {
            let timings = standing.bed.timings();
            Parted {
                lists: sum.lists + ms(timings.search),
                forces: sum.forces + ms(timings.forces),
                walls: sum.walls + ms(timings.walls),
                motion: sum.motion + ms(timings.motion),
                ..sum
            }
        };
        let of_beds = self.beds.iter().fold(Parted::default(), of_bed);
        let Spent { rail, soil, inertia } = self.spent;
        Parted { rail: ms(rail), soil: ms(soil), inertia: ms(inertia), ..of_beds }
    }
}
