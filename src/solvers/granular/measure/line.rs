//! The part of a straight line that lies in a region.

use super::region::{Region, RegionShape};

impl Region {
    /// Share of the straight line between two points (m) inside the region, 0 .. 1. For a space divided into boxes the
    /// shares add up to 1.
    pub fn share_of_line(&self, from: &[f64; 3], to: &[f64; 3]) -> f64 {
        let [start, end] = match &self.0 {
            RegionShape::Block { lower, upper } => within_block(lower, upper, from, to),
            RegionShape::Ball { centre, radius } => within_ball(centre, *radius, from, to),
        };
        (end.min(1.0) - start.max(0.0)).max(0.0)
    }
}

/// Start and end of the part inside along the line, 0 at `from` and 1 at `to`.
fn within_block(lower: &[f64; 3], upper: &[f64; 3], from: &[f64; 3], to: &[f64; 3]) -> [f64; 2] {
    let mut inside = [f64::NEG_INFINITY, f64::INFINITY];
    for k in 0..3 {
        let way = to[k] - from[k];
        if way == 0.0 {
            // as in `holds`: a line in a face belongs to one of two boxes
            if !(lower[k] <= from[k] && from[k] < upper[k]) {
                return [1.0, 0.0];
            }
            continue;
        }
        let (a, b) = ((lower[k] - from[k]) / way, (upper[k] - from[k]) / way);
        inside = [inside[0].max(a.min(b)), inside[1].min(a.max(b))];
    }
    inside
}

/// Values of t at which `|from + t (to - from) - centre| = radius`.
fn within_ball(centre: &[f64; 3], radius: f64, from: &[f64; 3], to: &[f64; 3]) -> [f64; 2] {
    let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let way: [f64; 3] = std::array::from_fn(|k| to[k] - from[k]);
    let away: [f64; 3] = std::array::from_fn(|k| from[k] - centre[k]);
    let (square, along) = (dot(&way, &way), dot(&way, &away));
    let room = along * along - square * (dot(&away, &away) - radius * radius);
    if square == 0.0 || room < 0.0 {
        return [1.0, 0.0];
    }
    [(-along - room.sqrt()) / square, (-along + room.sqrt()) / square]
}
