//! A mass that bounces on a support which only pushes: its path is known in closed form, free fall and half a period of
//! contact, so its energy and the time of every bounce are known for hundreds of bounces.

use crate::scenes::*;
use trackbed::solvers::track::*;

const MASS: f64 = 150.0;
const STIFFNESS: f64 = 50e6;
const GRAVITY: f64 = 9.81;
const HEIGHT: f64 = 1e-3;

/// A sleeper under a thread of a rail, held `HEIGHT` above its support; the force of the thread is a millionth of its weight.
fn sleeper(damping: f64) -> TrackModel {
    let foot = Foot::Sleeper { mass: MASS, support_stiffness: STIFFNESS, support_damping: damping };
    let mut model = beam([-1.0, 1.0], 0.1, 1e-12, RailEnds::Pinned, 1);
    model.seats = vec![Seat { x: 0.0, pad_stiffness: 1.0, pad_damping: 0.0, foot }];
    model.gravity = GRAVITY;
    model
}

struct Bounces {
    /// Energy above that of the sleeper lying on its support, J, at every step.
    energy: Vec<f64>,
    /// Contacts that ended.
    count: usize,
    lowest_force: f64,
}

fn bounce(damping: f64, scheme: Scheme, steps: usize) -> Bounces {
    let model = sleeper(damping);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, scheme);
    let thread = solve_static(stepper.track(), &level, &Loads::default()).unwrap();
    let rest = thread.foot_displacements[0];
    // The force that holds it up against the thread's stiffness of pad and rail in series.
    let soft = 1.0 / (1.0 + 8.0 / (48.0 * 0.1));
    let up = [(0, -(MASS * GRAVITY + soft * HEIGHT))];
    let state = solve_static(stepper.track(), &level, &Loads { sleepers: &up, ..Loads::default() }).unwrap();
    assert!((state.foot_displacements[0] + HEIGHT).abs() < 1e-6 * HEIGHT, "held at {}", state.foot_displacements[0]);
    let potential = |u: f64| -MASS * GRAVITY * u + 0.5 * STIFFNESS * u.max(0.0).powi(2) + 0.5 * soft * u * u;
    let mut found = Bounces { energy: Vec::new(), count: 0, lowest_force: f64::INFINITY };
    let mut carried = false;
    let mut look = |view: &StepView<'_>| {
        let (u, v) = (view.foot_displacement(0), view.foot_velocity(0));
        found.energy.push(0.5 * MASS * v * v + potential(u) - potential(rest));
        let force = view.contact_force(0).unwrap();
        found.lowest_force = found.lowest_force.min(force);
        found.count += usize::from(carried && force == 0.0);
        carried = force > 0.0;
    };
    Passage::released(&stepper, &level, state, steps).unwrap().run(&mut look).unwrap();
    found
}

/// Largest rise of the energy above an earlier value, as a part of the first.
fn growth(energy: &[f64]) -> f64 {
    let (mut lowest, mut growth) = (energy[0], 0.0f64);
    for e in energy {
        growth = growth.max((e - lowest) / energy[0]);
        lowest = lowest.min(*e);
    }
    growth
}

#[test]
fn energy_over_hundreds_of_bounces() {
    for (name, make) in [("0.85", scheme as fn(f64) -> Scheme), ("1", undamped)] {
        for damping in [0.0, 50e3] {
            for dt in [1e-4, 5e-5] {
                let found = bounce(damping, make(dt), (8.0 / dt) as usize);
                let left = found.energy[found.energy.len() - 1] / found.energy[0];
                println!(
                    "spectral radius {name}, damper {damping}, dt {dt:e}: {} bounces, energy left {left:.4}, growth {:.1e}, smallest force {}",
                    found.count,
                    growth(&found.energy),
                    found.lowest_force
                );
                assert!(found.lowest_force >= 0.0);
            }
        }
    }
}
