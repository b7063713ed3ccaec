//! Measurements in a packed bed: over its height, in its contacts, and under a plate.

use crate::graph::BedRecipe;
use crate::solvers::granular::measure::{Fabric, ForceSpread, Reading, Region, Rose, Survey};
use crate::solvers::granular::packing::{GrainLayer, Packed};
use crate::solvers::granular::probe::{FULL, LoadPoint, Outline, Plate, Stiffness, probe};
use crate::solvers::granular::{Bed, Failure};
use crate::store::{Shelf, StoreError, recipe_hash};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Height of a slab, as a share of the largest grain of its layer, and the largest number of slabs in a layer.
const SLAB: f64 = 0.5;
const SLABS: f64 = 24.0;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedReadings {
    /// Slabs from the floor upwards, over the whole plan; at rest, without a plate.
    pub profile: Vec<ProfileRow>,
    pub directions: Directions,
    /// Directions of contacts with more than the mean normal force.
    pub strong_directions: Directions,
    pub forces: ForceSpread,
    /// `None` if the test failed; a note then gives the reason.
    pub plate: Option<PlateTest>,
    pub notes: Vec<String>,
}

/// Values between two levels. Pressures are positive; two of them act on vertical planes, along and across the track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct ProfileRow {
    pub from_m: f64,
    pub to_m: f64,
    pub porosity: f64,
    pub coordination: f64,
    pub vertical_Pa: f64,
    pub along_Pa: f64,
    pub across_Pa: f64,
}

/// Directions of the contacts between grains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Directions {
    pub fabric: Fabric,
    pub deviator: f64,
    pub anisotropy: f64,
    pub rose: Rose,
}

/// A plate test with two loadings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub struct PlateTest {
    /// Along the track and across, m; `None` if it covers the whole cell.
    pub sides_m: Option<[f64; 2]>,
    pub area_m2: f64,
    pub pressure_Pa: f64,
    pub curve: Vec<LoadPoint>,
    /// First and second loading.
    pub stiffness_N_per_m: [f64; 2],
    /// Moduli of an equal half-space, Ev1 and Ev2; `None` for a plate over the whole cell.
    pub moduli_Pa: Option<[f64; 2]>,
    /// Under the plate at the first full pressure.
    pub loaded: Vec<ProfileRow>,
}

/// Measures a bed. `tell` gets the number of plate steps that are done, and their total.
pub fn read_bed(
    plan: &BedRecipe,
    packed: &Packed<f32>,
    tell: impl FnMut(usize, usize),
) -> Result<BedReadings, Failure> {
    let slabs = slabs(plan, packed);
    let survey = packed.survey(&mut packed.bed.clone())?;
    let forces = ForceSpread::from_pushes(survey.pushes());
    let row = |slab: &[f64; 2]| Some(profile_row(slab, &survey.slab(*slab, packed.area())?));
    let mut notes = Vec::new();
    let plate =
        press(plan, packed, &slabs, tell).map_err(|why| notes.push(format!("Stiffness was not measured: {why}."))).ok();
    Ok(BedReadings {
        profile: slabs.iter().filter_map(row).collect(),
        directions: Directions::of_contacts(&survey, 0.0),
        strong_directions: Directions::of_contacts(&survey, forces.mean),
        forces,
        plate,
        notes,
    })
}

/// Readings of a bed that were kept; `None` if there are none. Fails if they are damaged.
pub fn kept_readings(cache: &Path, plan: &BedRecipe) -> Result<Option<BedReadings>, StoreError> {
    shelf(cache).get(&readings_hash(plan))
}

/// Keeps the readings of a bed.
pub fn keep_readings(cache: &Path, plan: &BedRecipe, readings: &BedReadings) -> Result<(), StoreError> {
    shelf(cache).put(&readings_hash(plan), readings)
}

/// Readings are stored beside their beds.
fn shelf(cache: &Path) -> Shelf {
    Shelf::new(cache, "readings")
}

/// Hash of the bed's recipe and of the measuring method.
fn readings_hash(plan: &BedRecipe) -> String {
    recipe_hash(&(&plan.recipe, &plan.plate))
}

/// Levels between which a bed is measured, layer by layer.
fn slabs(plan: &BedRecipe, packed: &Packed<f32>) -> Vec<[f64; 2]> {
    let layer = |(number, layer): (usize, &GrainLayer)| {
        let [low, high] = packed.between(number);
        let count = ((high - low) / (SLAB * layer.curve.ends()[1])).floor().clamp(1.0, SLABS) as usize;
        let level = move |k: usize| low + (high - low) * k as f64 / count as f64;
        (0..count).map(move |k| [level(k), level(k + 1)]).collect::<Vec<_>>()
    };
    plan.recipe.layers.iter().enumerate().flat_map(layer).collect()
}

fn profile_row([from, to]: &[f64; 2], reading: &Reading) -> ProfileRow {
    let [along, across] = reading.horizontal();
    ProfileRow {
        from_m: *from,
        to_m: *to,
        porosity: reading.porosity,
        coordination: reading.coordination,
        vertical_Pa: reading.vertical(),
        along_Pa: along,
        across_Pa: across,
    }
}

impl Directions {
    /// Directions of the contacts with more than `least` N.
    fn of_contacts(survey: &Survey, least: f64) -> Directions {
        let fabric = Fabric::from_normals(survey.normals(least));
        let rose = Rose::from_normals(survey.normals(least));
        Directions { fabric, deviator: fabric.deviator(), anisotropy: fabric.anisotropy(), rose }
    }
}

fn press(
    plan: &BedRecipe,
    packed: &Packed<f32>,
    slabs: &[[f64; 2]],
    mut tell: impl FnMut(usize, usize),
) -> Result<PlateTest, String> {
    let plate = &plan.plate;
    let mut loaded = Ok(Vec::new());
    let stiffness = probe(&packed.bed, plate, |bed, done, all| {
        tell(done, all);
        if done == FULL {
            loaded = under(plate, packed, bed, slabs);
        }
    });
    let Stiffness { area, curve, first, again, moduli } = stiffness.map_err(|error| error.to_string())?;
    Ok(PlateTest {
        sides_m: (!matches!(plate.outline, Outline::Whole { .. })).then(|| plate.outline.sides()),
        area_m2: area,
        pressure_Pa: plate.pressure,
        curve,
        stiffness_N_per_m: [first, again],
        moduli_Pa: moduli,
        loaded: loaded.map_err(|failure| failure.to_string())?,
    })
}

/// The grains under the plate, level by level.
fn under(plate: &Plate, packed: &Packed<f32>, bed: &mut Bed, slabs: &[[f64; 2]]) -> Result<Vec<ProfileRow>, Failure> {
    let survey = packed.survey(bed)?;
    let [x, y] = plate.centre;
    let row = |slab: &[f64; 2]| {
        let [low, high] = *slab;
        let reading = match plate.outline {
            Outline::Whole { .. } => survey.slab(*slab, packed.area())?,
            outline => {
                let [length, width] = outline.sides();
                let (a, b) = (0.5 * length, 0.5 * width);
                survey.region(&Region::block([x - a, y - b, low], [x + a, y + b, high]).ok()?)
            }
        };
        Some(profile_row(slab, &reading))
    };
    Ok(slabs.iter().filter_map(row).collect())
}
