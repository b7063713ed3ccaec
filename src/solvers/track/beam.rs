//! The beam element with two nodes, Euler–Bernoulli or Timoshenko; it is exact for loads at its nodes.
//!
//! Unknowns are the deflection w (down) and the rotation θ of the cross-section (the slope w' if there is no shear) at
//! the left and at the right node. Between the nodes the element is the exact solution of the unloaded beam: a cubic w
//! whose shape depends on `φ = 12 EI/(κGA h²)`, and the quadratic θ that belongs to it (Friedman and Kosmatka,
//! Computers & Structures 47, 1993, doi 10.1016/0045-7949(93)90243-7). So the element does not lock. φ = 0 is the
//! Hermite element of Euler–Bernoulli.
//!
//! Under a point load P between the nodes, the exact deflection is the deflection of the element plus the deflection of
//! a beam clamped at both nodes, [`Element::clamped_deflection`]. The exact moments at the nodes exceed the moments of
//! the element by the clamping moments `-P N₂(a)`, `P N₄(a)`.

use crate::linalg::banded::SymmetricBanded;

/// A symmetric 4 x 4 matrix over the unknowns of an element.
pub(super) type ElementMatrix = [[f64; 4]; 4];

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Element {
    /// h, m.
    pub length: f64,
    /// EI, N m^2.
    pub bending_stiffness: f64,
    /// φ.
    shear_ratio: f64,
    /// κGA, N; infinite for Euler–Bernoulli.
    shear_stiffness: f64,
}

impl Element {
    /// Without a shear stiffness (κGA, N) the element is an Euler–Bernoulli beam.
    pub fn new(length: f64, bending_stiffness: f64, shear_stiffness: Option<f64>) -> Self {
        let shear_stiffness = shear_stiffness.unwrap_or(f64::INFINITY);
        let shear_ratio = 12.0 * bending_stiffness / (shear_stiffness * length * length);
        Self { length, bending_stiffness, shear_ratio, shear_stiffness }
    }

    /// Stiffness in bending and shear.
    pub fn stiffness(&self) -> ElementMatrix {
        let (h, phi) = (self.length, self.shear_ratio);
        let c = self.bending_stiffness / (h * h * h * (1.0 + phi));
        let (near, far) = ((4.0 + phi) * h * h, (2.0 - phi) * h * h);
        [
            [12.0, 6.0 * h, -12.0, 6.0 * h],
            [6.0 * h, near, -6.0 * h, far],
            [-12.0, -6.0 * h, 12.0, -6.0 * h],
            [6.0 * h, far, -6.0 * h, near],
        ]
        .map(|row| row.map(|entry| c * entry))
    }

    /// Consistent matrix of a property that resists deflection along the element: mass, foundation or damping, per
    /// metre.
    pub fn spread(&self, per_metre: f64) -> ElementMatrix {
        self.integral(per_metre, |a| self.shape(a))
    }

    /// Consistent matrix of the rotary inertia ρI per metre, which resists the rotation of the cross-section.
    pub fn rotary(&self, per_metre: f64) -> ElementMatrix {
        self.integral(per_metre, |a| self.rotation(a))
    }

    /// Nodal forces of an evenly distributed load, N per metre; their product with the displacements is also the
    /// integral of the deflection.
    pub fn even_load(&self, per_metre: f64) -> [f64; 4] {
        let h = self.length;
        [per_metre * h / 2.0, per_metre * h * h / 12.0, per_metre * h / 2.0, -per_metre * h * h / 12.0]
    }

    /// Deflection at distance `a` from the left node per unknown: N₁ .. N₄.
    #[inline]
    pub fn shape(&self, a: f64) -> [f64; 4] {
        let (h, phi) = (self.length, self.shear_ratio);
        let (s, t) = (a / h, 1.0 - a / h);
        let c = 1.0 / (1.0 + phi);
        [
            c * t * (t * (1.0 + 2.0 * s) + phi),
            c * a * t * (t + 0.5 * phi),
            c * s * (s * (1.0 + 2.0 * t) + phi),
            -c * s * (h - a) * (s + 0.5 * phi),
        ]
    }

    /// Rotation of the cross-section at distance `a` per unknown.
    pub fn rotation(&self, a: f64) -> [f64; 4] {
        let (h, phi) = (self.length, self.shear_ratio);
        let (s, t) = (a / h, 1.0 - a / h);
        let c = 1.0 / (1.0 + phi);
        let turn = 6.0 * c * s * t / h;
        [-turn, c * t * (t - 2.0 * s + phi), turn, c * s * (s - 2.0 * t + phi)]
    }

    /// Deflection at distance `x` of a beam clamped at both nodes under a unit load at `a`, m/N.
    pub fn clamped_deflection(&self, x: f64, a: f64) -> f64 {
        // Seen from the node on the side of x: its reaction is N₁(a), its clamping moment N₂(a).
        let (x, a) = if x <= a { (x, a) } else { (self.length - x, self.length - a) };
        let [reaction, moment, ..] = self.shape(a);
        x * (0.5 * x * (moment - reaction * x / 3.0) / self.bending_stiffness + reaction / self.shear_stiffness)
    }

    /// Sagging moments at the left and the right node, N m, without the moments of loads inside the element.
    #[inline]
    pub fn end_moments(&self, [w0, r0, w1, r1]: [f64; 4]) -> [f64; 2] {
        let (h, phi) = (self.length, self.shear_ratio);
        let c = self.bending_stiffness / (h * (1.0 + phi));
        let chord = 6.0 * (w0 - w1) / h;
        let (near, far) = (4.0 + phi, 2.0 - phi);
        [c * (chord + near * r0 + far * r1), -c * (chord + far * r0 + near * r1)]
    }

    /// `∫ f fᵀ da` over the element, times a factor: exact for the cubics by four Gauss points.
    fn integral(&self, factor: f64, f: impl Fn(f64) -> [f64; 4]) -> ElementMatrix {
        const POINTS: [(f64, f64); 2] =
            [(0.339_981_043_584_856_26, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_9)];
        let half = 0.5 * self.length;
        let mut matrix = [[0.0; 4]; 4];
        for (place, weight) in POINTS.into_iter().flat_map(|(p, w)| [(1.0 - p, w), (1.0 + p, w)]) {
            let values = f(half * place);
            for (row, left) in matrix.iter_mut().zip(values) {
                for (entry, right) in row.iter_mut().zip(values) {
                    *entry += factor * half * weight * left * right;
                }
            }
        }
        matrix
    }
}

/// Adds the matrix of an element over its unknowns.
pub(super) fn add_element(matrix: &mut SymmetricBanded, unknowns: [usize; 4], element: ElementMatrix) {
    for (r, row) in element.iter().enumerate() {
        for c in 0..=r {
            matrix.add(unknowns[r], unknowns[c], row[c]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EI: f64 = 6.4e6;

    fn theories(h: f64) -> [Element; 2] {
        [Element::new(h, EI, None), Element::new(h, EI, Some(240e6))]
    }

    #[test]
    fn clamped_beam_under_its_load() {
        let (a, b, h) = (0.2f64, 0.4f64, 0.6f64);
        let [euler, timoshenko] = theories(h);
        let expected = (a * b).powi(3) / (3.0 * EI * h.powi(3));
        assert!((euler.clamped_deflection(a, a) / expected - 1.0).abs() < 1e-14);
        // In the middle of the bay shear and bending add: P h³/192 EI + P h/4 κGA.
        let middle = timoshenko.clamped_deflection(0.3, 0.3);
        assert!((middle / (h.powi(3) / (192.0 * EI) + h / (4.0 * 240e6)) - 1.0).abs() < 1e-14, "{middle}");
        for element in theories(h) {
            let there = element.clamped_deflection(0.1, a);
            assert!((there / element.clamped_deflection(a, 0.1) - 1.0).abs() < 1e-14, "reciprocity");
            assert_eq!(element.clamped_deflection(0.0, a), 0.0);
        }
    }

    #[test]
    fn rigid_motion_costs_nothing() {
        for element in theories(0.15) {
            for motion in [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.15, 1.0]] {
                for row in element.stiffness() {
                    let force: f64 = row.iter().zip(motion).map(|(k, u)| k * u).sum();
                    assert!(force.abs() < 1e-14 * row[0].abs(), "{force}");
                }
                let at = |shape: [f64; 4]| shape.iter().zip(motion).map(|(n, u)| n * u).sum::<f64>();
                assert!((at(element.shape(0.05)) - (motion[0] + 0.05 * motion[1])).abs() < 1e-15);
                assert!((at(element.rotation(0.05)) - motion[1]).abs() < 1e-15);
            }
        }
    }

    /// Halving an element does not change the result between the nodes, as its functions are exact.
    #[test]
    fn two_halves_are_one() {
        for (whole, half) in theories(0.6).into_iter().zip(theories(0.3)) {
            let u = [1.3e-3, -2e-3, 0.4e-3, 1e-3];
            let at = |shape: [f64; 4]| shape.iter().zip(u).map(|(n, u)| n * u).sum::<f64>();
            let middle = [at(whole.shape(0.3)), at(whole.rotation(0.3))];
            let left = [u[0], u[1], middle[0], middle[1]];
            assert!(
                (at(whole.shape(0.2)) - left.iter().zip(half.shape(0.2)).map(|(u, n)| u * n).sum::<f64>()).abs()
                    < 1e-17
            );
            assert!((whole.end_moments(u)[0] / half.end_moments(left)[0] - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn consistent_mass_of_euler() {
        let h = 0.6;
        let [euler, _] = theories(h);
        let c = 60.0 * h / 420.0;
        let mass = euler.spread(60.0);
        for (entry, expected) in [
            (mass[0][0], 156.0),
            (mass[0][1], 22.0 * h),
            (mass[0][2], 54.0),
            (mass[0][3], -13.0 * h),
            (mass[1][1], 4.0 * h * h),
            (mass[1][3], -3.0 * h * h),
        ] {
            assert!((entry / (c * expected) - 1.0).abs() < 1e-13);
        }
        // ρI/(30 h) · 36 and 4 h²
        let rotary = euler.rotary(0.24);
        assert!((rotary[0][0] / (0.24 * 36.0 / (30.0 * h)) - 1.0).abs() < 1e-13);
        assert!((rotary[1][1] / (0.24 * 4.0 * h / 30.0) - 1.0).abs() < 1e-13);
    }
}
