//! Convex bodies between planes, and their surfaces with rounded edges.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// A point at most this far outside a plane, in units of the body, counts as on the plane.
const ON: f64 = 1e-12;

/// Points x with `normal · x <= height`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit.
    pub normal: Vector3<f64>,
    pub height: f64,
}

impl Plane {
    /// The plane of the stretched body: x becomes `stretch` x. The argument is the inverse transpose of `stretch`,
    /// which transforms normals.
    pub fn stretched(&self, inverse_transposed: &Matrix3<f64>) -> Self {
        let normal = inverse_transposed * self.normal;
        let length = normal.norm();
        Self { normal: normal / length, height: self.height / length }
    }
}

/// A corner of a body, at which three planes meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    pub place: Vector3<f64>,
    /// In an order such that their normals turn to the left seen from outside.
    pub planes: [usize; 3],
}

/// Corners of the body between the planes: the common points of three planes that lie inside all other planes.
pub fn corners(planes: &[Plane]) -> Vec<Corner> {
    let mut found = Vec::new();
    for a in 0..planes.len() {
        for b in a + 1..planes.len() {
            for c in b + 1..planes.len() {
                found.extend(corner(planes, [a, b, c]));
            }
        }
    }
    found
}

fn corner(planes: &[Plane], [a, b, c]: [usize; 3]) -> Option<Corner> {
    let (p, q, r) = (&planes[a], &planes[b], &planes[c]);
    let (qr, rp, pq) = (q.normal.cross(&r.normal), r.normal.cross(&p.normal), p.normal.cross(&q.normal));
    let turn = p.normal.dot(&qr);
    if turn.abs() < ON {
        return None;
    }
    let place = (qr * p.height + rp * q.height + pq * r.height) / turn;
    let others = planes.iter().enumerate().filter(|(i, _)| ![a, b, c].contains(i));
    let inside = others.map(|(_, plane)| plane.normal.dot(&place) - plane.height).all(|out| out <= ON);
    inside.then_some(Corner { place, planes: if turn > 0.0 { [a, b, c] } else { [a, c, b] } })
}

/// Radius of the largest ball between the planes: it touches four planes. 0 if there is none.
pub fn inscribed_radius(planes: &[Plane]) -> f64 {
    let n = planes.len();
    let mut largest = 0.0f64;
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                for d in c + 1..n {
                    let [p, q, r, s] = [a, b, c, d].map(|k| planes[k]);
                    let row = |p: Plane| p.normal.push(1.0).transpose();
                    let heights = Vector4::new(p.height, q.height, r.height, s.height);
                    let Some(inverse) = Matrix4::from_rows(&[row(p), row(q), row(r), row(s)]).try_inverse() else {
                        continue;
                    };
                    let ball = inverse * heights;
                    let fits = |plane: &Plane| plane.normal.dot(&ball.xyz()) + ball.w <= plane.height + ON;
                    if ball.w > largest && planes.iter().all(fits) {
                        largest = ball.w;
                    }
                }
            }
        }
    }
    largest
}

/// The surface of all points within `radius` of the body: flat faces, parts of cylinders along its edges and of balls
/// at its corners, with `segments` segments per arc. Vertices and triangles, outward.
pub fn rounded(
    planes: &[Plane],
    corners: &[Corner],
    radius: f64,
    segments: usize,
) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let segments = if radius > 0.0 { segments } else { 0 };
    let patch = Patch { segments };
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for (number, corner) in corners.iter().enumerate() {
        let normals = corner.planes.map(|p| planes[p].normal);
        for [i, j, k] in patch.weights() {
            let direction = normals[0] * i as f64 + normals[1] * j as f64 + normals[2] * k as f64;
            let out = if segments > 0 { direction.normalize() * radius } else { Vector3::zeros() };
            vertices.push(corner.place + out);
        }
        triangles.extend(patch.triangles(number));
    }
    for (number, plane) in planes.iter().enumerate() {
        let face = face(plane, number, corners);
        let at = |corner: usize| patch.on(corners, corner, number, number, 0);
        triangles.extend((2..face.len()).map(|k| [at(face[0]), at(face[k - 1]), at(face[k])]));
        for k in 0..face.len() {
            let (from, to) = (face[k], face[(k + 1) % face.len()]);
            let shared = corners[from].planes.iter().find(|p| **p != number && corners[to].planes.contains(p));
            // every edge once, from the face with the lower number; its neighbour is on the right
            let Some(&other) = shared.filter(|other| **other > number) else { continue };
            for step in 0..segments {
                let [a, b] = [from, to].map(|corner| patch.on(corners, corner, number, other, step));
                let [c, d] = [from, to].map(|corner| patch.on(corners, corner, number, other, step + 1));
                triangles.extend([[a, c, b], [b, c, d]]);
            }
        }
    }
    (vertices, triangles)
}

/// Corners of a face, counterclockwise seen from outside.
fn face(plane: &Plane, number: usize, corners: &[Corner]) -> Vec<usize> {
    let mut found: Vec<usize> = (0..corners.len()).filter(|c| corners[*c].planes.contains(&number)).collect();
    let middle = found.iter().map(|c| corners[*c].place).sum::<Vector3<f64>>() / found.len().max(1) as f64;
    let across = plane.normal.cross(&Vector3::ith(plane.normal.iamin(), 1.0)).normalize();
    let up = plane.normal.cross(&across);
    let angle = |c: usize| (corners[c].place - middle).dot(&up).atan2((corners[c].place - middle).dot(&across));
    found.sort_by(|a, b| angle(*a).total_cmp(&angle(*b)));
    found
}

/// The part of a ball between three normals, as a triangle of triangles; its vertices are given by their weights.
#[derive(Clone, Copy)]
struct Patch {
    segments: usize,
}

impl Patch {
    fn weights(self) -> impl Iterator<Item = [usize; 3]> {
        let n = self.segments;
        (0..=n).flat_map(move |j| (0..=n - j).map(move |k| [n - j - k, j, k]))
    }

    fn size(self) -> usize {
        (self.segments + 1) * (self.segments + 2) / 2
    }

    /// The vertex with these weights of the second and the third normal.
    fn vertex(self, corner: usize, j: usize, k: usize) -> u32 {
        let before = j * (self.segments + 1) - (j * j - j) / 2;
        (corner * self.size() + before + k) as u32
    }

    fn triangles(self, corner: usize) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for [i, j, k] in self.weights() {
            let at = |j: usize, k: usize| self.vertex(corner, j, k);
            if i >= 1 {
                triangles.push([at(j, k), at(j + 1, k), at(j, k + 1)]);
            }
            if i >= 2 {
                triangles.push([at(j + 1, k + 1), at(j, k + 1), at(j + 1, k)]);
            }
        }
        triangles
    }

    /// The vertex `step` steps from one normal of the corner towards another normal.
    fn on(self, corners: &[Corner], corner: usize, from: usize, to: usize, step: usize) -> u32 {
        let weight = |plane: usize| {
            let own = |p: usize, weight: usize| if p == plane { weight } else { 0 };
            if from == to { own(from, self.segments) } else { own(from, self.segments - step) + own(to, step) }
        };
        let [_, second, third] = corners[corner].planes;
        self.vertex(corner, weight(second), weight(third))
    }
}
