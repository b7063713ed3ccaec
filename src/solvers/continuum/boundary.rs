//! Supports of the soil: fixed faces, rollers, quiet faces, driven nodes.
//!
//! A quiet face has dashpots with the impedance of the soil behind it (Lysmer and Kuhlemeyer 1969): `ρ c_p` across the
//! face, `ρ c_s` along it, times its area. A dashpot acts on the mean of the velocities before and after a step, so
//! that it never shortens the step.

use super::error::{SoilError, number};
use super::mesh::FACES;
use super::soil::Soil;
use std::collections::HashMap;

/// A side of the box around the soil.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    XMin,
    XMax,
    YMin,
    YMax,
    Bottom,
    Top,
}

/// The support of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// Its nodes do not move.
    Fixed,
    /// Its nodes do not move across it: a wall without friction, or a plane of symmetry.
    Roller,
    /// Waves leave the soil through it. In a state of rest it is a roller; the reactions at rest are kept afterwards.
    Quiet,
}

impl Side {
    pub const ALL: [Side; 6] = [Side::XMin, Side::XMax, Side::YMin, Side::YMax, Side::Bottom, Side::Top];

    /// The axis perpendicular to the side.
    pub fn axis(self) -> usize {
        self as usize / 2
    }

    pub fn name(self) -> &'static str {
        ["x min", "x max", "y min", "y max", "bottom", "top"][self as usize]
    }
}

impl Soil {
    /// Supports a side of the soil. Nodes of two sides have both supports.
    ///
    /// # Errors
    /// No face of an element lies on this side.
    pub fn support(&mut self, side: Side, support: Support) -> Result<(), SoilError> {
        let faces = self.faces(side);
        if faces.is_empty() {
            return Err(SoilError::NoFace { side: side.name() });
        }
        let across = side.axis();
        for (element, corners) in faces {
            let impedance = self.impedance(element, across, corners);
            for node in corners.map(|corner| corner as usize) {
                match support {
                    Support::Fixed => (0..3).for_each(|axis| self.nodes.drive(node, axis, 0.0)),
                    Support::Roller => self.nodes.drive(node, across, 0.0),
                    Support::Quiet => self.nodes.add_quiet(node, across, impedance),
                }
            }
        }
        Ok(())
    }

    /// Holds a node along an axis (0, 1, 2 for x, y, z) at a velocity \[m/s\]; 0 fixes the node.
    ///
    /// # Errors
    /// A velocity that is not a finite number.
    pub fn drive(&mut self, node: usize, axis: usize, velocity: f64) -> Result<(), SoilError> {
        number("the velocity of a driven node", velocity)?;
        self.nodes.drive(node, axis, velocity);
        Ok(())
    }

    /// Releases a node along an axis.
    pub fn release(&mut self, node: usize, axis: usize) {
        self.nodes.held[node][axis] = false;
        self.measured = None;
    }

    /// Nodes of the faces of elements on a side, each once.
    pub fn side_nodes(&self, side: Side) -> Vec<usize> {
        let mut nodes: Vec<usize> =
            self.faces(side).iter().flat_map(|(_, corners)| corners.map(|n| n as usize)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Faces of a side with their elements: faces in the outermost plane that belong to one element only.
    fn faces(&self, side: Side) -> Vec<(usize, [u32; 4])> {
        let nodes = self.mesh.nodes();
        let (axis, largest) = (side.axis(), side as usize % 2 == 1);
        let span = |from: f64, choose: fn(f64, f64) -> f64| nodes.iter().fold(from, |x, node| choose(x, node[axis]));
        let (low, high) = (span(f64::INFINITY, f64::min), span(f64::NEG_INFINITY, f64::max));
        let plane = if largest { high } else { low };
        let near = |&node: &u32| (nodes[node as usize][axis] - plane).abs() <= 1e-9 * (high - low);
        let mut found: HashMap<[u32; 4], Option<(usize, [u32; 4])>> = HashMap::new();
        for (element, face) in self.mesh.elements().iter().enumerate().flat_map(|(e, _)| FACES.map(|face| (e, face))) {
            let corners = face.map(|corner| self.mesh.elements()[element].nodes[corner]);
            if corners.iter().all(near) {
                let mut key = corners;
                key.sort_unstable();
                found.entry(key).and_modify(|other| *other = None).or_insert(Some((element, corners)));
            }
        }
        let mut faces: Vec<_> = found.into_values().flatten().collect();
        faces.sort_unstable();
        faces
    }

    /// Impedance of the soil behind a face at each of its corners \[N s/m\].
    fn impedance(&self, element: usize, across: usize, corners: [u32; 4]) -> [f64; 3] {
        let [a, b, c, d] = corners.map(|node| self.mesh.nodes()[node as usize]);
        let (next, third) = ((across + 1) % 3, (across + 2) % 3);
        let turned = |p: [f64; 3], q: [f64; 3]| p[next] * q[third] - p[third] * q[next];
        let between = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|axis| q[axis] - p[axis]);
        let area = 0.5 * turned(between(a, c), between(b, d)).abs();
        let material = &self.mesh.materials()[self.mesh.elements()[element].material as usize];
        let [compression, shear] = material.wave_speeds().map(|speed| material.density * speed * area / 4.0);
        [0, 1, 2].map(|axis| if axis == across { compression } else { shear })
    }
}
