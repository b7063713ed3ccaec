//! The oedometer of `examples/oedometer` up to 20 kPa, against YADE's run from the same particle file. The whole
//! experiment with its load cycles and five seeds is the example itself; what it gave is in `docs/charts/oedometer`.

#[path = "../examples/oedometer/cycles.rs"]
mod cycles;
#[path = "../examples/oedometer/experiment.rs"]
mod experiment;
#[path = "../examples/oedometer/files.rs"]
mod files;
#[path = "../examples/oedometer/particles.rs"]
mod particles;
#[path = "../examples/oedometer/scatter.rs"]
mod scatter;

use cycles::{Outcome, run};
use experiment::{Parameters, Trouble};
use files::{Reference, write_run, write_scatter};
use particles::Particles;
use scatter::{observables, scatter};
use std::path::Path;

const FILE: &str = include_str!("../examples/oedometer/particles.xyzr");

fn spheres() -> Particles {
    Particles::read(FILE).unwrap()
}

/// To 20 kPa at the speed of YADE's seating, and back to 5 kPa.
fn shortened() -> Parameters {
    Parameters { speed: 0.02, low: 5e3, high: 20e3, cycles: 0, ..Parameters::default() }
}

#[test]
fn first_loading_is_yades() {
    let (bed, parameters) = (spheres(), shortened());
    let outcome = run::<f32>(&bed, &parameters, |_, _| {}).unwrap();

    // at rest the floor carries the weight of all spheres
    let weight = bed.solid_volume() * parameters.density * parameters.gravity / parameters.area() / 1e3;
    assert!((weight - 16.094).abs() < 1e-3, "{weight}");
    let settled = &outcome.compression[0];
    assert!((settled.floor_kpa / weight - 1.0).abs() < 1e-3, "{}", settled.floor_kpa);
    assert_eq!(settled.plate_kpa, 0.0);

    let yade = Reference::read(Path::new("docs/charts/oedometer/yade_20")).unwrap();
    let found = scatter(&[observables(&outcome.compression, &[])], &observables(&yade.compression, &[]));
    let barred: Vec<_> = found.iter().filter(|row| row.bar.is_some()).collect();
    assert_eq!(barred.len(), 8, "porosity and coordination at 0, 5, 10 and 20 kPa");
    for row in barred {
        assert_eq!(row.within, Some(true), "{row:?}");
    }
    // unloading is much stiffer than loading, but gives something back
    let [before, loaded, after] = outcome.cycles[0].heights;
    assert!(loaded < after && after - loaded < 0.5 * (before - loaded), "{before} {loaded} {after}");
    tables_keep_the_run(&outcome, &parameters);
}

fn tables_keep_the_run(outcome: &Outcome, parameters: &Parameters) {
    let folder = tempfile::tempdir().unwrap();
    write_run(folder.path(), outcome, parameters).unwrap();
    let read = Reference::read(folder.path()).unwrap();
    let found =
        scatter(&[observables(&outcome.compression, &outcome.cycles)], &observables(&read.compression, &read.cycles));
    for row in &found {
        let reference = row.reference.unwrap();
        assert!((row.mean - reference).abs() < 1e-5, "{row:?}");
    }
    let table = folder.path().join("scatter.csv");
    write_scatter(&table, &found).unwrap();
    assert_eq!(std::fs::read_to_string(table).unwrap().lines().count(), found.len() + 1);
}

#[test]
fn threads_change_no_bit() {
    let parameters = Parameters { settle_steps: 100, low: 50.0, high: 300.0, interval: 100, ..shortened() };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run::<f32>(&spheres().shaken(1, 1e-6), &parameters, |_, _| {})).unwrap()
    };
    let one = with(1);
    assert!(one.steps > 1000, "the plate loads the bed: {}", one.steps);
    assert_eq!(one, with(2));
}

#[test]
fn a_seed_is_a_small_change_that_comes_again() {
    let bed = spheres();
    assert_eq!((bed.radii.len(), bed.period), (2000, Some([0.6, 0.6])));
    assert_eq!(bed.shaken(0, 1e-6), bed);
    let moved = bed.shaken(3, 1e-6);
    assert_eq!(moved, bed.shaken(3, 1e-6));
    assert_ne!(moved, bed.shaken(4, 1e-6));
    let ways = bed.centres.iter().flatten().zip(moved.centres.iter().flatten()).map(|(a, b)| (a - b).abs());
    let farthest = ways.fold(0.0, f64::max);
    assert!((0.99e-6..=1.0001e-6).contains(&farthest), "{farthest}");
}

#[test]
fn what_cannot_be_is_named() {
    let wrong = Particles::read("# periodic x 1 m, y 2 m\n0 0 0 0.1\n0 0 nan 0.1\n").unwrap_err();
    assert_eq!(wrong.to_string(), "line 3: expected `x y z r` in m with r above 0, found `0 0 nan 0.1`");
    assert!(Particles::read("0 0 0 -0.1").is_err());
    let none = Particles { centres: vec![], radii: vec![], period: None };
    assert_eq!(run::<f64>(&none, &shortened(), |_, _| {}), Err(Trouble::NoSpheres));
    let damping = Parameters { damping: 1.0, ..shortened() }.check().unwrap_err();
    assert_eq!(damping.to_string(), "damping is 1, expected a number from 0 to below 1");
    let order = Parameters { high: 4e3, ..shortened() }.check().unwrap_err();
    assert!(order.to_string().starts_with("upper pressure is 4000"));
    let stiffness = Parameters { normal_stiffness: 0.0, ..shortened() }.check().unwrap_err();
    assert_eq!(stiffness.to_string(), "normal stiffness is 0, expected a number above 0");
}
