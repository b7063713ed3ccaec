//! Contacts of pebbles with walls: one evaluation a pebble and wall, as many contacts as the shape has there.

use super::contacts::{ContactEnergy, Surroundings};
use super::domain::Domain;
use super::force::{Contact, Meeting, Outcome, Prepared, Tangent, outcome};
use super::lanes::{Lanes, Num, Plain, Real, Vector};
use super::law::Laws;
use super::motion::{Felt, Motion, Pose};
use super::record::Record;
use super::search::{Grids, Seen};
use super::shape::{Shape, Touch, inherit};
use super::vector::{Vec3, add, cross, dot, norm, scale, sub};
use nalgebra::Vector3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Entries that one task works on. Fixed, so that threads change nothing.
const CHUNK: usize = 128;
const NONE: u32 = u32::MAX;

/// Number of a wall in the order of making.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct WallId(pub u32);

/// A rigid surface that moves as it is told and feels what touches it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Wall {
    pub shape: Shape,
    /// Position in its cell of the domain \[m\].
    pub(super) pose: Pose,
    pub(super) cell: [i32; 3],
    pub(super) surface: u16,
    pub(super) motion: Motion,
    /// Of the last half step \[m/s\], \[rad/s\].
    pub(super) velocity: Vector3<f64>,
    pub(super) spin: Vector3<f64>,
    pub(super) felt: Felt,
    /// Moment about the origin of the wall's frame \[N m\].
    pub(super) moment: Vec3,
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

    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    pub fn surface(&self) -> u16 {
        self.surface
    }

    /// Where the wall is, its position not wrapped into the period.
    pub fn pose(&self, domain: &Domain) -> Pose {
        Pose { position: domain.place(self.cell, self.pose.position.into()).into(), ..self.pose }
    }

    /// Largest speed of a point of the wall within `reach` of its origin, or of its surface where that ends \[m/s\].
    pub(super) fn fastest(&self) -> f64 {
        let reach = self.shape.bounds().map_or(0.0, |[low, high]| low.norm().max(high.norm()));
        self.velocity.norm() + self.spin.norm() * reach
    }

    /// A vector of space in the wall's frame.
    pub(super) fn turned_back(&self, v: Vec3) -> Vector3<f64> {
        Pose { position: Vector3::zeros(), ..self.pose }.to_frame(&v.into())
    }

    /// From the wall's origin to a pebble \[m\].
    pub(super) fn to(&self, domain: &Domain, cell: [i32; 3], offset: Vec3) -> Vec3 {
        domain.between((cell, offset), (self.cell, self.pose.position.into()))
    }
}

/// A pebble that may touch a wall.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub wall: u32,
    pub pebble: u32,
    pub law: u16,
    pub facets: (u32, u32),
    pub slots: (u32, u32),
}

/// Room for one contact of an entry.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slot<R> {
    pub feature: u32,
    pub normal: Vec3,
    pub shear: [R; 3],
    damping: [R; 3],
    pub overlap: f64,
}

impl<R: Real> Slot<R> {
    const fn empty(zero: R) -> Self {
        Slot { feature: NONE, normal: [0.0; 3], shear: [zero; 3], damping: [zero; 3], overlap: 0.0 }
    }

    pub fn touches(&self) -> bool {
        self.feature != NONE
    }
}

/// Contacts with walls, sorted by wall and then by who the pebble is.
#[derive(Debug, Clone, Default)]
pub(super) struct WallContacts<R> {
    pub entries: Vec<Entry>,
    pub facets: Vec<u32>,
    pub slots: Vec<Slot<R>>,
}

/// A contact with a wall that goes on in a new list.
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

/// Sums over the contacts of a wall.
#[derive(Debug, Clone, Copy)]
struct Load {
    wall: u32,
    force: Vec3,
    moment: Vec3,
    stiffness: f64,
    contacts: usize,
}

/// The pebbles, as walls need to know them.
#[derive(Clone, Copy)]
pub(super) struct Pebbles<'a> {
    /// Body of each pebble.
    pub owner: &'a [u32],
    /// Cell of each body.
    pub cell: &'a (dyn Fn(u32) -> [i32; 3] + Sync),
}

impl<R: Real> WallContacts<R> {
    /// Lists what is within `skin` of a wall; `name` gives body and pebble, and `surface` what a pebble is made of.
    pub fn find(
        walls: &[Wall],
        domain: &Domain,
        seen: &[Seen],
        grids: &Grids,
        skin: f64,
        laws: &Laws,
        about: impl Fn(u32) -> (u32, u16, u16),
        kept: &[Kept<R>],
    ) -> Self {
        let mut all = WallContacts::default();
        let mut near = Vec::new();
        for (number, wall) in walls.iter().enumerate() {
            let mut candidates = wall.candidates(domain, seen, grids, skin);
            candidates.sort_unstable_by_key(|&p| about(p));
            candidates.dedup();
            for pebble in candidates {
                let me = &seen[pebble as usize];
                let centre = wall.turned_back(wall.to(domain, me.cell, me.offset));
                if !wall.shape.near(&centre, me.radius + skin, &mut near) {
                    continue;
                }
                let (body, part, surface) = about(pebble);
                let room = if matches!(wall.shape, Shape::Mesh(_)) { near.len() as u32 } else { 1 };
                let (facet, slot) = (all.facets.len() as u32, all.slots.len() as u32);
                all.facets.extend(&near);
                all.slots.extend((0..room).map(|_| Slot::empty(R::default())));
                all.entries.push(Entry {
                    wall: number as u32,
                    pebble,
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

    /// The contacts that touch, to be found again, sorted.
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

    /// Computes every force, and what each wall feels. `outcomes` has a place for each slot.
    pub fn evaluate(
        &mut self,
        walls: &mut [Wall],
        domain: &Domain,
        laws: &Laws,
        pebbles: Pebbles,
        around: Surroundings<R>,
        outcomes: &mut [Outcome<R>],
        watched: bool,
    ) -> ContactEnergy {
        let work = Work { walls, domain, laws, pebbles, around, facets: &self.facets, watched };
        let mut tasks = Vec::with_capacity(self.entries.len().div_ceil(CHUNK));
        let (mut slots, mut places) = (&mut self.slots[..], outcomes);
        for entries in self.entries.chunks(CHUNK) {
            let count = (entries[entries.len() - 1].slots.1 - entries[0].slots.0) as usize;
            let (some, rest) = slots.split_at_mut(count);
            let (here, others) = places.split_at_mut(count);
            tasks.push((entries, some, here));
            (slots, places) = (rest, others);
        }
        let done: Vec<_> =
            tasks.into_par_iter().map(|(entries, slots, places)| work.run(entries, slots, places)).collect();
        for wall in walls.iter_mut() {
            (wall.felt, wall.moment) = (Felt::default(), [0.0; 3]);
        }
        let mut energy = ContactEnergy::default();
        for (lost, loads) in done {
            energy += lost;
            for load in loads {
                let wall = &mut walls[load.wall as usize];
                wall.felt.force += Vector3::from(load.force);
                wall.felt.stiffness += load.stiffness;
                wall.felt.contacts += load.contacts;
                wall.moment = add(wall.moment, load.moment);
            }
        }
        energy
    }
}

impl Wall {
    /// Pebbles that may be within `skin`.
    fn candidates(&self, domain: &Domain, seen: &[Seen], grids: &Grids, skin: f64) -> Vec<u32> {
        let Some([low, high]) = self.shape.bounds() else {
            return (0..seen.len() as u32).collect();
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
        let reach = seen.iter().map(|s| s.radius).fold(0.0, f64::max) + skin;
        let mut found = Vec::new();
        grids.in_box(sub(least, [reach; 3]), add(most, [reach; 3]), |pebble| found.push(pebble));
        found
    }
}

/// What tasks share.
struct Work<'a, R: Real> {
    walls: &'a [Wall],
    domain: &'a Domain,
    laws: &'a Laws,
    pebbles: Pebbles<'a>,
    around: Surroundings<'a, R>,
    facets: &'a [u32],
    watched: bool,
}

/// One lane: contacts with walls are few.
type One<R> = Plain<R, 1>;

impl<R: Real> Work<'_, R> {
    fn run(&self, entries: &[Entry], slots: &mut [Slot<R>], places: &mut [Outcome<R>]) -> (ContactEnergy, Vec<Load>) {
        let (mut energy, mut loads): (_, Vec<Load>) = (ContactEnergy::default(), Vec::new());
        let mut scratch = Scratch::default();
        let base = entries[0].slots.0;
        for entry in entries {
            let range = (entry.slots.0 - base) as usize..(entry.slots.1 - base) as usize;
            if loads.last().is_none_or(|load| load.wall != entry.wall) {
                loads.push(Load { wall: entry.wall, force: [0.0; 3], moment: [0.0; 3], stiffness: 0.0, contacts: 0 });
            }
            let load = loads.last_mut().expect("just put there");
            energy += self.entry(entry, &mut slots[range.clone()], &mut places[range], load, &mut scratch);
        }
        (energy, loads)
    }

    /// All contacts of a pebble with a wall.
    fn entry(
        &self,
        entry: &Entry,
        slots: &mut [Slot<R>],
        places: &mut [Outcome<R>],
        load: &mut Load,
        scratch: &mut Scratch<R>,
    ) -> ContactEnergy {
        let wall = &self.walls[entry.wall as usize];
        let record = &self.around.records[entry.pebble as usize];
        let away =
            wall.to(self.domain, (self.pebbles.cell)(self.pebbles.owner[entry.pebble as usize]), record.position());
        let facets = &self.facets[entry.facets.0 as usize..entry.facets.1 as usize];
        wall.shape.touches(&wall.turned_back(away), record.radius(), facets, &mut scratch.touches);
        for touch in &mut scratch.touches {
            touch.normal = wall.pose.direction_to_space(&touch.normal);
        }
        scratch.remember(slots);
        slots.fill(Slot::empty(R::default()));
        places.fill([R::default(); 8]);
        let mut energy = ContactEnergy::default();
        for (k, touch) in scratch.touches.iter().enumerate().take(slots.len()) {
            let history = scratch.heirs[k].map(|old| scratch.before[old]);
            let (shear, damping) =
                history.map_or(([R::default(); 3], [R::default(); 3]), |h: Slot<R>| (h.shear, h.damping));
            let (meeting, point) = self.meet(wall, record, away, touch);
            let lanes = One::<R>::new();
            let law: &Prepared = &self.around.laws[usize::from(entry.law)];
            let contact = law.force(lanes, &meeting, Vector(shear.map(|s| Num { lanes, value: [s] })));
            let values = outcome(&meeting, &contact).map(|n| n.value[0]);
            places[k] = values;
            slots[k] = Slot {
                feature: touch.feature,
                normal: touch.normal.into(),
                shear: contact.shear.0.map(|n| n.value[0]),
                damping: contact.damping.0.map(|n| n.value[0]),
                overlap: record.radius() - touch.distance,
            };
            load.add(values, point, self.stiffness(entry, record, slots[k].overlap));
            if self.watched {
                energy += self.energy(&meeting, &contact, damping);
            }
        }
        energy
    }

    fn stiffness(&self, entry: &Entry, record: &R::Record, overlap: f64) -> f64 {
        let law = &self.laws.all()[usize::from(entry.law)];
        Tangent::of(law, overlap, record.mass().to_f64(), record.radius()).normal
    }

    /// How a pebble meets a wall, and where \[m from the wall's origin\].
    fn meet(&self, wall: &Wall, record: &R::Record, away: Vec3, touch: &Touch) -> (Meeting<One<R>>, Vec3) {
        let normal: Vec3 = touch.normal.into();
        let overlap = record.radius() - touch.distance;
        let arm = record.radius() - 0.5 * overlap;
        let point = sub(away, scale(normal, arm));
        let f64s = |v: [R; 3]| v.map(R::to_f64);
        let (velocity, spin) = (f64s(record.velocity()), f64s(record.spin()));
        let own = sub(velocity, scale(cross(spin, normal), arm));
        let (wall_velocity, wall_spin): (Vec3, Vec3) = (wall.velocity.into(), wall.spin.into());
        let other = add(wall_velocity, cross(wall_spin, point));
        let lanes = One::<R>::new();
        let num = |value: f64| Num { lanes, value: lanes.splat(R::of(value)) };
        let meeting = Meeting {
            overlap: num(overlap),
            normal: Vector(normal.map(num)),
            arms: [num(arm), num(0.0)],
            velocity: Vector(sub(own, other).map(num)),
            twist: num(0.5 * dot(add(spin, wall_spin), normal)),
            mass: Num { lanes, value: [record.mass()] },
            curvature_radius: num(record.radius()),
        };
        (meeting, point)
    }

    fn energy(&self, meeting: &Meeting<One<R>>, contact: &Contact<One<R>>, before: [R; 3]) -> ContactEnergy {
        let before = before.map(R::to_f64);
        let f64s = |v: Vector<One<R>>| v.0.map(|n| n.value[0].to_f64());
        let mean = scale(add(before, f64s(contact.damping)), 0.5);
        ContactEnergy {
            strain: contact.strain.value[0].to_f64(),
            slip: contact.slip.value[0].to_f64(),
            dashpot: -dot(mean, f64s(meeting.velocity)) * self.around.dt,
        }
    }
}

impl Load {
    /// Adds the reaction of a contact.
    fn add<R: Real>(&mut self, outcome: Outcome<R>, point: Vec3, stiffness: f64) {
        let force = super::force::force_of(&outcome);
        self.force = sub(self.force, force);
        self.moment = sub(self.moment, cross(point, force));
        self.stiffness += stiffness;
        self.contacts += 1;
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
    /// Finds the histories that the touches of now go on with.
    fn remember(&mut self, slots: &[Slot<R>]) {
        self.before.clear();
        self.before.extend(slots.iter().filter(|s| s.touches()));
        self.names.clear();
        self.names.extend(self.before.iter().map(|s| (s.feature, Vector3::from(s.normal))));
        inherit(&self.names, &self.touches, &mut self.heirs);
    }
}

/// Length that a pebble may come nearer to a wall in a step \[m\].
pub(super) fn approach(walls: &[Wall], dt: f64) -> f64 {
    walls.iter().map(|w| w.fastest() * dt).fold(0.0, f64::max)
}

/// Distance that a wall has gone since its pose was `before` \[m\].
pub(super) fn moved(wall: &Wall, before: &Pose) -> f64 {
    let reach = wall.shape.bounds().map_or(0.0, |[low, high]| low.norm().max(high.norm()));
    let turned = (0..4).map(|k| (wall.pose.orientation[k] - before.orientation[k]).powi(2)).sum::<f64>().sqrt();
    norm((wall.pose.position - before.position).into()) + 2.0 * turned * reach
}
