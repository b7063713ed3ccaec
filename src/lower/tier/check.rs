//! Cells of grains under some sleepers of tier `law`: while the law runs, their settlement is compared with it.

use super::cells;
use super::grains::{READS as GRAINS, headway};
use super::refused::{self, waits};
use super::rig::cost::{PassingCells, cells_under_track, trains_of_cells};
use crate::diag::{Diagnostic, Severity};
use crate::graph::{BedPlan, CellPlan, CellsNode, Cost, Model, Node};
use crate::lower::Draft;
use crate::lower::bed::{self, BedUse, beds};
use crate::lower::cost::bytes_of_forces;
use crate::scenario::Scenario;
use crate::schema::Reads;

/// Fields that act only where cells check a law.
pub(super) const READS: [&Reads; 3] = [&bed::READS, &GRAINS, &cells::CELLS];

/// Cells that check a law, with their cost and the reasons against running them.
pub(super) struct Check {
    pub node: Option<Node>,
    pub cost: Option<Cost>,
    pub refusals: Vec<Diagnostic>,
}

/// The cells of a scene that asks for them; `blocks` is the number of blocks by the law.
pub(super) fn check(draft: &Draft<'_>, blocks: u64) -> Check {
    let scenario = draft.scenario;
    let nothing = |refusals| Check { node: None, cost: None, refusals };
    let (count, Some(plan)) = (*scenario.solve.grains.check_cells, &draft.blocks) else { return nothing(Vec::new()) };
    if count == 0 {
        return nothing(Vec::new());
    }
    let beds = match beds(scenario, BedUse::Track) {
        Ok(beds) if beds.is_empty() => return nothing(vec![no_grains(scenario)]),
        Ok(beds) => beds,
        Err(refusals) => return nothing(refusals.into_iter().map(|it| it.severity(Severity::Warning)).collect()),
    };
    let refusals: Vec<Diagnostic> = refused::of_check(scenario);
    let node = node(draft, beds, count as usize);
    let (train, _) = plan.kind(0);
    let passing = PassingCells {
        cells: node.cells.len(),
        kinds: cells::kinds(&node.cells),
        bays: f64::from(scenario.solve.grains.cell_bays),
        headway_time: node.headway_time,
        alone: train.wheel_base() / train.speed,
        trains: trains_of_cells(plan, blocks as f64, cells::left_open(scenario)),
        bytes_of_forces: bytes_of_forces(scenario.track.seats.len(), plan.kind(0)),
    };
    let cost = cells_under_track(draft, passing);
    Check { node: Some(Node::new("check", Model::Check(node))), cost: Some(cost), refusals }
}

/// `, checked by cells of grains under 3 sleepers`
pub(super) fn told(node: &Node) -> String {
    let count = if let Model::Check(cells) = &node.model { cells.cells.len() } else { 0 };
    format!(", checked by cells of grains under {count} sleeper{}", if count == 1 { "" } else { "s" })
}

fn no_grains(scenario: &Scenario) -> Diagnostic {
    let message = "`check_cells` asks for cells of grains, and no section has a layer of grains".to_owned();
    waits(
        message,
        scenario.solve.grains.check_cells.origin.span(),
        "leave out `check_cells`, or give a trackform `layers` of a `granular`",
    )
}

/// A cell for each of `count` sleepers of every kind.
fn node(draft: &Draft<'_>, beds: Vec<BedPlan>, count: usize) -> CellsNode {
    let scenario = draft.scenario;
    let mut kinds: Vec<(CellPlan, Vec<usize>)> = Vec::new();
    let plans = (0..scenario.track.seats.len()).filter_map(|seat| Some((seat, cells::plan(scenario, &beds, seat)?)));
    for (seat, plan) in plans {
        match kinds.iter_mut().find(|(kind, _)| kind.is_built_alike(&plan)) {
            Some((_, seats)) => seats.push(seat),
            None => kinds.push((plan, vec![seat])),
        }
    }
    let mut seats: Vec<usize> = kinds.into_iter().flat_map(|(_, seats)| spread(draft, seats, count)).collect();
    seats.sort_unstable();
    let plans: Vec<CellPlan> = seats.iter().filter_map(|seat| cells::plan(scenario, &beds, *seat)).collect();
    let mut cell_of = vec![None; scenario.track.seats.len()];
    seats.iter().enumerate().for_each(|(cell, seat)| cell_of[*seat] = Some(cell));
    let headway_time = headway(scenario).zip(draft.blocks.as_ref()).map(|(length, plan)| length / plan.train.speed);
    cells::node(draft, beds, (plans, cell_of), headway_time)
}

/// The sleepers at even ranks of settlement by the law, from the largest to the smallest, of those that every wheel
/// passes if there are any.
fn spread(draft: &Draft<'_>, seats: Vec<usize>, count: usize) -> Vec<usize> {
    let passed: Vec<usize> = seats.iter().copied().filter(|seat| cells::every_wheel_passes(draft, *seat)).collect();
    let mut seats = if passed.is_empty() { seats } else { passed };
    let settled = |seat: usize| cells::measure(draft, seat);
    seats.sort_by(|a, b| settled(*b).total_cmp(&settled(*a)).then(a.cmp(b)));
    let last = seats.len().saturating_sub(1);
    let rank = |at: usize| (at * last).checked_div(count - 1).unwrap_or(0);
    let mut ranks: Vec<usize> = (0..count.min(seats.len())).map(rank).collect();
    ranks.dedup();
    ranks.into_iter().map(|rank| seats[rank]).collect()
}
