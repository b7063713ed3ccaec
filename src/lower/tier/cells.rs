//! Tier `cells`: a periodic cell of grains for each distinct sleeper.
//!
//! Two sleepers are alike if they are built alike, lie on the same layers and settle by about the same amount under the
//! law. One cell gives the results of all alike sleepers.

use super::grains::{ADDED, DAMPING_TIME, READS, headway, standing, train_by_train};
use super::rig::cost::{PassingCells, blocks_of, cells_under_track, of_packings, trains_of_cells};
use super::{Proposal, Tier, edges, refused, waiting};
use crate::diag::{Diagnostic, Severity};
use crate::graph::{
    BedPlan, CellPlan, CellsNode, ExpectedError, Model, Node, Schedule, SeatOnCell, SleeperOnGrains, seats_alike,
};
use crate::lower::bays;
use crate::lower::bed::{self, BedUse, beds, beds_of_spheres};
use crate::lower::cost::{bytes_of_forces, bytes_of_track};
use crate::lower::foundation::Foundations;
use crate::lower::{Draft, crib, glue, track};
use crate::scenario::{self, Base, Given, Layer, Loading, Origin, Scenario, Seat, Stack, Track};
use crate::schema::Reads;
use crate::solvers::foundation::{self, Method};

pub struct Cells;

/// Fields of the cells themselves.
pub(super) const CELLS: Reads = Reads {
    fields: &["solve.cell_bays"],
    acts_where: "where cells of grains carry sleepers or check a law: `substructure = cells`, `check_cells`",
};

/// Young's modulus of grains for the stiffness of the soil below them alone, Pa.
const UNYIELDING: f64 = 1e15;
/// Length of track beside a transition in which each sleeper has its own cell if no law runs, m.
const NEAR: f64 = 10.0;

/// Length of rail over which a wheel acts on seats, m: three decay lengths of the deflection.
const REACH: f64 = 6.0;
/// Distance from the median / range of a group, within which a settlement counts as the median.
const NEARLY: f64 = 0.1;

/// Cells that part from others at a transition during a run, for the estimate: one in `transition_full.track`.
const PARTED: usize = 1;

/// Largest error of cells of two bays / largest settlement of the whole bed, of any sleeper in eight scenes of coarse
/// grains (docs/validation.md, "Expected errors on grains").
pub(super) const OF_CELLS: f64 = 0.42;
/// Error by trains that are left out and by sleepers that share a cell / largest settlement, if the scene leaves it to
/// the planner. Beside [`OF_CELLS`] it raises the whole error by 1 %, and the run takes half of the time of 5 %.
const BESIDE_CELLS: f64 = 0.1;

impl Tier for Cells {
    fn name(&self) -> &'static str {
        "cells"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&track::READS, &bed::READS, &READS, &CELLS, &bays::READS]
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        let scenario = draft.scenario;
        if !scenario.track.has_rails() {
            return Err("there are no rails".into());
        }
        let (Some(Loading::Traffic(_)), Some(blocks)) = (&scenario.loading, &draft.blocks) else {
            return Err("no train runs, and cells settle only under trains".into());
        };
        // grains take hours and clumps take time to make: only for scenes that ask for them by name
        let asked = scenario.solve.grains.tier.has_grains();
        let found = if asked { beds(scenario, BedUse::Track) } else { beds_of_spheres(scenario, BedUse::Track) };
        let (beds, mut refusals): (_, Vec<Diagnostic>) = match found {
            Ok(beds) if beds.is_empty() => return Err("no section has a layer of grains".into()),
            Ok(beds) => (beds, Vec::new()),
            // a bed that cannot be packed is only a reason against the run, as with E0604
            Err(refusals) => {
                (Vec::new(), refusals.into_iter().map(|refusal| refusal.severity(Severity::Warning)).collect())
            }
        };
        let blocks = train_by_train(blocks);
        let (train, _) = blocks.kind(0);
        let headway_time = headway(scenario).map(|headway| headway / train.speed);
        let (cells, cell_of) = if beds.is_empty() { Default::default() } else { cells(draft, &beds) };
        let passing = PassingCells {
            cells: cells.len() + PARTED * scenario.track.transitions.len(),
            kinds: kinds(&cells),
            bays: f64::from(scenario.solve.grains.cell_bays),
            headway_time,
            alone: train.wheel_base() / train.speed,
            trains: trains_of_cells(&blocks, blocks_of(&blocks), left_open(scenario)),
            bytes_of_forces: bytes_of_forces(scenario.track.seats.len(), blocks.kind(0)),
        };
        let track = track::track(draft);
        let mut cost = of_packings(scenario, cells_under_track(draft, passing));
        cost.bytes += bytes_of_track(&track);
        refusals.extend(match asked {
            true => refused::of_cells(scenario),
            false => waiting::refusal(scenario).into_iter().collect(),
        });
        let what = match cells.len() {
            0 => "a cell of grains for each distinct sleeper".to_owned(),
            count => format!("a cell of grains for each of {count} distinct sleepers"),
        };
        let node = node(draft, beds, (cells, cell_of), headway_time);
        let nodes = vec![Node::new("track", Model::Track(Box::new(track))), Node::new("grains", Model::Cells(node))];
        Ok(Proposal {
            edges: edges(&nodes),
            nodes,
            schedule: Schedule::Blocks(Box::new(blocks)),
            cost,
            what,
            why: "the scene asks for grains".into(),
            error: ExpectedError {
                numerical: Some(left_open(scenario)),
                of_tier: Some(OF_CELLS),
                evidence:
                    "neither rail nor grains connect the cells: on three packings of the shortened scene they settle \
                           by 6 to 11 % less than the whole bed in the far field, and by 3 to 15 % less beside the \
                           structure; in eight scenes of grains of 45 mm and more the worst sleeper is 21 to 43 % off"
                        .into(),
            },
            runs: asked && refusals.is_empty(),
            refusals,
        })
    }
}

/// Error that trains left out and sleepers that share a cell may add / largest settlement. A scene that names its tier
/// may state it as `tolerance`. Where `auto` has taken cells, the `tolerance` is for the whole error.
pub(super) fn left_open(scenario: &Scenario) -> f64 {
    let grains = &scenario.solve.grains;
    let (tolerance, chosen) = (*grains.tolerance, grains.tier.origin == Origin::Derived);
    let is_stated = grains.tolerance.origin != Origin::Default;
    match *grains.tier {
        scenario::Tier::Cells if is_stated && chosen => {
            // a little less, so that both parts together do not exceed the tolerance by rounding
            let left = 0.999 * (tolerance * tolerance - OF_CELLS * OF_CELLS).max(0.0).sqrt();
            // without this part the tolerance is exceeded too
            if left > 0.0 { left.min(BESIDE_CELLS) } else { BESIDE_CELLS }
        }
        scenario::Tier::Cells if is_stated => tolerance,
        scenario::Tier::Cells => BESIDE_CELLS,
        // cells that check a law
        _ if chosen => BESIDE_CELLS,
        _ => tolerance,
    }
}

/// Number of cells that are built differently.
pub(super) fn kinds(cells: &[CellPlan]) -> usize {
    let is_first = |number: &usize| !cells[..*number].iter().any(|other| other.is_built_alike(&cells[*number]));
    (0..cells.len()).filter(is_first).count()
}

/// The node of some cells, each for the seats that `cell_of` names.
pub(super) fn node(
    draft: &Draft<'_>,
    beds: Vec<BedPlan>,
    (cells, cell_of): (Vec<CellPlan>, Vec<Option<usize>>),
    headway_time: Option<f64>,
) -> CellsNode {
    let scenario = draft.scenario;
    CellsNode {
        beds,
        cells,
        seats: cell_of.iter().enumerate().map(|(seat, cell)| cell.map(|_| on_cell(draft, seat))).collect(),
        cell_of,
        settlement: scenario.track.seats.iter().map(|seat| *seat.initial_settlement).collect(),
        headway_time,
        damping_time: DAMPING_TIME,
        gravity: *scenario.solve.gravity,
        time_step: scenario.solve.grains.step.map(|step| *step),
        added_inertia: ADDED,
        tolerance: left_open(scenario),
        trains: draft.blocks.as_ref().map_or(0, |blocks| blocks.sequence.within(blocks.total)),
    }
}

/// The cells, and for every seat the index of its cell.
fn cells(draft: &Draft<'_>, beds: &[BedPlan]) -> (Vec<CellPlan>, Vec<Option<usize>>) {
    let scenario = draft.scenario;
    let mut groups: Vec<(CellPlan, Vec<usize>)> = Vec::new();
    let mut kinds: Vec<(CellPlan, Vec<usize>)> = Vec::new();
    let plans = (0..scenario.track.seats.len()).filter_map(|seat| Some((seat, plan(scenario, beds, seat)?)));
    for (seat, plan) in plans {
        match kinds.iter_mut().find(|(kind, _)| is_alike(kind, &plan)) {
            Some((_, seats)) => seats.push(seat),
            None => kinds.push((plan, vec![seat])),
        }
    }
    for (_, seats) in kinds {
        for group in settling_alike(draft, seats) {
            let plan = plan(scenario, beds, typical(draft, &group));
            let seats = group.into_iter().map(|(_, seat)| seat).collect();
            groups.extend(plan.map(|plan| (plan, seats)));
        }
    }
    groups.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x));
    let mut cell_of = vec![None; scenario.track.seats.len()];
    for (number, (_, seats)) in groups.iter().enumerate() {
        seats.iter().for_each(|seat| cell_of[*seat] = Some(number));
    }
    (groups.into_iter().map(|(plan, _)| plan).collect(), cell_of)
}

/// Whether two sleepers are built alike on the same ground.
fn is_alike(a: &CellPlan, b: &CellPlan) -> bool {
    let anywhere = |plan: &CellPlan| {
        let mut plan = CellPlan { x: 0.0, ..plan.clone() };
        plan.sleepers.iter_mut().for_each(|sleeper| sleeper.seat = 0);
        plan
    };
    anywhere(a) == anywhere(b)
}

/// Groups of seats that settle by about the same amount under the law, each seat with its settlement, in ascending
/// order.
fn settling_alike(draft: &Draft<'_>, seats: Vec<usize>) -> Vec<Vec<(f64, usize)>> {
    let width = by_law(draft).map_or(0.0, |settlement| {
        let largest = settlement.iter().fold(0.0, |most: f64, settlement| most.max(settlement.abs()));
        2.0 * left_open(draft.scenario) * largest
    });
    seats_alike(seats.into_iter().map(|seat| (measure(draft, seat), seat)).collect(), width)
}

/// Settlement of every seat by the law, if it ran, m.
fn by_law<'a>(draft: &Draft<'a>) -> Option<&'a [f64]> {
    draft.by_law.filter(|settlement| settlement.len() == draft.scenario.track.seats.len())
}

/// Settlement of a seat by the law, m. If no law ran, minus the distance to the nearest transition takes its place.
pub(super) fn measure(draft: &Draft<'_>, seat: usize) -> f64 {
    let track = &draft.scenario.track;
    let away = |x: f64| (track.seats[seat].x - x).abs();
    let beside = || -track.transitions.iter().map(|t| away(t.x)).fold(NEAR, f64::min);
    by_law(draft).map_or_else(beside, |settlement| settlement[seat])
}

/// The seat whose cell is used for a group: the middle one of the seats that every wheel passes and whose settlement is
/// near the median.
fn typical(draft: &Draft<'_>, group: &[(f64, usize)]) -> usize {
    let passed: Vec<(f64, usize)> =
        group.iter().filter(|(_, seat)| every_wheel_passes(draft, *seat)).copied().collect();
    let group = if passed.is_empty() { group } else { &passed };
    let (median, _) = group[group.len() / 2];
    let width = group[group.len() - 1].0 - group[0].0;
    let near = group.iter().filter(|(settlement, _)| (settlement - median).abs() <= NEARLY * width);
    let mut near: Vec<usize> = near.map(|(_, seat)| *seat).collect();
    near.sort_unstable();
    near[near.len() / 2]
}

/// Whether every wheel starts far before a seat and stops far behind it.
pub(super) fn every_wheel_passes(draft: &Draft<'_>, seat: usize) -> bool {
    let (Some(passage), Some(blocks)) = (draft.passages.first(), &draft.blocks) else { return true };
    let away = blocks.kind(0).0.wheel_base() + REACH;
    (passage.left + away..=passage.right - away).contains(&draft.scenario.track.seats[seat].x)
}

/// Data that the cell of a seat takes from the track.
fn on_cell(draft: &Draft<'_>, seat: usize) -> SeatOnCell {
    let scenario = draft.scenario;
    SeatOnCell {
        x: scenario.track.seats[seat].x,
        loaded_by: around(scenario, seat, scenario.solve.grains.cell_bays),
        passed: every_wheel_passes(draft, seat),
    }
}

/// A cell with the sleeper of a seat in its middle; `None` for a seat without grains.
pub(super) fn plan(scenario: &Scenario, beds: &[BedPlan], seat: usize) -> Option<CellPlan> {
    let track = &scenario.track;
    let here = track.seats.get(seat).filter(|seat| seat.is_ballasted())?;
    let section = &track.sections[here.section];
    let bed = beds.iter().position(|bed| bed.section == section.name)?;
    let [length, _] = beds[bed].numbers().plan;
    let copies = scenario.solve.grains.cell_bays;
    let phase = phase(track, here, length);
    let sleepers: Vec<SleeperOnGrains> = around(scenario, seat, copies)
        .into_iter()
        .enumerate()
        .filter_map(|(bay, seat)| {
            let standing = standing(scenario, seat, &track.seats[seat], 0.0)?;
            Some(SleeperOnGrains { place: [(bay as f64 + phase) * length, 0.0], pitch: None, ..standing })
        })
        .collect();
    (sleepers.len() == copies as usize).then(|| CellPlan {
        bed,
        x: here.x,
        copies,
        middle: (copies as usize - 1) / 2,
        sleepers,
        soil: soil(scenario, seat),
        crib: crib::planned(section),
        glued: glue::at_place(scenario, here.section, here.x),
    })
}

/// Place of a seat in its cell / length of the cell: where it stands in the cells of a whole bed, which begin at the
/// structure. It is rounded to a quarter: equal cells are built once.
fn phase(track: &Track, seat: &Seat, length: f64) -> f64 {
    let section = &track.sections[seat.section];
    let structure_at_left = track.sections.first().is_some_and(|first| first.start < section.start);
    let from = if structure_at_left { section.start } else { section.end };
    (4.0 * (seat.x - from) / length).round().rem_euclid(4.0) / 4.0
}

/// The seats of the bays of a cell around its middle seat. At the end of the section the other neighbour is used
/// instead.
fn around(scenario: &Scenario, seat: usize, copies: u32) -> Vec<usize> {
    let seats = &scenario.track.seats;
    let section = seats[seat].section;
    let beside = |seat: Option<usize>| {
        seat.filter(|seat| seats.get(*seat).is_some_and(|seat| seat.section == section && seat.is_ballasted()))
    };
    let (before, behind) = (beside(seat.checked_sub(1)), beside(seat.checked_add(1)));
    let left = before.or(behind).unwrap_or(seat);
    let right = behind.or(before).unwrap_or(seat);
    match copies {
        1 => vec![seat],
        2 => vec![seat, right],
        _ => vec![left, seat, right],
    }
}

/// Stiffness of the soil alone under a seat, N/m, by the stress cone; `None` without soil.
fn soil(scenario: &Scenario, seat: usize) -> Option<f64> {
    let track = &scenario.track;
    let here = &track.seats[seat];
    let parts = track.ground(here.section);
    let part = parts.iter().find(|part| (part.start..=part.end).contains(&here.x))?;
    part.layers.iter().find(|layer| layer.soil().is_some())?;
    let stack = Stack {
        bearing: here.sleeper?.bearing([track.bay(seat); 2]),
        layers: part.layers.iter().map(|layer| below_grains(layer, here.x)).collect::<Option<_>>()?,
        plate: part.approach_slab.map(|plate| (plate, plate.lever(here.x))),
        before: None,
        damping_time: Given::derived(DAMPING_TIME),
        span: track.sections[here.section].layers_span?,
    };
    let mut foundations = Foundations::new(Method::StressCone, track.bed.base == Base::Quiet);
    let carried = foundations.carried(&[&stack]).pop()?;
    carried.ok().map(|carried| carried.stiffness)
}

/// A layer of soil, or a layer of grains with an unyielding modulus.
fn below_grains(layer: &Layer, x: f64) -> Option<foundation::Layer> {
    let (poisson_ratio, density, spread) = match (layer.granular(), layer.soil()) {
        (Some(grains), _) => (*grains.poisson_ratio, *grains.density, *grains.spread),
        (_, Some(soil)) => (*soil.poisson_ratio, *soil.density, *soil.spread),
        _ => return None,
    };
    let youngs_modulus = match layer.granular() {
        Some(_) => UNYIELDING,
        None => layer.youngs_modulus()?.value_at(x),
    };
    Some(foundation::Layer {
        thickness: layer.thickness.value_at(x).max(0.0),
        youngs_modulus,
        poisson_ratio,
        density,
        spread,
    })
}
