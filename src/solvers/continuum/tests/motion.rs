//! Waves, energies, and equal bits for any number of threads.

use super::super::*;
use super::scenes::*;

/// A pulse runs up a column of 10 m, is reflected by the free top, and leaves through the quiet bottom.
#[test]
fn a_wave_leaves_through_a_quiet_face() {
    for formulation in FORMULATIONS {
        let mut soil = soil(block([0.05, 0.05, 10.0], [1, 1, 200], SUBGRADE), formulation, 0.0);
        support(&mut soil, &WALLS, Support::Roller);
        support(&mut soil, &[Side::Bottom], Support::Quiet);
        let speed = SUBGRADE.wave_speeds()[0];
        let top = soil.side_nodes(Side::Top);
        let middle = soil.mesh().nearest([0.0, 0.0, 5.0]);
        let dt = 0.8 * soil.limit();
        // a smooth push of 4 ms at the top: a pulse of 2.1 m
        let (period, area) = (4e-3, 0.05 * 0.05);
        let (mut passes, mut returns, mut arrives) = (0.0f64, 0.0f64, (0.0, 0.0));
        while soil.time() < 30.0 / speed {
            let t = soil.time();
            let push = if t < period { 1e3 * (std::f64::consts::PI * t / period).sin().powi(2) } else { 0.0 };
            top.iter().for_each(|&node| soil.add_force(node, [0.0, 0.0, -push * area / top.len() as f64]));
            soil.step(dt).unwrap();
            let v = soil.velocities()[middle][2].abs();
            if soil.time() < 10.0 / speed {
                passes = passes.max(v);
                if v > arrives.0 {
                    arrives = (v, soil.time());
                }
            } else {
                returns = returns.max(v);
            }
        }
        // v = σ / ρ c, and the peak comes 5 m later than the push
        let exact = 1e3 / (SUBGRADE.density * speed);
        assert!((passes / exact - 1.0).abs() < 0.01, "{formulation:?} {passes} {exact}");
        let found = 5.0 / (arrives.1 - 0.5 * period);
        assert!((found / speed - 1.0).abs() < 0.01, "{formulation:?} {found} {speed}");
        assert!(returns < 0.02 * passes, "{formulation:?} {}", returns / passes);
    }
}

/// A block after an impact, with damping, a quiet side and a driven node: the residual falls with the square of the
/// step.
#[test]
fn the_energy_balance_closes_with_order_two() {
    for (formulation, stiffness) in FORMULATIONS.into_iter().flat_map(|f| [(f, 0.0), (f, 2e-5)]) {
        let left = |parts: u32| {
            let damping = Damping { stiffness, local: 0.0 };
            let settings = Settings { formulation, gravity: [0.0, 0.0, -9.81], damping };
            let mut soil = Soil::new(block([0.4, 0.3, 0.3], [4, 3, 3], SUBGRADE), settings).unwrap();
            support(&mut soil, &[Side::Bottom], Support::Fixed);
            support(&mut soil, &[Side::XMin], Support::Quiet);
            let struck = soil.mesh().nearest([0.2, 0.2, 0.3]);
            soil.watch(true);
            let dt = 1e-5 / f64::from(parts);
            for _ in 0..400 * parts {
                let push = (soil.time() * 2000.0).sin().powi(2);
                soil.add_force(struck, [100.0 * push, 0.0, -1000.0 * push]);
                soil.step(dt).unwrap();
            }
            let energy = soil.energy();
            assert!(energy.quiet > 0.0 && (stiffness == 0.0 || energy.damping > 0.0));
            (energy.residual().abs() / energy.external, energy)
        };
        let ([one, two], energy) = ([left(1).0, left(2).0], left(4).1);
        assert!(one < 2e-3, "{formulation:?} {one:e} {energy:?}");
        // damping that lags by half a step is of first order, and so is its reported loss
        assert!((one / two).log2() > 1.8, "{formulation:?} {stiffness} {one:e} {two:e} {energy:?}");
    }
}

/// A block of 1440 weak elements: more than one chunk.
fn struck(formulation: Formulation) -> Soil {
    let strength = Strength { cohesion: 5e3, friction_angle: 0.5, dilation_angle: 0.1, tension: 1e3 };
    let weak = Material { strength: Some(strength), ..SUBGRADE };
    let mut soil = soil(block([2.0, 0.9, 0.8], [20, 9, 8], weak), formulation, 9.81);
    support(&mut soil, &[Side::Bottom], Support::Fixed);
    support(&mut soil, &[Side::XMin, Side::XMax], Support::Quiet);
    support(&mut soil, &[Side::YMin], Support::Roller);
    soil.watch(true);
    soil
}

fn strike(soil: &mut Soil, steps: u64) {
    let dt = 0.9 * soil.limit();
    for _ in 0..steps {
        let at = soil.mesh().nearest([1.0, 0.4, 0.8]);
        soil.add_force(at, [10.0, 20.0, -1e3]);
        soil.step(dt).unwrap();
    }
}

#[test]
fn threads_change_no_bit() {
    for formulation in FORMULATIONS {
        let states = [1, 2, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut soil = struck(formulation);
                strike(&mut soil, 50);
                assert!(soil.energy().plastic > 0.0);
                soil.state()
            })
        });
        assert!(states[0] == states[1] && states[0] == states[2]);
    }
}

#[test]
fn a_restored_soil_goes_on_bit_by_bit() {
    for formulation in FORMULATIONS {
        let mut through = struck(formulation);
        strike(&mut through, 30);
        let text = serde_json::to_string(&through.state()).unwrap();
        strike(&mut through, 30);
        let mut resumed = struck(formulation);
        resumed.restore(serde_json::from_str(&text).unwrap()).unwrap();
        strike(&mut resumed, 30);
        assert!(through.state() == resumed.state() && through.positions() == resumed.positions());
        let mut other = soil(block([1.0; 3], [1; 3], SUBGRADE), formulation, 0.0);
        assert!(matches!(other.restore(through.state()), Err(SoilError::OtherSoil { .. })));
    }
}

#[test]
fn a_force_that_is_no_number_is_told() {
    let mut soil = struck(Formulation::MeanStrain);
    soil.add_force(17, [f64::NAN, 0.0, 0.0]);
    assert_eq!(soil.step(1e-5), Err(SoilError::Lost { node: 17, step: 1 }));
    assert!(matches!(soil.step(1.0), Err(SoilError::Step { .. })));
    assert!(matches!(soil.step(f64::NAN), Err(SoilError::Value { .. })));
}
