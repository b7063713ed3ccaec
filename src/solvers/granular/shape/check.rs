//! Faults of a mesh: all at once, each with its number, the first few places and a remedy.

use super::triangles::{MeshKind, area_vector, half_edges, volume, winding};
use nalgebra::Vector3;
use std::fmt;

/// Number of places of a fault that are named.
const NAMED: usize = 3;

/// A facet lower than this share of its longest edge has no reliable direction.
const THINNEST: f64 = 1e-9;

/// Facets, edges and corners are numbered together in 32 bits; a mesh of n facets has fewer than 3 n edges and fewer
/// than 3 n corners.
const MOST_FACETS: usize = 600_000_000;

/// Why triangles do not form a valid mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshError {
    pub faults: Vec<MeshFault>,
}

/// All faults of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFault {
    pub kind: FaultKind,
    pub count: usize,
    /// The first few places.
    pub places: Vec<Place>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// No triangle at all.
    Empty,
    /// More facets than can be numbered.
    TooMany,
    /// A vertex that is not a number.
    NonFinite,
    /// A triangle with a vertex that does not exist.
    OutOfRange,
    /// A triangle without area.
    Degenerate,
    /// An edge of a closed mesh with a facet on one side only.
    OpenEdge,
    /// An edge between more than two facets.
    NonManifoldEdge,
    /// An edge between two facets that face opposite ways.
    Winding,
    /// A closed part whose normals point the wrong way.
    InsideOut,
    /// A closed part without volume.
    Flat,
}

/// The place of a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Number of the triangle, or number of the vertex that is not a number, in the input.
    pub number: u32,
    /// m.
    pub at: Vector3<f64>,
}

/// Faults of the input triangles; `places` gives, for each vertex, the first vertex at the same place.
pub(super) fn check(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    places: &[u32],
    kind: MeshKind,
) -> Result<(), MeshError> {
    if triangles.is_empty() {
        return Err(MeshError::single(FaultKind::Empty));
    }
    if triangles.len() > MOST_FACETS || vertices.len() > MOST_FACETS {
        return Err(MeshError::single(FaultKind::TooMany));
    }
    let mut found = Found::default();
    for (i, v) in vertices.iter().enumerate().filter(|(_, v)| !v.iter().all(|x| x.is_finite())) {
        found.add(FaultKind::NonFinite, i as u32, *v);
    }
    for (i, corners) in triangles.iter().enumerate() {
        if corners.iter().any(|v| *v as usize >= vertices.len()) {
            let known = corners.iter().find_map(|v| vertices.get(*v as usize));
            found.add(FaultKind::OutOfRange, i as u32, known.copied().unwrap_or_default());
        }
    }
    // if vertices are missing, further faults would only be consequences
    if found.faults.is_empty() {
        let welded: Vec<_> = triangles.iter().map(|t| t.map(|v| places[v as usize])).collect();
        thin_facets(vertices, &welded, &mut found);
        edges(vertices, &welded, kind, &mut found);
        if found.faults.is_empty() && matches!(kind, MeshKind::Solid | MeshKind::Container) {
            parts(vertices, &welded, kind, &mut found);
        }
    }
    if found.faults.is_empty() { Ok(()) } else { Err(MeshError { faults: found.faults }) }
}

#[derive(Default)]
struct Found {
    faults: Vec<MeshFault>,
}

impl Found {
    fn add(&mut self, kind: FaultKind, number: u32, at: Vector3<f64>) {
        let known = self.faults.iter().position(|fault| fault.kind == kind).unwrap_or_else(|| {
            self.faults.push(MeshFault { kind, count: 0, places: Vec::new() });
            self.faults.len() - 1
        });
        let fault = &mut self.faults[known];
        fault.count += 1;
        if fault.places.len() < NAMED {
            fault.places.push(Place { number, at });
        }
    }
}

fn thin_facets(vertices: &[Vector3<f64>], triangles: &[[u32; 3]], found: &mut Found) {
    for (i, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| vertices[v as usize]);
        let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        let twice = 2.0 * area_vector(vertices, corners).norm();
        // also false for an area out of the range of numbers
        if !(twice > THINNEST * longest && twice.is_finite()) {
            found.add(FaultKind::Degenerate, i as u32, (a + b + c) / 3.0);
        }
    }
}

fn edges(vertices: &[Vector3<f64>], triangles: &[[u32; 3]], kind: MeshKind, found: &mut Found) {
    let closed = matches!(kind, MeshKind::Solid | MeshKind::Container);
    // a triangle that collapsed by welding is not a side of anything
    let real = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    let mut sides = half_edges(triangles);
    sides.retain(|s| real(&triangles[s.facet as usize]));
    for sides in sides.chunk_by(|a, b| a.ends == b.ends) {
        let middle = (vertices[sides[0].ends[0] as usize] + vertices[sides[0].ends[1] as usize]) / 2.0;
        let fault = match sides {
            [_] if closed => FaultKind::OpenEdge,
            [_] => continue,
            [a, b] if a.forward == b.forward && kind != MeshKind::TwoSided => FaultKind::Winding,
            [_, _] => continue,
            _ => FaultKind::NonManifoldEdge,
        };
        found.add(fault, sides[0].facet, middle);
    }
}

/// A part of a closed mesh that is connected by edges.
struct Part {
    triangles: Vec<[u32; 3]>,
    facet: u32,
    low: Vector3<f64>,
    high: Vector3<f64>,
}

impl Part {
    fn lies_in(&self, other: &Part, vertices: &[Vector3<f64>]) -> bool {
        let boxed = (0..3).all(|k| other.low[k] <= self.low[k] && self.high[k] <= other.high[k]);
        let [a, b, c] = self.triangles[0].map(|v| vertices[v as usize]);
        boxed && winding(vertices, other.triangles.iter(), &((a + b + c) / 3.0)) != 0
    }
}

/// Every part must face the right way: the outermost part by the kind of the mesh, a part inside another part opposite
/// to it.
fn parts(vertices: &[Vector3<f64>], triangles: &[[u32; 3]], kind: MeshKind, found: &mut Found) {
    let parts = connected(vertices, triangles);
    for (i, part) in parts.iter().enumerate() {
        let at = vertices[part.triangles[0][0] as usize];
        let volume = volume(vertices, part.triangles.iter());
        let area: f64 = part.triangles.iter().map(|t| area_vector(vertices, t).norm()).sum();
        let around = parts.iter().enumerate().filter(|(j, other)| *j != i && part.lies_in(other, vertices)).count();
        let outward = (kind == MeshKind::Solid) == around.is_multiple_of(2);
        if volume.abs() <= 1e-12 * area.powf(1.5) {
            found.add(FaultKind::Flat, part.facet, at);
        } else if (volume > 0.0) != outward {
            found.add(FaultKind::InsideOut, part.facet, at);
        }
    }
}

fn connected(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Vec<Part> {
    let mut parent: Vec<u32> = (0..triangles.len() as u32).collect();
    fn root(parent: &mut [u32], mut facet: u32) -> u32 {
        while parent[facet as usize] != facet {
            parent[facet as usize] = parent[parent[facet as usize] as usize];
            facet = parent[facet as usize];
        }
        facet
    }
    for pair in half_edges(triangles).windows(2).filter(|pair| pair[0].ends == pair[1].ends) {
        let (a, b) = (root(&mut parent, pair[0].facet), root(&mut parent, pair[1].facet));
        // the facet with the lowest number represents its part
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut number = vec![usize::MAX; triangles.len()];
    let mut parts: Vec<Part> = Vec::new();
    for (i, corners) in triangles.iter().enumerate() {
        let first = root(&mut parent, i as u32) as usize;
        if number[first] == usize::MAX {
            number[first] = parts.len();
            let place = vertices[corners[0] as usize];
            parts.push(Part { triangles: Vec::new(), facet: i as u32, low: place, high: place });
        }
        let part = &mut parts[number[first]];
        part.triangles.push(*corners);
        for place in corners.map(|v| vertices[v as usize]) {
            part.low = part.low.inf(&place);
            part.high = part.high.sup(&place);
        }
    }
    parts
}

impl MeshError {
    pub(super) fn single(kind: FaultKind) -> Self {
        Self { faults: vec![MeshFault { kind, count: 1, places: Vec::new() }] }
    }
}

impl FaultKind {
    /// The words for one fault and for several faults, and the remedy.
    fn words(self) -> [&'static str; 3] {
        match self {
            FaultKind::Empty => ["mesh without triangles", "", "give at least one triangle"],
            FaultKind::TooMany => ["mesh with too many triangles", "", "make it coarser or cut it into several walls"],
            FaultKind::NonFinite => {
                ["vertex that is not a number", "vertices that are not numbers", "correct the file"]
            }
            FaultKind::OutOfRange => [
                "triangle with a vertex that does not exist",
                "triangles with vertices that do not exist",
                "count vertices from 0 to the number of vertices less 1",
            ],
            FaultKind::Degenerate => [
                "triangle without area",
                "triangles without area",
                "remove it and merge its vertices, or mesh the surface again",
            ],
            FaultKind::OpenEdge => [
                "open edge",
                "open edges",
                "close the hole, give coincident vertices the same coordinates, or make it a sheet",
            ],
            FaultKind::NonManifoldEdge => [
                "edge shared by more than two triangles",
                "edges shared by more than two triangles",
                "remove duplicate triangles, or cut the mesh into several walls there",
            ],
            FaultKind::Winding => [
                "edge between triangles that face opposite ways",
                "edges between triangles that face opposite ways",
                "swap two vertices of the triangles on one side",
            ],
            FaultKind::InsideOut => [
                "closed part that faces the wrong way",
                "closed parts that face the wrong way",
                "swap two vertices of all its triangles; a body faces outward, a container and a hole in a body inward",
            ],
            FaultKind::Flat => {
                ["closed part without volume", "closed parts without volume", "make it a two-sided sheet"]
            }
        }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.faults.iter().enumerate() {
            let [one, several, way_out] = fault.kind.words();
            let what = if fault.count == 1 { one } else { several };
            write!(f, "{}{} {what}", if i > 0 { "; " } else { "" }, fault.count)?;
            let part = if fault.kind == FaultKind::NonFinite { "vertex" } else { "triangle" };
            for (k, place) in fault.places.iter().enumerate() {
                let sign = if k > 0 { ", " } else { " (" };
                write!(
                    f,
                    "{sign}{part} {} at ({:.6}, {:.6}, {:.6}) m",
                    place.number, place.at.x, place.at.y, place.at.z
                )?;
            }
            let more = fault.count > fault.places.len() && !fault.places.is_empty();
            write!(
                f,
                "{}{}: {way_out}",
                if more { ", ..." } else { "" },
                if fault.places.is_empty() { "" } else { ")" }
            )?;
        }
        Ok(())
    }
}

impl std::error::Error for MeshError {}
