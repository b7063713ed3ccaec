//! One time step: forces, motion, walls, and a look whether all is well.

use super::bed::Bed;
use super::contacts::{ContactEnergy, Surroundings, shifts};
use super::fault::Fault;
use super::force::Prepared;
use super::integrate::{self, Drive};
use super::lanes::Real;
use super::search::CellTooSmall;
use super::walls::{Pebbles, approach};
use super::watch::Failure;
use std::time::{Duration, Instant};

/// Where the time of steps went.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timings {
    /// Making lists.
    pub search: Duration,
    /// Forces, those at walls among them.
    pub forces: Duration,
    pub walls: Duration,
    /// Sums, bodies and walls in motion.
    pub motion: Duration,
}

impl From<Fault> for Failure {
    fn from(fault: Fault) -> Failure {
        Failure::Fault(fault)
    }
}

impl From<CellTooSmall> for Failure {
    fn from(_: CellTooSmall) -> Failure {
        Failure::CellTooSmall
    }
}

impl<R: Real> Bed<R> {
    /// Does `count` steps, or as many as go well.
    pub fn run(&mut self, count: u64) -> Result<(), Failure> {
        (0..count).try_for_each(|_| self.step())
    }

    /// Does one step of the leapfrog: `v += F/m dt`, `x += v dt`. The first kick is half a step long, so that velocities
    /// stand half a step before positions from then on.
    pub fn step(&mut self) -> Result<(), Failure> {
        if self.dt == 0.0 {
            return Err(Failure::NoTimeStep);
        }
        let start = Instant::now();
        self.refresh()?;
        let listed = Instant::now();
        let energy = self.forces();
        let forced = Instant::now();
        let watched = self.ledger.watched;
        if watched {
            self.ledger.enter_contacts(energy, &self.walls, self.dt);
        }
        let drive = Drive {
            kick: if self.fresh { 0.5 * self.dt } else { self.dt },
            dt: self.dt,
            gravity: self.gravity.at(self.time),
            damping: self.damping,
            watched,
        };
        let contacts = (&self.incidence, &self.contacts.outcomes[..]);
        self.tally = integrate::advance::<R>(
            &mut self.bodies,
            &mut self.records,
            &mut self.clumps,
            &self.arms,
            contacts,
            &drive,
        );
        if watched {
            self.ledger.enter_bodies(&self.tally);
        }
        self.move_walls();
        self.build.travel += 2.0 * self.tally.fastest.0.sqrt() * self.dt + approach(&self.walls, self.dt);
        self.fresh = false;
        self.steps += 1;
        self.time += self.dt;
        self.timings.search += listed - start;
        self.timings.forces += forced - listed;
        self.timings.motion += forced.elapsed();
        self.look()
    }

    /// Computes the force of every contact from the present state.
    pub(super) fn forces(&mut self) -> ContactEnergy {
        let laws: Vec<Prepared> = self.laws.all().iter().map(|law| Prepared::new(law, self.dt)).collect();
        let shifts = shifts(&self.domain);
        let around = Surroundings { records: &self.records, laws: &laws, shifts: &shifts, dt: self.dt };
        let watched = self.ledger.watched;
        let mut energy = self.contacts.evaluate(around, watched);
        let start = Instant::now();
        if !self.walls.is_empty() {
            let bodies = &self.bodies;
            let cell = |body: u32| bodies[body as usize].cell;
            let pebbles = Pebbles { owner: &self.owner, cell: &cell };
            let pairs = self.contacts.len();
            let outcomes = &mut self.contacts.outcomes[pairs..];
            let (walls, domain) = (&mut self.walls, &self.domain);
            energy += self.wall_contacts.evaluate(walls, domain, &self.laws, pebbles, around, outcomes, watched);
        }
        self.timings.walls += start.elapsed();
        energy
    }

    /// Where the time of all steps so far went.
    pub fn timings(&self) -> Timings {
        self.timings
    }

    fn move_walls(&mut self) {
        for wall in &mut self.walls {
            (wall.velocity, wall.spin) = wall.motion.velocity(self.time, self.dt, &wall.felt);
            wall.pose.advance(&wall.velocity, &wall.spin, self.dt);
            let (cell, position) = self.domain.settle(wall.cell, wall.pose.position.into());
            if cell != wall.cell {
                (wall.cell, wall.pose.position) = (cell, position.into());
                // the lists measure ways from poses
                self.build.outdated = true;
            }
        }
    }

    /// Counts energies by kind from now on, or stops doing so. Costs about a quarter of the speed.
    pub fn watch_energy(&mut self, on: bool) {
        self.ledger.watch(on);
        self.contacts.damping.clear();
    }

    /// Energies at the start of the last step; all zero where nobody watched.
    pub fn energy(&self) -> super::Energy {
        self.ledger.now
    }
}
