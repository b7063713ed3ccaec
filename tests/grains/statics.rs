//! Beds at rest: columns, floor pressure, lattices, and the stress that their contacts carry.

use crate::scenes::{DENSITY, GRAVITY, RADIUS, alone, close, mass, norm, packed, random, sphere, springs, sub, walls};
use std::f64::consts::PI;
use trackbed::solvers::granular::measure::{Contact, Region, coordination, stress};
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, Failure, Gravity, Linear, Real, Snapshot,
    WallId,
};

const STIFFNESS: f64 = 1e7;

fn settling() -> Linear {
    Linear {
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: 0.3, shear: 0.3 },
        mode: DashpotMode::NoTensionRestInSlip,
        ..springs(STIFFNESS, STIFFNESS)
    }
}

/// Equal spheres one on another on a floor, the first at the bottom.
fn column<R: Real>(count: usize) -> Bed<R> {
    let mut bed = Bed::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(settling())));
    bed.set_gravity(Gravity::EARTH);
    bed.set_time_step(1e-5);
    bed.set_damping(0.5);
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    for k in 0..count {
        bed.add_sphere(&sphere([0.0, 0.0, RADIUS * (1.0 + 2.0 * k as f64)]));
    }
    bed
}

fn contacts(snapshot: &Snapshot) -> Vec<Contact> {
    snapshot.contacts.iter().map(|c| Contact { force: c.force, branch: c.branch, point: c.point }).collect()
}

fn pairs(snapshot: &Snapshot) -> Vec<(u32, u32)> {
    let pair = |c: &trackbed::solvers::granular::ContactState| Some((c.first.body()?.0, c.second.body()?.0));
    snapshot.contacts.iter().filter_map(pair).collect()
}

/// Largest errors of force and overlap in a column at rest, as shares.
fn errors_in_a_column<R: Real>(count: usize) -> [f64; 2] {
    let mut bed = column::<R>(count);
    let snapshot = alone(|| {
        bed.run(20_000).unwrap();
        bed.snapshot().unwrap()
    });
    assert_eq!(snapshot.contacts.len(), count);
    let weight = mass(RADIUS, DENSITY) * GRAVITY;
    let mut errors = [0.0f64; 2];
    for contact in &snapshot.contacts {
        // the contact under the k-th from the top carries k spheres
        let lower = match contact.second.body() {
            None => 0,
            Some(other) => other.0.min(contact.first.body().unwrap().0) + 1,
        };
        let carried = (count as u32 - lower) as f64 * weight;
        errors[0] = errors[0].max((contact.force[2].abs() / carried - 1.0).abs());
        errors[1] = errors[1].max((contact.overlap / (carried / STIFFNESS) - 1.0).abs());
    }
    errors
}

#[test]
fn contacts_of_a_column_carry_what_is_above() {
    for count in [1, 10] {
        let [force, overlap] = errors_in_a_column::<f64>(count);
        println!("column of {count}: force {force:.1e}, overlap {overlap:.1e}");
        assert!(force < 1e-8 && overlap < 1e-8);
        let [force, overlap] = errors_in_a_column::<f32>(count);
        println!("column of {count} in mixed precision: force {force:.1e}, overlap {overlap:.1e}");
        assert!(force < 1e-6 && overlap < 1e-6);
    }
}

#[test]
fn stress_of_a_column_under_its_own_weight() {
    let count = 10;
    let mut bed = column::<f64>(count);
    let snapshot = alone(|| {
        bed.run(20_000).unwrap();
        bed.snapshot().unwrap()
    });
    let high = 2.0 * RADIUS * count as f64;
    let region = Region::block([-RADIUS, -RADIUS, -0.01], [RADIUS, RADIUS, high]).unwrap();
    let sigma = stress(&region, contacts(&snapshot));
    // sum of force times branch; branches are short by the overlaps
    let weight = mass(RADIUS, DENSITY) * GRAVITY;
    let moment: f64 = (1..=count)
        .map(|k| {
            let force = k as f64 * weight;
            let overlap = force / STIFFNESS;
            force * if k == count { RADIUS - 0.5 * overlap } else { 2.0 * RADIUS - overlap }
        })
        .sum();
    close(sigma[(2, 2)], -moment / region.volume(), 1e-9, "vertical stress");
    for (row, column) in [(0, 0), (1, 1), (0, 1), (0, 2), (1, 2), (2, 0)] {
        assert!(sigma[(row, column)].abs() < 1e-12 * sigma[(2, 2)].abs());
    }
}

#[test]
fn a_floor_carries_the_weight_of_a_bed() {
    let (spheres, side) = packed();
    // smooth sides, so that they carry nothing
    let mut laws = ContactLaws::uniform(2, ContactLaw::Linear(settling()));
    laws.set(0, 1, ContactLaw::Linear(springs(STIFFNESS, 0.0)));
    let mut bed = Bed::<f32>::new(Domain::open(), laws);
    bed.set_gravity(Gravity::EARTH);
    bed.set_time_step(1e-5);
    bed.set_damping(0.7);
    let planes: Vec<WallId> = walls(side)
        .iter()
        .enumerate()
        .map(|(k, (point, normal))| bed.add_plane(*point, *normal, u16::from(k > 0)))
        .collect();
    // none rolls, so that all come to rest soon
    for sphere in &spheres {
        let id = bed.add_sphere(sphere);
        bed.hold_rotation(id);
    }
    let weight: f64 = spheres.iter().map(|s| mass(s.radius, s.density)).sum::<f64>() * GRAVITY;
    let pressure = |bed: &Bed<f32>| -bed.wall(planes[0]).felt().force.z / (side * side);
    alone(|| bed.run(20_000)).unwrap();
    println!("floor {:.3} Pa, weight over area {:.3} Pa", pressure(&bed), weight / (side * side));
    close(pressure(&bed), weight / (side * side), 1e-6, "floor pressure");

    // half as heavy again, so that it moves: the impulse of the floor is that of the weight and of the motion. Local
    // damping is a force from nowhere and stays out.
    bed.set_damping(0.0);
    bed.set_gravity(Gravity::Constant([0.0, 0.0, -1.5 * GRAVITY]));
    let rise = |bed: &Bed<f32>| bed.states().map(|s| s.mass * s.velocity[2]).sum::<f64>();
    let (before, mut impulse, steps) = (rise(&bed), 0.0, 300);
    alone(|| {
        for _ in 0..steps {
            bed.step().unwrap();
            impulse += pressure(&bed) * side * side * bed.time_step();
        }
    });
    let gained = rise(&bed) - before;
    let given = 1.5 * weight * f64::from(steps) * bed.time_step();
    assert!(gained.abs() > 1e-3 * given);
    close(impulse - gained, given, 1e-7, "impulse of the floor");
}

/// A lattice in a periodic cell, squeezed by a share of the distance of its spheres.
struct Lattice {
    bed: Bed<f64>,
    cell: [f64; 3],
    distance: f64,
    count: usize,
}

impl Lattice {
    /// `basis` holds places in a unit of `edges`, all in units of the distance of two spheres.
    fn new(edges: [f64; 3], basis: &[[f64; 3]], repeats: [usize; 3], squeeze: f64) -> Lattice {
        let distance = 2.0 * RADIUS * (1.0 - squeeze);
        let cell = [0, 1, 2].map(|c| edges[c] * distance * repeats[c] as f64);
        let domain = (0..3).fold(Domain::open(), |domain, axis| domain.periodic(axis, cell[axis]));
        let mut bed = Bed::new(domain, ContactLaws::single(ContactLaw::Linear(settling())));
        bed.set_time_step(1e-5);
        let mut count = 0;
        for k in 0..repeats.iter().product() {
            let at = [k % repeats[0], k / repeats[0] % repeats[1], k / (repeats[0] * repeats[1])];
            for place in basis {
                let centre = [0, 1, 2].map(|c| distance * (place[c] + edges[c] * (at[c] as f64 + 0.01)));
                bed.add_sphere(&sphere(centre));
                count += 1;
            }
        }
        Lattice { bed, cell, distance, count }
    }

    fn cubic(squeeze: f64) -> Lattice {
        Lattice::new([1.0; 3], &[[0.0; 3]], [3, 4, 5], squeeze)
    }

    fn hexagonal(squeeze: f64) -> Lattice {
        let (y, z) = (3.0f64.sqrt(), (8.0f64 / 3.0).sqrt());
        let basis = [[0.0; 3], [0.5, y / 2.0, 0.0], [0.5, y / 6.0, z / 2.0], [0.0, 2.0 * y / 3.0, z / 2.0]];
        Lattice::new([1.0, y, z], &basis, [3, 2, 2], squeeze)
    }

    fn region(&self) -> Region {
        Region::block([0.0; 3], self.cell).unwrap()
    }
}

#[test]
fn lattices_have_their_coordination_porosity_and_stress() {
    let squeeze = 1e-3;
    let dense = 1.0 - PI / (3.0 * 2.0f64.sqrt());
    for (name, mut lattice, neighbours, porosity, per_force) in [
        ("simple cubic", Lattice::cubic(squeeze), 6.0, 1.0 - PI / 6.0, 1.0),
        ("hexagonal close", Lattice::hexagonal(squeeze), 12.0, dense, 2.0 * 2.0f64.sqrt()),
    ] {
        let places: Vec<_> = lattice.bed.states().map(|s| s.place).collect();
        let snapshot = alone(|| {
            lattice.bed.run(100).unwrap();
            lattice.bed.snapshot().unwrap()
        });
        // in balance: nothing moves
        let moved = lattice.bed.states().zip(&places).map(|(s, p)| norm(sub(s.place, *p))).fold(0.0, f64::max);
        assert!(moved < 1e-12, "{name} moved by {moved:e} m");
        let found = coordination(lattice.count, &pairs(&snapshot));
        assert_eq!((found.mean, found.rattlers), (neighbours, 0), "{name}");
        assert_eq!(snapshot.coordination(lattice.count), neighbours);

        // shares of all images of the spheres that reach into the cell
        let region = lattice.region();
        let images = |place: [f64; 3]| {
            (0..27).map(move |k| [k % 3, k / 3 % 3, k / 9].map(|n| n as f64 - 1.0)).map({
                let cell = lattice.cell;
                move |s| [0, 1, 2].map(|c| place[c] + s[c] * cell[c])
            })
        };
        let shares = places.iter().flat_map(|p| images(*p)).map(|p| region.share_of_sphere((p, RADIUS)));
        let solid = region.porosity(shares);
        let expected = 1.0 - (1.0 - porosity) / (1.0 - squeeze).powi(3);
        close(1.0 - solid, 1.0 - expected, 1e-12, "solid share");

        // hydrostatic: p = F/L^2 and 2 sqrt(2) F/L^2
        let force = STIFFNESS * 2.0 * RADIUS * squeeze;
        let pressure = per_force * force / (lattice.distance * lattice.distance);
        let everywhere = Region::block([-1.0; 3], [2.0; 3]).unwrap();
        let volume: f64 = lattice.cell.iter().product();
        let sigma = stress(&everywhere, contacts(&snapshot)) * (everywhere.volume() / volume);
        for row in 0..3 {
            close(-sigma[(row, row)], pressure, 1e-11, name);
            for column in (0..3).filter(|c| *c != row) {
                assert!(sigma[(row, column)].abs() < 1e-11 * pressure, "{name}: {sigma}");
            }
        }
        println!("{name}: pressure {pressure:.6e} Pa, found {:.6e} Pa", -sigma.trace() / 3.0);
    }
}

/// A period that a body reaches across twice is no period for it: its second neighbour would be missed.
#[test]
fn a_period_must_be_longer_than_two_spheres() {
    let mut lattice = Lattice::new([1.0; 3], &[[0.0; 3]], [2, 3, 3], 1e-3);
    for _ in 0..2 {
        assert_eq!(lattice.bed.snapshot(), Err(Failure::CellTooSmall));
        assert_eq!(lattice.bed.step(), Err(Failure::CellTooSmall));
    }
    let mut lattice = Lattice::new([1.0; 3], &[[0.0; 3]], [3, 3, 1], 1e-3);
    assert!(matches!(lattice.bed.step(), Err(Failure::Fault(_))), "a sphere that touches itself");
}

/// A lattice whose spheres are nudged about goes on being held by its neighbours across the period.
#[test]
fn a_nudged_lattice_comes_back() {
    let mut lattice = Lattice::hexagonal(1e-3);
    let mut seed = 5;
    let start: Vec<_> = lattice.bed.states().map(|s| s.place).collect();
    let mut momentum = [0.0; 3];
    for id in 0..lattice.count as u32 {
        let last = id + 1 == lattice.count as u32;
        let velocity = [0, 1, 2].map(|c| if last { -momentum[c] } else { 0.01 * random(&mut seed) });
        momentum = [0, 1, 2].map(|c| momentum[c] + velocity[c]);
        lattice.bed.set_velocity(BodyId(id), velocity, [0.0; 3]);
    }
    lattice.bed.change_laws(|law| {
        if let ContactLaw::Linear(law) = law {
            law.friction = 0.0;
        }
    });
    alone(|| lattice.bed.run(3000)).unwrap();
    let left = lattice.bed.states().zip(&start).map(|(s, p)| norm(sub(s.place, *p))).fold(0.0, f64::max);
    assert!(left < 1e-9, "{left:e}");
}
