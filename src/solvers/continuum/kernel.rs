//! Forces of eight elements of one shape from the displacements of their corners.

// loops run over axes of several arrays at once
#![allow(clippy::needless_range_loop)]

use super::lanes::Lanes;
use super::shape::{Corners, Shape};
use super::tetra::{TETRAHEDRA, Tetrahedra};

/// Components xx, yy, zz, xy, yz, zx of a symmetric tensor; shear strains are tensor components, half of the shear
/// angle.
pub type Tensor = [Lanes; 6];

/// Amplitude or force of each hourglass pattern along each axis.
pub type Patterns = [[Lanes; 3]; 4];

/// Tensor component of two axes.
pub const COMPONENT: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];

/// Adds the forces of linear elements on their corners, and returns their strain energy \[J\].
#[inline(always)]
pub fn elastic(shape: &Shape, u: &Corners, force: &mut Corners) -> Lanes {
    match &shape.tetrahedra {
        None => {
            let strain = mean_strain(shape, u);
            let amplitudes = amplitudes(shape, u);
            let stress = stress(shape, &strain);
            let resistance = resistance(shape, &amplitudes);
            spread(shape, &stress, &resistance, force);
            (work(&stress, &strain) + pattern_work(&resistance, &amplitudes)) * (0.5 * shape.volume)
        }
        Some(tetrahedra) => {
            let mut energy = Lanes::ZERO;
            for overlay in 0..2 {
                let strains = tetrahedra.strains(u, overlay);
                for (i, strain) in strains.iter().enumerate() {
                    let stress = stress(shape, strain);
                    tetrahedra.spread(5 * overlay + i, &stress, force);
                    energy += work(&stress, strain) * (0.25 * tetrahedra.volumes[5 * overlay + i]);
                }
            }
            energy
        }
    }
}

#[inline(always)]
pub fn stress(shape: &Shape, strain: &Tensor) -> Tensor {
    let pressure = (strain[0] + strain[1] + strain[2]) * shape.lambda;
    let double = 2.0 * shape.mu;
    [
        pressure + strain[0] * double,
        pressure + strain[1] * double,
        pressure + strain[2] * double,
        strain[3] * double,
        strain[4] * double,
        strain[5] * double,
    ]
}

/// Double contraction of a stress and a strain.
#[inline(always)]
pub fn work(stress: &Tensor, strain: &Tensor) -> Lanes {
    let normal = stress[0] * strain[0] + stress[1] * strain[1] + stress[2] * strain[2];
    let shear = stress[3] * strain[3] + stress[4] * strain[4] + stress[5] * strain[5];
    normal + shear * 2.0
}

#[inline(always)]
pub fn pattern_work(resistance: &Patterns, amplitudes: &Patterns) -> Lanes {
    let mut sum = Lanes::ZERO;
    for pattern in 0..4 {
        for axis in 0..3 {
            sum += resistance[pattern][axis] * amplitudes[pattern][axis];
        }
    }
    sum
}

#[inline(always)]
pub fn mean_strain(shape: &Shape, u: &Corners) -> Tensor {
    let mut slope = [[Lanes::ZERO; 3]; 3];
    for axis in 0..3 {
        for along in 0..3 {
            for corner in 0..8 {
                slope[axis][along].add_scaled(shape.gradient[along][corner], u[axis][corner]);
            }
        }
    }
    symmetric(&slope)
}

#[inline(always)]
fn symmetric(slope: &[[Lanes; 3]; 3]) -> Tensor {
    [
        slope[0][0],
        slope[1][1],
        slope[2][2],
        (slope[0][1] + slope[1][0]) * 0.5,
        (slope[1][2] + slope[2][1]) * 0.5,
        (slope[2][0] + slope[0][2]) * 0.5,
    ]
}

#[inline(always)]
pub fn amplitudes(shape: &Shape, u: &Corners) -> Patterns {
    let mut found = [[Lanes::ZERO; 3]; 4];
    for pattern in 0..4 {
        for axis in 0..3 {
            for corner in 0..8 {
                found[pattern][axis].add_scaled(shape.patterns[pattern][corner], u[axis][corner]);
            }
        }
    }
    found
}

#[inline(always)]
pub fn resistance(shape: &Shape, amplitudes: &Patterns) -> Patterns {
    let mut found = *amplitudes;
    for pattern in 0..4 {
        for axis in 0..3 {
            found[pattern][axis] = amplitudes[pattern][axis] * shape.moduli[pattern][axis];
        }
    }
    found
}

/// Adds the corner forces of a mean stress and of the hourglass resistances.
#[inline(always)]
pub fn spread(shape: &Shape, stress: &Tensor, resistance: &Patterns, force: &mut Corners) {
    for axis in 0..3 {
        for corner in 0..8 {
            let mut sum = Lanes::ZERO;
            for along in 0..3 {
                sum.add_scaled(shape.gradient[along][corner], stress[COMPONENT[axis][along]]);
            }
            for pattern in 0..4 {
                sum.add_scaled(shape.patterns[pattern][corner], resistance[pattern][axis]);
            }
            force[axis][corner].add_scaled(-shape.volume, sum);
        }
    }
}

impl Tetrahedra {
    /// Strains of the five tetrahedra of an overlay, with the volumetric part of their mean.
    #[inline(always)]
    pub fn strains(&self, u: &Corners, overlay: usize) -> [Tensor; 5] {
        let mut strains = [[Lanes::ZERO; 6]; 5];
        let (mut mean, mut volume) = (Lanes::ZERO, 0.0);
        for i in 0..5 {
            let at = 5 * overlay + i;
            let mut slope = [[Lanes::ZERO; 3]; 3];
            for axis in 0..3 {
                for along in 0..3 {
                    for end in 0..4 {
                        slope[axis][along].add_scaled(self.gradients[at][along][end], u[axis][TETRAHEDRA[at][end]]);
                    }
                }
            }
            strains[i] = symmetric(&slope);
            mean.add_scaled(self.volumes[at], trace(&strains[i]));
            volume += self.volumes[at];
        }
        replace_traces(&mut strains, mean * (1.0 / volume));
        strains
    }

    /// Sets the mean pressure of an overlay in all its stresses.
    #[inline(always)]
    pub fn share_pressure(&self, overlay: usize, stresses: &mut [Tensor; 5]) {
        let (mut mean, mut volume) = (Lanes::ZERO, 0.0);
        for i in 0..5 {
            mean.add_scaled(self.volumes[5 * overlay + i], trace(&stresses[i]));
            volume += self.volumes[5 * overlay + i];
        }
        replace_traces(stresses, mean * (1.0 / volume));
    }

    /// Adds the corner forces of the stress of a tetrahedron; overlays count half.
    #[inline(always)]
    pub fn spread(&self, at: usize, stress: &Tensor, force: &mut Corners) {
        for axis in 0..3 {
            for end in 0..4 {
                let mut sum = Lanes::ZERO;
                for along in 0..3 {
                    sum.add_scaled(self.gradients[at][along][end], stress[COMPONENT[axis][along]]);
                }
                force[axis][TETRAHEDRA[at][end]].add_scaled(-0.5 * self.volumes[at], sum);
            }
        }
    }
}

#[inline(always)]
fn trace(tensor: &Tensor) -> Lanes {
    tensor[0] + tensor[1] + tensor[2]
}

#[inline(always)]
fn replace_traces(tensors: &mut [Tensor; 5], wanted: Lanes) {
    for tensor in tensors {
        let change = (wanted - trace(tensor)) * (1.0 / 3.0);
        for axis in 0..3 {
            tensor[axis] += change;
        }
    }
}
