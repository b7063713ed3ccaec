//! Symmetric systems whose rows reach back a different way each, in scratch that is reused without allocation.
//!
//! Row i is kept from its first entry to the diagonal. `A = L D Lᵀ` without pivoting fills nothing in front of a row's
//! first entry, so rows that reach back a bounded way make the cost linear in their number. Without pivoting is stable
//! for positive definite and for quasi-definite matrices (Vanderbei 1995): a positive definite block and a negative
//! definite one with any coupling between them, in any order.

/// The lower triangle of a symmetric matrix, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Skyline {
    /// Column of the first entry of each row, and where its diagonal entry stands in `values`.
    rows: Vec<(usize, usize)>,
    values: Vec<f64>,
}

/// A pivot smaller than this part of the sum of its terms is rounding.
const SINGULAR: f64 = 1e-14;

impl Skyline {
    /// Drops all rows and keeps their memory.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.values.clear();
    }

    pub fn order(&self) -> usize {
        self.rows.len()
    }

    /// Appends a row of zeros and returns its entries, from the column `first` to the diagonal.
    pub fn push_row(&mut self, first: usize) -> &mut [f64] {
        let row = self.rows.len();
        let first = first.min(row);
        let start = self.values.len();
        self.values.resize(start + row - first + 1, 0.0);
        self.rows.push((first, start + row - first));
        &mut self.values[start..]
    }

    /// Column of the first entry of a row, and its entries up to the diagonal.
    #[inline]
    pub fn row(&self, i: usize) -> (usize, &[f64]) {
        let (first, diagonal) = self.rows[i];
        (first, &self.values[diagonal + first - i..=diagonal])
    }

    /// The entry (i, j); zero in front of a row's first entry.
    #[inline]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        let (first, diagonal) = self.rows[i];
        if j < first { 0.0 } else { self.values[diagonal + j - i] }
    }

    /// Computes `y -= A x`.
    pub fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        for i in 0..self.order() {
            let (first, row) = self.row(i);
            let (before, diagonal) = row.split_at(i - first);
            let mut sum = diagonal[0] * x[i];
            for ((a, x_j), y_j) in before.iter().zip(&x[first..i]).zip(&mut y[first..i]) {
                sum += a * x_j;
                *y_j -= a * x[i];
            }
            y[i] -= sum;
        }
    }

    /// Replaces the right-hand side by the solution and the matrix by its factors; fails with the row of a pivot that
    /// is zero but for rounding, or not finite.
    pub fn solve_in_place(&mut self, b: &mut [f64]) -> Result<(), usize> {
        let order = self.order();
        for i in 0..order {
            let (first, diagonal) = self.rows[i];
            let (above, row) = self.values.split_at_mut(diagonal + first - i);
            // Row i holds t_j = L_ij D_j until its pivot is known.
            for j in first..i {
                let (first_j, diagonal_j) = self.rows[j];
                let from = first.max(first_j);
                let mut t = row[j - first];
                for (t_k, l) in row[from - first..j - first].iter().zip(&above[diagonal_j + from - j..diagonal_j]) {
                    t -= t_k * l;
                }
                row[j - first] = t;
            }
            let own = row[i - first];
            let (mut pivot, mut size, mut x) = (own, own.abs(), b[i]);
            for j in first..i {
                let t = row[j - first];
                let l = t / above[self.rows[j].1];
                pivot -= t * l;
                size += (t * l).abs();
                x -= l * b[j];
                row[j - first] = l;
            }
            // Written so that a pivot that is not a number fails.
            if !(pivot.abs() > SINGULAR * size && pivot.is_finite()) {
                return Err(i);
            }
            row[i - first] = pivot;
            b[i] = x;
        }
        for (x, (_, diagonal)) in b.iter_mut().zip(&self.rows) {
            *x /= self.values[*diagonal];
        }
        for i in (0..order).rev() {
            let (first, diagonal) = self.rows[i];
            let (before, rest) = b.split_at_mut(i);
            for (x, l) in before[first..].iter_mut().zip(&self.values[diagonal + first - i..diagonal]) {
                *x -= l * rest[0];
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    /// Rows that reach back as far as `reaches` says, with diagonals of both signs that dominate them.
    fn quasi_definite(order: usize, reaches: &[usize], entries: &[f64]) -> Skyline {
        let mut a = Skyline::default();
        let mut next = entries.iter().cycle();
        let mut definite = vec![1.0; order];
        for i in 0..order {
            definite[i] = if next.next().unwrap_or(&1.0) > &0.3 { 1.0 } else { -1.0 };
            let row = a.push_row(i.saturating_sub(reaches[i % reaches.len()]));
            row.iter_mut().for_each(|value| *value = *next.next().unwrap_or(&0.5));
            if let Some(diagonal) = row.last_mut() {
                *diagonal = definite[i] * (order as f64 + 1.0);
            }
        }
        a
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn agrees_with_dense(
            order in 1usize..30,
            reaches in prop::collection::vec(0usize..9, 7),
            entries in prop::collection::vec(-1.0..1.0f64, 83),
        ) {
            let mut a = quasi_definite(order, &reaches, &entries);
            let dense = DMatrix::from_fn(order, order, |i, j| a.get(i, j));
            let x = DVector::from_fn(order, |i, _| entries[(5 * i) % 83]);
            let mut b: Vec<f64> = (&dense * &x).iter().copied().collect();
            let mut rest = b.clone();
            a.subtract_product(x.as_slice(), &mut rest);
            prop_assert!(rest.iter().all(|r| r.abs() < 1e-12));
            prop_assert_eq!(a.solve_in_place(&mut b), Ok(()));
            prop_assert!((0..order).all(|i| (b[i] - x[i]).abs() < 1e-11));
        }
    }

    #[test]
    fn a_singular_row_is_named() {
        let mut a = Skyline::default();
        a.push_row(0)[0] = 0.3;
        a.push_row(0).copy_from_slice(&[0.1, 0.1 * 0.1 / 0.3]);
        a.push_row(2)[0] = 1.0;
        assert_eq!(a.solve_in_place(&mut [1.0; 3]), Err(1));
        a.clear();
        assert_eq!(a.order(), 0);
    }
}
