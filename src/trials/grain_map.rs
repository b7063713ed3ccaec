//! Maps of the grains of a scene: at which steps its own bed runs away, and at which speeds added inertia changes what
//! a sleeper feels.
//!
//! The bed is one cell of tier `cells`, as built. **Steps**: with more and more inertia allowed, the bed runs at shares
//! of the limit of its network of contacts; theory says that it grows beyond 1. **Speeds**: the train of the scene
//! passes with its forces compressed in time. Inertia multiplied by `1 + a` has the effect of a speed multiplied by
//! `sqrt(1 + a)`; beyond the speed at which the stiffness under the train changes, inertia matters.

use super::specimens::{Bench, kinds_of_cells};
use crate::execute::RunError;
use crate::graph::{Clock, Graph};
use crate::nodes::{Builders, NodeError, Specimen, StepOfCell, Telling, TrainForces, turns};
use crate::store::Beds;
use serde::Serialize;
use std::ops::ControlFlow;

/// One run of the bed at another step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepTrial {
    /// Largest inertia added / mass that was allowed, and what was added.
    pub allowed: f64,
    pub added: f64,
    /// Step / limit of the network of contacts, and the step, s.
    pub share: f64,
    pub step: f64,
    /// Why the bed was stopped; `None` if it went on.
    pub stopped: Option<String>,
}

impl StepTrial {
    /// Whether the bed did otherwise than theory says, farther than a tenth from the limit: contacts form and end
    /// while it runs, and dashpots that do not pull act less than theory assumes.
    pub fn is_against_theory(&self) -> bool {
        (self.share - 1.0).abs() > NEAR && self.stopped.is_some() != (self.share > 1.0)
    }
}

/// One passage at another speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpeedTrial {
    /// Largest inertia added / mass that was allowed.
    pub allowed: f64,
    /// Speed / speed of the scene.
    pub factor: f64,
    /// Secant stiffness of the grains under the train, N/m.
    pub stiffness: f64,
    /// Settlement that the train adds, m.
    pub settled: f64,
}

/// The maps of one bed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GrainMap {
    /// The section with the bed, and the sleeper whose forces load it.
    pub section: String,
    pub sleeper: String,
    /// Speed of the train of the scene, m/s.
    pub speed: f64,
    /// Inertia added / mass that the scene allows.
    pub allowed: f64,
    /// The step of the scene, at rest and under a static load.
    pub at_rest: StepOfCell,
    pub loaded: StepOfCell,
    pub steps: Vec<StepTrial>,
    pub speeds: Vec<SpeedTrial>,
}

/// Inertia added / mass of the two maps.
const ADDED: [f64; 4] = [0.0, 0.005, 0.02, 0.1];
const HEAVY: [f64; 4] = [0.0, 0.1, 0.2, 1.0];
/// Steps over the limit of the network.
const SHARES: [f64; 7] = [0.7, 0.85, 0.95, 1.05, 1.15, 1.3, 1.5];
/// Distance from the limit, in share of it, within which theory and a run may disagree.
const NEAR: f64 = 0.1;
/// Steps of a run: a bed that grows by a thousandth a step is found long before.
const STEPS: u64 = 4000;
/// Speeds over the speed of the scene.
const FACTORS: [f64; 6] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
/// Change of stiffness by inertia from which it matters.
pub const MATTERS: f64 = 0.05;

/// Hears of each trial that is done, and may end the others.
pub type Tried<'a> = dyn Fn() -> ControlFlow<()> + Sync + 'a;

/// Trials of a map.
pub fn grain_trials() -> usize {
    ADDED.len() * SHARES.len() + HEAVY.len() * FACTORS.len()
}

impl GrainMap {
    /// The limit of the step / the step of the scene, at rest and under load: the smaller one.
    pub fn margin(&self) -> f64 {
        (self.at_rest.limit / self.at_rest.step).min(self.loaded.limit / self.loaded.step)
    }

    /// Inertia added / mass of the passages, without none.
    pub fn inertias(&self) -> Vec<f64> {
        let mut inertias: Vec<f64> =
            self.speeds.iter().map(|trial| trial.allowed).filter(|share| *share > 0.0).collect();
        inertias.dedup();
        inertias
    }

    /// The largest speed factor of the passages.
    pub fn fastest(&self) -> f64 {
        self.speeds.iter().map(|trial| trial.factor).fold(0.0, f64::max)
    }

    /// Runs that go on against theory, or are stopped against it.
    pub fn against_theory(&self) -> usize {
        self.steps.iter().filter(|trial| trial.is_against_theory()).count()
    }

    /// The passage with so much inertia allowed at a speed factor.
    pub fn passage(&self, allowed: f64, factor: f64) -> Option<&SpeedTrial> {
        self.speeds.iter().find(|trial| trial.allowed == allowed && trial.factor == factor)
    }

    /// Stiffness with so much inertia / stiffness without added inertia, less 1, at a speed factor.
    pub fn change(&self, allowed: f64, factor: f64) -> Option<f64> {
        let [with, without] = [allowed, 0.0].map(|inertia| self.passage(inertia, factor));
        Some(with?.stiffness / without?.stiffness - 1.0)
    }

    /// What theory says of that change: the stiffness without added inertia at a speed multiplied by the root of
    /// `1 + allowed`, between the speeds of the map.
    pub fn change_in_theory(&self, allowed: f64, factor: f64) -> Option<f64> {
        let faster = factor * (1.0 + allowed).sqrt();
        let without: Vec<&SpeedTrial> = self.speeds.iter().filter(|trial| trial.allowed == 0.0).collect();
        let [low, high] = without.windows(2).map(|pair| [pair[0], pair[1]]).find(|pair| faster <= pair[1].factor)?;
        let share = (faster / low.factor).ln() / (high.factor / low.factor).ln();
        let stiffness = low.stiffness + share * (high.stiffness - low.stiffness);
        Some(stiffness / self.passage(0.0, factor)?.stiffness - 1.0)
    }

    /// The speed factor from which so much inertia changes the stiffness by more than [`MATTERS`]; `None` if no
    /// passage of the map does.
    pub fn matters_from(&self, allowed: f64) -> Option<f64> {
        let changes = FACTORS.into_iter().filter(|factor| self.change(allowed, *factor).is_some_and(large));
        changes.reduce(f64::min)
    }
}

fn large(change: f64) -> bool {
    change.abs() > MATTERS
}

/// Maps the bed of the first cell of a graph of tier `cells`; `None` for another graph. `tell` hears of the building of
/// the cells, `tried` of each trial, and may end them.
pub fn grain_map(
    graph: &Graph,
    builders: &Builders,
    beds: &Beds,
    tell: &mut Telling<'_>,
    tried: &Tried<'_>,
) -> Result<Option<GrainMap>, RunError> {
    let Some((cell, section)) = kinds_of_cells(graph).into_iter().next() else { return Ok(None) };
    let Some(bench) = Bench::prepare(graph, builders, beds, tell)? else { return Ok(None) };
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let seat = bench.seat(cell).map_err(at)?;
    let sleeper = graph.track().and_then(|track| track.seats.get(seat)).map_or("", |seat| &seat.name);
    let speed = graph.blocks().map_or(0.0, |blocks| blocks.train.speed);
    let built = bench.specimen(cell).map_err(at)?;
    let train = bench.train(cell).map_err(at)?;
    let measured = || -> Result<GrainMap, NodeError> {
        Ok(GrainMap {
            section: section.to_owned(),
            sleeper: sleeper.to_owned(),
            speed,
            allowed: bench.added_inertia(),
            at_rest: built.step()?,
            loaded: built.pressed()?.step()?,
            steps: steps(&built, tried)?,
            speeds: speeds(&built, &train, tried)?,
        })
    };
    measured().map(Some).map_err(at)
}

fn steps(built: &Specimen, tried: &Tried<'_>) -> Result<Vec<StepTrial>, NodeError> {
    let mut beds: Vec<(f64, Specimen, StepOfCell)> = Vec::new();
    for allowed in ADDED {
        let specimen = built.with_added(allowed)?;
        let limit = specimen.step()?;
        beds.push((allowed, specimen, limit));
    }
    let items: Vec<(usize, f64)> = (0..beds.len()).flat_map(|bed| SHARES.map(|share| (bed, share))).collect();
    in_turns(&items, |(bed, share)| {
        let (allowed, specimen, limit) = &beds[*bed];
        let step = share * limit.limit;
        let stopped = specimen.try_step(step, STEPS)?.map(|failure| failure.to_string());
        go_on(tried)?;
        Ok(StepTrial { allowed: *allowed, added: limit.added, share: *share, step, stopped })
    })
}

fn speeds(built: &Specimen, train: &TrainForces, tried: &Tried<'_>) -> Result<Vec<SpeedTrial>, NodeError> {
    let mut beds: Vec<(f64, Specimen)> = Vec::new();
    for allowed in HEAVY {
        beds.push((allowed, built.with_added(allowed)?));
    }
    let items: Vec<(usize, f64)> = (0..beds.len()).flat_map(|bed| FACTORS.map(|factor| (bed, factor))).collect();
    in_turns(&items, |(bed, factor)| {
        let (allowed, specimen) = &beds[*bed];
        let faster = TrainForces { interval: train.interval / factor, sleepers: train.sleepers.clone() };
        let passed = specimen.clone().pass(&faster)?;
        go_on(tried)?;
        Ok(SpeedTrial { allowed: *allowed, factor: *factor, stiffness: passed.stiffness, settled: passed.added })
    })
}

fn go_on(tried: &Tried<'_>) -> Result<(), NodeError> {
    if tried().is_break() { Err(NodeError::Stopped) } else { Ok(()) }
}

/// The results of a trial of each item, one core each.
fn in_turns<T: Sync, A: Send>(
    items: &[T],
    run: impl Fn(&T) -> Result<A, NodeError> + Sync,
) -> Result<Vec<A>, NodeError> {
    let threads = rayon::current_num_threads();
    let failed =
        |error: rayon::ThreadPoolBuildError| NodeError::Other { node: "grains".into(), why: error.to_string() };
    turns::each(items, threads, threads, run).map_err(failed)?.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(stiffness: impl Fn(f64, f64) -> f64) -> GrainMap {
        let step = |step| StepOfCell { step, limit: 25e-6, added: 0.01 };
        let speeds = HEAVY.into_iter().flat_map(|allowed| FACTORS.map(|factor| (allowed, factor)));
        GrainMap {
            section: "open".into(),
            sleeper: "-4".into(),
            speed: 20.0,
            allowed: 0.02,
            at_rest: step(20e-6),
            loaded: step(22e-6),
            steps: [0.85, 1.15]
                .map(|share| StepTrial {
                    allowed: 0.02,
                    added: 0.01,
                    share,
                    step: share * 25e-6,
                    stopped: (share > 1.2).then(|| "it grows".to_owned()),
                })
                .to_vec(),
            speeds: speeds
                .map(|(allowed, factor)| SpeedTrial {
                    allowed,
                    factor,
                    stiffness: stiffness(allowed, factor),
                    settled: 1e-4,
                })
                .collect(),
        }
    }

    #[test]
    fn a_uniform_inertia_acts_as_the_speed_that_theory_says() {
        // stiffer by the square of the speed, as a mass on a spring
        let of = |allowed: f64, factor: f64| 100e6 * (1.0 - 1e-3 * factor * factor * (1.0 + allowed));
        let map = map(of);
        for (allowed, factor) in [(0.1, 1.0), (0.2, 4.0), (1.0, 8.0)] {
            let [found, theory] =
                [map.change(allowed, factor), map.change_in_theory(allowed, factor)].map(Option::unwrap);
            assert!((found - theory).abs() < 0.04, "{allowed} {factor}: {found} {theory}");
        }
        assert_eq!(map.change_in_theory(1.0, 16.0), None, "beyond the speeds of the map");
        assert_eq!(map.matters_from(1.0), Some(8.0));
        assert_eq!(map.matters_from(0.1), None);
    }

    #[test]
    fn the_margin_is_the_smaller_one_and_a_run_against_theory_counts() {
        let map = map(|_, _| 100e6);
        assert!((map.margin() - 25.0 / 22.0).abs() < 1e-12);
        assert_eq!(map.against_theory(), 1);
    }
}
