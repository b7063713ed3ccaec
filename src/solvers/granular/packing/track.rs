//! The bed of a track: packed cells side by side, with held grains at its ends, brought to rest.
//!
//! Copies of one cell fit together grain by grain. The ends are rough walls: of the bay that would come next, the
//! grains that touch the bed are added and held. So no grain of the bed loses a contact, and copies of one cell are at
//! rest as they lie. A plane instead would release the locked-in stress along the track, and the bed would slide for
//! seconds.
//!
//! Between different cells, grains would be pressed into each other. Of two grains that overlap deeply the lighter is
//! removed, the others push each other apart slowly, and the remaining grains come to rest under their own weight.

use super::super::bed::Bed;
use super::super::body::BodyId;
use super::super::failure::Failure;
use super::super::grains::Random;
use super::super::lanes::Real;
use super::super::listen::{Answer, unless_stopped};
use super::super::rest::{Criterion, Fading, Look, Waiting, until_rest};
use super::describe::StageKind;
use super::error::PackingError;
use super::pace::Pace;
use super::packed::Packed;
use super::progress::Progress;
use super::recipe::Recipe;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// The cell of each bay.
pub struct Order(pub(super) Vec<usize>);

/// The bed of a track at rest.
#[derive(Clone)]
pub struct TrackBed<R: Real> {
    pub bed: Bed<R>,
    pub account: TrackAccount,
}

/// Summary of the bed of a track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackAccount {
    /// The cell of each bay, from 0.
    pub order: Vec<usize>,
    /// m.
    pub length: f64,
    /// Number of bodies without the held grains at the ends.
    pub bodies: usize,
    pub held_at_ends: usize,
    /// Number of grains removed between different cells.
    pub removed_at_seams: usize,
    /// Share of the mass that was removed.
    pub removed_mass: f64,
    /// Time until rest, s, and number of steps.
    pub time: f64,
    pub steps: u64,
    pub unbalance: f64,
}

/// Overlap divided by the smaller radius above which the lighter of two grains is removed.
const DEEP: f64 = 0.15;
/// Number of rounds in which overlapping grains push each other apart, and number of steps after which they are
/// stopped; and the step as a share of the pace.
const ROUNDS: usize = 100;
const STEPS: u64 = 5;
const SLOWLY: f64 = 0.25;
/// Rounds between updates of the inertia.
const HOLD: usize = 5;
/// Local damping while gaps close.
const DAMPING: f64 = 0.7;
/// Steps between checks of rest and of inertia.
const LOOK: u64 = 200;
/// Number of checks in a row that must find rest.
const CALM: usize = 2;

impl Order {
    /// Copies of one cell.
    pub fn of_one(bays: usize) -> Order {
        Order(vec![0; bays])
    }

    /// Cells in random order, each about equally often: no cell is repeated before all cells have been used.
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

/// Lays packed cells of one recipe (with different seeds) side by side, from x = 0 on. `tell` receives the progress,
/// and may stop the work.
///
/// # Panics
/// If `order` is empty or names a cell that does not exist.
pub fn lay<R: Real, A: Answer>(
    cells: &[Packed<R>],
    order: &Order,
    recipe: &Recipe,
    mut tell: impl FnMut(&Progress) -> A,
) -> Result<TrackBed<R>, PackingError> {
    let mut tell = |progress: &Progress| tell(progress).flow();
    let mut beds: Vec<Bed<R>> = cells.iter().map(|cell| cell.bed.clone()).collect();
    let bays = with_ends(&order.0);
    let all = Bed::side_by_side(&mut beds, &bays, -1, |_, _| true).map_err(failed)?;
    let sizes: Vec<usize> = bays.iter().map(|&cell| beds[cell].len()).collect();
    let parts = Parts::sorted(all, &sizes).map_err(failed)?;
    // numbers of `all` go bay by bay, body by body
    let starts: Vec<usize> = sizes.iter().scan(0, |next, size| Some(std::mem::replace(next, *next + size))).collect();
    let role = |bay: usize, body: BodyId| parts.roles[starts[bay] + body.0 as usize];
    let mut bed = Bed::side_by_side(&mut beds, &bays, -1, |bay, body| role(bay, body) != Role::Out).map_err(failed)?;
    let held = hold(&mut bed, &parts);
    close(&mut bed, recipe, order.0.len());
    let (time, steps) = (bed.time(), bed.steps());
    let unbalance = settle(&mut bed, recipe, order.0.windows(2).any(|pair| pair[0] != pair[1]), &mut tell)?;
    let account = TrackAccount {
        order: order.0.clone(),
        length: recipe.plan[0] * order.0.len() as f64,
        bodies: bed.len() - held,
        held_at_ends: held,
        removed_at_seams: parts.removed,
        removed_mass: parts.removed_mass,
        time: bed.time() - time,
        steps: bed.steps() - steps,
        unbalance,
    };
    Ok(TrackBed { bed, account })
}

/// The order with one more bay at each end, with the cell of that end.
fn with_ends(order: &[usize]) -> Vec<usize> {
    [&order[..1], order, &order[order.len() - 1..]].concat()
}

/// The role of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    Free,
    Held,
    Out,
}

struct Parts {
    /// Role of every body of every bay.
    roles: Vec<Role>,
    removed: usize,
    /// Share of the mass that is removed.
    removed_mass: f64,
}

impl Parts {
    /// Sorts the bodies of all bays; `sizes` are the numbers of bodies of the bays. The first and the last bay lie
    /// beyond the ends.
    fn sorted<R: Real>(mut all: Bed<R>, sizes: &[usize]) -> Result<Parts, Failure> {
        let inside = sizes[0]..all.len() - sizes[sizes.len() - 1];
        let mut roles = vec![Role::Out; all.len()];
        roles[inside.clone()].fill(Role::Free);
        let mut least = vec![f64::INFINITY; all.len()];
        for pebble in all.pebbles() {
            let least = &mut least[pebble.body.0 as usize];
            *least = least.min(pebble.radius);
        }
        let mut deep: Vec<(f64, usize, usize)> = Vec::new();
        for contact in &all.snapshot()?.contacts {
            let (Some(a), Some(b)) = (contact.first.body(), contact.second.body()) else { continue };
            let (a, b) = (a.0 as usize, b.0 as usize);
            match (inside.contains(&a), inside.contains(&b)) {
                (true, false) => roles[b] = Role::Held,
                (false, true) => roles[a] = Role::Held,
                (true, true) => {
                    let share = contact.overlap / least[a].min(least[b]);
                    if share > DEEP {
                        deep.push((share, a, b));
                    }
                }
                (false, false) => {}
            }
        }
        // the deepest overlap first
        deep.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let masses: Vec<f64> = all.states().map(|state| state.mass).collect();
        for (_, a, b) in deep {
            if roles[a] == Role::Free && roles[b] == Role::Free {
                roles[if masses[a] < masses[b] { a } else { b }] = Role::Out;
            }
        }
        let gone = || inside.clone().filter(|&body| roles[body] == Role::Out);
        let removed_mass = gone().map(|body| masses[body]).fold(0.0, |sum, mass| sum + mass)
            / masses[inside.clone()].iter().sum::<f64>();
        let removed = gone().count();
        Ok(Parts { roles, removed, removed_mass })
    }
}

/// Holds the grains at the ends, and returns their number.
fn hold<R: Real>(bed: &mut Bed<R>, parts: &Parts) -> usize {
    let there = parts.roles.iter().filter(|role| **role != Role::Out).enumerate();
    let held: Vec<BodyId> =
        there.filter(|(_, role)| **role == Role::Held).map(|(number, _)| BodyId(number as u32)).collect();
    for body in &held {
        bed.set_velocity(*body, [0.0; 3], [0.0; 3]);
        bed.fix(*body);
    }
    held.len()
}

/// Adds walls behind the held grains, for grains that might pass between them.
fn close<R: Real>(bed: &mut Bed<R>, recipe: &Recipe, bays: usize) {
    let length = recipe.plan[0] * bays as f64;
    let reach = |side: f64, from: f64| {
        bed.pebbles().map(|pebble| side * (pebble.place[0] - from) + pebble.radius).fold(0.0, f64::max)
    };
    let (before, behind) = (reach(-1.0, 0.0), reach(1.0, length));
    let surface = recipe.wall_surface();
    bed.add_plane([-before, 0.0, 0.0], [1.0, 0.0, 0.0], surface);
    bed.add_plane([length + behind, 0.0, 0.0], [-1.0, 0.0, 0.0], surface);
}

/// Lets overlapping grains push each other apart. After every few steps they are stopped, so that their stored energy
/// does not become speed.
fn push_apart<R: Real>(bed: &mut Bed<R>, pace: &Pace) -> Result<(), Failure> {
    for round in 0..ROUNDS {
        // grains that hardly move form few contacts: an update of the inertia costs more than the steps of a round
        if round.is_multiple_of(HOLD) {
            pace.hold(bed)?;
            bed.set_time_step(SLOWLY * bed.time_step());
        }
        bed.run(STEPS)?;
        (0..bed.len() as u32).for_each(|body| bed.set_velocity(BodyId(body), [0.0; 3], [0.0; 3]));
    }
    Ok(())
}

/// Runs until forces are in balance, and returns the force out of balance.
fn settle<R: Real>(
    bed: &mut Bed<R>,
    recipe: &Recipe,
    unlike: bool,
    tell: &mut impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<f64, PackingError> {
    // between different cells grains are rearranged for a second and more: the limit for a lift is sufficient there
    let unbalance = if unlike { recipe.rest.lift } else { recipe.rest.bed };
    let longest = recipe.rest.longest;
    // copies of one cell are at rest already, and need no step
    let criterion = Criterion { unbalance, missed: 0.0, every: LOOK, looks: CALM, longest, look_first: true };
    let pace = Pace::with_friction(recipe);
    bed.set_laws(recipe.laws_without_dashpots());
    bed.set_damping(DAMPING);
    let start = bed.time();
    if unlike {
        push_apart(bed, &pace).map_err(failed)?;
    }
    let look =
        until_rest(&mut Settling { bed, pace, limit: unbalance, fading: Fading::default(), tell }, &criterion, start)?;
    bed.unscale_masses();
    bed.set_laws(recipe.laws());
    bed.set_damping(recipe.local_damping);
    Ok(look.unbalance)
}

/// Cells side by side before they are at rest.
struct Settling<'s, R: Real, T> {
    bed: &'s mut Bed<R>,
    pace: Pace,
    limit: f64,
    fading: Fading,
    tell: &'s mut T,
}

impl<R: Real, T: FnMut(&Progress) -> ControlFlow<()>> Waiting<R> for Settling<'_, R, T> {
    type Error = PackingError;

    fn bed(&mut self) -> &mut Bed<R> {
        self.bed
    }

    fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        self.pace.run(self.bed, steps)
    }

    fn hear(&mut self, look: &Look) -> Result<(), PackingError> {
        let share = self.fading.share(look.unbalance / self.limit);
        let (bodies, steps) = (self.bed.len(), self.bed.steps());
        unless_stopped(
            (self.tell)(&Progress { stage: StageKind::SideBySide.to_string(), share, bodies, steps }),
            PackingError::Stopped,
        )
    }

    fn restless(&self, look: &Look) -> PackingError {
        let &Look { unbalance, time, .. } = look;
        PackingError::Restless { stage: StageKind::SideBySide, unbalance, limit: self.limit, time }
    }

    fn failed(&self, failure: Failure) -> PackingError {
        failed(failure)
    }
}

fn failed(failure: Failure) -> PackingError {
    PackingError::Failure { stage: StageKind::SideBySide, failure }
}
