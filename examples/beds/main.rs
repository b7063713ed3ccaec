//! The paper's cell packed.
use std::time::Instant;
use trackbed::solvers::granular::clump::Template;
use trackbed::solvers::granular::grains::*;
use trackbed::solvers::granular::packing::*;
use trackbed::solvers::granular::{DashpotMode, Surface};

fn main() {
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let get = |i: usize, d: f64| args.get(i).copied().unwrap_or(d);
    let surface = |k: f64, friction| Surface {
        normal_stiffness: 2.0 * k,
        shear_stiffness: 2.0 * k,
        friction,
        damping: [0.3; 2],
        mode: DashpotMode::default(),
    };
    let packing = Packing { friction: 0.0, local_damping: 0.7, viscous_damping: 0.0 };
    let lifts = get(1, 3.0) as u32;
    let sub = Layer {
        name: "subballast".into(),
        curve: Curve::new(&[[0.025, 0.0], [0.0375, 0.27], [0.05, 0.4], [0.1, 0.8], [0.15, 1.0]]).unwrap(),
        templates: vec![Template::sphere(0.5).unwrap()],
        density: 2700.0,
        surface: surface(5e6, 0.5),
        wall_friction: 0.5,
        thickness: 0.3,
        lifts,
        pressure: 200e3,
        packing,
    };
    let templates = ClumpShape::default().templates(1).unwrap();
    for t in &templates {
        println!("template {} pebbles, bounding {:.3}", t.pebbles.len(), t.bounding_radius());
    }
    let ballast = Layer {
        name: "ballast".into(),
        curve: Curve::new(&[[0.032, 0.0], [0.04, 0.2], [0.05, 0.5], [0.063, 0.85], [0.08, 1.0]]).unwrap(),
        templates,
        density: 2700.0,
        surface: surface(1.3e7, 0.7),
        wall_friction: 0.7,
        thickness: 0.3,
        lifts,
        pressure: 200e3,
        packing,
    };
    let recipe = Recipe {
        plan: [0.6, 1.2],
        walls: true,
        layers: vec![sub, ballast],
        gravity: 9.81,
        local_damping: 0.2,
        rest: Rest::default(),
        seed: get(0, 1.0) as u64,
    };
    let start = Instant::now();
    let mut last = String::new();
    let packed = pack::<f32>(&recipe, |p| {
        if p.stage != last {
            println!(
                "{:7.1} s  {:30} {:5.1} % {} bodies {} steps",
                start.elapsed().as_secs_f64(),
                p.stage,
                100.0 * p.share,
                p.bodies,
                p.steps
            );
            last = p.stage.clone();
        }
    });
    match packed {
        Err(error) => println!("{error}"),
        Ok(packed) => {
            for stage in &packed.stages {
                println!(
                    "{:25} {:.3} s {:6.1} kPa level {:?} unbalance {:.1e} {:?}",
                    stage.name,
                    stage.time,
                    stage.pressure / 1e3,
                    stage.level,
                    stage.state.unbalance,
                    stage
                        .state
                        .layers
                        .iter()
                        .map(|l| (
                            l.bodies,
                            (l.coordination * 100.0).round() / 100.0,
                            (l.without_rattlers * 100.0).round() / 100.0
                        ))
                        .collect::<Vec<_>>()
                );
            }
            for l in 0..2 {
                let [a, b] = packed.between(l);
                println!(
                    "layer {l}: {a:.4} .. {b:.4} porosity {:.4}, inner {:.4}; sample error {:.4}",
                    packed.porosity([a, b]),
                    packed.porosity([a + 0.05, b - 0.05]),
                    packed.samples[l].error()
                );
            }
        }
    }
    println!("{:.1} s", start.elapsed().as_secs_f64());
}
