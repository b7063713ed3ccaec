//! Eight numbers side by side: one number for each of eight elements.
//!
//! Plain loops over plain arrays, which the compiler turns into the vector instructions of the calling function. No
//! closures: their bodies might be compiled outside it. No fused operations either, so that every machine gives the
//! same bits.

use pulp::Simd;
use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul, Sub};

/// Some numbers side by side.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
}

impl Number for Lanes {}

/// The numbers that the machine computes at once. In long formulas of [`Lanes`] the compiler does not find the vectors;
/// these it cannot miss.
#[derive(Debug, Clone, Copy)]
pub struct Vector<S: Simd> {
    simd: S,
    numbers: S::f64s,
}

impl<S: Simd> Number for Vector<S> {}

impl<S: Simd> Vector<S> {
    /// The first numbers of a slice.
    #[inline(always)]
    pub fn load(simd: S, from: &[f64]) -> Vector<S> {
        Vector { simd, numbers: S::as_simd_f64s(from).0[0] }
    }

    /// Adds to the first numbers of a slice.
    #[inline(always)]
    pub fn add_to(self, sums: &mut [f64]) {
        let sum = &mut S::as_mut_simd_f64s(sums).0[0];
        *sum = self.simd.add_f64s(*sum, self.numbers);
    }
}

impl<S: Simd> Add for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Vector { numbers: self.simd.add_f64s(self.numbers, other.numbers), ..self }
    }
}

impl<S: Simd> Sub for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Vector { numbers: self.simd.sub_f64s(self.numbers, other.numbers), ..self }
    }
}

impl<S: Simd> Mul for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Vector { numbers: self.simd.mul_f64s(self.numbers, other.numbers), ..self }
    }
}

impl<S: Simd> Mul<f64> for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Vector { numbers: self.simd.mul_f64s(self.numbers, self.simd.splat_f64s(factor)), ..self }
    }
}

/// Elements that are computed together.
pub const LANES: usize = 8;

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    pub const ZERO: Lanes = Lanes([0.0; LANES]);

    /// Adds a number times the lanes.
    #[inline(always)]
    pub fn add_scaled(&mut self, factor: f64, x: Lanes) {
        for l in 0..LANES {
            self.0[l] += factor * x.0[l];
        }
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(mut self, other: Lanes) -> Lanes {
        self += other;
        self
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Lanes) {
        for l in 0..LANES {
            self.0[l] += other.0[l];
        }
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn sub(mut self, other: Lanes) -> Lanes {
        for l in 0..LANES {
            self.0[l] -= other.0[l];
        }
        self
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(mut self, other: Lanes) -> Lanes {
        for l in 0..LANES {
            self.0[l] *= other.0[l];
        }
        self
    }
}

impl Mul<f64> for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(mut self, factor: f64) -> Lanes {
        for l in 0..LANES {
            self.0[l] *= factor;
        }
        self
    }
}
