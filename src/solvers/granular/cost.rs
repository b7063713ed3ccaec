//! Cost of steps: reach of the lists, number of lists made, bytes moved per step.

use super::bed::Bed;
use super::body::{Arm, Body, Clump};
use super::contacts::BlockVector;
use super::domain::Image;
use super::failure::Failure;
use super::force::Outcome;
use super::lanes::{BLOCK, Real};
use super::walls::{Entry, Slot};

impl<R: Real> Bed<R> {
    /// Largest distance of listed pairs \[m\]; with `None` the bed chooses it for each body from its motion. It affects
    /// only the speed; the motion is the same, bit by bit.
    pub fn set_skin(&mut self, skin: Option<f64>) {
        self.lists.fixed_skin = skin;
        self.lists.outdated = true;
        self.unchecked = true;
    }

    /// Present largest distance of listed pairs of bodies that hardly move \[m\].
    pub fn skin(&self) -> f64 {
        self.lists.skin
    }

    /// Number of times that lists were made.
    pub fn lists_made(&self) -> u64 {
        self.lists.count
    }

    /// Makes the lists if they are not valid for the next step, so that the step does not need to make them.
    pub fn make_lists(&mut self) -> Result<(), Failure> {
        if self.dt <= 0.0 {
            return Err(Failure::NoTimeStep);
        }
        self.refresh()
    }

    /// Bytes moved by a step if every array is read from memory once per pass and written back once if it changes. Data
    /// that stay in a cache between passes are counted as well.
    pub fn bytes_per_step(&self) -> u64 {
        let bytes = |count: usize, each: usize| (count * each) as u64;
        let (places, pebbles, walls) = (self.contacts.len(), self.owner.len(), self.wall_contacts.slots.len());
        let outcome = size_of::<Outcome<R>>();
        let contacts = bytes(places, 2 * size_of::<u32>() + size_of::<Image>() + outcome)
            + bytes(places / BLOCK, size_of::<u16>() + 2 * size_of::<BlockVector<R>>())
            + bytes(pebbles, size_of::<R::Record>());
        let walls = bytes(walls, 2 * size_of::<Slot<R>>() + 2 * outcome)
            + bytes(self.wall_contacts.entries.len(), size_of::<Entry>());
        let motion = bytes(places, outcome)
            + self.incidence.bytes_per_step()
            + bytes(self.bodies.len(), 2 * size_of::<Body>())
            + bytes(self.clumps.len(), 2 * size_of::<Clump>())
            + bytes(self.arms.len(), size_of::<Arm>())
            + bytes(pebbles, 2 * size_of::<R::Record>());
        contacts + walls + motion
    }
}
