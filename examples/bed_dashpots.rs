//! How long a step of a track's bed may be, by the ratio of its dashpots: limits of the network of contacts, and runs
//! on both sides of them.
//!
//! ```text
//! cargo run --release --example bed_dashpots -- DIR [SCENE] [FOLDER]
//! ```
//!
//! `DIR` keeps the packed cell, which takes a minute to make. Writes `bed_dashpots.csv` and `bed_dashpots.svg` into the
//! folder.

use std::fmt::Write;
use trackbed::lower::{BedUse, beds};
use trackbed::solvers::granular::packing::{Order, lay};
use trackbed::solvers::granular::{Bed, ContactLaw, Dashpot};
use trackbed::store::Beds;

/// Ratios of the dashpots of a contact, and steps over the limit of the network at which the bed is run.
const RATIOS: [f64; 9] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0];
const SHARES: [f64; 4] = [0.9, 0.98, 1.05, 1.2];
/// Steps of a run: a bed that grows by a thousandth a step is found long before.
const STEPS: u64 = 4000;
/// Share of the mass that may be added as inertia.
const ADDED: f64 = 0.02;
/// Which dashpots there are.
const KINDS: [(&str, f64); 2] = [("normal", 0.0), ("normal and shear", 1.0)];

/// Limits with dashpots of a ratio, us, and at which shares of the network's the bed stayed calm.
struct Row {
    kind: usize,
    ratio: f64,
    pfc: f64,
    bound: f64,
    network: f64,
    held: f64,
    calm: Vec<bool>,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let cells = words.first().expect("bed_dashpots DIR [SCENE] [FOLDER]");
    let scene = words.get(1).map_or("scenarios/transition_full.track", String::as_str);
    let folder = words.get(2).map_or("docs/charts", String::as_str);
    let bed = bed(scene, cells);
    let mut rows = Vec::new();
    for (kind, (name, shear)) in KINDS.iter().enumerate() {
        for ratio in RATIOS {
            rows.push(row(&bed, kind, ratio, shear * ratio));
            eprintln!("{name} {ratio}: {:.1} us", rows.last().map_or(0.0, |row| row.network));
        }
    }
    std::fs::write(format!("{folder}/bed_dashpots.csv"), csv(&rows)).expect("a table");
    std::fs::write(format!("{folder}/bed_dashpots.svg"), svg(&rows)).expect("a chart");
}

/// One bay of a scene's track at rest.
fn bed(scene: &str, cells: &str) -> Bed {
    let scene = trackbed::Scene::open(scene).expect("a scene").check();
    let scenario = scene.scenario.as_ref().expect("a scene without errors");
    let plans = beds(scenario, BedUse::Track).expect("beds");
    let recipe = plans[0].ready(plans[0].seed()).expect("clumps").recipe;
    let cell = Beds::kept_in(cells).bed(&recipe, |_| ()).expect("a bed").packed;
    lay(&[cell], &Order::of_one(1), &recipe, |_| ()).expect("a bed of a track").bed
}

fn row(rest: &Bed, kind: usize, normal: f64, shear: f64) -> Row {
    let mut bed = rest.clone();
    bed.change_laws(|law| {
        if let ContactLaw::Linear(law) = law {
            law.dashpot = Dashpot::Ratio { normal, shear };
        }
    });
    let limits = bed.critical_step(0.0).expect("limits");
    let goes_on = |share: f64| {
        let mut bed = bed.clone();
        bed.set_time_step(share * limits.network.step);
        bed.run(STEPS).is_ok()
    };
    let calm = SHARES.iter().map(|share| goes_on(*share)).collect();
    let held = bed.hold_longest_step(ADDED, 0.0).expect("inertia").limit;
    let [pfc, bound, network, held] =
        [limits.estimate.step, limits.bound.step, limits.network.step, held].map(|step| 1e6 * step);
    Row { kind, ratio: normal, pfc, bound, network, held, calm }
}

fn csv(rows: &[Row]) -> String {
    let mut out = "dashpots,ratio,pfc_us,bound_us,network_us,with_2_percent_mass_us".to_owned();
    SHARES.iter().for_each(|share| _ = write!(out, ",at_{share}"));
    for row in rows {
        let Row { ratio, pfc, bound, network, held, .. } = row;
        let _ = write!(out, "\n{},{ratio},{pfc:.2},{bound:.2},{network:.2},{held:.2}", KINDS[row.kind].0);
        row.calm.iter().for_each(|calm| _ = write!(out, ",{}", if *calm { "goes on" } else { "stopped" }));
    }
    out + "\n"
}

const SIZE: [f64; 2] = [760.0, 420.0];
const PLOT: [f64; 4] = [70.0, 70.0, 430.0, 290.0];
const STYLE: &str = "text{font:13px system-ui,sans-serif;fill:#222}.m{fill:#666}path{fill:none;stroke-width:2}\
    .paper{fill:#fff}.grid{stroke:#ddd;stroke-width:1}.k0{stroke:#1a6fb0}.k1{stroke:#c4581b}.held{stroke-dasharray:6 4}\
    circle.calm{stroke:none}circle.k0.calm{fill:#1a6fb0}circle.k1.calm{fill:#c4581b}circle.grows{fill:#fff;stroke-width:1.6}";

fn svg(rows: &[Row]) -> String {
    let [width, height] = SIZE;
    let [left, top, across, up] = PLOT;
    let highest =
        rows.iter().map(|row| row.held.max(1.25 * row.network)).fold(0.0, f64::max).div_euclid(5.0) * 5.0 + 5.0;
    let place = |ratio: f64, step: f64| (left + across * ratio, top + up * (1.0 - step / highest));
    let mut s = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' width='{width}' height='{height}' role='img' \
         aria-label='Longest step of the bed by damping ratio'><style>{STYLE}</style><rect class='paper' width='{width}' height='{height}'/>\
         <text x='16' y='26' font-weight='600'>Longest step of a bed of the paper, by the ratio of its dashpots</text>\
         <text class='m' x='16' y='46'>Filled: {STEPS} steps without growth. Hollow: stopped, and told why. Ordinate: step, us.</text>"
    );
    for tick in 0..=(highest / 5.0) as usize {
        let (x, y) = place(0.0, 5.0 * tick as f64);
        let _ = write!(
            s,
            "<path class='grid' d='M{x} {y:.1} h{across}'/><text class='m' x='{}' y='{:.1}' text-anchor='end'>{}</text>",
            x - 8.0,
            y + 4.0,
            5 * tick
        );
    }
    for ratio in RATIOS.iter().filter(|ratio| (*ratio * 10.0).fract() < 1e-9) {
        let (x, y) = place(*ratio, 0.0);
        let _ = write!(s, "<text class='m' x='{x}' y='{}' text-anchor='middle'>{ratio}</text>", y + 20.0);
    }
    let _ = write!(
        s,
        "<text class='m' x='{}' y='{}' text-anchor='middle'>damping ratio of a contact</text>",
        left + 0.5 * across,
        top + up + 42.0
    );
    for (kind, (name, _)) in KINDS.iter().enumerate() {
        let of_kind = || rows.iter().filter(move |row| row.kind == kind);
        let path = |value: fn(&Row) -> f64| -> String {
            let points: Vec<String> =
                of_kind().map(|row| place(row.ratio, value(row))).map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
            format!("M{}", points.join(" L"))
        };
        let _ = write!(s, "<path class='k{kind}' d='{}'/>", path(|row| row.network));
        let _ = write!(s, "<path class='k{kind} held' d='{}'/>", path(|row| row.held));
        for row in of_kind() {
            for (share, calm) in SHARES.iter().zip(&row.calm) {
                let (x, y) = place(row.ratio, share * row.network);
                let class = if *calm { "calm" } else { "grows" };
                let _ = write!(s, "<circle class='k{kind} {class}' cx='{x:.1}' cy='{y:.1}' r='3.4'/>");
            }
        }
        for (line, (class, what)) in
            [("", "limit of the network"), (" held", "with 2 % of the mass as inertia")].iter().enumerate()
        {
            let (x, y) = (left + across + 14.0, 110.0 + 80.0 * kind as f64 + 24.0 * line as f64);
            if line == 0 {
                let _ = write!(s, "<text x='{x}' y='{}'>dashpots {name}</text>", y - 18.0);
            }
            let _ = write!(
                s,
                "<path class='k{kind}{class}' d='M{x} {} h24'/><text class='m' x='{}' y='{y}'>{what}</text>",
                y - 4.0,
                x + 30.0
            );
        }
    }
    s + "</svg>\n"
}
