//! Mohr-Coulomb with a tension cut-off: the stress of a strain that yields.
//!
//! Tension is positive, principal stresses are σ1 ≥ σ2 ≥ σ3. Shear yields at `σ1 - σ3 + (σ1 + σ3) sin φ = 2 c cos φ`,
//! tension yields at the limit of σ1. The shear flow has the dilation angle ψ instead of φ, the tension flow is
//! associated. In principal stresses each yield surface is a plane, so the return along the flow is exact in one step
//! if the active planes are known: one on a plane, two on an edge, three at a corner (Koiter 1953; Clausen, Damkilde
//! and Andersen 2006). They are found by trial.

use super::material::Strength;

/// A yield plane in principal stresses: `normal · σ = limit`; the flow is along `flow`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plane {
    normal: [f64; 3],
    flow: [f64; 3],
    limit: f64,
}

/// Strength with its elastic constants, prepared for use.
#[derive(Debug, Clone, PartialEq)]
pub struct Yield {
    lambda: f64,
    mu: f64,
    sine: f64,
    reach: f64,
    tension: f64,
    planes: [Plane; 6],
    /// Stress reduction of each plane per unit of flow.
    pushes: [[f64; 3]; 6],
}

/// Pairs of principal stresses whose shear can yield: the largest circle, then the circles of the two edges; then
/// tension.
const PAIRS: [[usize; 2]; 3] = [[0, 2], [1, 2], [0, 1]];

/// Sets of planes that can be active together, the most frequent first. Shear is numbered like the pairs, tension 3, 4,
/// 5.
const SETS: [&[usize]; 16] = [
    &[0],
    &[3],
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[3, 4],
    &[0, 1, 3],
    &[0, 3, 4],
    &[0, 2, 3],
    &[3, 4, 5],
    &[0, 1, 2],
    &[0, 1, 4],
    &[0, 2, 4],
    &[1, 3],
    &[2, 3],
    &[1, 3, 4],
];

impl Yield {
    pub fn new(strength: &Strength, lambda: f64, mu: f64) -> Yield {
        let Strength { cohesion, friction_angle, dilation_angle, tension } = *strength;
        let (sine, dilation) = (friction_angle.sin(), dilation_angle.sin());
        let reach = 2.0 * cohesion * friction_angle.cos();
        // no tension beyond the apex of the cone
        let tip = if sine > 0.0 { cohesion / friction_angle.tan() } else { f64::INFINITY };
        let tension = tension.min(tip);
        let mut planes = [Plane { normal: [0.0; 3], flow: [0.0; 3], limit: 0.0 }; 6];
        for (plane, [large, small]) in planes.iter_mut().zip(PAIRS) {
            let sides = |sine: f64| {
                let mut side = [0.0; 3];
                side[large] = 1.0 + sine;
                side[small] = sine - 1.0;
                side
            };
            *plane = Plane { normal: sides(sine), flow: sides(dilation), limit: reach };
        }
        for axis in 0..3 {
            let mut side = [0.0; 3];
            side[axis] = 1.0;
            planes[3 + axis] = Plane { normal: side, flow: side, limit: tension };
        }
        let pushes = planes.map(|plane| {
            let pressure = lambda * (plane.flow[0] + plane.flow[1] + plane.flow[2]);
            plane.flow.map(|flow| pressure + 2.0 * mu * flow)
        });
        Yield { lambda, mu, sine, reach, tension, planes, pushes }
    }

    /// The stress after yielding for a trial stress (xx, yy, zz, xy, yz, zx); `None` if it does not yield.
    #[inline]
    pub fn correct(&self, trial: &[f64; 6]) -> Option<[f64; 6]> {
        if self.surely_elastic(trial) {
            return None;
        }
        let (values, axes) = principal(trial);
        let corrected = self.correct_principal(values)?;
        let mut stress = [0.0; 6];
        for (component, (i, j)) in stress.iter_mut().zip([(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)]) {
            *component = (0..3).map(|k| corrected[k] * axes[k][i] * axes[k][j]).sum();
        }
        Some(stress)
    }

    /// Principal stresses lie within `mean ± 2/√3 √J2`, their largest difference within `2 √J2`.
    fn surely_elastic(&self, trial: &[f64; 6]) -> bool {
        let [xx, yy, zz, xy, yz, zx] = *trial;
        let mean = (xx + yy + zz) / 3.0;
        let shear = xy * xy + yz * yz + zx * zx;
        let deviator = (0.5 * ((xx - mean).powi(2) + (yy - mean).powi(2) + (zz - mean).powi(2)) + shear).sqrt();
        let third = 1.0 / 3f64.sqrt();
        2.0 * deviator + (2.0 * mean + third * deviator) * self.sine < self.reach
            && mean + 2.0 * third * deviator < self.tension
    }

    /// Return of principal stresses, largest first; `None` without yielding.
    pub fn correct_principal(&self, trial: [f64; 3]) -> Option<[f64; 3]> {
        let size = trial.iter().fold(self.reach, |size, s| size.max(s.abs()));
        let rounding = 1e-12 * size;
        let over = |stress: &[f64; 3]| {
            let over = |plane: &Plane| (0..3).map(|i| plane.normal[i] * stress[i]).sum::<f64>() - plane.limit;
            self.planes.iter().map(over).fold(f64::NEG_INFINITY, f64::max)
        };
        if over(&trial) <= 0.0 {
            return None;
        }
        let (mut best, mut least) = (trial, f64::INFINITY);
        for set in SETS {
            let Some(stress) = self.on(set, &trial) else { continue };
            let left = over(&stress);
            if left <= rounding {
                return Some(stress);
            }
            if left < least {
                (best, least) = (stress, left);
            }
        }
        Some(best)
    }

    /// The stress on some planes; `None` if the flow of a plane would be negative.
    fn on(&self, set: &[usize], trial: &[f64; 3]) -> Option<[f64; 3]> {
        if set.iter().any(|&plane| self.planes[plane].limit.is_infinite()) {
            return None;
        }
        let count = set.len();
        let mut matrix = [[0.0; 4]; 3];
        for (row, &plane) in set.iter().enumerate() {
            let Plane { normal, limit, .. } = self.planes[plane];
            for (column, &other) in set.iter().enumerate() {
                matrix[row][column] = (0..3).map(|i| normal[i] * self.pushes[other][i]).sum();
            }
            matrix[row][3] = (0..3).map(|i| normal[i] * trial[i]).sum::<f64>() - limit;
        }
        let flows = solve(&mut matrix, count)?;
        let least = -1e-12 * flows[..count].iter().fold(0.0f64, |m, f| m.max(f.abs()));
        if flows[..count].iter().any(|&flow| flow < least) {
            return None;
        }
        let mut stress = *trial;
        for (flow, &plane) in flows.iter().zip(set) {
            (0..3).for_each(|i| stress[i] -= flow * self.pushes[plane][i]);
        }
        Some(stress)
    }

    /// Strain (tensor components) of an elastic material under a stress.
    #[inline]
    pub fn strain(&self, stress: &[f64; 6]) -> [f64; 6] {
        let trace = stress[0] + stress[1] + stress[2];
        let pressure = self.lambda / (3.0 * self.lambda + 2.0 * self.mu) * trace;
        let mut strain = *stress;
        strain[..3].iter_mut().for_each(|s| *s -= pressure);
        strain.map(|s| s / (2.0 * self.mu))
    }
}

/// Solves up to three equations with the right-hand side in the last column; `None` if the solution is not unique.
fn solve(matrix: &mut [[f64; 4]; 3], count: usize) -> Option<[f64; 3]> {
    let size = matrix[..count].iter().flat_map(|row| &row[..count]).fold(0.0f64, |m, a| m.max(a.abs()));
    for column in 0..count {
        let pivot = (column..count).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        matrix.swap(column, pivot);
        if matrix[column][column].abs() <= 1e-10 * size {
            return None;
        }
        for row in column + 1..count {
            let factor = matrix[row][column] / matrix[column][column];
            let above = matrix[column];
            matrix[row].iter_mut().zip(above).for_each(|(a, above)| *a -= factor * above);
        }
    }
    let mut found = [0.0; 3];
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|k| matrix[row][k] * found[k]).sum();
        found[row] = (matrix[row][3] - known) / matrix[row][row];
    }
    Some(found)
}

/// Principal values of a symmetric tensor, largest first, and their axes, by Jacobi rotations.
pub fn principal(tensor: &[f64; 6]) -> ([f64; 3], [[f64; 3]; 3]) {
    let [xx, yy, zz, xy, yz, zx] = *tensor;
    let mut a = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..12 {
        let beside = a[0][1].abs() + a[1][2].abs() + a[0][2].abs();
        if beside <= 1e-17 * (a[0][0].abs() + a[1][1].abs() + a[2][2].abs()) {
            break;
        }
        for [p, q] in [[0, 1], [1, 2], [0, 2]] {
            if a[p][q] == 0.0 {
                continue;
            }
            let ratio = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
            let tangent = ratio.signum() / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
            let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
            let sine = tangent * cosine;
            let third = 3 - p - q;
            let (to_p, to_q) = (a[third][p], a[third][q]);
            a[p][p] -= tangent * a[p][q];
            a[q][q] += tangent * a[p][q];
            (a[p][q], a[q][p]) = (0.0, 0.0);
            a[third][p] = cosine * to_p - sine * to_q;
            a[third][q] = sine * to_p + cosine * to_q;
            (a[p][third], a[q][third]) = (a[third][p], a[third][q]);
            let (to_p, to_q) = (axes[p], axes[q]);
            axes[p] = [0, 1, 2].map(|i| cosine * to_p[i] - sine * to_q[i]);
            axes[q] = [0, 1, 2].map(|i| sine * to_p[i] + cosine * to_q[i]);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[j][j].total_cmp(&a[i][i]));
    (order.map(|i| a[i][i]), order.map(|i| axes[i]))
}
