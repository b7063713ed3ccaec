//! Specimens under their trains.

use super::program::Trial;
use crate::execute::{Loading, RunError};
use crate::graph::{CellPlan, CellsNode, Clock, Graph, Model, SeatOnCell};
use crate::nodes::{Builders, CellParts, NodeError, SeatForces, Specimen, Telling, TrainForces, turns};
use crate::solvers::settlement::Peak;
use crate::store::{Beds, recipe_hash};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::sync::Mutex;

/// Version: increased when the same specimens get other trains.
const METHOD: &str = "specimens 2";

/// The settlement of one specimen.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The trial of each train.
    pub trials: Vec<Trial>,
    /// Peak forces of the wheels of each train as a law gets them.
    pub peaks: Vec<Vec<Peak>>,
    /// After each train, m.
    pub settled: Vec<f64>,
    /// Stiffness of the grains under the last train, N/m.
    pub stiffness: Option<f64>,
}

/// The plane track of a scene and its cells.
pub struct Bench<'a> {
    loading: Loading<'a>,
    parts: CellParts<'a>,
    threads: usize,
}

/// What passes a specimen.
struct Exposure {
    trial: Trial,
    peaks: Vec<Peak>,
    train: TrainForces,
}

#[derive(Serialize, Deserialize)]
struct Measured {
    settled: Vec<f64>,
    stiffness: Option<f64>,
}

impl<'a> Bench<'a> {
    /// Builds the cells of a graph of tier `cells`, or takes them from the store. `None` for another graph.
    pub fn prepare(
        graph: &'a Graph,
        builders: &'a Builders,
        beds: &'a Beds,
        tell: &mut Telling<'_>,
    ) -> Result<Option<Bench<'a>>, RunError> {
        let Some(cells) = cells_of(graph) else { return Ok(None) };
        let loading = Loading::prepare(graph, builders, beds, tell)?;
        Ok(loading.map(|loading| Bench {
            loading,
            parts: CellParts { cells, beds },
            threads: rayon::current_num_threads(),
        }))
    }

    /// The settlement of specimens of a cell, one for each list of trials. `tell` hears of each train that has passed,
    /// and may end the measurement; finished specimens are stored.
    pub fn curves(
        &self,
        cell: usize,
        programs: &[Vec<Trial>],
        tell: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<Vec<Curve>, RunError> {
        let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
        let built = Specimen::build(self.parts, cell, &mut |_, _| ControlFlow::Continue(())).map_err(at)?;
        let exposed: Vec<Vec<Exposure>> =
            programs.iter().map(|program| self.exposures(cell, program)).collect::<Result<_, _>>().map_err(at)?;
        // a bed of one bay is small: one specimen a core
        let items: Vec<Mutex<Vec<Exposure>>> = exposed.into_iter().map(Mutex::new).collect();
        let one = |program: &Mutex<Vec<Exposure>>| {
            let program = std::mem::take(&mut *program.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
            self.curve(&built, program, tell)
        };
        let curves = turns::each(&items, self.threads, self.threads, one);
        let failed = |error: rayon::ThreadPoolBuildError| {
            at(NodeError::Other { node: "specimens".into(), why: error.to_string() })
        };
        curves.map_err(failed)?.into_iter().collect::<Result<_, _>>().map_err(at)
    }

    fn curve(
        &self,
        built: &Specimen,
        program: Vec<Exposure>,
        tell: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<Curve, NodeError> {
        let trials: Vec<Trial> = program.iter().map(|exposure| exposure.trial).collect();
        let forces: Vec<&TrainForces> = program.iter().map(|exposure| &exposure.train).collect();
        let hash = recipe_hash(&(METHOD, built.recipe(), &forces));
        let measure = || {
            let mut specimen = built.clone();
            let mut measured = Measured { settled: Vec::new(), stiffness: None };
            let mut settled = 0.0;
            for train in &forces {
                let passed = specimen.pass(train)?;
                settled += passed.added;
                measured.settled.push(settled);
                measured.stiffness = Some(passed.stiffness);
                if tell().is_break() {
                    return Err(NodeError::Stopped);
                }
            }
            Ok(measured)
        };
        let Measured { settled, stiffness } = self.parts.beds.measured(&hash, measure)?;
        Ok(Curve { trials, peaks: program.into_iter().map(|exposure| exposure.peaks).collect(), settled, stiffness })
    }

    /// Largest inertia added / mass of a bed that the scene allows.
    pub fn added_inertia(&self) -> f64 {
        self.parts.cells.added_inertia
    }

    /// A cell that no train has passed.
    pub fn specimen(&self, cell: usize) -> Result<Specimen, NodeError> {
        Specimen::build(self.parts, cell, &mut |_, _| ControlFlow::Continue(()))
    }

    /// The forces of the train of the scene on a cell.
    pub fn train(&self, cell: usize) -> Result<TrainForces, NodeError> {
        Ok(self.exposure(cell, Trial::OF_SCENE)?.train)
    }

    /// What the trains of a program bring to a cell. Trains with equal trials need one passage.
    fn exposures(&self, cell: usize, program: &[Trial]) -> Result<Vec<Exposure>, NodeError> {
        let mut found: Vec<Exposure> = Vec::new();
        for trial in program {
            let known = found.iter().position(|exposure| exposure.trial == *trial);
            let exposure = match known {
                Some(known) => {
                    Exposure { trial: *trial, peaks: found[known].peaks.clone(), train: found[known].train.clone() }
                }
                None => self.exposure(cell, *trial)?,
            };
            found.push(exposure);
        }
        Ok(found)
    }

    /// The seat whose forces load the specimens of a cell: one of its kind that every wheel passes, as near to its own
    /// seat as possible.
    pub fn seat(&self, cell: usize) -> Result<usize, NodeError> {
        let node = self.parts.cells;
        let own = &node.cells[cell];
        let is_alike = |of: &Option<usize>| of.is_some_and(|of| node.cells[of].is_built_alike(own));
        let alike = node.cell_of.iter().zip(&node.seats).enumerate().filter(|(_, (of, _))| is_alike(of));
        let places = alike.filter_map(|(seat, (_, at))| Some((seat, at.as_ref()?.x)));
        let passed = places.filter(|(_, x)| self.loading.passes(*x));
        let nearest = passed.min_by(|(_, a), (_, b)| (a - own.x).abs().total_cmp(&(b - own.x).abs()));
        nearest.map(|(seat, _)| seat).ok_or_else(none_passed)
    }

    fn exposure(&self, cell: usize, trial: Trial) -> Result<Exposure, NodeError> {
        let plan = &self.parts.cells.cells[cell];
        let SeatOnCell { loaded_by: seats, .. } =
            self.parts.cells.seats[self.seat(cell)?].as_ref().ok_or_else(none_passed)?;
        let seat = seats[plan.middle];
        let settlement = self.loading.with_void(&self.loading.settlement(), (seats, seat), trial.void)?;
        let (unloaded, passage) = self.loading.passage(&settlement)?;
        let no_forces = || NodeError::Other { node: "specimens".into(), why: "a passage brings no forces".into() };
        let mut forces: SeatForces = passage.forces.ok_or_else(no_forces)?;
        for seat in seats {
            let rest = forces.seats[*seat].first().copied().unwrap_or(0.0);
            forces.seats[*seat].iter_mut().for_each(|force| *force = scaled(*force, rest, trial.factor));
        }
        let rest = unloaded.seats[seat].contact_force;
        let peak = |peak: &Peak| Peak {
            force: scaled(peak.force, rest, trial.factor),
            deflection: scaled(peak.deflection, 0.0, trial.factor),
            void: peak.void,
        };
        let train = TrainForces::new(&forces, seats, plan.middle, self.parts.cells.headway_time);
        Ok(Exposure {
            trial,
            peaks: passage.peaks[seat].iter().map(peak).collect(),
            train: train.ok_or_else(no_forces)?,
        })
    }
}

fn none_passed() -> NodeError {
    let why = "no sleeper on this bed is passed by every wheel of the train: make the track longer".to_owned();
    NodeError::Other { node: "specimens".into(), why }
}

/// A value whose difference from another one is multiplied by a factor; supports do not pull.
fn scaled(value: f64, rest: f64, factor: f64) -> f64 {
    (rest + factor * (value - rest)).max(0.0)
}

/// The cells of a graph of tier `cells`.
fn cells_of(graph: &Graph) -> Option<&CellsNode> {
    graph.nodes.iter().find_map(|node| if let Model::Cells(cells) = &node.model { Some(cells) } else { None })
}

/// Cells of a graph that differ in how they are built: the index of each in the plan, with the section of its bed.
pub fn kinds_of_cells(graph: &Graph) -> Vec<(usize, &str)> {
    let Some(node) = cells_of(graph) else { return Vec::new() };
    let mut kinds: Vec<usize> = Vec::new();
    for (number, plan) in node.cells.iter().enumerate() {
        if !kinds.iter().any(|known| CellPlan::is_built_alike(&node.cells[*known], plan)) {
            kinds.push(number);
        }
    }
    kinds.into_iter().map(|cell| (cell, node.beds[node.cells[cell].bed].section.as_str())).collect()
}
