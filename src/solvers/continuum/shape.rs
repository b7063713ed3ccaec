//! Data shared by elements of one shape and one material: the mean gradient of a hexahedron, its hourglass patterns,
//! its masses.
//!
//! The mean gradient `b = (1/V) ∫ ∇N dV` is exact (the integrand is a polynomial that two points per axis integrate),
//! so that a linear field has its exact strain in any hexahedron. Four patterns `γ` have no mean strain, among them
//! bending and twisting (Flanagan and Belytschko 1981): `γ = (h - Σ (h·x) b) / 8` for the four patterns h = ηζ, ζξ, ξη,
//! ξηζ. They are orthogonal to every linear field, so their stiffness does not affect the patch test. This stiffness is
//! the energy of bending and twisting of a block with the edges of the element, which a fully integrated element would
//! have without locking.

use super::brick;
use super::material::Material;
use super::mesh::CORNERS;
use super::tetra::{Tetrahedra, cross};
use super::yields::Yield;

/// The formulation of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Formulation {
    /// One mean strain, with stiffness against hourglass patterns: exact for linear fields, no volumetric locking, long
    /// steps.
    #[default]
    MeanStrain,
    /// Two overlays of five tetrahedra of constant strain; their volumetric strain is averaged over the overlay (Marti
    /// and Cundall 1982). A step costs about twice as much.
    MixedDiscretisation,
}

/// The element of a shape and a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    pub volume: f64,
    /// Edges along x, y, z \[m\], if the element is a brick.
    pub edges: Option<[f64; 3]>,
    /// Mean gradient: axis, corner \[1/m\].
    pub gradient: [[f64; 8]; 3],
    /// Hourglass patterns: pattern, corner.
    pub patterns: [[f64; 8]; 4],
    /// Modulus of each pattern for each axis of displacement \[Pa/m²\].
    pub moduli: [[f64; 3]; 4],
    /// Mass of each corner \[kg\].
    pub masses: [f64; 8],
    /// Lamé's constants \[Pa\].
    pub lambda: f64,
    pub mu: f64,
    pub yields: Option<Yield>,
    /// Used instead of the mean strain.
    pub tetrahedra: Option<Box<Tetrahedra>>,
}

impl Shape {
    /// The element with eight corners \[m\]; the error is the volume of an element that is turned inside out.
    pub fn new(corners: &[[f64; 3]; 8], material: &Material, formulation: Formulation) -> Result<Shape, f64> {
        let mut shape = Shape {
            volume: 0.0,
            edges: brick::edges(corners),
            gradient: [[0.0; 8]; 3],
            patterns: [[0.0; 8]; 4],
            moduli: [[0.0; 3]; 4],
            masses: [0.0; 8],
            lambda: material.lame().0,
            mu: material.lame().1,
            yields: material.strength.map(|strength| Yield::new(&strength, material.lame().0, material.lame().1)),
            tetrahedra: None,
        };
        let point = 1.0 / 3f64.sqrt();
        for at in CORNERS.map(|c| c.map(|x| x * point)) {
            let Point { jacobian, shares, slopes } = Point::new(corners, at);
            if jacobian.is_nan() || jacobian <= 0.0 {
                return Err(jacobian * 8.0);
            }
            shape.volume += jacobian;
            for corner in 0..8 {
                shape.masses[corner] += material.density * shares[corner] * jacobian;
                (0..3).for_each(|axis| shape.gradient[axis][corner] += slopes[corner][axis]);
            }
        }
        let volume = shape.volume;
        shape.gradient.iter_mut().flatten().for_each(|b| *b /= volume);
        shape.add_patterns(corners);
        if formulation == Formulation::MixedDiscretisation {
            shape.tetrahedra = Some(Box::new(Tetrahedra::new(corners)?));
        }
        Ok(shape)
    }

    fn add_patterns(&mut self, corners: &[[f64; 3]; 8]) {
        let products = |c: &[f64; 3]| [c[1] * c[2], c[2] * c[0], c[0] * c[1], c[0] * c[1] * c[2]];
        for (pattern, values) in self.patterns.iter_mut().enumerate() {
            let h = CORNERS.map(|c| products(&c)[pattern]);
            let along = [0, 1, 2].map(|axis| (0..8).map(|c| h[c] * corners[c][axis]).sum::<f64>());
            for (corner, value) in values.iter_mut().enumerate() {
                let linear: f64 = (0..3).map(|axis| along[axis] * self.gradient[axis][corner]).sum();
                *value = (h[corner] - linear) / 8.0;
            }
        }
        // 4 / h² of a block with edges h: Σ b² = 1 / (2 h²)
        let stretch = self.gradient.map(|b| 8.0 * b.iter().map(|b| b * b).sum::<f64>());
        let poisson = self.lambda / (2.0 * (self.lambda + self.mu));
        let bending = 2.0 * self.mu / (1.0 - poisson);
        for axis in 0..3 {
            let (other, third) = ((axis + 1) % 3, (axis + 2) % 3);
            // u_x = q ξη bends: strain q η 2/h, mean square 1/3; the shear of this displacement is the locking of a
            // full element
            self.moduli[other][axis] = bending * stretch[axis] / 3.0;
            self.moduli[third][axis] = bending * stretch[axis] / 3.0;
            // u_x = q ηζ twists; two of three such displacements make one twist, which halves the energy of each
            self.moduli[axis][axis] = self.mu * (stretch[other] + stretch[third]) / 6.0;
            self.moduli[3][axis] = bending * stretch[axis] / 9.0;
        }
    }
}

/// A point of an element: the determinant of its Jacobian, the shape functions there, and the determinant times their
/// gradients.
struct Point {
    jacobian: f64,
    shares: [f64; 8],
    slopes: [[f64; 3]; 8],
}

impl Point {
    fn new(corners: &[[f64; 3]; 8], place: [f64; 3]) -> Point {
        let factor = |c: &[f64; 3], axis: usize| 0.5 * (1.0 + c[axis] * place[axis]);
        let slope = |c: &[f64; 3], k: usize| 0.5 * c[k] * factor(c, (k + 1) % 3) * factor(c, (k + 2) % 3);
        let local = CORNERS.map(|c| [0, 1, 2].map(|k| slope(&c, k)));
        // derivatives of the position along ξ, η, ζ
        let along = |k: usize| [0, 1, 2].map(|axis| (0..8).map(|c| local[c][k] * corners[c][axis]).sum::<f64>());
        let [x, y, z] = [0, 1, 2].map(along);
        let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
        let global = |local: [f64; 3]| [0, 1, 2].map(|axis| (0..3).map(|k| cofactors[k][axis] * local[k]).sum());
        Point {
            jacobian: (0..3).map(|axis| x[axis] * cofactors[0][axis]).sum(),
            shares: CORNERS.map(|c| factor(&c, 0) * factor(&c, 1) * factor(&c, 2)),
            slopes: local.map(global),
        }
    }
}
