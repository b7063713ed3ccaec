//! Nodes of grains: beds to pack, bodies on the beds, their loads, and the soil below.

use super::record::InVolume;
use crate::solvers::continuum::Strength;
use crate::solvers::granular::grains::{ClumpShape, TemplatesError};
use crate::solvers::granular::measure::Region;
use crate::solvers::granular::packing::{PackingError, Recipe};
use crate::solvers::granular::probe::Plate;
use crate::solvers::granular::rig::{Crib, Glued, Load, Rig, Sensor, Sleeper, Specimen};
use crate::solvers::track::{Pitch, UnderPad};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The bed of a section, before it is packed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedPlan {
    /// The name of the trackform.
    pub section: String,
    /// Complete recipe with spheres instead of the clumps of its layers, because clumps take a tenth of a second to
    /// make.
    blank: Recipe,
    /// Shapes of the grains of each layer, from the floor upwards; `None` for spheres.
    shapes: Vec<Option<ClumpShape>>,
    /// The plate that measures the stiffness of the bed: the footprint of half a sleeper, or of a whole sleeper in a
    /// bed of both rails.
    pub plate: Plate,
    /// Decisions and their reasons as sentences.
    pub notes: Vec<String>,
}

/// A bed that can be packed: a [`BedPlan`] with its clumps.
#[derive(Debug, Clone, PartialEq)]
pub struct BedRecipe {
    /// The name of the trackform.
    pub section: String,
    pub recipe: Recipe,
    pub plate: Plate,
    pub notes: Vec<String>,
}

/// Reason why a plan gives no recipe.
#[derive(Debug, Clone, PartialEq)]
pub enum BedError {
    /// Pebbles that give no clumps for the grains of a layer.
    Templates { layer: String, cause: TemplatesError },
    /// A recipe that cannot be packed.
    Recipe(PackingError),
}

impl fmt::Display for BedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BedError::Templates { layer, cause } => write!(f, "grains of `{layer}`: {cause}"),
            BedError::Recipe(cause) => cause.fmt(f),
        }
    }
}

impl std::error::Error for BedError {}

impl BedPlan {
    /// A plan from a recipe of spheres and the shapes of its grains, one shape for each layer.
    pub fn new(section: String, blank: Recipe, shapes: Vec<Option<ClumpShape>>, plate: Plate) -> BedPlan {
        BedPlan { section, blank, shapes, plate, notes: Vec::new() }
    }

    /// Whether another plan packs the same bed.
    pub fn packs_like(&self, other: &BedPlan) -> bool {
        self.blank == other.blank && self.shapes == other.shapes
    }

    /// The numbers of the recipe, with spheres instead of clumps.
    pub fn numbers(&self) -> &Recipe {
        &self.blank
    }

    /// The complete recipe for packing the bed with a seed.
    pub fn ready(&self, seed: u64) -> Result<BedRecipe, BedError> {
        let mut recipe = Recipe { seed, ..self.blank.clone() };
        for (layer, shape) in recipe.layers.iter_mut().zip(&self.shapes) {
            if let Some(shape) = shape {
                let templates = shape.templates(seed);
                layer.templates =
                    templates.map_err(|cause| BedError::Templates { layer: layer.name.clone(), cause })?;
            }
        }
        recipe.check().map_err(BedError::Recipe)?;
        let (section, plate, notes) = (self.section.clone(), self.plate, self.notes.clone());
        Ok(BedRecipe { section, recipe, plate, notes })
    }

    /// The seed of the first packing.
    pub fn seed(&self) -> u64 {
        self.blank.seed
    }
}

/// A bed of grains with sleepers or a plate on it; it takes the forces of actuators at every step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedNode {
    pub bed: BedPlan,
    /// Cells of the bed side by side.
    pub copies: u32,
    /// Bodies on the bed, from left to right.
    pub bodies: Vec<StandingBody>,
    /// Area of a plate over the whole bed, if there is one instead of sleepers, m2.
    pub plate: Option<f64>,
    /// Grains between and beside the sleepers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crib: Option<Crib>,
    /// Layers whose grains are glued.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub glued: Vec<Glued>,
    /// Pressure on the sides of a specimen, Pa.
    pub confinement: Option<f64>,
    /// Whether an actuator gives the velocity of the plate instead of a force.
    pub driven: bool,
    /// m/s^2.
    pub gravity: f64,
    pub sensors: Vec<SensorNode>,
    /// Largest added inertia / mass of the bed; added inertia allows a longer step.
    pub added_inertia: f64,
}

/// A sleeper or a plate on a bed, in the axes of the bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StandingBody {
    pub name: String,
    /// Chainage, m.
    pub x: f64,
    /// Position of its middle along and across the bed, m.
    pub place: [f64; 2],
    /// Size along and across the track, and height, m.
    pub size: [f64; 3],
    /// Mass of the body that the bed carries, kg.
    pub mass: f64,
}

/// A measurement volume below the top of the bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SensorNode {
    pub name: String,
    /// Chainage, m.
    pub x: f64,
    /// Position along and across the bed, and depth below its top, m.
    pub place: [f64; 3],
    pub volume: SensorVolume,
    /// Length and width of the bed, m; the volume ends at its sides.
    pub bed: [f64; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SensorVolume {
    /// Radius, m.
    Sphere { radius: f64 },
    /// Sizes, m; `across` is `None` for the whole width of the bed.
    Block { along: f64, across: Option<f64>, height: f64 },
}

/// The actuators of a rig, one for each body on the bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ActuatorsNode {
    pub loads: Vec<Load>,
    /// Length of a cycle, or of the whole history of a force, s.
    pub period: f64,
    pub cycles: u64,
}

/// The grains under a track: packed cells side by side in each window, sleepers on the grains, and springs under all
/// other sleepers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GrainsNode {
    /// Different beds; sections with equal layers share a bed.
    pub beds: Vec<BedPlan>,
    /// Chainages between which the scene asks for grains, m.
    pub window: Vec<[f64; 2]>,
    /// Stretches of grains, from left to right; empty if the plan is only shown.
    pub stretches: Vec<GrainStretch>,
    /// Whether soil lies below.
    pub on_soil: bool,
    /// Whether vehicles, rail and grains are computed together, without an exchange between blocks.
    pub ridden: bool,
    /// Settlement of every seat of the track at the start, m.
    pub settlement: Vec<f64>,
    /// The under sleeper pad of each seat of the track, if there is one.
    pub pads: Vec<Option<UnderPad>>,
    /// Load from which the stiffness of supports is computed.
    pub stiffness_from: StiffnessFrom,
    /// Distance between the fronts of two trains that follow each other, m; `None` if the track comes to rest between
    /// trains.
    pub headway: Option<f64>,
    /// Damping / stiffness of a support, s.
    pub damping_time: f64,
    /// m/s^2.
    pub gravity: f64,
    /// Time step of the grains, s; `None` for the longest step that `added_inertia` allows.
    pub time_step: Option<f64>,
    /// Largest added inertia / mass of a bed; added inertia allows a longer step.
    pub added_inertia: f64,
    /// Volumes in which passages are recorded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub volumes: Vec<VolumeUnderTrack>,
}

/// A volume of grains under a sleeper of a track, in which passages are recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeUnderTrack {
    pub sensor: SensorNode,
    /// Index of the seat of the sleeper, and number of its bed among [`GrainsNode::stretches`].
    pub seat: usize,
    pub stretch: usize,
    pub quantities: Vec<InVolume>,
    /// Axle counts at which a passage is recorded, and the sampling interval, s.
    pub after: Vec<u64>,
    pub every: f64,
}

/// Load from which the support stiffness of the grains is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessFrom {
    /// Static loads on a copy of the beds.
    StaticLoad,
    /// The forces of the last passage.
    Passage,
}

/// Grains between two places of a track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GrainStretch {
    /// Index into [`GrainsNode::beds`].
    pub bed: usize,
    /// Chainage of its left end, m.
    pub start: f64,
    /// Cells of the bed side by side.
    pub copies: u32,
    pub sleepers: Vec<SleeperOnGrains>,
    /// Grains between and beside the sleepers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crib: Option<Crib>,
    /// Layers whose grains are glued, over the whole length or between two distances from the left end.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub glued: Vec<Glued>,
}

/// A sleeper, or half a sleeper, on grains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SleeperOnGrains {
    /// Index of its seat.
    pub seat: usize,
    /// Position of its middle, from the left end of the stretch and from the side wall at the centre line, m.
    pub place: [f64; 2],
    /// Size along and across the track, and height, m.
    pub size: [f64; 3],
    /// Mass of half a sleeper, kg.
    pub mass: f64,
    /// Mass of the rail on it, kg.
    pub rail_mass: f64,
    pub pad: Option<UnderPad>,
    /// Rotation about its axis across the track; `None` if it does not rotate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch: Option<Pitch>,
    /// Whether it stands in the buffer bay between the window and the fixed grains at the end of a bed. The fixed
    /// grains make that bay stiffer, so its results are not used: its support has the stiffness and settlement of its
    /// neighbours.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub buffer: bool,
}

/// The layers below the grains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SoilNode {
    /// From the top downwards.
    pub layers: Vec<SoilLayer>,
    /// Parts along the track with other layers, from left to right.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blocks: Vec<SoilBlock>,
    /// Approximate size of the elements, m.
    pub element: f64,
    /// Whether waves leave through the base; otherwise the base does not move.
    pub quiet_base: bool,
    /// m/s^2.
    pub gravity: f64,
}

/// A part of the track with other layers of soil: a wedge, a reinforced embankment, an approach slab. It is as deep as
/// the soil beside it. If its layers are thinner, the lowest layer is extended down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SoilBlock {
    /// Chainage of its ends, m.
    pub start: f64,
    pub end: f64,
    /// From the top downwards.
    pub layers: Vec<SoilLayer>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SoilLayer {
    pub name: String,
    /// m.
    pub thickness: f64,
    /// Pa.
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    /// kg/m3.
    pub density: f64,
    /// `None` if the soil does not yield.
    pub strength: Option<Strength>,
}

impl SoilNode {
    /// The layers at a chainage, m.
    pub fn layers_at(&self, x: f64) -> &[SoilLayer] {
        let block = self.blocks.iter().find(|block| (block.start..block.end).contains(&x));
        block.map_or(&self.layers, |block| &block.layers)
    }
}

impl BedNode {
    /// Whether its plate moves at a given velocity.
    pub fn is_driven(&self) -> bool {
        self.driven
    }

    /// The test rig of this bed under actuators; `top` is the level of the top of the bed (m). Loops of force and depth
    /// and sensor readings are kept for the cycles `kept`.
    pub fn rig(&self, actuators: &ActuatorsNode, recipe: &Recipe, top: f64, kept: &[u64]) -> Rig {
        let body = |(body, load): (&StandingBody, &Load)| Sleeper {
            place: body.place,
            size: body.size,
            mass: body.mass,
            load: load.clone(),
        };
        let specimen = self.confinement.zip(recipe.sides());
        Rig {
            sleepers: self.bodies.iter().zip(&actuators.loads).map(body).collect(),
            specimen: specimen.map(|(pressure, sides)| Specimen { floor: recipe.floor(), sides, pressure }),
            glued: self.glued.clone(),
            filling: self.crib.and_then(|crib| crib.filling(recipe, self.copies)),
            period: actuators.period,
            cycles: actuators.cycles,
            gravity: self.gravity,
            densities: recipe.layers.iter().map(|layer| layer.density).collect(),
            kept: kept.to_vec(),
            sensors: self.sensors.iter().filter_map(|sensor| Some(Sensor { region: sensor.region(top)? })).collect(),
            added: self.added_inertia,
        }
    }
}

impl SensorNode {
    /// The volume in a bed with its top at a level (m), cut at the ends and sides of the bed; `None` if no volume
    /// remains.
    pub fn region(&self, top: f64) -> Option<Region> {
        let [x, y, depth] = self.place;
        let [length, width] = self.bed;
        let z = top - depth;
        match self.volume {
            SensorVolume::Sphere { radius } => Region::sphere([x, y, z], radius).ok(),
            SensorVolume::Block { along, across, height } => {
                let ends = |middle: f64, size: f64, most: f64| {
                    [(middle - size / 2.0).max(0.0), (middle + size / 2.0).min(most)]
                };
                let [[x0, x1], [y0, y1]] =
                    [ends(x, along, length), across.map_or([0.0, width], |size| ends(y, size, width))];
                Region::block([x0, y0, z - height / 2.0], [x1, y1, z + height / 2.0]).ok()
            }
        }
    }
}

impl ActuatorsNode {
    /// Whether the actuators give a velocity instead of a force.
    pub fn drive(&self) -> bool {
        self.loads.iter().any(|load| matches!(load, Load::Strain(_)))
    }
}
