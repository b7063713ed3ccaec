//! Contacts between pebbles: sorted once, kept in blocks of lanes, each force computed once (methods 4.2, pass 1).

use super::domain::{Domain, Image};
use super::force::{ForceRule, Meeting, Outcome, Prepared, outcome};
use super::lanes::{BLOCK, Fine, Lanes, Num, Real, Vector, Work};
use super::prefetch::prefetch;
use super::tasks::Task;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A vector for each contact of a block.
pub(super) type BlockVector<R> = [[R; BLOCK]; 3];

/// Pairs near each other, in blocks of one law each.
#[derive(Debug, Clone, Default)]
pub(super) struct Contacts<R> {
    /// Indices of the pebbles; unused places of a block hold a pair that is far apart.
    pub first: Vec<u32>,
    pub second: Vec<u32>,
    /// Shift of the first pebble.
    pub image: Vec<Image>,
    /// Law of each block.
    pub law: Vec<u16>,
    /// Force of the shear springs \[N\].
    pub shear: Vec<BlockVector<R>>,
    /// Force of the dashpots one step ago, if energy is watched \[N\].
    pub damping: Vec<BlockVector<R>>,
    /// Forces and moments on the bodies, one entry per contact; contacts with walls come last.
    pub outcomes: Vec<Outcome<R>>,
}

/// Energy stored in contacts, and energy lost in contacts in one step \[J\].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactEnergy {
    pub strain: f64,
    pub slip: f64,
    pub dashpot: f64,
}

impl std::ops::AddAssign for ContactEnergy {
    fn add_assign(&mut self, other: ContactEnergy) {
        self.strain += other.strain;
        self.slip += other.slip;
        self.dashpot += other.dashpot;
    }
}

/// Other data that the pass reads.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a, R: Real> {
    pub records: &'a [R::Record],
    pub laws: &'a [Prepared],
    /// Shift of every image \[m\].
    pub shifts: &'a [[f64; 3]; 64],
    pub dt: f64,
}

/// Shift of every image \[m\].
pub(super) fn shifts(domain: &Domain) -> [[f64; 3]; 64] {
    std::array::from_fn(|image| domain.shift(image as Image))
}

impl<R: Real> Contacts<R> {
    /// Number of places in blocks, including unused places.
    pub fn len(&self) -> usize {
        self.first.len()
    }

    /// Allocates or frees the arrays for watching energy.
    pub fn watch(&mut self, on: bool) {
        let blocks = if on { self.shear.len() } else { 0 };
        self.damping.resize(blocks, [[R::default(); BLOCK]; 3]);
    }

    /// Computes the forces of `tasks` from the state of the pebbles; an energy per task, 0 if energies are not watched.
    pub fn evaluate(&mut self, tasks: &[Task], around: Surroundings<R>) -> Vec<ContactEnergy> {
        let start = tasks[0].block as usize;
        let mut shear = &mut self.shear[start..];
        let mut outcomes = &mut self.outcomes[start * BLOCK..];
        let watched = !self.damping.is_empty();
        let mut damping = if watched { &mut self.damping[start..] } else { &mut self.damping[..] };
        let mut passes = Vec::with_capacity(tasks.len());
        for (task, next) in tasks.iter().zip(&tasks[1..]) {
            let blocks = task.block as usize..next.block as usize;
            let places = blocks.start * BLOCK..blocks.end * BLOCK;
            let (some_shear, rest_shear) = shear.split_at_mut(blocks.len());
            let (some_outcomes, rest_outcomes) = outcomes.split_at_mut(places.len());
            let (some_damping, rest_damping) = damping.split_at_mut(if watched { blocks.len() } else { 0 });
            passes.push(Pass {
                around,
                first: &self.first[places.clone()],
                second: &self.second[places.clone()],
                image: &self.image[places],
                law: &self.law[blocks],
                shear: some_shear,
                outcomes: some_outcomes,
                damping: some_damping,
            });
            (shear, outcomes, damping) = (rest_shear, rest_outcomes, rest_damping);
        }
        passes.into_par_iter().map(R::dispatch).collect()
    }
}

/// The contacts of the task in work.
struct Pass<'a, R: Real> {
    around: Surroundings<'a, R>,
    first: &'a [u32],
    second: &'a [u32],
    image: &'a [Image],
    law: &'a [u16],
    shear: &'a mut [BlockVector<R>],
    outcomes: &'a mut [Outcome<R>],
    damping: &'a mut [BlockVector<R>],
}

impl<R: Real> Work<R> for Pass<'_, R> {
    type Output = ContactEnergy;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(mut self, lanes: L) -> ContactEnergy {
        let mut sums = [[0.0; BLOCK]; 3];
        for block in 0..self.shear.len() {
            self.ask_for(block + AHEAD);
            // no closures on this path: the compiler would not use the lane instructions in their bodies
            match &self.around.laws[usize::from(self.law[block])] {
                Prepared::Linear(rule) => self.block(lanes, block, rule, &mut sums),
                Prepared::Hertz(rule) => self.block(lanes, block, rule, &mut sums),
            }
        }
        let [strain, slip, dashpot] = sums.map(|lanes| lanes.iter().sum());
        ContactEnergy { strain, slip, dashpot }
    }
}

/// Number of blocks between the prefetched block and the computed block.
const AHEAD: usize = 4;

impl<R: Real> Pass<'_, R> {
    /// Prefetches all that a block reads and writes. Its earlier pebbles are contiguous in memory and need no prefetch.
    #[inline(always)]
    fn ask_for(&self, block: usize) {
        let Some(shear) = self.shear.get(block) else { return };
        let places = block * BLOCK..(block + 1) * BLOCK;
        for component in shear {
            prefetch(component);
        }
        for &pebble in &self.second[places.clone()] {
            prefetch(&self.around.records[pebble as usize]);
        }
        for pair in self.outcomes[places].chunks(2) {
            prefetch(&pair[0]);
        }
    }

    #[inline(always)]
    fn block<L: Lanes<Real = R>>(
        &mut self,
        lanes: L,
        block: usize,
        rule: &impl ForceRule,
        sums: &mut [[f64; BLOCK]; 3],
    ) {
        for at in (0..BLOCK).step_by(L::WIDTH) {
            let places = block * BLOCK + at..block * BLOCK + at + L::WIDTH;
            let a = lanes.gather(self.around.records, &self.first[places.clone()]);
            let b = lanes.gather(self.around.records, &self.second[places.clone()]);
            let shift = shift_of(lanes, &self.image[places.clone()], self.around.shifts);
            let meeting = Meeting::between(lanes, &a, &b, shift);
            let shear = &mut self.shear[block];
            let contact = rule.force(lanes, &meeting, Vector::load(lanes, shear, at));
            contact.shear.store(shear, at);
            lanes.scatter(outcome(&meeting, &contact), &mut self.outcomes[places]);
            if let Some(before) = self.damping.get_mut(block) {
                let half = Num::splat(lanes, -0.5 * self.around.dt);
                let dashpot = (Vector::load(lanes, before, at) + contact.damping).dot(meeting.velocity) * half;
                contact.damping.store(before, at);
                for (sum, energy) in sums.iter_mut().zip([contact.strain, contact.slip, dashpot]) {
                    add_lanes(&mut sum[at..at + L::WIDTH], energy);
                }
            }
        }
    }
}

/// Shift of the first pebbles; none if all are in the cell of the second pebble.
#[inline(always)]
pub(super) fn shift_of<L: Lanes>(lanes: L, images: &[Image], shifts: &[[f64; 3]; 64]) -> Option<[Fine<L>; 3]> {
    let mut any = 0;
    for &image in images {
        any |= image;
    }
    if any == 0 {
        return None;
    }
    let mut columns = [[0.0; BLOCK]; 3];
    for (l, &image) in images.iter().enumerate() {
        for (column, shift) in columns.iter_mut().zip(shifts[usize::from(image)]) {
            column[l] = shift;
        }
    }
    let [x, y, z] = &columns;
    Some([Fine::load(lanes, x), Fine::load(lanes, y), Fine::load(lanes, z)])
}

#[inline(always)]
pub(super) fn add_lanes<L: Lanes>(sums: &mut [f64], energy: Num<L>) {
    let mut parts = [L::Real::default(); BLOCK];
    energy.store(&mut parts[..L::WIDTH]);
    for (sum, part) in sums.iter_mut().zip(parts) {
        *sum += part.to_f64();
    }
}
