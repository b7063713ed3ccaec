//! The forces of bonds, lane by lane.

use super::super::contacts::{ContactEnergy, Surroundings, add_lanes, shift_of};
use super::super::force::{ContactForces, Meeting, Outcome, carry, outcome};
use super::super::lanes::{BLOCK, Lanes, Num, Real, Vector, Work};
use super::{Block, Glue};
use rayon::prelude::*;

/// Blocks that one task computes.
const CHUNK: usize = 64;

pub(super) fn evaluate<R: Real>(
    glues: &[Glue],
    blocks: &mut [Block<R>],
    around: Surroundings<R>,
    outcomes: &mut [Outcome<R>],
) -> ContactEnergy {
    let tasks = blocks.par_chunks_mut(CHUNK).zip(outcomes.par_chunks_mut(CHUNK * BLOCK));
    let pass = |(blocks, outcomes)| R::dispatch(Pass { around, glues, blocks, outcomes });
    let energies: Vec<ContactEnergy> = tasks.map(pass).collect();
    let mut total = ContactEnergy::default();
    energies.into_iter().for_each(|energy| total += energy);
    total
}

/// The bonds of the task in work.
struct Pass<'a, R: Real> {
    around: Surroundings<'a, R>,
    glues: &'a [Glue],
    blocks: &'a mut [Block<R>],
    outcomes: &'a mut [Outcome<R>],
}

impl<R: Real> Work<R> for Pass<'_, R> {
    type Output = ContactEnergy;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(self, lanes: L) -> ContactEnergy {
        let mut sums = [[0.0; BLOCK]; 2];
        for (block, outcomes) in self.blocks.iter_mut().zip(self.outcomes.chunks_mut(BLOCK)) {
            let glue = &self.glues[usize::from(block.glue)];
            for at in (0..BLOCK).step_by(L::WIDTH) {
                let places = at..at + L::WIDTH;
                let a = lanes.gather(self.around.records, &block.first[places.clone()]);
                let b = lanes.gather(self.around.records, &block.second[places.clone()]);
                let shift = shift_of(lanes, &block.image[places.clone()], self.around.shifts);
                let meeting = Meeting::between(lanes, &a, &b, shift);
                let held = Held {
                    start: Num::load(lanes, &block.start[places.clone()]),
                    holds: Num::load(lanes, &block.holds[places.clone()]),
                    shear: Vector::load(lanes, &block.shear, at),
                };
                let (forces, holds) = act(lanes, glue, &meeting, held, self.around.dt);
                forces.shear.store(&mut block.shear, at);
                holds.store(&mut block.holds[places.clone()]);
                lanes.scatter(outcome(&meeting, &forces), &mut outcomes[places.clone()]);
                add_lanes(&mut sums[0][places.clone()], forces.strain);
                add_lanes(&mut sums[1][places], forces.slip);
            }
        }
        let [strain, slip] = sums.map(|lanes| lanes.iter().sum());
        ContactEnergy { strain, slip, dashpot: 0.0 }
    }
}

/// State of some bonds.
struct Held<L: Lanes> {
    start: Num<L>,
    holds: Num<L>,
    shear: Vector<L>,
}

/// Forces of some bonds, and 1 for bonds that stay intact. The energy of a breaking bond counts as lost by slip.
#[inline(always)]
fn act<L: Lanes>(lanes: L, glue: &Glue, meeting: &Meeting<L>, held: Held<L>, dt: f64) -> (ContactForces<L>, Num<L>) {
    let number = |value: f64| Num::splat(lanes, value);
    let (zero, half, tiny, dt) = (number(0.0), number(0.5), number(1e-30), number(dt));
    let normal = meeting.normal;
    let stretched = meeting.overlap - held.start;
    let pushed = number(glue.normal_stiffness) * stretched;
    let sliding = meeting.velocity - normal.scale(meeting.velocity.dot(normal));
    let carried = carry(held.shear, normal, meeting.twist * dt, tiny);
    let sheared = sliding.fma(-(number(glue.shear_stiffness) * dt), carried);
    let square = sheared.dot(sheared);
    let of_shear = square / number(2.0 * glue.shear_stiffness.max(1e-30));
    let strain = held.holds * (half * pushed * stretched + of_shear);

    let torn = number(glue.tensile_strength).less(-pushed);
    let cut = number(glue.shear_strength).less(square.sqrt());
    let holds = zero.where_or(cut, zero.where_or(torn, held.holds));
    let shear = sheared.scale(holds);
    let kept = holds * strain;
    let force = normal.fma(pushed * holds, shear);
    let damping = shear.scale(zero);
    (ContactForces { force, shear, damping, strain: kept, slip: strain - kept }, holds)
}
