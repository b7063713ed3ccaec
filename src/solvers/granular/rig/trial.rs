//! A running test. It runs in pieces of a cycle, so that it can stop and continue between any two pieces.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::listen::Answer;
use super::super::motion::{Push, WallMotion};
use super::super::stride::{Sharing, Stride};
use super::super::walls::WallId;
use super::answer::{Cycle, CycleSample};
use super::calm::{AT_REST, DAMPING};
use super::crib::fill;
use super::description::{Load, Rig};
use super::error::{Resting, RigError, in_cycle};
use super::glued::glue;
use super::sensor::SensorReading;
use super::set_down::{motion, place, until_rest};
use super::specimen::{Size, SpecimenState};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Pieces of a cycle: forces and depths are read after each piece, sensors after every second piece. The error of the
/// deepest position of a sine is below a thousandth.
pub(super) const PIECES: u64 = 64;
const SENSORS: u64 = 2;
/// Number of pieces over which the lower force grows.
const RAMP: u64 = PIECES / 2;
/// Limit of the settlement of a sleeper as a share of the height of the bed; beyond it the bed does not carry the
/// sleeper.
const SUNK: f64 = 0.5;

/// A bed with its sleepers under test.
pub struct Trial<'a, R: Real> {
    pub bed: Bed<R>,
    pub(super) rig: &'a Rig,
    pub(super) state: TrialState,
}

/// The state of a test besides its bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct TrialState {
    pub walls: Vec<WallId>,
    /// Level of the middle of each sleeper at rest under its own weight, or under the pressure on a specimen, m.
    pub rest: Vec<f64>,
    /// Size of a consolidated specimen.
    pub size: Option<Size>,
    pub specimen: Vec<SpecimenState>,
    /// Time at which the first ramp begins, s.
    pub start: f64,
    pub pieces: u64,
    pub steps: u64,
    /// Time step of the bed, s.
    pub stride: f64,
    pub current: Vec<Current>,
    pub cycles: Vec<Cycle>,
    pub samples: Vec<CycleSample>,
    pub readings: Vec<SensorReading>,
}

/// The present cycle of a sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Current {
    deepest: f64,
    contact_force: f64,
    work: f64,
    /// After the piece before: force of the actuator, N, and depth of the sleeper, m.
    force: f64,
    depth: f64,
}

impl<'a, R: Real> Trial<'a, R> {
    /// Sets the sleepers down, fills the cribs and lets everything come to rest. `tell` receives the elapsed share of
    /// the longest time for this.
    pub fn new<A: Answer>(mut bed: Bed<R>, rig: &'a Rig, mut tell: impl FnMut(f64) -> A) -> Result<Self, RigError> {
        let mut tell = |share: f64| tell(share).flow();
        let before = bed.steps();
        let walls = place(&mut bed, &rig.sleepers, rig.gravity);
        until_rest(&mut bed, &walls, (Resting::Sleepers, &AT_REST), &mut tell)?;
        if let Some(filling) = &rig.filling {
            fill(&mut bed, (&rig.sleepers, &walls), filling, &mut tell)?;
        }
        let size = consolidated(&mut bed, rig, &walls, tell)?;
        glue(&mut bed, &rig.glued).map_err(in_cycle(0))?;
        let rest = walls.iter().map(|wall| bed.wall(*wall).pose(bed.domain()).position.z).collect();
        let state = TrialState {
            start: bed.time(),
            pieces: 0,
            steps: bed.steps() - before,
            stride: Stride::with_added(&mut bed, Sharing::Even, rig.added).map_err(in_cycle(0))?.step,
            current: vec![Current::default(); walls.len()],
            walls,
            rest,
            size,
            specimen: Vec::new(),
            cycles: Vec::new(),
            samples: Vec::new(),
            readings: Vec::new(),
        };
        let mut trial = Trial { bed, rig, state };
        trial.engage();
        Ok(trial)
    }

    /// Gives each sleeper the force of its actuator, and the sides of a specimen their pressure, for their present
    /// areas.
    fn engage(&mut self) {
        let weights = match (self.rig.specimen, self.size()) {
            (Some(specimen), Some(size)) => {
                specimen.hold(&mut self.bed, &size);
                vec![specimen.pressure * size.area()]
            }
            _ => self.rig.sleepers.iter().map(|sleeper| self.rig.gravity * sleeper.mass).collect(),
        };
        for (number, weight) in weights.into_iter().enumerate() {
            let motion = self.motion(number, weight);
            self.bed.set_motion(self.state.walls[number], motion);
        }
    }

    /// Motion of a sleeper under a weight, N.
    fn motion(&self, number: usize, weight: f64) -> WallMotion {
        let sleeper = &self.rig.sleepers[number];
        let ramp = RAMP as f64 * self.piece();
        let start = self.state.start + (RAMP + self.delay(number)) as f64 * self.piece();
        let push = match &sleeper.load {
            Load::None => Push::Constant(0.0),
            Load::Constant(force) => Push::Table { times: vec![start - ramp, start], forces: vec![0.0, *force] },
            Load::Cyclic { range: [low, high], .. } => {
                Push::Cyclic { low: *low, high: *high, frequency: 1.0 / self.rig.period, start, ramp }
            }
            Load::History(points) => history(points, start, ramp),
            Load::Strain(share) => {
                // the plate accelerates during one piece, which costs half a piece
                let time = self.rig.period - 0.5 * self.piece();
                let speed = share * (self.state.rest[number] - sleeper.size[2] / 2.0) / time;
                let velocities = vec![Vector3::zeros(), -speed * Vector3::z()];
                return WallMotion::Table { times: vec![start, start + self.piece()], velocities };
            }
        };
        motion(sleeper, weight, self.bed.damping, push)
    }

    /// Present size of the specimen.
    fn size(&self) -> Option<Size> {
        let [plate] = self.state.walls[..] else { return None };
        let level = self.bed.wall(plate).pose(self.bed.domain()).position.z - self.face();
        Some(self.rig.specimen?.size(&self.bed, level))
    }

    /// Distance from the middle of the plate down to its lower face, m.
    fn face(&self) -> f64 {
        self.rig.sleepers[0].size[2] / 2.0
    }

    /// s.
    fn piece(&self) -> f64 {
        self.rig.period / PIECES as f64
    }

    /// Pieces by which the actuator of a sleeper starts after the first actuator.
    fn delay(&self, sleeper: usize) -> u64 {
        match self.rig.sleepers[sleeper].load {
            Load::Cyclic { delay, .. } => (delay / self.piece()).round() as u64,
            _ => 0,
        }
    }

    /// Pieces of the whole test, including ramp and delays.
    pub fn pieces(&self) -> u64 {
        let latest = (0..self.rig.sleepers.len()).map(|sleeper| self.delay(sleeper)).max().unwrap_or(0);
        RAMP + latest + PIECES * self.rig.cycles
    }

    /// Pieces that are done.
    pub fn done(&self) -> u64 {
        self.state.pieces
    }

    /// Time steps of the test so far, including setting down.
    pub fn steps(&self) -> u64 {
        self.state.steps
    }

    /// Finished cycles, in the order of their ends.
    pub fn cycles(&self) -> &[Cycle] {
        &self.state.cycles
    }

    pub fn samples(&self) -> &[CycleSample] {
        &self.state.samples
    }

    /// States of a specimen in the recorded cycles.
    pub fn specimen(&self) -> &[SpecimenState] {
        &self.state.specimen
    }

    pub fn readings(&self) -> &[SensorReading] {
        &self.state.readings
    }

    /// Whether the last piece ended a cycle of the first actuator.
    pub fn at_end_of_cycle(&self) -> bool {
        self.state.pieces > RAMP && (self.state.pieces - RAMP).is_multiple_of(PIECES)
    }

    /// Runs the next piece; returns false if there is none.
    pub fn advance(&mut self) -> Result<bool, RigError> {
        if self.state.pieces == self.pieces() {
            return Ok(false);
        }
        let cycle = self.state.pieces.saturating_sub(RAMP) / PIECES + 1;
        if self.rig.specimen.is_some() {
            self.engage();
        }
        let stride = Stride { step: self.state.stride, sharing: Sharing::Even };
        let piece = self.piece();
        self.state.steps += stride.run(&mut self.bed, &self.state.walls, piece).map_err(in_cycle(cycle))?;
        self.state.pieces += 1;
        (0..self.rig.sleepers.len()).try_for_each(|sleeper| self.look_at(sleeper, cycle))?;
        self.look_at_specimen(cycle);
        self.read(cycle)?;
        Ok(true)
    }

    fn look_at(&mut self, sleeper: usize, running: u64) -> Result<(), RigError> {
        let wall = self.bed.wall(self.state.walls[sleeper]);
        let level = wall.pose(self.bed.domain()).position.z;
        let (depth, contact_force) = (self.state.rest[sleeper] - level, wall.felt().force.z);
        let velocity = -wall.velocity().0[2];
        let force = match wall.motion() {
            WallMotion::Loaded { push, .. } => push.force_at(self.bed.time()),
            // for a driven plate: its force in addition to the pressure on a specimen
            _ => contact_force - self.rig.specimen.zip(self.size()).map_or(0.0, |(s, size)| s.pressure * size.area()),
        };
        let height = self.state.rest[sleeper] - self.rig.sleepers[sleeper].size[2] / 2.0;
        if depth > SUNK * height {
            return Err(RigError::Sunk { sleeper, depth, cycle: running });
        }
        let begin = RAMP + self.delay(sleeper);
        let current = &mut self.state.current[sleeper];
        let (before, moved) = (current.force, depth - current.depth);
        (current.force, current.depth) = (force, depth);
        let Some(since) = self.state.pieces.checked_sub(begin).filter(|since| *since > 0) else { return Ok(()) };
        let (cycle, part) = ((since - 1) / PIECES + 1, (since - 1) % PIECES + 1);
        if cycle > self.rig.cycles {
            return Ok(());
        }
        current.deepest = if part == 1 { depth } else { current.deepest.max(depth) };
        current.contact_force = if part == 1 { contact_force } else { current.contact_force.max(contact_force) };
        current.work = if part == 1 { 0.0 } else { current.work } + 0.5 * (before + force) * moved;
        if self.rig.kept.contains(&cycle) {
            let phase = part as f64 / PIECES as f64;
            self.state.samples.push(CycleSample { sleeper, cycle, phase, force, contact_force, depth, velocity });
        }
        if part == PIECES {
            self.state.cycles.push(self.ended(sleeper, cycle));
        }
        Ok(())
    }

    fn look_at_specimen(&mut self, cycle: u64) {
        let (Some(specimen), Some(rest), [plate]) = (self.rig.specimen, self.state.size, &self.state.walls[..]) else {
            return;
        };
        let since = self.state.pieces.saturating_sub(RAMP);
        if since > 0 && self.rig.kept.contains(&cycle) {
            let phase = ((since - 1) % PIECES + 1) as f64 / PIECES as f64;
            let state = specimen.state(&self.bed, *plate, self.face(), &rest);
            self.state.specimen.push(SpecimenState { cycle, phase, ..state });
        }
    }

    /// The results of a sleeper at the end of its cycle.
    fn ended(&self, sleeper: usize, number: u64) -> Cycle {
        let Current { deepest, contact_force, work, depth: settlement, .. } = self.state.current[sleeper];
        let load = &self.rig.sleepers[sleeper].load;
        let [low, high] = load.range();
        // a constant force has no rebound: the whole force is divided by the whole settlement
        let rebound = if matches!(load, Load::Constant(_)) { settlement } else { deepest - settlement };
        let stiffness = if rebound > 0.0 { (high - low) / rebound } else { 0.0 };
        Cycle { sleeper, number, settlement, deepest, stiffness, contact_force, work, steps: self.state.steps }
    }

    /// Reads the sensors in the recorded cycles; cycles count by the first actuator.
    fn read(&mut self, cycle: u64) -> Result<(), RigError> {
        let Some(since) = self.state.pieces.checked_sub(RAMP).filter(|since| *since > 0) else { return Ok(()) };
        let part = (since - 1) % PIECES + 1;
        let wanted = self.rig.kept.contains(&cycle) && cycle <= self.rig.cycles && part.is_multiple_of(SENSORS);
        if !wanted || self.rig.sensors.is_empty() {
            return Ok(());
        }
        let snapshot = self.bed.snapshot().map_err(in_cycle(cycle))?;
        for (number, sensor) in self.rig.sensors.iter().enumerate() {
            let porosity = (part == PIECES).then(|| sensor.porosity(&self.bed, &self.rig.densities));
            let phase = part as f64 / PIECES as f64;
            let reading = sensor.read(&self.bed, &snapshot);
            self.state.readings.push(SensorReading { sensor: number, cycle, phase, porosity, ..reading });
        }
        Ok(())
    }
}

/// Applies the pressure to the sides of a specimen, and the same pressure to the plate.
fn consolidated<R: Real>(
    bed: &mut Bed<R>,
    rig: &Rig,
    walls: &[WallId],
    tell: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Size>, RigError> {
    let (Some(specimen), [plate], [sleeper]) = (rig.specimen, walls, &rig.sleepers[..]) else { return Ok(None) };
    let push = |bed: &mut Bed<R>, force: f64| {
        bed.set_motion(*plate, motion(sleeper, force, DAMPING, Push::Constant(0.0)));
    };
    specimen.consolidate(bed, *plate, sleeper.size[2] / 2.0, push, tell).map(Some)
}

/// A history that begins at `start`, after a ramp to its first force.
fn history(points: &[[f64; 2]], start: f64, ramp: f64) -> Push {
    let first = points.first().copied().unwrap_or_default();
    let mut times = vec![start - ramp];
    let mut forces = vec![0.0];
    for [time, force] in points {
        times.push(start + time - first[0]);
        forces.push(*force);
    }
    Push::Table { times, forces }
}
