//! Momentum of track and train: it changes by the sum of gravity and support forces, in every step and over a passage.

use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

/// Forces and rates of momentum at one time, N: of all vehicles, and of the whole track.
#[derive(Clone, Copy, Default)]
struct Sums {
    wheels: f64,
    supports: f64,
    vehicles_inertia: f64,
    track_inertia: f64,
    vehicles_momentum: f64,
    track_momentum: f64,
}

/// Momentum of a rail and sleepers with these velocities (or its rate, with accelerations): the integral of the cubics
/// is the integral of a line plus `h²/12` times the difference of the slopes.
fn of_track(track: &Track, v: &[f64]) -> f64 {
    let rail: f64 = (0..track.nodes.len() - 1)
        .map(|e| {
            let h = track.nodes[e + 1] - track.nodes[e];
            let [w0, t0, w1, t1] = track.element_unknowns(e).map(|i| v[i]);
            track.model.rail[0].mass * (0.5 * h * (w0 + w1) + h * h / 12.0 * (t0 - t1))
        })
        .sum();
    let sleepers = track.sleepers.iter().map(|s| match track.model.seats[s.seat].foot {
        Foot::Sleeper { mass, .. } => mass * v[s.unknown],
        _ => 0.0,
    });
    rail + sleepers.sum::<f64>()
}

fn of_vehicles(vehicle: &Vehicle, v: &[f64]) -> f64 {
    vehicle.car_body_mass * v[0]
        + vehicle.bogie_mass * (v[2] + v[4])
        + vehicle.wheel_mass * v[6..10].iter().sum::<f64>()
}

fn sums(passage: &Passage<'_>, vehicle: &Vehicle) -> Sums {
    let (track, view, running) = (&*passage.stepper.track, passage.view(), &passage.vehicles[0].0);
    Sums {
        wheels: view.wheel_forces().iter().sum(),
        supports: (0..track.model.seats.len()).filter_map(|seat| view.contact_force(seat)).sum(),
        vehicles_inertia: of_vehicles(vehicle, &running.acceleration),
        track_inertia: of_track(track, &passage.acceleration),
        vehicles_momentum: of_vehicles(vehicle, &running.velocity),
        track_momentum: of_track(track, &passage.velocity),
    }
}

#[test]
fn momentum_is_balanced() {
    let mut model = ballast(40);
    model.rail_ends = RailEnds::Free;
    let mut level = TrackLevel::as_built(&model);
    for (seat, void) in [(23, 1e-3), (24, 2e-3), (25, 3e-3), (26, 2e-3), (27, 1e-3)] {
        level.settlements[seat] = void;
    }
    let vehicle = wagon();
    let (train, dt) = (Train::single(vehicle, Direction::Forward), 1e-4);
    let track_weight = 9.81 * (60.0 * 24.0 + 40.0 * 150.0);
    let weight = 9.81 * vehicle.mass();
    for scheme in [Scheme::generalised_alpha(dt, 0.85), Scheme::hht(dt, 0.1), Scheme::newmark(dt)] {
        let scheme = scheme.unwrap();
        let stepper = Stepper::new(Arc::new(Track::new(model.clone()).unwrap()), scheme).unwrap();
        let run = Run { train: &train, start: 11.0, finish: 19.0, motion: &Motion::Constant(200.0 / 3.6) };
        let mut passage = Passage::new(&stepper, &level, run).unwrap();
        let start = sums(&passage, &vehicle);
        let (mut before, mut worst, mut impulses) = (start, 0.0f64, [0.0; 2]);
        for _ in 0..passage.planned_steps() {
            passage.step().unwrap();
            let now = sums(&passage, &vehicle);
            // The equation of motion holds for the means of the method within a step.
            let mean = |of: fn(&Sums) -> f64, alpha: f64| (1.0 - alpha) * of(&now) + alpha * of(&before);
            let force = |of| mean(of, scheme.alpha_f);
            let rate = |of| mean(of, scheme.alpha_m);
            let vehicles = weight - force(|s| s.wheels) - rate(|s| s.vehicles_inertia);
            let track = track_weight + force(|s| s.wheels) - force(|s| s.supports) - rate(|s| s.track_inertia);
            worst = worst.max(vehicles.abs() / weight).max(track.abs() / weight);
            // Over a passage the mean of both ends of each step is equivalent.
            impulses[0] += 0.5 * dt * (2.0 * weight - now.wheels - before.wheels);
            let on_track = |s: &Sums| track_weight + s.wheels - s.supports;
            impulses[1] += 0.5 * dt * (on_track(&now) + on_track(&before));
            before = now;
        }
        let gained = [before.vehicles_momentum - start.vehicles_momentum, before.track_momentum - start.track_momentum];
        let total = weight * passage.time();
        let left = [0, 1].map(|i| (impulses[i] - gained[i]) / total);
        println!("each step within {worst:.1e} of the weight; impulses of the whole within {left:?} of the weight's");
        println!("    momentum gained: {:?} of it", gained.map(|p| p / total));
        assert!(worst < 1e-10, "found 1.0e-12");
        assert!(left.iter().all(|l| l.abs() < 1e-7), "found 5.4e-9 of a gain of 2.5e-3");
    }
}
