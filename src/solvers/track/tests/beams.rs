//! Rails beyond a continuous Euler–Bernoulli beam: shear, joints, auxiliary rails.

use super::scenes::*;
use crate::solvers::track::*;
use std::f64::consts::PI;
use std::sync::Arc;

fn at_rest(model: TrackModel, loads: &Loads) -> (Track, StaticState) {
    let level = TrackLevel::as_built(&model);
    let track = Track::new(model).unwrap();
    let state = solve_static(&track, &level, loads).unwrap();
    (track, state)
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "found {found}, expected {expected}");
}

/// A beam 10 m long on two supports, thick enough for shear to add three tenths.
fn thick(elements: usize) -> TrackModel {
    let mut model = beam(10.0, 2e6, 2000.0, RailEnds::Pinned, elements);
    model.rail[0].shear = Some(Shear { stiffness: 5.0 / 6.0 * 1e6, rotary_inertia: 2000.0 });
    model
}

#[test]
fn shear_adds_to_the_deflection() {
    for elements in [1, 2, 5] {
        let (track, state) = at_rest(thick(elements), &Loads { rail: &[(5.0, 1e3)], ..Loads::default() });
        let (bending, shear) = (1e3 * 1e3 / (48.0 * 2e6), 1e3 * 10.0 / (4.0 * 5.0 / 6.0 * 1e6));
        close(bending, 10.4167e-3, 1e-5);
        close(shear, 3.0e-3, 1e-12);
        close(state.rail_deflection_at(&track, 5.0).unwrap(), bending + shear, 1e-12);
        // Shear does not change a moment if the supports are statically determinate.
        if elements == 2 {
            close(state.rail_moment[1], 1e3 * 10.0 / 4.0, 1e-12);
        }
    }
}

/// First frequency of Timoshenko's beam on two supports: the smaller root of
/// `ρA ρI ω⁴ - (κGA ρA + κGA ρI q² + EI ρA q²) ω² + EI κGA q⁴ = 0` with q = π/L.
fn timoshenko_frequency(n: f64) -> f64 {
    let (ei, ga, m, rotary) = (2e6, 5.0 / 6.0 * 1e6, 2000.0, 2000.0);
    let q2 = (n * PI / 10.0f64).powi(2);
    let (a, b, c) = (m * rotary, ga * m + ga * rotary * q2 + ei * m * q2, ei * ga * q2 * q2);
    ((b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)).sqrt() / (2.0 * PI)
}

fn released_frequency(model: TrackModel, time_step: f64, steps: usize) -> f64 {
    let level = TrackLevel::as_built(&model);
    let stepper = Stepper::new(Arc::new(Track::new(model).unwrap()), Scheme::newmark(time_step).unwrap()).unwrap();
    let track = stepper.track();
    // A load with the shape of the first mode excites no other mode.
    let load = |x: &f64| (*x, 1e3 * (PI * x / 10.0).sin());
    let loads: Vec<(f64, f64)> = track.nodes().iter().map(load).collect();
    let state = solve_static(track, &level, &Loads { rail: &loads, ..Loads::default() }).unwrap();
    let node = track.nodes().len() / 2;
    let mut values = Vec::new();
    let mut look = |view: &StepView<'_>| values.push(view.rail_deflection(node));
    Passage::released(&stepper, &level, state, steps).unwrap().run(&mut look).unwrap();
    let crossings: Vec<f64> = (1..values.len())
        .filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0)
        .map(|i| i as f64 - values[i] / (values[i] - values[i - 1]))
        .collect();
    (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]) / time_step
}

#[test]
fn shear_lowers_the_frequency() {
    let [coarse, fine, found] = [4, 8, 40].map(|elements| released_frequency(thick(elements), 1e-3, 20_000));
    // The shape functions of the element are exact at rest; shear waves converge with the square of its length.
    let expected = timoshenko_frequency(1.0);
    close(found, expected, 1e-4);
    let order = ((coarse - expected) / (fine - expected)).log2();
    println!("first frequency {found:.6} Hz, exact {expected:.6} Hz, order {order:.2}");
    assert!((order - 2.0).abs() < 0.1, "order {order}");
    assert!(found < 0.9 * PI / 200.0 * (2e6f64 / 2000.0).sqrt(), "shear makes this beam a tenth slower: {found}");
}

/// A bay of rail pinned at both seats: 1425 Hz after Euler–Bernoulli, 1069 Hz with shear and rotary inertia.
#[test]
fn pinned_pinned_frequency() {
    let (ei, mass, shear) = (6.4e6, 60.0, Shear { stiffness: 0.4 * 80.77e9 * 76.70e-4, rotary_inertia: 0.2385 });
    let bay = |shear| {
        let mut model = beam(0.6, ei, mass, RailEnds::Pinned, 16);
        model.rail[0].shear = shear;
        let level = TrackLevel::as_built(&model);
        let stepper = Stepper::new(Arc::new(Track::new(model).unwrap()), Scheme::newmark(2e-6).unwrap()).unwrap();
        let load = |x: &f64| (*x, 1e3 * (PI * x / 0.6).sin());
        let loads: Vec<(f64, f64)> = stepper.track().nodes().iter().map(load).collect();
        let state = solve_static(stepper.track(), &level, &Loads { rail: &loads, ..Loads::default() }).unwrap();
        let mut values = Vec::new();
        let mut look = |view: &StepView<'_>| values.push(view.rail_deflection(8));
        Passage::released(&stepper, &level, state, 10_000).unwrap().run(&mut look).unwrap();
        let up: Vec<usize> = (1..values.len()).filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0).collect();
        (up.len() - 1) as f64 / ((up[up.len() - 1] - up[0]) as f64 * 2e-6)
    };
    let (euler, timoshenko) = (bay(None), bay(Some(shear)));
    println!("pinned-pinned: Euler {euler:.1} Hz, Timoshenko {timoshenko:.1} Hz");
    close(euler, 1425.0, 1e-3);
    close(timoshenko, 1069.0, 2e-3);
}

/// A beam clamped at the left, pinned at the right and hinged in the middle: its left half is a cantilever that also
/// carries the hinge force of the right half, a beam between hinge and pin.
#[test]
fn a_hinge_carries_no_moment() {
    let (ei, load, half) = (1e7, 10e3, 50.0f64);
    let mut model = beam(100.0, ei, 0.0, RailEnds::Clamped, 10);
    // A joint at the foot of a very short cantilever is a pin.
    (model.ends[1], model.rail[0].end, model.joints) = (100.01, 100.01, vec![50.0, 100.0]);
    for x in [10.0, 30.0, 50.0, 60.0, 75.0, 90.0] {
        let (track, state) = at_rest(model.clone(), &Loads { rail: &[(x, load)], ..Loads::default() });
        let expected = if x <= half {
            load * x * x * (3.0 * half - x) / (6.0 * ei)
        } else {
            load * (100.0 - x) / half * half.powi(3) / (3.0 * ei)
        };
        let hinge = track.nodes().iter().position(|n| (n - half).abs() < 1e-9).unwrap();
        assert!((state.rail_deflection[hinge] - expected).abs() < 1e-7, "{x}: {}", state.rail_deflection[hinge]);
        assert!(state.rail_moment[hinge].abs() < 1e-9 * load * half, "{}", state.rail_moment[hinge]);
    }
}

/// On very stiff pads, an auxiliary rail adds its bending stiffness and mass to the rail.
#[test]
fn an_auxiliary_rail_helps_to_carry() {
    let loads = Loads { rail: &[(9.0, 100e3)], ..Loads::default() };
    let mut model = ballast(30);
    model.rail_ends = RailEnds::Free;
    model.seats.iter_mut().for_each(|s| s.pad_stiffness = 1e12);
    let (_, alone) = at_rest(model.clone(), &loads);
    model.auxiliary_rails = vec![AuxiliaryRail {
        start: model.ends[0],
        end: model.ends[1],
        mass: 60.0,
        bending_stiffness: 6.4e6,
        pad_stiffness: 1e12,
        pad_damping: 5e3,
    }];
    let (_, joined) = at_rest(model.clone(), &loads);
    (model.auxiliary_rails, model.rail[0].bending_stiffness, model.rail[0].mass) = (Vec::new(), 12.8e6, 120.0);
    let (_, doubled) = at_rest(model, &loads);
    let peak = |state: &StaticState| state.contact_forces.iter().copied().fold(0.0, f64::max);
    close(peak(&joined), peak(&doubled), 1e-4);
    assert!(peak(&joined) < 0.9 * peak(&alone), "{} {}", peak(&joined), peak(&alone));
    close(joined.balance.supports(), joined.balance.loads, 1e-9);
    close(joined.balance.loads, doubled.balance.loads, 1e-12);
}

#[test]
fn rails_that_cannot_be_meshed_are_refused() {
    let rail = AuxiliaryRail {
        start: 3.0,
        end: 9.0,
        mass: 60.0,
        bending_stiffness: 6.4e6,
        pad_stiffness: 40e6,
        pad_damping: 5e3,
    };
    let changes: [&dyn Fn(&mut TrackModel); 8] = [
        &|m| m.joints = vec![0.0],
        &|m| m.joints = vec![f64::NAN],
        &|m| m.rail[0].shear = Some(Shear { stiffness: 0.0, rotary_inertia: 0.2 }),
        &|m| m.rail[0].shear = Some(Shear { stiffness: 240e6, rotary_inertia: -0.2 }),
        &|m| m.auxiliary_rails = vec![AuxiliaryRail { end: 3.4, ..rail }],
        &|m| m.auxiliary_rails = vec![AuxiliaryRail { end: 1e3, ..rail }],
        &|m| m.auxiliary_rails = vec![AuxiliaryRail { pad_stiffness: 0.0, ..rail }],
        &|m| m.auxiliary_rails = vec![AuxiliaryRail { mass: f64::NAN, ..rail }],
    ];
    for change in changes {
        let mut model = ballast(30);
        change(&mut model);
        assert!(matches!(Track::new(model), Err(TrackError::Model { .. })));
    }
}
