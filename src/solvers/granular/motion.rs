//! Motion of a wall: at rest, at a given velocity, by a table, harmonic, controlled to a given contact force, or as a
//! body with a mass under an applied force.
//!
//! Velocities belong to a whole step, from `time` to `time + dt`, as in a leapfrog scheme: x += v dt. For given motions
//! they are the mean over the step, so that the position of the wall is exact after every step for any dt.

mod error;
mod push;

pub use error::MotionError;
pub use push::Push;

use error::require;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Position and rotation of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the origin of the frame, m.
    pub position: Vector3<f64>,
    /// Unit quaternion w, x, y, z that turns the axes of the frame into the axes of space.
    pub orientation: [f64; 4],
}

/// Contact forces on a wall at the start of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Felt {
    /// Sum of the contact forces on the wall, N.
    pub force: Vector3<f64>,
    /// Sum of the normal stiffnesses of its contacts, N/m.
    pub stiffness: f64,
    /// Sum of their normal dashpots, N s/m.
    pub dashpot: f64,
    /// Velocity of the wall in the step before, on which the dashpot forces depend, m/s.
    pub velocity: Vector3<f64>,
    /// Number of contacts.
    pub contacts: usize,
}

/// The rule by which a wall moves.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum WallMotion {
    #[default]
    Fixed,
    /// Moves as a guide prescribes in every step, see [`super::Bed::guided_step`].
    Guided,
    /// Constant velocity (m/s) of the origin of the frame and angular velocity (rad/s) about it, in the axes of space.
    Velocity { linear: Vector3<f64>, angular: Vector3<f64> },
    /// Velocity (m/s) linear between times (s, increasing); the first value holds before, the last value after.
    Table { times: Vec<f64>, velocities: Vec<Vector3<f64>> },
    /// Harmonic: amplitude sin(2 pi frequency t + phase) along the unit axis, from the position of the wall at t = 0.
    Harmonic {
        axis: Vector3<f64>,
        /// m.
        amplitude: f64,
        /// Hz.
        frequency: f64,
        /// rad.
        phase: f64,
    },
    /// Moves along the unit axis until the contact force on the wall along this axis is `force`.
    ///
    /// v = (gain (F - force) + c v')/(k dt + c); k and c are the normal stiffness and dashpots of all contacts, v' is
    /// the speed of the step before. On springs and dashpots without mass, the difference F - force decreases by the
    /// factor 1 - gain per step. So F approaches from one side for gains up to 1, overshoots above 1 and grows above 2.
    /// Bodies with mass follow later than springs: 0.5 is the usual gain, a smaller gain is safer. Based on PFC's servo
    /// control, which has c = 0: if c is above k dt, the dashpots would make such a plate oscillate.
    Servo {
        axis: Vector3<f64>,
        /// N; above 0 if contacts push the wall along the axis.
        force: f64,
        /// m/s. Also the speed of a wall without contact, towards the side from which the force will come.
        speed_limit: f64,
        #[serde(default = "usual_gain")]
        gain: f64,
    },
    /// Moves along the unit axis as a body with a mass, without rotation: `m dv/dt = F`; F is the sum of weight,
    /// applied force and contact forces along the axis.
    ///
    /// Leapfrog, as for grains: v = v' + F dt / m. A wall that gets this motion during a run takes its present speed as
    /// v', half a step early. It oscillates on its contacts: dt must stay well below sqrt(m / k) of their stiffness.
    Loaded {
        axis: Vector3<f64>,
        /// kg.
        mass: f64,
        /// Along the axis, N.
        weight: f64,
        /// Local damping after Cundall, as for grains: F is reduced by this share if it drives the motion, and
        /// increased by this share if it brakes the motion.
        damping: f64,
        push: Push,
    },
}

fn usual_gain() -> f64 {
    0.5
}

impl WallMotion {
    /// A servo with the usual gain of 0.5.
    pub fn servo(axis: Vector3<f64>, force: f64, speed_limit: f64) -> Self {
        WallMotion::Servo { axis, force, speed_limit, gain: usual_gain() }
    }

    /// The first number that is out of its range.
    pub fn check(&self) -> Result<(), MotionError> {
        match self {
            WallMotion::Fixed | WallMotion::Guided => Ok(()),
            WallMotion::Velocity { linear, angular } => {
                finite("velocity of a wall", linear)?;
                finite("angular velocity of a wall", angular)
            }
            WallMotion::Table { times, velocities } => check_table(times, velocities),
            WallMotion::Harmonic { axis, amplitude, frequency, phase } => {
                unit("axis of a harmonic motion", axis)?;
                let number = |name, value: f64| require(value.is_finite(), name, value, "a finite number");
                number("amplitude of a harmonic motion", *amplitude)?;
                number("phase of a harmonic motion", *phase)?;
                let fine = frequency.is_finite() && *frequency >= 0.0;
                require(fine, "frequency of a harmonic motion", *frequency, "of 0 Hz or more")
            }
            WallMotion::Servo { axis, force, speed_limit, gain } => {
                unit("axis of a servo", axis)?;
                require(force.is_finite(), "force of a servo", *force, "a finite number")?;
                let fine = speed_limit.is_finite() && *speed_limit > 0.0;
                require(fine, "speed limit of a servo", *speed_limit, "above 0 m/s")?;
                require(*gain > 0.0 && *gain <= 1.0, "gain of a servo", *gain, "above 0 and up to 1")
            }
            WallMotion::Loaded { axis, mass, weight, damping, push } => {
                unit("axis of a loaded wall", axis)?;
                require(mass.is_finite() && *mass > 0.0, "mass of a wall", *mass, "above 0 kg")?;
                require(weight.is_finite(), "weight of a wall", *weight, "a finite number")?;
                require((0.0..1.0).contains(damping), "damping of a wall", *damping, "from 0 to below 1")?;
                push.check()
            }
        }
    }

    /// Velocity (m/s) and angular velocity (rad/s) of the step from `time` (s) over `dt` (s, above 0).
    pub fn velocity(&self, time: f64, dt: f64, felt: &Felt) -> (Vector3<f64>, Vector3<f64>) {
        let linear = match self {
            WallMotion::Fixed => Vector3::zeros(),
            // a wall that no guide changes keeps its velocity
            WallMotion::Guided => felt.velocity,
            WallMotion::Velocity { linear, angular } => return (*linear, *angular),
            WallMotion::Table { times, velocities } => mean_of_table(times, velocities, time, dt),
            WallMotion::Harmonic { axis, amplitude, frequency, phase } => {
                // sin b - sin a = 2 cos((a + b)/2) sin((b - a)/2) is accurate if a and b are close
                let half = TAU * frequency * dt / 2.0;
                axis * (amplitude * 2.0 * (TAU * frequency * time + phase + half).cos() * half.sin() / dt)
            }
            WallMotion::Servo { axis, force, speed_limit, gain } => {
                let excess = felt.force.dot(axis) - force;
                let speed = if felt.contacts > 0 && felt.stiffness > 0.0 {
                    let drive = gain * excess + felt.dashpot * felt.velocity.dot(axis);
                    (drive / (felt.stiffness * dt + felt.dashpot)).clamp(-speed_limit, *speed_limit)
                } else if excess == 0.0 {
                    0.0
                } else {
                    speed_limit.copysign(excess)
                };
                axis * speed
            }
            WallMotion::Loaded { axis, mass, weight, damping, push } => {
                let before = felt.velocity.dot(axis);
                let drive = felt.force.dot(axis) + weight + push.force_at(time);
                let braked = drive - damping * drive.abs() * if before == 0.0 { 0.0 } else { before.signum() };
                axis * (before + braked * dt / mass)
            }
        };
        (linear, Vector3::zeros())
    }
}

/// Mean over the step of a velocity that is linear between times.
fn mean_of_table(times: &[f64], velocities: &[Vector3<f64>], time: f64, dt: f64) -> Vector3<f64> {
    let end = time + dt;
    let after = times.partition_point(|t| *t <= time);
    let inner = times[after..].iter().copied().take_while(|t| *t < end);
    let mut way = Vector3::zeros();
    let mut from = time;
    for to in inner.chain([end]) {
        way += (value_at(times, velocities, from) + value_at(times, velocities, to)) * ((to - from) / 2.0);
        from = to;
    }
    way / (end - time)
}

fn value_at(times: &[f64], velocities: &[Vector3<f64>], time: f64) -> Vector3<f64> {
    let right = times.partition_point(|t| *t <= time);
    if right == 0 {
        return velocities[0];
    }
    if right == times.len() {
        return velocities[right - 1];
    }
    let share = (time - times[right - 1]) / (times[right] - times[right - 1]);
    velocities[right - 1].lerp(&velocities[right], share)
}

fn check_table(times: &[f64], velocities: &[Vector3<f64>]) -> Result<(), MotionError> {
    let name = "times of a table of velocities";
    require(!times.is_empty(), name, 0.0, "of 1 or more")?;
    let same = times.len() == velocities.len();
    require(same, "number of velocities of a table", velocities.len() as f64, "as many as there are times")?;
    times.iter().try_for_each(|t| require(t.is_finite(), name, *t, "finite numbers"))?;
    times.windows(2).try_for_each(|pair| require(pair[1] > pair[0], name, pair[1], "each above the time before it"))?;
    velocities.iter().try_for_each(|v| finite("velocities of a table", v))
}

fn finite(name: &'static str, vector: &Vector3<f64>) -> Result<(), MotionError> {
    vector.iter().try_for_each(|value| require(value.is_finite(), name, *value, "finite numbers"))
}

fn unit(name: &'static str, axis: &Vector3<f64>) -> Result<(), MotionError> {
    require((axis.norm() - 1.0).abs() <= 1e-12, name, axis.norm(), "of length 1")
}

impl Default for Pose {
    fn default() -> Self {
        Self { position: Vector3::zeros(), orientation: [1.0, 0.0, 0.0, 0.0] }
    }
}

impl Pose {
    /// Fails if the position is not finite or the length of the quaternion is not 1.
    pub fn check(&self) -> Result<(), MotionError> {
        finite("position of a wall", &self.position)?;
        let length = self.orientation.iter().map(|q| q * q).sum::<f64>().sqrt();
        require((length - 1.0).abs() <= 1e-12, "quaternion of a wall", length, "of length 1")
    }

    /// Moves and rotates over a step of `dt` (s), exactly for constant velocities (m/s, rad/s, axes of space).
    pub fn advance(&mut self, linear: &Vector3<f64>, angular: &Vector3<f64>, dt: f64) {
        self.position += linear * dt;
        let angle = angular.norm() * dt;
        // a wall that does not rotate keeps its bits
        if angle == 0.0 {
            return;
        }
        let axis = angular * ((angle / 2.0).sin() * dt / angle);
        let turned = product([(angle / 2.0).cos(), axis.x, axis.y, axis.z], self.orientation);
        let length = turned.iter().map(|q| q * q).sum::<f64>().sqrt();
        self.orientation = turned.map(|q| q / length);
    }

    /// A point of space, m, in the frame of the wall.
    #[inline]
    pub fn to_frame(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let [w, x, y, z] = self.orientation;
        turn([w, -x, -y, -z], &(point - self.position))
    }

    /// A point in the frame of the wall, m, in space.
    pub fn to_space(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.position + self.direction_to_space(point)
    }

    /// A direction in the frame of the wall, in space.
    #[inline]
    pub fn direction_to_space(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        turn(self.orientation, direction)
    }
}

/// Hamilton's product of quaternions w, x, y, z.
fn product([aw, ax, ay, az]: [f64; 4], [bw, bx, by, bz]: [f64; 4]) -> [f64; 4] {
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

/// v + 2 w (q x v) + 2 q x (q x v).
#[inline]
fn turn([w, x, y, z]: [f64; 4], v: &Vector3<f64>) -> Vector3<f64> {
    // most walls do not rotate
    if x == 0.0 && y == 0.0 && z == 0.0 {
        return *v;
    }
    let q = Vector3::new(x, y, z);
    let t = 2.0 * q.cross(v);
    v + w * t + q.cross(&t)
}

#[cfg(test)]
mod tests;
