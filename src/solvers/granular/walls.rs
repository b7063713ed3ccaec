//! Contacts of pebbles with walls: one evaluation per pebble and wall, with all contacts of the shape there.

// loops run over the lanes of several arrays at once; iterator chains made them a third slower
#![allow(clippy::needless_range_loop)]

use super::contacts::{BlockVector, ContactEnergy, Surroundings};
use super::domain::Domain;
use super::force::{ContactForces, Meeting, Outcome, Tangent, outcome};
use super::lanes::{BLOCK, Lanes, Num, Plain, Real, Row, Vector, Work};
use super::law::ContactLaws;
use super::motion::{Felt, Pose, WallMotion};
use super::prefetch::prefetch;
use super::record::Record;
use super::search::{Grids, Seen};
use super::shape::{Shape, Touch, inherit};
use super::sheet::Sheet;
use super::vector::{Vec3, add, cross, dot, norm, scale, sub};
use nalgebra::Vector3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Entries of one task. The number is fixed, so that the number of threads does not change the results.
const CHUNK: usize = 128;
const NONE: u32 = u32::MAX;

/// Number of a wall in the order of creation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct WallId(pub u32);

/// A rigid surface with a given motion; it records its contact forces.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Wall {
    pub shape: Shape,
    /// Position in its cell of the domain \[m\].
    pub(super) pose: Pose,
    pub(super) cell: [i32; 3],
    pub(super) surface: u16,
    pub(super) motion: WallMotion,
    /// Velocities of the last half step \[m/s\], \[rad/s\].
    pub(super) velocity: Vector3<f64>,
    pub(super) spin: Vector3<f64>,
    pub(super) felt: Felt,
    /// Moment about the origin of the frame of the wall \[N m\].
    pub(super) moment: Vec3,
    /// Moving corners of a plane that is a floor.
    #[serde(default)]
    pub(super) sheet: Option<Box<Sheet>>,
}

impl Wall {
    /// Force \[N\], sum of normal stiffnesses \[N/m\] and number of contacts at the start of the last step.
    pub fn felt(&self) -> &Felt {
        &self.felt
    }

    /// Moment on the wall about the origin of its frame \[N m\].
    pub fn moment(&self) -> [f64; 3] {
        self.moment
    }

    /// Velocity \[m/s\] and angular velocity \[rad/s\] of the last step.
    pub fn velocity(&self) -> ([f64; 3], [f64; 3]) {
        (self.velocity.into(), self.spin.into())
    }

    pub fn motion(&self) -> &WallMotion {
        &self.motion
    }

    pub fn surface(&self) -> u16 {
        self.surface
    }

    /// The corners of a deformable floor.
    pub fn sheet(&self) -> Option<&Sheet> {
        self.sheet.as_deref()
    }

    /// Pose of the wall, its position not wrapped into the period.
    pub fn pose(&self, domain: &Domain) -> Pose {
        Pose { position: domain.place(self.cell, self.pose.position.into()).into(), ..self.pose }
    }

    /// Largest speed of a point of the wall; for a plane, within `extent` \[m\] of its origin \[m/s\].
    pub(super) fn fastest(&self, extent: f64) -> f64 {
        let sheet = self.sheet.as_ref().map_or(0.0, |sheet| sheet.fastest());
        self.velocity.norm() + self.spin.norm() * self.reach(extent) + sheet
    }

    /// Distance of its farthest point from its origin; for a plane, `extent` \[m\].
    fn reach(&self, extent: f64) -> f64 {
        self.shape.bounds().map_or(extent, |[low, high]| low.norm().max(high.norm()))
    }

    /// Contact points of a sphere with the wall, `away` from its origin, in the frame of the wall; a deformable floor
    /// is not rotated.
    #[inline]
    pub(super) fn touches(&self, away: Vec3, radius: f64, facets: &[u32], touches: &mut Vec<Touch>) {
        match &self.sheet {
            Some(sheet) => {
                touches.clear();
                touches.extend(sheet.touch(away, radius));
            }
            None => self.shape.touches(&self.turned_back(away), radius, facets, touches),
        }
    }

    /// A vector of space in the frame of the wall.
    pub(super) fn turned_back(&self, v: Vec3) -> Vector3<f64> {
        Pose { position: Vector3::zeros(), ..self.pose }.to_frame(&v.into())
    }

    /// Vector from the origin of the wall to a pebble \[m\].
    #[inline(always)]
    pub(super) fn to(&self, domain: &Domain, cell: [i32; 3], offset: Vec3) -> Vec3 {
        let origin = self.pose.position.into();
        let middle = match self.shape.bounds() {
            // the shorter way is measured to the middle of the surface, for any origin of its frame
            Some([low, high]) if low != -high && (0..3).any(|axis| domain.period(axis).is_some()) => {
                self.pose.direction_to_space(&((low + high) / 2.0)).into()
            }
            _ => return domain.between((cell, offset), (self.cell, origin)),
        };
        add(domain.between((cell, offset), (self.cell, add(origin, middle))), middle)
    }
}

/// A pebble that may touch a wall.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub wall: u32,
    pub pebble: u32,
    /// Cell of the pebble: if it changes, new lists are made.
    cell: [i32; 3],
    pub law: u16,
    pub facets: (u32, u32),
    pub slots: (u32, u32),
}

/// Memory for one contact of an entry.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slot<R> {
    pub feature: u32,
    pub normal: Vec3,
    pub shear: [R; 3],
    damping: [R; 3],
    /// Force on the pebble \[N\].
    force: [R; 3],
    /// From the origin of the wall to the contact point \[m\].
    point: Vec3,
    pub overlap: f64,
    /// Tangent stiffness of the normal spring \[N/m\] and of its dashpot \[N s/m\].
    stiffness: [f64; 2],
}

impl<R: Real> Slot<R> {
    const fn empty(zero: R) -> Self {
        let (vector, none) = ([0.0; 3], [zero; 3]);
        let (normal, point) = (vector, vector);
        let (shear, damping, force) = (none, none, none);
        Slot { feature: NONE, normal, shear, damping, force, point, overlap: 0.0, stiffness: [0.0; 2] }
    }

    pub fn touches(&self) -> bool {
        self.feature != NONE
    }
}

/// Contacts with walls, sorted by wall and then by pebble.
#[derive(Debug, Clone, Default)]
pub(super) struct WallContacts<R> {
    pub entries: Vec<Entry>,
    pub facets: Vec<u32>,
    pub slots: Vec<Slot<R>>,
}

/// A contact with a wall that continues in a new list.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Kept<R> {
    pub wall: u32,
    pub body: u32,
    pub pebble: u16,
    pub feature: u32,
    pub normal: Vec3,
    pub shear: [R; 3],
    pub damping: [R; 3],
}

/// Pebbles in their grids, for contacts up to `skin` \[m\] apart.
#[derive(Clone, Copy)]
pub(super) struct Near<'a> {
    pub domain: &'a Domain,
    pub seen: &'a [Seen],
    pub grids: &'a Grids<'a>,
    pub skin: f64,
    /// Distance that each wall may move \[m\].
    pub reach: &'a [f64],
}

impl<R: Real> WallContacts<R> {
    /// Lists the pebbles within `skin` of a wall; `name` gives body and pebble, `surface` the surface of a pebble.
    pub fn find(
        walls: &[Wall],
        around: Near,
        laws: &ContactLaws,
        about: impl Fn(u32) -> (u32, u16, u16) + Sync,
        kept: &[Kept<R>],
    ) -> Self {
        let Near { domain, seen, .. } = around;
        let mut all = WallContacts::default();
        let mut near = Vec::new();
        for (number, wall) in walls.iter().enumerate() {
            let around = Near { skin: around.skin + around.reach[number], ..around };
            let named = wall.candidates(around).into_par_iter().map(|pebble| (about(pebble), pebble));
            let mut candidates: Vec<((u32, u16, u16), u32)> = named.collect();
            candidates.par_sort_unstable();
            candidates.dedup();
            for ((body, part, surface), pebble) in candidates {
                let me = &seen[pebble as usize];
                let away = wall.to(domain, me.cell, me.offset);
                if !wall.near(domain, away, me.radius + around.skin, &mut near) {
                    continue;
                }
                let room = if matches!(wall.shape, Shape::Mesh(_)) { near.len() as u32 } else { 1 };
                let (facet, slot) = (all.facets.len() as u32, all.slots.len() as u32);
                all.facets.extend(&near);
                all.slots.extend((0..room).map(|_| Slot::empty(R::default())));
                all.entries.push(Entry {
                    wall: number as u32,
                    pebble,
                    cell: me.cell,
                    law: laws.class(surface, wall.surface),
                    facets: (facet, all.facets.len() as u32),
                    slots: (slot, slot + room),
                });
                let mine = kept
                    .iter()
                    .skip(kept.partition_point(|k| (k.wall, k.body, k.pebble) < (number as u32, body, part)));
                let mine = mine.take_while(|k| (k.wall, k.body, k.pebble) == (number as u32, body, part));
                for (slot, k) in all.slots[slot as usize..].iter_mut().zip(mine) {
                    *slot = Slot { feature: k.feature, normal: k.normal, shear: k.shear, damping: k.damping, ..*slot };
                }
            }
        }
        all
    }

    /// The contacts with a force, sorted, for carrying over.
    pub fn keep(&self, about: impl Fn(u32) -> (u32, u16)) -> Vec<Kept<R>> {
        let mut kept = Vec::new();
        for entry in &self.entries {
            let (body, pebble) = about(entry.pebble);
            for slot in self.slots(entry).iter().filter(|s| s.touches()) {
                let &Slot { feature, normal, shear, damping, .. } = slot;
                kept.push(Kept { wall: entry.wall, body, pebble, feature, normal, shear, damping });
            }
        }
        kept.sort_by_key(|k| (k.wall, k.body, k.pebble));
        kept
    }

    pub fn slots(&self, entry: &Entry) -> &[Slot<R>] {
        &self.slots[entry.slots.0 as usize..entry.slots.1 as usize]
    }

    /// Computes every force. `outcomes` has a place for each slot.
    pub fn evaluate(
        &mut self,
        walls: &[Wall],
        laws: &ContactLaws,
        domain: &Domain,
        around: Surroundings<R>,
        outcomes: &mut [Outcome<R>],
        watched: bool,
    ) -> ContactEnergy {
        let shared = Shared { walls, laws, domain, around, facets: &self.facets, watched };
        let mut passes = Vec::with_capacity(self.entries.len().div_ceil(CHUNK));
        let (mut slots, mut places) = (&mut self.slots[..], outcomes);
        for entries in self.entries.chunks(CHUNK) {
            let count = (entries[entries.len() - 1].slots.1 - entries[0].slots.0) as usize;
            let (some_slots, rest_slots) = slots.split_at_mut(count);
            let (some_places, rest_places) = places.split_at_mut(count);
            passes.push(Pass { shared, entries, slots: some_slots, places: some_places });
            (slots, places) = (rest_slots, rest_places);
        }
        let energies: Vec<ContactEnergy> = passes.into_par_iter().map(R::dispatch).collect();
        let mut total = ContactEnergy::default();
        energies.into_iter().for_each(|energy| total += energy);
        total
    }

    /// Sums the forces on each wall contact by contact, so that pebbles listed without contact have no effect.
    pub fn load(&self, walls: &mut [Wall]) {
        walls.par_iter_mut().with_max_len(1).enumerate().for_each(|(number, wall)| {
            let begin = |number: usize| self.entries.partition_point(|entry| (entry.wall as usize) < number);
            let own = &self.entries[begin(number)..begin(number + 1)];
            let slots = own.first().map_or(0, |e| e.slots.0) as usize..own.last().map_or(0, |e| e.slots.1) as usize;
            wall.feel(&self.slots[slots]);
        });
    }
}

impl Wall {
    /// Adds the forces of its contacts.
    fn feel<R: Real>(&mut self, slots: &[Slot<R>]) {
        let (mut felt, mut moment) = (Felt { velocity: self.velocity, ..Felt::default() }, [0.0; 3]);
        self.sheet.iter_mut().for_each(|sheet| sheet.unload());
        for slot in slots.iter().filter(|slot| slot.touches()) {
            let force = slot.force.map(R::to_f64);
            felt.force -= Vector3::from(force);
            felt.stiffness += slot.stiffness[0];
            felt.dashpot += slot.stiffness[1];
            felt.contacts += 1;
            moment = sub(moment, cross(slot.point, force));
            self.sheet.iter_mut().for_each(|sheet| sheet.load(slot.point, scale(force, -1.0), slot.stiffness[0]));
        }
        (self.felt, self.moment) = (felt, moment);
    }
}

impl Wall {
    /// Whether the surface is within reach of a pebble; for a mesh, the facets within reach, including those on the
    /// other side of a period, because the pebble may get there before the next list.
    fn near(&self, domain: &Domain, away: Vec3, reach: f64, facets: &mut Vec<u32>) -> bool {
        if let Some(sheet) = &self.sheet {
            facets.clear();
            return sheet.touch(away, reach).is_some();
        }
        let mut found = self.shape.near(&self.turned_back(away), reach, facets);
        let periods = [0, 1, 2].map(|axis| domain.period(axis));
        if !matches!(self.shape, Shape::Mesh(_)) || periods.iter().all(Option::is_none) {
            return found;
        }
        let mut more = Vec::new();
        for image in 0..27 {
            let steps = [image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1];
            if image == 13 || (0..3).any(|axis| steps[axis] != 0 && periods[axis].is_none()) {
                continue;
            }
            let there = [0, 1, 2].map(|axis| away[axis] + f64::from(steps[axis]) * periods[axis].unwrap_or(0.0));
            found |= self.shape.near(&self.turned_back(there), reach, &mut more);
            facets.append(&mut more);
        }
        facets.sort_unstable();
        facets.dedup();
        found
    }

    /// Pebbles that may be within `skin`.
    fn candidates(&self, Near { domain, seen, grids, skin, .. }: Near) -> Vec<u32> {
        let reach = seen.iter().map(|s| s.radius).fold(0.0, f64::max) + skin;
        let mut found = Vec::new();
        let [low, high] = match (&self.shape, self.shape.bounds()) {
            (_, Some(bounds)) => bounds,
            (Shape::Plane { normal }, _) => {
                let Some([low, high]) = self.beside(normal, domain, reach) else {
                    return (0..seen.len() as u32).collect();
                };
                grids.in_box(low, high, |pebble| found.push(pebble));
                return found;
            }
            _ => return (0..seen.len() as u32).collect(),
        };
        let corners = (0..8).map(|k| {
            let corner = [0, 1, 2].map(|c| if k >> c & 1 == 0 { low[c] } else { high[c] });
            self.pose.direction_to_space(&corner.into())
        });
        let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let origin = domain.place(domain.wrap(self.cell), self.pose.position.into());
        for corner in corners {
            for c in 0..3 {
                least[c] = least[c].min(origin[c] + corner[c]);
                most[c] = most[c].max(origin[c] + corner[c]);
            }
        }
        grids.in_box(sub(least, [reach; 3]), add(most, [reach; 3]), |pebble| found.push(pebble));
        found
    }
}

impl Wall {
    /// Space behind a plane across an axis that ends, or within `reach` before it \[m\].
    fn beside(&self, normal: &Vector3<f64>, domain: &Domain, reach: f64) -> Option<[Vec3; 2]> {
        let normal = self.pose.direction_to_space(normal);
        let axis = normal.iamax();
        if normal[axis].abs() < 1.0 || domain.period(axis).is_some() {
            return None;
        }
        let origin = domain.place(self.cell, self.pose.position.into());
        let (mut low, mut high) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
        if normal[axis] > 0.0 {
            high[axis] = origin[axis] + reach;
        } else {
            low[axis] = origin[axis] - reach;
        }
        Some([low, high])
    }
}

/// Data shared by tasks.
#[derive(Clone, Copy)]
struct Shared<'a, R: Real> {
    walls: &'a [Wall],
    laws: &'a ContactLaws,
    domain: &'a Domain,
    around: Surroundings<'a, R>,
    facets: &'a [u32],
    watched: bool,
}

/// The entries of the task in work.
struct Pass<'a, R: Real> {
    shared: Shared<'a, R>,
    entries: &'a [Entry],
    slots: &'a mut [Slot<R>],
    places: &'a mut [Outcome<R>],
}

/// Number of entries between the prefetched pebble and the pebble in work. A core can wait for about twenty cache lines
/// at a time; further prefetches stop it.
const AHEAD: usize = 16;

/// One lane, for single contacts.
type One<R> = Plain<R, 1>;

impl<R: Real> Work<R> for Pass<'_, R> {
    type Output = ContactEnergy;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(mut self, lanes: L) -> ContactEnergy {
        let mut energy = ContactEnergy::default();
        let mut scratch = Scratch::default();
        let mut batches: Vec<Batch<R>> = Vec::new();
        let base = self.entries[0].slots.0;
        for ahead in 0..AHEAD {
            self.ask_for(ahead);
        }
        for (number, entry) in self.entries.iter().enumerate() {
            self.ask_for(number + AHEAD);
            let first = (entry.slots.0 - base) as usize;
            let range = first..(entry.slots.1 - base) as usize;
            let (slots, places) = (&mut self.slots[range.clone()], &mut self.places[range]);
            let Some((met, shear)) = self.shared.entry(entry, slots, places, &mut scratch, &mut energy) else {
                continue;
            };
            let batch = batch_of(&mut batches, entry.law);
            batch.put(first, &met, &shear);
            if batch.count == L::WIDTH {
                self.finish(lanes, batch);
            }
        }
        for batch in &mut batches {
            self.finish(lanes, batch);
        }
        energy
    }
}

/// A meeting in numbers: overlap, normal, arm, velocity, twist, mass, radius of curvature.
type Met<R> = [R; 11];
/// Index of the mass: it has the precision of contacts already.
const MASS: usize = 9;

/// Meetings under one law, one per lane.
struct Batch<R> {
    law: u16,
    count: usize,
    /// Slots for their results.
    slots: [usize; BLOCK],
    met: [[R; BLOCK]; 11],
    shear: BlockVector<R>,
}

impl<R: Real> Batch<R> {
    #[inline(always)]
    fn put(&mut self, slot: usize, met: &Met<R>, shear: &[R; 3]) {
        let lane = self.count;
        self.slots[lane] = slot;
        for row in 0..met.len() {
            self.met[row][lane] = met[row];
        }
        for row in 0..3 {
            self.shear[row][lane] = shear[row];
        }
        self.count += 1;
    }
}

/// The batch of a law.
fn batch_of<R: Real>(batches: &mut Vec<Batch<R>>, law: u16) -> &mut Batch<R> {
    let zero = R::default();
    let known = batches.iter().position(|batch| batch.law == law);
    let place = known.unwrap_or_else(|| {
        batches.push(Batch { law, count: 0, slots: [0; BLOCK], met: [[zero; BLOCK]; 11], shear: [[zero; BLOCK]; 3] });
        batches.len() - 1
    });
    &mut batches[place]
}

impl<R: Real> Pass<'_, R> {
    /// Computes the forces of a batch, and empties the batch.
    #[inline(always)]
    fn finish<L: Lanes<Real = R>>(&mut self, lanes: L, batch: &mut Batch<R>) {
        let mut met = [Num::splat(lanes, 0.0); 11];
        for row in 0..met.len() {
            met[row] = Num::load(lanes, &batch.met[row]);
        }
        let meeting = meeting(met);
        let contact = self.shared.around.laws[usize::from(batch.law)].force(
            lanes,
            &meeting,
            Vector::load(lanes, &batch.shear, 0),
        );
        contact.shear.store(&mut batch.shear, 0);
        let mut damping = [[R::default(); BLOCK]; 3];
        contact.damping.store(&mut damping, 0);
        let mut outcomes = [Outcome::default(); BLOCK];
        lanes.scatter(outcome(&meeting, &contact), &mut outcomes[..L::WIDTH]);
        for lane in 0..batch.count {
            let place = batch.slots[lane];
            let slot = &mut self.slots[place];
            for row in 0..3 {
                slot.shear[row] = batch.shear[row][lane];
                slot.damping[row] = damping[row][lane];
                slot.force[row] = outcomes[lane][row];
            }
            self.places[place] = outcomes[lane];
        }
        batch.count = 0;
    }
}

impl<R: Real> Pass<'_, R> {
    /// Prefetches the pebble of an entry: in the order of their names, they are scattered in memory.
    #[inline(always)]
    fn ask_for(&self, entry: usize) {
        if let Some(entry) = self.entries.get(entry) {
            prefetch(&self.shared.around.records[entry.pebble as usize]);
        }
    }
}

impl<R: Real> Shared<'_, R> {
    /// All contacts of a pebble with a wall. A single contact, the usual case, is returned to be computed together with
    /// others; its slot then has everything except its forces.
    #[inline(always)]
    fn entry(
        &self,
        entry: &Entry,
        slots: &mut [Slot<R>],
        places: &mut [Outcome<R>],
        scratch: &mut Scratch<R>,
        energy: &mut ContactEnergy,
    ) -> Option<(Met<R>, [R; 3])> {
        let wall = &self.walls[entry.wall as usize];
        let record = &self.around.records[entry.pebble as usize];
        let away = wall.to(self.domain, entry.cell, record.position());
        let facets = &self.facets[entry.facets.0 as usize..entry.facets.1 as usize];
        wall.touches(away, record.radius(), facets, &mut scratch.touches);
        let touched = slots.iter().any(Slot::touches);
        if scratch.touches.is_empty() && !touched {
            // the pebble was near without contact, and still is
            return None;
        }
        for touch in &mut scratch.touches {
            touch.normal = wall.pose.direction_to_space(&touch.normal);
        }
        if let ([slot], [touch], false) = (&mut *slots, &scratch.touches[..], self.watched)
            && (slot.feature == touch.feature || !touched)
        {
            let (met, point) = meet::<R>(wall, record, away, touch);
            *slot = self.slot(entry, record, touch, point, slot.shear);
            return Some((met, slot.shear));
        }
        scratch.remember(slots);
        slots.fill(Slot::empty(R::default()));
        places.fill(Outcome::default());
        for (k, touch) in scratch.touches.iter().enumerate().take(slots.len()) {
            let history = scratch.heirs[k].map_or(Slot::empty(R::default()), |old| scratch.before[old]);
            (slots[k], places[k]) = self.contact(entry, (wall, record, away), touch, &history, energy);
        }
        None
    }

    /// A contact before its forces are computed.
    #[inline(always)]
    fn slot(&self, entry: &Entry, record: &R::Record, touch: &Touch, point: Vec3, shear: [R; 3]) -> Slot<R> {
        let overlap = record.radius() - touch.distance;
        let law = &self.laws.all()[usize::from(entry.law)];
        let tangent = Tangent::from_law(law, overlap, record.mass().to_f64(), record.radius());
        Slot {
            feature: touch.feature,
            normal: touch.normal.into(),
            shear,
            damping: [R::default(); 3],
            force: [R::default(); 3],
            point,
            overlap,
            stiffness: [tangent.normal, tangent.normal_dashpot],
        }
    }

    /// A contact that continues with a history.
    #[inline(always)]
    fn contact(
        &self,
        entry: &Entry,
        (wall, record, away): (&Wall, &R::Record, Vec3),
        touch: &Touch,
        history: &Slot<R>,
        energy: &mut ContactEnergy,
    ) -> (Slot<R>, Outcome<R>) {
        let lanes = One::<R>::new();
        let (met, point) = meet::<R>(wall, record, away, touch);
        let meeting = meeting(met.map(|number| Num { lanes, value: [number] }));
        let shear = Vector(history.shear.map(|part| Num { lanes, value: [part] }));
        let contact = self.around.laws[usize::from(entry.law)].force(lanes, &meeting, shear);
        if self.watched {
            *energy += spent(&meeting, &contact, history.damping, self.around.dt);
        }
        let damping = numbers(contact.damping);
        let force = numbers(contact.force);
        let slot = Slot { damping, force, ..self.slot(entry, record, touch, point, numbers(contact.shear)) };
        let [a, b, c, d, e, f, g, h] = outcome(&meeting, &contact);
        let outcome = [a.value[0], b.value[0], c.value[0], d.value[0], e.value[0], f.value[0], g.value[0], h.value[0]];
        (slot, Row(outcome))
    }
}

#[inline(always)]
fn numbers<R: Real>(v: Vector<One<R>>) -> [R; 3] {
    [v.0[0].value[0], v.0[1].value[0], v.0[2].value[0]]
}

/// Geometry of the contact of a pebble with a wall, and its position \[m from the wall's origin\].
#[inline(always)]
fn meet<R: Real>(wall: &Wall, record: &R::Record, away: Vec3, touch: &Touch) -> (Met<R>, Vec3) {
    let normal: Vec3 = touch.normal.into();
    let overlap = record.radius() - touch.distance;
    // on a deformable floor the contact point lies on the facet, so that its corners get the moment too
    let arm = if wall.sheet.is_some() { touch.distance } else { record.radius() - 0.5 * overlap };
    let point = sub(away, scale(normal, arm));
    let ([a, b, c], [p, q, r]) = (record.velocity(), record.spin());
    let (velocity, spin) = ([a.to_f64(), b.to_f64(), c.to_f64()], [p.to_f64(), q.to_f64(), r.to_f64()]);
    let own = sub(velocity, scale(cross(spin, normal), arm));
    let (wall_velocity, wall_spin): (Vec3, Vec3) = (wall.velocity.into(), wall.spin.into());
    let of_sheet = match &wall.sheet {
        Some(sheet) => sheet.velocity_at(point),
        None => [0.0; 3],
    };
    let [u, v, w] = sub(own, add(add(wall_velocity, of_sheet), cross(wall_spin, point)));
    let twist = 0.5 * dot(add(spin, wall_spin), normal);
    let [x, y, z] = normal;
    let numbers = [overlap, x, y, z, arm, u, v, w, twist, 0.0, record.radius()];
    let mut met = [record.mass(); 11];
    for row in 0..11 {
        if row != MASS {
            met[row] = R::from_f64(numbers[row]);
        }
    }
    (met, point)
}

/// Contacts of pebbles with a wall in lanes.
#[inline(always)]
fn meeting<L: Lanes>([overlap, x, y, z, arm, u, v, w, twist, mass, curvature_radius]: [Num<L>; 11]) -> Meeting<L> {
    let arms = [arm, Num::splat(arm.lanes, 0.0)];
    let (normal, velocity) = (Vector([x, y, z]), Vector([u, v, w]));
    Meeting { overlap, normal, arms, velocity, twist, mass, curvature_radius }
}

/// Energy in a contact, and energy lost in a step.
fn spent<R: Real>(
    meeting: &Meeting<One<R>>,
    contact: &ContactForces<One<R>>,
    before: [R; 3],
    dt: f64,
) -> ContactEnergy {
    let f64s = |v: [R; 3]| v.map(R::to_f64);
    let mean = scale(add(f64s(before), f64s(numbers(contact.damping))), 0.5);
    ContactEnergy {
        strain: contact.strain.value[0].to_f64(),
        slip: contact.slip.value[0].to_f64(),
        dashpot: -dot(mean, f64s(numbers(meeting.velocity))) * dt,
    }
}

/// Buffers of a task.
struct Scratch<R> {
    touches: Vec<Touch>,
    before: Vec<Slot<R>>,
    names: Vec<(u32, Vector3<f64>)>,
    heirs: Vec<Option<usize>>,
}

impl<R> Default for Scratch<R> {
    fn default() -> Self {
        Scratch { touches: Vec::new(), before: Vec::new(), names: Vec::new(), heirs: Vec::new() }
    }
}

impl<R: Real> Scratch<R> {
    /// Finds the histories of the present contacts.
    fn remember(&mut self, slots: &[Slot<R>]) {
        self.before.clear();
        self.before.extend(slots.iter().filter(|s| s.touches()));
        self.names.clear();
        self.names.extend(self.before.iter().map(|s| (s.feature, Vector3::from(s.normal))));
        inherit(&self.names, &self.touches, &mut self.heirs);
    }
}

/// Largest approach of a pebble to a wall in a step \[m\].
pub(super) fn approach(walls: &[Wall], dt: f64, extent: f64) -> f64 {
    walls.iter().map(|w| w.fastest(extent) * dt).fold(0.0, f64::max)
}

/// Displacement of a wall since its pose was `before` \[m\].
pub(super) fn moved(wall: &Wall, before: &Pose, extent: f64) -> f64 {
    let turned = (0..4).map(|k| (wall.pose.orientation[k] - before.orientation[k]).powi(2)).sum::<f64>().sqrt();
    let sheet = wall.sheet.as_ref().map_or(0.0, |sheet| sheet.moved());
    norm((wall.pose.position - before.position).into()) + 2.0 * turned * wall.reach(extent) + sheet
}
