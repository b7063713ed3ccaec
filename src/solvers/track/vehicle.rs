//! Vehicles as ten rigid-body unknowns over one rail: car body and two bogies with bounce and pitch, four wheels.
//!
//! Pitch is the slope of the body seen in the direction of motion, so a train that runs the other way has the same matrices.

use super::TrackError;
use nalgebra::{SMatrix, SVector};

/// A vehicle on two bogies of two axles each, as carried by **one rail**: half of every mass, inertia and stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// As x grows.
    Forward,
    Backward,
}

/// Vehicles that run together.
#[derive(Debug, Clone, PartialEq)]
pub struct Train {
    /// Leading one first, each with the distance of its leading wheel behind the train's leading wheel, m.
    pub vehicles: Vec<(Vehicle, f64)>,
    pub direction: Direction,
}

/// Unknowns of a vehicle: car body bounce and pitch, the same of the leading and of the trailing bogie, four wheels.
pub(super) const UNKNOWNS: usize = 10;
/// The first wheel's unknown.
pub(super) const WHEEL: usize = 6;
pub(super) const WHEELS: usize = 4;

pub(super) type VehicleMatrix = SMatrix<f64, UNKNOWNS, UNKNOWNS>;
pub(super) type VehicleVector = SVector<f64, UNKNOWNS>;

impl Direction {
    /// +1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Forward => 1.0,
            Direction::Backward => -1.0,
        }
    }
}

impl Vehicle {
    /// Mass over one rail, kg.
    pub fn mass(&self) -> f64 {
        self.car_body_mass + 2.0 * self.bogie_mass + WHEELS as f64 * self.wheel_mass
    }

    /// Distances of the four wheels behind the leading one, m.
    pub fn wheel_offsets(&self) -> [f64; 4] {
        let (bogies, wheels) = (self.bogie_spacing, self.wheelset_spacing);
        [0.0, wheels, bogies, bogies + wheels]
    }

    /// Stiffness and damping matrices.
    pub(super) fn suspension(&self) -> (VehicleMatrix, VehicleMatrix) {
        let mut matrices = (VehicleMatrix::zeros(), VehicleMatrix::zeros());
        let mut connect = |stiffness: f64, damping: f64, extension: VehicleVector| {
            let outer = extension * extension.transpose();
            matrices.0 += stiffness * outer;
            matrices.1 += damping * outer;
        };
        for (bogie, side) in [(2, 0.5), (4, -0.5)] {
            let mut extension = VehicleVector::zeros();
            extension[0] = 1.0;
            extension[1] = side * self.bogie_spacing;
            extension[bogie] = -1.0;
            connect(self.secondary_stiffness, self.secondary_damping, extension);
            for (axle, side) in [(0, 0.5), (1, -0.5)] {
                let mut extension = VehicleVector::zeros();
                extension[bogie] = 1.0;
                extension[bogie + 1] = side * self.wheelset_spacing;
                extension[WHEEL + bogie - 2 + axle] = -1.0;
                connect(self.primary_stiffness, self.primary_damping, extension);
            }
        }
        matrices
    }

    /// The diagonal of the mass matrix.
    pub(super) fn masses(&self) -> VehicleVector {
        let (bogie, inertia, wheel) = (self.bogie_mass, self.bogie_inertia, self.wheel_mass);
        VehicleVector::from_column_slice(&[
            self.car_body_mass,
            self.car_body_inertia,
            bogie,
            inertia,
            bogie,
            inertia,
            wheel,
            wheel,
            wheel,
            wheel,
        ])
    }

    /// Gravity on the unknowns, N.
    pub(super) fn weight(&self, gravity: f64) -> VehicleVector {
        let mut weight = self.masses() * gravity;
        for pitch in [1, 3, 5] {
            weight[pitch] = 0.0;
        }
        weight
    }

    fn check(&self) -> Result<(), TrackError> {
        let positive = [
            ("car body mass", self.car_body_mass),
            ("car body inertia", self.car_body_inertia),
            ("bogie mass", self.bogie_mass),
            ("bogie inertia", self.bogie_inertia),
            ("bogie spacing", self.bogie_spacing),
            ("wheel mass", self.wheel_mass),
            ("wheelset spacing", self.wheelset_spacing),
            ("primary stiffness", self.primary_stiffness),
            ("secondary stiffness", self.secondary_stiffness),
            ("hertz constant", self.hertz),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(TrackError::Parameter { name, value, expected: "above 0" });
            }
        }
        for (name, value) in [("primary damping", self.primary_damping), ("secondary damping", self.secondary_damping)]
        {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(TrackError::Parameter { name, value, expected: "of 0 or more" });
            }
        }
        Ok(())
    }
}

impl Train {
    /// One vehicle.
    pub fn single(vehicle: Vehicle, direction: Direction) -> Self {
        Self { vehicles: vec![(vehicle, 0.0)], direction }
    }

    /// Number of wheels.
    pub fn wheels(&self) -> usize {
        WHEELS * self.vehicles.len()
    }

    /// Chainage of every wheel while the leading one is at `leading` (m), vehicle by vehicle.
    pub fn wheel_positions(&self, leading: f64) -> impl Iterator<Item = f64> + '_ {
        let sign = self.direction.sign();
        self.vehicles
            .iter()
            .flat_map(move |(vehicle, offset)| vehicle.wheel_offsets().map(|wheel| leading - sign * (offset + wheel)))
    }

    /// Distance from the leading to the last wheel, m.
    pub fn wheel_base(&self) -> f64 {
        let last = |(vehicle, offset): &(Vehicle, f64)| offset + vehicle.wheel_offsets()[WHEELS - 1];
        self.vehicles.iter().map(last).fold(0.0, f64::max)
    }

    pub(super) fn check(&self) -> Result<(), TrackError> {
        self.vehicles.iter().try_for_each(|(vehicle, _)| vehicle.check())
    }
}
