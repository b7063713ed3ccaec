//! The material of an element.

use super::error::SoilError;
use serde::{Deserialize, Serialize};

/// An isotropic elastic material, with a strength if it can yield.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// \[kg/m³\]
    pub density: f64,
    /// \[Pa\]
    pub youngs_modulus: f64,
    /// From above -1 to below 0.5.
    pub poisson_ratio: f64,
    /// With `None` it stays elastic under any load.
    pub strength: Option<Strength>,
}

/// Mohr-Coulomb strength with a tension cut-off, perfectly plastic.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Strength {
    /// \[Pa\]
    pub cohesion: f64,
    /// \[rad\]
    pub friction_angle: f64,
    /// \[rad\]; equal to the friction angle for associated flow, 0 for flow at constant volume.
    pub dilation_angle: f64,
    /// Largest tension \[Pa\]. Friction limits it too, to `cohesion / tan(friction_angle)`; without friction it may be
    /// infinite.
    pub tension: f64,
}

impl Material {
    /// Lamé's constants λ and μ \[Pa\].
    pub fn lame(&self) -> (f64, f64) {
        let Material { youngs_modulus: e, poisson_ratio: nu, .. } = *self;
        (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)))
    }

    /// Modulus of compression without lateral strain \[Pa\].
    pub fn constrained_modulus(&self) -> f64 {
        let (lambda, mu) = self.lame();
        lambda + 2.0 * mu
    }

    /// Speeds of compression and shear waves \[m/s\].
    pub fn wave_speeds(&self) -> [f64; 2] {
        [(self.constrained_modulus() / self.density).sqrt(), (self.lame().1 / self.density).sqrt()]
    }

    pub(super) fn check(&self, number: usize) -> Result<(), SoilError> {
        let want = |fine: bool, what: &'static str, value: f64, expected: &'static str| {
            if fine { Ok(()) } else { Err(SoilError::Material { number, what, value, expected }) }
        };
        let positive = |what, value: f64| want(value > 0.0 && value.is_finite(), what, value, "a number above 0");
        positive("the density", self.density)?;
        positive("Young's modulus", self.youngs_modulus)?;
        let nu = self.poisson_ratio;
        want(nu > -1.0 && nu < 0.5, "Poisson's ratio", nu, "above -1 and below 0.5")?;
        let Some(strength) = self.strength else { return Ok(()) };
        let Strength { cohesion, friction_angle, dilation_angle, tension } = strength;
        want(cohesion >= 0.0 && cohesion.is_finite(), "the cohesion", cohesion, "a number from 0")?;
        let angle = 0.0..std::f64::consts::FRAC_PI_2;
        want(angle.contains(&friction_angle), "the friction angle", friction_angle, "from 0 to below pi/2 rad")?;
        let dilates = (0.0..=friction_angle).contains(&dilation_angle);
        want(dilates, "the dilation angle", dilation_angle, "from 0 to the friction angle, rad")?;
        want(tension >= 0.0, "the tension limit", tension, "a number from 0")?;
        let some = cohesion > 0.0 || friction_angle > 0.0;
        want(some, "the cohesion", cohesion, "above 0 if there is no friction")
    }
}
