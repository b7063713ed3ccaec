//! The bed of Ahmadi et al. (2026), Table 2, packed, laid along a track and varied.
//!
//! ```text
//! beds cell [seed]             every stage of the paper's cell, as it ended
//! beds track BAYS [CELLS]      copies of it, or of so many cells, side by side and at rest
//! beds seeds COUNT             coordination and porosity over seeds, with their scatter
//! beds readings                both readings of the paper's contact stiffness and of its friction while packed
//! beds accuracy [WORD]         criterion, pressure, lifts, pebbles and length of the cell against time; cases with a word in their name
//! ```
//!
//! Tables are CSV on standard output; what it does meanwhile stands on standard error.

use std::time::Instant;
use trackbed::results;
use trackbed::solvers::granular::clump::Template;
use trackbed::solvers::granular::grains::{ClumpShape, Curve};
use trackbed::solvers::granular::packing::{Layer, Order, Packed, Packing, PackingError, Recipe, Rest, lay, pack};
use trackbed::solvers::granular::{DashpotMode, Surface};

const USAGE: &str = "beds cell [seed] | track BAYS [CELLS] | seeds COUNT | readings | accuracy [WORD]";

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize, otherwise: u64| words.get(place).map_or(otherwise, |w| w.parse().expect(USAGE));
    match words.first().map(String::as_str) {
        Some("cell") => cell(number(1, 1)),
        Some("track") => track(number(1, 40) as usize, number(2, 1)),
        Some("seeds") => seeds(number(1, 8)),
        Some("readings") => readings(),
        Some("accuracy") => accuracy(words.get(1).map_or("", String::as_str)),
        _ => eprintln!("{USAGE}"),
    }
}

/// Contact stiffness is that of a contact, N/m: two bodies in series.
fn surface(contact: f64, friction: f64) -> Surface {
    Surface {
        normal_stiffness: 2.0 * contact,
        shear_stiffness: 2.0 * contact,
        friction,
        damping: [0.3; 2],
        mode: DashpotMode::default(),
    }
}

/// Table 2 and Fig. 4: two layers of 0.3 m, half a track wide, one bay long.
fn paper(seed: u64) -> Recipe {
    let packing = Packing { friction: 0.0, local_damping: 0.7, viscous_damping: 0.0 };
    let layer = |name: &str, curve: &[[f64; 2]], templates, surface: Surface| Layer {
        name: name.into(),
        curve: Curve::new(curve).expect("a grading"),
        templates,
        density: 2700.0,
        surface,
        wall_friction: surface.friction,
        thickness: 0.3,
        lifts: 3,
        pressure: 200e3,
        packing,
    };
    let sub = layer(
        "sub-ballast",
        &[[0.025, 0.0], [0.0375, 0.27], [0.05, 0.4], [0.1, 0.8], [0.15, 1.0]],
        vec![Template::sphere(0.5).expect("a sphere")],
        surface(5e6, 0.5),
    );
    let ballast = layer(
        "ballast",
        &[[0.032, 0.0], [0.04, 0.2], [0.05, 0.5], [0.063, 0.85], [0.08, 1.0]],
        ClumpShape::default().templates(1).expect("clumps"),
        surface(1.3e7, 0.7),
    );
    Recipe {
        plan: [0.6, 1.2],
        walls: true,
        ends: false,
        layers: vec![sub, ballast],
        gravity: 9.81,
        local_damping: 0.2,
        rest: Rest::default(),
        seed,
    }
}

/// The bed, and the seconds that it took; a bed that cannot be packed ends the program.
fn packed(recipe: &Recipe) -> (Packed<f32>, f64) {
    tried(recipe).unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(1)
    })
}

fn tried(recipe: &Recipe) -> Result<(Packed<f32>, f64), PackingError> {
    let start = Instant::now();
    let mut last = String::new();
    let packed = pack::<f32>(recipe, |progress| {
        if progress.stage != last {
            eprintln!("{:7.1} s  {}: {} grains", start.elapsed().as_secs_f64(), progress.stage, progress.bodies);
            last.clone_from(&progress.stage);
        }
    });
    Ok((packed?, start.elapsed().as_secs_f64()))
}

/// The bed, built once and kept below the folder of temporary files.
fn kept(recipe: &Recipe) -> Packed<f32> {
    let cache = std::env::temp_dir().join("trackbed_beds");
    results::kept_bed(&cache, recipe).unwrap_or_else(|| {
        let (packed, _) = packed(recipe);
        results::keep_bed(&cache, recipe, &packed).expect("a folder to write to");
        packed
    })
}

fn cell(seed: u64) {
    let (packed, seconds) = packed(&paper(seed));
    println!("stage,time_s,pressure_kpa,level_m,unbalance,sub_ballast,z_sub_ballast,ballast,z_ballast");
    for stage in &packed.stages {
        let [sub, ballast] = [0, 1].map(|layer| stage.state.layers[layer]);
        println!(
            "{},{:.3},{:.1},{:.4},{:.1e},{},{:.2},{},{:.2}",
            stage.name.replace(", ", " "),
            stage.time,
            stage.pressure / 1e3,
            stage.level.unwrap_or(f64::NAN),
            stage.state.unbalance,
            sub.bodies,
            sub.coordination,
            ballast.bodies,
            ballast.coordination
        );
    }
    println!("{HEADER}\n{}", row("paper", &packed, seconds));
}

const HEADER: &str = "case,grains,thickness_sub_m,thickness_ballast_m,porosity_sub,porosity_ballast,z_sub_pressed,\
                      z_ballast_pressed,z_sub,z_ballast,steps,seconds";

fn row(name: &str, packed: &Packed<f32>, seconds: f64) -> String {
    let inside = |layer: usize| {
        let [low, high] = packed.between(layer);
        packed.porosity([low + 0.25 * (high - low), high - 0.25 * (high - low)])
    };
    let thick = |layer: usize| packed.between(layer)[1] - packed.between(layer)[0];
    let [pressed, rest] = [packed.stages.len() - 3, packed.stages.len() - 1].map(|stage| &packed.stages[stage].state);
    format!(
        "{name},{},{:.4},{:.4},{:.4},{:.4},{:.2},{:.2},{:.2},{:.2},{},{seconds:.1}",
        packed.bed.len(),
        thick(0),
        thick(1),
        inside(0),
        inside(1),
        pressed.layers[0].coordination,
        pressed.layers[1].coordination,
        rest.layers[0].coordination,
        rest.layers[1].coordination,
        packed.bed.steps()
    )
}

fn track(bays: usize, cells: u64) {
    let recipe = paper(1);
    let cells: Vec<Packed<f32>> = (1..=cells).map(|seed| kept(&paper(seed))).collect();
    let start = Instant::now();
    let laid = lay(&cells, &Order::mixed(cells.len(), bays, 1), &recipe, |progress| {
        eprintln!("{:7.1} s  {:.0} % {} steps", start.elapsed().as_secs_f64(), 100.0 * progress.share, progress.steps);
    });
    let laid = laid.unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(1)
    });
    let account = &laid.account;
    println!("bays,cells,grains,held_at_ends,removed_at_seams,removed_mass,unbalance,time_s,steps,seconds,memory_gb");
    println!(
        "{bays},{},{},{},{},{:.4},{:.1e},{:.4},{},{:.1},{:.2}",
        cells.len(),
        account.bodies,
        account.held_at_ends,
        account.removed_at_seams,
        account.removed_mass,
        account.unbalance,
        account.time,
        account.steps,
        start.elapsed().as_secs_f64(),
        peak_memory()
    );
}

/// The largest resident set so far, GB; not a number where the system does not tell.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().split(' ').next()?.parse::<f64>().ok()).map_or(f64::NAN, |kb| kb / 1e6)
}

fn seeds(count: u64) {
    println!("{HEADER}");
    for seed in 1..=count {
        let (packed, seconds) = packed(&paper(seed));
        println!("{}", row(&format!("seed {seed}"), &packed, seconds));
    }
}

fn readings() {
    println!("{HEADER}");
    let mut cases = vec![("contact stiffness, no friction", paper(1))];
    let mut body = paper(1);
    for (layer, stiffness) in body.layers.iter_mut().zip([5e6, 1.3e7]) {
        (layer.surface.normal_stiffness, layer.surface.shear_stiffness) = (stiffness, stiffness);
    }
    cases.push(("body stiffness", body));
    for (name, friction) in [("friction 0.1 while packed", 0.1), ("friction 0.3 while packed", 0.3)] {
        let mut rough = paper(1);
        rough.layers.iter_mut().for_each(|layer| layer.packing.friction = friction);
        cases.push((name, rough));
    }
    for (name, recipe) in cases {
        match tried(&recipe) {
            Ok((packed, seconds)) => println!("{}", row(name, &packed, seconds)),
            Err(error) => eprintln!("{name}: {error}"),
        }
    }
}

fn accuracy(word: &str) {
    println!("{HEADER}");
    let with = |change: &dyn Fn(&mut Recipe)| {
        let mut recipe = paper(1);
        change(&mut recipe);
        recipe
    };
    let all = |recipe: &mut Recipe, change: &dyn Fn(&mut Layer)| recipe.layers.iter_mut().for_each(change);
    let cases = [
        ("as it is", with(&|_| ())),
        ("lifts at rest to 0.03", with(&|r| r.rest.lift = 0.03)),
        ("lifts at rest to 0.003", with(&|r| r.rest.lift = 0.003)),
        ("100 kPa", with(&|r| all(r, &|layer| layer.pressure = 100e3))),
        ("400 kPa", with(&|r| all(r, &|layer| layer.pressure = 400e3))),
        ("one lift a layer", with(&|r| all(r, &|layer| layer.lifts = 1))),
        ("two lifts a layer", with(&|r| all(r, &|layer| layer.lifts = 2))),
        ("two bays", with(&|r| r.plan[0] = 1.2)),
        ("ballast of spheres", with(&|r| r.layers[1].templates = r.layers[0].templates.clone())),
    ];
    for (name, recipe) in cases.into_iter().filter(|(name, _)| name.contains(word)) {
        let (packed, seconds) = packed(&recipe);
        println!("{}", row(name, &packed, seconds));
    }
}
