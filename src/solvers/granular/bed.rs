//! A bed of grains: its parts, and the functions to build it.

use super::body::{Arm, Body, BodyId, Clump, SPHERE};
use super::bonds::Bonds;
use super::clump::Template;
use super::contacts::Contacts;
use super::domain::Domain;
use super::energy::Ledger;
use super::failure::Limits;
use super::gravity::Gravity;
use super::incidence::Incidence;
use super::integrate::{Tally, rotate, rotate_back};
use super::lanes::Real;
use super::law::{ContactLaw, ContactLaws};
use super::lists::Lists;
use super::motion::{Felt, Pose, WallMotion};
use super::record::Record;
use super::rotation;
use super::shape::Shape;
use super::sheet::Sheet;
use super::timings::Timings;
use super::vector::{add, cross};
use super::walls::{Wall, WallContacts, WallId};
use super::watch::memory::Watch;
use nalgebra::{UnitQuaternion, Vector3};

/// Spheres and clumps, the walls around them, and their state.
///
/// `R` is the precision of forces, velocities and contact histories: `f32` for normal work, `f64` for reference.
/// Positions, momenta and sums are `f64` in both. Lengths in m, forces in N, masses in kg, time in s.
///
/// Invalid numbers are reported by the next step, before it moves anything, or by [`Bed::check`].
#[derive(Debug, Clone)]
pub struct Bed<R: Real = f32> {
    pub(super) domain: Domain,
    pub(super) laws: ContactLaws,
    pub(super) gravity: Gravity,
    pub(super) damping: f64,
    pub(super) dt: f64,
    /// Sorted by position if the contacts are up to date.
    pub(super) bodies: Vec<Body>,
    /// Records of the pebbles, body by body; behind them two records that touch nothing.
    pub(super) records: Vec<R::Record>,
    /// Body of each pebble.
    pub(super) owner: Vec<u32>,
    /// In the order of the bodies.
    pub(super) clumps: Vec<Clump>,
    /// Positions of the pebbles in the frames of their bodies.
    pub(super) arms: Vec<Arm>,
    /// Index of each body in the bed, by the order of creation.
    pub(super) index: Vec<u32>,
    pub(super) walls: Vec<Wall>,
    pub(super) contacts: Contacts<R>,
    pub(super) wall_contacts: WallContacts<R>,
    pub(super) bonds: Bonds<R>,
    pub(super) incidence: Incidence,
    pub(super) lists: Lists,
    pub(super) tally: Tally,
    pub(super) ledger: Ledger,
    pub(super) time: f64,
    pub(super) steps: u64,
    /// Whether velocities still belong to the start and not to a half step.
    pub(super) fresh: bool,
    /// Whether something was added or set that has not been checked.
    pub(super) unchecked: bool,
    pub(super) limits: Limits,
    pub(super) watch: Watch,
    pub(super) timings: Timings,
}

/// A sphere to put into a bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    pub centre: [f64; 3],
    pub radius: f64,
    /// \[kg/m3\]
    pub density: f64,
    pub surface: u16,
}

/// A clump to put into a bed.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed<'a> {
    pub template: &'a Template,
    /// Place of the centroid \[m\].
    pub centre: [f64; 3],
    /// Principal frame of the template to world.
    pub attitude: UnitQuaternion<f64>,
    /// \[kg/m3\]
    pub density: f64,
    pub surface: u16,
}

/// The readable state of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    pub id: BodyId,
    /// Place of the centroid, not wrapped into the period \[m\].
    pub place: [f64; 3],
    /// Velocity of the last half step \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity of the last half step \[rad/s\].
    pub spin: [f64; 3],
    /// Unit quaternion w, x, y, z; the identity for a sphere, whose rotation is not tracked.
    pub attitude: [f64; 4],
    /// Mass that has weight, without the mass added by mass scaling \[kg\].
    pub mass: f64,
    pub surface: u16,
    /// Number of pebbles.
    pub pebbles: usize,
}

/// A pebble of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PebbleState {
    pub body: BodyId,
    /// Not wrapped into the period \[m\].
    pub place: [f64; 3],
    pub radius: f64,
}

impl<R: Real> Bed<R> {
    /// An empty bed without gravity and damping.
    pub fn new(domain: Domain, laws: ContactLaws) -> Self {
        Bed {
            domain,
            laws,
            gravity: Gravity::default(),
            damping: 0.0,
            dt: 0.0,
            bodies: Vec::new(),
            records: Vec::new(),
            owner: Vec::new(),
            clumps: Vec::new(),
            arms: Vec::new(),
            index: Vec::new(),
            walls: Vec::new(),
            contacts: Contacts::default(),
            wall_contacts: WallContacts::default(),
            bonds: Bonds::default(),
            incidence: Incidence::default(),
            lists: Lists::default(),
            tally: Tally::default(),
            ledger: Ledger::default(),
            time: 0.0,
            steps: 0,
            fresh: true,
            unchecked: true,
            limits: Limits::default(),
            watch: Watch::default(),
            timings: Timings::default(),
        }
    }

    /// Adds a sphere at rest.
    pub fn add_sphere(&mut self, sphere: &Sphere) -> BodyId {
        let &Sphere { centre, radius, density, surface } = sphere;
        let mass = density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let (cell, offset) = self.domain.split(centre);
        let mut record = R::Record::new(radius, mass);
        record.place(offset);
        let body = Body { inverse_inertia: 1.0 / (0.4 * mass * radius * radius), ..self.body(mass, cell, 1, surface) };
        self.put(body, [record])
    }

    /// Adds a clump at rest. A template of one pebble makes a sphere.
    pub fn add_clump(&mut self, placed: &Placed) -> BodyId {
        let &Placed { template, centre, attitude, density, surface } = placed;
        if let [pebble] = template.pebbles[..] {
            return self.add_sphere(&Sphere { centre, radius: pebble.radius, density, surface });
        }
        let mass = density * template.volume;
        let (cell, centre) = self.domain.split(centre);
        let turned = attitude.quaternion();
        let clump = Clump {
            centre,
            attitude: [turned.w, turned.i, turned.j, turned.k],
            turning: [0.0; 3],
            inverse_inertia: template.inertia.map(|i| 1.0 / (density * i)).into(),
            arms: self.arms.len() as u64,
        };
        let matrix = rotation::matrix(&clump.attitude);
        let records: Vec<R::Record> = template
            .pebbles
            .iter()
            .map(|pebble| {
                let mut record = R::Record::new(pebble.radius, mass);
                record.place(add(centre, rotate(&matrix, pebble.centre.into())));
                record
            })
            .collect();
        self.arms.extend(template.pebbles.iter().map(|p| [p.centre.x, p.centre.y, p.centre.z, 0.0]));
        let body = Body { clump: self.clumps.len() as u32, ..self.body(mass, cell, records.len(), surface) };
        self.clumps.push(clump);
        self.put(body, records)
    }

    fn body(&self, mass: f64, cell: [i32; 3], pebbles: usize, surface: u16) -> Body {
        let id = self.bodies.len() as u32;
        Body {
            velocity: [0.0; 3],
            spin: [0.0; 3],
            inverse_mass: 1.0 / mass,
            inverse_inertia: 0.0,
            mass,
            cell,
            id,
            rank: id,
            first: self.owner.len() as u32,
            // too many pebbles give 0, which the check reports
            pebbles: u16::try_from(pebbles).unwrap_or(0),
            surface,
            clump: SPHERE,
        }
    }

    fn put(&mut self, body: Body, records: impl IntoIterator<Item = R::Record>) -> BodyId {
        let place = self.bodies.len() as u32;
        self.records.truncate(self.owner.len());
        self.records.extend(records);
        self.owner.resize(self.records.len(), place);
        self.bodies.push(body);
        self.index.push(place);
        self.lists.outdated = true;
        self.unchecked = true;
        BodyId(body.id)
    }

    /// Adds a wall. `pose` is the position of its frame.
    pub fn add_wall(&mut self, shape: Shape, pose: Pose, surface: u16, motion: WallMotion) -> WallId {
        let (cell, position) = self.domain.split(pose.position.into());
        self.walls.push(Wall {
            shape,
            pose: Pose { position: position.into(), ..pose },
            cell,
            surface,
            motion: WallMotion::Fixed,
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            felt: Felt::default(),
            moment: [0.0; 3],
            sheet: None,
        });
        self.lists.outdated = true;
        let id = WallId(self.walls.len() as u32 - 1);
        self.set_motion(id, motion);
        id
    }

    /// Adds a fixed plane through `point` \[m\] with the solid behind its unit `normal`.
    pub fn add_plane(&mut self, point: [f64; 3], normal: [f64; 3], surface: u16) -> WallId {
        let pose = Pose { position: point.into(), ..Pose::default() };
        self.add_wall(Shape::Plane { normal: normal.into() }, pose, surface, WallMotion::Fixed)
    }

    /// Lets the corners of a floor move; a guide moves them, see [`Bed::guided_step`].
    ///
    /// # Panics
    /// If the wall is not a level plane.
    pub fn soften(&mut self, wall: WallId, sheet: Sheet) {
        let wall = &mut self.walls[wall.0 as usize];
        let up = matches!(wall.shape, Shape::Plane { normal } if normal == Vector3::z());
        assert!(up && wall.pose.orientation == Pose::default().orientation, "a floor is level");
        wall.sheet = Some(Box::new(sheet));
        self.lists.outdated = true;
    }

    /// Gives a wall another motion from now on.
    pub fn set_motion(&mut self, wall: WallId, motion: WallMotion) {
        let wall = &mut self.walls[wall.0 as usize];
        (wall.velocity, wall.spin) = match &motion {
            // a servo has no velocity until it has a contact force
            WallMotion::Servo { .. } => (Vector3::zeros(), Vector3::zeros()),
            faulty if faulty.check().is_err() => (Vector3::zeros(), Vector3::zeros()),
            // a wall with a mass keeps its speed
            WallMotion::Loaded { axis, .. } => (axis * wall.velocity.dot(axis), Vector3::zeros()),
            given => given.velocity(self.time, self.dt.max(f64::MIN_POSITIVE), &Felt::default()),
        };
        wall.motion = motion;
        self.unchecked = true;
    }

    /// Puts a wall at another position at once; it keeps its motion. Grains on the way are not touched.
    pub fn stand(&mut self, wall: WallId, place: [f64; 3]) {
        let (cell, position) = self.domain.split(place);
        let wall = &mut self.walls[wall.0 as usize];
        (wall.cell, wall.pose.position) = (cell, position.into());
        self.lists.outdated = true;
    }

    /// Sets velocity \[m/s\] and angular velocity \[rad/s\] of a body.
    pub fn set_velocity(&mut self, id: BodyId, velocity: [f64; 3], spin: [f64; 3]) {
        self.unchecked = true;
        let body = &mut self.bodies[self.index[id.0 as usize] as usize];
        body.velocity = velocity;
        let range = body.first as usize..body.first as usize + usize::from(body.pebbles);
        if body.clump == SPHERE {
            body.spin = spin;
            self.records[range.start].move_with(velocity.map(R::from_f64), spin.map(R::from_f64));
            return;
        }
        let clump = &mut self.clumps[body.clump as usize];
        let matrix = rotation::matrix(&clump.attitude);
        let local = rotate_back(&matrix, spin);
        // a body that keeps its spin has no angular momentum
        let held = clump.inverse_inertia == [0.0; 3];
        let momentum = [0, 1, 2].map(|c| if held { 0.0 } else { local[c] / clump.inverse_inertia[c] });
        body.spin = rotate(&matrix, momentum);
        clump.turning = spin;
        for (record, &[x, y, z, _]) in self.records[range].iter_mut().zip(&self.arms[clump.arms as usize..]) {
            let velocity = add(velocity, cross(spin, rotate(&matrix, [x, y, z])));
            record.move_with(velocity.map(R::from_f64), spin.map(R::from_f64));
        }
    }

    /// Makes a body keep its velocity and spin under any force.
    pub fn fix(&mut self, id: BodyId) {
        let body = &mut self.bodies[self.index[id.0 as usize] as usize];
        (body.inverse_mass, body.inverse_inertia) = (0.0, 0.0);
        if body.clump != SPHERE {
            self.clumps[body.clump as usize].inverse_inertia = [0.0; 3];
        }
    }

    /// Makes a body keep its rotation at zero.
    pub fn hold_rotation(&mut self, id: BodyId) {
        let velocity = self.body_state(id).velocity;
        self.set_velocity(id, velocity, [0.0; 3]);
        let body = &mut self.bodies[self.index[id.0 as usize] as usize];
        body.inverse_inertia = 0.0;
        if body.clump != SPHERE {
            self.clumps[body.clump as usize].inverse_inertia = [0.0; 3];
        }
    }

    /// Time step, above 0 \[s\].
    pub fn set_time_step(&mut self, dt: f64) {
        self.dt = dt;
        self.unchecked = true;
    }

    pub fn set_gravity(&mut self, gravity: Gravity) {
        self.gravity = gravity;
        self.unchecked = true;
    }

    /// Local damping after Cundall, from 0 to below 1.
    pub fn set_damping(&mut self, damping: f64) {
        self.damping = damping;
        self.unchecked = true;
    }

    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// Changes every contact law, for example its friction.
    pub fn change_laws(&mut self, change: impl FnMut(&mut ContactLaw)) {
        self.laws.change(change);
        self.unchecked = true;
    }

    /// Replaces the laws between the same surfaces. Contacts keep their histories.
    ///
    /// # Panics
    /// If there are fewer or more surfaces than before.
    pub fn set_laws(&mut self, laws: ContactLaws) {
        assert_eq!(laws.surfaces(), self.laws.surfaces(), "surfaces of a bed");
        self.laws = laws;
        self.unchecked = true;
    }

    pub fn laws(&self) -> &ContactLaws {
        &self.laws
    }

    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Time since the start \[s\].
    pub fn time(&self) -> f64 {
        self.time
    }

    pub fn steps(&self) -> u64 {
        self.steps
    }

    pub fn time_step(&self) -> f64 {
        self.dt
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    pub fn wall(&self, id: WallId) -> &Wall {
        &self.walls[id.0 as usize]
    }

    pub fn walls(&self) -> &[Wall] {
        &self.walls
    }

    pub fn body_state(&self, id: BodyId) -> BodyState {
        let body = &self.bodies[self.index[id.0 as usize] as usize];
        let (offset, spin, attitude) = if body.clump == SPHERE {
            (self.records[body.first as usize].position(), body.spin, [1.0, 0.0, 0.0, 0.0])
        } else {
            let clump = &self.clumps[body.clump as usize];
            (clump.centre, clump.turning, clump.attitude)
        };
        BodyState {
            id,
            place: self.domain.place(body.cell, offset),
            velocity: body.velocity,
            spin,
            attitude,
            mass: body.mass,
            surface: body.surface,
            pebbles: usize::from(body.pebbles),
        }
    }

    /// All bodies in the order of creation.
    pub fn states(&self) -> impl Iterator<Item = BodyState> + '_ {
        (0..self.bodies.len() as u32).map(|id| self.body_state(BodyId(id)))
    }

    /// All pebbles, body by body in the order of creation.
    pub fn pebbles(&self) -> impl Iterator<Item = PebbleState> + '_ {
        self.index.iter().flat_map(move |&place| {
            let body = &self.bodies[place as usize];
            let range = body.first as usize..body.first as usize + usize::from(body.pebbles);
            self.records[range].iter().map(move |record| PebbleState {
                body: BodyId(body.id),
                place: self.domain.place(body.cell, record.position()),
                radius: record.radius(),
            })
        })
    }
}
