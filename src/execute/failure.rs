//! Diagnostics of a run that stopped: the block of the scene that is responsible, and the text to write instead.

use super::RunError;
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::{Clock, Graph, Schedule, TrackSection, Train, Update};
use crate::lower::{Origins, Parameter};
use crate::nodes::NodeError;
use crate::solvers::granular::rig::RigError;
use crate::solvers::track::{Spring, TrackError, TrackParameter};
use crate::units::number;

/// The diagnostic of a run's failure, with the declaration that it is about.
pub fn diagnose(error: &RunError, graph: &Graph, origins: &Origins) -> Diagnostic {
    let said = |code: Code| Diagnostic::new(code, error.to_string());
    match error {
        RunError::Faults(_) => said(Code::E0612),
        RunError::ForeignCheckpoint => said(Code::E0803).help("run without `--resume`, with `--force`"),
        RunError::NoSchedule { .. } => said(Code::E0604),
        RunError::Node { clock, cause } => of_node(*clock, cause, graph, origins),
    }
}

fn of_node(clock: Clock, cause: &NodeError, graph: &Graph, origins: &Origins) -> Diagnostic {
    let said = |code: Code| Diagnostic::new(code, cause.to_string());
    match cause {
        NodeError::Track(cause) => of_track(clock, cause, graph, origins),
        NodeError::Bed(_) => said(Code::E0610),
        NodeError::Packing(_) => {
            said(Code::E0810).help("give the `packing` of the material more `local_damping`, or less `pressure`")
        }
        NodeError::Rig(RigError::Restless { .. }) => {
            said(Code::E0811).help("give the `packing` of the material more `pressure`, or its grains more `friction`")
        }
        NodeError::Rig(RigError::NoRoom { .. } | RigError::Grading(_)) => said(Code::E0610),
        NodeError::Rig(_) => said(Code::E0812).help("check if the `force` is `per sleeper` or `per seat`"),
        NodeError::Grains(_) => said(Code::E0801).help("write a shorter `grain_step`"),
        NodeError::Soil(_) => said(Code::E0801).help("give the soil more strength, or less load"),
        NodeError::Foreign { .. } => said(Code::E0803).help("run with `--force`"),
        NodeError::NoBuilder { .. } => said(Code::E0604),
        NodeError::Sunk { seat, .. } => of_sunk(clock, *seat, cause, graph, origins),
        NodeError::BeyondLaw { seat, .. } => of_law(clock, *seat, cause, graph, origins),
        NodeError::NoGround | NodeError::NoTrain | NodeError::Stopped | NodeError::Other { .. } => said(Code::E0801),
    }
}

fn of_sunk(clock: Clock, seat: usize, cause: &NodeError, graph: &Graph, origins: &Origins) -> Diagnostic {
    let scene = Scene { graph, origins };
    let x = graph.track().and_then(|track| track.seats.get(seat)).map_or(0.0, |seat| seat.x);
    let said = Diagnostic::new(Code::E0814, format!("after {clock}: {cause}"));
    let said = said.help("check the parameters of the `law` and their units, or give the traffic a `tamping`");
    let labels = [scene.place(x), scene.support(x)];
    labels.into_iter().filter_map(|(span, text)| Some((span?, text))).fold(said, |d, (span, text)| d.label(span, text))
}

fn of_law(clock: Clock, seat: usize, cause: &NodeError, graph: &Graph, origins: &Origins) -> Diagnostic {
    let scene = Scene { graph, origins };
    let x = graph.track().and_then(|track| track.seats.get(seat)).map_or(0.0, |seat| seat.x);
    let said = Diagnostic::new(Code::E0817, format!("after {clock}: {cause}")).help(
        "fit the law over a larger range with `trackbed calibrate --grains` (`--loads`, `--voids`), or remove its \
         `error` to use it as an extrapolation",
    );
    let (span, text) = scene.place(x);
    span.map_or(said.clone(), |span| said.label(span, text))
}

fn of_track(clock: Clock, cause: &TrackError, graph: &Graph, origins: &Origins) -> Diagnostic {
    let scene = Scene { graph, origins };
    let axles = if let Clock::Axles(axles) = clock { axles } else { 0 };
    let (labels, help) = scene.blame(axles, cause);
    let labels = labels.into_iter().filter_map(|(span, text)| Some((span?, text)));
    let code = if matches!(cause, TrackError::RanAway { .. }) { Code::E0703 } else { Code::E0801 };
    let message = format!("after {axles} axles: {cause}");
    labels.fold(Diagnostic::new(code, message).help(help), |d, (span, text)| d.label(span, text))
}

/// Limit of the return time of a support, s: longer than a bogie needs to pass.
const SLOW: f64 = 0.05;
const LESS_DAMPING: &str =
    "write less `damping` for that support: published ones need 1 to 5 ms (`damping_time = 1 ms`)";

struct Scene<'a> {
    graph: &'a Graph,
    origins: &'a Origins,
}

type Labels = Vec<(Option<Span>, String)>;

impl Scene<'_> {
    fn blame(&self, axles: u64, cause: &TrackError) -> (Labels, String) {
        match cause {
            TrackError::StepNotConverged { x, .. } | TrackError::Unstable { x, .. } => match self.slow_support(*x) {
                Some(slow) => (vec![slow, self.place(*x)], LESS_DAMPING.into()),
                None => (vec![self.time_step(), self.contact(), self.place(*x)], self.half_a_step()),
            },
            TrackError::StepTooLong { x, limit, .. } => (
                vec![self.time_step(), self.place(*x)],
                format!("write a `time_step` of at most {} us", number((1e6 * limit * 10.0).floor() / 10.0)),
            ),
            TrackError::NoEquilibrium { x, .. } if axles > 0 => {
                (vec![(self.span_of(Parameter::Update), "too long here".into()), self.place(*x)], self.half_a_block())
            }
            TrackError::NoEquilibrium { x, .. } => (
                vec![self.place(*x), self.support(*x)],
                "write `gravity = 9.81 m/s^2`, and remove loads that lift the rail".into(),
            ),
            TrackError::Mechanism { x } => {
                (vec![self.place(*x)], "fix the rail: write `rail_ends = clamped`, or more seats in `sections`".into())
            }
            TrackError::OffTrack { x, start, end } => {
                let given = [(Parameter::Start, "starts here"), (Parameter::Finish, "ends here")];
                let mut labels: Labels =
                    given.iter().map(|(parameter, text)| (self.span_of(*parameter), (*text).into())).collect();
                labels.push(self.place(x.clamp(*start, *end)));
                let help = format!(
                    "keep every wheel and load between {} m and {} m, or put {} m more track at that end of the model",
                    number(*start),
                    number(*end),
                    number((start - x).max(x - end).max(0.0).ceil())
                );
                (labels, help)
            }
            TrackError::RanAway { x, .. } => {
                let speed = self.train().map(|train| train.speed);
                let help = format!(
                    "the linear track model does not apply here: write a lower `speed`{}, a stiffer support, or a \
                    smaller step in settlement",
                    speed.map_or(String::new(), |v| format!(", {} km/h", number((v * 1.8).round())))
                );
                let fast = (self.span_of(Parameter::Speed(0)), "at this speed".into());
                (vec![self.place(*x), self.support(*x), fast], help)
            }
            TrackError::Model { x, .. } => {
                (vec![self.place(*x)], "change the value named in the message, in this section".into())
            }
            TrackError::Parameter { name, expected, .. } => {
                (vec![self.parameter(*name)], format!("write a {name} {expected}"))
            }
        }
    }

    fn span_of(&self, parameter: Parameter) -> Option<Span> {
        self.origins.span(parameter)
    }

    /// The train that leads the traffic.
    fn train(&self) -> Option<&Train> {
        self.graph.blocks().map(|blocks| &blocks.train)
    }

    fn section(&self, x: f64) -> Option<(usize, &TrackSection)> {
        let sections = &self.graph.track()?.sections;
        let index = sections.iter().position(|s| x <= s.end).or(sections.len().checked_sub(1))?;
        Some((index, &sections[index]))
    }

    /// The section at a place.
    fn place(&self, x: f64) -> (Option<Span>, String) {
        match self.section(x) {
            Some((index, section)) => {
                let place = number((x * 1e3).round() / 1e3);
                (self.span_of(Parameter::Section(index)), format!("x = {place} m lies in `{}`", section.name))
            }
            None => (None, String::new()),
        }
    }

    /// The support nearest to a place.
    fn support(&self, x: f64) -> (Option<Span>, String) {
        let nearest = self.nearest_seat(x);
        (nearest.and_then(|seat| self.span_of(Parameter::Support(seat))), "the nearest support".into())
    }

    fn nearest_seat(&self, x: f64) -> Option<usize> {
        let seats = self.graph.track().map_or(&[][..], |track| &track.seats);
        let distance = |seat: usize| (seats[seat].x - x).abs();
        (0..seats.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
    }

    /// The support nearest to a place, if its damper holds it down long after a wheel has passed. A shorter time step
    /// does not help then.
    fn slow_support(&self, x: f64) -> Option<(Option<Span>, String)> {
        let seat = self.nearest_seat(x)?;
        let Spring { stiffness, damping, .. } = self.graph.supports.get(seat)?.spring?;
        let time = damping / stiffness;
        let text = format!(
            "the damper of this support needs {} s until its {} MN/m spring has returned",
            number((time * 1e2).round() / 1e2),
            number((stiffness / 1e4).round() / 1e2)
        );
        (time > SLOW).then(|| (self.span_of(Parameter::Support(seat)), text))
    }

    fn time_step(&self) -> (Option<Span>, String) {
        (self.span_of(Parameter::TimeStep), "too long here".into())
    }

    fn contact(&self) -> (Option<Span>, String) {
        (self.span_of(Parameter::Contact(0)), "the contact of wheel and rail".into())
    }

    fn half_a_step(&self) -> String {
        match &self.graph.schedule {
            Schedule::Blocks(blocks) => {
                format!("write `time_step = {} s` in `solve`", number(blocks.passage.shortest_step() / 2.0))
            }
            _ => "change the loads".into(),
        }
    }

    /// Half the present interval, in whole trains.
    fn half_a_block(&self) -> String {
        let Some(blocks) = self.graph.blocks() else { return "change the loads".into() };
        let trains = blocks.train.axles();
        let present = match blocks.update {
            Update::Fixed { axles } => axles,
            Update::Geometric { first, .. } => first,
            // the shortest is one train already
            Update::Adaptive { .. } => {
                return "reduce the settlement per train: check the settlement law".into();
            }
        };
        let half = (present / 2 / trains).max(1) * trains;
        format!("exchange more often: write `update_every = {half} axles` in `solve`, or check the settlement law")
    }

    fn parameter(&self, name: TrackParameter) -> (Option<Span>, String) {
        let span = match name {
            TrackParameter::Speed => self.span_of(Parameter::Speed(0)),
            TrackParameter::TimeStep => self.span_of(Parameter::TimeStep),
            TrackParameter::Gravity => self.span_of(Parameter::Gravity),
            TrackParameter::ElementsPerBay => self.span_of(Parameter::ElementsPerBay),
            TrackParameter::Distance => self.span_of(Parameter::Finish).or(self.span_of(Parameter::Start)),
            TrackParameter::Vehicle(_) => self.span_of(Parameter::WheelMass(0)),
            _ => None,
        };
        (span, "given here".into())
    }
}
