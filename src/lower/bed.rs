//! Beds of grains of a scene, as plans for the packer: one bed for each section with different layers.

use super::clumps::Clumps;
use super::crib;
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::BedPlan;
use crate::scenario::{BedEnds, Contact, Granular, Layer, Loading, Scenario, Section, Shape};
use crate::schema::Reads;
use crate::solvers::granular::clump::Template;
use crate::solvers::granular::grains::TemplatesError;
use crate::solvers::granular::packing::{GRAIN, GrainLayer as Filling, Packing, PackingError, Recipe, Rest};
use crate::solvers::granular::probe::{Outline, Plate, Stillness};
use crate::solvers::granular::{DashpotMode, Surface};
use crate::units::number;

/// Least length of a cell / diameter of the largest grain: no grain touches its own periodic image.
const CELL: f64 = 3.2;
/// Half the width of a bed if there are no sleepers and no width is given, m.
const HALF_WIDTH: f64 = 1.2;
/// Pressure under the plate, Pa: slightly less than half a wheel load of 98 kN (a 20 t axle) on the 0.39 m2 of half a
/// sleeper.
const PLATE_PRESSURE: f64 = 100e3;

/// Fields of grains and of their bed.
pub(super) const READS: Reads = Reads {
    fields: &[
        "grading.passing",
        "grading.cut_below",
        "grading.cut_above",
        "granular.grading",
        "granular.scale",
        "granular.density",
        "granular.shape",
        "granular.contact",
        "granular.contact_stiffness",
        "granular.shear_ratio",
        "granular.friction",
        "granular.wall_friction",
        "granular.local_damping",
        "granular.viscous_damping",
        "granular.shear_damping",
        "granular.dashpots",
        "granular.packing",
        "granular.bond",
        "bond.stiffness",
        "bond.tensile_strength",
        "bond.shear_strength",
        "packing.lifts",
        "packing.pressure",
        "packing.friction",
        "packing.local_damping",
        "packing.viscous_damping",
        "packing.restored",
        "packing.reloads",
        "track.bed_width",
        "trackform.crib",
        "trackform.shoulder",
        "solve.gravity",
        "solve.symmetry",
        "solve.repeats",
    ],
    acts_where: WITH_GRAINS,
};

/// Fields of the volumes in which responses of grains are recorded.
pub(super) const VOLUMES: Reads = Reads {
    fields: &["record.depth", "record.volume"],
    acts_where: "where grains are loaded step by step: on a test rig, or under a track with `substructure = zone` or `full`",
};

const WITH_GRAINS: &str = "where grains are modelled: on a test rig, or with `substructure = cells`, `zone` or `full`";

/// Use of a packed cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BedUse {
    /// The bed of a track; fixed grains close its ends.
    Track,
    /// A test rig; its bed is periodic or a box.
    Rig,
}

/// One bed for each different section with grains under its sleepers. Fails if the packer would refuse a bed.
pub fn beds(scenario: &Scenario, use_of_it: BedUse) -> Result<Vec<BedPlan>, Vec<Diagnostic>> {
    let packings = if use_of_it == BedUse::Rig { scenario.solve.grains.repeats.most } else { 1 };
    beds_of(scenario, use_of_it, &Clumps::made(scenario.solve.seed, packings))
}

/// The same beds with spheres instead of clumps, because clumps take a tenth of a second to make. It does not report
/// clumps that are too wide.
pub(super) fn beds_of_spheres(scenario: &Scenario, use_of_it: BedUse) -> Result<Vec<BedPlan>, Vec<Diagnostic>> {
    beds_of(scenario, use_of_it, &Clumps::spheres())
}

fn beds_of(scenario: &Scenario, use_of_it: BedUse, clumps: &Clumps) -> Result<Vec<BedPlan>, Vec<Diagnostic>> {
    let mut found: Vec<BedPlan> = Vec::new();
    let mut wrong = Vec::new();
    for section in 0..scenario.track.sections.len() {
        match bed(scenario, section, use_of_it, clumps) {
            Ok(Some(plan)) if !found.iter().any(|other| other.packs_like(&plan)) => found.push(plan),
            Ok(_) => {}
            Err(diagnostic) => wrong.push(diagnostic),
        }
    }
    if wrong.is_empty() { Ok(found) } else { Err(wrong) }
}

fn bed(scenario: &Scenario, number: usize, use_of_it: BedUse, clumps: &Clumps) -> Result<Option<BedPlan>, Diagnostic> {
    let section = &scenario.track.sections[number];
    let middle = 0.5 * (section.start + section.end);
    let seed = scenario.solve.seed;
    let grains: Vec<(&Layer, &Granular)> =
        section.layers.iter().filter_map(|layer| Some((layer, layer.granular()?))).collect();
    let Some((Layer { name: top_name, .. }, top)) = grains.first() else { return Ok(None) };
    let mut notes = Vec::new();
    let (mut layers, mut shapes) = (Vec::new(), Vec::new());
    // the packer starts at the bottom
    for (layer, granular) in grains.iter().rev() {
        let shape = granular.shape.clumps();
        let templates = clumps.widest(shape.as_ref()).map_err(|cause| not_made(layer, granular, &cause))?;
        layers.push(filling(layer, granular, middle, templates)?);
        shapes.push(shape);
    }
    let plan = plan(scenario, number, Largest::of(&layers));
    let boxed = confinement(scenario).is_some();
    notes.push(if boxed {
        "The bed is a box with walls on all sides.".to_owned()
    } else {
        let spacing = *section.spacing;
        let bays = (plan[0] / spacing).round();
        format!("The cell is {bays} x {spacing} m long, at least {CELL} times the diameter of its largest grain.")
    });
    if section.layers.len() > grains.len() {
        notes.push("During packing the soil below the grains is a rigid floor.".to_owned());
    }
    for (layer, granular) in grains.iter().filter(|(_, granular)| *granular.scale != 1.0) {
        let (name, scale) = (&layer.name, *granular.scale);
        notes.push(format!(
            "Grains of `{name}` are {scale} times as large as the real grains, and their contacts are stiffer by the same factor."
        ));
    }
    if grains.iter().any(|(_, granular)| granular.local_damping.value != top.local_damping.value) {
        notes.push(format!("All layers have the local damping of the top layer: {}.", *top.local_damping));
    }
    if grains.iter().any(|(_, granular)| granular.packing.restored != top.packing.restored) {
        notes.push(format!(
            "Friction and damping return in all layers at the same time, as `{top_name}` states (`packing.restored`)."
        ));
    }
    if grains.iter().any(|(_, granular)| granular.packing.reloads != top.packing.reloads) {
        let times = top.packing.reloads;
        notes.push(format!("Loadings of the finished bed (`packing.reloads`): {times}, as `{top_name}` states."));
    }
    for layer in layers.iter().filter(|layer| layer.lifts_that_fit() < layer.lifts) {
        let (name, asked, fit) = (&layer.name, layer.lifts, layer.lifts_that_fit());
        let times = if fit == 1 { "lift" } else { "lifts" };
        notes.push(format!(
            "`{name}` is packed in {fit} {times} instead of {asked}: a single grain of {} mm would carry the plate of a thinner lift.",
            mm(layer.curve.ends()[1])
        ));
    }
    let recipe = Recipe {
        plan,
        walls: true,
        ends: boxed,
        layers,
        gravity: *scenario.solve.gravity,
        local_damping: *top.local_damping,
        restored: top.packing.restored,
        reloads: top.packing.reloads,
        rest: Rest::default(),
        seed,
    };
    recipe.check().map_err(|error| unpackable(&error, scenario, section))?;
    crib::holds_grains(scenario, number, &recipe)?;
    let recipe = recipe.with_spheres();
    if use_of_it == BedUse::Track && scenario.track.bed.ends == BedEnds::Walls && !boxed {
        notes.push("The cell is periodic along the track; fixed grains close both ends of the whole bed.".to_owned());
    }
    let plate = plate(scenario, number, &recipe, &mut notes);
    let mut plan = BedPlan::new(section.name.clone(), recipe, shapes, plate);
    plan.notes = notes;
    Ok(Some(plan))
}

/// The footprint of the sleeper on the cell, from the centre line outwards; the whole cell if it is too small for a
/// sleeper or if there is no sleeper.
fn plate(scenario: &Scenario, section: usize, recipe: &Recipe, notes: &mut Vec<String>) -> Plate {
    let track = &scenario.track;
    let [length, width] = recipe.plan;
    let largest = Largest::of(&recipe.layers).diameter;
    let sleeper = track.seats[track.seats_of(section)].iter().find_map(|seat| seat.sleeper);
    let share = if scenario.solve.grains.both_rails { 1.0 } else { 0.5 };
    let rest = Stillness::default();
    let plate =
        |outline, centre| Plate { outline, centre, pressure: PLATE_PRESSURE, surface: recipe.wall_surface(), rest };
    match sleeper.filter(|sleeper| sleeper.base_width + largest <= length) {
        Some(sleeper) => {
            let across = (share * sleeper.length).min(width);
            let middle = if share < 1.0 { 0.5 * across } else { 0.5 * width };
            plate(Outline::Rectangle { length: sleeper.base_width, width: across }, [0.5 * length, middle])
        }
        None => {
            notes.push("Its stiffness is measured with a plate over the whole cell.".to_owned());
            plate(Outline::Whole { area: length * width }, [0.5 * length, 0.5 * width])
        }
    }
}

/// The largest grain of a bed.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Largest {
    /// Diameter of the sphere with the volume of the grain, m.
    pub diameter: f64,
    /// Largest extent of the grain, m: a clump is longer than its diameter.
    pub width: f64,
}

impl Largest {
    fn of(layers: &[Filling]) -> Largest {
        let largest = |of: fn(&Filling) -> f64| layers.iter().map(of).fold(0.0, f64::max);
        Largest { diameter: largest(|layer| layer.curve.ends()[1]), width: largest(Filling::widest) }
    }
}

/// Length and width of a cell, m. A cell has enough bays that the largest grain does not touch its own periodic image;
/// a box has the length of the section.
pub(super) fn plan(scenario: &Scenario, number: usize, largest: Largest) -> [f64; 2] {
    let section = &scenario.track.sections[number];
    let spacing = *section.spacing;
    let least = (CELL * largest.diameter).max(largest.width / GRAIN);
    let length = match confinement(scenario) {
        Some(_) => section.end - section.start,
        None => (least / spacing).ceil().max(1.0) * spacing,
    };
    [length, width(scenario, number)]
}

/// Pressure on the sides of a specimen, Pa.
pub(super) fn confinement(scenario: &Scenario) -> Option<f64> {
    let Some(Loading::Rig(loads)) = &scenario.loading else { return None };
    loads.iter().find_map(|load| load.confinement).map(|pressure| *pressure)
}

/// Width of the bed of one rail or of both rails, m. No sleeper reaches beyond the side wall.
pub(super) fn width(scenario: &Scenario, section: usize) -> f64 {
    let track = &scenario.track;
    let lengths = track.seats[track.seats_of(section)].iter().filter_map(|seat| Some(seat.sleeper?.length));
    let shoulder = track.sections[section].crib.map_or(0.0, |crib| crib.beyond());
    let least = lengths.reduce(f64::max).map(|longest| 0.5 * longest + shoulder);
    let stated = track.bed.half_width.map(|half| half.max(least.unwrap_or(0.0)));
    let half = stated.or(least).unwrap_or(HALF_WIDTH);
    if scenario.solve.grains.both_rails { 2.0 * half } else { half }
}

fn filling(layer: &Layer, granular: &Granular, x: f64, templates: Vec<Template>) -> Result<Filling, Diagnostic> {
    let Contact::Linear { stiffness } = granular.contact else {
        let why = format!(
            "grains of `{}` have `contact = hertz`; this version packs only `contact = linear` with a `contact_stiffness`",
            layer.name
        );
        return Err(refused(&why, granular.density.origin.span()));
    };
    // a contact is two springs in series
    let normal = 2.0 * *stiffness;
    let mode = if granular.dashpots_pull { DashpotMode::Full } else { DashpotMode::default() };
    let surface = Surface {
        normal_stiffness: normal,
        shear_stiffness: normal * *granular.shear_ratio,
        friction: *granular.friction,
        damping: [*granular.viscous_damping, *granular.shear_damping],
        mode,
    };
    let curve = granular.grading.curve();
    let curve = curve
        .map_err(|error| refused(&format!("grains of `{}`: {error}", layer.name), granular.density.origin.span()))?;
    Ok(Filling {
        name: layer.name.clone(),
        curve,
        templates,
        density: *granular.density,
        surface,
        wall_friction: *granular.wall_friction,
        thickness: layer.thickness.value_at(x),
        lifts: granular.packing.lifts,
        pressure: *granular.packing.pressure,
        packing: Packing {
            friction: *granular.packing.friction,
            local_damping: *granular.packing.local_damping,
            viscous_damping: *granular.packing.viscous_damping,
        },
    })
}

/// Whether the layers of grains at two places (m) give the same packed bed, glued or not.
pub(super) fn packs_alike(one: (&[Layer], f64), other: (&[Layer], f64)) -> bool {
    let filled = |(layers, x): (&[Layer], f64)| -> Option<Vec<_>> {
        let grains = layers.iter().filter_map(|layer| Some((layer, layer.granular()?)));
        let of_one = |(layer, granular): (&Layer, &Granular)| {
            let filling = filling(layer, granular, x, Vec::new()).ok()?;
            let thickness = (filling.thickness / TINY).round() * TINY;
            let alike = Filling { name: String::new(), thickness, ..filling };
            let packing = granular.packing;
            Some((alike, granular.shape.clumps(), *granular.local_damping, packing.restored, packing.reloads))
        };
        grains.map(of_one).collect()
    };
    filled(one) == filled(other)
}

/// Thicknesses that differ by less than this count as equal, m.
const TINY: f64 = 1e-6;

/// A length in mm.
fn mm(length: f64) -> String {
    number((length * 1e3).round())
}

const UNPACKABLE: &str = "this bed cannot be packed";

fn refused(why: &str, at: Option<Span>) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0610, format!("{UNPACKABLE}: {why}"));
    match at {
        Some(span) => diagnostic.label(span, "asked for here"),
        None => diagnostic,
    }
}

/// Diagnostic for a layer whose surfaces give no clumps.
fn not_made(layer: &Layer, granular: &Granular, cause: &TemplatesError) -> Diagnostic {
    let at = match &granular.shape {
        Shape::Clumps { ratio, .. } => ratio.origin.span(),
        Shape::Spheres => None,
    };
    refused(&format!("grains of `{}`: {cause}", layer.name), at.or(granular.density.origin.span()))
}

/// Diagnostic for a recipe that the packer refuses, at the place in the scene that asks for it.
fn unpackable(error: &PackingError, scenario: &Scenario, section: &Section) -> Diagnostic {
    let layer = match error {
        PackingError::Number { layer, .. } => layer.as_deref(),
        PackingError::LargeGrain { layer, .. } | PackingError::ThinLayer { layer, .. } => Some(layer.as_str()),
        _ => None,
    };
    let of_layer = section.layers.iter().find(|other| Some(other.name.as_str()) == layer);
    let granular = of_layer.and_then(Layer::granular);
    let of_gravity = matches!(error, PackingError::Number { quantity: "gravity", .. });
    let gravity = scenario.solve.gravity.origin.span().filter(|_| of_gravity);
    let grains = granular.and_then(|granular| granular.density.origin.span());
    let at = gravity.or(grains).or(section.length_origin.span());
    let PackingError::LargeGrain { diameter, side, .. } = *error else { return refused(&error.to_string(), at) };
    let told = Diagnostic::new(Code::E0610, format!("{UNPACKABLE}: {error}")).help(larger_cell(scenario, diameter));
    let too_small = |span| (span, format!("too small: the cell is {} mm there", mm(side)));
    match side_of(scenario, section, side).map(too_small).or(at.map(|span| (span, "these grains".to_owned()))) {
        Some((span, text)) => told.label(span, text),
        None => told,
    }
}

/// Place of the text that gives a side (m) of the cell.
fn side_of(scenario: &Scenario, section: &Section, side: f64) -> Option<Span> {
    let length = section.end - section.start;
    let along = confinement(scenario).is_some() && (length - side).abs() < 1e-9;
    let width = scenario.track.bed.half_width.and_then(|half| half.origin.span());
    if along { section.length_origin.span() } else { width }
}

/// Help for a cell with a largest grain of this width (m): the sides are rounded up to hundreds of millimetres.
fn larger_cell(scenario: &Scenario, width: f64) -> String {
    let side = (width / GRAIN * 10.0 - 1e-9).ceil() / 10.0;
    let rails = if scenario.solve.grains.both_rails { 1.0 } else { 2.0 };
    let across = format!("`bed_width = {} m per track` or more", number(rails * side));
    match confinement(scenario) {
        Some(_) => format!(
            "write a section of {} m or longer, and {across}; or cut off large grains with `cut_above`",
            number(side)
        ),
        None => format!("write {across}; or cut off large grains with `cut_above`"),
    }
}
