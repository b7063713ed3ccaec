//! One train over one track: the state of the passage, and one step.
//!
//! A step solves the linear track with all supports closed, then the contacts ([`super::interface`]), and adds the
//! displacements by the contact forces. During the run no matrix is factored and no memory allocated.

use super::counters::Counters;
use super::error::{TrackError, TrackParameter, Wild};
use super::influence::Stepper;
use super::interface::{ContactIndex, Interface};
use super::ladder::Choice;
use super::motion::Timetable;
use super::quasi_static::{self, Start};
use super::running::RunningVehicle;
use super::{Loads, Motion, StaticState, SupportPhase, TrackLevel, Train, WheelContact, solve_static};
use crate::linalg::vector::add_scaled;
use std::ops::Range;

/// Limit of a displacement of the track, m; of a rotation, rad. A larger one means that the motion is unstable.
pub(super) const WILD_DISPLACEMENT: f64 = 1.0;
/// Limit of a wheel force, as a multiple of the static force. A larger one means that the motion is unstable.
pub(super) const WILD_FORCE: f64 = 100.0;

/// Whether a value is within its limit; a value that is not a number is not.
#[inline]
pub(super) fn within(value: f64, limit: f64) -> bool {
    value.abs() <= limit
}

/// The train of a run, its start and its finish.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    pub train: &'a Train,
    /// Chainage of the leading wheel at the start and at the finish, m; at both, all wheels stand on the track.
    pub start: f64,
    pub finish: f64,
    pub motion: &'a Motion,
}

/// A passage under way. All vectors run over the unknowns of the track unless said otherwise.
#[derive(Debug, Clone)]
pub struct Passage<'a> {
    pub(super) stepper: &'a Stepper,
    pub(super) level: &'a TrackLevel,
    pub(super) train: Option<(Run<'a>, Timetable)>,
    pub(super) unloaded: StaticState,
    pub(super) counters: Counters,
    /// Time in ticks: the step itself, or the shortest one of a ladder.
    pub(super) tick: u64,
    pub(super) tick_length: f64,
    pub(super) ticks_per_step: u64,
    pub(super) ticks_per_longest: u64,
    /// Length of the last step, s; at the start, length of the first step.
    pub(super) last_step: f64,
    pub(super) planned_ticks: u64,
    /// How the length of a step is chosen; none if it is fixed.
    pub(super) choice: Option<Box<Choice<'a>>>,
    pub(super) displacement: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    pub(super) interface: Interface,
    /// Chainage per wheel, m.
    pub(super) wheel_positions: Vec<f64>,
    /// Per sleeper, N.
    pub(super) support_forces: Vec<f64>,
    /// Each vehicle with the range of its wheels among all wheels.
    pub(super) vehicles: Vec<(RunningVehicle, Range<usize>)>,
    /// Limit of each wheel force, N; a larger force means that the motion is unstable.
    force_limits: Vec<f64>,
    steady: Vec<f64>,
    predicted: Vec<f64>,
    predicted_velocity: Vec<f64>,
    mean: [Vec<f64>; 3],
}

impl<'a> Passage<'a> {
    /// Places the train at its start, on a track at `level`, in quasi-static motion.
    ///
    /// Fails if a wheel stands off the track at the start or finish, if a speed is not above 0, if the finish does not
    /// lie ahead, or if there is no static equilibrium.
    pub fn new(stepper: &'a Stepper, level: &'a TrackLevel, run: Run<'a>) -> Result<Self, TrackError> {
        let (track, sign) = (&stepper.track, run.train.direction.sign());
        let timetable = run.motion.timetable(run.start, run.finish, sign)?;
        for x in run.train.wheel_positions(run.start).chain(run.train.wheel_positions(run.finish)) {
            track.rail_point(x)?;
        }
        let start = quasi_static::start(track, level, run.train, run.start, run.motion.speed_at(run.start))?;
        let planned_steps = (timetable.duration / stepper.time_step() + 1e-9).floor() as u64;
        let mut passage = Self::begin(stepper, level, Some((run, timetable)), start)?;
        passage.planned_ticks = planned_steps;
        Ok(passage)
    }

    /// Releases a track without vehicles that was held in `state`, for `steps` steps.
    pub fn released(
        stepper: &'a Stepper,
        level: &'a TrackLevel,
        state: StaticState,
        steps: usize,
    ) -> Result<Self, TrackError> {
        if !state.vehicles.is_empty() {
            let value = state.vehicles.len() as f64;
            return Err(TrackError::Parameter {
                name: TrackParameter::Train("vehicles"),
                value,
                expected: "of 0 on a released track",
            });
        }
        let track = &stepper.track;
        let start = Start::at_rest(track, state);
        let mut mass = track.mass.clone();
        track.held.iter().for_each(|(unknown, _)| mass.pin(*unknown));
        let mut passage = Self::begin(stepper, level, None, start)?;
        // Accelerations by the forces at the first instant, if every unknown has mass.
        if let Ok(mass) = mass.factor() {
            let forces = &mut passage.acceleration;
            forces.copy_from_slice(&passage.steady);
            track.stiffness.subtract_product(&passage.displacement, forces);
            for (sleeper, q) in track.sleepers.iter().zip(&passage.interface.corrections) {
                forces[sleeper.unknown] += q;
            }
            track.held.iter().for_each(|(unknown, _)| forces[*unknown] = 0.0);
            mass.solve_in_place(forces);
        }
        passage.planned_ticks = steps as u64;
        Ok(passage)
    }

    fn begin(
        stepper: &'a Stepper,
        level: &'a TrackLevel,
        train: Option<(Run<'a>, Timetable)>,
        start: Start,
    ) -> Result<Self, TrackError> {
        let track = &stepper.track;
        let unloaded = solve_static(track, level, &Loads::default())?;
        let (mut vehicles, mut contacts) = (Vec::new(), Vec::new());
        let (mut wheel_positions, mut force_limits): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        if let Some((run, _)) = &train {
            wheel_positions.extend(run.train.wheel_positions(run.start));
            let mut first = 0;
            for (v, (vehicle, _)) in run.train.vehicles.iter().enumerate() {
                let (displacement, velocity) = (start.state.vehicles[v].clone(), start.vehicle_velocity[v].clone());
                let (gravity, scheme) = (track.model.gravity, &stepper.scheme);
                let running = RunningVehicle::new(vehicle, gravity, scheme, displacement, velocity)?;
                let of_wheels: Vec<WheelContact> = vehicle.wheels.iter().map(|w| w.contact).collect();
                let load = vehicle.wheel_load(gravity);
                force_limits.extend(vehicle.wheels.iter().map(|w| match w.contact {
                    WheelContact::Given(_) => f64::INFINITY,
                    _ => WILD_FORCE * load,
                }));
                contacts.push((of_wheels, running.wheel_compliance(scheme)));
                vehicles.push((running, first..first + vehicle.wheels.len()));
                first += vehicle.wheels.len();
            }
        }
        let mut interface = Interface::new(contacts, &wheel_positions, track.sleepers.len());
        interface.forces.copy_from_slice(&start.state.wheel_forces);
        interface.indentations.copy_from_slice(&start.state.indentations);
        for (point, x) in interface.points.iter_mut().zip(&wheel_positions) {
            *point = track.rail_point(*x)?;
        }
        let mut support_forces = vec![0.0; track.sleepers.len()];
        for (s, sleeper) in track.sleepers.iter().enumerate() {
            let gap = start.state.unknowns[sleeper.unknown] - level.settlements[sleeper.seat];
            let damper = sleeper.support_damping * start.velocity[sleeper.unknown];
            let phase = start.state.phases[s];
            let force = sleeper.spring_force(phase, gap) + damper;
            let carries = phase != SupportPhase::Open && force >= 0.0;
            support_forces[s] = if carries { force } else { 0.0 };
            interface.gaps[s] = gap;
            interface.phases[s] = if carries { phase } else { SupportPhase::Open };
            let closed = sleeper.spring_force(SupportPhase::Closed, gap) + damper;
            interface.corrections[s] = closed - support_forces[s];
        }
        let order = track.order();
        Ok(Self {
            stepper,
            level,
            train,
            unloaded,
            counters: Counters::default(),
            tick: 0,
            tick_length: stepper.time_step(),
            ticks_per_step: 1,
            ticks_per_longest: 1,
            last_step: stepper.time_step(),
            planned_ticks: 0,
            choice: None,
            displacement: start.state.unknowns,
            velocity: start.velocity,
            acceleration: start.acceleration,
            interface,
            wheel_positions,
            support_forces,
            vehicles,
            force_limits,
            steady: track.steady_forces(level),
            predicted: vec![0.0; order],
            predicted_velocity: vec![0.0; order],
            mean: [vec![0.0; order], vec![0.0; order], vec![0.0; order]],
        })
    }

    /// The track without vehicles at this level.
    pub fn unloaded(&self) -> &StaticState {
        &self.unloaded
    }

    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Steps from the start to the finish if all steps were as long as the first.
    pub fn planned_steps(&self) -> usize {
        (self.planned_ticks / self.ticks_per_longest) as usize
    }

    /// Counts time in ticks: the step, halved `halvings` times.
    pub(super) fn divide_ticks(&mut self, halvings: u32) {
        self.ticks_per_step <<= halvings;
        self.ticks_per_longest = self.ticks_per_step;
        self.planned_ticks <<= halvings;
        self.tick_length = self.stepper.time_step() / self.ticks_per_step as f64;
    }

    /// s, since the start.
    pub fn time(&self) -> f64 {
        self.tick as f64 * self.tick_length
    }

    /// A step of the present length.
    pub(super) fn step_once(&mut self) -> Result<(), TrackError> {
        self.move_freely();
        self.counters.steps += 1;
        self.tick += self.ticks_per_step;
        self.last_step = self.stepper.time_step();
        self.move_wheels();
        self.place_supports();
        self.solve_contacts()?;
        self.add_contacts();
        self.check_sense()
    }

    /// The track at the end of the step with all supports closed and without the wheel forces there.
    fn move_freely(&mut self) {
        let (track, scheme) = (&*self.stepper.track, &self.stepper.scheme);
        let (dt, alpha_f) = (scheme.time_step, scheme.alpha_f);
        let [mean, mean_velocity, mean_acceleration] = &mut self.mean;
        let order = track.order();
        let (u, v, a) = (&mut self.displacement[..order], &mut self.velocity[..order], &mut self.acceleration[..order]);
        let (predicted, predicted_velocity) = (&mut self.predicted[..order], &mut self.predicted_velocity[..order]);
        let (from_a, velocity_from_a) = ((0.5 - scheme.beta) * dt * dt, (1.0 - scheme.gamma) * dt);
        for i in 0..order {
            predicted[i] = u[i] + dt * v[i] + from_a * a[i];
            predicted_velocity[i] = v[i] + velocity_from_a * a[i];
            mean[i] = (1.0 - alpha_f) * predicted[i] + alpha_f * u[i];
            mean_velocity[i] = (1.0 - alpha_f) * predicted_velocity[i] + alpha_f * v[i];
            mean_acceleration[i] = scheme.alpha_m * a[i];
        }
        a.copy_from_slice(&self.steady);
        for (point, force) in self.interface.points.iter().zip(&self.interface.forces) {
            track.add_force(point, alpha_f * force, a);
        }
        for (sleeper, q) in track.sleepers.iter().zip(&self.interface.corrections) {
            a[sleeper.unknown] += alpha_f * q;
        }
        track.stiffness.subtract_product(mean, a);
        track.damping.subtract_product(mean_velocity, a);
        track.mass.subtract_product(mean_acceleration, a);
        for (unknown, _) in &track.held {
            a[*unknown] = 0.0;
        }
        self.stepper.factor.solve_in_place(a);
    }

    /// The wheels at the end of the step, and their indentations of the free rail without wheel forces.
    fn move_wheels(&mut self) {
        let (track, scheme) = (&*self.stepper.track, &self.stepper.scheme);
        let time = self.time();
        if let Some((run, timetable)) = &self.train {
            let leading = timetable.position(time);
            for (position, x) in self.wheel_positions.iter_mut().zip(run.train.wheel_positions(leading)) {
                *position = x;
            }
        }
        let share = scheme.displacement_share();
        let (predicted, a) = (&self.predicted, &self.acceleration);
        for (vehicle, wheels) in &mut self.vehicles {
            vehicle.predict(scheme, &self.interface.forces[wheels.clone()]);
            for j in wheels.clone() {
                let x = self.wheel_positions[j];
                let point = track.moved_point(self.interface.points[j].element, x);
                let unknowns = track.element_unknowns(point.element);
                let rail: f64 =
                    (0..4).map(|k| point.shape[k] * (predicted[unknowns[k]] + share * a[unknowns[k]])).sum();
                self.interface.points[j] = point;
                self.interface.free_indentations[j] =
                    vehicle.free_wheel(scheme, j - wheels.start) - rail - track.model.irregularity.depth_at(x);
            }
        }
    }

    /// The gaps under the free track, and the lines on which supports carry within this step.
    fn place_supports(&mut self) {
        let (track, scheme) = (&*self.stepper.track, &self.stepper.scheme);
        let (share, rate) = (scheme.displacement_share(), scheme.rate());
        for (s, sleeper) in track.sleepers.iter().enumerate() {
            let (i, settlement) = (sleeper.unknown, self.level.settlements[sleeper.seat]);
            self.interface.free_gaps[s] = self.predicted[i] + share * self.acceleration[i] - settlement;
            let passing_speed = self.predicted_velocity[i] + rate * (settlement - self.predicted[i]);
            self.interface.lines[s] = sleeper.lines(rate, passing_speed);
        }
    }

    fn solve_contacts(&mut self) -> Result<(), TrackError> {
        let track = &*self.stepper.track;
        let effort = self.interface.solve(self.stepper).map_err(|contact| TrackError::StepNotConverged {
            step: self.counters.steps,
            time: self.tick as f64 * self.tick_length,
            x: match contact {
                ContactIndex::Wheel(rank) => self.wheel_positions[self.interface.wheel_of(rank)],
                ContactIndex::Support(s) => track.sleepers.get(s).map_or(f64::NAN, |s| track.model.seats[s.seat].x),
            },
            contact: self.interface.describe(contact),
        })?;
        self.counters.iterations += effort.iterations;
        self.counters.most_iterations = self.counters.most_iterations.max(effort.iterations);
        self.counters.most_open_supports = self.counters.most_open_supports.max(effort.active);
        Ok(())
    }

    /// Adds the displacements by the contact forces: the end of the step.
    fn add_contacts(&mut self) {
        let scheme = &self.stepper.scheme;
        let (share, velocity_share) = (scheme.displacement_share(), scheme.velocity_share());
        let per_displacement = 1.0 / share;
        let a = &mut self.acceleration[..];
        for (point, force) in self.interface.points.iter().zip(&self.interface.forces) {
            for (column, shape) in self.stepper.columns(point.element).into_iter().zip(point.shape) {
                add_scaled(&mut a[column.start..], &column.values, per_displacement * shape * force);
            }
        }
        for (column, q) in self.stepper.of_sleeper.iter().zip(&self.interface.corrections) {
            if *q != 0.0 {
                add_scaled(&mut a[column.start..], &column.values, per_displacement * q);
            }
        }
        let order = a.len();
        let (u, v) = (&mut self.displacement[..order], &mut self.velocity[..order]);
        let (predicted, predicted_velocity) = (&self.predicted[..order], &self.predicted_velocity[..order]);
        for i in 0..order {
            u[i] = predicted[i] + share * a[i];
            v[i] = predicted_velocity[i] + velocity_share * a[i];
        }
        for (vehicle, wheels) in &mut self.vehicles {
            vehicle.finish(scheme, &self.interface.forces[wheels.clone()]);
        }
        for s in 0..self.support_forces.len() {
            self.support_forces[s] = self.interface.support_force(s);
        }
    }

    /// Fails if a wheel force or a displacement is beyond its limit.
    fn check_sense(&self) -> Result<(), TrackError> {
        let mut forces = self.interface.forces.iter().zip(&self.force_limits);
        if let Some(j) = forces.position(|(force, limit)| !within(*force, *limit)) {
            let (step, x, force) = (self.counters.steps, self.wheel_positions[j], self.interface.forces[j]);
            return Err(TrackError::Unstable { step, time: self.time(), x, what: Wild::WheelForce(force) });
        }
        if self.displacement.iter().fold(true, |sound, u| sound & within(*u, WILD_DISPLACEMENT)) {
            Ok(())
        } else {
            Err(self.wild_displacement(self.time()))
        }
    }

    /// Names the first displacement beyond its limit.
    fn wild_displacement(&self, time: f64) -> TrackError {
        let track = &self.stepper.track;
        let unknown = self.displacement.iter().position(|u| !within(*u, WILD_DISPLACEMENT)).unwrap_or(0);
        TrackError::Unstable {
            step: self.counters.steps,
            time,
            x: track.place_of(unknown),
            what: Wild::Displacement(self.displacement[unknown]),
        }
    }

    /// Kinetic and potential energy of the track, J, relative to the track as built without weight.
    pub fn energy(&self) -> f64 {
        let track = &self.stepper.track;
        let u = &self.displacement;
        let mut energy = 0.5 * (track.mass.quadratic_form(&self.velocity) + track.stiffness.quadratic_form(u));
        energy -= track.weight.iter().zip(u).map(|(w, u)| w * u).sum::<f64>();
        for sleeper in &track.sleepers {
            let (u, k) = (u[sleeper.unknown], sleeper.support_stiffness);
            let gap = (u - self.level.settlements[sleeper.seat]).max(0.0);
            let (soft, closure) = sleeper.seating.map_or((k, 0.0), |s| (s.stiffness, s.closure));
            let (first, then) = (gap.min(closure), (gap - closure).max(0.0));
            energy += 0.5 * (soft * first * first + k * then * then - k * u * u) + soft * closure * then;
        }
        energy
    }
}
