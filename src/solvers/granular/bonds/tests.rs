//! Bonds against closed forms; lists, resumes and snapshots do not change a bit of them.

use super::super::law::{ContactLaw, ContactLaws, Dashpot, DashpotMode, FrictionLimit, Linear};
use super::super::{Bed, BodyId, ContactState, Domain, Gravity, Party, Sphere};
use super::Glue;

const RADIUS: f64 = 0.03;
const STIFF: f64 = 13e6;
/// Initial overlap of neighbours, m.
const OVERLAP: f64 = 1e-5;
const GLUE: Glue = Glue { normal_stiffness: 10e6, shear_stiffness: 8e6, tensile_strength: 1e3, shear_strength: 600.0 };

fn law(friction: f64) -> ContactLaws {
    ContactLaws::single(ContactLaw::Linear(Linear {
        normal_stiffness: STIFF,
        shear_stiffness: STIFF,
        friction,
        dashpot: Dashpot::Ratio { normal: 0.0, shear: 0.0 },
        mode: DashpotMode::default(),
        limit: FrictionLimit::default(),
    }))
}

/// Touching spheres, one below the other.
fn chain(count: usize) -> Bed<f64> {
    let mut bed = Bed::new(Domain::open(), law(0.0));
    for number in 0..count {
        let z = -(number as f64) * (2.0 * RADIUS - OVERLAP);
        bed.add_sphere(&Sphere { centre: [0.0, 0.0, z], radius: RADIUS, density: 2700.0, surface: 0 });
    }
    bed.set_time_step(1e-6);
    bed
}

fn glued(mut bed: Bed<f64>, glue: Glue) -> Bed<f64> {
    let pairs = bed.len() - 1;
    assert_eq!(bed.glue(vec![glue], |_| Some(0)).unwrap(), pairs);
    bed
}

/// Two spheres; the lower one is drawn away at this velocity, m/s.
fn drawn(velocity: [f64; 3]) -> Bed<f64> {
    let mut bed = glued(chain(2), GLUE);
    bed.set_velocity(BodyId(1), velocity, [0.0; 3]);
    (0..2).for_each(|body| bed.fix(BodyId(body)));
    bed
}

/// Force on the upper of two spheres.
fn force(bed: &mut Bed<f64>) -> [f64; 3] {
    bed.snapshot().unwrap().contacts.first().map_or([0.0; 3], |contact| contact.force)
}

#[test]
fn a_bond_pulls_by_its_stiffness_until_it_is_torn() {
    let mut bed = drawn([0.0, 0.0, -0.01]);
    bed.run(5000).unwrap();
    // 50 um apart; the contact has lost its overlap of 10 um
    let pull = -force(&mut bed)[2];
    assert!((pull / (GLUE.normal_stiffness * 50e-6) - 1.0).abs() < 1e-6, "{pull}");
    // broken in tension at 100 um
    bed.run(4990).unwrap();
    assert_eq!((bed.bonds(), bed.broken_bonds()), (1, 0));
    bed.run(20).unwrap();
    assert_eq!((bed.bonds(), bed.broken_bonds()), (0, 1));
    assert!(bed.snapshot().unwrap().contacts.is_empty());
}

#[test]
fn a_broken_bond_does_not_come_back() {
    let mut bed = drawn([0.0, 0.0, -0.01]);
    bed.run(10_100).unwrap();
    bed.set_velocity(BodyId(1), [0.0, 0.0, 0.01], [0.0; 3]);
    bed.run(11_100).unwrap();
    // 10 um nearer than at the start: the contact alone
    let push = force(&mut bed)[2];
    assert!((push / (STIFF * 20e-6) - 1.0).abs() < 1e-4, "{push}");
    assert_eq!(bed.broken_bonds(), 1);
}

#[test]
fn a_bond_shears_by_its_stiffness_until_it_is_cut() {
    let mut bed = drawn([0.01, 0.0, 0.0]);
    bed.run(5000).unwrap();
    let drag = force(&mut bed)[0];
    assert!((drag / (GLUE.shear_stiffness * 50e-6) - 1.0).abs() < 1e-3, "{drag}");
    // broken in shear at 75 um
    bed.run(2450).unwrap();
    assert_eq!(bed.broken_bonds(), 0);
    bed.run(100).unwrap();
    assert_eq!(bed.broken_bonds(), 1);
}

#[test]
fn a_chain_hangs_by_its_bonds_as_springs_in_series_do() {
    let mut bed = glued(chain(5), GLUE);
    bed.fix(BodyId(0));
    bed.set_gravity(Gravity::EARTH);
    bed.set_damping(0.7);
    let before = bed.body_state(BodyId(4)).place[2];
    bed.run(40_000).unwrap();
    let weight = 9.81 * bed.body_state(BodyId(1)).mass;
    // the contact deforms under the weight in parallel to the bond, and stays closed: 10 um are 130 N
    let pulled: f64 = (1..5).map(|below| f64::from(below) * weight / (GLUE.normal_stiffness + STIFF)).sum();
    let start = 4.0 * OVERLAP * STIFF / (GLUE.normal_stiffness + STIFF);
    let sunk = before - bed.body_state(BodyId(4)).place[2];
    assert!((sunk / (start + pulled) - 1.0).abs() < 1e-4, "{sunk} {}", start + pulled);
}

#[test]
fn energy_is_kept_until_a_bond_breaks_and_what_it_held_is_lost() {
    let swinging = |speed: f64, steps: u64| {
        let mut bed = glued(chain(2), GLUE);
        bed.set_time_step(2e-7);
        bed.watch_energy(true);
        bed.fix(BodyId(0));
        bed.set_velocity(BodyId(1), [0.0, 0.0, -speed], [0.0; 3]);
        bed.run(steps).unwrap();
        bed
    };
    let kept = swinging(0.05, 20_000);
    let energy = kept.energy();
    assert!(energy.slip == 0.0 && (energy.kinetic() + energy.strain) / energy.start < 1.0 + 1e-3, "{energy:?}");
    assert!((energy.kinetic() + energy.strain) / energy.start > 1.0 - 1e-3, "{energy:?}");
    let torn = swinging(2.0, 2_000);
    let energy = torn.energy();
    let at_most = 0.5 * GLUE.tensile_strength.powi(2) / GLUE.normal_stiffness;
    assert_eq!(torn.broken_bonds(), 1);
    assert!((energy.slip / at_most - 1.0).abs() < 0.02, "{} {at_most}", energy.slip);
    assert!(((energy.kinetic() + energy.strain + energy.slip) / energy.start - 1.0).abs() < 1e-3, "{energy:?}");
}

#[test]
fn the_stable_step_knows_of_bonds() {
    let mut loose = chain(2);
    // both springs count: a pair is stable if the stiffer of its two directions is stable
    let mut bound = glued(chain(2), Glue { shear_stiffness: GLUE.normal_stiffness, ..GLUE });
    let [loose, bound] = [&mut loose, &mut bound].map(|bed| bed.critical_step(0.0).unwrap().network.step);
    let stiffer = (1.0 + GLUE.normal_stiffness / STIFF).sqrt();
    assert!((loose / bound / stiffer - 1.0).abs() < 0.02, "{loose} {bound} {stiffer}");
}

/// A wall of spheres that falls on a floor, weakly glued side by side: these bonds break, and the bonds of the columns
/// hold.
fn heap() -> Bed<f32> {
    let mut bed: Bed<f32> = Bed::new(Domain::open(), law(0.5));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    for (column, row) in (0..6).flat_map(|column| (0..4).map(move |row| (column, row))) {
        let [x, z] = [column, row].map(|at| f64::from(at) * (2.0 * RADIUS - OVERLAP));
        bed.add_sphere(&Sphere {
            centre: [x + 0.0005 * f64::from(row % 2), 0.0, z + 0.05],
            radius: RADIUS,
            density: 2700.0,
            surface: 0,
        });
    }
    bed.set_gravity(Gravity::EARTH);
    bed.set_time_step(5e-6);
    let weak = Glue { tensile_strength: 1.0, shear_strength: 1.0, ..GLUE };
    let lies = |contact: &ContactState| contact.normal[2].abs() < 0.5;
    let of_grains = |contact: &ContactState| matches!(contact.second, Party::Body(..));
    bed.glue(vec![weak, GLUE], |contact| of_grains(contact).then_some(u16::from(!lies(contact)))).unwrap();
    bed
}

fn places(bed: &Bed<f32>) -> Vec<[f64; 3]> {
    bed.states().map(|state| state.place).collect()
}

#[test]
fn looks_resumes_and_lists_change_no_bit() {
    let mut straight = heap();
    straight.run(20_000).unwrap();
    let broken = straight.broken_bonds();
    assert!(broken > 0 && straight.bonds() > 0, "{broken} broken, {} hold", straight.bonds());
    let mut halted = heap();
    halted.run(9_000).unwrap();
    halted.snapshot().unwrap();
    let mut resumed: Bed<f32> = Bed::restore(halted.checkpoint()).unwrap();
    resumed.lists.fixed_skin = Some(2e-3);
    resumed.run(11_000).unwrap();
    assert_eq!(places(&resumed), places(&straight));
    assert_eq!((resumed.bonds(), resumed.broken_bonds()), (straight.bonds(), broken));
}

#[test]
fn bonds_of_those_that_stay_hold_when_others_are_taken_out() {
    let mut bed = glued(chain(4), GLUE);
    bed.remove(|body| body == BodyId(0)).unwrap();
    assert_eq!(bed.bonds(), 2);
    bed.fix(BodyId(0));
    bed.set_gravity(Gravity::EARTH);
    bed.run(1000).unwrap();
    assert_eq!(bed.bonds(), 2);
}

#[test]
fn glue_that_cannot_be_is_told_before_anything_moves() {
    let mut bed = chain(2);
    bed.glue(vec![Glue { tensile_strength: -1.0, ..GLUE }], |_| Some(0)).unwrap();
    let told = bed.step().unwrap_err().to_string();
    assert!(told.contains("tensile strength of a bond"), "{told}");
}
