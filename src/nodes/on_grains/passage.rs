//! Operations on a track on grains: it comes to rest, it is loaded, trains pass.

use super::build::{OF_STRIDE, Parts, SHARING};
use super::reading::{Reading, Watched};
use super::step::{Coupled, HOLD};
use super::underway::Following;
use super::wheels::WheelRun;
use super::{Books, Live, Stage, Telling, going_on, tell_stage_and_state};
use crate::graph::{GrainStretch, SleeperOnGrains, StiffnessFrom};
use crate::nodes::{Load, NodeError};
use crate::solvers::granular::{Answer, Stride};
use crate::solvers::track::{Spring, WheelLoads};
use std::ops::{ControlFlow, Range};
use std::time::Instant;

/// Longest time in which a built track must come to rest, s.
const LONGEST: f64 = 2.0;
/// Wheels act on the rail from so far before the grains on to so far behind them, m: three times the length in which a
/// rail's deflection fades.
pub(super) const REACH: f64 = 6.0;
/// Stiffness of supports before the stiffness of the grains is measured, N/m.
const GUESS: f64 = 80e6;
/// Static load on every sleeper, N, about the load on a sleeper under a 20 t axle; time in which it grows and stays, s.
const PRESS: f64 = 40e3;
const PRESSING: [f64; 2] = [0.06, 0.03];

impl Coupled {
    /// Each carried foot now.
    pub fn readings(&self) -> Vec<Reading> {
        let of = |(foot, force): (usize, &f64)| Reading { level: self.level(foot), force: *force };
        self.pushes.iter().enumerate().map(of).collect()
    }

    /// Looks at every carried foot after a step.
    pub fn look(&self, watched: &mut [Watched]) {
        for (foot, watched) in watched.iter_mut().enumerate() {
            watched.see(Reading { level: self.level(foot), force: self.pushes[foot] }, self.time_step());
        }
    }

    /// Adds the inertia that the contacts of now need for the step.
    pub fn hold(&mut self) -> Result<(), NodeError> {
        let start = Instant::now();
        let stride = Stride { step: self.time_step() / OF_STRIDE, sharing: SHARING };
        self.added = 0.0;
        for standing in &mut self.beds {
            self.added = stride.hold(&mut standing.bed)?.max(self.added);
            standing.bed.set_time_step(self.rail.time_step());
        }
        self.spent.inertia += start.elapsed();
        Ok(())
    }

    /// Steps under known wheel forces for a time (s); `see` is called with the time after each step, and may end the
    /// steps.
    pub fn run<A: Answer>(
        &mut self,
        time: f64,
        mut wheels: impl FnMut(f64, &mut Vec<(f64, f64)>),
        mut see: impl FnMut(f64, &Coupled) -> A,
    ) -> Result<(), NodeError> {
        let steps = (time / self.time_step()).ceil() as u64;
        self.run_steps(0..steps, &mut wheels, &mut see)
    }

    /// Some of the steps of a run.
    pub(super) fn run_steps<A: Answer>(
        &mut self,
        steps: Range<u64>,
        wheels: &mut impl FnMut(f64, &mut Vec<(f64, f64)>),
        see: &mut impl FnMut(f64, &Coupled) -> A,
    ) -> Result<(), NodeError> {
        let mut loads = Vec::new();
        for step in steps {
            if step.is_multiple_of(HOLD) {
                self.hold()?;
            }
            let now = step as f64 * self.time_step();
            wheels(now, &mut loads);
            self.step(&WheelLoads::Given(&loads))?;
            going_on(see(now, self).flow())?;
        }
        Ok(())
    }

    /// Loads all sleepers at once, and returns the stiffness of each support, N/m.
    fn press(
        &mut self,
        parts: Parts<'_>,
        tell: &mut impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Vec<f64>, NodeError> {
        let seats: Vec<f64> = self.rail.carried().iter().map(|seat| parts.track.seats[*seat].x).collect();
        let [growing, standing] = PRESSING;
        let before = self.readings();
        let damping = self.damp()?;
        let loads = |time: f64, loads: &mut Vec<(f64, f64)>| {
            loads.clear();
            loads.extend(seats.iter().map(|x| (*x, PRESS * (time / growing).min(1.0))));
        };
        self.run(growing + standing, loads, |time, _| tell(time / (growing + standing)))?;
        self.undamp(&damping)?;
        let secant = |(before, now): (&Reading, Reading)| (now.force - before.force) / (now.level - before.level);
        Ok(before.iter().zip(self.readings()).map(secant).collect())
    }
}

impl Live {
    /// Builds a track on grains and brings it to rest. Supports beyond the grains get the stiffness of the supports on
    /// grains, which is first measured on a copy.
    pub fn build(parts: Parts<'_>, tell: &mut Telling<'_>) -> Result<Live, NodeError> {
        let mut coupled = parts.build(&parts.beyond(GUESS), tell)?;
        let mut copy = coupled.clone();
        copy.come_to_rest(LONGEST, &mut |share| tell(Stage::Rail, share))?;
        let stiffness = copy.press(parts, &mut |share| tell(Stage::StaticLoad, share))?;
        drop(copy);
        let beyond = parts.beyond_as_near(&stiffness);
        coupled.rail = parts.rail(&beyond, coupled.time_step())?;
        let away = coupled.come_to_rest(LONGEST, &mut |share| tell(Stage::Rail, share))?;
        if away > 1.0 {
            let why = format!(
                "the track on grains is not at rest after {LONGEST} s: its motion is {away:.1} times the limit for \
                rest; pack the bed under more pressure"
            );
            return Err(NodeError::Other { node: "grains".into(), why });
        }
        let rest = coupled.readings();
        let as_built = rest.iter().zip(&stiffness).map(|(rest, k)| rest.level - rest.force / k).collect();
        let stiffness = parts.with_buffers(stiffness);
        let settlement = parts.grains.settlement.clone();
        let books =
            Books { beyond, stiffness, as_built, rest, rate: vec![0.0; settlement.len()], settlement, revision: 1 };
        Ok(Live { coupled, books, underway: None })
    }

    /// Presses a copy as it is now. The state that is offered meanwhile is the one before.
    pub fn press(&mut self, parts: Parts<'_>, follow: &mut Following<'_>) -> Result<(), NodeError> {
        let mut tell = |share: f64| match tell_stage_and_state((Stage::StaticLoad, share), &|| self.save(), follow) {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        };
        let stiffness = self.coupled.clone().press(parts, &mut tell)?;
        self.books.stiffness = parts.with_buffers(stiffness);
        self.books.revision += 1;
        self.lay_beyond(parts)
    }

    /// Lets trains pass, with the wheel forces of the plane track; goes on with those that are under way.
    pub fn pass(&mut self, parts: Parts<'_>, load: &Load<'_>, follow: &mut Following<'_>) -> Result<(), NodeError> {
        let none = || NodeError::Other { node: "grains".into(), why: "a passage brings no wheel forces".into() };
        let wheels = load.passage.wheels.as_ref().ok_or_else(none)?;
        // trains that follow each other closely are one passage; others pass one by one, and the track comes to rest
        // between them
        let passages: Vec<WheelRun<'_>> = match parts.grains.headway {
            Some(distance) => vec![WheelRun::new(wheels, load.trains, distance / wheels.speed, load.joined)],
            None => (0..load.trains).map(|_| WheelRun::alone(wheels)).collect(),
        };
        let (done, all) = (self.block().passages, passages.len() as u64);
        for (number, passage) in (0..).zip(&passages).skip(done as usize) {
            self.pass_once(parts, passage, &mut |told| follow(told.of_part(number, all)))?;
            self.block().passages += 1;
        }
        self.end_of_run(load.trains);
        Ok(())
    }

    /// Notes what each of so many trains has added to the settlement of every seat, m.
    pub fn note_rate(&mut self, before: &[f64], trains: u64) {
        let added = self.books.settlement.iter().zip(before).map(|(now, before)| now - before);
        self.books.rate = added.map(|added| added / trains.max(1) as f64).collect();
    }

    fn pass_once(
        &mut self,
        parts: Parts<'_>,
        wheels: &WheelRun<'_>,
        follow: &mut Following<'_>,
    ) -> Result<(), NodeError> {
        let [left, right] = parts.ends();
        let Some([begin, end]) = wheels.within([left - REACH, right + REACH]) else { return Ok(()) };
        let time_step = self.coupled.time_step();
        let steps = ((end - begin) / time_step).ceil() as u64;
        self.watch();
        let mut step = self.block().step;
        let with_rest = steps + self.coupled.steps_after();
        while step < steps {
            let next = self.next_steps(step, (steps, with_rest), follow)?;
            let time = |step: u64| begin + step as f64 * time_step;
            let mut recording = self.recording(time(step) <= wheels.first_ends());
            if let Some(recording) = recording.as_mut().filter(|_| step.is_multiple_of(HOLD)) {
                recording.read_contacts(&mut self.coupled, parts, time(step))?;
                self.tell_beds(parts, recording, wheels.leading_at(time(step)), follow)?;
            }
            step = next.end;
            let Live { coupled, underway, .. } = self;
            let mut nobody = Vec::new();
            let watched = underway.as_mut().map_or(&mut nobody, |underway| &mut underway.watched);
            let mut now = next.start;
            coupled.run_steps(
                next,
                &mut |time, loads| wheels.loads_at(begin + time, begin, loads),
                &mut |_, coupled| {
                    coupled.look(watched);
                    recording.iter_mut().for_each(|recording| recording.see(coupled, parts, now, time(now)));
                    now += 1;
                },
            )?;
            self.block().step = step;
            self.go_on_recording(recording);
        }
        self.come_to_rest((steps, with_rest), follow)?;
        self.end_of_passage(parts)?;
        self.block().step = 0;
        Ok(())
    }

    /// Looks at every carried foot from the beginning of a passage on.
    pub fn watch(&mut self) {
        let watched: Vec<Watched> = self.books.rest.iter().map(|rest| Watched::from_rest(*rest)).collect();
        let underway = self.block();
        if underway.step == 0 {
            underway.watched = watched;
        }
    }

    /// Ends a passage after which everything is at rest.
    pub fn end_of_passage(&mut self, parts: Parts<'_>) -> Result<(), NodeError> {
        let watched = std::mem::take(&mut self.block().watched);
        self.close_the_books(parts, &watched)
    }

    /// Result of a passage.
    fn close_the_books(&mut self, parts: Parts<'_>, watched: &[Watched]) -> Result<(), NodeError> {
        let Live { coupled, books, .. } = self;
        books.rest = coupled.readings();
        if parts.grains.stiffness_from == StiffnessFrom::Passage {
            for (stiffness, watched) in books.stiffness.iter_mut().zip(watched) {
                *stiffness = watched.stiffness().unwrap_or(*stiffness);
            }
            books.stiffness = parts.with_buffers(std::mem::take(&mut books.stiffness));
            books.revision += 1;
        }
        let started = &parts.grains.settlement;
        let carried = coupled.rail.carried();
        let settled = |(foot, seat): (usize, &usize)| {
            let seen = watched[foot].unloaded_level(books.rest[foot], books.stiffness[foot]);
            // a support that no wheel has reached lies where it did, and no higher than the sleeper over it
            let unseen =
                || (books.as_built[foot] + books.settlement[*seat] - started[*seat]).max(books.rest[foot].level);
            seen.unwrap_or_else(unseen) - books.as_built[foot]
        };
        let settled = parts.with_buffers(carried.iter().enumerate().map(settled).collect());
        for (seat, settlement) in books.settlement.iter_mut().enumerate() {
            let settled = match carried.binary_search(&seat) {
                Ok(foot) => settled[foot],
                Err(_) if parts.track.seats[seat].is_ballasted() => parts.as_near(&settled, seat),
                Err(_) => 0.0,
            };
            *settlement = started[seat] + settled;
        }
        self.lay_beyond(parts)
    }

    /// Updates the springs beyond the grains: stiffness of the supports near them (N/m), and level (m). The motion of
    /// the rail goes on.
    fn lay_beyond(&mut self, parts: Parts<'_>) -> Result<(), NodeError> {
        let Live { coupled, books, .. } = self;
        let beyond = parts.beyond_as_near(&books.stiffness);
        if beyond != books.beyond {
            let mut rail = parts.rail(&beyond, coupled.time_step())?;
            rail.restore(coupled.rail.state())?;
            coupled.rail = rail;
            books.beyond = beyond;
        }
        let started = &parts.grains.settlement;
        let added: Vec<f64> = books.settlement.iter().zip(started).map(|(now, start)| now - start).collect();
        Ok(coupled.rail.set_level(&parts.level(&books.beyond, &added))?)
    }
}

impl Parts<'_> {
    fn sleepers(&self) -> impl Iterator<Item = &SleeperOnGrains> {
        self.grains.stretches.iter().flat_map(|stretch| &stretch.sleepers)
    }

    /// The values of the carried feet; feet over buffers take the values near them.
    fn with_buffers(&self, mut values: Vec<f64>) -> Vec<f64> {
        for (foot, sleeper) in self.sleepers().enumerate().filter(|(_, sleeper)| sleeper.buffer) {
            values[foot] = self.as_near(&values, sleeper.seat);
        }
        values
    }

    /// Springs under the sleepers beyond the grains, as stiff as the supports of the carried feet near them, N/m.
    fn beyond_as_near(&self, stiffness: &[f64]) -> Vec<Option<Spring>> {
        let seats = self.track.seats.iter().enumerate();
        let spring = |number: usize| self.support(number, self.as_near(stiffness, number));
        seats.map(|(number, seat)| seat.is_ballasted().then(|| spring(number))).collect()
    }

    /// Median of the values of those carried feet that are read and in the third of the nearest bed that is next to a
    /// seat.
    fn as_near(&self, values: &[f64], seat: usize) -> f64 {
        let away = |other: usize| (self.track.seats[other].x - self.track.seats[seat].x).abs();
        let mut values = values.iter();
        let of_bed = |stretch: &GrainStretch| {
            let read = stretch.sleepers.iter().zip(&mut values).filter(|(sleeper, _)| !sleeper.buffer);
            let mut read: Vec<(f64, f64)> = read.map(|(sleeper, value)| (away(sleeper.seat), *value)).collect();
            read.sort_by(|a, b| a.0.total_cmp(&b.0));
            read
        };
        let beds = self.grains.stretches.iter().map(of_bed).filter(|read| !read.is_empty());
        let mut near = beds.min_by(|a, b| a[0].0.total_cmp(&b[0].0)).unwrap_or_default();
        near.truncate(near.len().div_ceil(3));
        median(near.into_iter().map(|(_, value)| value).collect())
    }
}

pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n.is_multiple_of(2) => 0.5 * (values[middle - 1] + values[middle]),
        _ => values[middle],
    }
}
