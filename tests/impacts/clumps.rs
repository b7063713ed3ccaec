//! Clumps in a bed: as spheres where they are round, as rigid bodies where they are not.

use crate::scene::{bed, bits, damped, dot, near, norm, put, sphere, springs, sub};
use nalgebra::{Matrix3, Unit, UnitQuaternion, Vector3};
use trackbed::solvers::granular::clump::{Pebble, Template};
use trackbed::solvers::granular::measure::coordination;
use trackbed::solvers::granular::shape::{Mesh, Shape};
use trackbed::solvers::granular::{
    Bed, BodyId, BodyState, ContactLaw, ContactLaws, Domain, Gravity, Linear, Placed, Pose, Snapshot, WallId,
    WallMotion,
};

type V = Vector3<f64>;

const DENSITY: f64 = 2700.0;
const RADIUS: f64 = 0.02;

fn pebble(x: f64, y: f64, z: f64) -> Pebble {
    Pebble { centre: V::new(x, y, z), radius: RADIUS }
}

/// Two spheres that touch each other, along x.
fn dumbbell() -> Template {
    Template::from_pebbles(&[pebble(-RADIUS, 0.0, 0.0), pebble(RADIUS, 0.0, 0.0)]).unwrap()
}

/// Three overlapping pebbles of three sizes: no two moments alike.
fn stone() -> Template {
    let ball = |x, y, radius| Pebble { centre: V::new(x, y, 0.0), radius };
    Template::from_pebbles(&[ball(0.0, 0.0, 0.02), ball(0.03, 0.0, 0.018), ball(0.01, 0.02, 0.015)]).unwrap()
}

fn add(bed: &mut Bed<f64>, template: &Template, centre: V, attitude: UnitQuaternion<f64>) -> BodyId {
    bed.add_clump(&Placed { template, centre: centre.into(), attitude, density: DENSITY, surface: 0 })
}

/// That takes x to a direction.
fn along(direction: V) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&V::x(), &direction).unwrap()
}

#[test]
fn a_clump_of_one_pebble_is_a_sphere_to_the_bit() {
    let law = ContactLaw::Linear(damped(1e6, 0.5, 0.1));
    let run = |clump: bool| {
        let mut bed: Bed<f32> = bed(law, 5e-6);
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        bed.set_gravity(Gravity::EARTH);
        let template = Template::sphere(RADIUS).unwrap();
        let attitude = UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5);
        for x in [0.0, 0.039] {
            let centre = [x, 0.1 * x, 0.02 + 0.1 * x];
            let id = match clump {
                true => bed.add_clump(&Placed { template: &template, centre, attitude, density: DENSITY, surface: 0 }),
                false => bed.add_sphere(&sphere(centre, RADIUS, DENSITY)),
            };
            bed.set_velocity(id, [0.3, 0.1, -0.5], [1.0, 2.0, 3.0]);
        }
        bed.run(2000).unwrap();
        bed.states().map(|s| bits(&s)).collect::<Vec<_>>()
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn a_round_clump_of_two_pebbles_moves_as_a_sphere() {
    // a second pebble deep inside, by hand: the arithmetic of clumps, the mechanics of a sphere
    let ball = Template::sphere(RADIUS).unwrap();
    let inner = Pebble { centre: V::new(0.001, 0.002, 0.0), radius: 0.01 };
    let hidden = Template { pebbles: vec![ball.pebbles[0], inner], ..ball.clone() };
    let run = |clump: bool| {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(damped(1e6, 0.5, 0.1)), 5e-6);
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        bed.set_gravity(Gravity::EARTH);
        let id = match clump {
            true => add(&mut bed, &hidden, V::new(0.0, 0.0, 0.021), UnitQuaternion::identity()),
            false => bed.add_sphere(&sphere([0.0, 0.0, 0.021], RADIUS, DENSITY)),
        };
        bed.set_velocity(id, [0.3, 0.1, -0.5], [1.0, 2.0, 3.0]);
        bed.run(20_000).unwrap();
        bed.body_state(id)
    };
    let (clump, ball) = (run(true), run(false));
    let apart =
        [sub(clump.place, ball.place), sub(clump.velocity, ball.velocity), sub(clump.spin, ball.spin)].map(norm);
    println!("hidden pebble: {apart:?}");
    assert!(apart[0] < 1e-12 && apart[1] < 1e-12 && apart[2] < 1e-10, "{apart:?}");
}

/// A dumbbell of touching spheres over the plane z = 0, written down from Newton's and Euler's laws alone: centroid,
/// velocity, angular momentum, axis, shear springs of both pebbles.
#[derive(Clone, Copy)]
struct Oracle {
    place: V,
    velocity: V,
    momentum: V,
    axis: V,
    shear: [V; 2],
}

/// Mass and moments about and across the axis.
struct Rigid {
    mass: f64,
    along: f64,
    across: f64,
    law: Linear,
    dashpot: f64,
}

impl Oracle {
    fn spin(&self, body: &Rigid) -> V {
        self.momentum / body.across
            + self.axis * (self.axis.dot(&self.momentum) * (1.0 / body.along - 1.0 / body.across))
    }

    fn centres(&self) -> [V; 2] {
        [self.place - RADIUS * self.axis, self.place + RADIUS * self.axis]
    }

    /// Rates of everything; `slips` tells which shear dashpots rest.
    fn rate(&self, body: &Rigid, slips: [bool; 2]) -> Oracle {
        let spin = self.spin(body);
        let (mut force, mut moment, mut shear) = (V::new(0.0, 0.0, -9.81 * body.mass), V::zeros(), [V::zeros(); 2]);
        for (k, centre) in self.centres().into_iter().enumerate() {
            let overlap = RADIUS - centre.z;
            if overlap <= 0.0 {
                continue;
            }
            let arm = centre - self.place - V::z() * (RADIUS - 0.5 * overlap);
            let slip = self.velocity + spin.cross(&arm);
            let (normal, sliding) = (slip.z, V::new(slip.x, slip.y, 0.0));
            let push = (body.law.normal_stiffness * overlap - body.dashpot * normal).max(0.0);
            let rub = if slips[k] { V::zeros() } else { -body.dashpot * sliding };
            let acting = V::z() * push + self.shear[k] + rub;
            force += acting;
            moment += arm.cross(&acting);
            shear[k] = -body.law.shear_stiffness * sliding + 0.5 * spin.z * V::z().cross(&self.shear[k]);
        }
        Oracle {
            place: self.velocity,
            velocity: force / body.mass,
            momentum: moment,
            axis: spin.cross(&self.axis),
            shear,
        }
    }

    fn ahead(&self, rate: &Oracle, h: f64) -> Oracle {
        Oracle {
            place: self.place + h * rate.place,
            velocity: self.velocity + h * rate.velocity,
            momentum: self.momentum + h * rate.momentum,
            axis: (self.axis + h * rate.axis).normalize(),
            shear: [0, 1].map(|k| self.shear[k] + h * rate.shear[k]),
        }
    }

    /// A step of Runge and Kutta, then friction cuts the shear springs.
    fn step(&mut self, body: &Rigid, slips: &mut [bool; 2], h: f64) {
        let a = self.rate(body, *slips);
        let b = self.ahead(&a, 0.5 * h).rate(body, *slips);
        let c = self.ahead(&b, 0.5 * h).rate(body, *slips);
        let d = self.ahead(&c, h).rate(body, *slips);
        for (rate, share) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            let axis = self.axis;
            *self = self.ahead(&rate, share * h / 6.0);
            self.axis = axis + share * h / 6.0 * rate.axis;
        }
        self.axis.normalize_mut();
        for (k, centre) in self.centres().into_iter().enumerate() {
            let limit = body.law.friction * body.law.normal_stiffness * (RADIUS - centre.z).max(0.0);
            slips[k] = self.shear[k].norm() > limit;
            if slips[k] {
                self.shear[k] = self.shear[k].try_normalize(0.0).map_or(V::zeros(), |t| t * limit);
            }
        }
    }
}

#[test]
fn a_falling_dumbbell_is_a_rigid_body() {
    const TIME: f64 = 0.03;
    let law = damped(1e6, 0.4, 0.1);
    let axis = V::new(0.8, 0.1, 0.3).normalize();
    let start = V::new(0.0, 0.0, RADIUS + RADIUS * axis.z + 1e-4);
    let (velocity, spin) = (V::new(0.3, -0.2, -1.0), V::new(2.0, 3.0, -1.0));
    let m = crate::scene::mass(RADIUS, DENSITY);
    let (round, steiner) = (0.4 * m * RADIUS * RADIUS, m * RADIUS * RADIUS);
    let body = Rigid {
        mass: 2.0 * m,
        along: 2.0 * round,
        across: 2.0 * (round + steiner),
        law,
        dashpot: 2.0 * 0.1 * (2.0 * m * law.normal_stiffness).sqrt(),
    };
    let turning = axis * axis.dot(&spin);
    let momentum = body.along * turning + body.across * (spin - turning);
    let mut alone = Oracle { place: start, velocity, momentum, axis, shear: [V::zeros(); 2] };
    let mut slips = [false; 2];
    let steps = 200_000;
    for _ in 0..steps {
        alone.step(&body, &mut slips, TIME / f64::from(steps));
    }
    let error = |dt: f64| {
        let mut bed = bed(ContactLaw::Linear(law), dt);
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        bed.set_gravity(Gravity::EARTH);
        let id = add(&mut bed, &dumbbell(), start, along(axis));
        bed.set_velocity(id, velocity.into(), spin.into());
        let (mut hits, mut before) = (0, 0);
        for _ in 0..(TIME / dt).round() as usize {
            bed.step().unwrap();
            let now = bed.walls()[0].felt().contacts;
            hits += usize::from(now > before);
            before = now;
        }
        assert!(hits >= 2, "both ends are to meet the floor");
        let apart = bed.pebbles().zip(alone.centres()).map(|(p, c)| (V::from(p.place) - c).norm());
        apart.fold(0.0, f64::max) / RADIUS
    };
    let errors = [8e-6, 4e-6, 2e-6, 1e-6].map(error);
    println!("dumbbell: {errors:?} of a radius");
    assert!(errors[3] < 2e-3 && errors[3] < 0.5 * errors[0], "{errors:?}");
}

/// Angular momentum and kinetic energy of a free clump, from what one can read: the spin is that of the middle of the
/// step.
fn turning(state: &BodyState, inertia: V, dt: f64) -> (V, f64) {
    let [w, x, y, z] = state.attitude;
    let attitude = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, x, y, z));
    let spin = attitude.inverse() * V::from(state.spin);
    let middle = inertia.component_mul(&spin);
    let end = middle + 0.5 * dt * middle.cross(&spin);
    (attitude * end, 0.5 * end.component_div(&inertia).dot(&end))
}

/// A free stone that turns with a spin given in its principal frame.
fn free(spin: V, dt: f64) -> (Bed<f64>, BodyId, V) {
    let template = stone();
    let mut bed = bed(ContactLaw::Linear(springs(1e6, 0.5)), dt);
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.7, 1.1);
    let id = add(&mut bed, &template, V::new(0.1, 0.2, 0.3), attitude);
    bed.set_velocity(id, [0.0; 3], (attitude * spin).into());
    (bed, id, template.inertia * DENSITY)
}

#[test]
fn a_free_clump_keeps_momentum_and_energy() {
    let dt = 1e-4;
    let (mut bed, id, inertia) = free(V::new(6.0, 4.0, -7.0), dt);
    bed.step().unwrap();
    let (momentum, energy) = turning(&bed.body_state(id), inertia, dt);
    let (mut drift, mut change): (f64, f64) = (0.0, 0.0);
    for _ in 0..1000 {
        bed.run(1000).unwrap();
        let (l, e) = turning(&bed.body_state(id), inertia, dt);
        drift = drift.max((l - momentum).norm() / momentum.norm());
        change = change.max((e / energy - 1.0).abs());
    }
    println!("free rotation: momentum {drift:.1e}, energy {change:.1e}");
    assert!(drift < 1e-10 && change < 1e-10, "{drift} {change}");
    assert!(bed.snapshot().unwrap().contacts.is_empty(), "pebbles of one body do not touch");
    assert_eq!(bed.body_state(id).velocity, [0.0; 3]);
}

/// Complete elliptic integral of the first kind by the arithmetic-geometric mean.
fn elliptic(modulus: f64) -> f64 {
    let (mut a, mut g) = (1.0, (1.0 - modulus * modulus).sqrt());
    while (a - g).abs() > 1e-15 * a {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}

#[test]
fn a_clump_flips_about_its_middle_axis_in_time() {
    let dt = 1e-4;
    let inertia = stone().inertia * DENSITY;
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| inertia[a].total_cmp(&inertia[b]));
    let mut spin = V::zeros();
    (spin[order[1]], spin[order[0]]) = (30.0, 0.3);
    // Landau and Lifshitz, Mechanics, section 37
    let [mut a, b, mut c] = order.map(|k| inertia[k]);
    let energy: f64 = (0..3).map(|k| inertia[k] * spin[k] * spin[k]).sum();
    let square: f64 = (0..3).map(|k| (inertia[k] * spin[k]).powi(2)).sum();
    if square < energy * b {
        std::mem::swap(&mut a, &mut c);
    }
    let modulus = (b - a) * (energy * c - square) / ((c - b) * (square - energy * a));
    let period = 4.0 * elliptic(modulus.sqrt()) * (a * b * c / ((c - b) * (square - energy * a))).sqrt();
    let (mut bed, id, _) = free(spin, dt);
    let (mut before, mut flips) = (spin[order[1]], Vec::new());
    while flips.len() < 3 {
        bed.step().unwrap();
        let state = bed.body_state(id);
        let [w, x, y, z] = state.attitude;
        let attitude = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, x, y, z));
        let now = (attitude.inverse() * V::from(state.spin))[order[1]];
        if now * before < 0.0 {
            flips.push(bed.time() - dt * now / (now - before));
        }
        before = now;
    }
    let found = flips[2] - flips[0];
    println!("flip: {:.2e}", found / period - 1.0);
    near(found, period, 1e-5);
}

/// A dumbbell along y squeezed between two plates that move to opposite sides, so that it feels a moment and no force.
/// Gives spins at two times, 10 ms apart, while all slips.
fn spin_up(damping: f64, start: f64) -> [f64; 2] {
    let overlap = 1e-5;
    let mut bed = bed(ContactLaw::Linear(springs(1e6, 0.3)), 1e-6);
    let id = add(&mut bed, &dumbbell(), V::zeros(), along(V::y()));
    bed.set_velocity(id, [0.0; 3], [0.0, start, 0.0]);
    bed.set_damping(damping);
    for side in [1.0, -1.0] {
        let pose = Pose { position: V::z() * side * (RADIUS - overlap), ..Pose::default() };
        let motion = WallMotion::Velocity { linear: V::x() * side * 10.0, angular: V::zeros() };
        bed.add_wall(Shape::Plane { normal: -V::z() * side }, pose, 0, motion);
    }
    [1000, 10_000].map(|steps| {
        bed.run(steps).unwrap();
        assert!(norm(bed.body_state(id).place) < 1e-12);
        bed.body_state(id).spin[1]
    })
}

#[test]
fn a_moment_spins_a_clump_up() {
    let inertia = 2.0 * 0.4 * crate::scene::mass(RADIUS, DENSITY) * RADIUS * RADIUS;
    let moment = 4.0 * 0.3 * 1e6 * 1e-5 * (RADIUS - 0.5e-5);
    let [first, last] = spin_up(0.0, 0.0);
    near(last - first, moment / inertia * 0.01, 1e-9);
    // local damping takes its share where the moment drives, and adds it where it brakes
    let [first, last] = spin_up(0.3, 0.0);
    near(last - first, 0.7 * moment / inertia * 0.01, 1e-9);
    let [first, last] = spin_up(0.3, -4000.0);
    near(last - first, 1.3 * moment / inertia * 0.01, 1e-9);
}

#[test]
fn a_clump_at_rest_on_three_pebbles_carries_its_weight() {
    let template =
        Template::from_pebbles(&[pebble(0.0, 0.0, 0.0), pebble(0.035, 0.0, 0.0), pebble(0.01, 0.03, 0.0)]).unwrap();
    let mut bed = bed(ContactLaw::Linear(damped(1e7, 0.5, 0.3)), 5e-6);
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::EARTH);
    bed.set_damping(0.7);
    let id = add(&mut bed, &template, V::new(0.0, 0.0, RADIUS), UnitQuaternion::identity());
    bed.run(40_000).unwrap();
    let now = bed.snapshot().unwrap();
    let state = bed.body_state(id);
    let weight = 9.81 * state.mass;
    assert_eq!(now.contacts.len(), 3);
    assert!(norm(state.velocity) < 1e-12 && norm(state.spin) < 1e-10, "{state:?}");
    let sum = now.contacts.iter().fold(V::zeros(), |sum, c| sum + V::from(c.force));
    println!("at rest: {:.1e} of the weight", (sum - V::z() * weight).norm() / weight);
    assert!((sum - V::z() * weight).norm() < 1e-9 * weight);
    // moments about the centroid give each share
    let arms = Matrix3::from_columns(&[0, 1, 2].map(|k| {
        let contact = now.contacts[k];
        V::new(1.0, contact.branch[0], contact.branch[1])
    }));
    let shares = arms.try_inverse().unwrap() * V::new(weight, 0.0, 0.0);
    for (contact, share) in now.contacts.iter().zip(shares.iter()) {
        near(contact.force[2], *share, 1e-6);
    }
}

/// Pebbles of a dumbbell thrown onto a floor, after a while.
fn thrown(floor: impl FnOnce(&mut Bed<f64>) -> WallId) -> Vec<V> {
    let mut bed = bed(ContactLaw::Linear(damped(1e6, 0.4, 0.1)), 4e-6);
    floor(&mut bed);
    bed.set_gravity(Gravity::EARTH);
    let id = add(&mut bed, &dumbbell(), V::new(0.0, 0.0, 0.04), along(V::new(0.8, 0.1, 0.3).normalize()));
    bed.set_velocity(id, [0.3, -0.2, -1.0], [2.0, 3.0, -1.0]);
    bed.run(10_000).unwrap();
    bed.pebbles().map(|p| p.place.into()).collect()
}

#[test]
fn a_clump_meets_planes_blocks_and_meshes_alike() {
    let half = V::new(0.2, 0.3, 0.1);
    let pose = || Pose { position: V::new(0.013, 0.017, -0.1), ..Pose::default() };
    let plane = thrown(|bed| bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0));
    let block = thrown(|bed| bed.add_wall(Shape::block(half).unwrap(), pose(), 0, WallMotion::Fixed));
    let mesh = thrown(|bed| bed.add_wall(Shape::Mesh(Mesh::block(half).unwrap()), pose(), 0, WallMotion::Fixed));
    for others in [block, mesh] {
        let apart = plane.iter().zip(&others).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        println!("floors differ by {apart:.1e} m");
        assert!(apart < 1e-9, "{apart}");
    }
}

/// Touching pairs of bodies, as often as their pebbles touch.
fn pairs(now: &Snapshot) -> Vec<(u32, u32)> {
    let of = |c: &trackbed::solvers::granular::ContactState| {
        Some((c.first.body()?.0, c.second.body().unwrap_or(BodyId(u32::MAX)).0))
    };
    now.contacts.iter().filter_map(of).collect()
}

#[test]
fn coordination_counts_a_pair_of_clumps_once() {
    let mut bed = bed(ContactLaw::Linear(springs(1e6, 0.5)), 1e-6);
    // side by side: two contacts of one pair; a sphere on top of the second; all on the floor
    for y in [0.0, 0.03999] {
        add(&mut bed, &dumbbell(), V::new(0.0, y, 0.01999), UnitQuaternion::identity());
    }
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    put(&mut bed, sphere([0.02, 0.03999, 0.05998], RADIUS, DENSITY), [0.0; 3], [0.0; 3]);
    let now = bed.snapshot().unwrap();
    let with_floor = now.contacts.iter().filter(|c| c.second.body().is_none()).count();
    assert_eq!((now.contacts.len(), with_floor), (7, 4));
    let found = coordination(bed.len(), &pairs(&now));
    assert_eq!((found.pairs, found.rattlers), (2, 2));
    near(found.mean, 4.0 / 3.0, 1e-15);
    // contacts of pebbles are more
    near(now.coordination(bed.len()), 2.0, 1e-15);
    // forces of a contact are along its normal before anything slid
    for contact in &now.contacts {
        near(dot(contact.force, contact.normal), 1e6 * contact.overlap, 1e-9);
    }
}

#[test]
fn a_symmetric_clump_falls_straight() {
    // along y over an edge of nothing: mirrored pebbles feel mirrored forces, so that no turning starts
    let mut bed = bed(ContactLaw::Linear(damped(1e6, 0.5, 0.1)), 4e-6);
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::EARTH);
    let axis = Unit::new_normalize(V::z());
    let attitude = UnitQuaternion::from_axis_angle(&axis, std::f64::consts::FRAC_PI_2);
    let id = add(&mut bed, &dumbbell(), V::new(0.0, 0.0, 0.03), attitude);
    bed.run(30_000).unwrap();
    let state = bed.body_state(id);
    println!("falls straight: {state:?}");
    assert!(norm(state.spin) < 1e-9 && state.place[0].abs() + state.place[1].abs() < 1e-12, "{state:?}");
}

#[test]
fn clumps_meet_across_a_period_as_anywhere() {
    let run = |x: f64| {
        let mut bed = Bed::<f64>::new(
            Domain::open().periodic(0, 0.5),
            ContactLaws::single(ContactLaw::Linear(damped(1e6, 0.5, 0.1))),
        );
        bed.set_time_step(4e-6);
        let template = stone();
        let ids = [(-0.03, 1.0), (0.03, -1.0)].map(|(side, speed)| {
            let attitude = UnitQuaternion::from_euler_angles(0.3 * side, 20.0 * side, 1.1);
            let id = add(&mut bed, &template, V::new(x + side, 0.1, 10.0 * side * side), attitude);
            bed.set_velocity(id, [speed, 0.1 * speed, 0.0], [3.0, 2.0, 1.0]);
            id
        });
        bed.run(10_000).unwrap();
        let [a, b] = ids.map(|id| bed.body_state(id));
        (sub(a.place, b.place), sub(a.velocity, b.velocity), a.spin)
    };
    let (middle, border) = (run(0.25), run(0.5));
    println!("across: {middle:?} {border:?}");
    // an impact multiplies the rounding of places by a few hundred
    for (a, b) in [(middle.0, border.0), (middle.1, border.1), (middle.2, border.2)] {
        assert!(norm(sub(a, b)) < 1e-8, "{a:?} {b:?}");
    }
    assert!((middle.1[0] - 2.0).abs() > 0.5, "they met");
}
