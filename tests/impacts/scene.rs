//! What the tests share: small beds, laws, vectors.

use trackbed::solvers::granular::{
    Bed, BodyId, BodyState, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, HertzMindlin, Linear,
    Real, Sphere,
};

/// An open bed under one law.
pub fn bed<R: Real>(law: ContactLaw, dt: f64) -> Bed<R> {
    let mut bed = Bed::new(Domain::open(), ContactLaws::single(law));
    bed.set_time_step(dt);
    bed
}

pub fn sphere(centre: [f64; 3], radius: f64, density: f64) -> Sphere {
    Sphere { centre, radius, density, surface: 0 }
}

/// Puts a sphere of a radius (m) in, moving (m/s, rad/s).
pub fn put<R: Real>(bed: &mut Bed<R>, sphere: Sphere, velocity: [f64; 3], spin: [f64; 3]) -> BodyId {
    let id = bed.add_sphere(&sphere);
    bed.set_velocity(id, velocity, spin);
    id
}

/// Springs of equal stiffness (N/m) without dashpots.
pub fn springs(stiffness: f64, friction: f64) -> Linear {
    damped(stiffness, friction, 0.0)
}

/// Springs with dashpots of a share of critical damping, which do not pull.
pub fn damped(stiffness: f64, friction: f64, ratio: f64) -> Linear {
    Linear {
        normal_stiffness: stiffness,
        shear_stiffness: stiffness,
        friction,
        dashpot: Dashpot::Ratio { normal: ratio, shear: ratio },
        mode: DashpotMode::NoTensionRestInSlip,
        limit: FrictionLimit::Spring,
    }
}

/// Young's modulus (Pa), Poisson's ratio and density (kg/m3).
#[derive(Clone, Copy)]
pub struct Material(pub f64, pub f64, pub f64);

impl Material {
    pub fn pair(self, friction: f64, restitution: f64) -> HertzMindlin {
        HertzMindlin::between((self.0, self.1), (self.0, self.1), friction, restitution)
    }

    pub fn on_rigid(self, friction: f64, restitution: f64) -> HertzMindlin {
        HertzMindlin::between((self.0, self.1), (f64::INFINITY, 0.0), friction, restitution)
    }
}

pub fn mass(radius: f64, density: f64) -> f64 {
    density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

pub fn near(found: f64, wanted: f64, share: f64) {
    assert!((found - wanted).abs() <= share * wanted.abs(), "{found} instead of {wanted}");
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| a[c] - b[c])
}

pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The bits of a motion.
pub fn bits(state: &BodyState) -> [[u64; 3]; 3] {
    [state.place, state.velocity, state.spin].map(|v| v.map(f64::to_bits))
}
