//! What lies under the sleepers: layers of granular material and of soil.

use super::{Given, Grading, Varying};
use crate::solvers::granular::grains::{self, Angular, ClumpShape, Rule};
use crate::solvers::granular::packing::Restored;
use crate::solvers::granular::shape::Mesh;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A layer of a section; the first of several lies under the sleepers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Name of its material.
    pub name: String,
    pub material: Material,
    /// m.
    pub thickness: Varying,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Material {
    Granular(Box<Granular>),
    Soil(Soil),
}

/// Ballast or sub-ballast: grains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Granular {
    /// Grading of what is modelled: `scale` times the real one.
    pub grading: Grading,
    /// Size of modelled over real grains.
    pub scale: Given,
    /// Density of a grain, kg/m^3.
    pub density: Given,
    pub shape: Shape,
    pub contact: Contact,
    /// Tangential stiffness of a contact / normal stiffness.
    pub shear_ratio: Given,
    /// Between grains, under traffic.
    pub friction: Given,
    /// To walls and sleepers.
    pub wall_friction: Given,
    /// Share of the force out of balance that opposes motion, under traffic.
    pub local_damping: Given,
    /// Normal dashpot of a contact, as share of its critical damping, under traffic.
    pub viscous_damping: Given,
    /// The same of its shear dashpot.
    pub shear_damping: Given,
    /// Whether a dashpot may pull grains that part.
    pub dashpots_pull: bool,
    pub packing: Packing,
    pub bond: Option<Bond>,
    /// Young's modulus of the layer as a continuum, Pa; grains do not read it.
    pub youngs_modulus: Option<Varying>,
    /// Poisson's ratio of the layer as a continuum.
    pub poisson_ratio: Given,
    /// At which the layer spreads a load, rad against the vertical.
    pub spread: Given,
}

impl Granular {
    /// The same as fewer and larger grains. The stiffness of a layer goes as that of its contacts over the size of its grains, and
    /// its strength as that of its bonds over their area, so they grow with the size and with its square.
    pub fn coarsened(self) -> Granular {
        let scale = *self.scale;
        let times = |given: Given, factor: f64| Given { value: *given * factor, ..given };
        let bond = self.bond.map(|bond| Bond {
            stiffness: times(bond.stiffness, scale),
            tensile_strength: times(bond.tensile_strength, scale * scale),
            shear_strength: times(bond.shear_strength, scale * scale),
        });
        let contact = match self.contact {
            Contact::Linear { stiffness } => Contact::Linear { stiffness: times(stiffness, scale) },
            // grows with the size by itself
            hertz @ Contact::Hertz { .. } => hertz,
        };
        Granular { grading: self.grading.scaled(scale), contact, bond, ..self }
    }
}

/// The shape of grains. A grain has the volume of the sphere of its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    Spheres,
    /// Overlapping spheres that move as one.
    Clumps {
        /// Fewest and most spheres of a clump.
        pebbles: [u32; 2],
        /// Smallest sphere / largest sphere of a clump.
        ratio: Given,
        /// Overlap of spheres that smooths the surface, rad.
        distance: Given,
        surfaces: Surfaces,
    },
}

/// Surfaces that the spheres of clumps fill: grains are copies of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Surfaces {
    /// Angular ones, made from the scene's seed.
    Angular {
        templates: u32,
        /// Shortest / intermediate and intermediate / longest side of the smallest box.
        flatness: Given,
        elongation: Given,
        /// Radius of edges / radius of the largest inscribed ball.
        roundness: Given,
    },
    /// Scans, and surfaces of the library.
    Meshes(Vec<Surface>),
}

/// A closed surface of a size that means nothing: its grains have those of their grading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Name in its file, or in the library.
    pub name: String,
    pub mesh: Arc<Mesh>,
}

impl Shape {
    /// The clumps that grains are copies of; `None` for spheres.
    pub fn clumps(&self) -> Option<ClumpShape> {
        let Shape::Clumps { pebbles, ratio, distance, surfaces } = self else { return None };
        let surfaces = match surfaces {
            Surfaces::Angular { templates, flatness, elongation, roundness } => grains::Surfaces::Angular {
                indices: Angular { flatness: **flatness, elongation: **elongation, roundness: **roundness },
                count: *templates as usize,
            },
            Surfaces::Meshes(surfaces) => grains::Surfaces::Meshes(surfaces.iter().map(|s| s.mesh.clone()).collect()),
        };
        let rule = Rule { pebbles: pebbles.map(|n| n as usize), ratio: **ratio, distance: **distance };
        Some(ClumpShape { surfaces, rule })
    }
}

/// The normal force of two grains that touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Contact {
    Linear {
        /// Stiffness of a contact, N/m.
        stiffness: Given,
    },
    Hertz {
        /// Pa.
        youngs_modulus: Given,
        poisson_ratio: Given,
    },
}

/// How a granular layer is packed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Packing {
    pub lifts: u32,
    /// On each lift, Pa.
    pub pressure: Given,
    /// Friction while grains are packed; see [`Granular`].
    pub friction: Given,
    pub local_damping: Given,
    pub viscous_damping: Given,
    /// When friction and damping come back.
    pub restored: Restored,
    /// Times that the plate presses the finished bed again.
    pub reloads: u32,
}

/// Glue between grains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bond {
    /// Stiffness of a contact, N/m.
    pub stiffness: Given,
    /// N.
    pub tensile_strength: Given,
    /// N.
    pub shear_strength: Given,
}

/// A continuous layer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Soil {
    /// Pa.
    pub youngs_modulus: Varying,
    pub poisson_ratio: Given,
    /// kg/m^3.
    pub density: Given,
    /// At which the layer spreads a load, rad against the vertical.
    pub spread: Given,
    pub strength: Strength,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Strength {
    /// It does not yield.
    Elastic,
    MohrCoulomb {
        /// Pa.
        cohesion: Given,
        /// rad.
        friction_angle: Given,
        /// rad, not above the friction angle.
        dilation: Given,
        /// Pa.
        tension: Given,
    },
}

impl Layer {
    pub fn granular(&self) -> Option<&Granular> {
        if let Material::Granular(granular) = &self.material { Some(granular) } else { None }
    }

    pub fn soil(&self) -> Option<&Soil> {
        if let Material::Soil(soil) = &self.material { Some(soil) } else { None }
    }

    /// Young's modulus as a continuum, Pa; `None` where grains are known by their contacts alone.
    pub fn youngs_modulus(&self) -> Option<&Varying> {
        match &self.material {
            Material::Granular(granular) => granular.youngs_modulus.as_ref(),
            Material::Soil(soil) => Some(&soil.youngs_modulus),
        }
    }
}
