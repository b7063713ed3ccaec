//! Layers under the sleepers: granular materials and soils.

use super::{Given, Grading, Varying};
use crate::solvers::granular::grains::{self, Angular, ClumpShape, Rule};
use crate::solvers::granular::packing::Restored;
use crate::solvers::granular::shape::Mesh;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A layer of a section; the first layer lies under the sleepers.
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
    /// Grading of the modelled grains: `scale` times the real sizes.
    pub grading: Grading,
    /// Size of modelled grains / size of real grains.
    pub scale: Given,
    /// Density of a grain, kg/m^3.
    pub density: Given,
    pub shape: Shape,
    pub contact: Contact,
    /// Tangential stiffness of a contact / normal stiffness.
    pub shear_ratio: Given,
    /// Friction between grains, under traffic.
    pub friction: Given,
    /// Friction on walls and sleepers.
    pub wall_friction: Given,
    /// Local damping: share of the unbalanced force that opposes the motion, under traffic.
    pub local_damping: Given,
    /// Normal damping of a contact / critical damping, under traffic.
    pub viscous_damping: Given,
    /// Shear damping of a contact / critical damping, under traffic.
    pub shear_damping: Given,
    /// Whether a dashpot may pull on grains that separate.
    pub dashpots_pull: bool,
    pub packing: Packing,
    pub bond: Option<Bond>,
    /// Young's modulus of the layer as a continuum, Pa; not used by grains.
    pub youngs_modulus: Option<Varying>,
    /// Poisson's ratio of the layer as a continuum.
    pub poisson_ratio: Given,
    /// Angle from the vertical at which the layer spreads a load, rad.
    pub spread: Given,
}

impl Granular {
    /// The same material with fewer and larger grains. The stiffness of a layer is proportional to the contact
    /// stiffness / grain size, and its strength to the bond strength / grain area. So contact stiffness grows with the
    /// size, and bond strength with its square.
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
            // Hertz stiffness grows with the size without a change
            hertz @ Contact::Hertz { .. } => hertz,
        };
        Granular { grading: self.grading.scaled(scale), contact, bond, ..self }
    }
}

/// The shape of grains. A grain has the volume of a sphere with the diameter of its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    Spheres,
    /// Overlapping spheres that move as one rigid body.
    Clumps {
        /// Smallest and largest number of spheres in a clump.
        pebbles: [u32; 2],
        /// Smallest sphere / largest sphere of a clump.
        ratio: Given,
        /// Overlap of spheres, which determines the smoothness of the surface, rad.
        distance: Given,
        surfaces: Surfaces,
    },
}

/// Surfaces that are filled with the spheres of clumps; grains are copies of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Surfaces {
    /// Angular shapes, made from the seed of the scene.
    Angular {
        templates: u32,
        /// Shortest / intermediate and intermediate / longest side of the smallest box.
        flatness: Given,
        elongation: Given,
        /// Radius of edges / radius of the largest inscribed sphere.
        roundness: Given,
    },
    /// Scans, and surfaces of the library.
    Meshes(Vec<Surface>),
}

/// A closed surface. Its size has no meaning, because the grains have the sizes of their grading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Name in its file, or in the library.
    pub name: String,
    pub mesh: Arc<Mesh>,
}

impl Shape {
    /// The clump shapes of the grains; `None` for spheres.
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

/// The law of the normal force between two grains.
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

/// The packing recipe of a granular layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Packing {
    pub lifts: u32,
    /// Pressure on each lift, Pa.
    pub pressure: Given,
    /// Friction during packing; see [`Granular`].
    pub friction: Given,
    pub local_damping: Given,
    pub viscous_damping: Given,
    /// When friction and damping return to the values for traffic.
    pub restored: Restored,
    /// Number of times that the plate presses the finished bed again.
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
    /// Angle from the vertical at which the layer spreads a load, rad.
    pub spread: Given,
    pub strength: Strength,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Strength {
    /// The soil does not yield.
    Elastic,
    MohrCoulomb {
        /// Pa.
        cohesion: Given,
        /// rad.
        friction_angle: Given,
        /// Angle of dilation, rad, not above the friction angle.
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

    /// Young's modulus as a continuum, Pa; `None` for grains without a modulus.
    pub fn youngs_modulus(&self) -> Option<&Varying> {
        match &self.material {
            Material::Granular(granular) => granular.youngs_modulus.as_ref(),
            Material::Soil(soil) => Some(&soil.youngs_modulus),
        }
    }
}
