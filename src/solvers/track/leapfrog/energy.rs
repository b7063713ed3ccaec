//! The energy balance of a track: stored energy, work of the forces, and losses.

use super::Leapfrog;
use super::under::Under;
use serde::{Deserialize, Serialize};

/// Energy of the track half a step before the present time, and work since the account began, J.
///
/// `stored() = begin + pushes + supports + wheels - dissipated` to rounding, while the step length and the level stay
/// the same. Energy stored in elastic supports of ordinary sleepers counts as work done by the supports. A start from
/// rest has half a kick: an account that begins there has an error of the square of the first acceleration times the
/// step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyAccount {
    pub kinetic: f64,
    /// In rails, slabs, pads and the continuations of the rail.
    pub strain: f64,
    /// Energy of gravity and of the level of the continuations of the rail, relative to the track as built.
    pub potential: f64,
    /// Stored energy when the account began.
    pub begin: f64,
    /// Work on the track: by pushes and turns on carried feet, by supports of ordinary sleepers, by wheels.
    pub pushes: f64,
    pub supports: f64,
    pub wheels: f64,
    /// By pads, slabs, ends and drag.
    pub dissipated: f64,
}

impl EnergyAccount {
    /// Kinetic, elastic and potential energy, J.
    pub fn stored(&self) -> f64 {
        self.kinetic + self.strain + self.potential
    }

    /// Energy that the account does not explain, J.
    pub fn residual(&self) -> f64 {
        self.stored() - (self.begin + self.pushes + self.supports + self.wheels - self.dissipated)
    }
}

impl Leapfrog {
    /// Begins an energy account at the last half step.
    pub fn watch(&mut self) {
        let empty = EnergyAccount::default();
        let begin = self.stored(empty).stored();
        self.state.account = Some(EnergyAccount { begin, ..empty });
    }

    /// The energy account at the last half step; none if no account was begun.
    pub fn energy(&self) -> Option<EnergyAccount> {
        self.state.account.map(|account| self.stored(account))
    }

    fn stored(&self, account: EnergyAccount) -> EnergyAccount {
        let (v, half) = (&self.state.velocity, 0.5 * self.state.last_step);
        let middle: Vec<f64> = self.state.displacement.iter().zip(v).map(|(u, v)| u - half * v).collect();
        let pulled: f64 = self.pulls.iter().map(|(end, i, pull)| pull * self.state.level.ends[*end] * middle[*i]).sum();
        EnergyAccount {
            kinetic: 0.5 * self.mass.quadratic_form(v),
            strain: 0.5 * self.stiffness.quadratic_form(&middle),
            potential: -self.track.weight.iter().zip(&middle).map(|(f, u)| f * u).sum::<f64>() - pulled,
            ..account
        }
    }

    /// Adds the work of the last step: forces times `½ (Δt_- v_- + Δt_+ v_+)`, the displacement between the half steps.
    pub(super) fn keep_account(&mut self) {
        let Some(mut account) = self.state.account else { return };
        let (track, state) = (&*self.track, &self.state);
        let (kick, next) = (state.last_kick, self.time_step);
        let last = 2.0 * kick - next;
        let (v, a) = (&state.velocity, &state.acceleration);
        let way = |i: usize| 0.5 * (last * (v[i] - kick * a[i]) + next * v[i]);
        for (carried, push) in track.carried.iter().zip(&state.pushes) {
            account.pushes -= push * way(carried.underside);
        }
        for (carried, turn) in track.carried.iter().zip(&state.turns) {
            account.pushes += carried.pitch.map_or(0.0, |pitch| turn * way(pitch));
        }
        for (sleeper, support) in track.sleepers.iter().zip(&state.supports) {
            account.supports -= support * way(sleeper.unknown);
        }
        for (x, force) in &state.on_rail {
            account.wheels +=
                force * Under::wheel_at(track, &self.beyond, &state.level, state.ride.ground, *x).moved(way);
        }
        for ((mean, v), a) in self.mean_velocity.iter_mut().zip(v).zip(a) {
            *mean = v - 0.5 * kick * a;
        }
        account.dissipated += kick * self.damping.quadratic_form(&self.mean_velocity);
        self.state.account = Some(account);
    }
}
