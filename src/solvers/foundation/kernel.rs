//! Bonded elastic layers under a pressure that waves along their surface.
//!
//! A load of any plan is a sum of waves, and under a wave of number k every displacement and stress waves too. Their
//! amplitudes `y = (u, w, t / k, s / k)`, horizontal and vertical displacement, shear and normal stress on level planes,
//! obey `dy/dz = k A y` with z downwards and Lame's constants L and G, M = L + 2G:
//!
//! ```text
//! u' = k (w + t / G)               t' = k (k u (M - L^2 / M) + s L / M)
//! w' = k (s - k L u) / (k M)       s' = -k t
//! ```
//!
//! `A` has the double eigenvalues -1 and 1, so that exp(A x) is a polynomial of third degree in A. Going up through the
//! layers, the compliance `(u, w) = C (t, s)` of all that lies below is carried along: it stays bounded where the
//! exponential itself overflows.

use super::{Below, Layer};

type Pair = [[f64; 2]; 2];
type Quad = [[f64; 4]; 4];

/// Slices of a layer are not thicker than this over k: exp(2 x) of the digits are lost in one.
const THICKEST: f64 = 3.0;
/// Below this depth, times k, nothing is felt: exp(-30) is 1e-13.
const DEEP: f64 = 30.0;

/// A layer, ready for any wave number.
struct Sheet {
    thickness: f64,
    /// Compliance of a half-space of its material.
    endless: Pair,
    /// A, A^2 - 1 and their product.
    powers: [Quad; 3],
}

/// Layers on what lies below them.
pub(super) struct Kernel {
    sheets: Vec<Sheet>,
    below: Below,
}

/// The answer to a wave of pressure of amplitude 1.
pub(super) struct Answer {
    /// Amplitude of the surface's settlement times k, 1/Pa.
    pub settlement: f64,
    /// Amplitude of the vertical pressure at the bottom of each layer.
    pub pressures: Vec<f64>,
}

impl Kernel {
    pub fn new(layers: &[Layer], below: Below) -> Kernel {
        Kernel { sheets: layers.iter().map(Sheet::new).collect(), below }
    }

    pub fn answer(&self, k: f64) -> Answer {
        let mut compliance = match self.below {
            Below::Rigid => [[0.0; 2]; 2],
            // they hold against sliding as they do against pressure
            Below::Springs { modulus } => [[-k / modulus, 0.0], [0.0, -k / modulus]],
            Below::HalfSpace { youngs_modulus, poisson_ratio } => endless(youngs_modulus, poisson_ratio),
        };
        // stresses at the bottom of each layer from those at its top
        let mut passed = vec![[[0.0; 2]; 2]; self.sheets.len()];
        for (sheet, passed) in self.sheets.iter().zip(&mut passed).rev() {
            (compliance, *passed) = sheet.above(k, compliance);
        }
        let mut stress = [0.0, 1.0];
        let pressures = passed
            .iter()
            .map(|passed| {
                stress = [
                    passed[0][0] * stress[0] + passed[0][1] * stress[1],
                    passed[1][0] * stress[0] + passed[1][1] * stress[1],
                ];
                stress[1]
            })
            .collect();
        // a pressure is a negative normal stress
        Answer { settlement: -compliance[1][1], pressures }
    }
}

impl Sheet {
    fn new(layer: &Layer) -> Sheet {
        let (e, nu) = (layer.youngs_modulus, layer.poisson_ratio);
        let shear = e / (2.0 * (1.0 + nu));
        let lame = 2.0 * shear * nu / (1.0 - 2.0 * nu);
        let oedometric = lame + 2.0 * shear;
        let a = [
            [0.0, 1.0, 1.0 / shear, 0.0],
            [-lame / oedometric, 0.0, 0.0, 1.0 / oedometric],
            [oedometric - lame * lame / oedometric, 0.0, 0.0, lame / oedometric],
            [0.0, 0.0, -1.0, 0.0],
        ];
        let mut even = product(&a, &a);
        for (i, row) in even.iter_mut().enumerate() {
            row[i] -= 1.0;
        }
        Sheet { thickness: layer.thickness, endless: endless(e, nu), powers: [a, even, product(&even, &a)] }
    }

    /// Compliance at the top of the layer from that at its bottom, and the stresses at the bottom from those at the top.
    fn above(&self, k: f64, below: Pair) -> (Pair, Pair) {
        let depth = k * self.thickness;
        if depth > DEEP {
            return (self.endless, [[0.0; 2]; 2]);
        }
        let slices = (depth / THICKEST).ceil().max(1.0);
        let up = self.upwards(depth / slices);
        let (mut compliance, mut passed) = (below, [[1.0, 0.0], [0.0, 1.0]]);
        for _ in 0..slices as usize {
            // y at the top = exp(-A x) (C, 1) times the stresses at the bottom
            let displacement = combined(&up, 0, &compliance);
            let stress = inverse(&combined(&up, 2, &compliance));
            compliance = times(&displacement, &stress);
            passed = times(&passed, &stress);
        }
        (compliance, passed)
    }

    /// exp(-A x), from the polynomial that meets exp(-x l) and its slope at l = -1 and 1.
    fn upwards(&self, x: f64) -> Quad {
        let (cosh, sinh) = (x.cosh(), x.sinh());
        let factors = [-sinh, 0.5 * x * sinh, -0.5 * (x * cosh - sinh)];
        let mut sum = [[0.0; 4]; 4];
        for (i, row) in sum.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                let unit = if i == j { cosh } else { 0.0 };
                *value = unit + self.powers.iter().zip(factors).map(|(power, f)| f * power[i][j]).sum::<f64>();
            }
        }
        sum
    }
}

/// Compliance of a half-space: `(1 / 2G) [[-2 (1 - nu), 1 - 2 nu], [1 - 2 nu, -2 (1 - nu)]]`.
fn endless(e: f64, nu: f64) -> Pair {
    let half = (1.0 + nu) / e;
    let (own, cross) = (-2.0 * (1.0 - nu) * half, (1.0 - 2.0 * nu) * half);
    [[own, cross], [cross, own]]
}

/// Two rows of `e (C, 1)`, from the row `first`.
fn combined(e: &Quad, first: usize, c: &Pair) -> Pair {
    let entry = |i: usize, j: usize| e[first + i][0] * c[0][j] + e[first + i][1] * c[1][j] + e[first + i][2 + j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

fn times(a: &Pair, b: &Pair) -> Pair {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

fn inverse(a: &Pair) -> Pair {
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    [[a[1][1] / determinant, -a[0][1] / determinant], [-a[1][0] / determinant, a[0][0] / determinant]]
}

fn product(a: &Quad, b: &Quad) -> Quad {
    let mut sum = [[0.0; 4]; 4];
    for (i, row) in sum.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = (0..4).map(|m| a[i][m] * b[m][j]).sum();
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(thickness: f64, youngs_modulus: f64, poisson_ratio: f64) -> Layer {
        Layer { thickness, youngs_modulus, poisson_ratio, density: 2e3, spread: 0.5 }
    }

    /// Of a layer on a rough rigid base (Vorovich, Aleksandrov and Babeshko 1974): with n = 3 - 4 nu and x = k h,
    /// `2 (1 - nu^2) / E (2 n sinh 2x - 4x) / (2 n cosh 2x + 1 + n^2 + 4 x^2)`.
    fn on_rock(e: f64, nu: f64, x: f64) -> f64 {
        let n = 3.0 - 4.0 * nu;
        let above = 2.0 * n * (2.0 * x).sinh() - 4.0 * x;
        let below = 2.0 * n * (2.0 * x).cosh() + 1.0 + n * n + 4.0 * x * x;
        2.0 * (1.0 - nu * nu) / e * above / below
    }

    #[test]
    fn a_layer_on_rock_is_the_closed_form() {
        for nu in [0.0, 0.25, 0.45] {
            for x in [1e-3, 0.1, 1.0, 2.9, 3.1, 8.0, 29.0, 31.0] {
                let found = Kernel::new(&[layer(0.5, 80e6, nu)], Below::Rigid).answer(x / 0.5).settlement;
                let exact = on_rock(80e6, nu, x);
                assert!((found / exact - 1.0).abs() < 1e-10, "nu {nu}, k h {x}: {found} against {exact}");
            }
        }
    }

    #[test]
    fn a_thin_stiff_layer_on_springs_is_a_plate() {
        let (e, nu, h, modulus) = (30e9, 0.2, 0.2, 60e6);
        let plate = e * h * h * h / (12.0 * (1.0 - nu * nu));
        for k in [0.05, 0.2, 0.5] {
            let found = Kernel::new(&[layer(h, e, nu)], Below::Springs { modulus }).answer(k).settlement / k;
            let exact = 1.0 / (modulus + plate * f64::powi(k, 4));
            // a plate is thin: what it leaves out is of the order (k h)^2
            assert!((found / exact - 1.0).abs() < 2.0 * (k * h).powi(2) + 1e-3, "k {k}: {found} against {exact}");
        }
    }

    #[test]
    fn equal_layers_are_one() {
        let many = [layer(0.1, 50e6, 0.3), layer(0.7, 50e6, 0.3), layer(0.0, 9e9, 0.1), layer(0.2, 50e6, 0.3)];
        let ground = Below::HalfSpace { youngs_modulus: 50e6, poisson_ratio: 0.3 };
        for k in [0.01, 0.7, 5.0, 40.0] {
            let (answer, one) = (Kernel::new(&many, Below::Rigid), Kernel::new(&[layer(1.0, 50e6, 0.3)], Below::Rigid));
            assert!((answer.answer(k).settlement / one.answer(k).settlement - 1.0).abs() < 1e-10);
            let endless = Kernel::new(&many, ground).answer(k);
            assert!((endless.settlement / (2.0 * (1.0 - 0.09) / 50e6) - 1.0).abs() < 1e-10);
            // pressure under a wave on a half-space: (1 + k z) exp(-k z)
            for (pressure, z) in endless.pressures.iter().zip([0.1, 0.8, 0.8, 1.0]) {
                assert!((pressure - (1.0 + k * z) * f64::exp(-k * z)).abs() < 1e-10, "k {k}, z {z}: {pressure}");
            }
        }
    }
}
