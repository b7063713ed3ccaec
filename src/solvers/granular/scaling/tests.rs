//! Effects of mass scaling, and values that it must not change.

use super::need::{Acting, largest};
use crate::solvers::granular::clump::{Pebble, Template};
use crate::solvers::granular::critical::{Around, Weight, pencil, surely_allows};
use crate::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Placed, Sphere,
};
use nalgebra::Vector3;

const STIFFNESS: f64 = 1e6;

fn law(ratio: f64) -> ContactLaw {
    ContactLaw::Linear(Linear {
        normal_stiffness: STIFFNESS,
        shear_stiffness: STIFFNESS,
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: ratio, shear: ratio },
        mode: DashpotMode::NoTensionRestInSlip,
        limit: FrictionLimit::Spring,
    })
}

/// Spheres of two sizes and clumps over a floor, in a periodic cell, that fall and come to rest.
fn mixed() -> Bed<f64> {
    let length = 0.2;
    let mut bed = Bed::new(Domain::open().periodic(0, length).periodic(1, length), ContactLaws::uniform(1, law(0.3)));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::EARTH);
    let pebble = |x: f64| Pebble { centre: Vector3::new(x, 0.0, 0.0), radius: 0.015 };
    let template = Template::from_pebbles(&[pebble(-0.01), pebble(0.01)]).unwrap();
    for k in 0..4 * 4 * 4 {
        let [i, j, l] = [k % 4, k / 4 % 4, k / 16];
        let centre =
            [0.05 * i as f64 + 0.003 * (j + l) as f64, 0.05 * j as f64 + 0.004 * l as f64, 0.03 + 0.05 * l as f64];
        if k % 3 == 0 {
            bed.add_clump(&Placed {
                template: &template,
                centre,
                attitude: template.axes,
                density: 2700.0,
                surface: 0,
            });
        } else {
            let radius = if k % 3 == 1 { 0.02 } else { 0.01 };
            bed.add_sphere(&Sphere { centre, radius, density: 2700.0, surface: 0 });
        }
    }
    bed.set_damping(0.5);
    bed.set_time_step(2e-5);
    bed.run(60_000).unwrap();
    bed
}

/// Mean force on the floor over some steps: a rolling sphere sometimes hits another sphere.
fn mean_load(bed: &mut Bed<f64>, steps: u32) -> f64 {
    let floor = crate::solvers::granular::WallId(0);
    let sum: f64 = (0..steps)
        .map(|_| {
            bed.step().unwrap();
            bed.wall(floor).felt().force.z
        })
        .sum();
    sum / f64::from(steps)
}

fn weight(bed: &Bed<f64>) -> f64 {
    9.81 * bed.states().map(|s| s.mass).sum::<f64>()
}

#[test]
fn a_lone_sphere_gets_just_the_inertia_that_it_needs() {
    let mut bed = Bed::<f64>::new(Domain::open(), ContactLaws::uniform(1, law(0.0)));
    bed.change_laws(|l| {
        if let ContactLaw::Linear(l) = l {
            l.shear_stiffness = 0.0
        }
    });
    let id = bed.add_sphere(&Sphere { centre: [0.0, 0.0, 0.01 - 1e-9], radius: 0.01, density: 2700.0, surface: 0 });
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let mass = bed.body_state(id).mass;
    let limit = 2.0 / (STIFFNESS / mass).sqrt();
    let scaling = bed.scale_masses(2.0 * limit, 0.0).unwrap();
    // the limit is proportional to the root of the inertia
    assert!((scaling.largest.unwrap().1 / 4.0 - 1.0).abs() < 0.01, "{scaling:?}");
    assert!((scaling.added_share - 3.0).abs() < 0.04 && (scaling.added_mass / mass - 3.0).abs() < 0.04);
    assert!(bed.critical_step(0.0).unwrap().network.step >= 2.0 * limit);
    assert_eq!(bed.body_state(id).mass, mass, "its weight is as before");
    // below the limit nothing is added, and earlier additions are removed
    let scaling = bed.scale_masses(0.9 * limit, 0.0).unwrap();
    assert_eq!((scaling.bodies, scaling.added_mass, scaling.largest), (0, 0.0, None));
    assert!((bed.critical_step(0.0).unwrap().network.step / limit - 1.0).abs() < 1e-3);
}

#[test]
fn a_scaled_sphere_falls_as_any_other() {
    let mut bed = Bed::<f64>::new(Domain::open(), ContactLaws::uniform(1, law(0.0)));
    let add = |bed: &mut Bed<f64>, x: f64| {
        bed.add_sphere(&Sphere { centre: [x, 0.0, 0.01], radius: 0.01, density: 2700.0, surface: 0 })
    };
    let (one, _) = (add(&mut bed, 0.0), add(&mut bed, 0.02 - 1e-9));
    let limit = bed.critical_step(0.0).unwrap().network.step;
    let scaling = bed.scale_masses(1.5 * limit, 0.0).unwrap();
    assert_eq!(scaling.bodies, 2);
    bed.change_laws(|l| {
        if let ContactLaw::Linear(l) = l {
            l.normal_stiffness = 1e-6
        }
    });
    bed.set_gravity(Gravity::EARTH);
    bed.set_time_step(1e-4);
    bed.run(1000).unwrap();
    let speed = bed.body_state(one).velocity[2];
    // its weight now moves more inertia: free fall is slower by the factor, so only bodies at rest may be scaled
    let factor = scaling.largest.unwrap().1;
    assert!((speed / (-9.81 * 0.1 / factor) - 1.0).abs() < 1e-3, "{speed} {factor}");
}

#[test]
fn a_scaled_bed_is_stable_at_the_target_and_weighs_the_same() {
    let mut bed = mixed();
    let step = bed.critical_step(0.0).unwrap();
    assert!((mean_load(&mut bed, 5000) / -weight(&bed) - 1.0).abs() < 0.02);
    let forces = bed.snapshot().unwrap().contacts;
    let target = 1.4 * step.network.step;
    let scaling = bed.scale_masses(target, 1e-5).unwrap();
    assert!(scaling.bodies > 0 && scaling.bodies < bed.len() && scaling.limit >= target);
    assert!(bed.critical_step(1e-5).unwrap().network.step >= target);
    // forces at rest do not change
    bed.set_time_step(target);
    bed.run(10_000).unwrap();
    let load = mean_load(&mut bed, 10_000);
    // rolling spheres change the mean force on the floor by some thousandths; the additional mass, if it had weight, by
    // far more
    assert!((load / -weight(&bed) - 1.0).abs() < 5e-3 && scaling.added_share > 0.02, "{load} {scaling:?}");
    let after = bed.snapshot().unwrap().contacts;
    let load =
        |contacts: &[crate::solvers::granular::ContactState]| contacts.iter().map(|c| c.force[2].abs()).sum::<f64>();
    assert!((load(&after) / load(&forces) - 1.0).abs() < 0.02, "{} {}", load(&after), load(&forces));
}

#[test]
fn scaling_and_back_changes_nothing() {
    let mut bed = mixed();
    for id in 0..bed.len() as u32 {
        bed.set_velocity(BodyId(id), [0.01, 0.0, 0.0], [1.0, 2.0, 3.0]);
    }
    let limit = bed.critical_step(0.0).unwrap().network.step;
    let before: Vec<_> = bed.states().collect();
    let inertia: Vec<_> = bed.bodies.iter().map(|b| (b.inverse_mass, b.inverse_inertia)).collect();
    let momentum: Vec<_> = bed.bodies.iter().map(|b| b.spin).collect();
    assert!(bed.scale_masses(3.0 * limit, 0.0).unwrap().bodies > bed.len() / 2);
    assert_eq!(bed.states().collect::<Vec<_>>(), before, "velocities stay");
    bed.unscale_masses();
    assert_eq!(bed.states().collect::<Vec<_>>(), before);
    assert_eq!(bed.bodies.iter().map(|b| (b.inverse_mass, b.inverse_inertia)).collect::<Vec<_>>(), inertia);
    for (after, before) in bed.bodies.iter().zip(&momentum) {
        (0..3).for_each(|c| assert!((after.spin[c] - before[c]).abs() <= 4e-16 * before[c].abs()));
    }
}

/// Regression: a held clump was made heavier at every check and never lighter again; after five hundred axles its spin
/// was not a number.
#[test]
fn what_is_fixed_is_not_scaled() {
    let mut bed = mixed();
    for id in 0..bed.len() as u32 {
        bed.set_velocity(BodyId(id), [0.0; 3], [1.0, 2.0, 3.0]);
        bed.fix(BodyId(id));
    }
    let before: Vec<_> = bed.bodies.iter().map(|b| b.spin).collect();
    for _ in 0..3 {
        let scaling = bed.hold_time_step_by_need(1e-3, |_, _| 2.0).unwrap();
        assert_eq!((scaling.bodies, scaling.added_share), (0, 0.0));
    }
    assert_eq!(bed.bodies.iter().map(|b| b.spin).collect::<Vec<_>>(), before);
}

#[test]
fn the_longest_step_for_a_share_of_mass_is_one_that_the_network_bears() {
    let bed = mixed();
    let plain = bed.clone().critical_step(0.0).unwrap().network.step;
    let mut last = plain;
    for share in [0.0, 0.005, 0.05, 0.5] {
        let mut bed = bed.clone();
        let held = bed.hold_longest_step(share, 0.0).unwrap();
        assert!(held.added_share <= share && held.limit >= 0.995 * last, "{share}: {held:?}");
        let bears = bed.critical_step(0.0).unwrap().network.step;
        assert!((held.limit / bears - 1.0).abs() < 5e-3, "{held:?} {bears}");
        last = held.limit;
    }
    assert!(last > 1.5 * plain, "{last} {plain}");
    // any step is stable without contacts
    let mut alone = Bed::<f64>::new(Domain::open(), ContactLaws::uniform(1, law(0.0)));
    alone.add_sphere(&Sphere { centre: [0.0; 3], radius: 0.01, density: 2700.0, surface: 0 });
    let held = alone.hold_longest_step(0.02, 0.0).unwrap();
    assert_eq!((held.limit, held.bodies), (f64::INFINITY, 0));
}

/// The contacts of a single grain, found without the list of all contacts, equal its contacts in that list, in the same
/// order; a step allowed by the traces is allowed by the pencil.
#[test]
fn the_own_contacts_of_a_body_are_those_among_all() {
    let mut bed = mixed();
    let links = bed.links(0.0).unwrap();
    let roots = bed.roots();
    let around = Around::new(&links, roots.len());
    let (mut sure, mut allowed) = (0, 0);
    for (body, root) in roots.iter().enumerate() {
        let own = bed.own_links(bed.index[body]);
        assert_eq!(own, around.pick(body, &links).copied().collect::<Vec<_>>(), "body {body}");
        for step in [1e-4, 3e-4, 1e-3] {
            let allows = pencil(body, root, &own, Weight::Even(2.0)).allows(step);
            let surely = surely_allows(body, root, &own, Weight::Even(2.0), step);
            assert!(allows || !surely, "body {body} at {step} s");
            (sure, allowed) = (sure + usize::from(surely), allowed + usize::from(allows));
        }
    }
    assert!(sure > allowed / 4 && allowed < 3 * roots.len(), "{sure} of {allowed} without their pencils");
}

/// The contributions of the contacts of a body, summed by blocks, equal the pencil at that step. A step held by need is
/// stable for the network, with less additional mass than if contacts count twice.
#[test]
fn contacts_shared_by_need_hold_a_step_with_less_mass() {
    let bed = mixed();
    let plain = bed.clone().critical_step(0.0).unwrap().network.step;
    let (links, roots) = (bed.clone().links(0.0).unwrap(), bed.roots());
    let (around, acting) = (Around::new(&links, roots.len()), Acting::new(&bed, 1e-4));
    let loads: Vec<f64> = (0..roots.len()).map(|body| 1.0 + body as f64 % 7.0).collect();
    for (body, root) in roots.iter().enumerate() {
        let pencil = pencil(body, root, around.pick(body, &links), Weight::Shared(&loads));
        let of = |place: u32| loads[bed.bodies[place as usize].id as usize];
        let count = |other| 1.0 + of(other) / loads[body];
        let whole = acting.matrix(bed.index[body] as usize, count);
        // the sums take normals in single precision, and arms without overlaps
        assert!((whole - pencil.at_step(1e-4)).norm() <= 1e-3 * whole.norm(), "body {body}");
        assert!(largest(&whole) >= whole.symmetric_eigenvalues().max(), "body {body}");
    }
    for factor in [1.0, 1.5, 3.0] {
        let step = factor * plain;
        let (mut shared, mut even) = (bed.clone(), bed.clone());
        let by_need = shared.hold_time_step_by_need(step, |_, _| 0.0).unwrap();
        let twice = even.hold_time_step(step, |_| 0.0).unwrap();
        let bears = shared.critical_step(0.0).unwrap().network.step;
        assert!(bears >= step, "{factor}: {bears} s for {step} s");
        assert!(by_need.added_share <= twice.added_share, "{factor}: {by_need:?} {twice:?}");
    }
}
