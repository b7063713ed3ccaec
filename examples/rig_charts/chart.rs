//! Panels: settlement and stiffness against wall time, one setting changed in each, with the scatter of packings as a
//! band.

use super::Row;
use super::test::Answer;
use std::fmt::Write as _;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 1140.0;
const PANEL: (f64, f64) = (320.0, 250.0);
/// Ends of a vertical axis, over the mean of the usual setting, as powers of two: of most panels, and of a setting that
/// changes more.
const ENDS: [f64; 2] = [-2.0, 3.0];
const WIDE: [f64; 2] = [-8.0, 4.0];
const HIGH: [f64; 2] = [-2.0, 6.0];
/// Of two, named at the side.
const POWERS: [f64; 11] = [1.0 / 256.0, 1.0 / 64.0, 1.0 / 16.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0];
/// Seconds that may be named below.
const TICKS: [f64; 14] = [5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 150.0, 200.0, 300.0, 500.0];

const PANELS: [(&str, &str, [f64; 2]); 7] = [
    ("friction", "Friction while packed (usual: 0.2)", WIDE),
    ("pebbles", "Pebbles a grain (usual: 2 or 3)", HIGH),
    ("scale", "Particle scale (usual: 1)", ENDS),
    ("pressure", "Pressure while packed (usual: 200 kPa)", ENDS),
    ("step", "Mass added as inertia (usual: 0.5 %)", ENDS),
    ("criterion", "Force out of balance of a lift (usual: 0.01)", ENDS),
    ("length", "Length of the cell (usual: 1 bay)", ENDS),
];

const STYLE: &str = "text{font:12px system-ui,sans-serif;fill:#1d2733}.t{font-weight:600;font-size:13px}.m{fill:#5b6877}\
.a{stroke:#c9d1da;stroke-width:1}.f{fill:none;stroke:#8a97a6}.b{fill:#dbe9f1}.c{fill:#f6e3d8}.s{stroke:#0b6e99;fill:#0b6e99}\
.k{stroke:#c2571a;fill:#c2571a}.o{fill:#fff}.e{stroke-width:1.4}";

/// What is shown of a test, and the classes of its marks and of its band.
type Series = (&'static str, &'static str, fn(&Answer) -> f64);

const SERIES: [Series; 2] = [("k", "c", |a| a.stiffness), ("s", "b", |a| a.growth)];

/// Mean and its standard error.
#[derive(Clone, Copy)]
struct Mean {
    value: f64,
    error: f64,
}

fn mean(answers: &[&Answer], of: impl Fn(&Answer) -> f64) -> Mean {
    let count = answers.len() as f64;
    let value = answers.iter().map(|a| of(a)).sum::<f64>() / count;
    let square = answers.iter().map(|a| (of(a) - value).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    Mean { value, error: (square / count).sqrt() }
}

/// Settings of a chart in their order, with what their tests answered.
fn settings<'a>(rows: &'a [Row], chart: &str) -> Vec<(&'a str, Vec<&'a Answer>)> {
    let mut found: Vec<(&str, Vec<&Answer>)> = Vec::new();
    for row in rows.iter().filter(|row| row.chart == chart) {
        let Ok(answer) = &row.answer else { continue };
        match found.iter_mut().find(|(name, _)| *name == row.name) {
            Some((_, answers)) => answers.push(answer),
            None => found.push((&row.name, vec![answer])),
        }
    }
    found
}

pub fn draw(rows: &[Row]) -> String {
    let mut svg = String::new();
    let usual = settings(rows, "usual").into_iter().flat_map(|(_, answers)| answers).collect::<Vec<_>>();
    let _ = write!(
        svg,
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' width='{WIDTH}' height='{HEIGHT}'><style>{STYLE}</style>\
         <rect width='{WIDTH}' height='{HEIGHT}' fill='#fff'/>\
         <text class='t' x='30' y='28'>Half a sleeper on 0.3 m of ballast, ten cycles of 5 to 60 kN: what each setting costs and changes</text>"
    );
    legend(&mut svg, rows, &usual);
    for (number, (chart, title, ends)) in PANELS.iter().enumerate() {
        let at = (70.0 + (number % 3) as f64 * 385.0, 130.0 + (number / 3) as f64 * 350.0);
        let mut shown = settings(rows, chart);
        shown.push(("usual", usual.clone()));
        panel(&mut svg, title, *ends, &shown, &usual, at);
    }
    svg.push_str("</svg>\n");
    svg
}

fn legend(svg: &mut String, rows: &[Row], usual: &[&Answer]) {
    let [stiffness, growth] = SERIES.map(|(_, _, of)| mean(usual, of));
    let scatter = |m: Mean| 100.0 * m.error * (usual.len() as f64).sqrt() / m.value;
    let failed = rows.iter().filter(|row| row.answer.is_err()).count();
    let _ = write!(
        svg,
        "<circle class='s' cx='36' cy='52' r='4'/><text x='48' y='56'>settlement from cycle 2 to 10 over its usual mean, {:.3} mm (one packing scatters by {:.0} %)</text>\
         <circle class='k' cx='36' cy='74' r='4'/><text x='48' y='78'>resilient stiffness of cycle 10 over its usual mean, {:.0} MN/m ({:.0} %)</text>\
         <text class='m' x='640' y='56'>Means of {} packings (usual: {}) with standard errors; bands: of the usual.</text>\
         <text class='m' x='640' y='78'>Across: seconds to pack and test, on one core of two. Tests that failed: {failed}.</text>\
         <text class='m' x='640' y='100'>* has a mark beyond its axis.</text>",
        1e3 * growth.value,
        scatter(growth),
        1e-6 * stiffness.value,
        scatter(stiffness),
        super::SEEDS,
        usual.len(),
    );
}

fn panel(
    svg: &mut String,
    title: &str,
    [lowest, highest]: [f64; 2],
    shown: &[(&str, Vec<&Answer>)],
    usual: &[&Answer],
    (left, top): (f64, f64),
) {
    let (width, height) = PANEL;
    let seconds = |answers: &[&Answer]| mean(answers, |a| a.packing + a.testing).value;
    let times: Vec<f64> = shown.iter().map(|(_, answers)| seconds(answers)).collect();
    let least = 0.8 * times.iter().copied().fold(f64::INFINITY, f64::min);
    let most = 1.25 * times.iter().copied().fold(0.0, f64::max);
    let x = |time: f64| left + width * (time / least).ln() / (most / least).ln();
    let y = |value: f64| top + height * (highest - value.max(1e-9).log2().clamp(lowest, highest)) / (highest - lowest);
    let _ = write!(svg, "<text class='t' x='{left}' y='{}'>{title}</text>", top - 12.0);
    for (_, band, of) in SERIES.into_iter().rev() {
        let Mean { value, error } = mean(usual, of);
        let (high, low) = (y(1.0 + error / value), y(1.0 - error / value));
        let _ =
            write!(svg, "<rect class='{band}' x='{left}' y='{high:.1}' width='{width}' height='{:.1}'/>", low - high);
    }
    for tick in POWERS.into_iter().filter(|tick| (lowest..=highest).contains(&tick.log2())) {
        let at = y(tick);
        let _ = write!(
            svg,
            "<path class='a' d='M{left} {at}h{width}'/><text class='m' text-anchor='end' x='{}' y='{}'>{}</text>",
            left - 6.0,
            at + 4.0,
            if tick < 0.25 { format!("1/{}", 1.0 / tick) } else { tick.to_string() }
        );
    }
    for tick in TICKS.into_iter().filter(|tick| (least..most).contains(tick)) {
        let (at, under) = (x(tick), top + height);
        let _ = write!(
            svg,
            "<path class='a' d='M{at:.1} {under}v5'/><text class='m' text-anchor='middle' x='{at:.1}' y='{}'>{tick} s</text>",
            under + 18.0
        );
    }
    let _ = write!(svg, "<rect class='f' x='{left}' y='{top}' width='{width}' height='{height}'/>");
    for (mark, _, of) in SERIES {
        let whole = mean(usual, of).value;
        for ((name, answers), time) in shown.iter().zip(&times) {
            let Mean { value, error } = mean(answers, of);
            if beyond(value / whole, [lowest, highest]) {
                continue;
            }
            let (at, middle) = (x(*time), y(value / whole));
            let (high, low) = (y((value + error) / whole), y((value - error) / whole));
            let open = if *name == "usual" { " o" } else { "" };
            let _ = write!(
                svg,
                "<path class='{mark} e' d='M{at:.1} {high:.1}V{low:.1}'/><circle class='{mark}{open}' cx='{at:.1}' cy='{middle:.1}' r='4'/>"
            );
        }
    }
    let starred = |name: &str, answers: &[&Answer]| {
        let lost = |(_, _, of): &Series| beyond(mean(answers, of).value / mean(usual, of).value, [lowest, highest]);
        format!("{name}{}", if SERIES.iter().any(lost) { "*" } else { "" })
    };
    let named = shown.iter().zip(&times).map(|((name, answers), time)| (x(*time), starred(name, answers)));
    names(svg, named.collect(), top + 14.0);
}

/// Whether a value, over that of the usual setting, lies outside of an axis.
fn beyond(value: f64, [lowest, highest]: [f64; 2]) -> bool {
    !(lowest..=highest).contains(&value.max(1e-9).log2())
}

/// Names above their marks, in rows where they would lie on each other.
fn names(svg: &mut String, mut marks: Vec<(f64, String)>, top: f64) {
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut ends = [f64::NEG_INFINITY; 4];
    for (at, name) in marks {
        let half = 3.4 * name.chars().count() as f64;
        let row = ends.iter().position(|end| *end < at - half - 4.0).unwrap_or(0);
        ends[row] = at + half;
        let _ = write!(svg, "<text text-anchor='middle' x='{at:.1}' y='{}'>{name}</text>", top + 14.0 * row as f64);
    }
}
