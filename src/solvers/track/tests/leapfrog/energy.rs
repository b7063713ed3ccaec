//! Tests of the energy account.

use super::*;

/// Work of forces, losses in pads and drag, and stored energy balance, under moving forces and pushing springs.
#[test]
fn energy_is_accounted_for() {
    let model = ballast(40);
    let level = TrackLevel::as_built(&model);
    for drag in [0.0, 30.0] {
        let mut leapfrog = leapfrog(&carried(model.clone()), &level, 20e-6);
        leapfrog.set_drag(drag).unwrap();
        let mut springs = Springs::under(&model, &level);
        leapfrog.step(springs.push(&leapfrog), &WheelLoads::None).unwrap();
        leapfrog.watch();
        for step in 0..5000 {
            let x = 8.0 + SPEED * 20e-6 * f64::from(step);
            leapfrog.step(springs.push(&leapfrog), &WheelLoads::Given(&[(x, FORCE), (x + 1.78, FORCE)])).unwrap();
        }
        let account = leapfrog.energy().unwrap();
        println!("{account:.3?}, residual {:.1e} J", account.residual());
        assert!(account.wheels > 0.0 && account.pushes < 0.0 && account.dissipated > 0.1);
        assert!(account.residual().abs() < 1e-9 * account.dissipated, "found 1e-12");
    }
}
