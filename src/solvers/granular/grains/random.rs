//! Random numbers that are the same in every run (Steele, Lea and Flood 2014, `splitmix64`).

use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A stream of random numbers, determined by its seed alone.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Stream `number` of a seed, independent of the other streams of the same seed.
    pub fn new(seed: u64, number: u64) -> Self {
        Self(mixed(mixed(seed) ^ number))
    }

    fn bits(&mut self) -> u64 {
        let out = mixed(self.0);
        self.0 = self.0.wrapping_add(STEP);
        out
    }

    /// Uniform from 0 to below 1.
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Uniform on the unit sphere: the height is uniform (Archimedes).
    pub fn direction(&mut self) -> Vector3<f64> {
        let (z, turn) = (self.between(-1.0, 1.0), TAU * self.share());
        let across = (1.0 - z * z).sqrt();
        Vector3::new(across * turn.cos(), across * turn.sin(), z)
    }

    /// Puts items into random order (Fisher and Yates).
    pub fn shuffle<T>(&mut self, things: &mut [T]) {
        for last in (1..things.len()).rev() {
            let other = (self.share() * (last + 1) as f64) as usize;
            things.swap(last, other);
        }
    }
}

const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

fn mixed(number: u64) -> u64 {
    let z = number.wrapping_add(STEP);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
