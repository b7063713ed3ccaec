//! Distribution of forces over contacts.
//!
//! Normal forces are divided by their mean: strong forces (above the mean) carry the load, weak forces stabilise the
//! strong contacts (Radjai et al. 1998, Phys. Rev. Lett. 80, 61-64). The tail of the distribution falls as `exp(-β f)`.

use serde::{Deserialize, Serialize};

/// Width of a bin, as a share of the mean force.
const BIN: f64 = 0.25;
/// Number of bins, limited so that one large force does not create thousands.
const BINS: usize = 80;
/// A contact counts as sliding if at most this share of its friction is left: forces are in single precision.
const SLIDES: f64 = 1e-4;

/// A contact in compression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPush {
    /// N.
    pub normal: f64,
    /// N.
    pub shear: f64,
    /// Coefficient of friction.
    pub friction: f64,
}

/// Forces in the contacts of a bed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ForceSpread {
    pub contacts: usize,
    /// Normal force, N.
    #[serde(rename = "mean_N")]
    pub mean: f64,
    /// Largest normal force over the mean.
    pub largest: f64,
    /// Share of contacts with more than the mean.
    pub above: f64,
    /// Share of the total normal force carried by these contacts.
    pub carried: f64,
    /// β of the tail `exp(-β f/mean)` above the mean, by maximum likelihood: one divided by the mean excess. 1 if all
    /// forces are exponential. `None` with fewer than two forces above the mean.
    pub decay: Option<f64>,
    /// Mean of shear force divided by the friction limit; `None` without friction.
    pub mobilised: Option<f64>,
    /// Share of contacts at the friction limit; `None` without friction.
    pub sliding: Option<f64>,
    /// Force divided by the mean at the middle of each bin, and density there; forces beyond the last bin are cut off.
    pub density: Vec<[f64; 2]>,
}

impl ForceSpread {
    /// Distribution of the forces of contacts in compression; other contacts are left out.
    pub fn from_pushes(pushes: impl IntoIterator<Item = ContactPush>) -> ForceSpread {
        let pushes: Vec<ContactPush> = pushes.into_iter().filter(|push| push.normal > 0.0).collect();
        if pushes.is_empty() {
            return ForceSpread::default();
        }
        let count = pushes.len() as f64;
        let mean = pushes.iter().map(|push| push.normal).sum::<f64>() / count;
        let forces: Vec<f64> = pushes.iter().map(|push| push.normal / mean).collect();
        let strong: Vec<f64> = forces.iter().copied().filter(|force| *force > 1.0).collect();
        let excess = strong.iter().map(|force| force - 1.0).sum::<f64>() / strong.len().max(1) as f64;
        let rubbing: Vec<f64> =
            pushes.iter().filter(|p| p.friction > 0.0).map(|p| p.shear / (p.friction * p.normal)).collect();
        let of_rubbing = |sum: f64| (!rubbing.is_empty()).then(|| sum / rubbing.len() as f64);
        ForceSpread {
            contacts: pushes.len(),
            mean,
            largest: forces.iter().copied().fold(0.0, f64::max),
            above: strong.len() as f64 / count,
            carried: strong.iter().sum::<f64>() / count,
            decay: (strong.len() > 1 && excess > 0.0).then(|| 1.0 / excess),
            mobilised: of_rubbing(rubbing.iter().map(|share| share.min(1.0)).sum()),
            sliding: of_rubbing(rubbing.iter().filter(|share| **share >= 1.0 - SLIDES).count() as f64),
            density: density(&forces),
        }
    }
}

fn density(forces: &[f64]) -> Vec<[f64; 2]> {
    let largest = forces.iter().copied().fold(0.0, f64::max);
    let mut counts = vec![0.0; ((largest / BIN) as usize + 1).min(BINS)];
    for force in forces {
        if let Some(count) = counts.get_mut((force / BIN) as usize) {
            *count += 1.0;
        }
    }
    let middle = |bin: usize| (bin as f64 + 0.5) * BIN;
    counts.iter().enumerate().map(|(bin, count)| [middle(bin), count / (BIN * forces.len() as f64)]).collect()
}
