//! A scene of test loads on sleepers over grains, as a bed to pack and a rig to run.

mod cost;
mod listing;
mod refusals;

pub use cost::{RigCost, rig_cost};
pub use listing::rig_listing;
pub(super) use refusals::refusals;

use super::bed::{BedPlan, beds, confinement};
use crate::diag::Diagnostic;
use crate::scenario::{Foot, Force, Given, Loading, RigLoad, Scenario, Seat, Section, SleeperBody, Target, Volume};
use crate::solvers::granular::measure::Region;
use crate::solvers::granular::packing::GrainLayer;
use crate::solvers::granular::rig::{ADDED, Load, Rig, Sensor, Sleeper, Specimen};
use crate::units::number;
use std::f64::consts::PI;

/// Name of a plate, and its mass over its area: 20 mm of steel, kg/m2; height, m.
const PLATE: &str = "plate";
const PLATE_MASS: f64 = 157.0;
const PLATE_HEIGHT: f64 = 0.02;
/// By how much it is wider than a specimen, which may grow under it.
const WIDER: f64 = 2.0;
/// Inertial number up to which grains move as if at rest (GDR MiDi 2004): a plate that is driven is no faster.
const INERTIAL: f64 = 1e-3;
/// A constant force grows and is held for this long, s.
const HELD: f64 = 0.5;

/// A rig, before its bed is packed.
#[derive(Debug, Clone, PartialEq)]
pub struct RigPlan {
    pub bed: BedPlan,
    /// Cells of the bed side by side.
    pub copies: u32,
    /// Area of a plate in the place of sleepers, m2.
    pub plate: Option<f64>,
    /// On the sides of a specimen, Pa.
    pub confinement: Option<f64>,
    /// Names and chainages of the sleepers or of the plate, m.
    pub sleepers: Vec<(String, f64)>,
    /// Names and chainages of the sensors, m.
    pub sensors: Vec<(String, f64)>,
    /// With sensors at depths below the top of the bed.
    rig: Rig,
    places: Vec<Place>,
}

/// Where a sensor is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    /// Along and across the bed, below the sleeper, m.
    at: [f64; 3],
    volume: Volume,
    /// Of the bed, m.
    length: f64,
    width: f64,
}

/// Whether a scene is a test rig that this version runs: loads on sleepers or on the bed, grains under them, no rails, no trains.
pub fn is_rig(scenario: &Scenario) -> bool {
    stands_on_its_bed(scenario) && scenario.track.sections.iter().all(has_grains)
}

/// Whether loads act on sleepers or a bed, without rails.
fn stands_on_its_bed(scenario: &Scenario) -> bool {
    let loads = match &scenario.loading {
        Some(Loading::Rig(loads)) => loads.iter().all(|load| load.on != Target::Rail),
        Some(Loading::Static(loads)) => loads.iter().all(|load| load.on != Target::Rail),
        _ => false,
    };
    loads && scenario.track.sections.iter().all(|section| section.rail.is_none())
}

fn has_grains(section: &Section) -> bool {
    section.layers.iter().any(|layer| layer.granular().is_some())
}

/// The rig of a scene; what cannot be packed or run is told.
pub fn rig(scenario: &Scenario) -> Result<RigPlan, Vec<Diagnostic>> {
    let refused = refusals(scenario);
    if !refused.is_empty() {
        return Err(refused);
    }
    let mut bed = beds(scenario)?.remove(0);
    bed.notes.retain(|note| !note.starts_with("The cell is periodic"));
    let confinement = confinement(scenario);
    bed.notes.push(match confinement {
        Some(pressure) => format!("Its four sides give way under {} kPa.", number(pressure / 1e3)),
        None => "The bed goes on periodically along the track; nothing lies beside or between the sleepers.".to_owned(),
    });
    let section = &scenario.track.sections[0];
    let [cell, across] = bed.recipe.plan;
    let copies = ((section.end - section.start) / cell - 1e-9).ceil().max(1.0) as u32;
    let loads = loads(scenario);
    let seats = &scenario.track.seats;
    let length = cell * f64::from(copies);
    let pressed = loads.iter().find(|load| load.on == Target::Bed);
    let (names, sleepers) = match pressed {
        Some(load) => {
            (vec![(PLATE.to_owned(), section.start + length / 2.0)], vec![plate(scenario, load, [length, across])])
        }
        None => (
            seats.iter().map(|seat| (scenario.track.seat_name(seat), seat.x)).collect(),
            seats.iter().filter_map(|seat| sleeper(scenario, seat, &loads, across)).collect(),
        ),
    };
    let densities = bed.recipe.layers.iter().map(|layer| layer.density).collect();
    let (sensors, places) = sensors(scenario, length, across);
    let of = |layer: &GrainLayer| [layer.curve.mean_volume(), layer.density, confinement.unwrap_or(layer.pressure)];
    let rest = rest_time(bed.recipe.layers.iter().map(of));
    bed.notes.extend(driven(&loads, rest));
    let specimen = confinement.zip(bed.recipe.sides());
    let rig = Rig {
        sleepers,
        specimen: specimen.map(|(pressure, sides)| Specimen { floor: bed.recipe.floor(), sides, pressure }),
        period: period(&loads, rest),
        cycles: cycles(&loads),
        gravity: *scenario.solve.gravity,
        densities,
        kept: kept(scenario, cycles(&loads)),
        sensors: Vec::new(),
        added: ADDED,
    };
    let plate = pressed.map(|_| length * across);
    Ok(RigPlan { bed, copies, plate, confinement, sleepers: names, sensors, rig, places })
}

impl RigPlan {
    /// The rig on a bed whose top is at a level, m.
    pub fn on(&self, top: f64) -> Rig {
        let sensors = self.places.iter().filter_map(|place| Some(Sensor { region: place.region(top)? })).collect();
        Rig { sensors, ..self.rig.clone() }
    }

    pub fn cycles(&self) -> u64 {
        self.rig.cycles
    }
}

impl Place {
    /// Cut at the ends and sides of the bed; `None` where nothing is left.
    fn region(&self, top: f64) -> Option<Region> {
        let [x, y, depth] = self.at;
        let z = top - depth;
        match self.volume {
            Volume::Sphere { radius } => Region::sphere([x, y, z], radius).ok(),
            Volume::Box { along, across, height } => {
                let ends = |middle: f64, size: f64, most: f64| {
                    [(middle - size / 2.0).max(0.0), (middle + size / 2.0).min(most)]
                };
                let [[x0, x1], [y0, y1]] =
                    [ends(x, along, self.length), across.map_or([0.0, self.width], |size| ends(y, size, self.width))];
                Region::block([x0, y0, z - height / 2.0], [x1, y1, z + height / 2.0]).ok()
            }
        }
    }
}

/// All loads, those that stay as they are among them.
fn loads(scenario: &Scenario) -> Vec<RigLoad> {
    match &scenario.loading {
        Some(Loading::Rig(loads)) => loads.clone(),
        Some(Loading::Static(loads)) => loads
            .iter()
            .map(|load| RigLoad {
                name: load.name.clone(),
                on: load.on,
                x: load.x,
                force: Force::Constant(load.force),
                confinement: None,
                speed: Given::derived(0.0),
                cycles: 1,
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Of a cycle, s; `rest` is the [`rest_time`] of the bed.
fn period(loads: &[RigLoad], rest: f64) -> f64 {
    let of = |load: &RigLoad| match &load.force {
        Force::Constant(_) => None,
        Force::Cyclic { frequency, .. } => Some(1.0 / **frequency),
        Force::History(points) => Some(points.last()?[0] - points.first()?[0]),
        Force::Strain(strain) => Some(**strain * rest / INERTIAL),
    };
    loads.iter().find_map(of).unwrap_or(HELD)
}

/// In which a pressure moves a grain by its own size, d sqrt(rho / p), s: the longest of layers of mean volume, density and pressure.
fn rest_time(layers: impl Iterator<Item = [f64; 3]>) -> f64 {
    let of = |[volume, density, pressure]: [f64; 3]| (6.0 * volume / PI).cbrt() * (density / pressure).sqrt();
    layers.map(of).fold(0.0, f64::max)
}

/// How fast a plate is driven, and why.
fn driven(loads: &[RigLoad], rest: f64) -> Option<String> {
    let strain = loads.iter().any(|load| matches!(load.force, Force::Strain(_)));
    let rate = format!("{:.1}", 100.0 * INERTIAL / rest);
    strain.then(|| {
        format!("The plate shortens the bed by {rate} % a second: an inertial number of {INERTIAL}, as if at rest.")
    })
}

fn cycles(loads: &[RigLoad]) -> u64 {
    let of = |load: &RigLoad| matches!(load.force, Force::Cyclic { .. }).then_some(load.cycles);
    loads.iter().filter_map(of).max().unwrap_or(1)
}

/// Cycles of which loops and sensors are kept: those that records ask for, the first and the last.
fn kept(scenario: &Scenario, cycles: u64) -> Vec<u64> {
    let asked = scenario.records.iter().flat_map(|record| &record.after);
    let asked = asked.chain(scenario.volumes.iter().flat_map(|record| &record.after)).copied();
    let mut kept: Vec<u64> = asked.filter(|count| (1..=cycles).contains(count)).chain([1, cycles]).collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The load that acts on a seat: one that stands there, or one that moves over it.
fn load_at<'a>(seat: &Seat, loads: &'a [RigLoad]) -> Option<&'a RigLoad> {
    loads.iter().find(|load| acts_on(load, seat))
}

fn acts_on(load: &RigLoad, seat: &Seat) -> bool {
    let away = seat.x - load.x;
    away.abs() < 1e-6 || *load.speed > 0.0 && away > 0.0
}

/// A sleeper, and the force of its actuator, of one rail or of both.
fn sleeper(scenario: &Scenario, seat: &Seat, loads: &[RigLoad], across: f64) -> Option<Sleeper> {
    let Foot::Sleeper { mass, .. } = &seat.foot else { return None };
    let SleeperBody { length, base_width, height, base_area, .. } = seat.sleeper?;
    let (share, y) = if scenario.solve.grains.both_rails { (2.0, across / 2.0) } else { (1.0, 0.0) };
    let load = load_at(seat, loads).map_or(Load::None, |load| force(load, share, seat.x - load.x));
    let start = scenario.track.sections[0].start;
    Some(Sleeper {
        place: [seat.x - start, y],
        // what bears is as wide as the sleeper, and no longer than it
        size: [base_width, (base_area / base_width).min(length), height],
        mass: share * **mass,
        load,
    })
}

/// A plate over the whole bed.
fn plate(scenario: &Scenario, load: &RigLoad, [length, across]: [f64; 2]) -> Sleeper {
    let share = if scenario.solve.grains.both_rails { 2.0 } else { 1.0 };
    let wider = if load.confinement.is_some() { WIDER } else { 1.0 };
    Sleeper {
        place: [length / 2.0, across / 2.0],
        size: [wider * length, wider * across, PLATE_HEIGHT],
        mass: PLATE_MASS * length * across,
        load: force(load, share, 0.0),
    }
}

/// Of an actuator, of one rail or of a share of it, `away` m behind the place of its load.
fn force(load: &RigLoad, share: f64, away: f64) -> Load {
    match &load.force {
        Force::Constant(force) => Load::Constant(share * **force),
        Force::Cyclic { range: [low, high], .. } => {
            let delay = if *load.speed > 0.0 { away / *load.speed } else { 0.0 };
            Load::Cyclic { range: [share * **low, share * **high], delay }
        }
        Force::Strain(strain) => Load::Strain(**strain),
        Force::History(points) => Load::History(points.iter().map(|[time, force]| [*time, share * force]).collect()),
    }
}

/// Names and chainages of the sensors, and where they are: under the rail seat, or across the whole bed.
fn sensors(scenario: &Scenario, length: f64, width: f64) -> (Vec<(String, f64)>, Vec<Place>) {
    let track = &scenario.track;
    let top = track.sections[0].layers.first().map_or(0.0, |layer| layer.thickness.at(track.sections[0].start));
    let (mut names, mut places) = (Vec::new(), Vec::new());
    for record in &scenario.volumes {
        for seat in record.seats.iter().map(|seat| &track.seats[*seat]) {
            let depth = record.depth.unwrap_or(top / 2.0);
            let half = seat.sleeper.map_or(0.0, |sleeper| sleeper.seat_distance / 2.0);
            let y = if scenario.solve.grains.both_rails { width / 2.0 + half } else { half };
            let reach = match record.volume {
                Volume::Sphere { radius } => radius,
                Volume::Box { .. } => 0.0,
            };
            let y = y.min(width - reach).max(reach.min(width / 2.0));
            let x = seat.x - track.sections[0].start;
            names.push((format!("{} at {} mm", track.seat_name(seat), (depth * 1e3).round()), seat.x));
            places.push(Place { at: [x, y, depth], volume: record.volume, length, width });
        }
    }
    (names, places)
}
