//! How far bodies and walls may move before new lists are made.
//!
//! Every pebble and every wall has its own reach. A pair is listed if it is closer than both reaches together, so lists
//! are valid until something has moved by more than its reach. Under a train nine grains of ten move by a tenth of a
//! millimetre in the life of a list, and a few loose ones fly by several millimetres. Those fly already when the list is
//! made: their speed tells their reach. One reach for all would list half as many pairs again.

use super::bed::Bed;
use super::lanes::{BLOCK, Real};
use super::lists::{Lists, Span};
use super::record::Record;
use super::tasks::Task;
use super::vector::{norm, sub};
use super::walls::{Wall, moved};
use rayon::prelude::*;

/// Number of steps that lists should last.
const LIFE: u64 = 400;
/// Reach divided by the distance that is covered in this time at the present speed.
const RESERVE: f64 = 2.5;
/// Smallest and largest reach divided by the largest radius.
const LIMITS: [f64; 2] = [5e-4, 0.1];
/// The first reach of a pebble at rest, divided by the largest radius.
const FIRST: f64 = 4e-3;
/// Factors of the reach of pebbles at rest after a list that one of them ended early, and after any other.
const GROWTH: [f64; 2] = [1.5, 0.8];

impl<R: Real> Bed<R> {
    /// Distance of a pebble from its place when the lists were made \[m\].
    fn gone(&self, pebble: usize) -> f64 {
        let before = self.lists.reference[pebble].map(f64::from);
        let now = sub(self.records[pebble].position(), self.lists.origin[pebble / BLOCK]);
        norm(sub(now, before))
    }

    /// Distance of a wall from its place when the lists were made \[m\].
    fn gone_wall(&self, wall: usize) -> f64 {
        moved(&self.walls[wall], &self.lists.walls[wall], self.lists.extent)
    }

    /// Measures what is left to the bodies and walls whose bound is used up.
    pub(super) fn measure(&mut self) {
        let lists = &self.lists;
        let left = |pebble: u32| f64::from(lists.reach[pebble as usize]) - self.gone(pebble as usize);
        let measured = |(span, ends): (&Span, &[Task])| {
            if !span.is_used_up() {
                return *span;
            }
            let pebbles = ends[0].pebble..ends[1].pebble;
            Span { travelled: 0.0, left: pebbles.map(left).fold(f64::INFINITY, f64::min) }
        };
        let spans: Vec<Span> = lists.spans.par_iter().zip(lists.tasks.par_windows(2)).map(measured).collect();
        if lists.of_walls.is_used_up() {
            let left = |(wall, reach): (usize, &f64)| reach - self.gone_wall(wall);
            let left = lists.wall_reach.iter().enumerate().map(left).fold(f64::INFINITY, f64::min);
            self.lists.of_walls = Span { travelled: 0.0, left };
        }
        self.lists.spans = spans;
    }

    /// Chooses the reach of pebbles at rest: it grows until none of them ends a list early.
    pub(super) fn choose_rest(&mut self) {
        let early = self.steps - self.lists.step < LIFE && self.is_overtaken();
        let [least, first, most] = [LIMITS[0], FIRST, LIMITS[1]].map(|share| 2.0 * share * self.largest_radius());
        let lists = &mut self.lists;
        lists.skin = match lists.fixed_skin {
            Some(skin) => skin,
            None if lists.count == 0 || lists.skin == 0.0 => first,
            None if lists.outdated => lists.skin,
            None => (lists.skin * if early { GROWTH[0] } else { GROWTH[1] }).clamp(least, most),
        };
        lists.count += 1;
        lists.step = self.steps;
        lists.outdated = false;
    }

    /// Whether a pebble has moved by more than the reach of pebbles at rest, although it had no other.
    fn is_overtaken(&self) -> bool {
        let Lists { spans, tasks, reach, outdated, .. } = &self.lists;
        if *outdated {
            return false;
        }
        let rest = (0.5 * self.lists.skin) as f32;
        let beyond = |pebble: u32| {
            reach[pebble as usize] <= rest && self.gone(pebble as usize) > f64::from(reach[pebble as usize])
        };
        let used = spans.iter().zip(tasks.windows(2)).filter(|(span, _)| span.is_used_up());
        used.into_iter().any(|(_, ends)| (ends[0].pebble..ends[1].pebble).any(beyond))
    }

    fn largest_radius(&self) -> f64 {
        self.records[..self.owner.len()].iter().map(Record::radius).fold(0.0, f64::max)
    }

    /// Gives every pebble and every wall its reach, after the bodies were sorted.
    pub(super) fn spread_reach(&mut self) {
        let (rest, most) = (0.5 * self.lists.skin, LIMITS[1] * self.largest_radius());
        let life = RESERVE * LIFE as f64 * self.dt;
        let chosen = |speed: f64| match self.lists.fixed_skin {
            Some(_) => rest,
            None => (life * speed).min(most).max(rest),
        };
        let of_pebble = |record: &R::Record| chosen(norm(record.velocity().map(R::to_f64))) as f32;
        let records = &self.records[..self.owner.len()];
        let reach = records.par_iter().with_min_len(4096).map(of_pebble).collect();
        let wall_reach = self.walls.iter().map(|wall| chosen(wall.fastest(self.lists.extent))).collect();
        (self.lists.reach, self.lists.wall_reach) = (reach, wall_reach);
    }

    /// Stores all positions. Displacements are kept in single precision, relative to an origin that blocks of pebbles
    /// share.
    pub(super) fn remember(&mut self) {
        let records = &self.records[..self.owner.len()];
        self.lists.origin = records.chunks(BLOCK).map(|block| block[0].position()).collect();
        let origin = &self.lists.origin;
        let from_origin = |(p, r): (usize, &R::Record)| sub(r.position(), origin[p / BLOCK]).map(|x| x as f32);
        self.lists.reference = records.par_iter().enumerate().map(from_origin).collect();
        self.lists.walls = self.walls.iter().map(|w| w.pose).collect();
        self.walls.iter_mut().filter_map(|w| w.sheet.as_mut()).for_each(|sheet| sheet.remember());
        let far = |wall: &Wall| {
            let pebbles = records.par_iter().zip(&self.owner);
            let distance =
                |(r, &b): (&R::Record, &u32)| norm(wall.to(&self.domain, self.bodies[b as usize].cell, r.position()));
            pebbles.map(distance).reduce(|| 0.0, f64::max)
        };
        let planes = self.walls.iter().filter(|w| w.shape.bounds().is_none());
        self.lists.extent = planes.map(far).fold(0.0, f64::max) + 2.0 * self.lists.farthest();
        let Lists { spans, tasks, reach, .. } = &mut self.lists;
        let least = |ends: &[Task]| {
            let reach = &reach[ends[0].pebble as usize..ends[1].pebble as usize];
            Span { travelled: 0.0, left: f64::from(reach.iter().copied().fold(f32::INFINITY, f32::min)) }
        };
        *spans = tasks.par_windows(2).map(least).collect();
        let left = self.lists.wall_reach.iter().copied().fold(f64::INFINITY, f64::min);
        self.lists.of_walls = Span { travelled: 0.0, left };
    }
}
