//! Checks at regular intervals for signs of a failing run.
//!
//! If the step is too long, a body and its neighbours reverse their motion in every step. The energy that they gain
//! between two checks may be lost when contacts open, so such a bed need not fly apart; the bodies vibrate. So at
//! regular intervals the bodies are compared over two consecutive steps. The body that reverses its motion with the
//! most energy is the suspect. The check of its contacts, and of the contacts of the bodies that it reaches in a step,
//! is cheap (a matrix of six motions, see `critical`). Only if they do not allow the step in several checks, the limit
//! of the whole network is computed. So only a step above the limit ends a run as growth.

pub(super) mod memory;
#[cfg(test)]
mod tests;

use super::bed::Bed;
use super::body::{Body, BodyId, SPHERE};
use super::critical::{Around, Network, Weight, bound, pencil};
use super::failure::{Culprit, Failure, Limits};
use super::lanes::Real;
use super::record::Record;
use super::vector::{Vec3, dot, norm};
use memory::Good;

/// Number of checks in a row with a suspect body before the network is checked, and before it is checked again.
const PATIENCE: u32 = 8;
/// Number of times that the network must be found unstable.
const TIMES: u32 = 2;
/// A network that was found stable is checked again if a body reverses its motion with this many times the energy.
const RISE: f64 = 16.0;
/// Number of checks between estimates of the stable step, after the first few.
const ESTIMATES: u64 = 16;
/// Relative tolerance of the network limit.
const TOLERANCE: f64 = 5e-3;

/// A body that reversed its motion in the last step.
#[derive(Debug, Clone, Copy)]
struct Suspect {
    place: u32,
    /// \[J\]
    energy: f64,
    /// Displacement of its surface in a step \[m\].
    stride: f64,
}

impl<R: Real> Bed<R> {
    /// Changes the limits that stop a run.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
        self.unchecked = true;
    }

    /// Checks the last step.
    pub(super) fn look(&mut self) -> Result<(), Failure> {
        if let Some(place) = self.tally.lost {
            return Err(Failure::Lost(self.culprit(place)));
        }
        let (square, place) = self.tally.fastest;
        let stride = square.sqrt() * self.dt;
        if stride > 0.0 {
            let share = stride / self.records[self.bodies[place as usize].first as usize].radius();
            if share > self.limits.stride {
                return Err(Failure::Stride { culprit: self.culprit(place), share });
            }
        }
        let every = self.limits.every.max(2);
        if self.steps.is_multiple_of(every) {
            let (share, pebble) = self.deepest();
            if share > self.limits.overlap {
                return Err(Failure::Overlap { culprit: self.culprit(self.owner[pebble as usize]), share });
            }
            if self.limits.growth {
                self.watch.before = self.bodies.iter().map(motion).collect();
                self.watch.lists = self.lists.count;
            }
        }
        if self.limits.growth && self.steps % every == 1 {
            self.look_for_growth()?;
        }
        let looks = self.steps / every;
        if self.steps == 1 || self.steps.is_multiple_of(every) && (looks < 3 || looks.is_multiple_of(ESTIMATES)) {
            self.remember_good();
        }
        Ok(())
    }

    /// Fails if a body reverses its motion in every step because the step is too long.
    fn look_for_growth(&mut self) -> Result<(), Failure> {
        if self.watch.lists != self.lists.count || self.watch.before.len() != self.bodies.len() {
            return Ok(());
        }
        if self.watch.cleared.1 != self.dt {
            self.watch.cleared = (0.0, self.dt);
        }
        let suspect = self.suspect().filter(|s| s.energy > self.watch.cleared.0 && !self.allows(s));
        let Some(suspect) = suspect else {
            self.watch.suspected = 0;
            return Ok(());
        };
        self.watch.suspected += 1;
        if !self.watch.suspected.is_multiple_of(PATIENCE) {
            return Ok(());
        }
        let id = BodyId(self.bodies[suspect.place as usize].id);
        let limit = self.limit_of_network(suspect.stride)?;
        if self.dt <= limit {
            self.watch.cleared.0 = RISE * suspect.energy;
            self.watch.suspected = 0;
        } else if self.watch.suspected >= TIMES * PATIENCE {
            let culprit = self.culprit(self.index[id.0 as usize]);
            return Err(Failure::Growth(Culprit { stable_dt: limit, ..culprit }));
        }
        Ok(())
    }

    /// The body that reversed its motion in the last step with the most energy.
    fn suspect(&self) -> Option<Suspect> {
        let mut most: Option<Suspect> = None;
        for (place, (body, before)) in self.bodies.iter().zip(&self.watch.before).enumerate() {
            let (now, before) = (motion(body).map(f64::from), before.map(f64::from));
            let part = |m: &[f64; 6], at: usize| -> Vec3 { [m[at], m[at + 1], m[at + 2]] };
            let moving = -dot(part(&now, 0), part(&before, 0));
            let turning = -dot(part(&now, 3), part(&before, 3));
            let inertia = |inverse: f64| if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
            let (per_spin, radius) = match body.clump {
                SPHERE => (inertia(body.inverse_inertia), self.records[body.first as usize].radius()),
                // angular momentum instead of spin
                clump => (self.clumps[clump as usize].inverse_inertia.into_iter().fold(0.0, f64::max), 0.0),
            };
            let energy = inertia(body.inverse_mass) * moving.max(0.0) + per_spin * turning.max(0.0);
            if energy > most.map_or(0.0, |m| m.energy) {
                let spin = if body.clump == SPHERE { norm(body.spin) * radius } else { 0.0 };
                most = Some(Suspect { place: place as u32, energy, stride: (norm(body.velocity) + spin) * self.dt });
            }
        }
        most
    }

    /// Whether the contacts of a body and of its neighbours allow the step, each body alone.
    fn allows(&self, suspect: &Suspect) -> bool {
        let gap = suspect.stride;
        let links = self.links_of(suspect.place, gap);
        let mut bodies: Vec<u32> = links.iter().flat_map(|l| l.ends().map(|(_, body)| body)).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies.iter().all(|&body| {
            let place = self.index[body as usize];
            let links = self.links_of(place, gap);
            pencil(body as usize, &self.root(&self.bodies[place as usize]), &links, Weight::Even(2.0)).allows(self.dt)
        })
    }

    /// Largest overlap divided by the smaller radius, and a pebble with it.
    pub(super) fn deepest(&self) -> (f64, u32) {
        let mut deepest = (0.0, 0);
        for place in 0..self.contacts.len() {
            let (a, b) = (self.contacts.first[place], self.contacts.second[place]);
            if let Some(overlap) = self.overlap(place) {
                let share = overlap / self.records[a as usize].radius().min(self.records[b as usize].radius());
                if share > deepest.0 {
                    deepest = (share, a);
                }
            }
        }
        for entry in &self.wall_contacts.entries {
            for slot in self.wall_contacts.slots(entry).iter().filter(|s| s.touches()) {
                let share = slot.overlap / self.records[entry.pebble as usize].radius();
                if share > deepest.0 {
                    deepest = (share, entry.pebble);
                }
            }
        }
        deepest
    }

    /// Overlap of a contact when its force was computed \[m\], to the precision of an arm; none without contact.
    pub(super) fn overlap(&self, place: usize) -> Option<f64> {
        let outcome = &self.contacts.outcomes[place];
        let radius = self.records[self.contacts.first[place] as usize].radius();
        let touches = outcome.0[..3].iter().any(|&force| force != R::default());
        touches.then_some(2.0 * (radius - outcome[6].to_f64()).max(0.0))
    }

    fn culprit(&self, place: u32) -> Culprit {
        let body = &self.bodies[place as usize];
        Culprit {
            body: BodyId(body.id),
            place: self.body_state(BodyId(body.id)).place,
            step: self.steps,
            time: self.time,
            dt: self.dt,
            // contacts of a failed run give a poor estimate; they are used only if there were none before
            stable_dt: self.stable_when_good().unwrap_or_else(|| self.body_time_step()),
        }
    }

    fn remember_good(&mut self) {
        let Good { cells, pebbles, clumps, gap } = &mut self.watch.good;
        cells.clear();
        pebbles.clear();
        clumps.clear();
        *gap = 2.0 * self.tally.fastest.0.sqrt() * self.dt;
        for &place in &self.index {
            let body = &self.bodies[place as usize];
            cells.push(body.cell);
            let range = body.first as usize..body.first as usize + usize::from(body.pebbles);
            pebbles.extend(self.records[range].iter().map(Record::position));
            if body.clump != SPHERE {
                let clump = &self.clumps[body.clump as usize];
                clumps.push((clump.centre, clump.attitude));
            }
        }
    }

    /// Limit of the network in the last stable state \[s\]; none without contacts then.
    fn stable_when_good(&self) -> Option<f64> {
        let good = &self.watch.good;
        if good.cells.len() != self.bodies.len() {
            return None;
        }
        let mut bed = self.clone();
        let (mut pebbles, mut clumps) = (good.pebbles.iter(), good.clumps.iter());
        for (&place, &cell) in self.index.iter().zip(&good.cells) {
            let body = &mut bed.bodies[place as usize];
            body.cell = cell;
            let range = body.first as usize..body.first as usize + usize::from(body.pebbles);
            bed.records[range].iter_mut().zip(&mut pebbles).for_each(|(record, place)| record.place(*place));
            if body.clump != SPHERE {
                let clump = &mut bed.clumps[body.clump as usize];
                (clump.centre, clump.attitude) = *clumps.next()?;
            }
        }
        bed.lists.outdated = true;
        bed.limit_of_network(good.gap).ok().filter(|limit| limit.is_finite())
    }

    /// Largest stable step for contacts of pairs up to `gap` \[m\] apart \[s\].
    fn limit_of_network(&mut self, gap: f64) -> Result<f64, Failure> {
        let links = self.links(gap)?;
        let roots = self.roots();
        let around = Around::new(&links, roots.len());
        let bound = bound(&links, &roots, &around).0;
        Ok(Network::new(&links, &roots).limit(&around, bound, TOLERANCE).step)
    }
}

fn motion(body: &Body) -> [f32; 6] {
    let ([a, b, c], [p, q, r]) = (body.velocity, body.spin);
    [a, b, c, p, q, r].map(|x| x as f32)
}
