//! A vehicle: a linear multibody system of any size on any number of wheels, over one rail.
//!
//! ```text
//! M y'' + C y' + K y = weight - Σ F_w e_w,    δ_w = y_w - (rail and its irregularity under the wheel)
//! ```
//!
//! M is diagonal, F_w is the force of wheel w on the rail and e_w selects the unknown that moves the wheel.
//! Displacements are positive down, rotations as seen in the direction of travel, so a train has the same matrices in
//! both directions.

use super::error::{TrackError, TrackParameter};
use nalgebra::DMatrix;

/// A linear vehicle, as carried by one rail.
#[derive(Debug, Clone, PartialEq)]
pub struct Multibody {
    /// Diagonal of the mass matrix, kg or kg m^2, per unknown.
    pub masses: Vec<f64>,
    /// Symmetric, N/m, N and N m.
    pub stiffness: DMatrix<f64>,
    /// Symmetric, N s/m, N s and N m s.
    pub damping: DMatrix<f64>,
    /// Mass on which gravity acts along each unknown, kg; 0 for a rotation.
    pub weighing: Vec<f64>,
    /// Per unknown, N down: constant forces besides gravity; 0 for a rotation.
    pub forces: Vec<f64>,
    /// In any order.
    pub wheels: Vec<Wheel>,
}

/// A wheel of a [`Multibody`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheel {
    /// The unknown that moves the wheel; none for a given force.
    pub unknown: Option<usize>,
    /// Distance behind the first wheel, m.
    pub offset: f64,
    pub contact: WheelContact,
}

/// How a wheel presses on the rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WheelContact {
    /// `F = C max(0, δ)^1.5` with C in N/m^1.5: a wheel lifts off and is never pulled.
    Hertz(f64),
    /// `F = k δ + c δ'` (N/m, N s/m), in both directions: a wheel that cannot lift off.
    Linear { stiffness: f64, damping: f64 },
    /// A given force, N down, independent of the rail.
    Given(f64),
}

impl Multibody {
    /// A mass (kg) on a spring (N/m) and damper (N s/m) that end on the rail itself: one unknown, one wheel.
    pub fn sprung_mass(mass: f64, stiffness: f64, damping: f64) -> Self {
        Self {
            masses: vec![mass],
            stiffness: DMatrix::zeros(1, 1),
            damping: DMatrix::zeros(1, 1),
            weighing: vec![mass],
            forces: vec![0.0],
            wheels: vec![Wheel { unknown: Some(0), offset: 0.0, contact: WheelContact::Linear { stiffness, damping } }],
        }
    }

    /// A mass (kg) on a spring (N/m) and damper (N s/m) on a wheel (kg): two unknowns, one wheel.
    pub fn sprung_wheel(mass: f64, stiffness: f64, damping: f64, wheel_mass: f64, contact: WheelContact) -> Self {
        let pair = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
        Self {
            masses: vec![mass, wheel_mass],
            stiffness: &pair * stiffness,
            damping: &pair * damping,
            weighing: vec![mass, wheel_mass],
            forces: vec![0.0; 2],
            wheels: vec![Wheel { unknown: Some(1), offset: 0.0, contact }],
        }
    }

    /// A moving force (N down): no unknown, one wheel.
    pub fn moving_force(force: f64) -> Self {
        Self {
            masses: Vec::new(),
            stiffness: DMatrix::zeros(0, 0),
            damping: DMatrix::zeros(0, 0),
            weighing: Vec::new(),
            forces: Vec::new(),
            wheels: vec![Wheel { unknown: None, offset: 0.0, contact: WheelContact::Given(force) }],
        }
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.masses.len()
    }

    /// The constant forces on the unknowns, N.
    pub(super) fn weight(&self, gravity: f64) -> Vec<f64> {
        self.weighing.iter().zip(&self.forces).map(|(mass, force)| gravity * mass + force).collect()
    }

    /// Wheels whose force depends on the motion.
    pub(super) fn carrying_wheels(&self) -> usize {
        self.wheels.iter().filter(|w| w.unknown.is_some()).count()
    }

    /// The mean static force of the wheels whose force is not given, N; 0 if there are no such wheels.
    pub(super) fn wheel_load(&self, gravity: f64) -> f64 {
        self.weight(gravity).iter().sum::<f64>() / self.carrying_wheels().max(1) as f64
    }

    pub(super) fn check(&self) -> Result<(), TrackError> {
        let fail = |name, value, expected| Err(TrackError::Parameter { name, value, expected });
        let order = self.order();
        for (name, length) in [
            ("rows of a vehicle's stiffness", self.stiffness.nrows()),
            ("columns of a vehicle's stiffness", self.stiffness.ncols()),
            ("rows of a vehicle's damping", self.damping.nrows()),
            ("columns of a vehicle's damping", self.damping.ncols()),
            ("weighing masses of a vehicle", self.weighing.len()),
            ("forces on a vehicle", self.forces.len()),
        ] {
            if length != order {
                return fail(TrackParameter::Vehicle(name), length as f64, "one per unknown");
            }
        }
        // Written so that a value that is not a number fails.
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        for value in self.masses.iter().chain(&self.weighing) {
            if !not_negative(*value) {
                return fail(TrackParameter::Vehicle("mass of a vehicle"), *value, "of 0 or more");
            }
        }
        if let Some(value) = self.forces.iter().find(|f| !f.is_finite()) {
            return fail(TrackParameter::Vehicle("force on a vehicle"), *value, "a finite number");
        }
        for (name, matrix) in [("stiffness of a vehicle", &self.stiffness), ("damping of a vehicle", &self.damping)] {
            let largest = matrix.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            for i in 0..order {
                for j in 0..=i {
                    let value = matrix[(i, j)];
                    let same = (value - matrix[(j, i)]).abs() <= 1e-12 * largest;
                    if !(value.is_finite() && same) {
                        return fail(TrackParameter::Vehicle(name), value, "finite and symmetric");
                    }
                }
                if !not_negative(matrix[(i, i)]) {
                    return fail(TrackParameter::Vehicle(name), matrix[(i, i)], "of 0 or more along each unknown");
                }
            }
        }
        if self.wheels.is_empty() {
            return fail(TrackParameter::Vehicle("wheels of a vehicle"), 0.0, "of 1 or more");
        }
        self.wheels.iter().try_for_each(|wheel| wheel.check(order))
    }
}

impl Wheel {
    fn check(&self, order: usize) -> Result<(), TrackError> {
        let fail = |name, value, expected| Err(TrackError::Parameter { name, value, expected });
        if !(self.offset >= 0.0 && self.offset.is_finite()) {
            return fail(TrackParameter::Wheel("offset of a wheel"), self.offset, "of 0 or more");
        }
        let above = |value: f64| value > 0.0 && value.is_finite();
        match self.contact {
            WheelContact::Hertz(constant) if !above(constant) => {
                return fail(TrackParameter::Wheel("Hertz constant of a wheel"), constant, "above 0");
            }
            WheelContact::Linear { stiffness, .. } if !above(stiffness) => {
                return fail(TrackParameter::Wheel("contact stiffness of a wheel"), stiffness, "above 0");
            }
            WheelContact::Linear { damping, .. } if !(damping >= 0.0 && damping.is_finite()) => {
                return fail(TrackParameter::Wheel("contact damping of a wheel"), damping, "of 0 or more");
            }
            WheelContact::Given(force) if !force.is_finite() => {
                return fail(TrackParameter::Wheel("force of a wheel"), force, "a finite number");
            }
            _ => {}
        }
        match (self.unknown, self.contact) {
            (Some(unknown), WheelContact::Given(_)) => {
                fail(TrackParameter::Wheel("unknown of a wheel"), unknown as f64, "to be absent if the force is given")
            }
            (Some(unknown), _) if unknown >= order => {
                fail(TrackParameter::Wheel("unknown of a wheel"), unknown as f64, "below the number of unknowns")
            }
            (None, WheelContact::Hertz(_) | WheelContact::Linear { .. }) => {
                fail(TrackParameter::Wheel("unknowns of a wheel"), 0.0, "of 1 if the force is not given")
            }
            _ => Ok(()),
        }
    }
}
