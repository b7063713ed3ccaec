//! Linear tracks let go from a deflected state, against their modes.

use crate::modal::Modes;
use crate::scenes::*;
use nalgebra::DVector;
use trackbed::solvers::track::*;

/// Loads on all nodes in a bell around `middle`, so that hardly anything moves faster than a step.
fn bell(track: &Track, middle: f64, width: f64, load: f64) -> Vec<(f64, f64)> {
    let [start, end] = track.model().ends;
    let inside = track.nodes().iter().filter(|x| start < **x && **x < end);
    inside.map(|x| (*x, load * (-((x - middle) / width).powi(2)).exp())).collect()
}

/// Largest difference of the rail to the modes at `time` as a part of its largest deflection from rest.
fn difference(model: &TrackModel, scheme: Scheme, width: f64, time: f64, damped: bool) -> f64 {
    let stepper = stepper(model.clone(), scheme);
    let track = stepper.track();
    let level = TrackLevel::as_built(model);
    let loads = bell(track, 0.5 * (model.ends[0] + model.ends[1]) + 0.1, width, 200.0);
    let state = solve_static(track, &level, &Loads { rail: &loads, ..Loads::default() }).unwrap();
    let rest = solve_static(track, &level, &Loads::default()).unwrap();

    let modes = Modes::of(track);
    let forces = loads.iter().fold(DVector::zeros(modes.order()), |sum, (x, p)| sum + modes.force(*x, *p));
    let start = modes.at_rest(&forces);
    let scale = largest(start.iter().copied());
    for (node, (loaded, free)) in state.rail_deflection.iter().zip(&rest.rail_deflection).enumerate() {
        assert!((loaded - free - start[2 * node]).abs() < 1e-9 * scale, "static states differ at node {node}");
    }

    let steps = (time / scheme.time_step).round() as usize;
    let mut passage = Passage::released(&stepper, &level, state, steps).unwrap();
    passage.run(&mut ()).unwrap();
    let expected = if damped { modes.released_damped(&start, time) } else { modes.released(&start, time) };
    let view = passage.view();
    let nodes = 0..track.nodes().len();
    largest(nodes.map(|n| (view.rail_deflection(n) - rest.rail_deflection[n] - expected[2 * n]) / scale))
}

fn undamped_track() -> TrackModel {
    let mut model = ballast(12);
    for seat in &mut model.seats {
        seat.pad_damping = 0.0;
        seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 0.0 };
    }
    model
}

#[test]
fn beams_follow_their_modes() {
    for ends in [RailEnds::Pinned, RailEnds::Clamped] {
        let model = beam([0.0, 10.0], 2e8, 2000.0, ends, 12);
        let found = |scheme| difference(&model, scheme, 2.0, 0.09, false);
        let (none, some) = (found(undamped(2e-6)), found(scheme(2e-6)));
        println!("{ends:?}: {none:.1e} of the deflection, {some:.1e} with numerical damping");
        assert!(none < 1e-6 && some < 1e-6, "found 4.6e-7 where clamped");
    }
}

#[test]
fn tracks_follow_their_modes() {
    let found = difference(&undamped_track(), undamped(5e-7), 0.8, 0.02, false);
    println!("undamped: {found:.1e} of the deflection");
    assert!(found < 1e-6, "found");
    for ends in [RailEnds::Clamped, RailEnds::Pinned] {
        let model = TrackModel { rail_ends: ends, ..ballast(12) };
        let found = difference(&model, scheme(5e-7), 0.8, 0.02, true);
        println!("{ends:?}, damped pads and ballast: {found:.1e} of the deflection");
        assert!(found < 1e-6, "found");
    }
}

/// Halving the step quarters the error against the exact motion.
#[test]
fn order_in_time() {
    let steps = [4e-5, 2e-5, 1e-5, 5e-6];
    let undamped_model = undamped_track();
    for (name, model, make) in [
        ("generalised-alpha, spectral radius 0.85", ballast(12), scheme as fn(f64) -> Scheme),
        ("generalised-alpha, spectral radius 1", undamped_model, undamped),
    ] {
        let errors = steps.map(|dt| (dt, difference(&model, make(dt), 0.8, 0.02, true)));
        let found = order(&errors);
        println!("{name}: {errors:?}, order {found:.3}");
        assert!((found - 2.0).abs() < 0.1, "observed order {found}");
    }
}

/// A damped beam under a step load (L = 10 m, EI = 2 MN m², 2 t/m, damping as its mass of 2 % at 2 rad/s) against its modal
/// series. What is let go after a load is what has not yet come under a step.
#[test]
fn damped_beam_under_a_step_load() {
    use std::f64::consts::PI;
    let (length, ei, mass, load) = (10.0, 2e6, 2000.0, 1e3);
    let rate = 2.0 * 0.02 * 2.0 * 5000.0 / 5002.0; // damping per mass, 1/s
    let elements = 40;
    let mut model = beam([0.0, length], ei, mass, RailEnds::Pinned, 1);
    let h = length / elements as f64;
    model.seats = (0..=elements).map(|i| spring(i as f64 * h, 1e-6, rate * mass * h)).collect();
    let level = TrackLevel::as_built(&model);
    let time_step = 1e-3;
    let stepper = stepper(model, undamped(time_step));
    let track = stepper.track();
    let state = solve_static(track, &level, &Loads { rail: &[(5.0, load)], ..Loads::default() }).unwrap();
    let node = track.seat_node(elements / 2);
    let still = state.rail_deflection[node];
    assert!((still / 10.4167e-3 - 1.0).abs() < 1e-5, "static {still}");

    let series = |time: f64| -> f64 {
        (1..400)
            .step_by(2)
            .map(|n| {
                let w = (n as f64 * PI / length).powi(2) * (ei / mass).sqrt();
                let decay = 0.5 * rate;
                let wd = (w * w - decay * decay).sqrt();
                let open = (-decay * time).exp() * ((wd * time).cos() + decay / wd * (wd * time).sin());
                2.0 * load / (mass * length * w * w) * (1.0 - open)
            })
            .sum()
    };
    let (mut worst, mut peak) = (0.0f64, 0.0f64);
    let mut passage = Passage::released(&stepper, &level, state, 8000).unwrap();
    let mut look = |view: &StepView<'_>| {
        let found = still - view.rail_deflection(node);
        worst = worst.max((found - series(view.time())).abs() / still);
        peak = peak.max(found / still);
    };
    passage.run(&mut look).unwrap();
    println!("largest difference {worst:.1e} of the static deflection, peak {peak:.4}");
    assert!(worst < 2e-3, "found");
}
