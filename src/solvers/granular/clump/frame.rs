//! The principal frame of a symmetric tensor, as close to the given axes as possible.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Values that differ by less than this share of their sum count as equal: their axes are not rotated relative to each
/// other.
const EQUAL: f64 = 1e-9;

/// Rounds of three rotations; convergence is quadratic, and five rounds are enough.
const ROUNDS: usize = 20;

/// Axes and values of a symmetric, positive tensor, by Jacobi's rotations (Golub and Van Loan, Matrix Computations,
/// 8.5). No rotation exceeds 45 degrees and unnecessary rotations are left out. So values keep the order of the nearest
/// given axes, principal axes stay unchanged, and for equal values, whose axes are arbitrary, the given axes stay.
pub fn principal_frame(tensor: &Matrix3<f64>) -> (UnitQuaternion<f64>, Vector3<f64>) {
    let mut a = *tensor;
    let mut axes = Matrix3::identity();
    let size = tensor.trace();
    for _ in 0..ROUNDS {
        let mut turned = false;
        for (p, q) in [(0, 1), (1, 2), (2, 0)] {
            if let Some(turn) = rotation(&a, p, q, size) {
                a = turn.transpose() * a * turn;
                axes *= turn;
                turned = true;
            }
        }
        if !turned {
            break;
        }
    }
    (UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)), a.diagonal())
}

/// The rotation that makes entry (p, q) zero, or none if it is zero.
fn rotation(a: &Matrix3<f64>, p: usize, q: usize, size: f64) -> Option<Matrix3<f64>> {
    let (off, gap) = (a[(p, q)], a[(q, q)] - a[(p, p)]);
    let clear = off.abs() <= 1e-16 * size || (off.abs() <= EQUAL * size && gap.abs() <= EQUAL * size);
    if clear {
        return None;
    }
    let cotangent = 0.5 * gap / off; // of twice the angle
    let tangent = cotangent.signum() / (cotangent.abs() + (cotangent * cotangent + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    let mut turn = Matrix3::identity();
    turn[(p, p)] = cosine;
    turn[(q, q)] = cosine;
    turn[(p, q)] = sine;
    turn[(q, p)] = -sine;
    Some(turn)
}
