//! Places grains loosely above a bed: at random, the largest first, without contacts.

use super::super::bed::{Bed, Placed};
use super::super::clump::Template;
use super::super::grains::{Grain, Random};
use super::super::lanes::Real;
use super::super::vector::Vec3;
use super::recipe::GrainLayer;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Solid share of the room in which positions are tried first.
const LOOSE: f64 = 0.25;
/// Positions tried before the room is enlarged.
const TRIES: usize = 60;
/// Factor of enlargement, and largest number of enlargements: then the room is eighty times as high, and no position
/// fits.
const GROWTH: f64 = 1.05;
const MOST_GROWTHS: usize = 90;

/// Room above a bed, m.
pub(in super::super) struct Room<'a> {
    /// Along x and y, from 0, m.
    pub plan: [f64; 2],
    /// Whether it is periodic along x and y; otherwise walls are at both ends.
    pub periodic: [bool; 2],
    /// Level of the surface below.
    pub base: f64,
    /// Area of the part of its plan in which grains may be, m2.
    pub area: f64,
    /// Whether a ball with this centre and radius lies in the allowed part.
    pub free: &'a dyn Fn(&Vec3, f64) -> bool,
}

/// A grain and its position.
pub(in super::super) struct Loose {
    /// Scaled to its size.
    pub template: Template,
    /// Place of the centroid, m.
    pub centre: Vec3,
    pub attitude: UnitQuaternion<f64>,
}

/// Positions of all grains, and the level below which they lie, m; `None` if a grain is too large for the plan.
pub(in super::super) fn set_loose(
    grains: &[Grain],
    templates: &[Template],
    room: &Room<'_>,
    random: &mut Random,
) -> Option<(Vec<Loose>, f64)> {
    let mut scaled: Vec<Template> = grains.iter().map(|grain| templates[grain.template].scaled(grain.size)).collect();
    scaled.sort_by(|a, b| b.volume.total_cmp(&a.volume));
    let solid: f64 = scaled.iter().map(|template| template.volume).sum();
    let widest = scaled.iter().flat_map(|t| &t.pebbles).map(|p| 2.0 * p.radius).fold(0.0, f64::max);
    let highest = scaled.iter().map(|t| 2.0 * t.bounding_radius()).fold(0.0, f64::max);
    let mut height = (solid / (room.area * LOOSE)).max(highest);
    let mut taken = Taken::new(room, widest.max(f64::MIN_POSITIVE));
    let mut placed = Vec::with_capacity(scaled.len());
    for template in scaled {
        let mut growths = 0;
        let (centre, attitude) = loop {
            match (0..TRIES).find_map(|_| taken.try_place(&template, height, random)) {
                Some(found) => break found,
                None if growths == MOST_GROWTHS => return None,
                None => (height, growths) = (height * GROWTH, growths + 1),
            }
        };
        placed.push(Loose { template, centre, attitude });
    }
    Some((placed, room.base + height))
}

/// Adds grains to a bed, falling.
pub(in super::super) fn put<R: Real>(bed: &mut Bed<R>, loose: &[Loose], layer: &GrainLayer, surface: u16, fall: f64) {
    for grain in loose {
        let placed = Placed {
            template: &grain.template,
            centre: grain.centre,
            attitude: grain.attitude,
            density: layer.density,
            surface,
        };
        let body = bed.add_clump(&placed);
        bed.set_velocity(body, [0.0, 0.0, -fall], [0.0; 3]);
    }
}

/// Placed pebbles, by cells as wide as the widest pebble.
struct Taken<'a> {
    room: &'a Room<'a>,
    cells: [usize; 2],
    edge: Vec3,
    /// Level by level.
    pebbles: Vec<Vec<(Vec3, f64)>>,
}

impl Taken<'_> {
    fn new<'a>(room: &'a Room<'a>, widest: f64) -> Taken<'a> {
        let cells = room.plan.map(|side| ((side / widest).floor() as usize).max(1));
        let edge = [room.plan[0] / cells[0] as f64, room.plan[1] / cells[1] as f64, widest];
        Taken { room, cells, edge, pebbles: Vec::new() }
    }

    /// A random position, used if it is free.
    fn try_place(
        &mut self,
        template: &Template,
        height: f64,
        random: &mut Random,
    ) -> Option<(Vec3, UnitQuaternion<f64>)> {
        let room = self.room;
        let attitude = even_attitude(random);
        let arms: Vec<(Vector3<f64>, f64)> = template.pebbles.iter().map(|p| (attitude * p.centre, p.radius)).collect();
        let reach = |axis: usize, side: f64| arms.iter().map(|(arm, r)| side * arm[axis] + r).fold(0.0, f64::max);
        let between = |low: f64, high: f64, random: &mut Random| (low <= high).then(|| random.between(low, high));
        let inside = |axis: usize, random: &mut Random| match room.periodic[axis] {
            true => Some(random.between(0.0, room.plan[axis])),
            false => between(reach(axis, -1.0), room.plan[axis] - reach(axis, 1.0), random),
        };
        let x = inside(0, random)?;
        let y = inside(1, random)?;
        let z = between(room.base + reach(2, -1.0), room.base + height - reach(2, 1.0), random)?;
        let centre = Vector3::new(x, y, z);
        let pebbles: Vec<(Vec3, f64)> = arms.iter().map(|(arm, r)| ((centre + arm).into(), *r)).collect();
        if pebbles.iter().any(|pebble| !(room.free)(&pebble.0, pebble.1) || self.meets(pebble)) {
            return None;
        }
        pebbles.into_iter().for_each(|pebble| self.take(pebble));
        Some((centre.into(), attitude))
    }

    fn cell(&self, place: &Vec3) -> [isize; 3] {
        let of = |axis: usize, origin: f64| ((place[axis] - origin) / self.edge[axis]).floor() as isize;
        [of(0, 0.0), of(1, 0.0), of(2, self.room.base)]
    }

    fn index(&self, [x, y, z]: [isize; 3]) -> usize {
        let [nx, ny] = self.cells;
        let (x, y) = (x.rem_euclid(nx as isize) as usize, y.rem_euclid(ny as isize) as usize);
        (z.max(0) as usize * ny + y) * nx + x
    }

    fn take(&mut self, pebble: (Vec3, f64)) {
        let index = self.index(self.cell(&pebble.0));
        if self.pebbles.len() <= index {
            self.pebbles.resize(index + 1, Vec::new());
        }
        self.pebbles[index].push(pebble);
    }

    fn meets(&self, pebble: &(Vec3, f64)) -> bool {
        let [x, y, z] = self.cell(&pebble.0);
        let meets = |other: &(Vec3, f64)| self.square(&pebble.0, &other.0) < (pebble.1 + other.1).powi(2);
        (0..27)
            .map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1])
            .any(|cell| cell[2] >= 0 && self.pebbles.get(self.index(cell)).is_some_and(|there| there.iter().any(meets)))
    }

    /// Squared distance, the shorter way across a period, m2.
    fn square(&self, a: &Vec3, b: &Vec3) -> f64 {
        let apart = |axis: usize| {
            let (d, period) = (a[axis] - b[axis], self.room.plan[axis]);
            if self.room.periodic[axis] { d - period * (d / period).round() } else { d }
        };
        apart(0).powi(2) + apart(1).powi(2) + (a[2] - b[2]).powi(2)
    }
}

/// A random attitude, uniformly distributed (Shoemake 1992).
fn even_attitude(random: &mut Random) -> UnitQuaternion<f64> {
    let share = random.share();
    let [a, b] = [(); 2].map(|()| std::f64::consts::TAU * random.share());
    let (small, large) = ((1.0 - share).sqrt(), share.sqrt());
    UnitQuaternion::new_normalize(Quaternion::new(large * b.cos(), small * a.sin(), small * a.cos(), large * b.sin()))
}
