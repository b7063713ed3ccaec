//! Builds a track on grains, as in the paper (sections 2.1.3, 2.3 and 2.4): cells are packed, laid side by side,
//! sleepers set down, cribs filled and layers glued where the scene asks for it, the soil put below, the rail laid on.
//! Each stage is at rest before the next one begins.

use super::soil::{Plan, SoilBelow};
use super::step::{Coupled, Spent, StandingBed};
use super::{Stage, Telling, going_on};
use crate::graph::{GrainStretch, GrainsNode, Responses, SleeperOnGrains, SoilNode, TrackNode};
use crate::nodes::NodeError;
use crate::solvers::granular::packing::{Order, lay};
use crate::solvers::granular::rig::{Load, Sleeper, fill, glue, stand};
use crate::solvers::granular::{Bed, Sharing, Stride, WallId, WallMotion};
use crate::solvers::track::{Foot, Leapfrog, Spring, Track, TrackLevel};
use crate::store::{Beds, recipe_hash};
use std::sync::Arc;

/// The time step over the step that each grain bears by itself. The reserve is for contacts that form between two
/// updates of the inertia. At 0.95, and with one update per passage, loaded sleepers made the step too long and the run
/// stopped.
pub const OF_STRIDE: f64 = 0.9;
/// Rule for sharing contacts between grains when inertia is added for the step.
pub const SHARING: Sharing = Sharing::ByNeed;

/// Mass that a grain of a track gets at least, kg, for a time step (s) and contacts of a stiffness (N/m).
pub fn mass_for_step(time_step: f64, stiffness: f64) -> f64 {
    Stride { step: time_step / OF_STRIDE, sharing: SHARING }.least_inertia(stiffness, 1.0)
}

/// Version: increased when the same parts are built in another way, or stored in another form.
const METHOD: &str = "track on grains 13";

/// Data of a track on grains.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    pub grains: &'a GrainsNode,
    pub soil: Option<&'a SoilNode>,
    pub track: &'a TrackNode,
    pub beds: &'a Beds,
}

impl Parts<'_> {
    /// Hash of the built track; it does not depend on the trains.
    pub fn hash(&self) -> String {
        let GrainsNode { beds, stretches, settlement, pads, damping_time, gravity, time_step, added_inertia, .. } =
            self.grains;
        let grains = (beds, stretches, settlement, pads, damping_time, gravity, time_step, added_inertia);
        recipe_hash(&(METHOD, grains, self.soil, self.track))
    }

    /// Builds the whole track; `beyond` gives the supports of the seats that do not stand on grains.
    pub fn build(&self, beyond: &[Option<Spring>], tell: &mut Telling<'_>) -> Result<Coupled, NodeError> {
        let mut beds = Vec::with_capacity(self.grains.stretches.len());
        let (mut feet, mut time_step) = (0, f64::INFINITY);
        for (number, stretch) in self.grains.stretches.iter().enumerate() {
            let (bed, step) = self.standing(number, feet, tell)?;
            feet += stretch.sleepers.len();
            time_step = time_step.min(step);
            beds.push(bed);
        }
        for standing in &mut beds {
            standing.bed.set_time_step(time_step);
        }
        let rail = self.rail(beyond, time_step)?;
        Ok(Coupled { pushes: vec![0.0; rail.carried().len()], rail, beds, added: 0.0, spent: Spent::default() })
    }

    /// A bed with its sleepers and the soil below, all at rest, and the step that it may take, s.
    fn standing(&self, number: usize, feet: usize, tell: &mut Telling<'_>) -> Result<(StandingBed, f64), NodeError> {
        let stretch = &self.grains.stretches[number];
        let plan = &self.grains.beds[stretch.bed];
        let ready = plan.ready(plan.seed()).map_err(NodeError::Bed)?;
        let recipe = &ready.recipe;
        let found = self.beds.bed(recipe, |progress| tell(Stage::Packing, progress.share));
        let cell = found?.packed;
        let order = Order::of_one(stretch.copies as usize);
        let mut bed = lay(&[cell], &order, recipe, |progress| tell(Stage::Laying, progress.share))?.bed;
        let sleepers: Vec<Sleeper> = stretch.sleepers.iter().map(sleeper).collect();
        let walls = stand(&mut bed, &sleepers, self.grains.gravity, |share| tell(Stage::Sleepers, share))?;
        if let Some(filling) = stretch.crib.and_then(|crib| crib.filling(recipe, stretch.copies)) {
            fill(&mut bed, (&sleepers, &walls), &filling, |share| tell(Stage::Cribs, share))?;
        }
        glue(&mut bed, &stretch.glued)?;
        walls.iter().for_each(|wall| bed.set_motion(*wall, WallMotion::Guided));
        let time_step = self.time_step(&mut bed)?;
        bed.set_time_step(time_step);
        going_on(tell(Stage::Soil, 0.0))?;
        let below = |soil| SoilBelow::new(&mut bed, recipe.floor(), self.lies(number), soil);
        let soil = self.soil.map(below).transpose()?;
        // stiff soil in small elements may need shorter steps than the grains
        let time_step = soil.iter().map(|soil| soil.longest_step(&bed)).fold(time_step, f64::min);
        let sleepers = walls.into_iter().zip(feet..).collect();
        Ok((StandingBed { bed, sleepers, soil }, time_step))
    }

    /// The step of a bed: that of the scene, or the longest for which the inertia that may be added suffices, s.
    fn time_step(&self, bed: &mut Bed<f32>) -> Result<f64, NodeError> {
        match self.grains.time_step {
            Some(step) => Ok(step),
            None => {
                let stride = Stride::with_added(bed, SHARING, self.grains.added_inertia)?;
                stride.hold(bed)?;
                Ok(OF_STRIDE * stride.step)
            }
        }
    }

    /// The rail over all seats at rest, before a first step.
    pub fn rail(&self, beyond: &[Option<Spring>], time_step: f64) -> Result<Leapfrog, NodeError> {
        let responses = Responses { revision: 0, seats: beyond.to_vec() };
        let mut model = self.track.model(&responses);
        for sleeper in self.grains.stretches.iter().flat_map(|stretch| &stretch.sleepers) {
            model.seats[sleeper.seat].foot =
                Foot::Carried { mass: sleeper.mass, pad: sleeper.pad, pitch: sleeper.pitch };
        }
        let level = self.level(beyond, &vec![0.0; self.track.seats.len()]);
        Ok(Leapfrog::new(Arc::new(Track::new(model)?), &level, time_step)?)
    }

    /// Springs under the sleepers beyond the grains, of a stiffness (N/m) without their pads.
    pub fn beyond(&self, stiffness: f64) -> Vec<Option<Spring>> {
        let seats = self.track.seats.iter().enumerate();
        seats.map(|(number, seat)| seat.is_ballasted().then(|| self.support(number, stiffness))).collect()
    }

    /// Stiffness under a sleeper, N/m: the support and its pad in series.
    pub fn support(&self, seat: usize, stiffness: f64) -> Spring {
        let ground = Spring { stiffness, damping: self.grains.damping_time * stiffness, seating: None };
        self.grains.pads.get(seat).copied().flatten().map_or(ground, |pad| pad.on(ground))
    }

    /// Level of the supports beyond the grains, m: raised by their deflection under the track alone, so that the track
    /// lies level, and lowered by their settlement.
    pub fn level(&self, beyond: &[Option<Spring>], settlement: &[f64]) -> TrackLevel {
        let seats = self.track.seats.iter().enumerate().zip(beyond).zip(settlement);
        let settlements = seats.map(|(((number, seat), spring), settled)| {
            let weight = self.dead_weight(number);
            let sinks = spring.filter(|_| seat.is_ballasted()).map_or(0.0, |spring| spring.compression(weight));
            settled - sinks
        });
        let end = |seat: Option<&f64>| seat.copied().unwrap_or(0.0);
        TrackLevel { settlements: settlements.collect(), ends: [end(settlement.first()), end(settlement.last())] }
    }

    /// The floor of a bed.
    pub fn floor(&self, stretch: usize) -> WallId {
        self.grains.beds[self.grains.stretches[stretch].bed].numbers().floor()
    }

    /// Length and width of a bed, m.
    pub fn plan(&self, stretch: usize) -> [f64; 2] {
        let GrainStretch { bed, copies, .. } = &self.grains.stretches[stretch];
        let [length, width] = self.grains.beds[*bed].numbers().plan;
        [length * f64::from(*copies), width]
    }

    /// Where a bed lies.
    pub fn lies(&self, stretch: usize) -> Plan {
        Plan { start: self.grains.stretches[stretch].start, sides: self.plan(stretch) }
    }

    /// Chainages between which grains lie, m.
    pub fn ends(&self) -> [f64; 2] {
        let stretches = self.grains.stretches.iter().enumerate();
        let ends = stretches.map(|(number, stretch)| [stretch.start, stretch.start + self.plan(number)[0]]);
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[left, right], [a, b]| [left.min(a), right.max(b)])
    }

    /// Weight of the track that a seat carries, N.
    pub fn dead_weight(&self, seat: usize) -> f64 {
        let seat = &self.track.seats[seat];
        let rail = self.track.rail.iter().find(|rail| seat.x <= rail.end).map_or(0.0, |rail| rail.mass * seat.bay);
        self.grains.gravity * (rail + seat.foot.mass())
    }
}

fn sleeper(standing: &SleeperOnGrains) -> Sleeper {
    let underside = standing.pad.map_or(0.0, |pad| pad.mass);
    let mass = standing.mass + standing.rail_mass + underside;
    Sleeper { place: standing.place, size: standing.size, mass, load: Load::None }
}
