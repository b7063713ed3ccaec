//! What collisions keep: momentum, angular momentum, and energy where nothing is lost.

use crate::scenes::{RADIUS, Vec3, add, alone, cross, norm, random, scaled, shown, sphere, springs, sub};
use trackbed::solvers::granular::{Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, Linear, Real, Sphere};

/// Momentum and angular momentum, and the sums of the sizes of their parts.
fn momenta<R: Real>(bed: &Bed<R>, radii: &[f64]) -> [(Vec3, f64); 2] {
    let mut sums = [([0.0; 3], 0.0); 2];
    for (state, radius) in bed.states().zip(radii) {
        let momentum = scaled(state.velocity, state.mass);
        let own = scaled(state.spin, 0.4 * state.mass * radius * radius);
        let angular = add(cross(state.place, momentum), own);
        for (sum, part) in sums.iter_mut().zip([momentum, angular]) {
            *sum = (add(sum.0, part), sum.1 + norm(part));
        }
    }
    sums
}

/// Two clusters of 32 spheres of many sizes thrown at each other, off centre and turning; shares by which sums change.
fn errors<R: Real>() -> [f64; 2] {
    let law = Linear {
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: 0.2, shear: 0.1 },
        mode: DashpotMode::NoTensionRestInSlip,
        ..springs(1e6, 8e5)
    };
    let mut bed = Bed::<R>::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(law)));
    bed.set_time_step(1e-5);
    let (mut seed, mut radii) = (9, Vec::new());
    for k in 0..64 {
        let sign = if k < 32 { 1.0 } else { -1.0 };
        let cell = [k % 2, k / 2 % 4, k / 8 % 4].map(|n| 2.05 * RADIUS * f64::from(n));
        let mut vector = |size: f64| [0, 1, 2].map(|_| size * random(&mut seed));
        let (jitter, velocity, spin) = (vector(5e-4), vector(0.2), vector(20.0));
        let radius = RADIUS * (0.85 + 0.15 * random(&mut seed));
        let centre = add(add(cell, jitter), [-sign * 2.4 * RADIUS, sign * RADIUS, 0.3]);
        let id = bed.add_sphere(&Sphere { radius, ..sphere(centre) });
        bed.set_velocity(id, add(velocity, [2.0 * sign, 0.0, 0.0]), spin);
        radii.push(radius);
    }
    let before = momenta(&bed, &radii);
    let kinetic = |bed: &mut Bed<R>| bed.snapshot().map(|s| s.translation + s.rotation).unwrap();
    alone(|| {
        let start = kinetic(&mut bed);
        bed.run(4000).unwrap();
        let left = kinetic(&mut bed) / start;
        assert!(left < 0.95, "they lose energy in collisions: {left} is left");
    });
    let after = momenta(&bed, &radii);
    [0, 1].map(|k| norm(sub(after[k].0, before[k].0)) / before[k].1)
}

#[test]
fn collisions_keep_momentum_and_angular_momentum() {
    let [momentum, angular] = errors::<f64>();
    println!("double precision: momentum {momentum:.1e}, angular momentum {angular:.1e}");
    assert!(momentum < 1e-14 && angular < 1e-13);
    let [momentum, angular] = errors::<f32>();
    println!("mixed precision: momentum {momentum:.1e}, angular momentum {angular:.1e}");
    // the force is one number with two signs; moments are rounded
    assert!(momentum < 1e-14 && angular < 1e-9);
}

/// Kinetic and strain energy of a gas of springs after many collisions, as a share of what it had.
fn drift<R: Real>(dt: f64) -> (f64, f64) {
    let side = 0.36;
    let domain = (0..3).fold(Domain::open(), |domain, axis| domain.periodic(axis, side));
    let mut bed = Bed::<R>::new(domain, ContactLaws::single(ContactLaw::Linear(springs(1e6, 0.0))));
    bed.set_time_step(dt);
    bed.watch_energy(true);
    let mut seed = 2;
    for k in 0..125 {
        let centre = [k % 5, k / 5 % 5, k / 25].map(|n| 0.072 * (0.5 + f64::from(n)));
        let id = bed.add_sphere(&sphere(centre));
        bed.set_velocity(id, [0, 1, 2].map(|_| random(&mut seed)), [0.0; 3]);
    }
    let (mut worst, mut last) = (0.0f64, 0.0);
    alone(|| {
        for _ in 0..100 {
            bed.run((2e-3 / dt).round() as u64).unwrap();
            let energy = bed.energy();
            last = energy.residual() / energy.start;
            worst = worst.max(last.abs());
        }
    });
    (worst, last)
}

#[test]
fn an_elastic_gas_keeps_its_energy() {
    let [coarse, fine] = [2e-5, 1e-5].map(|dt| drift::<f64>(dt).0);
    let (mixed, _) = drift::<f32>(1e-5);
    println!("largest error of the energy: {}", shown(&[coarse, fine, mixed]));
    // chaotic, so of the second order only roughly; and no drift in 0.2 s
    assert!(fine < 5e-5 && mixed < 5e-5 && coarse / fine > 2.5);
}
