//! Impacts under Hertz's law against closed forms and against an ordinary differential equation solved on its own.

use crate::scene::{Material, bed, mass, near, norm, put, sphere};
use trackbed::solvers::granular::{Bed, ContactLaw, DashpotMode, HertzMindlin};

/// Glass of Chung and Ooi's first test.
const GLASS: Material = Material(4.8e10, 0.20, 2800.0);
const RADIUS: f64 = 0.01;

/// Hertz's impact at a speed (m/s) of closing: largest force (N) and overlap (m), duration (s).
pub fn closed_form(law: &HertzMindlin, mass: f64, radius: f64, speed: f64) -> (f64, f64, f64) {
    let stiffness = 4.0 / 3.0 * law.effective_modulus * radius.sqrt();
    let overlap = (1.25 * mass * speed * speed / stiffness).powf(0.4);
    // 2 sqrt(pi) gamma(7/5) / gamma(9/10) d/v
    (stiffness * overlap.powf(1.5), overlap, 2.943_275_070 * overlap / speed)
}

/// Two glass spheres that touch, closing at 20 m/s.
fn two_spheres(law: HertzMindlin, dt: f64) -> Bed<f64> {
    let mut bed = bed(ContactLaw::HertzMindlin(law), dt);
    for (x, v) in [(RADIUS, -10.0), (-RADIUS, 10.0)] {
        put(&mut bed, sphere([x, 0.0, 0.0], RADIUS, GLASS.2), [v, 0.0, 0.0], [0.0; 3]);
    }
    bed
}

/// Forces at every step until the spheres part, the first at the time 0.
fn forces(bed: &mut Bed<f64>) -> Vec<(f64, f64)> {
    let mut found = vec![(0.0, 0.0)];
    loop {
        bed.step().unwrap();
        let now = bed.snapshot().unwrap();
        let Some(contact) = now.contacts.first() else { return found };
        found.push((norm(contact.force), contact.overlap));
    }
}

fn scale(law: &HertzMindlin) -> (f64, f64, f64) {
    closed_form(law, 0.5 * mass(RADIUS, GLASS.2), 0.5 * RADIUS, 20.0)
}

/// Overlap and closing speed under `m d'' = -push(d, d')` by Runge and Kutta, at every one of `count` steps of `dt`.
fn history(mass: f64, speed: f64, dt: f64, count: usize, push: impl Fn(f64, f64) -> f64) -> Vec<(f64, f64)> {
    const FINER: usize = 50;
    let h = dt / FINER as f64;
    let rate = |(d, v): (f64, f64)| (v, -push(d, v) / mass);
    let along = |(d, v): (f64, f64), (a, b): (f64, f64), h: f64| (d + h * a, v + h * b);
    let mut state = (0.0, speed);
    let mut found = vec![state];
    for _ in 0..count {
        for _ in 0..FINER {
            let k1 = rate(state);
            let k2 = rate(along(state, k1, 0.5 * h));
            let k3 = rate(along(state, k2, 0.5 * h));
            let k4 = rate(along(state, k3, h));
            let mean = |f: fn(&(f64, f64)) -> f64| (f(&k1) + 2.0 * f(&k2) + 2.0 * f(&k3) + f(&k4)) / 6.0;
            state = along(state, (mean(|k| k.0), mean(|k| k.1)), h);
        }
        found.push(state);
    }
    found
}

#[test]
fn the_force_follows_the_equation_of_hertz() {
    let law = GLASS.pair(0.0, 1.0);
    let (largest, _, duration) = scale(&law);
    let (m, stiffness) = (0.5 * mass(RADIUS, GLASS.2), 4.0 / 3.0 * law.effective_modulus * (0.5 * RADIUS).sqrt());
    let worst = |steps: f64| {
        let dt = duration / steps;
        let found = forces(&mut two_spheres(law, dt));
        let wanted = history(m, 20.0, dt, found.len(), |d, _| stiffness * d.max(0.0).powf(1.5));
        let error =
            |((f, _), (d, _)): (&(f64, f64), &(f64, f64))| (f - stiffness * d.max(0.0).powf(1.5)).abs() / largest;
        (found.iter().zip(&wanted).map(error).fold(0.0, f64::max), found.len() as f64 * dt)
    };
    let errors = [100.0, 200.0, 400.0].map(worst);
    println!("force against time: {errors:?} duration {duration}");
    assert!(errors[2].0 < 1e-4, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0].0 / pair[1].0).log2();
        assert!((order - 2.0).abs() < 0.2, "order {order}");
    }
    near(errors[2].1, duration, 1.0 / 400.0);
}

#[test]
fn a_damped_impact_follows_its_equation() {
    let law = HertzMindlin { mode: DashpotMode::NoTension, ..GLASS.pair(0.0, 0.3) };
    let (largest, _, duration) = scale(&law);
    let (m, radius) = (0.5 * mass(RADIUS, GLASS.2), 0.5 * RADIUS);
    let push = |d: f64, v: f64| {
        let a = (radius * d.max(0.0)).sqrt();
        let dashpot = 2.0 * (5.0f64 / 6.0).sqrt() * law.damping_ratio() * (2.0 * law.effective_modulus * a * m).sqrt();
        (4.0 / 3.0 * law.effective_modulus * a * d + dashpot * v).max(0.0)
    };
    let worst = |steps: f64| {
        let dt = duration / steps;
        let found = forces(&mut two_spheres(law, dt));
        let wanted = history(m, 20.0, dt, found.len(), push);
        let error = |((f, _), &(d, v)): (&(f64, f64), &(f64, f64))| (f - push(d, v)).abs() / largest;
        found.iter().zip(&wanted).map(error).fold(0.0, f64::max)
    };
    // the dashpot takes the velocity of half a step ago
    let errors = [200.0, 400.0, 800.0].map(worst);
    println!("damped force against time: {errors:?}");
    assert!(errors[2] < 5e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((0.7..2.2).contains(&order), "order {order}");
    }
}

#[test]
fn the_largest_force_is_of_second_order() {
    let law = GLASS.pair(0.0, 1.0);
    let (largest, overlap, duration) = scale(&law);
    // the parabola through the three largest values, so that the place of the peak between steps does not count
    let peak = |steps: f64| {
        let found = forces(&mut two_spheres(law, duration / steps));
        let at = (1..found.len() - 1).max_by(|&a, &b| found[a].0.total_cmp(&found[b].0)).unwrap();
        let of = |v: fn(&(f64, f64)) -> f64| {
            let [a, b, c] = [at - 1, at, at + 1].map(|k| v(&found[k]));
            b + 0.125 * (c - a).powi(2) / (2.0 * b - a - c)
        };
        (of(|s| s.0), of(|s| s.1))
    };
    let errors = [50.0, 100.0, 200.0].map(|steps| (peak(steps).0 / largest - 1.0).abs());
    println!("peak force: {errors:?}, overlap {}", peak(200.0).1 / overlap - 1.0);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.3, "order {order} of {errors:?}");
    }
}

/// Speeds of parting over those of meeting.
fn restitution(law: HertzMindlin, speed: f64, steps: f64) -> f64 {
    let (_, _, duration) = closed_form(&law, 0.5 * mass(RADIUS, GLASS.2), 0.5 * RADIUS, speed);
    let mut bed = two_spheres(law, duration / steps);
    let ids: Vec<_> = bed.states().map(|s| s.id).collect();
    for (id, v) in ids.iter().zip([-0.5, 0.5]) {
        bed.set_velocity(*id, [v * speed, 0.0, 0.0], [0.0; 3]);
    }
    bed.run(8 * steps as u64).unwrap();
    (bed.body_state(ids[0]).velocity[0] - bed.body_state(ids[1]).velocity[0]) / speed
}

#[test]
fn restitution_is_the_one_given() {
    for (mode, most) in [(DashpotMode::Full, 2e-3), (DashpotMode::NoTension, 2e-3)] {
        let mut worst: f64 = 0.0;
        for e in [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.95, 1.0] {
            for speed in [0.01, 1.0, 20.0] {
                let found = restitution(HertzMindlin { mode, ..GLASS.pair(0.0, e) }, speed, 1000.0);
                println!("{mode:?} {e} at {speed} m/s: {found:.6}");
                worst = worst.max((found - e).abs());
            }
        }
        println!("{mode:?}: worst {worst:.2e}");
        assert!(worst < most, "{mode:?} {worst}");
    }
}

#[test]
fn ratios_without_tension_meet_the_linear_closed_form() {
    // Schwager and Pöschel's formula at ratios below, at and above 1, and far out
    let formula = |z: f64| match z {
        1.0 => (-2.0f64).exp(),
        z if z < 1.0 => (-2.0 * z * z.acos() / (1.0 - z * z).sqrt()).exp(),
        z => (-2.0 * z * z.acosh() / (z * z - 1.0).sqrt()).exp(),
    };
    for z in [1e-6, 0.01, 0.05, 0.1, 0.3, 0.5, 0.7, 0.99, 0.99995, 1.0, 1.00005, 1.01, 3.0, 1e3, 1e6] {
        let law = HertzMindlin { mode: DashpotMode::NoTension, ..GLASS.pair(0.0, formula(z)) };
        near(law.damping_ratio(), z, 1e-9);
    }
    near(formula(0.3), 0.450975, 2e-6);
    assert_eq!(HertzMindlin { mode: DashpotMode::NoTension, ..GLASS.pair(0.0, 1.0) }.damping_ratio(), 0.0);
}

#[test]
fn an_elastic_impact_keeps_energy_to_second_order() {
    let law = GLASS.pair(0.3, 1.0);
    let duration = scale(&law).2;
    let worst = |steps: f64| {
        let mut bed = two_spheres(law, duration / steps);
        bed.watch_energy(true);
        let mut worst: f64 = 0.0;
        for _ in 0..(1.2 * steps) as u64 {
            bed.step().unwrap();
            worst = worst.max(bed.energy().residual().abs() / bed.energy().start);
        }
        let after = bed.snapshot().unwrap().translation / bed.energy().start - 1.0;
        (worst, after.abs())
    };
    let errors = [100.0, 200.0, 400.0].map(worst);
    println!("energy, worst on the way and after: {errors:?}");
    assert!(errors[2].0 < 1e-4 && errors[2].1 < 1e-5);
    for pair in errors.windows(2) {
        let order = (pair[0].0 / pair[1].0).log2();
        assert!((order - 2.0).abs() < 0.2, "order {order}");
    }
}

#[test]
fn the_critical_step_is_that_of_the_tangent() {
    // a sphere squeezed between two plates: k = 2 S, S = 2 E* sqrt(R d)
    let (law, overlap) = (GLASS.on_rigid(0.0, 1.0), 1e-5);
    let stiffness = 4.0 * law.effective_modulus * (RADIUS * overlap).sqrt();
    let critical = 2.0 * (mass(RADIUS, GLASS.2) / stiffness).sqrt();
    let largest = |share: f64| {
        let mut bed: Bed<f64> = bed(ContactLaw::HertzMindlin(law), share * critical);
        bed.add_plane([0.0, 0.0, overlap - RADIUS], [0.0, 0.0, 1.0], 0);
        bed.add_plane([0.0, 0.0, RADIUS - overlap], [0.0, 0.0, -1.0], 0);
        // a millionth of the overlap, so that the springs are as good as linear
        let id = bed.add_sphere(&sphere([0.0, 0.0, 1e-6 * overlap], RADIUS, GLASS.2));
        let mut largest: f64 = 0.0;
        for _ in 0..1000 {
            bed.step().unwrap();
            largest = largest.max(norm(bed.body_state(id).place) / overlap);
        }
        largest
    };
    assert!(largest(0.99) < 1e-5, "{}", largest(0.99));
    assert!(largest(1.01) > 1e-2, "{}", largest(1.01));
}
