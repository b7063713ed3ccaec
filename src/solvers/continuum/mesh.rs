//! The soil divided into hexahedra with eight nodes, each with its material.

use super::error::SoilError;
use super::lanes::LANES;
use super::material::Material;
use super::surface::Surface;

/// A hexahedron: the lower four nodes counterclockwise seen from above, then the upper four in the same order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Element {
    pub nodes: [u32; 8],
    /// Index in the list of materials.
    pub material: u32,
}

/// Position of the corners of an element along each axis, in the order of its nodes: -1 or 1.
pub(super) const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Corners of the six faces, counterclockwise seen from outside: against and along x, y, z.
pub(super) const FACES: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

/// Nodes \[m\], elements and materials; z points up.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    nodes: Vec<[f64; 3]>,
    elements: Vec<Element>,
    materials: Vec<Material>,
    surface: Option<Surface>,
}

impl Mesh {
    /// A mesh of any hexahedra. Such a mesh has no [`surface`](Mesh::surface).
    ///
    /// # Errors
    /// Elements that name a node or a material that does not exist, or have no volume; loose nodes; invalid materials.
    pub fn new(nodes: Vec<[f64; 3]>, elements: Vec<Element>, materials: Vec<Material>) -> Result<Mesh, SoilError> {
        if elements.is_empty() {
            return Err(SoilError::Empty);
        }
        for (number, material) in materials.iter().enumerate() {
            material.check(number)?;
        }
        for place in &nodes {
            place.iter().try_for_each(|&x| super::error::number("a coordinate of a node", x))?;
        }
        let mut used = vec![false; nodes.len()];
        for (element, Element { nodes: corners, material }) in elements.iter().enumerate() {
            if *material as usize >= materials.len() {
                return Err(SoilError::Missing { element, what: "material", number: *material as usize });
            }
            for &node in corners {
                let seen = used.get_mut(node as usize);
                *seen.ok_or(SoilError::Missing { element, what: "node", number: node as usize })? = true;
            }
        }
        if let Some(node) = used.iter().position(|used| !used) {
            return Err(SoilError::Loose { node });
        }
        Ok(Mesh { nodes, elements, materials, surface: None })
    }

    /// A box between grid lines \[m\], equally spaced or not. `material_of(i, j, k)` gives the material of the element
    /// between lines i and i + 1 along x, j along y and k along z; `None` leaves the place empty. Elements and nodes
    /// are numbered in slabs of [`LANES`] elements along x, and in a slab along x first, then z, then y: elements that
    /// are computed together lie side by side, and so do their nodes.
    ///
    /// # Errors
    /// Lines that do not increase, no element, invalid materials.
    pub fn grid(
        lines: [&[f64]; 3],
        materials: Vec<Material>,
        material_of: impl Fn(usize, usize, usize) -> Option<usize>,
    ) -> Result<Mesh, SoilError> {
        for (axis, lines) in lines.iter().enumerate() {
            // a line that is not a number does not increase
            if let Some(at) =
                (1..lines.len()).find(|&i| lines[i].is_nan() || lines[i] <= lines[i - 1] || lines[0].is_nan())
            {
                return Err(SoilError::Lines { axis, at });
            }
            if lines.len() < 2 {
                return Err(SoilError::Empty);
            }
        }
        let count = lines.map(<[f64]>::len);
        let grid_node = |i: usize, j: usize, k: usize| (i * count[1] + j) * count[2] + k;
        let mut found = Vec::new();
        for i in 0..count[0] - 1 {
            for j in 0..count[1] - 1 {
                for k in 0..count[2] - 1 {
                    found.extend(material_of(i, j, k).map(|material| ([i, j, k], material)));
                }
            }
        }
        found.sort_by_key(|&([i, j, k], _)| (i / LANES, j, k, i));
        let corners = |[i, j, k]: [usize; 3]| {
            CORNERS.map(|c| {
                grid_node(i + usize::from(c[0] > 0.0), j + usize::from(c[1] > 0.0), k + usize::from(c[2] > 0.0))
            })
        };
        let mut number = vec![u32::MAX; count[0] * count[1] * count[2]];
        for (cell, _) in &found {
            corners(*cell).iter().for_each(|&node| number[node] = 0);
        }
        let place = |at: usize| [at / (count[1] * count[2]), at / count[2] % count[1], at % count[2]];
        let mut used: Vec<usize> = (0..number.len()).filter(|&at| number[at] == 0).collect();
        // the first plane of nodes of a slab belongs to the slab before
        used.sort_by_key(|&at| (place(at)[0].div_ceil(LANES), place(at)[1], place(at)[2], place(at)[0]));
        used.iter().enumerate().for_each(|(node, &at)| number[at] = node as u32);
        let nodes = used.iter().map(|&at| [0, 1, 2].map(|axis| lines[axis][place(at)[axis]])).collect();
        let element = |&(cell, material): &([usize; 3], usize)| Element {
            nodes: corners(cell).map(|n| number[n]),
            material: material as u32,
        };
        let elements: Vec<Element> = found.iter().map(element).collect();
        let mut tops = vec![None; (count[0] - 1) * (count[1] - 1)];
        for (([i, j, _], _), element) in found.iter().zip(&elements) {
            // elements of a column are in the order from below
            tops[i * (count[1] - 1) + j] = Some(FACES[5].map(|corner| element.nodes[corner]));
        }
        let surface = Surface::new([lines[0].to_vec(), lines[1].to_vec()], tops);
        Ok(Mesh { surface: Some(surface), ..Mesh::new(nodes, elements, materials)? })
    }

    /// Positions of the nodes of the undeformed soil \[m\].
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The top of a grid; `None` for other meshes.
    pub fn surface(&self) -> Option<&Surface> {
        self.surface.as_ref()
    }

    /// Positions of the corners of an element \[m\].
    pub(super) fn corners(&self, element: usize) -> [[f64; 3]; 8] {
        self.elements[element].nodes.map(|node| self.nodes[node as usize])
    }

    /// The node nearest to a place.
    pub fn nearest(&self, place: [f64; 3]) -> usize {
        let far = |node: &[f64; 3]| (0..3).map(|i| (node[i] - place[i]).powi(2)).sum::<f64>();
        let nodes = self.nodes.iter().enumerate();
        nodes.min_by(|a, b| far(a.1).total_cmp(&far(b.1))).map_or(0, |(node, _)| node)
    }
}
