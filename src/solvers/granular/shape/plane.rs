//! A sphere on a plane through the origin; the solid is behind the normal.

use super::touch::Touch;
use nalgebra::Vector3;

pub(super) fn touch(normal: &Vector3<f64>, centre: &Vector3<f64>, reach: f64) -> Option<Touch> {
    let distance = normal.dot(centre);
    (distance < reach).then_some(Touch { normal: *normal, distance, feature: 0 })
}
