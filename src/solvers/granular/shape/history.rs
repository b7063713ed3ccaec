//! Finds, for each contact of this step, the contact of the last step whose shear force it continues.

use super::touch::Touch;
use nalgebra::Vector3;

/// Cosine of the largest rotation of the normal, 30 degrees, at which a contact counts as the same.
const SAME_TURN: f64 = 0.866_025_403_784_438_6;

/// For every present touch, finds the earlier contact (feature and unit normal) whose history it takes. The result goes
/// into `heirs`, which is emptied first.
///
/// A touch of the same feature continues. A new feature inherits from a feature that vanished in the same step if their
/// normals differ by less than 30 degrees, the closest pair first, so that a sphere that rolls from facet to facet
/// keeps its shear force. No history is inherited twice.
pub fn inherit(before: &[(u32, Vector3<f64>)], now: &[Touch], heirs: &mut Vec<Option<usize>>) {
    heirs.clear();
    heirs.extend(now.iter().map(|touch| before.iter().position(|(feature, _)| *feature == touch.feature)));
    // few contacts: searching all pairs needs no memory, and uses each vanished contact once
    while heirs.contains(&None) {
        let mut best = (SAME_TURN, None);
        for (old, (_, normal)) in before.iter().enumerate() {
            if heirs.contains(&Some(old)) {
                continue;
            }
            for (new, touch) in now.iter().enumerate().filter(|(new, _)| heirs[*new].is_none()) {
                let likeness = normal.dot(&touch.normal);
                if likeness > best.0 {
                    best = (likeness, Some((new, old)));
                }
            }
        }
        let Some((new, old)) = best.1 else { return };
        heirs[new] = Some(old);
    }
}
