//! Forces of eight elements that may yield, and their memory.
//!
//! An element stores its plastic strain; stress follows from the elastic part of the strain. Hourglass patterns of a
//! yielding element flow with it: their resistance is reduced by the same factor as the stress, so that it stays
//! bounded when the soil fails.

// loops run over axes of several arrays at once
#![allow(clippy::needless_range_loop)]

use super::kernel::{deformation, resistance, spread, stress, work};
use super::lanes::{LANES, Lanes};
use super::shape::Shape;
use super::tensor::{Corners, Patterns, Tensor};
use super::yields::Yield;
use serde::{Deserialize, Serialize};

/// Memory of eight elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// One point for the mean strain, ten for tetrahedra.
    pub points: Vec<Point>,
    /// Plastic part of the amplitudes of hourglass patterns, and their resistance in the last step.
    pattern_flow: Patterns,
    resistance: Patterns,
}

/// Plastic strain, and the stress in the last step \[Pa\].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Point {
    pub flow: Tensor,
    pub stress: Tensor,
}

/// Strain energy, and energy lost to flow since the last step \[J\].
#[derive(Clone, Copy)]
pub struct Work {
    pub strain: Lanes,
    pub lost: Lanes,
}

impl Memory {
    pub fn new(shape: &Shape) -> Memory {
        let points = if shape.tetrahedra.is_some() { 10 } else { 1 };
        let zeros = [[Lanes::ZERO; 3]; 4];
        Memory { points: vec![Point::default(); points], pattern_flow: zeros, resistance: zeros }
    }

    /// Adds the forces of elements on their corners, and updates the memory.
    #[inline(always)]
    pub fn pull(&mut self, shape: &Shape, yields: &Yield, u: &Corners, force: &mut Corners) -> Work {
        match &shape.tetrahedra {
            None => self.pull_mean(shape, yields, u, force),
            Some(_) => self.pull_tetrahedra(shape, yields, u, force),
        }
    }

    #[inline(always)]
    fn pull_mean(&mut self, shape: &Shape, yields: &Yield, u: &Corners, force: &mut Corners) -> Work {
        let (strain, amplitudes) = deformation(shape, u);
        let point = &mut self.points[0];
        let trial = stress(shape, &less(&strain, &point.flow));
        let (corrected, kept) = correct(yields, &trial);
        let before = *point;
        point.stress = corrected;
        flow_where(yields, &strain, point, &kept);
        let elastic = less_patterns(&amplitudes, &self.pattern_flow);
        let mut held = resistance(shape, &elastic);
        let mut lost = lost(&before, point);
        let mut pattern_strain = Lanes::ZERO;
        for pattern in 0..4 {
            for axis in 0..3 {
                let full = elastic[pattern][axis];
                let share = full * kept;
                held[pattern][axis] = held[pattern][axis] * kept;
                let flows = full - share;
                lost += (held[pattern][axis] + self.resistance[pattern][axis]) * flows * 0.5;
                self.pattern_flow[pattern][axis] += flows;
                pattern_strain += held[pattern][axis] * share;
            }
        }
        self.resistance = held;
        spread(shape, &point.stress, &held, force);
        let strain = work(&point.stress, &less(&strain, &point.flow)) + pattern_strain;
        Work { strain: strain * (0.5 * shape.volume), lost: lost * shape.volume }
    }

    #[inline(always)]
    fn pull_tetrahedra(&mut self, shape: &Shape, yields: &Yield, u: &Corners, force: &mut Corners) -> Work {
        let mut sum = Work { strain: Lanes::ZERO, lost: Lanes::ZERO };
        let Some(tetrahedra) = &shape.tetrahedra else { return sum };
        for overlay in 0..2 {
            let strains = tetrahedra.strains(u, overlay);
            let points = &mut self.points[5 * overlay..5 * overlay + 5];
            let (mut stresses, mut kept) = ([[Lanes::ZERO; 6]; 5], Lanes([1.0; LANES]));
            for i in 0..5 {
                let trial = stress(shape, &less(&strains[i], &points[i].flow));
                let (corrected, share) = correct(yields, &trial);
                stresses[i] = corrected;
                for l in 0..LANES {
                    kept.0[l] = kept.0[l].min(share.0[l]);
                }
            }
            // if one tetrahedron yields, its effect on the pressure is shared by the whole overlay
            let mut shared = stresses;
            tetrahedra.share_pressure(overlay, &mut shared);
            for i in 0..5 {
                for (component, shared) in stresses[i].iter_mut().zip(&shared[i]) {
                    for l in 0..LANES {
                        component.0[l] = if kept.0[l] < 1.0 { shared.0[l] } else { component.0[l] };
                    }
                }
                let before = points[i];
                points[i].stress = stresses[i];
                flow_where(yields, &strains[i], &mut points[i], &kept);
                tetrahedra.spread(5 * overlay + i, &stresses[i], force);
                let volume = tetrahedra.volumes[5 * overlay + i];
                sum.strain += work(&stresses[i], &less(&strains[i], &points[i].flow)) * (0.25 * volume);
                sum.lost += lost(&before, &points[i]) * (0.5 * volume);
            }
        }
        sum
    }

    /// Mean stress of the elements in the last step.
    pub fn mean_stress(&self, shape: &Shape) -> Tensor {
        let Some(tetrahedra) = &shape.tetrahedra else { return self.points[0].stress };
        let mut sum = [Lanes::ZERO; 6];
        let whole: f64 = tetrahedra.volumes.iter().sum();
        for (point, volume) in self.points.iter().zip(tetrahedra.volumes) {
            for (sum, component) in sum.iter_mut().zip(point.stress) {
                sum.add_scaled(volume / whole, component);
            }
        }
        sum
    }
}

/// Stresses allowed by the strength, and the share of the stress that is kept: 1 without yielding.
#[inline(always)]
fn correct(yields: &Yield, trial: &Tensor) -> (Tensor, Lanes) {
    let (mut corrected, mut kept) = (*trial, Lanes([1.0; LANES]));
    for l in 0..LANES {
        let lane = [trial[0].0[l], trial[1].0[l], trial[2].0[l], trial[3].0[l], trial[4].0[l], trial[5].0[l]];
        if let Some(stress) = yields.correct(&lane) {
            for component in 0..6 {
                corrected[component].0[l] = stress[component];
            }
            kept.0[l] = share(&stress, &lane);
        }
    }
    (corrected, kept)
}

/// Remaining share of a stress: the smaller of the shares of the stress and of its deviator.
fn share(stress: &[f64; 6], trial: &[f64; 6]) -> f64 {
    let size = |s: &[f64; 6], mean: f64| {
        let normal: f64 = s[..3].iter().map(|s| (s - mean).powi(2)).sum();
        (normal + 2.0 * s[3..].iter().map(|s| s * s).sum::<f64>()).sqrt()
    };
    let mean = |s: &[f64; 6]| (s[0] + s[1] + s[2]) / 3.0;
    let ratio = |left: f64, of: f64| if of > 0.0 { left / of } else { 1.0 };
    let whole = ratio(size(stress, 0.0), size(trial, 0.0));
    let deviator = ratio(size(stress, mean(stress)), size(trial, mean(trial)));
    // at most just below 1, because the element yields
    whole.min(deviator).min(1.0 - f64::EPSILON)
}

/// Plastic strain of the yielding lanes: strain minus the elastic strain of the stress.
#[inline(always)]
fn flow_where(yields: &Yield, strain: &Tensor, point: &mut Point, kept: &Lanes) {
    for l in 0..LANES {
        if kept.0[l] < 1.0 {
            let s = &point.stress;
            let elastic = yields.strain(&[s[0].0[l], s[1].0[l], s[2].0[l], s[3].0[l], s[4].0[l], s[5].0[l]]);
            for component in 0..6 {
                point.flow[component].0[l] = strain[component].0[l] - elastic[component];
            }
        }
    }
}

#[inline(always)]
fn less(a: &Tensor, b: &Tensor) -> Tensor {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3], a[4] - b[4], a[5] - b[5]]
}

#[inline(always)]
fn less_patterns(a: &Patterns, b: &Patterns) -> Patterns {
    let mut left = *a;
    for pattern in 0..4 {
        for axis in 0..3 {
            left[pattern][axis] = a[pattern][axis] - b[pattern][axis];
        }
    }
    left
}

/// Work of the mean stress of two steps on the flow between them, per volume.
#[inline(always)]
fn lost(before: &Point, after: &Point) -> Lanes {
    let mut mean = before.stress;
    for component in 0..6 {
        mean[component] = (before.stress[component] + after.stress[component]) * 0.5;
    }
    work(&mean, &less(&after.flow, &before.flow))
}
