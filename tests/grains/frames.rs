//! What must not depend on the frame or on the order: contacts that turn as one, twist, rolling, mirrored and swapped
//! pairs.

use crate::scenes::{
    RADIUS, Vec3, add, alone, close, cross, dot, norm, open, random, scaled, shown, sphere, springs, sub,
};
use nalgebra::{Rotation3, Unit, Vector3};
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Linear, Real, Sphere,
};

const STIFFNESS: f64 = 1e6;

/// Two spheres so heavy that they go where they are told, one above the other along z, with a shear force along x.
struct Pair {
    bed: Bed<f64>,
    ids: [BodyId; 2],
}

impl Pair {
    fn new(dt: f64) -> Pair {
        let mut bed = open(Linear { friction: 1e9, ..springs(STIFFNESS, STIFFNESS) });
        bed.set_time_step(dt);
        let high = 2.0 * RADIUS - 1e-4;
        let ids =
            [[0.0; 3], [0.0, 0.0, high]].map(|centre| bed.add_sphere(&Sphere { density: 1e30, ..sphere(centre) }));
        // sheared by turning in place: nothing moves, the surfaces slide on each other by 1e-4 m
        let mut pair = Pair { bed, ids };
        let spin = [0.0, -1e-4 / (high * 100.0 * dt), 0.0];
        for _ in 0..100 {
            pair.step([[0.0; 3]; 2], [spin, spin]);
        }
        pair
    }

    fn step(&mut self, velocities: [Vec3; 2], spins: [Vec3; 2]) {
        for k in 0..2 {
            self.bed.set_velocity(self.ids[k], velocities[k], spins[k]);
        }
        self.bed.step().unwrap();
    }

    fn place(&self, k: usize) -> Vec3 {
        self.bed.body_state(self.ids[k]).place
    }

    /// Force on the upper sphere across the line of centres \[N\].
    fn shear(&mut self) -> Vec3 {
        // at rest, so that a look adds no shear
        for id in self.ids {
            self.bed.set_velocity(id, [0.0; 3], [0.0; 3]);
        }
        let contact = self.bed.snapshot().unwrap().contacts[0];
        let sign = if contact.first.body() == Some(self.ids[1]) { 1.0 } else { -1.0 };
        let normal = contact.normal;
        scaled(sub(contact.force, scaled(normal, dot(contact.force, normal))), sign)
    }
}

fn turned(axis: Vec3, angle: f64, vector: Vec3) -> Vec3 {
    (Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::from(axis)), angle) * Vector3::from(vector)).into()
}

/// Share by which the shear force misses the one that turned along, after a turn of `angle` about `axis` in `steps`.
fn error_of_a_turn(axis: Vec3, angle: f64, steps: usize) -> f64 {
    let dt = 1e-5;
    let mut pair = Pair::new(dt);
    let (start, before) = ([pair.place(0), pair.place(1)], pair.shear());
    let rate = scaled(axis, angle / norm(axis) / (steps as f64 * dt));
    for step in 1..=steps {
        // to where the circle is at the end of the step
        let velocities = [0, 1].map(|k| {
            let there = turned(axis, angle * step as f64 / steps as f64, start[k]);
            scaled(sub(there, pair.place(k)), 1.0 / dt)
        });
        pair.step(velocities, [rate; 2]);
    }
    norm(sub(pair.shear(), turned(axis, angle, before))) / norm(before)
}

#[test]
fn a_pair_that_turns_as_one_keeps_its_shear_force() {
    alone(|| {
        for (name, axis, largest, order) in [
            ("normal turns towards the force", [0.0, 1.0, 0.0], 1e-5, 2.0),
            ("normal turns across the force", [1.0, 0.0, 0.0], 1e-5, 2.0),
            ("about the normal", [0.0, 0.0, 1.0], 2e-4, 1.0),
        ] {
            let errors = [1000, 2000, 4000].map(|steps| error_of_a_turn(axis, 1.0, steps));
            let found = (errors[1] / errors[2]).log2();
            println!("{name}: {} after a radian in 1000, 2000, 4000 steps, order {found:.2}", shown(&errors));
            assert!(errors[2] < largest && (found - order).abs() < 0.1, "{name}");
        }
    });
}

/// A pair that turns about its line of centres and across it at once slips a little, because velocities stand half a
/// step before the normal: by `d w_n w_t dt / 2` a second, which goes away with the step.
#[test]
fn turning_about_any_axis_slips_by_half_a_step() {
    alone(|| {
        let (axis, slip, distance) = ([0.3, -0.5, 0.8], 1e-4, 2.0 * RADIUS - 1e-4);
        let size = norm(axis);
        let (along, across) = (axis[2] / size, f64::hypot(axis[0], axis[1]) / size);
        for steps in [1000, 4000] {
            let expected = 0.5 * distance * along * across / steps as f64 / slip;
            close(error_of_a_turn(axis, 1.0, steps), expected, 0.03, "share of the shear force");
        }
    });
}

/// The shear force turns with the mean spin about the normal: half as fast where one turns, not at all where both turn
/// against each other.
#[test]
fn twist_turns_the_shear_force_by_the_mean_spin() {
    alone(|| {
        for (spins, share) in [([1.0, 1.0], 1.0), ([1.0, 0.0], 0.5), ([0.0, 1.0], 0.5), ([1.0, -1.0], 0.0)] {
            let (dt, steps) = (1e-5, 2000);
            let mut pair = Pair::new(dt);
            let before = pair.shear();
            let rate = 1.0 / (steps as f64 * dt);
            for _ in 0..steps {
                pair.step([[0.0; 3]; 2], spins.map(|s| [0.0, 0.0, s * rate]));
            }
            let after = pair.shear();
            let angle = cross(before, after)[2].atan2(dot(before, after));
            assert!((angle - share).abs() < 1e-6, "{spins:?}: {angle}");
            assert!((norm(after) / norm(before) - 1.0).abs() < 3e-4, "{spins:?}: {after:?}");
        }
    });
}

/// One sphere rolls round another without slip: the shear force goes round with the contact.
#[test]
fn rolling_carries_the_shear_force_along() {
    alone(|| {
        let (dt, angle) = (1e-5, 1.0);
        let errors = [2000usize, 4000].map(|steps| {
            let mut pair = Pair::new(dt);
            let before = pair.shear();
            let (axis, start) = ([0.0, 1.0, 0.0], pair.place(1));
            let rate = angle / (steps as f64 * dt);
            for step in 1..=steps {
                let there = turned(axis, angle * step as f64 / steps as f64, start);
                let velocity = scaled(sub(there, pair.place(1)), 1.0 / dt);
                // equal arms: the one that goes round turns twice as fast
                pair.step([[0.0; 3], velocity], [[0.0; 3], scaled(axis, 2.0 * rate)]);
            }
            norm(sub(pair.shear(), turned(axis, angle, before))) / norm(before)
        });
        println!("rolling by a radian: {}", shown(&errors));
        assert!(errors[1] < 1e-5 && errors[0] / errors[1] > 1.9, "{errors:?}");
    });
}

fn rubbing() -> Linear {
    Linear {
        friction: 0.4,
        dashpot: Dashpot::Ratio { normal: 0.1, shear: 0.2 },
        mode: DashpotMode::NoTensionRestInSlip,
        limit: FrictionLimit::Spring,
        ..springs(STIFFNESS, 0.8 * STIFFNESS)
    }
}

/// Pairs far from each other, each in an oblique collision with spin.
fn pairs() -> Vec<[(Sphere, Vec3, Vec3); 2]> {
    let mut seed = 7;
    let mut vector = |size: f64| [0, 1, 2].map(|_| size * random(&mut seed));
    (0..20)
        .map(|k| {
            let centre = [f64::from(k), 0.0, 0.0];
            let axis = vector(1.0);
            let (small, large) = (RADIUS, 1.3 * RADIUS);
            let apart = scaled(axis, (small + large + 1e-5) / norm(axis));
            let approach = add(scaled(apart, -20.0), vector(0.3));
            [
                (Sphere { radius: large, ..sphere(centre) }, vector(0.1), vector(20.0)),
                (Sphere { radius: small, ..sphere(add(centre, apart)) }, approach, vector(20.0)),
            ]
        })
        .collect()
}

/// States of the first and second of each pair after a collision; `swapped` makes the second first.
fn collided<R: Real>(pairs: &[[(Sphere, Vec3, Vec3); 2]], swapped: bool) -> Vec<[[Vec3; 3]; 2]> {
    let mut bed = Bed::<R>::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(rubbing())));
    bed.set_time_step(1e-5);
    let mut add = |(sphere, velocity, spin): &(Sphere, Vec3, Vec3)| {
        let id = bed.add_sphere(sphere);
        bed.set_velocity(id, *velocity, *spin);
        id
    };
    let ids: Vec<[BodyId; 2]> = pairs
        .iter()
        .map(|[a, b]| {
            if swapped {
                let b = add(b);
                [add(a), b]
            } else {
                [add(a), add(b)]
            }
        })
        .collect();
    alone(|| bed.run(400)).unwrap();
    let state = |id| {
        let state = bed.body_state(id);
        [state.place, state.velocity, state.spin]
    };
    ids.iter().map(|pair| pair.map(state)).collect()
}

#[test]
fn swapping_the_order_of_making_changes_no_bit() {
    let pairs = pairs();
    assert_eq!(collided::<f64>(&pairs, false), collided::<f64>(&pairs, true));
    assert_eq!(collided::<f32>(&pairs, false), collided::<f32>(&pairs, true));
    // they did collide
    let turned = collided::<f64>(&pairs, false).iter().zip(&pairs).filter(|(now, was)| now[0][2] != was[0].2).count();
    assert_eq!(turned, pairs.len());
}

/// In a mirror, velocities change their sign across it and spins along it: bit by bit where the mirror is a plane of
/// axes.
#[test]
fn a_mirrored_collision_is_the_mirror_of_the_collision() {
    fn check<R: Real>() {
        let pairs = pairs();
        for axis in 0..3 {
            let polar = |v: Vec3| [0, 1, 2].map(|c| if c == axis { -v[c] } else { v[c] });
            let axial = |v: Vec3| [0, 1, 2].map(|c| if c == axis { v[c] } else { -v[c] });
            let mirrored: Vec<_> = pairs
                .iter()
                .map(|pair| pair.map(|(s, v, w)| (Sphere { centre: polar(s.centre), ..s }, polar(v), axial(w))))
                .collect();
            let direct = collided::<R>(&pairs, false);
            let expected: Vec<_> =
                direct.iter().map(|pair| pair.map(|[x, v, w]| [polar(x), polar(v), axial(w)])).collect();
            assert_eq!(collided::<R>(&mirrored, false), expected, "mirror across axis {axis}");
        }
    }
    check::<f64>();
    check::<f32>();
}
