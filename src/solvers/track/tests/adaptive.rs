//! Steps of varying length against short steps of constant length, with sleepers that lift off and land.

use super::scenes::*;
use crate::solvers::track::*;
use std::sync::Arc;

/// Wheel forces every 0.4 ms; checks that every step has its reported length.
fn forces(passage: &mut Passage, every: usize) -> (Vec<f64>, Counters) {
    let (mut forces, mut time) = (Vec::new(), 0.0);
    let mut look = |view: &StepView<'_>| {
        time += if view.step() > 0 { view.time_step() } else { 0.0 };
        assert!((time - view.time()).abs() < 1e-12, "{time} {}", view.time());
        if view.is_on_grid(every) {
            forces.extend_from_slice(view.wheel_forces());
        }
    };
    let counters = passage.run(&mut look).unwrap();
    (forces, counters)
}

#[test]
fn short_steps_where_sleepers_land() {
    let model = transition(50, 20);
    let level = hollow(&model, 1e-3, 3e-3, -3.0, 2.4);
    let track = Arc::new(Track::new(model).unwrap());
    let train = Train::single(wagon(), Direction::Forward);
    let motion = Motion::Constant(55.56);
    let run = Run { train: &train, start: -12.0, finish: 5.0, motion: &motion };
    let longest = 4e-4;
    let scheme = |dt: f64| Scheme::generalised_alpha(dt, 0.85).unwrap();
    let fixed = |halvings: usize| {
        let stepper = Stepper::new(track.clone(), scheme(longest / (1 << halvings) as f64)).unwrap();
        forces(&mut Passage::new(&stepper, &level, run).unwrap(), 1 << halvings)
    };
    let worst = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let (reference, _) = fixed(7);
    let (coarse, coarse_counters) = fixed(2);
    let ladder = Ladder::new(&track, scheme(longest), 5).unwrap();
    let mut last = f64::INFINITY;
    for tolerance in [1e-4, 1e-5, 1e-6] {
        let mut passage = Passage::adaptive(&ladder, &level, run, tolerance).unwrap();
        let (found, counters) = forces(&mut passage, 1);
        assert_eq!(found.len(), reference.len());
        let error = worst(&found, &reference);
        println!(
            "tolerance {tolerance:e}: {error:.0} N, {counters:?}; 0.1 ms: {:.0} N, {coarse_counters:?}",
            worst(&coarse, &reference)
        );
        assert!(error < last, "a smaller tolerance gives a smaller error");
        last = error;
    }
}
