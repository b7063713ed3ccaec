//! The data sheet of a vehicle on two bogies: ten rigid-body unknowns over one rail: bounce and pitch of the car body
//! and of the two bogies, and four wheels.

use super::{Multibody, Wheel, WheelContact};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// A vehicle on two bogies of two axles each, as carried by **one rail**: half of every mass, inertia and stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Vehicle {
    /// kg.
    pub car_body_mass: f64,
    /// kg m^2, about the pitch axis.
    pub car_body_inertia: f64,
    /// kg, of each bogie.
    pub bogie_mass: f64,
    /// kg m^2, of each bogie.
    pub bogie_inertia: f64,
    /// Distance of the bogie centres, m.
    pub bogie_spacing: f64,
    /// kg, of each wheel with its half axle.
    pub wheel_mass: f64,
    /// Distance of the axles of a bogie, m.
    pub wheelset_spacing: f64,
    /// N/m and N s/m, of each wheel.
    pub primary_stiffness: f64,
    pub primary_damping: f64,
    /// N/m and N s/m, of each bogie.
    pub secondary_stiffness: f64,
    pub secondary_damping: f64,
    /// Hertz constant of wheel on rail, N/m^1.5.
    pub hertz: f64,
}

/// Unknowns: car body bounce and pitch, bounce and pitch of the leading and of the trailing bogie, four wheels.
const UNKNOWNS: usize = 10;
/// The first wheel's unknown.
const WHEEL: usize = 6;
/// The rotations.
const PITCHES: [usize; 3] = [1, 3, 5];

impl Vehicle {
    /// Mass over one rail, kg.
    pub fn mass(&self) -> f64 {
        self.car_body_mass + 2.0 * self.bogie_mass + 4.0 * self.wheel_mass
    }

    /// Distances of the four wheels behind the leading wheel, m.
    pub fn wheel_offsets(&self) -> [f64; 4] {
        let (bogies, wheels) = (self.bogie_spacing, self.wheelset_spacing);
        [0.0, wheels, bogies, bogies + wheels]
    }

    /// Stiffness and damping matrices.
    fn suspension(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let zeros = DMatrix::zeros(UNKNOWNS, UNKNOWNS);
        let (mut stiffness, mut damping) = (zeros.clone(), zeros);
        // A spring and a damper that are extended by a combination of unknowns.
        let mut connect = |k: f64, c: f64, extension: &[(usize, f64)]| {
            for (i, a) in extension {
                for (j, b) in extension {
                    stiffness[(*i, *j)] += k * a * b;
                    damping[(*i, *j)] += c * a * b;
                }
            }
        };
        for (bogie, side) in [(2, 0.5), (4, -0.5)] {
            let secondary = [(0, 1.0), (1, side * self.bogie_spacing), (bogie, -1.0)];
            connect(self.secondary_stiffness, self.secondary_damping, &secondary);
            for (axle, side) in [(0, 0.5), (1, -0.5)] {
                let wheel = WHEEL + bogie - 2 + axle;
                let primary = [(bogie, 1.0), (bogie + 1, side * self.wheelset_spacing), (wheel, -1.0)];
                connect(self.primary_stiffness, self.primary_damping, &primary);
            }
        }
        (stiffness, damping)
    }

    /// The diagonal of the mass matrix.
    fn masses(&self) -> [f64; UNKNOWNS] {
        let (bogie, inertia, wheel) = (self.bogie_mass, self.bogie_inertia, self.wheel_mass);
        let (car, car_inertia) = (self.car_body_mass, self.car_body_inertia);
        [car, car_inertia, bogie, inertia, bogie, inertia, wheel, wheel, wheel, wheel]
    }
}

impl From<Vehicle> for Multibody {
    fn from(vehicle: Vehicle) -> Self {
        let (stiffness, damping) = vehicle.suspension();
        let masses = vehicle.masses().to_vec();
        let mut weighing = masses.clone();
        for pitch in PITCHES {
            weighing[pitch] = 0.0;
        }
        let wheel = |(w, offset): (usize, f64)| Wheel {
            unknown: Some(WHEEL + w),
            offset,
            contact: WheelContact::Hertz(vehicle.hertz),
        };
        let wheels = vehicle.wheel_offsets().into_iter().enumerate().map(wheel).collect();
        Multibody { masses, stiffness, damping, weighing, forces: vec![0.0; UNKNOWNS], wheels }
    }
}
