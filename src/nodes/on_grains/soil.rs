//! The soil below a bed: the floor of the grains moves with the nodes of its surface.
//!
//! Soil whose own step is longer takes one for several of the grains: its corners go on at constant velocity meanwhile, and it feels the
//! mean of their forces, so that momentum stays to round-off.

use crate::graph::SoilNode;
use crate::nodes::NodeError;
use crate::solvers::continuum::{Material, Mesh, Settings, Side, Soil, State, Support};
use crate::solvers::granular::{Bed, Guided, Sheet, WallId};
use serde::{Deserialize, Serialize};

/// Soil under one bed.
#[derive(Clone)]
pub struct SoilBelow {
    pub soil: Soil,
    floor: WallId,
    /// Node under each corner of the floor.
    nodes: Vec<usize>,
    state: SinceStep,
}

/// What has come together since the last step of the soil.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct SinceStep {
    /// Steps of the grains in one of the soil, and those done.
    ratio: u32,
    steps: u32,
    time: f64,
    /// N s at each corner.
    impulses: Vec<[f64; 3]>,
}

/// Share of the stable step of the soil that is taken, and steps of the grains in it at most.
const SAFE: f64 = 0.8;
const MOST: f64 = 16.0;

impl SoilBelow {
    /// Puts soil under a bed of so long and wide a plan (m) at rest: it bears the bed as it lies, and lies still.
    pub fn new(bed: &mut Bed<f32>, floor: WallId, plan: [f64; 2], node: &SoilNode) -> Result<SoilBelow, NodeError> {
        let (mut soil, sheet) = unloaded(plan, node)?;
        let nodes = nodes_under(&sheet, &soil);
        bed.soften(floor, sheet);
        bed.snapshot()?;
        if let Some(sheet) = bed.wall(floor).sheet() {
            nodes.iter().zip(sheet.forces()).for_each(|(node, force)| soil.add_force(*node, *force));
        }
        soil.rest(&[])?;
        let impulses = vec![[0.0; 3]; nodes.len()];
        Ok(SoilBelow { soil, floor, nodes, state: SinceStep { ratio: 1, impulses, ..SinceStep::default() } })
    }

    /// The state as data.
    pub fn store(&self) -> (State, SinceStep) {
        (self.soil.state(), self.state.clone())
    }

    /// The soil below a bed that was stored with it.
    pub fn restore(
        bed: &Bed<f32>,
        floor: WallId,
        plan: [f64; 2],
        node: &SoilNode,
        (state, since): (State, SinceStep),
    ) -> Result<SoilBelow, NodeError> {
        let (mut soil, sheet) = unloaded(plan, node)?;
        let nodes = nodes_under(&sheet, &soil);
        let corners =
            bed.walls().get(floor.0 as usize).and_then(|wall| wall.sheet()).map(|sheet| sheet.corners().len());
        if corners != Some(nodes.len()) || since.impulses.len() != nodes.len() {
            let why = "its soil has another number of corners".to_owned();
            return Err(NodeError::Foreign { node: "grains under the track", why });
        }
        soil.restore(state)?;
        Ok(SoilBelow { soil, floor, nodes, state: since })
    }

    /// Chooses how many steps (s) of the grains the soil takes at once, by its limit with the contacts of now on its nodes.
    pub fn adapt(&mut self, bed: &Bed<f32>, time_step: f64) {
        let springs: Vec<(usize, f64)> = match bed.wall(self.floor).sheet() {
            Some(sheet) => self.nodes.iter().copied().zip(sheet.stiffnesses().iter().copied()).collect(),
            None => Vec::new(),
        };
        self.state.ratio = (SAFE * self.soil.limit_with(&springs) / time_step).clamp(1.0, MOST) as u32;
    }

    /// Steps of the grains in one of the soil.
    pub fn ratio(&self) -> u32 {
        self.state.ratio
    }

    /// Takes the forces of a step of the grains, and says how the corners of their floor move in it.
    pub fn step(&mut self, walls: &mut Guided<'_>) -> Result<(), NodeError> {
        let dt = walls.dt;
        let Some(sheet) = walls.sheet(self.floor) else { return Ok(()) };
        let since = &mut self.state;
        for (impulse, force) in since.impulses.iter_mut().zip(sheet.forces()) {
            (0..3).for_each(|axis| impulse[axis] += dt * force[axis]);
        }
        (since.steps, since.time) = (since.steps + 1, since.time + dt);
        if since.steps >= since.ratio {
            for (node, impulse) in self.nodes.iter().zip(&mut since.impulses) {
                self.soil.add_force(*node, impulse.map(|sum| sum / since.time));
                *impulse = [0.0; 3];
            }
            self.soil.step(since.time)?;
            (since.steps, since.time) = (0, 0.0);
            let velocities = self.soil.velocities();
            for (corner, node) in sheet.corners_mut().iter_mut().zip(&self.nodes) {
                corner.velocity = velocities[*node];
            }
        }
        for corner in sheet.corners_mut() {
            (0..3).for_each(|axis| corner.displacement[axis] += dt * corner.velocity[axis]);
        }
        Ok(())
    }
}

/// Soil that bears nothing yet, and the floor over it.
fn unloaded(plan: [f64; 2], node: &SoilNode) -> Result<(Soil, Sheet), NodeError> {
    let [x, y] = plan.map(|side| lines(0.0, side, node.element));
    let (z, layer_of) = levels(node);
    let materials = node.layers.iter().map(|layer| Material {
        density: layer.density,
        youngs_modulus: layer.youngs_modulus,
        poisson_ratio: layer.poisson_ratio,
        strength: layer.strength,
    });
    let mesh = Mesh::grid([&x, &y, &z], materials.collect(), |_, _, k| Some(layer_of[k]))?;
    let mut soil = Soil::new(mesh, Settings { gravity: [0.0, 0.0, -node.gravity], ..Settings::default() })?;
    for side in [Side::XMin, Side::XMax, Side::YMin, Side::YMax] {
        soil.support(side, Support::Roller)?;
    }
    soil.support(Side::Bottom, if node.quiet_base { Support::Quiet } else { Support::Fixed })?;
    let sheet = Sheet::flat(x, y).ok_or(NodeError::NoGround)?;
    Ok((soil, sheet))
}

/// The node under each corner of a floor.
fn nodes_under(sheet: &Sheet, soil: &Soil) -> Vec<usize> {
    let under = |corner: usize| {
        let [x, y] = sheet.place(corner);
        soil.mesh().nearest([x, y, 0.0])
    };
    (0..sheet.corners().len()).map(under).collect()
}

/// Equal parts of a stretch, each about as long as `size`, m.
fn lines(from: f64, to: f64, size: f64) -> Vec<f64> {
    let count = ((to - from) / size).round().max(1.0) as usize;
    (0..=count).map(|line| from + (to - from) * line as f64 / count as f64).collect()
}

/// Levels of the elements from the base up to the floor of the grains at 0 (m), and the layer of each.
fn levels(node: &SoilNode) -> (Vec<f64>, Vec<usize>) {
    let depth: f64 = node.layers.iter().map(|layer| layer.thickness).sum();
    let (mut levels, mut layer_of) = (vec![-depth], Vec::new());
    for (number, layer) in node.layers.iter().enumerate().rev() {
        let base = levels[levels.len() - 1];
        // round-off must not leave the floor beside 0
        let top = if number == 0 { 0.0 } else { base + layer.thickness };
        let of_layer = lines(base, top, node.element);
        layer_of.extend(std::iter::repeat_n(number, of_layer.len() - 1));
        levels.extend(&of_layer[1..]);
    }
    (levels, layer_of)
}
