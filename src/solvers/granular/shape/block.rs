//! A sphere on a solid block: one contact, with the face, edge or corner whose region of space contains the centre.

use super::touch::Touch;
use nalgebra::Vector3;

/// The number of one of the 26 regions around the block: along each axis below (0), beside (1) or above (2) the block.
/// 13 is the inside.
fn feature(sides: Vector3<f64>) -> u32 {
    let digit = |s: f64| if s < 0.0 { 0 } else { u32::from(s > 0.0) + 1 };
    digit(sides.x) + 3 * digit(sides.y) + 9 * digit(sides.z)
}

pub(super) fn touch(half: &Vector3<f64>, centre: &Vector3<f64>, reach: f64) -> Option<Touch> {
    let away = centre - centre.zip_map(half, |c, h| c.clamp(-h, h));
    let distance = away.norm();
    // a distance whose square is not a finite number does not count
    if distance > 0.0 {
        return (distance < reach).then(|| Touch { normal: away / distance, distance, feature: feature(away) });
    }
    let depths = half - centre.abs();
    let axis = depths.imin();
    let mut normal = Vector3::zeros();
    normal[axis] = 1.0f64.copysign(centre[axis]);
    Some(Touch { normal, distance: -depths[axis], feature: feature(normal) })
}

pub(super) fn contains(half: &Vector3<f64>, point: &Vector3<f64>) -> bool {
    point.iter().zip(half).all(|(p, h)| p.abs() < *h)
}
