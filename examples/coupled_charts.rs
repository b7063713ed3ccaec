//! Charts of coupled runs, each from the directories of several runs.
//!
//! ```text
//! cargo run --release --example coupled_charts -- passages ALONE TRAIN
//! cargo run --release --example coupled_charts -- tiers NAME=DIR NAME=DIR ...
//! ```
//!
//! `passages` draws what a sleeper presses on its ballast with under wagons one by one (`--set
//! solve.passages=isolated`) and under a train (`=continuous`); both runs record `contact_force` at sleeper -1. `tiers`
//! draws the settlement of the sleepers before a structure at the last count that all runs recorded. A chart and its
//! table go to `docs/charts`.

use std::fmt::Write;
use std::path::Path;
use trackbed::results::{Run, read};

const FOLDER: &str = "docs/charts";
/// The sleeper of `passages`.
const SLEEPER: &str = "-1";
/// From the first wheel on, s.
const TIMES: [f64; 2] = [-0.1, 0.5];
/// Chainage of `tiers`, m.
const PLACES: [f64; 2] = [-5.4, 0.0];

/// A line of a chart.
struct Line {
    name: String,
    points: Vec<(f64, f64)>,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.split_first() {
        Some((kind, runs)) if kind == "passages" && runs.len() == 2 => passages(&runs[0], &runs[1]),
        Some((kind, runs)) if kind == "tiers" && !runs.is_empty() => tiers(runs),
        _ => panic!("coupled_charts passages ALONE TRAIN, or tiers NAME=DIR ..."),
    }
}

fn open(directory: &str) -> Run {
    read(Path::new(directory)).unwrap_or_else(|error| panic!("{directory}: {error}"))
}

fn passages(alone: &str, train: &str) {
    let lines = [("wagons alone", alone), ("continuous train", train)].map(|(name, directory)| {
        let points = from_first_wheel(contact_force(&open(directory)));
        Line { name: name.to_owned(), points }
    });
    let axes = Axes {
        title: format!("Force of sleeper {SLEEPER} on its ballast, kN"),
        across: "time from the first wheel, s",
        ends: TIMES,
        tick: 0.1,
        step: 10.0,
    };
    axes.save("passages", "passages,time_s,contact_force_kN", &lines);
}

/// Times, s, and forces, kN, in the first passage that was recorded.
fn contact_force(run: &Run) -> Vec<(f64, f64)> {
    let first = run.histories.iter().map(|row| row.axles).min().unwrap_or(0);
    let is_meant = |axles: u64, quantity: &str, id: &str| (axles, quantity, id) == (first, "contact_force", SLEEPER);
    let rows = run.histories.iter().filter(|row| is_meant(row.axles, &row.quantity, &row.id));
    rows.map(|row| (row.time_s, 1e-3 * row.value)).collect()
}

/// The same, from the moment at which half of the largest force is reached first.
fn from_first_wheel(forces: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let largest = forces.iter().map(|(_, force)| *force).fold(0.0, f64::max);
    let start = forces.iter().find(|(_, force)| *force > 0.5 * largest).map_or(0.0, |(time, _)| *time);
    let shown = |(time, _): &(f64, f64)| (TIMES[0]..TIMES[1]).contains(time);
    forces.into_iter().map(|(time, force)| (time - start, force)).filter(shown).collect()
}

fn tiers(runs: &[String]) {
    let runs: Vec<(&str, Run)> = runs
        .iter()
        .map(|run| {
            let (name, directory) = run.split_once('=').expect("NAME=DIR");
            (name, open(directory))
        })
        .collect();
    let last = |run: &Run| run.sleepers.iter().map(|row| row.axles).max().unwrap_or(0);
    let axles = runs.iter().map(|(_, run)| last(run)).min().unwrap_or(0);
    let lines: Vec<Line> = runs
        .iter()
        .map(|(name, run)| {
            let shown =
                run.sleepers.iter().filter(|row| row.axles == axles && (PLACES[0]..PLACES[1]).contains(&row.x_m));
            let points = shown.map(|row| (row.x_m, 1e6 * row.settlement_m)).collect();
            Line { name: (*name).to_owned(), points }
        })
        .collect();
    let axes = Axes {
        title: format!("Settlement after {axles} axles, um"),
        across: "chainage, m; the structure begins at 0",
        ends: PLACES,
        tick: 0.6,
        step: 10.0,
    };
    axes.save("tiers", "run,x_m,settlement_um", &lines);
}

struct Axes {
    title: String,
    across: &'static str,
    /// Ends of the axis across, and the distance of its ticks and of those upwards, which begin at 0.
    ends: [f64; 2],
    tick: f64,
    step: f64,
}

const SIZE: [f64; 2] = [860.0, 390.0];
const PLOT: [f64; 4] = [64.0, 52.0, 560.0, 280.0];
const COLOURS: [&str; 8] = ["#c4581b", "#1a6fb0", "#2c8a4b", "#8a5cb5", "#b8901c", "#4aa3a3", "#a3336b", "#555555"];
const STYLE: &str = "text{font:13px system-ui,sans-serif;fill:#222}.m{fill:#666}path{fill:none;stroke-width:1.8}\
    .paper{fill:#fff}.grid{stroke:#ddd;stroke-width:1}";

impl Axes {
    fn save(&self, name: &str, head: &str, lines: &[Line]) {
        let mut csv = format!("{head}\n");
        for line in lines {
            line.points.iter().for_each(|(x, y)| _ = writeln!(csv, "{},{x:.4},{y:.3}", line.name));
        }
        std::fs::write(format!("{FOLDER}/{name}.csv"), csv).expect("a table");
        std::fs::write(format!("{FOLDER}/{name}.svg"), self.svg(lines)).expect("a chart");
    }

    fn svg(&self, lines: &[Line]) -> String {
        let ([width, height], [left, top, across, up]) = (SIZE, PLOT);
        let [from, to] = self.ends;
        let most = lines.iter().flat_map(|line| &line.points).map(|(_, y)| *y).fold(0.0, f64::max);
        let highest = (most / self.step).ceil().max(1.0) * self.step;
        let place = |x: f64, y: f64| (left + across * (x - from) / (to - from), top + up * (1.0 - y / highest));
        let title = &self.title;
        let mut s = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' width='{width}' height='{height}' role='img' \
             aria-label='{title}'><style>{STYLE}</style><rect class='paper' width='{width}' height='{height}'/>\
             <text x='16' y='26' font-weight='600'>{title}</text>"
        );
        for tick in 0..=(highest / self.step).round() as usize {
            let level = self.step * tick as f64;
            let (x, y) = place(from, level);
            let _ = write!(s, "<path class='grid' d='M{x} {y:.1} h{across}'/>");
            let _ = write!(s, "<text class='m' x='{}' y='{:.1}' text-anchor='end'>{level}</text>", x - 8.0, y + 4.0);
        }
        for tick in 0..=((to - from) / self.tick).round() as usize {
            // no -0.0 where the last tick is almost 0
            let value = (10.0 * (from + self.tick * tick as f64)).round() / 10.0 + 0.0;
            let (x, y) = (place(value, 0.0).0, top + up + 20.0);
            let _ = write!(s, "<text class='m' x='{x:.1}' y='{y}' text-anchor='middle'>{value:.1}</text>");
        }
        let (x, y) = (left + 0.5 * across, top + up + 42.0);
        let _ = write!(s, "<text class='m' x='{x}' y='{y}' text-anchor='middle'>{}</text>", self.across);
        for (number, line) in lines.iter().enumerate() {
            let stroke = COLOURS[number % COLOURS.len()];
            let points = line.points.iter().map(|(x, y)| place(*x, *y)).map(|(x, y)| format!("{x:.1} {y:.1}"));
            let _ = write!(s, "<path stroke='{stroke}' d='M{}'/>", points.collect::<Vec<_>>().join(" L"));
            let (x, y) = (left + across + 18.0, top + 12.0 + 22.0 * number as f64);
            let _ = write!(s, "<path stroke='{stroke}' d='M{x} {} h22'/>", y - 4.0);
            let _ = write!(s, "<text class='m' x='{}' y='{y}'>{}</text>", x + 28.0, line.name);
        }
        s + "</svg>\n"
    }
}
