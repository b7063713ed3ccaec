//! The nodes of the soil: their motion, their masses, and the sums of their forces.

use super::chunk::Chunk;
use super::mesh::Mesh;
use super::shape::Shape;

/// Data of each node.
#[derive(Debug, Clone)]
pub struct Nodes {
    pub displacement: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub mass: Vec<f64>,
    /// Forces added by the caller for the next step \[N\].
    pub external: Vec<[f64; 3]>,
    /// Reactions of quiet faces since the last state of rest \[N\].
    pub borne: Vec<[f64; 3]>,
    /// Forces of stiffness damping in this step \[N\]; empty without.
    pub viscous: Vec<[f64; 3]>,
    /// Dashpots of quiet faces \[N s/m\].
    pub dashpot: Vec<[f64; 3]>,
    /// The velocity at which an axis is held \[m/s\].
    pub driven: Vec<[Option<f64>; 3]>,
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
            external: zeros.clone(),
            borne: zeros.clone(),
            viscous: Vec::new(),
            dashpot: zeros,
            driven: vec![[None; 3]; count],
            quiet: vec![[false; 3]; count],
            slots,
            starts,
        }
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
