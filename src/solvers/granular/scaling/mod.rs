//! Selective mass scaling: additional inertia, but no additional weight, for bodies too light for the required time
//! step.
//!
//! A body counts as too light by its own contacts; contacts with other bodies are counted s times. s = 2 is always
//! sufficient (see `critical`), s = 1 hardly ever. The smallest s at which the whole network is stable is found by
//! bisection, so that the additional mass is as small as this rule allows.
//!
//! Gravity acts on the real mass, and damping ratios refer to it. So forces at rest are the forces without scaling.
//! Dashpots keep their coefficients, so a scaled body rebounds as with a damping ratio smaller by the root of its
//! factor.

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

/// Bisections of the weight of contacts between bodies.
const HALVINGS: usize = 6;
/// Relative tolerance of the network limit.
const TOLERANCE: f64 = 2e-3;

/// Bodies of one task. The number is fixed, so that the number of threads does not change the results.
const CHUNK: usize = 512;

/// Weights of contacts between bodies that are tried in the search for the longest step.
const WEIGHTS: [f64; 2] = [1.0, 1.5];
/// Bisections of the search range of the step, and its width as a factor.
const HALVINGS_OF_STEP: usize = 9;
const WIDEST: f64 = 16.0;

/// The contacts of a bed, and their springs.
struct Held<'a> {
    links: &'a [Link],
    roots: &'a [Roots],
    around: &'a Around,
}

impl Held<'_> {
    /// Factors of inertia that make a step \[s\] stable for each body; contacts with other bodies are counted `weight`
    /// times.
    fn factors(&self, step: f64, weight: f64) -> Vec<f64> {
        // slightly more, so that the tolerance of the network limit is covered
        let step = step * (1.0 + TOLERANCE);
        let of = |body: usize| {
            let pencil = pencil(body, &self.roots[body], self.around.pick(body, self.links), Weight::Even(weight));
            if pencil.allows(step) { 1.0 } else { pencil.inertia_factor(step).max(1.0) }
        };
        (0..self.roots.len()).into_par_iter().with_min_len(CHUNK).map(of).collect()
    }

    /// Factors for the longest step from `shortest` \[s\] for which the additional mass is at most a share of these
    /// masses.
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

    /// The limit of the network with these factors \[s\].
    fn limit(&self, factors: &[f64]) -> f64 {
        let scaled: Vec<_> = self.roots.iter().zip(factors).map(|(r, f)| r.heavier(*f)).collect();
        let bound = super::critical::bound(self.links, &scaled, self.around).0;
        Network::new(self.links, &scaled).limit(self.around, bound, TOLERANCE).step
    }
}

/// The result of mass scaling.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scaling {
    /// The required step, and the largest stable step now \[s\].
    pub target: f64,
    pub limit: f64,
    /// Bodies with added inertia.
    pub bodies: usize,
    /// Inertial mass added \[kg\], and its share of the mass of all bodies that move.
    pub added_mass: f64,
    pub added_share: f64,
    /// The body with the largest ratio of inertia to real mass, and this ratio.
    pub largest: Option<(BodyId, f64)>,
}

impl<R: Real> Bed<R> {
    /// Adds inertia to bodies until `target` \[s\] is a stable step for the present contacts and for contacts of pairs
    /// up to `gap` \[m\] apart. Inertia added before is removed first.
    ///
    /// Contacts that form later may need more inertia: choose a gap that covers the future motion, or scale again from
    /// time to time.
    pub fn scale_masses(&mut self, target: f64, gap: f64) -> Result<Scaling, Failure> {
        assert!(target.is_finite() && target > 0.0, "a time step is a positive time");
        self.unscale_masses();
        let links = self.links(gap)?;
        let roots = self.roots();
        let around = Around::new(&links, roots.len());
        let factors = |share: f64| -> Vec<f64> {
            // slightly more, so that the tolerance of the network limit is covered
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

    /// Adds inertia for the longest possible step with at most `share` of the mass added, and returns the limit of the
    /// whole network: [`Scaling::limit`]. Contacts of pairs up to `gap` \[m\] apart count. Inertia added before is
    /// removed first.
    ///
    /// Each body gets the inertia that it needs alone for the longest step for which the share suffices. The weight of
    /// contacts between bodies is found by trial with the network limit: for the bed of a track this takes some ten
    /// seconds. For bodies without contacts any step is stable: then the limit is infinite, and nothing is added.
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

    /// Adds inertia until `target` \[s\] is a stable step for the present contacts, for each body by its own contacts,
    /// with contacts between bodies counted twice: more than [`Bed::scale_masses`] adds, at a fraction of the cost. A
    /// body has at least `least` times its mass, independent of its contacts, so that it is prepared for contacts that
    /// form later. Inertia added before is removed.
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
            // any step is stable for fixed bodies
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

    /// Removes the inertia added by mass scaling. Velocities do not change; the inertia of a clump is restored to
    /// rounding.
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

    /// Inertial mass divided by real mass; 1 for a fixed body.
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
            // it keeps its angular velocity, so its angular momentum changes
            body.spin = scale(body.spin, factor);
            let clump = &mut self.clumps[body.clump as usize];
            clump.inverse_inertia = scale(clump.inverse_inertia, 1.0 / factor);
        }
    }
}

#[cfg(test)]
mod tests;
