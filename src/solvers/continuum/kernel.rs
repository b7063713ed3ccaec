//! Forces of eight elements of one shape from the displacements of their corners.

// loops run over axes of several arrays at once
#![allow(clippy::needless_range_loop)]

use super::brick;
use super::lanes::{Lanes, Number};
use super::shape::Shape;
use super::tensor::{COMPONENT, Corners, Patterns, Tensor, symmetric};
use super::tetra::{TETRAHEDRA, Tetrahedra};

/// Adds the forces of linear elements on their corners, and returns their strain energy \[J\].
#[inline(always)]
pub fn elastic(shape: &Shape, u: &Corners, force: &mut Corners) -> Lanes {
    match (&shape.tetrahedra, &shape.edges) {
        (None, Some(edges)) => {
            let (of_bricks, energy) = elastic_bricks(shape, edges, u);
            add(&of_bricks, force);
            energy
        }
        (None, None) => {
            let (strain, amplitudes) = deformation(shape, u);
            let stress = stress(shape, &strain);
            let resistance = resistance(shape, &amplitudes);
            spread(shape, &stress, &resistance, force);
            (work(&stress, &strain) + pattern_work(&resistance, &amplitudes)) * (0.5 * shape.volume)
        }
        (Some(tetrahedra), _) => {
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

/// Forces of linear bricks on their corners, and their strain energy \[J\].
#[inline(always)]
pub fn elastic_bricks<N: Number>(shape: &Shape, edges: &[f64; 3], u: &Corners<N>) -> (Corners<N>, N) {
    let (strain, amplitudes) = brick::deformation(edges, u);
    let stress = stress(shape, &strain);
    let resistance = resistance(shape, &amplitudes);
    let force = brick::spread(edges, shape.volume, &stress, &resistance);
    (force, (work(&stress, &strain) + pattern_work(&resistance, &amplitudes)) * (0.5 * shape.volume))
}

#[inline(always)]
fn add(forces: &Corners, sum: &mut Corners) {
    for axis in 0..3 {
        for corner in 0..8 {
            sum[axis][corner] += forces[axis][corner];
        }
    }
}

#[inline(always)]
pub fn stress<N: Number>(shape: &Shape, strain: &Tensor<N>) -> Tensor<N> {
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
pub fn work<N: Number>(stress: &Tensor<N>, strain: &Tensor<N>) -> N {
    let normal = stress[0] * strain[0] + stress[1] * strain[1] + stress[2] * strain[2];
    let shear = stress[3] * strain[3] + stress[4] * strain[4] + stress[5] * strain[5];
    normal + shear * 2.0
}

#[inline(always)]
fn pattern_work<N: Number>(resistance: &Patterns<N>, amplitudes: &Patterns<N>) -> N {
    let bending = product(&resistance[0], &amplitudes[0]) + product(&resistance[1], &amplitudes[1]);
    bending + (product(&resistance[2], &amplitudes[2]) + product(&resistance[3], &amplitudes[3]))
}

#[inline(always)]
fn product<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The mean strain of elements, and the amplitudes of their hourglass patterns.
#[inline(always)]
pub fn deformation(shape: &Shape, u: &Corners) -> (Tensor, Patterns) {
    match &shape.edges {
        Some(edges) => brick::deformation(edges, u),
        None => (mean_strain(shape, u), amplitudes(shape, u)),
    }
}

#[inline(always)]
fn mean_strain(shape: &Shape, u: &Corners) -> Tensor {
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
fn amplitudes(shape: &Shape, u: &Corners) -> Patterns {
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
pub fn resistance<N: Number>(shape: &Shape, amplitudes: &Patterns<N>) -> Patterns<N> {
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
    if let Some(edges) = &shape.edges {
        return add(&brick::spread(edges, shape.volume, stress, resistance), force);
    }
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
