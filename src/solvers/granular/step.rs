//! One time step: forces, motion, walls, and checks.

use super::bed::Bed;
use super::body::{Arm, Body, Clump};
use super::contacts::{ContactEnergy, Contacts, Surroundings, shifts};
use super::energy::Energy;
use super::failure::Failure;
use super::force::Prepared;
use super::incidence::Incidence;
use super::integrate::{self, Acting, Drive, Moving, Tally};
use super::lanes::Real;
use super::lists::Span;
use super::motion::{Felt, WallMotion};
use super::sheet::Sheet;
use super::tasks::Task;
use super::timings::Timings;
use super::walls::{Wall, WallId, approach};
use std::time::Instant;

/// Number of tasks that one thread computes before it moves their bodies: their data fit into its cache. Several
/// threads compute all contacts, then move all bodies: they wait for each other after both, and these waits cost more
/// than the cache saves (docs/validation.md, speed).
const ALONE: usize = 3;

/// Access to the walls between the computation of forces and the motion.
pub struct Guided<'a> {
    walls: &'a mut [Wall],
    /// Time of the forces, s.
    pub time: f64,
    /// Length of the step, s.
    pub dt: f64,
}

impl Guided<'_> {
    /// Contact forces on a wall.
    pub fn felt(&self, wall: WallId) -> &Felt {
        &self.walls[wall.0 as usize].felt
    }

    /// The moment of the contacts on a wall about its place, N m.
    pub fn moment(&self, wall: WallId) -> [f64; 3] {
        self.walls[wall.0 as usize].moment
    }

    /// Velocity of a guided wall in this step, m/s.
    pub fn drive(&mut self, wall: WallId, velocity: [f64; 3]) {
        self.walls[wall.0 as usize].velocity = velocity.into();
    }

    /// Angular velocity of a guided wall about its place in this step, rad/s.
    pub fn turn(&mut self, wall: WallId, spin: [f64; 3]) {
        self.walls[wall.0 as usize].spin = spin.into();
    }

    /// The corners of a floor: their forces are computed, and their motion must be set.
    pub fn sheet(&mut self, wall: WallId) -> Option<&mut Sheet> {
        self.walls[wall.0 as usize].sheet.as_deref_mut()
    }
}

/// The bodies, and the contacts between them.
struct Between<'a, R: Real> {
    bodies: &'a mut [Body],
    records: &'a mut [R::Record],
    clumps: &'a mut [Clump],
    arms: &'a [Arm],
    incidence: &'a Incidence,
    contacts: &'a mut Contacts<R>,
    tasks: &'a [Task],
    spans: &'a mut [Span],
    timings: &'a mut Timings,
}

impl<R: Real> Between<'_, R> {
    /// Computes the forces of all contacts, and moves the bodies if `drive` is given. `around` has the laws, the shifts
    /// of images and the time step; the energy of the contacts is added to `energy`.
    ///
    /// Contacts belong to the task of the earlier of their two bodies. So once the contacts of some tasks are computed,
    /// all contacts of their bodies are computed, and later tasks do not read the old state of these bodies. They are
    /// moved while all data are in the cache.
    fn sweep(
        self,
        (laws, shifts, dt): (&[Prepared], &[[f64; 3]; 64], f64),
        drive: Option<&Drive>,
        mut energy: ContactEnergy,
    ) -> (ContactEnergy, Tally) {
        let mut tally = Tally::default();
        let last = self.tasks.len().saturating_sub(1);
        let window = if rayon::current_num_threads() == 1 { ALONE } else { last.max(1) };
        for begin in (0..last).step_by(window) {
            let tasks = &self.tasks[begin..=(begin + window).min(last)];
            let start = Instant::now();
            let around = Surroundings { records: self.records, laws, shifts, dt };
            // task by task, so that the sum does not depend on the window
            self.contacts.evaluate(tasks, around).into_iter().for_each(|of_task| energy += of_task);
            let forced = Instant::now();
            if let Some(drive) = drive {
                let moving = Moving {
                    bodies: &mut self.bodies[tasks[0].body as usize..],
                    records: &mut self.records[tasks[0].pebble as usize..],
                    clumps: &mut self.clumps[tasks[0].clump as usize..],
                    arms: self.arms,
                };
                let acting = Acting { incidence: self.incidence, outcomes: &self.contacts.outcomes };
                let tallies = integrate::advance::<R>(moving, tasks, acting, drive);
                for (span, of_task) in self.spans[begin..].iter_mut().zip(tallies) {
                    span.travelled += of_task.fastest.0.sqrt() * drive.dt;
                    tally = tally.and(of_task);
                }
            }
            self.timings.forces += forced - start;
            self.timings.motion += forced.elapsed();
        }
        (energy, tally)
    }
}

impl<R: Real> Bed<R> {
    /// Does `count` steps, or stops at the first failure.
    pub fn run(&mut self, count: u64) -> Result<(), Failure> {
        // from within the pool: a thread outside it would sleep and wake four times per step, half of the time of a
        // small bed
        rayon::scope(|_| (0..count).try_for_each(|_| self.step()))
    }

    /// Does one step of the leapfrog: `v += F/m dt`, `x += v dt`. The first kick is half a step long, so that
    /// velocities are half a step before positions from then on.
    pub fn step(&mut self) -> Result<(), Failure> {
        self.guided_step(|_| Ok(()))
    }

    /// The same as [`Bed::step`], with a guide: `guide` reads the forces on walls at the start of the step and sets the
    /// motion of the guided walls. It runs beside the contacts between bodies, because it needs none of them.
    pub fn guided_step<E: From<Failure> + Send>(
        &mut self,
        guide: impl FnOnce(&mut Guided<'_>) -> Result<(), E> + Send,
    ) -> Result<(), E> {
        if self.dt == 0.0 {
            return Err(Failure::NoTimeStep.into());
        }
        let start = Instant::now();
        self.refresh()?;
        self.timings.search += start.elapsed();
        let drive = Drive {
            kick: if self.fresh { 0.5 * self.dt } else { self.dt },
            dt: self.dt,
            gravity: self.gravity.value_at(self.time),
            damping: self.damping,
            watched: self.ledger.watched,
        };
        let (time, dt) = (self.time, self.dt);
        let guide = |walls: &mut [Wall]| guide(&mut Guided { walls, time, dt });
        if drive.watched {
            // the account needs the motion of the walls before the guide changes it
            let (energy, ()) = self.sweep(Some(&drive), |_| ());
            self.ledger.enter(energy, &self.tally, &self.walls, dt);
            guide(&mut self.walls)?;
        } else {
            self.sweep(Some(&drive), guide).1?;
        }
        self.move_walls();
        self.lists.of_walls.travelled += approach(&self.walls, self.dt, self.lists.extent);
        self.fresh = false;
        self.steps += 1;
        self.time += self.dt;
        self.settle();
        Ok(self.look()?)
    }

    /// Computes every force, and moves the bodies if `drive` is given. `guide` gets the walls as soon as their forces
    /// are known, beside the contacts between bodies.
    pub(super) fn sweep<T: Send>(
        &mut self,
        drive: Option<&Drive>,
        guide: impl FnOnce(&mut [Wall]) -> T + Send,
    ) -> (ContactEnergy, T) {
        let laws: Vec<Prepared> = self.laws.all().iter().map(|law| Prepared::new(law, self.dt)).collect();
        let shifts = shifts(&self.domain);
        let mut energy = self.wall_forces(&laws, &shifts);
        energy += self.bond_forces(&laws, &shifts);
        let Bed { walls, wall_contacts, bodies, records, clumps, arms, incidence, contacts, lists, timings, .. } = self;
        let (tasks, spans) = (&lists.tasks[..], &mut lists.spans[..]);
        let between = Between { bodies, records, clumps, arms, incidence, contacts, tasks, spans, timings };
        let around = (&laws[..], &shifts, self.dt);
        let loading = || {
            wall_contacts.load(walls);
            guide(walls)
        };
        let ((energy, tally), guided) = rayon::join(|| between.sweep(around, drive, energy), loading);
        if drive.is_some() {
            self.tally = tally;
        }
        (energy, guided)
    }

    fn wall_forces(&mut self, laws: &[Prepared], shifts: &[[f64; 3]; 64]) -> ContactEnergy {
        if self.walls.is_empty() {
            return ContactEnergy::default();
        }
        let start = Instant::now();
        let around = Surroundings { records: &self.records, laws, shifts, dt: self.dt };
        let from = self.contacts.first.len();
        let outcomes = &mut self.contacts.outcomes[from..from + self.wall_contacts.slots.len()];
        let (walls, watched) = (&self.walls, self.ledger.watched);
        let energy = self.wall_contacts.evaluate(walls, &self.laws, &self.domain, around, outcomes, watched);
        self.timings.walls += start.elapsed();
        energy
    }

    fn bond_forces(&mut self, laws: &[Prepared], shifts: &[[f64; 3]; 64]) -> ContactEnergy {
        if self.bonds.places() == 0 {
            return ContactEnergy::default();
        }
        let start = Instant::now();
        let around = Surroundings { records: &self.records, laws, shifts, dt: self.dt };
        let before = self.contacts.first.len() + self.wall_contacts.slots.len();
        let energy = self.bonds.evaluate(around, &mut self.contacts.outcomes[before..]);
        self.timings.forces += start.elapsed();
        energy
    }

    /// Time spent in all steps so far, part by part.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    fn move_walls(&mut self) {
        for wall in &mut self.walls {
            if !matches!(wall.motion, WallMotion::Guided) {
                (wall.velocity, wall.spin) = wall.motion.velocity(self.time, self.dt, &wall.felt);
            }
            wall.pose.advance(&wall.velocity, &wall.spin, self.dt);
            let (cell, position) = self.domain.settle(wall.cell, wall.pose.position.into());
            if cell != wall.cell {
                (wall.cell, wall.pose.position) = (cell, position.into());
                // the lists measure displacements from stored poses
                self.lists.outdated = true;
            }
        }
    }

    /// Starts or stops recording energies by kind. Recording costs about a quarter of the speed.
    pub fn watch_energy(&mut self, on: bool) {
        self.ledger.watch(on);
        self.contacts.watch(on);
    }

    /// Energies at the start of the last step; all zero unless energies are recorded.
    pub fn energy(&self) -> Energy {
        self.ledger.now
    }
}
