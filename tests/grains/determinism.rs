//! What must not change a bit: threads, reach and order of lists, and being looked at.

use crate::scenes::{Vec3, packed, random, sphere, springs, threads};
use nalgebra::{UnitQuaternion, Vector3};
use trackbed::solvers::granular::clump::{Pebble, Template};
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, Energy, Gravity, Linear, Placed, Real, Sphere,
};

/// 3600 bodies, every fifth a clump of two, set going: more tasks than one thread computes at once.
fn bed<R: Real>() -> Bed<R> {
    let law = Linear {
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: 0.2, shear: 0.2 },
        mode: DashpotMode::NoTensionRestInSlip,
        ..springs(1e7, 1e7)
    };
    let mut bed = Bed::new(Domain::open().periodic(0, 0.75), ContactLaws::single(ContactLaw::Linear(law)));
    bed.set_time_step(1e-5);
    bed.set_gravity(Gravity::EARTH);
    bed.set_damping(0.1);
    let (spheres, side) = packed();
    let pebble = |x: f64| Pebble { centre: Vector3::new(x, 0.0, 0.0), radius: 0.7 };
    let template = Template::from_pebbles(&[pebble(-0.3), pebble(0.3)]).unwrap();
    let mut seed = 1;
    for tile in 0..18 {
        let shift = [tile % 3, tile / 3 % 3, tile / 9].map(|at| side * f64::from(at));
        for (k, s) in spheres.iter().enumerate() {
            let centre = crate::scenes::add(s.centre, shift);
            let mut vector = |size: f64| [0, 1, 2].map(|_| size * random(&mut seed));
            let (velocity, spin, turn) = (vector(0.1), vector(5.0), vector(3.0));
            let id = if k % 5 == 0 {
                let template = &template.scaled(s.radius);
                let attitude = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
                bed.add_clump(&Placed { template, centre, attitude, density: 2700.0, surface: 0 })
            } else {
                bed.add_sphere(&Sphere { centre, ..*s })
            };
            bed.set_velocity(id, velocity, spin);
        }
    }
    for (point, normal) in
        [([0.0; 3], [0.0, 0.0, 1.0]), ([0.0; 3], [0.0, 1.0, 0.0]), ([0.0, 3.0 * side, 0.0], [0.0, -1.0, 0.0])]
    {
        bed.add_plane(point, normal, 0);
    }
    bed
}

type Bits = Vec<[[u64; 3]; 3]>;

fn bits<R: Real>(bed: &Bed<R>, count: usize) -> Bits {
    let state = |id| bed.body_state(BodyId(id));
    (0..count as u32).map(state).map(|s| [s.place, s.velocity, s.spin].map(|v| v.map(f64::to_bits))).collect()
}

const STEPS: u64 = 200;

fn moved<R: Real>(threads_: usize, change: impl FnOnce(&mut Bed<R>) + Send) -> Bits {
    let mut bed = bed::<R>();
    let count = bed.len();
    threads(threads_, || {
        change(&mut bed);
        bed.run(STEPS - bed.steps()).unwrap();
    });
    bits(&bed, count)
}

#[test]
fn threads_change_no_bit() {
    let one = moved::<f32>(1, |_| ());
    for count in [2, 3, 7] {
        assert!(moved::<f32>(count, |_| ()) == one, "{count} threads");
    }
    assert!(moved::<f64>(1, |_| ()) == moved::<f64>(3, |_| ()));
}

#[test]
fn reach_and_order_of_lists_change_no_bit() {
    let usual = moved::<f32>(2, |_| ());
    // lists made every few steps, once, and with neighbours far beyond contact
    for skin in [2e-5, 1e-3, 2e-2] {
        assert!(moved::<f32>(2, |bed| bed.set_skin(Some(skin))) == usual, "skin of {skin} m");
    }
    // bodies are sorted by place: one far away, made last, changes the order in which they stand
    let far: Vec3 = [0.0005, 0.3, 3.0];
    let shifted = moved::<f32>(2, |bed| {
        bed.run(50).unwrap();
        bed.add_sphere(&sphere(far));
    });
    assert!(shifted == usual);
}

#[test]
fn looking_changes_no_bit() {
    let looked = moved::<f32>(2, |bed| {
        bed.watch_energy(true);
        for _ in 0..7 {
            bed.run(23).unwrap();
            bed.snapshot().unwrap();
        }
    });
    assert!(looked == moved::<f32>(2, |_| ()));
}

#[test]
fn energies_do_not_depend_on_threads() {
    let energy = |count| -> Energy {
        let mut bed = bed::<f32>();
        bed.watch_energy(true);
        threads(count, || bed.run(50)).unwrap();
        bed.energy()
    };
    let one = energy(1);
    assert!(one.strain > 0.0 && one.lost() > 0.0);
    for count in [2, 7] {
        assert_eq!(energy(count), one, "{count} threads");
    }
}
