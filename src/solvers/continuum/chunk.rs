//! A few hundred elements that one thread computes together.
//!
//! A chunk holds the nodes of its elements and sums their forces there, so that threads share no data while they work.
//! Chunks are cut by the number of elements alone and their forces are added in order: any number of threads gives the
//! same bits.

use super::flow::Memory;
use super::kernel;
use super::lanes::{LANES, Lanes};
use super::mesh::Mesh;
use super::shape::{Corners, Shape};
use pulp::NullaryFnOnce;

/// Elements of a chunk: their nodes fit into the first-level caches of a core.
pub const ELEMENTS: usize = 480;

/// Up to eight elements of one shape.
#[derive(Debug, Clone)]
struct Batch {
    shape: u32,
    count: usize,
    elements: [u32; LANES],
    /// Nodes of the chunk: corner, lane. Lanes without an element repeat the first.
    corners: [[u16; LANES]; 8],
    /// Memory of elements with a strength.
    memory: Option<Box<Memory>>,
}

#[derive(Debug, Clone)]
pub struct Chunk {
    /// Nodes of the elements, in the order in which elements name them.
    pub nodes: Vec<u32>,
    /// Forces of the elements on these nodes \[N\].
    pub force: Vec<[f64; 3]>,
    batches: Vec<Batch>,
    place: Vec<[f64; 3]>,
}

/// Energies stored and lost in the elements of a chunk \[J\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Held {
    pub strain: f64,
    pub plastic: f64,
}

impl Chunk {
    /// Cuts all elements of a mesh into chunks; `shapes` gives the shape of each element.
    pub fn cut(mesh: &Mesh, known: &[Shape], shapes: &[u32]) -> Vec<Chunk> {
        let mut local = vec![u16::MAX; mesh.nodes().len()];
        (0..shapes.len())
            .step_by(ELEMENTS)
            .map(|from| {
                let to = (from + ELEMENTS).min(shapes.len());
                let chunk = Chunk::new(mesh, from..to, (known, shapes), &mut local);
                chunk.nodes.iter().for_each(|&node| local[node as usize] = u16::MAX);
                chunk
            })
            .collect()
    }

    fn new(
        mesh: &Mesh,
        elements: std::ops::Range<usize>,
        (known, shapes): (&[Shape], &[u32]),
        local: &mut [u16],
    ) -> Chunk {
        let mut nodes: Vec<u32> = Vec::new();
        for element in elements.clone() {
            for node in mesh.elements()[element].nodes {
                if local[node as usize] == u16::MAX {
                    local[node as usize] = nodes.len() as u16;
                    nodes.push(node);
                }
            }
        }
        let mut sorted: Vec<usize> = elements.collect();
        sorted.sort_by_key(|&element| (shapes[element], element));
        let mut batches = Vec::new();
        for alike in sorted.chunk_by(|&a, &b| shapes[a] == shapes[b]) {
            for group in alike.chunks(LANES) {
                let lane = |l: usize| group[l.min(group.len()) % group.len()];
                let shape = &known[shapes[group[0]] as usize];
                let memory = shape.yields.as_ref().map(|_| Box::new(Memory::new(shape)));
                let mut batch = Batch {
                    memory,
                    shape: shapes[group[0]],
                    count: group.len(),
                    elements: [0; LANES],
                    corners: [[0; LANES]; 8],
                };
                for l in 0..LANES {
                    batch.elements[l] = lane(l) as u32;
                    for corner in 0..8 {
                        batch.corners[corner][l] = local[mesh.elements()[lane(l)].nodes[corner] as usize];
                    }
                }
                batches.push(batch);
            }
        }
        let zeros = vec![[0.0; 3]; nodes.len()];
        Chunk { force: zeros.clone(), place: zeros, nodes, batches }
    }

    /// Computes the forces of the elements.
    pub fn pull(&mut self, shapes: &[Shape], displacement: &[[f64; 3]], answer: Answer) -> Held {
        pulp::Arch::new().dispatch(Pull { chunk: self, shapes, displacement, answer })
    }

    /// Memories of the elements, batch by batch.
    pub fn memories(&self) -> impl Iterator<Item = &Memory> {
        self.batches.iter().filter_map(|batch| batch.memory.as_deref())
    }

    pub fn memories_mut(&mut self) -> impl Iterator<Item = &mut Memory> {
        self.batches.iter_mut().filter_map(|batch| batch.memory.as_deref_mut())
    }

    /// Memory and lane of an element that can yield.
    pub fn memory(&self, element: usize) -> Option<(&Memory, usize)> {
        let lane = |batch: &Batch| batch.elements[..batch.count].iter().position(|&e| e as usize == element);
        self.batches.iter().find_map(|batch| Some((batch.memory.as_deref()?, lane(batch)?)))
    }
}

/// The response of elements to displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// Elastic, independent of strength and history.
    Linear,
    /// With strength; the memory does not change.
    Tried,
    /// With strength; the memory is updated.
    Remembered,
}

/// Work for the widest instructions of the machine. A closure would not do: the compiler might compile its body without
/// them.
struct Pull<'a> {
    chunk: &'a mut Chunk,
    shapes: &'a [Shape],
    displacement: &'a [[f64; 3]],
    answer: Answer,
}

impl NullaryFnOnce for Pull<'_> {
    type Output = Held;

    #[inline(always)]
    fn call(self) -> Held {
        let Chunk { nodes, force, batches, place } = self.chunk;
        for (place, &node) in place.iter_mut().zip(nodes.iter()) {
            *place = self.displacement[node as usize];
        }
        force.fill([0.0; 3]);
        let mut held = Held::default();
        for batch in batches {
            let u = gather(batch, place);
            let mut f: Corners = [[Lanes::ZERO; 8]; 3];
            let shape = &self.shapes[batch.shape as usize];
            match (&shape.yields, &mut batch.memory) {
                (Some(yields), Some(memory)) if self.answer != Answer::Linear => {
                    let work = if self.answer == Answer::Remembered {
                        memory.pull(shape, yields, &u, &mut f)
                    } else {
                        memory.clone().pull(shape, yields, &u, &mut f)
                    };
                    for l in 0..batch.count {
                        held.strain += work.strain.0[l];
                        held.plastic += work.lost.0[l];
                    }
                }
                _ => {
                    let energy = kernel::elastic(shape, &u, &mut f);
                    for l in 0..batch.count {
                        held.strain += energy.0[l];
                    }
                }
            }
            scatter(batch, &f, force);
        }
        held
    }
}

#[inline(always)]
fn gather(batch: &Batch, place: &[[f64; 3]]) -> Corners {
    let mut u = [[Lanes::ZERO; 8]; 3];
    for corner in 0..8 {
        for l in 0..LANES {
            let [x, y, z] = place[batch.corners[corner][l] as usize];
            u[0][corner].0[l] = x;
            u[1][corner].0[l] = y;
            u[2][corner].0[l] = z;
        }
    }
    u
}

#[inline(always)]
fn scatter(batch: &Batch, f: &Corners, force: &mut [[f64; 3]]) {
    for corner in 0..8 {
        for l in 0..batch.count {
            let sum = &mut force[batch.corners[corner][l] as usize];
            sum[0] += f[0][corner].0[l];
            sum[1] += f[1][corner].0[l];
            sum[2] += f[2][corner].0[l];
        }
    }
}
