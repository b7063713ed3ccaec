//! Soils shared by several tests.

use super::super::{Element, Formulation, Material, Mesh, Settings, Side, Soil, Support};

pub const FORMULATIONS: [Formulation; 2] = [Formulation::MeanStrain, Formulation::MixedDiscretisation];

/// The subgrade of the paper, 519 m/s and 300 m/s.
pub const SUBGRADE: Material = Material { density: 2100.0, youngs_modulus: 472e6, poisson_ratio: 0.25, strength: None };

/// Lines with equal spaces between 0 and a length \[m\].
pub fn lines(length: f64, spaces: usize) -> Vec<f64> {
    (0..=spaces).map(|i| length * i as f64 / spaces as f64).collect()
}

/// A box of one material.
pub fn block(lengths: [f64; 3], spaces: [usize; 3], material: Material) -> Mesh {
    let [x, y, z] = [0, 1, 2].map(|axis| lines(lengths[axis], spaces[axis]));
    Mesh::grid([&x, &y, &z], vec![material], |_, _, _| Some(0)).unwrap()
}

pub fn soil(mesh: Mesh, formulation: Formulation, gravity: f64) -> Soil {
    Soil::new(mesh, Settings { formulation, gravity: [0.0, 0.0, -gravity], ..Settings::default() }).unwrap()
}

pub fn support(soil: &mut Soil, sides: &[Side], support: Support) {
    sides.iter().for_each(|&side| soil.support(side, support).unwrap());
}

pub const WALLS: [Side; 4] = [Side::XMin, Side::XMax, Side::YMin, Side::YMax];

/// Numbers from -1 to 1 that are the same in every run.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / 2f64.powi(30) - 1.0
    }
}

/// A box with its inner nodes moved by up to a share of the spacing, so that all elements are differently distorted
/// hexahedra.
pub fn distorted(spaces: usize, share: f64) -> Mesh {
    let even = block([1.0; 3], [spaces; 3], SUBGRADE);
    let mut numbers = Numbers(7);
    let mut nodes = even.nodes().to_vec();
    for x in nodes.iter_mut().flatten() {
        // nodes of a side stay in its plane
        if *x > 1e-9 && *x < 1.0 - 1e-9 {
            *x += share / spaces as f64 * numbers.next();
        }
    }
    let elements: Vec<Element> = even.elements().to_vec();
    Mesh::new(nodes, elements, even.materials().to_vec()).unwrap()
}
