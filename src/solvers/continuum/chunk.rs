//! A few hundred elements that one thread computes together.
//!
//! A chunk holds the nodes of its elements and sums their forces there, so that threads share no data while they work.
//! Chunks are cut by the number of elements alone and their forces are added in order: any number of threads gives the
//! same bits.

use super::flow::Memory;
use super::kernel;
use super::lanes::{LANES, Lanes, Vector};
use super::mesh::Mesh;
use super::shape::Shape;
use super::tensor::Corners;
use pulp::{Simd, WithSimd};

/// Elements of a chunk: their nodes fit into the first-level caches of a core.
pub const ELEMENTS: usize = 480;

/// Corners of an element, so that both ends of an edge along x follow each other.
const ALONG: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// Up to eight elements of one shape.
#[derive(Debug, Clone)]
struct Batch {
    shape: u32,
    count: usize,
    elements: [u32; LANES],
    ends: Ends,
    /// Memory of elements with a strength.
    memory: Option<Box<Memory>>,
}

/// Nodes of the chunk at the corners of the elements of a batch.
#[derive(Debug, Clone)]
enum Ends {
    /// Elements side by side: the eight nodes of a corner follow its first node.
    Row([u16; 8]),
    /// Any elements: corner, lane. Lanes without an element repeat the first.
    Each(Box<[[u16; LANES]; 8]>),
}

/// Values at the nodes of a chunk, axis by axis.
pub type Values = [Vec<f64>; 3];

#[derive(Debug, Clone)]
pub struct Chunk {
    /// Nodes of the elements; those of elements side by side follow each other.
    pub nodes: Vec<u32>,
    /// Forces of the elements on these nodes \[N\].
    force: Values,
    batches: Vec<Batch>,
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
        let mut sorted: Vec<usize> = elements.collect();
        sorted.sort_by_key(|&element| (shapes[element], element));
        let alike = sorted.chunk_by(|&a, &b| shapes[a] == shapes[b]);
        let groups: Vec<&[usize]> = alike.flat_map(|alike| alike.chunks(LANES)).collect();
        let mut nodes: Vec<u32> = Vec::new();
        for (group, corner) in groups.iter().flat_map(|group| ALONG.map(|corner| (group, corner))) {
            for node in group.iter().map(|&element| mesh.elements()[element].nodes[corner]) {
                if local[node as usize] == u16::MAX {
                    local[node as usize] = nodes.len() as u16;
                    nodes.push(node);
                }
            }
        }
        let batch = |group: &&[usize]| {
            let shape = shapes[group[0]];
            let lanes: [usize; LANES] = std::array::from_fn(|l| group[l.min(group.len()) % group.len()]);
            let corner = |corner: usize| lanes.map(|element| local[mesh.elements()[element].nodes[corner] as usize]);
            let memory = known[shape as usize].yields.as_ref().map(|_| Box::new(Memory::new(&known[shape as usize])));
            let ends = Ends::new(std::array::from_fn(corner));
            Batch { shape, count: group.len(), elements: lanes.map(|element| element as u32), ends, memory }
        };
        let batches = groups.iter().map(batch).collect();
        let zeros = [0; 3].map(|_| vec![0.0; nodes.len()]);
        Chunk { force: zeros, nodes, batches }
    }

    /// The force of the elements on a node of the chunk \[N\].
    #[inline(always)]
    pub fn force(&self, node: usize) -> [f64; 3] {
        [self.force[0][node], self.force[1][node], self.force[2][node]]
    }

    /// Computes the forces of the elements. `place` is memory to work with, the same for one chunk after another: it
    /// stays in the caches.
    pub fn pull(&mut self, place: &mut Values, shapes: &[Shape], displacement: &[[f64; 3]], answer: Answer) -> Held {
        pulp::Arch::new().dispatch(Pull { chunk: self, place, shapes, displacement, answer })
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
    place: &'a mut Values,
    shapes: &'a [Shape],
    displacement: &'a [[f64; 3]],
    answer: Answer,
}

impl WithSimd for Pull<'_> {
    type Output = Held;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Held {
        let Chunk { nodes, force, batches } = self.chunk;
        let place = self.place;
        place.iter_mut().for_each(|place| place.resize(nodes.len(), 0.0));
        let [x, y, z] = &mut *place;
        for (((x, y), z), &node) in x.iter_mut().zip(y).zip(z).zip(nodes.iter()) {
            [*x, *y, *z] = self.displacement[node as usize];
        }
        force.iter_mut().for_each(|force| force.fill(0.0));
        let (mut held, mut elastic) = (Held::default(), [0.0; LANES]);
        for batch in batches {
            let shape = &self.shapes[batch.shape as usize];
            let is_elastic = shape.yields.is_none() || self.answer == Answer::Linear;
            if let (Ends::Row(first), Some(edges), true, None) =
                (&batch.ends, &shape.edges, is_elastic, &shape.tetrahedra)
            {
                pull_row(simd, (shape, edges), first, place, force, &mut elastic);
                continue;
            }
            let u = gather(batch, place);
            let mut f: Corners = [[Lanes::ZERO; 8]; 3];
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
        held.strain += elastic.iter().sum::<f64>();
        held
    }
}

/// Adds the forces of elastic bricks side by side, and their strain energy \[J\].
#[inline(always)]
fn pull_row<S: Simd>(
    simd: S,
    (shape, edges): (&Shape, &[f64; 3]),
    first: &[u16; 8],
    place: &Values,
    force: &mut Values,
    energy: &mut [f64; LANES],
) {
    for from in (0..LANES).step_by(S::F64_LANES) {
        let u = [
            load(simd, from, first, &place[0]),
            load(simd, from, first, &place[1]),
            load(simd, from, first, &place[2]),
        ];
        let (f, stored) = kernel::elastic_bricks(shape, edges, &u);
        stored.add_to(&mut energy[from..][..S::F64_LANES]);
        // corners of one end of the elements first: nodes of the two ends overlap, and a load has to wait for a store
        // just before it
        for corner in [0, 3, 4, 7, 1, 2, 5, 6] {
            for axis in 0..3 {
                f[axis][corner].add_to(&mut force[axis][first[corner] as usize + from..][..S::F64_LANES]);
            }
        }
    }
}

/// Values at the corners of elements side by side, from one of them on. No closure: see [`Pull`].
#[inline(always)]
fn load<S: Simd>(simd: S, from: usize, first: &[u16; 8], values: &[f64]) -> [Vector<S>; 8] {
    [
        load_one(simd, from, first[0], values),
        load_one(simd, from, first[1], values),
        load_one(simd, from, first[2], values),
        load_one(simd, from, first[3], values),
        load_one(simd, from, first[4], values),
        load_one(simd, from, first[5], values),
        load_one(simd, from, first[6], values),
        load_one(simd, from, first[7], values),
    ]
}

#[inline(always)]
fn load_one<S: Simd>(simd: S, from: usize, first: u16, values: &[f64]) -> Vector<S> {
    Vector::load(simd, &values[first as usize + from..][..S::F64_LANES])
}

impl Ends {
    fn new(corners: [[u16; LANES]; 8]) -> Ends {
        let row = |nodes: &[u16; LANES]| nodes.windows(2).all(|pair| pair[1] == pair[0] + 1);
        if corners.iter().all(row) { Ends::Row(corners.map(|nodes| nodes[0])) } else { Ends::Each(Box::new(corners)) }
    }
}

#[inline(always)]
fn gather(batch: &Batch, place: &Values) -> Corners {
    let mut u = [[Lanes::ZERO; 8]; 3];
    for axis in 0..3 {
        let place = place[axis].as_slice();
        match &batch.ends {
            Ends::Row(first) => {
                for corner in 0..8 {
                    u[axis][corner].0.copy_from_slice(&place[first[corner] as usize..][..LANES]);
                }
            }
            Ends::Each(nodes) => {
                for corner in 0..8 {
                    for l in 0..LANES {
                        u[axis][corner].0[l] = place[nodes[corner][l] as usize];
                    }
                }
            }
        }
    }
    u
}

/// Adds the forces of a batch. Corners of one end of the elements come first: nodes of the two ends of a row overlap,
/// and a load has to wait for a store just before it.
#[inline(always)]
fn scatter(batch: &Batch, f: &Corners, force: &mut Values) {
    match &batch.ends {
        Ends::Row(first) => {
            for corner in [0, 3, 4, 7, 1, 2, 5, 6] {
                for axis in 0..3 {
                    let sums = &mut force[axis][first[corner] as usize..][..LANES];
                    for (sum, force) in sums.iter_mut().zip(&f[axis][corner].0) {
                        *sum += force;
                    }
                }
            }
        }
        Ends::Each(nodes) => {
            for corner in 0..8 {
                for l in 0..batch.count {
                    for axis in 0..3 {
                        force[axis][nodes[corner][l] as usize] += f[axis][corner].0[l];
                    }
                }
            }
        }
    }
}
