//! Beds that are packed, and what refuses to be one.

use super::super::law::DashpotMode;
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
    let layer = Layer {
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
        layers: vec![layer],
        gravity: 9.81,
        local_damping: 0.2,
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
    // a lift is measured before it is quite at rest, and gives way a little more later
    assert!((packed.levels[0] / 0.2 - 1.0).abs() < 0.08, "{:?}", packed.levels);
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
    let [pressed, restored, lifted] = ["pressed", "friction restored", "plate lifted"].map(z);
    assert!((5.3..6.5).contains(&pressed), "{pressed}");
    assert!((restored / pressed - 1.0).abs() < 0.05, "{pressed} and {restored}");
    assert!((3.5..pressed).contains(&lifted), "{pressed} and {lifted}");
}

#[test]
fn a_bed_that_moves_on_is_refused() {
    let short = Rest { longest: 0.02, ..Rest::default() };
    let outcome = |recipe: &Recipe| pack::<f32>(recipe, |_| ()).err().unwrap();
    // the plate comes down, and there is no time to press
    let error = outcome(&Recipe { rest: short, ..small() });
    assert!(matches!(&error, PackingError::Pressure { reached, target, .. } if reached < target), "{error}");
    assert!(error.to_string().contains("ballast, lift 1 of 2: the plate stands at"), "{error}");
    // forces that must all but vanish
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
        (&|r| r.plan[0] = 0.1, "more than a third of the cell's 100 mm"),
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
        let room = place::Room { length: 0.3, width: 0.35, periodic, base: 0.1 };
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
