//! One step of the rotation of a rigid body, for a leapfrog: angular momentum at half steps, attitude at full steps.
//!
//! In the principal frame of the body the free motion is `p' = p × Ω`, `Ω = p/I`, with p = Rᵀ L. The implicit midpoint
//! rule keeps every quadratic invariant (Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.2), for example
//! the energy and the magnitude of p, and is symmetric in time:
//!
//! ```text
//! p̄ = p + (Δt/2) p̄ × Ω,    Ω = p̄/I,    R <- R cay(Δt Ω)
//! ```
//!
//! The rotation cay(Δt Ω), by the angle 2 atan(Δt |Ω|/2) about Ω, is the quaternion (1, Δt Ω/2) after normalisation. L
//! itself does not change, so it is exact to the last bit. Angles are too small by a share of (Δt |Ω|)²/12: 1e-11 in a
//! bed.

use super::lanes::{Fine, FineVector, Lanes, Matrix, Plain};

/// Largest number of iterations. Beyond it, Δt |Ω| is above 1, and no second-order scheme is accurate.
const ROUNDS: usize = 60;

/// The iteration ends if p̄ changes by no more than this share: the remaining error is smaller by another Δt |Ω|/2.
const SETTLED: f64 = 1e-15;

/// Rotates a body by one free step of `dt` (s), and returns the angular velocity (rad/s, in the world) of that step:
/// the body rotates about it by the angle 2 atan(dt |ω|/2).
///
/// `attitude` is the unit quaternion (w, x, y, z) from the principal frame to the world; its length stays 1 to
/// rounding. (The coordinates of nalgebra's quaternions are (x, y, z, w).) `momentum` is the angular momentum in the
/// world, kg m²/s, at the middle of the step; `inverse_inertia` are the inverse principal moments, 1/(kg m²). Free
/// motion keeps its energy to rounding while dt |ω| is below 1/2. Only `+ - * /` and roots are used: the result is the
/// same bits on every machine.
pub fn turn(attitude: &mut [f64; 4], momentum: &[f64; 3], inverse_inertia: &[f64; 3], dt: f64) -> [f64; 3] {
    let lane = One::new();
    let before = attitude.map(|part| Fine::splat(lane, part));
    let [momentum, inverse] = [momentum, inverse_inertia].map(|v| FineVector::splat(lane, *v));
    let (after, spin) = turn_in_lanes(&before, &matrix_in_lanes(&before), momentum, inverse, dt);
    *attitude = after.map(|part| part.value[0]);
    spin.0.map(|part| part.value[0])
}

/// The rotation matrix of a unit quaternion (w, x, y, z), as rows: from the principal frame to the world.
pub fn matrix(attitude: &[f64; 4]) -> [[f64; 3]; 3] {
    let rows = matrix_in_lanes(&attitude.map(|part| Fine::splat(One::new(), part))).0;
    rows.map(|row| row.0.map(|part| part.value[0]))
}

type One = Plain<f64, 1>;

/// [`turn`] for one body per lane, with known matrices: attitudes after the step, and spins of the step.
#[inline(always)]
pub(super) fn turn_in_lanes<L: Lanes>(
    attitude: &[Fine<L>; 4],
    axes: &Matrix<L>,
    momentum: FineVector<L>,
    inverse_inertia: FineVector<L>,
    dt: f64,
) -> ([Fine<L>; 4], FineVector<L>) {
    let [w, x, y, z] = *attitude;
    let half = w.alike(0.5 * dt);
    let spin = mid_step_spin(axes.apply_back(momentum), inverse_inertia, half);
    let [a, b, c] = [half * spin.0[0], half * spin.0[1], half * spin.0[2]];
    let [p, q, r, s] = [
        w - (x * a + y * b + z * c),
        x + (w * a + y * c - z * b),
        y + (w * b + z * a - x * c),
        z + (w * c + x * b - y * a),
    ];
    let shorten = w.alike(1.0) / ((p * p + q * q) + (r * r + s * s)).sqrt();
    ([p * shorten, q * shorten, r * shorten, s * shorten], axes.apply(spin))
}

/// [`matrix`] for one body per lane.
#[inline(always)]
pub(super) fn matrix_in_lanes<L: Lanes>(attitude: &[Fine<L>; 4]) -> Matrix<L> {
    let [w, x, y, z] = *attitude;
    let (one, two) = (w.alike(1.0), w.alike(2.0));
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let (xy, yz, zx) = (x * y, y * z, z * x);
    let (wx, wy, wz) = (w * x, w * y, w * z);
    Matrix([
        FineVector([one - two * (yy + zz), two * (xy - wz), two * (zx + wy)]),
        FineVector([two * (xy + wz), one - two * (zz + xx), two * (yz - wx)]),
        FineVector([two * (zx - wy), two * (yz + wx), one - two * (xx + yy)]),
    ])
}

/// Ω at the middle of the step, in the principal frame. Every iteration reduces the error by a factor of about dt
/// |Ω|/2: two or three iterations in a bed. Each lane ends its iteration independently of the other lanes.
#[inline(always)]
fn mid_step_spin<L: Lanes>(start: FineVector<L>, inverse_inertia: FineVector<L>, half: Fine<L>) -> FineVector<L> {
    let settled = half.alike(SETTLED * SETTLED) * start.dot(start);
    let (mut middle, mut spin) = (start, start.times(inverse_inertia));
    let mut change = half.alike(f64::INFINITY);
    for _ in 0..ROUNDS {
        let next = start + middle.cross(spin).scale(half);
        let further = next - middle;
        // a converged lane does not change
        let before = change;
        change = further.dot(further).where_less(settled, before, before);
        middle = next.where_less(settled, before, middle);
        spin = middle.times(inverse_inertia);
        if !settled.any_less(change) {
            break;
        }
    }
    spin
}

#[cfg(test)]
mod tests {
    use super::super::integrate::{rotate as to_world, rotate_back as to_body};
    use super::super::vector::dot;
    use super::*;

    const INERTIA: [f64; 3] = [1.0, 1.7, 2.2];

    struct Top {
        attitude: [f64; 4],
        momentum: [f64; 3],
        inverse: [f64; 3],
    }

    impl Top {
        /// A body with a given spin in its principal frame, in a general attitude.
        fn new(inertia: [f64; 3], spin: [f64; 3]) -> Self {
            let attitude = [0.5, -0.5, 0.1, 0.7]; // of length 1
            let p = [inertia[0] * spin[0], inertia[1] * spin[1], inertia[2] * spin[2]];
            Self { attitude, momentum: to_world(&matrix(&attitude), p), inverse: inertia.map(|i| 1.0 / i) }
        }

        fn step(&mut self, dt: f64) {
            turn(&mut self.attitude, &self.momentum, &self.inverse, dt);
        }

        fn spin(&self) -> [f64; 3] {
            let p = to_body(&matrix(&self.attitude), self.momentum);
            [p[0] * self.inverse[0], p[1] * self.inverse[1], p[2] * self.inverse[2]]
        }

        fn twice_energy(&self) -> f64 {
            let p = to_body(&matrix(&self.attitude), self.momentum);
            p[0] * p[0] * self.inverse[0] + p[1] * p[1] * self.inverse[1] + p[2] * p[2] * self.inverse[2]
        }
    }

    /// Complete elliptic integral of the first kind by the arithmetic-geometric mean.
    fn elliptic(modulus: f64) -> f64 {
        let (mut a, mut g) = (1.0, (1.0 - modulus * modulus).sqrt());
        while (a - g).abs() > 1e-15 * a {
            (a, g) = (0.5 * (a + g), (a * g).sqrt());
        }
        std::f64::consts::FRAC_PI_2 / a
    }

    /// Landau and Lifshitz, Mechanics, section 37: the period of the spin in the principal frame.
    fn period(inertia: [f64; 3], spin: [f64; 3]) -> f64 {
        let [mut a, b, mut c] = inertia;
        let energy: f64 = (0..3).map(|k| inertia[k] * spin[k] * spin[k]).sum();
        let momentum: f64 = (0..3).map(|k| (inertia[k] * spin[k]).powi(2)).sum();
        if momentum < energy * b {
            std::mem::swap(&mut a, &mut c);
        }
        let modulus = (b - a) * (energy * c - momentum) / ((c - b) * (momentum - energy * a));
        4.0 * elliptic(modulus.sqrt()) * (a * b * c / ((c - b) * (momentum - energy * a))).sqrt()
    }

    /// The time between the first and the third zero of a component of the spin, a period, from the steps around each.
    fn measured_period(spin: [f64; 3], component: usize, dt: f64) -> f64 {
        let mut top = Top::new(INERTIA, spin);
        let mut zeros = Vec::new();
        let mut past = [top.spin()[component]; 3];
        for step in 0.. {
            if zeros.len() == 3 {
                break;
            }
            top.step(dt);
            past = [past[1], past[2], top.spin()[component]];
            if past[1] * past[2] < 0.0 {
                // The parabola through the last three values, whose error is of the third order.
                let (slope, bend) = (0.5 * (past[2] - past[0]), 0.5 * (past[2] - 2.0 * past[1] + past[0]));
                let mut at = past[1] / (past[1] - past[2]);
                for _ in 0..20 {
                    at -= (past[1] + slope * at + bend * at * at) / (slope + 2.0 * bend * at);
                }
                zeros.push((step as f64 + at) * dt);
            }
        }
        zeros[2] - zeros[0]
    }

    #[test]
    fn free_motion_keeps_energy_and_attitude() {
        for (spin, dt) in [([0.02, 1.0, 0.01], 1e-3), ([0.6, 0.4, -0.7], 1e-3), ([0.6, 0.4, -0.7], 1e-5)] {
            let mut top = Top::new(INERTIA, spin);
            let energy = top.twice_energy();
            let mut worst: f64 = 0.0;
            for _ in 0..1_000_000 {
                top.step(dt);
                worst = worst.max((top.twice_energy() / energy - 1.0).abs());
            }
            assert!(worst < 1e-11, "{worst}");
            let size: f64 = top.attitude.iter().map(|c| c * c).sum();
            assert!((size - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn energy_is_kept_in_steps_of_half_a_radian() {
        let mut top = Top::new(INERTIA, [0.6, 0.4, -0.7]);
        let energy = top.twice_energy();
        for _ in 0..10_000 {
            top.step(0.5);
        }
        assert!((top.twice_energy() / energy - 1.0).abs() < 1e-11);
    }

    #[test]
    fn a_step_back_undoes_a_step() {
        let mut top = Top::new(INERTIA, [0.6, 0.4, -0.7]);
        let start = top.attitude;
        for dt in [0.01, -0.01] {
            for _ in 0..10_000 {
                top.step(dt);
            }
        }
        for (a, b) in top.attitude.iter().zip(start) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
    }

    #[test]
    fn the_flip_about_the_middle_axis_takes_its_time() {
        let spin = [0.01, 1.0, 0.0];
        let exact = period(INERTIA, spin);
        let errors = [0.02, 0.01, 0.005].map(|dt| measured_period(spin, 1, dt) / exact - 1.0);
        assert!(errors[2].abs() < 5e-6);
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.05, "order {order}");
        }
    }

    #[test]
    fn spin_about_the_outer_axes_wobbles_at_the_closed_form() {
        for (spin, component) in [([1.0, 0.3, 0.2], 1), ([0.2, 0.3, 1.0], 1)] {
            let error = measured_period(spin, component, 1e-3) / period(INERTIA, spin) - 1.0;
            assert!(error.abs() < 5e-7, "{error}");
        }
    }

    /// The axis of a symmetric top rotates about L at the rate |L|/I, and the top about its axis at (1/J - 1/I) L·e in
    /// addition.
    fn symmetric_top_error(dt: f64) -> f64 {
        let (across, along) = (1.3, 0.8);
        let mut top = Top::new([across, across, along], [0.4, 0.0, 0.9]);
        let start = top.attitude;
        let steps = (20.0 / dt).round() as usize;
        for _ in 0..steps {
            top.step(dt);
        }
        let time = steps as f64 * dt;
        let size = dot(top.momentum, top.momentum).sqrt();
        let about = |axis: [f64; 3], angle: f64| {
            let (s, c) = (0.5 * angle).sin_cos();
            nalgebra::Quaternion::new(c, s * axis[0], s * axis[1], s * axis[2])
        };
        let precession = about(top.momentum.map(|l| l / size), size / across * time);
        let own = about([0.0, 0.0, 1.0], (1.0 / along - 1.0 / across) * along * 0.9 * time);
        let exact = precession * nalgebra::Quaternion::new(start[0], start[1], start[2], start[3]) * own;
        let [w, x, y, z] = top.attitude;
        2.0 * (exact.w * w + exact.i * x + exact.j * y + exact.k * z).abs().min(1.0).acos()
    }

    #[test]
    fn a_symmetric_top_precesses_at_second_order() {
        let errors = [0.04, 0.02, 0.01].map(symmetric_top_error);
        assert!(errors[2] < 3e-4);
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.02, "order {order}");
        }
    }

    #[test]
    fn the_spin_given_back_is_that_of_the_step() {
        let mut top = Top::new(INERTIA, [0.6, 0.4, -0.7]);
        let before = nalgebra::Matrix3::from(matrix(&top.attitude)).transpose();
        let dt = 0.1;
        let spin = turn(&mut top.attitude, &top.momentum, &top.inverse, dt);
        let after = nalgebra::Matrix3::from(matrix(&top.attitude)).transpose();
        let spin = nalgebra::Vector3::from(spin);
        let step = nalgebra::Rotation3::from_axis_angle(
            &nalgebra::Unit::new_normalize(spin),
            2.0 * (0.5 * dt * spin.norm()).atan(),
        );
        assert!((step.matrix() * before - after).norm() < 1e-15);
    }
}
