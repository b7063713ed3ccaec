//! Facets, edges and corners of a surface: their neighbours, and the directions that decide which of them is touched.

use super::triangles::{area_vector, half_edges};
use nalgebra::Vector3;

/// Stands for the missing facet at the border of a sheet.
pub(super) const NONE: u32 = u32::MAX;

/// Largest angle between two facets, rad, that still form one flat face: the gap by this angle is below the slack of
/// `contact`.
const FLAT: f64 = 1e-13;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeshSurface {
    pub facets: Vec<Facet>,
    pub edges: Vec<Edge>,
    pub corners: Vec<MeshCorner>,
    /// Edges from the corners; edges from the same corner are contiguous.
    pub spokes: Vec<Spoke>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Facet {
    pub corners: [u32; 3],
    pub places: [Vector3<f64>; 3],
    /// Edge k runs from corner k to the next.
    pub edges: [u32; 3],
    pub normal: Vector3<f64>,
    /// Unit, in the plane of the facet, from edge k inward.
    pub inward: [Vector3<f64>; 3],
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Edge {
    pub ends: [Vector3<f64>; 2],
    /// Unit, from the first end to the second.
    pub direction: Vector3<f64>,
    /// The second is `NONE` at a border.
    pub facets: [u32; 2],
    /// Directions from the edge into the facets; zero if a facet is missing.
    pub inward: [Vector3<f64>; 2],
    /// Sum of the normals of the facets: a point on its side is in front (Baerentzen and Aanaes 2005, section 3).
    pub normal: Vector3<f64>,
    /// Inside a flat face.
    pub flat: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeshCorner {
    pub place: Vector3<f64>,
    /// Range in the spokes.
    pub spokes: [u32; 2],
    /// Sum of the normals of the facets, each weighted by its angle here (Baerentzen and Aanaes 2005, section 3).
    pub normal: Vector3<f64>,
    pub flat: bool,
    pub border: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spoke {
    pub edge: u32,
    /// Unit, away from the corner.
    pub direction: Vector3<f64>,
}

impl MeshSurface {
    pub fn new(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Self {
        let mut facets: Vec<_> = triangles.iter().map(|t| facet(vertices, *t)).collect();
        let mut edges = Vec::with_capacity(3 * triangles.len() / 2);
        let mut ends = Vec::with_capacity(edges.capacity());
        for sides in half_edges(triangles).chunk_by(|a, b| a.ends == b.ends) {
            for side in sides {
                facets[side.facet as usize].edges[side.slot] = edges.len() as u32;
            }
            let beside = |k: usize| sides.get(k).map(|side| (side.facet, &facets[side.facet as usize], side.slot));
            edges.push(edge(sides[0].ends.map(|v| vertices[v as usize]), [beside(0), beside(1)]));
            ends.push(sides[0].ends);
        }
        let (corners, spokes) = corners(vertices, &facets, &edges, &ends);
        Self { facets, edges, corners, spokes }
    }

    /// The number of an edge among the features: facets, then edges, then corners.
    pub fn edge_feature(&self, edge: u32) -> u32 {
        self.facets.len() as u32 + edge
    }

    pub fn corner_feature(&self, corner: u32) -> u32 {
        (self.facets.len() + self.edges.len()) as u32 + corner
    }
}

fn facet(vertices: &[Vector3<f64>], corners: [u32; 3]) -> Facet {
    let places = corners.map(|v| vertices[v as usize]);
    let normal = area_vector(vertices, &corners).normalize();
    let inward = [0, 1, 2].map(|k| normal.cross(&(places[(k + 1) % 3] - places[k])).normalize());
    Facet { corners, places, edges: [NONE; 3], normal, inward }
}

fn edge(ends: [Vector3<f64>; 2], beside: [Option<(u32, &Facet, usize)>; 2]) -> Edge {
    let inward = beside.map(|side| side.map_or(Vector3::zeros(), |(_, facet, slot)| facet.inward[slot]));
    Edge {
        ends,
        direction: (ends[1] - ends[0]).normalize(),
        facets: beside.map(|side| side.map_or(NONE, |(number, ..)| number)),
        inward,
        normal: beside.iter().flatten().map(|(_, facet, _)| facet.normal).sum(),
        flat: (inward[0] + inward[1]).norm() <= FLAT,
    }
}

fn corners(
    vertices: &[Vector3<f64>],
    facets: &[Facet],
    edges: &[Edge],
    ends: &[[u32; 2]],
) -> (Vec<MeshCorner>, Vec<Spoke>) {
    let mut leaving: Vec<_> = (0..edges.len()).flat_map(|e| [(ends[e][0], e, 1.0), (ends[e][1], e, -1.0)]).collect();
    leaving.sort_unstable_by_key(|(corner, e, _)| (*corner, *e));
    let corner = |(number, place): (usize, &Vector3<f64>)| {
        let start = leaving.partition_point(|(corner, ..)| (*corner as usize) < number);
        let end = leaving.partition_point(|(corner, ..)| (*corner as usize) <= number);
        let around = || leaving[start..end].iter().map(|(_, e, _)| &edges[*e]);
        MeshCorner {
            place: *place,
            spokes: [start as u32, end as u32],
            normal: Vector3::zeros(),
            flat: around().all(|e| e.flat),
            border: around().any(|e| e.facets[1] == NONE),
        }
    };
    let mut corners: Vec<_> = vertices.iter().enumerate().map(corner).collect();
    for facet in facets {
        for k in 0..3 {
            let arm = |to: usize| facet.places[(k + to) % 3] - facet.places[k];
            corners[facet.corners[k] as usize].normal += arm(1).angle(&arm(2)) * facet.normal;
        }
    }
    let spoke = |(_, e, sign): &(u32, usize, f64)| Spoke { edge: *e as u32, direction: edges[*e].direction * *sign };
    (corners, leaving.iter().map(spoke).collect())
}
