//! Beds that several tests share, and what reads them.

use trackbed::solvers::granular::{
    Bed, BodyId, Dashpot, DashpotMode, Domain, FrictionLimit, Law, Laws, Linear, Sphere,
};

pub type Vec3 = [f64; 3];

/// Radius \[m\] and density \[kg/m3\] of a sphere of ballast.
pub const RADIUS: f64 = 0.028;
pub const DENSITY: f64 = 2700.0;
pub const GRAVITY: f64 = 9.81;

/// Springs alone: no friction, no dashpots \[N/m\].
pub fn springs(normal_stiffness: f64, shear_stiffness: f64) -> Linear {
    Linear {
        normal_stiffness,
        shear_stiffness,
        friction: 0.0,
        dashpot: Dashpot::Ratio { normal: 0.0, shear: 0.0 },
        mode: DashpotMode::Full,
        limit: FrictionLimit::Spring,
    }
}

/// Everything by one linear law, in an open space.
pub fn open(law: Linear) -> Bed<f64> {
    Bed::new(Domain::open(), Laws::single(Law::Linear(law)))
}

pub fn sphere(centre: Vec3) -> Sphere {
    Sphere { centre, radius: RADIUS, density: DENSITY, surface: 0 }
}

/// Of a sphere \[kg\].
pub fn mass(radius: f64, density: f64) -> f64 {
    density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

/// Work on the calling thread alone: a few spheres are done before another thread is awake.
pub fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    threads(1, work)
}

pub fn threads<T: Send>(count: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(work)
}

/// Value at a step of zero of a value that errs by the first power of the step, from a step and its half.
pub fn extrapolated(whole: f64, half: f64) -> f64 {
    2.0 * half - whole
}

#[track_caller]
pub fn close(found: f64, expected: f64, share: f64, what: &str) {
    let error = (found / expected - 1.0).abs();
    assert!(error <= share, "{what}: {found} against {expected}, {error:.2e} off");
}

/// Velocity along an axis \[m/s\].
pub fn speed(bed: &Bed<f64>, id: BodyId, axis: usize) -> f64 {
    bed.body_state(id).velocity[axis]
}

pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn scaled(a: Vec3, factor: f64) -> Vec3 {
    a.map(|x| x * factor)
}

pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// Errors in two digits.
pub fn shown(errors: &[f64]) -> String {
    errors.iter().map(|e| format!("{e:.1e}")).collect::<Vec<_>>().join(", ")
}
