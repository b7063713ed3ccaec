//! How far bodies and walls may move before new lists are made.
//!
//! Every pebble and every wall has its own reach. A pair is listed if it is closer than both reaches together, so lists
//! are valid until something has moved by more than its reach. Under a train nine grains of ten move by a tenth of a
//! millimetre in the life of a list, and a few loose ones fly by several millimetres. Those fly already when the list
//! is made, so their speed tells their reach. One reach for all would have to suit the fastest grain.

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
        // bodies that were added or removed have no place in the lists
        if *outdated || reach.len() != self.owner.len() {
            return false;
        }
        let rest = (0.5 * self.lists.skin) as f32;
        let beyond = |pebble: u32| {
            reach[pebble as usize] <= rest && self.gone(pebble as usize) > f64::from(reach[pebble as usize])
        };
        let mut used = spans.iter().zip(tasks.windows(2)).filter(|(span, _)| span.is_used_up());
        used.any(|(_, ends)| (ends[0].pebble..ends[1].pebble).any(beyond))
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

#[cfg(test)]
mod tests {
    use super::super::law::{ContactLaw, Dashpot, DashpotMode, FrictionLimit, Linear};
    use super::super::motion::{Pose, WallMotion};
    use super::super::shape::Shape;
    use super::super::{Bed, ContactLaws, Domain, Sphere};
    use nalgebra::Vector3;

    const RADIUS: f64 = 0.02;
    const AT_REST: usize = 100;

    /// A row of spheres at rest 1 mm apart, a sphere that flies along the row and towards it, and a plate that comes
    /// down on the end of the row.
    fn bed(skin: Option<f64>) -> Bed<f32> {
        let law = ContactLaw::Linear(Linear {
            normal_stiffness: 1e6,
            shear_stiffness: 1e6,
            friction: 0.5,
            dashpot: Dashpot::Ratio { normal: 0.1, shear: 0.0 },
            mode: DashpotMode::default(),
            limit: FrictionLimit::default(),
        });
        let mut bed = Bed::new(Domain::open(), ContactLaws::single(law));
        let mut put = |centre| bed.add_sphere(&Sphere { centre, radius: RADIUS, density: 2700.0, surface: 0 });
        (0..AT_REST).for_each(|k| {
            put([k as f64 * (2.0 * RADIUS + 1e-3), 0.0, 0.0]);
        });
        let flies = put([0.02, 0.0, 2.5 * RADIUS]);
        bed.set_velocity(flies, [1.0, 0.0, -0.2], [0.0; 3]);
        let down = WallMotion::Velocity { linear: Vector3::new(0.0, 0.0, -0.3), angular: Vector3::zeros() };
        let place = Vector3::new(AT_REST as f64 * (2.0 * RADIUS + 1e-3), 0.0, 0.05);
        let plate = Shape::block(Vector3::new(0.05, 0.05, 0.01)).unwrap();
        bed.add_wall(plate, Pose { position: place, orientation: [1.0, 0.0, 0.0, 0.0] }, 0, down);
        bed.set_time_step(2e-5);
        bed.set_skin(skin);
        bed
    }

    #[test]
    fn only_what_moves_is_listed_from_afar() {
        let (mut own, mut same) = (bed(None), bed(Some(4e-3)));
        own.step().unwrap();
        same.step().unwrap();
        let flies = f64::from(own.lists.reach.iter().copied().fold(0.0, f32::max));
        let at_rest = f64::from(own.lists.reach.iter().copied().fold(1.0, f32::min));
        assert!(flies > 1.9e-3 && at_rest < 1e-4, "{flies} and {at_rest} m");
        assert!(own.lists.wall_reach[0] > 1.9e-3, "the plate reaches {} m", own.lists.wall_reach[0]);
        // none of the gaps in the row is within reach
        assert!(own.listed_contacts() < 5, "{} contacts", own.listed_contacts());
        assert!(same.listed_contacts() >= AT_REST - 1, "{} contacts", same.listed_contacts());
    }

    #[test]
    fn nothing_is_met_unlisted() {
        // 0.1 s: the flying sphere strikes the row, the plate its end, and both wake their neighbours
        let moved = |skin| {
            let mut bed = bed(skin);
            bed.run(5000).unwrap();
            let all: Vec<_> = bed.states().map(|state| (state.place, state.velocity, state.spin)).collect();
            (all, bed.lists_made())
        };
        let ((own, lists), (often, more)) = (moved(None), moved(Some(1e-5)));
        assert!(own == often, "a contact was late");
        let awake = own.iter().filter(|(_, velocity, _)| velocity.iter().any(|v| *v != 0.0)).count();
        assert!(awake > 4, "{awake} spheres move");
        assert!(lists * 10 < more, "{lists} lists instead of {more}");
    }
}
