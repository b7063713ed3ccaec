//! The stiffness of a bed under a rigid plate that is loaded, unloaded and loaded again.
//!
//! This is the plate load test of DIN 18134 on grains: pressure increases and decreases in steps, and each step ends
//! when forces are in balance. The test works on a copy; the bed itself does not change. The plate does not tilt.

mod error;
#[cfg(test)]
mod tests;

pub use error::ProbeError;

use super::bed::Bed;
use super::failure::Failure;
use super::lanes::Real;
use super::motion::{Pose, WallMotion};
use super::rest::{Criterion, Look, Waiting, until_rest};
use super::shape::{Mesh, Shape};
use super::stride::{Sharing, Stride};
use super::vector::Vec3;
use super::walls::WallId;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Number of sides of the polygon that replaces a circle; its area is the area of the circle.
const SIDES: u32 = 48;
/// Half the height of a plate: grains beside it never reach its top, m.
const HALF_HEIGHT: f64 = 0.5;

/// The outline of a plate, in plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Outline {
    /// Along x and y, m.
    Rectangle { length: f64, width: f64 },
    /// m.
    Circle { radius: f64 },
    /// The whole bed, with this plan area in m2.
    Whole { area: f64 },
}

/// The plate on a bed, and its load.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plate {
    pub outline: Outline,
    /// Place of its middle in plan, m.
    pub centre: [f64; 2],
    /// Largest pressure, Pa.
    pub pressure: f64,
    /// Surface of the plate: a surface of the bed.
    pub surface: u16,
    pub rest: Stillness,
}

/// Limits at which a pressure step ends, and at which a test fails.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stillness {
    /// Limit of the mean force out of balance divided by the mean acting force.
    pub unbalance: f64,
    /// Tolerance of the pressure of a step, as a share of the largest pressure.
    pub pressure: f64,
    /// Longest time of a step, s.
    pub longest: f64,
    /// Settlement at which the plate counts as sunk, m.
    pub deepest: f64,
}

impl Default for Stillness {
    fn default() -> Self {
        Stillness { unbalance: 2e-3, pressure: 0.01, longest: 1.5, deepest: 0.05 }
    }
}

/// Share of the largest pressure at which the plate counts as seated: in DIN 18134 the seating pressure is 10 kPa.
pub const SEAT: f64 = 0.05;
/// Pressures of the test divided by the largest pressure: first loading, unloading, second loading, unloading.
const STEPS: [f64; 12] = [SEAT, 0.25, 0.5, 0.75, 1.0, 0.5, SEAT, 0.25, 0.5, 0.75, 1.0, SEAT];
/// Indices of the seating before both full pressures, and of the full pressures, among these steps.
const FIRST: [usize; 2] = [0, 4];
const AGAIN: [usize; 2] = [6, 10];
/// Number of steps done when the bed is at rest under the first full pressure.
pub const FULL: usize = FIRST[1] + 1;

/// Local damping of the copy: only the states of rest matter, not the time to reach them.
const LOCAL_DAMPING: f64 = 0.7;
/// Largest speed of the plate, m/s; and the gain of its servo, as for the plate of the packing.
const SPEED: f64 = 0.02;
const GAIN: f64 = 0.2;
/// Additional inertia during the test, divided by all mass: states of rest do not depend on it.
const ADDED: f64 = 0.2;
/// Steps between checks, and number of checks in a row that must find rest.
const LOOK: u64 = 200;
const CALM: usize = 2;

/// A step of the test at its end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LoadPoint {
    /// Pa.
    #[serde(rename = "pressure_Pa")]
    pub pressure: f64,
    /// Settlement from the seated position, m; downwards.
    #[serde(rename = "settlement_m")]
    pub settlement: f64,
}

/// The result of a plate load test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stiffness {
    /// m2.
    pub area: f64,
    /// One point per step.
    pub curve: Vec<LoadPoint>,
    /// Force divided by settlement from the seat to the full pressure, first and second loading, N/m.
    pub first: f64,
    pub again: f64,
    /// Deformation moduli of both loadings for a half-space, Ev1 and Ev2, Pa; `None` for a plate as large as the bed.
    pub moduli: Option<[f64; 2]>,
}

impl Outline {
    /// m2.
    pub fn area(&self) -> f64 {
        match self {
            Outline::Rectangle { length, width } => length * width,
            Outline::Circle { radius } => PI * radius * radius,
            Outline::Whole { area } => *area,
        }
    }

    /// Modulus, Pa, of a half-space that carries a rigid plate with `stiffness`, N/m; `None` for a plate without an
    /// edge.
    ///
    /// For a circle it is `E = 1.5 r Δσ/Δs` (DIN 18134): Boussinesq's `(1 - ν²) F/(2 r s)` with `1 - ν² = 3/π`. A
    /// rectangle with half sides a >= b has `F/s = E a/(1 - ν²) (0.73 + 1.54 (b/a)^0.75)` (Gazetas 1991, Foundation
    /// Engineering Handbook, Table 15.1), with the same ν: 1.5 % less than the exact value for a square.
    pub fn modulus(&self, stiffness: f64) -> Option<f64> {
        const POISSON: f64 = 3.0 / PI;
        match self {
            Outline::Whole { .. } => None,
            Outline::Circle { radius } => Some(POISSON * stiffness / (2.0 * radius)),
            Outline::Rectangle { length, width } => {
                let (a, b) = (0.5 * length.max(*width), 0.5 * length.min(*width));
                Some(POISSON * stiffness / (a * (0.73 + 1.54 * (b / a).powf(0.75))))
            }
        }
    }

    /// Along x and y, m; 0 for the whole bed.
    pub fn sides(&self) -> [f64; 2] {
        match *self {
            Outline::Rectangle { length, width } => [length, width],
            Outline::Circle { radius } => [2.0 * radius; 2],
            Outline::Whole { .. } => [0.0; 2],
        }
    }

    /// The solid, and the distance of its lower face below its origin, m.
    fn shape(&self) -> Result<(Shape, f64), ProbeError> {
        match *self {
            Outline::Whole { .. } => Ok((Shape::Plane { normal: Vector3::new(0.0, 0.0, -1.0) }, 0.0)),
            Outline::Rectangle { length, width } => {
                let half = Vector3::new(0.5 * length, 0.5 * width, HALF_HEIGHT);
                Ok((Shape::block(half).map_err(|_| ProbeError::Plate)?, HALF_HEIGHT))
            }
            Outline::Circle { radius } => {
                // the polygon has the area of the circle
                let angle = 2.0 * PI / f64::from(SIDES);
                let corner = radius * (angle / angle.sin()).sqrt();
                let mesh = Mesh::cylinder(corner, 2.0 * HALF_HEIGHT, SIDES).map_err(|_| ProbeError::Plate)?;
                Ok((Shape::Mesh(mesh), HALF_HEIGHT))
            }
        }
    }

    /// Whether a sphere at this distance from the middle is at least partly under the plate.
    fn covers(&self, [x, y]: [f64; 2], radius: f64) -> bool {
        match self {
            Outline::Whole { .. } => true,
            Outline::Circle { radius: reach } => x.hypot(y) < reach + radius,
            Outline::Rectangle { length, width } => x.abs() < 0.5 * length + radius && y.abs() < 0.5 * width + radius,
        }
    }
}

/// Presses a plate on a copy of the bed. `look` receives the copy at the end of each step, with the number of steps
/// done and the number of all steps.
pub fn probe<R: Real>(
    bed: &Bed<R>,
    plate: &Plate,
    mut look: impl FnMut(&mut Bed<R>, usize, usize),
) -> Result<Stiffness, ProbeError> {
    plate.check(bed)?;
    let mut test = Test::new(bed.clone(), plate)?;
    let mut curve: Vec<LoadPoint> = Vec::new();
    for (number, share) in STEPS.iter().enumerate() {
        let seat = curve.first().map(|_| test.seat);
        let point = test.until_rest(share * plate.pressure, seat)?;
        if seat.is_none() {
            test.seat = test.level();
        }
        curve.push(point);
        look(&mut test.bed, number + 1, STEPS.len());
    }
    let area = plate.outline.area();
    let secant = |[from, to]: [usize; 2]| {
        let (from, to) = (curve[from], curve[to]);
        area * (to.pressure - from.pressure) / (to.settlement - from.settlement)
    };
    let (first, again) = (secant(FIRST), secant(AGAIN));
    if !(first > 0.0 && again > 0.0 && first.is_finite() && again.is_finite()) {
        return Err(ProbeError::NoSettlement);
    }
    let moduli = plate.outline.modulus(first).zip(plate.outline.modulus(again)).map(|(first, again)| [first, again]);
    Ok(Stiffness { area, curve, first, again, moduli })
}

impl Plate {
    fn check<R: Real>(&self, bed: &Bed<R>) -> Result<(), ProbeError> {
        let area = self.outline.area();
        let fine = area.is_finite() && area > 0.0 && self.pressure.is_finite() && self.pressure > 0.0;
        let known = usize::from(self.surface) < bed.laws().surfaces();
        if !(fine && known && self.centre.iter().all(|c| c.is_finite())) {
            return Err(ProbeError::Plate);
        }
        let (sides, periods) = (self.outline.sides(), [0, 1].map(|axis| bed.domain().period(axis)));
        let largest = bed.pebbles().map(|pebble| pebble.radius).fold(0.0, f64::max);
        for (side, period) in sides.into_iter().zip(periods) {
            // otherwise a grain would touch the plate and its image
            if let Some(period) = period.filter(|period| side + 2.0 * largest > *period) {
                return Err(ProbeError::WidePlate { side, period });
            }
        }
        Ok(())
    }
}

/// A bed under its plate.
struct Test<'a, R: Real> {
    bed: Bed<R>,
    plate: &'a Plate,
    wall: WallId,
    /// Distance from the origin of the plate down to its lower face, m.
    depth: f64,
    /// Level at which the plate was seated, m.
    seat: f64,
    stride: Stride,
}

impl<'a, R: Real> Test<'a, R> {
    fn new(mut bed: Bed<R>, plate: &'a Plate) -> Result<Self, ProbeError> {
        let top = top_under(&bed, plate).ok_or(ProbeError::Nothing)?;
        let (shape, depth) = plate.outline.shape()?;
        let [x, y] = plate.centre;
        let pose = Pose { position: Vector3::new(x, y, top + depth), ..Pose::default() };
        let wall = bed.add_wall(shape, pose, plate.surface, WallMotion::Fixed);
        bed.set_damping(LOCAL_DAMPING);
        let stride = Stride::with_added(&mut bed, Sharing::Even, ADDED).map_err(ProbeError::Failure)?;
        Ok(Test { bed, plate, wall, depth, seat: top, stride })
    }

    /// Level of the lower face, m.
    fn level(&self) -> f64 {
        self.bed.wall(self.wall).pose(self.bed.domain()).position.z - self.depth
    }

    fn pressure(&self) -> f64 {
        self.bed.wall(self.wall).felt().force.z / self.plate.outline.area()
    }

    /// Presses with `target` (Pa) until forces are in balance.
    fn until_rest(&mut self, target: f64, seat: Option<f64>) -> Result<LoadPoint, ProbeError> {
        let Stillness { unbalance, pressure: missed, longest, .. } = self.plate.rest;
        let criterion = Criterion { unbalance, missed, every: LOOK, looks: CALM, longest, look_first: false };
        let axis = Vector3::new(0.0, 0.0, 1.0);
        let force = target * self.plate.outline.area();
        self.bed.set_motion(self.wall, WallMotion::Servo { axis, force, speed_limit: SPEED, gain: GAIN });
        let (start, from) = (self.bed.time(), seat.unwrap_or(self.seat));
        until_rest(&mut Step { test: self, target, from }, &criterion, start)?;
        let settlement = if seat.is_some() { from - self.level() } else { 0.0 };
        Ok(LoadPoint { pressure: self.pressure(), settlement })
    }
}

/// A pressure step in progress.
struct Step<'s, 'a, R: Real> {
    test: &'s mut Test<'a, R>,
    /// Pa.
    target: f64,
    /// Level from which settlement is measured, m.
    from: f64,
}

impl<R: Real> Waiting<R> for Step<'_, '_, R> {
    type Error = ProbeError;

    fn bed(&mut self) -> &mut Bed<R> {
        &mut self.test.bed
    }

    fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        self.test.stride.run_steps(&mut self.test.bed, &[], steps)
    }

    fn missed(&self) -> f64 {
        (self.test.pressure() - self.target).abs() / self.test.plate.pressure
    }

    fn worth_waiting(&self, _: &Look) -> Result<(), ProbeError> {
        let (pressure, settlement) = (self.test.pressure(), self.from - self.test.level());
        if settlement > self.test.plate.rest.deepest {
            return Err(ProbeError::Sunk { pressure, settlement, target: self.test.plate.pressure });
        }
        Ok(())
    }

    fn restless(&self, look: &Look) -> ProbeError {
        let Plate { pressure: target, rest: Stillness { unbalance: limit, longest: time, .. }, .. } = *self.test.plate;
        ProbeError::Restless { pressure: self.test.pressure(), target, unbalance: look.unbalance, limit, time }
    }

    fn failed(&self, failure: Failure) -> ProbeError {
        ProbeError::Failure(failure)
    }
}

/// Highest point of the grains under the plate, m.
fn top_under<R: Real>(bed: &Bed<R>, plate: &Plate) -> Option<f64> {
    let away = |axis: usize, place: &Vec3| {
        let way = place[axis] - plate.centre[axis];
        bed.domain().period(axis).map_or(way, |period| way - period * (way / period).round())
    };
    let tops = bed.pebbles().filter(|p| plate.outline.covers([away(0, &p.place), away(1, &p.place)], p.radius));
    tops.map(|pebble| pebble.place[2] + pebble.radius).reduce(f64::max)
}
