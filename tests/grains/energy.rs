//! Where the work goes: a cycle of load on a packed bed.

use crate::scenes::{packed, springs, threads, walls};
use nalgebra::Vector3;
use trackbed::solvers::granular::shape::Shape;
use trackbed::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, Gravity, Linear, Pose, Real, WallId, WallMotion,
};

/// A packed bed under a plate that has been pressed on it.
fn pressed<R: Real>() -> (Bed<R>, WallId) {
    let law = Linear {
        friction: 0.4,
        dashpot: Dashpot::Ratio { normal: 0.1, shear: 0.1 },
        mode: DashpotMode::NoTensionRestInSlip,
        ..springs(1e7, 8e6)
    };
    let mut bed = Bed::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(law)));
    bed.set_time_step(1e-5);
    bed.set_gravity(Gravity::EARTH);
    bed.set_damping(0.3);
    let (spheres, side) = packed();
    spheres.iter().for_each(|s| {
        bed.add_sphere(s);
    });
    for (point, normal) in walls(side) {
        bed.add_plane(point, normal, 0);
    }
    let top = spheres.iter().map(|s| s.centre[2] + s.radius).fold(0.0, f64::max);
    let pose = Pose { position: Vector3::new(0.0, 0.0, top), ..Pose::default() };
    let plate = bed.add_wall(Shape::Plane { normal: -Vector3::z() }, pose, 0, WallMotion::Fixed);
    let force = |bed: &Bed<R>| bed.wall(plate).felt().force.z;
    let down = WallMotion::Velocity { linear: Vector3::new(0.0, 0.0, -0.3), angular: Vector3::zeros() };
    threads(1, || {
        // again and again, until the bed stands under it
        while force(&bed) < 3000.0 {
            bed.set_motion(plate, down.clone());
            while force(&bed) < 6000.0 {
                bed.step().unwrap();
            }
            bed.set_motion(plate, WallMotion::Fixed);
            bed.run(1000).unwrap();
        }
    });
    (bed, plate)
}

/// A cycle of load by a plate that goes 0.3 mm down and up in 20 ms; shares of the work of loading.
struct Cycle {
    /// Largest of what is not accounted for.
    worst: f64,
    /// Work of loading and of the whole cycle \[J\].
    loading: f64,
    whole: f64,
    /// Lost by slip, dashpots, local damping \[J\].
    lost: [f64; 3],
    /// Of the plate before, at the bottom, after \[N\].
    forces: [f64; 3],
}

fn cycle<R: Real>(mut bed: Bed<R>, plate: WallId, dt: f64) -> Cycle {
    let start = bed.time();
    bed.set_time_step(dt);
    bed.watch_energy(true);
    let times: Vec<f64> = (0..5).map(|k| start + 5e-3 * f64::from(k)).collect();
    let velocities = [0.0, -0.06, 0.0, 0.06, 0.0].map(|v| Vector3::new(0.0, 0.0, v)).to_vec();
    bed.set_motion(plate, WallMotion::Table { times, velocities });
    let work = |bed: &Bed<R>| bed.energy().walls + bed.energy().gravity;
    let steps = (20e-3 / dt).round() as u64;
    let (mut worst, mut loading, mut forces) = (0.0f64, 0.0f64, [bed.wall(plate).felt().force.z, 0.0, 0.0]);
    threads(1, || {
        for step in 0..steps {
            bed.step().unwrap();
            forces[if step < steps / 2 { 1 } else { 2 }] = bed.wall(plate).felt().force.z;
            worst = worst.max(bed.energy().residual().abs());
            loading = loading.max(work(&bed));
        }
    });
    let energy = bed.energy();
    Cycle {
        worst: worst / loading,
        forces,
        loading,
        whole: work(&bed),
        lost: [energy.slip, energy.dashpot, energy.damping],
    }
}

#[test]
fn the_work_of_a_load_cycle_is_accounted_for() {
    let (bed, plate) = pressed::<f64>();
    let steps = [2e-5, 1e-5, 5e-6];
    let cycles = steps.map(|dt| cycle(bed.clone(), plate, dt));
    for (dt, c) in steps.iter().zip(&cycles) {
        let [slip, dashpot, damping] = c.lost.map(|lost| lost / c.loading);
        println!("step {dt:.0e} s: unaccounted {:.1e} of {:.4} J of loading", c.worst, c.loading);
        println!(
            "  a cycle takes {:.2}, slip {slip:.2}, dashpots {dashpot:.2}, damping {damping:.2}",
            c.whole / c.loading
        );
        println!("  plate: {:.0?} N before, at the bottom, after", c.forces);
    }
    let order = (cycles[0].worst / cycles[2].worst).log2() / 2.0;
    let (single, plate) = pressed::<f32>();
    let mixed = cycle(single, plate, 5e-6).worst;
    println!("order {order:.2}; mixed precision, 5e-6 s: {mixed:.1e}");
    assert!(cycles[2].worst < 1e-3 && mixed < 1e-3);
    assert!((order - 2.0).abs() < 0.3, "{order}");
    // every kind of loss takes part
    assert!(cycles.iter().all(|c| c.lost.iter().all(|lost| *lost > 5e-3 * c.loading)));
}
