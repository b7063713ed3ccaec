//! Deformation and forces of bricks, whose edges lie along the axes: most elements of a grid are.
//!
//! The corners of a brick take part in its mean gradient and in its hourglass patterns with plus or minus one, so sums
//! and differences over its edges give all of them at once: a quarter of the operations of any other element.

use super::lanes::Number;
use super::mesh::CORNERS;
use super::tensor::{COMPONENT, Corners, Patterns, Tensor, symmetric};

/// Corners that differ from those of a brick by less than this share of its largest edge are those of a brick.
const EXACT: f64 = 1e-11;

/// Parts of the values at eight corners: along ξ, η, ζ, and of the patterns ηζ, ζξ, ξη, ξηζ.
type Parts<N> = [N; 7];

/// Edges of an element along the axes \[m\]; `None` if it is no brick.
pub fn edges(corners: &[[f64; 3]; 8]) -> Option<[f64; 3]> {
    let edges = [0, 1, 2].map(|axis| corners[6][axis] - corners[0][axis]);
    let near = EXACT * edges.iter().fold(0.0, |size: f64, edge| size.max(edge.abs()));
    let place = |corner: usize, axis: usize| corners[0][axis] + 0.5 * (1.0 + CORNERS[corner][axis]) * edges[axis];
    let is_near = |corner: usize| (0..3).all(|axis| (corners[corner][axis] - place(corner, axis)).abs() <= near);
    (0..8).all(is_near).then_some(edges)
}

/// The mean strain of bricks, and the amplitudes of their patterns.
#[inline(always)]
pub fn deformation<N: Number>(edges: &[f64; 3], u: &Corners<N>) -> (Tensor<N>, Patterns<N>) {
    let [x, y, z] = [parts(&u[0]), parts(&u[1]), parts(&u[2])];
    let [a, b, c] = edges.map(|edge| 1.0 / (4.0 * edge));
    let strain =
        symmetric(&[[x[0] * a, x[1] * b, x[2] * c], [y[0] * a, y[1] * b, y[2] * c], [z[0] * a, z[1] * b, z[2] * c]]);
    (strain, [pattern(3, &x, &y, &z), pattern(4, &x, &y, &z), pattern(5, &x, &y, &z), pattern(6, &x, &y, &z)])
}

#[inline(always)]
fn pattern<N: Number>(at: usize, x: &Parts<N>, y: &Parts<N>, z: &Parts<N>) -> [N; 3] {
    [x[at] * 0.125, y[at] * 0.125, z[at] * 0.125]
}

/// The corner forces of a mean stress and of the resistances of the patterns.
#[inline(always)]
pub fn spread<N: Number>(edges: &[f64; 3], volume: f64, stress: &Tensor<N>, resistance: &Patterns<N>) -> Corners<N> {
    let [a, b, c] = edges.map(|edge| -volume / (4.0 * edge));
    let scales = [a, b, c, -0.125 * volume];
    [
        corners(&along(0, &scales, stress, resistance)),
        corners(&along(1, &scales, stress, resistance)),
        corners(&along(2, &scales, stress, resistance)),
    ]
}

/// Parts of the forces along an axis.
#[inline(always)]
fn along<N: Number>(axis: usize, &[a, b, c, d]: &[f64; 4], stress: &Tensor<N>, resistance: &Patterns<N>) -> Parts<N> {
    let [x, y, z] = COMPONENT[axis];
    [
        stress[x] * a,
        stress[y] * b,
        stress[z] * c,
        resistance[0][axis] * d,
        resistance[1][axis] * d,
        resistance[2][axis] * d,
        resistance[3][axis] * d,
    ]
}

/// Sums of the values with the signs of each part, from edges along ξ, then faces, then the body.
#[inline(always)]
fn parts<N: Number>(u: &[N; 8]) -> Parts<N> {
    let (s0, d0) = (u[1] + u[0], u[1] - u[0]);
    let (s1, d1) = (u[2] + u[3], u[2] - u[3]);
    let (s2, d2) = (u[5] + u[4], u[5] - u[4]);
    let (s3, d3) = (u[6] + u[7], u[6] - u[7]);
    let (low, low_y, low_x, low_xy) = (s1 + s0, s1 - s0, d1 + d0, d1 - d0);
    let (top, top_y, top_x, top_xy) = (s3 + s2, s3 - s2, d3 + d2, d3 - d2);
    [top_x + low_x, top_y + low_y, top - low, top_y - low_y, top_x - low_x, top_xy + low_xy, top_xy - low_xy]
}

/// The sum of all parts with their signs at each corner: first along ζ, for the lower and the upper face, then along η,
/// then along ξ.
#[inline(always)]
fn corners<N: Number>(&[x, y, z, yz, zx, xy, xyz]: &Parts<N>) -> [N; 8] {
    let (low_x, top_x) = (x - zx, x + zx);
    let (low_y, top_y) = (y - yz, y + yz);
    let (low_xy, top_xy) = (xy - xyz, xy + xyz);
    // the part along ζ is negative on the lower face: the near edge has the opposite sign
    let (low_near, low_far) = (z + low_y, low_y - z);
    let (top_near, top_far) = (z - top_y, z + top_y);
    let (low_near_x, low_far_x) = (low_x - low_xy, low_x + low_xy);
    let (top_near_x, top_far_x) = (top_x - top_xy, top_x + top_xy);
    [
        (low_near + low_near_x) * -1.0,
        low_near_x - low_near,
        low_far + low_far_x,
        low_far - low_far_x,
        top_near - top_near_x,
        top_near + top_near_x,
        top_far + top_far_x,
        top_far - top_far_x,
    ]
}
