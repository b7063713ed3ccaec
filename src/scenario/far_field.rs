//! The far field of a track: the responses of sleepers far from every transition.

use super::Track;

/// Distance from every transition beyond which a sleeper is in the far field, m.
const DISTANCE: f64 = 10.0;

impl Track {
    /// Median of values by chainage (m) in the far field; if no sleeper is far enough, of the half that is farthest
    /// from every transition.
    pub fn far_field(&self, values: Vec<(f64, f64)>) -> Option<f64> {
        let distance = |x: f64| {
            let distances = self.transitions.iter().map(|transition| (x - transition.x).abs());
            distances.fold(f64::INFINITY, f64::min)
        };
        let mut by_distance: Vec<(f64, f64)> = values.into_iter().map(|(x, value)| (distance(x), value)).collect();
        by_distance.sort_by(|a, b| b.0.total_cmp(&a.0));
        let far = by_distance.iter().take_while(|(distance, _)| *distance > DISTANCE).count();
        let far = if far == 0 { by_distance.len().div_ceil(2) } else { far };
        median(by_distance[..far].iter().map(|(_, value)| *value).collect())
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some((values[middle - 1] + values[middle]) / 2.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
    }
}
