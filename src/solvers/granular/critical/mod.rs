//! The longest stable time step (methods 1.4).
//!
//! The leapfrog, with dashpots that depend on the velocity of half a step before, is for unchanged contacts
//!
//! ```text
//! M (x[n+1] - 2 x[n] + x[n-1]) / dt^2 + C (x[n] - x[n-1]) / dt + K x[n] = 0.
//! ```
//!
//! Put x[n] = z^n u: with a = u'Ku and b = u'Cu for u'Mu = 1, z^2 + (a dt^2 + b dt - 2) z + 1 - b dt = 0, and both
//! roots stay in the unit circle exactly if a dt^2 + 2 b dt < 4. So a step is stable if 4 M - dt^2 K - 2 dt C is
//! positive definite, and at the limit a mode reverses its motion in every step (z = -1). For one oscillator of
//! frequency w and damping ratio xi this is dt < (2/w) (sqrt(1 + xi^2) - xi).
//!
//! Local damping increases a force by its share while the force brakes a body; in that mode it always brakes. So the
//! limit is the limit for inertia reduced by the factor 1 + alpha: (2/w) / sqrt(1 + alpha) for one oscillator.
//!
//! K and C are the matrices of the present contacts: springs and dashpots at full stiffness even if they slip, lever
//! arms of clumps, inertia including mass scaling, walls and fixed bodies at rest. The rotation of forces with their
//! contacts is left out; its share is about overlap over radius.

mod limit;
mod links;
mod local;
mod network;
#[cfg(test)]
pub(super) mod tests;

pub(super) use links::{Link, Roots, reduced};
pub(super) use local::{Around, Weight, bound, pencil, surely_allows};
pub(super) use network::Network;

use super::bed::Bed;
use super::body::BodyId;
use super::failure::Failure;
use super::force::Tangent;
use super::lanes::{BLOCK, Real};
use super::record::Record;

/// The origin of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitSeat {
    pub body: BodyId,
    /// \[m\]
    pub place: [f64; 3],
    pub surface: u16,
    /// Number of contacts of the body that count.
    pub contacts: usize,
}

/// A largest stable time step, and the body that sets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// \[s\]; infinite if nothing touches.
    pub step: f64,
    pub seat: Option<LimitSeat>,
}

/// The longest stable time step, by three rules.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalStep {
    /// PFC's rule without its safety factor of 0.8: the smallest sqrt(m / k) over bodies and axes, with the stiffness
    /// divided by (sqrt(1 + beta^2) - beta)^2. It is neither a bound nor exact: half of the stable step for a single
    /// body without dashpots, too long for some beds with dashpots.
    pub estimate: Limit,
    /// The limit by the contacts of one body at a time, coupled with its rotation and weighted with its neighbours.
    /// Never too long.
    pub bound: Limit,
    /// The limit by the whole network of contacts; too short by at most [`CriticalStep::residual`].
    pub network: Limit,
    /// Relative uncertainty of the network limit, already subtracted.
    pub residual: f64,
    /// Number of contacts that count.
    pub contacts: usize,
    /// Cost of the network limit, in sweeps over all contacts.
    pub sweeps: usize,
}

/// Relative uncertainty to which the network limit is iterated.
const TOLERANCE: f64 = 2e-3;

impl<R: Real> Bed<R> {
    /// The longest stable step with the present contacts. Contacts of pairs up to `gap` \[m\] apart count too, so that
    /// a step is chosen before they close.
    ///
    /// Hertz springs count with the stiffness of their present overlap. The motion afterwards is unchanged, bit by bit.
    /// Fails only if neighbour lists cannot be made.
    pub fn critical_step(&mut self, gap: f64) -> Result<CriticalStep, Failure> {
        let links = self.links(gap)?;
        let roots = self.roots();
        let around = Around::new(&links, roots.len());
        let estimate = local::estimate(&links, &roots, &around);
        let bound = local::bound(&links, &roots, &around);
        let network = Network::new(&links, &roots).limit(&around, bound.0, TOLERANCE);
        let limit = |(step, body): (f64, Option<u32>)| Limit { step, seat: body.map(|b| self.seat(b, &around)) };
        Ok(CriticalStep {
            // local damping is no part of PFC's rule
            estimate: limit((estimate.0 * (1.0 + self.damping).sqrt(), estimate.1)),
            bound: limit(bound),
            network: limit((network.step, network.body)),
            residual: network.residual,
            contacts: links.len(),
            sweeps: network.sweeps,
        })
    }

    /// [`CriticalStep::bound`] alone \[s\], which costs little.
    pub fn bound_time_step(&mut self, gap: f64) -> Result<f64, Failure> {
        let links = self.links(gap)?;
        let roots = self.roots();
        Ok(local::bound(&links, &roots, &Around::new(&links, roots.len())).0)
    }

    fn seat(&self, body: u32, around: &Around) -> LimitSeat {
        let state = self.body_state(BodyId(body));
        let contacts = around.links_of(body as usize).len();
        LimitSeat { body: state.id, place: state.place, surface: state.surface, contacts }
    }

    /// A stable time step by the contacts of the last step, body by body, at low cost \[s\]; infinite without contacts.
    ///
    /// Shorter than [`CriticalStep::bound`]: each contact counts with its stiffer direction.
    pub fn body_time_step(&self) -> f64 {
        let mut sums = vec![[0.0; 2]; self.bodies.len()];
        let mut count = |pebble: u32, tangent: &Tangent, shared: f64| {
            let place = self.owner[pebble as usize];
            let (normal, shear) = self.mobility(place, pebble);
            let stiffest = |n: f64, s: f64| shared * (n * normal).max(s * shear);
            let sum = &mut sums[place as usize];
            sum[0] += stiffest(tangent.normal, tangent.shear);
            sum[1] += stiffest(tangent.normal_dashpot, tangent.shear_dashpot);
        };
        for place in 0..self.contacts.len() {
            let Some(overlap) = self.overlap(place) else { continue };
            let (a, b) = (self.contacts.first[place], self.contacts.second[place]);
            let (one, other) = (&self.records[a as usize], &self.records[b as usize]);
            let law = &self.laws.all()[usize::from(self.contacts.law[place / BLOCK])];
            let mass = links::reduced(one.mass().to_f64(), other.mass().to_f64());
            let tangent = Tangent::from_law(law, overlap, mass, links::reduced(one.radius(), other.radius()));
            count(a, &tangent, 2.0);
            count(b, &tangent, 2.0);
        }
        for entry in &self.wall_contacts.entries {
            let record = &self.records[entry.pebble as usize];
            let law = &self.laws.all()[usize::from(entry.law)];
            for slot in self.wall_contacts.slots(entry).iter().filter(|s| s.touches()) {
                count(
                    entry.pebble,
                    &Tangent::from_law(law, slot.overlap, record.mass().to_f64(), record.radius()),
                    1.0,
                );
            }
        }
        let braked = 1.0 + self.damping;
        sums.iter().map(|&[a, b]| limit::step(braked * a, braked * b)).fold(f64::INFINITY, f64::min)
    }

    /// Largest displacement per unit force on the surface of a pebble, along and across \[1/kg\].
    fn mobility(&self, place: u32, pebble: u32) -> (f64, f64) {
        let body = &self.bodies[place as usize];
        let radius = self.records[pebble as usize].radius();
        if body.clump == super::body::SPHERE {
            return (body.inverse_mass, body.inverse_mass + radius * radius * body.inverse_inertia);
        }
        let clump = &self.clumps[body.clump as usize];
        let [x, y, z, _] = self.arms[clump.arms as usize + (pebble - body.first) as usize];
        let arm = radius + super::vector::norm([x, y, z]);
        let most = body.inverse_mass + arm * arm * clump.inverse_inertia.into_iter().fold(0.0, f64::max);
        (most, most)
    }
}
