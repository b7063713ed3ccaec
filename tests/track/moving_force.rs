//! A constant force that rolls over beams, against series, modes and the steady motion of an endless beam.

use crate::modal::Modes;
use crate::scenes::*;
use crate::stiffness_jump::{EI, LOAD, MASS, SOFT, STIFF, jump};
use nalgebra::Complex;
use std::f64::consts::PI;
use trackbed::solvers::track::*;

/// Rail deflections at every node for each of the steps that `at` asks for, with the force starting at rest on the left
/// end.
fn roll(
    model: &TrackModel,
    scheme: Scheme,
    force: f64,
    to: f64,
    speed: f64,
    mut look: impl FnMut(&StepView<'_>),
) -> Vec<f64> {
    let level = TrackLevel::as_built(model);
    let stepper = stepper(model.clone(), scheme);
    let train = Train::single(Multibody::moving_force(force), Direction::Forward);
    let run = Run { train: &train, start: model.ends[0], finish: to, motion: &Motion::Constant(speed) };
    let mut passage = Passage::new(&stepper, &level, run).unwrap();
    passage.run(&mut look).unwrap();
    let view = passage.view();
    assert!((view.wheel_positions()[0] - to).abs() < 1e-9, "the force has not come to {to} m");
    (0..stepper.track().nodes().len()).map(|node| view.rail_deflection(node)).collect()
}

/// Mid-span of a simply supported beam (25 m, EI = 8.323 GN m², 2303 kg/m) under 56.4 kN at 100 km/h, the force of the
/// sprung mass of Yang and Yau: Fryba's series.
#[test]
fn simply_supported_beam() {
    let (l, ei, m, speed): (f64, f64, f64, f64) = (25.0, 8.323e9, 2303.0, 100.0 / 3.6);
    let force = 5750.0 * 9.81;
    let series = |t: f64, modes: usize| -> f64 {
        (1..=modes)
            .step_by(2)
            .map(|n| {
                let (q, sign) = (n as f64 * PI / l, if n % 4 == 1 { 1.0 } else { -1.0 });
                let (w, drive) = (q * q * (ei / m).sqrt(), q * speed);
                let amplitude = 2.0 * force / (m * l * (w * w - drive * drive));
                sign * amplitude * ((drive * t).sin() - drive / w * (w * t).sin())
            })
            .sum()
    };
    let model = beam([0.0, l], ei, m, RailEnds::Pinned, 20);
    let (mut worst, mut peak, mut one, mut nine) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    let still = force * l.powi(3) / (48.0 * ei);
    roll(&model, undamped(9e-5), force, l, speed, |view| {
        let (found, t) = (view.rail_deflection(10), view.time());
        worst = worst.max((found - series(t, 99)).abs() / still);
        (peak, one, nine) = (peak.max(found), one.max(series(t, 1)), nine.max(series(t, 9)));
    });
    println!(
        "static {:.4} mm, peak {:.5} mm, series 1 and 9 modes {:.4} {:.4}; differs by {worst:.1e}",
        still * 1e3,
        peak * 1e3,
        one * 1e3,
        nine * 1e3
    );
    assert!((still - 2.2062e-3).abs() < 2e-6 && (one - 2.3765e-3).abs() < 2e-6 && (nine - 2.3971e-3).abs() < 2e-6);
    assert!(worst < 5e-5, "found 1.3e-5");
}

/// Over the jump of stiffness: the solver against the modes of the same springs, exact in time, and its order.
#[test]
fn over_the_jump() {
    let model = jump(20.0, 0.5);
    let modes = Modes::of(&Track::new(model.clone()).unwrap());
    let speed = 100.0;
    let expected = modes.under_moving_force(LOAD, -20.0, 5.0, speed);
    let scale = largest(expected.iter().step_by(2).copied());
    let errors = [2e-5, 1e-5, 5e-6].map(|dt| {
        let found = roll(&model, undamped(dt), LOAD, 5.0, speed, |_| ());
        (dt, largest(found.iter().enumerate().map(|(n, w)| (w - expected[2 * n]) / scale)))
    });
    println!("{speed} m/s: {errors:?}, order {:.2}", order(&errors));
    // The end of the beam is left in a moment and rings faster than the coarse steps.
    assert!(errors[2].1 < 4e-5 && order(&errors) > 1.5, "found 1.8e-5 and 1.71");
}

/// Roots of `r⁴ + a r² + b r + d`, by the method of Durand and Kerner.
fn roots(a: f64, b: f64, d: f64) -> [Complex<f64>; 4] {
    let scale = d.powf(0.25);
    let mut r = [0, 1, 2, 3].map(|i| scale * Complex::new(0.4, 0.9).powi(i));
    for _ in 0..500 {
        for i in 0..4 {
            let others: Complex<f64> = (0..4).filter(|j| *j != i).map(|j| r[i] - r[j]).product();
            let z = r[i];
            r[i] -= (z * z * z * z + z * z * a + z * b + d) / others;
        }
    }
    r
}

/// The steady motion of an endless beam on a damped foundation under a force at speed v: with s = x - v t,
/// `EI w'''' + m v² w'' - c v w' + k w = P δ(s)`, a sum over the roots of its polynomial.
fn steady(s: f64, k: f64, c: f64, speed: f64) -> f64 {
    let (a, b, d) = (MASS * speed * speed / EI, -c * speed / EI, k / EI);
    let side = if s >= 0.0 { 1.0 } else { -1.0 };
    let decaying = roots(a, b, d).into_iter().filter(|r| side * r.re < 0.0);
    let sum: Complex<f64> = decaying.map(|r| (r * s).exp() / (r * r * r * 4.0 + r * 2.0 * a + b)).sum();
    side * LOAD / EI * sum.re
}

#[test]
fn steady_motion_far_from_the_jump() {
    for speed in [100.0, 200.0] {
        // Undamped and far below the critical speed: P λ/2k over √(1 - (v/v_cr)²).
        let critical = (4.0 * SOFT * EI / (MASS * MASS)).powf(0.25);
        let undamped = LOAD * (SOFT / (4.0 * EI)).powf(0.25) / (2.0 * SOFT) / (1.0 - (speed / critical).powi(2)).sqrt();
        assert!((steady(0.0, SOFT, 0.0, speed) / undamped - 1.0).abs() < 1e-9);
        let mut model = jump(60.0, 0.5);
        for seat in &mut model.seats {
            let k = seat.pad_stiffness;
            seat.pad_damping = 0.2 * 2.0 * (k * 0.5 * MASS).sqrt();
        }
        for (k, to) in [(SOFT, -15.0), (STIFF, 40.0)] {
            let c = 0.2 * 2.0 * (k * MASS).sqrt();
            let found = roll(&model, scheme(0.02 / speed), LOAD, to, speed, |_| ());
            let mut worst = 0.0f64;
            let nodes: Vec<f64> = Track::new(model.clone()).unwrap().nodes().to_vec();
            for (x, w) in nodes.iter().zip(&found).filter(|(x, _)| (**x - to).abs() < 10.0) {
                worst = worst.max((w - steady(x - to, k, c, speed)).abs());
            }
            let peak = steady(0.0, k, c, speed);
            println!("{speed} m/s on {k:e} N/m²: {:.5} mm, differs by {:.1e} of it", peak * 1e3, worst / peak);
            // At nine tenths of the soft side's critical speed 45 m are not enough to forget the start.
            let limit = if speed > 0.8 * (4.0 * k * EI / (MASS * MASS)).powf(0.25) { 2e-2 } else { 5e-4 };
            assert!(worst / peak < limit, "found 2.5e-4, 1.2e-4, 1.2e-2, 1.5e-4");
        }
    }
}
