//! Thins a long series to what the pixels can show, with every peak kept.

/// Keeps the first, lowest, highest and last point of each column of `column` px; the order stays.
pub fn thin(points: &[(f64, f64)], column: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let of = |point: &(f64, f64)| (point.0 / column).floor();
    for group in points.chunk_by(|a, b| of(a) == of(b)) {
        if group.len() <= 4 {
            kept.extend(group);
            continue;
        }
        let by_height = |a: &usize, b: &usize| group[*a].1.total_cmp(&group[*b].1);
        let lowest = (0..group.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..group.len()).max_by(by_height).unwrap_or(0);
        let mut chosen = [0, lowest, highest, group.len() - 1];
        chosen.sort_unstable();
        let mut last = None;
        kept.extend(chosen.into_iter().filter(|index| last.replace(*index) != Some(*index)).map(|i| group[i]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_peaks_and_ends() {
        let mut points: Vec<(f64, f64)> = (0..10_000).map(|k| (f64::from(k) / 100.0, 1.0)).collect();
        points[4321].1 = 9.0;
        points[4355].1 = -9.0;
        let thinned = thin(&points, 1.0);
        assert!(thinned.len() <= 400);
        assert!(thinned.contains(&points[4321]) && thinned.contains(&points[4355]));
        assert_eq!((thinned[0], thinned[thinned.len() - 1]), (points[0], points[9999]));
        assert!(thinned.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
