//! Small dense symmetric systems in the caller's scratch, without allocation.
//!
//! Factors `A = L D Lᵀ` without pivoting. That is stable for positive definite and for quasi-definite matrices (Vanderbei
//! 1995): a positive definite block and a negative definite one with any coupling between them, in any order.

/// Solves `A x = b` in place; returns the row of a pivot that is zero or not finite.
///
/// `a` holds `A` row by row (`order` x `order`); only its lower triangle is read and it is overwritten. `b` enters as the
/// right-hand side and leaves as the solution.
pub fn solve_symmetric(a: &mut [f64], order: usize, b: &mut [f64]) -> Result<(), usize> {
    for j in 0..order {
        let (above, rest) = a.split_at_mut(j * order);
        let row_j = &mut rest[..order];
        // Row j holds t_k = L_jk D_k until its pivot is known.
        let mut pivot = row_j[j];
        for k in 0..j {
            let row_k = &above[k * order..k * order + k];
            let mut t = row_j[k];
            for (m, l) in row_k.iter().enumerate() {
                t -= row_j[m] * l;
            }
            row_j[k] = t;
        }
        for k in 0..j {
            let l = row_j[k] / above[k * order + k];
            pivot -= row_j[k] * l;
            row_j[k] = l;
        }
        if pivot == 0.0 || !pivot.is_finite() {
            return Err(j);
        }
        row_j[j] = pivot;
        let mut x = b[j];
        for k in 0..j {
            x -= row_j[k] * b[k];
        }
        b[j] = x;
    }
    for j in 0..order {
        b[j] /= a[j * order + j];
    }
    for j in (0..order).rev() {
        let x = b[j];
        for k in 0..j {
            b[k] -= a[j * order + k] * x;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quasi_definite_system_is_solved() {
        let a = [4.0, 1.0, 0.5, 1.0, -3.0, 0.2, 0.5, 0.2, 2.0];
        let x = [1.0, -2.0, 3.0];
        let mut b: Vec<f64> = (0..3).map(|i| (0..3).map(|j| a[3 * i + j] * x[j]).sum()).collect();
        assert_eq!(solve_symmetric(&mut a.clone(), 3, &mut b), Ok(()));
        for (found, expected) in b.iter().zip(x) {
            assert!((found - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn zero_pivot_is_reported() {
        let mut a = [1.0, 1.0, 1.0, 1.0];
        assert_eq!(solve_symmetric(&mut a, 2, &mut [1.0, 1.0]), Err(1));
    }
}
