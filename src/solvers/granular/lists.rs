//! The age of the contact lists: how far bodies and walls may move, and where everything was when the lists were made.

use super::motion::Pose;
use super::tasks::Task;
use super::vector::Vec3;

/// When lists were made, and how long they are valid.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    /// Something was added.
    pub outdated: bool,
    /// Largest distance of listed pairs of pebbles at rest: twice their reach \[m\].
    pub skin: f64,
    /// A distance given by the user, for all pairs \[m\].
    pub fixed_skin: Option<f64>,
    pub step: u64,
    /// Number of lists made.
    pub count: u64,
    /// Largest distance of pebbles from the origins of planes \[m\]: a rotating plane moves by angle times this
    /// distance.
    pub extent: f64,
    /// First indices of the tasks, and one final value.
    pub tasks: Vec<Task>,
    /// Reach of each pebble and of each wall: the distance that it may move \[m\].
    pub reach: Vec<f32>,
    pub wall_reach: Vec<f64>,
    /// The bodies of each task, and the walls.
    pub spans: Vec<Span>,
    pub of_walls: Span,
    /// Positions of pebbles and walls when the lists were made \[m\].
    pub reference: Vec<[f32; 3]>,
    pub origin: Vec<Vec3>,
    pub walls: Vec<Pose>,
}

/// What some bodies or walls may still move.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Span {
    /// Upper bound of the distance that one of them has moved since `left` was measured \[m\].
    pub travelled: f64,
    /// Least distance that was left to one of them then \[m\].
    pub left: f64,
}

impl Span {
    pub fn is_used_up(&self) -> bool {
        self.travelled > self.left
    }
}

impl Lists {
    pub fn is_valid(&self) -> bool {
        !self.of_walls.is_used_up() && !self.spans.iter().any(Span::is_used_up)
    }

    /// Lower bound of the distance up to which all pairs are listed now \[m\].
    pub fn listed_up_to(&self) -> f64 {
        let left = |span: &Span| span.left - span.travelled;
        let of_bodies = self.spans.iter().map(left).fold(f64::INFINITY, f64::min);
        of_bodies + of_bodies.min(left(&self.of_walls))
    }

    /// The largest reach of a pebble \[m\].
    pub fn farthest(&self) -> f64 {
        f64::from(self.reach.iter().copied().fold(0.0, f32::max))
    }
}
