//! A test rig: sleepers, or a plate, on a packed bed under actuators.

pub(super) mod cost;
mod refusals;

use super::{Proposal, Tier, edges};
use crate::graph::{
    ActuatorsNode, BedNode, ExpectedError, Model, Node, Schedule, SensorNode, SensorVolume, StandingBody, Tests,
};
use crate::lower::bed::{self, BedUse, beds, confinement};
use crate::lower::blocks::COUNTS;
use crate::lower::{Draft, crib, glue};
use crate::scenario::{
    Foot, Force, Given, Loading, Repeats, RigLoad, Scenario, Seat, Section, SleeperBody, Target, Volume,
};
use crate::schema::Reads;
use crate::solvers::granular::packing::{GrainLayer, Recipe};
use crate::solvers::granular::rig::{ADDED, Load};
use crate::units::number;
use std::f64::consts::PI;

/// Name of a plate, and its mass over its area: 20 mm of steel, kg/m2; height, m.
const PLATE: &str = "plate";
const PLATE_MASS: f64 = 157.0;
const PLATE_HEIGHT: f64 = 0.02;
/// Width of the plate / width of a specimen, which may bulge under the plate.
const WIDER: f64 = 2.0;
/// Largest inertial number of quasi-static flow of grains (GDR MiDi 2004); it limits the speed of a driven plate.
const INERTIAL: f64 = 1e-3;
/// Time in which a constant force grows and is held, s.
const HELD: f64 = 0.5;

pub struct TestRig;

/// Fields of the test itself.
const READS: Reads = Reads { fields: &["load.total", "sleeper.mass"], acts_where: "where a test rig is loaded" };

impl Tier for TestRig {
    fn name(&self) -> &'static str {
        "rig"
    }

    /// A bed under actuators is the same for every tier of grains.
    fn answers(&self, word: &str) -> bool {
        ["cells", "zone", "full"].contains(&word)
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&bed::READS, &bed::VOLUMES, &COUNTS, &READS]
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        let scenario = draft.scenario;
        if !stands_on_its_bed(scenario) {
            return Err("no loads act on sleepers or on a bed without rails".into());
        }
        let mut refusals = refusals::refusals(scenario);
        let nodes = match beds(scenario, BedUse::Rig) {
            Ok(beds) => beds.into_iter().next().map_or(Vec::new(), |bed| self.nodes(scenario, bed)),
            Err(more) => {
                refusals.extend(more);
                Vec::new()
            }
        };
        let bed = nodes.iter().find_map(|node| if let Model::Bed(bed) = &node.model { Some(&**bed) } else { None });
        let cost = cost::of_rig(scenario, bed);
        let kept = kept(scenario, cycles(&loads(scenario)));
        let Repeats { least, most: packings } = scenario.solve.grains.repeats;
        let tests = Tests { first: 0, packings, least, kept };
        Ok(Proposal {
            edges: edges(&nodes),
            nodes,
            schedule: Schedule::Actuators(tests),
            cost,
            what: "a bed of grains under actuators".into(),
            why: "loads act on sleepers or on a bed, and there are no rails".into(),
            error: ExpectedError::default(),
            runs: refusals.is_empty(),
            refusals,
        })
    }
}

impl TestRig {
    fn nodes(&self, scenario: &Scenario, mut bed: crate::graph::BedPlan) -> Vec<Node> {
        let confinement = confinement(scenario);
        let crib = crib::note(&scenario.track.sections[0]);
        bed.notes.push(match confinement {
            Some(pressure) => {
                format!("Its four sides move under a constant pressure of {} kPa.", number(pressure / 1e3))
            }
            None if crib.is_some() => "The bed is periodic along the track.".into(),
            None => "The bed is periodic along the track; there are no grains beside or between the sleepers.".into(),
        });
        bed.notes.extend(crib);
        let loads = loads(scenario);
        let rest = rest_time(rests(bed.numbers(), confinement));
        bed.notes.extend(driven(&loads, rest));
        let section = &scenario.track.sections[0];
        let [cell, across] = bed.numbers().plan;
        let copies = ((section.end - section.start) / cell - 1e-9).ceil().max(1.0) as u32;
        let length = cell * f64::from(copies);
        let pressed = loads.iter().find(|load| load.on == Target::Bed);
        let (bodies, forces): (Vec<StandingBody>, Vec<Load>) = match pressed {
            Some(load) => vec![plate(scenario, load, [length, across])].into_iter().unzip(),
            None => scenario.track.seats.iter().filter_map(|seat| sleeper(scenario, seat, &loads, across)).unzip(),
        };
        let node = BedNode {
            bed,
            copies,
            bodies,
            plate: pressed.map(|_| length * across),
            crib: crib::planned(section),
            glued: glue::at_place(scenario, 0, 0.5 * (section.start + section.end)),
            confinement,
            driven: forces.iter().any(|load| matches!(load, Load::Strain(_))),
            gravity: *scenario.solve.gravity,
            sensors: sensors(scenario, length, across),
            added_inertia: ADDED,
        };
        let actuators = ActuatorsNode { loads: forces, period: period(&loads, rest), cycles: cycles(&loads) };
        vec![Node::new("actuators", Model::Actuators(actuators)), Node::new("bed", Model::Bed(Box::new(node)))]
    }
}

/// Mean volume, density and pressure of each layer.
fn rests(recipe: &Recipe, confinement: Option<f64>) -> impl Iterator<Item = [f64; 3]> {
    let of =
        move |layer: &GrainLayer| [layer.curve.mean_volume(), layer.density, confinement.unwrap_or(layer.pressure)];
    recipe.layers.iter().map(of)
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

/// All loads, including constant loads.
pub(super) fn loads(scenario: &Scenario) -> Vec<RigLoad> {
    match &scenario.loading {
        Some(Loading::Rig(loads)) => loads.clone(),
        Some(Loading::Static(loads)) => loads
            .iter()
            .map(|load| RigLoad {
                name: load.name.clone(),
                span: load.span,
                on: load.on,
                x: load.x,
                force: Force::Constant(load.force),
                confinement: None,
                speed: Given::derived(0.0),
                cycles: 1,
                changes: None,
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Period of a cycle, s; `rest` is the [`rest_time`] of the bed.
fn period(loads: &[RigLoad], rest: f64) -> f64 {
    let of = |load: &RigLoad| match &load.force {
        Force::Constant(_) => None,
        Force::Cyclic { frequency, .. } => Some(1.0 / **frequency),
        Force::History(points) => Some(points.last()?[0] - points.first()?[0]),
        Force::Strain(strain) => Some(**strain * rest / INERTIAL),
    };
    loads.iter().find_map(of).unwrap_or(HELD)
}

/// Time in which a pressure moves a grain by its own size, d sqrt(rho / p), s: the largest value of layers with a mean
/// volume, density and pressure.
fn rest_time(layers: impl Iterator<Item = [f64; 3]>) -> f64 {
    let of = |[volume, density, pressure]: [f64; 3]| (6.0 * volume / PI).cbrt() * (density / pressure).sqrt();
    layers.map(of).fold(0.0, f64::max)
}

/// Speed of a driven plate and its reason, for people.
fn driven(loads: &[RigLoad], rest: f64) -> Option<String> {
    let strain = loads.iter().any(|load| matches!(load.force, Force::Strain(_)));
    let rate = format!("{:.1}", 100.0 * INERTIAL / rest);
    strain.then(|| {
        format!(
            "The plate compresses the bed by {rate} % per second: quasi-static, with an inertial number of {INERTIAL}."
        )
    })
}

fn cycles(loads: &[RigLoad]) -> u64 {
    let of = |load: &RigLoad| matches!(load.force, Force::Cyclic { .. }).then_some(load.cycles);
    loads.iter().filter_map(of).max().unwrap_or(1)
}

/// Cycles whose loops and sensor readings are kept: the recorded cycles, the first and the last.
fn kept(scenario: &Scenario, cycles: u64) -> Vec<u64> {
    let asked = scenario.records.iter().flat_map(|record| &record.after);
    let asked = asked.chain(scenario.volumes.iter().flat_map(|record| &record.after)).copied();
    let mut kept: Vec<u64> = asked.filter(|count| (1..=cycles).contains(count)).chain([1, cycles]).collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The load that acts on a seat, either at a fixed place or moving over the seat.
fn load_at<'a>(seat: &Seat, loads: &'a [RigLoad]) -> Option<&'a RigLoad> {
    loads.iter().find(|load| acts_on(load, seat))
}

fn acts_on(load: &RigLoad, seat: &Seat) -> bool {
    let away = seat.x - load.x;
    away.abs() < 1e-6 || *load.speed > 0.0 && away > 0.0
}

/// A sleeper, and the force of its actuator, of one rail or of both.
fn sleeper(scenario: &Scenario, seat: &Seat, loads: &[RigLoad], across: f64) -> Option<(StandingBody, Load)> {
    let Foot::Sleeper { mass, .. } = &seat.foot else { return None };
    let SleeperBody { length, base_width, height, base_area, .. } = seat.sleeper?;
    let (share, y) = if scenario.solve.grains.both_rails { (2.0, across / 2.0) } else { (1.0, 0.0) };
    let load = load_at(seat, loads).map_or(Load::None, |load| force(load, share, seat.x - load.x));
    let start = scenario.track.sections[0].start;
    let body = StandingBody {
        name: scenario.track.seat_name(seat),
        x: seat.x,
        place: [seat.x - start, y],
        // the bearing area is as wide as the sleeper and at most as long
        size: [base_width, (base_area / base_width).min(length), height],
        mass: share * **mass,
    };
    Some((body, load))
}

/// A plate over the whole bed.
fn plate(scenario: &Scenario, load: &RigLoad, [length, across]: [f64; 2]) -> (StandingBody, Load) {
    let share = if scenario.solve.grains.both_rails { 2.0 } else { 1.0 };
    let wider = if load.confinement.is_some() { WIDER } else { 1.0 };
    let body = StandingBody {
        name: PLATE.to_owned(),
        x: scenario.track.sections[0].start + length / 2.0,
        place: [length / 2.0, across / 2.0],
        size: [wider * length, wider * across, PLATE_HEIGHT],
        mass: PLATE_MASS * length * across,
    };
    (body, force(load, share, 0.0))
}

/// Force of an actuator for `share` of one rail, `away` m behind the place of its load.
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

/// Sensors under the rail seat, or across the whole bed.
fn sensors(scenario: &Scenario, length: f64, width: f64) -> Vec<SensorNode> {
    let track = &scenario.track;
    let top = track.sections[0].layers.first().map_or(0.0, |layer| layer.thickness.value_at(track.sections[0].start));
    let mut sensors = Vec::new();
    for record in &scenario.volumes {
        for seat in record.seats.iter().map(|seat| &track.seats[*seat]) {
            let depth = record.depth.unwrap_or(top / 2.0);
            let half = seat.sleeper.map_or(0.0, |sleeper| sleeper.seat_distance / 2.0);
            let y = if scenario.solve.grains.both_rails { width / 2.0 + half } else { half };
            let (reach, volume) = match record.volume {
                Volume::Sphere { radius } => (radius, SensorVolume::Sphere { radius }),
                Volume::Box { along, across, height } => (0.0, SensorVolume::Block { along, across, height }),
            };
            let y = y.min(width - reach).max(reach.min(width / 2.0));
            let x = seat.x - track.sections[0].start;
            sensors.push(SensorNode {
                name: format!("{} at {} mm", track.seat_name(seat), (depth * 1e3).round()),
                x: seat.x,
                place: [x, y, depth],
                volume,
                bed: [length, width],
            });
        }
    }
    sensors
}
