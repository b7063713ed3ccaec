//! Shapes against each other, against closed forms and against slow but simple searches.

mod closed;
mod faults;
mod floors;
mod history;
mod valleys;

use super::*;
use nalgebra::UnitQuaternion;

/// Numbers in [0, 1) that are the same in every run (SplitMix64).
pub(super) struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A point in a cube around the origin.
    fn point(&mut self, half: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-half, half))
    }
}

/// Contacts as found by the neighbour search and the contact test together.
fn touches(shape: &Shape, centre: &Vector3<f64>, reach: f64) -> Vec<Touch> {
    let (mut facets, mut out) = (Vec::new(), Vec::new());
    shape.near(centre, reach, &mut facets);
    shape.touches(centre, reach, &facets, &mut out);
    out
}

/// The larger of the differences in distance and in normal.
fn difference(a: &Touch, b: &Touch) -> f64 {
    (a.distance - b.distance).abs().max((a.normal - b.normal).norm())
}

fn turned(mesh: &Mesh, turn: &UnitQuaternion<f64>) -> Mesh {
    Mesh::new(mesh.vertices().iter().map(|v| turn * v).collect(), mesh.triangles().to_vec(), mesh.kind()).unwrap()
}

/// The nearest point of a triangle by the regions of its corners, edges and face (Ericson 2005, section 5.1.5).
fn nearest_point(p: &Vector3<f64>, [a, b, c]: [Vector3<f64>; 3]) -> Vector3<f64> {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(&(p - a)), ac.dot(&(p - a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(&(p - b)), ac.dot(&(p - b)));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let (d5, d6) = (ab.dot(&(p - c)), ac.dot(&(p - c)));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6));
    }
    a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc))
}

/// Distance from a point to the surface by checking every facet.
fn distance(mesh: &Mesh, p: &Vector3<f64>) -> f64 {
    let to = |t: &[u32; 3]| (p - nearest_point(p, t.map(|v| mesh.vertices()[v as usize]))).norm();
    mesh.triangles().iter().map(to).fold(f64::INFINITY, f64::min)
}

/// A sphere with a wavy radius: hills and valleys of all curvatures.
fn bumpy() -> Mesh {
    let ball = Mesh::sphere(1.0, 3).unwrap();
    let wave = |v: &Vector3<f64>| v * (1.0 + 0.25 * (5.0 * v.x).sin() * (4.0 * v.y + 1.0).cos() * (6.0 * v.z).cos());
    Mesh::new(ball.vertices().iter().map(wave).collect(), ball.triangles().to_vec(), MeshKind::Solid).unwrap()
}
