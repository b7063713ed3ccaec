//! Equilibria: closed forms, the check of the transition paper, the balance of forces.

use super::scenes::*;
use crate::solvers::track::*;

fn at_rest(model: TrackModel, loads: &Loads) -> (Track, StaticState) {
    let level = TrackLevel::as_built(&model);
    let track = Track::new(model).unwrap();
    let state = solve_static(&track, &level, loads).unwrap();
    (track, state)
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "found {found}, expected {expected}");
}

/// Twenty rigid seats on pads of 40 MN/m, 100 kN over the tenth: nodally exact values of the discrete beam.
#[test]
fn twenty_rigid_seats() {
    let mut model = ballast(20);
    model.seats.iter_mut().for_each(|s| s.foot = Foot::Rigid);
    (model.rail_ends, model.gravity) = (RailEnds::Free, 0.0);
    for elements in [1, 4, 7] {
        model.elements_per_bay = elements;
        let (track, state) = at_rest(model.clone(), &Loads { rail: &[(5.7, 100e3)], ..Loads::default() });
        let node = track.seat_node(9);
        close(state.rail_deflection[node], 0.9498e-3, 6e-5);
        close(state.rail_moment[node], 17.66e3, 3e-4);
        for (away, share) in [(0usize, 0.3799), (1, 0.2510), (2, 0.0867), (3, 0.0039)] {
            for seat in [9 - away, 9 + away] {
                assert!((state.seat_loads[seat] / 100e3 - share).abs() < 0.00005, "{seat}: {}", state.seat_loads[seat]);
            }
        }
        // Between two seats, on a node and inside an element.
        let (track, state) = at_rest(model.clone(), &Loads { rail: &[(6.0, 100e3)], ..Loads::default() });
        close(state.rail_deflection_at(&track, 6.0).unwrap(), 0.9582e-3, 6e-5);
        close(state.seat_loads[9] / 100e3, 0.339, 2e-3);
        if elements == 4 {
            let node = track.nodes().iter().position(|x| (x - 6.0).abs() < 1e-9).unwrap();
            close(state.rail_moment[node], 20.76e3, 3e-4);
        }
    }
}

/// A beam on springs 1 m apart against a beam on a Winkler foundation.
#[test]
fn long_beam_on_springs() {
    let (ei, k, load) = (4.41e5, 2.75e5, 18e3);
    let mut model = beam(100.0, ei, 0.0, RailEnds::Free, 1);
    let spring = |x: f64| Seat { x, pad_stiffness: k, pad_damping: 0.0, foot: Foot::Rigid };
    model.seats = (0..=100).map(|i| spring(i as f64)).collect();
    let (track, state) = at_rest(model, &Loads { rail: &[(50.0, load)], ..Loads::default() });
    let lambda = (k / (4.0 * ei)).powf(0.25);
    close(lambda * load / (2.0 * k), 20.5645e-3, 1e-5);
    close(state.rail_deflection_at(&track, 50.0).unwrap(), 20.5645e-3, 0.01);
}

#[test]
fn supported_beams() {
    // Simply supported: mid-span, and off the middle inside an element.
    let mid = Loads { rail: &[(5.0, 1e3)], ..Loads::default() };
    let (track, state) = at_rest(beam(10.0, 2e8, 2000.0, RailEnds::Pinned, 100), &mid);
    close(state.rail_deflection_at(&track, 5.0).unwrap(), 0.104_166_667e-3, 1e-7);
    for elements in [1, 3, 100] {
        let (l, ei, p, a) = (1.0f64, 2e8, 1e3, 0.4f64);
        let loads = Loads { rail: &[(a, p)], ..Loads::default() };
        let (track, state) = at_rest(beam(l, ei, 1.0, RailEnds::Pinned, elements), &loads);
        for x in [0.1f64, 0.25, 0.39, 0.4, 0.41, 0.5, 0.77, 1.0] {
            let (x_, b) = if x <= a { (x, l - a) } else { (l - x, a) };
            let expected = p * b * x_ * (l * l - b * b - x_ * x_) / (6.0 * l * ei);
            let found = state.rail_deflection_at(&track, x).unwrap();
            assert!((found - expected).abs() < 1e-7 * 1e-7, "{elements} elements, x {x}: {found}, {expected}");
        }
        close(state.balance.rail_ends, p, 1e-9);
    }
    // Clamped at both ends: PL³/192EI and PL/8.
    let (track, state) = at_rest(beam(10.0, 2e8, 1.0, RailEnds::Clamped, 10), &mid);
    close(state.rail_deflection_at(&track, 5.0).unwrap(), 1e3 * 1e3 / (192.0 * 2e8), 1e-9);
    close(state.rail_moment[5], 1e3 * 10.0 / 8.0, 1e-9);
    close(state.rail_moment[0], -1e3 * 10.0 / 8.0, 1e-9);
}

/// Two very stiff seats clamp the left of a beam whose right end is free.
#[test]
fn cantilever() {
    let (ei, length, load) = (2e3, 1.0, 1e3);
    let mut model = beam(length + 0.001, ei, 20.0, RailEnds::Free, 1);
    let rigid = |x: f64| Seat { x, pad_stiffness: 1e15, pad_damping: 0.0, foot: Foot::Rigid };
    model.seats = vec![rigid(0.0), rigid(0.001)];
    let (track, state) = at_rest(model, &Loads { rail: &[(length + 0.001, load)], ..Loads::default() });
    close(state.rail_deflection_at(&track, length + 0.001).unwrap(), load / (3.0 * ei), 2e-3);
}

#[test]
fn forces_balance_in_every_state() {
    let train = Train::single(wagon(), Direction::Forward);
    for (depth, ends) in
        [(0.0, RailEnds::Clamped), (1e-3, RailEnds::Clamped), (4e-3, RailEnds::Pinned), (2e-3, RailEnds::Free)]
    {
        let mut model = transition(40, 20);
        model.rail_ends = ends;
        let level = hollow(&model, 2e-3, depth, -3.0, 3.0);
        let track = Track::new(model).unwrap();
        for loads in [
            Loads::default(),
            Loads { rail: &[(-3.123, 40e3)], sleepers: &[(3, 5e3)], ..Loads::default() },
            Loads { train: Some((&train, 0.77)), ..Loads::default() },
        ] {
            let state = solve_static(&track, &level, &loads).unwrap();
            close(state.balance.supports(), state.balance.loads, 1e-9);
            assert!(state.contact_forces.iter().all(|f| *f >= 0.0));
            if loads.train.is_some() {
                let sum: f64 = state.wheel_forces.iter().sum();
                close(sum, wagon().mass() * 9.81, 1e-9);
            } else if depth > 1e-3 {
                assert!(state.contact_forces[..40].iter().filter(|f| **f == 0.0).count() >= 2, "no voids");
            }
        }
    }
}

#[test]
fn a_track_that_nothing_holds() {
    let mut model = ballast(8);
    model.rail_ends = RailEnds::Free;
    let level = TrackLevel::as_built(&model);
    let track = Track::new(model).unwrap();
    let lifted = Loads { rail: &[(2.4, -1e6)], ..Loads::default() };
    assert!(matches!(solve_static(&track, &level, &lifted), Err(TrackError::Mechanism { .. })));
    let bare = Track::new(beam(1.0, 1.0, 1.0, RailEnds::Free, 3)).unwrap();
    let level = TrackLevel::as_built(bare.model());
    assert!(matches!(solve_static(&bare, &level, &Loads::default()), Err(TrackError::Mechanism { .. })));
}

#[test]
fn places_off_the_track_are_refused() {
    let model = ballast(30);
    let level = TrackLevel::as_built(&model);
    let track = Track::new(model).unwrap();
    let train = Train::single(wagon(), Direction::Forward);
    let loads = Loads { train: Some((&train, 5.0)), ..Loads::default() };
    let Err(TrackError::OffTrack { x, .. }) = solve_static(&track, &level, &loads) else { panic!() };
    assert!((x - (5.0 - 6.77)).abs() < 1e-12);
}

#[test]
fn contradictions_are_refused() {
    let seating = |m: &mut TrackModel, stiffness: f64, closure: f64| {
        let seating = Some(Seating { stiffness, closure });
        m.seats[2].foot = Foot::Sleeper { mass: 1.0, support_stiffness: 1e6, support_damping: 0.0, seating };
    };
    let too_stiff = |m: &mut TrackModel| seating(m, 2e6, 1e-3);
    let too_short = |m: &mut TrackModel| seating(m, 1e5, 0.0);
    let broken: [&dyn Fn(&mut TrackModel); 8] = [
        &too_stiff,
        &too_short,
        &|m: &mut TrackModel| m.seats[3].x = m.seats[2].x,
        &|m: &mut TrackModel| m.seats[3].foot = Foot::Slab,
        &|m: &mut TrackModel| m.rail[0].end -= 1.0,
        &|m: &mut TrackModel| m.rail[0].bending_stiffness = f64::NAN,
        &|m: &mut TrackModel| m.ends[1] = -1.0,
        &|m: &mut TrackModel| m.seats[1].pad_stiffness = 0.0,
    ];
    for change in broken {
        let mut model = ballast(10);
        change(&mut model);
        assert!(matches!(Track::new(model), Err(TrackError::Model { .. })));
    }
}

/// Two slabs that meet, under one rail, carry as one track.
#[test]
fn slabs_that_meet() {
    let mut model = transition(5, 20);
    let mut second = model.slabs[0];
    (model.slabs[0].end, second.start) = (6.0, 6.0);
    model.slabs.push(second);
    let (track, state) = at_rest(model, &Loads { rail: &[(6.0, 1e5)], ..Loads::default() });
    close(state.balance.supports(), state.balance.loads, 1e-9);
    assert!(state.rail_deflection_at(&track, 6.0).unwrap() > 0.0);
}

/// Sleepers that all carry the same load settle like one spring with two stiffnesses.
#[test]
fn a_support_that_seats() {
    let (soft, stiff, closure) = (8e6, 50e6, 0.5e-3);
    let seated = |seats: usize, gravity: f64| {
        let mut model = ballast(seats);
        (model.rail_ends, model.gravity) = (RailEnds::Free, gravity);
        for seat in &mut model.seats {
            let seating = Some(Seating { stiffness: soft, closure });
            seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: stiff, support_damping: 0.0, seating };
        }
        model
    };
    for force in [1e3, 3.9e3, 4e3, 4.1e3, 60e3] {
        let loads: Vec<(usize, f64)> = (0..12).map(|seat| (seat, force)).collect();
        let (_, state) = at_rest(seated(12, 0.0), &Loads { sleepers: &loads, ..Loads::default() });
        let expected = (force / soft).min(closure) + ((force - soft * closure) / stiff).max(0.0);
        for seat in 0..12 {
            close(state.foot_displacements[seat], expected, 1e-10);
            close(state.contact_forces[seat], force, 1e-10);
        }
    }
    // Under a wagon some supports are closed, some are seating and some are open; together they carry the wagon.
    let model = seated(30, 9.81);
    let level = hollow(&model, 0.0, 4e-3, 13.0, 2.0);
    let train = Train::single(Vehicle { bogie_spacing: 2.5, ..wagon() }, Direction::Forward);
    let track = Track::new(model).unwrap();
    let state = solve_static(&track, &level, &Loads { train: Some((&train, 5.9)), ..Loads::default() }).unwrap();
    close(state.balance.supports(), state.balance.loads, 1e-9);
    let lowest = |i: &usize| state.foot_displacements[*i] - level.settlements[*i];
    assert!((0..30).any(|i| state.contact_forces[i] == 0.0));
    assert!((0..30).any(|i| (0.0..closure).contains(&lowest(&i))) && (0..30).any(|i| lowest(&i) > closure));
}
