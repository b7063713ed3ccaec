//! Selective mass scaling: more inertia, and no more weight, for bodies too light for the time step wanted.
//!
//! A body counts as too light by its own contacts, those with other bodies counted s times. s = 2 is always enough (see
//! `critical`), s = 1 hardly ever; the least s at which the whole network is stable is found by halving, for the sake of as
//! little added mass as this rule can do with.
//!
//! Gravity pulls, and dashpots by ratio refer to, the real mass: forces at rest are those without scaling, and dashpots keep
//! their coefficients, so that a scaled body rebounds as if its damping ratio were smaller by the root of its factor.

use super::bed::{Bed, BodyState};
use super::body::{BodyId, SPHERE};
use super::critical::{Around, Network, Weight, pencil};
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

    /// Adds inertia until `target` \[s\] is a stable step for the contacts of now, each body by its own with those between
    /// bodies counted twice: more than [`Bed::scale_masses`] adds, at a fraction of its cost. A body has `least` times its
    /// mass at least, whatever touches it: contacts that form later find it prepared. What was added before is taken off.
    pub fn hold_time_step(&mut self, target: f64, least: impl Fn(&BodyState) -> f64) -> Result<Scaling, Failure> {
        assert!(target.is_finite() && target > 0.0, "a time step is a positive time");
        self.unscale_masses();
        let links = self.links(0.0)?;
        let roots = self.roots();
        let around = Around::new(&links, roots.len());
        let needed = |body: usize| {
            let pencil = pencil(body, &roots[body], around.pick(body, &links), Weight::Even(2.0));
            if pencil.allows(target) { 1.0 } else { pencil.inertia_factor(target * (1.0 + TOLERANCE)) }
        };
        let needed: Vec<f64> = (0..roots.len()).into_par_iter().with_min_len(CHUNK).map(needed).collect();
        let factors: Vec<f64> = self.states().zip(needed).map(|(state, needed)| needed.max(least(&state))).collect();
        Ok(self.weigh_down(&factors, target, target))
    }

    fn weigh_down(&mut self, factors: &[f64], target: f64, limit: f64) -> Scaling {
        let mut scaling = Scaling { target, limit, bodies: 0, added_mass: 0.0, added_share: 0.0, largest: None };
        let mut moving = 0.0;
        for (id, &factor) in factors.iter().enumerate() {
            let place = self.index[id] as usize;
            let body = &self.bodies[place];
            moving += if body.inverse_mass > 0.0 { body.mass } else { 0.0 };
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
