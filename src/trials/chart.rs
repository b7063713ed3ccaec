//! Error against time: one passage over the frozen settled track with many numerics, each against the finest.
//!
//! Sweeps, not the full product: every integrator over the time step, every mesh at a fine step, both beam theories.
//! The reference of a beam theory has the finest step halved once more and twice the elements of the scene, at least
//! eight. The difference of the two references is the error of the model, which does not depend on the step.
//!
//! Orders of convergence come from a track that springs back, where all is smooth, and from the wheel forces of
//! passages, which begin quasi-statically and in which sleepers lift and strike. The differences d of neighbouring
//! steps give log2(d(2 dt) / d(dt)).

use super::planned::Planned;
use super::settled::Settled;
use super::variant::{Case, Errors, METHODS, Measured, Prepared, Variant};
use crate::nodes::RUNAWAY;
use crate::scenario::{Beam, Integrator};
use crate::solvers::track::TrackError;
use serde::Serialize;

/// Settings of the comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// How often the scene's time step is halved.
    pub halvings: u32,
}

/// State of the track under a passage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    AsBuilt,
    Settled,
}

impl Level {
    pub fn name(self) -> &'static str {
        match self {
            Level::AsBuilt => "as_built",
            Level::Settled => "settled",
        }
    }
}

/// The value that varies along a line of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sweep {
    TimeStep,
    /// Steps that vary, over their tolerance.
    Tolerance,
    Elements,
    Reference,
}

impl Sweep {
    pub fn name(self) -> &'static str {
        match self {
            Sweep::TimeStep => "time_step",
            Sweep::Tolerance => "tolerance",
            Sweep::Elements => "elements",
            Sweep::Reference => "reference",
        }
    }
}

/// One passage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    pub level: Level,
    pub sweep: Sweep,
    pub variant: Variant,
    /// The numerics of the scene itself.
    pub default: bool,
    /// On the frontier: no cheaper point has a smaller error of the wheel force.
    pub efficient: bool,
    pub outcome: Outcome,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Came to its end.
    Done {
        /// Time of the passage alone, median of its repetitions, and of mesh, factors and initial state, s.
        seconds: f64,
        setup_s: f64,
        steps: usize,
        iterations: usize,
        errors: Errors,
    },
    /// Ended with an invalid result: its forces are unstable.
    Unstable { seconds: f64, reason: String },
    /// Was stopped by the solver.
    Failed { seconds: f64, reason: String },
}

impl Outcome {
    /// Time and errors of a passage that gave an answer.
    pub fn done(&self) -> Option<(f64, &Errors)> {
        match self {
            Outcome::Done { seconds, errors, .. } => Some((*seconds, errors)),
            _ => None,
        }
    }

    pub fn seconds(&self) -> f64 {
        match self {
            Outcome::Done { seconds, .. } | Outcome::Unstable { seconds, .. } | Outcome::Failed { seconds, .. } => {
                *seconds
            }
        }
    }
}

/// Observed order of an integrator in the time step; none if too few of its steps gave an answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Order {
    pub method: Integrator,
    /// Error of the rail that springs back from a small force, without a train.
    pub released: Option<f64>,
    /// Error of the wheel forces.
    pub as_built: Option<f64>,
    pub settled: Option<f64>,
}

/// The cheapest numerics of the scene's beam theory whose error stays below `tolerance`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cheapest {
    pub quantity: &'static str,
    pub tolerance: f64,
    pub variant: Option<Variant>,
    pub seconds: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Chart {
    pub title: String,
    /// Axles that have settled the track.
    pub axles: u64,
    /// Seats that lose contact in the reference passage over the settled track.
    pub losing_contact: usize,
    pub points: Vec<Point>,
    pub orders: Vec<Order>,
    pub cheapest: Vec<Cheapest>,
    /// Euler–Bernoulli against Timoshenko, both at their finest; none if one of them failed.
    pub model_error: Option<Errors>,
}

/// Reads one error.
pub type ReadError = fn(&Errors) -> f64;

/// The quantities of a chart, and how to read their errors.
pub const QUANTITIES: [(&str, ReadError); 4] = [
    ("wheel force", |e| e.wheel_force),
    ("seat load", |e| e.seat_load),
    ("contact-loss time", |e| e.contact_loss.unwrap_or(e.contact_loss_s)),
    ("rail moment", |e| e.rail_moment),
];

/// Errors that a user may ask for.
pub const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// Compares; fails if the references do.
pub fn chart(
    planned: &Planned,
    settled: &Settled,
    title: &str,
    request: Request,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Chart, TrackError> {
    let scene = Variant::planned(planned);
    let own = scene.even();
    let case = Case::planned(planned, settled.settlement.clone());
    let fresh = Case::planned(planned, planned.initial_settlement());
    let plan = plan(own, scene.tolerance, &case, request);
    let coarsest = plan.iter().map(|(_, _, v)| v.time_step).fold(0.0, f64::max);
    let (case, fresh) = (case.aligned(coarsest), fresh.aligned(coarsest));
    let all: f64 = plan.iter().map(|(_, _, v)| cost(v)).sum();
    let mut done = 0.0;
    let mut bench = Bench { scene, own, references: Vec::new(), traces: Vec::new(), points: Vec::new() };
    let mut model_error = None;
    for (level, sweep, variant) in plan {
        let case = if level == Level::Settled { &case } else { &fresh };
        bench.point(case, level, sweep, variant)?;
        done += cost(&variant);
        progress(done as u64, all as u64);
        if let (None, Some(euler), Some(timoshenko)) = (
            &model_error,
            bench.reference(Level::Settled, Beam::Euler),
            bench.reference(Level::Settled, Beam::Timoshenko),
        ) {
            model_error = Some(euler.errors(timoshenko, case.static_wheel_force()));
        }
    }
    let losing_contact = bench
        .reference(Level::Settled, own.beam)
        .map_or(0, |r| r.contact_losses.iter().filter(|loss| **loss > 0.0).count());
    let orders = METHODS
        .into_iter()
        .map(|method| Order {
            method,
            released: released(&fresh, Variant { method, ..own }),
            as_built: bench.order(method, Level::AsBuilt),
            settled: bench.order(method, Level::Settled),
        })
        .collect();
    let mut points = bench.points;
    mark_frontier(&mut points, own.beam);
    Ok(Chart {
        title: title.to_owned(),
        axles: settled.axles,
        losing_contact,
        cheapest: cheapest(&points, own.beam),
        points,
        orders,
        model_error,
    })
}

/// Tolerances of steps that vary.
const STEP_TOLERANCES: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

/// Every passage, references first.
fn plan(own: Variant, tolerance: Option<f64>, case: &Case, request: Request) -> Vec<(Level, Sweep, Variant)> {
    let step = |halvings: i32| own.time_step * 0.5f64.powi(halvings);
    let finest = request.halvings as i32;
    let coarsest = |elements| {
        let legal = (case.transit(elements) / own.time_step * (1.0 + 1e-9)).log2().floor();
        -(legal.clamp(0.0, 12.0) as i32)
    };
    let fine = Variant { time_step: step(finest + 1), elements_per_bay: (2 * own.elements_per_bay).max(8), ..own };
    let other = if own.beam == Beam::Euler { Beam::Timoshenko } else { Beam::Euler };
    let mut plan = vec![
        (Level::Settled, Sweep::Reference, fine),
        (Level::Settled, Sweep::Reference, Variant { beam: other, ..fine }),
        // of the time step alone: on the mesh of the scene
        (Level::AsBuilt, Sweep::Reference, Variant { time_step: step(finest), ..own }),
    ];
    let mut methods = METHODS.to_vec();
    if !methods.contains(&own.method) {
        methods.insert(0, own.method);
    }
    for method in methods {
        for halvings in coarsest(own.elements_per_bay)..=finest {
            let variant = Variant { method, time_step: step(halvings), ..own };
            plan.push((Level::Settled, Sweep::TimeStep, variant));
            if halvings < finest - 1 {
                plan.push((Level::AsBuilt, Sweep::TimeStep, variant));
            }
        }
    }
    for halvings in coarsest(own.elements_per_bay)..finest {
        plan.push((Level::Settled, Sweep::TimeStep, Variant { beam: other, time_step: step(halvings), ..own }));
    }
    let longest = step(coarsest(4 * own.elements_per_bay).max(-2));
    let known = STEP_TOLERANCES.into_iter();
    for tolerance in known.chain(tolerance.filter(|own| !STEP_TOLERANCES.contains(own))) {
        let variant = Variant { time_step: longest, tolerance: Some(tolerance), ..own };
        plan.push((Level::Settled, Sweep::Tolerance, variant));
    }
    let halvings = (finest - 1).max(0);
    let mut meshes = vec![1, 2, 4, 8, own.elements_per_bay];
    meshes.sort_unstable();
    meshes.dedup();
    for beam in [own.beam, other] {
        for elements_per_bay in &meshes {
            let variant = Variant { time_step: step(halvings), elements_per_bay: *elements_per_bay, beam, ..own };
            plan.push((Level::Settled, Sweep::Elements, variant));
        }
    }
    plan
}

/// Relative cost of a passage, for the estimate of what is left.
fn cost(variant: &Variant) -> f64 {
    (1.0 + 0.5 * f64::from(variant.elements_per_bay)) * 1e-1 / variant.time_step
}

/// Passages below this time are repeated, s.
const SHORT: f64 = 0.4;

struct Bench {
    /// The numerics of the scene, and the same with even steps.
    scene: Variant,
    own: Variant,
    references: Vec<(Level, Beam, Measured)>,
    traces: Vec<(Level, Variant, Measured)>,
    points: Vec<Point>,
}

impl Bench {
    fn reference(&self, level: Level, beam: Beam) -> Option<&Measured> {
        self.references.iter().find(|(l, b, _)| (*l, *b) == (level, beam)).map(|(_, _, m)| m)
    }

    fn point(&mut self, case: &Case, level: Level, sweep: Sweep, variant: Variant) -> Result<(), TrackError> {
        let prepared = Prepared::new(&case.node, &case.responses, variant, self.own.time_step)?;
        let mut result = prepared.run(case);
        if sweep == Sweep::Reference {
            let measured = result.clone().map_err(|failure| failure.cause)?;
            self.references.push((level, variant.beam, measured));
        } else if let Ok(first) = &mut result {
            let mut times = vec![first.seconds];
            while times.len() < 3 && times.iter().sum::<f64>() < SHORT {
                times.extend(prepared.run(case).map(|again| again.seconds));
            }
            times.sort_by(f64::total_cmp);
            first.seconds = times[times.len() / 2];
        }
        let outcome = self.outcome(case, level, variant, &result);
        if let (Ok(measured), Outcome::Done { .. }) = (result, &outcome) {
            self.traces.push((level, variant, measured));
        }
        let swept = matches!(sweep, Sweep::TimeStep | Sweep::Tolerance);
        let default = variant == self.scene && swept && level == Level::Settled;
        self.points.push(Point { level, sweep, variant, default, efficient: false, outcome });
        Ok(())
    }

    fn outcome(
        &self,
        case: &Case,
        level: Level,
        variant: Variant,
        result: &Result<Measured, super::Failure>,
    ) -> Outcome {
        let measured = match result {
            Ok(measured) => measured,
            Err(failure) => return Outcome::Failed { seconds: failure.seconds, reason: failure.cause.to_string() },
        };
        let weight = case.static_wheel_force();
        let reference = self.reference(level, variant.beam).unwrap_or(measured);
        if measured.wheel_peak > RUNAWAY * weight {
            let reason = format!("a wheel force of {:.0} times the static one", measured.wheel_peak / weight);
            return Outcome::Unstable { seconds: measured.seconds, reason };
        }
        Outcome::Done {
            seconds: measured.seconds,
            setup_s: measured.setup_s,
            steps: measured.steps,
            iterations: measured.iterations,
            errors: measured.errors(reference, weight),
        }
    }

    /// From the finest three steps of an integrator at the scene's mesh that lie below twice the scene's own step.
    fn order(&self, method: Integrator, level: Level) -> Option<f64> {
        let mut traces: Vec<_> = self
            .traces
            .iter()
            .filter(|(l, v, _)| *l == level && *v == Variant { method, time_step: v.time_step, ..self.own })
            .map(|(_, v, m)| (v.time_step, m))
            .collect();
        traces.sort_by(|a, b| a.0.total_cmp(&b.0));
        traces.dedup_by(|a, b| a.0 == b.0);
        let [(_, fine), (_, middle), (_, coarse), ..] = traces.as_slice() else { return None };
        let (small, large) = (fine.errors(middle, 1.0).wheel_force_rms, middle.errors(coarse, 1.0).wheel_force_rms);
        (small > 0.0).then(|| (large / small).log2())
    }
}

/// Share of a wheel's static force that can be released without lifting a sleeper.
const SMALL: f64 = 0.02;
/// Instants of free vibration that are compared, at intervals of the scene's step.
const INSTANTS: usize = 400;

/// Order of a method on the track that springs back from a small force.
fn released(case: &Case, variant: Variant) -> Option<f64> {
    let ring = |halvings: u32| {
        let steps = 2usize.pow(halvings);
        let variant = Variant { time_step: variant.time_step / steps as f64, ..variant };
        let prepared = Prepared::new(&case.node, &case.responses, variant, variant.time_step).ok()?;
        prepared.ring(case, SMALL * case.static_wheel_force(), steps, INSTANTS).ok()
    };
    let (coarse, middle, fine) = (ring(1)?, ring(2)?, ring(3)?);
    let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let (large, small) = (far(&coarse, &middle), far(&middle, &fine));
    (small > 0.0).then(|| (large / small).log2())
}

/// Marks the points of the settled track and the scene's beam theory on the frontier of time and error.
fn mark_frontier(points: &mut [Point], beam: Beam) {
    let candidate = |p: &Point| p.level == Level::Settled && p.variant.beam == beam && p.sweep != Sweep::Reference;
    let mut order: Vec<usize> = (0..points.len()).filter(|i| candidate(&points[*i])).collect();
    order.sort_by(|a, b| points[*a].outcome.seconds().total_cmp(&points[*b].outcome.seconds()));
    let mut least = f64::INFINITY;
    for i in order {
        let Some((_, errors)) = points[i].outcome.done() else { continue };
        if errors.wheel_force < least {
            least = errors.wheel_force;
            points[i].efficient = true;
        }
    }
}

fn cheapest(points: &[Point], beam: Beam) -> Vec<Cheapest> {
    let mut rows = Vec::new();
    for (quantity, error) in QUANTITIES {
        for tolerance in TOLERANCES {
            let best = points
                .iter()
                .filter(|p| p.level == Level::Settled && p.variant.beam == beam && p.sweep != Sweep::Reference)
                .filter_map(|p| p.outcome.done().map(|(seconds, errors)| (p, seconds, error(errors))))
                .filter(|(_, _, error)| *error < tolerance)
                .min_by(|a, b| a.1.total_cmp(&b.1));
            rows.push(Cheapest {
                quantity,
                tolerance,
                variant: best.map(|(point, _, _)| point.variant),
                seconds: best.map(|(_, seconds, _)| seconds),
            });
        }
    }
    rows
}
