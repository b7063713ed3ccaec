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

/// A track under a bell of loads, and where its modes say the rail is some time after these are taken away.
struct Case {
    model: TrackModel,
    loads: Vec<(f64, f64)>,
    time: f64,
    /// Largest deflection under the loads, m.
    scale: f64,
    /// Of unknowns, from the unloaded track.
    start: DVector<f64>,
    expected: DVector<f64>,
}

impl Case {
    fn new(model: TrackModel, width: f64, time: f64, damped: bool) -> Self {
        let track = Track::new(model.clone()).unwrap();
        let loads = bell(&track, 0.5 * (model.ends[0] + model.ends[1]) + 0.1, width, 200.0);
        let modes = Modes::of(&track);
        let forces = loads.iter().fold(DVector::zeros(modes.order()), |sum, (x, p)| sum + modes.force(*x, *p));
        let start = modes.at_rest(&forces);
        let expected = if damped { modes.released_damped(&start, time) } else { modes.released(&start, time) };
        Self { model, loads, time, scale: largest(start.iter().copied()), start, expected }
    }

    /// Largest difference of the rail to its modes as a part of its largest deflection under the loads.
    fn difference(&self, scheme: Scheme) -> f64 {
        let stepper = stepper(self.model.clone(), scheme);
        let (track, level) = (stepper.track(), TrackLevel::as_built(&self.model));
        let state = solve_static(track, &level, &Loads { rail: &self.loads, ..Loads::default() }).unwrap();
        let rest = solve_static(track, &level, &Loads::default()).unwrap().rail_deflection;
        let nodes = 0..track.nodes().len();
        let worst = |found: &dyn Fn(usize) -> f64, expected: &DVector<f64>| {
            largest(nodes.clone().map(|n| (found(n) - rest[n] - expected[2 * n]) / self.scale))
        };
        let at_rest = worst(&|n| state.rail_deflection[n], &self.start);
        assert!(at_rest < 1e-9, "static states differ by {at_rest}");
        let steps = (self.time / scheme.time_step).round() as usize;
        let mut passage = Passage::released(&stepper, &level, state, steps).unwrap();
        passage.run(&mut ()).unwrap();
        worst(&|n| passage.view().rail_deflection(n), &self.expected)
    }
}

fn undamped_track() -> TrackModel {
    let mut model = ballast(12);
    for seat in &mut model.seats {
        seat.pad_damping = 0.0;
        seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 0.0, seating: None };
    }
    model
}

#[test]
fn beams_follow_their_modes() {
    for ends in [RailEnds::Pinned, RailEnds::Clamped] {
        let case = Case::new(beam([0.0, 10.0], 2e8, 2000.0, ends, 12), 2.0, 0.09, false);
        let (none, some) = (case.difference(undamped(2e-6)), case.difference(scheme(2e-6)));
        println!("{ends:?}: {none:.1e} of the deflection, {some:.1e} with numerical damping");
        assert!(none < 1e-6 && some < 1e-6, "found 4.0e-7 where clamped");
    }
}

#[test]
fn tracks_follow_their_modes() {
    let found = Case::new(undamped_track(), 0.8, 0.02, false).difference(undamped(5e-7));
    println!("undamped: {found:.1e} of the deflection");
    assert!(found < 1e-6, "found 4.3e-7");
    for (ends, shear) in [(RailEnds::Clamped, None), (RailEnds::Pinned, None), (RailEnds::Pinned, Some(SHEAR))] {
        let mut model = TrackModel { rail_ends: ends, ..ballast(12) };
        model.rail[0].shear = shear;
        let found = Case::new(model, 0.8, 0.02, true).difference(scheme(5e-7));
        println!("{ends:?}, {shear:?}, damped pads and ballast: {found:.1e} of the deflection");
        assert!(found < 1e-6, "found 1.0e-7, 7.0e-8 and 1.6e-7");
    }
}

/// Halving the step quarters the error against the exact motion of the same mesh, for every method and both beam
/// theories. Waves of shear and rotation, at 5 kHz, ask for smaller steps before they follow.
#[test]
fn order_in_time() {
    for (theory, shear, steps) in [
        ("Euler-Bernoulli", None, [4e-5, 2e-5, 1e-5, 5e-6]),
        ("Timoshenko", Some(SHEAR), [5e-6, 2.5e-6, 1.25e-6, 6.25e-7]),
    ] {
        let mut model = ballast(12);
        model.rail[0].shear = shear;
        let case = Case::new(model, 0.8, 0.01, true);
        for (name, make) in METHODS {
            let errors = steps.map(|dt| (dt, case.difference(make(dt))));
            let found = order(&errors);
            println!("{theory}, {name}: {:.1e} to {:.1e}, order {found:.3}", errors[0].1, errors[3].1);
            assert!((found - 2.0).abs() < 0.1, "observed order {found}");
        }
    }
}

/// A damped beam under a step load (L = 10 m, EI = 2 MN m², 2 t/m, damping as its mass of 2 % at 2 rad/s) against its
/// modal series. What is let go after a load is what has not yet come under a step.
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
    assert!(worst < 2e-3, "found 1.2e-3");
    assert!((peak - 1.9603).abs() < 1e-3, "found 1.9603");
}
