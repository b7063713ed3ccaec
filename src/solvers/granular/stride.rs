//! The time step of a test on a bed: that of all but a few grains. The few that would need a shorter one (light, long, in many contacts with
//! dashpots) have some inertia added, and no weight; how much there may be of it in all is a choice.

use super::bed::Bed;
use super::failure::Failure;
use super::lanes::Real;
use super::law::ContactLaw;
use super::motion::WallMotion;
use super::walls::WallId;

/// Share of the stable step that is taken.
const SAFE: f64 = 0.8;
/// The same of a sleeper on all its contacts.
const SLEEPER: f64 = 0.2;
/// Steps after which the contacts of now are looked at again.
const LOOK: u64 = 200;
/// Width of the range in which the step is sought, as a factor.
const WIDEST: f64 = 64.0;

/// How the contacts of a step are shared between their bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sharing {
    /// Each counts twice for both. What rigs do: their figures were made so.
    Even,
    /// By what each body needs: longer steps for the same mass.
    ByNeed,
}

impl Sharing {
    /// Share of sqrt(m / k) that a body bears for contacts still to come.
    fn prior(self) -> f64 {
        match self {
            Sharing::Even => 0.25,
            Sharing::ByNeed => 0.3,
        }
    }

    /// Halvings of the range in which the step is sought: to 7 % and to 1 %.
    fn halvings(self) -> usize {
        match self {
            Sharing::Even => 6,
            Sharing::ByNeed => 9,
        }
    }
}

/// A step that a bed is held at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride {
    /// \[s\]
    pub step: f64,
    pub sharing: Sharing,
}

impl Stride {
    /// The longest for which no more than `share` of the mass of all bodies is added as inertia.
    pub fn with_added<R: Real>(bed: &mut Bed<R>, sharing: Sharing, share: f64) -> Result<Stride, Failure> {
        bed.unscale_masses();
        // free grains that touch nothing bound no step: then any will do to begin with
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

    /// Prepares a bed for some steps, and gives the share of mass that is added.
    pub fn hold<R: Real>(&self, bed: &mut Bed<R>) -> Result<f64, Failure> {
        let stiffness = stiffness(bed);
        let root = self.sharing.prior() / (SAFE * self.step);
        let least = |surface: u16, mass: f64| stiffness[usize::from(surface)] / (root * root * mass);
        let scaling = match self.sharing {
            Sharing::Even => bed.hold_time_step(self.step, |body| least(body.surface, body.mass))?,
            Sharing::ByNeed => bed.hold_time_step_by_need(self.step, least)?,
        };
        Ok(scaling.added_share)
    }

    /// Runs for a time, s, and gives the steps that it took.
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

    /// Longest step that sleepers bear on their contacts of now too, s.
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
        // beds of a scene have linear contacts; others are bounded by the contacts of now alone
        ContactLaw::HertzMindlin(_) => 0.0,
    };
    (0..bed.laws().surfaces() as u16).map(of).collect()
}
