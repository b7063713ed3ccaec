//! The bed of Ahmadi et al. (2026), Table 2, packed, laid along a track and varied.
//!
//! ```text
//! beds cell [seed]             every stage of the paper's cell, as it ended
//! beds track BAYS [CELLS]      copies of it, or of so many cells, side by side and at rest
//! beds seeds COUNT             coordination and porosity over seeds, with their scatter
//! beds readings [WORD]         both readings of the paper's contact stiffness and count of grains; friction in packing
//! beds accuracy [WORD]         criterion, pressure, lifts, pebbles and length of the cell against time
//! ```
//!
//! With a word only cases that have it in their name. Tables are CSV on standard output; what it does meanwhile stands
//! on standard error. The last three pack as many cells at a time as there are cores, each with a core of its own.

use std::time::Instant;
use trackbed::nodes::turns;
use trackbed::solvers::granular::clump::Template;
use trackbed::solvers::granular::grains::{ClumpShape, Curve};
use trackbed::solvers::granular::packing::{
    GrainLayer, Order, Packed, Packing, PackingError, Progress, Recipe, Rest, lay, pack,
};
use trackbed::solvers::granular::probe::{Outline, Plate, Stillness, probe};
use trackbed::solvers::granular::{DashpotMode, Surface};
use trackbed::store::Beds;

const USAGE: &str = "beds cell [seed] | track BAYS [CELLS] | seeds COUNT | readings [WORD] | accuracy [WORD]";

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize, otherwise: u64| words.get(place).map_or(otherwise, |w| w.parse().expect(USAGE));
    match words.first().map(String::as_str) {
        Some("cell") => cell(number(1, 1)),
        Some("track") => track(number(1, 40) as usize, number(2, 1)),
        Some("seeds") => seeds(number(1, 8)),
        Some("readings") => readings(words.get(1).map_or("", String::as_str)),
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
    let layer = |name: &str, curve: &[[f64; 2]], templates, surface: Surface| GrainLayer {
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
        restored: Default::default(),
        reloads: 0,
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
    let mut told = Told::from_now();
    let packed = pack::<f32, _>(recipe, |progress| told.stage(progress))?;
    Ok((packed, told.start.elapsed().as_secs_f64()))
}

/// Says of each stage when it begins.
struct Told {
    start: Instant,
    last: String,
}

impl Told {
    fn from_now() -> Told {
        Told { start: Instant::now(), last: String::new() }
    }

    fn stage(&mut self, progress: &Progress) {
        if progress.stage != self.last {
            eprintln!("{:7.1} s  {}: {} grains", self.start.elapsed().as_secs_f64(), progress.stage, progress.bodies);
            self.last.clone_from(&progress.stage);
        }
    }
}

/// The bed, built once and kept below the folder of temporary files.
fn kept(recipe: &Recipe) -> Packed<f32> {
    let beds = Beds::kept_in(std::env::temp_dir().join("trackbed_beds"));
    let mut told = Told::from_now();
    let found = beds.bed(recipe, |progress| told.stage(progress)).unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(1)
    });
    found.packed
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
    println!("{HEADER}\n{}", row("paper", &packed, seconds, None));
}

const HEADER: &str = "case,grains,pebbles_ballast,thickness_sub_m,thickness_ballast_m,porosity_sub,porosity_ballast,z_sub_pressed,\
                      z_ballast_pressed,z_sub,z_ballast,plate_MN_per_m,plate_again_MN_per_m,steps,seconds";

/// Pressed is under the plate, before friction comes back.
fn row(name: &str, packed: &Packed<f32>, seconds: f64, stiffness: Option<[f64; 2]>) -> String {
    let inside = |layer: usize| {
        let [low, high] = packed.between(layer);
        packed.porosity([low + 0.25 * (high - low), high - 0.25 * (high - low)])
    };
    let thick = |layer: usize| packed.between(layer)[1] - packed.between(layer)[0];
    let pebbles = packed.bed.pebbles().filter(|pebble| pebble.body.0 >= packed.bodies[1]).count();
    let [first, again] = stiffness.unwrap_or([f64::NAN; 2]).map(|stiffness| 1e-6 * stiffness);
    let [pressed, rest] = packed.pressed_and_at_rest();
    format!(
        "{name},{},{pebbles},{:.4},{:.4},{:.4},{:.4},{:.2},{:.2},{:.2},{:.2},{first:.1},{again:.1},{},{seconds:.1}",
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

/// A row for each case, as many at a time as there are cores.
fn table(cases: &[(String, Recipe)]) {
    println!("{HEADER}");
    turns::each(cases, turns::cores(), turns::cores(), |(name, recipe)| match tried(recipe) {
        Ok((packed, seconds)) => println!("{}", row(name, &packed, seconds, plate_stiffness(recipe, &packed))),
        Err(error) => eprintln!("{name}: {error}"),
    })
    .expect("threads");
}

/// Under half a sleeper to 100 kPa, first and second loading, N/m.
fn plate_stiffness(recipe: &Recipe, packed: &Packed<f32>) -> Option<[f64; 2]> {
    let [length, width] = recipe.plan;
    let plate = Plate {
        outline: Outline::Rectangle { length: 0.3, width },
        centre: [0.5 * length, 0.5 * width],
        pressure: 100e3,
        surface: recipe.wall_surface(),
        rest: Stillness::default(),
    };
    let tested = probe(&packed.bed, &plate, |_, _, _| ());
    tested.map_err(|error| eprintln!("no stiffness: {error}")).ok().map(|tested| [tested.first, tested.again])
}

fn seeds(count: u64) {
    let cases: Vec<(String, Recipe)> = (1..=count).map(|seed| (format!("seed {seed}"), paper(seed))).collect();
    table(&cases);
}

/// Grains so many times as large, in layers as stiff.
fn scaled(layer: &mut GrainLayer, factor: f64) {
    let points: Vec<[f64; 2]> = layer.curve.points().iter().map(|[size, share]| [size * factor, *share]).collect();
    layer.curve = Curve::new(&points).expect("a grading");
    layer.surface.normal_stiffness *= factor;
    layer.surface.shear_stiffness *= factor;
}

fn readings(word: &str) {
    let with = |name: &str, change: &dyn Fn(&mut GrainLayer)| {
        let mut recipe = paper(1);
        recipe.layers.iter_mut().for_each(change);
        (name.to_owned(), recipe)
    };
    let of_bodies = |layer: &mut GrainLayer| {
        layer.surface.normal_stiffness *= 0.5;
        layer.surface.shear_stiffness *= 0.5;
    };
    let mut clumps = paper(1);
    // 6484 in place of about 3080
    scaled(&mut clumps.layers[1], (3080.0f64 / 6484.0).cbrt());
    let with_friction = |friction: f64| move |layer: &mut GrainLayer| layer.packing.friction = friction;
    let cases = [
        with("contact stiffness and count of pebbles", &|_| ()),
        ("count of clumps".into(), clumps),
        with("body stiffness", &of_bodies),
        with("friction 0.1 while packed", &with_friction(0.1)),
        with("friction 0.3 while packed", &with_friction(0.3)),
    ];
    table(&named(cases, word));
}

fn accuracy(word: &str) {
    let with = |name: &str, change: &dyn Fn(&mut Recipe)| {
        let mut recipe = paper(1);
        change(&mut recipe);
        (name.to_owned(), recipe)
    };
    let all = |recipe: &mut Recipe, change: &dyn Fn(&mut GrainLayer)| recipe.layers.iter_mut().for_each(change);
    let cases = [
        with("as it is", &|_| ()),
        with("lifts at rest to 0.03", &|r| r.rest.lift = 0.03),
        with("lifts at rest to 0.003", &|r| r.rest.lift = 0.003),
        with("100 kPa", &|r| all(r, &|layer| layer.pressure = 100e3)),
        with("400 kPa", &|r| all(r, &|layer| layer.pressure = 400e3)),
        with("one lift a layer", &|r| all(r, &|layer| layer.lifts = 1)),
        with("two lifts a layer", &|r| all(r, &|layer| layer.lifts = 2)),
        with("two bays", &|r| r.plan[0] = 1.2),
        with("grains 1.25 times as large", &|r| all(r, &|layer| scaled(layer, 1.25))),
        with("ballast of spheres", &|r| r.layers[1].templates = r.layers[0].templates.clone()),
    ];
    table(&named(cases, word));
}

/// Cases with a word in their name.
fn named(cases: impl IntoIterator<Item = (String, Recipe)>, word: &str) -> Vec<(String, Recipe)> {
    cases.into_iter().filter(|(name, _)| name.contains(word)).collect()
}
