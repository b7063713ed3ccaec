//! One bogie on two wheels over sleepers, on an even rail and on an uneven one.

use super::scenes::*;
use nalgebra::DMatrix;
use std::f64::consts::PI;
use std::sync::Arc;
use trackbed::solvers::track::*;

const WHEEL: f64 = 1019.5;
const BOGIE: f64 = 8000.0;
const AXLES: f64 = 2.5;

/// Bounce and pitch of the frame, then the leading and the trailing wheel.
fn bogie() -> Multibody {
    let (stiffness, damping, inertia) = (1e6, 30e3, BOGIE);
    let mut k = DMatrix::zeros(4, 4);
    for (wheel, side) in [(2, 0.5 * AXLES), (3, -0.5 * AXLES)] {
        let mut extension = DMatrix::zeros(4, 1);
        (extension[0], extension[1], extension[wheel]) = (1.0, side, -1.0);
        k += &extension * extension.transpose();
    }
    let wheel =
        |unknown: usize, offset: f64| Wheel { unknown: Some(unknown), offset, contact: WheelContact::Hertz(100e9) };
    Multibody {
        masses: vec![BOGIE, inertia, WHEEL, WHEEL],
        stiffness: &k * stiffness,
        damping: &k * damping,
        weighing: vec![BOGIE, 0.0, WHEEL, WHEEL],
        forces: vec![0.0; 4],
        wheels: vec![wheel(2, 0.0), wheel(3, AXLES)],
    }
}

/// Wheel forces and rail deflections over one node, step by step.
fn over(model: TrackModel, direction: Direction) -> (Vec<f64>, Vec<f64>) {
    let level = TrackLevel::as_built(&model);
    let [left, right] = model.ends;
    let stepper = Stepper::new(Arc::new(Track::new(model).unwrap()), scheme(1e-4)).unwrap();
    let node = stepper.track().seat_node(50);
    let train = Train::single(bogie(), direction);
    let (start, finish) = match direction {
        Direction::Forward => (left + 10.0, right - 6.0),
        Direction::Backward => (right - 10.0, left + 6.0),
    };
    let motion = Motion::Constant(140.0 / 3.6);
    let run = Run { train: &train, start, finish, motion: &motion };
    let (mut forces, mut deflections) = (Vec::new(), Vec::new());
    let mut look = |view: &StepView<'_>| {
        forces.extend_from_slice(view.wheel_forces());
        deflections.push(view.rail_deflection(node));
    };
    Passage::new(&stepper, &level, run).unwrap().run(&mut look).unwrap();
    (forces, deflections)
}

#[test]
fn a_bogie_keeps_its_weight() {
    let load = (BOGIE / 2.0 + WHEEL) * 9.81;
    for direction in [Direction::Forward, Direction::Backward] {
        let (forces, _) = over(ballast(100), direction);
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        let worst = forces.iter().map(|f| (f / load - 1.0).abs()).fold(0.0, f64::max);
        println!("{direction:?}: mean {:.2e}, largest {worst:.2e} from the static force", mean / load - 1.0);
        assert!((mean / load - 1.0).abs() < 1e-4 && worst < 0.02);
    }
}

/// Waves of 1.5 m and 0.1 mm on the rail: deflections hardly hang on the elements between two seats.
#[test]
fn elements_under_an_uneven_rail() {
    let uneven = |elements: usize| {
        let mut model = ballast(100);
        model.elements_per_bay = elements;
        let wave = |i: usize| (0.1 * i as f64, 1e-4 * (2.0 * PI * 0.1 * i as f64 / 1.5).sin());
        model.irregularity = Irregularity::spline((0..=600).map(wave).collect()).unwrap();
        over(model, Direction::Forward).1
    };
    let finest = uneven(8);
    let peak = finest.iter().copied().fold(0.0, f64::max);
    for (elements, bound) in [(1, 1e-3), (2, 1e-4), (4, 1e-5)] {
        let found = uneven(elements);
        let worst = found.iter().zip(&finest).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / peak;
        println!("{elements} elements a bay: {worst:.1e} of the peak");
        assert!(worst < bound, "{elements}: {worst}");
    }
}
