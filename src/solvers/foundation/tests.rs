//! Both methods against closed forms, published numbers and each other.

use super::rectangle::mean_settlement;
use super::*;
use proptest::prelude::*;

const ALONE: Method = Method::LayeredElastic { neighbours: 0.0 };

/// Half a concrete sleeper 2.6 m long, its seat 0.75 m from the centre line.
fn sleeper() -> Bearing {
    Bearing { width: 0.3, length: 0.95, spacings: [0.6; 2], to_centre: Some(0.275) }
}

/// The same without the other half of the sleeper.
fn half() -> Bearing {
    Bearing { to_centre: None, ..sleeper() }
}

fn layer(thickness: f64, youngs_modulus: f64, poisson_ratio: f64) -> Layer {
    Layer { thickness, youngs_modulus, poisson_ratio, density: 1800.0, spread: 35f64.to_radians() }
}

fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} against {expected}");
}

#[test]
fn the_published_track_has_its_published_stiffness() {
    // Zhai et al. (2004): 0.45 m of ballast of 110 MPa at 35 degrees under sleepers 0.545 m apart, ground of 90 MPa/m
    let bearing = Bearing { width: 0.273, length: 0.95, spacings: [0.545; 2], to_centre: None };
    let ballast = [layer(0.45, 110e6, 0.2)];
    let alone = support(&bearing, &ballast, Below::Rigid, Method::StressCone).unwrap();
    near(alone.stiffness, 137.75e6, 3e-3);
    let both = support(&bearing, &ballast, Below::Springs { modulus: 90e6 }, Method::StressCone).unwrap();
    near(1.0 / (1.0 / both.stiffness - 1.0 / alone.stiffness), 77.5e6, 1e-3);
    // their mass of 531.4 kg counts a part of the shared volume twice: 2 (h - h0) h0^2 tan^2 with h0 = 0.256 m
    let (tan, shared) = (35f64.to_radians().tan(), 0.45 - (0.545 - 0.273) / 2.0 / 35f64.to_radians().tan());
    near(alone.masses[0] + 1800.0 * 2.0 * (0.45 - shared) * (shared * tan).powi(2), 531.4, 1e-3);
}

#[test]
fn a_free_cone_is_the_closed_form() {
    let wide = Bearing { spacings: [9.0; 2], ..half() };
    let (h, e, t) = (0.4, 130e6, 35f64.to_radians().tan());
    let found = support(&wide, &[layer(h, e, 0.3)], Below::Rigid, Method::StressCone).unwrap();
    let (l, b) = (0.95, 0.3);
    let exact = 2.0 * (l - b) * t * e / (l / b * (b + 2.0 * h * t) / (l + 2.0 * h * t)).ln();
    near(found.stiffness, exact, 1e-12);
    near(found.masses[0], 1800.0 * h * (l * b + (l + b) * h * t + 4.0 / 3.0 * (h * t).powi(2)), 1e-12);
    near(found.pressures(50e3)[0], 50e3 / (l * b), 1e-12);
    near(found.pressures(50e3)[1], 50e3 / ((l + 2.0 * h * t) * (b + 2.0 * h * t)), 1e-12);
    // a square has no logarithm: k = E a (a + 2 h t) / h
    let square = Bearing { width: 0.5, length: 0.5, ..wide };
    let found = support(&square, &[layer(h, e, 0.3)], Below::Rigid, Method::StressCone).unwrap();
    near(found.stiffness, e * 0.5 * (0.5 + 2.0 * h * t) / h, 1e-12);
}

#[test]
fn a_sleeper_between_two_spacings_lies_between_them() {
    let layers = [layer(0.35, 120e6, 0.2), layer(1.0, 60e6, 0.3)];
    for method in [Method::StressCone, Method::LayeredElastic { neighbours: 1.0 }] {
        let of =
            |spacings| support(&Bearing { spacings, ..sleeper() }, &layers, Below::Rigid, method).unwrap().stiffness;
        let (close, between, mirrored, far) = (of([0.5; 2]), of([0.5, 0.7]), of([0.7, 0.5]), of([0.7; 2]));
        assert!(close < between && between < far, "{method:?}: {close} {between} {far}");
        near(between, mirrored, 1e-12);
    }
}

#[test]
fn flexible_rectangles_settle_as_tabulated() {
    // mean settlement over p B (1 - nu^2) / E, sides 1 : n (Giroud 1968)
    for (n, factor) in [(1.0, 0.946), (2.0, 1.300), (5.0, 1.826), (10.0, 2.246)] {
        near(mean_settlement([0.3, 0.3 * n], [0.0; 2], 1e8, 0.0) * 1e8 * 0.3 * n, factor, 6e-4);
    }
    // at a large distance a rectangle acts like a point: (1 - nu^2) / (pi E r)
    near(mean_settlement([0.3, 0.9], [30.0, 40.0], 1e8, 0.3), 0.91 / (std::f64::consts::PI * 1e8 * 50.0), 1e-4);
}

#[test]
fn pressure_below_a_rectangle_is_boussinesqs() {
    let ground = Below::HalfSpace { youngs_modulus: 70e6, poisson_ratio: 0.3 };
    let layers = [layer(0.25, 70e6, 0.3), layer(0.35, 70e6, 0.3), layer(1.4, 70e6, 0.3)];
    let found = support(&half(), &layers, ground, ALONE).unwrap();
    near(1.0 / found.stiffness, mean_settlement([0.3, 0.95], [0.0; 2], 70e6, 0.3), 1e-9);
    for (pressure, z) in found.pressures[1..].iter().zip([0.25, 0.6, 2.0]) {
        // four corners (Newmark 1935)
        let (m, n) = (0.15 / z, 0.475 / z);
        let root = f64::sqrt(1.0 + m * m + n * n);
        let inside = m * n / root * (1.0 / (1.0 + m * m) + 1.0 / (1.0 + n * n)) + (m * n / root).atan();
        near(*pressure, 4.0 * inside / (2.0 * std::f64::consts::PI) / (0.3 * 0.95), 1e-5);
    }
}

#[test]
fn a_thin_layer_on_rock_is_an_oedometer() {
    let nu = 0.3;
    let oedometric = 40e6 * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let error = |h: f64| {
        let found = support(&half(), &[layer(h, 40e6, nu)], Below::Rigid, ALONE).unwrap();
        found.stiffness / (oedometric * 0.3 * 0.95 / h) - 1.0
    };
    // the effect of the edge is proportional to the thickness
    let (thin, thinner) = (error(0.04), error(0.02));
    assert!(thinner.abs() < 0.06 && (thin / thinner - 2.0).abs() < 0.3, "{thin} {thinner}");
}

#[test]
fn deep_rock_is_a_half_space() {
    let endless = mean_settlement([0.3, 0.95], [0.0; 2], 50e6, 0.25);
    let missing = |h: f64| {
        let found = support(&half(), &[layer(h, 50e6, 0.25)], Below::Rigid, ALONE).unwrap();
        1.0 - 1.0 / (found.stiffness * endless)
    };
    let (deep, deeper) = (missing(10.0), missing(20.0));
    assert!(deeper > 0.0 && deeper < 0.025 && (deep / deeper - 2.0).abs() < 0.02, "{deep} {deeper}");
}

#[test]
fn layers_of_one_material_are_one_layer_however_cut() {
    for (below, neighbours) in [(Below::Rigid, 0.0), (Below::Springs { modulus: 60e6 }, 0.7)] {
        for method in [Method::StressCone, Method::LayeredElastic { neighbours }] {
            let of = |cuts: &[f64]| {
                let layers: Vec<Layer> = cuts.iter().map(|h| layer(*h, 90e6, 0.2)).collect();
                support(&sleeper(), &layers, below, method).unwrap()
            };
            let one = of(&[1.2]);
            for cuts in [vec![0.05, 1.15], vec![0.6, 0.0, 0.6], vec![0.3, 0.1, 0.5, 0.3]] {
                let found = of(&cuts);
                near(found.stiffness, one.stiffness, 1e-6);
                near(found.masses.iter().sum(), one.masses[0], 1e-9);
                near(found.pressures[cuts.len()], one.pressures[1], 1e-4);
            }
        }
    }
}

#[test]
fn pressure_falls_with_depth_and_a_stiff_slab_spreads_it() {
    let soil = layer(2.0, 60e6, 0.3);
    let with = |middle: Layer| {
        let layers = [layer(0.3, 110e6, 0.2), middle, soil];
        support(&sleeper(), &layers, Below::Rigid, Method::LayeredElastic { neighbours: Method::NEIGHBOURS }).unwrap()
    };
    let (slab, none) = (with(layer(0.3, 5e9, 0.2)), with(layer(0.3, 60e6, 0.3)));
    assert!(none.pressures.windows(2).all(|p| p[0] > p[1]), "{none:?}");
    assert!(slab.pressures[2] < 0.6 * none.pressures[2] && slab.stiffness > 1.2 * none.stiffness);
}

#[test]
fn mistakes_are_named() {
    let stack = [layer(0.3, 110e6, 0.2)];
    let fails = |bearing: Bearing, layers: &[Layer], below, method| {
        support(&bearing, layers, below, method).unwrap_err().to_string()
    };
    let plain = |layers: &[Layer]| fails(sleeper(), layers, Below::Rigid, Method::StressCone);
    assert_eq!(plain(&[]), "expected at least one layer with a thickness");
    assert_eq!(plain(&[layer(0.0, 1e8, 0.2)]), "expected at least one layer with a thickness");
    assert_eq!(plain(&[stack[0], layer(-0.1, 1e8, 0.2)]), "expected a positive thickness of layer 2, found -0.1");
    assert_eq!(plain(&[layer(0.3, 0.0, 0.2)]), "expected a positive Young's modulus of layer 1, found 0");
    assert_eq!(plain(&[layer(0.3, f64::NAN, 0.2)]), "expected a positive Young's modulus of layer 1, found NaN");
    assert_eq!(plain(&[layer(0.3, 1e8, 0.5)]), "expected a Poisson's ratio of layer 1 from 0 to below 0.5, found 0.5");
    let steep = Layer { spread: 95f64.to_radians(), ..stack[0] };
    assert_eq!(plain(&[steep]), "expected a load spread angle from 0 to below 90 degrees in layer 1, found 95");
    let crowded = Bearing { spacings: [0.6, 0.2], ..sleeper() };
    assert_eq!(
        fails(crowded, &stack, Below::Rigid, Method::StressCone),
        "expected a sleeper spacing of at least the sleeper width, 0.3 m, found 0.2 m"
    );
    assert_eq!(
        fails(sleeper(), &stack, Below::Springs { modulus: -1.0 }, Method::StressCone),
        "expected a positive modulus of subgrade reaction, found -1"
    );
    assert_eq!(
        fails(sleeper(), &stack, Below::Rigid, Method::LayeredElastic { neighbours: 1.5 }),
        "expected a load share of the neighbours from 0 to 1, found 1.5"
    );
}

/// The support without panels, closed sums or data of earlier stacks: every wave and direction in small equal steps.
fn by_brute_force(bearing: &Bearing, layers: &[Layer], neighbours: f64) -> f64 {
    let top = layers[0];
    let endless = 2.0 * (1.0 - top.poisson_ratio * top.poisson_ratio) / top.youngs_modulus;
    let (apart, length) = (bearing.length + 2.0 * bearing.to_centre.unwrap(), bearing.length);
    let centres: Vec<(f64, f64, f64)> =
        [(0.0, 1.0), (-bearing.spacings[0], neighbours), (bearing.spacings[1], neighbours)]
            .into_iter()
            .flat_map(|(x, share)| [(x, 0.0, share), (x, apart, share)])
            .collect();
    let half_space = |(x, y, share): &(f64, f64, f64)| {
        share * mean_settlement([bearing.width, length], [*x, *y], top.youngs_modulus, top.poisson_ratio)
    };
    let sinc = |x: f64| x.sin() / x;
    let (step, directions) = (0.01, 160);
    let wave = |k: f64| {
        let direction = |i: usize| {
            let (sin, cos) = (std::f64::consts::FRAC_PI_2 * (i as f64 + 0.5) / directions as f64).sin_cos();
            let plan = sinc(0.5 * k * cos * bearing.width) * sinc(0.5 * k * sin * length);
            plan * plan
                * centres.iter().map(|(x, y, share)| share * (k * cos * x).cos() * (k * sin * y).cos()).sum::<f64>()
        };
        let mean = (0..directions).map(direction).sum::<f64>() / directions as f64;
        (kernel::Kernel::new(layers, Below::Rigid).settlement(k) - endless) * mean / (2.0 * std::f64::consts::PI)
    };
    // Simpson's rule, up to waves without effect below the first layer
    let steps = 2 * (6.0 / top.thickness / step).ceil() as usize;
    let weight = |i: usize| if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    let integral = (0..=steps).map(|i| weight(i) * wave((i as f64 * step).max(1e-9))).sum::<f64>() * step / 3.0;
    1.0 / (centres.iter().map(half_space).sum::<f64>() + integral)
}

#[test]
fn a_footing_gives_what_brute_force_does_whatever_was_asked_before() {
    let bearing = Bearing { spacings: [0.55, 0.62], width: 0.4, ..sleeper() };
    let wedge = |h: f64| [layer(0.4, 110e6, 0.2), layer(h, 700e6, 0.3), layer(2.0 - h, 60e6, 0.35)];
    let mut footing = Footing::new(bearing, Method::LayeredElastic { neighbours: 0.7 });
    for h in [0.3, 0.31, 0.8] {
        let found = footing.support(&wedge(h), Below::Rigid).unwrap();
        near(found.stiffness, by_brute_force(&bearing, &wedge(h), 0.7), 1e-8);
        let alone = support(&bearing, &wedge(h), Below::Rigid, Method::LayeredElastic { neighbours: 0.7 }).unwrap();
        assert_eq!(found, alone);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Stiffer ground anywhere gives a stiffer support, and an additional layer above rock a softer one.
    #[test]
    fn stiffness_follows_the_layers(
        stack in prop::collection::vec((0.05..1.0f64, 10e6..2e9f64, 0.0..0.45f64), 1..4),
        which in 0usize..3,
        factor in 1.05..3.0f64,
    ) {
        let layers: Vec<Layer> = stack.iter().map(|(h, e, nu)| layer(*h, *e, *nu)).collect();
        let mut stiffer = layers.clone();
        let at = which % layers.len();
        stiffer[at].youngs_modulus *= factor;
        let mut deeper = layers.clone();
        deeper.push(layer(0.5, 50e6, 0.3));
        for method in [Method::StressCone, ALONE, Method::LayeredElastic { neighbours: 1.0 }] {
            let of = |layers: &[Layer]| support(&sleeper(), layers, Below::Rigid, method).unwrap();
            let plain = of(&layers);
            prop_assert!(plain.stiffness.is_finite() && plain.stiffness > 0.0);
            prop_assert!(of(&stiffer).stiffness > plain.stiffness * (1.0 - 1e-9));
            prop_assert!(of(&deeper).stiffness < plain.stiffness);
        }
    }
}

/// A known stack, and its row in `docs/validation.md`.
struct Known {
    name: &'static str,
    layers: Vec<Layer>,
    below: Below,
}

fn known() -> [Known; 7] {
    let (ballast, subballast) = (layer(0.3, 110e6, 0.2), layer(0.3, 150e6, 0.3));
    let soil = |h: f64, e: f64| Layer { density: 2000.0, spread: 30f64.to_radians(), ..layer(h, e, 0.3) };
    // a plate spreads the load as 0.9 t (E / E_soil)^(1/3) of the soil (Odemark 1949)
    let odemark = 0.9 * f64::cbrt(34e9 / 60e6) * 30f64.to_radians().tan();
    let plate = Layer { spread: odemark.atan(), ..layer(0.3, 34e9, 0.2) };
    let ground = |e: f64| Below::HalfSpace { youngs_modulus: e, poisson_ratio: 0.3 };
    [
        Known {
            name: "paper: 300 mm subballast, 1 m of 472 MPa on rock",
            layers: vec![ballast, subballast, soil(1.0, 472e6)],
            below: Below::Rigid,
        },
        Known {
            name: "soft: 300 mm subballast, 2 m of 20 MPa on 20 MPa without end",
            layers: vec![ballast, subballast, soil(2.0, 20e6)],
            below: ground(20e6),
        },
        Known {
            name: "ballast mat: 25 mm of 1.5 MPa on a deck",
            layers: vec![ballast, Layer { spread: 0.0, ..layer(0.025, 1.5e6, 0.1) }],
            below: Below::Rigid,
        },
        Known {
            name: "cement-treated: 300 mm of 5 GPa, 2 m of 60 MPa on 60 MPa without end",
            layers: vec![ballast, layer(0.3, 5e9, 0.2), soil(2.0, 60e6)],
            below: ground(60e6),
        },
        Known {
            name: "300 mm subballast, 2 m of 60 MPa on rock",
            layers: vec![ballast, subballast, soil(2.0, 60e6)],
            below: Below::Rigid,
        },
        Known {
            name: "the same with a wedge, 0.8 m of 900 MPa on 1.2 m of 60 MPa",
            layers: vec![ballast, subballast, soil(0.8, 900e6), soil(1.2, 60e6)],
            below: Below::Rigid,
        },
        Known {
            name: "the same with an approach slab, 0.3 m of 34 GPa on 1.7 m of 60 MPa",
            layers: vec![ballast, subballast, plate, soil(1.7, 60e6)],
            below: Below::Rigid,
        },
    ]
}

#[test]
fn the_validation_page_compares_both_methods() {
    let page = include_str!("../../../docs/validation.md");
    let row = |Known { name, layers, below }: Known| {
        let elastic = |neighbours| Method::LayeredElastic { neighbours };
        let methods = [Method::StressCone, elastic(0.0), elastic(Method::NEIGHBOURS)];
        let found = methods.map(|method| support(&sleeper(), &layers, below, method).unwrap());
        let stiffness = found.each_ref().map(|s| format!("{:.0}", s.stiffness / 1e6)).join(" | ");
        let below_ballast = [&found[0], &found[2]].map(|s| format!("{:.0}", s.pressures(40e3)[1] / 1e3)).join(" | ");
        format!("| {name} | {stiffness} | {below_ballast} | {:.0} |", found[0].masses.iter().sum::<f64>())
    };
    let rows = known().map(row).join("\n");
    assert!(page.contains(&rows), "expected in docs/validation.md:\n{rows}");
}
