//! A track whose sleepers stand on periodic cells of grains: tier `cells`.
//!
//! Each cell is driven by the forces on the supports of its own sleepers, computed with the plane track. It returns its
//! stiffness and the settlement that a train adds. A cell computes as many trains of a block as the accuracy requires;
//! the other trains are a jump, by a law that is fitted to the results of all cells so far. The rail joins the sleepers
//! in the plane track only: cells do not push each other along the track, as the bays of a bed do.

mod book;
mod cell;
mod forces;
mod hardening;
mod layout;
mod specimen;
mod stored;

use super::on_grains::{Following, Stage, Telling, going_on, tell_stage_and_state};
use super::turns;
use super::{Bonds, Even, Forces, Load, Mark, NodeError, Substructure};
use crate::graph::{CellPlan, CellsNode, Responses, SeatOnCell};
use crate::store::{Beds, recipe_hash};
use book::{Book, laws};
use cell::Cell;
pub use cell::Passed;
use forces::Following as FollowingTrains;
pub use forces::TrainForces;
use hardening::Jump;
use layout::Layout;
use serde::{Deserialize, Serialize};
pub use specimen::{Specimen, StepOfCell};
use std::ops::{ControlFlow, Range};
use std::sync::{Mutex, PoisonError};

/// Version: increased when the same cells are built in another way, or stored in another form.
const METHOD: &str = "cell of grains 3";

/// Data of cells.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    pub cells: &'a CellsNode,
    pub beds: &'a Beds,
}

/// Settlement of a cell by the trains so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Checked {
    /// m.
    pub settled: f64,
    /// Standard error from the trains that were left out, m.
    pub error: f64,
}

/// Cells as the ground of a track.
pub struct CellGround<'a> {
    parts: Parts<'a>,
    responses: Responses,
    live: Option<Live>,
}

/// The ground at work.
struct Live {
    layout: Layout,
    cells: Vec<Cell>,
    books: Vec<Book>,
    /// Trains so far.
    passed: u64,
    /// Grows whenever a stiffness changes.
    revision: u64,
    underway: Option<Underway>,
}

/// A block that has begun and is not done. Its trains come in runs: of one kind, in one direction, with one passage of
/// the plane track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Underway {
    /// The books at the start of the block: other nodes get these values until the block is done.
    began: Vec<Book>,
    /// Runs that are done.
    runs: usize,
    /// Trains of the run under way that each cell has computed; empty before its first one.
    computed: Vec<usize>,
    /// Trains with which the run ends, if it ends early.
    until: Option<u64>,
}

impl<'a> CellGround<'a> {
    /// A ground that is not built yet: [`Substructure::prepare`] does that, or [`Substructure::restore`].
    pub fn new(parts: Parts<'a>) -> CellGround<'a> {
        CellGround { parts, responses: Responses { revision: 0, seats: Vec::new() }, live: None }
    }

    /// Takes over the values of the supports from the books.
    fn answer(&mut self) {
        let Some(live) = &self.live else { return };
        let seats = book::supports(self.parts.cells, &live.layout, live.told());
        self.responses = Responses { revision: live.revision, seats };
    }

    fn end_of_block(&mut self) {
        if let Some(live) = &mut self.live {
            live.underway = None;
            live.revision += 1;
        }
        self.answer();
    }

    /// The settlement of each cell.
    pub fn checked(&self) -> Vec<Checked> {
        let books = self.live.as_ref().map_or(&[] as &[Book], |live| &live.books);
        books.iter().map(|book| Checked { settled: book.settled, error: book.error }).collect()
    }

    fn live(&self) -> Result<&Live, NodeError> {
        self.live.as_ref().ok_or(NodeError::NoGround)
    }
}

impl Substructure for CellGround<'_> {
    fn prepare(&mut self, tell: &mut Telling<'_>) -> Result<(), NodeError> {
        self.live = Some(Live::build(self.parts, tell)?);
        self.answer();
        Ok(())
    }

    fn responses(&self) -> &Responses {
        &self.responses
    }

    fn settlement(&self) -> Vec<f64> {
        let node = self.parts.cells;
        match &self.live {
            Some(live) => book::settlement(node, &live.layout, |cell| live.told()[cell].settled),
            None => node.settlement.clone(),
        }
    }

    fn forces(&self) -> Forces {
        Forces::Histories
    }

    /// Prediction: each train adds the settlement of the last train.
    fn predict(&self, loads: &[Load<'_>]) -> Result<Vec<f64>, NodeError> {
        let trains = loads.iter().map(|load| load.trains).sum::<u64>() as f64;
        let live = self.live()?;
        let told = live.told();
        Ok(book::settlement(self.parts.cells, &live.layout, |cell| told[cell].settled + trains * told[cell].rate))
    }

    fn foresees(&self) -> bool {
        false
    }

    fn advance(&mut self, loads: &[Load<'_>]) -> Result<(), NodeError> {
        self.advance_and_follow(loads, &mut |_| ControlFlow::Continue(()))
    }

    fn advance_and_follow(&mut self, loads: &[Load<'_>], follow: &mut Following<'_>) -> Result<(), NodeError> {
        let node = self.parts.cells;
        let live = self.live.as_mut().ok_or(NodeError::NoGround)?;
        let done = live.block().runs;
        for load in loads.iter().skip(done) {
            live.run(node, load, &|_, _| true, follow)?;
        }
        self.end_of_block();
        Ok(())
    }

    fn advance_while(
        &mut self,
        load: &Load<'_>,
        even: &Even<'_>,
        follow: &mut Following<'_>,
    ) -> Result<u64, NodeError> {
        let live = self.live.as_mut().ok_or(NodeError::NoGround)?;
        let passed = live.run(self.parts.cells, load, even, follow)?;
        self.end_of_block();
        Ok(passed)
    }

    fn bonds(&self) -> Bonds {
        self.live.iter().flat_map(|live| &live.cells).map(|cell| Bonds::in_bed(&cell.bed)).sum()
    }

    fn error_added(&self) -> f64 {
        let books = self.live.as_ref().map_or(&[] as &[Book], |live| &live.books);
        books.iter().map(|book| book.error_added).fold(0.0, f64::max)
    }

    fn is_underway(&self) -> bool {
        self.live.as_ref().is_some_and(|live| live.underway.is_some())
    }

    /// A failure of grains ends the run, and nothing goes back to before it.
    fn mark(&self) -> Mark {
        Mark(Box::new(()))
    }

    fn roll_back(&mut self, _: Mark) {}

    fn tamp(&mut self, _: &[usize], _: f64) -> Result<(), NodeError> {
        Err(NodeError::Other { node: "cells".into(), why: "this version cannot tamp grains".into() })
    }

    fn save(&self) -> Result<serde_json::Value, NodeError> {
        self.live()?.save()
    }

    fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError> {
        self.live = Some(Live::restore(self.parts, state)?);
        self.answer();
        Ok(())
    }
}

impl Live {
    /// Builds every cell; those that are alike are built once.
    fn build(parts: Parts<'_>, tell: &mut Telling<'_>) -> Result<Live, NodeError> {
        let node = parts.cells;
        let (mut cells, mut books): (Vec<Cell>, Vec<Book>) = (Vec::new(), Vec::new());
        for (number, plan) in node.cells.iter().enumerate() {
            let (cell, book) = match node.cells[..number].iter().position(|other| plan.is_built_alike(other)) {
                Some(built) => (cells[built].clone(), books[built].clone()),
                None => built(parts, plan, tell)?,
            };
            cells.push(cell);
            books.push(book);
        }
        Ok(Live { layout: Layout::planned(node), cells, books, passed: 0, revision: 1, underway: None })
    }

    /// The block of trains under way; begins one where there is none.
    fn block(&mut self) -> &mut Underway {
        if self.underway.is_none() {
            self.books.iter_mut().for_each(|book| book.error_added = 0.0);
        }
        let books = &self.books;
        self.underway.get_or_insert_with(|| Underway {
            began: books.clone(),
            runs: 0,
            computed: Vec::new(),
            until: None,
        })
    }

    /// The values of the cells that other nodes get.
    fn told(&self) -> &[Book] {
        self.underway.as_ref().map_or(&self.books, |underway| &underway.began)
    }

    /// Lets the trains of one load pass, as long as the settlement is even; goes on with those that are under way.
    /// Returns the number of trains that have passed.
    fn run(
        &mut self,
        node: &CellsNode,
        load: &Load<'_>,
        even: &Even<'_>,
        follow: &mut Following<'_>,
    ) -> Result<u64, NodeError> {
        let begins = self.block().computed.is_empty();
        if begins {
            self.part(node, load)?;
        }
        let trains = forces_of_cells(node, &self.layout.plans, load)?;
        if begins {
            self.block().computed = vec![0; self.cells.len()];
            for ((book, train), plan) in self.books.iter_mut().zip(&trains).zip(&self.layout.plans) {
                book.begin(train.among.load(plan.middle));
            }
        }
        loop {
            let count = self.block().until.unwrap_or(load.trains);
            let jumps = self.jumps(node, count);
            let due: Vec<usize> = (0..jumps.len()).filter(|cell| jumps[*cell].is_none()).collect();
            if due.is_empty() {
                // what the laws leave out may be uneven too
                self.stop_early(self.trains_computed()..count, node, even);
                if self.block().until.is_some_and(|until| until < count) {
                    continue;
                }
                self.end_of_run(jumps.into_iter().flatten().collect(), count);
                return Ok(count);
            }
            let share = self.share(&jumps, count);
            tell_stage_and_state((Stage::Passage, share), &|| self.save(), follow)?;
            for (cell, passed) in self.pass(&due, &trains, load, node.gravity)? {
                self.books[cell].note(&passed);
                self.block().computed[cell] += 1;
            }
            let computed = self.trains_computed();
            self.stop_early(computed..count.min(computed + 1), node, even);
        }
    }

    /// Trains of the run under way that are computed, in the cell that has computed most.
    fn trains_computed(&self) -> u64 {
        let computed = self.underway.as_ref().and_then(|underway| underway.computed.iter().max());
        computed.map_or(0, |most| *most as u64)
    }

    /// Lets the run under way end with the first of these numbers of trains after which the settlement is not even.
    fn stop_early(&mut self, mut trains: Range<u64>, node: &CellsNode, even: &Even<'_>) {
        let uneven = |trains: &u64| {
            let added: Option<Vec<Jump>> = self.by_law(*trains).into_iter().collect();
            let after = |added: Vec<Jump>| {
                book::settlement(node, &self.layout, |cell| self.books[cell].settled + added[cell].settled)
            };
            added.is_some_and(|added| !even(&after(added), *trains))
        };
        let until = trains.find(uneven);
        let block = self.block();
        block.until = block.until.or(until);
    }

    /// Splits cells whose seats get different loads from the trains of one load.
    fn part(&mut self, node: &CellsNode, load: &Load<'_>) -> Result<(), NodeError> {
        let loads = loads_of_seats(node, load)?;
        for from in self.layout.part(node, &loads, node.tolerance) {
            self.cells.push(self.cells[from].clone());
            self.books.push(self.books[from].clone());
            let began = &mut self.block().began;
            began.push(began[from].clone());
        }
        Ok(())
    }

    /// Settlement that the run under way adds to each cell; `None` for a cell that must compute a further train first.
    /// Each cell computes at least one train: forces have changed since the last run, and this train shows if the law
    /// no longer holds.
    fn jumps(&self, node: &CellsNode, trains: u64) -> Vec<Option<Jump>> {
        let computed = self.underway.as_ref().map_or(&[] as &[usize], |underway| &underway.computed);
        let jumps = self.by_law(trains);
        let settled = |(book, jump): (&Book, &Option<Jump>)| book.settled + jump.map_or(0.0, |jump| jump.settled);
        let largest =
            self.books.iter().zip(&jumps).map(settled).fold(0.0, |most: f64, settled| most.max(settled.abs()));
        let tolerance = node.tolerance * ((self.passed + trains) as f64 / node.trains as f64).min(1.0);
        let good = |((book, now), jump): ((&Book, &usize), Option<Jump>)| {
            let bears = |jump: &Jump| *now > 0 && book.bears(jump, largest, tolerance);
            jump.filter(|jump| *now as u64 >= trains || bears(jump))
        };
        self.books.iter().zip(computed).zip(jumps).map(good).collect()
    }

    /// Settlement that so many trains of the run under way add to each cell, by what it has computed and by its law;
    /// `None` without a law for what is left.
    fn by_law(&self, trains: u64) -> Vec<Option<Jump>> {
        let plans = &self.layout.plans;
        let laws = laws(plans, &self.books);
        let computed = self.underway.as_ref().map_or(&[] as &[usize], |underway| &underway.computed);
        let jump = |(cell, now): (usize, &usize)| {
            let law = laws[plans[cell].bed].as_ref();
            self.books[cell].jump(law, *now, self.passed, trains)
        };
        computed.iter().enumerate().map(jump).collect()
    }

    /// Share of a run of trains that is done: of a cell that needs further ones, what it has computed.
    fn share(&self, jumps: &[Option<Jump>], trains: u64) -> f64 {
        let computed = self.underway.as_ref().map_or(&[] as &[usize], |underway| &underway.computed);
        let of_cell =
            |(jump, now): (&Option<Jump>, &usize)| if jump.is_some() { 1.0 } else { *now as f64 / trains as f64 };
        jumps.iter().zip(computed).map(of_cell).sum::<f64>() / jumps.len() as f64
    }

    /// Lets one train of a load pass each of these cells, side by side.
    fn pass(
        &mut self,
        due: &[usize],
        trains: &[Trains],
        load: &Load<'_>,
        gravity: f64,
    ) -> Result<Vec<(usize, Passed)>, NodeError> {
        let computed = self.underway.as_ref().map_or(&[] as &[usize], |underway| &underway.computed);
        let threads = rayon::current_num_threads();
        let cells: Vec<(usize, Mutex<&mut Cell>)> = self
            .cells
            .iter_mut()
            .enumerate()
            .filter(|(cell, _)| due.contains(cell))
            .map(|(i, cell)| (i, Mutex::new(cell)))
            .collect();
        let one = |(number, cell): &(usize, Mutex<&mut Cell>)| {
            let mut cell = cell.lock().unwrap_or_else(PoisonError::into_inner);
            let mut all = Passed { added: 0.0, stiffness: cell.stiffness };
            for part in trains[*number].parts(load, computed[*number] as u64) {
                let passed = cell.pass(part, gravity)?;
                all = Passed { added: all.added + passed.added, stiffness: passed.stiffness };
            }
            Ok((*number, all))
        };
        let failed =
            |error: rayon::ThreadPoolBuildError| NodeError::Other { node: "cells".into(), why: error.to_string() };
        // one core a cell, and all cores for the cells that are left over
        let (in_turns, last) = cells.split_at(cells.len() - cells.len() % threads);
        let passed = turns::each(in_turns, threads, threads, one).map_err(failed)?;
        passed.into_iter().chain(turns::each(last, last.len(), threads, one).map_err(failed)?).collect()
    }

    fn end_of_run(&mut self, jumps: Vec<Jump>, trains: u64) {
        for (book, jump) in self.books.iter_mut().zip(&jumps) {
            book.settle(jump, trains);
        }
        self.passed += trains;
        let block = self.block();
        block.runs += 1;
        block.computed.clear();
        block.until = None;
    }
}

/// The key of a cell in the store.
fn recipe(parts: Parts<'_>, plan: &CellPlan) -> String {
    let node = parts.cells;
    let bed = &node.beds[plan.bed];
    recipe_hash(&(METHOD, plan.anywhere(), bed, node.gravity, node.time_step, node.added_inertia))
}

/// A cell that no train has passed, from the store if it was built before.
fn built(parts: Parts<'_>, plan: &CellPlan, tell: &mut Telling<'_>) -> Result<(Cell, Book), NodeError> {
    let (node, hash) = (parts.cells, recipe(parts, plan));
    let build = || {
        let mut cell = Cell::build(plan, node, parts.beds, tell)?;
        going_on(tell(Stage::StaticLoad, 0.0))?;
        cell.stand_on(cell.clone().pressed(node.gravity)?);
        Ok(cell.store())
    };
    // later results must not depend on whether the cell was built before: both cases continue from the stored state
    let cell = Cell::restore(parts.beds.built::<_, NodeError>(&hash, build)?, plan.sleepers.len())?;
    let book = Book::new(cell.stiffness);
    Ok((cell, book))
}

fn no_forces() -> NodeError {
    NodeError::Other { node: "cells".into(), why: "a passage brings no forces of sleepers".into() }
}

/// Force that a train adds on the support of each seat that it passes with every wheel, N.
fn loads_of_seats(node: &CellsNode, load: &Load<'_>) -> Result<Vec<Option<f64>>, NodeError> {
    let forces = load.passage.forces.as_ref().ok_or_else(no_forces)?;
    let of_seat = |(number, seat): (usize, &Option<SeatOnCell>)| {
        seat.as_ref().filter(|seat| seat.passed)?;
        Some(TrainForces::new(forces, &[number], 0, node.headway_time)?.load(0))
    };
    Ok(node.seats.iter().enumerate().map(of_seat).collect())
}

/// Forces of the trains of a load on a cell.
struct Trains {
    among: TrainForces,
    first: Option<TrainForces>,
    last: Option<TrainForces>,
}

impl Trains {
    /// The parts of a train by its number in the load. With no train ahead, the first train has only its front half:
    /// its rear half comes together with the front half of the next one. With no train behind, the rear half of the
    /// last train comes at the end.
    fn parts(&self, load: &Load<'_>, number: u64) -> impl Iterator<Item = &TrainForces> {
        let first = self.first.as_ref().filter(|_| number == 0 && !load.joined.ahead);
        let last = self.last.as_ref().filter(|_| number + 1 == load.trains && !load.joined.behind);
        [Some(first.unwrap_or(&self.among)), last].into_iter().flatten()
    }
}

fn forces_of_cells(node: &CellsNode, plans: &[CellPlan], load: &Load<'_>) -> Result<Vec<Trains>, NodeError> {
    let forces = load.passage.forces.as_ref().ok_or_else(no_forces)?;
    let of_cell = |plan: &CellPlan| {
        let seats: Vec<usize> = plan.sleepers.iter().map(|sleeper| sleeper.seat).collect();
        let alone = || Some((TrainForces::new(forces, &seats, plan.middle, None)?, None, None));
        let following = |headway| {
            let FollowingTrains { among, first, last } = FollowingTrains::new(forces, &seats, plan.middle, headway)?;
            Some((among, Some(first), last))
        };
        let (among, first, last) = node.headway_time.map_or_else(alone, following).ok_or_else(no_forces)?;
        Ok(Trains { among, first, last })
    };
    plans.iter().map(of_cell).collect()
}
