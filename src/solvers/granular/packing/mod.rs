//! A compacted bed from gradings: lifts of loose grains fall and are pressed by a plate, without friction, until they are at
//! rest; then the plate is eased, friction comes back and the plate goes (Ahmadi et al. 2026, section 2.1.2).
//!
//! The bed is one periodic cell along x or a box with ends, between walls across or periodic there too, on a floor at z = 0. Every stage ends when
//! forces are in balance, never by a count of steps; one that does not get there is told with what it reached.

mod describe;
mod error;
mod pace;
mod place;
mod press;
mod store;
#[cfg(test)]
pub(super) mod tests;
mod track;

pub use describe::{LayerState, Stage, State};
pub use error::PackingError;
pub use store::Stored;
pub use track::{Order, TrackAccount, TrackBed, lay};

use super::bed::{Bed, Placed};
use super::clump::Template;
use super::domain::Domain;
use super::grains::{Curve, Random, Sample, grains};
use super::gravity::Gravity;
use super::lanes::Real;
use super::law::{Law, Laws, Surface};
use super::walls::WallId;
use press::Press;
use serde::{Deserialize, Serialize};

/// What is packed, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Of the cell along x and across, m.
    pub plan: [f64; 2],
    /// Whether walls stand at both ends across; else the bed is periodic there too.
    pub walls: bool,
    /// Whether walls stand at both ends along too.
    pub ends: bool,
    /// From the floor upwards.
    pub layers: Vec<Layer>,
    /// Downwards, m/s2.
    pub gravity: f64,
    /// Local damping of the finished bed.
    pub local_damping: f64,
    pub rest: Rest,
    pub seed: u64,
}

/// A layer of one material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    pub name: String,
    pub curve: Curve,
    /// Of unit size; grains are copies of them as often of one as of another.
    pub templates: Vec<Template>,
    /// Of a grain, kg/m3.
    pub density: f64,
    /// Of the finished bed.
    pub surface: Surface,
    /// To walls, floor and plate.
    pub wall_friction: f64,
    /// m.
    pub thickness: f64,
    pub lifts: u32,
    /// On each lift, Pa.
    pub pressure: f64,
    /// While it is packed.
    pub packing: Packing,
}

/// How a layer is damped while it is packed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Packing {
    pub friction: f64,
    pub local_damping: f64,
    /// Share of critical damping of contacts.
    pub viscous_damping: f64,
}

/// When a stage is at its end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rest {
    /// Force out of balance over the forces that act, mean over all bodies, of a lift under its plate.
    pub lift: f64,
    /// The same of the finished bed.
    pub bed: f64,
    /// Share by which the plate may miss its pressure.
    pub pressure: f64,
    /// Time that a stage may take, s; under less than 200 kPa longer by the root of that.
    pub longest: f64,
}

impl Default for Rest {
    fn default() -> Self {
        Rest { lift: 0.01, bed: 1e-3, pressure: 0.02, longest: 4.0 }
    }
}

/// A finished bed, and what became of it on the way.
#[derive(Clone)]
pub struct Packed<R: Real> {
    pub bed: Bed<R>,
    /// Of the cell along x and across, m.
    pub plan: [f64; 2],
    /// Of the grains of each layer, kg/m3.
    pub densities: Vec<f64>,
    /// Where the bodies of each layer begin, and the end of the last.
    pub bodies: Vec<u32>,
    /// What was taken of each grading.
    pub samples: Vec<Sample>,
    /// Level at which the plate stood on each layer under its pressure, m.
    pub levels: Vec<f64>,
    /// Each stage as it ended.
    pub stages: Vec<Stage>,
}

impl<R: Real> Packed<R> {
    /// The bed under the plate of its last lift, without friction, and as it is in the end.
    pub fn pressed_and_at_rest(&self) -> [&State; 2] {
        let last = self.stages.len() - 1;
        [last - press::LAST, last].map(|stage| &self.stages[stage].state)
    }
}

/// How far packing is, for people who wait.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    pub stage: String,
    /// Of all stages, 0 .. 1; an estimate.
    pub share: f64,
    pub bodies: usize,
    pub steps: u64,
}

/// Counts the ways in which beds have been packed and read: another one makes another bed of the same recipe.
pub const METHOD: u32 = 5;

/// How grains fill space, fitted to layers of 2 to 10 grains: to 1.5 % without friction, 3 % with it (`docs/grains.md`).
struct Filling {
    /// Solid share far from flat surfaces, over that of frictionless spheres of the same sizes.
    far: f64,
    /// Share of it that flat surfaces take, by the size of the mean grain.
    flat: f64,
    /// Share of it that much friction takes; as `1 - exp(-friction / ROUGH)`.
    friction: f64,
}

const SPHERES: Filling = Filling { far: 1.0, flat: 0.133, friction: 0.132 };
const CLUMPS: Filling = Filling { far: 1.067, flat: 0.097, friction: 0.222 };
const ROUGH: f64 = 0.26;

/// Of a layer so thick (m), none thinner than its largest grain, which would bear the plate alone; at most as many as asked for.
pub fn lifts_that_fit(asked: u32, thickness: f64, curve: &Curve) -> u32 {
    let most = (thickness / curve.ends()[1] + 1e-9).floor().max(1.0);
    asked.min(most as u32)
}

impl Layer {
    /// That it is pressed in, at most as many as asked for.
    pub fn lifts_that_fit(&self) -> u32 {
        lifts_that_fit(self.lifts, self.thickness, &self.curve)
    }

    /// Share of its space that it is thought to fill, with this area of flat surfaces to a volume, 1/m.
    fn solid_share(&self, flat: f64) -> f64 {
        let spheres = self.templates.iter().all(|template| template.pebbles.len() == 1);
        let filling = if spheres { SPHERES } else { CLUMPS };
        let loosened = (1.0 - filling.flat * self.curve.surface_mean() * flat)
            * (1.0 + filling.friction * (-self.packing.friction / ROUGH).exp_m1());
        filling.far * self.curve.solid_share() * loosened
    }
}

impl Recipe {
    /// What no bed can be made of, before any is tried.
    pub fn check(&self) -> Result<(), PackingError> {
        error::check(self)
    }
}

/// Builds the bed. `tell` hears how far it is.
pub fn pack<R: Real>(recipe: &Recipe, tell: impl FnMut(&Progress)) -> Result<Packed<R>, PackingError> {
    recipe.check()?;
    let mut press = Press::<R, _>::new(recipe, tell);
    let mut packed = Contents::default();
    let mut top = 0.0;
    for (number, layer) in recipe.layers.iter().enumerate() {
        packed.bodies.push(press.bed.len() as u32);
        // what a layer lacks the next one makes up for
        top += layer.thickness;
        let sample = fill(&mut press, recipe, number, layer, top)?;
        packed.samples.push(sample);
        packed.levels.push(press.level());
    }
    packed.bodies.push(press.bed.len() as u32);
    let densities: Vec<f64> = recipe.layers.iter().map(|layer| layer.density).collect();
    let mass: f64 = packed.samples.iter().zip(&densities).map(|(sample, density)| sample.volume * density).sum();
    press.finish(recipe, mass * recipe.gravity / (recipe.plan[0] * recipe.plan[1]))?;
    let Contents { bodies, samples, levels } = packed;
    Ok(Packed { bed: press.bed, plan: recipe.plan, densities, bodies, samples, levels, stages: press.stages })
}

#[derive(Default)]
struct Contents {
    bodies: Vec<u32>,
    samples: Vec<Sample>,
    levels: Vec<f64>,
}

/// Packs a layer lift by lift up to a level. Each has what the layer is thought to hold up to its top and lacks, by a guess that those
/// before it have corrected.
fn fill<R: Real, T: FnMut(&Progress)>(
    press: &mut Press<'_, R, T>,
    recipe: &Recipe,
    number: usize,
    layer: &Layer,
    top: f64,
) -> Result<Sample, PackingError> {
    let area = recipe.plan[0] * recipe.plan[1];
    let base = press.level();
    let guess = |height: f64| area * height * layer.solid_share(recipe.flat(number, height));
    let mut lifts = Vec::<Sample>::new();
    let (mut taken, mut correction) = (0.0, 1.0);
    let count = layer.lifts_that_fit();
    for lift in 0..count {
        let reached = press.level() - base;
        if taken > 0.0 {
            correction = taken / guess(reached);
        }
        let height = reached + (top - base - reached) / f64::from(count - lift);
        let volume = (correction * guess(height) - taken).max(0.0);
        let sample = layer.curve.sample(volume, recipe.seed.wrapping_add((number as u64) << 32 | u64::from(lift)))?;
        taken += sample.volume;
        let copies = grains(&sample, layer.templates.len(), recipe.seed ^ (u64::from(lift) << 8));
        press.lay(recipe, number, lift, &copies)?;
        lifts.push(sample);
    }
    let sizes = lifts.iter().flat_map(|sample| sample.sizes.iter().copied()).collect();
    let volume = lifts.iter().map(|sample| sample.volume).sum();
    Ok(Sample { sizes, volume, curve: layer.curve.clone() })
}

impl Recipe {
    /// Laws of the finished bed: surface `i` is layer `i`, the last one is walls, floor and plate, as stiff as the grains.
    pub fn laws(&self) -> Laws {
        self.between(|layer| (layer.surface, layer.wall_friction))
    }

    /// The same without dashpots, which forces at rest do not know.
    fn laws_without_dashpots(&self) -> Laws {
        self.between(|layer| (Surface { damping: [0.0; 2], ..layer.surface }, layer.wall_friction))
    }

    /// Laws while it is packed.
    fn packing_laws(&self) -> Laws {
        self.between(|layer| {
            let Packing { friction, viscous_damping, .. } = layer.packing;
            // without friction nothing holds against sliding, and steps may be longer
            let shear_stiffness = if friction > 0.0 { layer.surface.shear_stiffness } else { 0.0 };
            let surface = Surface { friction, shear_stiffness, damping: [viscous_damping; 2], ..layer.surface };
            (surface, friction.min(layer.wall_friction))
        })
    }

    fn between(&self, of: impl Fn(&Layer) -> (Surface, f64)) -> Laws {
        let surfaces: Vec<(Surface, f64)> = self.layers.iter().map(of).collect();
        let mut all: Vec<Surface> = surfaces.iter().map(|(surface, _)| *surface).collect();
        all.extend(all.last().copied());
        let mut laws = Laws::of(&all);
        for (number, (surface, friction)) in surfaces.iter().enumerate() {
            let mut law = surface.meet(surface);
            if let Law::Linear(law) = &mut law {
                law.friction = *friction;
            }
            laws.set(number as u16, self.wall_surface(), law);
        }
        laws
    }

    /// Of contacts between grains of each layer, N/m: two bodies in series.
    fn stiffness(&self) -> Vec<f64> {
        self.layers.iter().map(|layer| 0.5 * layer.surface.normal_stiffness).collect()
    }

    /// The least sqrt(m / k) of a mean grain of any layer, s.
    fn mean_step(&self) -> f64 {
        let of = |(layer, k): (&Layer, f64)| (layer.density * layer.curve.mean_volume() / k).sqrt();
        self.layers.iter().zip(self.stiffness()).map(of).fold(f64::INFINITY, f64::min)
    }

    /// The surface of walls, floor and plate.
    pub fn wall_surface(&self) -> u16 {
        self.layers.len() as u16
    }

    /// Area of flat surfaces around a layer of this height (m) to its volume, 1/m. What the plate loosens on one layer the next one fills.
    fn flat(&self, layer: usize, height: f64) -> f64 {
        let pair = |present: bool, distance: f64| if present { 2.0 / distance } else { 0.0 };
        pair(layer == 0, height) + pair(self.walls, self.plan[1]) + pair(self.ends, self.plan[0])
    }

    /// An empty bed of this plan, with floor and walls, as it is packed.
    fn ground<R: Real>(&self) -> Bed<R> {
        let [length, width] = self.plan;
        let domain = if self.ends { Domain::open() } else { Domain::open().periodic(0, length) };
        let domain = if self.walls { domain } else { domain.periodic(1, width) };
        let mut bed = Bed::new(domain, self.packing_laws());
        bed.set_gravity(Gravity::Constant([0.0, 0.0, -self.gravity]));
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], self.wall_surface());
        if self.walls {
            bed.add_plane([0.0; 3], [0.0, 1.0, 0.0], self.wall_surface());
            bed.add_plane([0.0, width, 0.0], [0.0, -1.0, 0.0], self.wall_surface());
        }
        if self.ends {
            bed.add_plane([0.0; 3], [1.0, 0.0, 0.0], self.wall_surface());
            bed.add_plane([length, 0.0, 0.0], [-1.0, 0.0, 0.0], self.wall_surface());
        }
        bed
    }

    /// The walls of a box, the lower and the upper one along and across. `None` of a bed that goes on.
    pub fn sides(&self) -> Option<[[WallId; 2]; 2]> {
        // in the order of `ground`
        (self.walls && self.ends).then_some([[WallId(3), WallId(4)], [WallId(1), WallId(2)]])
    }

    pub fn floor(&self) -> WallId {
        WallId(0)
    }
}

/// Puts grains into a bed, falling.
fn put<R: Real>(bed: &mut Bed<R>, loose: &[place::Loose], layer: &Layer, surface: u16, fall: f64) {
    for grain in loose {
        let placed = Placed {
            template: &grain.template,
            centre: grain.centre,
            attitude: grain.attitude,
            density: layer.density,
            surface,
        };
        let body = bed.add_clump(&placed);
        bed.set_velocity(body, [0.0, 0.0, -fall], [0.0; 3]);
    }
}

/// Numbers by chance of one lift.
fn chance(recipe: &Recipe, layer: usize, lift: u32) -> Random {
    Random::new(recipe.seed, 1 << 48 | (layer as u64) << 32 | u64::from(lift))
}
