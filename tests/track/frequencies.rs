//! Frequencies that a track shows: of beams, between seats, of passing.

use crate::scenes::*;
use std::f64::consts::PI;
use trackbed::solvers::track::*;

/// Mean frequency between upward zero crossings, Hz.
fn frequency(values: &[f64], time_step: f64) -> f64 {
    let crossings: Vec<f64> = (1..values.len())
        .filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0)
        .map(|i| i as f64 - values[i] / (values[i] - values[i - 1]))
        .collect();
    (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]) / time_step
}

/// Deflection over time of the node at `x` after loads on all nodes are taken away, from that at rest.
pub fn let_go(model: TrackModel, load: impl Fn(f64) -> f64, x: f64, scheme: Scheme, steps: usize) -> Vec<f64> {
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, scheme);
    let track = stepper.track();
    let node = track.nodes().iter().position(|n| (n - x).abs() < 1e-9).unwrap();
    let rest = solve_static(track, &level, &Loads::default()).unwrap().rail_deflection[node];
    let loads: Vec<(f64, f64)> = track.nodes().iter().map(|x| (*x, load(*x))).collect();
    let state = solve_static(track, &level, &Loads { rail: &loads, ..Loads::default() }).unwrap();
    let mut deflections = Vec::new();
    let mut look = |view: &StepView<'_>| deflections.push(view.rail_deflection(node) - rest);
    Passage::released(&stepper, &level, state, steps).unwrap().run(&mut look).unwrap();
    deflections
}

/// A simply supported beam under a step load at mid-span (L = 10 m, EI = 200 MN m², 2 t/m) against its modal series.
#[test]
fn beam_under_a_step_load() {
    let load = |x: f64| if (x - 5.0).abs() < 1e-9 { 1e3 } else { 0.0 };
    let values = let_go(beam([0.0, 10.0], 2e8, 2000.0, RailEnds::Pinned, 40), load, 5.0, undamped(5e-5), 8000);
    let still = values[0];
    assert!((still / 0.104_166_667e-3 - 1.0).abs() < 1e-7, "static {still}");
    let (mut worst, mut peak, mut series_peak) = (0.0f64, 0.0f64, 0.0f64);
    for (step, value) in values.iter().enumerate() {
        let series: f64 = (1..200)
            .step_by(2)
            .map(|n| {
                let w = (n as f64 * PI / 10.0).powi(2) * 1e5f64.sqrt();
                2.0 * 1e3 / (2e4 * w * w) * (1.0 - (w * step as f64 * 5e-5).cos())
            })
            .sum();
        worst = worst.max((still - value - series).abs() / still);
        (peak, series_peak) = (peak.max((still - value) / still), series_peak.max(series / still));
    }
    println!("largest difference {worst:.1e} of the static deflection; peak {peak:.5}, series {series_peak:.5}");
    assert!(worst < 1e-3, "found 4.9e-4");
    assert!((peak - series_peak).abs() < 5e-4 && peak < 2.0, "found 1.9999 of 2");
}

/// Frequency of mode n of a simply supported beam of length l, Hz: the lower root of the two unknowns w and θ of its
/// shape, `ρA ρI ω⁴ - (κGA ρA + (κGA ρI + EI ρA) q²) ω² + EI κGA q⁴ = 0`, q = nπ/l.
fn timoshenko(section: &RailSection, shear: Shear, l: f64, n: f64) -> f64 {
    let (q2, ei, ga) = ((n * PI / l).powi(2), section.bending_stiffness, shear.stiffness);
    let (m, rotary) = (section.mass, shear.rotary_inertia);
    let (a, b, c) = (m * rotary, ga * m + (ga * rotary + ei * m) * q2, ei * ga * q2 * q2);
    (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt() / (2.0 * PI)
}

/// The rail between seats 0.6 m apart vibrates as if pinned there, whatever the pads: 1425 Hz, and 1069 Hz with shear.
#[test]
fn pinned_pinned() {
    let shape = |x: f64| 1e3 * (PI * x / 0.6).sin();
    for (shear, published, elements) in [(None, 1425.0, 8), (Some(SHEAR), 1069.0, 24)] {
        let mut model = beam([0.0, 6.0], 6.4e6, 60.0, RailEnds::Pinned, elements);
        model.seats = (0..=10).map(|i| spring(0.6 * i as f64, 40e6, 5e3)).collect();
        model.rail[0].shear = shear;
        let euler = PI / (2.0 * 0.6 * 0.6) * (6.4e6f64 / 60.0).sqrt();
        let expected = shear.map_or(euler, |shear| timoshenko(&model.rail[0], shear, 0.6, 1.0));
        assert!((expected / published - 1.0).abs() < 2e-3, "closed form {expected}");
        let found = frequency(&let_go(model, shape, 0.3, undamped(2e-6), 10_000), 2e-6);
        println!("ten bays: {found:.2} Hz, closed form {expected:.2} Hz");
        assert!((found / expected - 1.0).abs() < 1e-3, "found {found}");
    }
}

/// The error of a frequency falls with the fourth power of the element's length, as `(k h)^4/1440` of the cubic
/// element.
#[test]
fn order_in_element_length() {
    let expected = PI / (2.0 * 100.0) * 1e5f64.sqrt();
    let error = |elements: usize| {
        let shape = |x: f64| 1e3 * (PI * x / 10.0).sin();
        let model = beam([0.0, 10.0], 2e8, 2000.0, RailEnds::Pinned, elements);
        let time_step = 1e-4;
        let values = let_go(model, shape, 5.0, undamped(time_step), 40_000);
        let found = frequency(&values, time_step);
        // The undamped scheme's own shift of a frequency is known.
        let w = 2.0 * (PI * found * time_step).tan() / time_step;
        (10.0 / elements as f64, w / (2.0 * PI) / expected - 1.0)
    };
    let errors = [2, 4, 8].map(error);
    for (h, e) in errors {
        println!("h = {h} m: {e:.3e}, (k h)^4/1440 = {:.3e}", (PI * h / 10.0).powi(4) / 1440.0);
    }
    let found = order(&errors);
    println!("order {found:.3}");
    assert!((found - 4.0).abs() < 0.15, "observed order {found}, found 3.95");
}

/// Shear strain is constant in an element, so frequencies of a Timoshenko beam converge with the square of its length;
/// the error is the share of shear in the flexibility, small in a rail.
#[test]
fn order_in_element_length_with_shear() {
    let shape = |x: f64| 1e3 * (PI * x / 0.6).sin();
    let error = |elements: usize| {
        let mut model = beam([0.0, 0.6], 6.4e6, 60.0, RailEnds::Pinned, elements);
        model.rail[0].shear = Some(SHEAR);
        let expected = timoshenko(&model.rail[0], SHEAR, 0.6, 1.0);
        let time_step = 2e-6;
        let found = frequency(&let_go(model, shape, 0.3, undamped(time_step), 20_000), time_step);
        let w = 2.0 * (PI * found * time_step).tan() / time_step;
        (0.6 / elements as f64, w / (2.0 * PI) / expected - 1.0)
    };
    let errors = [4, 8, 16].map(error);
    let found = order(&errors);
    println!("{errors:?}, order {found:.3}");
    assert!((found - 2.0).abs() < 0.15, "observed order {found}");
}

/// Part of a signal at one frequency, by a Hann window.
pub fn amplitude(values: &[f64], time_step: f64, frequency: f64) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let (mut re, mut im) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let window = 1.0 - (2.0 * PI * (i as f64 + 0.5) / count).cos();
        let angle = 2.0 * PI * frequency * time_step * i as f64;
        re += window * (value - mean) * angle.cos();
        im += window * (value - mean) * angle.sin();
    }
    2.0 * re.hypot(im) / count
}

/// At 200 km/h over seats 0.6 m apart the wheel force moves at 92.6 Hz and at hardly anything between its multiples.
#[test]
fn passing_of_sleepers() {
    let passing = SPEED / 0.6;
    assert!((passing - 92.6).abs() < 0.05);
    let model = ballast(110);
    let level = TrackLevel::as_built(&model);
    let forces = wheel_forces(&stepper(model, scheme(1e-4)), &level, 20.0, 56.0);
    let late: Vec<f64> = forces[forces.len() / 3..].iter().map(|f| f[0] / static_force()).collect();
    let at = |f: f64| amplitude(&late, 1e-4, f);
    println!(
        "wheel force at 92.6 Hz {:.2e}, at 185 Hz {:.2e}, at 140 Hz {:.2e} of the static force",
        at(passing),
        at(2.0 * passing),
        at(1.5 * passing)
    );
    assert!(at(passing) > 100.0 * at(1.5 * passing), "found 2.4e-3 and 1.2e-9");
}
