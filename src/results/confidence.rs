//! Means with their confidence intervals.

/// 97.5 % quantiles of Student's t for 1, 2, ... degrees of freedom; beyond them that of the normal distribution
/// serves.
const STUDENT: [f64; 20] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
    2.110, 2.101, 2.093, 2.086,
];

/// The factor of a standard error that makes a 95 % interval with so many degrees of freedom, at least 1.
fn student(freedom: usize) -> f64 {
    STUDENT.get(freedom.saturating_sub(1)).copied().unwrap_or(1.960)
}

/// Mean, and half the width of its 95 % confidence interval; `None` of fewer than two values.
pub fn mean_and_confidence(values: &[f64]) -> (f64, Option<f64>) {
    let (mean, variance) = mean_and_variance(values);
    (mean, variance.map(|variance| student(values.len() - 1) * (variance / values.len() as f64).sqrt()))
}

/// Mean and standard deviation of one value; `None` of fewer than two values.
pub fn mean_and_deviation(values: &[f64]) -> (f64, Option<f64>) {
    let (mean, variance) = mean_and_variance(values);
    (mean, variance.map(f64::sqrt))
}

fn mean_and_variance(values: &[f64]) -> (f64, Option<f64>) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    if values.len() < 2 {
        return (mean, None);
    }
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, Some(squares / (count - 1.0)))
}

/// Half the width of the 95 % interval of a difference of two independent means, each of so many values with that
/// deviation (Welch).
pub fn confidence_of_difference((one, ones): (f64, usize), (other, others): (f64, usize)) -> Option<f64> {
    if ones < 2 || others < 2 {
        return None;
    }
    let (a, b) = (one * one / ones as f64, other * other / others as f64);
    if a + b == 0.0 {
        return Some(0.0);
    }
    let freedom = (a + b).powi(2) / (a * a / (ones - 1) as f64 + b * b / (others - 1) as f64);
    Some(student(freedom.floor() as usize) * (a + b).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_is_as_sure_as_students_t_says() {
        assert_eq!(mean_and_confidence(&[3.0]), (3.0, None));
        // of 1, 2, 3: standard deviation 1, t of two degrees of freedom 4.303
        let (mean, half) = mean_and_confidence(&[1.0, 2.0, 3.0]);
        assert!((mean - 2.0).abs() < 1e-12 && (half.unwrap() - 4.303 / 3f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn a_difference_is_as_sure_as_welch_says() {
        // equal deviations 1 of three values each: four degrees of freedom, t 2.776, standard error sqrt(2/3)
        let half = confidence_of_difference((1.0, 3), (1.0, 3)).unwrap();
        assert!((half - 2.776 * (2.0f64 / 3.0).sqrt()).abs() < 1e-9);
        assert_eq!(confidence_of_difference((1.0, 1), (1.0, 3)), None);
        assert_eq!(confidence_of_difference((0.0, 2), (0.0, 3)), Some(0.0));
    }
}
