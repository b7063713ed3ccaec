//! Grains between and beside a sleeper: their positions, their rest, and results independent of the number of threads.

use super::super::pocket::Pocket;
use super::*;
use crate::solvers::granular::{Party, WallId};

const CRIB: Crib = Crib { height: 0.12, shoulder: 0.1 };

/// The small bed with a sleeper of 0.3 m x 1 m (half of it stands on the bed) and its cribs filled.
fn filled(crib: Crib) -> (Bed<f32>, Sleeper, WallId, Filling) {
    let recipe = recipe([0.6; 2], 0.2, [0.05, 0.07], 0.7, false);
    let filling = crib.filling(&recipe, 1).unwrap();
    let sleeper = Sleeper { place: [0.3, 0.0], size: [0.3, 1.0, 0.2], mass: 150.0, load: Load::None };
    let mut bed = bed();
    let walls = stand(&mut bed, std::slice::from_ref(&sleeper), 9.81, |_| {}).unwrap();
    let mut told = Vec::new();
    fill(&mut bed, (std::slice::from_ref(&sleeper), &walls), &filling, |share| told.push(share)).unwrap();
    assert!(told.is_sorted() && told.last() == Some(&1.0), "{told:?}");
    (bed, sleeper, walls[0], filling)
}

#[test]
fn grains_fill_the_crib_to_its_height_and_rest_beside_the_sleeper() {
    let alone = super::bed().len();
    let (mut bed, sleeper, wall, filling) = filled(CRIB);
    assert!(bed.len() > alone + 100, "{} grains more", bed.len() - alone);
    let pocket = Pocket::around(&bed, &[sleeper], &[wall], &filling);
    // between the sleeper and its image, and beyond its end
    assert!((pocket.area - (0.3 * 0.5 + 0.6 * 0.1)).abs() < 0.01, "{}", pocket.area);
    let level = pocket.underside + CRIB.height;
    let poured: Vec<_> = bed.states().skip(alone).collect();
    let highest = poured.iter().map(|grain| grain.place[2]).fold(0.0, f64::max);
    assert!(highest < level + 1e-3 && highest > level - 0.02, "{highest} {level}");
    // on the flat bed coarse spheres lie in layers 0.8 of their size apart, and the last one fits or does not
    let open = pocket.empty(&bed, CRIB.height) / (pocket.area * CRIB.height);
    assert!(open * CRIB.height < 0.8 * 0.06, "{open} of the space lies above the grains");
    // all grains but a few that roll off the edge of the shoulder or under the sleeper lie in the pocket
    let outside = poured.iter().filter(|grain| !pocket.holds([grain.place[0], grain.place[1]], 0.0)).count();
    assert!(outside * 50 < poured.len(), "{outside} of {}", poured.len());
    let solid: f64 = poured.iter().map(|grain| grain.mass / 2700.0).sum();
    let porosity = 1.0 - solid / (pocket.area * CRIB.height * (1.0 - open));
    assert!((0.3..0.6).contains(&porosity), "{porosity}");

    let snapshot = bed.snapshot().unwrap();
    let deepest = snapshot.contacts.iter().map(|contact| contact.overlap).fold(0.0, f64::max);
    assert!(deepest < 0.02 * 0.025, "{deepest} m");
    // grains of the crib touch the sides of the sleeper
    let beside = snapshot.contacts.iter().filter(|contact| {
        let on_sleeper =
            [contact.first, contact.second].iter().any(|party| matches!(party, Party::Wall(w) if *w == wall));
        on_sleeper && contact.normal[2].abs() < 0.1
    });
    assert!(beside.count() > 5, "few grains touch the sides of the sleeper");
    // the force on the walls is the weight of all grains, except for the 0.2 % of all contact forces that may be out of
    // balance
    let weight = 9.81 * bed.states().map(|grain| grain.mass).sum::<f64>();
    let felt: f64 = bed.walls().iter().map(|wall| wall.felt().force.z).sum();
    assert!((felt / -weight - 1.0).abs() < 0.02, "{felt} N for {weight} N");
    let carried = bed.wall(wall).felt().force.z / (150.0 * 9.81);
    assert!((carried - 1.0).abs() < 0.011, "{carried}");
}

#[test]
fn without_a_shoulder_nothing_is_poured_beyond_the_end() {
    let (bed, sleeper, wall, filling) = filled(Crib { shoulder: 0.0, ..CRIB });
    let pocket = Pocket::around(&bed, &[sleeper], &[wall], &filling);
    assert!((pocket.area - 0.3 * 0.5).abs() < 0.01, "{}", pocket.area);
    assert!(!pocket.holds([0.05, 0.52], 0.0) && pocket.holds([0.05, 0.45], 0.03) && !pocket.holds([0.2, 0.2], 0.0));
}

#[test]
fn threads_change_no_bit_of_a_filled_crib() {
    let states = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| filled(CRIB).0.states().collect::<Vec<_>>())
    };
    assert!(states(1) == states(2));
}

#[test]
fn a_crib_too_narrow_for_its_grains_is_told() {
    let recipe = recipe([0.6; 2], 0.2, [0.05, 0.07], 0.7, false);
    let filling = Crib { shoulder: 0.0, ..CRIB }.filling(&recipe, 1).unwrap();
    let sleeper = Sleeper { place: [0.3, 0.0], size: [0.57, 1.2, 0.2], mass: 150.0, load: Load::None };
    let mut bed = super::bed();
    let walls = stand(&mut bed, std::slice::from_ref(&sleeper), 9.81, |_| {}).unwrap();
    let error = fill(&mut bed, (&[sleeper], &walls), &filling, |_| {}).unwrap_err();
    assert!(
        error == RigError::NoRoom { layer: "stone".into() } && error.to_string().contains("is too large for the space"),
        "{error}"
    );
}
