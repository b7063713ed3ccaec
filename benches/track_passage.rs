//! Time per step of one wagon over the transition of 66 m: 69 sleepers, 24 m of slab, 200 km/h, dt 0.1 ms.

#[path = "shared/wagon.rs"]
mod wagon;

use std::sync::Arc;
use std::time::Instant;
use trackbed::linalg::banded::SymmetricBanded;
use trackbed::solvers::track::*;

fn main() -> Result<(), TrackError> {
    let ends = [-42.0, 24.0];
    let seat = |x: f64, foot: Foot| Seat { x, pad_stiffness: 40e6, pad_damping: 5e3, foot };
    let sleeper = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 50e3, seating: None };
    let mut seats: Vec<Seat> = (1..=69).rev().map(|i| seat(-0.6 * f64::from(i), sleeper)).collect();
    seats.extend((0..40).map(|i| seat(0.6 * f64::from(i), Foot::Slab)));
    let model = TrackModel {
        ends,
        rail: vec![RailSection { start: ends[0], end: ends[1], mass: 60.0, bending_stiffness: 6.4e6, shear: None }],
        seats,
        slabs: vec![Slab {
            start: 0.0,
            end: 24.0,
            bending_stiffness: 122e6,
            mass: 1200.0,
            foundation_stiffness: 160e6,
            foundation_damping: 160e3,
        }],
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends: RailEnds::Clamped,
        irregularity: Irregularity::default(),
        elements_per_bay: 4,
        gravity: 9.81,
    };
    let vehicle = wagon::wagon();
    let settlement = |seat: &Seat| match seat.foot {
        Foot::Sleeper { .. } => {
            let s = ((seat.x + 3.0) / 2.4).clamp(-1.0, 1.0);
            2e-3 + 1e-3 * (0.5 * std::f64::consts::PI * s).cos().powi(2)
        }
        _ => 0.0,
    };
    let level = TrackLevel { settlements: model.seats.iter().map(settlement).collect(), ends: [2e-3, 0.0] };

    let clock = Instant::now();
    let track = Arc::new(Track::new(model)?);
    println!("{} unknowns, meshed in {:.2} ms", track.order(), 1e3 * clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    let state = solve_static(&track, &level, &Loads::default())?;
    println!("at rest in {:.2} ms, {} sets", 1e3 * clock.elapsed().as_secs_f64(), state.iterations);
    let clock = Instant::now();
    let stepper = Stepper::new(track.clone(), Scheme::generalised_alpha(1e-4, 0.85)?)?;
    println!("step factored in {:.1} ms", 1e3 * clock.elapsed().as_secs_f64());

    for (direction, start, finish) in [(Direction::Forward, -27.0, 20.0), (Direction::Backward, 10.0, -30.0)] {
        for observed in [false, true] {
            let train = Train::single(vehicle, direction);
            let run = Run { train: &train, start, finish, motion: &Motion::Constant(55.56) };
            let clock = Instant::now();
            let mut passage = Passage::new(&stepper, &level, run)?;
            let begun = clock.elapsed().as_secs_f64();
            let clock = Instant::now();
            let mut envelope = Envelope::default();
            let counters = if observed { passage.run(&mut envelope)? } else { passage.run(&mut ())? };
            let per_step = 1e6 * clock.elapsed().as_secs_f64() / counters.steps as f64;
            println!(
                "{direction:?}, envelope {observed}: begun in {:.1} ms, {per_step:.1} us/step, {counters:?}",
                1e3 * begun
            );
            if let Some((i, force)) = envelope.contact_forces.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)) {
                let x = passage.view().track().model().seats[i].x;
                println!("  largest contact force {:.2} kN at x = {x:.1} m", 1e-3 * force);
            }
        }
    }
    against_the_plain_way(&track, &level, vehicle)
}

/// One passage of the wagon over the whole model in steps of 0.05 ms, and what the plain way would take at the least:
/// the same banded matrix factored anew and solved in each of its Newton iterations, all else for nothing.
fn against_the_plain_way(track: &Arc<Track>, level: &TrackLevel, vehicle: Vehicle) -> Result<(), TrackError> {
    let stepper = Stepper::new(track.clone(), Scheme::generalised_alpha(5e-5, 0.85)?)?;
    let train = Train::single(vehicle, Direction::Forward);
    let motion = Motion::Constant(55.56);
    let run = Run { train: &train, start: -27.45, finish: 18.0, motion: &motion };
    let order = track.order();
    let mut matrix = SymmetricBanded::zeros(order, 5);
    for i in 0..order {
        for j in i.saturating_sub(5)..i {
            matrix.add(i, j, 0.1);
        }
        matrix.add(i, i, 2.0);
    }
    let (mut ours, mut plain) = (Vec::new(), Vec::new());
    let mut counters = Counters::default();
    for _ in 0..5 {
        let clock = Instant::now();
        counters = Passage::new(&stepper, level, run)?.run(&mut ())?;
        ours.push(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        let mut x = vec![1.0; order];
        for _ in 0..counters.iterations {
            x.fill(1.0);
            std::hint::black_box(&matrix).factor().expect("a dominant diagonal").solve_in_place(&mut x);
        }
        plain.push(clock.elapsed().as_secs_f64());
    }
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let (ours, plain) = (median(&mut ours), median(&mut plain));
    println!(
        "one passage in steps of 0.05 ms: {} steps, {ours:.3} s; {} refactorisations and solves alone {plain:.3} s, {:.1} times as long",
        counters.steps,
        counters.iterations,
        plain / ours
    );
    Ok(())
}
