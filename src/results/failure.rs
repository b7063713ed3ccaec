//! A run that stopped, said to a person: which block of the scene is responsible, and what to write there instead.

use crate::diag::{Code, Diagnostic, Span};
use crate::graph::{Graph, RunError, Schedule};
use crate::scenario::{Loading, Scenario, Section, Traffic};
use crate::solvers::track::{TrackError, TrackParameter};
use crate::units::number;

/// The diagnostic of a run's failure, with the declaration that it is about.
pub fn diagnose(error: &RunError, scenario: &Scenario, graph: &Graph) -> Diagnostic {
    let (axles, cause) = match error {
        RunError::Recorder(message) => {
            return Diagnostic::new(Code::E0802, message.clone()).help("the run can be resumed with `--resume`");
        }
        RunError::Track { axles, cause } => (*axles, cause),
    };
    let scene = Scene { scenario, graph };
    let (labels, help) = scene.blame(axles, cause);
    let labels = labels.into_iter().filter_map(|(span, text)| Some((span?, text)));
    let code = if matches!(cause, TrackError::RanAway { .. }) { Code::E0703 } else { Code::E0801 };
    labels.fold(Diagnostic::new(code, error.to_string()).help(help), |d, (span, text)| d.at(span, text))
}

struct Scene<'a> {
    scenario: &'a Scenario,
    graph: &'a Graph,
}

type Labels = Vec<(Option<Span>, String)>;

impl Scene<'_> {
    fn blame(&self, axles: u64, cause: &TrackError) -> (Labels, String) {
        match cause {
            TrackError::StepNotConverged { x, .. } | TrackError::Unstable { x, .. } => {
                (vec![self.time_step(), self.contact(), self.place(*x)], self.half_a_step())
            }
            TrackError::NoEquilibrium { x, .. } if axles > 0 => {
                (vec![(self.scenario.solve.update_span, "too long here".into()), self.place(*x)], self.half_a_block())
            }
            TrackError::NoEquilibrium { x, .. } => (
                vec![self.place(*x), self.support(*x)],
                "let gravity and the supports hold the track: `gravity = 9.81 m/s^2`, no load that lifts the rail"
                    .into(),
            ),
            TrackError::Mechanism { x } => (
                vec![self.place(*x)],
                "let something hold it: `rail_ends = clamped`, or more seats in `sections`".into(),
            ),
            TrackError::OffTrack { x, start, end } => {
                let solve = &self.scenario.solve;
                let given = [(solve.start, "starts here"), (solve.finish, "ends here")];
                let mut labels: Labels =
                    given.iter().map(|(g, text)| (g.and_then(|g| g.origin.span()), (*text).into())).collect();
                labels.push(self.place(x.clamp(*start, *end)));
                let help = format!(
                    "keep every wheel and load between {} m and {} m, or lengthen a section by {} m",
                    number(*start),
                    number(*end),
                    number((start - x).max(x - end).max(0.0).ceil())
                );
                (labels, help)
            }
            TrackError::RanAway { x, .. } => {
                let speed = self.traffic().map(|t| t.train.speed);
                let help = format!(
                    "the linear track cannot follow: write a lower `speed`{}, a stiffer support, or a smaller step in settlement",
                    speed.map_or(String::new(), |v| format!(", {} km/h", number((*v * 1.8).round())))
                );
                let fast = (speed.and_then(|v| v.origin.span()), "at this speed".into());
                (vec![self.place(*x), self.support(*x), fast], help)
            }
            TrackError::Model { x, .. } => {
                (vec![self.place(*x)], "change the value that the message names, in that section".into())
            }
            TrackError::Parameter { name, expected, .. } => {
                (vec![self.parameter(*name)], format!("write a {name} {expected}"))
            }
        }
    }

    fn traffic(&self) -> Option<&Traffic> {
        match &self.scenario.loading {
            Some(Loading::Traffic(traffic)) => Some(traffic),
            _ => None,
        }
    }

    fn section(&self, x: f64) -> Option<&Section> {
        let sections = &self.scenario.track.sections;
        sections.iter().find(|s| x <= s.end).or(sections.last())
    }

    /// The section at a place.
    fn place(&self, x: f64) -> (Option<Span>, String) {
        match self.section(x) {
            Some(s) => {
                (s.length_origin.span(), format!("x = {} m lies in `{}`", number((x * 1e3).round() / 1e3), s.name))
            }
            None => (None, String::new()),
        }
    }

    /// The support nearest to a place.
    fn support(&self, x: f64) -> (Option<Span>, String) {
        let distance = |seat: &&crate::scenario::Seat| (seat.x - x).abs();
        let nearest = self.scenario.track.seats.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let span = nearest.and_then(|seat| seat.support()?.stiffness.origin.span());
        (span, "the nearest support".into())
    }

    fn time_step(&self) -> (Option<Span>, String) {
        (self.scenario.solve.time_step.span(), "too coarse here".into())
    }

    fn contact(&self) -> (Option<Span>, String) {
        let vehicle = self.traffic().and_then(|t| t.train.vehicles.first());
        (vehicle.and_then(|v| v.hertz.origin.span()), "the contact of wheel and rail".into())
    }

    fn half_a_step(&self) -> String {
        match &self.graph.schedule {
            Schedule::Blocks(blocks) => {
                format!("write `time_step = {} s` in `solve`", number(blocks.passage.shortest_step() / 2.0))
            }
            Schedule::Static { .. } => "change the loads".into(),
        }
    }

    /// Half the present interval, in whole trains.
    fn half_a_block(&self) -> String {
        let trains = self.traffic().map_or(1, |t| t.train.axles());
        let present = match self.scenario.solve.update {
            crate::scenario::Update::Fixed { axles } => axles,
            crate::scenario::Update::Geometric { first, .. } => first,
            // the shortest is one train already
            crate::scenario::Update::Adaptive { .. } => {
                return "let the supports settle less at once: check the settlement law".into();
            }
        };
        let half = (present / 2 / trains).max(1) * trains;
        format!("exchange more often: write `update_every = {half} axles` in `solve`, or check the settlement law")
    }

    fn parameter(&self, name: TrackParameter) -> (Option<Span>, String) {
        let (solve, train) = (&self.scenario.solve, self.traffic().map(|t| &t.train));
        let span = match name {
            TrackParameter::Speed => train.and_then(|t| t.speed.origin.span()),
            TrackParameter::TimeStep => solve.time_step.span(),
            TrackParameter::Gravity => solve.gravity.origin.span(),
            TrackParameter::ElementsPerBay => solve.elements_per_bay.origin.span(),
            TrackParameter::Distance => solve.finish.or(solve.start).and_then(|f| f.origin.span()),
            TrackParameter::Vehicle(_) => train.and_then(|t| t.vehicles.first()?.wheel_mass.origin.span()),
            _ => None,
        };
        (span, "given here".into())
    }
}
