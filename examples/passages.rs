//! What a sleeper feels under a wagon alone and under a train: one history of two runs in one chart.
//!
//! ```text
//! trackbed run SCENE --out ALONE --set solve.passages=isolated
//! trackbed run SCENE --out TRAIN --set solve.passages=continuous
//! cargo run --release --example passages -- ALONE TRAIN [SLEEPER] [FOLDER]
//! ```
//!
//! Both runs must record `rail_seat_load` at the sleeper. Writes `passages.csv` and `passages.svg` into the folder.

use std::fmt::Write;
use std::path::Path;
use trackbed::results::read;

const QUANTITY: &str = "rail_seat_load";
const KINDS: [&str; 2] = ["wagons alone", "continuous train"];

/// Times, s, and loads of a seat, kN, of the first passage that was recorded.
fn history(directory: &str, sleeper: &str) -> Vec<(f64, f64)> {
    let run = read(Path::new(directory)).expect("a run");
    let first = run.histories.iter().map(|row| row.axles).min().unwrap_or(0);
    let here = run.histories.iter().filter(|row| row.axles == first && row.quantity == QUANTITY && row.id == sleeper);
    let loads: Vec<(f64, f64)> = here.map(|row| (row.time_s, 1e-3 * row.value)).collect();
    assert!(!loads.is_empty(), "{directory} has no {QUANTITY} at {sleeper}");
    loads
}

/// From the first moment that half of the largest load is reached, s.
fn from_first_wheel(loads: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let largest = loads.iter().map(|(_, load)| *load).fold(0.0, f64::max);
    let start = loads.iter().find(|(_, load)| *load > 0.5 * largest).map_or(0.0, |(time, _)| *time);
    loads.into_iter().map(|(time, load)| (time - start, load)).filter(|(time, _)| (-0.1..0.6).contains(time)).collect()
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [alone, train] = [0, 1].map(|k| words.get(k).expect("passages ALONE TRAIN [SLEEPER] [FOLDER]"));
    let sleeper = words.get(2).map_or("-1", String::as_str);
    let folder = words.get(3).map_or("docs/charts", String::as_str);
    let lines = [alone, train].map(|directory| from_first_wheel(history(directory, sleeper)));
    let mut csv = "passages,time_s,rail_seat_load_kN\n".to_owned();
    for (kind, line) in KINDS.iter().zip(&lines) {
        line.iter().for_each(|(time, load)| _ = writeln!(csv, "{kind},{time:.4},{load:.3}"));
    }
    std::fs::write(format!("{folder}/passages.csv"), csv).expect("a table");
    std::fs::write(format!("{folder}/passages.svg"), svg(sleeper, &lines)).expect("a chart");
}

const SIZE: [f64; 2] = [760.0, 380.0];
const PLOT: [f64; 4] = [64.0, 60.0, 660.0, 260.0];
/// Ends of the axis of time, s.
const TIMES: [f64; 2] = [-0.1, 0.6];
const STYLE: &str = "text{font:13px system-ui,sans-serif;fill:#222}.m{fill:#666}path{fill:none;stroke-width:1.8}\
    .paper{fill:#fff}.grid{stroke:#ddd;stroke-width:1}.k0{stroke:#c4581b}.k1{stroke:#1a6fb0}";

fn svg(sleeper: &str, lines: &[Vec<(f64, f64)>; 2]) -> String {
    let ([width, height], [left, top, across, up]) = (SIZE, PLOT);
    let most = lines.iter().flatten().map(|(_, load)| *load).fold(0.0, f64::max);
    let highest = (most / 10.0).ceil() * 10.0;
    let place = |time: f64, load: f64| {
        (left + across * (time - TIMES[0]) / (TIMES[1] - TIMES[0]), top + up * (1.0 - load / highest))
    };
    let mut s = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' width='{width}' height='{height}' role='img' \
         aria-label='Rail seat load under wagons alone and a train'><style>{STYLE}</style><rect class='paper' width='{width}' height='{height}'/>\
         <text x='16' y='26' font-weight='600'>Rail seat load of sleeper {sleeper}, kN</text>"
    );
    for tick in 0..=(highest / 10.0) as usize {
        let (x, y) = place(TIMES[0], 10.0 * tick as f64);
        let label = 10 * tick;
        let _ = write!(s, "<path class='grid' d='M{x} {y:.1} h{across}'/>");
        let _ = write!(s, "<text class='m' x='{}' y='{:.1}' text-anchor='end'>{label}</text>", x - 8.0, y + 4.0);
    }
    for tick in -1..=6 {
        let (x, y) = place(0.1 * f64::from(tick), 0.0);
        let label = 100 * tick;
        let _ = write!(s, "<text class='m' x='{x:.1}' y='{}' text-anchor='middle'>{label}</text>", y + 20.0);
    }
    let middle = left + 0.5 * across;
    let _ = write!(
        s,
        "<text class='m' x='{middle}' y='{}' text-anchor='middle'>time from the first wheel, ms</text>",
        top + up + 42.0
    );
    for (kind, (name, line)) in KINDS.iter().zip(lines).enumerate() {
        let points = line.iter().map(|(time, load)| place(*time, *load)).map(|(x, y)| format!("{x:.1} {y:.1}"));
        let _ = write!(s, "<path class='k{kind}' d='M{}'/>", points.collect::<Vec<_>>().join(" L"));
        let x = 330.0 + 190.0 * kind as f64;
        let _ =
            write!(s, "<path class='k{kind}' d='M{x} 22 h24'/><text class='m' x='{}' y='26'>{name}</text>", x + 30.0);
    }
    s + "</svg>\n"
}
