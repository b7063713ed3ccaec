//! One cell at work: sleepers without a rail on a periodic bed, each under the forces of its seat.
//!
//! The forces are the forces on the support, which already include the inertia of the sleeper. So the sleepers of a
//! cell are light. If the support force is zero, a sleeper lies on the support with its own weight.

use super::forces::TrainForces;
use crate::graph::{BedPlan, CellPlan, CellsNode, SleeperOnGrains};
use crate::nodes::NodeError;
use crate::nodes::on_grains::{OF_STRIDE, SHARING, Stage, Telling};
use crate::solvers::granular::rig::{Load, Sleeper, fill, glue, stand};
use crate::solvers::granular::{Bed, Push, Stride, WallId, WallMotion};
use crate::store::Beds;
use nalgebra::Vector3;

/// Mass of a sleeper of a cell over that of a sleeper of the track.
const LIGHT: f64 = 0.1;
/// The step over sqrt(m / k) of a sleeper on all its contacts.
const OF_SLEEPER: f64 = 0.2;
/// Steps between looks at inertia, and at how deep the sleepers are, s.
pub(super) const HOLD: u64 = 200;
const LOOK: f64 = 0.5e-3;
/// Time in which the force goes from the weight of the sleeper to its value between two trains, and back after the
/// train; time for which it then stays there; over the last part of this time the level of the sleeper is read, s.
const LEAD: f64 = 0.02;
const STAND: f64 = 0.02;
const READ: f64 = 0.005;
/// Static load on every sleeper, N, about the load on a sleeper under a 20 t axle; time in which it grows and stays, s;
/// local damping (Cundall) during this time.
const PRESS: f64 = 40e3;
const PRESSING: [f64; 2] = [0.06, 0.03];
const DAMPING: f64 = 0.7;
/// Smallest force added by a train for which the secant stiffness is used, N.
const LOADED: f64 = 2e3;
/// Settlement of a sleeper, as a share of the height of the bed, above which the bed no longer carries it.
const SUNK: f64 = 0.5;

/// A cell of grains with its sleepers.
#[derive(Clone)]
pub(super) struct Cell {
    pub bed: Bed<f32>,
    pub walls: Vec<WallId>,
    /// Step that each grain bears by itself, s.
    pub stride: f64,
    /// Force on each support now, N.
    pub forces: Vec<f64>,
    /// Weight of the sleepers and what they carry, N.
    pub weights: Vec<f64>,
    /// The sleeper whose answers are taken, and the height of the bed under it as built, m.
    pub middle: usize,
    pub height: f64,
    /// Secant stiffness of the grains under it, N/m, and the level at which a spring of this stiffness carries nothing
    /// if it carries the weight of the sleeper where the sleeper is, m.
    pub stiffness: f64,
    pub unloaded: f64,
}

/// Effect of a train on the sleeper in the middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passed {
    /// m.
    pub added: f64,
    /// Secant of its largest force, N/m; the one before if the train hardly loads the cell.
    pub stiffness: f64,
}

impl Cell {
    /// A cell at rest under the weight of its sleepers.
    pub fn build(plan: &CellPlan, node: &CellsNode, beds: &Beds, tell: &mut Telling<'_>) -> Result<Cell, NodeError> {
        let bed: &BedPlan = &node.beds[plan.bed];
        let ready = bed.ready(bed.seed()).map_err(NodeError::Bed)?;
        let found = beds.bed(&ready.recipe, |progress| tell(Stage::Packing, progress.share));
        let mut packed = found?.packed;
        let mut bed = packed.bed.replicate(plan.copies)?;
        let sleepers: Vec<Sleeper> = plan.sleepers.iter().map(sleeper).collect();
        let walls = stand(&mut bed, &sleepers, node.gravity, |share| tell(Stage::Sleepers, share))?;
        if let Some(filling) = plan.crib.and_then(|crib| crib.filling(&ready.recipe, plan.copies)) {
            fill(&mut bed, (&sleepers, &walls), &filling, |share| tell(Stage::Cribs, share))?;
        }
        glue(&mut bed, &plan.glued)?;
        let stride = match node.time_step {
            Some(step) => step / OF_STRIDE,
            None => Stride::with_added(&mut bed, SHARING, node.added_inertia)?.step,
        };
        let weights: Vec<f64> = sleepers.iter().map(|sleeper| node.gravity * sleeper.mass).collect();
        let height = bed.wall(walls[plan.middle]).pose(bed.domain()).position.z - 0.5 * sleepers[plan.middle].size[2];
        let forces = weights.clone();
        let (middle, stiffness, unloaded) = (plan.middle, f64::INFINITY, 0.0);
        let mut cell = Cell { bed, walls, stride, forces, weights, middle, height, stiffness, unloaded };
        cell.drive(&cell.constant(&cell.forces), node.gravity);
        Ok(cell)
    }

    /// Stiffness under a static load on all sleepers, N/m. It is measured on a copy, because a load compacts the bed.
    pub fn pressed(mut self, gravity: f64) -> Result<f64, NodeError> {
        let before = self.level();
        self.press(gravity)?;
        Ok(PRESS / (self.level() - before))
    }

    /// Puts a static load on all sleepers.
    pub fn press(&mut self, gravity: f64) -> Result<(), NodeError> {
        let damping = self.bed.damping();
        self.bed.set_damping(DAMPING);
        let forces: Vec<f64> = self.forces.iter().map(|force| force + PRESS).collect();
        self.go_to(&forces, PRESSING, gravity)?;
        self.bed.set_damping(damping);
        self.drive(&self.constant(&self.forces), gravity);
        Ok(())
    }

    /// Takes a stiffness of the grains, N/m, for a sleeper at rest that no train has passed.
    pub fn stand_on(&mut self, stiffness: f64) {
        self.stiffness = stiffness;
        self.unloaded = self.level() - self.weights[self.middle] / stiffness;
    }

    /// Lets one train, or half of one, pass; the sleepers rest before and after it with their weights.
    ///
    /// The settlement is read at rest, as that of a whole bed. Between two trains the rail lifts the sleepers, and a
    /// bed without load rises by tenths of a millimetre.
    pub fn pass(&mut self, train: &TrainForces, gravity: f64) -> Result<Passed, NodeError> {
        let between: Vec<f64> = train.sleepers.iter().map(|forces| forces[0]).collect();
        self.go_to(&between, [LEAD, 0.0], gravity)?;
        let (begin, start) = (self.level(), self.bed.time());
        let table = |forces: &Vec<f64>| {
            ((0..forces.len()).map(|at| start + train.interval * at as f64).collect(), forces.clone())
        };
        self.drive(&train.sleepers.iter().map(table).collect::<Vec<_>>(), gravity);
        let mut deepest = begin;
        self.run(train.time(), |cell| deepest = deepest.max(cell.level()))?;
        self.forces = train.sleepers.iter().map(|forces| forces[forces.len() - 1]).collect();
        self.go_to(&self.weights.clone(), [LEAD, STAND - READ], gravity)?;
        let rest = self.mean_level(READ)?;
        if rest > SUNK * self.height {
            let why = format!("a sleeper has sunk by {:.0} mm: the grains do not carry it", 1e3 * rest);
            return Err(NodeError::Other { node: "cells".into(), why });
        }
        let load = train.load(self.middle);
        let secant = load / (deepest - begin);
        if load > LOADED && secant.is_finite() && secant > 0.0 {
            self.stiffness = secant;
        }
        let unloaded = rest - self.weights[self.middle] / self.stiffness;
        let added = unloaded - std::mem::replace(&mut self.unloaded, unloaded);
        Ok(Passed { added, stiffness: self.stiffness })
    }

    /// Level of the sleeper in the middle below that at which it was set down, m.
    fn level(&self) -> f64 {
        let wall = self.bed.wall(self.walls[self.middle]);
        let half = 0.5 * wall.shape.bounds().map_or(0.0, |[low, high]| high.z - low.z);
        self.height + half - wall.pose(self.bed.domain()).position.z
    }

    /// Its mean over a time, s.
    fn mean_level(&mut self, time: f64) -> Result<f64, NodeError> {
        let (mut sum, mut looks) = (0.0, 0u32);
        self.run(time, |cell| {
            sum += cell.level();
            looks += 1;
        })?;
        Ok(sum / f64::from(looks))
    }

    /// Brings the forces on the supports straight to others, and lets them stand.
    fn go_to(&mut self, forces: &[f64], [growing, standing]: [f64; 2], gravity: f64) -> Result<(), NodeError> {
        let now = self.bed.time();
        let ramp = |(from, to): (&f64, &f64)| (vec![now, now + growing], vec![*from, *to]);
        self.drive(&self.forces.iter().zip(forces).map(ramp).collect::<Vec<_>>(), gravity);
        self.run(growing + standing, |_| ())?;
        self.forces = forces.to_vec();
        Ok(())
    }

    fn constant(&self, forces: &[f64]) -> Vec<(Vec<f64>, Vec<f64>)> {
        forces.iter().map(|force| (vec![self.bed.time()], vec![*force])).collect()
    }

    /// Applies a force history to every support: times, s, and forces, N.
    fn drive(&mut self, tables: &[(Vec<f64>, Vec<f64>)], gravity: f64) {
        for (number, (times, forces)) in tables.iter().enumerate() {
            let mass = LIGHT * self.weights[number] / gravity;
            let weight = LIGHT * self.weights[number];
            let forces = forces.iter().map(|force| (force - weight).max(0.0)).collect();
            let push = Push::Table { times: times.clone(), forces };
            let damping = self.bed.damping();
            let motion = WallMotion::Loaded { axis: -Vector3::z(), mass, weight, damping, push };
            self.bed.set_motion(self.walls[number], motion);
        }
    }

    /// Runs for a time, s; `see` looks from time to time, at the end too.
    fn run(&mut self, time: f64, mut see: impl FnMut(&Cell)) -> Result<(), NodeError> {
        let mut left = time;
        while left > 0.0 {
            let step = self.hold()?;
            let pieces = (step * HOLD as f64 / LOOK).round().max(1.0) as u64;
            for _ in 0..pieces {
                let steps = (LOOK.min(left) / step).ceil().max(1.0);
                self.bed.run(steps as u64)?;
                left -= steps * step;
                see(self);
                if left <= 0.5 * step {
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Adds the inertia that the contacts of now need for the step, and takes the step that the sleepers bear too, s.
    pub fn hold(&mut self) -> Result<f64, NodeError> {
        Stride { step: self.stride, sharing: SHARING }.hold(&mut self.bed)?;
        let of_sleeper = |wall: &WallId| {
            let wall = self.bed.wall(*wall);
            match wall.motion() {
                WallMotion::Loaded { mass, .. } if wall.felt().stiffness > 0.0 => (mass / wall.felt().stiffness).sqrt(),
                _ => f64::INFINITY,
            }
        };
        let of_sleepers = self.walls.iter().map(of_sleeper).fold(f64::INFINITY, f64::min);
        let step = (OF_STRIDE * self.stride).min(OF_SLEEPER * of_sleepers);
        self.bed.set_time_step(step);
        Ok(step)
    }
}

fn sleeper(standing: &SleeperOnGrains) -> Sleeper {
    let underside = standing.pad.map_or(0.0, |pad| pad.mass);
    let mass = standing.mass + standing.rail_mass + underside;
    Sleeper { place: standing.place, size: standing.size, mass, load: Load::None }
}
