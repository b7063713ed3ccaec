//! The bed of a track: packed cells side by side, with held grains at its ends, brought to rest.
//!
//! Copies of one cell fit each other grain by grain. The ends are rough walls: of the bay that would come next, the grains that
//! touch the bed stand there and are held, so that no grain of the bed loses a contact, and copies of one cell are at rest as they
//! lie. A plane instead would let go what the bed has locked in along the track, and let it slide for seconds.
//!
//! Where another cell stands beside one, grains would be pressed into each other: of two that overlap deeply the lighter is taken
//! out, the others push each other apart slowly, and what is left comes to rest under its own weight.

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

/// What was made of the cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackAccount {
    /// The cell of each bay, from 0.
    pub order: Vec<usize>,
    /// m.
    pub length: f64,
    /// Those that are held at the ends are not among them.
    pub bodies: usize,
    pub held_at_ends: usize,
    /// Taken out where unlike cells meet.
    pub removed_at_seams: usize,
    /// Share of the mass that was taken out.
    pub removed_mass: f64,
    /// Until rest, s, and steps that it took.
    pub time: f64,
    pub steps: u64,
    pub unbalance: f64,
}

/// Overlap over the smaller radius beyond which the lighter of two grains goes.
const DEEP: f64 = 0.15;
/// Rounds, and steps of each, after which grains that push each other apart stand still again; and the share of the pace at which
/// they do.
const ROUNDS: usize = 100;
const STEPS: u64 = 5;
const SLOWLY: f64 = 0.25;
/// Rounds between looks at inertia.
const HOLD: usize = 5;
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

/// Lays packed cells of one recipe (but for its seed) side by side, from x = 0 on. `tell` hears how far it is, and may end it.
///
/// # Panics
/// If `order` is empty or names a cell that is not there.
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

/// With a further bay at each end, of the cell that stands there.
fn with_ends(order: &[usize]) -> Vec<usize> {
    [&order[..1], order, &order[order.len() - 1..]].concat()
}

/// What becomes of a body.
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
    /// Share of the mass.
    removed_mass: f64,
}

impl Parts {
    /// Sorts the bodies of bays with so many of them each, the first and the last bay beyond the ends.
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
        // the deepest first
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

/// Holds the grains at the ends, and gives how many they are.
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

/// Walls behind the held grains, for what might find its way between them.
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

/// Grains that overlap push each other apart, and stand still again after every few steps: what they store does not become speed.
fn push_apart<R: Real>(bed: &mut Bed<R>, pace: &Pace) -> Result<(), Failure> {
    for round in 0..ROUNDS {
        // grains that hardly move form few contacts: a look at inertia costs more than the steps of a round
        if round.is_multiple_of(HOLD) {
            pace.hold(bed)?;
            bed.set_time_step(SLOWLY * bed.time_step());
        }
        bed.run(STEPS)?;
        (0..bed.len() as u32).for_each(|body| bed.set_velocity(BodyId(body), [0.0; 3], [0.0; 3]));
    }
    Ok(())
}

/// Runs until forces are in balance, and gives how far they are.
fn settle<R: Real>(
    bed: &mut Bed<R>,
    recipe: &Recipe,
    unlike: bool,
    tell: &mut impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<f64, PackingError> {
    // where unlike cells meet, grains find their places for a second and more: as calm as a lift is calm enough there
    let unbalance = if unlike { recipe.rest.lift } else { recipe.rest.bed };
    let longest = recipe.rest.longest;
    // copies of one cell lie as they did, and need no step
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

/// Cells side by side on their way to rest.
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
