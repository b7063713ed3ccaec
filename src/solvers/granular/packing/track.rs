//! The bed of a track: packed cells side by side between walls at its ends, brought to rest.
//!
//! Copies of one cell fit each other grain by grain. Where another cell stands beside one, and at the walls, grains would be
//! pressed into each other: the smaller of two that overlap is taken out, and so is what stands in a wall. What is left closes
//! the gaps under its own weight.

use super::super::bed::Bed;
use super::super::body::BodyId;
use super::super::grains::Random;
use super::super::lanes::Real;
use super::super::measure::unbalance;
use super::super::snapshot::Snapshot;
use super::super::watch::Failure;
use super::pace::Pace;
use super::{Packed, PackingError, Progress, Recipe};
use serde::{Deserialize, Serialize};

/// The cell of each bay.
pub struct Order(pub(super) Vec<usize>);

/// The bed of a track at rest.
#[derive(Clone)]
pub struct TrackBed<R: Real> {
    pub bed: Bed<R>,
    pub account: TrackAccount,
}

/// What was made of the cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackAccount {
    /// The cell of each bay, from 0.
    pub order: Vec<usize>,
    /// m.
    pub length: f64,
    pub bodies: usize,
    /// Taken out at the walls, and where unlike cells meet.
    pub removed_at_ends: usize,
    pub removed_at_seams: usize,
    /// Share of the mass that was taken out.
    pub removed_mass: f64,
    /// Until rest, s, and steps that it took.
    pub time: f64,
    pub steps: u64,
    pub unbalance: f64,
}

/// Overlap over the smaller radius from which two grains were not packed together.
const OVERLAP: f64 = 2e-3;
/// Local damping while gaps close.
const DAMPING: f64 = 0.7;
/// Steps between looks at rest and at inertia.
const LOOK: u64 = 200;
/// Looks in a row that must find rest.
const CALM: usize = 2;

impl Order {
    /// Copies of one cell.
    pub fn of_one(bays: usize) -> Order {
        Order(vec![0; bays])
    }

    /// Cells by chance, each about as often as any other: no cell has its turn again before all have had theirs.
    pub fn mixed(cells: usize, bays: usize, seed: u64) -> Order {
        let mut random = Random::new(seed, 1 << 40);
        let mut order = Vec::with_capacity(bays + cells);
        while order.len() < bays {
            let mut turn: Vec<usize> = (0..cells).collect();
            random.shuffle(&mut turn);
            order.extend(turn);
        }
        order.truncate(bays);
        Order(order)
    }
}

/// Lays packed cells of one recipe (but for its seed) side by side, from x = 0 on. `tell` hears how far it is.
///
/// # Panics
/// If `order` is empty or names a cell that is not there.
pub fn lay<R: Real>(
    cells: &[Packed<R>],
    order: &Order,
    recipe: &Recipe,
    mut tell: impl FnMut(&Progress),
) -> Result<TrackBed<R>, PackingError> {
    let failed = |failure| PackingError::Failure { stage: LAID.to_owned(), failure };
    let mut beds: Vec<Bed<R>> = cells.iter().map(|cell| cell.bed.clone()).collect();
    let all = Bed::side_by_side(&mut beds, &order.0, |_, _| true).map_err(failed)?;
    let length = recipe.plan[0] * order.0.len() as f64;
    let out = in_the_way(all, length).map_err(failed)?;
    // numbers of `all` go bay by bay, body by body
    let starts: Vec<usize> =
        order.0.iter().scan(0, |next, &cell| Some(std::mem::replace(next, *next + beds[cell].len()))).collect();
    let mut bed =
        Bed::side_by_side(&mut beds, &order.0, |bay, body| !out.gone[starts[bay] + body.0 as usize]).map_err(failed)?;
    let surface = recipe.wall_surface();
    bed.add_plane([0.0; 3], [1.0, 0.0, 0.0], surface);
    bed.add_plane([length, 0.0, 0.0], [-1.0, 0.0, 0.0], surface);
    let (time, steps) = (bed.time(), bed.steps());
    bed.set_damping(DAMPING);
    let unbalance = settle(&mut bed, recipe, &mut tell)?;
    bed.set_damping(recipe.local_damping);
    let account = TrackAccount {
        order: order.0.clone(),
        length,
        bodies: bed.len(),
        removed_at_ends: out.at_ends,
        removed_at_seams: out.at_seams,
        removed_mass: out.mass,
        time: bed.time() - time,
        steps: bed.steps() - steps,
        unbalance,
    };
    Ok(TrackBed { bed, account })
}

/// The name of the stage.
const LAID: &str = "cells side by side";

struct Out {
    gone: Vec<bool>,
    at_ends: usize,
    at_seams: usize,
    mass: f64,
}

/// What stands in the walls at the ends, and of two that overlap the lighter one, deepest overlaps first.
fn in_the_way<R: Real>(mut all: Bed<R>, length: f64) -> Result<Out, Failure> {
    let mut gone = vec![false; all.len()];
    for pebble in all.pebbles() {
        let slack = OVERLAP * pebble.radius;
        let (low, high) = (pebble.place[0] - pebble.radius, pebble.place[0] + pebble.radius);
        gone[pebble.body.0 as usize] |= low < -slack || high > length + slack;
    }
    let at_ends = gone.iter().filter(|gone| **gone).count();
    let mut least = vec![f64::INFINITY; all.len()];
    for pebble in all.pebbles() {
        let least = &mut least[pebble.body.0 as usize];
        *least = least.min(pebble.radius);
    }
    let mut deep: Vec<(f64, BodyId, BodyId)> = all
        .snapshot()?
        .contacts
        .iter()
        .filter_map(|contact| {
            let (a, b) = (contact.first.body()?, contact.second.body()?);
            let radius = least[a.0 as usize].min(least[b.0 as usize]);
            (contact.overlap > OVERLAP * radius).then_some((contact.overlap, a, b))
        })
        .collect();
    deep.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let masses: Vec<f64> = all.states().map(|state| state.mass).collect();
    for (_, a, b) in deep {
        let (a, b) = (a.0 as usize, b.0 as usize);
        if !gone[a] && !gone[b] {
            gone[if masses[a] < masses[b] { a } else { b }] = true;
        }
    }
    let at_seams = gone.iter().filter(|gone| **gone).count() - at_ends;
    let taken: f64 = masses.iter().zip(&gone).filter(|(_, gone)| **gone).map(|(mass, _)| mass).sum();
    Ok(Out { gone, at_ends, at_seams, mass: taken / masses.iter().sum::<f64>() })
}

/// Runs until forces are in balance, and gives how far they are.
fn settle<R: Real>(bed: &mut Bed<R>, recipe: &Recipe, tell: &mut impl FnMut(&Progress)) -> Result<f64, PackingError> {
    let failed = |failure| PackingError::Failure { stage: LAID.to_owned(), failure };
    let (start, limit) = (bed.time(), recipe.rest.bed);
    let pace = Pace::of(recipe);
    let (mut calm, mut first) = (0, None);
    loop {
        pace.hold(bed).map_err(failed)?;
        bed.run(LOOK).map_err(failed)?;
        let snapshot: Snapshot = bed.snapshot().map_err(failed)?;
        let unbalance = unbalance(bed, &snapshot);
        calm = if unbalance <= limit { calm + 1 } else { 0 };
        let took = bed.time() - start;
        if calm >= CALM {
            bed.unscale_masses();
            return Ok(unbalance);
        }
        if took > recipe.rest.longest {
            return Err(PackingError::Restless { stage: LAID.to_owned(), unbalance, limit, time: took });
        }
        // forces out of balance fade about as exp(-t)
        let far = (unbalance / limit).ln().max(0.0);
        let share = 1.0 - (far / *first.get_or_insert(far.max(1.0))).min(1.0);
        tell(&Progress { stage: LAID.to_owned(), share, bodies: bed.len(), steps: bed.steps() });
    }
}
