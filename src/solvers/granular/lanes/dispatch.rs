//! The two precisions, and the lanes of each on this machine.

use super::plain::Plain;
#[cfg(target_arch = "x86_64")]
use super::x86;
use super::{Real, Work};
use crate::solvers::granular::record::{Compact, Full};

impl Real for f32 {
    type Record = Compact;
    const NAME: &'static str = "mixed";

    #[inline(always)]
    fn from_f64(value: f64) -> f32 {
        value as f32
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn fma(self, factor: f32, summand: f32) -> f32 {
        self.mul_add(factor, summand)
    }

    #[inline(always)]
    fn dispatch<W: Work<f32>>(work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(lanes) = x86::Wide::detect() {
                return lanes.enter(work, lanes);
            }
            if let Some(lanes) = x86::Middle::detect() {
                return lanes.enter(work, lanes);
            }
        }
        work.run(Plain::<f32, 4>::new())
    }
}

impl Real for f64 {
    type Record = Full;
    const NAME: &'static str = "f64";

    #[inline(always)]
    fn from_f64(value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn fma(self, factor: f64, summand: f64) -> f64 {
        self.mul_add(factor, summand)
    }

    #[inline(always)]
    fn dispatch<W: Work<f64>>(work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        if let Some(lanes) = x86::Middle::detect() {
            // the reference is plain code; only its fused products need the instructions
            return lanes.enter(work, Plain::<f64, 4>::new());
        }
        work.run(Plain::<f64, 4>::new())
    }
}
