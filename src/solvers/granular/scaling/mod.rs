//! Selective mass scaling: more inertia, and no more weight, for bodies too light for the time step wanted.
//!
//! A body counts as too light by its own contacts, those with other bodies counted s times. s = 2 is always enough (see
//! `critical`), s = 1 hardly ever; the least s at which the whole network is stable is found by halving, for the sake of as
//! little added mass as this rule can do with.
//!
//! Gravity pulls, and dashpots by ratio refer to, the real mass: forces at rest are those without scaling, and dashpots keep
//! their coefficients, so that a scaled body rebounds as if its damping ratio were smaller by the root of its factor.

mod need;

use super::bed::{Bed, BodyState};
use super::body::{BodyId, SPHERE};
use super::critical::{Around, Link, Network, Roots, Weight, pencil, surely_allows};
use super::failure::Failure;
use super::lanes::Real;
use super::record::Record;
use super::vector::scale;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Halvings of the share that contacts between bodies count with.
const HALVINGS: usize = 6;
/// Relative tolerance of the network's limit.
const TOLERANCE: f64 = 2e-3;

/// Bodies that one task works on. Fixed, so that threads change nothing.
const CHUNK: usize = 512;

/// How often contacts between bodies count where the longest step is sought.
const WEIGHTS: [f64; 2] = [1.0, 1.5];
/// Halvings of the range in which the step is sought, and its width as a factor.
const HALVINGS_OF_STEP: usize = 9;
const WIDEST: f64 = 16.0;

/// A bed's contacts, and what they hold.
struct Held<'a> {
    links: &'a [Link],
    roots: &'a [Roots],
    around: &'a Around,
}

impl Held<'_> {
    /// Factors of inertia by which each body bears a step \[s\], its contacts with others counted `weight` times.
    fn factors(&self, step: f64, weight: f64) -> Vec<f64> {
        // a little more, so that the network's limit is not missed by its tolerance
        let step = step * (1.0 + TOLERANCE);
        let of = |body: usize| {
            let pencil = pencil(body, &self.roots[body], self.around.pick(body, self.links), Weight::Even(weight));
            if pencil.allows(step) { 1.0 } else { pencil.inertia_factor(step).max(1.0) }
        };
        (0..self.roots.len()).into_par_iter().with_min_len(CHUNK).map(of).collect()
    }

    /// Factors for the longest step from `shortest` \[s\] on for which they add no more than a share of these masses.
    fn longest(&self, weight: f64, shortest: f64, masses: &[f64], share: f64) -> Vec<f64> {
        let most = share * masses.iter().sum::<f64>();
        let (mut low, mut high) = (shortest, shortest * WIDEST);
        let mut best = vec![1.0; masses.len()];
        for _ in 0..HALVINGS_OF_STEP {
            let mid = (low * high).sqrt();
            let factors = self.factors(mid, weight);
            if masses.iter().zip(&factors).map(|(mass, factor)| mass * (factor - 1.0)).sum::<f64>() <= most {
                (low, best) = (mid, factors);
            } else {
                high = mid;
            }
        }
        best
    }

    /// What the network bears with these factors \[s\].
    fn limit(&self, factors: &[f64]) -> f64 {
        let scaled: Vec<_> = self.roots.iter().zip(factors).map(|(r, f)| r.heavier(*f)).collect();
        let bound = super::critical::bound(self.links, &scaled, self.around).0;
        Network::new(self.links, &scaled).limit(self.around, bound, TOLERANCE).step
    }
}

/// What mass scaling did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scaling {
    /// The step that was wanted, and the largest stable one now \[s\].
    pub target: f64,
    pub limit: f64,
    /// Bodies with added inertia.
    pub bodies: usize,
    /// Inertial mass added \[kg\], and its share of the mass of all bodies that move.
    pub added_mass: f64,
    pub added_share: f64,
    /// Largest inertia over the real one, and whose.
    pub largest: Option<(BodyId, f64)>,
}

impl<R: Real> Bed<R> {
    /// Adds inertia to bodies until `target` \[s\] is a stable step for the contacts of now and of pairs up to `gap` \[m\] apart.
    /// What was added before is taken off first.
    ///
    /// Contacts that form later may need more: choose a gap that covers what will happen, or scale again from time to time.
    pub fn scale_masses(&mut self, target: f64, gap: f64) -> Result<Scaling, Failure> {
        assert!(target.is_finite() && target > 0.0, "a time step is a positive time");
        self.unscale_masses();
        let links = self.links(gap)?;
        let roots = self.roots();
        let around = Around::new(&links, roots.len());
        let factors = |share: f64| -> Vec<f64> {
            // a little more, so that the network's limit is not missed by its tolerance
            let step = target * (1.0 + TOLERANCE);
            let of = |body| {
                pencil(body, &roots[body], around.pick(body, &links), Weight::Even(share)).inertia_factor(step).max(1.0)
            };
            (0..roots.len()).map(of).collect()
        };
        let limit = |factors: &[f64]| {
            let scaled: Vec<_> = roots.iter().zip(factors).map(|(r, f)| r.heavier(*f)).collect();
            let bound = super::critical::bound(&links, &scaled, &around).0;
            if bound >= target { bound } else { Network::new(&links, &scaled).limit(&around, bound, TOLERANCE).step }
        };
        let (mut low, mut high) = (0.5, 2.0);
        let most = factors(high);
        let mut best = (limit(&most).max(target), most);
        for _ in 0..HALVINGS {
            let mid = 0.5 * (low + high);
            let trial = factors(mid);
            let stable = limit(&trial);
            if stable >= target {
                (high, best) = (mid, (stable, trial));
            } else {
                low = mid;
            }
        }
        Ok(self.weigh_down(&best.1, target, best.0))
    }

    /// Adds inertia so that steps may be as long as can be while no more than `share` of the mass is added, and tells what the whole network
    /// bears then: [`Scaling::limit`]. Contacts of pairs up to `gap` \[m\] apart count. What was added before is taken off first.
    ///
    /// Inertia goes where a body alone needs it for some step, the longest for which the share suffices. How often contacts between bodies
    /// count in this is tried out, by asking the network: the bed of a track takes some ten seconds. Bodies that nothing touches bear any
    /// step: then the limit is infinite, and nothing is added.
    ///
    /// # Panics
    /// If `share` is below 0.
    pub fn hold_longest_step(&mut self, share: f64, gap: f64) -> Result<Scaling, Failure> {
        assert!(share >= 0.0, "a share of the mass is 0 or more");
        self.unscale_masses();
        let links = self.links(gap)?;
        let roots = self.roots();
        let around = Around::new(&links, roots.len());
        let held = Held { links: &links, roots: &roots, around: &around };
        let bound = super::critical::bound(&links, &roots, &around).0;
        if !bound.is_finite() {
            return Ok(self.weigh_down(&[], bound, bound));
        }
        let masses: Vec<f64> =
            self.states().map(|state| if self.is_held(state.id) { 0.0 } else { state.mass }).collect();
        let mut best = (held.limit(&vec![1.0; roots.len()]), vec![1.0; roots.len()]);
        for weight in WEIGHTS {
            let factors = held.longest(weight, bound, &masses, share);
            let limit = held.limit(&factors);
            if limit > best.0 {
                best = (limit, factors);
            }
        }
        Ok(self.weigh_down(&best.1, best.0, best.0))
    }

    fn is_held(&self, id: BodyId) -> bool {
        self.bodies[self.index[id.0 as usize] as usize].inverse_mass == 0.0
    }

    /// Adds inertia until `target` \[s\] is a stable step for the contacts of now, each body by its own with those between
    /// bodies counted twice: more than [`Bed::scale_masses`] adds, at a fraction of its cost. A body has `least` times its
    /// mass at least, whatever touches it: contacts that form later find it prepared. What was added before is taken off.
    pub fn hold_time_step(
        &mut self,
        target: f64,
        least: impl Fn(&BodyState) -> f64 + Sync,
    ) -> Result<Scaling, Failure> {
        assert!(target.is_finite() && target > 0.0, "a time step is a positive time");
        self.unscale_masses();
        self.reach(0.0)?;
        let needed = |body: usize| {
            let place = self.index[body];
            let (links, root) = (self.own_links(place), self.root(&self.bodies[place as usize]));
            if surely_allows(body, &root, &links, Weight::Even(2.0), target) {
                return 1.0;
            }
            let pencil = pencil(body, &root, &links, Weight::Even(2.0));
            if pencil.allows(target) { 1.0 } else { pencil.inertia_factor(target * (1.0 + TOLERANCE)) }
        };
        let factor = |body: usize| needed(body).max(least(&self.body_state(BodyId(body as u32))));
        let bodies = (0..self.bodies.len()).into_par_iter().with_min_len(CHUNK);
        let factors: Vec<f64> = bodies.map(factor).collect();
        Ok(self.weigh_down(&factors, target, target))
    }

    fn weigh_down(&mut self, factors: &[f64], target: f64, limit: f64) -> Scaling {
        let mut scaling = Scaling { target, limit, bodies: 0, added_mass: 0.0, added_share: 0.0, largest: None };
        let mut moving = 0.0;
        for (id, &factor) in factors.iter().enumerate() {
            let place = self.index[id] as usize;
            let body = &self.bodies[place];
            // what is fixed bears any step
            if body.inverse_mass == 0.0 {
                continue;
            }
            moving += body.mass;
            if factor <= 1.0 {
                continue;
            }
            scaling.bodies += 1;
            scaling.added_mass += body.mass * (factor - 1.0);
            if scaling.largest.is_none_or(|(_, most)| factor > most) {
                scaling.largest = Some((BodyId(body.id), factor));
            }
            self.multiply_inertia(place, factor);
        }
        scaling.added_share = if moving > 0.0 { scaling.added_mass / moving } else { 0.0 };
        scaling
    }

    /// Takes off what mass scaling added. Velocities stay as they are; the inertia of a clump comes back to rounding.
    pub fn unscale_masses(&mut self) {
        for place in 0..self.bodies.len() {
            let factor = self.inertia_factor(place);
            if factor == 1.0 {
                continue;
            }
            self.multiply_inertia(place, 1.0 / factor);
            let body = &mut self.bodies[place];
            body.inverse_mass = 1.0 / body.mass;
            if body.clump == SPHERE && body.inverse_inertia > 0.0 {
                let radius = self.records[body.first as usize].radius();
                body.inverse_inertia = 1.0 / (0.4 * body.mass * radius * radius);
            }
        }
    }

    /// Inertial over real mass; 1 for a body that is fixed.
    fn inertia_factor(&self, place: usize) -> f64 {
        let body = &self.bodies[place];
        let real = 1.0 / body.mass;
        if body.inverse_mass == 0.0 || body.inverse_mass == real { 1.0 } else { real / body.inverse_mass }
    }

    fn multiply_inertia(&mut self, place: usize, factor: f64) {
        let body = &mut self.bodies[place];
        body.inverse_mass /= factor;
        body.inverse_inertia /= factor;
        if body.clump != SPHERE {
            // it keeps its turning, so its angular momentum changes
            body.spin = scale(body.spin, factor);
            let clump = &mut self.clumps[body.clump as usize];
            clump.inverse_inertia = scale(clump.inverse_inertia, 1.0 / factor);
        }
    }
}

#[cfg(test)]
mod tests;
