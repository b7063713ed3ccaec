//! The cubic Hermite element of an Euler–Bernoulli beam: matrices, loads between its nodes and what the cubic leaves out.
//!
//! Unknowns are deflection w (down) and slope w' of the left and of the right node. The element is exact for loads at its
//! nodes. Under a point load P at distances a and b from the nodes of an element of length h, the exact deflection exceeds
//! the cubic by that of a beam clamped at both nodes: `P a³b³/(3 EI h³)` at the load, with the clamping moments
//! `-P ab²/h²` and `-P a²b/h²` (sagging positive) at the nodes.

/// A symmetric 4 x 4 matrix over the unknowns of an element.
pub(super) type ElementMatrix = [[f64; 4]; 4];

/// Bending stiffness matrix.
pub(super) fn stiffness(bending_stiffness: f64, h: f64) -> ElementMatrix {
    let c = bending_stiffness / (h * h * h);
    scaled(
        c,
        [
            [12.0, 6.0 * h, -12.0, 6.0 * h],
            [6.0 * h, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
            [-12.0, -6.0 * h, 12.0, -6.0 * h],
            [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
        ],
    )
}

/// Consistent matrix of something spread along the element: mass, foundation stiffness or damping, per metre.
pub(super) fn spread(per_metre: f64, h: f64) -> ElementMatrix {
    let c = per_metre * h / 420.0;
    scaled(
        c,
        [
            [156.0, 22.0 * h, 54.0, -13.0 * h],
            [22.0 * h, 4.0 * h * h, 13.0 * h, -3.0 * h * h],
            [54.0, 13.0 * h, 156.0, -22.0 * h],
            [-13.0 * h, -3.0 * h * h, -22.0 * h, 4.0 * h * h],
        ],
    )
}

/// Nodal forces of a load spread evenly, N per metre; their product with displacements also integrates these.
pub(super) fn even_load(per_metre: f64, h: f64) -> [f64; 4] {
    [per_metre * h / 2.0, per_metre * h * h / 12.0, per_metre * h / 2.0, -per_metre * h * h / 12.0]
}

/// The cubics at distance `a` from the left node.
pub(super) fn shape(a: f64, h: f64) -> [f64; 4] {
    let (s, t) = (a / h, 1.0 - a / h);
    [t * t * (1.0 + 2.0 * s), a * t * t, s * s * (1.0 + 2.0 * t), -s * s * (h - a)]
}

/// Deflection at distance `x` under a unit load at `a` of a beam clamped at both nodes, m/N.
pub(super) fn clamped_deflection(x: f64, a: f64, bending_stiffness: f64, h: f64) -> f64 {
    // Seen from the node on whose side x lies.
    let (x, a) = if x <= a { (x, a) } else { (h - x, h - a) };
    let b = h - a;
    b * b * x * x * (3.0 * a * h - 3.0 * a * x - b * x) / (6.0 * bending_stiffness * h * h * h)
}

fn scaled(factor: f64, mut matrix: ElementMatrix) -> ElementMatrix {
    matrix.iter_mut().flatten().for_each(|entry| *entry *= factor);
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamped_beam_under_its_load() {
        let (a, b, h, ei) = (0.2f64, 0.4f64, 0.6f64, 6.4e6);
        let expected = (a * b).powi(3) / (3.0 * ei * h.powi(3));
        assert!((clamped_deflection(a, a, ei, h) / expected - 1.0).abs() < 1e-14);
        // Reciprocity.
        assert!((clamped_deflection(0.1, a, ei, h) / clamped_deflection(a, 0.1, ei, h) - 1.0).abs() < 1e-14);
        assert_eq!(clamped_deflection(0.0, a, ei, h), 0.0);
    }

    #[test]
    fn rigid_motion_costs_nothing() {
        let h = 0.15;
        let k = stiffness(1.0, h);
        for motion in [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, h, 1.0]] {
            for row in k {
                let force: f64 = row.iter().zip(motion).map(|(k, u)| k * u).sum();
                assert!(force.abs() < 1e-9);
            }
        }
        assert!((shape(0.05, h)[0] + shape(0.05, h)[2] - 1.0).abs() < 1e-15);
    }
}
