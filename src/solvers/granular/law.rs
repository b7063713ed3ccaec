//! Contact laws: normal and shear forces between two surfaces.
//!
//! Conventions are the conventions of PFC's linear model (springs with parallel dashpots, no moment, shear by
//! increments in the rotating contact plane) and of Hertz and Mindlin without partial slip.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The law of one pair of surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum ContactLaw {
    Linear(Linear),
    HertzMindlin(HertzMindlin),
}

/// Linear springs, Coulomb friction and dashpots in parallel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Linear {
    /// Stiffness of the contact, not of a body \[N/m\]; see [`in_series`].
    pub normal_stiffness: f64,
    /// \[N/m\]
    pub shear_stiffness: f64,
    /// Coefficient of friction.
    pub friction: f64,
    pub dashpot: Dashpot,
    pub mode: DashpotMode,
    pub limit: FrictionLimit,
}

/// Hertz's normal and Mindlin's no-slip shear stiffness, with Tsuji's dashpots.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HertzMindlin {
    /// `1 / E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2` \[Pa\].
    pub effective_modulus: f64,
    /// `1 / G* = (2 - nu1) / G1 + (2 - nu2) / G2` \[Pa\].
    pub effective_shear_modulus: f64,
    pub friction: f64,
    /// Normal coefficient of restitution in (0, 1].
    pub restitution: f64,
    /// Whether the shear dashpot acts.
    pub shear_dashpot: bool,
    pub mode: DashpotMode,
    pub limit: FrictionLimit,
}

/// Dashpots in normal and shear direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Dashpot {
    /// Share of critical damping: `c = 2 beta sqrt(m k)` with `m = m1 m2 / (m1 + m2)`, `m1` against a wall.
    Ratio { normal: f64, shear: f64 },
    /// \[N s/m\]
    Constant { normal: f64, shear: f64 },
}

/// Limits of dashpots; PFC's `dp_mode` 0 to 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DashpotMode {
    /// Dashpots always act, and may pull.
    Full,
    /// The total normal force does not pull.
    NoTension,
    /// The shear dashpot does not act while the contact slips.
    RestInSlip,
    /// Both `NoTension` and `RestInSlip`: the mode for ballast.
    #[default]
    NoTensionRestInSlip,
}

impl DashpotMode {
    pub fn pulls(self) -> bool {
        matches!(self, DashpotMode::Full | DashpotMode::RestInSlip)
    }

    pub fn rests_in_slip(self) -> bool {
        matches!(self, DashpotMode::RestInSlip | DashpotMode::NoTensionRestInSlip)
    }
}

/// The normal force that limits friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FrictionLimit {
    /// The force of the spring, as in PFC and YADE.
    #[default]
    Spring,
    /// The magnitude of spring and dashpot forces together, as in LIGGGHTS and LAMMPS.
    Total,
}

/// Springs of two bodies in series: the stiffness of their contact (PFC's inheritance).
pub fn in_series(first: f64, second: f64) -> f64 {
    // a body of zero stiffness gives zero
    if first == 0.0 || second == 0.0 { 0.0 } else { first * second / (first + second) }
}

impl HertzMindlin {
    /// The law between two elastic solids given by Young's modulus \[Pa\] and Poisson's ratio; `f64::INFINITY` is
    /// rigid.
    pub fn between(first: (f64, f64), second: (f64, f64), friction: f64, restitution: f64) -> HertzMindlin {
        let normal = |(young, poisson): (f64, f64)| (1.0 - poisson * poisson) / young;
        let shear = |(young, poisson): (f64, f64)| 2.0 * (2.0 - poisson) * (1.0 + poisson) / young;
        HertzMindlin {
            effective_modulus: 1.0 / (normal(first) + normal(second)),
            effective_shear_modulus: 1.0 / (shear(first) + shear(second)),
            friction,
            restitution,
            shear_dashpot: false,
            mode: DashpotMode::Full,
            limit: FrictionLimit::Spring,
        }
    }

    /// Share of critical damping that gives the restitution, at any speed.
    ///
    /// With Tsuji's dashpot and y = d^(5/4) instead of the overlap d, the speed as a function of y is the speed of a
    /// linear oscillator of the same ratio z, and y + 2 z v = 0 when the sum of spring and dashpot force becomes zero
    /// (Antypov and Elliott 2011, EPL 94, 50004). So the linear closed forms hold. To the end of the overlap
    /// `e = exp(-pi z / sqrt(1 - z^2))`; to the end of the push, if dashpots do not pull,
    /// `e = exp(-2 z acos(z) / sqrt(1 - z^2))` (Schwager and Pöschel 2007, Granular Matter 9, 465-469, written shorter;
    /// z may be above 1 there).
    pub fn damping_ratio(&self) -> f64 {
        let lost = -self.restitution.ln();
        let pulling = lost / std::f64::consts::PI.hypot(lost);
        if self.mode.pulls() { pulling } else { ratio_without_tension(lost, pulling) }
    }
}

/// Solves `2 z acos(z) / sqrt(1 - z^2) = lost` for z. The left side is increasing and concave, so Newton's steps from
/// `below` never go beyond the root.
fn ratio_without_tension(lost: f64, below: f64) -> f64 {
    let mut z = below;
    for _ in 0..60 {
        let (x, square) = (1.0 - z, 1.0 - z * z);
        // acos(z) / sqrt(1 - z^2) and its slope; near z = 1 the first terms of the series
        let (angle, slope) = if x.abs() < 1e-4 {
            (1.0 + x / 3.0 + 2.0 * x * x / 15.0, -1.0 / 3.0 - 4.0 * x / 15.0)
        } else {
            let angle = if z < 1.0 { z.acos() / square.sqrt() } else { z.acosh() / (-square).sqrt() };
            (angle, (z * angle - 1.0) / square)
        };
        let step = (lost - 2.0 * z * angle) / (2.0 * (angle + z * slope));
        z += step;
        if step.abs() <= 1e-15 * z {
            break;
        }
    }
    z
}

/// Material properties of the bodies of one surface; the law of a pair follows from two surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Stiffness of the body; two bodies in series make a contact \[N/m\].
    pub normal_stiffness: f64,
    /// \[N/m\]
    pub shear_stiffness: f64,
    /// Coefficient of friction; the smaller of two applies.
    pub friction: f64,
    /// Share of critical damping, normal and shear; the smaller of two applies.
    pub damping: [f64; 2],
    pub mode: DashpotMode,
}

impl Surface {
    /// The linear law between two surfaces: stiffness in series, the smaller friction and damping.
    pub fn meet(&self, other: &Surface) -> ContactLaw {
        ContactLaw::Linear(Linear {
            normal_stiffness: in_series(self.normal_stiffness, other.normal_stiffness),
            shear_stiffness: in_series(self.shear_stiffness, other.shear_stiffness),
            friction: self.friction.min(other.friction),
            dashpot: Dashpot::Ratio {
                normal: self.damping[0].min(other.damping[0]),
                shear: self.damping[1].min(other.damping[1]),
            },
            mode: self.mode,
            limit: FrictionLimit::Spring,
        })
    }
}

/// A number of a law out of its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawError {
    pub quantity: &'static str,
    pub value: f64,
    pub expected: &'static str,
}

impl fmt::Display for LawError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} is {}, expected {}", self.quantity, self.value, self.expected)
    }
}

impl std::error::Error for LawError {}

impl ContactLaw {
    /// Every number out of its range, in the order of the fields.
    pub fn faults(&self) -> Vec<LawError> {
        const POSITIVE: &str = "a number above 0";
        const NOT_NEGATIVE: &str = "a number from 0";
        let mut faults = Vec::new();
        let mut want = |quantity, value: f64, fine: bool, expected| {
            if !(value.is_finite() && fine) {
                faults.push(LawError { quantity, value, expected });
            }
        };
        match self {
            ContactLaw::Linear(law) => {
                want("normal stiffness", law.normal_stiffness, law.normal_stiffness > 0.0, POSITIVE);
                want("shear stiffness", law.shear_stiffness, law.shear_stiffness >= 0.0, NOT_NEGATIVE);
                want("friction", law.friction, law.friction >= 0.0, NOT_NEGATIVE);
                let (Dashpot::Ratio { normal, shear } | Dashpot::Constant { normal, shear }) = law.dashpot;
                want("normal dashpot", normal, normal >= 0.0, NOT_NEGATIVE);
                want("shear dashpot", shear, shear >= 0.0, NOT_NEGATIVE);
            }
            ContactLaw::HertzMindlin(law) => {
                want("effective modulus", law.effective_modulus, law.effective_modulus > 0.0, POSITIVE);
                want(
                    "effective shear modulus",
                    law.effective_shear_modulus,
                    law.effective_shear_modulus > 0.0,
                    POSITIVE,
                );
                want("friction", law.friction, law.friction >= 0.0, NOT_NEGATIVE);
                let restitution = law.restitution;
                want("restitution", restitution, restitution > 0.0 && restitution <= 1.0, "a number above 0, up to 1");
            }
        }
        faults
    }
}

/// The law of every pair of surfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactLaws {
    surfaces: usize,
    /// Row by row, `surfaces` squared, symmetric.
    pairs: Vec<ContactLaw>,
}

impl ContactLaws {
    /// One law for all contacts; surface 0 is the only surface.
    pub fn single(law: ContactLaw) -> ContactLaws {
        ContactLaws { surfaces: 1, pairs: vec![law] }
    }

    /// Laws of all pairs, by inheritance.
    pub fn from_surfaces(surfaces: &[Surface]) -> ContactLaws {
        let pairs = surfaces.iter().flat_map(|a| surfaces.iter().map(|b| a.meet(b))).collect();
        ContactLaws { surfaces: surfaces.len(), pairs }
    }

    /// The same law for all pairs of `surfaces` surfaces; [`ContactLaws::set`] changes some.
    pub fn uniform(surfaces: usize, law: ContactLaw) -> ContactLaws {
        ContactLaws { surfaces, pairs: vec![law; surfaces * surfaces] }
    }

    /// Number of surfaces.
    pub fn surfaces(&self) -> usize {
        self.surfaces
    }

    pub fn set(&mut self, first: u16, second: u16, law: ContactLaw) {
        for (a, b) in [(first, second), (second, first)] {
            self.pairs[usize::from(a) * self.surfaces + usize::from(b)] = law;
        }
    }

    pub fn get(&self, first: u16, second: u16) -> &ContactLaw {
        &self.pairs[self.class(first, second) as usize]
    }

    /// Changes every law in place, for example friction or the dashpots of packing.
    pub fn change(&mut self, change: impl FnMut(&mut ContactLaw)) {
        self.pairs.iter_mut().for_each(change);
    }

    /// Number of a pair in [`ContactLaws::all`], the same for both orders.
    pub(super) fn class(&self, first: u16, second: u16) -> u16 {
        let (a, b) = (first.min(second) as usize, first.max(second) as usize);
        (a * self.surfaces + b) as u16
    }

    pub(super) fn all(&self) -> &[ContactLaw] {
        &self.pairs
    }
}
