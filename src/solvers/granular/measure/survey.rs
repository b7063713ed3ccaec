//! Measurements of a bed at an instant, anywhere: in boxes, in measurement spheres, and slab by slab over its height.
//!
//! - **Porosity** uses the exact part of every body inside the region.
//! - **Stress** uses the part of the branch of each contact inside the region, `σ = -(1/V) Σ s F ⊗ L` with the share s
//!   of the line between the centroids (Goldhirsch 2010, Granular Matter 12, 239-252, for the sharp border of a region;
//!   with s = 1 or 0 it is the form of Christoffersen et al. 1981, [`super::stress`]). So the stresses of parts add up
//!   to the stress of the whole, and between two levels the vertical stress is the mean of all carried forces, for any
//!   grains cut by the levels.
//! - **Velocity and acceleration** are plain means over the bodies whose centroid lies inside; every body counts
//!   equally, independent of its mass (Ahmadi et al. 2026, Eq. 2 and the text after it). The acceleration is due to
//!   contacts and weight, without local damping.
//! - **Coordination** counts the neighbours of the same bodies, including neighbours outside; **fabric** uses the
//!   contacts between bodies whose point lies inside.
//!
//! In a periodic bed a region may lie anywhere and cross borders.

use super::fabric::{equivalent, rows};
use super::forces::ContactPush;
use super::{Ball, Coordination, Fabric, Region, balance, neighbours};
use crate::solvers::granular::bed::Bed;
use crate::solvers::granular::lanes::Real;
use crate::solvers::granular::law::ContactLaw;
use crate::solvers::granular::snapshot::{ContactState, Party, Snapshot};
use crate::solvers::granular::vector::{Vec3, add, dot, norm, scale, sub};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Wider than any bed, so that only the two levels cut the bed; m.
const WIDE: f64 = 1e4;

/// Bodies and contacts of a bed, moved back into its period.
#[derive(Debug, Clone)]
pub struct Survey {
    grains: Vec<Grain>,
    touches: Vec<Touch>,
    periods: [Option<f64>; 3],
}

#[derive(Debug, Clone)]
struct Grain {
    place: Vec3,
    velocity: Vec3,
    acceleration: Vec3,
    pebbles: Vec<Ball>,
    /// From the centroid to its farthest point, m.
    reach: f64,
    volume: f64,
    neighbours: u32,
}

#[derive(Debug, Clone)]
struct Touch {
    /// Centroid of the first body.
    centre: Vec3,
    point: Vec3,
    branch: Vec3,
    /// Force on the first body.
    force: Vec3,
    normal: Vec3,
    /// Whether the second is a wall.
    wall: bool,
    friction: f64,
}

/// The measurements in a region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Bodies with their centroid inside.
    pub bodies: usize,
    pub porosity: f64,
    /// Mean number of neighbours of these bodies; 0 if there are none.
    pub coordination: f64,
    /// Mean stress, Pa, tension positive. Row: component of the force.
    pub stress: [[f64; 3]; 3],
    /// m/s; 0 without bodies.
    pub velocity: [f64; 3],
    /// m/s2; 0 without bodies.
    pub acceleration: [f64; 3],
    pub fabric: Fabric,
}

impl Reading {
    /// Pressure on a horizontal plane, Pa.
    pub fn vertical(&self) -> f64 {
        -self.stress[2][2]
    }

    /// Pressures on vertical planes, along x and along y, Pa.
    pub fn horizontal(&self) -> [f64; 2] {
        [-self.stress[0][0], -self.stress[1][1]]
    }

    /// Deviator q of the symmetric part, `√(3/2 s : s)`, Pa.
    pub fn deviator(&self) -> f64 {
        let symmetric = [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (self.stress[i][j] + self.stress[j][i])));
        equivalent(&symmetric)
    }
}

impl Survey {
    /// Surveys a bed by its present snapshot. `densities` (kg/m3) by surface give the volume of bodies with several
    /// pebbles.
    pub fn from_snapshot<R: Real>(bed: &Bed<R>, snapshot: &Snapshot, densities: &[f64]) -> Survey {
        let periods = [0, 1, 2].map(|axis| bed.domain().period(axis));
        let touches = snapshot.contacts.iter().filter_map(|contact| touch(bed, contact, &periods));
        Survey { grains: grains(bed, snapshot, densities, &periods), touches: touches.collect(), periods }
    }

    /// Measures a region at any position.
    pub fn region(&self, region: &Region) -> Reading {
        self.read(region, region.volume(), &self.periods)
    }

    /// Measures everything between two levels (m); `plan` is the plan area (m2) of the whole bed. `None` if the upper
    /// level is not above the lower level.
    pub fn slab(&self, [low, high]: [f64; 2], plan: f64) -> Option<Reading> {
        let region = Region::block([-WIDE, -WIDE, low], [WIDE, WIDE, high]).ok()?;
        Some(self.read(&region, plan * (high - low), &[None; 3]))
    }

    /// Unit normals of the contacts between bodies with a normal force above `least` (N).
    pub fn normals(&self, least: f64) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.inner().filter(move |touch| touch.normal_force() > least).map(|touch| touch.normal)
    }

    /// Forces of the contacts between bodies.
    pub fn pushes(&self) -> impl Iterator<Item = ContactPush> + '_ {
        self.inner().map(|touch| {
            let normal = touch.normal_force();
            let shear = norm(sub(touch.force, scale(touch.normal, normal)));
            ContactPush { normal, shear, friction: touch.friction }
        })
    }

    fn inner(&self) -> impl Iterator<Item = &Touch> {
        self.touches.iter().filter(|touch| !touch.wall)
    }

    fn read(&self, region: &Region, volume: f64, periods: &[Option<f64>; 3]) -> Reading {
        let bounds = region.bounds();
        let (mut solid, mut inside) = (0.0, Vec::new());
        for grain in &self.grains {
            for shift in images(&grain.place, grain.reach, &bounds, periods) {
                solid += grain.share(region, shift);
                if region.holds(&add(grain.place, shift)) {
                    inside.push(grain);
                }
            }
        }
        let (mut stress, mut normals) = (Matrix3::zeros(), Vec::new());
        for touch in &self.touches {
            for shift in images(&touch.centre, touch.reach(), &bounds, periods) {
                let from = add(touch.centre, shift);
                let share = region.share_of_line(&from, &sub(from, touch.branch));
                stress -= Vector3::from(touch.force) * Vector3::from(touch.branch).transpose() * (share / volume);
                if !touch.wall && region.holds(&add(touch.point, shift)) {
                    normals.push(touch.normal);
                }
            }
        }
        let mean = |of: fn(&Grain) -> Vec3| {
            scale(inside.iter().fold([0.0; 3], |sum, grain| add(sum, of(grain))), 1.0 / inside.len().max(1) as f64)
        };
        let counts: Vec<u32> = inside.iter().map(|grain| grain.neighbours).collect();
        Reading {
            bodies: inside.len(),
            porosity: 1.0 - solid / volume,
            coordination: Coordination::from_neighbours(&counts).mean,
            stress: rows(&stress),
            velocity: mean(|grain| grain.velocity),
            acceleration: mean(|grain| grain.acceleration),
            fabric: Fabric::from_normals(normals),
        }
    }
}

impl Grain {
    /// Volume inside a region, shifted, m3.
    fn share(&self, region: &Region, shift: Vec3) -> f64 {
        let balls: Vec<Ball> = self.pebbles.iter().map(|(place, radius)| (add(*place, shift), *radius)).collect();
        region.share_of_clump(&balls, self.volume)
    }
}

impl Touch {
    fn normal_force(&self) -> f64 {
        dot(self.force, self.normal)
    }

    /// Largest distance of a measured part from the first centroid, m.
    fn reach(&self) -> f64 {
        norm(self.branch).max(norm(sub(self.point, self.centre)))
    }
}

fn grains<R: Real>(bed: &Bed<R>, snapshot: &Snapshot, densities: &[f64], periods: &[Option<f64>; 3]) -> Vec<Grain> {
    let pair = |contact: &ContactState| Some((contact.first.body()?.0, contact.second.body()?.0));
    let pairs: Vec<(u32, u32)> = snapshot.contacts.iter().filter_map(pair).collect();
    let half_step = if bed.fresh { 0.0 } else { 0.5 * bed.dt };
    let forces = balance(bed, snapshot);
    let mut grains: Vec<Grain> = bed
        .states()
        .zip(neighbours(bed.len(), &pairs))
        .map(|(state, neighbours)| {
            let number = state.id.0 as usize;
            // including mass scaling; 0 if a body keeps its velocity
            let inverse_mass = bed.bodies[bed.index[number] as usize].inverse_mass;
            let acceleration = scale(forces[number].net, inverse_mass);
            Grain {
                place: state.place,
                velocity: add(state.velocity, scale(acceleration, half_step)),
                acceleration,
                pebbles: Vec::new(),
                reach: 0.0,
                volume: densities.get(usize::from(state.surface)).map_or(0.0, |density| state.mass / density),
                neighbours,
            }
        })
        .collect();
    for pebble in bed.pebbles() {
        let grain = &mut grains[pebble.body.0 as usize];
        grain.reach = grain.reach.max(norm(sub(pebble.place, grain.place)) + pebble.radius);
        grain.pebbles.push((pebble.place, pebble.radius));
    }
    for grain in &mut grains {
        let shift = into_period(&grain.place, periods);
        grain.place = add(grain.place, shift);
        grain.pebbles.iter_mut().for_each(|(place, _)| *place = add(*place, shift));
    }
    grains
}

fn touch<R: Real>(bed: &Bed<R>, contact: &ContactState, periods: &[Option<f64>; 3]) -> Option<Touch> {
    let first = bed.body_state(contact.first.body()?);
    let (wall, surface) = match contact.second {
        Party::Wall(wall) => (true, bed.wall(wall).surface()),
        Party::Body(body, _) => (false, bed.body_state(body).surface),
    };
    let shift = into_period(&first.place, periods);
    let friction = match bed.laws().get(first.surface, surface) {
        ContactLaw::Linear(law) => law.friction,
        ContactLaw::HertzMindlin(law) => law.friction,
    };
    Some(Touch {
        centre: add(first.place, shift),
        point: add(contact.point, shift),
        branch: contact.branch,
        force: contact.force,
        normal: contact.normal,
        wall,
        friction,
    })
}

/// The shift that moves a position back into the period, m.
fn into_period(place: &Vec3, periods: &[Option<f64>; 3]) -> Vec3 {
    [0, 1, 2].map(|axis| periods[axis].map_or(0.0, |period| -period * (place[axis] / period).floor()))
}

/// Shifts, m, by which a body of this reach comes near a box across a period.
fn images(place: &Vec3, reach: f64, [low, high]: &[Vec3; 2], periods: &[Option<f64>; 3]) -> Vec<Vec3> {
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let (least, most) = (low[axis] - reach - place[axis], high[axis] + reach - place[axis]);
        match periods[axis] {
            Some(period) => {
                let count = (least / period).ceil() as i64..=(most / period).floor() as i64;
                count.map(|n| n as f64 * period).collect()
            }
            None if least <= 0.0 && most >= 0.0 => vec![0.0],
            None => vec![],
        }
    });
    let planes = x.iter().flat_map(|x| y.iter().map(move |y| (x, y)));
    planes.flat_map(|(x, y)| z.iter().map(move |z| [*x, *y, *z])).collect()
}
