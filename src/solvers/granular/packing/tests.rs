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
    for stage in &packed.stages {
        eprintln!("{stage:?}");
    }
    let last = packed.stages.last().unwrap();
    assert!(last.state.unbalance <= recipe.rest.bed);
    assert!((packed.levels[0] / 0.2 - 1.0).abs() < 0.05, "{:?}", packed.levels);
    let porosity = packed.porosity([0.04, 0.16]);
    // random close packing of spheres of like sizes: 0.36; walls loosen it
    assert!((0.34..0.42).contains(&porosity), "{porosity}");
    let z = last.state.layers[0].coordination;
    assert!((4.5..6.5).contains(&z), "{z}");
}
