//! Converts the whole state of a bed to data, and back, bit by bit.

use super::bed::Bed;
use super::body::{Body, Clump};
use super::bonds::{Bond, Bonds, Glue};
use super::build::Carried;
use super::domain::Domain;
use super::energy::Ledger;
use super::failure::{Failure, Limits};
use super::gravity::Gravity;
use super::integrate::Tally;
use super::lanes::Real;
use super::law::{ContactLaw, ContactLaws, Dashpot};
use super::record::Record;
use super::vector::{Vec3, dot, norm};
use super::walls::{Kept, Wall};
use serde::{Deserialize, Serialize};

/// The complete state on which the further motion of a bed depends; serialise it with a format that keeps every bit of
/// a number.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Checkpoint<R: Real> {
    version: u32,
    domain: Domain,
    laws: ContactLaws,
    gravity: Gravity,
    damping: f64,
    dt: f64,
    bodies: Vec<Body>,
    pebbles: Vec<Grain<R>>,
    clumps: Vec<Clump>,
    arms: Vec<Vec3>,
    walls: Vec<Wall>,
    shear: Vec<Carried<R>>,
    kept: Vec<Kept<R>>,
    glues: Vec<Glue>,
    bonds: Vec<Bond<R>>,
    broken_bonds: u64,
    tally: Tally,
    ledger: Ledger,
    time: f64,
    steps: u64,
    fresh: bool,
    limits: Limits,
    skin: f64,
    fixed_skin: Option<f64>,
}

/// The record of a pebble.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(bound = "")]
struct Grain<R: Real> {
    place: Vec3,
    velocity: [R; 3],
    spin: [R; 3],
    radius: f64,
    mass: R,
}

/// Largest valid force, velocity and stiffness in SI units: their squares are finite in both precisions.
const LARGEST: f64 = 1e15;
/// Largest valid dashpot ratio and friction.
const STRONGEST: f64 = 1e3;
/// Largest part of a shear force that is normal to its contact plane / shear force.
const TILTED: f64 = 0.5;
/// Longest valid time step, s.
const LONGEST: f64 = 1.0;
/// Layout of a checkpoint; other layouts are refused.
const VERSION: u32 = 2;

/// A checkpoint that cannot be restored.
#[derive(Debug, Clone, PartialEq)]
pub enum RestoreError {
    /// Made by another version of this program.
    Version { found: u32 },
    /// Its parts do not match.
    Inconsistent(&'static str),
    /// Its lists cannot be made.
    Failure(Failure),
}

impl std::fmt::Display for RestoreError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            RestoreError::Version { found } => {
                write!(
                    f,
                    "the checkpoint has layout {found}, but this program reads layout {VERSION}; run from the start"
                )
            }
            RestoreError::Inconsistent(what) => write!(f, "the checkpoint is damaged: {what}; run from the start"),
            RestoreError::Failure(failure) => failure.fmt(f),
        }
    }
}

impl std::error::Error for RestoreError {}

impl<R: Real> Bed<R> {
    /// The state as data. A bed restored from it continues bit by bit like this bed.
    pub fn checkpoint(&self) -> Checkpoint<R> {
        let pebble = |r: &R::Record| Grain {
            place: r.position(),
            velocity: r.velocity(),
            spin: r.spin(),
            radius: r.radius(),
            mass: r.mass(),
        };
        Checkpoint {
            version: VERSION,
            domain: self.domain,
            laws: self.laws.clone(),
            gravity: self.gravity.clone(),
            damping: self.damping,
            dt: self.dt,
            bodies: self.bodies.clone(),
            pebbles: self.records[..self.owner.len()].iter().map(pebble).collect(),
            clumps: self.clumps.clone(),
            arms: self.arms.iter().map(|&[x, y, z, _]| [x, y, z]).collect(),
            walls: self.walls.clone(),
            shear: self.carried(),
            kept: self.kept(),
            glues: self.bonds.glues.clone(),
            bonds: self.bonds.held(),
            broken_bonds: self.broken_bonds(),
            tally: self.tally,
            ledger: self.ledger.clone(),
            time: self.time,
            steps: self.steps,
            fresh: self.fresh,
            limits: self.limits,
            skin: self.lists.skin,
            fixed_skin: self.lists.fixed_skin,
        }
    }

    /// The bed of a checkpoint.
    pub fn restore(from: Checkpoint<R>) -> Result<Bed<R>, RestoreError> {
        from.check()?;
        let mut bed = Bed::new(from.domain, from.laws);
        (bed.gravity, bed.damping, bed.dt) = (from.gravity, from.damping, from.dt);
        bed.index = vec![0; from.bodies.len()];
        for (place, body) in from.bodies.iter().enumerate() {
            bed.owner.resize(bed.owner.len() + usize::from(body.pebbles), place as u32);
            bed.index[body.id as usize] = place as u32;
        }
        bed.records = from
            .pebbles
            .into_iter()
            .map(|grain| {
                let mut record = R::Record::new(grain.radius, grain.mass.to_f64());
                record.place(grain.place);
                record.move_with(grain.velocity, grain.spin);
                record
            })
            .collect();
        (bed.bodies, bed.clumps, bed.walls) = (from.bodies, from.clumps, from.walls);
        bed.arms = from.arms.into_iter().map(|[x, y, z]| [x, y, z, 0.0]).collect();
        (bed.tally, bed.ledger, bed.limits) = (from.tally, from.ledger, from.limits);
        (bed.time, bed.steps, bed.fresh) = (from.time, from.steps, from.fresh);
        (bed.lists.skin, bed.lists.fixed_skin, bed.lists.outdated) = (from.skin, from.fixed_skin, true);
        bed.bonds = Bonds::none(from.glues, from.broken_bonds);
        bed.check().map_err(|fault| RestoreError::Failure(fault.into()))?;
        bed.bind(from.bonds).map_err(|e| RestoreError::Failure(e.into()))?;
        bed.rebuild_with(from.shear, from.kept).map_err(|e| RestoreError::Failure(e.into()))?;
        Ok(bed)
    }
}

impl<R: Real> Checkpoint<R> {
    /// Fails unless all parts match.
    fn check(&self) -> Result<(), RestoreError> {
        use RestoreError::Inconsistent;
        if self.version != VERSION {
            return Err(RestoreError::Version { found: self.version });
        }
        if self.laws.surfaces() == 0 || self.laws.all().len() != self.laws.surfaces().pow(2) {
            return Err(Inconsistent("laws between surfaces are missing"));
        }
        let mut named = vec![false; self.bodies.len()];
        let (mut pebbles, mut clumps) = (0, 0);
        let mut parts = vec![0; self.bodies.len()];
        for body in &self.bodies {
            match named.get_mut(body.id as usize) {
                Some(name) if !*name => *name = true,
                _ => return Err(Inconsistent("bodies are not numbered one by one")),
            }
            if body.first != pebbles {
                return Err(Inconsistent("pebbles are not in the order of their bodies"));
            }
            pebbles += u32::from(body.pebbles);
            parts[body.id as usize] = body.pebbles;
            if body.clump != super::body::SPHERE {
                let arms = self.clumps.get(body.clump as usize).map(|c| c.arms as usize + usize::from(body.pebbles));
                if body.clump != clumps || arms.is_none_or(|end| end > self.arms.len()) {
                    return Err(Inconsistent("clumps are not in the order of their bodies"));
                }
                clumps += 1;
            }
            if usize::from(body.surface) >= self.laws.surfaces() {
                return Err(Inconsistent("a body has a surface without laws"));
            }
        }
        let bodies = self.bodies.len() as u32;
        let named = |(body, part): (u32, u16)| parts.get(body as usize).is_some_and(|parts| part < *parts);
        let bound = |bond: &Bond<R>| named(bond.low) && named(bond.high) && usize::from(bond.glue) < self.glues.len();
        let known = |c: &Carried<R>| c.low.0 < bodies && c.high.0 < bodies;
        if pebbles as usize != self.pebbles.len() || clumps as usize != self.clumps.len() {
            return Err(Inconsistent("pebbles or clumps are missing"));
        }
        if !self.shear.iter().all(known) || self.walls.iter().any(|w| usize::from(w.surface()) >= self.laws.surfaces())
        {
            return Err(Inconsistent("a contact names a body, or a wall a surface, that does not exist"));
        }
        if !self.bonds.iter().all(bound) {
            return Err(Inconsistent("a bond names a pebble or a glue that does not exist"));
        }
        self.is_sane().then_some(()).ok_or(Inconsistent("it holds a number out of range"))
    }

    /// Whether the numbers that no other check covers are in their range: damaged bytes may hold any number.
    fn is_sane(&self) -> bool {
        let within = |x: f64| x.abs() <= LARGEST;
        let real = |x: &R| within(x.to_f64());
        let share = |x: &f64| x.is_finite() && *x >= 0.0;
        let of_walls = |wall: &Wall| wall.velocity.iter().chain(wall.spin.iter()).all(|x| within(*x));
        let stiff = |law: &ContactLaw| match law {
            ContactLaw::Linear(law) => [law.normal_stiffness, law.shear_stiffness],
            ContactLaw::HertzMindlin(law) => [law.effective_modulus, law.effective_shear_modulus],
        };
        let in_plane = |kept: &Kept<R>| {
            let shear = kept.shear.map(R::to_f64);
            dot(shear, kept.normal).abs() <= TILTED * norm(shear)
        };
        let moderate = |law: &ContactLaw| match law {
            ContactLaw::Linear(law) => {
                let dashpots = match law.dashpot {
                    Dashpot::Ratio { normal, shear } => normal.max(shear) <= STRONGEST,
                    Dashpot::Constant { normal, shear } => within(normal) && within(shear),
                };
                dashpots && law.friction <= STRONGEST
            }
            ContactLaw::HertzMindlin(law) => law.friction <= STRONGEST,
        };
        self.pebbles.iter().all(|grain| grain.velocity.iter().chain(&grain.spin).all(real))
            && self.bodies.iter().all(|body| share(&body.inverse_mass) && share(&body.inverse_inertia))
            && self.clumps.iter().all(|clump| clump.turning.iter().all(|x| within(*x)))
            && self.arms.iter().flatten().all(|x| x.is_finite())
            && self.shear.iter().all(|carried| carried.shear.iter().chain(&carried.damping).all(real))
            && self.kept.iter().all(|kept| kept.shear.iter().chain(&kept.damping).all(real))
            && self.kept.iter().flat_map(|kept| &kept.normal).all(|x| x.is_finite())
            && self.kept.iter().all(in_plane)
            && self.bonds.iter().all(|bond| bond.shear.iter().chain([&bond.start]).all(real))
            && self.walls.iter().all(of_walls)
            && self.laws.all().iter().flat_map(stiff).all(within)
            && self.laws.all().iter().all(moderate)
            && self.time.is_finite()
            && self.dt <= LONGEST
            && share(&self.skin)
    }
}
