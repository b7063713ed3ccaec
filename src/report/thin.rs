//! Thins a long series to the resolution of the pixels; every peak is kept.

/// Distance from a straight line that is not visible, px.
pub const UNSEEN: f64 = 0.08;
/// Points that one straight piece may stand for, so that the search stays linear.
const LONGEST: usize = 128;

/// Leaves out points that lie nearer than `off` to the straight line between those that stay, px; x grows.
pub fn straighten(points: &[(f64, f64)], off: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let mut from = 0;
    for next in 2..points.len() {
        if next - from > LONGEST || !straight(&points[from..=next], off) {
            from = next - 1;
            kept.push(points[from]);
        }
    }
    kept.extend(points.get(1..).and_then(<[_]>::last));
    kept
}

/// Whether everything between the ends lies on the line between them.
fn straight(points: &[(f64, f64)], off: f64) -> bool {
    let (Some(a), Some(b)) = (points.first(), points.last()) else { return true };
    let slope = (b.1 - a.1) / (b.0 - a.0);
    points.iter().all(|p| (a.1 + slope * (p.0 - a.0) - p.1).abs() <= off)
}

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
    fn straight_pieces_keep_their_ends() {
        let corner: Vec<(f64, f64)> = (0..=100).map(f64::from).map(|x| (x, (x - 50.0).abs())).collect();
        assert_eq!(straighten(&corner, UNSEEN), [(0.0, 50.0), (50.0, 0.0), (100.0, 50.0)]);
        let wave: Vec<(f64, f64)> = (0..400).map(f64::from).map(|k| (k / 4.0, 40.0 * (k / 40.0).sin())).collect();
        let kept = straighten(&wave, UNSEEN);
        assert!(kept.len() < 200 && kept[0] == wave[0] && kept[kept.len() - 1] == wave[399]);
        // the points left out lie on the remaining line
        for (x, y) in &wave {
            let after = kept.iter().position(|p| p.0 >= *x).unwrap().max(1);
            let (a, b) = (kept[after - 1], kept[after]);
            assert!((a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0) - y).abs() <= UNSEEN);
        }
        assert_eq!(straighten(&[], UNSEEN), []);
        assert_eq!(straighten(&wave[..1], UNSEEN), wave[..1]);
        assert_eq!(straighten(&wave[..2], UNSEEN), wave[..2]);
    }

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
