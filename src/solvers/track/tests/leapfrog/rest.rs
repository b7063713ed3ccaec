//! Tracks that come to rest: closed forms and statics.

use super::*;

/// Twenty fixed sleepers under 100 kN over one of them: the moment is 17.66 kN m, where published figures are 16 and
/// 19.
#[test]
fn fixed_sleepers() {
    let mut model = ballast(20);
    model.seats.iter_mut().for_each(|seat| seat.foot = Foot::Rigid);
    (model.rail_ends, model.gravity) = (RailEnds::Free, 0.0);
    let x = model.seats[10].x;
    let mut leapfrog = leapfrog(&model, &TrackLevel::as_built(&model), 1e-4);
    leapfrog.set_drag(1000.0).unwrap();
    for step in 0..6000 {
        leapfrog.step(&[], &WheelLoads::Given(&[(x, gradually(step, 2000) * 100e3)])).unwrap();
    }
    let (view, node) = (leapfrog.view(), leapfrog.track().seat_node(10));
    let shares: Vec<f64> = (10..14).map(|seat| view.seat_load(seat) / 1e3).collect();
    let (moment, deflection) = (view.rail_moment(node), view.rail_deflection(node));
    let rest = solve_static(leapfrog.track(), leapfrog.level(), &Loads { rail: &[(x, 100e3)], ..Loads::default() });
    let rest = rest.unwrap();
    println!(
        "{:.3} kN m ({:.3}), {:.4} mm, {shares:.3?} %",
        moment / 1e3,
        rest.rail_moment[node] / 1e3,
        deflection * 1e3
    );
    assert!((moment / 17.66e3 - 1.0).abs() < 1e-3 && (deflection - 0.9498e-3).abs() < 1e-7);
    assert!((moment / rest.rail_moment[node] - 1.0).abs() < 1e-9, "{}", rest.rail_moment[node]);
    for (share, expected) in shares.iter().zip([37.99, 25.10, 8.67, 0.39]) {
        assert!((share - expected).abs() < 0.01, "{share} {expected}");
    }
    let mut moments = vec![0.0; leapfrog.track().nodes().len()];
    view.rail_moments(&mut moments);
    assert_eq!(moments[node], moment);
}

/// Pads under sleepers and the ground below them act in series.
#[test]
fn pads_under_sleepers() {
    let (stiff, model) = (150e6, ballast(20));
    let mut padded = model.clone();
    for seat in &mut padded.seats {
        seat.foot = Foot::Carried {
            mass: 145.0,
            pad: Some(UnderPad { mass: 5.0, stiffness: stiff, damping: 10e3 }),
            pitch: None,
        };
    }
    let level = TrackLevel::as_built(&model);
    let mut leapfrog = leapfrog(&padded, &level, 2e-5);
    leapfrog.set_drag(500.0).unwrap();
    assert_eq!(leapfrog.carried(), (0..20).collect::<Vec<_>>());
    let mut springs = Springs::under(&model, &level);
    let x = 6.1;
    for step in 0..40_000 {
        let force = 1e5 * gradually(step, 10_000);
        leapfrog.step(springs.push(&leapfrog), &WheelLoads::Given(&[(x, force)])).unwrap();
    }
    let mut series = model.clone();
    for seat in &mut series.seats {
        let support_stiffness = 1.0 / (1.0 / 50e6 + 1.0 / stiff);
        seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness, support_damping: 0.0, seating: None };
    }
    let track = Track::new(series).unwrap();
    let rest = solve_static(&track, &level, &Loads { rail: &[(x, 1e5)], ..Loads::default() }).unwrap();
    let view = leapfrog.view();
    for seat in 0..20 {
        // The weight of the underside does not load the pad.
        let difference = view.foot_displacement(seat) - rest.foot_displacements[seat];
        let underside = view.foot_displacement(seat) - view.underside_displacement(seat);
        let force = view.contact_force(seat).unwrap();
        assert!(difference.abs() < 5.0 * 9.81 / stiff * 1.5, "{difference}");
        assert!(force == 0.0 || (underside - (force - 5.0 * 9.81) / stiff).abs() < 1e-10);
        assert!((force - rest.contact_forces[seat]).abs() < 10.0, "{force} {}", rest.contact_forces[seat]);
    }
}

/// Settling supports move the sleepers down; at rest again the track is in the position of the statics.
#[test]
fn levels_change_while_it_runs() {
    let mut model = transition(20, 20);
    model.auxiliary_rails = vec![AuxiliaryRail {
        start: -6.0,
        end: 6.0,
        mass: 60.0,
        bending_stiffness: 6.4e6,
        pad_stiffness: 40e6,
        pad_damping: 5e3,
    }];
    model.seats[39].foot = Foot::Rigid;
    let settled = hollow(&model, 2e-3, 1e-3, -3.0, 2.4);
    let mut leapfrog = leapfrog(&model, &TrackLevel::as_built(&model), 1e-4);
    leapfrog.move_level(&settled, 0.1).unwrap();
    leapfrog.set_drag(100.0).unwrap();
    for step in 0..10_000 {
        if step == 5000 {
            assert_eq!(leapfrog.level(), &settled);
            leapfrog.set_time_step(1.5e-4).unwrap();
        }
        leapfrog.step(&[], &WheelLoads::None).unwrap();
    }
    let rest = solve_static(leapfrog.track(), &settled, &Loads::default()).unwrap();
    let view = leapfrog.view();
    let largest = (0..40).map(|seat| (view.seat_load(seat) - rest.seat_loads[seat]).abs()).fold(0.0, f64::max);
    println!("seat loads within {largest:.1e} N of statics");
    assert!(largest < 1.0 && rest.contact_forces.iter().any(|force| *force > 3e3));
}

/// Carried feet held at their levels carry the track.
#[test]
fn carried_feet_at_rest() {
    let model = carried(ballast(20));
    let mut level = TrackLevel::as_built(&model);
    level.settlements[7] = 1e-3;
    let track = Track::new(model.clone()).unwrap();
    let rest = solve_static(&track, &level, &Loads { rail: &[(6.0, 5e4)], ..Loads::default() }).unwrap();
    assert!((rest.balance.supports() / rest.balance.loads - 1.0).abs() < 1e-9);
    assert_eq!(rest.foot_displacements[7], 1e-3);
    assert!(rest.contact_forces[7] < rest.contact_forces[4]);
}
