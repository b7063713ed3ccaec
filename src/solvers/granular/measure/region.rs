//! Measurement regions: a box or a sphere, and the part of a sphere inside.

use super::ball;
use std::f64::consts::PI;
use std::fmt;

/// Centre (m) and radius (m) of a sphere.
pub type Ball = ([f64; 3], f64);

/// A box along the axes, or a measurement sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region(pub(super) RegionShape);

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RegionShape {
    Block { lower: [f64; 3], upper: [f64; 3] },
    Ball { centre: [f64; 3], radius: f64 },
}

/// A region without volume, or with a size that is not a finite number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoRegion;

impl fmt::Display for NoRegion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected a region with a volume above 0 m3")
    }
}

impl std::error::Error for NoRegion {}

impl Region {
    /// The box between two corners, m.
    pub fn block(lower: [f64; 3], upper: [f64; 3]) -> Result<Self, NoRegion> {
        Self(RegionShape::Block { lower, upper }).checked()
    }

    /// The sphere about `centre` (m) of `radius` (m).
    pub fn sphere(centre: [f64; 3], radius: f64) -> Result<Self, NoRegion> {
        Self(RegionShape::Ball { centre, radius }).checked()
    }

    fn checked(self) -> Result<Self, NoRegion> {
        let sound = match self.0 {
            RegionShape::Block { lower, upper } => (0..3).all(|k| lower[k] < upper[k]),
            RegionShape::Ball { centre, radius } => radius > 0.0 && centre.iter().all(|c| c.is_finite()),
        };
        if sound && self.volume().is_normal() { Ok(self) } else { Err(NoRegion) }
    }

    /// m³.
    pub fn volume(&self) -> f64 {
        match self.0 {
            RegionShape::Block { lower, upper } => (0..3).map(|k| upper[k] - lower[k]).product(),
            RegionShape::Ball { radius, .. } => 4.0 / 3.0 * PI * radius * radius * radius,
        }
    }

    /// Whether a point lies inside. A box contains its lower faces and not its upper faces, so of boxes that fill a
    /// space exactly one contains the point.
    pub fn holds(&self, point: &[f64; 3]) -> bool {
        match self.0 {
            RegionShape::Block { lower, upper } => (0..3).all(|k| lower[k] <= point[k] && point[k] < upper[k]),
            RegionShape::Ball { centre, radius } => ball::distance(&centre, point) <= radius,
        }
    }

    /// Its lowest and highest corner, m.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        match self.0 {
            RegionShape::Block { lower, upper } => [lower, upper],
            RegionShape::Ball { centre, radius } => [centre.map(|c| c - radius), centre.map(|c| c + radius)],
        }
    }

    /// Volume of a sphere inside the region, m³, in closed form; the error is about 1e-14 of the sphere.
    pub fn share_of_sphere(&self, (centre, radius): Ball) -> f64 {
        match self.0 {
            RegionShape::Block { lower, upper } => {
                let scale = |corner: [f64; 3]| std::array::from_fn(|k| (corner[k] - centre[k]) / radius);
                radius * radius * radius * ball::unit_ball_in_box(&scale(lower), &scale(upper))
            }
            RegionShape::Ball { centre: middle, radius: reach } => {
                ball::ball_in_ball(radius, reach, ball::distance(&centre, &middle))
            }
        }
    }

    /// Porosity, from the volumes (m³) of bodies inside the region. Overlaps of bodies at their contacts count twice,
    /// as in their masses.
    pub fn porosity(&self, shares: impl IntoIterator<Item = f64>) -> f64 {
        1.0 - shares.into_iter().sum::<f64>() / self.volume()
    }

    pub(super) fn holds_ball(&self, (centre, radius): &Ball) -> bool {
        match &self.0 {
            RegionShape::Block { lower, upper } => {
                (0..3).all(|k| lower[k] <= centre[k] - radius && centre[k] + radius <= upper[k])
            }
            RegionShape::Ball { centre: middle, radius: reach } => ball::distance(centre, middle) + radius <= *reach,
        }
    }

    /// Whether a ball surely misses the region; false does not exclude that a ball near an edge of a box misses it.
    pub(super) fn misses_ball(&self, (centre, radius): &Ball) -> bool {
        match &self.0 {
            RegionShape::Block { lower, upper } => {
                (0..3).any(|k| centre[k] + radius <= lower[k] || upper[k] <= centre[k] - radius)
            }
            RegionShape::Ball { centre: middle, radius: reach } => ball::distance(centre, middle) >= reach + radius,
        }
    }
}
