//! Walls are at their exact position after every step, and servos reach their target force.

use super::*;
use proptest::prelude::*;

/// Position of a wall after a time in steps of dt.
fn moved(motion: &WallMotion, dt: f64, steps: u32) -> Pose {
    let mut pose = Pose::default();
    for step in 0..steps {
        let (linear, angular) = motion.velocity(f64::from(step) * dt, dt, &Felt::default());
        pose.advance(&linear, &angular, dt);
    }
    pose
}

#[test]
fn a_harmonic_motion_reaches_its_amplitude() {
    let axis = Vector3::new(0.0, 0.6, 0.8);
    let at = |phase, dt: f64, steps| {
        let motion = WallMotion::Harmonic { axis, amplitude: 2e-3, frequency: 5.0, phase };
        motion.check().unwrap();
        moved(&motion, dt, steps).position.dot(&axis)
    };
    // a quarter and three quarters of a period, in few steps and in many
    for dt in [1e-2f64, 1e-4] {
        let quarter = (0.05 / dt).round() as u32;
        assert!((at(0.0, dt, quarter) - 2e-3).abs() < 1e-15);
        assert!((at(0.0, dt, 3 * quarter) + 2e-3).abs() < 1e-15);
        assert!((at(std::f64::consts::FRAC_PI_2, dt, 2 * quarter) + 4e-3).abs() < 1e-15);
    }
    // after a thousand periods no error remains
    assert!(at(0.3, 1e-3, 200_000).abs() < 1e-13);
}

#[test]
fn a_table_holds_before_and_after_and_its_knots_need_not_meet_steps() {
    let velocity = |vx: f64| Vector3::new(vx, 0.0, -vx);
    let motion = WallMotion::Table {
        times: vec![1.0, 2.0, 2.5],
        velocities: vec![velocity(1.0), velocity(3.0), velocity(-1.0)],
    };
    motion.check().unwrap();
    let mean = |time, dt| motion.velocity(time, dt, &Felt::default()).0.x;
    assert_eq!((mean(-5.0, 1.0), mean(9.0, 1.0), mean(2.5, 0.1)), (1.0, -1.0, -1.0));
    assert!((mean(1.0, 0.5) - 1.5).abs() < 1e-15);
    // 0 to 4: 1 + 2 + 0.5 - 1.5
    for steps in [1, 3, 7, 400] {
        let end = moved(&motion, 4.0 / f64::from(steps), steps).position;
        assert!((end - velocity(2.0)).norm() < 1e-13, "{end}");
    }
    let constant = WallMotion::Table { times: vec![0.0], velocities: vec![velocity(0.2)] };
    assert!((moved(&constant, 0.01, 100).position.x - 0.2).abs() < 1e-15);
}

#[test]
fn a_turning_pose_stays_one() {
    let angular = Vector3::new(0.3, -2.0, 1.1);
    let motion = WallMotion::Velocity { linear: Vector3::new(0.1, 0.0, 0.0), angular };
    let pose = moved(&motion, 1e-3, 100_000);
    pose.check().unwrap();
    let length = pose.orientation.iter().map(|q| q * q).sum::<f64>().sqrt();
    assert!((length - 1.0).abs() < 1e-15);
    // against Rodrigues' rotation by the whole angle
    let expected = nalgebra::Rotation3::new(angular * 100.0) * Vector3::new(1.0, 2.0, 3.0);
    assert!((pose.direction_to_space(&Vector3::new(1.0, 2.0, 3.0)) - expected).norm() < 1e-9);
    assert!((pose.position.x - 10.0).abs() < 1e-10);
    assert_eq!(moved(&WallMotion::Fixed, 1e-3, 100), Pose::default());
}

proptest! {
    #[test]
    fn points_come_back_from_the_frame_and_move_with_it(
        angle in prop::array::uniform3(-3.0f64..3.0),
        place in prop::array::uniform3(-5.0f64..5.0),
        point in prop::array::uniform3(-5.0f64..5.0),
        spin in prop::array::uniform3(-2.0f64..2.0),
    ) {
        let mut pose = Pose { position: Vector3::from(place), ..Pose::default() };
        pose.advance(&Vector3::zeros(), &Vector3::from(angle), 1.0);
        let (point, spin) = (Vector3::from(point), Vector3::from(spin));
        let inner = pose.to_frame(&point);
        prop_assert!((pose.to_space(&inner) - point).norm() < 1e-13);
        prop_assert!((inner.norm() - (point - pose.position).norm()).abs() < 1e-13);
        // the material point moves at its velocity
        let (linear, dt) = (Vector3::new(0.2, -0.1, 0.5), 1e-6);
        let mut next = pose;
        next.advance(&linear, &spin, dt);
        let speed = (next.to_space(&inner) - point) / dt;
        let expected = linear + spin.cross(&(point - pose.position));
        prop_assert!((speed - expected).norm() < 1e-4);
    }
}

/// Force errors, step by step, of a servo that presses on a massless spring, starting 1 N too low.
fn errors(gain: f64, steps: usize) -> Vec<f64> {
    let (stiffness, target, dt) = (1e6, 100.0, 1e-4);
    let servo = WallMotion::Servo { axis: Vector3::z(), force: target, speed_limit: 1e9, gain };
    let mut height = -(target - 1.0) / stiffness;
    let mut errors = Vec::new();
    for step in 0..steps {
        let force = -stiffness * height;
        errors.push(force - target);
        let felt = Felt { force: Vector3::z() * force, stiffness, contacts: 1, ..Felt::default() };
        height += servo.velocity(step as f64 * dt, dt, &felt).0.z * dt;
    }
    errors
}

#[test]
fn a_servo_relaxes_by_one_less_its_gain() {
    for gain in [0.1, 0.5, 0.9, 1.0] {
        let errors = errors(gain, 40);
        for pair in errors.windows(2) {
            assert!((pair[1] - (1.0 - gain) * pair[0]).abs() < 1e-10);
        }
    }
    // gains that overshoot still converge up to 2; `check` refuses them
    let settles = |gain: f64| errors(gain, 2000).last().unwrap().abs() < 1.0;
    let (mut low, mut high) = (1.0, 4.0);
    while high - low > 1e-6 {
        let middle = (low + high) / 2.0;
        if settles(middle) { low = middle } else { high = middle }
    }
    assert!((low - 2.0).abs() < 1e-4, "{low}");
}

#[test]
fn a_servo_finds_its_contact_and_loads_a_bed_with_mass() {
    // ten bodies on springs with dashpots under a plate: the plate moves to them, then holds the force
    let (n, mass, k, c, dt) = (10, 0.05, 1.3e7, 480.0, 1e-5);
    let servo = WallMotion::servo(Vector3::z(), 2000.0, 0.2);
    let (mut plate, mut speed) = (1e-4, 0.0);
    let (mut x, mut v) = (vec![0.0; n], vec![0.0; n]);
    let mut forces = Vec::new();
    for step in 0..40_000 {
        let spring = |gap: f64, rate: f64| if gap < 0.0 { (-k * gap - c * rate).max(0.0) } else { 0.0 };
        let top = plate - x[n - 1];
        let felt_force = spring(top, speed - v[n - 1]);
        let contacts = usize::from(top < 0.0);
        let count = contacts as f64;
        let felt = Felt {
            force: Vector3::z() * felt_force,
            stiffness: k * count,
            dashpot: c * count,
            velocity: Vector3::z() * speed,
            contacts,
        };
        speed = servo.velocity(f64::from(step) * dt, dt, &felt).0.z;
        assert!(contacts > 0 || speed == -0.2);
        let pushes: Vec<f64> = (0..n)
            .map(|i| if i == 0 { spring(x[0], v[0]) } else { spring(x[i] - x[i - 1], v[i] - v[i - 1]) })
            .chain([felt_force])
            .collect();
        for i in 0..n {
            v[i] += (pushes[i] - pushes[i + 1]) / mass * dt;
            x[i] += v[i] * dt;
        }
        plate += speed * dt;
        forces.push(felt_force);
    }
    let late = &forces[30_000..];
    assert!(
        late.iter().all(|f| (f - 2000.0).abs() < 2.0),
        "{:?}",
        late.iter().fold(0.0f64, |m, f| m.max((f - 2e3).abs()))
    );
}

#[test]
fn a_servo_without_contact_moves_to_where_force_comes_from() {
    let free = Felt::default();
    let speed = |force| WallMotion::servo(Vector3::x(), force, 0.3).velocity(0.0, 1e-5, &free).0.x;
    assert_eq!((speed(10.0), speed(-10.0), speed(0.0)), (-0.3, 0.3, 0.0));
    // with contact the limit applies as well
    let felt = Felt { force: Vector3::x() * 1e6, stiffness: 1e6, contacts: 4, ..Felt::default() };
    assert_eq!(WallMotion::servo(Vector3::x(), 10.0, 0.3).velocity(0.0, 1e-5, &felt).0.x, 0.3);
}

#[test]
fn numbers_out_of_range_are_named() {
    let servo = |force, speed_limit, gain| WallMotion::Servo { axis: Vector3::z(), force, speed_limit, gain };
    let harmonic = |axis, frequency| WallMotion::Harmonic { axis, amplitude: 1.0, frequency, phase: 0.0 };
    let zero = Vector3::zeros();
    let wrong = [
        (servo(1.0, 1.0, 0.0), "gain of a servo"),
        (servo(1.0, 1.0, 1.5), "gain of a servo"),
        (servo(1.0, 0.0, 0.5), "speed limit of a servo"),
        (servo(f64::NAN, 1.0, 0.5), "force of a servo"),
        (WallMotion::servo(zero, 1.0, 1.0), "axis of a servo"),
        (harmonic(Vector3::z(), -1.0), "frequency of a harmonic motion"),
        (harmonic(Vector3::z() * 2.0, 1.0), "axis of a harmonic motion"),
        (WallMotion::Velocity { linear: zero, angular: zero.add_scalar(f64::INFINITY) }, "angular velocity of a wall"),
        (WallMotion::Table { times: vec![], velocities: vec![] }, "times of a table of velocities"),
        (WallMotion::Table { times: vec![0.0, 0.0], velocities: vec![zero; 2] }, "times of a table of velocities"),
        (WallMotion::Table { times: vec![0.0], velocities: vec![zero; 2] }, "number of velocities of a table"),
    ];
    for (motion, name) in wrong {
        assert_eq!(motion.check().unwrap_err().name, name);
    }
    let error = servo(1.0, 1.0, 1.5).check().unwrap_err();
    assert_eq!(error.to_string(), "expected gain of a servo above 0 and up to 1, found 1.5");
    assert!(Pose { orientation: [1.0, 0.1, 0.0, 0.0], ..Pose::default() }.check().is_err());
}

#[test]
fn motions_come_back_from_a_file() {
    let motions = [
        WallMotion::Fixed,
        WallMotion::servo(Vector3::z(), 1.0 / 3.0, 0.1),
        WallMotion::Table { times: vec![0.1, 0.7], velocities: vec![Vector3::x(), Vector3::y()] },
    ];
    for motion in motions {
        let text = serde_json::to_string(&motion).unwrap();
        assert_eq!(serde_json::from_str::<WallMotion>(&text).unwrap(), motion);
    }
    let text = r#"{"Servo":{"axis":[0.0,0.0,1.0],"force":1.0,"speed_limit":0.1}}"#;
    assert_eq!(serde_json::from_str::<WallMotion>(text).unwrap(), WallMotion::servo(Vector3::z(), 1.0, 0.1));
}
