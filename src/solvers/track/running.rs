//! A vehicle in motion: one time step of the vehicle, for given forces at its wheels.

use super::error::{TrackError, TrackParameter};
use super::multibody::Multibody;
use super::scheme::Scheme;
use nalgebra::DMatrix;

/// A vehicle's motion and the matrices of its step. Lists run over its unknowns.
#[derive(Debug, Clone)]
pub(super) struct RunningVehicle {
    /// Number of unknowns.
    order: usize,
    // Matrices column by column, all symmetric.
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    inverse: Vec<f64>,
    masses: Vec<f64>,
    weight: Vec<f64>,
    /// Per wheel.
    wheels: Vec<Option<usize>>,
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    predicted: Vec<f64>,
    predicted_velocity: Vec<f64>,
    mean: [Vec<f64>; 2],
}

impl RunningVehicle {
    /// A vehicle in motion without acceleration; fails if an unknown has no mass and no spring.
    pub fn new(
        vehicle: &Multibody,
        gravity: f64,
        scheme: &Scheme,
        displacement: Vec<f64>,
        velocity: Vec<f64>,
    ) -> Result<Self, TrackError> {
        let order = vehicle.order();
        let inverse = inverse(vehicle, scheme)?;
        let columns = |matrix: &DMatrix<f64>| matrix.as_slice().to_vec();
        Ok(Self {
            order,
            stiffness: columns(&vehicle.stiffness),
            damping: columns(&vehicle.damping),
            inverse: columns(&inverse),
            masses: vehicle.masses.clone(),
            weight: vehicle.weight(gravity),
            wheels: vehicle.wheels.iter().map(|w| w.unknown).collect(),
            displacement,
            velocity,
            acceleration: vec![0.0; order],
            predicted: vec![0.0; order],
            predicted_velocity: vec![0.0; order],
            mean: [vec![0.0; order], vec![0.0; order]],
        })
    }

    /// Continues in steps of another length.
    pub fn change_step(&mut self, vehicle: &Multibody, scheme: &Scheme) -> Result<(), TrackError> {
        self.inverse.copy_from_slice(inverse(vehicle, scheme)?.as_slice());
        Ok(())
    }

    /// Drop of each wheel at the end of a step per force at each wheel there, m/N.
    pub fn wheel_compliance(&self, scheme: &Scheme) -> DMatrix<f64> {
        let (_, _, share) = scheme.effective();
        DMatrix::from_fn(self.wheels.len(), self.wheels.len(), |v, w| match (self.wheels[v], self.wheels[w]) {
            (Some(i), Some(j)) => share * self.inverse[j * self.order + i],
            _ => 0.0,
        })
    }

    /// Begins a step: computes the acceleration at its end for zero wheel forces at the end.
    pub fn predict(&mut self, scheme: &Scheme, old_forces: &[f64]) {
        let n = self.order;
        let (dt, alpha_f) = (scheme.time_step, scheme.alpha_f);
        let (from_a, velocity_from_a) = ((0.5 - scheme.beta) * dt * dt, (1.0 - scheme.gamma) * dt);
        let (u, v, a) = (&self.displacement[..n], &self.velocity[..n], &mut self.acceleration[..n]);
        let (predicted, predicted_velocity) = (&mut self.predicted[..n], &mut self.predicted_velocity[..n]);
        let [forces, rest] = &mut self.mean;
        let (forces, rest) = (&mut forces[..n], &mut rest[..n]);
        for i in 0..n {
            predicted[i] = u[i] + dt * v[i] + from_a * a[i];
            predicted_velocity[i] = v[i] + velocity_from_a * a[i];
            forces[i] = self.weight[i] - scheme.alpha_m * self.masses[i] * a[i];
        }
        for j in 0..n {
            let mean = (1.0 - alpha_f) * predicted[j] + alpha_f * u[j];
            let mean_velocity = (1.0 - alpha_f) * predicted_velocity[j] + alpha_f * v[j];
            let (stiffness, damping) = (&self.stiffness[j * n..(j + 1) * n], &self.damping[j * n..(j + 1) * n]);
            for i in 0..n {
                forces[i] -= stiffness[i] * mean + damping[i] * mean_velocity;
            }
        }
        for (wheel, force) in self.wheels.iter().zip(old_forces) {
            if let Some(unknown) = wheel {
                forces[*unknown] -= alpha_f * force;
            }
        }
        rest.fill(0.0);
        for (column, force) in self.inverse.chunks_exact(n.max(1)).zip(forces.iter()) {
            for (a, inverse) in rest.iter_mut().zip(column) {
                *a += inverse * force;
            }
        }
        a.copy_from_slice(rest);
    }

    /// Displacement of a wheel at the end of the step for zero wheel forces there, m; 0 under a given force.
    #[inline]
    pub fn free_wheel(&self, scheme: &Scheme, wheel: usize) -> f64 {
        self.wheels[wheel].map_or(0.0, |i| self.predicted[i] + scheme.displacement_share() * self.acceleration[i])
    }

    /// Ends a step with its wheel forces.
    pub fn finish(&mut self, scheme: &Scheme, forces: &[f64]) {
        let n = self.order;
        for (wheel, force) in self.wheels.iter().zip(forces) {
            let Some(unknown) = wheel else { continue };
            let share = (1.0 - scheme.alpha_f) * force;
            for (a, inverse) in self.acceleration.iter_mut().zip(&self.inverse[unknown * n..(unknown + 1) * n]) {
                *a -= share * inverse;
            }
        }
        let (share, velocity_share) = (scheme.displacement_share(), scheme.velocity_share());
        for i in 0..n {
            self.displacement[i] = self.predicted[i] + share * self.acceleration[i];
            self.velocity[i] = self.predicted_velocity[i] + velocity_share * self.acceleration[i];
        }
    }
}

/// Acceleration at the end of a step per force there; fails if an unknown has no mass and no spring.
fn inverse(vehicle: &Multibody, scheme: &Scheme) -> Result<DMatrix<f64>, TrackError> {
    let (of_mass, of_damping, of_stiffness) = scheme.effective();
    let mut matrix = of_damping * &vehicle.damping + of_stiffness * &vehicle.stiffness;
    for (i, mass) in vehicle.masses.iter().enumerate() {
        matrix[(i, i)] += of_mass * mass;
    }
    matrix.cholesky().map(|factor| factor.inverse()).ok_or(TrackError::Parameter {
        name: TrackParameter::Vehicle("unknowns of a vehicle"),
        value: vehicle.order() as f64,
        expected: "that each have a mass or a spring",
    })
}
