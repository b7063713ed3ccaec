//! Which contact of this step goes on with the shear force of which contact of the last.

use super::touch::Touch;
use nalgebra::Vector3;

/// Cosine of the largest turn of the normal, 30 degrees, over which a contact is taken for the same.
const SAME_TURN: f64 = 0.866_025_403_784_438_6;

/// For every touch of now the contact of before (feature and unit normal) whose history it takes, into `heirs`, which is
/// emptied first.
///
/// A touch of the same feature goes on. A new feature inherits from one that vanished in the same step if their normals
/// differ by less than 30 degrees, the closest pair first, so that a sphere which rolls from facet to facet keeps its
/// shear force. Nothing is inherited twice.
pub fn inherit(before: &[(u32, Vector3<f64>)], now: &[Touch], heirs: &mut Vec<Option<usize>>) {
    heirs.clear();
    heirs.extend(now.iter().map(|touch| before.iter().position(|(feature, _)| *feature == touch.feature)));
    // few contacts: looking through all pairs needs no memory, and gives each vanished one away once
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
