//! Surfaces from the bytes of an STL file, binary or text, and back.
//!
//! STL has neither units nor shared corners: corners closer than a millionth of the largest extent become one corner.
//! Normals in the file are not read; the order of the corners defines the outside.

use super::super::shape::{Mesh, MeshError, MeshKind};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

/// Corners at most this far apart, as a share of the largest extent, become one.
const SAME: f64 = 1e-6;
/// Bytes before the facets of a binary file, and bytes of a facet.
const HEAD: usize = 84;
const FACET: usize = 50;

/// Why bytes do not describe the surface of a grain.
#[derive(Debug, Clone, PartialEq)]
pub enum StlError {
    /// The file neither begins with `solid` nor has the length of a binary file with its number of facets.
    NotStl,
    /// A binary file with fewer facets than its header gives.
    Cut { facets: usize, found: usize },
    /// A text with an unexpected word.
    Text { expected: &'static str, found: String, bytes: Range<usize> },
    /// Facets that do not form a closed body.
    Mesh(MeshError),
    /// Several separate bodies; a grain must be one body.
    Bodies { count: usize },
}

/// The closed body that an STL file describes, in the unit of the file.
pub fn read(bytes: &[u8]) -> Result<Mesh, StlError> {
    let corners = match binary(bytes) {
        Some(corners) => corners,
        None => text(bytes)?,
    };
    let (vertices, triangles) = welded(&corners);
    let mesh = Mesh::new(vertices, triangles, MeshKind::Solid).map_err(StlError::Mesh)?;
    match bodies(&mesh) {
        1 => Ok(mesh),
        count => Err(StlError::Bodies { count }),
    }
}

/// The surface as a binary STL file.
pub fn write(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![0; HEAD - 4];
    bytes.extend((mesh.triangles().len() as u32).to_le_bytes());
    for (number, corners) in mesh.triangles().iter().enumerate() {
        let places = corners.map(|v| mesh.vertices()[v as usize]);
        for place in [mesh.normal(number as u32)].iter().chain(&places) {
            bytes.extend(place.iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// Corners of a file whose length matches its number of facets.
fn binary(bytes: &[u8]) -> Option<Vec<[Vector3<f64>; 3]>> {
    let facets = facets(bytes)?;
    if bytes.len() != HEAD + FACET * facets {
        return None;
    }
    let number = |at: &[u8]| f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]]));
    let corner = |facet: &[u8], k: usize| Vector3::from_fn(|axis, _| number(&facet[12 + 12 * k + 4 * axis..]));
    Some(bytes[HEAD..].chunks_exact(FACET).map(|facet| [0, 1, 2].map(|k| corner(facet, k))).collect())
}

/// Number of facets in the header of a binary file.
fn facets(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    Some(u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize)
}

/// Corners of a text of `facet normal x y z outer loop vertex x y z vertex ... endloop endfacet`.
fn text(bytes: &[u8]) -> Result<Vec<[Vector3<f64>; 3]>, StlError> {
    let begins = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let text = std::str::from_utf8(bytes).ok().filter(|text| begins && !text.contains('\0'));
    let Some(text) = text else {
        let found = bytes.len().saturating_sub(HEAD) / FACET;
        let cut = facets(bytes).filter(|facets| (found..found.saturating_mul(1000).max(1000)).contains(facets));
        return Err(cut.map_or(StlError::NotStl, |facets| StlError::Cut { facets, found }));
    };
    let mut words = Words { text, at: 0 };
    let mut corners = Vec::new();
    while words.peek().is_some() {
        words.keyword("solid")?;
        words.rest_of_line();
        while words.is_next("facet") {
            words.keyword("facet")?;
            words.keyword("normal")?;
            words.place()?;
            words.keyword("outer")?;
            words.keyword("loop")?;
            let mut places = [Vector3::zeros(); 3];
            for place in &mut places {
                words.keyword("vertex")?;
                *place = words.place()?;
            }
            words.keyword("endloop")?;
            words.keyword("endfacet")?;
            corners.push(places);
        }
        words.keyword("endsolid")?;
        words.rest_of_line();
    }
    Ok(corners)
}

/// Words of a text, one after the other.
struct Words<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Words<'a> {
    fn peek(&self) -> Option<(usize, &'a str)> {
        let rest = &self.text[self.at..];
        let word = rest.split_ascii_whitespace().next()?;
        Some((self.at + (rest.len() - rest.trim_ascii_start().len()), word))
    }

    fn is_next(&self, keyword: &str) -> bool {
        self.peek().is_some_and(|(_, word)| word.eq_ignore_ascii_case(keyword))
    }

    fn next<T>(&mut self, expected: &'static str, read: impl Fn(&str) -> Option<T>) -> Result<T, StlError> {
        let (start, word) = self.peek().unwrap_or((self.text.trim_ascii_end().len(), ""));
        let bytes = start..start + word.len();
        self.at = bytes.end;
        read(word).ok_or_else(|| StlError::Text { expected, found: word.to_string(), bytes })
    }

    fn keyword(&mut self, keyword: &'static str) -> Result<(), StlError> {
        self.next(keyword, |word| word.eq_ignore_ascii_case(keyword).then_some(()))
    }

    fn place(&mut self) -> Result<Vector3<f64>, StlError> {
        let mut place = Vector3::zeros();
        for axis in 0..3 {
            place[axis] = self.next("a number", |word| word.parse::<f64>().ok().filter(|x| x.is_finite()))?;
        }
        Ok(place)
    }

    /// The rest of the line is a name.
    fn rest_of_line(&mut self) {
        self.at = self.text[self.at..].find('\n').map_or(self.text.len(), |end| self.at + end);
    }
}

/// Corners at the same place get one number; triangles that collapse by this are left out.
fn welded(corners: &[[Vector3<f64>; 3]]) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let all = || corners.iter().flatten();
    let low = all().fold(Vector3::repeat(f64::INFINITY), |low, v| low.inf(v));
    let high = all().fold(Vector3::repeat(f64::NEG_INFINITY), |high, v| high.sup(v));
    let near = SAME * (high - low).amax();
    let mut vertices: Vec<Vector3<f64>> = Vec::new();
    let (mut known, mut cells) = (HashMap::new(), HashMap::<[i64; 3], Vec<u32>>::new());
    let mut number = |place: &Vector3<f64>| {
        *known.entry([place.x, place.y, place.z].map(f64::to_bits)).or_insert_with(|| {
            let cell = ((place - low) / near.max(f64::MIN_POSITIVE)).map(|x| x as i64);
            let around =
                (0..27).map(|k| [0, 1, 2].map(|axis| cell[axis].saturating_add(k / 3_i64.pow(axis as u32) % 3 - 1)));
            let same = around
                .filter_map(|cell| cells.get(&cell))
                .flatten()
                .find(|v| (vertices[**v as usize] - place).norm() <= near);
            same.copied().unwrap_or_else(|| {
                vertices.push(*place);
                let number = vertices.len() as u32 - 1;
                cells.entry(cell.into()).or_default().push(number);
                number
            })
        })
    };
    let mut triangles: Vec<[u32; 3]> = corners.iter().map(|places| [0, 1, 2].map(|k| number(&places[k]))).collect();
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    (vertices, triangles)
}

/// Parts of a mesh that share no corner.
fn bodies(mesh: &Mesh) -> usize {
    let mut parent: Vec<u32> = (0..mesh.vertices().len() as u32).collect();
    fn root(parent: &mut [u32], mut vertex: u32) -> u32 {
        while parent[vertex as usize] != vertex {
            parent[vertex as usize] = parent[parent[vertex as usize] as usize];
            vertex = parent[vertex as usize];
        }
        vertex
    }
    let mut count = parent.len();
    for &[a, b, c] in mesh.triangles() {
        for other in [b, c] {
            let (one, two) = (root(&mut parent, a), root(&mut parent, other));
            if one != two {
                parent[one.max(two) as usize] = one.min(two);
                count -= 1;
            }
        }
    }
    count
}

impl fmt::Display for StlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StlError::NotStl => {
                write!(f, "it is not an STL file: it is neither text that begins with `solid` nor binary")
            }
            StlError::Cut { facets, found } => {
                write!(f, "it is cut off: the header gives {facets} triangles, the file holds {found}")
            }
            StlError::Text { expected, found, .. } if found.is_empty() => {
                write!(f, "expected `{expected}`, found the end of the file")
            }
            StlError::Text { expected, found, .. } => write!(f, "expected `{expected}`, found `{found}`"),
            StlError::Mesh(error) => error.fmt(f),
            StlError::Bodies { count } => {
                write!(f, "it holds {count} separate bodies; a grain must be one body")
            }
        }
    }
}

impl std::error::Error for StlError {}
