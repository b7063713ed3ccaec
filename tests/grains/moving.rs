//! Bodies and walls that move as they are told.

use crate::scenes::{RADIUS, Vec3, alone, norm, open, sphere, springs, sub};
use nalgebra::{UnitQuaternion, Vector3};
use trackbed::solvers::granular::clump::{Pebble, Template};
use trackbed::solvers::granular::shape::Shape;
use trackbed::solvers::granular::{Bed, BodyId, Gravity, Linear, Placed, Pose, WallMotion};

/// A plane that turns meets spheres far from its origin, where it moves fast.
#[test]
fn a_plane_that_turns_meets_far_spheres() {
    for far in [0.5, 5.0] {
        let mut bed = open(springs(1e7, 0.0));
        bed.set_time_step(1e-5);
        let rate = 0.2;
        let turning = WallMotion::Velocity { linear: Vector3::zeros(), angular: Vector3::new(0.0, -rate, 0.0) };
        let plane = bed.add_wall(Shape::Plane { normal: Vector3::z() }, Pose::default(), 0, turning);
        let gap = 0.005 * far;
        let id = bed.add_sphere(&sphere([far, 0.0, RADIUS + gap]));
        alone(|| bed.run(6000)).unwrap();
        // the plane came up by more than the gap: the sphere was pushed and flies ahead
        assert!(rate * bed.time() * far > 2.0 * gap);
        let state = bed.body_state(id);
        let normal = bed.wall(plane).pose(bed.domain()).direction_to_space(&Vector3::z());
        let distance = normal.dot(&Vector3::from(state.place));
        assert!(distance > RADIUS - 1e-4, "at {far} m the plane went through: {distance}");
        assert!(state.velocity[2] > 1.5 * rate * far, "{state:?}");
    }
}

/// A sphere and a clump, both in free fall onto others, that are told how to move.
fn bodies(bed: &mut Bed<f64>) -> [BodyId; 2] {
    let pebble = |x: f64| Pebble { centre: Vector3::new(x, 0.0, 0.0), radius: RADIUS };
    let template = &Template::from_pebbles(&[pebble(-0.01), pebble(0.01)]).unwrap();
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.2, 0.5);
    let centre = [0.3, 0.0, 0.0];
    let clump = bed.add_clump(&Placed { template, centre, attitude, density: 2700.0, surface: 0 });
    [bed.add_sphere(&sphere([0.0; 3])), clump]
}

fn scene() -> (Bed<f64>, [BodyId; 2]) {
    let mut bed = open(Linear { friction: 0.5, ..springs(1e6, 1e6) });
    bed.set_time_step(1e-5);
    bed.set_gravity(Gravity::EARTH);
    let told = bodies(&mut bed);
    for x in [0.0, 0.3] {
        bed.add_sphere(&sphere([x + 0.01, 0.0, 2.0 * RADIUS + 1e-4]));
    }
    (bed, told)
}

const VELOCITY: Vec3 = [0.2, -0.1, 0.3];
const SPIN: Vec3 = [1.0, 2.0, -3.0];

#[test]
fn fixed_bodies_keep_velocity_and_spin() {
    for told_first in [true, false] {
        let (mut bed, told) = scene();
        for id in told {
            if told_first {
                bed.set_velocity(id, VELOCITY, SPIN);
                bed.fix(id);
            } else {
                bed.fix(id);
                bed.set_velocity(id, VELOCITY, SPIN);
            }
        }
        let start = told.map(|id| bed.body_state(id));
        alone(|| bed.run(1000)).unwrap();
        for (id, start) in told.into_iter().zip(start) {
            let state = bed.body_state(id);
            let way = VELOCITY.map(|v| v * bed.time());
            assert_eq!(state.velocity, VELOCITY);
            assert!(norm(sub(state.spin, SPIN)) < 1e-12, "{state:?}");
            assert!(norm(sub(sub(state.place, start.place), way)) < 1e-12, "{state:?}");
        }
        // the clump turns by its spin
        let [before, after] = [start[1].attitude, bed.body_state(told[1]).attitude]
            .map(|[w, x, y, z]| UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z)));
        let turned = (after * before.inverse()).scaled_axis();
        assert!((turned - Vector3::from(SPIN) * bed.time()).norm() < 1e-9, "{turned}");
        // and they push what is in their way
        let pushed = bed.states().filter(|s| s.velocity[2] > 0.3).count();
        assert!(pushed >= 2, "{pushed}");
    }
}

#[test]
fn held_bodies_do_not_turn() {
    let (mut bed, told) = scene();
    for id in told {
        bed.set_velocity(id, VELOCITY, SPIN);
        bed.hold_rotation(id);
    }
    let attitude = bed.body_state(told[1]).attitude;
    alone(|| bed.run(1000)).unwrap();
    for id in told {
        let state = bed.body_state(id);
        assert_eq!(state.spin, [0.0; 3]);
        assert!(state.velocity != VELOCITY, "contacts and weight act on it");
    }
    let turned = bed.body_state(told[1]).attitude;
    assert!(turned.iter().zip(attitude).all(|(a, b)| (a - b).abs() < 1e-15), "{turned:?}");
}
