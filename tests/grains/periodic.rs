//! Cells that come back to themselves, bays, and places far from the origin.

use crate::scenes::{GRAVITY, RADIUS, Vec3, add, alone, norm, packed, random, scaled, sphere, springs, sub};
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, Gravity, Linear, Real, Sphere,
};

const SIDE: f64 = 0.25;

fn rubbing() -> Linear {
    Linear {
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: 0.2, shear: 0.2 },
        mode: DashpotMode::NoTensionRestInSlip,
        ..springs(1e7, 8e6)
    }
}

/// Spheres with velocities and spins, in a cell that is periodic along x and y.
fn going() -> Vec<(Sphere, Vec3, Vec3)> {
    let mut seed = 4;
    let (spheres, side) = packed();
    assert_eq!(side, SIDE);
    spheres
        .into_iter()
        .map(|s| {
            let mut vector = |size: f64| [0, 1, 2].map(|_| size * random(&mut seed));
            // few enough digits that a place is a number in every bay, and a drift across the borders
            let centre = s.centre.map(|x| (x * 2f64.powi(40)).round() / 2f64.powi(40));
            (Sphere { centre, ..s }, add(vector(0.01), [2.0, -1.2, 0.0]), vector(1.0))
        })
        .collect()
}

fn bed<R: Real>(domain: Domain, spheres: &[(Sphere, Vec3, Vec3)], shift: impl Fn(usize) -> Vec3) -> Bed<R> {
    // a smooth floor lets them drift across the borders
    let mut laws = ContactLaws::uniform(2, ContactLaw::Linear(rubbing()));
    laws.set(0, 1, ContactLaw::Linear(springs(1e7, 0.0)));
    let mut bed = Bed::new(domain, laws);
    bed.set_time_step(1e-5);
    bed.set_gravity(Gravity::Constant([0.0, 0.0, -GRAVITY]));
    bed.set_damping(0.05);
    let floor = shift(0)[2];
    bed.add_plane([0.0, 0.0, floor], [0.0, 0.0, 1.0], 1);
    for (k, (s, velocity, spin)) in spheres.iter().enumerate() {
        let id = bed.add_sphere(&Sphere { centre: add(s.centre, shift(k)), ..*s });
        bed.set_velocity(id, *velocity, *spin);
    }
    bed
}

fn cell() -> Domain {
    Domain::open().periodic(0, SIDE).periodic(1, SIDE)
}

/// Largest difference of places once the shifts are taken off \[m\].
fn apart<R: Real>(a: &Bed<R>, b: &Bed<R>, shift: impl Fn(usize) -> Vec3) -> f64 {
    a.states()
        .zip(b.states())
        .enumerate()
        .map(|(k, (a, b))| norm(sub(sub(b.place, a.place), shift(k))))
        .fold(0.0, f64::max)
}

const STEPS: u64 = 1000;

#[test]
fn a_bed_moves_the_same_wherever_it_is() {
    let spheres = going();
    let mut here = bed::<f64>(cell(), &spheres, |_| [0.0; 3]);
    alone(|| here.run(STEPS)).unwrap();
    let everywhere: &[(&str, &(dyn Fn(usize) -> Vec3 + Sync))] = &[
        ("moved by any vector", &|_| [0.137, -0.211, 3.3]),
        ("far from the origin", &|_| [1234.5, -777.7, 0.0]),
        ("each in a cell of its own", &|k| [SIDE * (k % 5) as f64, -SIDE * (k % 3) as f64, 0.0]),
    ];
    for (name, shift) in everywhere {
        let mut there = bed::<f64>(cell(), &spheres, shift);
        alone(|| there.run(STEPS)).unwrap();
        let difference = apart(&here, &there, shift);
        println!("{name}: {difference:.1e} m after {STEPS} steps");
        // rounding of the places at the start, and what it grows to
        let most = if *name == "far from the origin" { 1e-8 } else { 1e-9 };
        assert!(difference < most, "{name}: {difference:e}");
    }
    // they crossed borders
    let crossed = here
        .states()
        .zip(&spheres)
        .filter(|(s, (at, ..))| (s.place[0] / SIDE).floor() != (at.centre[0] / SIDE).floor());
    assert!(crossed.count() > 5);
}

/// Three bays of the same bed, the last next to the first, are the bed of one bay three times, bit by bit.
#[test]
fn bays_repeat_bit_by_bit() {
    fn check<R: Real>() {
        let spheres = going();
        let mut one = bed::<R>(cell(), &spheres, |_| [0.0; 3]);
        let thrice: Vec<_> = (0..3).flat_map(|_| spheres.iter().copied()).collect();
        let bay = |k: usize| [SIDE * (k / spheres.len()) as f64, 0.0, 0.0];
        let mut three = bed::<R>(Domain::open().periodic_bays(SIDE, 3).periodic(1, SIDE), &thrice, bay);
        alone(|| {
            one.run(STEPS).unwrap();
            three.run(STEPS).unwrap();
        });
        for k in 0..thrice.len() {
            let (a, b) = (one.body_state(BodyId((k % spheres.len()) as u32)), three.body_state(BodyId(k as u32)));
            assert_eq!((a.velocity, a.spin), (b.velocity, b.spin), "body {k} in {}", R::NAME);
            assert!(norm(sub(sub(b.place, a.place), bay(k))) < 1e-15);
        }
    }
    check::<f64>();
    check::<f32>();
}

/// A sphere that slides and rolls through several bays, and hits one at rest, goes as it goes where nothing is cut:
/// until it bounces, each time lower, which no rounding survives.
#[test]
fn a_sphere_crosses_bays() {
    let run = |domain: Domain| {
        let mut bed = Bed::<f64>::new(domain, ContactLaws::single(ContactLaw::Linear(rubbing())));
        bed.set_time_step(1e-5);
        bed.set_gravity(Gravity::EARTH);
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        let thrown = bed.add_sphere(&sphere([-0.1, 0.0, RADIUS]));
        bed.set_velocity(thrown, [4.0, 0.0, 0.0], [0.0, 100.0, 0.0]);
        bed.add_sphere(&sphere([0.26, 0.045, RADIUS]));
        alone(|| bed.run(12_000)).unwrap();
        bed.states().map(|s| s.place).collect::<Vec<_>>()
    };
    let whole = run(Domain::open());
    assert!(whole[0][0] > 0.3 && whole[1][1] > 0.05);
    for domain in [Domain::open().bays(0.25), Domain::open().bays(0.137).periodic(1, 7.0)] {
        let cut = run(domain);
        let difference = cut.iter().zip(&whole).map(|(a, b)| norm(sub(*a, *b))).fold(0.0, f64::max);
        println!("bays of {:?} m: {difference:.1e} m", domain.cell_length(0));
        assert!(difference < 1e-11, "{difference:e}");
    }
}

/// Two spheres that meet across every border and corner of a cell.
#[test]
fn collisions_across_a_border() {
    let collide = |domain: Domain, middle: Vec3| {
        let mut bed = Bed::<f64>::new(domain, ContactLaws::single(ContactLaw::Linear(rubbing())));
        bed.set_time_step(1e-5);
        let along = scaled([0.6, -0.48, 0.64], RADIUS + 1e-4);
        for sign in [1.0, -1.0] {
            let id = bed.add_sphere(&sphere(add(middle, scaled(along, sign))));
            bed.set_velocity(id, add(scaled(along, -sign * 30.0), [0.0, 0.2 * sign, 0.1]), [3.0, sign, 20.0 * sign]);
        }
        alone(|| bed.run(500)).unwrap();
        bed.states().map(|s| [sub(s.place, middle), s.velocity, s.spin]).collect::<Vec<_>>()
    };
    let free = collide(Domain::open(), [0.5; 3]);
    let domain = (0..3).fold(Domain::open(), |domain, axis| domain.periodic(axis, 0.2));
    for corner in 0..27 {
        let middle = [corner % 3, corner / 3 % 3, corner / 9].map(|n| 0.1 * f64::from(n));
        for (a, b) in collide(domain, middle).iter().zip(&free) {
            for (a, b) in a.iter().zip(b) {
                assert!(norm(sub(*a, *b)) < 1e-11, "{middle:?}: {a:?} {b:?}");
            }
        }
    }
}
