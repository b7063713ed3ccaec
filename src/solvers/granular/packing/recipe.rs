//! The parts of a bed and the method of packing, and the laws, walls and first time step that follow from them.

use super::super::bed::Bed;
use super::super::clump::Template;
use super::super::domain::Domain;
use super::super::grains::Curve;
use super::super::gravity::Gravity;
use super::super::lanes::Real;
use super::super::law::{ContactLaw, ContactLaws, Surface};
use super::super::walls::WallId;
use serde::{Deserialize, Serialize};

/// The recipe of a bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Sides of the cell along x and across, m.
    pub plan: [f64; 2],
    /// Whether walls are at both ends across; otherwise the bed is periodic across.
    pub walls: bool,
    /// Whether walls are also at both ends along.
    pub ends: bool,
    /// From the floor upwards.
    pub layers: Vec<GrainLayer>,
    /// Gravity, downwards, m/s2.
    pub gravity: f64,
    /// Local damping of the finished bed.
    pub local_damping: f64,
    #[serde(default, skip_serializing_if = "Restored::is_usual")]
    pub restored: Restored,
    /// Number of times that the plate presses the finished bed again.
    #[serde(default, skip_serializing_if = "is_none")]
    pub reloads: u32,
    pub rest: Rest,
    pub seed: u64,
}

/// A layer of one material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GrainLayer {
    pub name: String,
    pub curve: Curve,
    /// Clumps of unit size; grains are copies of them, of each equally often.
    pub templates: Vec<Template>,
    /// Density of a grain, kg/m3.
    pub density: f64,
    /// Surface of the grains in the finished bed.
    pub surface: Surface,
    /// Friction with walls, floor and plate.
    pub wall_friction: f64,
    /// m.
    pub thickness: f64,
    pub lifts: u32,
    /// Pressure on each lift, Pa.
    pub pressure: f64,
    /// Parameters while the layer is packed.
    pub packing: Packing,
}

/// Friction and damping of a layer while it is packed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Packing {
    pub friction: f64,
    pub local_damping: f64,
    /// Share of critical damping of contacts, in the normal direction.
    pub viscous_damping: f64,
}

/// The time at which the grains get the friction and the damping of the finished bed. The paper does not specify it
/// (Ahmadi et al. 2026, sections 2.1.2 and 2.1.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Restored {
    /// Under the full pressure of the plate.
    Pressed,
    /// Under the plate after its pressure is reduced to half of the weight of the bed.
    #[default]
    Eased,
    /// After the plate is removed and the bed is at rest without friction.
    Unloaded,
}

impl Restored {
    fn is_usual(&self) -> bool {
        *self == Restored::default()
    }
}

fn is_none(times: &u32) -> bool {
    *times == 0
}

/// Limits at which a stage ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rest {
    /// Limit of the force out of balance divided by the acting forces, mean over all bodies, for a lift under its
    /// plate.
    pub lift: f64,
    /// The same limit for the finished bed.
    pub bed: f64,
    /// Relative tolerance of the pressure of the plate.
    pub pressure: f64,
    /// Longest time of a stage, s. At a pressure p below 200 kPa it is longer by the factor sqrt(200 kPa / p).
    pub longest: f64,
}

impl Default for Rest {
    fn default() -> Self {
        Rest { lift: 0.01, bed: 1e-3, pressure: 0.02, longest: 4.0 }
    }
}

/// Number of lifts of a layer of this thickness (m), at most `asked`. No lift is thinner than the largest grain,
/// because this grain alone would carry the plate.
pub fn lifts_that_fit(asked: u32, thickness: f64, curve: &Curve) -> u32 {
    let most = (thickness / curve.ends()[1] + 1e-9).floor().max(1.0);
    asked.min(most as u32)
}

impl GrainLayer {
    /// Number of lifts in which it is pressed, at most the number in the recipe.
    pub fn lifts_that_fit(&self) -> u32 {
        lifts_that_fit(self.lifts, self.thickness, &self.curve)
    }
}

impl Recipe {
    /// The same recipe with a sphere instead of the clumps of every layer.
    pub fn with_spheres(self) -> Recipe {
        let sphere: Vec<Template> = Template::sphere(0.5).into_iter().collect();
        let layers = self.layers.into_iter().map(|layer| GrainLayer { templates: sphere.clone(), ..layer });
        Recipe { layers: layers.collect(), ..self }
    }

    /// Laws of the finished bed: surface `i` is layer `i`; the last surface is walls, floor and plate, as stiff as the
    /// grains.
    pub fn laws(&self) -> ContactLaws {
        self.between(|layer| (layer.surface, layer.wall_friction))
    }

    /// The same laws without dashpots; forces at rest do not depend on them.
    pub(super) fn laws_without_dashpots(&self) -> ContactLaws {
        self.between(|layer| (Surface { damping: [0.0; 2], ..layer.surface }, layer.wall_friction))
    }

    /// Laws during packing.
    fn packing_laws(&self) -> ContactLaws {
        self.between(|layer| {
            let Packing { friction, viscous_damping, .. } = layer.packing;
            // without friction shear springs have no effect, and longer steps are stable
            let shear_stiffness = if friction > 0.0 { layer.surface.shear_stiffness } else { 0.0 };
            let surface = Surface { friction, shear_stiffness, damping: [viscous_damping, 0.0], ..layer.surface };
            (surface, friction.min(layer.wall_friction))
        })
    }

    fn between(&self, of: impl Fn(&GrainLayer) -> (Surface, f64)) -> ContactLaws {
        let surfaces: Vec<(Surface, f64)> = self.layers.iter().map(of).collect();
        let mut all: Vec<Surface> = surfaces.iter().map(|(surface, _)| *surface).collect();
        all.extend(all.last().copied());
        let mut laws = ContactLaws::from_surfaces(&all);
        for (number, (surface, friction)) in surfaces.iter().enumerate() {
            let mut law = surface.meet(surface);
            if let ContactLaw::Linear(law) = &mut law {
                law.friction = *friction;
            }
            laws.set(number as u16, self.wall_surface(), law);
        }
        laws
    }

    /// Stiffness of contacts between grains of each layer, N/m: two bodies in series.
    pub(super) fn stiffness(&self) -> Vec<f64> {
        self.layers.iter().map(|layer| 0.5 * layer.surface.normal_stiffness).collect()
    }

    /// The smallest sqrt(m / k) of a mean grain of any layer, s.
    pub(super) fn mean_step(&self) -> f64 {
        let of = |(layer, k): (&GrainLayer, f64)| (layer.density * layer.curve.mean_volume() / k).sqrt();
        self.layers.iter().zip(self.stiffness()).map(of).fold(f64::INFINITY, f64::min)
    }

    /// The surface of walls, floor and plate.
    pub fn wall_surface(&self) -> u16 {
        self.layers.len() as u16
    }

    /// Area of flat surfaces around a layer of this height (m) per volume, 1/m. Voids at the plate on one layer are
    /// filled by the next layer.
    pub(super) fn flat(&self, layer: usize, height: f64) -> f64 {
        let pair = |present: bool, distance: f64| if present { 2.0 / distance } else { 0.0 };
        pair(layer == 0, height) + pair(self.walls, self.plan[1]) + pair(self.ends, self.plan[0])
    }

    /// An empty bed with this plan, with floor and walls, as used for packing.
    pub(super) fn ground<R: Real>(&self) -> Bed<R> {
        let [length, width] = self.plan;
        let domain = if self.ends { Domain::open() } else { Domain::open().periodic(0, length) };
        let domain = if self.walls { domain } else { domain.periodic(1, width) };
        let mut bed = Bed::new(domain, self.packing_laws());
        bed.set_gravity(Gravity::Constant([0.0, 0.0, -self.gravity]));
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], self.wall_surface());
        if self.walls {
            bed.add_plane([0.0; 3], [0.0, 1.0, 0.0], self.wall_surface());
            bed.add_plane([0.0, width, 0.0], [0.0, -1.0, 0.0], self.wall_surface());
        }
        if self.ends {
            bed.add_plane([0.0; 3], [1.0, 0.0, 0.0], self.wall_surface());
            bed.add_plane([length, 0.0, 0.0], [-1.0, 0.0, 0.0], self.wall_surface());
        }
        bed
    }

    /// The walls of a box, the lower and the upper one along and across. `None` for a periodic bed.
    pub fn sides(&self) -> Option<[[WallId; 2]; 2]> {
        // in the order of `ground`
        (self.walls && self.ends).then_some([[WallId(3), WallId(4)], [WallId(1), WallId(2)]])
    }

    pub fn floor(&self) -> WallId {
        WallId(0)
    }
}
