//! Means with their confidence intervals.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Share of the means that lie outside of their intervals.
const OUTSIDE: f64 = 0.05;

/// The factor of a standard error that makes an interval with so many degrees of freedom, at least 1; `outside` is the
/// share of means that lie outside of it. Not a number if no such distribution exists.
fn student(freedom: usize, outside: f64) -> f64 {
    let t = StudentsT::new(0.0, 1.0, freedom.max(1) as f64);
    t.map_or(f64::NAN, |t| t.inverse_cdf(1.0 - 0.5 * outside))
}

/// Mean, and half the width of its 95 % confidence interval; `None` of fewer than two values.
pub fn mean_and_confidence(values: &[f64]) -> (f64, Option<f64>) {
    mean_and_interval(values, OUTSIDE)
}

/// Mean, and half the width of an interval that holds it but for a share `outside`; `None` of fewer than two values.
pub fn mean_and_interval(values: &[f64], outside: f64) -> (f64, Option<f64>) {
    let (mean, variance) = mean_and_variance(values);
    let half = variance.map(|variance| match variance {
        // a large factor is not to make something of nothing
        0.0 => 0.0,
        variance => student(values.len() - 1, outside) * (variance / values.len() as f64).sqrt(),
    });
    (mean, half)
}

/// Whether the 95 % interval of the mean reaches no further than this to either side.
pub fn is_known_within(values: &[f64], reach: f64) -> bool {
    mean_and_confidence(values).1.is_some_and(|half| half <= reach)
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
    Some(student(freedom.floor() as usize, OUTSIDE) * (a + b).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 97.5 % quantiles of Student's t for 1, 2, 3, 10 and 30 degrees of freedom, as tables print them.
    const TABLE: [(usize, f64); 5] = [(1, 12.706), (2, 4.303), (3, 3.182), (10, 2.228), (30, 2.042)];

    #[test]
    fn a_mean_is_as_sure_as_students_t_says() {
        assert_eq!(mean_and_confidence(&[3.0]), (3.0, None));
        for (freedom, t) in TABLE {
            assert!((student(freedom, OUTSIDE) - t).abs() < 5e-4, "{freedom}: {}", student(freedom, OUTSIDE));
        }
        // of 1, 2, 3: standard deviation 1, t of two degrees of freedom 4.303; 9.925 at 99 %
        let (mean, half) = mean_and_confidence(&[1.0, 2.0, 3.0]);
        assert!((mean - 2.0).abs() < 1e-12 && (half.unwrap() - 4.303 / 3f64.sqrt()).abs() < 1e-3);
        let (_, half) = mean_and_interval(&[1.0, 2.0, 3.0], 0.01);
        assert!((half.unwrap() - 9.925 / 3f64.sqrt()).abs() < 1e-3);
    }

    #[test]
    fn a_difference_is_as_sure_as_welch_says() {
        // equal deviations 1 of three values each: four degrees of freedom, t 2.776, standard error sqrt(2/3)
        let half = confidence_of_difference((1.0, 3), (1.0, 3)).unwrap();
        assert!((half - 2.776 * (2.0f64 / 3.0).sqrt()).abs() < 1e-3);
        assert_eq!(confidence_of_difference((1.0, 1), (1.0, 3)), None);
        assert_eq!(confidence_of_difference((0.0, 2), (0.0, 3)), Some(0.0));
    }
}
