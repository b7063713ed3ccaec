//! Cost of a test rig, estimated without packing it: number of grains from the gradings, time steps from the lightest
//! grain.

use super::{cycles, loads, period, rest_time};
use crate::graph::{BedNode, BlockWeight, Blocks, Cost, Passing, TestWork, Work};
use crate::lower::bed::{confinement, width};
use crate::lower::{Draft, crib};
use crate::scenario::{Contact, Granular, Repeats, Scenario, Section, Shape};
use crate::solvers::granular::grains::Curve;
use crate::solvers::granular::packing::lifts_that_fit;
use crate::solvers::granular::rig::SOLID as POURED;
use std::f64::consts::PI;

/// Share of the volume that grains fill in a packed bed.
const SOLID: f64 = 0.6;
/// Time step of a test and of packing / sqrt(m / k) of the lightest grain; packing damps light grains.
const STEP: f64 = 0.1;
const PACKING_STEP: f64 = 0.25;
/// Time of a packing stage, s; number of stages in addition to the lifts; time of setting down the sleepers, s, at
/// twice the step.
const STAGE: f64 = 0.45;
const LAST_STAGES: u32 = 3;
const SET_DOWN: f64 = 0.15;
/// Time in which the grains of cribs are poured and come to rest, s, at the step of a test.
const POURING: f64 = 1.0;
/// Pebble steps per second on two cores, during packing and during a test (`benches/estimates.py`).
const PEBBLE_STEPS: [f64; 2] = [16e6, 55e6];
/// Time on one core / time on two cores.
const SECOND_CORE: f64 = 1.7;

/// Bytes per pebble, with its contacts, their histories, and its copy in a checkpoint (16 bays of the bed of the paper
/// hold 154,000 pebbles in 726 MB).
const BYTES: f64 = 4_700.0;

/// The grains on a plan area of a section.
struct Filling {
    grains: f64,
    pebbles: f64,
    lifts: u32,
    /// sqrt(m / k) of the lightest grain on one contact, s.
    light: f64,
    /// See [`rest_time`], s.
    rest: f64,
}

/// The grains on `area` (m2) of a section; layers whose grading is not a valid curve are left out.
fn filling(scenario: &Scenario, section: &Section, area: f64) -> Filling {
    let materials: Vec<(f64, &Granular, Curve)> = section
        .layers
        .iter()
        .filter_map(|layer| {
            let granular = layer.granular()?;
            Some((layer.thickness.value_at(section.start), granular, granular.grading.curve().ok()?))
        })
        .collect();
    let pressure = |granular: &Granular| confinement(scenario).unwrap_or(*granular.packing.pressure);
    let of =
        |(_, granular, curve): &(f64, &Granular, Curve)| [curve.mean_volume(), *granular.density, pressure(granular)];
    let rest = rest_time(materials.iter().map(of));
    let mut filling = Filling { grains: 0.0, pebbles: 0.0, lifts: 0, light: f64::INFINITY, rest };
    for (thickness, granular, curve) in &materials {
        let count = SOLID * area * thickness / curve.mean_volume();
        filling.grains += count;
        filling.pebbles += count * pebbles_of(&granular.shape);
        filling.lifts += lifts_that_fit(granular.packing.lifts, *thickness, curve);
        filling.light = filling.light.min(lightest(granular, curve));
    }
    filling
}

/// Grains and pebbles of the top layer of a section in a space beside its sleepers, m3.
fn beside(section: &Section, space: f64) -> [f64; 2] {
    let top = section.layers.iter().find_map(|layer| layer.granular());
    let Some((top, curve)) = top.and_then(|top| Some((top, top.grading.curve().ok()?))) else { return [0.0; 2] };
    let grains = POURED * space / curve.mean_volume();
    [grains, grains * pebbles_of(&top.shape)]
}

/// The estimate for a test rig, within a factor of two. A rig without a bed is refused and has no cost.
pub(super) fn of_rig(scenario: &Scenario, bed: Option<&BedNode>) -> Cost {
    let Some(bed) = bed else { return cost(0.0, TestWork::default()) };
    let section = &scenario.track.sections[0];
    let [length, width] = bed.bed.numbers().plan;
    let copies = f64::from(bed.copies);
    let Filling { grains, pebbles, lifts, light, rest } = filling(scenario, section, length * width);
    let rails = if scenario.solve.grains.both_rails { 2.0 } else { 1.0 };
    let [beside_grains, beside_pebbles] = beside(section, rails * crib::space(scenario, 0, copies * length));
    let step = scenario.solve.grains.step.map_or(STEP * light, |step| *step);
    let packing_steps = STAGE * f64::from(lifts + LAST_STAGES) / (PACKING_STEP * light);
    let loads = loads(scenario);
    let pouring = if bed.crib.is_some() { POURING } else { 0.0 };
    let test_steps = (SET_DOWN + pouring + (0.5 + cycles(&loads) as f64) * period(&loads, rest)) / step;
    let Repeats { least: least_packings, most: packings } = scenario.solve.grains.repeats;
    // during packing half of the bed is present on average
    let [packing, testing] = [0.5 * packing_steps, copies * test_steps];
    let steps_beside = beside_pebbles * test_steps / PEBBLE_STEPS[1];
    let seconds =
        f64::from(packings) * (pebbles * (packing / PEBBLE_STEPS[0] + testing / PEBBLE_STEPS[1]) + steps_beside);
    let making = f64::from(packings) * pebbles * packing / PEBBLE_STEPS[0];
    let (grains, pebbles) = (copies * grains + beside_grains, copies * pebbles + beside_pebbles);
    let work =
        TestWork { grains, pebbles, time_step: step, packing_steps, making, test_steps, packings, least_packings };
    cost(seconds, work)
}

fn cost(seconds: f64, work: TestWork) -> Cost {
    Cost {
        seconds: SECOND_CORE * seconds,
        seconds_on_two_cores: seconds,
        bytes: (BYTES * work.pebbles) as u64,
        work: Work::Tests(work),
    }
}

/// Time step of grains under a track / sqrt(m / k) of the lightest grain; pebble steps per second on two cores, with
/// soil and rail (`docs/validation.md`, a track on grains).
const TRACK_STEP: f64 = 0.48;
const TRACK_PEBBLE_STEPS: f64 = 20e6;
/// Time of the stages of building, s.
const BUILDING: f64 = 0.7;

/// The estimate for grains under a length of track, within a factor of two: every train runs over the grains in their
/// time step.
pub(in crate::lower::tier) fn grains_under_track(draft: &Draft<'_>, blocks: Option<&Blocks>, passing: Passing) -> Cost {
    let length = passing.length;
    let scenario = draft.scenario;
    let sections = scenario.track.sections.iter().enumerate().filter(|(_, section)| super::has_grains(section));
    let Some((number, section)) = sections.max_by(|(_, a), (_, b)| (a.end - a.start).total_cmp(&(b.end - b.start)))
    else {
        return cost(0.0, TestWork::default());
    };
    let Filling { grains, pebbles, lifts, light, .. } = filling(scenario, section, length * width(scenario, number));
    let cell = filling(scenario, section, *section.spacing * width(scenario, number)).pebbles;
    let [beside_grains, beside_pebbles] = beside(section, crib::space(scenario, number, length));
    let (grains, pebbles) = (grains + beside_grains, pebbles + beside_pebbles);
    let time_step = scenario.solve.grains.step.map_or(TRACK_STEP * light, |step| *step);
    let packing_steps = STAGE * f64::from(lifts + LAST_STAGES) / (PACKING_STEP * light);
    let building = BUILDING + if section.crib.is_some() { POURING } else { 0.0 };
    let passing = blocks.map_or(0.0, |blocks| passing.between(blocks, 0, blocks.total));
    let of_time = |time: f64| pebbles * time / time_step / TRACK_PEBBLE_STEPS;
    let making = 0.5 * cell * packing_steps / PEBBLE_STEPS[0] + of_time(building);
    let Repeats { least: least_packings, most: packings } = scenario.solve.grains.repeats;
    let test_steps = (building + passing) / time_step;
    let all = |seconds: f64| f64::from(packings) * seconds;
    let making = all(making);
    let work = TestWork { grains, pebbles, time_step, packing_steps, making, test_steps, packings, least_packings };
    cost(making + all(of_time(passing)), work)
}

/// Trains over cells of grains.
#[derive(Debug, Clone, Copy)]
pub(in crate::lower::tier) struct PassingCells {
    /// Number of cells, of those that are built differently, and of bays in a cell.
    pub cells: usize,
    pub kinds: usize,
    pub bays: f64,
    /// Time between the fronts of trains that follow each other, s; `None` if they run one by one.
    pub headway_time: Option<f64>,
    /// Time between the first and the last wheel of a train, s.
    pub alone: f64,
    /// Trains that each cell computes.
    pub trains: f64,
    /// Bytes of the forces that drive the cells.
    pub bytes_of_forces: u64,
}

/// Additional time of a train that runs alone, and of every train, s.
const BESIDE_ALONE: f64 = 0.1;
const BESIDE_EACH: f64 = 0.04;
/// Bytes per pebble of a cell: between cells that part during a run and cells that do not (`benches/grain_errors.py`).
const CELL_BYTES: f64 = 1_800.0;
/// Pebble steps per second of a cell on one core, and of building it on two (`benches/estimates.py`); time of a train
/// on a cell that has both cores / on one core.
const CELL_STEPS: f64 = 15e6;
const BUILT_STEPS: f64 = 30e6;
const ON_BOTH_CORES: f64 = 0.6;
/// Trains that a cell computes: the first trains, and a share of the others that is inversely proportional to the
/// tolerance, here for 10 %; at least one in each block. 500 axles on the paper's bed, which rises later, took 0.8; on
/// a tamped bed 0.4 (`docs/validation.md`, cells).
const FIRST_TRAINS: f64 = 4.0;
const OTHER_TRAINS: f64 = 0.65;
const OF_TOLERANCE: f64 = 0.1;

/// Trains that a cell computes of a run of so many blocks.
pub(in crate::lower::tier) fn trains_of_cells(plan: &Blocks, blocks: f64, tolerance: f64) -> f64 {
    let all = plan.total as f64 / plan.train.axles().max(1) as f64;
    let others = OTHER_TRAINS * OF_TOLERANCE / tolerance.max(OTHER_TRAINS * OF_TOLERANCE);
    all.min((FIRST_TRAINS + others * (all - FIRST_TRAINS).max(0.0)).max(blocks))
}

/// Blocks of a plan that are prescribed.
pub(in crate::lower::tier) fn blocks_of(plan: &Blocks) -> f64 {
    BlockWeight::Equal.between(plan, 0, plan.total)
}

/// The cost of all packings of a track, of the cost of one.
pub(in crate::lower::tier) fn of_packings(scenario: &Scenario, of_one: Cost) -> Cost {
    let Repeats { least: least_packings, most: packings } = scenario.solve.grains.repeats;
    match of_one.work {
        Work::Tests(work) => Cost {
            bytes: of_one.bytes,
            ..cost(
                f64::from(packings) * of_one.seconds_on_two_cores,
                TestWork { packings, least_packings, making: f64::from(packings) * work.making, ..work },
            )
        },
        Work::Passages(_) => of_one,
    }
}

/// The estimate for the cells of one packing, within a factor of three: the number of trains that a cell leaves out is
/// not known in advance.
pub(in crate::lower::tier) fn cells_under_track(draft: &Draft<'_>, passing: PassingCells) -> Cost {
    let scenario = draft.scenario;
    let sections = scenario.track.sections.iter().enumerate().filter(|(_, section)| super::has_grains(section));
    let Some((number, section)) = sections.max_by(|(_, a), (_, b)| (a.end - a.start).total_cmp(&(b.end - b.start)))
    else {
        return cost(0.0, TestWork::default());
    };
    let bay = *section.spacing;
    let Filling { grains, pebbles, lifts, light, .. } = filling(scenario, section, bay * width(scenario, number));
    let [beside_grains, beside_pebbles] = beside(section, crib::space(scenario, number, bay));
    let time_step = scenario.solve.grains.step.map_or(TRACK_STEP * light, |step| *step);
    let packing_steps = STAGE * f64::from(lifts + LAST_STAGES) / (PACKING_STEP * light);
    let building = BUILDING + if section.crib.is_some() { POURING } else { 0.0 };
    let train = BESIDE_EACH + passing.headway_time.unwrap_or(passing.alone + BESIDE_ALONE);
    let [cell_grains, cell_pebbles] =
        [grains + beside_grains, pebbles + beside_pebbles].map(|count| passing.bays * count);
    let [built, passed] = [building, passing.trains * train].map(|time| time / time_step);
    let packing = 0.5 * pebbles * packing_steps / PEBBLE_STEPS[0];
    let placing = passing.kinds as f64 * cell_pebbles * built / BUILT_STEPS;
    let turns = (passing.cells / 2) as f64 + (passing.cells % 2) as f64 * ON_BOTH_CORES;
    let making = packing + placing;
    let seconds = making + turns * cell_pebbles * passed / CELL_STEPS;
    let cells = passing.cells as f64;
    let test_steps = cells * (built + passed);
    let [grains, pebbles] = [cell_grains, cell_pebbles].map(|count| cells * count);
    let (packings, least_packings) = (1, 1);
    let work = TestWork { grains, pebbles, time_step, packing_steps, making, test_steps, packings, least_packings };
    Cost { bytes: passing.bytes_of_forces + (CELL_BYTES * pebbles) as u64, ..cost(seconds, work) }
}

fn pebbles_of(shape: &Shape) -> f64 {
    match shape {
        Shape::Clumps { pebbles: [fewest, most], .. } => f64::from(fewest + most) / 2.0,
        _ => 1.0,
    }
}

/// Pressure at which the stiffness of a Hertz contact is estimated, Pa: ballast under a wheel.
const HERTZ_PRESSURE: f64 = 2e5;

/// sqrt(m / k) of the lightest grain on one contact, s.
fn lightest(granular: &Granular, curve: &Curve) -> f64 {
    let mass = *granular.density * PI / 6.0 * curve.ends()[0].powi(3);
    let stiffness = match granular.contact {
        Contact::Linear { stiffness } => *stiffness * granular.shear_ratio.max(1.0),
        // k = (6 E*^2 R F)^(1/3) (Johnson 1985, 4.2); such beds are refused before the run, but their plan is shown
        Contact::Hertz { youngs_modulus, poisson_ratio } => {
            let effective = *youngs_modulus / (2.0 * (1.0 - *poisson_ratio * *poisson_ratio));
            let size = curve.ends()[0];
            (6.0 * effective * effective * (size / 4.0) * HERTZ_PRESSURE * size * size).cbrt()
        }
    };
    (mass / stiffness).sqrt()
}
