//! The relevant contacts, as springs and dashpots between rigid bodies.

use super::super::bed::Bed;
use super::super::body::{Body, SPHERE};
use super::super::domain::{Image, mirrored};
use super::super::failure::Failure;
use super::super::force::Tangent;
use super::super::lanes::{BLOCK, Real};
use super::super::record::Record;
use super::super::rotation;
use super::super::vector::{Vec3, add, cross, dot, norm, scale, sub};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// Smallest number of pairs of a task.
const CHUNK: usize = 4096;

/// Stands for a wall instead of a second body.
pub const GROUND: u32 = u32::MAX;

/// A body, and a pebble in it; two pebbles, and the image of the second.
type PebbleName = (u32, u16);
type PairName = (PebbleName, PebbleName, Image);

/// A spring and a dashpot between two bodies, or a body and the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Numbers of the bodies.
    pub bodies: [u32; 2],
    /// From the second to the first.
    pub normal: Vec3,
    /// From the centroids to the contact point \[m\].
    pub arms: [Vec3; 2],
    pub tangent: Tangent,
    /// Mass to which damping ratios refer \[kg\].
    pub mass: f64,
}

impl Link {
    /// The two ends that are bodies, with their number in the link.
    pub fn ends(&self) -> impl Iterator<Item = (usize, u32)> {
        self.bodies.into_iter().enumerate().filter(|&(_, body)| body != GROUND)
    }

    /// The same link seen from its other end.
    fn turned(self) -> Link {
        let ([a, b], [from_a, from_b]) = (self.bodies, self.arms);
        Link { bodies: [b, a], normal: scale(self.normal, -1.0), arms: [from_b, from_a], ..self }
    }

    /// Velocity of the first body relative to the second at the contact point.
    pub fn apart(&self, motions: &[[f64; 6]]) -> Vec3 {
        let at = |end: usize| {
            let [x, y, z, p, q, r] = motions[self.bodies[end] as usize];
            add([x, y, z], cross([p, q, r], self.arms[end]))
        };
        if self.bodies[1] == GROUND { at(0) } else { sub(at(0), at(1)) }
    }

    /// Adds force and moment of `force` on the first body to both bodies.
    pub fn push(&self, force: Vec3, forces: &mut [[f64; 6]]) {
        for (end, body) in self.ends() {
            let force = if end == 0 { force } else { scale(force, -1.0) };
            let moment = cross(self.arms[end], force);
            let sum = &mut forces[body as usize];
            for c in 0..3 {
                sum[c] += force[c];
                sum[3 + c] += moment[c];
            }
        }
    }

    /// `along` times the normal part of a vector and `across` times the rest.
    pub fn stretch(&self, v: Vec3, along: f64, across: f64) -> Vec3 {
        add(scale(v, across), scale(self.normal, (along - across) * dot(v, self.normal)))
    }
}

/// Roots of the inverse inertia of a body, which scale its motions: u = root y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roots {
    /// Root of the inverse mass \[kg^-1/2\].
    pub translation: f64,
    /// Root of the inverse inertia, symmetric, in the world \[kg^-1/2 / m\].
    pub rotation: Matrix3<f64>,
}

impl Roots {
    /// Roots of a body with `factor` times the inertia.
    pub fn heavier(&self, factor: f64) -> Roots {
        let share = factor.sqrt().recip();
        Roots { translation: self.translation * share, rotation: self.rotation * share }
    }

    /// An upper bound of the largest root of rotation: the largest row sum.
    pub fn widest_turn(&self) -> f64 {
        self.rotation.row_iter().map(|row| row.iter().map(|value| value.abs()).sum()).fold(0.0, f64::max)
    }

    pub fn apply(&self, [x, y, z, p, q, r]: [f64; 6]) -> [f64; 6] {
        let turned = self.rotation * Vector3::new(p, q, r);
        let w = self.translation;
        [w * x, w * y, w * z, turned.x, turned.y, turned.z]
    }
}

/// m1 m2 / (m1 + m2).
pub fn reduced(first: f64, second: f64) -> f64 {
    first * second / (first + second)
}

impl<R: Real> Bed<R> {
    /// Contacts of pairs that are now up to `gap` \[m\] apart, in an order that depends on the touching bodies and not
    /// on the lists: sums over them are the same, bit by bit, for any order of bodies in memory.
    pub(in super::super) fn links(&mut self, gap: f64) -> Result<Vec<Link>, Failure> {
        self.reach(gap)?;
        let named = |place: usize| (self.name_of_pair(place), place);
        // one in four of the listed pairs touches: only these are sorted, and computing them twice is cheaper than
        // moving them
        let all = || (0..self.contacts.len()).into_par_iter().with_min_len(CHUNK);
        let mut pairs: Vec<_> = all().filter(|place| self.pair(*place, gap).is_some()).map(named).collect();
        pairs.par_sort_unstable();
        let of_pairs = pairs.into_par_iter().with_min_len(CHUNK).filter_map(|(_, place)| self.pair(place, gap));
        let mut links: Vec<Link> = of_pairs.collect();
        let mut entries: Vec<usize> = (0..self.wall_contacts.entries.len()).collect();
        entries.sort_by_cached_key(|&entry| {
            let entry = &self.wall_contacts.entries[entry];
            (self.name(entry.pebble), entry.wall)
        });
        entries.into_iter().for_each(|entry| self.walled(entry, gap, &mut links));
        links.extend((0..self.bonds.places()).filter_map(|place| self.bond_link(place)));
        Ok(links)
    }

    /// Names of the two pebbles of a listed pair and the image of the second, in an order that does not depend on the
    /// lists.
    fn name_of_pair(&self, place: usize) -> PairName {
        let [a, b] = [self.contacts.first[place], self.contacts.second[place]].map(|pebble| self.name(pebble));
        let image = self.contacts.image[place];
        (a.min(b), a.max(b), if a < b { image } else { mirrored(image) })
    }

    /// Present contacts of one body, in the same order as among the contacts of all bodies.
    pub(in super::super) fn own_links(&self, body: u32) -> Vec<Link> {
        let mut pairs: Vec<(PairName, Link)> = Vec::new();
        let mut walls: Vec<(PebbleName, u32, usize)> = Vec::new();
        let mut bonds: Vec<usize> = Vec::new();
        let Body { first, pebbles, .. } = self.bodies[body as usize];
        for pebble in first as usize..first as usize + usize::from(pebbles) {
            for entry in self.incidence.contacts_of(pebble) {
                let place = entry.place();
                if let Some(slot) = place.checked_sub(self.contacts.len()) {
                    match slot.checked_sub(self.wall_contacts.slots.len()) {
                        Some(bond) => bonds.push(bond),
                        None => {
                            let entry = self.wall_contacts.entries.partition_point(|e| e.slots.1 as usize <= slot);
                            walls.push((self.name(pebble as u32), self.wall_contacts.entries[entry].wall, entry));
                        }
                    }
                    continue;
                }
                // a body that touches its own image owns both ends of the contact
                let again = entry.is_second() && self.owner[self.contacts.first[place] as usize] == body;
                if let Some(link) = self.pair(place, 0.0).filter(|_| !again) {
                    pairs.push((self.name_of_pair(place), link));
                }
            }
        }
        pairs.sort_unstable_by_key(|(name, _)| *name);
        // an entry has room for several contacts
        walls.sort_unstable();
        walls.dedup();
        let mut links: Vec<Link> = pairs.into_iter().map(|(_, link)| link).collect();
        walls.into_iter().for_each(|(.., entry)| self.walled(entry, 0.0, &mut links));
        bonds.sort_unstable();
        bonds.dedup();
        links.extend(bonds.into_iter().filter_map(|place| self.bond_link(place)));
        links
    }

    /// Contacts of one body, as far as they are listed.
    pub(in super::super) fn links_of(&self, body: u32, gap: f64) -> Vec<Link> {
        let mut links = Vec::new();
        let body = &self.bodies[body as usize];
        for pebble in body.first as usize..body.first as usize + usize::from(body.pebbles) {
            let mut last = None;
            for place in self.incidence.contacts_of(pebble).iter().map(|entry| entry.place()) {
                let Some(slot) = place.checked_sub(self.contacts.len()) else {
                    links.extend(self.pair(place, gap));
                    continue;
                };
                if let Some(bond) = slot.checked_sub(self.wall_contacts.slots.len()) {
                    links.extend(self.bond_link(bond));
                    continue;
                }
                // an entry has room for several contacts
                let entry = self.wall_contacts.entries.partition_point(|e| e.slots.1 as usize <= slot);
                if last.replace(entry) != Some(entry) {
                    self.walled(entry, gap, &mut links);
                }
            }
        }
        links
    }

    /// Contacts of a pebble with a wall.
    pub(in super::super) fn walled(&self, entry: usize, gap: f64, links: &mut Vec<Link>) {
        let entry = &self.wall_contacts.entries[entry];
        let wall = &self.walls[entry.wall as usize];
        let record = &self.records[entry.pebble as usize];
        let body = self.owner[entry.pebble as usize];
        let away = wall.to(&self.domain, self.bodies[body as usize].cell, record.position());
        let facets = &self.wall_contacts.facets[entry.facets.0 as usize..entry.facets.1 as usize];
        let mut touches = Vec::new();
        wall.touches(away, record.radius() + gap, facets, &mut touches);
        let (mass, law) = (record.mass().to_f64(), &self.laws.all()[usize::from(entry.law)]);
        links.extend(touches.iter().map(|touch| {
            let normal: Vec3 = wall.pose.direction_to_space(&touch.normal).into();
            let overlap = record.radius() - touch.distance;
            let arm = self.arm(entry.pebble, scale(normal, -(record.radius() - 0.5 * overlap)));
            let tangent = Tangent::from_law(law, overlap, mass, record.radius());
            Link { bodies: [self.bodies[body as usize].id, GROUND], normal, arms: [arm, [0.0; 3]], tangent, mass }
        }));
    }

    /// Makes lists that contain all pairs up to `gap` apart.
    pub(in super::super) fn reach(&mut self, gap: f64) -> Result<(), Failure> {
        self.refresh()?;
        // valid lists contain all pairs that touch
        if gap == 0.0 || gap <= self.lists.listed_up_to() {
            return Ok(());
        }
        let fixed = self.lists.fixed_skin.replace(gap.max(self.lists.skin));
        self.lists.outdated = true;
        let made = self.refresh();
        self.lists.fixed_skin = fixed;
        made
    }

    fn pair(&self, place: usize, gap: f64) -> Option<Link> {
        let (a, b) = (self.contacts.first[place], self.contacts.second[place]);
        if a as usize == self.owner.len() {
            return None;
        }
        let (one, other) = (&self.records[a as usize], &self.records[b as usize]);
        let apart = add(sub(one.position(), other.position()), self.domain.shift(self.contacts.image[place]));
        let distance = norm(apart);
        let overlap = one.radius() + other.radius() - distance;
        if overlap <= 0.0 && overlap <= -gap {
            return None;
        }
        let mass = reduced(one.mass().to_f64(), other.mass().to_f64());
        let law = &self.laws.all()[usize::from(self.contacts.law[place / BLOCK])];
        let tangent = Tangent::from_law(law, overlap, mass, reduced(one.radius(), other.radius()));
        Some(self.link(a, b, self.contacts.image[place], tangent))
    }

    /// A spring between two pebbles, the first one shifted by the image.
    pub(in super::super) fn link(&self, a: u32, b: u32, image: Image, tangent: Tangent) -> Link {
        let (one, other) = (&self.records[a as usize], &self.records[b as usize]);
        let apart = add(sub(one.position(), other.position()), self.domain.shift(image));
        let distance = norm(apart);
        let overlap = one.radius() + other.radius() - distance;
        let normal = scale(apart, 1.0 / distance);
        let link = Link {
            bodies: [a, b].map(|pebble| self.name(pebble).0),
            normal,
            arms: [
                self.arm(a, scale(normal, -(one.radius() - 0.5 * overlap))),
                self.arm(b, scale(normal, other.radius() - 0.5 * overlap)),
            ],
            tangent,
            mass: reduced(one.mass().to_f64(), other.mass().to_f64()),
        };
        // the order of the two pebbles in a list is arbitrary
        if self.name(a) < self.name(b) { link } else { link.turned() }
    }

    /// From the centroid of the body of a pebble to a point given relative to the centre of the pebble.
    fn arm(&self, pebble: u32, from_centre: Vec3) -> Vec3 {
        let body = &self.bodies[self.owner[pebble as usize] as usize];
        match body.clump {
            SPHERE => from_centre,
            clump => {
                let centre = self.clumps[clump as usize].centre;
                add(sub(self.records[pebble as usize].position(), centre), from_centre)
            }
        }
    }

    /// Roots of the inverse inertia of all bodies by their numbers, including the effect of local damping.
    pub(in super::super) fn roots(&self) -> Vec<Roots> {
        let places = self.index.par_iter().with_min_len(CHUNK);
        places.map(|&place| self.root(&self.bodies[place as usize])).collect()
    }

    pub(in super::super) fn root(&self, body: &Body) -> Roots {
        let rotation = match body.clump {
            SPHERE => Matrix3::from_diagonal_element(body.inverse_inertia.sqrt()),
            clump => {
                let clump = &self.clumps[clump as usize];
                let axes = Matrix3::from(rotation::matrix(&clump.attitude)).transpose();
                let roots = Vector3::from(clump.inverse_inertia).map(f64::sqrt);
                axes * Matrix3::from_diagonal(&roots) * axes.transpose()
            }
        };
        Roots { translation: body.inverse_mass.sqrt(), rotation }.heavier(1.0 / (1.0 + self.damping))
    }
}
