//! What is told to a bed from outside: gravity over time, bodies that keep their motion, bodies that come later.

use crate::scene::{bed, bits, damped, mass, near, norm, put, sphere, springs};
use trackbed::solvers::granular::{Bed, ContactLaw, Failure, Gravity};

const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

#[test]
fn a_table_of_gravity_is_felt_as_it_stands() {
    // up from 0 to g in 0.1 s, then held: v = g t²/0.2, then g (t - 0.05)
    let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 0.5)), 1e-4);
    let id = bed.add_sphere(&sphere([0.0; 3], 0.02, 2700.0));
    bed.set_gravity(Gravity::Table { times: vec![0.0, 0.1], values: vec![[0.0; 3], [0.0, 1.0, -9.81]] });
    bed.run(500).unwrap();
    // velocities are those of half a step before; the table is straight there
    let t = bed.time() - 0.5e-4;
    near(bed.body_state(id).velocity[2], -9.81 * t * t / 0.2, 1e-5);
    bed.run(1500).unwrap();
    let t = bed.time() - 0.5e-4;
    near(bed.body_state(id).velocity[2], -9.81 * (t - 0.05), 1e-6);
    near(bed.body_state(id).velocity[1], t - 0.05, 1e-6);
}

#[test]
fn free_fall_is_exact() {
    let mut bed: Bed<f32> = bed(ContactLaw::Linear(springs(1e6, 0.5)), 1e-4);
    let id = put(&mut bed, sphere([1.0, 2.0, 3.0], 0.02, 2700.0), [3.0, 0.0, 4.0], [0.0; 3]);
    bed.set_gravity(Gravity::EARTH);
    bed.run(10_000).unwrap();
    let place = bed.body_state(id).place;
    for (found, wanted) in place.iter().zip([4.0, 2.0, 3.0 + 4.0 - 4.905]) {
        assert!((found - wanted).abs() < 1e-10, "{place:?}");
    }
}

#[test]
fn a_fixed_body_keeps_its_motion_and_pushes() {
    let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 0.0)), 1e-6);
    let pusher = put(&mut bed, sphere([-0.02, 0.0, 0.0], 0.02, 2700.0), [0.3, 0.0, 0.0], [0.0, 0.0, 2.0]);
    bed.fix(pusher);
    let pushed = bed.add_sphere(&sphere([0.02, 0.0, 0.0], 0.02, 2700.0));
    bed.set_gravity(Gravity::Constant([0.0, 0.0, 0.0]));
    bed.run(4000).unwrap();
    let state = bed.body_state(pusher);
    assert_eq!((state.velocity, state.spin), ([0.3, 0.0, 0.0], [0.0, 0.0, 2.0]));
    assert!((state.place[0] - (-0.02 + 0.3 * 4e-3)).abs() < 1e-14);
    // as from a wall: elastic, twice the speed
    near(bed.body_state(pushed).velocity[0], 0.6, 1e-5);
    // and gravity does nothing to it
    bed.set_gravity(Gravity::EARTH);
    bed.run(100).unwrap();
    assert_eq!(bed.body_state(pusher).velocity, [0.3, 0.0, 0.0]);
}

#[test]
fn held_rotation_makes_a_block_of_a_sphere() {
    // a sphere slides and turns, a block stops after v²/(2 mu g)
    let (g, speed, friction) = (9.81, 0.5, 0.4);
    let mut bed: Bed<f64> = bed(ContactLaw::Linear(damped(1e6, friction, 0.2)), 2e-6);
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let weight = mass(0.02, 2700.0) * g;
    let id = put(&mut bed, sphere([0.0, 0.0, 0.02 - weight / 1e6], 0.02, 2700.0), [speed, 0.0, 0.0], [0.0; 3]);
    bed.hold_rotation(id);
    bed.set_gravity(Gravity::Constant([0.0, 0.0, -g]));
    bed.run(100_000).unwrap();
    let state = bed.body_state(id);
    println!("block slides {:.6e} for {:.6e}", state.place[0], speed * speed / (2.0 * friction * g));
    near(state.place[0], speed * speed / (2.0 * friction * g), 1e-4);
    assert_eq!(state.spin, [0.0; 3]);
    assert!(norm(state.velocity) < 1e-5);
}

#[test]
fn a_velocity_set_in_the_middle_is_the_velocity() {
    let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 0.0)), 1e-4);
    let id = bed.add_sphere(&sphere([0.0; 3], 0.02, 2700.0));
    bed.run(10).unwrap();
    bed.set_velocity(id, [1.0, 0.0, -2.0], [0.0, 7.0, 0.0]);
    let before = bed.body_state(id);
    assert_eq!((before.velocity, before.spin), ([1.0, 0.0, -2.0], [0.0, 7.0, 0.0]));
    bed.run(100).unwrap();
    let after = bed.body_state(id);
    assert_eq!((after.velocity, after.spin), (before.velocity, before.spin));
    assert!((after.place[2] + 0.02).abs() < 1e-15 && (after.place[0] - 0.01).abs() < 1e-15);
}

/// A pile of spheres on a floor, some of them there from the start.
fn pile(bed: &mut Bed<f64>, range: std::ops::Range<u32>) {
    for k in range {
        let (x, y, z) = (k % 3, k / 3 % 3, k / 9);
        let jitter = 1e-3 * f64::from(k * 7 % 5);
        let centre = [0.041 * f64::from(x) + jitter, 0.041 * f64::from(y) - jitter, 0.02 + 0.0405 * f64::from(z)];
        bed.add_sphere(&sphere(centre, 0.02, 2700.0));
    }
}

#[test]
fn bodies_that_come_later_leave_contacts_as_they_are() {
    let start = || {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(damped(1e6, 0.5, 0.1)), 1e-5);
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        for (x, side) in [(-0.021, 1.0), (0.107, -1.0)] {
            bed.add_plane([x, 0.0, 0.0], [side, 0.0, 0.0], 0);
            bed.add_plane([0.0, x - 0.004, 0.0], [0.0, side, 0.0], 0);
        }
        bed.set_gravity(Gravity::Constant(DOWN.map(|c| 9.81 * c)));
        pile(&mut bed, 0..27);
        bed.run(12_000).unwrap();
        bed
    };
    let (mut alone, mut joined) = (start(), start());
    let touching = alone.snapshot().unwrap().contacts.len();
    assert!(touching > 20, "{touching}");
    // far above: nothing else may change, history included
    let far = joined.add_sphere(&sphere([0.04, 0.04, 3.0], 0.03, 2700.0));
    alone.run(1000).unwrap();
    joined.run(1000).unwrap();
    for (a, b) in alone.states().zip(joined.states()) {
        assert_eq!(bits(&a), bits(&b));
    }
    near(joined.body_state(far).velocity[2], -9.81 * (1000.0 - 0.0) * 1e-5, 1e-9);
    // onto the pile: it bounces and all stays sound
    let count = joined.len();
    joined.add_sphere(&sphere([0.041, 0.041, 0.16], 0.02, 2700.0));
    joined.run(4000).unwrap();
    assert_eq!(joined.len(), count + 1);
    assert!(joined.states().all(|s| s.place[2] > 0.0));
}

#[test]
fn a_body_set_deep_into_another_is_told() {
    let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 0.5)), 1e-6);
    bed.add_sphere(&sphere([0.0; 3], 0.02, 2700.0));
    bed.add_sphere(&sphere([0.01, 0.0, 0.0], 0.02, 2700.0));
    let told = bed.run(1000);
    assert!(matches!(told, Err(Failure::Overlap { .. } | Failure::Stride { .. })), "{told:?}");
    let text = told.unwrap_err().to_string();
    assert!(text.contains("body"), "{text}");
}

#[test]
fn two_bodies_in_one_place_give_no_nonsense() {
    let mut bed: Bed<f32> = bed(ContactLaw::Linear(springs(1e6, 0.5)), 1e-6);
    for _ in 0..2 {
        bed.add_sphere(&sphere([0.3, 0.2, 0.1], 0.02, 2700.0));
    }
    let told = bed.run(100);
    assert!(told.is_err() || bed.states().all(|s| s.place.iter().all(|x| x.is_finite())));
    assert!(bed.states().all(|s| s.place.iter().chain(&s.velocity).all(|x| x.is_finite())));
}
