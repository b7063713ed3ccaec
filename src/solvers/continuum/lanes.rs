//! Eight numbers side by side: one number for each of eight elements.
//!
//! Plain loops over plain arrays, which the compiler turns into the vector instructions of the calling function. No
//! closures: their bodies might be compiled outside it. No fused operations either, so that every machine gives the
//! same bits.

use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul, Sub};

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
