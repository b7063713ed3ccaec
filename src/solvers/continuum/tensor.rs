//! Values of eight elements at once: at their corners, tensors, hourglass patterns.

use super::lanes::{Lanes, Number};

/// Values at the corners: axis by axis, corner by corner.
pub type Corners<N = Lanes> = [[N; 8]; 3];

/// Components xx, yy, zz, xy, yz, zx of a symmetric tensor; shear strains are tensor components, half of the shear
/// angle.
pub type Tensor<N = Lanes> = [N; 6];

/// Amplitude or force of each hourglass pattern along each axis.
pub type Patterns<N = Lanes> = [[N; 3]; 4];

/// Tensor component of two axes.
pub const COMPONENT: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];

/// The strain of a gradient of displacement: row by axis of displacement.
#[inline(always)]
pub fn symmetric<N: Number>(slope: &[[N; 3]; 3]) -> Tensor<N> {
    [
        slope[0][0],
        slope[1][1],
        slope[2][2],
        (slope[0][1] + slope[1][0]) * 0.5,
        (slope[1][2] + slope[2][1]) * 0.5,
        (slope[2][0] + slope[0][2]) * 0.5,
    ]
}
