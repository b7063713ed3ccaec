//! The track node at work: its statics and its passages.

use super::sampler::{ForceSampler, Sampler, WheelSampler};
use super::standing::{StandingBogies, StandingForces};
use super::steps::{Steps, steps_of_kinds};
use super::{
    Kept, NodeError, PassageOutcome, RailPoint, Request, SeatOutcome, Superstructure, Unloaded, UnloadedSeat, profile,
};
use crate::graph::{
    Blocks, LoadedPart, PassagePlan, PointLoad, Record, Responses, Runner, TrackNode, TrackSeat, Train,
};
use crate::solvers::settlement::Peak;
use crate::solvers::track::{Envelope, Loads, Run, StaticState, Track, TrackError, TrackLevel, solve_static};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// A track on its ground, meshed, its time steps factored once for all passages.
pub struct TrackSystem<'a> {
    node: Cow<'a, TrackNode>,
    records: &'a [Record],
    blocks: Option<Cow<'a, Blocks>>,
    built: Option<Built>,
}

/// The parts that depend on the responses of the ground.
struct Built {
    responses: Responses,
    track: Arc<Track>,
    /// Steps in time, for each kind of train.
    steps: Vec<Arc<Steps>>,
    /// Standing bogies, from the first time that somebody asks for their forces.
    bogies: OnceLock<Result<StandingBogies, TrackError>>,
}

/// Seats whose mean stands for those near the ends of the model, see [`TrackSystem::complete`].
const NEIGHBOURS: usize = 10;

/// Wheel forces above this multiple of the static force are not a valid result: rails break at much smaller forces.
pub const RUNAWAY: f64 = 10.0;

impl<'a> TrackSystem<'a> {
    /// A track without ground yet; `blocks` gives the trains that run over it, `records` the histories that are
    /// recorded.
    pub fn new(node: &'a TrackNode, blocks: Option<&'a Blocks>, records: &'a [Record]) -> Self {
        TrackSystem { node: Cow::Borrowed(node), records, blocks: blocks.map(Cow::Borrowed), built: None }
    }

    /// The same track on the same ground, with twice the elements and finer passages.
    pub fn finer(&self) -> Result<TrackSystem<'a>, NodeError> {
        let node = TrackNode { elements_per_bay: 2 * self.node.elements_per_bay, ..self.node.clone().into_owned() };
        let blocks = self.blocks.as_ref().map(|blocks| Cow::Owned(blocks.finer()));
        let mut finer = TrackSystem { node: Cow::Owned(node), records: self.records, blocks, built: None };
        finer.stand_on(&self.built()?.responses)?;
        Ok(finer)
    }

    fn blocks(&self) -> Result<&Blocks, NodeError> {
        self.blocks.as_deref().ok_or(NodeError::NoTrain)
    }

    fn built(&self) -> Result<&Built, NodeError> {
        self.built.as_ref().ok_or(NodeError::NoGround)
    }

    /// Forces of standing bogies on a settlement of every seat (m), and the voids if they are asked for.
    pub fn standing(&self, settlement: &[f64], with_voids: bool) -> Result<StandingForces, NodeError> {
        Ok(self.bogies()?.forces(settlement, with_voids)?)
    }

    fn bogies(&self) -> Result<&StandingBogies, NodeError> {
        let (built, blocks) = (self.built()?, self.blocks()?);
        let bogies = built.bogies.get_or_init(|| StandingBogies::new(&self.node, &built.responses, blocks));
        bogies.as_ref().map_err(|error| error.clone().into())
    }

    /// Peak forces of a passage after the settlement under it has changed, and with it the forces of standing bogies.
    pub fn follow(
        &self,
        kind: usize,
        passage: &PassageOutcome,
        [from, to]: [&StandingForces; 2],
    ) -> Result<Vec<Vec<Peak>>, NodeError> {
        let blocks = self.blocks()?;
        let mut peaks = self.bogies()?.follow(kind, &passage.peaks, from, to);
        let (train, plan) = blocks.kind(kind);
        for (seat, sources) in self.incomplete(plan.passed(train)) {
            peaks[seat] = mean_peaks(&peaks, &sources);
        }
        Ok(peaks)
    }

    fn at_rest(&self, state: &StaticState, settlement: &[f64], Built { track, responses, .. }: &Built) -> Unloaded {
        let nodes = track.nodes().iter().zip(&state.rail_deflection).zip(&state.rail_moment);
        let rail = nodes.map(|((x, deflection), moment)| RailPoint { x: *x, deflection: *deflection, moment: *moment });
        let gap = |i: usize| (settlement[i] - state.foot_displacements[i]).max(0.0);
        let stiffness = |i: usize| responses.seats.get(i).copied().flatten().map_or(0.0, |spring| spring.stiffness);
        let seats = (0..settlement.len()).map(|i| UnloadedSeat {
            settlement: settlement[i],
            sleeper_level: state.foot_displacements[i],
            void: if self.node.seats[i].is_ballasted() { gap(i) } else { 0.0 },
            contact_force: state.contact_forces[i],
            seat_load: state.seat_loads[i],
            support_stiffness: stiffness(i),
        });
        Unloaded { rail: rail.collect(), seats: seats.collect(), profile: Vec::new() }
    }

    fn run(&self, request: Request<'_>) -> Result<(Unloaded, PassageOutcome), NodeError> {
        let Request { axles, settlement, runner, kept, forces } = request;
        let blocks = self.blocks()?;
        let built = self.built()?;
        let Built { responses, track, steps, .. } = built;
        let Runner { kind, direction } = runner;
        let ((train, plan), steps) = (blocks.kind(kind), &steps[kind]);
        let model = train.model(direction);
        let (start, finish) = plan.way(train, direction);
        let level: TrackLevel = self.node.level(settlement, responses);
        let run = Run { train: &model, start, finish, motion: &train.motion };
        let mut passage = steps.begin(&level, run)?;
        let mut unloaded = self.at_rest(passage.unloaded(), settlement, built);
        let recorded = kept != Kept::Nothing;
        if kept == Kept::Profile {
            let load = train.mean_wheel_mass() * self.node.gravity;
            unloaded.profile = profile::profile(track, &level, passage.unloaded(), load, plan.left..=plan.right)?;
        }
        let mut envelope = Envelope::default();
        let mut sampler = Sampler::new(if recorded { self.records } else { &[] }, axles, plan.sample_every, recorded);
        let mut force_sampler = ForceSampler::new(forces, settlement.len(), plan.time_step);
        let mut wheel_sampler = WheelSampler::new(forces, plan.time_step, train.speed);
        let samplers = &mut (&mut force_sampler, &mut wheel_sampler);
        let counters = passage.run(&mut (&mut envelope, &mut (&mut sampler, samplers)))?;

        let seats = self.at_seats(&envelope, &unloaded.seats, plan.passed(train));
        let outcome = PassageOutcome {
            time_steps: counters.steps as u64,
            newton_iterations: counters.iterations as u64,
            samples: sampler.samples,
            forces: force_sampler.taken(),
            wheels: wheel_sampler.taken(),
            ..self.extremes(train, plan, track, envelope, seats)
        };
        self.bounded(train, &outcome)?;
        Ok((unloaded, outcome))
    }

    /// Extremes of a passage, without its cost and records.
    fn extremes(
        &self,
        train: &Train,
        plan: &PassagePlan,
        track: &Track,
        envelope: Envelope,
        (seats, peaks): (Vec<SeatOutcome>, Vec<Vec<Peak>>),
    ) -> PassageOutcome {
        let largest = |range: &[(f64, f64)]| range.iter().map(|r| r.1).fold(f64::NEG_INFINITY, f64::max);
        let passed = plan.passed(train);
        let over_the_way = |range: &[(f64, f64)]| {
            let places = range.iter().zip(track.nodes());
            let whole: Vec<(f64, f64)> = places.filter(|(_, x)| passed.contains(*x)).map(|(r, _)| *r).collect();
            // no place of a short way is passed by every wheel
            largest(if whole.is_empty() { range } else { &whole })
        };
        let shares = shares_of_static(train, self.node.gravity, &envelope.wheel_forces);
        PassageOutcome {
            seats,
            peaks,
            max_wheel_force: largest(&envelope.wheel_forces),
            min_wheel_force: envelope.wheel_forces.iter().map(|r| r.0).fold(f64::INFINITY, f64::min),
            amplification: shares.map(|(_, most)| most),
            unloading: shares.map(|(least, _)| 1.0 - least),
            max_rail_moment: over_the_way(&envelope.rail_moments),
            max_rail_displacement: over_the_way(&envelope.rail_displacements),
            rail_moments: envelope.rail_moments,
            rail_displacements: envelope.rail_displacements,
            time_steps: 0,
            newton_iterations: 0,
            samples: Vec::new(),
            forces: None,
            wheels: None,
        }
    }

    /// Extremes of every seat, and the largest force of each wheel on its support, as if trains came from far away.
    fn at_seats(
        &self,
        envelope: &Envelope,
        unloaded: &[UnloadedSeat],
        passed: Range<f64>,
    ) -> (Vec<SeatOutcome>, Vec<Vec<Peak>>) {
        let (mut outcomes, mut peaks) = at_seats(envelope, unloaded);
        self.complete(passed, &mut outcomes, &mut peaks);
        (outcomes, peaks)
    }

    /// Refuses an unstable outcome: it would settle the track by unrealistic forces.
    fn bounded(&self, train: &Train, outcome: &PassageOutcome) -> Result<(), TrackError> {
        let times = outcome.max_wheel_force / (train.mass() * self.node.gravity / train.axles() as f64);
        if times <= RUNAWAY {
            return Ok(());
        }
        let load = |i: &usize| outcome.seats[*i].max_rail_seat_load;
        let worst = (0..outcome.seats.len()).max_by(|a, b| load(a).total_cmp(&load(b))).unwrap_or(0);
        let x = self.node.seats.get(worst).map_or(0.0, |seat| seat.x);
        Err(TrackError::RanAway { x, force: outcome.max_wheel_force, times })
    }

    /// Trains start and stop on the track, so seats near its ends are passed by only some of the wheels. Such a seat
    /// takes the mean of the nearest ten seats of its section that every wheel passes, as if trains came from far away.
    /// Otherwise a false step in the settlement would grow at the start of the trains. A section without such a seat
    /// keeps its own values.
    fn complete(&self, passed: Range<f64>, outcomes: &mut [SeatOutcome], peaks: &mut [Vec<Peak>]) {
        for (seat, from) in self.incomplete(passed) {
            let mean = |of: &dyn Fn(usize) -> f64| from.iter().map(|n| of(*n)).sum::<f64>() / from.len() as f64;
            peaks[seat] = mean_peaks(peaks, &from);
            outcomes[seat] = SeatOutcome {
                max_rail_seat_load: mean(&|n| outcomes[n].max_rail_seat_load),
                max_contact_force: mean(&|n| outcomes[n].max_contact_force),
                max_sleeper_displacement: mean(&|n| outcomes[n].max_sleeper_displacement),
                contact_loss: mean(&|n| outcomes[n].contact_loss),
            };
        }
    }

    /// Seats that not every wheel passes, each with the seats whose mean it takes.
    fn incomplete(&self, passed: Range<f64>) -> Vec<(usize, Vec<usize>)> {
        let seats = &self.node.seats;
        let sources = |(i, seat): (usize, &TrackSeat)| {
            let whole = |n: &usize| seats[*n].section == seat.section && passed.contains(&seats[*n].x);
            let from: Vec<usize> = if seat.x < passed.start {
                (0..seats.len()).filter(whole).take(NEIGHBOURS).collect()
            } else {
                (0..seats.len()).rev().filter(whole).take(NEIGHBOURS).collect()
            };
            (!from.is_empty()).then_some((i, from))
        };
        seats.iter().enumerate().filter(|(_, seat)| !passed.contains(&seat.x)).filter_map(sources).collect()
    }
}

/// The mean of the peak forces of some seats, wheel by wheel.
fn mean_peaks(peaks: &[Vec<Peak>], from: &[usize]) -> Vec<Peak> {
    let mean = |of: &dyn Fn(usize) -> f64| from.iter().map(|n| of(*n)).sum::<f64>() / from.len() as f64;
    let of_wheel = |wheel: usize| Peak {
        force: mean(&|n| peaks[n][wheel].force),
        deflection: mean(&|n| peaks[n][wheel].deflection),
        void: mean(&|n| peaks[n][wheel].void),
    };
    (0..peaks[from[0]].len()).map(of_wheel).collect()
}

/// Extremes of every seat over a passage, and the largest force of each wheel of the train on its support.
fn at_seats(envelope: &Envelope, unloaded: &[UnloadedSeat]) -> (Vec<SeatOutcome>, Vec<Vec<Peak>>) {
    let seats = unloaded.len();
    let outcome = |i: usize| SeatOutcome {
        max_rail_seat_load: envelope.seat_loads[i].1,
        max_contact_force: envelope.contact_forces[i],
        max_sleeper_displacement: envelope.foot_displacements[i],
        contact_loss: envelope.contact_losses[i],
    };
    let peaks_of = |seat: usize| {
        let deflections = envelope.axle_deflections_of(seat);
        let wheels = envelope.axle_peaks_of(seat).iter().zip(deflections);
        let void = unloaded[seat].void;
        wheels.map(|(force, deflection)| Peak { force: *force, deflection: *deflection, void }).collect()
    };
    ((0..seats).map(outcome).collect(), (0..seats).map(peaks_of).collect())
}

impl Superstructure for TrackSystem<'_> {
    fn stand_on(&mut self, responses: &Responses) -> Result<(), NodeError> {
        if self.built.as_ref().is_some_and(|built| built.responses.revision == responses.revision) {
            return Ok(());
        }
        let track = Arc::new(Track::new(self.node.model(responses))?);
        let steps =
            self.blocks.as_deref().map(|blocks| steps_of_kinds(blocks, &track)).transpose()?.unwrap_or_default();
        self.built = Some(Built { responses: responses.clone(), track, steps, bogies: OnceLock::new() });
        Ok(())
    }

    fn equilibrium(&self, settlement: &[f64], loads: &[PointLoad]) -> Result<Unloaded, NodeError> {
        let built = self.built()?;
        let Built { responses, track, .. } = built;
        let (mut rail, mut sleepers) = (Vec::new(), Vec::new());
        for load in loads {
            match load.on {
                LoadedPart::Rail { x } => rail.push((x, load.force)),
                LoadedPart::Sleeper { seat } => sleepers.push((seat, load.force)),
            }
        }
        let loads = Loads { rail: &rail, sleepers: &sleepers, train: None };
        let state = solve_static(track, &self.node.level(settlement, responses), &loads)?;
        Ok(self.at_rest(&state, settlement, built))
    }

    fn passage(&self, request: Request<'_>) -> Result<(Unloaded, PassageOutcome), NodeError> {
        self.run(request)
    }
}

/// The least and the largest force of any wheel over its static force; `None` without gravity. Forces are of wheel
/// after wheel.
fn shares_of_static(train: &Train, gravity: f64, forces: &[(f64, f64)]) -> Option<(f64, f64)> {
    let loads = train.static_wheel_loads(gravity);
    let shares = forces
        .iter()
        .zip(loads)
        .filter(|(_, load)| *load > 0.0)
        .map(|((least, most), load)| (least / load, most / load));
    shares.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}
