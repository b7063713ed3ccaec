//! A banded factor worked from both ends at once.
//!
//! Substitution in a narrow band waits for each unknown before it can begin the next. With the matrix cut in two by a
//! separator as wide as the band, `A` from the top and `B` from the bottom (its rows taken backwards) do not wait for
//! each other:
//!
//! ```text
//! A = L_A D_A L_Aᵀ,   Y_A = L_A⁻¹ C_Aᵀ,   S = M - Y_Aᵀ D_A⁻¹ Y_A - Y_Bᵀ D_B⁻¹ Y_B
//! z_A = L_A⁻¹ f_A,   S x_s = f_s - Y_Aᵀ D_A⁻¹ z_A - Y_Bᵀ D_B⁻¹ z_B,   L_Aᵀ x_A = D_A⁻¹ (z_A - Y_A x_s)
//! ```
//!
//! where `C_A` couples the separator to `A`. `Y_A` has entries in its last rows only, as many as the band is wide.

use super::banded::{BandedFactor, NotPositiveDefinite, SymmetricBanded};
use nalgebra::DMatrix;

/// The factors of a [`SymmetricBanded`] matrix for many right-hand sides.
#[derive(Debug, Clone)]
pub enum TwistedFactor {
    /// A matrix too small or too wide to be cut.
    Whole(BandedFactor),
    Cut(Box<Cut>),
}

/// A matrix in two halves and a separator. What belongs to both halves stands side by side, `[of A, of B]`, so that one
/// instruction serves both.
#[derive(Debug, Clone)]
pub struct Cut {
    width: usize,
    /// Unknowns of each half.
    size: usize,
    separator: usize,
    /// Rows of `L` and, backwards, of its transpose, as in [`BandedFactor`].
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// `D⁻¹`.
    inverse_pivots: Vec<f64>,
    /// `D⁻¹ Y` of each half: its last rows, as many as the band is wide, each of one entry per row of the separator.
    couplings: [Vec<f64>; 2],
    /// `S⁻¹`, by rows.
    inverse: Vec<f64>,
}

impl TwistedFactor {
    /// Factors a matrix; fails with a row whose pivot is not clearly positive.
    pub fn new(matrix: &SymmetricBanded) -> Result<Self, NotPositiveDefinite> {
        let (n, width) = (matrix.order(), matrix.kernel_width());
        if n < 4 * width || !BandedFactor::UNROLLED.contains(&width) {
            return Ok(Self::Whole(matrix.factor()?));
        }
        let size = (n - width) / 2;
        let separator = n - 2 * size;
        let mut schur = DMatrix::from_fn(separator, separator, |r, c| matrix.get(size + r, size + c));
        let halve = |entry: &dyn Fn(usize, usize) -> f64| {
            let mut block = SymmetricBanded::zeros(size, matrix.half_band());
            for i in 0..size {
                for j in i.saturating_sub(matrix.half_band())..=i {
                    block.add(i, j, entry(i, j));
                }
            }
            let factor = block.factor()?;
            let mut coupling = DMatrix::zeros(width, separator);
            for r in 0..separator {
                let mut column = vec![0.0; size];
                for (i, value) in column.iter_mut().enumerate().skip(size - width) {
                    *value = entry(size + r, i);
                }
                factor.substitute_forward(&mut column);
                coupling.column_mut(r).copy_from_slice(&column[size - width..]);
            }
            let solved = coupling.clone();
            for (mut row, inverse_pivot) in coupling.row_iter_mut().zip(&factor.inverse_pivots()[size - width..]) {
                row *= *inverse_pivot;
            }
            Ok((factor, solved.transpose() * &coupling, coupling))
        };
        let (top, from_top, top_coupling) = halve(&|i, j| matrix.get(i, j))?;
        let (bottom, from_bottom, bottom_coupling) = halve(&|i, j| matrix.get(n - 1 - i, n - 1 - j))
            .map_err(|e: NotPositiveDefinite| NotPositiveDefinite { row: n - 1 - e.row })?;
        // The bottom half counts the rows of the separator backwards.
        schur -= from_top
            + DMatrix::from_fn(separator, separator, |r, c| from_bottom[(separator - 1 - r, separator - 1 - c)]);
        let bottom_coupling = DMatrix::from_fn(width, separator, |i, r| bottom_coupling[(i, separator - 1 - r)]);
        let inverse = schur.cholesky().ok_or(NotPositiveDefinite { row: size })?.inverse();
        Ok(Self::Cut(Box::new(Cut {
            width,
            size,
            separator,
            lower: side_by_side(top.lower(), bottom.lower()),
            upper: side_by_side(top.upper(), bottom.upper()),
            inverse_pivots: side_by_side(top.inverse_pivots(), bottom.inverse_pivots()),
            couplings: [top_coupling, bottom_coupling].map(|c| c.transpose().as_slice().to_vec()),
            inverse: inverse.as_slice().to_vec(),
        })))
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        match self {
            Self::Whole(factor) => factor.solve_in_place(x),
            Self::Cut(cut) => match cut.width {
                4 => cut.solve::<4>(x),
                5 => cut.solve::<5>(x),
                _ => cut.solve::<8>(x),
            },
        }
    }
}

impl Cut {
    fn solve<const W: usize>(&self, x: &mut [f64]) {
        let (top, rest) = x.split_at_mut(self.size);
        let (middle, bottom) = rest.split_at_mut(self.separator);

        let mut known = [[0.0; 2]; W];
        let lower = self.lower.as_chunks::<2>().0.as_chunks::<W>().0;
        for (row, (a, b)) in lower.iter().zip(top.iter_mut().zip(bottom.iter_mut().rev())) {
            advance(row, &mut known, [a, b]);
        }
        for (half, coupling) in self.couplings.iter().enumerate() {
            for (row, z) in coupling.chunks_exact(self.separator).zip(known) {
                middle.iter_mut().zip(row).for_each(|(m, c)| *m -= c * z[half]);
            }
        }
        let mut solved = [0.0; 16];
        for (value, row) in solved.iter_mut().zip(self.inverse.chunks_exact(self.separator)) {
            *value = row.iter().zip(middle.iter()).map(|(s, m)| s * m).sum();
        }
        middle.copy_from_slice(&solved[..self.separator]);

        let pivots = self.inverse_pivots.as_chunks::<2>().0;
        for (p, (a, b)) in pivots.iter().zip(top.iter_mut().zip(bottom.iter_mut().rev())) {
            *a *= p[0];
            *b *= p[1];
        }
        let carried = |coupling: &[f64]| coupling.iter().zip(&*middle).map(|(c, x)| c * x).sum::<f64>();
        let [of_top, of_bottom] = &self.couplings;
        for (a, coupling) in top[self.size - W..].iter_mut().zip(of_top.chunks_exact(self.separator)) {
            *a -= carried(coupling);
        }
        for (b, coupling) in bottom[..W].iter_mut().rev().zip(of_bottom.chunks_exact(self.separator)) {
            *b -= carried(coupling);
        }
        known = [[0.0; 2]; W];
        let upper = self.upper.as_chunks::<2>().0.as_chunks::<W>().0;
        for (row, (a, b)) in upper.iter().rev().zip(top.iter_mut().rev().zip(bottom.iter_mut())) {
            advance(row, &mut known, [a, b]);
        }
    }
}

/// One unknown more of both halves; `known` holds the last ones, the nearest last.
#[inline(always)]
fn advance<const W: usize>(row: &[[f64; 2]; W], known: &mut [[f64; 2]; W], x: [&mut f64; 2]) {
    let [a, b] = x;
    let mut value = [*a, *b];
    for k in 0..W {
        for half in 0..2 {
            value[half] -= row[k][half] * known[k][half];
        }
    }
    known.copy_within(1.., 0);
    known[W - 1] = value;
    [*a, *b] = value;
}

fn side_by_side(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).flat_map(|(a, b)| [*a, *b]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_the_plain_factor(
            order in 1usize..90,
            half_band in 0usize..9,
            entries in prop::collection::vec(-1.0..1.0f64, 1..200),
        ) {
            let mut matrix = SymmetricBanded::zeros(order, half_band);
            let mut next = entries.iter().cycle().copied();
            for i in 0..order {
                for j in i.saturating_sub(half_band)..i {
                    matrix.add(i, j, next.next().unwrap());
                }
                matrix.add(i, i, 2.0 * half_band as f64 + 1.0);
            }
            let right: Vec<f64> = (0..order).map(|_| next.next().unwrap()).collect();
            let (mut plain, mut twisted) = (right.clone(), right);
            matrix.factor().unwrap().solve_in_place(&mut plain);
            TwistedFactor::new(&matrix).unwrap().solve_in_place(&mut twisted);
            for (a, b) in plain.iter().zip(&twisted) {
                prop_assert!((a - b).abs() < 1e-13, "{} {}", a, b);
            }
        }
    }

    #[test]
    fn a_singular_row_is_named() {
        for row in [3, 50, 97] {
            let mut matrix = SymmetricBanded::zeros(100, 3);
            for i in 0..100 {
                matrix.add(i, i, if i == row { -1.0 } else { 1.0 });
            }
            let found = TwistedFactor::new(&matrix).unwrap_err().row;
            assert!(found.abs_diff(row) < 3, "row {row}, found {found}");
        }
    }
}
