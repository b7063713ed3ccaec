//! Copies of a periodic cell side by side (periodic cell replication, methods 1.7).

use super::bed::Bed;
use super::bonds::Bonds;
use super::build::Carried;
use super::domain::steps_of;
use super::failure::Failure;
use super::lanes::{BLOCK, Real};

impl<R: Real> Bed<R> {
    /// `count` copies along x of a bed with one period, with velocities and contact histories.
    ///
    /// Copies of a body keep its rank, and have the same offset in their bay. So they continue bit by bit like the
    /// original until one bay is treated differently. Planes are shared; a wall that ends is copied into every bay.
    /// Bodies are numbered copy by copy: body `i` of copy `c` is `c len + i`.
    ///
    /// # Panics
    /// If the bed is not one period along x, or `count` is 0.
    pub fn replicate(&mut self, count: u32) -> Result<Bed<R>, Failure> {
        assert!(count > 0, "a bed of no copies");
        let length = self.domain.period(0).filter(|_| self.domain.cells(0) == Some(1)).expect("one period along x");
        self.refresh()?;
        let mut copy: Bed<R> = self.clone();
        copy.domain = self.domain.periodic_bays(length, count);
        copy.bonds = Bonds::default();
        self.copy_bodies(&mut copy, count);
        let walls = self.copy_walls(&mut copy, count);
        let (bodies, bays) = (self.bodies.len() as u32, count as i32);
        let mut carried = Vec::new();
        for (near, image) in self.carried_with_images() {
            for bay in 0..bays {
                // the lower body is in this bay, and its neighbour as many bays away as the image says
                let other = (bay - steps_of(image)[0]).rem_euclid(bays) as u32;
                let (low, high) =
                    ((bay as u32 * bodies + near.low.0, near.low.1), (other * bodies + near.high.0, near.high.1));
                let swap = |v: [R; 3]| if low < high { v } else { v.map(|c| -c) };
                carried.push(Carried {
                    low: low.min(high),
                    high: low.max(high),
                    shear: swap(near.shear),
                    damping: swap(near.damping),
                });
            }
        }
        let mut kept = Vec::new();
        for touch in self.kept() {
            for bay in 0..count {
                let wall = walls[touch.wall as usize]
                    + if self.walls[touch.wall as usize].shape.bounds().is_some() { bay } else { 0 };
                kept.push(super::walls::Kept { wall, body: bay * bodies + touch.body, ..touch });
            }
        }
        kept.sort_by_key(|k| (k.wall, k.body, k.pebble));
        copy.lists.outdated = true;
        copy.rebuild_with(carried, kept)?;
        Ok(copy)
    }

    fn copy_bodies(&self, copy: &mut Bed<R>, count: u32) {
        let (bodies, pebbles, clumps) = (self.bodies.len(), self.owner.len(), self.clumps.len());
        copy.records.truncate(pebbles);
        copy.bodies.clear();
        copy.owner.clear();
        copy.index.clear();
        for bay in 0..count {
            for body in &self.bodies {
                let mut body = *body;
                body.cell[0] = bay as i32;
                body.id += bay * bodies as u32;
                body.first += bay * pebbles as u32;
                if body.clump != super::body::SPHERE {
                    body.clump += bay * clumps as u32;
                }
                copy.bodies.push(body);
            }
            copy.owner.extend(self.owner.iter().map(|owner| owner + bay * bodies as u32));
            copy.index.extend(self.index.iter().map(|place| place + bay * bodies as u32));
            if bay > 0 {
                copy.records.extend_from_slice(&self.records[..pebbles]);
                copy.clumps.extend_from_slice(&self.clumps);
            }
        }
    }

    /// Returns the first number of the copies of each wall.
    fn copy_walls(&self, copy: &mut Bed<R>, count: u32) -> Vec<u32> {
        copy.walls.clear();
        let mut first = Vec::new();
        for wall in &self.walls {
            first.push(copy.walls.len() as u32);
            let bays = if wall.shape.bounds().is_some() { count } else { 1 };
            for bay in 0..bays {
                let mut wall = wall.clone();
                wall.cell[0] = bay as i32;
                copy.walls.push(wall);
            }
        }
        first
    }

    /// Histories, and the number of cells by which the lower of the two bodies is shifted.
    pub(super) fn carried_with_images(&self) -> Vec<(Carried<R>, super::domain::Image)> {
        let contacts = &self.contacts;
        (0..contacts.len())
            .filter(|&place| (contacts.first[place] as usize) < self.owner.len())
            .map(|place| {
                let (block, lane) = (place / BLOCK, place % BLOCK);
                let of = |all: &[super::contacts::BlockVector<R>]| {
                    [0, 1, 2].map(|c| all.get(block).map_or(R::default(), |v| v[c][lane]))
                };
                let (a, b) = (self.name(contacts.first[place]), self.name(contacts.second[place]));
                let (shear, damping) = (of(&contacts.shear), of(&contacts.damping));
                let image = contacts.image[place];
                if a < b {
                    (Carried { low: a, high: b, shear, damping }, image)
                } else {
                    let swap = |v: [R; 3]| v.map(|c| -c);
                    let carried = Carried { low: b, high: a, shear: swap(shear), damping: swap(damping) };
                    (carried, super::domain::mirrored(image))
                }
            })
            .collect()
    }
}
