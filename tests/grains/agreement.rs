//! The kernel against the plain solver, and its two precisions against each other.

use crate::oracle::{Grain, Oracle, Plane};
use crate::scenes::{Vec3, alone, mass, norm, packed, random, shown, sub, walls};
use trackbed::solvers::granular::{Bed, ContactLaws, DashpotMode, Domain, Gravity, Real, Sphere, Surface};

const DT: f64 = 1e-5;
const DAMPING: f64 = 0.2;
const GRAVITY: Vec3 = [1.0, -0.5, -9.81];

fn surfaces() -> Vec<Surface> {
    [(1.3e7, 1.0e7, 0.7, [0.3, 0.1]), (5e6, 5e6, 0.5, [0.2, 0.2]), (4e7, 2e7, 0.2, [0.1, 0.3])]
        .map(|(normal_stiffness, shear_stiffness, friction, damping)| Surface {
            normal_stiffness,
            shear_stiffness,
            friction,
            damping,
            mode: DashpotMode::NoTensionRestInSlip,
        })
        .into()
}

/// What is in the box: packed spheres of three surfaces, set going, and walls of three surfaces.
struct Scene {
    spheres: Vec<(Sphere, Vec3, Vec3)>,
    planes: Vec<(Vec3, Vec3, u16)>,
}

fn scene() -> Scene {
    let (spheres, side) = packed();
    let mut seed = 11;
    let mut vector = |size: f64| [0, 1, 2].map(|_| size * random(&mut seed));
    let spheres = spheres
        .into_iter()
        .enumerate()
        .map(|(k, s)| (Sphere { surface: (k % 3) as u16, ..s }, vector(0.01), vector(0.5)))
        .collect();
    let planes = walls(side).into_iter().enumerate().map(|(k, (point, normal))| (point, normal, (k % 3) as u16));
    Scene { spheres, planes: planes.collect() }
}

fn bed<R: Real>(scene: &Scene) -> Bed<R> {
    let mut bed = Bed::new(Domain::open(), ContactLaws::from_surfaces(&surfaces()));
    bed.set_time_step(DT);
    bed.set_gravity(Gravity::Constant(GRAVITY));
    bed.set_damping(DAMPING);
    for &(point, normal, surface) in &scene.planes {
        bed.add_plane(point, normal, surface);
    }
    for (sphere, velocity, spin) in &scene.spheres {
        let id = bed.add_sphere(sphere);
        bed.set_velocity(id, *velocity, *spin);
    }
    bed
}

fn oracle(scene: &Scene) -> Oracle {
    let grain = |&(s, velocity, spin): &(Sphere, Vec3, Vec3)| Grain {
        place: s.centre,
        velocity,
        spin,
        radius: s.radius,
        mass: mass(s.radius, s.density),
        surface: usize::from(s.surface),
    };
    let plane = |&(point, normal, surface): &(Vec3, Vec3, u16)| Plane { point, normal, surface: usize::from(surface) };
    let mut oracle =
        Oracle::new(scene.spheres.iter().map(grain).collect(), scene.planes.iter().map(plane).collect(), surfaces());
    (oracle.gravity, oracle.damping, oracle.dt) = (GRAVITY, DAMPING, DT);
    oracle
}

fn places<R: Real>(bed: &Bed<R>) -> Vec<Vec3> {
    bed.states().map(|s| s.place).collect()
}

/// Largest distance between two lists of places \[m\].
fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max)
}

#[test]
fn agrees_with_a_plain_solver() {
    let scene = scene();
    let (mut bed, mut mixed, mut oracle) = (bed::<f64>(&scene), bed::<f32>(&scene), oracle(&scene));
    let (mut full, mut single) = (Vec::new(), Vec::new());
    let start = places(&bed);
    let mut contacts = alone(|| bed.snapshot()).unwrap().contacts.len();
    println!("{contacts} at the start");
    for _ in 0..10 {
        for _ in 0..100 {
            oracle.step();
        }
        alone(|| {
            bed.run(100).unwrap();
            mixed.run(100).unwrap();
        });
        let expected: Vec<Vec3> = oracle.grains.iter().map(|g| g.place).collect();
        full.push(apart(&places(&bed), &expected));
        single.push(apart(&places(&mixed), &expected));
        contacts = contacts.max(alone(|| bed.snapshot()).unwrap().contacts.len());
    }
    let way = apart(&start, &places(&bed));
    println!("{contacts} contacts, ways up to {way:.4} m");
    println!("double precision, every 100 steps: {} m", shown(&full));
    println!("mixed precision, every 100 steps: {} m", shown(&single));
    assert!(contacts > 300);
    // of coordinates of up to half a metre
    assert!(full.iter().all(|d| *d < 1e-12 * 0.3));
    assert!(single.iter().all(|d| *d < 1e-5 * way));
    let spin = bed.states().zip(&oracle.grains).map(|(s, g)| norm(sub(s.spin, g.spin))).fold(0.0, f64::max);
    assert!(spin < 1e-9, "{spin}");
}
