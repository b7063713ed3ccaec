//! The track node at work: its statics and its passages, spoken to in the scene's terms.

use super::model::{level, model, motion, scheme, train};
use super::profile;
use super::sampler::Sampler;
use super::substructure::initial_settlement;
use super::track::{PassageOutcome, RailPoint, SeatOutcome, Unloaded, UnloadedSeat};
use super::{AdaptiveSteps, Blocks, Graph, Runner, Schedule, TrackNode};
use crate::scenario::{Direction, Record, StaticLoad, Target, Train};
use crate::solvers::settlement::Peak;
use crate::solvers::track::{
    Envelope, Ladder, Loads, Passage, Run, Scheme, StaticState, Stepper, Track, TrackError, TrackLevel, TrackParameter,
    solve_static,
};
use std::ops::Range;
use std::sync::Arc;

/// A meshed track, its time step factored once for all passages.
pub(super) struct TrackSystem<'a> {
    node: &'a TrackNode,
    records: &'a [Record],
    track: Arc<Track>,
    /// With the steps of each kind of train.
    traffic: Option<(&'a Blocks, Vec<Arc<Steps>>)>,
}

/// What a passage keeps beside its outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kept {
    Nothing,
    Histories,
    /// Histories, and the unloaded rail under the mean wheel of the train.
    Profile,
}

/// The time steps of all passages, factored once.
pub enum Steps {
    Even(Stepper),
    Chosen { ladder: Ladder, tolerance: f64 },
}

impl Steps {
    fn new(track: &Arc<Track>, scheme: Scheme, adaptive: Option<AdaptiveSteps>) -> Result<Self, TrackError> {
        Ok(match adaptive {
            None => Steps::Even(Stepper::new(track.clone(), scheme)?),
            Some(AdaptiveSteps { tolerance, halvings }) => {
                Steps::Chosen { ladder: Ladder::new(track, scheme, halvings as usize)?, tolerance }
            }
        })
    }

    /// A passage in these steps.
    pub fn begin<'a>(&'a self, level: &'a TrackLevel, run: Run<'a>) -> Result<Passage<'a>, TrackError> {
        match self {
            Steps::Even(stepper) => Passage::new(stepper, level, run),
            Steps::Chosen { ladder, tolerance } => Passage::adaptive(ladder, level, run, *tolerance),
        }
    }
}

/// The steps of every kind of train; those that take the same ones share their factors.
fn steps_of_kinds(blocks: &Blocks, track: &Arc<Track>) -> Result<Vec<Arc<Steps>>, TrackError> {
    let mut steps: Vec<Arc<Steps>> = Vec::new();
    let plans: Vec<_> = blocks.kinds().map(|(_, plan)| (plan.integrator, plan.time_step, plan.adaptive)).collect();
    for (kind, plan) in plans.iter().enumerate() {
        let (integrator, time_step, adaptive) = *plan;
        steps.push(match plans[..kind].iter().position(|earlier| earlier == plan) {
            Some(same) => steps[same].clone(),
            None => Arc::new(Steps::new(track, scheme(integrator, time_step)?, adaptive)?),
        });
    }
    Ok(steps)
}

/// Seats whose mean stands for those near the ends of the model, see [`TrackSystem::complete`].
const NEIGHBOURS: usize = 10;

/// Wheel forces beyond so many static ones are no answer: rails break long before.
pub const RUNAWAY: f64 = 10.0;

impl<'a> TrackSystem<'a> {
    pub fn new(graph: &'a Graph) -> Result<Self, TrackError> {
        let track = Arc::new(Track::new(model(&graph.track))?);
        let traffic = match &graph.schedule {
            Schedule::Static { .. } => None,
            Schedule::Blocks(blocks) => Some((&**blocks, steps_of_kinds(blocks, &track)?)),
        };
        Ok(TrackSystem { node: &graph.track, records: &graph.records, track, traffic })
    }

    /// The track under test loads.
    pub fn equilibrium(&self, loads: &[StaticLoad]) -> Result<Unloaded, TrackError> {
        let seats = &self.node.track.seats;
        let on = |target: Target| loads.iter().filter(move |l| l.on == target);
        let rail: Vec<(f64, f64)> = on(Target::Rail).map(|l| (l.x, *l.force)).collect();
        let nearest = |x: f64| {
            (0..seats.len()).min_by(|&a, &b| (seats[a].x - x).abs().total_cmp(&(seats[b].x - x).abs())).unwrap_or(0)
        };
        let sleepers: Vec<(usize, f64)> = on(Target::Sleepers).map(|l| (nearest(l.x), *l.force)).collect();
        let settlement = initial_settlement(&self.node.track);
        let loads = Loads { rail: &rail, sleepers: &sleepers, train: None };
        let state = solve_static(&self.track, &level(self.node, &settlement), &loads)?;
        Ok(self.at_rest(&state, &settlement))
    }

    fn at_rest(&self, state: &StaticState, settlement: &[f64]) -> Unloaded {
        let nodes = self.track.nodes().iter().zip(&state.rail_deflection).zip(&state.rail_moment);
        let rail = nodes.map(|((x, deflection), moment)| RailPoint { x: *x, deflection: *deflection, moment: *moment });
        let gap = |i: usize| (settlement[i] - state.foot_displacements[i]).max(0.0);
        let seats = (0..settlement.len()).map(|i| UnloadedSeat {
            settlement: settlement[i],
            sleeper_level: state.foot_displacements[i],
            void: if self.node.track.seats[i].is_ballasted() { gap(i) } else { 0.0 },
            contact_force: state.contact_forces[i],
            seat_load: state.seat_loads[i],
        });
        Unloaded { rail: rail.collect(), seats: seats.collect(), profile: Vec::new() }
    }

    /// One train over the settled track, and the track at rest before it.
    pub fn passage(
        &self,
        axles: u64,
        settlement: &[f64],
        runner: Runner,
        kept: Kept,
    ) -> Result<(Unloaded, PassageOutcome), TrackError> {
        let Some((blocks, steps)) = &self.traffic else {
            return Err(TrackError::Parameter {
                name: TrackParameter::Train("trains"),
                value: 0.0,
                expected: "of 1 or more",
            });
        };
        let ((kind, plan), steps, direction) = (blocks.kind(runner.kind), &steps[runner.kind], runner.direction);
        let train = train(kind, direction);
        let (left, right, base) = (plan.left, plan.right, train.wheel_base());
        let (start, finish) =
            if direction == Direction::Backward { (right - base, left) } else { (left + base, right) };
        let level = level(self.node, settlement);
        let motion = motion(kind);
        let run = Run { train: &train, start, finish, motion: &motion };
        let mut passage = steps.begin(&level, run)?;
        let mut unloaded = self.at_rest(passage.unloaded(), settlement);
        let recorded = kept != Kept::Nothing;
        if kept == Kept::Profile {
            let load = kind.mean_wheel_mass() * self.node.gravity;
            unloaded.profile = profile::profile(&self.track, &level, passage.unloaded(), load, left..=right)?;
        }
        let mut envelope = Envelope::default();
        let wanted = if recorded { self.records } else { &[] };
        let mut sampler = Sampler::new(wanted, axles, plan.sample_every, recorded);
        let counters = passage.run(&mut (&mut envelope, &mut sampler))?;

        let seats = settlement.len();
        let mut outcomes: Vec<SeatOutcome> = (0..seats)
            .map(|i| SeatOutcome {
                max_rail_seat_load: envelope.seat_loads[i].1,
                max_contact_force: envelope.contact_forces[i],
                max_sleeper_displacement: envelope.foot_displacements[i],
                contact_loss: envelope.contact_losses[i],
            })
            .collect();
        let peaks_of = |seat: usize| {
            let deflections = envelope.axle_deflections_of(seat);
            let wheels = envelope.axle_peaks_of(seat).iter().zip(deflections);
            wheels.map(|(force, deflection)| Peak { force: *force, deflection: *deflection }).collect()
        };
        let mut peaks: Vec<Vec<Peak>> = (0..seats).map(peaks_of).collect();
        self.complete(plan.passed(kind), &mut outcomes, &mut peaks);
        let largest = |range: &[(f64, f64)]| range.iter().map(|r| r.1).fold(f64::NEG_INFINITY, f64::max);
        let outcome = PassageOutcome {
            seats: outcomes,
            peaks,
            max_wheel_force: largest(&envelope.wheel_forces),
            min_wheel_force: envelope.wheel_forces.iter().map(|r| r.0).fold(f64::INFINITY, f64::min),
            max_rail_moment: largest(&envelope.rail_moments),
            rail_moments: envelope.rail_moments,
            rail_displacements: envelope.rail_displacements,
            time_steps: counters.steps as u64,
            newton_iterations: counters.iterations as u64,
            samples: sampler.samples,
        };
        self.bounded(kind, &outcome)?;
        Ok((unloaded, outcome))
    }

    /// Refuses an outcome that has run away: it would settle the track by forces that no track bears.
    fn bounded(&self, train: &Train, outcome: &PassageOutcome) -> Result<(), TrackError> {
        let mass: f64 = train.vehicles.iter().map(|v| v.mass()).sum();
        let times = outcome.max_wheel_force / (mass * self.node.gravity / train.axles() as f64);
        if times <= RUNAWAY {
            return Ok(());
        }
        let load = |i: &usize| outcome.seats[*i].max_rail_seat_load;
        let worst = (0..outcome.seats.len()).max_by(|a, b| load(a).total_cmp(&load(b))).unwrap_or(0);
        let x = self.node.track.seats.get(worst).map_or(0.0, |seat| seat.x);
        Err(TrackError::RanAway { x, force: outcome.max_wheel_force, times })
    }

    /// Trains start and stop on the track, so seats near its ends see only some of their wheels. Such a seat takes the mean of
    /// the nearest ten of its section that every wheel passes, as if trains came from afar: otherwise a false step in the
    /// settlement would grow where they start. A section of which no seat is passed keeps what it saw.
    fn complete(&self, passed: Range<f64>, outcomes: &mut [SeatOutcome], peaks: &mut [Vec<Peak>]) {
        let seats = &self.node.track.seats;
        for (i, seat) in seats.iter().enumerate().filter(|(_, s)| !passed.contains(&s.x)) {
            let whole = |n: &usize| seats[*n].section == seat.section && passed.contains(&seats[*n].x);
            let from: Vec<usize> = if seat.x < passed.start {
                (0..seats.len()).filter(whole).take(NEIGHBOURS).collect()
            } else {
                (0..seats.len()).rev().filter(whole).take(NEIGHBOURS).collect()
            };
            if from.is_empty() {
                continue;
            }
            let mean = |of: &dyn Fn(usize) -> f64| from.iter().map(|n| of(*n)).sum::<f64>() / from.len() as f64;
            let mean_peak = |wheel: usize| Peak {
                force: mean(&|n| peaks[n][wheel].force),
                deflection: mean(&|n| peaks[n][wheel].deflection),
            };
            peaks[i] = (0..peaks[i].len()).map(mean_peak).collect();
            outcomes[i] = SeatOutcome {
                max_rail_seat_load: mean(&|n| outcomes[n].max_rail_seat_load),
                max_contact_force: mean(&|n| outcomes[n].max_contact_force),
                max_sleeper_displacement: mean(&|n| outcomes[n].max_sleeper_displacement),
                contact_loss: mean(&|n| outcomes[n].contact_loss),
            };
        }
    }
}
