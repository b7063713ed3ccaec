//! Copies of a cell side by side.

use crate::bed::{bed, bits};
use trackbed::solvers::granular::{Bed, BodyId, Real};

/// Offsets in their bays, velocities, spins of one copy.
fn copy<R: Real>(bed: &Bed<R>, bodies: usize, number: usize) -> Vec<u64> {
    let states = (number * bodies..(number + 1) * bodies).map(|id| bed.body_state(BodyId(id as u32)));
    states
        .flat_map(|s| s.velocity.into_iter().chain(s.spin).chain([s.place[1], s.place[2]]))
        .map(f64::to_bits)
        .collect()
}

fn steps_alike<R: Real>() {
    let mut cell = bed::<R>(11);
    cell.run(16_000).unwrap();
    let mut row = cell.replicate(3).unwrap();
    assert_eq!(row.len(), 3 * cell.len());
    let touching = cell.touching().unwrap();
    assert!(touching.0 > 40, "{touching:?}");
    assert_eq!(row.touching().unwrap(), (3 * touching.0, 3 * touching.1));
    let (before, largest) = (cell.snapshot().unwrap(), row.snapshot().unwrap().largest_force());
    assert_eq!(before.largest_force(), largest, "joints carry no jump in force");
    cell.run(2000).unwrap();
    row.run(2000).unwrap();
    let original = copy(&cell, cell.len(), 0);
    for number in 0..3 {
        assert_eq!(copy(&row, cell.len(), number), original, "copy {number}, {}", R::NAME);
    }
}

#[test]
fn a_replicated_cell_steps_bit_by_bit_as_its_source() {
    steps_alike::<f32>();
    steps_alike::<f64>();
}

#[test]
fn copies_part_where_one_is_disturbed() {
    let mut cell = bed::<f32>(11);
    cell.run(12_000).unwrap();
    let mut row = cell.replicate(4).unwrap();
    row.set_velocity(BodyId(0), [0.0, 0.0, 0.5], [0.0; 3]);
    row.run(500).unwrap();
    assert_ne!(copy(&row, cell.len(), 0), copy(&row, cell.len(), 2));
}

#[test]
fn neither_threads_nor_lists_change_a_bit() {
    let run = |threads: usize, skin: Option<f64>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut cell = bed::<f32>(5);
            cell.run(4000).unwrap();
            let mut row = cell.replicate(8).unwrap();
            row.set_skin(skin);
            row.run(1500).unwrap();
            (bits(&row), row.kinetic_energy().unwrap())
        })
    };
    let alone = run(1, None);
    assert_eq!(alone, run(3, None));
    assert_eq!(alone, run(2, Some(1e-4)));
    assert_eq!(alone, run(1, Some(8e-3)));
}
