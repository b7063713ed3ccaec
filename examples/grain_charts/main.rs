//! What accuracy of the grain solver costs: time step, precision, reach of lists, pebbles a clump, mass scaling.
//!
//! ```sh
//! cargo run --release --example grain_charts -- docs/charts
//! ```
//!
//! A periodic bed of 200 grains at rest is loaded by a plate from 5 to 50 kPa and unloaded, once for each seed. Every
//! setting is compared with a reference of the same seeds (`f64`, a twentieth of the stable step, of clumps a tenth);
//! the scatter of the reference over its seeds is the band below which an error does not matter. Takes about six
//! minutes; `--redraw` draws the table that is there again. Writes `grains_accuracy.csv` and `grains_accuracy.svg`.

mod chart;
mod cycle;

use cycle::{Answer, Setting};
use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;
use trackbed::nodes::turns;

/// Seeds of every setting.
const SEEDS: u64 = 5;

/// One setting over all seeds.
pub struct Row {
    pub chart: &'static str,
    pub name: String,
    /// What the chart's axis shows.
    pub value: f64,
    /// Runs that failed, as they should beyond the stable step.
    pub failed: usize,
    /// Root mean square over the seeds of the difference from the reference, over the reference's mean.
    pub settlement_error: f64,
    pub stiffness_error: f64,
    /// Difference of the means over seeds, over the reference's mean.
    pub settlement_bias: f64,
    pub stiffness_bias: f64,
    /// Energy that nothing accounts for over the work done.
    pub residual: f64,
    /// Wall time for a second of the bed \[s\], median over seeds.
    pub time: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let dir = PathBuf::from(std::env::args().nth(1).ok_or("usage: grain_charts DIR")?);
    std::fs::create_dir_all(&dir)?;
    if std::env::args().nth(2).as_deref() == Some("--redraw") {
        let (rows, band) =
            read(&std::fs::read_to_string(dir.join("grains_accuracy.csv"))?).ok_or("the table is damaged")?;
        return Ok(std::fs::write(dir.join("grains_accuracy.svg"), chart::draw(&rows, band))?);
    }
    let reference = runs(&Setting::reference());
    let band = [scatter(&reference, |a| a.settlement), scatter(&reference, |a| a.stiffness)];
    // a clump of other pebbles is another grain: its reference is that of most pebbles
    let clumps = runs(&Setting { pebbles: 8, share: 0.1, ..Setting::reference() });
    let mut rows = Vec::new();
    for (chart, name, value, setting) in settings() {
        let answers = runs(&setting);
        let against = if chart == "pebbles" { &clumps } else { &reference };
        let row = compare(chart, name, value, &answers, against);
        eprintln!(
            "{chart:9} {:>14}: settlement {:.2e}, stiffness {:.2e}, residual {:.1e}, {:.2} s a second, {} of {SEEDS} failed",
            row.name, row.settlement_error, row.stiffness_error, row.residual, row.time, row.failed
        );
        rows.push(row);
    }
    std::fs::write(dir.join("grains_accuracy.csv"), table(&rows, band))?;
    std::fs::write(dir.join("grains_accuracy.svg"), chart::draw(&rows, band))?;
    Ok(())
}

fn settings() -> Vec<(&'static str, String, f64, Setting)> {
    let base = Setting::usual();
    let mut all = Vec::new();
    for share in [0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 0.95, 1.05, 1.2] {
        all.push(("step", format!("{share} of limit"), share, Setting { share, ..base }));
    }
    for (double, name) in [(false, "mixed"), (true, "f64")] {
        for share in [0.1, 0.5, 0.85] {
            all.push(("precision", format!("{name} {share}"), share, Setting { double, share, ..base }));
        }
    }
    for skin in [0.05e-3, 0.2e-3, 1e-3, 4e-3, 10e-3] {
        all.push(("skin", format!("{} mm", skin * 1e3), skin * 1e3, Setting { skin: Some(skin), ..base }));
    }
    for pebbles in [1, 2, 3, 4, 6, 8] {
        all.push(("pebbles", format!("{pebbles}"), f64::from(pebbles), Setting { pebbles, ..base }));
    }
    for target in [1.0, 1.2, 1.5, 2.0, 3.0] {
        all.push(("scaling", format!("{target} of limit"), target, Setting { scaled: Some(target), ..base }));
    }
    all
}

/// The answers of all seeds; none where a run failed. Each run has a core to itself.
fn runs(setting: &Setting) -> Vec<Option<Answer>> {
    turns::each(&(0..SEEDS).collect::<Vec<_>>(), turns::cores(), turns::cores(), |seed| cycle::run(setting, *seed))
        .expect("threads")
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().sum::<f64>() / values.count().max(1) as f64
}

/// Standard deviation over the seeds, over the mean.
fn scatter(answers: &[Option<Answer>], of: impl Fn(&Answer) -> f64) -> f64 {
    let values: Vec<f64> = answers.iter().flatten().map(of).collect();
    let middle = mean(values.iter().copied());
    let square = values.iter().map(|v| (v - middle).powi(2)).sum::<f64>() / (values.len().max(2) - 1) as f64;
    square.sqrt() / middle.abs()
}

fn compare(
    chart: &'static str,
    name: String,
    value: f64,
    answers: &[Option<Answer>],
    against: &[Option<Answer>],
) -> Row {
    let pairs: Vec<(Answer, Answer)> = answers.iter().zip(against).filter_map(|(a, r)| Some(((*a)?, (*r)?))).collect();
    let error = |of: fn(&Answer) -> f64| {
        let middle = mean(pairs.iter().map(|(_, r)| of(r)));
        let square = mean(pairs.iter().map(|(a, r)| (of(a) - of(r)).powi(2)));
        (square.sqrt() / middle.abs(), mean(pairs.iter().map(|(a, r)| of(a) - of(r))) / middle.abs())
    };
    let ((settlement_error, settlement_bias), (stiffness_error, stiffness_bias)) =
        (error(|a| a.settlement), error(|a| a.stiffness));
    let mut times: Vec<f64> = pairs.iter().map(|(a, _)| a.time).collect();
    times.sort_by(f64::total_cmp);
    Row {
        chart,
        name,
        value,
        failed: answers.iter().filter(|a| a.is_none()).count(),
        settlement_error,
        stiffness_error,
        settlement_bias,
        stiffness_bias,
        residual: mean(pairs.iter().map(|(a, _)| a.residual)),
        time: times.get(times.len() / 2).copied().unwrap_or(f64::NAN),
    }
}

fn table(rows: &[Row], band: [f64; 2]) -> String {
    let mut text = String::from(
        "chart,setting,value,failed,settlement_error,stiffness_error,settlement_bias,stiffness_bias,energy_residual,seconds_per_second\n",
    );
    let _ = writeln!(text, "band,scatter of {SEEDS} seeds,,0,{:.5e},{:.5e},,,,", band[0], band[1]);
    for row in rows {
        let numbers = [
            row.settlement_error,
            row.stiffness_error,
            row.settlement_bias,
            row.stiffness_bias,
            row.residual,
            row.time,
        ];
        // where every run failed there is nothing to say
        let numbers = numbers.map(|n| if n.is_finite() { format!("{n:.5e}") } else { String::new() });
        let _ = writeln!(text, "{},{},{},{},{}", row.chart, row.name, row.value, row.failed, numbers.join(","));
    }
    text
}

/// The rows of a [`table`], and its band.
fn read(text: &str) -> Option<(Vec<Row>, [f64; 2])> {
    let mut lines = text.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let number = |cell: &str| if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
    let head = lines.next()?;
    let band = [number(head.get(4)?)?, number(head.get(5)?)?];
    let row = |cells: Vec<&str>| -> Option<Row> {
        let of = |k: usize| number(cells.get(k)?);
        let charts = ["step", "precision", "skin", "pebbles", "scaling"];
        Some(Row {
            chart: charts.into_iter().find(|chart| *chart == cells[0])?,
            name: cells.get(1)?.to_string(),
            value: of(2)?,
            failed: cells.get(3)?.parse().ok()?,
            settlement_error: of(4)?,
            stiffness_error: of(5)?,
            settlement_bias: of(6)?,
            stiffness_bias: of(7)?,
            residual: of(8)?,
            time: of(9)?,
        })
    };
    Some((lines.map(row).collect::<Option<_>>()?, band))
}
