//! Error of whole runs against their time: one panel for each quantity, both scales logarithmic.

use crate::report::svg::{Anchor, Frame, Svg, text_width};
use crate::trials::runs::{Done, Ended, Group, RunChart, RunErrors, RunRow};
use crate::units::{duration, percent};

const WIDTH: f64 = 1080.0;
const PANEL: (f64, f64) = (500.0, 330.0);
const HEAD: f64 = 84.0;
/// Errors below are drawn on the lower edge.
const LEAST: f64 = 1e-4;
/// Times that a scale may name, s.
const TIMES: [f64; 16] = [
    0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 60.0, 180.0, 600.0, 1800.0, 3600.0, 10_800.0, 36_000.0, 86_400.0, 259_200.0,
    864_000.0,
];

/// Reads one error of a run.
type ReadError = fn(&RunErrors) -> Option<f64>;

/// The whole picture.
pub fn runs_chart_svg(chart: &RunChart) -> String {
    let mut svg = Svg::default();
    svg.text("strong", (16.0, 24.0), Anchor::Start, &format!("{}: error of whole runs against time", chart.title));
    let under = format!(
        "{} axles. Reference: {}, {}. Open marks are the scene's own settings.",
        chart.axles,
        chart.reference,
        duration(chart.took.seconds)
    );
    svg.text("small muted", (16.0, 42.0), Anchor::Start, &under);
    legend(&mut svg, chart);
    let scales = Scales::new(chart);
    for (index, (_, name, read)) in RunErrors::ALL.into_iter().enumerate() {
        let frame = Frame {
            x: 16.0 + (index % 2) as f64 * (PANEL.0 + 32.0),
            y: HEAD + (index / 2) as f64 * (PANEL.1 + 22.0),
            width: PANEL.0,
            height: PANEL.1,
        };
        panel(&mut svg, chart, (index, name, read), scales, frame);
    }
    let rows = RunErrors::ALL.len().div_ceil(2) as f64;
    svg.finish(WIDTH, HEAD + rows * (PANEL.1 + 22.0), &format!("Error of whole runs of {}", chart.title))
}

/// Ends of both scales, as logarithms.
#[derive(Clone, Copy)]
struct Scales {
    seconds: (f64, f64),
    errors: (f64, f64),
}

impl Scales {
    fn new(chart: &RunChart) -> Scales {
        let done: Vec<&Done> = chart.rows.iter().filter_map(RunRow::done).collect();
        let logs = done.iter().map(|done| done.took.seconds).chain([chart.took.seconds]).map(|s| s.max(1e-3).log10());
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let errors = done.iter().flat_map(|done| RunErrors::ALL.map(|(_, _, read)| read(&done.errors)));
        let (least, most) =
            errors.flatten().fold((1e-2f64, 1e-2f64), |(a, b), e| (a.min(e.max(LEAST)), b.max(e.min(10.0))));
        Scales { seconds: (low - 0.15, high + 0.3), errors: (least.log10().floor(), most.log10().ceil().max(-1.0)) }
    }
}

/// A panel of one quantity.
struct Plane {
    frame: Frame,
    scales: Scales,
}

impl Plane {
    fn point(&self, seconds: f64, error: f64) -> (f64, f64) {
        let share =
            |value: f64, (low, high): (f64, f64)| ((value.max(1e-12).log10() - low) / (high - low)).clamp(0.0, 1.0);
        let across = share(seconds, self.scales.seconds);
        let up = share(error, self.scales.errors);
        (self.frame.x + across * self.frame.width, self.frame.y + (1.0 - up) * self.frame.height)
    }

    fn axes(&self, svg: &mut Svg) {
        let f = self.frame;
        let (right, bottom) = (f.x + f.width, f.y + f.height);
        for decade in self.scales.errors.0 as i32..=self.scales.errors.1 as i32 {
            let error = 10f64.powi(decade);
            let y = self.point(1.0, error).1;
            svg.line("grid", (f.x, y), (right, y));
            svg.text("small muted", (f.x - 7.0, y + 4.0), Anchor::End, &percent(error));
        }
        let (low, high) = self.scales.seconds;
        for seconds in TIMES.into_iter().filter(|s| (low..high).contains(&s.log10())) {
            let x = self.point(seconds, 1.0).0;
            svg.line("grid", (x, f.y), (x, bottom));
            svg.text("small muted", (x, bottom + 16.0), Anchor::Middle, &duration(seconds));
        }
        svg.line("axis", (f.x, bottom), (right, bottom));
        svg.line("axis", (f.x, f.y), (f.x, bottom));
    }
}

fn panel(svg: &mut Svg, chart: &RunChart, (index, name, read): (usize, &str, ReadError), scales: Scales, frame: Frame) {
    svg.text("strong", (frame.x, frame.y + 12.0), Anchor::Start, &format!("Error of the {name}"));
    let inner = Frame { x: frame.x + 58.0, y: frame.y + 24.0, width: frame.width - 62.0, height: frame.height - 54.0 };
    let plane = Plane { frame: inner, scales };
    plane.axes(svg);
    let known = |row: &RunRow| Some((row.done()?.took.seconds, read(&row.done()?.errors)?));
    let of_packings = chart.rows.iter().filter(|row| row.variant.group == Group::Packing).filter_map(known);
    if let Some(band) = of_packings.map(|(_, error)| error).reduce(f64::max) {
        let y = plane.point(1.0, band).1;
        svg.line("load", (inner.x, y), (inner.x + inner.width, y));
        svg.text("small muted halo", (inner.x + 4.0, y - 4.0), Anchor::Start, "another packing");
    }
    if index == 0 {
        frontier(svg, chart, &plane, read);
    }
    let reference = plane.point(chart.took.seconds, 1.0).0;
    svg.line("mark", (reference, inner.y), (reference, inner.y + inner.height));
    let mut rows: Vec<(&RunRow, (f64, f64))> = chart.rows.iter().filter_map(|row| Some((row, known(row)?))).collect();
    rows.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let mark = |(_, (seconds, error)): &(&RunRow, (f64, f64))| {
        let (x, y) = plane.point(*seconds, *error);
        Frame { x: x - 4.0, y: y - 4.0, width: 8.0, height: 8.0 }
    };
    let mut taken: Vec<Frame> = rows.iter().map(mark).collect();
    for (row, (seconds, error)) in rows {
        let at = plane.point(seconds, error);
        let title = format!("{}: {} in {}", row.variant.name, percent(error), duration(seconds));
        marker(svg, row.variant.group, at, &title);
        label(svg, &row.variant.name, at, inner, &mut taken);
    }
    for row in chart.rows.iter().filter(|row| matches!(row.ended, Ended::Stopped { .. })) {
        stopped(svg, row, &plane, &mut taken);
    }
}

/// A run that a solver has stopped, at the upper edge.
fn stopped(svg: &mut Svg, row: &RunRow, plane: &Plane, taken: &mut Vec<Frame>) {
    let Some(seconds) = row.seconds() else { return };
    let inner = plane.frame;
    let (x, y) = (plane.point(seconds, 1.0).0, inner.y + 4.0);
    let (title, size) = (format!("{}: stopped by a solver after {}", row.variant.name, duration(seconds)), 4.0);
    svg.path("cross k2", &[(x - size, y - size), (x + size, y + size)], false, &title);
    svg.path("cross k2", &[(x - size, y + size), (x + size, y - size)], false, &title);
    label(svg, &format!("{} (stopped)", row.variant.name), (x, y), inner, taken);
}

/// The runs that no faster run beats.
fn frontier(svg: &mut Svg, chart: &RunChart, plane: &Plane, read: ReadError) {
    let efficient = chart.rows.iter().filter_map(RunRow::done).filter(|done| done.efficient);
    let mut points: Vec<(f64, f64)> =
        efficient.filter_map(|done| Some((done.took.seconds, read(&done.errors)?))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let path: Vec<(f64, f64)> = points.into_iter().map(|(s, e)| plane.point(s, e)).collect();
    svg.path("frontier", &path, false, "not beaten by a faster run");
}

/// Writes a name beside its mark, where no mark and no other name stands; else the tooltip of the mark has it.
fn label(svg: &mut Svg, name: &str, at: (f64, f64), inner: Frame, taken: &mut Vec<Frame>) {
    let width = 0.86 * text_width(name);
    let sides = [at.0 + 7.0, at.0 - 7.0 - width];
    let lines = [4.0, -8.0, 16.0, -20.0, 28.0, -32.0, 40.0];
    let places = lines.into_iter().flat_map(|dy| sides.map(|x| Frame { x, y: at.1 + dy - 10.0, width, height: 11.0 }));
    let within = |frame: &Frame| {
        let (right, bottom) = (inner.x + inner.width, inner.y + inner.height);
        frame.x > inner.x && frame.x + width < right && frame.y > inner.y - 8.0 && frame.y + frame.height < bottom
    };
    let apart = |a: &Frame, b: &Frame| {
        a.x + a.width < b.x || b.x + b.width < a.x || a.y + a.height < b.y || b.y + b.height < a.y
    };
    let free = |frame: &Frame| within(frame) && taken.iter().all(|other| apart(frame, other));
    let Some(frame) = { places }.find(free) else { return };
    svg.text("small halo", (frame.x, frame.y + 10.0), Anchor::Start, name);
    taken.push(frame);
}

fn legend(svg: &mut Svg, chart: &RunChart) {
    let (mut x, y) = (16.0, 66.0);
    for group in Group::ALL {
        if chart.rows.iter().any(|row| row.variant.group == group && row.done().is_some()) {
            marker(svg, group, (x + 6.0, y - 4.0), "");
            svg.text("", (x + 16.0, y), Anchor::Start, group.name());
            x += 40.0 + text_width(group.name());
        }
    }
    svg.line("mark", (x, y - 4.0), (x + 24.0, y - 4.0));
    svg.text("", (x + 30.0, y), Anchor::Start, "time of the reference");
}

/// A shape of its own for each group, so that colour is not needed.
fn marker(svg: &mut Svg, group: Group, (x, y): (f64, f64), title: &str) {
    let polygon = |corners: &[(f64, f64)]| corners.iter().map(|(u, v)| (x + u, y + v)).collect::<Vec<_>>();
    match group {
        Group::Reference | Group::Scene => svg.circle("hollow s0", (x, y), 5.0, title),
        Group::Tier => svg.circle("dot s0", (x, y), 4.0, title),
        Group::Exchange => {
            svg.path("dot s1", &polygon(&[(-3.4, -3.4), (3.4, -3.4), (3.4, 3.4), (-3.4, 3.4)]), true, title);
        }
        Group::Passages => svg.path("dot s2", &polygon(&[(0.0, -4.6), (4.2, 3.4), (-4.2, 3.4)]), true, title),
        Group::Bays => svg.path("dot s3", &polygon(&[(0.0, -4.8), (4.8, 0.0), (0.0, 4.8), (-4.8, 0.0)]), true, title),
        Group::Soil => svg.path("dot k4", &polygon(&[(0.0, 4.6), (4.2, -3.4), (-4.2, -3.4)]), true, title),
        Group::Grains => svg.circle("dot s3", (x, y), 3.6, title),
        Group::Jumps => {
            svg.path("dot s2", &polygon(&[(-1.8, -4.6), (1.8, -4.6), (1.8, 4.6), (-1.8, 4.6)]), true, title)
        }
        Group::Passage => {
            svg.path("dot k1", &polygon(&[(-4.6, -1.8), (4.6, -1.8), (4.6, 1.8), (-4.6, 1.8)]), true, title);
        }
        Group::Packing => {
            svg.path("cross k1", &polygon(&[(-4.0, -4.0), (4.0, 4.0)]), false, title);
            svg.path("cross k1", &polygon(&[(-4.0, 4.0), (4.0, -4.0)]), false, title);
        }
    }
}
