//! Plates on beds whose stiffness has a closed form, and invalid plates.

use super::super::law::{ContactLaws, DashpotMode, Surface};
use super::super::measure::packed::{bed, recipe};
use super::super::packing::Packed;
use super::super::{Domain, Sphere};
use super::*;

const RADIUS: f64 = 0.03;
const SIDE: f64 = 0.5;
/// Stiffness of a contact with floor and plate, N/m.
const CONTACT: f64 = 1e7;

/// Sixteen spheres in a square on a floor, apart from each other.
fn studs() -> Bed<f64> {
    let surface = Surface {
        normal_stiffness: 2.0 * CONTACT,
        shear_stiffness: 2.0 * CONTACT,
        friction: 0.5,
        damping: [0.3; 2],
        mode: DashpotMode::default(),
    };
    let mut bed = Bed::new(Domain::open().periodic(0, SIDE).periodic(1, SIDE), ContactLaws::from_surfaces(&[surface]));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    for k in 0..16 {
        let at = |n: i32| (f64::from(n) + 0.5) * SIDE / 4.0;
        bed.add_sphere(&Sphere { centre: [at(k % 4), at(k / 4), RADIUS], radius: RADIUS, density: 2700.0, surface: 0 });
    }
    bed.set_time_step(2e-5);
    bed
}

fn plate(outline: Outline, centre: [f64; 2]) -> Plate {
    Plate { outline, centre, pressure: 50e3, surface: 0, rest: Stillness::default() }
}

#[test]
fn studs_are_springs_under_every_plate() {
    let middle = [0.5 * SIDE; 2];
    let eighth = SIDE / 8.0;
    for (outline, centre, studs_under) in [
        (Outline::Whole { area: SIDE * SIDE }, middle, 16.0),
        (Outline::Rectangle { length: 0.2, width: 0.2 }, middle, 4.0),
        (Outline::Rectangle { length: 0.06, width: 0.4 }, [3.0 * eighth, 0.5 * SIDE], 4.0),
        // across the border of the period
        (Outline::Rectangle { length: 0.2, width: 0.06 }, [0.0, eighth], 2.0),
        (Outline::Circle { radius: 0.05 }, [eighth, 5.0 * eighth], 1.0),
    ] {
        let found =
            probe(&studs(), &plate(outline, centre), |_, _, _| ()).unwrap_or_else(|e| panic!("{outline:?}: {e}"));
        // floor and plate are two springs in series
        let expected = studs_under * CONTACT / 2.0;
        for stiffness in [found.first, found.again] {
            assert!((stiffness / expected - 1.0).abs() < 1e-3, "{outline:?}: {stiffness} and {expected}");
        }
        let last = found.curve.last().unwrap();
        assert!(last.settlement.abs() < 1e-3 * found.curve[4].settlement, "an elastic bed comes back: {last:?}");
    }
}

#[test]
fn moduli_are_those_of_the_standard_and_of_boussinesq() {
    // DIN 18134: E = 1.5 r Δσ/Δs, with 100 kPa on 1 mm under a plate of 300 mm
    let circle = Outline::Circle { radius: 0.15 };
    let modulus = circle.modulus(100e3 * circle.area() / 1e-3).unwrap();
    assert!((modulus / (1.5 * 0.15 * 100e3 / 1e-3) - 1.0).abs() < 1e-12, "{modulus}");
    // a rigid plate is a charged lamina: F (1 - ν²)/(E s √A) is π times its capacity divided by √A. For a square it is
    // 0.36679, for an ellipse of 5 to 1 a/K(e) = 0.41825, which is close to the value of the rectangle
    for (ratio, capacity) in [(1.0_f64, 0.36679), (5.0, 0.41825)] {
        let outline = Outline::Rectangle { length: ratio, width: 1.0 };
        let found = 3.0 / PI / (outline.modulus(1.0).unwrap() * ratio.sqrt());
        assert!((found / (PI * capacity) - 1.0).abs() < 0.02, "{ratio}: {found}");
    }
    assert_eq!(Outline::Whole { area: 1.0 }.modulus(1e8), None);
}

#[test]
fn plates_that_are_none_are_refused() {
    let bed = studs();
    let refused = |plate: &Plate| probe(&bed, plate, |_, _, _| ()).unwrap_err();
    let good = plate(Outline::Rectangle { length: 0.2, width: 0.2 }, [0.25; 2]);
    assert_eq!(refused(&Plate { pressure: 0.0, ..good }), ProbeError::Plate);
    assert_eq!(refused(&Plate { surface: 1, ..good }), ProbeError::Plate);
    assert_eq!(refused(&Plate { outline: Outline::Circle { radius: f64::NAN }, ..good }), ProbeError::Plate);
    let wide = Outline::Rectangle { length: 0.2, width: 0.46 };
    assert!(matches!(refused(&Plate { outline: wide, ..good }), ProbeError::WidePlate { .. }));
    let between = plate(Outline::Rectangle { length: 0.04, width: 0.04 }, [0.25; 2]);
    assert_eq!(refused(&between), ProbeError::Nothing);
    let soft = Plate { rest: Stillness { deepest: 1e-6, ..Stillness::default() }, ..good };
    let error = refused(&soft);
    assert!(matches!(error, ProbeError::Sunk { .. }), "{error}");
    let hasty = Plate { rest: Stillness { longest: 1e-3, ..Stillness::default() }, ..good };
    let error = refused(&hasty);
    assert!(
        matches!(error, ProbeError::Restless { .. }) && error.to_string().contains("is not at rest after"),
        "{error}"
    );
}

#[test]
fn a_packed_bed_is_stiffer_the_second_time_and_stays_as_it_was() {
    let (recipe, packed) = (recipe(), bed());
    let before: Vec<_> = packed.bed.states().collect();
    let whole = Outline::Whole { area: packed.area() };
    let pressed = Plate { surface: recipe.wall_surface(), ..plate(whole, [0.15; 2]) };
    let test = || probe(&packed.bed, &pressed, |_, _, _| ()).unwrap_or_else(|error| panic!("{error}"));
    let found = test();
    assert!(found.again > found.first && found.first > 0.0, "{found:?}");
    // a settlement remains, and the rebound is smaller than the total
    let (full, back) = (found.curve[4].settlement, found.curve[6].settlement);
    assert!(0.0 < back && back < full, "{found:?}");
    assert_eq!(before, packed.bed.states().collect::<Vec<_>>());
    assert_eq!(found, test());
    // a stored bed gives the same result as the original bed
    let kept = Packed::<f32>::restore(packed.store()).unwrap();
    assert_eq!(found, probe(&kept.bed, &pressed, |_, _, _| ()).unwrap());
}

#[test]
fn a_stricter_measure_of_rest_gives_the_same_stiffness() {
    let (recipe, packed) = (recipe(), bed());
    let whole = Outline::Whole { area: packed.area() };
    let [usual, strict] = [2e-3, 2e-4].map(|unbalance| {
        let rest = Stillness { unbalance, longest: 4.0, ..Stillness::default() };
        let pressed = Plate { surface: recipe.wall_surface(), rest, ..plate(whole, [0.15; 2]) };
        probe(&packed.bed, &pressed, |_, _, _| ()).unwrap_or_else(|error| panic!("{error}"))
    });
    // a few spheres slip in a different order on every path: up to 8 % at first loading, 1 % at second loading
    assert!((usual.first / strict.first - 1.0).abs() < 0.12, "{usual:?} and {strict:?}");
    assert!((usual.again / strict.again - 1.0).abs() < 0.05, "{usual:?} and {strict:?}");
}
