//! Vehicles ride on the rail over the grains: track, vehicles, grains and soil in one step; only forces and velocities
//! are exchanged.

use super::build::Parts;
use super::extremes::{Extremes, Recorded};
use super::passage::REACH;
use super::reading::LIFTED;
use super::step::HOLD;
use super::underway::{Following, RideUnderway};
use super::{GrainGround, Live};
use crate::graph::{Blocks, Record, Runner, Train};
use crate::nodes::{NodeError, PassageOutcome, RailPoint, Unloaded, UnloadedSeat};
use crate::solvers::track::{Direction, WheelLoads};

/// Trains of a block that ride over the grains.
pub struct Riders<'a> {
    pub blocks: &'a Blocks,
    pub runner: Runner,
    pub trains: u64,
    /// Axles that have passed before.
    pub axles: u64,
    /// Records of the first of them; `None` if it is not recorded.
    pub records: Option<&'a [Record]>,
}

impl GrainGround<'_> {
    /// The track without a train; in the middle of a block, as the block began.
    pub fn at_rest(&self) -> Result<Unloaded, NodeError> {
        let live = self.live_at_rest()?;
        let ride = live.underway.as_ref().and_then(|underway| underway.ride.as_ref());
        Ok(ride.map_or_else(|| live.at_rest(self.parts()), |ride| ride.unloaded.clone()))
    }

    /// Begins a block of trains that ride, or goes on with the one that is under way: gives the passages of its runs
    /// that are done.
    pub fn begin_rides(&mut self) -> Result<Vec<PassageOutcome>, NodeError> {
        let unloaded = self.at_rest()?;
        let underway = self.working()?.block();
        let begun = || RideUnderway::new(unloaded);
        Ok(underway.ride.get_or_insert_with(begun).outcomes.clone())
    }

    /// Ends a block of trains that ride.
    pub fn end_rides(&mut self) -> Result<(), NodeError> {
        let live = self.working()?;
        let recorded = live.recorded();
        live.underway = None;
        self.recorded = recorded;
        self.answer();
        Ok(())
    }

    /// Lets the next run of trains of a block ride over the grains, and returns the passage of the first train. Trains
    /// that follow each other closely are one passage.
    pub fn ride(&mut self, riders: &Riders<'_>, follow: &mut Following<'_>) -> Result<PassageOutcome, NodeError> {
        let parts = self.parts();
        let live = self.working()?;
        let underway = live.block();
        if riders.records.is_some() && (underway.runs, underway.passages, underway.step) == (0, 0, 0) {
            live.begin_record(parts, riders.axles);
        }
        let passages = if parts.grains.headway.is_some() { 1 } else { riders.trains };
        let train = following(riders, parts.grains.headway, riders.trains.div_ceil(passages.max(1)));
        for number in live.block().passages..passages {
            let outcome = live.ride(parts, riders, &train, &mut |told| follow(told.of_part(number, passages)))?;
            live.underway_ride()?.first.get_or_insert(outcome);
            live.block().passages += 1;
        }
        let ride = live.underway_ride()?;
        let first = ride.first.take().ok_or(NodeError::NoTrain)?;
        ride.outcomes.push(first.clone());
        live.end_of_run(riders.trains);
        Ok(first)
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
    fn at_rest(&self, parts: Parts<'_>) -> Unloaded {
        let (rail, books) = (&self.coupled.rail, &self.books);
        let settlement = &books.settlement;
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
            let lifted =
                parts.dead_weight(number) / books.stiffness_of(number, rail.carried(), parts).max(f64::MIN_POSITIVE);
            let gap = settlement[number] - parts.grains.settlement[number] - lifted - sleeper_level;
            let force = view.contact_force(number).unwrap_or(0.0);
            UnloadedSeat {
                settlement: settlement[number],
                sleeper_level,
                void: if seat.is_ballasted() && force <= LIFTED { gap.max(0.0) } else { 0.0 },
                contact_force: force,
                seat_load: view.seat_load(number),
                support_stiffness: books.stiffness_of(number, rail.carried(), parts),
            }
        };
        Unloaded {
            rail: nodes.map(point).collect(),
            seats: parts.track.seats.iter().enumerate().map(seat).collect(),
            profile: Vec::new(),
        }
    }

    /// The part of a block under way that is about vehicles that ride.
    fn underway_ride(&mut self) -> Result<&mut RideUnderway, NodeError> {
        self.block().ride.as_mut().ok_or(NodeError::NoTrain)
    }

    /// One passage, from its beginning or from where it is.
    fn ride(
        &mut self,
        parts: Parts<'_>,
        riders: &Riders<'_>,
        train: &Train,
        follow: &mut Following<'_>,
    ) -> Result<PassageOutcome, NodeError> {
        let [start, steps] = self.steps_of_ride(parts, riders, train)?;
        let rest = self.coupled.steps_after();
        let all = steps + 2 * rest;
        let (kind, plan) = riders.blocks.kind(riders.runner.kind);
        let time_step = self.coupled.time_step();
        let ride = self.underway_ride()?;
        let (since, unloaded) = (ride.since, ride.unloaded.clone());
        let interval = plan.sample_every as f64 * plan.time_step;
        let recorded = riders.records.map(|records| Recorded { records, axles: riders.axles, interval });
        let mut extremes = Extremes::new(parts.track, &unloaded, (kind, plan), recorded, time_step);
        if start > 0 {
            extremes.seen = std::mem::take(&mut ride.seen);
        }
        let mut step = start;
        while step < steps {
            self.block().step = step;
            self.underway_ride()?.seen = std::mem::take(&mut extremes.seen);
            let next = self.next_steps(step, (steps, all), follow)?;
            extremes.seen = std::mem::take(&mut self.underway_ride()?.seen);
            let is_look = step.is_multiple_of(HOLD);
            step = next.end;
            let mut recording = self.recording(true);
            if is_look {
                self.coupled.hold()?;
            }
            if let Some(recording) = recording.as_mut().filter(|_| is_look) {
                let time = self.coupled.rail.time() - since;
                recording.read_contacts(&mut self.coupled, parts, time)?;
                let leading = self.coupled.rail.view().wheel_positions().next();
                self.tell_beds(parts, recording, leading, follow)?;
            }
            for now in next {
                self.coupled.step(&WheelLoads::Riding)?;
                let Some(underway) = &mut self.underway else { continue };
                self.coupled.look(&mut underway.watched);
                let view = self.coupled.rail.view();
                extremes.see(&view, time_step, since);
                recording
                    .iter_mut()
                    .for_each(|recording| recording.see(&self.coupled, parts, now, view.time() - since));
            }
            self.go_on_recording(recording);
        }
        self.coupled.rail.dismiss();
        self.block().step = steps.max(1);
        let ride = self.underway_ride()?;
        ride.on_rail = false;
        ride.seen = std::mem::take(&mut extremes.seen);
        self.come_to_rest_on_all(parts, [steps, rest, all], follow)?;
        extremes.seen = std::mem::take(&mut self.underway_ride()?.seen);
        Ok(extremes.outcome())
    }

    /// Comes to rest after a ride, or goes on with it: on the grains, and then on the springs beyond them that have
    /// settled too: the rail goes down, and the load on the grains under it changes.
    fn come_to_rest_on_all(
        &mut self,
        parts: Parts<'_>,
        [steps, rest, all]: [u64; 3],
        follow: &mut Following<'_>,
    ) -> Result<(), NodeError> {
        if !self.underway_ride()?.has_settled {
            self.come_to_rest((steps, all), follow)?;
            self.end_of_passage(parts)?;
            self.underway_ride()?.has_settled = true;
        }
        self.come_to_rest((steps + rest, all), follow)?;
        self.books.rest = self.coupled.readings();
        self.underway_ride()?.has_settled = false;
        self.block().step = 0;
        Ok(())
    }

    /// Steps of a ride that are done and of the whole ride, with the train where it is; it has gone from one that comes
    /// to rest.
    fn steps_of_ride(&mut self, parts: Parts<'_>, riders: &Riders<'_>, train: &Train) -> Result<[u64; 2], NodeError> {
        let underway = self.block();
        let has_gone = underway.resting.is_some();
        let done = underway.step;
        if has_gone {
            return Ok([done, done]);
        }
        let way = self.set_out(parts, riders, train)?;
        Ok([done, (way / train.speed / self.coupled.time_step()).ceil() as u64])
    }

    /// Puts a train before the rail, or where it was in the middle of its passage; gives the way that its first wheel
    /// goes, m.
    fn set_out(&mut self, parts: Parts<'_>, riders: &Riders<'_>, train: &Train) -> Result<f64, NodeError> {
        let ([left, right], [start, end]) = (parts.ends(), parts.track.ends());
        let direction = riders.runner.direction;
        let from = self.coupled.rail.approach(direction);
        // the last wheel goes behind the grains, or to the end of the track
        let way = match direction {
            Direction::Forward => (right + REACH).min(end) - from,
            Direction::Backward => from - (left - REACH).max(start),
        };
        self.watch();
        let motion = self.underway_ride()?.motion.take();
        self.coupled.rail.ride(&train.model(direction), &train.motion, from)?;
        let now = self.coupled.rail.time();
        match motion {
            Some(motion) => self.coupled.rail.restore(&motion)?,
            None => self.underway_ride()?.since = now,
        }
        self.underway_ride()?.on_rail = true;
        Ok(way + train.wheel_base())
    }
}
