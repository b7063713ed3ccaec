//! Lists of possible contacts: bodies sorted by position, pairs found, contact histories carried over.
//!
//! Lists do not change the motion by a single bit. The contacts of a pebble are summed in an order that depends only on
//! its neighbours, so the number of lists made and their reach affect only the speed.

use super::bed::Bed;
use super::body::{Body, Clump, SPHERE};
use super::contacts::{BlockVector, Contacts};
use super::domain::{Image, mirrored, steps_of};
use super::entry::Entry;
use super::failure::Failure;
use super::force::Outcome;
use super::incidence::Incidence;
use super::lanes::{BLOCK, Real};
use super::order::Strips;
use super::record::Record;
use super::search::{CellTooSmall, Grids, Pair, Seen};
use super::tasks::{TASK, Task};
use super::vector::sub;
use super::walls::{Kept, Near, WallContacts};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Number of steps after which the bed checks whether bodies have left their cells.
const SETTLE: u64 = 128;
/// Rounding error of a displacement in single precision \[m\].
const SLACK: f64 = 1e-6;

/// A contact that continues in a new list, between a lower and a higher body.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Carried<R> {
    pub low: (u32, u16),
    pub high: (u32, u16),
    /// Shear force on the lower body.
    pub shear: [R; 3],
    pub damping: [R; 3],
}

/// Contact histories by the lower of two bodies.
struct Histories<R> {
    start: Vec<u32>,
    all: Vec<Carried<R>>,
}

impl<R: Real> Histories<R> {
    fn new(mut all: Vec<Carried<R>>, bodies: usize) -> Self {
        let mut start = vec![0u32; bodies + 1];
        all.iter().for_each(|c| start[c.low.0 as usize + 1] += 1);
        (0..bodies).for_each(|b| start[b + 1] += start[b]);
        all.par_sort_unstable_by_key(|c| (c.low, c.high));
        Histories { start, all }
    }

    fn find(&self, low: (u32, u16), high: (u32, u16)) -> Option<&Carried<R>> {
        let range = self.start[low.0 as usize] as usize..self.start[low.0 as usize + 1] as usize;
        self.all[range].iter().find(|c| c.low == low && c.high == high)
    }
}

/// Pairs of a task in blocks; the names are those of [`Contacts`].
#[derive(Default)]
struct Blocked {
    first: Vec<u32>,
    second: Vec<u32>,
    image: Vec<Image>,
    law: Vec<u16>,
}

impl<R: Real> Bed<R> {
    /// Checks new parts, and makes new lists if the present lists are no longer valid.
    pub(super) fn refresh(&mut self) -> Result<(), Failure> {
        if self.unchecked {
            self.check()?;
            self.unchecked = false;
        }
        if self.lists.outdated {
            return Ok(self.rebuild()?);
        }
        if self.lists.is_valid() {
            return Ok(());
        }
        // a bound is used up; the actual distances decide
        self.measure();
        if self.lists.is_valid() { Ok(()) } else { Ok(self.rebuild()?) }
    }

    fn rebuild(&mut self) -> Result<(), CellTooSmall> {
        let carried = self.carried();
        let kept = self.kept();
        let done = self.rebuild_with(carried, kept);
        // unfinished lists must not be used
        self.lists.outdated |= done.is_err();
        done
    }

    /// Contact histories of all contacts between pebbles.
    pub(super) fn carried(&self) -> Vec<Carried<R>> {
        let blocks = (0..self.contacts.law.len()).into_par_iter().with_min_len(256);
        blocks.flat_map_iter(|block| (0..BLOCK).filter_map(move |lane| self.history(block, lane))).collect()
    }

    /// History of the contact in a lane of a block; `None` if it has none.
    fn history(&self, block: usize, lane: usize) -> Option<Carried<R>> {
        let contacts = &self.contacts;
        let of =
            |vectors: &[BlockVector<R>]| [0, 1, 2].map(|c| vectors.get(block).map_or(R::default(), |v| v[c][lane]));
        let (shear, damping) = (of(&contacts.shear), of(&contacts.damping));
        if shear.iter().chain(&damping).all(|&s| s == R::default()) {
            return None;
        }
        let place = block * BLOCK + lane;
        let (a, b) = (self.name(contacts.first[place]), self.name(contacts.second[place]));
        let swap = |v: [R; 3]| if a < b { v } else { v.map(|c| -c) };
        Some(Carried { low: a.min(b), high: a.max(b), shear: swap(shear), damping: swap(damping) })
    }

    pub(super) fn kept(&self) -> Vec<Kept<R>> {
        self.wall_contacts.keep(|pebble| self.name(pebble))
    }

    /// Number of the body in the order of creation, and index of the pebble in the body.
    pub(super) fn name(&self, pebble: u32) -> (u32, u16) {
        let body = &self.bodies[self.owner[pebble as usize] as usize];
        (body.id, (pebble - body.first) as u16)
    }

    pub(super) fn rebuild_with(&mut self, carried: Vec<Carried<R>>, kept: Vec<Kept<R>>) -> Result<(), CellTooSmall> {
        self.choose_rest();
        self.sort();
        self.spread_reach();
        let histories = Histories::new(carried, self.bodies.len());
        // the memory of the outcomes is used again: new memory costs more than the sums of a step
        let outcomes = std::mem::take(&mut self.contacts.outcomes);
        self.contacts = Contacts { outcomes, ..Contacts::default() };
        self.incidence = Incidence::default();
        let seen = self.seen();
        let domain = self.domain;
        let (pairs, wall_contacts) = {
            let grids = Grids::new(&domain, &seen, SLACK);
            let about = |pebble: u32| {
                let (body, part) = self.name(pebble);
                (body, part, self.bodies[self.owner[pebble as usize] as usize].surface)
            };
            let near = Near { domain: &domain, seen: &seen, grids: &grids, skin: SLACK, reach: &self.lists.wall_reach };
            // not in parallel with the pairs: memory allocated by another thread for the wall lists slowed the wall
            // forces by a quarter
            let walls = WallContacts::find(&self.walls, near, &self.laws, about, &kept);
            (grids.pairs(SLACK)?, walls)
        };
        drop(seen);
        self.wall_contacts = wall_contacts;
        self.fill(pairs, &histories);
        drop(histories);
        self.rebind()?;
        self.connect();
        self.remember();
        Ok(())
    }

    /// Moves bodies that are far outside their cells into the cells of their positions. This rounds their offsets, so
    /// it is done at fixed steps and does not depend on when lists are made.
    pub(super) fn settle(&mut self) {
        if !self.steps.is_multiple_of(SETTLE) {
            return;
        }
        for body in &mut self.bodies {
            let records = &mut self.records[body.first as usize..body.first as usize + usize::from(body.pebbles)];
            let centre = match body.clump {
                SPHERE => records[0].position(),
                clump => self.clumps[clump as usize].centre,
            };
            if self.domain.near_cell(centre) {
                continue;
            }
            let (cell, offset) = self.domain.settle(body.cell, centre);
            body.cell = cell;
            self.lists.outdated = true;
            let moved = sub(centre, offset);
            for record in records {
                record.place(sub(record.position(), moved));
            }
            match body.clump {
                SPHERE => self.records[body.first as usize].place(offset),
                clump => self.clumps[clump as usize].centre = offset,
            }
        }
    }

    /// Sorts bodies so that neighbours are close in memory.
    fn sort(&mut self) {
        let place = |body: &Body| {
            let first = self.records[body.first as usize].position();
            self.domain.place(self.domain.wrap(body.cell), first)
        };
        let strips = Strips::through(self.bodies.iter().map(place));
        let key = |(index, body)| (strips.key(place(body)), index as u32);
        let mut order: Vec<(u64, u32)> = self.bodies.par_iter().enumerate().map(key).collect();
        order.par_sort_unstable_by_key(|&(key, index)| (key, self.bodies[index as usize].id));
        if order.iter().enumerate().all(|(new, &(_, old))| new as u32 == old) {
            self.records.truncate(self.owner.len());
        } else {
            self.permute(&order);
        }
        // a pair far apart, which fills up blocks
        for x in [0.0, 1e3] {
            let mut idle = R::Record::new(0.0, 1.0);
            idle.place([x, 0.0, 0.0]);
            self.records.push(idle);
        }
    }

    fn permute(&mut self, order: &[(u64, u32)]) {
        let (mut bodies, mut clumps) = (Vec::with_capacity(order.len()), Vec::with_capacity(self.clumps.len()));
        let mut owner = Vec::with_capacity(self.owner.len());
        let mut arms = 0;
        for (new, &(_, old)) in order.iter().enumerate() {
            let mut body = self.bodies[old as usize];
            body.first = owner.len() as u32;
            owner.resize(owner.len() + usize::from(body.pebbles), new as u32);
            if body.clump != SPHERE {
                let clump = self.clumps[body.clump as usize];
                clumps.push(Clump { arms, ..clump });
                arms += u64::from(body.pebbles);
                body.clump = clumps.len() as u32 - 1;
            }
            self.index[body.id as usize] = new as u32;
            bodies.push(body);
        }
        let old = |&(_, old): &(u64, u32)| &self.bodies[old as usize];
        // with room for two idle ones
        let mut records = Vec::with_capacity(self.owner.len() + 2);
        records.par_extend(order.par_iter().map(old).flat_map_iter(|body| {
            let first = body.first as usize;
            self.records[first..first + usize::from(body.pebbles)].iter().copied()
        }));
        let arms = order.par_iter().map(old).filter(|body| body.clump != SPHERE).flat_map_iter(|body| {
            let first = self.clumps[body.clump as usize].arms as usize;
            self.arms[first..first + usize::from(body.pebbles)].iter().copied()
        });
        (self.records, self.arms) = (records, arms.collect());
        (self.owner, self.clumps, self.bodies) = (owner, clumps, bodies);
    }

    fn seen(&self) -> Vec<Seen> {
        let of = |(pebble, &body): (usize, &u32)| {
            let record = &self.records[pebble];
            let cell = self.bodies[body as usize].cell;
            let radius = record.radius() + f64::from(self.lists.reach[pebble]);
            Seen { cell, offset: record.position(), radius, body }
        };
        self.owner.par_iter().enumerate().map(of).collect()
    }

    /// Puts pairs into blocks with one law each, task by task, with their histories.
    fn fill(&mut self, pairs: Vec<Vec<Pair>>, histories: &Histories<R>) {
        let mut tasks = self.tasks();
        let blocked: Vec<Blocked> =
            self.by_task(&pairs, tasks.len() - 1).into_par_iter().map(|pairs| self.blocked(pairs)).collect();
        drop(pairs);
        let outcomes = std::mem::take(&mut self.contacts.outcomes);
        let mut contacts = Contacts { outcomes, ..Contacts::default() };
        let blocks = blocked.iter().map(|blocked| blocked.law.len()).sum::<usize>();
        contacts.first.reserve(blocks * BLOCK);
        contacts.second.reserve(blocks * BLOCK);
        contacts.image.reserve(blocks * BLOCK);
        for (task, blocked) in tasks.iter_mut().zip(blocked) {
            task.block = contacts.law.len() as u32;
            contacts.first.extend(blocked.first);
            contacts.second.extend(blocked.second);
            contacts.image.extend(blocked.image);
            contacts.law.extend(blocked.law);
        }
        tasks.last_mut().expect("an end").block = contacts.law.len() as u32;
        self.lists.tasks = tasks;
        let zero = [[R::default(); BLOCK]; 3];
        contacts.shear = vec![zero; contacts.law.len()];
        if self.ledger.watched {
            contacts.damping = vec![zero; contacts.law.len()];
        }
        if !histories.all.is_empty() {
            self.hand_over(histories, &mut contacts);
        }
        self.contacts = contacts;
    }

    /// Blocks of the pairs of a task, with one law each.
    fn blocked(&self, mut pairs: Vec<Pair>) -> Blocked {
        let idle = self.owner.len() as u32;
        let class = |pair: &Pair| {
            let surface = |pebble: u32| self.bodies[self.owner[pebble as usize] as usize].surface;
            self.laws.class(surface(pair.first), surface(pair.second))
        };
        pairs.sort_by_cached_key(class);
        let mut blocked = Blocked::default();
        for run in pairs.chunk_by(|a, b| class(a) == class(b)) {
            blocked.first.extend(run.iter().map(|p| p.first));
            blocked.second.extend(run.iter().map(|p| p.second));
            blocked.image.extend(run.iter().map(|p| p.image));
            let padded = blocked.first.len().next_multiple_of(BLOCK);
            blocked.first.resize(padded, idle);
            blocked.second.resize(padded, idle + 1);
            blocked.image.resize(padded, 0);
            blocked.law.resize(padded / BLOCK, class(&run[0]));
        }
        blocked
    }

    /// Puts the histories of contacts that continue into their places.
    fn hand_over(&self, histories: &Histories<R>, contacts: &mut Contacts<R>) {
        let Contacts { first, second, shear, damping, .. } = contacts;
        let idle = self.owner.len() as u32;
        let carried = |place: usize| {
            let (a, b) = (self.name(first[place]), self.name(second[place]));
            let sign = if a < b { R::from_f64(1.0) } else { R::from_f64(-1.0) };
            histories.find(a.min(b), a.max(b)).map(|carried| (sign, carried))
        };
        let put = |(block, values): (usize, &mut BlockVector<R>), part: fn(&Carried<R>) -> [R; 3]| {
            for lane in (0..BLOCK).filter(|lane| first[block * BLOCK + lane] != idle) {
                let Some((sign, carried)) = carried(block * BLOCK + lane) else { continue };
                (0..3).for_each(|c| values[c][lane] = sign * part(carried)[c]);
            }
        };
        shear.par_iter_mut().enumerate().with_min_len(64).for_each(|block| put(block, |carried| carried.shear));
        damping.par_iter_mut().enumerate().with_min_len(64).for_each(|block| put(block, |carried| carried.damping));
    }

    /// Renumbers the intact bonds, drops the broken bonds, and allocates the results of all contacts.
    fn rebind(&mut self) -> Result<(), CellTooSmall> {
        self.bonds.dropped = self.broken_bonds();
        self.bind(self.bonds.held())?;
        let places = self.contacts.len() + self.wall_contacts.slots.len() + self.bonds.places();
        // and one that stays 0
        self.contacts.outcomes.clear();
        self.contacts.outcomes.resize(places + 1, Outcome::default());
        Ok(())
    }

    /// First indices of the tasks; blocks are not known yet.
    fn tasks(&self) -> Vec<Task> {
        let mut tasks = Vec::new();
        let mut clump = 0;
        for (place, body) in self.bodies.iter().enumerate() {
            if place % TASK == 0 {
                tasks.push(Task { body: place as u32, pebble: body.first, clump, block: 0, group: 0 });
            }
            clump += u32::from(body.clump != SPHERE);
        }
        tasks.push(Task { body: self.bodies.len() as u32, pebble: self.owner.len() as u32, clump, block: 0, group: 0 });
        tasks
    }

    /// Pairs by the task of the earlier of their bodies; most pairs are found in this task.
    fn by_task(&self, pairs: &[Vec<Pair>], tasks: usize) -> Vec<Vec<Pair>> {
        let task = |pair: &Pair| self.owner[pair.first as usize].min(self.owner[pair.second as usize]) as usize / TASK;
        // numbers of the tasks in which the pairs of a list are, in the order of the pairs
        let found: Vec<Vec<(usize, Vec<Pair>)>> = pairs
            .par_iter()
            .map(|list| {
                let mut parts: BTreeMap<usize, Vec<Pair>> = BTreeMap::new();
                list.iter().for_each(|pair| parts.entry(task(pair)).or_default().push(*pair));
                parts.into_iter().collect()
            })
            .collect();
        let mut sorted = vec![Vec::new(); tasks];
        found.into_iter().flatten().for_each(|(task, part)| sorted[task].extend(part));
        sorted
    }

    /// Lists the contacts of each pebble in an order that is the same in all copies of a bay.
    fn connect(&mut self) {
        let (pebbles, outcomes) = (self.owner.len(), self.contacts.outcomes.len());
        assert!(outcomes < 1 << 31, "contacts are numbered by 31 bits");
        // every thread reads all contacts, and lists those of its own pebbles
        let share = pebbles.div_ceil(rayon::current_num_threads()).max(1);
        let mut start = vec![0u32; pebbles + 1];
        start[1..].par_chunks_mut(share).enumerate().for_each(|(part, counts)| {
            self.each_entry(|pebble, _| {
                if let Some(count) = counts.get_mut((pebble as usize).wrapping_sub(part * share)) {
                    *count += 1;
                }
            });
        });
        (0..pebbles).for_each(|p| start[p + 1] += start[p]);
        let mut entries = vec![Entry::new(0, false); start[pebbles] as usize];
        let (mut rest, mut parts) = (&mut entries[..], Vec::new());
        for first in (0..pebbles).step_by(share) {
            let own = &start[first..=(first + share).min(pebbles)];
            let (part, others) = rest.split_at_mut((own[own.len() - 1] - own[0]) as usize);
            parts.push((first, own, part));
            rest = others;
        }
        parts.into_par_iter().for_each(|(first, own, part)| self.list(first, own, part));
        let nothing = Entry::new(outcomes as u32 - 1, false);
        self.incidence = Incidence::new(start, entries, &mut self.lists.tasks, nothing);
    }

    /// Lists the contacts of the pebbles from `first` on; `start` holds their first entries and one final value.
    fn list(&self, first: usize, start: &[u32], entries: &mut [Entry]) {
        let place = |start: u32, of: &[u32]| (start - of[0]) as usize;
        let mut next: Vec<usize> = start[..start.len() - 1].iter().map(|&s| place(s, start)).collect();
        self.each_entry(|pebble, entry| {
            if let Some(next) = next.get_mut((pebble as usize).wrapping_sub(first)) {
                entries[*next] = entry;
                *next += 1;
            }
        });
        for ends in start.windows(2) {
            let list = &mut entries[place(ends[0], start)..place(ends[1], start)];
            list.sort_unstable_by_key(|&entry| self.order_of(entry));
        }
    }

    /// Visits every contact, once for each of its pebbles.
    fn each_entry(&self, mut visit: impl FnMut(u32, Entry)) {
        let (contacts, idle) = (&self.contacts, self.owner.len() as u32);
        for place in (0..contacts.len()).filter(|&place| contacts.first[place] != idle) {
            visit(contacts.first[place], Entry::new(place as u32, false));
            visit(contacts.second[place], Entry::new(place as u32, true));
        }
        let walls = contacts.len() as u32;
        for entry in &self.wall_contacts.entries {
            (entry.slots.0..entry.slots.1).for_each(|slot| visit(entry.pebble, Entry::new(walls + slot, false)));
        }
        let bonds = walls + self.wall_contacts.slots.len() as u32;
        for place in 0..self.bonds.places() {
            let Some([first, second]) = self.bonds.pebbles(place) else { continue };
            visit(first, Entry::new(bonds + place as u32, false));
            visit(second, Entry::new(bonds + place as u32, true));
        }
    }

    /// Sort key of a contact among the contacts of its pebble: first the cell of the neighbour relative to the pebble,
    /// then the rank of the neighbour. Walls and bonds come last, in a separate order.
    fn order_of(&self, entry: Entry) -> (u8, u32, u32) {
        let place = entry.place();
        if place >= self.contacts.len() {
            return (u8::MAX, 0, place as u32);
        }
        let (other, image) = match entry.is_second() {
            false => (self.contacts.second[place], self.contacts.image[place]),
            true => (self.contacts.first[place], mirrored(self.contacts.image[place])),
        };
        let [x, y, z] = steps_of(image).map(|s| (s + 1) as u8);
        let body = &self.bodies[self.owner[other as usize] as usize];
        (16 * x + 4 * y + z, body.rank, other - body.first)
    }
}
