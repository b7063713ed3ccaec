//! Sleepers on small beds: their forces on the bed, their settlement, and results independent of threads and pauses.

use super::*;
use crate::solvers::granular::measure::Region;
use crate::solvers::granular::packing::{GrainLayer, Packing, Recipe, Rest, pack};
use crate::solvers::granular::{Bed, DashpotMode, Surface, clump::Template, grains::Curve};
use std::sync::OnceLock;

mod crib;
mod glued;

/// Spheres of these sizes on a plan, in a box with smooth walls or in a cell with rough walls.
fn recipe(plan: [f64; 2], thickness: f64, sizes: [f64; 2], friction: f64, boxed: bool) -> Recipe {
    let surface = Surface {
        normal_stiffness: 2.6e7,
        shear_stiffness: 2.6e7,
        friction,
        damping: [0.3; 2],
        mode: DashpotMode::default(),
    };
    Recipe {
        plan,
        walls: true,
        ends: boxed,
        layers: vec![GrainLayer {
            name: "stone".into(),
            curve: Curve::new(&[[sizes[0], 0.0], [sizes[1], 1.0]]).unwrap(),
            templates: vec![Template::sphere(0.5).unwrap()],
            density: 2700.0,
            surface,
            wall_friction: if boxed { 0.0 } else { friction },
            thickness,
            lifts: 1,
            pressure: 200e3,
            packing: Packing { friction: 0.0, local_damping: 0.7, viscous_damping: 0.0 },
        }],
        gravity: 9.81,
        local_damping: 0.2,
        restored: Default::default(),
        reloads: 0,
        rest: Rest::default(),
        seed: 1,
    }
}

/// A bed of 0.6 m x 0.6 m x 0.2 m of coarse spheres, packed once.
fn bed() -> Bed<f32> {
    static BED: OnceLock<Bed<f32>> = OnceLock::new();
    let packed = || pack::<f32, _>(&recipe([0.6; 2], 0.2, [0.05, 0.07], 0.7, false), |_| {}).unwrap().bed;
    BED.get_or_init(packed).clone()
}

fn rig(load: Load, cycles: u64) -> Rig {
    let sleeper = Sleeper { place: [0.3, 0.0], size: [0.3, 1.2, 0.2], mass: 150.0, load };
    let region = Region::block([0.15, 0.0, 0.05], [0.45, 0.6, 0.15]).unwrap();
    Rig {
        sleepers: vec![sleeper],
        specimen: None,
        filling: None,
        glued: Vec::new(),
        period: 0.04,
        cycles,
        gravity: 9.81,
        densities: vec![2700.0],
        kept: vec![1, cycles],
        sensors: vec![Sensor { region }],
        added: ADDED,
    }
}

fn cyclic(cycles: u64) -> Rig {
    rig(Load::Cyclic { range: [2e3, 20e3], delay: 0.0 }, cycles)
}

fn run<'a>(rig: &'a Rig) -> Trial<'a, f32> {
    let mut trial = Trial::new(bed(), rig, |_| {}).unwrap();
    while trial.advance().unwrap() {}
    trial
}

#[test]
fn a_sleeper_rests_on_the_bed_and_settles_less_and_less() {
    let rig = cyclic(6);
    let trial = run(&rig);
    let cycles = trial.cycles();
    assert_eq!(cycles.iter().map(|cycle| cycle.number).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
    let settled: Vec<f64> = cycles.iter().map(|cycle| cycle.settlement).collect();
    assert!(settled[0] > 0.0 && settled[5] < 0.02, "{settled:?}");
    assert!(settled[5] - settled[4] < settled[0], "{settled:?}");
    for cycle in cycles {
        assert!(cycle.deepest > cycle.settlement, "{cycle:?}");
        // half a sleeper on 0.2 m of stones over a rigid floor
        assert!((5e6..500e6).contains(&cycle.stiffness), "{cycle:?}");
        // weight and applied force, and the inertia force of the mass
        assert!((cycle.contact_force / (20e3 + 150.0 * 9.81) - 1.0).abs() < 0.15, "{cycle:?}");
        assert!(cycle.work > 0.0, "friction keeps work: {cycle:?}");
    }
    assert_eq!(trial.samples().len(), 128);
    // the bed carries the applied force: across 0.6 m and along at most twice the width of the sleeper
    let peak = trial.readings().iter().filter(|r| r.cycle == 6).map(|r| r.stress).fold(0.0, f64::max);
    let pressure = (20e3 + 150.0 * 9.81) / (0.3 * 0.6);
    assert!((0.3..1.3).contains(&(peak / pressure)), "{peak} {pressure}");
    let porosity = trial.readings().iter().filter_map(|r| r.porosity).next().unwrap();
    assert!((0.3..0.5).contains(&porosity), "{porosity}");
}

#[test]
fn a_test_that_pauses_and_one_on_other_threads_end_with_the_same_bits() {
    let rig = cyclic(2);
    let whole = run(&rig);
    let mut trial = Trial::new(bed(), &rig, |_| {}).unwrap();
    for _ in 0..77 {
        trial.advance().unwrap();
    }
    let kept = serde_json::to_string(&trial.store()).unwrap();
    let mut again = Trial::<f32>::restore(serde_json::from_str(&kept).unwrap(), &rig).unwrap();
    while again.advance().unwrap() {}
    assert_eq!(
        (again.cycles(), again.samples(), again.readings()),
        (whole.cycles(), whole.samples(), whole.readings())
    );
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let cycles = alone.install(|| run(&rig).cycles().to_vec());
    assert_eq!(cycles, whole.cycles());
}

#[test]
fn constant_forces_and_histories_are_followed() {
    let constant = rig(Load::Constant(10e3), 1);
    let held = run(&constant).cycles()[0];
    assert!(held.stiffness > 1e6 && (held.contact_force / 11.5e3 - 1.0).abs() < 0.1, "{held:?}");
    let points = vec![[0.0, 1e3], [0.02, 15e3], [0.04, 1e3]];
    let history = Rig { period: 0.04, ..rig(Load::History(points), 1) };
    let trial = run(&history);
    let middle = trial.samples().iter().find(|sample| sample.phase == 0.5).unwrap();
    assert!((middle.force - 15e3).abs() < 1.0, "{middle:?}");
    assert!(trial.cycles()[0].deepest > trial.cycles()[0].settlement);
}

#[test]
fn what_no_bed_carries_is_told() {
    let heavy = rig(Load::Cyclic { range: [2e3, 3e7], delay: 0.0 }, 3);
    let mut trial = Trial::new(bed(), &heavy, |_| {}).unwrap();
    let error = loop {
        match trial.advance() {
            Ok(more) => assert!(more, "the bed carries 30 MN"),
            Err(error) => break error,
        }
    };
    let said = error.to_string();
    assert!(said.contains("in cycle 1"), "{said}");
}

/// A box of 0.3 m x 0.3 m x 0.4 m of spheres with smooth walls, and the rig that shortens it by a tenth under 100 kPa.
fn specimen(friction: f64) -> (Bed<f32>, Rig) {
    let recipe = recipe([0.3; 2], 0.4, [0.04, 0.05], friction, true);
    let packed = pack::<f32, _>(&recipe, |_| {}).unwrap();
    let plate = Sleeper { place: [0.15, 0.15], size: [0.3, 0.3, 0.02], mass: 14.0, load: Load::Strain(0.1) };
    let rig = Rig {
        sleepers: vec![plate],
        specimen: Some(Specimen { floor: recipe.floor(), sides: recipe.sides().unwrap(), pressure: 100e3 }),
        filling: None,
        glued: Vec::new(),
        period: 0.9,
        cycles: 1,
        gravity: 9.81,
        densities: vec![2700.0],
        kept: vec![1],
        sensors: vec![Sensor { region: Region::block([0.0, 0.0, 0.1], [0.3, 0.3, 0.3]).unwrap() }],
        added: ADDED,
    };
    (packed.bed, rig)
}

#[test]
fn a_specimen_keeps_its_pressure_dilates_and_bears_what_its_friction_bears() {
    let (bed, rig) = specimen(0.5);
    let mut trial = Trial::new(bed, &rig, |_| {}).unwrap();
    while trial.advance().unwrap() {}
    let states = trial.specimen();
    assert_eq!(states.len(), 64);
    let last = states[63];
    assert!((last.axial_strain - 0.1).abs() < 2e-3, "{last:?}");
    for state in states {
        assert!((state.lateral_stress / 100e3 - 1.0).abs() < 0.1, "{state:?}");
    }
    let mean = states.iter().map(|state| state.lateral_stress).sum::<f64>() / 64.0;
    assert!((mean / 100e3 - 1.0).abs() < 0.02, "{mean}");
    // spheres of friction 0.5 that roll freely, seven to a side of the box
    let peak = states.iter().map(|state| state.mobilised_friction().to_degrees()).fold(0.0, f64::max);
    assert!((18.0..40.0).contains(&peak), "{peak}");
    assert!(states.iter().any(|state| state.volume_strain < -0.005), "a dense specimen dilates");
    // the forces on the walls equal the forces of the contacts inside, while the specimen lies in the region
    let early: Vec<_> = states.iter().filter(|state| state.axial_strain < 0.01).collect();
    let inside: Vec<f64> =
        trial.readings().iter().filter(|r| r.phase <= early[early.len() - 1].phase).map(|r| r.stress).collect();
    let felt: Vec<f64> =
        early.iter().filter(|state| ((state.phase * 64.0) as u64).is_multiple_of(2)).map(|s| s.axial_stress).collect();
    assert!(inside.len() == felt.len() && inside.len() >= 3);
    let ratio = inside.iter().sum::<f64>() / felt.iter().sum::<f64>();
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

#[test]
fn a_specimen_without_friction_has_little_strength() {
    let (bed, rig) = specimen(0.0);
    let mut trial = Trial::new(bed, &rig, |_| {}).unwrap();
    while trial.advance().unwrap() {}
    let late: Vec<f64> = trial.specimen()[32..].iter().map(|state| state.mobilised_friction().to_degrees()).collect();
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    // 5.8 degrees at rest (Peyneau and Roux 2008); an inertial number of 1e-3 adds a few degrees
    assert!((2.0..14.0).contains(&mean), "{mean}");
}

#[test]
fn a_test_that_lost_a_list_is_refused() {
    let rig = cyclic(2);
    let mut trial = Trial::new(bed(), &rig, |_| {}).unwrap();
    for _ in 0..100 {
        trial.advance().unwrap();
    }
    let whole = serde_json::to_value(trial.store()).unwrap();
    let mut refused = 0;
    for list in crate::solvers::granular::packing::tests::lists(&whole) {
        let mut lacking = whole.clone();
        *lacking.pointer_mut(&list).unwrap() = serde_json::json!([]);
        let Ok(stored) = serde_json::from_value::<StoredTrial<f32>>(lacking) else { continue };
        match Trial::restore(stored, &rig) {
            Err(_) => refused += 1,
            // a missing contact history or recorded reading does not affect the motion
            Ok(mut trial) => drop(trial.advance()),
        }
    }
    assert!(refused > 5, "{refused}");
}
