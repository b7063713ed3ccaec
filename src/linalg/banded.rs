//! Symmetric banded matrices: products, `L D Lᵀ` without pivoting, and columns of the inverse where they are not
//! negligible.
//!
//! The matrix is stored by diagonals, which makes a product a few straight runs through memory. The factor is stored by
//! rows of `width` entries beside the diagonal, oldest column first, so that a solve runs through memory once forward
//! and once back with the last `width` unknowns in registers. The width is the half band rounded up to one that has an
//! unrolled kernel; the entries added are zeros.

/// A symmetric matrix of which only the entries with `|i - j| <= half_band` differ from zero.
#[derive(Debug, Clone, PartialEq)]
pub struct SymmetricBanded {
    order: usize,
    half_band: usize,
    /// Diagonal d, from d `order` on: at row i the entry (i, i - d), the main diagonal first.
    diagonals: Vec<f64>,
}

/// A pivot that is not positive: the matrix is singular or indefinite at this row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositiveDefinite {
    pub row: usize,
}

/// The factors of a [`SymmetricBanded`] matrix.
#[derive(Debug, Clone)]
pub struct BandedFactor {
    width: usize,
    inverse_pivots: Vec<f64>,
    /// Row i of L: columns `i - width .. i`.
    lower: Vec<f64>,
    /// Row i of the transpose of L, backwards: columns `i + width .. i`, so that the nearest comes last.
    upper: Vec<f64>,
}

/// The part of a column of the inverse that is not negligible.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Window {
    /// Row of the first value.
    pub start: usize,
    pub values: Vec<f64>,
}

/// A pivot smaller than this part of its diagonal entry is rounding.
const SINGULAR: f64 = 1e-14;

fn kernel_width(half_band: usize) -> usize {
    match half_band {
        0..=4 => 4,
        5 => 5,
        6..=8 => 8,
        wider => wider,
    }
}

impl SymmetricBanded {
    /// The zero matrix.
    pub fn zeros(order: usize, half_band: usize) -> Self {
        Self { order, half_band, diagonals: vec![0.0; order * (half_band + 1)] }
    }

    pub fn order(&self) -> usize {
        self.order
    }

    pub fn half_band(&self) -> usize {
        self.half_band
    }

    /// Entries that a row of the factor holds.
    pub(super) fn kernel_width(&self) -> usize {
        kernel_width(self.half_band)
    }

    /// Adds `value` to the entries (i, j) and (j, i), once where they are the same.
    ///
    /// # Panics
    /// Where the entry lies outside the matrix or its band.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let (row, distance) = (i.max(j), i.abs_diff(j));
        assert!(distance <= self.half_band, "entry ({i}, {j}) outside a half band of {}", self.half_band);
        self.diagonals[distance * self.order + row] += value;
    }

    /// The entry (i, j); zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (row, distance) = (i.max(j), i.abs_diff(j));
        if distance <= self.half_band { self.diagonals[distance * self.order + row] } else { 0.0 }
    }

    /// Adds `factor` times a matrix of the same shape.
    ///
    /// # Panics
    /// Where the shapes differ.
    pub fn add_scaled(&mut self, factor: f64, other: &SymmetricBanded) {
        assert!(self.half_band == other.half_band && self.order == other.order, "matrices of two shapes");
        for (a, b) in self.diagonals.iter_mut().zip(&other.diagonals) {
            *a += factor * b;
        }
    }

    /// Replaces row and column `i` by those of the identity: the unknown `i` becomes its right-hand side.
    pub fn pin(&mut self, i: usize) {
        self.diagonals[i] = 1.0;
        for d in 1..=self.half_band {
            self.diagonals[d * self.order + i] = 0.0;
            if i + d < self.order {
                self.diagonals[d * self.order + i + d] = 0.0;
            }
        }
    }

    /// Computes `y -= A x`.
    pub fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        for d in 0..=self.half_band.min(self.order.saturating_sub(1)) {
            let diagonal = &self.diagonals[d * self.order + d..(d + 1) * self.order];
            for ((y, a), x) in y[d..].iter_mut().zip(diagonal).zip(x) {
                *y -= a * x;
            }
            if d > 0 {
                for ((y, a), x) in y.iter_mut().zip(diagonal).zip(&x[d..]) {
                    *y -= a * x;
                }
            }
        }
    }

    /// `xᵀ A x`.
    pub fn quadratic_form(&self, x: &[f64]) -> f64 {
        let mut sum = 0.0;
        for d in 0..=self.half_band.min(self.order.saturating_sub(1)) {
            let diagonal = &self.diagonals[d * self.order + d..(d + 1) * self.order];
            let products = diagonal.iter().zip(x).zip(&x[d..]).map(|((a, x), y)| a * x * y).sum::<f64>();
            sum += if d == 0 { products } else { 2.0 * products };
        }
        sum
    }

    /// Factors the matrix; fails with the first row whose pivot is not clearly positive.
    pub fn factor(&self) -> Result<BandedFactor, NotPositiveDefinite> {
        let (n, width) = (self.order, kernel_width(self.half_band));
        let mut lower = vec![0.0; n * width];
        for d in 1..=self.half_band {
            for i in d..n {
                lower[i * width + width - d] = self.diagonals[d * n + i];
            }
        }
        let mut pivots = vec![0.0; n];
        for i in 0..n {
            let reach = width.min(i);
            let (above, rest) = lower.split_at_mut(i * width);
            let row = &mut rest[..width];
            for d in (1..=reach).rev() {
                let column = i - d;
                let other = &above[column * width..(column + 1) * width];
                let mut t = row[width - d];
                // Both rows hold the columns from `i - width` on.
                for k in 0..width - d {
                    t -= row[k] * other[k + d];
                }
                row[width - d] = t;
            }
            let mut pivot = self.diagonals[i];
            for d in 1..=reach {
                let t = row[width - d];
                let l = t / pivots[i - d];
                pivot -= t * l;
                row[width - d] = l;
            }
            if pivot.is_nan() || pivot <= SINGULAR * self.diagonals[i] {
                return Err(NotPositiveDefinite { row: i });
            }
            pivots[i] = pivot;
        }
        let mut upper = vec![0.0; n * width];
        for i in 0..n {
            for d in 1..=width.min(i) {
                upper[(i - d) * width + width - d] = lower[i * width + width - d];
            }
        }
        Ok(BandedFactor { width, inverse_pivots: pivots.iter().map(|p| 1.0 / p).collect(), lower, upper })
    }
}

impl BandedFactor {
    /// Widths that have an unrolled kernel.
    pub(super) const UNROLLED: [usize; 3] = [4, 5, 8];

    pub fn order(&self) -> usize {
        self.inverse_pivots.len()
    }

    pub(super) fn inverse_pivots(&self) -> &[f64] {
        &self.inverse_pivots
    }

    pub(super) fn lower(&self) -> &[f64] {
        &self.lower
    }

    pub(super) fn upper(&self) -> &[f64] {
        &self.upper
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        match self.width {
            4 => self.solve_unrolled::<4>(x),
            5 => self.solve_unrolled::<5>(x),
            8 => self.solve_unrolled::<8>(x),
            _ => self.solve_rows(x, 0, self.order()),
        }
    }

    fn solve_unrolled<const W: usize>(&self, x: &mut [f64]) {
        let n = self.order();
        let x = &mut x[..n];
        let mut known = [0.0; W];
        for (row, xi) in self.lower.as_chunks::<W>().0.iter().zip(x.iter_mut()) {
            let mut value = *xi;
            for k in 0..W {
                value -= row[k] * known[k];
            }
            known.copy_within(1.., 0);
            known[W - 1] = value;
            *xi = value;
        }
        for (xi, p) in x.iter_mut().zip(&self.inverse_pivots) {
            *xi *= p;
        }
        known = [0.0; W];
        for (row, xi) in self.upper.as_chunks::<W>().0.iter().zip(x.iter_mut()).rev() {
            let mut value = *xi;
            for k in 0..W {
                value -= row[k] * known[k];
            }
            known.copy_within(1.., 0);
            known[W - 1] = value;
            *xi = value;
        }
    }

    /// Replaces a right-hand side by `L⁻¹` times it.
    pub(super) fn substitute_forward(&self, x: &mut [f64]) {
        for i in 0..self.order() {
            x[i] -= self.lower_row(i, self.width.min(i), x);
        }
    }

    /// Solves for a right-hand side that is zero outside the rows `first .. end`, as if the matrix ended there.
    fn solve_rows(&self, x: &mut [f64], first: usize, end: usize) {
        for i in first..end {
            let reach = self.width.min(i - first);
            x[i] -= self.lower_row(i, reach, x);
        }
        for i in (first..end).rev() {
            x[i] *= self.inverse_pivots[i];
            let reach = self.width.min(end - 1 - i);
            x[i] -= self.upper_row(i, reach, x);
        }
    }

    fn lower_row(&self, i: usize, reach: usize, x: &[f64]) -> f64 {
        let row = &self.lower[(i + 1) * self.width - reach..(i + 1) * self.width];
        row.iter().zip(&x[i - reach..i]).map(|(l, x)| l * x).sum()
    }

    fn upper_row(&self, i: usize, reach: usize, x: &[f64]) -> f64 {
        let row = &self.upper[(i + 1) * self.width - reach..(i + 1) * self.width];
        row.iter().rev().zip(&x[i + 1..i + 1 + reach]).map(|(l, x)| l * x).sum()
    }

    /// Column `j` of the inverse, cut where its entries fall for good below `negligible` times its largest one.
    ///
    /// The cost is that of the window: the inverse of a matrix with local coupling decays exponentially away from its
    /// diagonal, and so do its factors. `scratch` holds at least `order` zeros and leaves as zeros.
    pub fn inverse_column(&self, j: usize, negligible: f64, scratch: &mut [f64]) -> Window {
        let n = self.order();
        let quiet_rows = 2 * self.width; // this many small entries in a row: a decayed wave, not one of its zeros
        let x = scratch;
        x[j] = 1.0;
        let (mut end, mut largest, mut quiet) = (j + 1, self.inverse_pivots[j], 0);
        while end < n && quiet < quiet_rows {
            x[end] = -self.lower_row(end, self.width.min(end - j), x);
            let size = (x[end] * self.inverse_pivots[end]).abs();
            largest = f64::max(largest, size);
            quiet = if size < negligible * largest { quiet + 1 } else { 0 };
            end += 1;
        }
        let mut start = end;
        (largest, quiet) = (0.0, 0);
        while start > 0 && (start > j || quiet < quiet_rows) {
            start -= 1;
            let own = if start < j { 0.0 } else { x[start] * self.inverse_pivots[start] };
            x[start] = own - self.upper_row(start, self.width.min(end - 1 - start), x);
            largest = f64::max(largest, x[start].abs());
            quiet = if x[start].abs() < negligible * largest { quiet + 1 } else { 0 };
        }
        let floor = negligible * largest;
        while end > j + 1 && x[end - 1].abs() < floor {
            end -= 1;
            x[end] = 0.0;
        }
        while start < j && x[start].abs() < floor {
            x[start] = 0.0;
            start += 1;
        }
        let values = x[start..end].to_vec();
        x[start..end].fill(0.0);
        Window { start, values }
    }
}

impl Window {
    /// One past the last row.
    pub fn end(&self) -> usize {
        self.start + self.values.len()
    }

    /// The entry of a row; zero outside the window.
    #[inline]
    pub fn entry(&self, row: usize) -> f64 {
        self.values.get(row.wrapping_sub(self.start)).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    fn dense(a: &SymmetricBanded) -> DMatrix<f64> {
        DMatrix::from_fn(a.order(), a.order(), |i, j| a.get(i, j))
    }

    /// Random entries beside a diagonal that dominates them.
    fn spd(order: usize, half_band: usize, entries: &[f64]) -> SymmetricBanded {
        let mut a = SymmetricBanded::zeros(order, half_band);
        let mut next = entries.iter().cycle().copied();
        for i in 0..order {
            for j in i.saturating_sub(half_band)..i {
                a.add(i, j, next.next().unwrap_or(0.5));
            }
            a.add(i, i, 2.0 * half_band as f64 + 0.1);
        }
        a
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn agrees_with_dense(order in 1usize..40, half_band in 0usize..11, entries in prop::collection::vec(-1.0..1.0f64, 97)) {
            let a = spd(order, half_band, &entries);
            let x = DVector::from_fn(order, |i, _| entries[(7 * i) % 97]);
            let b = dense(&a) * &x;

            let mut product = vec![0.0; order];
            a.subtract_product(x.as_slice(), &mut product);
            prop_assert!((0..order).all(|i| (product[i] + b[i]).abs() < 1e-12));
            prop_assert!((a.quadratic_form(x.as_slice()) - x.dot(&b)).abs() < 1e-11);

            let factor = a.factor().unwrap();
            let mut solution: Vec<f64> = b.iter().copied().collect();
            factor.solve_in_place(&mut solution);
            prop_assert!((0..order).all(|i| (solution[i] - x[i]).abs() < 1e-12));

            let inverse = dense(&a).try_inverse().unwrap();
            let mut scratch = vec![0.0; order];
            for j in 0..order {
                let column = factor.inverse_column(j, 1e-18, &mut scratch);
                prop_assert!((0..order).all(|i| (column.entry(i) - inverse[(i, j)]).abs() < 1e-13));
                prop_assert!(scratch.iter().all(|x| *x == 0.0));
            }
        }
    }

    #[test]
    fn windows_stay_short_where_the_inverse_decays() {
        let a = spd(4000, 5, &[-0.3, 0.4, 0.1, -0.7]);
        let factor = a.factor().unwrap();
        let mut scratch = vec![0.0; 4000];
        let column = factor.inverse_column(2000, 1e-18, &mut scratch);
        assert!(column.values.len() < 400, "{}", column.values.len());
        let mut full = vec![0.0; 4000];
        full[2000] = 1.0;
        factor.solve_in_place(&mut full);
        let largest = full.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        assert!((0..4000).all(|i| (full[i] - column.entry(i)).abs() <= 1e-15 * largest));
    }

    #[test]
    fn pinned_rows_keep_their_right_hand_side() {
        let mut a = spd(9, 3, &[0.3, -0.2]);
        a.pin(4);
        let mut x = vec![1.0; 9];
        a.factor().unwrap().solve_in_place(&mut x);
        assert_eq!(x[4], 1.0);
    }

    #[test]
    fn a_mechanism_is_named_by_its_row() {
        let mut a = SymmetricBanded::zeros(3, 1);
        for i in 0..2 {
            a.add(i, i, 1.0);
            a.add(i + 1, i + 1, 1.0);
            a.add(i, i + 1, -1.0);
        }
        assert_eq!(a.factor().unwrap_err(), NotPositiveDefinite { row: 2 });
    }
}
