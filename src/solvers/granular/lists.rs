//! The age of the contact lists: their reach, and all positions at the time when they were made.

use super::motion::Pose;
use super::tasks::Task;
use super::vector::Vec3;

/// When lists were made, and how long they are valid.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    /// Something was added.
    pub outdated: bool,
    /// Largest distance of listed pairs \[m\].
    pub skin: f64,
    /// A reach given by the user \[m\].
    pub fixed_skin: Option<f64>,
    /// Upper bound of the approach of two bodies since then \[m\].
    pub travel: f64,
    pub step: u64,
    /// Number of lists made.
    pub count: u64,
    /// Largest distance of pebbles from the origins of planes \[m\]: a rotating plane moves by angle times this
    /// distance.
    pub extent: f64,
    /// First indices of the tasks, and one final value.
    pub tasks: Vec<Task>,
    /// Positions of pebbles and walls when the lists were made \[m\].
    pub reference: Vec<[f32; 3]>,
    pub origin: Vec<Vec3>,
    pub walls: Vec<Pose>,
}
