//! Grain sizes from a sieve curve: the number of grains of each size in a required solid volume.
//!
//! A curve gives the share of the mass finer than a size; grains are drawn by number. With u the share of the mass,
//! d(u) the size and v(d) = π d³/6 the volume of a grain, a unit of solid volume holds
//!
//! ```text
//! n(u) = ∫₀ᵘ du' / v(d(u'))
//! ```
//!
//! grains finer than d(u). A volume V has N = V n(1) grains, and the k-th grain is drawn from the middle half of the
//! k-th of N equal strata by number. So each size has as many whole grains as possible: the resulting curve differs
//! from the required curve by about half of the mass share of the largest grain, the smallest difference that whole
//! grains allow. Sizes drawn without strata differ by the root of the number of grains.
//!
//! Every class has its own closed form: between two sieves u is linear in ln d, so that n is an exponential of ln d.

use super::Random;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;

/// Largest number of grains; larger beds cannot be run in practice.
const MOST_GRAINS: f64 = 2e7;

/// Share of the modelled mass by size: from 0 at the finest grain to 1 at the coarsest, linear in the logarithm of the
/// size in between. Two points of equal size are a jump: many grains of this size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Size, m, and share of the modelled mass that is finer.
    points: Vec<[f64; 2]>,
    /// Share of the whole mass that is modelled.
    modelled: f64,
}

/// Why points do not form a curve, or a curve gives no sample.
#[derive(Debug, Clone, PartialEq)]
pub enum GradingError {
    /// A size (m) that is not a finite number above 0.
    Size { size: f64 },
    /// Sizes or shares that do not ascend, from this point on.
    Falls { point: usize },
    /// All points have the same share: there is no mass between them.
    Empty,
    /// A solid volume (m³) that is not a finite number above 0.
    Volume { volume: f64 },
    /// The volume holds less than one grain of the mean size.
    NoGrain { volume: f64, mean: f64 },
    /// More grains than can be modelled.
    TooMany { grains: f64, finest: f64 },
}

/// Grains of a curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Diameters of the spheres of equal volume, m, in random order: the first thousand follow the curve as well.
    pub sizes: Vec<f64>,
    /// The required curve.
    pub curve: Curve,
    /// Solid volume of all grains, m³: within half a mean grain of the required volume.
    pub volume: f64,
}

/// The mass between two sieves, required and reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Class {
    /// Finest and coarsest size, m.
    pub sizes: [f64; 2],
    /// Share of the modelled mass.
    pub asked: f64,
    pub reached: f64,
    pub grains: usize,
}

impl Curve {
    /// Whether it has the points of a curve; points may be missing in a curve read from a file.
    pub(in super::super) fn is_whole(&self) -> bool {
        self.points.len() >= 2
    }

    /// A curve through points (size in m, share of the mass that passes). Sizes and shares ascend; equal values are
    /// allowed. Grains below the first and above the last point are not modelled.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, GradingError> {
        for (point, [size, share]) in points.iter().enumerate() {
            if !(*size > 0.0 && size.is_finite()) {
                return Err(GradingError::Size { size: *size });
            }
            let before = point.checked_sub(1).map_or([0.0, 0.0], |before| points[before]);
            if !(before[0] <= *size && before[1] <= *share && *share <= 1.0 + 1e-9) {
                return Err(GradingError::Falls { point });
            }
        }
        let (first, last) = (points.first().map_or(0.0, |p| p[1]), points.last().map_or(0.0, |p| p[1]));
        let modelled = last - first;
        if modelled <= 0.0 {
            return Err(GradingError::Empty);
        }
        let mut points: Vec<[f64; 2]> =
            points.iter().map(|[size, share]| [*size, (share - first) / modelled]).collect();
        // level ends hold no grains
        let start = points.iter().rposition(|p| p[1] <= 0.0).unwrap_or(0);
        let end = points.iter().position(|p| p[1] >= 1.0).unwrap_or(points.len() - 1);
        points.truncate(end + 1);
        points.drain(..start);
        Ok(Self { points, modelled })
    }

    /// Grains of one size, m.
    pub fn single(size: f64) -> Result<Self, GradingError> {
        Self::new(&[[size, 0.0], [size, 1.0]])
    }

    /// Size, m, and share of the modelled mass that is finer.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Share of the whole mass that is modelled; the rest is cut off.
    pub fn modelled(&self) -> f64 {
        self.modelled
    }

    /// Sizes of the finest and of the coarsest grain, m.
    pub fn ends(&self) -> [f64; 2] {
        [self.points[0][0], self.points[self.points.len() - 1][0]]
    }

    /// Share of the modelled mass in grains finer than a size, m; at a jump, the value below the jump.
    pub fn below(&self, size: f64) -> f64 {
        let after = self.points.partition_point(|p| p[0] < size);
        match (after.checked_sub(1).map(|i| self.points[i]), self.points.get(after)) {
            (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (size / a[0]).ln() / (b[0] / a[0]).ln(),
            (Some(_), None) => 1.0,
            (None, _) => 0.0,
        }
    }

    /// Mean volume of a grain, m³: 1 / n(1).
    pub fn mean_volume(&self) -> f64 {
        1.0 / self.classes().map(|class| class.number()).sum::<f64>()
    }

    /// Mean size by surface (Sauter), m: the size with the same surface per volume as all grains together.
    pub fn surface_mean(&self) -> f64 {
        let [surface, volume] = [2.0, 3.0].map(|power| self.classes().map(|class| class.moment(power)).sum::<f64>());
        volume / surface
    }

    /// Solid share of a dense random packing of frictionless spheres of this curve (Desmond and Weeks 2014, eq. 3):
    /// from mean, scatter and skewness of the sizes by number.
    pub fn solid_share(&self) -> f64 {
        let moment = |power: f64| self.classes().map(|class| class.moment(power)).sum::<f64>();
        let number = moment(0.0);
        let [mean, second, third] = [1.0, 2.0, 3.0].map(|power| moment(power) / number);
        let variance = (second - mean * mean).max(0.0);
        let scatter = variance.sqrt() / mean;
        // third central moment divided by variance and mean: skewness times scatter
        let skewed =
            if scatter > 1e-6 { (third - 3.0 * mean * variance - mean.powi(3)) / (variance * mean) } else { 0.0 };
        0.634 + 0.0658 * scatter + 0.0857 * skewed * scatter
    }

    /// Whole grains whose volumes sum to `volume` (m³); the same seed gives the same grains.
    pub fn sample(&self, volume: f64, seed: u64) -> Result<Sample, GradingError> {
        if !(volume > 0.0 && volume.is_finite()) {
            return Err(GradingError::Volume { volume });
        }
        let mean = self.mean_volume();
        let count = (volume / mean).round();
        if count < 1.0 {
            return Err(GradingError::NoGrain { volume, mean });
        }
        if count > MOST_GRAINS {
            return Err(GradingError::TooMany { grains: count, finest: self.ends()[0] });
        }
        let mut random = Random::new(seed, SIZES);
        let mut classes = self.classes().peekable();
        // number of grains finer than the present class, in a unit of solid volume
        let mut finer = 0.0;
        let mut sizes = Vec::with_capacity(count as usize);
        for k in 0..count as usize {
            let wanted = (k as f64 + random.between(0.25, 0.75)) / (count * mean);
            while let Some(class) = classes.next_if(|class| finer + class.number() < wanted) {
                finer += class.number();
            }
            sizes.push(classes.peek().map_or(self.ends()[1], |class| class.size(wanted - finer)));
        }
        random.shuffle(&mut sizes);
        let volume = sizes.iter().map(|size| ball(*size)).sum();
        Ok(Sample { sizes, curve: self.clone(), volume })
    }

    /// Pieces of the curve with a mass above 0, finest first.
    fn classes(&self) -> impl Iterator<Item = Piece> {
        let piece = |pair: &[[f64; 2]]| Piece {
            finest: pair[0][0],
            widths: (pair[1][0] / pair[0][0]).ln(),
            mass: pair[1][1] - pair[0][1],
        };
        self.points.windows(2).map(piece).filter(|piece| piece.mass > 0.0)
    }
}

/// Number of the random stream for sizes.
const SIZES: u64 = 1;

/// A part of the curve between two points.
struct Piece {
    /// m.
    finest: f64,
    /// ln(coarsest / finest); 0 for a jump.
    widths: f64,
    /// Share of the modelled mass.
    mass: f64,
}

impl Piece {
    /// Grains in a unit of solid volume of the whole curve.
    fn number(&self) -> f64 {
        self.moment(0.0)
    }

    /// Sum of d^p over these grains: with w the width, f the finest size and v its volume, m f^p / v ∫₀¹ exp((p - 3) w
    /// s) ds.
    fn moment(&self, power: f64) -> f64 {
        let w = (3.0 - power) * self.widths;
        let mean = if w > 0.0 { -(-w).exp_m1() / w } else { 1.0 };
        self.mass / ball(self.finest) * self.finest.powf(power) * mean
    }

    /// Size (m) up to which there are `number` grains in this class: the inverse of the same integral.
    fn size(&self, number: f64) -> f64 {
        let w = 3.0 * self.widths;
        let part = number * ball(self.finest) / self.mass;
        let s = if w > 0.0 { -(-part * w).max(-1.0).ln_1p() / w } else { 0.0 };
        self.finest * (self.widths * s.clamp(0.0, 1.0)).exp()
    }
}

impl Sample {
    /// Share of the grains' mass that is finer than a size, m.
    pub fn below(&self, size: f64) -> f64 {
        self.sizes.iter().filter(|d| **d < size).map(|d| ball(*d)).sum::<f64>() / self.volume
    }

    /// Largest difference between the required and the reached curve, as a share of the mass (after Kolmogorov).
    pub fn error(&self) -> f64 {
        let mut sizes = self.sizes.clone();
        sizes.sort_unstable_by(f64::total_cmp);
        let (mut error, mut finer) = (0.0f64, 0.0);
        for same in sizes.chunk_by(|a, b| a == b) {
            let asked = [self.curve.below(same[0]), self.curve.below(same[0].next_up())];
            let with = finer + same.iter().map(|size| ball(*size)).sum::<f64>() / self.volume;
            error = error.max((asked[0] - finer).abs()).max((asked[1] - with).abs());
            finer = with;
        }
        error
    }

    /// Classes between the points of the curve. A class with mass but without a grain is too narrow for the volume.
    pub fn classes(&self) -> Vec<Class> {
        let points = &self.curve.points;
        let class = |pair: &[[f64; 2]]| {
            let last = pair[1][0] == self.curve.ends()[1];
            let holds = |size: &&f64| pair[0][0] <= **size && (**size < pair[1][0] || (last && **size <= pair[1][0]));
            let within: Vec<f64> = self.sizes.iter().filter(holds).map(|size| ball(*size)).collect();
            Class {
                sizes: [pair[0][0], pair[1][0]],
                asked: pair[1][1] - pair[0][1],
                reached: within.iter().sum::<f64>() / self.volume,
                grains: within.len(),
            }
        };
        points.windows(2).map(class).collect()
    }
}

/// Volume of a ball, m³, from its diameter, m.
fn ball(diameter: f64) -> f64 {
    PI / 6.0 * diameter.powi(3)
}

impl fmt::Display for GradingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GradingError::Size { size } => write!(f, "expected a grain size above 0 m, found {size} m"),
            GradingError::Falls { point } => {
                write!(f, "sizes and shares (from 0 to 1) must ascend, but they do not ascend at point {point}")
            }
            GradingError::Empty => {
                write!(f, "the grading curve holds no mass because its first and last shares are equal")
            }
            GradingError::Volume { volume } => write!(f, "expected a solid volume above 0 m3, found {volume} m3"),
            GradingError::NoGrain { volume, mean } => {
                write!(
                    f,
                    "a volume of {:.3e} m3 is too small for this grading; its mean grain has {:.3e} m3",
                    volume, mean
                )
            }
            GradingError::TooMany { grains, finest } => write!(
                f,
                "the grading has {grains:.1e} grains in this volume, too many; remove the sizes below a limit above {:.3} mm",
                1e3 * finest
            ),
        }
    }
}

impl std::error::Error for GradingError {}
