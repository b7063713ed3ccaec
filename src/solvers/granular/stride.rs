//! The time step of a test on a bed: the stable step of all but a few grains. The few grains that need a shorter step
//! (light, long, or with many contacts with dashpots) get additional inertia, but no additional weight. The total
//! additional inertia is limited by choice.

use super::bed::Bed;
use super::failure::Failure;
use super::lanes::Real;
use super::law::ContactLaw;
use super::motion::WallMotion;
use super::walls::WallId;

/// Share of the stable step that is taken.
const SAFE: f64 = 0.8;
/// The same share for a sleeper on all its contacts.
const SLEEPER: f64 = 0.2;
/// Number of steps after which the present contacts are checked again.
const LOOK: u64 = 200;
/// Width of the search range of the step, as a factor.
const WIDEST: f64 = 64.0;

/// How the stiffness of a contact is shared between its bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sharing {
    /// Each contact counts twice for both bodies. Rigs use this; their published results were computed with it.
    Even,
    /// By the need of each body: longer steps for the same mass.
    ByNeed,
}

impl Sharing {
    /// Share of sqrt(m / k) of a body that allows for future contacts.
    fn prior(self) -> f64 {
        match self {
            Sharing::Even => 0.25,
            Sharing::ByNeed => 0.3,
        }
    }

    /// Number of halvings of the search range of the step: to 7 % and to 1 %.
    fn halvings(self) -> usize {
        match self {
            Sharing::Even => 6,
            Sharing::ByNeed => 9,
        }
    }
}

/// A time step that is kept for a bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride {
    /// \[s\]
    pub step: f64,
    pub sharing: Sharing,
}

impl Stride {
    /// The longest step for which the inertia added is at most `share` of the mass of all bodies.
    pub fn with_added<R: Real>(bed: &mut Bed<R>, sharing: Sharing, share: f64) -> Result<Stride, Failure> {
        bed.unscale_masses();
        // free grains without contacts set no limit: then any step will do at the start
        let own = Some(bed.bound_time_step(0.0)?).filter(|step| step.is_finite()).unwrap_or(bed.time_step());
        let (mut fine, mut factor) = (1.0, WIDEST.sqrt());
        for _ in 0..sharing.halvings() {
            let step = own * fine * factor;
            if (Stride { step, sharing }).hold(bed)? <= share {
                fine *= factor;
            }
            factor = factor.sqrt();
        }
        bed.unscale_masses();
        Ok(Stride { step: own * fine, sharing })
    }

    /// Prepares a bed for some steps, and returns the share of mass added.
    pub fn hold<R: Real>(&self, bed: &mut Bed<R>) -> Result<f64, Failure> {
        let stiffness = stiffness(bed);
        let least = |surface: u16, mass: f64| self.least_inertia(stiffness[usize::from(surface)], mass);
        let scaling = match self.sharing {
            Sharing::Even => bed.hold_time_step(self.step, |body| least(body.surface, body.mass))?,
            Sharing::ByNeed => bed.hold_time_step_by_need(self.step, least)?,
        };
        Ok(scaling.added_share)
    }

    /// Least inertia of a grain / its mass (kg), for contacts of a stiffness (N/m) that may come.
    pub fn least_inertia(&self, stiffness: f64, mass: f64) -> f64 {
        let root = self.sharing.prior() / (SAFE * self.step);
        stiffness / (root * root * mass)
    }

    /// Runs for a time, s, and returns the number of steps.
    pub(super) fn run<R: Real>(&self, bed: &mut Bed<R>, sleepers: &[WallId], time: f64) -> Result<u64, Failure> {
        let (mut left, mut steps) = (time, 0);
        loop {
            self.hold(bed)?;
            let count = (left / self.longest(bed, sleepers)).ceil().max(1.0);
            let step = left / count;
            let part = (count as u64).min(LOOK);
            bed.set_time_step(step);
            bed.run(part)?;
            steps += part;
            if part == count as u64 {
                return Ok(steps);
            }
            left -= step * part as f64;
        }
    }

    /// Runs some steps.
    pub(super) fn run_steps<R: Real>(&self, bed: &mut Bed<R>, sleepers: &[WallId], steps: u64) -> Result<(), Failure> {
        self.hold(bed)?;
        bed.set_time_step(self.longest(bed, sleepers));
        bed.run(steps)
    }

    /// Longest step that is also stable for sleepers on their present contacts, s.
    fn longest<R: Real>(&self, bed: &Bed<R>, sleepers: &[WallId]) -> f64 {
        let of = |wall: &WallId| {
            let wall = bed.wall(*wall);
            match wall.motion() {
                WallMotion::Loaded { mass, .. } if wall.felt().stiffness > 0.0 => (mass / wall.felt().stiffness).sqrt(),
                _ => f64::INFINITY,
            }
        };
        let of_sleepers = sleepers.iter().map(of).fold(f64::INFINITY, f64::min);
        (SAFE * self.step).min(SLEEPER * of_sleepers)
    }
}

/// Stiffness of a contact between bodies of each surface, N/m.
fn stiffness<R: Real>(bed: &Bed<R>) -> Vec<f64> {
    let of = |surface: u16| match bed.laws().get(surface, surface) {
        ContactLaw::Linear(law) => law.normal_stiffness.max(law.shear_stiffness),
        // beds of a scene have linear contacts; other beds are limited by their present contacts alone
        ContactLaw::HertzMindlin(_) => 0.0,
    };
    (0..bed.laws().surfaces() as u16).map(of).collect()
}
