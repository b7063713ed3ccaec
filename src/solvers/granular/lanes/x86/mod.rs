//! Sixteen lanes of AVX-512 and eight of AVX2, in mixed precision.
//!
//! Records are read in whole cache lines and transposed in registers: a gather instruction would fetch each number of a
//! line separately. No closures here: the compiler would not use the instructions of the calling function in their
//! bodies.

mod middle;
mod wide;

pub use middle::Middle;
pub use wide::Wide;

use super::{Lanes, Row, Work};
use bytemuck::must_cast;
use pulp::NullaryFnOnce;
use std::arch::x86_64::__m128;

/// Work with its lanes. A closure would not do: the compiler may compile its body outside the function that has the
/// instructions.
struct Entered<W, L> {
    work: W,
    lanes: L,
}

impl<W: Work<L::Real>, L: Lanes> NullaryFnOnce for Entered<W, L> {
    type Output = W::Output;
    #[inline(always)]
    fn call(self) -> W::Output {
        self.work.run(self.lanes)
    }
}

/// The two halves of a row.
#[inline(always)]
fn halves_of(row: &Row<f32>) -> [__m128; 2] {
    must_cast(row.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::granular::entry::Entry;
    use crate::solvers::granular::lanes::{Num, Plain};

    /// Numbers of outcomes, column by column, and which lanes are of a second pebble.
    struct Gathered<'a>(&'a [Row<f32>], &'a [Entry]);

    impl Work<f32> for Gathered<'_> {
        type Output = Vec<f32>;
        fn run<L: Lanes<Real = f32>>(self, lanes: L) -> Vec<f32> {
            let Gathered(rows, entries) = self;
            let chosen = Num::splat(lanes, 1.0).where_or(lanes.of_second(entries), Num::splat(lanes, 0.0));
            let columns = lanes.gather_rows(rows, entries).into_iter().chain([chosen]);
            let numbers = |column: Num<L>| {
                let mut numbers = vec![0.0; L::WIDTH];
                column.store(&mut numbers);
                numbers
            };
            columns.flat_map(numbers).collect()
        }
    }

    #[test]
    fn outcomes_come_as_columns_like_in_plain_lanes() {
        let rows: Vec<Row<f32>> =
            (0..40).map(|row| Row([0, 1, 2, 3, 4, 5, 6, 7].map(|c| (10 * row + c) as f32))).collect();
        let entries: Vec<Entry> = (0..16).map(|l| Entry::new(7 * l % 40, l % 3 == 1)).collect();
        let gathered = || Gathered(&rows, &entries);
        let expected = gathered().run(Plain::<f32, 16>::new());
        assert_eq!((expected[1], expected[16 * 7 + 15], expected[16 * 8 + 1]), (70.0, 257.0, 1.0));
        if let Some(lanes) = Wide::detect() {
            assert_eq!(lanes.enter(gathered(), lanes), expected);
        }
        if let Some(lanes) = Middle::detect() {
            assert_eq!(lanes.enter(gathered(), lanes), gathered().run(Plain::<f32, 8>::new()));
        }
    }
}
