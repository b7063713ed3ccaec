//! The wagon, body by body.

use crate::solvers::track::Vehicle;

/// The equation of motion of every body, written out.
pub fn accelerations(wagon: &Vehicle, gravity: f64, z: &[f64], v: &[f64], wheel_forces: [f64; 4], a: &mut [f64]) {
    let (half_base, half_axles) = (0.5 * wagon.bogie_spacing, 0.5 * wagon.wheelset_spacing);
    let (mut body_force, mut body_moment) = (0.0, 0.0);
    for (bogie, ahead) in [(0usize, 1.0), (1, -1.0)] {
        let (bounce, pitch) = (2 + 2 * bogie, 3 + 2 * bogie);
        let closing = |q: &[f64]| q[0] + ahead * half_base * q[1] - q[bounce];
        let secondary = wagon.secondary_stiffness * closing(z) + wagon.secondary_damping * closing(v);
        body_force -= secondary;
        body_moment -= ahead * half_base * secondary;
        let (mut force, mut moment) = (secondary, 0.0);
        for (axle, ahead) in [(0usize, 1.0), (1, -1.0)] {
            let wheel = 2 * bogie + axle;
            let closing = |q: &[f64]| q[bounce] + ahead * half_axles * q[pitch] - q[6 + wheel];
            let primary = wagon.primary_stiffness * closing(z) + wagon.primary_damping * closing(v);
            force -= primary;
            moment -= ahead * half_axles * primary;
            a[6 + wheel] = gravity + (primary - wheel_forces[wheel]) / wagon.wheel_mass;
        }
        a[bounce] = gravity + force / wagon.bogie_mass;
        a[pitch] = moment / wagon.bogie_inertia;
    }
    a[0] = gravity + body_force / wagon.car_body_mass;
    a[1] = body_moment / wagon.car_body_inertia;
}
