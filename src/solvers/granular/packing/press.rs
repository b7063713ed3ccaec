//! The plate that presses a bed, and its stages.

use super::super::bed::Bed;
use super::super::failure::Failure;
use super::super::grains::{Grain, Random};
use super::super::lanes::Real;
use super::super::listen::unless_stopped;
use super::super::motion::{Pose, WallMotion};
use super::super::rest::{Criterion, Look, Waiting, until_rest};
use super::super::shape::Shape;
use super::super::walls::WallId;
use super::describe::{BedState, Stage, StageKind};
use super::error::PackingError;
use super::pace::{Pace, SAFE};
use super::place::{Room, put, set_loose};
use super::progress::Progress;
use super::recipe::{Recipe, Restored};
use nalgebra::Vector3;
use std::ops::ControlFlow;

/// Steps between checks of forces and of the time step.
const LOOK: u64 = 200;
/// Number of checks in a row that must find rest.
const CALM: usize = 3;
/// Speed of falling loose grains and of the plate before it carries load, m/s.
const FALL: f64 = 1.0;
/// Speed of the plate after it carries load, m/s.
const SLOW: f64 = 0.2;
/// Speed at which the plate is removed, m/s.
const LIFT: f64 = 0.05;
/// Share of the pressure from which the plate moves slowly.
const BEARS: f64 = 0.05;
/// Pressure, Pa, under which grains are rearranged in the time limit of a recipe; a grain moves by its own size in d
/// sqrt(rho / p).
const USUAL: f64 = 200e3;
/// Gain of the servo: bodies have mass, and follow later than springs.
const GAIN: f64 = 0.2;
/// Share of its pressure at which the plate counts as removed.
const GONE: f64 = 0.01;

/// Number of stages after the lifts.
pub(super) const LAST: usize = 3;

/// A bed under a plate.
pub(super) struct Press<'a, R: Real, T> {
    pub bed: Bed<R>,
    pub stages: Vec<Stage>,
    plate: WallId,
    recipe: &'a Recipe,
    area: f64,
    /// Level of the plate when it pressed last, m.
    level: f64,
    /// Time step while grains are packed; `None` when the grains have their own inertia again.
    pace: Option<Pace>,
    /// Total number of stages.
    count: usize,
    tell: T,
}

/// The state that a stage waits for.
#[derive(Clone, Copy)]
struct Goal {
    /// Pressure of the plate, Pa.
    pressure: Option<f64>,
    unbalance: f64,
}

impl<'a, R: Real, T: FnMut(&Progress) -> ControlFlow<()>> Press<'a, R, T> {
    pub fn new(recipe: &'a Recipe, tell: T) -> Self {
        let mut bed = recipe.ground();
        let normal = Vector3::new(0.0, 0.0, -1.0);
        let plate = bed.add_wall(Shape::Plane { normal }, Pose::default(), recipe.wall_surface(), WallMotion::Fixed);
        let lifts: u32 = recipe.layers.iter().map(|layer| layer.lifts_that_fit()).sum();
        let [length, width] = recipe.plan;
        let mut press = Press {
            bed,
            stages: Vec::new(),
            plate,
            recipe,
            area: length * width,
            level: 0.0,
            pace: Some(Pace::without_friction(recipe)),
            count: lifts as usize + LAST + 3 * recipe.reloads as usize,
            tell,
        };
        press.away();
        press
    }

    /// Level of the plate when it pressed last, m.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Lays a lift of loose grains on the bed and presses it.
    pub fn lay(&mut self, recipe: &Recipe, number: usize, lift: u32, grains: &[Grain]) -> Result<(), PackingError> {
        let layer = &recipe.layers[number];
        let room = Room {
            plan: recipe.plan,
            periodic: [!recipe.ends, !recipe.walls],
            base: self.top(),
            area: recipe.plan[0] * recipe.plan[1],
            free: &|_, _| true,
        };
        let mut random = chance(recipe, number, lift);
        let Some((loose, top)) = set_loose(grains, &layer.templates, &room, &mut random) else {
            return Err(PackingError::NoRoom { layer: layer.name.clone() });
        };
        put(&mut self.bed, &loose, layer, number as u16, FALL);
        self.bed.set_damping(layer.packing.local_damping);
        self.lower_from(top, layer.pressure, FALL);
        let stage = StageKind::Lift { layer: layer.name.clone(), lift: lift + 1, lifts: layer.lifts_that_fit() };
        let goal = Goal { pressure: Some(layer.pressure), unbalance: recipe.rest.lift };
        self.until_rest(&stage, goal, top)?;
        self.level = self.height();
        Ok(())
    }

    /// Reduces the pressure of the plate, removes the plate, and loads the bed again as often as the recipe says. The
    /// recipe also says when friction is restored: before the reduction, after it, or after the plate is removed. With
    /// friction, a third of the contacts open when the bed springs back. Without friction, the stiffness of the bed at
    /// rest is only a third.
    ///
    /// `weight`: weight of the bed divided by its area, Pa. The pressure is reduced to half of it, the mean pressure by
    /// the weight of the bed.
    pub fn finish(&mut self, recipe: &Recipe, weight: f64) -> Result<(), PackingError> {
        let pressed = recipe.layers.last().map(|layer| layer.pressure);
        let eased = pressed.map(|pressure| pressure.min(0.5 * weight));
        match recipe.restored {
            Restored::Pressed => {
                self.restore(recipe, pressed)?;
                self.stand(&StageKind::Eased, eased, recipe.rest.bed)?;
                self.lift(recipe.rest.bed)?;
            }
            Restored::Eased => {
                self.stand(&StageKind::Eased, eased, recipe.rest.lift)?;
                self.restore(recipe, eased)?;
                self.lift(recipe.rest.bed)?;
            }
            Restored::Unloaded => {
                self.stand(&StageKind::Eased, eased, recipe.rest.lift)?;
                self.lift(recipe.rest.lift)?;
                self.restore(recipe, None)?;
            }
        }
        (1..=recipe.reloads).try_for_each(|number| self.reload(recipe, number, [pressed, eased]))
    }

    /// Presses the plate on the finished bed and removes it again.
    fn reload(&mut self, recipe: &Recipe, number: u32, [pressed, eased]: [Option<f64>; 2]) -> Result<(), PackingError> {
        let Some(pressure) = pressed else { return Ok(()) };
        self.lower_from(self.top(), pressure, SLOW);
        self.stand(&StageKind::Reloaded { number, of: recipe.reloads }, pressed, recipe.rest.bed)?;
        self.stand(&StageKind::Eased, eased, recipe.rest.bed)?;
        self.lift(recipe.rest.bed)
    }

    /// Restores friction and damping of the finished bed under a pressure of the plate, Pa; `None` after the plate is
    /// removed.
    fn restore(&mut self, recipe: &Recipe, pressure: Option<f64>) -> Result<(), PackingError> {
        self.pace = None;
        self.bed.unscale_masses();
        self.bed.set_laws(recipe.laws());
        self.bed.set_damping(recipe.local_damping);
        self.stand(&StageKind::Restored, pressure, recipe.rest.bed)
    }

    /// Waits for rest under a pressure of the plate, Pa, and stores the level of the plate.
    fn stand(&mut self, stage: &StageKind, pressure: Option<f64>, unbalance: f64) -> Result<(), PackingError> {
        self.until_rest(stage, Goal { pressure, unbalance }, self.level)?;
        if pressure.is_some() {
            self.level = self.height();
        }
        Ok(())
    }

    /// Lifts the plate until its pressure is nearly zero, and waits until the bed is at rest.
    fn lift(&mut self, unbalance: f64) -> Result<(), PackingError> {
        let (pressure, level) = (self.pressure(), self.level);
        let up = WallMotion::Velocity { linear: Vector3::new(0.0, 0.0, LIFT), angular: Vector3::zeros() };
        self.bed.set_motion(self.plate, up);
        // the springs under the plate are released long before it has moved by the size of a grain
        let clear = level + self.recipe.layers.iter().map(|layer| layer.curve.ends()[1]).fold(0.0, f64::max);
        while self.pressure() > GONE * pressure && self.height() < clear {
            self.advance(LOOK).map_err(|failure| failed(&StageKind::Lifted, failure))?;
        }
        self.away();
        self.stand(&StageKind::Lifted, None, unbalance)
    }

    /// Highest point of any grain, m.
    fn top(&self) -> f64 {
        self.bed.pebbles().map(|pebble| pebble.place[2] + pebble.radius).fold(0.0, f64::max)
    }

    fn height(&self) -> f64 {
        self.bed.wall(self.plate).pose(self.bed.domain()).position.z
    }

    fn pressure(&self) -> f64 {
        self.bed.wall(self.plate).felt().force.z / self.area
    }

    /// Puts the plate out of reach of all grains, at rest.
    fn away(&mut self) {
        let high = 10.0 * (1.0 + self.recipe.layers.iter().map(|layer| layer.thickness).sum::<f64>());
        self.bed.set_motion(self.plate, WallMotion::Fixed);
        self.bed.stand(self.plate, [0.0, 0.0, high]);
    }

    fn lower_from(&mut self, top: f64, pressure: f64, speed_limit: f64) {
        self.bed.stand(self.plate, [0.0, 0.0, top]);
        self.drive(pressure, speed_limit);
    }

    fn drive(&mut self, pressure: f64, speed_limit: f64) {
        let axis = Vector3::new(0.0, 0.0, 1.0);
        self.bed
            .set_motion(self.plate, WallMotion::Servo { axis, force: pressure * self.area, speed_limit, gain: GAIN });
    }

    /// Does some steps, each with the longest allowed time step.
    fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        if let Some(pace) = &mut self.pace {
            return pace.run(&mut self.bed, steps);
        }
        let step = self.bed.bound_time_step(0.0)?;
        self.bed.set_time_step(SAFE * step.min(self.recipe.mean_step()));
        self.bed.run(steps)
    }

    /// Runs until forces are in balance and the pressure of the plate is at its target.
    fn until_rest(&mut self, stage: &StageKind, goal: Goal, top: f64) -> Result<(), PackingError> {
        // loose grains need time to fall, and under a lower pressure more time for rearrangement
        let slower = goal.pressure.map_or(1.0, |pressure| (USUAL / pressure).sqrt().max(1.0));
        let criterion = Criterion {
            unbalance: goal.unbalance,
            missed: self.recipe.rest.pressure,
            every: LOOK,
            looks: CALM,
            longest: slower * self.recipe.rest.longest + top / FALL,
            look_first: false,
        };
        let longest = criterion.longest;
        let start = self.bed.time();
        let look = until_rest(&mut Pressing { press: self, stage, goal, longest, bears: false }, &criterion, start)?;
        let state = BedState::from_snapshot(&self.bed, &look.snapshot, look.unbalance);
        let (pressure, level) = (self.pressure(), goal.pressure.map(|_| self.height()));
        self.stages.push(Stage { name: stage.to_string(), time: look.time, pressure, level, state });
        Ok(())
    }

    fn say(&mut self, stage: &StageKind, share: f64) -> ControlFlow<()> {
        let share = (self.stages.len() as f64 + share) / self.count as f64;
        let progress = Progress { stage: stage.to_string(), share, bodies: self.bed.len(), steps: self.bed.steps() };
        (self.tell)(&progress)
    }
}

/// A stage in progress.
struct Pressing<'p, 'a, R: Real, T> {
    press: &'p mut Press<'a, R, T>,
    stage: &'p StageKind,
    goal: Goal,
    /// Longest time of the stage, s.
    longest: f64,
    /// Whether the plate carries load already, and moves slowly.
    bears: bool,
}

impl<R: Real, T: FnMut(&Progress) -> ControlFlow<()>> Waiting<R> for Pressing<'_, '_, R, T> {
    type Error = PackingError;

    fn bed(&mut self) -> &mut Bed<R> {
        &mut self.press.bed
    }

    fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        self.press.advance(steps)?;
        let pressure = self.press.pressure();
        if let Some(target) = self.goal.pressure.filter(|target| !self.bears && pressure > BEARS * target) {
            self.bears = true;
            self.press.drive(target, SLOW);
        }
        Ok(())
    }

    fn missed(&self) -> f64 {
        self.goal.pressure.map_or(0.0, |target| (self.press.pressure() / target - 1.0).abs())
    }

    fn hear(&mut self, look: &Look) -> Result<(), PackingError> {
        unless_stopped(self.press.say(self.stage, (look.time / self.longest).min(1.0)), PackingError::Stopped)
    }

    fn restless(&self, look: &Look) -> PackingError {
        let (stage, time) = (self.stage.clone(), look.time);
        match self.goal.pressure.filter(|_| look.missed > self.press.recipe.rest.pressure) {
            Some(target) => PackingError::Pressure { stage, reached: self.press.pressure(), target, time },
            None => PackingError::Restless { stage, unbalance: look.unbalance, limit: self.goal.unbalance, time },
        }
    }

    fn failed(&self, failure: Failure) -> PackingError {
        failed(self.stage, failure)
    }
}

fn failed(stage: &StageKind, failure: Failure) -> PackingError {
    PackingError::Failure { stage: stage.clone(), failure }
}

/// Random numbers of one lift.
fn chance(recipe: &Recipe, layer: usize, lift: u32) -> Random {
    Random::new(recipe.seed, 1 << 48 | (layer as u64) << 32 | u64::from(lift))
}
