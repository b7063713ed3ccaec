//! Beds that are packed, and recipes that are refused.

use super::super::bed::Bed;
use super::super::clump::Template;
use super::super::grains::{Curve, Random, grains};
use super::super::law::{DashpotMode, Surface};
use super::*;

/// Spheres of 32 to 50 mm in a small cell.
fn small() -> Recipe {
    let surface = Surface {
        normal_stiffness: 2.6e7,
        shear_stiffness: 2.6e7,
        friction: 0.7,
        damping: [0.3; 2],
        mode: DashpotMode::default(),
    };
    let layer = GrainLayer {
        name: "ballast".into(),
        curve: Curve::new(&[[0.032, 0.0], [0.05, 1.0]]).unwrap(),
        templates: vec![Template::sphere(0.5).unwrap()],
        density: 2700.0,
        surface,
        wall_friction: 0.7,
        thickness: 0.2,
        lifts: 2,
        pressure: 200e3,
        packing: Packing { friction: 0.0, local_damping: 0.7, viscous_damping: 0.0 },
    };
    Recipe {
        plan: [0.3, 0.3],
        walls: false,
        ends: false,
        layers: vec![layer],
        gravity: 9.81,
        local_damping: 0.2,
        restored: Default::default(),
        reloads: 0,
        rest: Rest::default(),
        seed: 1,
    }
}

fn packed(recipe: &Recipe) -> Packed<f32> {
    pack(recipe, |_| ()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_small_bed_is_dense_level_and_at_rest() {
    let recipe = small();
    let packed = packed(&recipe);
    let last = packed.stages.last().unwrap();
    assert!(last.state.unbalance <= recipe.rest.bed);
    assert!((packed.levels[0] / 0.2 - 1.0).abs() < 0.03, "{:?}", packed.levels);
    let porosity = packed.porosity([0.04, 0.16]);
    // random close packing of spheres of like sizes: 0.36; walls loosen it
    assert!((0.34..0.42).contains(&porosity), "{porosity}");
    // isostatic without friction: six neighbours, fewer at floor and plate; unloading opens contacts
    let z = |name: &str| {
        packed
            .stages
            .iter()
            .find(|stage| stage.name == name)
            .map(|stage| stage.state.layers[0].without_rattlers)
            .unwrap()
    };
    let [pressed, restored, lifted] = ["ballast, lift 2 of 2", "friction restored", "plate lifted"].map(z);
    assert!((5.3..6.5).contains(&pressed), "{pressed}");
    assert!((restored / pressed - 1.0).abs() < 0.05, "{pressed} and {restored}");
    assert!((3.5..pressed).contains(&lifted), "{pressed} and {lifted}");
}

/// The time at which friction is restored: the lower the pressure of the plate then, the more contacts stay after the
/// plate is removed; without load the bed becomes slightly denser.
#[test]
fn friction_comes_back_when_the_recipe_says() {
    let of = |restored| {
        let packed = packed(&Recipe { restored, ..small() });
        let names: Vec<String> = packed.stages[2..].iter().map(|stage| stage.name.clone()).collect();
        let last = packed.stages.last().unwrap();
        assert!(last.state.unbalance <= small().rest.bed, "{names:?}");
        (names, packed.porosity([0.04, 0.16]), last.state.layers[0].coordination)
    };
    let [pressed, eased, unloaded] = [Restored::Pressed, Restored::Eased, Restored::Unloaded].map(of);
    assert_eq!(pressed.0, ["friction restored", "plate eased", "plate lifted"]);
    assert_eq!(eased.0, ["plate eased", "friction restored", "plate lifted"]);
    assert_eq!(unloaded.0, ["plate eased", "plate lifted", "friction restored"]);
    assert!((pressed.1 - eased.1).abs() < 3e-3 && unloaded.1 < eased.1, "{pressed:?} {eased:?} {unloaded:?}");
    assert!(pressed.2 < 0.9 * eased.2 && eased.2 < 0.95 * unloaded.2, "{pressed:?} {eased:?} {unloaded:?}");
}

/// A bed loaded again under the pressure of its packing settles a little, once.
#[test]
fn the_plate_loads_a_finished_bed_again() {
    let recipe = Recipe { restored: Restored::Pressed, reloads: 2, ..small() };
    let packed = packed(&recipe);
    let again: Vec<_> = packed.stages[5..].iter().map(|stage| (stage.name.as_str(), stage.level)).collect();
    let names =
        ["loaded again, 1 of 2", "plate eased", "plate lifted", "loaded again, 2 of 2", "plate eased", "plate lifted"];
    assert_eq!(again.iter().map(|(name, _)| *name).collect::<Vec<_>>(), names);
    for stage in packed.stages.iter().filter(|stage| stage.name.starts_with("loaded")) {
        assert!(
            (stage.pressure / recipe.layers[0].pressure - 1.0).abs() < 0.02,
            "{}: {} Pa",
            stage.name,
            stage.pressure
        );
    }
    let [eased, once, twice] = [packed.stages[3].level, again[1].1, again[4].1].map(Option::unwrap);
    let sunk = [eased - once, once - twice];
    assert!(sunk[0] > 0.0 && sunk[0] < 0.05 * recipe.layers[0].thickness, "{sunk:?} m");
    assert!(sunk[1].abs() < sunk[0], "{sunk:?} m");
}

/// Spheres and clumps, between two and four grains thick, with and without walls, with and without friction: one lift
/// has only the first estimate.
#[test]
fn a_layer_of_one_lift_is_as_thick_as_asked() {
    let clumps = super::super::grains::ClumpShape::default().templates(1).unwrap();
    let spheres = small().layers[0].templates.clone();
    for (templates, thickness, walls, friction) in
        [(&clumps, 0.2, false, 0.0), (&spheres, 0.1, true, 0.0), (&clumps, 0.15, false, 0.2)]
    {
        let mut recipe = Recipe { walls, ..small() };
        let layer = &mut recipe.layers[0];
        (layer.lifts, layer.thickness, layer.templates) = (1, thickness, templates.clone());
        layer.packing.friction = friction;
        let level = packed(&recipe).levels[0];
        assert!((level / thickness - 1.0).abs() < 0.04, "{level} of {thickness} with friction {friction}");
    }
}

#[test]
fn lifts_are_as_thick_as_the_largest_grain() {
    let with = |thickness, lifts| GrainLayer { thickness, lifts, ..small().layers[0].clone() }.lifts_that_fit();
    assert_eq!([with(0.2, 2), with(0.2, 4), with(0.2, 5), with(0.149, 5), with(0.05, 3)], [2, 4, 4, 2, 1]);
}

#[test]
fn a_bed_that_moves_on_is_refused() {
    let short = Rest { longest: 0.02, ..Rest::default() };
    let outcome = |recipe: &Recipe| pack::<f32, _>(recipe, |_| ()).err().unwrap();
    // the plate comes down, but there is no time to press
    let error = outcome(&Recipe { rest: short, ..small() });
    assert!(matches!(&error, PackingError::Pressure { reached, target, .. } if reached < target), "{error}");
    assert!(error.to_string().contains("ballast, lift 1 of 2: the pressure of the plate is"), "{error}");
    // a limit near zero for the force out of balance
    let strict = Rest { longest: 0.3, lift: 1e-12, ..Rest::default() };
    let error = outcome(&Recipe { rest: strict, ..small() });
    assert!(matches!(error, PackingError::Restless { .. } | PackingError::Pressure { .. }), "{error}");
}

#[test]
fn recipes_that_make_no_bed_are_refused() {
    let with = |change: &dyn Fn(&mut Recipe)| {
        let mut recipe = small();
        change(&mut recipe);
        recipe.check().unwrap_err().to_string()
    };
    for (change, why) in [
        (&(|r: &mut Recipe| r.layers.clear()) as &dyn Fn(&mut Recipe), "no layer"),
        (&|r| r.plan[1] = 0.0, "side of the cell is 0"),
        (&|r| r.plan[0] = 0.1, "more than a third of the cell side of 100 mm"),
        (&|r| r.layers[0].thickness = 0.04, "thinner than its largest grain of 50 mm"),
        (&|r| r.layers[0].lifts = 0, "number of lifts"),
        (&|r| r.layers[0].pressure = -1.0, "pressure of layer `ballast` is -1"),
        (&|r| r.layers[0].templates.clear(), "number of templates"),
        (&|r| r.layers[0].surface.normal_stiffness = 0.0, "normal stiffness"),
        (&|r| r.local_damping = 1.0, "local damping is 1"),
        (&|r| r.rest.bed = f64::NAN, "force out of balance of the bed is NaN"),
    ] {
        let error = with(change);
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn loose_grains_touch_nothing() {
    let shape = super::super::grains::ClumpShape::default();
    let templates = shape.templates(3).unwrap();
    let curve = Curve::new(&[[0.03, 0.0], [0.06, 1.0]]).unwrap();
    let sample = curve.sample(0.01, 1).unwrap();
    let copies = grains(&sample, templates.len(), 1);
    for periodic in [false, true] {
        let room = place::Room {
            plan: [0.3, 0.35],
            periodic: [true, periodic],
            base: 0.1,
            area: 0.3 * 0.35,
            free: &|_, _| true,
        };
        let (loose, top) = place::set_loose(&copies, &templates, &room, &mut Random::new(7, 0)).unwrap();
        assert_eq!(loose.len(), copies.len());
        let pebbles: Vec<(usize, nalgebra::Vector3<f64>, f64)> = loose
            .iter()
            .enumerate()
            .flat_map(|(k, grain)| {
                let centre = nalgebra::Vector3::from(grain.centre);
                grain.template.pebbles.iter().map(move |p| (k, centre + grain.attitude * p.centre, p.radius))
            })
            .collect();
        let around = |d: f64, period: f64| d - period * (d / period).round();
        for (k, place, radius) in &pebbles {
            assert!(place.z - radius >= 0.1 - 1e-12 && place.z + radius <= top + 1e-12);
            assert!(periodic || (place.y - radius >= -1e-12 && place.y + radius <= 0.35 + 1e-12));
            for (other, there, reach) in pebbles.iter().filter(|(other, ..)| other > k) {
                let d = place - there;
                let y = if periodic { around(d.y, 0.35) } else { d.y };
                let distance = (around(d.x, 0.3).powi(2) + y * y + d.z * d.z).sqrt();
                assert!(distance >= radius + reach - 1e-12, "{k} and {other}: {distance}");
            }
        }
    }
}

#[test]
fn cells_side_by_side_keep_their_forces() {
    let mut packed = packed(&small());
    let mut bays = packed.bed.replicate(3).unwrap();
    let mut open = Bed::side_by_side(std::slice::from_mut(&mut packed.bed), &[0, 0, 0], 0, |_, _| true).unwrap();
    assert_eq!(open.len(), bays.len());
    let forces = |bed: &mut Bed<f32>| {
        let mut all: Vec<_> = bed.snapshot().unwrap().contacts;
        all.sort_by_key(|contact| (contact.first, contact.second));
        all
    };
    let (closed, open) = (forces(&mut bays), forces(&mut open));
    // the missing contacts are between the first and the last bay
    let inside: Vec<_> =
        closed.iter().filter(|c| open.iter().any(|o| (o.first, o.second) == (c.first, c.second))).collect();
    assert_eq!(inside.len(), open.len());
    assert!(open.len() < closed.len() && open.len() > closed.len() * 9 / 10, "{} of {}", open.len(), closed.len());
    for (a, b) in inside.iter().zip(&open) {
        assert_eq!((a.force, a.overlap), (b.force, b.overlap));
    }
}

#[test]
fn unlike_cells_come_to_rest_between_walls() {
    let recipe = Recipe { rest: Rest { bed: 5e-3, ..Rest::default() }, ..small() };
    let cells = [packed(&recipe), packed(&Recipe { seed: 2, ..recipe.clone() })];
    let order = Order(vec![0, 1]);
    let laid = lay(&cells, &order, &recipe, |_| ()).unwrap_or_else(|error| panic!("{error}"));
    let account = &laid.account;
    assert!(account.unbalance <= recipe.rest.lift && account.bodies + account.held_at_ends == laid.bed.len());
    assert!(account.held_at_ends > 0 && account.removed_at_seams > 0 && account.removed_mass < 0.15, "{account:?}");
    let mut bed = laid.bed;
    let still = bed.states().filter(|body| body.velocity == [0.0; 3]).count();
    assert!(still >= account.held_at_ends);
    let deepest = bed.snapshot().unwrap().contacts.iter().map(|c| c.overlap).fold(0.0, f64::max);
    assert!(deepest < 1e-4, "{deepest}");
    // the same bits with one thread
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let again = pool.install(|| lay(&cells, &order, &recipe, |_| ())).unwrap();
    assert!(again.bed.states().eq(bed.states()));
}

#[test]
fn copies_of_a_cell_need_no_room_between_them() {
    let recipe = Recipe { rest: Rest { bed: 5e-3, ..Rest::default() }, ..small() };
    let cell = packed(&recipe);
    let count = cell.bed.len();
    let laid = lay(&[cell], &Order::of_one(2), &recipe, |_| ()).unwrap_or_else(|error| panic!("{error}"));
    let TrackAccount { bodies, held_at_ends, removed_at_seams, steps, .. } = laid.account;
    // they are at rest in their packed positions
    assert_eq!((bodies, removed_at_seams, steps), (2 * count, 0, 0));
    assert!(held_at_ends > 0);
}

#[test]
fn every_cell_has_its_turn() {
    let Order(order) = Order::mixed(3, 40, 5);
    assert_eq!(order.len(), 40);
    for turn in order.chunks(3).filter(|turn| turn.len() == 3) {
        let mut turn = turn.to_vec();
        turn.sort();
        assert_eq!(turn, [0, 1, 2]);
    }
}

/// Data read from a disk may lack a list; they are refused or as good as before.
#[test]
fn a_bed_that_lost_a_list_is_refused() {
    let whole = serde_json::to_value(packed(&small()).store()).unwrap();
    let mut refused = 0;
    for list in lists(&whole) {
        let mut lacking = whole.clone();
        *lacking.pointer_mut(&list).unwrap() = serde_json::json!([]);
        let Ok(stored) = serde_json::from_value::<StoredBed<f32>>(lacking) else { continue };
        match Packed::restore(stored) {
            Err(_) => refused += 1,
            Ok(mut packed) => {
                packed.pressed_and_at_rest();
                packed.porosity(packed.between(0));
                packed.bed.snapshot().unwrap();
            }
        }
    }
    assert!(refused > 8, "{refused}");
}

/// Pointers to every list of a value; of equal neighbours in a list only the first.
pub(in super::super) fn lists(value: &serde_json::Value) -> Vec<String> {
    let below = |name: String, value: &serde_json::Value| {
        lists(value).into_iter().map(move |rest| format!("/{name}{rest}")).collect::<Vec<_>>()
    };
    match value {
        serde_json::Value::Object(fields) => {
            fields.iter().flat_map(|(name, value)| below(name.clone(), value)).collect()
        }
        serde_json::Value::Array(items) => {
            let inner = items.first().into_iter().flat_map(|first| below("0".to_owned(), first));
            std::iter::once(String::new()).chain(inner).collect()
        }
        _ => Vec::new(),
    }
}
