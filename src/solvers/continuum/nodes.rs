//! The nodes of the soil: their motion, their masses, and the sums of their forces.

use super::chunk::Chunk;
use super::mesh::Mesh;
use super::shape::Shape;

/// Data of each node. A step reads as little of it as it can, because grains leave nothing of it in the caches: data of
/// few nodes stay away until a node needs them.
#[derive(Debug, Clone)]
pub struct Nodes {
    pub displacement: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub mass: Vec<f64>,
    /// Forces added by the caller for the next step \[N\], the nodes that have some, and whether a node is one of them.
    external: Vec<[f64; 3]>,
    loaded: Vec<u32>,
    is_loaded: Vec<bool>,
    /// Reactions of quiet faces since the last state of rest \[N\]; empty without quiet faces.
    pub borne: Vec<[f64; 3]>,
    /// Forces of stiffness damping in this step \[N\]; empty without.
    pub viscous: Vec<[f64; 3]>,
    /// Dashpots of quiet faces \[N s/m\]; empty without.
    pub dashpot: Vec<[f64; 3]>,
    /// Axes along which a node moves at a given velocity.
    pub held: Vec<[bool; 3]>,
    /// This velocity \[m/s\]; empty while it is 0 for all.
    driven: Vec<[f64; 3]>,
    /// Axes across a quiet face: held during the search for a state of rest.
    pub quiet: Vec<[bool; 3]>,
    /// The slots of the forces of a node in the chunks: chunk and node of the chunk, node after node.
    pub slots: Vec<(u32, u32)>,
    /// First slot of each node, and one final value.
    pub starts: Vec<u32>,
}

impl Nodes {
    pub fn new(mesh: &Mesh, shapes: &[Shape], kinds: &[u32], chunks: &[Chunk]) -> Nodes {
        let count = mesh.nodes().len();
        let zeros = vec![[0.0; 3]; count];
        let mut mass = vec![0.0; count];
        for (element, &kind) in mesh.elements().iter().zip(kinds) {
            for (&node, share) in element.nodes.iter().zip(shapes[kind as usize].masses) {
                mass[node as usize] += share;
            }
        }
        let mut starts = vec![0u32; count + 1];
        for &node in chunks.iter().flat_map(|chunk| &chunk.nodes) {
            starts[node as usize + 1] += 1;
        }
        for node in 0..count {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut slots = vec![(0, 0); starts[count] as usize];
        for (at, chunk) in chunks.iter().enumerate() {
            for (local, &node) in chunk.nodes.iter().enumerate() {
                slots[next[node as usize] as usize] = (at as u32, local as u32);
                next[node as usize] += 1;
            }
        }
        Nodes {
            displacement: zeros.clone(),
            velocity: zeros.clone(),
            mass,
            external: zeros,
            loaded: Vec::new(),
            is_loaded: vec![false; count],
            borne: Vec::new(),
            viscous: Vec::new(),
            dashpot: Vec::new(),
            held: vec![[false; 3]; count],
            driven: Vec::new(),
            quiet: vec![[false; 3]; count],
            slots,
            starts,
        }
    }

    /// Adds to the force of the caller on a node \[N\].
    #[inline]
    pub fn add_force(&mut self, node: usize, force: [f64; 3]) {
        let sum = &mut self.external[node];
        (0..3).for_each(|axis| sum[axis] += force[axis]);
        if !std::mem::replace(&mut self.is_loaded[node], true) {
            self.loaded.push(node as u32);
        }
    }

    /// The force of the caller on a node \[N\].
    #[inline(always)]
    pub fn external(&self, node: usize) -> [f64; 3] {
        if self.is_loaded[node] { self.external[node] } else { [0.0; 3] }
    }

    /// Forces of the caller on all nodes \[N\].
    pub fn externals(&self) -> &[[f64; 3]] {
        &self.external
    }

    pub fn clear_forces(&mut self) {
        for node in self.loaded.drain(..) {
            self.external[node as usize] = [0.0; 3];
            self.is_loaded[node as usize] = false;
        }
    }

    /// Holds a node along an axis at a velocity \[m/s\].
    pub fn drive(&mut self, node: usize, axis: usize, velocity: f64) {
        self.held[node][axis] = true;
        if velocity != 0.0 && self.driven.is_empty() {
            self.driven = vec![[0.0; 3]; self.mass.len()];
        }
        if let Some(driven) = self.driven.get_mut(node) {
            driven[axis] = velocity;
        }
    }

    /// The velocity at which a held node moves \[m/s\].
    #[inline(always)]
    pub fn driven(&self, node: usize) -> [f64; 3] {
        self.driven.get(node).copied().unwrap_or_default()
    }

    /// Adds dashpots to a node \[N s/m\], for a quiet face across an axis.
    pub fn add_quiet(&mut self, node: usize, across: usize, dashpot: [f64; 3]) {
        if self.dashpot.is_empty() {
            self.dashpot = vec![[0.0; 3]; self.mass.len()];
            self.borne = self.dashpot.clone();
        }
        self.quiet[node][across] = true;
        (0..3).for_each(|axis| self.dashpot[node][axis] += dashpot[axis]);
    }

    /// Sum of the forces of all elements on a node \[N\].
    #[inline(always)]
    pub fn pull(&self, chunks: &[Chunk], node: usize) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for &(chunk, local) in &self.slots[self.starts[node] as usize..self.starts[node + 1] as usize] {
            let force = chunks[chunk as usize].force(local as usize);
            for axis in 0..3 {
                sum[axis] += force[axis];
            }
        }
        sum
    }
}
