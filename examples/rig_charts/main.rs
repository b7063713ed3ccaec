//! What accuracy of a box test costs: pebbles a grain, particle scale, time step, packing friction, pressure and
//! criterion, length of the cell.
//!
//! ```sh
//! cargo run --release --example rig_charts -- docs/charts
//! ```
//!
//! A sleeper on 0.3 m of ballast under ten cycles, on packings of several seeds for every setting, two at a time with a
//! core each. About half an hour; `--redraw` draws the table that is there again. Writes `rig_accuracy.csv`, a row for
//! each test, and `rig_accuracy.svg`.

mod chart;
mod table;
mod test;

use std::error::Error;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use test::Setting;
use trackbed::nodes::turns;

/// Packings of a setting, and of the one that all others are compared with.
const SEEDS: u64 = 2;
const BASE_SEEDS: u64 = 4;

/// A setting by its place in a chart.
struct Case {
    chart: &'static str,
    name: String,
    setting: Setting,
    seeds: u64,
}

/// A test as it ended.
pub struct Row {
    pub chart: String,
    pub name: String,
    pub seed: u64,
    /// The reason where there is none.
    pub answer: Result<test::Answer, String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let dir = PathBuf::from(words.first().ok_or("usage: rig_charts DIR [--redraw]")?);
    std::fs::create_dir_all(&dir)?;
    let file = dir.join("rig_accuracy.csv");
    if words.get(1).is_none_or(|word| word != "--redraw") {
        std::fs::write(&file, table::write(&rows()))?;
    }
    let rows = table::read(&std::fs::read_to_string(&file)?).ok_or("the table is damaged")?;
    Ok(std::fs::write(dir.join("rig_accuracy.svg"), chart::draw(&rows))?)
}

/// Every test, each with a core of its own.
fn rows() -> Vec<Row> {
    let cases = cases();
    let tests: Vec<(&Case, u64)> =
        cases.iter().flat_map(|case| (1..=case.seeds).map(move |seed| (case, seed))).collect();
    let done = AtomicUsize::new(0);
    turns::each(&tests, turns::cores(), turns::cores(), |(case, seed)| {
        let answer = test::run(&case.setting, *seed);
        let row = Row { chart: case.chart.to_owned(), name: case.name.clone(), seed: *seed, answer };
        eprintln!("{:3} of {}: {}", 1 + done.fetch_add(1, Ordering::Relaxed), tests.len(), table::line(&row));
        row
    })
    .expect("threads")
}

/// One thing changed at a time.
fn cases() -> Vec<Case> {
    let usual = Setting::default();
    let mut all = vec![Case { chart: "usual", name: "usual".into(), setting: usual.clone(), seeds: BASE_SEEDS }];
    let mut add = |chart, name: String, setting| all.push(Case { chart, name, setting, seeds: SEEDS });
    for pebbles in ["spheres", "clumps(2)", "clumps(4)", "clumps(6)"] {
        let name = pebbles.trim_start_matches("clumps(").trim_end_matches(')').replace("spheres", "1");
        add("pebbles", name, usual.clone().set("stone.shape", pebbles));
    }
    for scale in ["1.25", "1.5", "2"] {
        add("scale", scale.into(), usual.clone().set("stone.scale", scale));
    }
    for added in [0.0, 0.05, 0.2] {
        add("step", format!("{} %", 100.0 * added), Setting { added, ..usual.clone() });
    }
    for friction in ["0", "0.1", "0.3"] {
        add("friction", friction.into(), usual.clone().set("stone.packing.friction", friction));
    }
    for pressure in [50, 100, 400] {
        add(
            "pressure",
            format!("{pressure} kPa"),
            usual.clone().set("stone.packing.pressure", &format!("{pressure} kPa")),
        );
    }
    for rest in [0.1, 0.03, 0.003] {
        add("criterion", rest.to_string(), Setting { rest, ..usual.clone() });
    }
    for bays in [2, 3] {
        add("length", format!("{bays} bays"), Setting { bays, ..usual.clone() });
    }
    all
}
