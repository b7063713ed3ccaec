//! The picture: first loading of every seed, the load cycles of the first, coordination, and settlement over cycles.

use super::cycles::{Cycle, Outcome};
use super::experiment::Row;
use super::files::Reference;
use super::svg::{Anchor, Frame, Svg};

const WIDTH: f64 = 1080.0;
const PANEL: (f64, f64) = (516.0, 360.0);
const HEAD: f64 = 62.0;
const MARGIN: [f64; 4] = [60.0, 34.0, 14.0, 44.0];

/// A line of a diagram, in the diagram's units.
struct Line {
    class: &'static str,
    points: Vec<(f64, f64)>,
    /// Half the scatter at each point, and whether points are marked.
    bars: Vec<(f64, f64)>,
    dots: bool,
}

impl Line {
    fn plain(class: &'static str, points: Vec<(f64, f64)>) -> Line {
        Line { class, points, bars: Vec::new(), dots: false }
    }
}

struct Diagram {
    title: &'static str,
    across: &'static str,
    /// What goes down the axis grows downwards.
    downwards: bool,
    lines: Vec<Line>,
}

/// The whole picture; `name` says what was run.
pub fn draw(runs: &[Outcome], reference: Option<&Reference>, name: &str) -> String {
    let mut svg = Svg::default();
    svg.text("strong", (16.0, 24.0), Anchor::Start, name);
    let mut x = 16.0;
    let several = runs.len() > 1;
    let mut key = vec![("line s0", if several { "first seed" } else { "Trackbed" })];
    key.extend(several.then_some(("faint s0", "other seeds")));
    key.extend(reference.map(|_| ("line s1", "reference")));
    for (class, text) in key {
        svg.line(class, (x, 42.0), (x + 24.0, 42.0));
        svg.text("", (x + 30.0, 46.0), Anchor::Start, text);
        x += 48.0 + 7.0 * text.len() as f64;
    }
    for (index, diagram) in diagrams(runs, reference).iter().enumerate() {
        let (column, row) = ((index % 2) as f64, (index / 2) as f64);
        let at = (16.0 + column * (PANEL.0 + 16.0), HEAD + row * (PANEL.1 + 14.0));
        diagram.draw(&mut svg, at, &format!("plane-{index}"));
    }
    svg.finish(WIDTH, HEAD + 2.0 * (PANEL.1 + 14.0), name)
}

fn diagrams(runs: &[Outcome], reference: Option<&Reference>) -> [Diagram; 4] {
    let top = runs[0].compression[0].plate_height_m;
    let travel = move |row: &Row| (row.plate_kpa, 1e3 * (top - row.plate_height_m));
    let coordination = |row: &Row| (row.plate_kpa, row.coordination);
    // the reference is an outcome among others, on top of them
    let over_rows = |value: &dyn Fn(&Row) -> (f64, f64)| {
        let line = |class, rows: &[Row]| Line::plain(class, rows.iter().map(value).collect());
        let mut lines: Vec<Line> = runs.iter().skip(1).map(|run| line("faint s0", &run.compression)).collect();
        lines.push(line("line s0", &runs[0].compression));
        lines.extend(reference.map(|reference| line("line s1", &reference.compression)));
        lines
    };
    let whole: Vec<(f64, f64)> = runs[0].compression.iter().chain(&runs[0].path).map(travel).collect();
    let mut settling = vec![mean_settlement(runs)];
    settling.extend(
        reference.map(|reference| Line { dots: true, ..Line::plain("line s1", settlement(&reference.cycles)) }),
    );
    [
        Diagram {
            title: "Travel of the plate in first loading [mm]",
            across: "Pressure on the plate [kPa]",
            downwards: true,
            lines: over_rows(&travel),
        },
        Diagram {
            title: "Travel of the plate, all cycles of the first seed [mm]",
            across: "Pressure on the plate [kPa]",
            downwards: true,
            lines: vec![Line::plain("spring", whole)],
        },
        Diagram {
            title: "Coordination number in first loading",
            across: "Pressure on the plate [kPa]",
            downwards: false,
            lines: over_rows(&coordination),
        },
        Diagram {
            title: "Settlement since first unloading, mean and range of the seeds [mm]",
            across: "Load cycles",
            downwards: true,
            lines: settling,
        },
    ]
}

/// Since the end of the first unloading \[mm\].
fn settlement(cycles: &[Cycle]) -> Vec<(f64, f64)> {
    let from = cycles.first().map_or(0.0, |c| c.heights[2]);
    cycles.iter().map(|c| (c.number as f64, 1e3 * (from - c.heights[2]))).collect()
}

fn mean_settlement(runs: &[Outcome]) -> Line {
    let each: Vec<Vec<(f64, f64)>> = runs.iter().map(|run| settlement(&run.cycles)).collect();
    let at = |cycle: usize| each.iter().filter_map(move |run| run.get(cycle)).map(|point| point.1);
    let count = each[0].len();
    let points = (0..count).map(|k| (k as f64, at(k).sum::<f64>() / at(k).count() as f64)).collect();
    let bars = (0..count).map(|k| (at(k).fold(f64::INFINITY, f64::min), at(k).fold(f64::NEG_INFINITY, f64::max)));
    Line { class: "line s0", points, bars: bars.collect(), dots: true }
}

impl Diagram {
    fn draw(&self, svg: &mut Svg, (left, top): (f64, f64), id: &str) {
        let [l, t, r, b] = MARGIN;
        let plane = Frame { x: left + l, y: top + t, width: PANEL.0 - l - r, height: PANEL.1 - t - b };
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let ends = self.lines.iter().flat_map(|line| line.bars.iter().flat_map(|(low, high)| [*low, *high]));
        let (x, x_step) = scale(points().map(|p| p.0), 10.0);
        let (y, y_step) = scale(points().map(|p| p.1).chain(ends), 8.0);
        let at = |(px, py): (f64, f64)| {
            let up = (py - y.0) / (y.1 - y.0);
            let down = if self.downwards { up } else { 1.0 - up };
            (plane.x + (px - x.0) / (x.1 - x.0) * plane.width, plane.y + down * plane.height)
        };
        svg.text("strong", (left, top + 16.0), Anchor::Start, self.title);
        let (right, bottom) = (plane.x + plane.width, plane.y + plane.height);
        for value in ticks(x, x_step) {
            let (place, _) = at((value, y.0));
            svg.line("grid", (place, plane.y), (place, bottom));
            svg.text("small muted", (place, bottom + 16.0), Anchor::Middle, &label(value, x_step));
        }
        for value in ticks(y, y_step) {
            let (_, place) = at((x.0, value));
            svg.line("grid", (plane.x, place), (right, place));
            svg.text("small muted", (plane.x - 7.0, place + 4.0), Anchor::End, &label(value, y_step));
        }
        svg.line("axis", (plane.x, bottom), (right, bottom));
        svg.line("axis", (plane.x, plane.y), (plane.x, bottom));
        svg.text("", ((plane.x + right) / 2.0, bottom + 36.0), Anchor::Middle, self.across);
        svg.clipped(id, plane, |svg| {
            for line in &self.lines {
                line.draw(svg, &at);
            }
        });
    }
}

impl Line {
    fn draw(&self, svg: &mut Svg, at: &dyn Fn((f64, f64)) -> (f64, f64)) {
        let colour = self.class.split(' ').next_back().unwrap_or_default();
        for (point, (low, high)) in self.points.iter().zip(&self.bars) {
            svg.line(&format!("line {colour}"), at((point.0, *low)), at((point.0, *high)));
        }
        let pixels: Vec<(f64, f64)> = self.points.iter().map(|point| at(*point)).collect();
        svg.path(self.class, &pixels, false, "");
        if self.dots {
            for &pixel in &pixels {
                svg.circle(&format!("dot {colour}"), pixel, 3.2, "");
            }
        }
    }
}

/// A range that ends on round values, and the step between them.
fn scale(values: impl Iterator<Item = f64>, count: f64) -> ((f64, f64), f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let span = (high - low).max(1e-9);
    let power = 10f64.powf((span / count).log10().floor());
    let step = [1.0, 2.0, 5.0].into_iter().find(|s| s * power >= span / count).unwrap_or(10.0) * power;
    // what stands out by a hair is cut
    let (first, last) = ((low / step + 0.02).floor(), (high / step - 0.02).ceil());
    ((first * step, last.max(first + 1.0) * step), step)
}

fn ticks((low, high): (f64, f64), step: f64) -> impl Iterator<Item = f64> {
    (0..=((high - low) / step).round() as u32).map(move |k| low + f64::from(k) * step)
}

fn label(value: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}
