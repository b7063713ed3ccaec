//! Bonded elastic layers under a pressure that varies as a wave along their surface.
//!
//! A load on any area is a sum of waves. Under a wave of wave number k all displacements and stresses are waves too; in
//! each layer they are a sum of four parts. With z downwards, the shear modulus G and Poisson's ratio n, the amplitudes
//! `(u, w, t / k, s / k)` of horizontal and vertical displacement, shear and normal stress on level planes are
//!
//! ```text
//! exp(-k z) p,  exp(-k z) (q + k z p)     p = (1, 1, -2 G, -2 G)
//!                                         q = (0, 3 - 4 n, -2 G (1 - 2 n), -4 G (1 - n))
//! ```
//!
//! and their mirror images, which come up from below: in these, w and t have the opposite sign. Going up through the
//! layers, the compliance `(u, w) = C (t, s)` of everything below is updated. It gives the upward parts from the
//! downward parts. Only decaying exponentials occur, so any thickness of a layer is possible.

use super::layers::{Below, Layer};
use nalgebra::{Matrix2, Vector2};

type Pair = Matrix2<f64>;

/// Depth times k below which nothing has an effect: exp(-30) is 1e-13.
const DEEP: f64 = 30.0;

/// A layer, prepared for any wave number.
struct Sheet {
    thickness: f64,
    /// Compliance of a half-space of its material.
    endless: Pair,
    /// Displacements and stresses of p and q, side by side.
    displacements: Pair,
    stresses: Pair,
    /// Under the last wave: stresses at its bottom from those at its top.
    passed: Pair,
}

/// Layers on what lies below them.
pub(super) struct Kernel {
    sheets: Vec<Sheet>,
    below: Below,
}

impl Kernel {
    pub fn new(layers: &[Layer], below: Below) -> Kernel {
        Kernel { sheets: layers.iter().map(Sheet::new).collect(), below }
    }

    /// Amplitude of the settlement of the surface times k under a pressure wave of amplitude 1, 1/Pa.
    pub fn settlement(&mut self, k: f64) -> f64 {
        let mut compliance = match self.below {
            Below::Rigid => Pair::zeros(),
            // the same stiffness against sliding and against pressure
            Below::Springs { modulus } => Pair::identity() * (-k / modulus),
            Below::HalfSpace { youngs_modulus, poisson_ratio } => endless(youngs_modulus, poisson_ratio),
        };
        for sheet in self.sheets.iter_mut().rev() {
            compliance = sheet.above(k, &compliance);
        }
        // a pressure is a negative normal stress
        -compliance.m22
    }

    /// Amplitude of the vertical pressure at the bottom of each layer under that wave.
    pub fn pressures(&self) -> impl Iterator<Item = f64> {
        self.sheets.iter().scan(Vector2::y(), |stress, sheet| {
            *stress = sheet.passed * *stress;
            Some(stress.y)
        })
    }
}

impl Sheet {
    fn new(layer: &Layer) -> Sheet {
        let (e, nu) = (layer.youngs_modulus, layer.poisson_ratio);
        let g = e / (2.0 * (1.0 + nu));
        Sheet {
            thickness: layer.thickness,
            endless: endless(e, nu),
            displacements: Pair::new(1.0, 0.0, 1.0, 3.0 - 4.0 * nu),
            stresses: Pair::new(1.0, 1.0 - 2.0 * nu, 1.0, 2.0 * (1.0 - nu)) * (-2.0 * g),
            passed: Pair::zeros(),
        }
    }

    /// Compliance at the top of the layer from the compliance at its bottom.
    fn above(&mut self, k: f64, below: &Pair) -> Pair {
        let depth = k * self.thickness;
        if depth > DEEP {
            self.passed = Pair::zeros();
            return self.endless;
        }
        let (u, s) = (&self.displacements, &self.stresses);
        let (u_up, s_up) = (mirrored(u), -mirrored(s));
        let fading = Pair::new(1.0, depth, 0.0, 1.0) * (-depth).exp();
        // at the bottom u + u_up r = C (s + s_up r)
        let returned = inverse(&(u_up - below * s_up)) * (below * s - u);
        let risen = fading * returned * fading;
        let from_stresses = inverse(&(s + s_up * risen));
        self.passed = (s + s_up * returned) * fading * from_stresses;
        (u + u_up * risen) * from_stresses
    }
}

/// Compliance of a half-space: `(1 / 2G) [[-2 (1 - nu), 1 - 2 nu], [1 - 2 nu, -2 (1 - nu)]]`.
fn endless(e: f64, nu: f64) -> Pair {
    let half = (1.0 + nu) / e;
    let (own, cross) = (-2.0 * (1.0 - nu) * half, (1.0 - 2.0 * nu) * half);
    Pair::new(own, cross, cross, own)
}

/// With the sign of the second row changed.
fn mirrored(m: &Pair) -> Pair {
    Pair::new(m.m11, m.m12, -m.m21, -m.m22)
}

fn inverse(m: &Pair) -> Pair {
    Pair::new(m.m22, -m.m12, -m.m21, m.m11) / m.determinant()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(thickness: f64, youngs_modulus: f64, poisson_ratio: f64) -> Layer {
        Layer { thickness, youngs_modulus, poisson_ratio, density: 2e3, spread: 0.5 }
    }

    /// The settlement of a layer on a rough rigid base (Vorovich, Aleksandrov and Babeshko 1974): with n = 3 - 4 nu and
    /// x = k h, `2 (1 - nu^2) / E (2 n sinh 2x - 4x) / (2 n cosh 2x + 1 + n^2 + 4 x^2)`.
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
                let found = Kernel::new(&[layer(0.5, 80e6, nu)], Below::Rigid).settlement(x / 0.5);
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
            let found = Kernel::new(&[layer(h, e, nu)], Below::Springs { modulus }).settlement(k) / k;
            let exact = 1.0 / (modulus + plate * f64::powi(k, 4));
            // the plate theory is for thin plates: its error is of the order (k h)^2
            assert!((found / exact - 1.0).abs() < 2.0 * (k * h).powi(2) + 1e-3, "k {k}: {found} against {exact}");
        }
    }

    #[test]
    fn equal_layers_are_one() {
        let many = [layer(0.1, 50e6, 0.3), layer(0.7, 50e6, 0.3), layer(0.0, 9e9, 0.1), layer(0.2, 50e6, 0.3)];
        let ground = Below::HalfSpace { youngs_modulus: 50e6, poisson_ratio: 0.3 };
        for k in [0.01, 0.7, 5.0, 40.0] {
            let one = Kernel::new(&[layer(1.0, 50e6, 0.3)], Below::Rigid).settlement(k);
            assert!((Kernel::new(&many, Below::Rigid).settlement(k) / one - 1.0).abs() < 1e-10);
            let mut endless = Kernel::new(&many, ground);
            assert!((endless.settlement(k) / (2.0 * (1.0 - 0.09) / 50e6) - 1.0).abs() < 1e-10);
            // pressure under a wave on a half-space: (1 + k z) exp(-k z)
            for (pressure, z) in endless.pressures().zip([0.1, 0.8, 0.8, 1.0]) {
                assert!((pressure - (1.0 + k * z) * f64::exp(-k * z)).abs() < 1e-10, "k {k}, z {z}: {pressure}");
            }
        }
    }
}
