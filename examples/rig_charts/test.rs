//! One box test on one packing.

use std::time::Instant;
use trackbed::Scene;
use trackbed::graph::Schedule;
use trackbed::solvers::granular::packing::pack;
use trackbed::solvers::granular::rig::Trial;

/// Cycles, and the one from which settlement counts: a first contact is chance.
const CYCLES: u64 = 10;
const FROM: u64 = 2;

const BOX: &str = "
use std
granular stone : ballasts.granite_31_63 { grading.cut_below = 40 mm, packing.lifts = 1, packing.friction = 0.2 }
trackform bed { sleeper = sleepers.concrete, spacing = 0.6 m, layers = [stone: 300 mm] }
track box { sections = [bed: 1 sleeper], bed_width = 2.6 m per track }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 20 Hz) per sleeper, total = 10 cycles }
solve { substructure = full }
";

/// What is changed.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Values of the scene.
    pub sets: Vec<(String, String)>,
    /// Sleepers on the cell, loaded alike.
    pub bays: u32,
    /// Force out of balance at which a lift is packed.
    pub rest: f64,
    /// Share of the mass that is added as inertia, for the sake of longer steps.
    pub added: f64,
}

impl Default for Setting {
    fn default() -> Self {
        Setting { sets: Vec::new(), bays: 1, rest: 0.01, added: 0.005 }
    }
}

impl Setting {
    pub fn set(mut self, path: &str, value: &str) -> Setting {
        self.sets.push((path.into(), value.into()));
        self
    }
}

#[derive(Debug, Clone)]
pub struct Answer {
    pub grains: usize,
    pub porosity: f64,
    /// Of a sleeper, mean over sleepers, m: after the first cycle, and from the second to the last.
    pub first: f64,
    pub growth: f64,
    /// Resilient, of the last cycle, N/m.
    pub stiffness: f64,
    pub steps: u64,
    /// s.
    pub packing: f64,
    pub testing: f64,
}

pub fn run(setting: &Setting, seed: u64) -> Result<Answer, String> {
    let scene = Scene::from_text(BOX)
        .set("solve.seed", seed.to_string())
        .set("box.sections", format!("[bed: {} sleepers]", setting.bays));
    let scene = setting.sets.iter().fold(scene, |scene, (path, value)| scene.set(path, value));
    let compiled = scene.check();
    let wrong = compiled.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
    let (None, Some(graph)) = (wrong, compiled.runnable()) else { return Err(format!("{wrong:?}")) };
    let (Some((bed, actuators)), Schedule::Actuators(tests)) = (graph.bed_under_actuators(), &graph.schedule) else {
        return Err("no rig".into());
    };
    let mut recipe = bed.bed.ready(seed).map_err(|error| error.to_string())?.recipe;
    // one long cell, in place of copies of a short one
    recipe.plan[0] = 0.6 * f64::from(setting.bays);
    recipe.rest.lift = setting.rest;
    let start = Instant::now();
    let packed = pack::<f32, _>(&recipe, |_| ()).map_err(|error| error.to_string())?;
    let packing = start.elapsed().as_secs_f64();
    let [low, high] = packed.between(0);
    let porosity = packed.porosity([low + 0.25 * (high - low), high - 0.25 * (high - low)]);
    let mut rig = bed.rig(actuators, &recipe, high, &tests.kept);
    rig.added = setting.added;
    let load = rig.sleepers[0].load.clone();
    rig.sleepers.iter_mut().for_each(|sleeper| sleeper.load = load.clone());
    let grains = packed.bed.len();
    let mut trial = Trial::new(packed.bed, &rig, |_| ()).map_err(|error| error.to_string())?;
    while trial.advance().map_err(|error| error.to_string())? {}
    let mean = |number: u64, of: &dyn Fn(&trackbed::solvers::granular::rig::Cycle) -> f64| {
        let values: Vec<f64> = trial.cycles().iter().filter(|cycle| cycle.number == number).map(of).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let settlement = |number| mean(number, &|cycle| cycle.settlement);
    Ok(Answer {
        grains,
        porosity,
        first: settlement(1),
        growth: settlement(CYCLES) - settlement(FROM),
        stiffness: mean(CYCLES, &|cycle| cycle.stiffness),
        steps: trial.steps(),
        packing,
        testing: start.elapsed().as_secs_f64() - packing,
    })
}
