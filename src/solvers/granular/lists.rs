//! The age of the lists of what may touch: how far they reach, and where everything was when they were made.

use super::integrate::Task;
use super::motion::Pose;
use super::vector::Vec3;

/// When lists were made, and for how long they are good.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    /// Something was added.
    pub outdated: bool,
    /// How far pairs may be apart and still be listed \[m\].
    pub skin: f64,
    /// A reach that a user wants \[m\].
    pub fixed_skin: Option<f64>,
    /// Bound of what two bodies have come nearer since \[m\].
    pub travel: f64,
    pub step: u64,
    /// Lists made.
    pub count: u64,
    /// How far pebbles are from the origins of planes \[m\]: what a plane that turns sweeps.
    pub extent: f64,
    /// Where tasks begin, and one more.
    pub tasks: Vec<Task>,
    /// Where pebbles, walls were \[m\].
    pub reference: Vec<[f32; 3]>,
    pub origin: Vec<Vec3>,
    pub walls: Vec<Pose>,
}
