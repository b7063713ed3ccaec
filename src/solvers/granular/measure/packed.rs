//! Surveys of whole beds: lattices under their own weight, beds that fall and rotate, and a packed bed under a plate.

use super::*;
use crate::solvers::granular::clump::Template;
use crate::solvers::granular::grains::Curve;
use crate::solvers::granular::packing::{GrainLayer, Packed, Packing, Recipe, Rest, pack};
use crate::solvers::granular::probe::{FULL, Outline, Plate, Stillness, probe};
use crate::solvers::granular::{Bed, ContactLaws, DashpotMode, Domain, Gravity, Party, Sphere, Surface, WallId};
use std::f64::consts::PI;
use std::sync::LazyLock;

const DENSITY: f64 = 2700.0;
const RADIUS: f64 = 0.03;
const GRAVITY: f64 = 9.81;

fn surface() -> Surface {
    Surface {
        normal_stiffness: 2.6e7,
        shear_stiffness: 2.6e7,
        friction: 0.7,
        damping: [0.3; 2],
        mode: DashpotMode::default(),
    }
}

/// Spheres of 32 to 50 mm in a periodic cell.
pub(in super::super) fn recipe() -> Recipe {
    let layer = GrainLayer {
        name: "ballast".into(),
        curve: Curve::new(&[[0.032, 0.0], [0.05, 1.0]]).unwrap(),
        templates: vec![Template::sphere(0.5).unwrap()],
        density: DENSITY,
        surface: surface(),
        wall_friction: 0.7,
        thickness: 0.2,
        lifts: 1,
        pressure: 200e3,
        packing: Packing { friction: 0.0, local_damping: 0.7, viscous_damping: 0.0 },
    };
    Recipe {
        plan: [0.3, 0.3],
        walls: false,
        ends: false,
        layers: vec![layer],
        gravity: GRAVITY,
        local_damping: 0.2,
        restored: Default::default(),
        reloads: 0,
        rest: Rest::default(),
        seed: 1,
    }
}

/// The bed of [`recipe`], packed once for all tests.
pub(in super::super) fn bed() -> &'static Packed<f32> {
    static BED: LazyLock<Packed<f32>> = LazyLock::new(|| pack(&recipe(), |_| ()).unwrap_or_else(|e| panic!("{e}")));
    &BED
}

fn mass() -> f64 {
    DENSITY * 4.0 / 3.0 * PI * RADIUS.powi(3)
}

/// Sides of the lattice, spheres and m: no grain may be more than a third of its cell.
const WIDE: u32 = 4;
const SIDE: f64 = 8.0 * RADIUS;

/// A cubic lattice of `count` layers in a periodic column, on a floor or without one.
fn column(count: u32, floor: bool, fall: f64) -> Bed<f64> {
    let domain = Domain::open().periodic(0, SIDE).periodic(1, SIDE);
    let mut bed = Bed::new(domain, ContactLaws::from_surfaces(&[surface()]));
    if floor {
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    }
    for k in 0..WIDE * WIDE * count {
        let at = |n: u32| (2.0 * f64::from(n) + 1.0) * RADIUS;
        let centre = [at(k % WIDE), at(k / WIDE % WIDE), at(k / WIDE / WIDE)];
        bed.add_sphere(&Sphere { centre, radius: RADIUS, density: DENSITY, surface: 0 });
    }
    bed.set_gravity(Gravity::Constant([0.0, 0.0, -fall]));
    bed.set_time_step(2e-5);
    bed
}

fn survey(bed: &mut Bed<f64>) -> Survey {
    let snapshot = bed.snapshot().unwrap();
    Survey::from_snapshot(bed, &snapshot, &[DENSITY])
}

fn block(lower: [f64; 3], upper: [f64; 3]) -> Region {
    Region::block(lower, upper).unwrap()
}

#[test]
fn a_lattice_carries_its_weight_slab_by_slab() {
    let count = 5;
    let mut bed = column(count, true, GRAVITY);
    bed.set_damping(0.5);
    bed.run(30_000).unwrap();
    let survey = survey(&mut bed);
    let plan = SIDE * SIDE;
    let centres: Vec<f64> = bed.states().map(|state| state.place[2]).collect();
    // at a level, the weight of all spheres with their centre above it; its mean over a slab
    let above = |[low, high]: [f64; 2]| {
        let part = |z: &f64| ((z - low) / (high - low)).clamp(0.0, 1.0);
        mass() * GRAVITY * centres.iter().map(part).sum::<f64>() / plan
    };
    let levels: Vec<f64> = (0..=13).map(|k| 0.3 * f64::from(k) / 13.0).collect();
    for slab in levels.windows(2).map(|pair| [pair[0], pair[1]]) {
        let reading = survey.slab(slab, plan).unwrap();
        assert!((reading.vertical() - above(slab)).abs() < 1e-6 * above([0.0, 0.01]), "{slab:?}: {reading:?}");
    }
    // the porosity of a cubic lattice, and the fabric of its columns
    let inner = survey.slab([2.0 * RADIUS, 4.0 * RADIUS], plan).unwrap();
    assert!((inner.porosity - (1.0 - PI / 6.0)).abs() < 1e-6, "{}", inner.porosity);
    assert!((inner.fabric.deviator() - 1.0).abs() < 1e-9 || inner.fabric.deviator() < 1e-9, "{:?}", inner.fabric);
    // a box of whole cells anywhere, also over one or several borders of the period, gives the same result as the slab
    for x in [[0.0, 0.24], [-0.07, 0.05], [0.4, 0.88], [-0.3, 0.18]] {
        let reading = survey.region(&block([x[0], -0.01, 0.1], [x[1], 0.23, 0.17]));
        let slab = survey.slab([0.1, 0.17], plan).unwrap();
        let cells = (x[1] - x[0]) / SIDE;
        assert!((reading.porosity - slab.porosity).abs() < 1e-9, "{x:?}: {} {}", reading.porosity, slab.porosity);
        assert!((reading.vertical() / slab.vertical() - 1.0).abs() < 1e-9, "{x:?}");
        assert_eq!(reading.bodies, (slab.bodies as f64 * cells).round() as usize, "{x:?}");
    }
}

#[test]
fn a_falling_bed_has_the_acceleration_of_gravity() {
    let mut bed = column(3, false, GRAVITY);
    bed.run(500).unwrap();
    let reading = survey(&mut bed).region(&Region::sphere([0.12, 0.12, 0.09], 0.1).unwrap());
    assert!(reading.bodies > 12, "{}", reading.bodies);
    let fallen = GRAVITY * bed.time();
    for (found, expected) in [(reading.acceleration, GRAVITY), (reading.velocity, fallen)] {
        let error = (found[2] + expected).abs() + found[0].abs() + found[1].abs();
        assert!(error < 1e-12 * expected, "{found:?} and {expected}");
    }
}

#[test]
fn rigid_motion_is_read_as_it_is() {
    let mut bed = column(4, false, 0.0);
    let (velocity, spin, about) = ([0.3, -0.2, 0.1], [0.5, 1.0, -2.0], [0.12, 0.12, 0.12]);
    for state in bed.states().collect::<Vec<_>>() {
        let [x, y, z] = [0, 1, 2].map(|k| state.place[k] - about[k]);
        let turning = [spin[1] * z - spin[2] * y, spin[2] * x - spin[0] * z, spin[0] * y - spin[1] * x];
        bed.set_velocity(state.id, [0, 1, 2].map(|k| velocity[k] + turning[k]), spin);
    }
    let survey = survey(&mut bed);
    // around the axis of rotation, the rotation cancels
    let whole = survey.region(&block([0.0; 3], [0.24; 3]));
    assert_eq!(whole.bodies, 64);
    // two spheres: their mean velocity is the velocity of their middle
    let two = survey.region(&block([0.0, 0.0, 0.0], [0.06, 0.06, 0.12]));
    assert_eq!(two.bodies, 2);
    let [x, y, z] = [0.03 - 0.12, 0.03 - 0.12, 0.06 - 0.12];
    let turned = [0.3 + z + 2.0 * y, -0.2 - 2.0 * x - 0.5 * z, 0.1 + 0.5 * y - x];
    for k in 0..3 {
        assert!((whole.velocity[k] - velocity[k]).abs() < 1e-12, "{:?}", whole.velocity);
        assert!((two.velocity[k] - turned[k]).abs() < 1e-12, "{:?} and {turned:?}", two.velocity);
    }
    let none = survey.region(&block([0.0, 0.0, 1.0], [0.1, 0.1, 1.1]));
    assert_eq!((none.bodies, none.velocity, none.porosity), (0, [0.0; 3], 1.0));
}

#[test]
fn a_packed_bed_carries_its_plate_and_its_weight_at_every_level() {
    let packed = bed();
    let area = packed.area();
    let plate = Plate {
        outline: Outline::Whole { area },
        centre: [0.15; 2],
        pressure: 50e3,
        surface: recipe().wall_surface(),
        rest: Stillness::default(),
    };
    let mut worst = [f64::NAN; 2];
    probe(&packed.bed, &plate, |bed, done, _| {
        if done != FULL {
            return;
        }
        let snapshot = bed.snapshot().unwrap();
        let survey = packed.survey(bed).unwrap();
        let pressed = WallId(bed.walls().len() as u32 - 1);
        let felt: f64 =
            snapshot.contacts.iter().filter(|c| c.second == Party::Wall(pressed)).map(|c| -c.force[2]).sum::<f64>();
        let bodies: Vec<(f64, f64, f64)> = bed
            .states()
            .zip(balance(bed, &snapshot))
            .map(|(state, forces)| (state.place[2], state.mass * GRAVITY, forces.net[2]))
            .collect();
        let slabs: Vec<[f64; 2]> = (1..8).map(|k| [0.02 * f64::from(k), 0.02 * f64::from(k + 1)]).collect();
        // the weight of everything above, with its acceleration and without
        worst = [1.0, 0.0].map(|moving| {
            let error = slabs.iter().map(|[low, high]| {
                let part = |z: f64| ((z - low) / (high - low)).clamp(0.0, 1.0);
                let above: f64 = bodies.iter().map(|(z, weight, net)| part(*z) * (weight + moving * net)).sum();
                (survey.slab([*low, *high], area).unwrap().vertical() * area / (felt + above) - 1.0).abs()
            });
            error.fold(0.0, f64::max)
        });
        // the slabs together are the whole
        let whole = survey.slab([0.02, 0.16], area).unwrap();
        let mean = |of: &dyn Fn(&Reading) -> f64| {
            slabs.iter().map(|slab| of(&survey.slab(*slab, area).unwrap())).sum::<f64>() / slabs.len() as f64
        };
        assert!((mean(&|r| r.porosity) - whole.porosity).abs() < 1e-9);
        for (i, j) in (0..9).map(|n| (n / 3, n % 3)) {
            let error = mean(&|r| r.stress[i][j]) - whole.stress[i][j];
            assert!(error.abs() < 1e-9 * whole.vertical(), "{i} {j}: {error}");
        }
        let bodies: usize = slabs.iter().map(|slab| survey.slab(*slab, area).unwrap().bodies).sum();
        assert_eq!(bodies, whole.bodies);
        // loaded without lateral movement: between sliding and a fluid
        let [along, across] = whole.horizontal();
        assert!((0.2..0.9).contains(&(0.5 * (along + across) / whole.vertical())), "{whole:?}");
    })
    .unwrap_or_else(|error| panic!("{error}"));
    // the balance is exact; the tolerance of a plate at rest is a hundredth
    assert!(worst[0] < 1e-12 && worst[1] < 0.02, "{worst:?}");
}
