//! One passage with its own numerics, for charts and stability maps.
//!
//! A [`Case`] is the physics (a track as it lies, a train, from where to where), a [`Variant`] the numerics.
//! [`Prepared`] is a variant factored for a track; it runs any case on this track and returns result and cost.

use super::clock::Clock;
use super::planned::Planned;
use crate::graph::{Responses, TrackNode, Train};
use crate::nodes::Steps;
use crate::scenario::{Beam, Integrator};
use crate::solvers::track::{
    Counters, Direction, Envelope, Ladder, Passage, Run, Shear, StepView, Stepper, Track, TrackError, TrackLevel,
    TrackModel,
};
use serde::{Serialize, Serializer};
use std::fmt;
use std::sync::Arc;

/// The methods that charts and maps compare.
pub const METHODS: [Integrator; 5] = [
    Integrator::GeneralisedAlpha { rho: 0.85 },
    Integrator::GeneralisedAlpha { rho: 0.5 },
    Integrator::GeneralisedAlpha { rho: 1.0 },
    Integrator::Hht { alpha: 0.1 },
    Integrator::Newmark,
];

fn as_word<T: fmt::Display, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

/// The numerics of a passage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Variant {
    #[serde(serialize_with = "as_word")]
    pub method: Integrator,
    /// s; the longest one where steps vary.
    pub time_step: f64,
    /// Error of a step as part of the rail's largest deflection, where steps vary.
    pub tolerance: Option<f64>,
    pub elements_per_bay: u32,
    #[serde(serialize_with = "as_word")]
    pub beam: Beam,
}

impl Variant {
    /// The numerics in the plan of a scene.
    pub fn planned(planned: &Planned) -> Variant {
        let Planned { node, blocks, .. } = planned;
        let shears = node.rail.iter().any(|rail| rail.shear.is_some());
        Variant {
            method: blocks.passage.integrator,
            time_step: blocks.passage.time_step,
            tolerance: blocks.passage.adaptive.map(|steps| steps.tolerance),
            elements_per_bay: node.elements_per_bay,
            beam: if shears { Beam::Timoshenko } else { Beam::Euler },
        }
    }

    /// The same in even steps: a quarter of the longest where steps vary.
    pub(super) fn even(self) -> Variant {
        let time_step = if self.tolerance.is_some() { self.time_step / 4.0 } else { self.time_step };
        Variant { time_step, tolerance: None, ..self }
    }
}

/// A train that runs over a track as it lies.
#[derive(Debug, Clone)]
pub struct Case {
    pub node: TrackNode,
    pub responses: Responses,
    pub train: Train,
    pub direction: Direction,
    /// Chainage of the hindmost wheel at the left and of the foremost at the right, m.
    pub left: f64,
    pub right: f64,
    /// Settlement of every seat, m.
    pub settlement: Vec<f64>,
}

impl Case {
    /// The passage that a run of the scene would make over `settlement`.
    pub fn planned(planned: &Planned, settlement: Vec<f64>) -> Case {
        let Planned { node, responses, blocks, .. } = planned;
        Case {
            node: node.clone(),
            responses: responses.clone(),
            train: blocks.train.clone(),
            direction: blocks.leading_direction(),
            left: blocks.passage.left,
            right: blocks.passage.right,
            settlement,
        }
    }

    /// The same, ended where a whole number of steps of `time` (s) has passed, so that all steps that divide it end
    /// there.
    pub fn aligned(mut self, time: f64) -> Case {
        let run = self.right - self.left - self.train.wheel_base();
        let step = self.train.speed * time;
        let lost = run - (run / step + 1e-9).floor() * step;
        if lost > 0.0 && run > step {
            if self.direction == Direction::Backward { self.left += lost } else { self.right -= lost }
        }
        self
    }

    /// Static force of a wheel, N: the mean over the train.
    pub fn static_wheel_force(&self) -> f64 {
        self.train.mass() * self.node.gravity / self.train.axles() as f64
    }

    /// Time in which a wheel crosses one element, s.
    pub fn transit(&self, elements_per_bay: u32) -> f64 {
        self.node.shortest_bay / f64::from(elements_per_bay) / self.train.speed
    }
}

/// Half the length over which a force is spread so that nothing moves faster than a step when it is let go, m.
const BELL: f64 = 5.0;

/// Results of a passage.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// Wheel forces at equal intervals from the start, one instant after another, N.
    pub wheel_forces: Vec<f64>,
    pub wheels: usize,
    /// Interval of `wheel_forces`, s.
    pub interval: f64,
    /// Largest wheel force, N.
    pub wheel_peak: f64,
    /// Largest load of every seat, N.
    pub seat_peaks: Vec<f64>,
    /// Time without contact under every seat, s.
    pub contact_losses: Vec<f64>,
    /// Largest sagging moment at rail nodes, N m.
    pub rail_moment: f64,
    pub steps: usize,
    pub iterations: usize,
    /// Mesh, factors and initial state; and the passage alone, s.
    pub setup_s: f64,
    pub seconds: f64,
}

/// A passage that did not come to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    pub cause: TrackError,
    /// Time spent until then, s.
    pub seconds: f64,
}

/// How often the longest step may be halved where steps vary.
const HALVINGS: usize = 6;

/// A time step factored for a track.
pub struct Prepared {
    steps: Steps,
    interval: f64,
    setup_s: f64,
}

impl Prepared {
    /// Meshes and factors. Wheel forces are kept every `interval` (s), or every step where steps are longer.
    pub fn new(
        node: &TrackNode,
        responses: &Responses,
        variant: Variant,
        interval: f64,
    ) -> Result<Prepared, TrackError> {
        let started = Clock::start();
        let mut node = node.clone();
        node.elements_per_bay = variant.elements_per_bay;
        let mut model = node.model(responses);
        set_beam(&mut model, variant.beam);
        let track = Arc::new(Track::new(model)?);
        let scheme = variant.method.scheme(variant.time_step)?;
        let steps = match variant.tolerance {
            None => Steps::Even(Stepper::new(track, scheme)?),
            Some(tolerance) => Steps::Chosen { ladder: Ladder::new(&track, scheme, HALVINGS)?, tolerance },
        };
        Ok(Prepared { steps, interval, setup_s: started.seconds() })
    }

    /// Runs a case on the track that was prepared.
    pub fn run(&self, case: &Case) -> Result<Measured, Failure> {
        let started = Clock::start();
        let failed = |cause| Failure { cause, seconds: started.seconds() };
        let train = case.train.model(case.direction);
        let base = case.train.wheel_base();
        let (start, finish) = if case.direction == Direction::Backward {
            (case.right - base, case.left)
        } else {
            (case.left + base, case.right)
        };
        let level = case.node.level(&case.settlement, &case.responses);
        let run = Run { train: &train, start, finish, motion: &case.train.motion };
        let mut passage = self.steps.begin(&level, run).map_err(failed)?;
        let setup_s = self.setup_s + started.seconds();

        let running = Clock::start();
        let failed = |cause| Failure { cause, seconds: running.seconds() };
        let step = self.stepper().time_step();
        let every = (self.interval / step).round().max(1.0) as usize;
        let mut envelope = Envelope::default();
        let mut forces = Vec::new();
        let mut trace = |view: &StepView<'_>| {
            if view.is_on_grid(every) {
                forces.extend_from_slice(view.wheel_forces());
            }
        };
        let counters = passage.run(&mut (&mut envelope, &mut trace)).map_err(failed)?;
        let seconds = running.seconds();
        let interval = every as f64 * step;
        Ok(measured(&envelope, forces, interval, counters, (setup_s, seconds)))
    }

    pub fn track(&self) -> &Track {
        self.stepper().track()
    }

    /// The step, the longest one where steps vary.
    fn stepper(&self) -> &Stepper {
        match &self.steps {
            Steps::Even(stepper) => stepper,
            Steps::Chosen { ladder, .. } => ladder.longest(),
        }
    }

    /// Deflection of the middle of the rail (m) after every interval of `steps` steps while the track springs back from
    /// a force spread there (N), `count` times.
    pub fn ring(&self, case: &Case, force: f64, steps: usize, count: usize) -> Result<Vec<f64>, TrackError> {
        let level: TrackLevel = case.node.level(&case.settlement, &case.responses);
        let node = self.track().seat_node(case.node.seats.len() / 2);
        let nodes = self.track().nodes();
        let bell = |x: f64| (0.5 * std::f64::consts::PI * ((x - nodes[node]) / BELL).clamp(-1.0, 1.0)).cos().powi(2);
        let whole: f64 = nodes.iter().map(|x| bell(*x)).sum();
        let pressed: Vec<(f64, f64)> = nodes.iter().map(|x| (*x, force * bell(*x) / whole)).collect();
        let held = crate::solvers::track::Loads { rail: &pressed, ..Default::default() };
        let state = crate::solvers::track::solve_static(self.track(), &level, &held)?;
        let mut passage = Passage::released(self.stepper(), &level, state, steps * count)?;
        let mut deflections = Vec::with_capacity(count);
        for _ in 0..count {
            for _ in 0..steps {
                passage.step()?;
            }
            deflections.push(passage.view().rail_deflection(node));
        }
        Ok(deflections)
    }

    /// The largest energy of the track in free vibration over its energy at the start, above that of the track at rest;
    /// `pressed` names rail loads (m, N) that hold it down before it is let go.
    pub fn free_vibration(&self, case: &Case, pressed: &[(f64, f64)], steps: usize) -> Result<f64, TrackError> {
        let level: TrackLevel = case.node.level(&case.settlement, &case.responses);
        let held = crate::solvers::track::Loads { rail: pressed, ..Default::default() };
        let state = crate::solvers::track::solve_static(self.track(), &level, &held)?;
        let rest = crate::solvers::track::solve_static(self.track(), &level, &Default::default())?;
        let lowest = Passage::released(self.stepper(), &level, rest, 0)?.energy();
        let mut passage = Passage::released(self.stepper(), &level, state, steps)?;
        let start = passage.energy() - lowest;
        let mut most: f64 = 0.0;
        for _ in 0..steps {
            passage.step()?;
            most = most.max(passage.energy() - lowest);
        }
        Ok(most / start)
    }
}

fn measured(
    envelope: &Envelope,
    wheel_forces: Vec<f64>,
    interval: f64,
    counters: Counters,
    (setup_s, seconds): (f64, f64),
) -> Measured {
    let largest = |ranges: &[(f64, f64)]| ranges.iter().map(|r| r.1).fold(f64::NEG_INFINITY, f64::max);
    Measured {
        wheel_forces,
        wheels: envelope.wheel_forces.len(),
        interval,
        wheel_peak: largest(&envelope.wheel_forces),
        seat_peaks: envelope.seat_loads.iter().map(|range| range.1).collect(),
        contact_losses: envelope.contact_losses.clone(),
        rail_moment: largest(&envelope.rail_moments),
        steps: counters.steps,
        iterations: counters.iterations,
        setup_s,
        seconds,
    }
}

/// Density of steel, kg/m^3, its moduli, Pa, and the share of a rail's section that carries shear: for a Timoshenko
/// rail where the scene states no shear stiffness.
const DENSITY: f64 = 7850.0;
const YOUNGS_MODULUS: f64 = 210e9;
const SHEAR_MODULUS: f64 = 81e9;
const SHEAR_SHARE: f64 = 0.4;

fn set_beam(model: &mut TrackModel, beam: Beam) {
    for section in &mut model.rail {
        section.shear = match beam {
            Beam::Euler => None,
            Beam::Timoshenko => section.shear.or(Some(Shear {
                stiffness: SHEAR_SHARE * SHEAR_MODULUS * section.mass / DENSITY,
                rotary_inertia: DENSITY * section.bending_stiffness / YOUNGS_MODULUS,
            })),
        };
    }
}

/// Differences between a passage and a reference; each is a share of the largest value of the reference unless it has a
/// unit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Errors {
    /// Largest difference of a wheel force at one instant, over the static wheel force.
    pub wheel_force: f64,
    /// The same as a root mean square over instants and wheels.
    pub wheel_force_rms: f64,
    /// Error of the largest wheel force.
    pub wheel_peak: f64,
    /// Largest difference of the peak load of a seat.
    pub seat_load: f64,
    /// Sum over seats of the difference of the time without contact, s.
    pub contact_loss_s: f64,
    /// The same over the sum of those times; none if the reference keeps contact everywhere.
    pub contact_loss: Option<f64>,
    pub rail_moment: f64,
}

impl Measured {
    /// Differences from a reference whose instants are among this one's, or the other way round.
    pub fn errors(&self, reference: &Measured, static_force: f64) -> Errors {
        let (fine, coarse) = if self.interval <= reference.interval { (self, reference) } else { (reference, self) };
        let stride = (coarse.interval / fine.interval).round() as usize;
        let instants = |m: &'_ Measured| m.wheel_forces.len() / m.wheels.max(1);
        let shared = instants(coarse).min(instants(fine).div_ceil(stride));
        let mut largest: f64 = 0.0;
        let mut squares = 0.0;
        for i in 0..shared {
            for wheel in 0..self.wheels {
                let difference =
                    fine.wheel_forces[i * stride * self.wheels + wheel] - coarse.wheel_forces[i * self.wheels + wheel];
                largest = largest.max(difference.abs());
                squares += difference * difference;
            }
        }
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let differences = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect::<Vec<f64>>();
        let share = |part: f64, whole: f64| if part == 0.0 { 0.0 } else { part / whole };
        let lost: f64 = reference.contact_losses.iter().sum();
        let contact_loss_s: f64 = differences(&self.contact_losses, &reference.contact_losses).iter().sum();
        Errors {
            wheel_force: share(largest, static_force),
            wheel_force_rms: share((squares / (shared * self.wheels).max(1) as f64).sqrt(), static_force),
            wheel_peak: share((self.wheel_peak - reference.wheel_peak).abs(), reference.wheel_peak),
            seat_load: share(most(&differences(&self.seat_peaks, &reference.seat_peaks)), most(&reference.seat_peaks)),
            contact_loss_s,
            contact_loss: (lost > 0.0).then_some(contact_loss_s / lost),
            rail_moment: share((self.rail_moment - reference.rail_moment).abs(), reference.rail_moment),
        }
    }
}
