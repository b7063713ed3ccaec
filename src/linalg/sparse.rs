//! Sparse symmetric positive definite systems: Cholesky's factorisation with an ordering of little fill. The only user
//! of `faer`.
//!
//! The order of elimination and the places of the fill depend on the pattern alone: they are found once, and factors of
//! other values of the same pattern reuse them.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{MatMut, Side};

/// The lower half of a symmetric matrix, column by column.
#[derive(Debug, Clone)]
pub struct SparseSymmetric {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

/// The order of elimination and the places of the fill.
#[derive(Debug, Clone)]
pub struct Analysis(SymbolicLlt<usize>);

/// The factor `L` of `A = L Lᵀ`.
#[derive(Debug, Clone)]
pub struct Cholesky(Llt<usize, f64>);

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FactorError {
    /// The matrix is not positive definite.
    NotDefinite,
    /// The factor does not fit into memory.
    TooLarge,
}

impl SparseSymmetric {
    /// Zeros at the places where two unknowns stand in a group together, and on the diagonal.
    ///
    /// # Panics
    /// A group names an unknown that is not below `order`.
    pub fn from_groups<G: AsRef<[usize]>>(order: usize, groups: &[G]) -> SparseSymmetric {
        let mut groups_of: Vec<Vec<u32>> = vec![Vec::new(); order];
        for (number, group) in groups.iter().enumerate() {
            for &unknown in group.as_ref() {
                groups_of[unknown].push(number as u32);
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        let mut column_rows = Vec::new();
        for (column, numbers) in groups_of.iter().enumerate() {
            column_rows.clear();
            column_rows.push(column);
            for &number in numbers {
                column_rows.extend(groups[number as usize].as_ref().iter().copied().filter(|&row| row > column));
            }
            column_rows.sort_unstable();
            column_rows.dedup();
            rows.extend_from_slice(&column_rows);
            starts.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        SparseSymmetric { starts, rows, values }
    }

    pub fn order(&self) -> usize {
        self.starts.len() - 1
    }

    /// Entries that are stored: the diagonal and one half.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// Sets all values to zero and keeps the pattern.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds to the entries (i, j) and (j, i).
    ///
    /// # Panics
    /// The pattern has no such entry.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let (row, column) = (i.max(j), i.min(j));
        let (from, to) = (self.starts[column], self.starts[column + 1]);
        let at = self.rows[from..to].binary_search(&row).expect("an entry of the pattern");
        self.values[from + at] += value;
    }

    /// Computes `y = A x`.
    pub fn product(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for column in 0..self.order() {
            let (from, to) = (self.starts[column], self.starts[column + 1]);
            let mut sum = self.values[from] * x[column];
            for (&row, value) in self.rows[from + 1..to].iter().zip(&self.values[from + 1..to]) {
                sum += value * x[row];
                y[row] += value * x[column];
            }
            y[column] += sum;
        }
    }

    /// Finds an order of elimination and the places of the fill.
    ///
    /// # Errors
    /// The factor does not fit into memory.
    pub fn analyse(&self) -> Result<Analysis, FactorError> {
        let analysis = SymbolicLlt::try_new(self.pattern(), Side::Lower);
        analysis.map(Analysis).map_err(|_| FactorError::TooLarge)
    }

    /// Factors the matrix by the analysis of its pattern.
    ///
    /// # Errors
    /// The matrix is not positive definite, or the factor does not fit into memory.
    pub fn factor(&self, analysis: &Analysis) -> Result<Cholesky, FactorError> {
        use faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot;
        let matrix = SparseColMatRef::new(self.pattern(), &self.values);
        match Llt::try_new_with_symbolic(analysis.0.clone(), matrix, Side::Lower) {
            Ok(factor) => Ok(Cholesky(factor)),
            Err(faer::sparse::linalg::LltError::Numeric(NonPositivePivot { .. })) => Err(FactorError::NotDefinite),
            Err(_) => Err(FactorError::TooLarge),
        }
    }

    fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.order(), self.order(), &self.starts, None, &self.rows)
    }
}

impl Cholesky {
    /// Replaces right-hand sides, one after the other, by their solutions.
    pub fn solve_in_place(&self, sides: &mut [f64], order: usize) {
        let columns = sides.len().checked_div(order).unwrap_or(0);
        if columns > 0 {
            self.0.solve_in_place(MatMut::from_column_major_slice_mut(sides, order, columns));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of springs between walls, with a second pattern of values.
    fn chain(order: usize, stiffness: f64) -> SparseSymmetric {
        let groups: Vec<[usize; 2]> = (1..order).map(|i| [i - 1, i]).collect();
        let mut a = SparseSymmetric::from_groups(order, &groups);
        for [i, j] in groups {
            a.add(i, i, stiffness);
            a.add(j, j, stiffness);
            a.add(i, j, -stiffness);
        }
        a.add(0, 0, stiffness);
        a.add(order - 1, order - 1, stiffness);
        a
    }

    #[test]
    fn a_chain_of_springs_between_walls() {
        let analysis = chain(50, 1.0).analyse().unwrap();
        for stiffness in [1.0, 40e6] {
            let a = chain(50, stiffness);
            // each of the nodes bears a unit of force: a parabola
            let mut x = vec![1.0; 100];
            a.factor(&analysis).unwrap().solve_in_place(&mut x, 50);
            for (i, x) in x.iter().enumerate() {
                let at = (i % 50 + 1) as f64;
                assert!((x * stiffness - 0.5 * at * (51.0 - at)).abs() < 1e-9);
            }
            let mut back = vec![0.0; 50];
            a.product(&x[..50], &mut back);
            assert!(back.iter().all(|y| (y - 1.0).abs() < 1e-9));
        }
    }

    #[test]
    fn a_matrix_that_is_not_definite_is_told() {
        let mut a = chain(5, 1.0);
        let analysis = a.analyse().unwrap();
        a.add(2, 2, -10.0);
        assert!(matches!(a.factor(&analysis), Err(FactorError::NotDefinite)));
    }
}
