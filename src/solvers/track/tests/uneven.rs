//! An uneven rail and a varying speed: closed forms on a rigid track, and changes that must have no effect.

use super::scenes::*;
use crate::solvers::track::*;
use std::f64::consts::PI;

/// A rigid track.
fn rigid(irregularity: Irregularity) -> TrackModel {
    let mut model = ballast(50);
    model.rail[0].bending_stiffness = 6.4e14;
    model.seats.iter_mut().for_each(|s| (s.foot, s.pad_stiffness) = (Foot::Rigid, 4e16));
    TrackModel { irregularity, ..model }
}

const MASS: f64 = 500.0;
const STIFFNESS: f64 = 2e6;
const SPEED: f64 = 30.0;

/// Time since `begin` (m) and the wheel force beyond the weight, N, of a sprung mass.
fn force_over(irregularity: Irregularity, begin: f64, finish: f64, damping: f64) -> Vec<(f64, f64)> {
    let model = rigid(irregularity);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, 5e-5, 0.95);
    let train = Train::single(Multibody::sprung_mass(MASS, STIFFNESS, damping), Direction::Forward);
    let run = Run { train: &train, start: begin - 1.5, finish, motion: &Motion::Constant(SPEED) };
    let mut seen = Vec::new();
    let mut look = |view: &StepView<'_>| {
        seen.push(((view.wheel_positions()[0] - begin) / SPEED, view.wheel_forces()[0] - MASS * 9.81));
    };
    Passage::new(&stepper, &level, run).unwrap().run(&mut look).unwrap();
    seen
}

fn worst(seen: &[(f64, f64)], expected: impl Fn(f64) -> f64) -> f64 {
    let largest = seen.iter().fold(0.0f64, |m, (_, f)| m.max(f.abs()));
    seen.iter().filter(|(t, _)| *t > 0.0).fold(0.0f64, |m, (t, f)| m.max((f - expected(*t)).abs())) / largest
}

/// Points of a profile every centimetre.
fn points(begin: f64, length: f64, profile: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let count = (length / 0.01).round() as usize;
    (0..=count).map(|i| length * i as f64 / count as f64).map(|s| (begin + s, profile(s))).collect()
}

/// A sprung mass without damper that meets `r = A sin(ω t)`:
/// `F - m g = k (y - r)`, `y = A/(1 - β²) (sin ω t - β sin ω_0 t)`, `β = ω/ω_0`.
#[test]
fn a_sprung_mass_on_waves() {
    let (size, length, begin) = (1e-3, 1.7, 4.0);
    let wave = |s: f64| size * (2.0 * PI * s / length).sin();
    let profile = Irregularity::spline(points(begin, 15.0 * length, wave)).unwrap();
    let (own, forced) = ((STIFFNESS / MASS).sqrt(), 2.0 * PI * SPEED / length);
    let beta = forced / own;
    let expected = |t: f64| {
        let y = size / (1.0 - beta * beta) * ((forced * t).sin() - beta * (own * t).sin());
        STIFFNESS * (y - size * (forced * t).sin())
    };
    let found = worst(&force_over(profile, begin, 25.0, 0.0), expected);
    println!("waves: wheel force within {found:.1e}");
    assert!(found < 2e-4);
}

/// With a damper, after the initial motion has decayed: `|F - m g| = m ω² A |(k + i ω c)/(k - m ω² + i ω c)|`.
#[test]
fn a_damped_mass_on_waves() {
    let (size, length, begin, c) = (1e-3, 0.9, 4.0, 3e4);
    let wave = |s: f64| size * (2.0 * PI * s / length).sin();
    let profile = Irregularity::spline(points(begin, 22.0, wave)).unwrap();
    let omega = 2.0 * PI * SPEED / length;
    let (k, inertia) = (STIFFNESS, MASS * omega * omega);
    let expected = inertia * size * (k * k + (omega * c).powi(2)).sqrt() / (k - inertia).hypot(omega * c);
    let seen = force_over(profile, begin, 25.0, c);
    let late = seen.iter().filter(|(t, _)| *t > 0.4).fold((0.0f64, 0.0f64), |m, (_, f)| (m.0.min(*f), m.1.max(*f)));
    println!("damped waves: {:.1} .. {:.1} N, expected {expected:.1} N", late.0, late.1);
    assert!((late.1 / expected - 1.0).abs() < 2e-3 && (late.0 / expected + 1.0).abs() < 2e-3);
}

/// A dip `r = D/2 (1 - cos ω t)`: within the dip
/// `y = D/2 (1 - cos ω_0 t) - D/2 ω_0²/(ω_0² - ω²) (cos ω t - cos ω_0 t)`.
#[test]
fn a_sprung_mass_in_a_dip() {
    let (depth, length, begin) = (2e-3, 3.0, 6.0);
    let dip = |s: f64| 0.5 * depth * (1.0 - (2.0 * PI * s / length).cos());
    let (own, forced) = ((STIFFNESS / MASS).sqrt(), 2.0 * PI * SPEED / length);
    let expected = |t: f64| {
        let share = own * own / (own * own - forced * forced);
        let (cos, own_cos) = ((forced * t).cos(), (own * t).cos());
        let y = 0.5 * depth * (1.0 - own_cos - share * (cos - own_cos));
        STIFFNESS * (y - 0.5 * depth * (1.0 - cos))
    };
    for (form, limit) in [(Irregularity::linear as fn(Vec<(f64, f64)>) -> _, 2e-4), (Irregularity::spline, 2e-4)] {
        // Level points keep the ends of the spline level.
        let mut all = vec![(begin - 0.02, 0.0), (begin - 0.01, 0.0)];
        all.extend(points(begin, length, dip));
        let found = worst(&force_over(form(all).unwrap(), begin, begin + length, 0.0), expected);
        println!("dip: wheel force within {found:.1e}");
        assert!(found < limit);
    }
}

/// A surface that is lower everywhere by the same amount, and a profile of one speed, have no effect.
#[test]
fn a_level_offset_changes_nothing() {
    let run = |offset: Option<f64>, motion: Motion| {
        let mut model = transition(45, 20);
        if let Some(offset) = offset {
            model.irregularity = Irregularity::linear(vec![(0.0, offset), (1.0, offset)]).unwrap();
        }
        let level = hollow(&model, 2e-3, 1e-3, -3.0, 2.4);
        let stepper = stepper(model, 1e-4, 0.85);
        let train = Train::single(wagon(), Direction::Forward);
        let run = Run { train: &train, start: -14.0, finish: -8.0, motion: &motion };
        let mut forces = Vec::new();
        let mut look = |view: &StepView<'_>| forces.extend_from_slice(view.wheel_forces());
        Passage::new(&stepper, &level, run).unwrap().run(&mut look).unwrap();
        forces
    };
    let even = run(None, Motion::Constant(55.56));
    for other in
        [run(Some(0.02), Motion::Constant(55.56)), run(None, Motion::ByChainage(vec![(-12.0, 55.56), (-11.0, 55.56)]))]
    {
        assert_eq!(other.len(), even.len());
        assert!(other.iter().zip(&even).all(|(a, b)| (a - b).abs() < 1e-6 * b));
    }
}

/// A train that slows down is at the position of the closed form in every step, and stops within a step of the finish.
#[test]
fn a_train_that_slows_down() {
    let model = ballast(60);
    let level = TrackLevel::as_built(&model);
    let stepper = stepper(model, 1e-4, 0.85);
    let train = Train::single(wagon(), Direction::Backward);
    // v = 40 m/s + 4/s (x - 20 m) down to 20 m/s at x = 15 m.
    let motion = Motion::ByChainage(vec![(15.0, 20.0), (20.0, 40.0)]);
    let run = Run { train: &train, start: 20.0, finish: 12.0, motion: &motion };
    let mut passage = Passage::new(&stepper, &level, run).unwrap();
    let slowing = 2f64.ln() / 4.0;
    assert_eq!(passage.planned_steps(), ((slowing + 3.0 / 20.0) / 1e-4) as usize);
    let mut look = |view: &StepView<'_>| {
        let t = view.time();
        let expected = if t < slowing { 20.0 + 10.0 * (-4.0 * t).exp_m1() } else { 15.0 - 20.0 * (t - slowing) };
        assert!((view.wheel_positions()[0] - expected).abs() < 1e-11);
    };
    passage.run(&mut look).unwrap();
    assert!(passage.view().wheel_positions()[0] - 12.0 < 20.0 * 1e-4);
}
