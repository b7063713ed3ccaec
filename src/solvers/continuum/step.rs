//! One step of the leapfrog: `v += F/m dt`, `x += v dt`.

use super::chunk::{Answer, Chunk, Held, Values};
use super::energy::Tally;
use super::error::{SoilError, within};
use super::nodes::Nodes;
use super::shape::Shape;
use super::soil::{Damping, Soil};
use rayon::prelude::*;

/// Nodes that one thread moves together.
const NODES: usize = 1024;

/// Data of a step besides nodes and elements.
#[derive(Clone, Copy)]
struct Kick {
    /// This step and the step before \[s\]; velocities advance by the mean of both, because they are half a step before
    /// positions.
    dt: f64,
    last: f64,
    gravity: [f64; 3],
    local: f64,
    watched: bool,
}

impl Soil {
    /// Does one step of `dt` \[s\] under the forces added since the last step; these forces are used up.
    ///
    /// # Errors
    /// A step above the [`limit`](Soil::limit), or a motion that is not a finite number.
    pub fn step(&mut self, dt: f64) -> Result<(), SoilError> {
        within("the time step of the soil", dt, dt > 0.0, "a time above 0")?;
        let limit = self.limit();
        if dt > limit {
            return Err(SoilError::Step { dt, limit });
        }
        self.advance(dt)
    }

    /// Does a step without checking whether it is stable.
    pub(super) fn advance(&mut self, dt: f64) -> Result<(), SoilError> {
        let Damping { stiffness, local } = self.settings.damping;
        if stiffness > 0.0 {
            pull(&mut self.chunks, &self.shapes, &self.nodes.velocity, Answer::Linear);
            let viscous = |node| self.nodes.pull(&self.chunks, node).map(|force| stiffness * force);
            self.nodes.viscous = (0..self.nodes.mass.len()).map(viscous).collect();
        }
        let held = pull(&mut self.chunks, &self.shapes, &self.nodes.displacement, Answer::Remembered);
        let (gravity, watched) = (self.settings.gravity, self.ledger.watched);
        let kick = Kick { dt, last: self.clock.last, gravity, local, watched };
        let tally = advance(&mut self.nodes, &self.chunks, kick);
        self.nodes.clear_forces();
        if watched {
            self.ledger.enter(held, &tally);
        }
        self.clock.last = dt;
        self.clock.time += dt;
        self.clock.steps += 1;
        if tally.speed.is_finite() { Ok(()) } else { Err(self.lost()) }
    }

    fn lost(&self) -> SoilError {
        let bad = |velocity: &[f64; 3]| !velocity.iter().map(|v| v * v).sum::<f64>().is_finite();
        SoilError::Lost { node: self.nodes.velocity.iter().position(bad).unwrap_or(0), step: self.clock.steps }
    }
}

/// Computes the forces of all elements under displacements.
pub(super) fn pull(chunks: &mut [Chunk], shapes: &[Shape], displacement: &[[f64; 3]], answer: Answer) -> Held {
    let held: Vec<Held> = chunks
        .par_iter_mut()
        .map_init(Values::default, |place, chunk| chunk.pull(place, shapes, displacement, answer))
        .collect();
    let join = |a: Held, b: &Held| Held { strain: a.strain + b.strain, plastic: a.plastic + b.plastic };
    held.iter().fold(Held::default(), join)
}

fn advance(nodes: &mut Nodes, chunks: &[Chunk], kick: Kick) -> Tally {
    // the motion is taken out of the nodes while the threads read the other data
    let take = std::mem::take::<Vec<[f64; 3]>>;
    let (mut displacement, mut velocity) = (take(&mut nodes.displacement), take(&mut nodes.velocity));
    let still = &*nodes;
    let tallies: Vec<Tally> = displacement
        .par_chunks_mut(NODES)
        .zip(velocity.par_chunks_mut(NODES))
        .enumerate()
        .map(|(part, (displacement, velocity))| {
            let mut tally = Tally::default();
            for (i, (u, v)) in displacement.iter_mut().zip(velocity).enumerate() {
                *v = still.kick(chunks, part * NODES + i, *v, kick, &mut tally);
                (0..3).for_each(|axis| u[axis] += v[axis] * kick.dt);
                tally.speed += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            }
            tally
        })
        .collect();
    (nodes.displacement, nodes.velocity) = (displacement, velocity);
    tallies.into_iter().fold(Tally::default(), Tally::join)
}

impl Nodes {
    /// Velocity of a node after its kick.
    #[inline(always)]
    fn kick(&self, chunks: &[Chunk], node: usize, before: [f64; 3], kick: Kick, tally: &mut Tally) -> [f64; 3] {
        let pull = self.pull(chunks, node);
        let at = |values: &[[f64; 3]]| values.get(node).copied().unwrap_or_default();
        let (viscous, borne, dashpot) = (at(&self.viscous), at(&self.borne), at(&self.dashpot));
        let (external, mass, held) = (self.external(node), self.mass[node], self.held[node]);
        let time = 0.5 * (kick.dt + kick.last);
        let mut after = [0.0; 3];
        for axis in 0..3 {
            let weight = mass * kick.gravity[axis];
            let load = pull[axis] + external[axis] + borne[axis] + weight;
            let total = load + viscous[axis];
            let damper = dashpot[axis];
            // against the velocity in the middle of the kick, so that a node that reverses in every step is damped too
            let local = match kick.local > 0.0 {
                true => kick.local * total.abs() * sign(before[axis] + 0.5 * total / mass * time),
                false => 0.0,
            };
            let free =
                ((mass - 0.5 * damper * time) * before[axis] + (total - local) * time) / (mass + 0.5 * damper * time);
            after[axis] = if held[axis] { self.driven(node)[axis] } else { free };
            if kick.watched {
                let now = before[axis] + (after[axis] - before[axis]) * kick.last / (kick.dt + kick.last);
                let (was, comes) = (0.5 * kick.last * before[axis], 0.5 * kick.dt * after[axis]);
                let mut enter = |sum: fn(&mut Tally) -> &mut super::energy::Halves, force: f64| {
                    let halves = sum(tally);
                    halves.before += force * was;
                    halves.after += force * comes;
                };
                enter(|t| &mut t.gravity, weight);
                enter(|t| &mut t.external, external[axis] + borne[axis]);
                if held[axis] {
                    enter(|t| &mut t.driven, mass * (after[axis] - before[axis]) / time - load);
                } else {
                    enter(|t| &mut t.damping, local - viscous[axis]);
                    enter(|t| &mut t.quiet, 0.5 * damper * (before[axis] + after[axis]));
                }
                tally.kinetic += 0.5 * mass * now * now;
            }
        }
        after
    }
}

/// 0 at 0, unlike `signum`.
#[inline(always)]
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}
