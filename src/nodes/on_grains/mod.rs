//! A track whose sleepers stand on grains: packed beds under a rail, and soil below (the paper's DEM-FDM model).
//!
//! Between two exchanges the wheel forces of the plane track run over the rail of this model. The settlement and the
//! stiffness of every support go back to the plane track (the paper's Fig. 3). Sleepers beyond the grains stand on
//! springs; their supports settle as the median of the outer third of the sleepers on grains, and so do those in the
//! last bay before grains that are held.

mod build;
mod energy;
mod extremes;
mod idle;
mod passage;
mod reading;
mod recording;
mod rest;
mod ride;
mod soil;
mod step;
mod stored;
#[cfg(test)]
mod tests;
mod timed;
mod under_track;
mod underway;
mod volumes;
mod wheels;

pub(super) use build::{OF_STRIDE, SHARING};
pub use build::{Parts, mass_for_step};
pub use energy::PassageEnergy;
pub use recording::VolumeSample;
pub use ride::Riders;
pub use timed::{Parted, TimedSteps};
pub use under_track::BedUnderTrack;
pub use underway::{Following, Told};

use crate::graph::{Responses, StiffnessFrom};
use crate::nodes::{Bonds, Forces, Load, Mark, NodeError, Substructure};
use crate::solvers::track::Spring;
use reading::Reading;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::ControlFlow;
use step::Coupled;
use underway::Underway;

/// Stage of the computation of a track on grains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    Packing,
    Laying,
    Sleepers,
    Cribs,
    Soil,
    Rail,
    StaticLoad,
    Passage,
    Check,
    Rest,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stage::Packing => "packing a cell",
            Stage::Laying => "placing cells side by side",
            Stage::Sleepers => "setting down sleepers",
            Stage::Cribs => "filling cribs",
            Stage::Soil => "soil below",
            Stage::Rail => "laying the rail, coming to rest",
            Stage::StaticLoad => "static load on the sleepers",
            Stage::Passage => "trains on grains",
            Stage::Check => "cells that check the law",
            Stage::Rest => "coming to rest",
        })
    }
}

/// Gets the stage, and the share of this stage that is done. A break ends the computation.
pub type Telling<'a> = dyn FnMut(Stage, f64) -> ControlFlow<()> + 'a;

/// Fails if the listener has ended the run.
pub(super) fn going_on(told: ControlFlow<()>) -> Result<(), NodeError> {
    match told {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(NodeError::Stopped),
    }
}

/// Reports the progress of trains, and offers the state: a listener that ends the run can store the state first.
pub(super) fn tell_stage_and_state(
    (stage, share): (Stage, f64),
    state: &dyn Fn() -> Result<serde_json::Value, NodeError>,
    follow: &mut Following<'_>,
) -> Result<(), NodeError> {
    let told = [follow(Told::Stage(stage, share)), follow(Told::State(state))];
    told.into_iter().try_for_each(going_on)
}

/// Grains as the ground of a track.
pub struct GrainGround<'a> {
    parts: Parts<'a>,
    responses: Responses,
    live: Option<Live>,
    /// Axles after which the next block begins, where its first passage is recorded.
    record: Option<u64>,
    /// The records of the last block.
    recorded: Vec<VolumeSample>,
}

/// The ground at work.
#[derive(Clone)]
pub(super) struct Live {
    coupled: Coupled,
    books: Books,
    /// The block of trains that has begun and is not done.
    underway: Option<Underway>,
}

/// Data of every seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Books {
    /// Under the seats that do not stand on grains.
    beyond: Vec<Option<Spring>>,
    /// Stiffness of the support of every carried foot, N/m.
    stiffness: Vec<f64>,
    /// Level at which the support of each carried foot carried nothing when the track was built, m.
    as_built: Vec<f64>,
    /// Each carried foot at rest now.
    rest: Vec<Reading>,
    /// Level of every support without load below the level as built, m, of the seats.
    settlement: Vec<f64>,
    /// Settlement added by the last train, m.
    rate: Vec<f64>,
    /// Grows whenever a stiffness changes.
    revision: u64,
}

impl Books {
    /// Stiffness of what carries the sleeper of a seat, N/m; 0 without a sleeper. `carried` are the seats on grains.
    fn stiffness_of(&self, seat: usize, carried: &[usize], parts: Parts<'_>) -> f64 {
        match carried.binary_search(&seat) {
            Ok(foot) => parts.support(seat, self.stiffness[foot]).stiffness,
            Err(_) => self.beyond[seat].map_or(0.0, |spring| spring.stiffness),
        }
    }
}

impl<'a> GrainGround<'a> {
    /// A ground that is not built yet: [`Substructure::prepare`] does that, or [`Substructure::restore`].
    pub fn new(parts: Parts<'a>) -> GrainGround<'a> {
        let responses = Responses { revision: 0, seats: Vec::new() };
        GrainGround { parts, responses, live: None, record: None, recorded: Vec::new() }
    }

    /// Times steps under the wheels of a passage, on a copy.
    pub fn time_steps(&self, load: &Load<'_>, steps: u64) -> Result<TimedSteps, NodeError> {
        self.live_at_rest()?.time_steps(self.parts, load, steps)
    }

    fn working(&mut self) -> Result<&mut Live, NodeError> {
        self.live.as_mut().ok_or(NodeError::NoGround)
    }

    fn live_at_rest(&self) -> Result<&Live, NodeError> {
        self.live.as_ref().ok_or(NodeError::NoGround)
    }

    fn parts(&self) -> Parts<'a> {
        self.parts
    }

    /// Takes over the values of the supports from the books.
    fn answer(&mut self) {
        let Some(live) = &self.live else { return };
        let (books, coupled) = (live.told(), &live.coupled);
        let mut seats = books.beyond.clone();
        for (foot, seat) in coupled.rail.carried().iter().enumerate() {
            seats[*seat] = Some(self.parts.support(*seat, books.stiffness[foot]));
        }
        self.responses = Responses { revision: books.revision, seats };
    }
}

impl Substructure for GrainGround<'_> {
    fn prepare(&mut self, tell: &mut Telling<'_>) -> Result<(), NodeError> {
        let parts = self.parts;
        // later results must not depend on whether the track was built before: both cases continue from the stored
        // state
        let state = parts.beds.built(&parts.hash(), || Live::build(parts, tell)?.save())?;
        self.restore(&state)
    }

    fn responses(&self) -> &Responses {
        &self.responses
    }

    fn settlement(&self) -> Vec<f64> {
        self.live.as_ref().map_or(&self.parts.grains.settlement, |live| &live.told().settlement).clone()
    }

    fn forces(&self) -> Forces {
        Forces::Wheels
    }

    /// Prediction: each train adds the settlement of the last train, because the response of grains is not known before
    /// it is computed.
    fn predict(&self, loads: &[Load<'_>]) -> Result<Vec<f64>, NodeError> {
        let trains: u64 = loads.iter().map(|load| load.trains).sum();
        let rate = self.live.as_ref().map(|live| live.told().rate.as_slice()).unwrap_or_default();
        let settlement = self.settlement().into_iter().enumerate();
        Ok(settlement.map(|(seat, s)| s + trains as f64 * rate.get(seat).copied().unwrap_or(0.0)).collect())
    }

    fn foresees(&self) -> bool {
        false
    }

    fn advance(&mut self, loads: &[Load<'_>]) -> Result<(), NodeError> {
        self.advance_and_follow(loads, &mut |_| ControlFlow::Continue(()))
    }

    fn advance_and_follow(&mut self, loads: &[Load<'_>], follow: &mut Following<'_>) -> Result<(), NodeError> {
        let parts = self.parts;
        let record = self.record.take();
        let live = self.working()?;
        if let Some(axles) = record.filter(|_| live.underway.is_none()) {
            live.begin_record(parts, axles);
        }
        let done = live.block().runs;
        for load in loads.iter().skip(done) {
            live.pass(parts, load, follow)?;
        }
        // the trains are still under way: a run that stops meanwhile has lost none of them
        if parts.grains.stiffness_from == StiffnessFrom::StaticLoad {
            live.press(parts, follow)?;
        }
        let recorded = live.recorded();
        live.underway = None;
        self.recorded = recorded;
        self.answer();
        Ok(())
    }

    fn record(&mut self, axles: u64) {
        self.record = Some(axles);
    }

    fn recorded(&mut self) -> Vec<VolumeSample> {
        std::mem::take(&mut self.recorded)
    }

    fn record_alone(
        &mut self,
        axles: u64,
        load: &Load<'_>,
        follow: &mut Following<'_>,
    ) -> Result<Vec<VolumeSample>, NodeError> {
        self.record_copy(axles, load, follow)
    }

    fn bonds(&self) -> Bonds {
        let beds = self.live.iter().flat_map(|live| &live.coupled.beds);
        beds.map(|standing| Bonds::in_bed(&standing.bed)).sum()
    }

    fn is_underway(&self) -> bool {
        self.live.as_ref().is_some_and(|live| live.underway.is_some())
    }

    fn beds(&mut self) -> Result<Vec<BedUnderTrack<'_>>, NodeError> {
        self.look()
    }

    /// A failure of grains ends the run, and nothing goes back to before it.
    fn mark(&self) -> Mark {
        Mark(Box::new(()))
    }

    fn roll_back(&mut self, _: Mark) {}

    fn tamp(&mut self, _: &[usize], _: f64) -> Result<(), NodeError> {
        Err(NodeError::Other { node: "grains".into(), why: "this version cannot tamp grains".into() })
    }

    fn save(&self) -> Result<serde_json::Value, NodeError> {
        self.live_at_rest()?.save()
    }

    fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError> {
        self.live = Some(Live::restore(self.parts, state)?);
        self.answer();
        Ok(())
    }
}
