//! Runs that must stop, and runs that must not.

use crate::solvers::granular::critical::tests::{law, pressed};
use crate::solvers::granular::{Bed, ContactLaw, ContactLaws, Domain, Failure, Gravity, Limits, Real, Sphere};

/// Layers of falling spheres of two sizes over a floor in a periodic column.
fn falling<R: Real>(shear: f64, ratios: [f64; 2]) -> Bed<R> {
    let length = 0.24;
    let domain = Domain::open().periodic(0, length).periodic(1, length);
    let mut bed = Bed::new(domain, ContactLaws::uniform(1, law(shear, ratios)));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    for k in 0..5 * 5 * 6 {
        let [i, j, l] = [k % 5, k / 5 % 5, k / 25].map(f64::from);
        let centre = [0.048 * i + 0.004 * (l * 1.7).sin(), 0.048 * j + 0.004 * (l * 2.3).cos(), 0.03 + 0.048 * l];
        bed.add_sphere(&Sphere { centre, radius: if k % 3 == 0 { 0.015 } else { 0.022 }, density: 2700.0, surface: 0 });
    }
    bed.set_gravity(Gravity::EARTH);
    bed
}

fn settle<R: Real>(bed: &mut Bed<R>) {
    let friction = |bed: &mut Bed<R>, friction| {
        bed.change_laws(|law| {
            if let ContactLaw::Linear(law) = law {
                law.friction = friction
            }
        })
    };
    friction(bed, 0.0);
    bed.set_damping(0.4);
    bed.set_time_step(9e-6);
    bed.run(60_000).unwrap();
    friction(bed, 0.7);
    bed.set_damping(0.7);
    bed.run(10_000).unwrap();
    bed.set_damping(0.0);
}

/// Sets the step to a share of the network limit.
fn step_of<R: Real>(bed: &mut Bed<R>, share: f64, gap: f64) {
    let limit = bed.critical_step(gap).unwrap().network.step;
    bed.set_time_step(share * limit);
}

#[test]
fn steps_above_the_limit_stop_with_the_body_and_what_is_stable() {
    for ratios in [[0.0; 2], [0.3, 0.0], [0.3, 0.3]] {
        let start = pressed(6, law(1.0, ratios));
        let limit = start.clone().critical_step(0.0).unwrap().network.step;
        for share in [1.05, 1.1, 1.2, 1.5, 3.0] {
            let mut bed = start.clone();
            bed.set_time_step(share * limit);
            let failure = bed.run(4000).unwrap_err();
            let (Failure::Growth(culprit)
            | Failure::Stride { culprit, .. }
            | Failure::Overlap { culprit, .. }
            | Failure::Lost(culprit)) = &failure
            else {
                panic!("{failure}")
            };
            let told = culprit.stable_dt / limit;
            assert!(culprit.stable_dt < culprit.dt && told > 0.9 && told < 1.03, "{told} {failure}");
            assert!(failure.to_string().contains("is above the stable"), "{failure}");
        }
    }
}

#[test]
fn a_bed_that_boils_is_stopped_in_single_precision_under_gravity() {
    let mut bed = falling::<f32>(1.0, [0.3, 0.3]);
    settle(&mut bed);
    let limit = bed.critical_step(0.0).unwrap().network.step;
    // this bed still moves a little: contacts open, and later its limit is up to 1.3 times the initial limit
    for share in [1.4, 1.6] {
        let mut bed = bed.clone();
        bed.set_time_step(share * limit);
        let failure = bed.run(20_000).unwrap_err();
        assert!(matches!(failure, Failure::Growth(_)), "{failure}");
        // unless growth checks are switched off
        bed.set_limits(Limits { growth: false, ..Limits::default() });
        bed.run(2000).unwrap();
    }
}

#[test]
fn healthy_runs_go_on() {
    // impact and packing, with and without dashpots, then shaken, at 0.9 of the limit
    for ratios in [[0.0; 2], [0.3, 0.3]] {
        let mut packed = falling::<f32>(1.0, ratios);
        settle(&mut packed);
        step_of(&mut packed, 0.9, 0.0);
        let mut bed = falling::<f32>(1.0, ratios);
        bed.set_time_step(packed.time_step());
        bed.run(20_000).unwrap_or_else(|e| panic!("{ratios:?} {e}"));
        let mut bed = packed;
        bed.set_gravity(Gravity::Shaken { mean: [0.0, 0.0, -9.81], share: 1.5, frequency: 40.0 });
        bed.run(20_000).unwrap_or_else(|e| panic!("{ratios:?} {e}"));
    }
    // what is pressed and kicked, just below the limit
    let mut bed = pressed(6, law(1.0, [0.0; 2]));
    step_of(&mut bed, 0.97, 0.0);
    bed.set_velocity(super::BodyId(0), [0.2, 0.1, 0.0], [0.0; 3]);
    bed.run(10_000).unwrap();
}
