//! Vehicles ride on the rail over the grains: track, vehicles, grains and soil in one step, nothing exchanged but forces and velocities.

use super::build::Parts;
use super::extremes::{Extremes, Recorded};
use super::passage::{AFTER, HOLD, REACH};
use super::reading::{LIFTED, Reading, Watched};
use super::{GrainGround, Live, Stage, Telling};
use crate::graph::{Blocks, Record, Runner, Train};
use crate::nodes::{NodeError, PassageOutcome, RailPoint, Substructure, Unloaded, UnloadedSeat};
use crate::solvers::track::{Direction, WheelLoads};

/// Room that the first wheel has before the rail, m.
const BEFORE: f64 = 0.5;

/// Trains of a block that ride over the grains.
pub struct Riders<'a> {
    pub blocks: &'a Blocks,
    pub runner: Runner,
    pub trains: u64,
    /// Axles that have passed before.
    pub axles: u64,
    /// What the first of them is recorded for; `None` where it is not.
    pub records: Option<&'a [Record]>,
}

impl GrainGround<'_> {
    /// The track without a train.
    pub fn at_rest(&self) -> Result<Unloaded, NodeError> {
        self.live_at_rest().map(|live| live.at_rest(self.parts(), &self.settlement()))
    }

    /// Lets trains of a block ride over the grains, and gives the passage of the first of them; trains that follow each other closely are
    /// one passage.
    pub fn ride(&mut self, riders: &Riders<'_>, tell: &mut Telling<'_>) -> Result<PassageOutcome, NodeError> {
        let before = self.settlement();
        let unloaded = self.at_rest()?;
        let parts = self.parts();
        let passages = if parts.grains.headway.is_some() { 1 } else { riders.trains };
        let together = riders.trains.div_ceil(passages.max(1));
        let mut first = None;
        for passage in 0..passages {
            let train = following(riders, parts.grains.headway, together);
            let mut tell = |stage, share: f64| tell(stage, (passage as f64 + share) / passages as f64);
            let outcome = self.working()?.ride(parts, riders, &train, &unloaded, &mut tell)?;
            first.get_or_insert(outcome);
        }
        self.working()?.note_rate(&before, riders.trains);
        self.answer();
        first.ok_or(NodeError::NoTrain)
    }
}

/// A train, and the same again behind it, so many in all.
fn following(riders: &Riders<'_>, headway: Option<f64>, trains: u64) -> Train {
    let (train, _) = riders.blocks.kind(riders.runner.kind);
    let behind = headway.unwrap_or(0.0);
    let vehicles = (0..trains).flat_map(|number| {
        train.vehicles.iter().map(move |(vehicle, offset)| (*vehicle, offset + number as f64 * behind))
    });
    Train { vehicles: vehicles.collect(), ..train.clone() }
}

impl Live {
    /// The track without a train, as it lies on the grains.
    fn at_rest(&self, parts: Parts<'_>, settlement: &[f64]) -> Unloaded {
        let (rail, books) = (&self.coupled.rail, &self.books);
        let view = rail.view();
        let nodes = rail.track().nodes().iter().enumerate();
        let point = |(node, x): (usize, &f64)| RailPoint {
            x: *x,
            deflection: view.rail_deflection(node),
            moment: view.rail_moment(node),
        };
        let seat = |(number, seat): (usize, &crate::graph::TrackSeat)| {
            let sleeper_level = view.foot_displacement(number);
            // of a sleeper on springs they were made to carry the track at level 0
            let lifted = parts.dead_weight(number) / books.stiffness_of(number, rail.carried()).max(f64::MIN_POSITIVE);
            let gap = settlement[number] - parts.grains.settlement[number] - lifted - sleeper_level;
            let force = view.contact_force(number).unwrap_or(0.0);
            UnloadedSeat {
                settlement: settlement[number],
                sleeper_level,
                void: if seat.is_ballasted() && force <= LIFTED { gap.max(0.0) } else { 0.0 },
                contact_force: force,
                seat_load: view.seat_load(number),
                support_stiffness: books.stiffness_of(number, rail.carried()),
            }
        };
        Unloaded {
            rail: nodes.map(point).collect(),
            seats: parts.track.seats.iter().enumerate().map(seat).collect(),
            profile: Vec::new(),
        }
    }

    fn ride(
        &mut self,
        parts: Parts<'_>,
        riders: &Riders<'_>,
        train: &Train,
        unloaded: &Unloaded,
        tell: &mut Telling<'_>,
    ) -> Result<PassageOutcome, NodeError> {
        let (kind, plan) = riders.blocks.kind(riders.runner.kind);
        let direction = riders.runner.direction;
        let ([left, right], [start, end]) = (parts.ends(), parts.track.ends());
        let model = train.model(direction);
        let (from, way) = match direction {
            Direction::Forward => (start - BEFORE, right + REACH - (start - BEFORE)),
            Direction::Backward => (end + BEFORE, end + BEFORE - (left - REACH)),
        };
        // the last wheel goes behind the grains, or to the end of the track
        let way = way.min(end - start + BEFORE) + train.wheel_base();
        let time_step = self.coupled.time_step();
        let interval = plan.sample_every as f64 * plan.time_step;
        let recorded = riders.records.map(|records| Recorded { records, axles: riders.axles, interval });
        let mut extremes = Extremes::new(parts.track, unloaded, (kind, plan), recorded, time_step);
        let mut watched: Vec<Watched> = self.books.rest.iter().map(|rest| Watched::from_rest(*rest)).collect();
        self.coupled.rail.ride(&model, &train.motion, from)?;
        let (began, steps) = (self.coupled.rail.time(), (way / train.speed / time_step).ceil() as u64);
        for step in 0..steps {
            if step.is_multiple_of(HOLD) {
                self.coupled.hold()?;
            }
            self.coupled.step(&WheelLoads::Riding)?;
            for (foot, watched) in watched.iter_mut().enumerate() {
                watched.see(Reading { level: self.coupled.level(foot), force: self.coupled.pushes[foot] }, time_step);
            }
            extremes.see(&self.coupled.rail.view(), time_step, began);
            if step.is_multiple_of(steps.div_ceil(100)) {
                tell(Stage::Passage, step as f64 / steps as f64);
            }
        }
        self.coupled.come_to_rest(AFTER, &mut |_| {})?;
        self.close_the_books(parts, &watched)?;
        Ok(extremes.outcome())
    }
}
