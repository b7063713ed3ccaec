//! A specimen: a bed in a box with four sides that move under a constant pressure, as in a triaxial cell.
//!
//! Stress and strain are values of the box: lengths between its walls, and forces on the walls divided by their areas,
//! positive in compression. The vertical stress is the mean of plate and floor, so that half of the weight of the
//! grains counts, as at half the height. Strains are measured from the end of consolidation, relative to the lengths at
//! that time.

use super::super::bed::Bed;
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::super::listen::unless_stopped;
use super::super::motion::WallMotion;
use super::super::rest::{Criterion, Look, Waiting, until_rest};
use super::super::stride::Stride;
use super::super::walls::WallId;
use super::calm::{AT_REST, calmed, restless};
use super::error::{Resting, RigError, in_cycle};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Largest speed of the sides, m/s; and the gain of their servos, the usual gain: with a lower gain they lag behind a
/// dilating specimen.
const SPEED: f64 = 0.1;
const GAIN: f64 = 0.5;
/// End of consolidation: the pressure of a side may differ from its target by 2 %.
const CONSOLIDATED: Criterion = Criterion { missed: 0.02, ..AT_REST };

/// The moving walls, and their pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Specimen {
    pub floor: WallId,
    /// Along, across: the lower and the upper wall of each.
    pub sides: [[WallId; 2]; 2],
    /// Pa.
    pub pressure: f64,
}

/// Lengths of a specimen, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Size {
    /// Along, across.
    pub plan: [f64; 2],
    pub height: f64,
}

/// A specimen at an instant of a recorded cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpecimenState {
    pub cycle: u64,
    /// Elapsed share of the cycle, 0 .. 1.
    pub phase: f64,
    /// Shortening divided by height, loss of volume divided by volume.
    pub axial_strain: f64,
    pub volume_strain: f64,
    /// Pa.
    pub axial_stress: f64,
    /// Mean over the four sides, Pa.
    pub lateral_stress: f64,
}

impl SpecimenState {
    /// Pa.
    pub fn deviator(&self) -> f64 {
        self.axial_stress - self.lateral_stress
    }

    /// Mobilised angle of friction, by Mohr's circle through the origin: sin phi = (s1 - s3)/(s1 + s3), rad.
    pub fn mobilised_friction(&self) -> f64 {
        (self.deviator() / (self.axial_stress + self.lateral_stress)).asin()
    }
}

impl Size {
    pub fn area(&self) -> f64 {
        self.plan[0] * self.plan[1]
    }

    fn volume(&self) -> f64 {
        self.area() * self.height
    }
}

impl Specimen {
    /// Size of the specimen under a plate with its lower face at `height`, m.
    pub(super) fn size<R: Real>(&self, bed: &Bed<R>, height: f64) -> Size {
        let plan = [0, 1].map(|axis| {
            let [low, high] = self.sides[axis].map(|side| bed.wall(side).pose(bed.domain()).position[axis]);
            high - low
        });
        Size { plan, height }
    }

    /// Applies the pressure to the sides, for their present areas.
    pub(super) fn hold<R: Real>(&self, bed: &mut Bed<R>, size: &Size) {
        for (axis, side, outward) in self.each() {
            let force = self.pressure * area_of_side(size, axis);
            bed.set_motion(side, WallMotion::Servo { axis: outward, force, speed_limit: SPEED, gain: GAIN });
        }
    }

    /// Runs until forces are in balance and the pressures of sides and plate are at their targets. `push` sets the
    /// force of the plate, N.
    pub(super) fn consolidate<R: Real>(
        &self,
        bed: &mut Bed<R>,
        plate: WallId,
        face: f64,
        push: impl FnMut(&mut Bed<R>, f64),
        tell: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Size, RigError> {
        let level = |bed: &Bed<R>| bed.wall(plate).pose(bed.domain()).position.z - face;
        calmed(bed, |bed, stride| {
            let (start, size) = (bed.time(), self.size(bed, level(bed)));
            let mut waiting = Consolidation { specimen: self, bed, plate, level, size, stride, push, tell };
            until_rest(&mut waiting, &CONSOLIDATED, start)?;
            Ok(self.size(waiting.bed, level(waiting.bed)))
        })
    }

    /// Readings of the specimen, relative to its size `rest`.
    pub(super) fn state<R: Real>(&self, bed: &Bed<R>, plate: WallId, face: f64, rest: &Size) -> SpecimenState {
        let plate = bed.wall(plate);
        let size = self.size(bed, plate.pose(bed.domain()).position.z - face);
        let vertical = 0.5 * (plate.felt().force.z - bed.wall(self.floor).felt().force.z);
        SpecimenState {
            cycle: 0,
            phase: 0.0,
            axial_strain: 1.0 - size.height / rest.height,
            volume_strain: 1.0 - size.volume() / rest.volume(),
            axial_stress: vertical / size.area(),
            lateral_stress: self.pressures(bed, &size).into_iter().sum::<f64>() / 4.0,
        }
    }

    /// Pressure on each side, Pa.
    fn pressures<R: Real>(&self, bed: &Bed<R>, size: &Size) -> [f64; 4] {
        self.each().map(|(axis, side, outward)| bed.wall(side).felt().force.dot(&outward) / area_of_side(size, axis))
    }

    /// Axis, wall, and outward direction.
    fn each(&self) -> [(usize, WallId, Vector3<f64>); 4] {
        let [[west, east], [near, far]] = self.sides;
        let (x, y) = (Vector3::x(), Vector3::y());
        [(0, west, -x), (0, east, x), (1, near, -y), (1, far, y)]
    }
}

/// Area of a side perpendicular to an axis, m2.
fn area_of_side(size: &Size, axis: usize) -> f64 {
    size.plan[1 - axis] * size.height
}

/// A specimen before it is at rest under the pressure on its sides.
struct Consolidation<'s, R: Real, L, P, T> {
    specimen: &'s Specimen,
    bed: &'s mut Bed<R>,
    plate: WallId,
    /// Returns the level of the lower face of the plate, m.
    level: L,
    /// Size of the specimen before the last steps.
    size: Size,
    stride: Stride,
    push: P,
    tell: T,
}

impl<R: Real, L: Fn(&Bed<R>) -> f64, P: FnMut(&mut Bed<R>, f64), T: FnMut(f64) -> ControlFlow<()>> Waiting<R>
    for Consolidation<'_, R, L, P, T>
{
    type Error = RigError;

    fn bed(&mut self) -> &mut Bed<R> {
        self.bed
    }

    fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        self.size = self.specimen.size(self.bed, (self.level)(self.bed));
        self.specimen.hold(self.bed, &self.size);
        (self.push)(self.bed, self.specimen.pressure * self.size.area());
        self.stride.run_steps(self.bed, &[self.plate], steps)
    }

    fn missed(&self) -> f64 {
        let pressure = self.specimen.pressure;
        let axial = self.bed.wall(self.plate).felt().force.z / self.size.area();
        let sides = self.specimen.pressures(self.bed, &self.size).into_iter().map(|p| (p / pressure - 1.0).abs());
        sides.fold((axial / pressure - 1.0).abs(), f64::max)
    }

    fn hear(&mut self, look: &Look) -> Result<(), RigError> {
        unless_stopped((self.tell)((look.time / CONSOLIDATED.longest).min(1.0)), RigError::Stopped)
    }

    fn restless(&self, look: &Look) -> RigError {
        restless(Resting::Specimen, CONSOLIDATED.unbalance, look)
    }

    fn failed(&self, failure: Failure) -> RigError {
        in_cycle(0)(failure)
    }
}
