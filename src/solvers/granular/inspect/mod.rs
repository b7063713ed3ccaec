//! Reports all problems of a bed before its first step at once, each with numbers and a remedy.

use super::bed::Bed;
use super::body::BodyId;
use super::failure::Failure;
use super::lanes::Real;
use super::law::LawError;
use super::motion::MotionError;
use super::record::Record;
use super::shape::{Shape, ShapeError};
use super::vector::{Vec3, add, norm, scale, sub};
use super::walls::WallId;
use std::fmt;

/// A problem with which a run should not start.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// The bed has no body.
    Empty,
    /// A law with a number out of its range, and its two surfaces.
    ContactLaw {
        surfaces: [u16; 2],
        fault: LawError,
    },
    /// A wall with an invalid shape or motion.
    Shape {
        wall: WallId,
        fault: ShapeError,
    },
    WallMotion {
        wall: WallId,
        fault: MotionError,
    },
    /// A body with a number out of its range.
    Body {
        body: BodyId,
        quantity: &'static str,
        value: f64,
    },
    /// Pairs that overlap by more than the allowed share, and the worst pair.
    Overlaps {
        count: usize,
        body: BodyId,
        other: Other,
        place: Vec3,
        overlap: f64,
        share: f64,
    },
    /// Bodies with a pebble centre inside a solid, and the first of them.
    Outside {
        wall: WallId,
        count: usize,
        body: BodyId,
        place: Vec3,
    },
    /// A wall longer than half a period: contacts with its images are not found.
    WideWall {
        wall: WallId,
        axis: usize,
        extent: f64,
        period: f64,
    },
    /// A plane that leans along a periodic direction: it is not continuous from period to period.
    LeaningPlane {
        wall: WallId,
        axis: usize,
        lean: f64,
    },
    /// A grain that could touch its own image, or a neighbour twice.
    LargeGrain {
        body: BodyId,
        axis: usize,
        diameter: f64,
        cell: f64,
    },
    /// A period or bay in which neighbours are more than a cell apart.
    CellTooSmall,
    /// The time step is above the limit of the contacts.
    Step {
        dt: f64,
        limit: f64,
        body: Option<(BodyId, Vec3)>,
    },
    NoStep,
}

/// The second of two overlapping parties.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Other {
    Body(BodyId),
    Wall(WallId),
}

/// Largest share of a periodic cell that a grain may take.
const GRAIN: f64 = 1.0 / 3.0;
/// Component of a unit normal that counts as rounding.
const LEAN: f64 = 1e-9;

impl<R: Real> Bed<R> {
    /// Checks for overlaps of more than `share` of the smaller radius, bodies in walls, walls and grains that do not
    /// fit their periods, laws and numbers out of range, and a time step above the limit of the contacts.
    ///
    /// If numbers are out of range, only those are reported, because the other checks need valid numbers.
    pub fn inspect(&mut self, share: f64) -> Vec<Finding> {
        let mut found = Vec::new();
        if self.bodies.is_empty() {
            found.push(Finding::Empty);
        }
        self.inspect_laws(&mut found);
        self.inspect_walls(&mut found);
        self.inspect_numbers(&mut found);
        if !found.is_empty() {
            return found;
        }
        self.inspect_periods(&mut found);
        self.inspect_outside(&mut found);
        if self.refresh().is_err() {
            found.push(Finding::CellTooSmall);
            return found;
        }
        self.inspect_overlaps(share, &mut found);
        self.inspect_step(&mut found);
        found
    }

    fn inspect_laws(&self, found: &mut Vec<Finding>) {
        let used = |surface: u16| self.bodies.iter().any(|b| b.surface == surface);
        let surfaces = self.laws.surfaces() as u16;
        for a in (0..surfaces).filter(|&a| used(a)) {
            let others = (0..surfaces).filter(|&b| (used(b) && b >= a) || self.walls.iter().any(|w| w.surface == b));
            for b in others {
                let faults = self.laws.get(a, b).faults();
                found.extend(faults.into_iter().map(|fault| Finding::ContactLaw { surfaces: [a, b], fault }));
            }
        }
    }

    fn inspect_walls(&self, found: &mut Vec<Finding>) {
        for (number, wall) in self.walls.iter().enumerate() {
            let id = WallId(number as u32);
            found.extend(wall.shape.check().err().map(|fault| Finding::Shape { wall: id, fault }));
            let motion = wall.motion.check().and_then(|()| wall.pose.check());
            found.extend(motion.err().map(|fault| Finding::WallMotion { wall: id, fault }));
        }
    }

    fn inspect_numbers(&self, found: &mut Vec<Finding>) {
        for state in self.states() {
            let mut want = |quantity, value: f64, fine: bool| {
                if !fine {
                    found.push(Finding::Body { body: state.id, quantity, value });
                }
            };
            let odd = |v: [f64; 3]| v.into_iter().find(|x| !x.is_finite());
            want("mass", state.mass, state.mass.is_finite() && state.mass > 0.0);
            for (quantity, vector) in [("place", state.place), ("velocity", state.velocity), ("spin", state.spin)] {
                want(quantity, odd(vector).unwrap_or(0.0), odd(vector).is_none());
            }
        }
        for pebble in self.pebbles().filter(|p| !(p.radius.is_finite() && p.radius > 0.0)) {
            found.push(Finding::Body { body: pebble.body, quantity: "radius", value: pebble.radius });
        }
    }

    fn inspect_periods(&self, found: &mut Vec<Finding>) {
        for axis in 0..3 {
            if let Some(period) = self.domain.period(axis) {
                for (number, wall) in self.walls.iter().enumerate() {
                    found.extend(period_of_wall(WallId(number as u32), wall, axis, period));
                }
            }
            let Some(cell) = self.domain.cell_length(axis) else { continue };
            let largest = self.pebbles().fold(None::<(f64, BodyId)>, |most, p| match most {
                Some((diameter, _)) if diameter >= 2.0 * p.radius => most,
                _ => Some((2.0 * p.radius, p.body)),
            });
            if let Some((diameter, body)) = largest.filter(|(diameter, _)| *diameter > GRAIN * cell) {
                found.push(Finding::LargeGrain { body, axis, diameter, cell });
            }
        }
    }

    /// Bodies with a pebble centre inside a solid.
    fn inspect_outside(&self, found: &mut Vec<Finding>) {
        for (number, wall) in self.walls.iter().enumerate() {
            let mut inside: Vec<(u32, Vec3)> = Vec::new();
            for body in &self.bodies {
                let pebbles = body.first as usize..body.first as usize + usize::from(body.pebbles);
                let places = self.records[pebbles].iter().map(Record::position);
                let first = places.into_iter().find(|&at| {
                    let away = wall.to(&self.domain, body.cell, at);
                    wall.shape.contains(&wall.turned_back(away))
                });
                inside.extend(first.map(|at| (body.id, self.domain.place(body.cell, at))));
            }
            if let Some(&(id, place)) = inside.iter().min_by_key(|(id, _)| *id) {
                let wall = WallId(number as u32);
                found.push(Finding::Outside { wall, count: inside.len(), body: BodyId(id), place });
            }
        }
    }

    fn inspect_overlaps(&self, limit: f64, found: &mut Vec<Finding>) {
        let mut worst: Option<Finding> = None;
        let (mut count, mut most) = (0, 0.0);
        for place in 0..self.contacts.len() {
            let (a, b) = (self.contacts.first[place], self.contacts.second[place]);
            if a as usize == self.owner.len() {
                continue;
            }
            let (one, other) = (&self.records[a as usize], &self.records[b as usize]);
            let apart = add(sub(one.position(), other.position()), self.domain.shift(self.contacts.image[place]));
            let overlap = one.radius() + other.radius() - norm(apart);
            let share = overlap / one.radius().min(other.radius());
            count += usize::from(share > limit);
            if share > limit && share > most {
                most = share;
                let ids = [a, b].map(|p| BodyId(self.name(p).0));
                let body = &self.bodies[self.owner[a as usize] as usize];
                let place = sub(self.domain.place(body.cell, one.position()), scale(apart, 0.5));
                worst =
                    Some(Finding::Overlaps { count, body: ids[0], other: Other::Body(ids[1]), place, overlap, share });
            }
        }
        for entry in &self.wall_contacts.entries {
            let wall = &self.walls[entry.wall as usize];
            let record = &self.records[entry.pebble as usize];
            let body = &self.bodies[self.owner[entry.pebble as usize] as usize];
            let away = wall.to(&self.domain, body.cell, record.position());
            let facets = &self.wall_contacts.facets[entry.facets.0 as usize..entry.facets.1 as usize];
            let mut touches = Vec::new();
            wall.touches(away, record.radius(), facets, &mut touches);
            let deepest = touches.iter().map(|t| record.radius() - t.distance).fold(0.0, f64::max);
            let share = deepest / record.radius();
            count += usize::from(share > limit);
            if share > limit && share > most {
                most = share;
                let other = Other::Wall(WallId(entry.wall));
                let place = self.domain.place(body.cell, record.position());
                worst = Some(Finding::Overlaps { count, body: BodyId(body.id), other, place, overlap: deepest, share });
            }
        }
        if let Some(Finding::Overlaps { body, other, place, overlap, share, .. }) = worst {
            found.push(Finding::Overlaps { count, body, other, place, overlap, share });
        }
    }

    fn inspect_step(&mut self, found: &mut Vec<Finding>) {
        if self.dt <= 0.0 {
            found.push(Finding::NoStep);
            return;
        }
        match self.critical_step(0.0) {
            Ok(step) if self.dt > step.network.step => found.push(Finding::Step {
                dt: self.dt,
                limit: step.network.step,
                body: step.network.seat.map(|seat| (seat.body, seat.place)),
            }),
            Ok(_) => {}
            Err(_) => found.push(Finding::CellTooSmall),
        }
    }
}

/// The problem of a wall along a periodic axis.
fn period_of_wall(wall: WallId, shape: &super::walls::Wall, axis: usize, period: f64) -> Option<Finding> {
    match &shape.shape {
        Shape::Plane { normal } => {
            let lean = shape.pose.direction_to_space(normal)[axis];
            (lean.abs() > LEAN).then_some(Finding::LeaningPlane { wall, axis, lean })
        }
        _ => {
            let [low, high] = shape.shape.bounds()?;
            let corner = |k: usize| [0, 1, 2].map(|c| if k >> c & 1 == 0 { low[c] } else { high[c] });
            let along = |k: usize| shape.pose.direction_to_space(&corner(k).into())[axis];
            let (least, most) =
                (0..8).map(along).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            let extent = most - least;
            (extent > 0.5 * period).then_some(Finding::WideWall { wall, axis, extent, period })
        }
    }
}

struct At(Vec3);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "({x:.4}, {y:.4}, {z:.4}) m")
    }
}

impl fmt::Display for Other {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Other::Body(id) => write!(f, "body {}", id.0),
            Other::Wall(id) => write!(f, "wall {}", id.0),
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        const AXES: [char; 3] = ['x', 'y', 'z'];
        match self {
            Finding::Empty => write!(f, "there is no body; add spheres or clumps"),
            Finding::ContactLaw { surfaces: [a, b], fault } => {
                write!(f, "law between surfaces {a} and {b}: {fault}; set it before bodies of these surfaces touch")
            }
            Finding::Shape { wall, fault } => write!(f, "wall {}: {fault}", wall.0),
            Finding::WallMotion { wall, fault } => write!(f, "wall {}: {fault}", wall.0),
            Finding::Body { body, quantity, value } => {
                write!(
                    f,
                    "body {}: its {quantity} is {value}; give a finite value, above 0 for mass and radius",
                    body.0
                )
            }
            Finding::Overlaps { count, body, other, place, overlap, share } => write!(
                f,
                "{count} contacts overlap too much; the largest overlap is between body {} and {other} at {}: {overlap:.3e} m, {share:.3} of \
                 the smaller radius; move them apart, or let radii grow under damping",
                body.0,
                At(*place)
            ),
            Finding::Outside { wall, count, body, place } => write!(
                f,
                "{count} bodies have their centre inside wall {}; the first is body {} at {}; move them out, or reverse the normals of the wall",
                wall.0,
                body.0,
                At(*place)
            ),
            Finding::WideWall { wall, axis, extent, period } => write!(
                f,
                "wall {} is {extent:.4} m long along {}, more than half of the period of {period:.4} m, but contacts with its periodic \
                 images are not found; use a plane, or cut it into shorter walls",
                wall.0, AXES[*axis]
            ),
            Finding::LeaningPlane { wall, axis, lean } => write!(
                f,
                "plane {} leans along the periodic {}, by {lean:.3e} of its normal, so it is not continuous from period to period; turn \
                 the normal perpendicular to it, or make that direction not periodic",
                wall.0, AXES[*axis]
            ),
            Finding::LargeGrain { body, axis, diameter, cell } => write!(
                f,
                "body {} has a pebble of diameter {diameter:.4} m, more than a third of the cell of {cell:.4} m along {}; take a longer cell",
                body.0, AXES[*axis]
            ),
            Finding::CellTooSmall => write!(f, "{}", Failure::CellTooSmall),
            Finding::Step { dt, limit, body } => {
                write!(f, "the time step of {dt:.3e} s is above the limit of {limit:.3e} s of the contacts")?;
                if let Some((body, place)) = body {
                    write!(f, ", set by body {} at {}", body.0, At(*place))?;
                }
                write!(f, "; take {:.3e} s, or scale masses", 0.9 * limit)
            }
            Finding::NoStep => write!(f, "{}", Failure::NoTimeStep),
        }
    }
}

#[cfg(test)]
mod tests;
