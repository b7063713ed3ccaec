//! Beds that several tests share, and what reads them.

use std::sync::OnceLock;
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Sphere,
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
    Bed::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(law)))
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

/// A number in -1..1 from a seed that it moves on.
pub fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 33) as f64 / f64::from(1u32 << 30) - 1.0
}

/// Inward planes of a box without a lid: points and normals.
pub fn walls(side: f64) -> [(Vec3, Vec3); 5] {
    [
        ([0.0; 3], [0.0, 0.0, 1.0]),
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([side, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ([0.0; 3], [0.0, 1.0, 0.0]),
        ([0.0, side, 0.0], [0.0, -1.0, 0.0]),
    ]
}

/// 200 spheres of 28 to 50 mm at rest in a box, and the side of the box.
pub fn packed() -> (Vec<Sphere>, f64) {
    static PACKED: OnceLock<(Vec<Sphere>, f64)> = OnceLock::new();
    PACKED.get_or_init(pack).clone()
}

/// Packs without friction and without rolling, under many times its weight, and then lets friction and weight decide.
fn pack() -> (Vec<Sphere>, f64) {
    let (across, layers, pitch, mut seed) = (5, 8, 0.05, 3);
    let side = pitch * across as f64;
    let mut spheres = Vec::new();
    for k in 0..across * across * layers {
        let cell = [k % across, k / across % across, k / (across * across)];
        let lean = 1e-3 * random(&mut seed);
        let centre = [lean, -lean, 2.0 * lean];
        let centre = [0, 1, 2].map(|c| centre[c] + pitch * (0.5 + cell[c] as f64));
        spheres.push(Sphere { centre, radius: 0.0195 + 0.0055 * random(&mut seed), ..sphere(centre) });
    }
    settle(&mut spheres, side, springs(1e7, 0.0), true, &[(100.0, 6000), (10.0, 2000)]);
    settle(&mut spheres, side, Linear { friction: 0.5, ..springs(1e7, 1e7) }, false, &[(10.0, 2000), (1.0, 8000)]);
    (spheres, side)
}

/// Moves spheres to where they come to rest under multiples of their weight, for some steps each.
fn settle(spheres: &mut [Sphere], side: f64, law: Linear, held: bool, stages: &[(f64, u64)]) {
    let mut bed = open(law);
    for (point, normal) in walls(side) {
        bed.add_plane(point, normal, 0);
    }
    for sphere in spheres.iter() {
        let id = bed.add_sphere(sphere);
        if held {
            bed.hold_rotation(id);
        }
    }
    bed.set_damping(0.7);
    bed.set_time_step(1.5e-5);
    for &(weights, steps) in stages {
        bed.set_gravity(Gravity::Constant([0.0, 0.0, -weights * GRAVITY]));
        alone(|| bed.run(steps)).unwrap();
    }
    for (sphere, state) in spheres.iter_mut().zip(bed.states()) {
        sphere.centre = state.place;
    }
}
