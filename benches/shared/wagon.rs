//! The wagon that benchmarks and cases share.

use trackbed::solvers::track::Vehicle;

/// A wagon of 20 t axles, over one rail.
pub fn wagon() -> Vehicle {
    Vehicle {
        car_body_mass: 36_518.0,
        car_body_inertia: 36_518.0 * 3.91 * 3.91,
        bogie_mass: 400.0,
        bogie_inertia: 365.0,
        bogie_spacing: 6.77,
        wheel_mass: 670.5,
        wheelset_spacing: 1.78,
        primary_stiffness: 15e6,
        primary_damping: 35e3,
        secondary_stiffness: 1.875e6,
        secondary_damping: 5e3,
        hertz: 100e9,
    }
}
