//! One exchange: the track as it lies after so many axles, and the passages of trains over it, each computed once.

use super::substructure::Substructure;
use super::system::TrackSystem;
use super::track::{PassageOutcome, Unloaded};
use crate::scenario::Direction;
use crate::solvers::track::TrackError;

/// The track at an axle count.
pub(super) struct Exchange {
    pub axles: u64,
    /// Of every seat, m.
    pub settlement: Vec<f64>,
    /// Whether the passage of `leading` is recorded.
    recorded: bool,
    leading: Direction,
    pub unloaded: Option<Unloaded>,
    forward: Option<PassageOutcome>,
    backward: Option<PassageOutcome>,
}

impl Exchange {
    /// The settled track, before any train runs over it. The passage in direction `leading` is the one that is recorded.
    pub fn new(axles: u64, settlement: Vec<f64>, recorded: bool, leading: Direction) -> Self {
        Exchange { axles, settlement, recorded, leading, unloaded: None, forward: None, backward: None }
    }

    /// Computes the passages that are missing, both directions at once.
    pub fn ensure(&mut self, system: &TrackSystem<'_>, directions: &[Direction]) -> Result<(), TrackError> {
        let missing = |direction| directions.contains(&direction) && self.of(direction).is_none();
        let run = |direction: Direction| {
            let recorded = self.recorded && direction == self.leading;
            system.passage(self.axles, &self.settlement, direction, recorded)
        };
        let one = |direction| missing(direction).then(|| run(direction)).transpose();
        let (forward, backward) = rayon::join(|| one(Direction::Forward), || one(Direction::Backward));
        for (direction, passage) in [(Direction::Forward, forward?), (Direction::Backward, backward?)] {
            let Some((unloaded, passage)) = passage else { continue };
            self.unloaded = Some(unloaded); // the same for both: no train stands on it
            match direction {
                Direction::Backward => self.backward = Some(passage),
                _ => self.forward = Some(passage),
            }
        }
        Ok(())
    }

    /// The passage in a direction, where it has been computed.
    pub fn of(&self, direction: Direction) -> Option<&PassageOutcome> {
        if direction == Direction::Backward { self.backward.as_ref() } else { self.forward.as_ref() }
    }

    /// The passage that a record shows.
    pub fn recorded(&self) -> Option<(&Unloaded, Direction, &PassageOutcome)> {
        let passage = self.of(self.leading).filter(|_| self.recorded)?;
        Some((self.unloaded.as_ref()?, self.leading, passage))
    }

    /// What its passages took.
    pub fn work(&self) -> Work {
        self.passages().fold(Work::default(), |work, passage| Work {
            time_steps: work.time_steps + passage.time_steps,
            newton_iterations: work.newton_iterations + passage.newton_iterations,
        })
    }

    pub fn passages(&self) -> impl Iterator<Item = &PassageOutcome> {
        self.forward.iter().chain(&self.backward)
    }

    /// What the substructure becomes when trains of these counts pass with the forces computed here.
    pub fn load<'a>(&self, from: &Substructure<'a>, trains: &[(Direction, u64)]) -> Substructure<'a> {
        let mut loaded = from.clone();
        for (direction, count) in trains {
            if let Some(passage) = self.of(*direction) {
                loaded.load(&passage.peaks, *count);
            }
        }
        loaded
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Work {
    pub time_steps: u64,
    pub newton_iterations: u64,
}
