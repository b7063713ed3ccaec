//! Vectors of numbers that stand side by side in memory.

/// Adds `factor` times `x` to the first numbers of `y`.
#[inline]
pub fn add_scaled(y: &mut [f64], x: &[f64], factor: f64) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
