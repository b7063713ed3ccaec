//! The bed at an instant: every contact with a force, and the kinetic energy at the time of the positions.

use super::bed::Bed;
use super::body::{BodyId, SPHERE};
use super::failure::Failure;
use super::force::force_of;
use super::integrate::{self, Acting, Drive, Moving};
use super::lanes::{BLOCK, Real};
use super::record::Record;
use super::tasks::Task;
use super::vector::{Vec3, add, norm, scale, sub};
use super::walls::WallId;

/// A party of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Party {
    /// A body, and the index of its pebble.
    Body(BodyId, u16),
    Wall(WallId),
}

impl Party {
    pub fn body(&self) -> Option<BodyId> {
        match self {
            Party::Body(id, _) => Some(*id),
            Party::Wall(_) => None,
        }
    }
}

/// A contact that carries a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// A body; of two bodies the one that was created first.
    pub first: Party,
    pub second: Party,
    /// Force on the first party \[N\].
    pub force: [f64; 3],
    /// Unit vector from the second to the first.
    pub normal: [f64; 3],
    /// \[m\]
    pub overlap: f64,
    /// Contact point, close to the first party \[m\].
    pub point: [f64; 3],
    /// From the centroid of the second body, or from the contact point of a wall, to the centroid of the first \[m\].
    pub branch: [f64; 3],
}

/// The bed at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// \[s\]
    pub time: f64,
    /// Kinetic energy of translation and of rotation \[J\].
    pub translation: f64,
    pub rotation: f64,
    /// Contacts between pebbles, then those with walls.
    pub contacts: Vec<ContactState>,
}

impl Snapshot {
    /// Mean number of pebble contacts per body: twice the number of contacts divided by the number of bodies.
    pub fn coordination(&self, bodies: usize) -> f64 {
        let pairs = self.contacts.iter().filter(|c| c.second.body().is_some()).count();
        2.0 * pairs as f64 / bodies.max(1) as f64
    }

    /// Largest force \[N\].
    pub fn largest_force(&self) -> f64 {
        self.contacts.iter().map(|c| norm(c.force)).fold(0.0, f64::max)
    }
}

impl<R: Real> Bed<R> {
    /// Takes a snapshot. The motion continues afterwards bit by bit as without a snapshot.
    pub fn snapshot(&mut self) -> Result<Snapshot, Failure> {
        self.with_forces(|bed| {
            let tally = bed.half_kick();
            let contacts = bed.contact_states();
            Snapshot { time: bed.time, translation: tally.translation, rotation: tally.rotation, contacts }
        })
    }

    /// Kinetic energy of translation and of rotation at the time of the positions \[J\].
    pub fn kinetic_energy(&mut self) -> Result<(f64, f64), Failure> {
        let tally = self.with_forces(Self::half_kick)?;
        Ok((tally.translation, tally.rotation))
    }

    /// Number of contacts that carry a force now: between pebbles, and with walls.
    pub fn touching(&mut self) -> Result<(usize, usize), Failure> {
        self.with_forces(|bed| {
            let pairs = (0..bed.contacts.len()).filter(|&place| bed.overlap(place).is_some()).count();
            (pairs, bed.wall_contacts.slots.iter().filter(|slot| slot.touches()).count())
        })
    }

    /// Computes the forces of the present state, calls `look`, and restores the state.
    fn with_forces<T>(&mut self, look: impl FnOnce(&mut Self) -> T) -> Result<T, Failure> {
        if self.dt == 0.0 {
            return Err(Failure::NoTimeStep);
        }
        self.refresh()?;
        let histories = (self.contacts.shear.clone(), self.contacts.damping.clone(), self.wall_contacts.slots.clone());
        let bonds = self.bonds.clone();
        let felt: Vec<_> = self.walls.iter().map(|w| (w.felt, w.moment)).collect();
        self.sweep(None, |_| ());
        let seen = look(self);
        (self.contacts.shear, self.contacts.damping, self.wall_contacts.slots) = histories;
        self.bonds = bonds;
        for (wall, felt) in self.walls.iter_mut().zip(felt) {
            (wall.felt, wall.moment) = felt;
        }
        Ok(seen)
    }

    /// The result of half a kick under the present forces, without moving anything. Bodies are taken by their numbers:
    /// the sums are the same, bit by bit, for any order in memory.
    fn half_kick(&mut self) -> integrate::Tally {
        let drive = Drive {
            kick: if self.fresh { 0.0 } else { 0.5 * self.dt },
            dt: 0.0,
            gravity: self.gravity.value_at(self.time),
            damping: self.damping,
            watched: true,
        };
        let acting = Acting { incidence: &self.incidence, outcomes: &self.contacts.outcomes };
        let felt = integrate::felt(&self.lists.tasks, acting);
        let mut tally = integrate::Tally::default();
        for &place in &self.index {
            let body = self.bodies[place as usize];
            let clump = (body.clump != SPHERE).then_some(body.clump);
            let clumps = clump.map_or(0..0, |clump| clump as usize..clump as usize + 1);
            let pebbles = body.first as usize..body.first as usize + usize::from(body.pebbles);
            let at = Task { body: place, pebble: body.first, ..Task::default() };
            let moving = Moving {
                bodies: &mut [body],
                records: &mut self.records[pebbles.clone()].to_vec(),
                clumps: &mut self.clumps[clumps].to_vec(),
                arms: &self.arms,
            };
            tally = tally.and(integrate::advance_alone::<R>(moving, at, &felt[pebbles], &drive));
        }
        tally
    }

    fn contact_states(&self) -> Vec<ContactState> {
        let mut states = Vec::new();
        for place in 0..self.contacts.len() {
            if self.overlap(place).is_none() {
                continue;
            }
            states.push(self.contact_state(place));
        }
        let pairs = self.contacts.len();
        for entry in &self.wall_contacts.entries {
            for (k, slot) in self.wall_contacts.slots(entry).iter().enumerate().filter(|(_, s)| s.touches()) {
                let place = self.place_of(entry.pebble);
                let radius = self.records[entry.pebble as usize].radius();
                let point = sub(place, scale(slot.normal, radius - 0.5 * slot.overlap));
                let centre = add(place, sub(self.centre(entry.pebble), self.offset(entry.pebble)));
                states.push(ContactState {
                    first: self.party(entry.pebble),
                    second: Party::Wall(WallId(entry.wall)),
                    force: force_of(&self.contacts.outcomes[pairs + entry.slots.0 as usize + k]),
                    normal: slot.normal,
                    overlap: slot.overlap,
                    point,
                    branch: sub(centre, point),
                });
            }
        }
        self.add_bonds(&mut states);
        // in an order that depends only on the parties: sums over contacts must not depend on how lists were made
        states.sort_by_key(|contact: &ContactState| {
            let walled = contact.second.body().is_none();
            (walled, contact.first, contact.second)
        });
        states
    }

    /// The contact at this index of the list. Its first party is the lower one, because the order of two pebbles in a
    /// list is arbitrary and may change after a resume.
    fn contact_state(&self, place: usize) -> ContactState {
        let (a, b) = (self.contacts.first[place], self.contacts.second[place]);
        let (image, outcome) = (self.domain.shift(self.contacts.image[place]), &self.contacts.outcomes[place]);
        let is_turned = self.party(b) < self.party(a);
        let (a, b, sign, arm) = if is_turned { (b, a, -1.0, outcome[7]) } else { (a, b, 1.0, outcome[6]) };
        let apart = add(sub(self.offset(a), self.offset(b)), scale(image, sign));
        let distance = norm(apart);
        let normal = scale(apart, 1.0 / distance);
        ContactState {
            first: self.party(a),
            second: self.party(b),
            force: scale(force_of(outcome), sign),
            normal,
            // from positions: an arm in single precision is accurate only to a hundredth of a small overlap
            overlap: self.records[a as usize].radius() + self.records[b as usize].radius() - distance,
            point: sub(self.place_of(a), scale(normal, arm.to_f64())),
            branch: add(sub(self.centre(a), self.centre(b)), scale(image, sign)),
        }
    }

    pub(super) fn party(&self, pebble: u32) -> Party {
        let (body, part) = self.name(pebble);
        Party::Body(BodyId(body), part)
    }

    pub(super) fn offset(&self, pebble: u32) -> Vec3 {
        self.records[pebble as usize].position()
    }

    /// Centroid of the body of a pebble, in the cell of the body \[m\].
    pub(super) fn centre(&self, pebble: u32) -> Vec3 {
        let body = &self.bodies[self.owner[pebble as usize] as usize];
        if body.clump == SPHERE { self.offset(pebble) } else { self.clumps[body.clump as usize].centre }
    }

    pub(super) fn place_of(&self, pebble: u32) -> Vec3 {
        let body = &self.bodies[self.owner[pebble as usize] as usize];
        self.domain.place(body.cell, self.offset(pebble))
    }

    /// Number of listed contacts, including unused places of blocks: the contacts that a step computes.
    pub fn listed_contacts(&self) -> usize {
        debug_assert_eq!(self.contacts.len() % BLOCK, 0);
        self.contacts.len()
    }
}
