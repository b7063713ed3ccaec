//! Soil of hexahedra against other solvers: a layered foundation.

use trackbed::solvers::continuum::{Formulation, Material, Mesh, Settings, Side, Soil, Spot, Support};
use trackbed::solvers::foundation::{self, Bearing, Below, Layer, Method};

/// Half sides of the load and thicknesses from above \[m\].
const SIDES: [f64; 2] = [0.3, 0.5];
const UPPER: (f64, Material) =
    (0.4, Material { density: 2000.0, youngs_modulus: 150e6, poisson_ratio: 0.2, strength: None });
const LOWER: (f64, Material) =
    (0.8, Material { density: 2100.0, youngs_modulus: 472e6, poisson_ratio: 0.25, strength: None });

/// Spaces of `size` up to `even`, then growing by a sixth up to about 6 m.
fn growing(even: f64, size: f64) -> Vec<f64> {
    let mut lines: Vec<f64> = (0..=(even / size).round() as usize).map(|i| i as f64 * size).collect();
    // so that halving the size halves all spaces
    let growth = f64::powf(1.36, size / 0.1);
    let mut space = size;
    while lines[lines.len() - 1] < 6.0 {
        space *= growth;
        lines.push(lines[lines.len() - 1] + space);
    }
    lines
}

/// Stiffness of a uniform pressure on a rectangle, as its force over its mean settlement: a quarter of the layer.
fn stiffness(formulation: Formulation, size: f64) -> f64 {
    let (x, y) = (growing(SIDES[0], size), growing(SIDES[1], size));
    let deep = UPPER.0 + LOWER.0;
    let z: Vec<f64> = (0..=(deep / size).round() as usize).map(|i| i as f64 * size).collect();
    let material = |_: usize, _: usize, k: usize| Some(usize::from(z[k] + 0.5 * size > LOWER.0));
    let mesh = Mesh::grid([&x, &y, &z], vec![LOWER.1, UPPER.1], material).unwrap();
    let mut soil = Soil::new(mesh, Settings { formulation, ..Settings::default() }).unwrap();
    for side in [Side::XMin, Side::XMax, Side::YMin, Side::YMax] {
        soil.support(side, Support::Roller).unwrap();
    }
    soil.support(Side::Bottom, Support::Fixed).unwrap();
    let surface = soil.mesh().surface().unwrap().clone();
    let loaded: Vec<[u32; 4]> = {
        let (_, across) = surface.columns(1, 0.0, SIDES[1] - 0.5 * size);
        let (_, along) = surface.columns(0, 0.0, SIDES[0] - 0.5 * size);
        let columns = (0..along).flat_map(|i| (0..across).map(move |j| (i, j)));
        columns.map(|(i, j)| surface.facets()[surface.facet_of_column(i, j).unwrap()]).collect()
    };
    let share = Spot::weights([0.0; 2]);
    let force = 1e3 * size * size;
    for facet in &loaded {
        (0..4).for_each(|corner| soil.add_force(facet[corner] as usize, [0.0, 0.0, -force * share[corner]]));
    }
    soil.rest(&[]).unwrap();
    let sinks = |facet: &[u32; 4]| facet.map(|node| -soil.displacements()[node as usize][2]).iter().sum::<f64>() / 4.0;
    let mean = loaded.iter().map(sinks).sum::<f64>() / loaded.len() as f64;
    4.0 * force * loaded.len() as f64 / mean
}

/// Elements of 0.05 m are within 1 % of waves on layers (2 % mixed), and so is what they and those of 0.1 m say of
/// none.
#[test]
fn a_rectangle_on_layers_sinks_as_waves_say() {
    let layer = |(thickness, material): (f64, Material)| Layer {
        thickness,
        youngs_modulus: material.youngs_modulus,
        poisson_ratio: material.poisson_ratio,
        density: material.density,
        spread: 0.6,
    };
    let [width, length] = SIDES.map(|half| 2.0 * half);
    let bearing = Bearing { width, length, spacings: [100.0; 2], to_centre: None };
    let method = Method::LayeredElastic { neighbours: 0.0 };
    let exact = foundation::support(&bearing, &[layer(UPPER), layer(LOWER)], Below::Rigid, method).unwrap().stiffness;
    for formulation in [Formulation::MeanStrain, Formulation::MixedDiscretisation] {
        let [coarse, fine] = [0.1, 0.05].map(|size| stiffness(formulation, size) / exact);
        let near = if formulation == Formulation::MeanStrain { 0.01 } else { 0.02 };
        assert!((fine - 1.0).abs() < near, "{formulation:?} {coarse} {fine}");
        let extrapolated = fine + (fine - coarse) / 3.0;
        assert!((extrapolated - 1.0).abs() < 0.01, "{formulation:?} {coarse} {fine} {extrapolated}");
    }
}
