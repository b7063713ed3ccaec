//! The bed of 10,000 spheres that LAMMPS and LIGGGHTS have run: same law, same step, same shaken gravity.

use crate::scene::{near, sphere};
use trackbed::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Real,
};

/// Springs, Coulomb friction of the total normal force, a normal dashpot that may pull.
const LAW: Linear = Linear {
    normal_stiffness: 1.3e7,
    shear_stiffness: 1.3e7,
    friction: 0.7,
    dashpot: Dashpot::Constant { normal: 829.0, shear: 0.0 },
    mode: DashpotMode::Full,
    limit: FrictionLimit::Total,
};

fn bed<R: Real>() -> Bed<R> {
    let text = include_str!("../../benches/grains/bed10k.xyzr");
    let mut bed =
        Bed::new(Domain::open().periodic(0, 1.2).periodic(1, 1.2), ContactLaws::single(ContactLaw::Linear(LAW)));
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let [x, y, z, radius] = *line.split_whitespace().map(|n| n.parse().unwrap()).collect::<Vec<f64>>() else {
            panic!("four numbers a sphere, not {line}")
        };
        bed.add_sphere(&sphere([x, y, z], radius, 2700.0));
    }
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::Shaken { mean: [0.0, 0.0, -9.81], share: 0.3, frequency: 20.0 });
    bed.set_time_step(1e-5);
    bed
}

/// 500 steps; LAMMPS and LIGGGHTS agree on the energy, and count 51,030 and 51,024 half contacts.
fn meets_the_peers<R: Real>() {
    let mut bed = bed::<R>();
    bed.run(500).unwrap();
    let now = bed.snapshot().unwrap();
    let coordination = now.coordination(bed.len());
    println!("kinetic energy {:.6e}, coordination {coordination}", now.translation);
    near(now.translation, 0.016297, 1e-4);
    assert!((5.102..=5.103).contains(&coordination), "{coordination}");
}

#[test]
fn ten_thousand_spheres_move_as_the_peers_say_in_double_precision() {
    meets_the_peers::<f64>();
}

#[test]
fn ten_thousand_spheres_move_as_the_peers_say_in_mixed_precision() {
    meets_the_peers::<f32>();
}
