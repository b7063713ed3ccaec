//! Cubic beam elements by quadrature, and a banded Cholesky factor for their mass.

/// Values and derivatives of the four cubics of an element of length h at s = x/h: order 0 or 2.
pub fn cubics(s: f64, h: f64, order: usize) -> [f64; 4] {
    match order {
        0 => [
            1.0 - 3.0 * s * s + 2.0 * s * s * s,
            h * (s - 2.0 * s * s + s * s * s),
            3.0 * s * s - 2.0 * s * s * s,
            h * (s * s * s - s * s),
        ],
        _ => [(12.0 * s - 6.0) / (h * h), (6.0 * s - 4.0) / h, (6.0 - 12.0 * s) / (h * h), (6.0 * s - 2.0) / h],
    }
}

/// `factor` times the integral of the products of the cubics or of their curvatures, by four Gauss points.
pub fn integrated(factor: f64, h: f64, order: usize) -> [[f64; 4]; 4] {
    let points =
        [(0.339_981_043_584_856_3, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_9)];
    let mut matrix = [[0.0; 4]; 4];
    for (t, weight) in points.into_iter().flat_map(|(t, weight)| [(t, weight), (-t, weight)]) {
        let n = cubics(0.5 * (1.0 + t), h, order);
        for (i, row) in matrix.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += factor * 0.5 * h * weight * n[i] * n[j];
            }
        }
    }
    matrix
}

/// Cholesky factor of a banded matrix given by its rows of the lower band, four wide.
pub struct Band(Vec<[f64; 4]>);

impl Band {
    pub fn factor(mut rows: Vec<[f64; 4]>) -> Self {
        for i in 0..rows.len() {
            for d in (0..4.min(i + 1)).rev() {
                let j = i - d;
                let mut value = rows[i][d];
                for e in d + 1..4.min(i + 1) {
                    if e - d < 4 {
                        value -= rows[i][e] * rows[j][e - d];
                    }
                }
                rows[i][d] = if d == 0 { value.sqrt() } else { value / rows[j][0] };
            }
        }
        Self(rows)
    }

    pub fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        for i in 0..n {
            for d in 1..4.min(i + 1) {
                x[i] -= self.0[i][d] * x[i - d];
            }
            x[i] /= self.0[i][0];
        }
        for i in (0..n).rev() {
            for d in 1..4.min(n - i) {
                x[i] -= self.0[i + d][d] * x[i + d];
            }
            x[i] /= self.0[i][0];
        }
    }
}
