//! Estimate of the solid share of a layer of grains, before it is packed.

use super::recipe::GrainLayer;

/// Solid share of grains, fitted to layers of 2 to 10 grains: error 1.5 % without friction, 3 % with friction
/// (`docs/grains.md`).
struct Filling {
    /// Solid share far from flat surfaces, divided by the solid share of frictionless spheres of the same sizes.
    far: f64,
    /// Reduction of the solid share by flat surfaces, in units of the size of the mean grain.
    flat: f64,
    /// Reduction of the solid share by high friction, applied as `1 - exp(-friction / ROUGH)`.
    friction: f64,
}

const SPHERES: Filling = Filling { far: 1.0, flat: 0.133, friction: 0.132 };
const CLUMPS: Filling = Filling { far: 1.067, flat: 0.097, friction: 0.222 };
const ROUGH: f64 = 0.26;

impl GrainLayer {
    /// Estimated solid share; `flat` is the area of flat surfaces per volume, 1/m.
    pub(super) fn solid_share(&self, flat: f64) -> f64 {
        let spheres = self.templates.iter().all(|template| template.pebbles.len() == 1);
        let filling = if spheres { SPHERES } else { CLUMPS };
        let loosened = (1.0 - filling.flat * self.curve.surface_mean() * flat)
            * (1.0 + filling.friction * (-self.packing.friction / ROUGH).exp_m1());
        filling.far * self.curve.solid_share() * loosened
    }
}
