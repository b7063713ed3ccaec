//! Glue in a bed under a sleeper.

use super::*;
use crate::solvers::granular::Glue;

fn glued(strength: f64) -> Rig {
    let glue =
        Glue { normal_stiffness: 13e6, shear_stiffness: 13e6, tensile_strength: strength, shear_strength: strength };
    Rig { glued: vec![Glued { surface: 0, along: None, glue }], ..cyclic(3) }
}

#[test]
fn glue_makes_a_bed_stiffer_and_it_settles_less() {
    let (loose, bound) = (cyclic(3), glued(1e3));
    let (loose, bound) = (run(&loose), run(&bound));
    let last = |trial: &Trial<'_, f32>| *trial.cycles().last().unwrap();
    assert!(last(&bound).stiffness > 1.2 * last(&loose).stiffness, "{:?} {:?}", last(&bound), last(&loose));
    assert!(last(&bound).settlement < 0.7 * last(&loose).settlement, "{:?} {:?}", last(&bound), last(&loose));
    assert_eq!(bound.bed.broken_bonds(), 0, "a kilonewton is not reached under 20 kN on a sleeper");
}

#[test]
fn weak_glue_breaks_and_leaves_the_bed_as_without() {
    let (loose, weak) = (cyclic(3), glued(1.0));
    let (loose, weak) = (run(&loose), run(&weak));
    assert!(weak.bed.broken_bonds() > 0);
    let [bound, free] = [&weak, &loose].map(|trial| trial.cycles().last().unwrap().stiffness);
    assert!((bound / free - 1.0).abs() < 0.3, "{bound} {free}");
}

#[test]
fn glue_holds_between_two_places_only() {
    let mut bed = bed();
    let parts = Glued { along: Some([0.0, 0.2]), ..glued(1e3).glued[0] };
    let some = glue(&mut bed, &[parts]).unwrap();
    let all = glue(&mut bed, &[Glued { along: None, ..parts }]).unwrap();
    assert!(some > 0 && some < all / 2, "{some} of {all}");
    assert_eq!(glue(&mut bed, &[Glued { surface: 1, ..parts }]).unwrap(), 0, "no grains of that layer");
}
