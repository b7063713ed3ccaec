//! Contacts of each pebble, and the sums of their forces in a fixed order.

use super::entry::Entry;
use super::force::Outcome;
use super::lanes::Lanes;
use super::prefetch::prefetch_at;
use std::ops::Range;

/// Contacts of each pebble, in an order that depends only on which bodies are its neighbours.
#[derive(Debug, Clone, Default)]
pub(super) struct Incidence {
    /// First entry of each pebble, and one final value.
    pub start: Vec<u32>,
    pub entries: Vec<Entry>,
}

/// Force on a pebble, and moment about its centre: the first six of eight numbers.
#[repr(align(64))]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Felt(pub [f64; 8]);

/// Number of entries between the prefetched entry and the summed entry.
const ASKED: usize = 16;

impl Incidence {
    /// Contacts of a pebble.
    pub fn contacts_of(&self, pebble: usize) -> &[Entry] {
        &self.entries[self.start[pebble] as usize..self.start[pebble + 1] as usize]
    }

    /// What some pebbles feel.
    #[inline(always)]
    pub fn felt<L: Lanes>(&self, lanes: L, pebbles: Range<usize>, outcomes: &[Outcome<L::Real>]) -> Vec<Felt> {
        let mut felt = vec![Felt::default(); pebbles.len()];
        let touches = |pebble: usize| self.start[pebble] < self.start[pebble + 1];
        let mut pebble = pebbles.start;
        while pebble < pebbles.end {
            if !touches(pebble) {
                pebble += 1;
                continue;
            }
            let begin = pebble;
            while pebble < pebbles.end && touches(pebble) {
                pebble += 1;
            }
            let here = &mut felt[begin - pebbles.start..pebble - pebbles.start];
            self.add_up(lanes, self.start[begin] as usize..self.start[pebble] as usize, outcomes, here);
        }
        felt
    }

    /// Sums the entries of neighbouring pebbles that all have some. One loop runs over the entries of all these
    /// pebbles: the processor cannot foresee where a loop over the few entries of one pebble ends.
    #[inline(always)]
    fn add_up<L: Lanes>(&self, lanes: L, range: Range<usize>, outcomes: &[Outcome<L::Real>], felt: &mut [Felt]) {
        let (mut sums, mut next) = ([0.0; 8], 0);
        for at in range {
            if let Some(later) = self.entries.get(at + ASKED) {
                prefetch_at(outcomes, later.place());
            }
            let entry = self.entries[at];
            next += usize::from(entry.begins());
            sums = lanes.add_row(&outcomes[entry.place()], entry, sums);
            felt[next - 1] = Felt(sums);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::granular::lanes::{Plain, Real, Row, Work, factors};

    /// Five pebbles; the second and the last two touch nothing.
    fn incidence() -> Incidence {
        let first = Entry::new(0, false).at_the_beginning();
        let third = [Entry::new(0, true).at_the_beginning(), Entry::new(2, false), Entry::new(1, true)];
        Incidence { start: vec![0, 1, 1, 4, 4, 4], entries: [&[first], &third[..]].concat() }
    }

    fn outcomes() -> Vec<Outcome<f32>> {
        (0..3)
            .map(|place| Row([1.0, 2.0, 3.0, 0.25, 0.5, 0.75, 4.0, 8.0].map(|x: f32| x + 16.0 * place as f32)))
            .collect()
    }

    struct Summed<'a>(&'a Incidence, &'a [Outcome<f32>]);

    impl Work<f32> for Summed<'_> {
        type Output = Vec<Felt>;
        fn run<L: Lanes<Real = f32>>(self, lanes: L) -> Vec<Felt> {
            self.0.felt(lanes, 0..5, self.1)
        }
    }

    #[test]
    fn pebbles_feel_their_contacts_and_no_others() {
        let (incidence, outcomes) = (incidence(), outcomes());
        let alone = |pebble: usize| {
            let mut sums = [0.0; 6];
            for &entry in incidence.contacts_of(pebble) {
                let outcome = &outcomes[entry.place()];
                let factors = factors(outcome, entry);
                (0..6).for_each(|k| sums[k] += factors[k] * f64::from(outcome[k]));
            }
            sums
        };
        let summed = || Summed(&incidence, &outcomes);
        for felt in [f32::dispatch(summed()), summed().run(Plain::<f32, 4>::new())] {
            let six: Vec<[f64; 6]> = felt.iter().map(|felt| *felt.0.first_chunk().unwrap()).collect();
            assert_eq!(six, [0, 1, 2, 3, 4].map(alone));
        }
        assert_eq!(alone(0), [1.0, 2.0, 3.0, -1.0, -2.0, -3.0]);
        assert_eq!(alone(1), [0.0; 6]);
    }
}
