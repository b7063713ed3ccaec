//! Spheres and blocks on planes: sliding, rolling, resting.

use crate::scenes::{DENSITY, GRAVITY, RADIUS, alone, close, mass, open, sphere, springs};
use trackbed::solvers::granular::{Bed, BodyId, Dashpot, DashpotMode, Gravity, Linear};

const STIFFNESS: f64 = 1e7;

/// A sphere in balance on a plane that is tilted by `angle`: the plane lies flat and gravity leans.
fn on_an_incline(law: Linear, angle: f64, dt: f64) -> (Bed<f64>, BodyId) {
    let mut bed = open(law);
    bed.set_time_step(dt);
    bed.set_gravity(Gravity::Constant([GRAVITY * angle.sin(), 0.0, -GRAVITY * angle.cos()]));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let overlap = mass(RADIUS, DENSITY) * GRAVITY * angle.cos() / law.normal_stiffness;
    let id = bed.add_sphere(&sphere([0.0, 0.0, RADIUS - overlap]));
    (bed, id)
}

fn rough(friction: f64, shear_dashpot: f64) -> Linear {
    Linear {
        friction,
        dashpot: Dashpot::Ratio { normal: 0.0, shear: shear_dashpot },
        mode: DashpotMode::RestInSlip,
        ..springs(STIFFNESS, STIFFNESS)
    }
}

#[test]
fn sliding_turns_into_rolling() {
    let (start, friction, dt) = (0.5, 0.4, 2e-6);
    let (mut bed, id) = on_an_incline(rough(friction, 0.0), 0.0, dt);
    bed.set_velocity(id, [start, 0.0, 0.0], [0.0; 3]);
    alone(|| {
        let surface_slips = |bed: &Bed<f64>| {
            let state = bed.body_state(id);
            state.velocity[0] - RADIUS * state.spin[1]
        };
        while surface_slips(&bed) > 0.0 {
            bed.step().unwrap();
        }
        let state = bed.body_state(id);
        close(state.velocity[0], 5.0 / 7.0 * start, 1e-4, "speed");
        close(state.spin[1], 5.0 / 7.0 * start / RADIUS, 1e-4, "spin");
        close(bed.time(), 2.0 * start / (7.0 * friction * GRAVITY), 1e-4, "time");
        close(state.place[0], 12.0 * start * start / (49.0 * friction * GRAVITY), 1e-4, "distance");

        // the shear spring rings on, about rolling
        let (mut crossings, mut before) = (Vec::new(), surface_slips(&bed));
        while crossings.len() < 21 {
            bed.step().unwrap();
            let now = surface_slips(&bed);
            if before * now <= 0.0 {
                crossings.push(bed.time() + dt * (before / (before - now) - 1.0));
            }
            before = now;
        }
        let period = (crossings[20] - crossings[0]) / 10.0;
        let ringing = (3.5 * STIFFNESS / mass(RADIUS, DENSITY)).sqrt();
        close(std::f64::consts::TAU / period, ringing, 1e-3, "frequency of ringing");
    });
}

#[test]
fn a_shear_dashpot_ends_the_ringing() {
    let (start, friction) = (0.5, 0.4);
    let (mut bed, id) = on_an_incline(rough(friction, 0.3), 0.0, 1e-5);
    bed.set_velocity(id, [start, 0.0, 0.0], [0.0; 3]);
    alone(|| bed.run(10_000)).unwrap();
    let state = bed.body_state(id);
    close(state.velocity[0], 5.0 / 7.0 * start, 1e-4, "speed");
    close(state.velocity[0], RADIUS * state.spin[1], 1e-5, "rolling");
}

/// Acceleration and growth of the spin over a stretch of time after the start has died away.
fn acceleration(bed: &mut Bed<f64>, id: BodyId) -> (f64, f64) {
    alone(|| bed.run(4000)).unwrap();
    let (before, time) = (bed.body_state(id), bed.time());
    alone(|| bed.run(8000)).unwrap();
    let (after, passed) = (bed.body_state(id), bed.time() - time);
    ((after.velocity[0] - before.velocity[0]) / passed, (after.spin[1] - before.spin[1]) / passed)
}

#[test]
fn a_sphere_rolls_down_a_gentle_incline() {
    let friction: f64 = 0.3;
    // tan b up to 3.5 mu
    for angle in [0.1, 0.99 * (3.5 * friction).atan()] {
        let (mut bed, id) = on_an_incline(rough(friction, 0.3), angle, 1e-5);
        let (a, spin) = acceleration(&mut bed, id);
        close(a, 5.0 / 7.0 * GRAVITY * angle.sin(), 1e-5, "acceleration");
        close(spin, a / RADIUS, 1e-5, "growth of the spin");
    }
}

#[test]
fn a_sphere_slides_down_a_steep_incline() {
    let friction: f64 = 0.3;
    for angle in [1.01 * (3.5 * friction).atan(), 1.2] {
        let (mut bed, id) = on_an_incline(rough(friction, 0.3), angle, 1e-5);
        let (a, spin) = acceleration(&mut bed, id);
        close(a, GRAVITY * (angle.sin() - friction * angle.cos()), 1e-9, "acceleration");
        close(spin, 2.5 * friction * GRAVITY * angle.cos() / RADIUS, 1e-5, "growth of the spin");
    }
}

#[test]
fn a_block_sticks_or_slides() {
    let friction: f64 = 0.5;
    let block = |angle| {
        let (mut bed, id) = on_an_incline(rough(friction, 0.3), angle, 1e-5);
        bed.hold_rotation(id);
        (bed, id)
    };
    // a load put on at once swings to twice its rest, so it stays below half of what friction holds at first
    let angle: f64 = 0.24;
    let (mut bed, id) = block(angle);
    alone(|| bed.run(20_000)).unwrap();
    let state = bed.body_state(id);
    let rest = mass(RADIUS, DENSITY) * GRAVITY * angle.sin() / STIFFNESS;
    close(state.place[0], rest, 1e-9, "shear displacement at rest");
    assert!(state.velocity[0].abs() < 1e-15 && state.spin == [0.0; 3], "{state:?}");

    let angle: f64 = 0.7;
    let (mut bed, id) = block(angle);
    let (a, spin) = acceleration(&mut bed, id);
    close(a, GRAVITY * (angle.sin() - friction * angle.cos()), 1e-9, "acceleration");
    assert_eq!(spin, 0.0);

    // just below and just above the angle of friction, the load put on slowly
    for (factor, sticks) in [(0.999, true), (1.001, false)] {
        let angle = factor * friction.atan();
        let (mut bed, id) = block(angle);
        let flat = Gravity::Constant([0.0, 0.0, -GRAVITY * angle.cos()]);
        let lean = [GRAVITY * angle.sin(), 0.0, -GRAVITY * angle.cos()];
        let Gravity::Constant(flat) = flat else { unreachable!() };
        bed.set_gravity(Gravity::Table { times: vec![0.0, 0.2], values: vec![flat, lean] });
        alone(|| bed.run(40_000)).unwrap();
        let state = bed.body_state(id);
        assert_eq!(state.velocity[0] < 1e-9, sticks, "{factor}: {state:?}");
    }
}
