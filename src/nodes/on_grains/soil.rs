//! The soil below a bed: the floor of the grains moves with the nodes of its surface.
//!
//! The soil takes every step of the grains, and not one step for several of theirs. Otherwise force and velocity would
//! be two steps apart: with one step in sixteen, columns of spheres under a rail gained a tenth of the wheels' work.

use crate::graph::{SoilLayer, SoilNode};
use crate::nodes::NodeError;
use crate::solvers::continuum::{Material, Mesh, Settings, Side, Soil, State, Support};
use crate::solvers::granular::{Bed, Guided, Sheet, WallId};

/// Soil under one bed.
#[derive(Clone)]
pub struct SoilBelow {
    pub soil: Soil,
    floor: WallId,
    /// Node under each corner of the floor.
    nodes: Vec<usize>,
}

/// Share of the stable step of the soil that is taken.
const SAFE: f64 = 0.8;

impl SoilBelow {
    /// Puts soil under a bed at rest: it carries the bed in its present position without moving.
    pub fn new(bed: &mut Bed<f32>, floor: WallId, plan: Plan, node: &SoilNode) -> Result<SoilBelow, NodeError> {
        let (mut soil, sheet) = unloaded(plan, node)?;
        let nodes = nodes_under(&sheet, &soil);
        bed.soften(floor, sheet);
        bed.snapshot()?;
        if let Some(sheet) = bed.wall(floor).sheet() {
            nodes.iter().zip(sheet.forces()).for_each(|(node, force)| soil.add_force(*node, *force));
        }
        soil.rest(&[])?;
        Ok(SoilBelow { soil, floor, nodes })
    }

    /// The state as data.
    pub fn store(&self) -> State {
        self.soil.state()
    }

    /// The soil below a bed that was stored with it.
    pub fn restore(
        bed: &Bed<f32>,
        floor: WallId,
        plan: Plan,
        node: &SoilNode,
        state: State,
    ) -> Result<SoilBelow, NodeError> {
        let (mut soil, sheet) = unloaded(plan, node)?;
        let nodes = nodes_under(&sheet, &soil);
        let corners =
            bed.walls().get(floor.0 as usize).and_then(|wall| wall.sheet()).map(|sheet| sheet.corners().len());
        if corners != Some(nodes.len()) {
            let why = "its soil has another number of corners".to_owned();
            return Err(NodeError::Foreign { node: "grains under the track", why });
        }
        soil.restore(state)?;
        Ok(SoilBelow { soil, floor, nodes })
    }

    /// Longest stable step of the soil with the present contacts on its nodes, minus a reserve, s.
    pub fn longest_step(&self, bed: &Bed<f32>) -> f64 {
        let springs: Vec<(usize, f64)> = match bed.wall(self.floor).sheet() {
            Some(sheet) => self.nodes.iter().copied().zip(sheet.stiffnesses().iter().copied()).collect(),
            None => Vec::new(),
        };
        SAFE * self.soil.limit_with(&springs)
    }

    /// Takes the forces of a step of the grains, and says how the corners of their floor move in it.
    pub fn step(&mut self, walls: &mut Guided<'_>) -> Result<(), NodeError> {
        let dt = walls.dt;
        let Some(sheet) = walls.sheet(self.floor) else { return Ok(()) };
        self.nodes.iter().zip(sheet.forces()).for_each(|(node, force)| self.soil.add_force(*node, *force));
        self.soil.step(dt)?;
        let velocities = self.soil.velocities();
        for (corner, node) in sheet.corners_mut().iter_mut().zip(&self.nodes) {
            corner.velocity = velocities[*node];
            (0..3).for_each(|axis| corner.displacement[axis] += dt * corner.velocity[axis]);
        }
        Ok(())
    }
}

/// Where a bed lies: chainage of its left end, length and width, m.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    pub start: f64,
    pub sides: [f64; 2],
}

/// Soil that bears nothing yet, and the floor over it.
fn unloaded(plan: Plan, node: &SoilNode) -> Result<(Soil, Sheet), NodeError> {
    let [x, y] = plan.sides.map(|side| lines(0.0, side, node.element));
    let z = levels(node);
    let (materials, numbers) = materials(plan.start, node, &x, &z);
    let mesh = Mesh::grid([&x, &y, &z], materials, |i, _, k| Some(numbers[i][k]))?;
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

/// The materials of the layers, each once, and the material of each element by its place along the track and upwards.
/// An element has the material at its middle.
fn materials(start: f64, node: &SoilNode, x: &[f64], z: &[f64]) -> (Vec<Material>, Vec<Vec<usize>>) {
    let mut found: Vec<Material> = Vec::new();
    let mut number = |layer: &SoilLayer| {
        let material = Material {
            density: layer.density,
            youngs_modulus: layer.youngs_modulus,
            poisson_ratio: layer.poisson_ratio,
            strength: layer.strength,
        };
        found.iter().position(|other| *other == material).unwrap_or_else(|| {
            found.push(material);
            found.len() - 1
        })
    };
    let middle = |pair: &[f64]| 0.5 * (pair[0] + pair[1]);
    let column = |pair: &[f64]| -> Vec<usize> {
        let layers = node.layers_at(start + middle(pair));
        z.windows(2).filter_map(|pair| layer_at(layers, -middle(pair))).map(&mut number).collect()
    };
    let numbers = x.windows(2).map(column).collect();
    (found, numbers)
}

/// The layer at a depth, m; the lowest below all of them.
fn layer_at(layers: &[SoilLayer], depth: f64) -> Option<&SoilLayer> {
    let mut base = 0.0;
    let reached = |layer: &&SoilLayer| {
        base += layer.thickness;
        depth < base
    };
    layers.iter().find(reached).or(layers.last())
}

/// Levels of the elements from the base up to the floor of the grains at 0, m.
fn levels(node: &SoilNode) -> Vec<f64> {
    let depth: f64 = node.layers.iter().map(|layer| layer.thickness).sum();
    let mut levels = vec![-depth];
    for (number, layer) in node.layers.iter().enumerate().rev() {
        let base = levels[levels.len() - 1];
        // round-off must not leave the floor beside 0
        let top = if number == 0 { 0.0 } else { base + layer.thickness };
        let of_layer = lines(base, top, node.element);
        levels.extend(&of_layer[1..]);
    }
    levels
}
