//! The plate that presses a bed, and the stages that it goes through.

use super::super::bed::Bed;
use super::super::grains::Grain;
use super::super::lanes::Real;
use super::super::measure::unbalance;
use super::super::motion::{Motion, Pose};
use super::super::shape::Shape;
use super::super::walls::WallId;
use super::pace::{Pace, SAFE};
use super::place::{Room, set_loose};
use super::{PackingError, Progress, Recipe, Stage, State, chance, put};
use nalgebra::Vector3;

/// Steps between looks at forces and at the time step.
const LOOK: u64 = 200;
/// Looks in a row that must find rest.
const CALM: usize = 3;
/// At which loose grains fall and the plate comes down to them, m/s.
const FALL: f64 = 1.0;
/// Of the plate once it bears, m/s.
const SLOW: f64 = 0.2;
/// At which it goes away, m/s.
const LIFT: f64 = 0.05;
/// Share of the pressure from which the plate goes slowly.
const BEARS: f64 = 0.05;
/// A pressure, Pa, under which grains find their places in the time that a recipe allows; a grain moves by its own size in d sqrt(rho / p).
const USUAL: f64 = 200e3;
/// Gain of the servo: bodies have mass, and follow later than springs.
const GAIN: f64 = 0.2;
/// Share of its pressure at which the plate has gone.
const GONE: f64 = 0.01;

/// Stages after those of the lifts.
pub(super) const LAST: usize = 3;
const EASED: &str = "plate eased";
const RESTORED: &str = "friction restored";
const LIFTED: &str = "plate lifted";

/// A bed under a plate.
pub(super) struct Press<'a, R: Real, T> {
    pub bed: Bed<R>,
    pub stages: Vec<Stage>,
    plate: WallId,
    recipe: &'a Recipe,
    area: f64,
    /// Level of the plate when it last pressed, m.
    level: f64,
    /// While grains are packed; `None` when they have their own inertia again.
    pace: Option<Pace>,
    /// Stages in all.
    count: usize,
    tell: T,
}

/// What a stage waits for.
#[derive(Clone, Copy)]
struct Goal {
    /// Of the plate, Pa.
    pressure: Option<f64>,
    unbalance: f64,
}

impl<'a, R: Real, T: FnMut(&Progress)> Press<'a, R, T> {
    pub fn new(recipe: &'a Recipe, tell: T) -> Self {
        let mut bed = recipe.ground();
        let normal = Vector3::new(0.0, 0.0, -1.0);
        let plate = bed.add_wall(Shape::Plane { normal }, Pose::default(), recipe.wall_surface(), Motion::Fixed);
        let lifts: u32 = recipe.layers.iter().map(|layer| layer.lifts_that_fit()).sum();
        let [length, width] = recipe.plan;
        let mut press = Press {
            bed,
            stages: Vec::new(),
            plate,
            recipe,
            area: length * width,
            level: 0.0,
            pace: Some(Pace::of(recipe)),
            count: lifts as usize + LAST,
            tell,
        };
        press.away();
        press
    }

    /// Of the plate when it last pressed, m.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// A lift of loose grains is laid on the bed and pressed.
    pub fn lay(&mut self, recipe: &Recipe, number: usize, lift: u32, grains: &[Grain]) -> Result<(), PackingError> {
        let layer = &recipe.layers[number];
        let room = Room { plan: recipe.plan, periodic: [!recipe.ends, !recipe.walls], base: self.top() };
        let mut random = chance(recipe, number, lift);
        let Some((loose, top)) = set_loose(grains, &layer.templates, &room, &mut random) else {
            return Err(PackingError::NoRoom { layer: layer.name.clone() });
        };
        put(&mut self.bed, &loose, layer, number as u16, FALL);
        self.bed.set_damping(layer.packing.local_damping);
        self.lower_from(top, layer.pressure, FALL);
        let stage = format!("{}, lift {} of {}", layer.name, lift + 1, layer.lifts_that_fit());
        let goal = Goal { pressure: Some(layer.pressure), unbalance: recipe.rest.lift };
        self.until_rest(&stage, goal, top)?;
        self.level = self.height();
        Ok(())
    }

    /// The plate is eased, friction comes back under what it still bears, and the plate goes. With friction a bed that springs back opens
    /// a third of its contacts; without friction and without load it would flow for seconds, and lose what the plate has gained.
    /// `weight` is that of the bed over its area, Pa: half of it is what the plate presses with, as the bed's own weight does inside.
    pub fn finish(&mut self, recipe: &Recipe, weight: f64) -> Result<(), PackingError> {
        let pressure = recipe.layers.last().map(|layer| layer.pressure.min(0.5 * weight));
        self.until_rest(EASED, Goal { pressure, unbalance: recipe.rest.lift }, self.level)?;
        let unbalance = recipe.rest.bed;
        self.pace = None;
        self.bed.unscale_masses();
        self.bed.set_laws(recipe.laws());
        self.bed.set_damping(recipe.local_damping);
        self.until_rest(RESTORED, Goal { pressure, unbalance }, self.level)?;
        self.level = self.height();
        self.lift()?;
        self.until_rest(LIFTED, Goal { pressure: None, unbalance }, self.level)
    }

    /// The plate goes up until it all but presses no more.
    fn lift(&mut self) -> Result<(), PackingError> {
        let (pressure, level) = (self.pressure(), self.level);
        let up = Motion::Velocity { linear: Vector3::new(0.0, 0.0, LIFT), angular: Vector3::zeros() };
        self.bed.set_motion(self.plate, up);
        // the springs under it give way long before it is a grain's size away
        let clear = level + self.recipe.layers.iter().map(|layer| layer.curve.ends()[1]).fold(0.0, f64::max);
        while self.pressure() > GONE * pressure && self.height() < clear {
            self.advance(LIFTED)?;
        }
        self.away();
        Ok(())
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

    /// Out of reach of every grain, at rest.
    fn away(&mut self) {
        let high = 10.0 * (1.0 + self.recipe.layers.iter().map(|layer| layer.thickness).sum::<f64>());
        self.bed.set_motion(self.plate, Motion::Fixed);
        self.bed.stand(self.plate, [0.0, 0.0, high]);
    }

    fn lower_from(&mut self, top: f64, pressure: f64, speed_limit: f64) {
        self.bed.stand(self.plate, [0.0, 0.0, top]);
        self.drive(pressure, speed_limit);
    }

    fn drive(&mut self, pressure: f64, speed_limit: f64) {
        let axis = Vector3::new(0.0, 0.0, 1.0);
        self.bed.set_motion(self.plate, Motion::Servo { axis, force: pressure * self.area, speed_limit, gain: GAIN });
    }

    /// Some steps, each as long as it may be.
    fn advance(&mut self, stage: &str) -> Result<(), PackingError> {
        let failed = |failure| PackingError::Failure { stage: stage.to_owned(), failure };
        if let Some(pace) = &mut self.pace {
            return pace.run(&mut self.bed, LOOK).map_err(failed);
        }
        let step = self.bed.bound_time_step(0.0).map_err(failed)?;
        self.bed.set_time_step(SAFE * step.min(self.recipe.mean_step()));
        self.bed.run(LOOK).map_err(failed)
    }

    /// Runs until forces are in balance and the plate presses as it should.
    fn until_rest(&mut self, stage: &str, goal: Goal, top: f64) -> Result<(), PackingError> {
        let start = self.bed.time();
        // loose grains need their time to fall, and grains under a lower pressure more time to find their places
        let slower = goal.pressure.map_or(1.0, |pressure| (USUAL / pressure).sqrt().max(1.0));
        let longest = slower * self.recipe.rest.longest + top / FALL;
        let (mut calm, mut bears) = (0, false);
        loop {
            self.advance(stage)?;
            let pressure = self.pressure();
            if let Some(target) = goal.pressure.filter(|target| !bears && pressure > BEARS * target) {
                bears = true;
                self.drive(target, SLOW);
            }
            let missed = goal.pressure.map_or(0.0, |target| (pressure / target - 1.0).abs());
            let snapshot =
                self.bed.snapshot().map_err(|failure| PackingError::Failure { stage: stage.to_owned(), failure })?;
            let unbalance = unbalance(&self.bed, &snapshot);
            calm = if unbalance <= goal.unbalance && missed <= self.recipe.rest.pressure { calm + 1 } else { 0 };
            let took = self.bed.time() - start;
            self.say(stage, (took / longest).min(1.0));
            if calm >= CALM {
                let state = State::of(&self.bed, &snapshot, unbalance);
                let level = goal.pressure.map(|_| self.height());
                self.stages.push(Stage { name: stage.to_owned(), time: took, pressure, level, state });
                return Ok(());
            }
            if took > longest {
                let stage = stage.to_owned();
                return Err(match goal.pressure.filter(|_| missed > self.recipe.rest.pressure) {
                    Some(target) => PackingError::Pressure { stage, reached: pressure, target, time: took },
                    None => PackingError::Restless { stage, unbalance, limit: goal.unbalance, time: took },
                });
            }
        }
    }

    fn say(&mut self, stage: &str, share: f64) {
        let share = (self.stages.len() as f64 + share) / self.count as f64;
        let progress = Progress { stage: stage.to_owned(), share, bodies: self.bed.len(), steps: self.bed.steps() };
        (self.tell)(&progress);
    }
}
