//! Limits against closed forms, and against runs that grow or do not grow.

use super::*;
use crate::solvers::granular::clump::{Pebble, Template};
use crate::solvers::granular::{
    ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Placed, Pose, Sphere,
    WallMotion, shape::Shape,
};
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::PI;

const RADIUS: f64 = 0.02;
const DENSITY: f64 = 2700.0;
const STIFFNESS: f64 = 1.3e7;

/// Overlap that does not change a digit of a limit.
const TOUCH: f64 = 1e-11;

pub(in super::super) fn law(shear: f64, ratios: [f64; 2]) -> ContactLaw {
    ContactLaw::Linear(Linear {
        normal_stiffness: STIFFNESS,
        shear_stiffness: shear * STIFFNESS,
        friction: 0.7,
        dashpot: Dashpot::Ratio { normal: ratios[0], shear: ratios[1] },
        mode: DashpotMode::Full,
        limit: FrictionLimit::Spring,
    })
}

fn bed(law: ContactLaw) -> Bed<f64> {
    Bed::new(Domain::open(), ContactLaws::uniform(1, law))
}

fn sphere(centre: [f64; 3], radius: f64) -> Sphere {
    Sphere { centre, radius, density: DENSITY, surface: 0 }
}

fn mass(radius: f64) -> f64 {
    DENSITY * 4.0 / 3.0 * PI * radius.powi(3)
}

/// Spheres with these radii side by side along x, from the origin on.
fn row(bed: &mut Bed<f64>, radii: &[f64]) {
    let mut x = 0.0;
    for &radius in radii {
        bed.add_sphere(&sphere([x + radius, 0.0, 0.0], radius));
        x += 2.0 * radius - TOUCH;
    }
}

fn between_walls(law: ContactLaw) -> Bed<f64> {
    let mut bed = bed(law);
    row(&mut bed, &[RADIUS]);
    bed.add_plane([TOUCH, 0.0, 0.0], [1.0, 0.0, 0.0], 0);
    bed.add_plane([2.0 * RADIUS - TOUCH, 0.0, 0.0], [-1.0, 0.0, 0.0], 0);
    bed
}

fn found(bed: &mut Bed<f64>) -> CriticalStep {
    bed.critical_step(0.0).unwrap()
}

#[track_caller]
fn same(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} for {expected}");
}

/// The network limit has the residual subtracted, and is otherwise exact.
#[track_caller]
fn near(step: &CriticalStep, expected: f64) {
    let share = step.network.step / expected;
    assert!(share < 1.0 + 1e-6 && share > 1.0 - 3e-3, "{share}, {step:?}");
    assert!(step.bound.step <= step.network.step * (1.0 + 1e-12));
}

#[test]
fn a_sphere_between_two_walls() {
    let m = mass(RADIUS);
    let normal = 2.0 / (2.0 * STIFFNESS / m).sqrt();
    let step = found(&mut between_walls(law(0.1, [0.0; 2])));
    near(&step, normal);
    same(step.bound.step, normal);
    same(step.estimate.step, normal / 2.0);
    assert_eq!((step.contacts, step.network.seat.unwrap().contacts), (2, 2));
    // with stiff shear springs the sphere rotates first: w^2 = 5 kt/m
    let step = found(&mut between_walls(law(1.0, [0.0; 2])));
    near(&step, 2.0 / (5.0 * STIFFNESS / m).sqrt());
    // lagged dashpots: (2/w) (sqrt(1 + 2 z^2) - sqrt(2) z)
    for z in [0.1, 0.3, 0.7, 1.0] {
        let step = found(&mut between_walls(law(0.1, [z, 0.0])));
        near(&step, normal * ((1.0 + 2.0 * z * z).sqrt() - 2f64.sqrt() * z));
    }
    // and in shear, where c = 2 z sqrt(m kt) has an effect on the rotation of the sphere 2.5 times as large as on its
    // motion
    let step = found(&mut between_walls(law(1.0, [0.0, 0.3])));
    let xi = 0.3 * 5f64.sqrt();
    near(&step, 2.0 / (5.0 * STIFFNESS / m).sqrt() * ((1.0 + xi * xi).sqrt() - xi));
}

#[test]
fn local_damping_shortens_the_step() {
    for share in [0.2, 0.5, 0.7] {
        let mut bed = between_walls(law(0.1, [0.0; 2]));
        bed.set_damping(share);
        let limit = 2.0 / (2.0 * STIFFNESS / mass(RADIUS)).sqrt() / (1.0 + share).sqrt();
        near(&found(&mut bed), limit);
        let speed = |part: f64| {
            let mut bed = bed.clone();
            bed.set_time_step(part * limit);
            bed.set_velocity(BodyId(0), [1e-12, 0.0, 0.0], [0.0; 3]);
            bed.run(60).unwrap();
            bed.body_state(BodyId(0)).velocity[0].abs()
        };
        assert!(speed(0.98) < 1e-12 && speed(1.02) > 1e-11, "{share}: {:e} {:e}", speed(0.98), speed(1.02));
    }
}

#[test]
fn on_one_wall_sliding_and_turning_couple() {
    let mut bed = bed(law(1.0, [0.0; 2]));
    row(&mut bed, &[RADIUS]);
    bed.add_plane([TOUCH, 0.0, 0.0], [1.0, 0.0, 0.0], 0);
    let step = found(&mut bed);
    near(&step, 2.0 / (3.5 * STIFFNESS / mass(RADIUS)).sqrt());
    same(step.bound.step, 2.0 / (3.5 * STIFFNESS / mass(RADIUS)).sqrt());
}

#[test]
fn two_spheres_of_any_sizes() {
    for ratio in [1.0, 2.0, 6.0] {
        let radii = [RADIUS, ratio * RADIUS];
        let reduced = 1.0 / (1.0 / mass(radii[0]) + 1.0 / mass(radii[1]));
        let mut smooth = bed(law(0.0, [0.3, 0.0]));
        row(&mut smooth, &radii);
        let step = found(&mut smooth);
        near(&step, 2.0 / (STIFFNESS / reduced).sqrt() * (1.09f64.sqrt() - 0.3));
        same(step.bound.step, step.network.step / (1.0 - step.residual).min(1.0));
        assert_eq!(step.network.seat.unwrap().body, BodyId(0), "the lighter one is the seat");
        // rolling on each other: both rotate in the same direction, (1/m + r^2/I) = 3.5/m for each
        let mut rough = bed(law(1.0, [0.0; 2]));
        row(&mut rough, &radii);
        near(&found(&mut rough), 2.0 / (3.5 * STIFFNESS / reduced).sqrt());
    }
}

#[test]
fn chains_meet_the_closed_form() {
    for n in [2, 3, 10, 40] {
        let mut free = bed(law(0.0, [0.0; 2]));
        row(&mut free, &vec![RADIUS; n]);
        let frequency = |angle: f64| 2.0 * (STIFFNESS / mass(RADIUS)).sqrt() * angle.sin();
        near(&found(&mut free), 2.0 / frequency((n - 1) as f64 * PI / (2 * n) as f64));
        free.add_plane([TOUCH, 0.0, 0.0], [1.0, 0.0, 0.0], 0);
        let end = n as f64 * (2.0 * RADIUS - TOUCH);
        free.add_plane([end, 0.0, 0.0], [-1.0, 0.0, 0.0], 0);
        near(&found(&mut free), 2.0 / frequency(n as f64 * PI / (2 * (n + 1)) as f64));
    }
}

#[test]
fn a_clump_of_two_rocks_on_its_feet() {
    let apart = 0.9 * RADIUS;
    let pebble = |x: f64| Pebble { centre: Vector3::new(x, 0.0, 0.0), radius: RADIUS };
    let template = Template::from_pebbles(&[pebble(-apart), pebble(apart)]).unwrap();
    let mut bed = bed(law(0.0, [0.0; 2]));
    let placed = Placed {
        template: &template,
        centre: [0.0, 0.0, RADIUS - TOUCH],
        attitude: template.axes,
        density: DENSITY,
        surface: 0,
    };
    bed.add_clump(&placed);
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let (m, inertia) = (DENSITY * template.volume, DENSITY * template.inertia.max());
    let fastest = (2.0 * STIFFNESS / m).max(2.0 * STIFFNESS * apart * apart / inertia);
    let step = found(&mut bed);
    near(&step, 2.0 / fastest.sqrt());
    same(step.bound.step, 2.0 / fastest.sqrt());
    same(step.estimate.step, 1.0 / fastest.sqrt());
    // rotated in the world, the result is the same
    let turn = UnitQuaternion::from_euler_angles(0.3, -1.0, 2.0);
    let mut turned = self::bed(law(0.0, [0.0; 2]));
    let up = turn * Vector3::z();
    turned.add_clump(&Placed { centre: (up * (RADIUS - TOUCH)).into(), attitude: turn * template.axes, ..placed });
    turned.add_plane([0.0; 3], up.into(), 0);
    near(&found(&mut turned), 2.0 / fastest.sqrt());
}

#[test]
fn walls_with_faces_and_fixed_bodies_are_ground() {
    let mut block = bed(law(0.0, [0.0; 2]));
    row(&mut block, &[RADIUS]);
    let pose = Pose { position: Vector3::new(-0.1 + TOUCH, 0.0, 0.0), ..Pose::default() };
    block.add_wall(Shape::block(Vector3::repeat(0.1)).unwrap(), pose, 0, WallMotion::Fixed);
    near(&found(&mut block), 2.0 / (STIFFNESS / mass(RADIUS)).sqrt());
    let mut pair = bed(law(0.0, [0.0; 2]));
    row(&mut pair, &[RADIUS, RADIUS]);
    pair.fix(BodyId(1));
    let step = found(&mut pair);
    near(&step, 2.0 / (STIFFNESS / mass(RADIUS)).sqrt());
    same(step.bound.step, 2.0 / (STIFFNESS / mass(RADIUS)).sqrt());
}

#[test]
fn without_contacts_there_is_no_limit_but_a_gap_may_count() {
    let mut bed = bed(law(0.0, [0.0; 2]));
    bed.add_sphere(&sphere([0.0; 3], RADIUS));
    bed.add_sphere(&sphere([2.0 * RADIUS + 1e-4, 0.0, 0.0], RADIUS));
    let step = found(&mut bed);
    assert_eq!((step.network.step, step.network.seat, step.contacts), (f64::INFINITY, None, 0));
    assert_eq!((step.bound.step, step.estimate.step), (f64::INFINITY, f64::INFINITY));
    near(&bed.critical_step(2e-4).unwrap(), 2.0 / (2.0 * STIFFNESS / mass(RADIUS)).sqrt());
    // farther than the normal reach of the lists
    assert_eq!(bed.critical_step(0.9e-4).unwrap().contacts, 0);
    bed.add_sphere(&sphere([0.0, 2.9 * RADIUS, 0.0], RADIUS));
    assert_eq!(bed.critical_step(0.91 * RADIUS).unwrap().contacts, 2);
}

/// Spheres with radii within a tenth of each other, pressed into a periodic box until all are at rest.
pub(in super::super) fn pressed(side: usize, law: ContactLaw) -> Bed<f64> {
    let spacing = 1.85 * RADIUS;
    let length = side as f64 * spacing;
    let domain = (0..3).fold(Domain::open(), |d, axis| d.periodic(axis, length));
    let mut bed = Bed::new(domain, ContactLaws::uniform(1, law));
    let mut state = 88172645463325252u64;
    let mut chance = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for k in 0..side.pow(3) {
        let at = [k % side, k / side % side, k / side / side].map(|i| (i as f64 + 0.5 + 0.3 * chance()) * spacing);
        bed.add_sphere(&sphere(at, RADIUS * (1.0 + 0.2 * chance())));
    }
    bed.set_limits(crate::solvers::granular::Limits { overlap: 0.9, ..Default::default() });
    bed.set_damping(0.7);
    bed.change_laws(|law| friction(law, 0.5));
    bed.set_time_step(8e-6);
    for _ in 0..8 {
        bed.run(1000).unwrap();
        // bodies without contacts are stopped here, because nothing else stops them
        (0..bed.len() as u32).for_each(|id| bed.set_velocity(BodyId(id), [0.0; 3], [0.0; 3]));
    }
    bed.run(4000).unwrap();
    bed.set_damping(0.0);
    bed.change_laws(|law| friction(law, 1e6));
    bed
}

fn friction(law: &mut ContactLaw, friction: f64) {
    if let ContactLaw::Linear(law) = law {
        law.friction = friction;
    }
}

fn kinetic(bed: &Bed<f64>) -> f64 {
    bed.states().map(|s| s.velocity.iter().map(|v| v * v).sum::<f64>()).sum()
}

#[test]
fn a_bed_is_stable_below_the_limit_of_its_network_and_grows_above() {
    for (shear, ratios) in [(1.0, [0.0; 2]), (1.0, [0.3, 0.0]), (0.5, [0.2, 0.4])] {
        let start = pressed(7, law(shear, ratios));
        let step = start.clone().critical_step(0.0).unwrap();
        assert!(step.bound.step < step.network.step && step.residual < 3e-3);
        let grown = |share: f64| {
            let mut bed = start.clone();
            bed.gravity = Gravity::default();
            bed.set_time_step(share * step.network.step);
            let mut past = 0.0;
            for round in 0..40 {
                if bed.run(10).is_err() || kinetic(&bed) > 1e-8 {
                    return f64::INFINITY;
                }
                if round == 10 {
                    past = kinetic(&bed);
                }
            }
            kinetic(&bed) / past
        };
        let (mut low, mut high) = (0.9, 1.1);
        assert!(grown(low) < 10.0 && grown(high) > 1e3, "{} {}", grown(low), grown(high));
        for _ in 0..6 {
            let mid = 0.5 * (low + high);
            if grown(mid) > 10.0 { high = mid } else { low = mid }
        }
        assert!(low > 0.99 && high < 1.02, "{low} {high}");
    }
}

/// A simple cubic lattice without rotation, slightly compressed: six equal contacts per sphere, two of them normal in
/// each direction. With dashpots in both directions xi = beta sqrt(6), with normal dashpots alone a third of this.
#[test]
fn a_lattice_grows_where_the_theory_says() {
    for ratios in [[0.0; 2], [0.3, 0.0], [0.3; 2], [1.0, 0.0], [1.0; 2]] {
        let spacing = 2.0 * RADIUS * 0.999;
        let domain = (0..3).fold(Domain::open(), |d, axis| d.periodic(axis, 4.0 * spacing));
        let mut bed = Bed::<f64>::new(domain, ContactLaws::uniform(1, law(1.0, ratios)));
        bed.change_laws(|law| friction(law, 1e9));
        for k in 0..64 {
            let id = bed.add_sphere(&sphere([k % 4, k / 4 % 4, k / 16].map(|i| f64::from(i) * spacing), RADIUS));
            bed.hold_rotation(id);
            bed.set_velocity(id, [1e-9 * f64::from(k * 7 % 5) - 2e-9, 1e-9, -1e-9], [0.0; 3]);
        }
        let xi = (ratios[0] + 2.0 * ratios[1]) / 3.0 * 6f64.sqrt();
        let theory = 2.0 / (12.0 * STIFFNESS / mass(RADIUS)).sqrt() * ((1.0 + xi * xi).sqrt() - xi);
        near(&found(&mut bed), theory);
        let peak = |share: f64| {
            let mut bed = bed.clone();
            bed.set_time_step(share * theory);
            bed.run(1000).map_or(f64::INFINITY, |()| kinetic(&bed))
        };
        assert!(peak(0.98) < 1e-14 && peak(1.02) > 1e-10, "{ratios:?}: {:e} {:e}", peak(0.98), peak(1.02));
    }
}
