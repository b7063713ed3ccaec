//! Glue between grains: springs in tension, compression and shear, until they break.
//!
//! A bond acts in parallel to the contact of its two pebbles and is independent of it. Its normal force depends on the
//! overlap minus the overlap at which it was glued; its shear force grows by increments in the rotating contact plane;
//! it carries no moment. A bond breaks for good if its tension or shear exceeds its strength, and carries no force from
//! that step on. These are PFC's linear parallel bonds of radius 0.

mod pass;
#[cfg(test)]
mod tests;

use super::bed::Bed;
use super::contacts::{BlockVector, ContactEnergy, Surroundings};
use super::critical::Link;
use super::domain::Image;
use super::failure::Failure;
use super::force::{Outcome, Tangent, force_of};
use super::lanes::{BLOCK, Real};
use super::law::LawError;
use super::record::Record;
use super::search::CellTooSmall;
use super::snapshot::{ContactState, Party};
use super::vector::{Vec3, add, norm, scale, sub};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Properties of bonds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Glue {
    /// Stiffness of a bond, in addition to the stiffness of the contact \[N/m\].
    pub normal_stiffness: f64,
    /// \[N/m\]
    pub shear_stiffness: f64,
    /// Tensile force at which a bond breaks \[N\].
    pub tensile_strength: f64,
    /// Shear force at which a bond breaks \[N\].
    pub shear_strength: f64,
}

impl Glue {
    /// Every number out of its range, in the order of the fields.
    pub fn faults(&self) -> Vec<LawError> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let numbers = [
            ("normal stiffness of a bond", self.normal_stiffness, positive(self.normal_stiffness), "a number above 0"),
            (
                "shear stiffness of a bond",
                self.shear_stiffness,
                self.shear_stiffness.is_finite() && self.shear_stiffness >= 0.0,
                "a number from 0",
            ),
            ("tensile strength of a bond", self.tensile_strength, positive(self.tensile_strength), "a number above 0"),
            ("shear strength of a bond", self.shear_strength, positive(self.shear_strength), "a number above 0"),
        ];
        let wrong = numbers.into_iter().filter(|(_, _, fine, _)| !fine);
        wrong.map(|(quantity, value, _, expected)| LawError { quantity, value, expected }).collect()
    }

    fn tangent(&self) -> Tangent {
        Tangent { normal: self.normal_stiffness, shear: self.shear_stiffness, normal_dashpot: 0.0, shear_dashpot: 0.0 }
    }
}

/// Number of a body, and index of a pebble in it.
type Name = (u32, u16);

/// An intact bond, given by its pebbles, the lower name first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Bond<R> {
    pub glue: u16,
    pub low: Name,
    pub high: Name,
    /// Overlap at which the bond carries no force \[m\].
    pub start: R,
    /// Force of the shear spring on the lower pebble \[N\].
    pub shear: [R; 3],
}

/// Bonds of one glue that are computed together.
#[derive(Debug, Clone)]
struct Block<R> {
    glue: u16,
    names: [[Name; 2]; BLOCK],
    first: [u32; BLOCK],
    second: [u32; BLOCK],
    /// Shift of the first pebble.
    image: [Image; BLOCK],
    start: [R; BLOCK],
    /// 1 for an intact bond, 0 for a broken bond or an unused place of the block.
    holds: [R; BLOCK],
    shear: BlockVector<R>,
}

/// All bonds of a bed.
#[derive(Debug, Clone, Default)]
pub(super) struct Bonds<R> {
    pub glues: Vec<Glue>,
    /// Sorted by glue and names.
    blocks: Vec<Block<R>>,
    /// Bonds broken so far that are no longer in the blocks.
    pub dropped: u64,
}

impl<R: Real> Bonds<R> {
    /// No bonds with these glues yet, after `dropped` broken bonds.
    pub fn none(glues: Vec<Glue>, dropped: u64) -> Self {
        Bonds { glues, blocks: Vec::new(), dropped }
    }

    /// Number of outcomes of bonds: one per place, including unused places of blocks.
    pub fn places(&self) -> usize {
        self.blocks.len() * BLOCK
    }

    /// The intact bonds.
    pub fn held(&self) -> Vec<Bond<R>> {
        let of_block = |block: &Block<R>| {
            let lanes = (0..BLOCK).filter(|lane| block.is_held(*lane)).map(|lane| Bond {
                glue: block.glue,
                low: block.names[lane][0],
                high: block.names[lane][1],
                start: block.start[lane],
                shear: [0, 1, 2].map(|c| block.shear[c][lane]),
            });
            lanes.collect::<Vec<_>>()
        };
        self.blocks.iter().flat_map(of_block).collect()
    }

    /// Pebbles of the bond at a place; `None` if no intact bond is there.
    pub fn pebbles(&self, place: usize) -> Option<[u32; 2]> {
        let (block, lane) = (&self.blocks[place / BLOCK], place % BLOCK);
        block.is_held(lane).then(|| [block.first[lane], block.second[lane]])
    }

    /// Computes the forces of all bonds.
    pub fn evaluate(&mut self, around: Surroundings<R>, outcomes: &mut [Outcome<R>]) -> ContactEnergy {
        pass::evaluate(&self.glues, &mut self.blocks, around, outcomes)
    }
}

impl<R: Real> Block<R> {
    fn is_held(&self, lane: usize) -> bool {
        self.holds[lane] > R::default()
    }
}

impl<R: Real> Bed<R> {
    /// Glues pairs of pebbles that touch now: `which` returns the number of the glue in `glues`, if any. In the present
    /// state the bonds carry no force. Earlier bonds are removed. Returns the number of bonds.
    ///
    /// Bodies that are copied from a glued bed are not glued: glue last.
    pub fn glue(&mut self, glues: Vec<Glue>, which: impl Fn(&ContactState) -> Option<u16>) -> Result<usize, Failure> {
        let contacts = self.snapshot()?.contacts;
        let bond = |contact: &ContactState| {
            let (Party::Body(low, a), Party::Body(high, b)) = (contact.first, contact.second) else { return None };
            let start = R::from_f64(contact.overlap);
            Some(Bond { glue: which(contact)?, low: (low.0, a), high: (high.0, b), start, shear: [R::default(); 3] })
        };
        let bonds: Vec<Bond<R>> = contacts.iter().filter_map(bond).collect();
        let count = bonds.len();
        self.bonds = Bonds::none(glues, 0);
        self.bind(bonds)?;
        self.lists.outdated = true;
        self.unchecked = true;
        Ok(count)
    }

    /// Number of intact bonds.
    pub fn bonds(&self) -> usize {
        (0..self.bonds.places()).filter(|place| self.bonds.pebbles(*place).is_some()).count()
    }

    /// Number of bonds that have broken since they were glued.
    pub fn broken_bonds(&self) -> u64 {
        let broken = |block: &Block<R>| {
            (0..BLOCK).filter(|lane| block.names[*lane] != [(0, 0); 2] && !block.is_held(*lane)).count()
        };
        self.bonds.dropped + self.bonds.blocks.iter().map(broken).sum::<usize>() as u64
    }

    /// Puts bonds into blocks, by the present positions of their pebbles in memory. Their order depends only on the
    /// bonded pebbles.
    pub(super) fn bind(&mut self, mut bonds: Vec<Bond<R>>) -> Result<(), CellTooSmall> {
        bonds.sort_by_key(|bond| (bond.glue, bond.low, bond.high));
        let idle = self.owner.len() as u32;
        let mut blocks = Vec::new();
        for run in bonds.chunk_by(|a, b| a.glue == b.glue) {
            for chunk in run.chunks(BLOCK) {
                let mut block = Block::empty(chunk[0].glue, idle);
                for (lane, bond) in chunk.iter().enumerate() {
                    self.put_bond(&mut block, lane, bond)?;
                }
                blocks.push(block);
            }
        }
        self.bonds.blocks = blocks;
        Ok(())
    }

    fn put_bond(&self, block: &mut Block<R>, lane: usize, bond: &Bond<R>) -> Result<(), CellTooSmall> {
        let [a, b] = [bond.low, bond.high].map(|name| self.pebble_of(name));
        let at = |pebble: u32| {
            let body = &self.bodies[self.owner[pebble as usize] as usize];
            (body.cell, self.records[pebble as usize].position())
        };
        block.names[lane] = [bond.low, bond.high];
        (block.first[lane], block.second[lane]) = (a, b);
        block.image[lane] = self.domain.image(at(a), at(b)).ok_or(CellTooSmall)?;
        block.start[lane] = bond.start;
        block.holds[lane] = R::from_f64(1.0);
        (0..3).for_each(|c| block.shear[c][lane] = bond.shear[c]);
        Ok(())
    }

    /// Index of a pebble in memory.
    fn pebble_of(&self, (body, part): Name) -> u32 {
        self.bodies[self.index[body as usize] as usize].first + u32::from(part)
    }

    /// The spring of the bond at a place; `None` if no intact bond is there.
    pub(super) fn bond_link(&self, place: usize) -> Option<Link> {
        let [a, b] = self.bonds.pebbles(place)?;
        let block = &self.bonds.blocks[place / BLOCK];
        let tangent = self.bonds.glues[usize::from(block.glue)].tangent();
        Some(self.link(a, b, block.image[place % BLOCK], tangent))
    }

    /// Adds the forces of bonds to the states of their contacts; a bond whose pebbles are apart is a separate contact.
    pub(super) fn add_bonds(&self, states: &mut Vec<ContactState>) {
        let before = self.contacts.len() + self.wall_contacts.slots.len();
        let listed: HashMap<(Party, Party), usize> =
            states.iter().enumerate().map(|(number, state)| ((state.first, state.second), number)).collect();
        for place in 0..self.bonds.places() {
            let Some([a, b]) = self.bonds.pebbles(place) else { continue };
            let force = force_of(&self.contacts.outcomes[before + place]);
            let [low, high] = [a, b].map(|pebble| self.party(pebble));
            match listed.get(&(low, high)) {
                Some(&number) => states[number].force = add(states[number].force, force),
                None => states.push(self.bond_state(place, [a, b], force)),
            }
        }
    }

    fn bond_state(&self, place: usize, [a, b]: [u32; 2], force: Vec3) -> ContactState {
        let image = self.domain.shift(self.bonds.blocks[place / BLOCK].image[place % BLOCK]);
        let apart = add(sub(self.offset(a), self.offset(b)), image);
        let distance = norm(apart);
        let normal = scale(apart, 1.0 / distance);
        let [first, second] = [a, b].map(|pebble| self.records[pebble as usize].radius());
        let overlap = first + second - distance;
        ContactState {
            first: self.party(a),
            second: self.party(b),
            force,
            normal,
            overlap,
            point: sub(self.place_of(a), scale(normal, first - 0.5 * overlap)),
            branch: add(sub(self.centre(a), self.centre(b)), image),
        }
    }
}

impl<R: Real> Block<R> {
    fn empty(glue: u16, idle: u32) -> Block<R> {
        Block {
            glue,
            names: [[(0, 0); 2]; BLOCK],
            // a pair far apart
            first: [idle; BLOCK],
            second: [idle + 1; BLOCK],
            image: [0; BLOCK],
            start: [R::default(); BLOCK],
            holds: [R::default(); BLOCK],
            shear: [[R::default(); BLOCK]; 3],
        }
    }
}
