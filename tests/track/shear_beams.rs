//! Timoshenko beams in motion against closed forms.

use crate::frequencies::let_go;
use crate::scenes::*;
use nalgebra::{Matrix2, SymmetricEigen, Vector2};
use std::f64::consts::PI;
use trackbed::solvers::track::*;

/// A simply supported thick beam under a step load at mid-span against its modal series: for every n the shape has an
/// amplitude of deflection and one of rotation, two unknowns and two frequencies.
#[test]
fn thick_beam_under_a_step_load() {
    let (length, ei, mass, load) = (10.0, 2e6, 2000.0, 1e3);
    let shear = Shear { stiffness: 5.0 / 6.0 * 1e6, rotary_inertia: 2000.0 };
    let mut model = beam([0.0, length], ei, mass, RailEnds::Pinned, 160);
    model.rail[0].shear = Some(shear);
    let time_step = 1e-3;
    let at_middle = |x: f64| if (x - 5.0).abs() < 1e-9 { load } else { 0.0 };
    let values = let_go(model, at_middle, 5.0, undamped(time_step), 6000);
    let still = values[0];
    assert!((still / (10.41667e-3 + 3e-3) - 1.0).abs() < 1e-6, "bending and shear, found {still}");

    let modes: Vec<(f64, f64)> = (1..1200)
        .step_by(2)
        .flat_map(|n| {
            let q = n as f64 * PI / length;
            let (ga, m) = (shear.stiffness, Vector2::new(mass, shear.rotary_inertia).map(f64::sqrt));
            let k = Matrix2::new(ga * q * q, -ga * q, -ga * q, ei * q * q + ga);
            let eigen = SymmetricEigen::new(Matrix2::from_fn(|i, j| k[(i, j)] / (m[i] * m[j])));
            [0, 1].map(|mode| {
                let share = eigen.eigenvectors[(0, mode)] / m[0];
                (eigen.eigenvalues[mode], 2.0 * load / length * share * share)
            })
        })
        .collect();
    let series = |time: f64| modes.iter().map(|(w2, p)| p / w2 * (1.0 - (w2.sqrt() * time).cos())).sum::<f64>();
    let mut worst = 0.0f64;
    for (step, value) in values.iter().enumerate().step_by(10) {
        worst = worst.max((still - value - series(step as f64 * time_step)).abs() / still);
    }
    println!("largest difference {worst:.1e} of the static deflection");
    // A point load sends waves of shear with fronts that no mesh resolves: 1.0e-2 with half the elements and twice the
    // step.
    assert!(worst < 8e-3, "found 6.0e-3");
}

/// A beam that can only shear is a rod: a step force runs along it at √(κGA/ρA) = 816.5 m/s, and where it acts the
/// deflection climbs to twice the static one and falls again, in straight lines, every 4 L/c.
#[test]
fn shear_wave() {
    let (length, ga, mass, load): (f64, f64, f64, f64) = (1.0, 2e6, 3.0, 1e3);
    let speed = (ga / mass).sqrt();
    assert!((speed - 816.5).abs() < 0.05);
    // Two rods side by side, clamped outside and loaded in the middle with both forces.
    let mut model = beam([-length, length], 1e11, mass, RailEnds::Clamped, 200);
    model.rail[0].shear = Some(Shear { stiffness: ga, rotary_inertia: 0.0 });
    let time_step = 2e-6;
    let at_middle = |x: f64| if x.abs() < 1e-9 { 2.0 * load } else { 0.0 };
    let values = let_go(model, at_middle, 0.0, scheme(time_step), 5000);
    let still = load * length / ga;
    assert!((values[0] / still - 1.0).abs() < 1e-4, "static {}", values[0]);
    let (mut worst, mut mean) = (0.0f64, 0.0);
    for (step, value) in values.iter().enumerate() {
        let phase = (speed * step as f64 * time_step / length).rem_euclid(4.0);
        let expected = if phase < 2.0 { phase } else { 4.0 - phase };
        let difference = (1.0 - value / values[0] - expected).abs();
        worst = worst.max(difference);
        mean += difference / values.len() as f64;
    }
    println!(
        "differs by {worst:.1e} of the static deflection at the turns of the second period, {mean:.1e} in the mean"
    );
    assert!(worst < 0.04 && mean < 3e-3, "found 2.4e-2 and 1.6e-3");
}
