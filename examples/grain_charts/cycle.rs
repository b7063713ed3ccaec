//! The experiment: grains fall, a plate loads and unloads them.

use nalgebra::{UnitQuaternion, Vector3};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Instant;
use trackbed::solvers::granular::clump::{Pebble, Template};
use trackbed::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Placed, Pose, Real,
    Shape, WallId, WallMotion,
};

/// Side of the periodic cell \[m\].
const SIDE: f64 = 0.3;
const GRAINS: usize = 200;
/// Step of settling, stable for all grains here \[s\].
const SETTLING_STEP: f64 = 2e-5;
const PLATE_SPEED: f64 = 0.03;
/// Speed at which the plate comes down on the loose grains \[m/s\].
const APPROACH: f64 = 0.3;
/// The longest that the plate looks for a pressure \[s\].
const PATIENCE: f64 = 3.0;
/// Pairs nearer than this count as contacts of a loaded bed \[m\].
const GAP: f64 = 20e-6;
const LOW: f64 = 5e3;
const HIGH: f64 = 50e3;

/// How a run is done.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    pub double: bool,
    /// Time step over the limit of the contact network.
    pub share: f64,
    pub skin: Option<f64>,
    /// Pebbles a clump; 0 is a mixture of spheres.
    pub pebbles: u32,
    /// Masses are scaled so that a step of this many limits is stable.
    pub scaled: Option<f64>,
}

impl Setting {
    pub fn usual() -> Setting {
        Setting { double: false, share: 0.5, skin: None, pebbles: 0, scaled: None }
    }

    pub fn reference() -> Setting {
        Setting { double: true, share: 0.05, ..Setting::usual() }
    }
}

/// What a run tells.
#[derive(Debug, Clone, Copy)]
pub struct Answer {
    /// Permanent, of the load cycle \[m\].
    pub settlement: f64,
    /// Secant of the loading \[N/m\].
    pub stiffness: f64,
    /// Energy unaccounted for over the work done.
    pub residual: f64,
    /// Wall time for a second of the bed \[s\].
    pub time: f64,
}

pub fn run(setting: &Setting, seed: u64) -> Option<Answer> {
    if setting.double { run_in::<f64>(setting, seed) } else { run_in::<f32>(setting, seed) }
}

fn run_in<R: Real>(setting: &Setting, seed: u64) -> Option<Answer> {
    let (mut bed, plate) = settled::<R>(setting, seed)?;
    let limit = bed.critical_step(GAP).ok()?.network.step;
    let step = match setting.scaled {
        Some(target) => 0.85 * target * limit,
        None => setting.share * limit,
    };
    if setting.scaled.is_some() {
        bed.scale_masses(step, GAP).ok()?;
    }
    bed.set_time_step(step);
    bed.set_skin(setting.skin);
    bed.watch_energy(true);
    let (clock, start) = (Instant::now(), bed.time());
    let mut heights = Vec::new();
    for (pressure, speed) in [(LOW, -PLATE_SPEED), (HIGH, -PLATE_SPEED), (LOW, PLATE_SPEED)] {
        heights.push(press(&mut bed, plate, speed, pressure)?);
    }
    let energy = bed.energy();
    Some(Answer {
        settlement: heights[0] - heights[2],
        stiffness: (HIGH - LOW) * SIDE * SIDE / (heights[0] - heights[1]),
        residual: energy.residual().abs() / (energy.walls.abs() + energy.gravity.abs()),
        time: clock.elapsed().as_secs_f64() / (bed.time() - start),
    })
}

/// Moves the plate at `speed` \[m/s\] until it feels `pressure` \[Pa\], and says where that is \[m\].
fn press<R: Real>(bed: &mut Bed<R>, plate: WallId, speed: f64, pressure: f64) -> Option<f64> {
    let linear = Vector3::new(0.0, 0.0, speed);
    bed.set_motion(plate, WallMotion::Velocity { linear, angular: Vector3::zeros() });
    let end = bed.time() + PATIENCE;
    while bed.time() < end {
        if let Err(failure) = bed.step() {
            eprintln!("{failure}");
            return None;
        }
        let felt = bed.wall(plate).felt().force.z / (SIDE * SIDE);
        if if speed < 0.0 { felt >= pressure } else { felt <= pressure } {
            return Some(bed.wall(plate).pose(bed.domain()).position.z);
        }
    }
    eprintln!("the plate found no {pressure} Pa");
    None
}

/// Beds at rest as text, by pebbles and seed: settling takes longer than the load cycle.
static SETTLED: Mutex<BTreeMap<(u32, u64), String>> = Mutex::new(BTreeMap::new());

/// Grains at rest under a plate that touches them. The same for every setting of the same grains and seed, whatever its
/// precision: grains that fall forget how they started.
fn settled<R: Real>(setting: &Setting, seed: u64) -> Option<(Bed<R>, WallId)> {
    let key = (setting.pebbles, seed);
    let known = SETTLED.lock().ok()?.get(&key).cloned();
    let text = match known {
        Some(text) => text,
        None => {
            let text = serde_json::to_string(&fallen(setting.pebbles, seed)?.checkpoint()).ok()?;
            SETTLED.lock().ok()?.insert(key, text.clone());
            text
        }
    };
    // the first wall is the floor
    Some((Bed::restore(serde_json::from_str(&text).ok()?).ok()?, WallId(1)))
}

fn fallen(pebbles: u32, seed: u64) -> Option<Bed<f64>> {
    let mut random = Random(seed.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let law = ContactLaw::Linear(Linear {
        normal_stiffness: 1.3e7,
        shear_stiffness: 1.3e7,
        friction: 0.6,
        dashpot: Dashpot::Ratio { normal: 0.2, shear: 0.0 },
        mode: DashpotMode::NoTensionRestInSlip,
        limit: FrictionLimit::Spring,
    });
    let domain = Domain::open().periodic(0, SIDE).periodic(1, SIDE);
    let mut bed: Bed<f64> = Bed::new(domain, ContactLaws::single(law));
    let template = Template::from_pebbles(&ellipsoid(pebbles.max(1))).ok()?;
    for grain in 0..GRAINS {
        let (layer, cell) = (grain / 16, grain % 16);
        let mut around = |x: f64| x + 0.004 * (random.next() - 0.5);
        let centre = [
            around(0.075 * ((cell % 4) as f64 + 0.5)),
            around(0.075 * ((cell / 4) as f64 + 0.5)),
            around(0.04 + 0.07 * layer as f64),
        ];
        let diameter = 0.04 + 0.024 * random.next();
        let axis = Vector3::new(random.next(), random.next(), random.next()) * 4.0;
        let template = template.scaled(diameter / template.equivalent_diameter());
        let attitude = UnitQuaternion::from_scaled_axis(axis);
        bed.add_clump(&Placed { template: &template, centre, attitude, density: 2700.0, surface: 0 });
    }
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::EARTH);
    bed.set_time_step(SETTLING_STEP);
    // first they fall, then they come to rest
    for (damping, time) in [(0.2, 1.0), (0.7, 0.4)] {
        bed.set_damping(damping);
        if let Err(failure) = bed.run((time / SETTLING_STEP) as u64) {
            eprintln!("settling: {failure}");
            return None;
        }
    }
    let top = bed.pebbles().map(|p| p.place[2] + p.radius).fold(0.0, f64::max);
    let pose = Pose { position: Vector3::new(0.0, 0.0, top), ..Pose::default() };
    let plate = bed.add_wall(Shape::plane(-Vector3::z()).ok()?, pose, 0, WallMotion::Fixed);
    press(&mut bed, plate, -APPROACH, LOW)?;
    bed.set_motion(plate, WallMotion::Fixed);
    bed.run((0.1 / SETTLING_STEP) as u64).ok()?;
    bed.set_damping(0.2);
    Some(bed)
}

/// Pebbles inside an ellipsoid of half axes 1, 0.85 and 0.7: one is a sphere.
fn ellipsoid(count: u32) -> Vec<Pebble> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let axes = Vector3::new(1.0, 0.85, 0.7);
    (0..count)
        .map(|k| {
            let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(count);
            let (s, angle) = ((1.0 - z * z).sqrt(), golden * f64::from(k));
            let out = Vector3::new(s * angle.cos(), s * angle.sin(), z);
            let centre = if count == 1 { Vector3::zeros() } else { axes.component_mul(&out) * 0.4 };
            // from the centre to the surface of the ellipsoid beyond it
            Pebble { centre, radius: 0.6 * axes.component_mul(&out).norm() }
        })
        .collect()
}

/// Pseudo-random numbers in 0..1 (xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
