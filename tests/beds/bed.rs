//! A small periodic bed of spheres and clumps, shaken on a floor.

use nalgebra::{UnitQuaternion, Vector3};
use trackbed::solvers::granular::clump::{Pebble, Template};
use trackbed::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Placed, Real, Sphere,
};

/// Pseudo-random numbers in 0..1.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub fn law() -> ContactLaw {
    ContactLaw::Linear(Linear {
        normal_stiffness: 1.3e7,
        shear_stiffness: 1.0e7,
        friction: 0.6,
        dashpot: Dashpot::Ratio { normal: 0.2, shear: 0.1 },
        mode: DashpotMode::NoTensionRestInSlip,
        limit: FrictionLimit::Spring,
    })
}

/// About 200 grains of 16 to 30 mm radius that fall on a floor, five times as heavy as on earth, every third a clump of
/// two or three pebbles.
pub fn bed<R: Real>(seed: u64) -> Bed<R> {
    let mut random = Random::new(seed);
    let mut bed = Bed::new(Domain::open().periodic(0, 0.4).periodic(1, 0.4), ContactLaws::single(law()));
    let dumbbell = [(0.0, 0.0, 0.02), (0.018, 0.004, 0.016)];
    let bent = [(0.0, 0.0, 0.018), (0.016, 0.0, 0.016), (0.009, 0.014, 0.014)];
    let template = |shape: &[(f64, f64, f64)]| {
        let pebbles: Vec<Pebble> =
            shape.iter().map(|&(x, y, radius)| Pebble { centre: Vector3::new(x, y, 0.0), radius }).collect();
        Template::from_pebbles(&pebbles).unwrap()
    };
    let templates = [template(&dumbbell), template(&bent)];
    for layer in 0..6 {
        for cell in 0..36 {
            let place = |k: usize| 0.0666 * k as f64 + 0.033;
            let mut shaken = |x: f64| x + 0.005 * (random.next() - 0.5);
            let centre = [shaken(place(cell % 6)), shaken(place(cell / 6)), shaken(0.036 + 0.066 * layer as f64)];
            if (cell + layer) % 3 == 0 {
                let axis = Vector3::new(random.next(), random.next(), random.next()) * 3.0;
                bed.add_clump(&Placed {
                    template: &templates[cell % 2],
                    centre,
                    attitude: UnitQuaternion::from_scaled_axis(axis),
                    density: 2700.0,
                    surface: 0,
                });
            } else {
                let radius = 0.016 + 0.014 * random.next();
                bed.add_sphere(&Sphere { centre, radius, density: 2700.0, surface: 0 });
            }
        }
    }
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::Shaken { mean: [0.0, 0.0, -50.0], share: 0.3, frequency: 20.0 });
    bed.set_damping(0.2);
    bed.set_time_step(1e-5);
    bed
}

/// Every bit of what one can see of the motion.
pub fn bits<R: Real>(bed: &Bed<R>) -> Vec<u64> {
    let mut bits = Vec::new();
    for state in bed.states() {
        let numbers = state.place.iter().chain(&state.velocity).chain(&state.spin).chain(&state.attitude);
        bits.extend(numbers.map(|x| x.to_bits()));
    }
    bits
}
