//! Five panels: error of a load cycle against what the setting changes, with the scatter of seeds as a band.

use super::Row;
use std::fmt::Write as _;

const WIDTH: f64 = 1180.0;
const PANEL: (f64, f64) = (330.0, 250.0);
const LEAST: f64 = 1e-6;
const MOST: f64 = 10.0;

/// One panel: its rows, its title and its axis.
struct Panel {
    chart: &'static str,
    title: &'static str,
    axis: &'static str,
    logarithmic: bool,
}

/// Class of a line's marks, and what it shows.
type Series = (&'static str, fn(&Row) -> f64);

const PANELS: [Panel; 5] = [
    Panel { chart: "step", title: "Time step", axis: "step over the limit of the contact network", logarithmic: false },
    Panel {
        chart: "precision",
        title: "Precision",
        axis: "step over the limit; mixed filled, f64 open",
        logarithmic: false,
    },
    Panel { chart: "skin", title: "Reach of neighbour lists", axis: "skin, mm", logarithmic: true },
    Panel { chart: "pebbles", title: "Pebbles a clump, against 8", axis: "pebbles", logarithmic: false },
    Panel {
        chart: "scaling",
        title: "Selective mass scaling",
        axis: "step over the unscaled limit, times 0.85",
        logarithmic: false,
    },
];

const STYLE: &str = "text{font:12px system-ui,sans-serif;fill:#1d2733}.t{font-weight:600;font-size:14px}.m{fill:#5b6877}\
.a{stroke:#c9d1da;stroke-width:1}.f{fill:none;stroke:#8a97a6}.b{fill:#e9eef4}.s{stroke:#0b6e99;fill:#0b6e99}\
.k{stroke:#c2571a;fill:#c2571a}.r{stroke:#6a8f3c;fill:#6a8f3c}.o{fill:#fff}.l{fill:none;stroke-width:1.6}.x{fill:#b3261e}";

pub fn draw(rows: &[Row], band: [f64; 2]) -> String {
    let mut svg = String::new();
    let _ = write!(
        svg,
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} 720' width='{WIDTH}' height='720'><style>{STYLE}</style>\
         <rect width='{WIDTH}' height='720' fill='#fff'/>\
         <text class='t' x='30' y='28'>A bed of 200 grains, loaded to 50 kPa and unloaded: what each setting costs and spoils</text>"
    );
    legend(&mut svg, band);
    for (number, panel) in PANELS.iter().enumerate() {
        let at = (70.0 + (number % 3) as f64 * 385.0, 90.0 + (number / 3) as f64 * 325.0);
        let mine: Vec<&Row> = rows.iter().filter(|r| r.chart == panel.chart).collect();
        draw_panel(&mut svg, panel, &mine, at, band);
    }
    svg.push_str("</svg>\n");
    svg
}

fn legend(svg: &mut String, band: [f64; 2]) {
    let items = [
        ("s", "settlement, root mean square over 5 seeds".to_string()),
        ("k", "stiffness, the same".to_string()),
        ("r", "energy unaccounted for over work".to_string()),
    ];
    for (number, (class, text)) in items.iter().enumerate() {
        let y = 455.0 + 26.0 * number as f64;
        let _ =
            write!(svg, "<circle class='{class}' cx='850' cy='{y}' r='4'/><text x='864' y='{}'>{text}</text>", y + 4.0);
    }
    let _ = write!(
        svg,
        "<rect class='b' x='842' y='527' width='16' height='12'/><text x='864' y='537'>below the scatter of seeds: {:.0} % of</text>\
         <text x='864' y='553'>settlement (top of band), {:.1} % of stiffness (line)</text>\
         <text class='x' x='844' y='579'>✕</text><text x='864' y='579'>stopped by the solver, with a message</text>\
         <text class='m' x='842' y='611'>Numbers at the bottom: wall seconds for a</text>\
         <text class='m' x='842' y='627'>second of the bed, one core, two runs at a time.</text>",
        100.0 * band[0],
        100.0 * band[1]
    );
}

fn draw_panel(svg: &mut String, panel: &Panel, rows: &[&Row], (left, top): (f64, f64), band: [f64; 2]) {
    let (width, height) = PANEL;
    let of = |value: f64| if panel.logarithmic { value.log10() } else { value };
    let (low, high) =
        rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), r| (l.min(of(r.value)), h.max(of(r.value))));
    let x = |value: f64| left + 16.0 + (width - 32.0) * (of(value) - low) / (high - low).max(1e-9);
    let y = |error: f64| {
        let share = (error.clamp(LEAST, MOST).log10() - LEAST.log10()) / (MOST.log10() - LEAST.log10());
        top + height * (1.0 - share)
    };
    let _ = write!(svg, "<text class='t' x='{left}' y='{}'>{}</text>", top - 10.0, panel.title);
    let _ = write!(
        svg,
        "<rect class='b' x='{left}' y='{}' width='{width}' height='{}'/>",
        y(band[0]),
        top + height - y(band[0])
    );
    for power in -6..=1 {
        let at = y(10f64.powi(power));
        let _ = write!(
            svg,
            "<path class='a' d='M{left} {at}h{width}'/><text class='m' text-anchor='end' x='{}' y='{}'>1e{power}</text>",
            left - 6.0,
            at + 4.0
        );
    }
    let _ = write!(svg, "<path class='k' stroke-dasharray='5 4' d='M{left} {0}h{width}'/>", y(band[1]));
    let _ = write!(svg, "<rect class='f' x='{left}' y='{top}' width='{width}' height='{height}'/>");
    let mut labels: Vec<f64> = rows.iter().map(|r| r.value).collect();
    labels.dedup();
    let mut last = f64::NEG_INFINITY;
    for value in labels {
        // names that would lie on each other
        if x(value) - last < 28.0 {
            continue;
        }
        last = x(value);
        let _ = write!(
            svg,
            "<text class='m' text-anchor='middle' x='{}' y='{}'>{value}</text>",
            x(value),
            top + height + 16.0
        );
    }
    let _ = write!(
        svg,
        "<text text-anchor='middle' x='{}' y='{}'>{}</text>",
        left + width / 2.0,
        top + height + 34.0,
        panel.axis
    );
    let series: [Series; 3] = [("r", |r| r.residual), ("k", |r| r.stiffness_error), ("s", |r| r.settlement_error)];
    for (class, value) in series {
        let open = |row: &Row| row.name.starts_with("f64");
        for double in [false, true] {
            let points: Vec<(f64, f64)> = rows
                .iter()
                .filter(|r| open(r) == double && value(r).is_finite())
                .map(|r| (x(r.value), y(value(r))))
                .collect();
            let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
            if !path.is_empty() {
                let _ = write!(svg, "<path class='{class} l' d='M{}'/>", path.join("L"));
            }
            for (x, y) in points {
                let _ = write!(
                    svg,
                    "<circle class='{class}{}' cx='{x:.1}' cy='{y:.1}' r='3.5'/>",
                    if double { " o" } else { "" }
                );
            }
        }
    }
    for row in rows.iter().filter(|r| r.settlement_error.is_finite() && !r.name.starts_with("f64")) {
        let _ = write!(
            svg,
            "<text class='m' text-anchor='middle' x='{}' y='{}'>{:.1}</text>",
            x(row.value),
            top + height - 8.0,
            row.time
        );
    }
    for row in rows.iter().filter(|r| r.failed > 0) {
        let _ = write!(
            svg,
            "<text class='x' text-anchor='middle' x='{}' y='{}'>✕ {}</text>",
            x(row.value),
            top + 16.0,
            row.failed
        );
    }
}
