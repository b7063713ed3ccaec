//! How many pebbles a grain needs: angular grains, the clumps that stand for them, what is wrong with those and what
//! they cost. Writes the surfaces of the library as well.
//!
//!     cargo run --release --example grain_shapes -- docs/charts stdlib/shapes

use nalgebra::{UnitQuaternion, Vector3};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use trackbed::report::{PebbleRow, grain_pebbles_svg, grain_templates_svg};
use trackbed::solvers::granular::clump::Template;
use trackbed::solvers::granular::grains::{Angular, ClumpShape, Fitted, GrainForm, Misfit, Rule, Surfaces, stl};

/// Surfaces of the library: flatness, elongation, roundness.
const LIBRARY: [(&str, [f64; 3]); 5] = [
    ("blocky", [0.85, 0.85, 0.1]),
    ("flat", [0.5, 0.85, 0.1]),
    ("elongated", [0.85, 0.5, 0.1]),
    ("bladed", [0.55, 0.55, 0.1]),
    ("worn", [0.75, 0.75, 0.5]),
];
/// Columns of the picture, and points of the chart.
const DRAWN: [usize; 6] = [1, 2, 3, 5, 10, 20];
const COUNTED: [usize; 10] = [1, 2, 3, 4, 5, 7, 10, 15, 20, 50];
/// Surfaces over which the chart is averaged.
const SURFACES: usize = 20;
/// Pairs of grains that are brought together, and how near two pebbles must come to be tested, in sizes.
const PAIRS: usize = 300;
const NEAR: f64 = 0.05;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [charts, shapes] = &arguments[..] else { return eprintln!("usage: grain_shapes CHARTS SHAPES") };
    if let Err(error) = library(Path::new(shapes)).and_then(|()| pictures(Path::new(charts))) {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

/// The surfaces of the library, of the volume of the ball of diameter 1.
fn library(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for (number, (name, [flatness, elongation, roundness])) in LIBRARY.into_iter().enumerate() {
        let surface = Angular { flatness, elongation, roundness }.surface(1, number as u64).expect("indices of grains");
        std::fs::write(folder.join(format!("{name}.stl")), stl::write(&surface))?;
        let form = GrainForm::of_surface(&surface);
        println!(
            "{name}: S/I {:.3}, I/L {:.3}, sphericity {:.3}, {} triangles",
            form.flatness(),
            form.elongation(),
            form.sphericity(),
            surface.triangles().len()
        );
    }
    Ok(())
}

fn shape(pebbles: usize, count: usize) -> ClumpShape {
    let paper = ClumpShape::default();
    let Surfaces::Angular { indices, .. } = paper.surfaces else { unreachable!("angular by default") };
    ClumpShape { surfaces: Surfaces::Angular { indices, count }, rule: Rule { pebbles: [pebbles; 2], ..paper.rule } }
}

fn pictures(folder: &Path) -> std::io::Result<()> {
    let start = Instant::now();
    let templates = ClumpShape::default().templates(1).expect("the default shape");
    println!("{} templates in {:.0} ms", templates.len(), 1e3 * start.elapsed().as_secs_f64());
    let columns: Vec<Vec<Fitted>> = DRAWN.iter().map(|n| shape(*n, 5).fitted(1).expect("angular grains")).collect();
    let rows: Vec<Vec<Fitted>> = (0..5).map(|k| columns.iter().map(|column| column[k].clone()).collect()).collect();
    std::fs::write(folder.join("grain_templates.svg"), grain_templates_svg(&DRAWN, &rows))?;
    let rows: Vec<PebbleRow> = COUNTED.iter().map(|n| row(*n)).collect();
    let mut table = "pebbles,volume_elsewhere,mean_distance,inertia,pairs_tested\n".to_string();
    for row in &rows {
        let PebbleRow { pebbles, volume, distance, inertia, tests } = row;
        let _ = writeln!(table, "{pebbles},{volume:.4},{distance:.4},{inertia:.4},{tests:.2}");
    }
    print!("{table}");
    std::fs::write(folder.join("grain_pebbles.csv"), table)?;
    std::fs::write(folder.join("grain_pebbles.svg"), grain_pebbles_svg(&rows))
}

fn row(pebbles: usize) -> PebbleRow {
    let fitted = shape(pebbles, SURFACES).fitted(1).expect("angular grains");
    let errors: Vec<Misfit> = fitted.iter().map(|f| Misfit::between(&f.surface, &f.template)).collect();
    let mean = |of: fn(&Misfit) -> f64| errors.iter().map(of).sum::<f64>() / errors.len() as f64;
    let templates: Vec<Template> = fitted.into_iter().map(|f| f.template).collect();
    PebbleRow {
        pebbles,
        volume: mean(|e| 0.5 * e.volume),
        distance: mean(|e| e.mean_distance),
        inertia: mean(|e| e.inertia),
        tests: tests(&templates),
    }
}

/// Pairs of pebbles that come near where two grains of equal size touch, on average over directions and attitudes.
fn tests(templates: &[Template]) -> f64 {
    let spiral = |k: usize, turn: f64| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / PAIRS as f64;
        let (sine, cosine) = (turn * k as f64).sin_cos();
        Vector3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z)
    };
    let pair = |k: usize| {
        let [one, two] = [&templates[k % templates.len()], &templates[(k + 7) % templates.len()]];
        let attitude = UnitQuaternion::from_scaled_axis(spiral(k, 1.3) * (0.7 * k as f64 % 3.1));
        let along = spiral(k, 2.4);
        // how far the second stands off where it just touches: the largest over pairs of pebbles
        let apart = |p: usize, q: usize| {
            (attitude * two.pebbles[q].centre - one.pebbles[p].centre, one.pebbles[p].radius + two.pebbles[q].radius)
        };
        let all = || (0..one.pebbles.len()).flat_map(|p| (0..two.pebbles.len()).map(move |q| (p, q)));
        let stop = all().filter_map(|(p, q)| {
            let (from, reach) = apart(p, q);
            let square = reach * reach - (from - along * from.dot(&along)).norm_squared();
            (square >= 0.0).then(|| square.sqrt() - from.dot(&along))
        });
        let stop = stop.fold(0.0, f64::max);
        let near = |(p, q): &(usize, usize)| {
            let (from, reach) = apart(*p, *q);
            (from + along * stop).norm() < reach + NEAR
        };
        all().filter(near).count() as f64
    };
    (0..PAIRS).map(pair).sum::<f64>() / PAIRS as f64
}
