//! The chart of error against time: four quantities, each on logarithmic scales, a line for each integrator.

use super::number::significant;
use super::svg::{Anchor, Frame, Svg, text_width};
use crate::scenario::{Beam, Integrator};
use crate::trials::chart::{QUANTITIES, ReadError};
use crate::trials::{Chart, Level, Outcome, Point, Sweep};
use crate::units::number;

const WIDTH: f64 = 1080.0;
const PANEL: (f64, f64) = (500.0, 350.0);
const HEAD: f64 = 104.0;
/// Errors below are drawn on the edge.
const LEAST: f64 = 1e-5;

/// The whole picture.
pub fn chart_svg(chart: &Chart) -> String {
    let mut svg = Svg::default();
    let picture = Picture::new(chart);
    svg.text("strong", (16.0, 24.0), Anchor::Start, &format!("{}: error against time", chart.title));
    let under = format!(
        "One passage over the track after {} axles; {} seats lose contact. Reference: finest step and mesh of the same \
        beam theory.",
        chart.axles, chart.losing_contact
    );
    svg.text("small muted", (16.0, 42.0), Anchor::Start, &under);
    picture.legend(&mut svg);
    for (index, (name, error)) in QUANTITIES.iter().enumerate() {
        let frame = Frame {
            x: 16.0 + (index % 2) as f64 * (PANEL.0 + 32.0),
            y: HEAD + (index / 2) as f64 * (PANEL.1 + 26.0),
            width: PANEL.0,
            height: PANEL.1,
        };
        picture.panel(&mut svg, index, name, *error, frame);
    }
    svg.finish(WIDTH, HEAD + 2.0 * (PANEL.1 + 26.0), &format!("Error against time of {}", chart.title))
}

struct Picture<'a> {
    chart: &'a Chart,
    beam: Beam,
    methods: Vec<Integrator>,
    /// Decades of the time axis.
    decades: (f64, f64),
    /// Upper end of the axis of errors.
    most: f64,
}

impl<'a> Picture<'a> {
    fn new(chart: &'a Chart) -> Self {
        let own = chart.points.iter().find(|p| p.default);
        let beam = own.map_or(Beam::Euler, |p| p.variant.beam);
        let mut methods: Vec<Integrator> = Vec::new();
        for point in chart.points.iter().filter(|p| p.sweep == Sweep::TimeStep) {
            if !methods.contains(&point.variant.method) {
                methods.push(point.variant.method);
            }
        }
        let shown = chart.points.iter().filter(|p| p.level == Level::Settled && p.sweep != Sweep::Reference);
        let logs: Vec<f64> = shown.map(|p| p.outcome.seconds().max(1e-6).log10()).collect();
        let low = logs.iter().copied().fold(f64::INFINITY, f64::min);
        let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let decades = if low.is_finite() { (low - 0.12, high + 0.12) } else { (-3.0, 0.0) };
        let of_point = |p: &Point| p.outcome.done().map(|(_, errors)| QUANTITIES.map(|(_, error)| error(errors)));
        let settled = chart.points.iter().filter(|p| p.level == Level::Settled);
        let largest = settled.filter_map(of_point).flatten().fold(1e-2, f64::max);
        Picture { chart, beam, methods, decades, most: 10f64.powf(largest.log10().ceil().min(1.0)) }
    }

    /// Points of a line, from the cheapest to the most expensive, including failed ones.
    fn line(&self, method: Integrator, beam: Beam) -> Vec<&'a Point> {
        let of_line = |p: &&Point| {
            p.level == Level::Settled
                && p.sweep == Sweep::TimeStep
                && (p.variant.method, p.variant.beam) == (method, beam)
        };
        let mut points: Vec<&Point> = self.chart.points.iter().filter(of_line).collect();
        points.sort_by(|a, b| b.variant.time_step.total_cmp(&a.variant.time_step));
        points
    }

    fn legend(&self, svg: &mut Svg) {
        let (mut x, y) = (16.0, 66.0);
        for (index, method) in self.methods.iter().enumerate() {
            let name = method.to_string();
            svg.line(&format!("line {}", class(index)), (x, y - 4.0), (x + 24.0, y - 4.0));
            marker(svg, index, (x + 12.0, y - 4.0), "");
            svg.text("", (x + 30.0, y), Anchor::Start, &name);
            x += 50.0 + text_width(&name);
        }
        if self.chart.points.iter().any(|p| p.sweep == Sweep::Tolerance) {
            svg.line(&format!("line {VARYING}"), (x, y - 4.0), (x + 24.0, y - 4.0));
            plus(svg, (x + 12.0, y - 4.0), "");
            svg.text("", (x + 30.0, y), Anchor::Start, "variable steps");
        }
        let (mut x, y) = (16.0, 88.0);
        let other = if self.beam == Beam::Euler { Beam::Timoshenko } else { Beam::Euler };
        svg.line("other s0", (x, y - 4.0), (x + 24.0, y - 4.0));
        svg.text("", (x + 30.0, y), Anchor::Start, &other.to_string());
        x += 44.0 + text_width(&other.to_string());
        svg.circle("hollow s0", (x + 6.0, y - 4.0), 6.5, "");
        svg.text("small", (x + 6.0, y), Anchor::Middle, "4");
        svg.text("", (x + 18.0, y), Anchor::Start, "elements per bay");
        x += 128.0;
        svg.circle("ring", (x + 8.0, y - 4.0), 8.0, "");
        svg.text("", (x + 22.0, y), Anchor::Start, "scene's setting");
        x += 142.0;
        svg.line("frontier", (x + 4.0, y - 4.0), (x + 24.0, y - 4.0));
        svg.text("", (x + 34.0, y), Anchor::Start, "best at this cost");
        x += 220.0;
        cross(svg, "s1", (x + 6.0, y - 4.0), "");
        svg.text("", (x + 18.0, y), Anchor::Start, "failed or unstable");
        x += 158.0;
        svg.line("mark", (x, y - 4.0), (x + 24.0, y - 4.0));
        svg.text("", (x + 30.0, y), Anchor::Start, "slope 2");
    }

    fn panel(&self, svg: &mut Svg, index: usize, name: &str, error: ReadError, frame: Frame) {
        svg.text("strong", (frame.x, frame.y + 12.0), Anchor::Start, &format!("Error of the {name}"));
        let plane = Plane {
            frame: Frame {
                x: frame.x + 58.0,
                y: frame.y + 22.0,
                width: frame.width - 62.0,
                height: frame.height - 58.0,
            },
            decades: self.decades,
            most: self.most,
        };
        plane.axes(svg);
        svg.clipped(&format!("plane{index}"), plane.grown(), |svg| {
            self.guide(svg, &plane, error);
            if index == 0 {
                self.frontier(svg, &plane, error);
            }
            self.model(svg, &plane, error);
            self.lines(svg, &plane, error);
            self.varying(svg, &plane, error);
            self.meshes(svg, &plane, error);
            self.own(svg, &plane, error);
        });
    }

    /// Error that falls with the square of the step, through the scene's own point.
    fn guide(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let Some((seconds, errors)) = self.chart.points.iter().find(|p| p.default).and_then(|p| p.outcome.done())
        else {
            return;
        };
        let at = |factor: f64| plane.point(seconds * factor, error(errors) * 2.0 / (factor * factor));
        svg.line("mark", at(0.25), at(8.0));
    }

    fn frontier(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let mut points: Vec<(f64, f64)> = self
            .chart
            .points
            .iter()
            .filter(|p| p.efficient)
            .filter_map(|p| p.outcome.done().map(|(seconds, errors)| (seconds, error(errors))))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let path: Vec<(f64, f64)> = points.into_iter().map(|(s, e)| plane.point(s, e)).collect();
        svg.path("frontier", &path, false, "best at this cost");
    }

    fn model(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let Some(model) = &self.chart.model_error else { return };
        let (left, y) = plane.point(10f64.powf(plane.decades.0), error(model));
        svg.line("load", (left, y), (left + plane.frame.width, y));
        let text = format!("Euler against Timoshenko: {} %", significant(100.0 * error(model), 2));
        svg.text("small muted halo", (left + plane.frame.width - 6.0, y - 5.0), Anchor::End, &text);
    }

    fn lines(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let other = if self.beam == Beam::Euler { Beam::Timoshenko } else { Beam::Euler };
        for (index, method) in self.methods.iter().enumerate() {
            for (beam, kind) in [(other, "other"), (self.beam, "line")] {
                let points = self.line(*method, beam);
                let done = |p: &&Point| p.outcome.done().map(|(seconds, errors)| plane.point(seconds, error(errors)));
                for piece in points.split(|p| p.outcome.done().is_none()) {
                    let path: Vec<(f64, f64)> = piece.iter().filter_map(done).collect();
                    svg.path(&format!("{kind} {}", class(index)), &path, false, "");
                }
                for point in &points {
                    match done(point) {
                        Some(at) if beam == self.beam => marker(svg, index, at, &title(point, error)),
                        Some(at) => svg.circle(&format!("hollow {}", class(index)), at, 2.4, &title(point, error)),
                        None => {
                            let top = plane.point(point.outcome.seconds().max(10f64.powf(plane.decades.0)), self.most);
                            cross(svg, class(index), (top.0, top.1 + 8.0), &title(point, error));
                        }
                    }
                }
            }
        }
    }

    /// Steps that vary, over their tolerance.
    fn varying(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let points = self.chart.points.iter().filter(|p| p.sweep == Sweep::Tolerance);
        let done: Vec<(&Point, (f64, f64))> = points
            .filter_map(|p| p.outcome.done().map(|(seconds, errors)| (p, plane.point(seconds, error(errors)))))
            .collect();
        let path: Vec<(f64, f64)> = done.iter().map(|(_, at)| *at).collect();
        svg.path(&format!("line {VARYING}"), &path, false, "");
        for (point, at) in done {
            plus(svg, at, &title(point, error));
        }
    }

    fn meshes(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let meshes = self.chart.points.iter().filter(|p| p.sweep == Sweep::Elements && p.variant.beam == self.beam);
        for point in meshes {
            let Some((seconds, errors)) = point.outcome.done() else { continue };
            let at = plane.point(seconds, error(errors));
            svg.circle("hollow s0", at, 6.5, &title(point, error));
            svg.text("small", (at.0, at.1 + 4.0), Anchor::Middle, &point.variant.elements_per_bay.to_string());
        }
    }

    fn own(&self, svg: &mut Svg, plane: &Plane, error: ReadError) {
        let own = self.chart.points.iter().find(|p| p.default);
        if let Some((seconds, errors)) = own.and_then(|p| p.outcome.done()) {
            svg.circle("ring", plane.point(seconds, error(errors)), 8.0, "numerics of the scene");
        }
    }
}

fn title(point: &Point, error: ReadError) -> String {
    let v = &point.variant;
    let step = match v.tolerance {
        Some(tolerance) => format!("up to {} ms with tolerance {tolerance:e}", number(v.time_step * 1e3)),
        None => format!("{} ms", number(v.time_step * 1e3)),
    };
    let head = format!("{}, {step}, {} elements per bay, {}", v.method, v.elements_per_bay, v.beam);
    match &point.outcome {
        Outcome::Done { seconds, errors, .. } => {
            format!("{head}: {} % in {} s", significant(100.0 * error(errors), 3), significant(*seconds, 3))
        }
        Outcome::Unstable { reason, .. } | Outcome::Failed { reason, .. } => format!("{head}: {reason}"),
    }
}

fn class(index: usize) -> &'static str {
    ["s0", "s1", "s2", "s3", "k4", "k1"][index % 6]
}

/// A shape of its own for each line, so that colour is not needed.
fn marker(svg: &mut Svg, index: usize, (x, y): (f64, f64), title: &str) {
    let class = format!("dot {}", class(index));
    let polygon = |corners: &[(f64, f64)]| corners.iter().map(|(u, v)| (x + u, y + v)).collect::<Vec<_>>();
    match index % 5 {
        0 => svg.circle(&class, (x, y), 3.6, title),
        1 => svg.path(&class, &polygon(&[(-3.2, -3.2), (3.2, -3.2), (3.2, 3.2), (-3.2, 3.2)]), true, title),
        2 => svg.path(&class, &polygon(&[(0.0, -4.4), (4.0, 3.2), (-4.0, 3.2)]), true, title),
        3 => svg.path(&class, &polygon(&[(0.0, -4.6), (4.6, 0.0), (0.0, 4.6), (-4.6, 0.0)]), true, title),
        _ => svg.path(&class, &polygon(&[(0.0, 4.4), (4.0, -3.2), (-4.0, -3.2)]), true, title),
    }
}

/// The class of steps that vary.
const VARYING: &str = "k1";

fn plus(svg: &mut Svg, (x, y): (f64, f64), title: &str) {
    let class = format!("cross {VARYING}");
    svg.path(&class, &[(x - 5.0, y), (x + 5.0, y)], false, title);
    svg.path(&class, &[(x, y - 5.0), (x, y + 5.0)], false, title);
}

fn cross(svg: &mut Svg, class: &str, (x, y): (f64, f64), title: &str) {
    let class = format!("cross {class}");
    svg.path(&class, &[(x - 4.0, y - 4.0), (x + 4.0, y + 4.0)], false, title);
    svg.path(&class, &[(x - 4.0, y + 4.0), (x + 4.0, y - 4.0)], false, title);
}

/// Seconds across and errors up, both as logarithms.
struct Plane {
    frame: Frame,
    decades: (f64, f64),
    most: f64,
}

impl Plane {
    fn point(&self, seconds: f64, error: f64) -> (f64, f64) {
        let (low, high) = self.decades;
        let across = (seconds.max(1e-9).log10() - low) / (high - low);
        let (bottom, top) = (LEAST.log10(), self.most.log10());
        let up = (error.clamp(LEAST, self.most).log10() - bottom) / (top - bottom);
        (self.frame.x + across * self.frame.width, self.frame.y + (1.0 - up) * self.frame.height)
    }

    /// The plane with room for markers on its edges.
    fn grown(&self) -> Frame {
        let f = self.frame;
        Frame { x: f.x - 8.0, y: f.y - 8.0, width: f.width + 16.0, height: f.height + 16.0 }
    }

    fn axes(&self, svg: &mut Svg) {
        let f = self.frame;
        let (right, bottom) = (f.x + f.width, f.y + f.height);
        for decade in -5..=self.most.log10().round() as i32 {
            let error = 10f64.powi(decade);
            let y = self.point(1.0, error).1;
            svg.line("grid", (f.x, y), (right, y));
            svg.text("small muted", (f.x - 7.0, y + 4.0), Anchor::End, &format!("{} %", number(percent(decade))));
        }
        for decade in self.decades.0.floor() as i32..=self.decades.1.ceil() as i32 {
            for multiple in [1.0, 2.0, 5.0] {
                let seconds = multiple * 10f64.powi(decade);
                let log = seconds.log10();
                if log < self.decades.0 || log > self.decades.1 {
                    continue;
                }
                let x = self.point(seconds, 1.0).0;
                svg.line("grid", (x, f.y), (x, bottom));
                let text = if seconds < 0.0999 {
                    format!("{} ms", round(seconds * 1e3))
                } else {
                    format!("{} s", round(seconds))
                };
                svg.text("small muted", (x, bottom + 16.0), Anchor::Middle, &text);
            }
        }
        svg.line("axis", (f.x, bottom), (right, bottom));
        svg.line("axis", (f.x, f.y), (f.x, bottom));
        svg.text("small", (f.x + f.width / 2.0, bottom + 32.0), Anchor::Middle, "Time of one passage on one core");
    }
}

fn percent(decade: i32) -> f64 {
    10f64.powi(decade + 2)
}

/// A tick without the rounding error of a power of ten.
fn round(value: f64) -> String {
    number((value * 1e6).round() / 1e6)
}
