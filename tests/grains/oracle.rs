//! A plain solver of the same equations, to compare with: every pair in turn, a struct a sphere, double precision.
//!
//! PFC's linear model as its manual states it: springs by overlap and by increments of shear, dashpots by the share of
//! critical damping, properties of pairs from two surfaces, Cundall's damping, leapfrog. It knows the kernel only by
//! the numbers that describe a scene.

use crate::scenes::{Vec3, add, cross, dot, norm, scaled, sub};
use std::collections::BTreeMap;
use trackbed::solvers::granular::Surface;

pub struct Grain {
    pub place: Vec3,
    pub velocity: Vec3,
    pub spin: Vec3,
    pub radius: f64,
    pub mass: f64,
    pub surface: usize,
}

pub struct Plane {
    pub point: Vec3,
    pub normal: Vec3,
    pub surface: usize,
}

pub struct Oracle {
    pub grains: Vec<Grain>,
    pub planes: Vec<Plane>,
    pub surfaces: Vec<Surface>,
    pub gravity: Vec3,
    pub damping: f64,
    pub dt: f64,
    pub steps: u64,
    /// Shear force on the first of two, while they touch; planes are counted behind the grains.
    shear: BTreeMap<(usize, usize), Vec3>,
}

/// One side of a contact.
struct Side {
    spin: Vec3,
    surface: usize,
    /// Velocity of its material at the contact point.
    at_contact: Vec3,
}

impl Oracle {
    pub fn new(grains: Vec<Grain>, planes: Vec<Plane>, surfaces: Vec<Surface>) -> Oracle {
        let shear = BTreeMap::new();
        Oracle { grains, planes, surfaces, gravity: [0.0; 3], damping: 0.0, dt: 0.0, steps: 0, shear }
    }

    pub fn step(&mut self) {
        let count = self.grains.len();
        let mut loads = vec![([0.0; 3], [0.0; 3]); count];
        let mut shear = BTreeMap::new();
        for i in 0..count {
            for j in i + 1..count {
                let (a, b) = (&self.grains[i], &self.grains[j]);
                let apart = sub(a.place, b.place);
                let distance = norm(apart);
                let overlap = a.radius + b.radius - distance;
                if overlap <= 0.0 {
                    continue;
                }
                let normal = scaled(apart, 1.0 / distance);
                let point = sub(a.place, scaled(normal, a.radius - overlap / 2.0));
                let mass = a.mass * b.mass / (a.mass + b.mass);
                let (force, spring) = self.contact((i, j), overlap, normal, mass, a.side(point), b.side(point));
                shear.insert((i, j), spring);
                push(&mut loads[i], force, sub(point, a.place));
                push(&mut loads[j], scaled(force, -1.0), sub(point, b.place));
            }
            for (k, plane) in self.planes.iter().enumerate() {
                let a = &self.grains[i];
                let overlap = a.radius - dot(sub(a.place, plane.point), plane.normal);
                if overlap <= 0.0 {
                    continue;
                }
                let point = sub(a.place, scaled(plane.normal, a.radius - overlap / 2.0));
                let still = Side { spin: [0.0; 3], surface: plane.surface, at_contact: [0.0; 3] };
                let key = (i, count + k);
                let (force, spring) = self.contact(key, overlap, plane.normal, a.mass, a.side(point), still);
                shear.insert(key, spring);
                push(&mut loads[i], force, sub(point, a.place));
            }
        }
        self.shear = shear;
        let (gravity, damping, dt) = (self.gravity, self.damping, self.dt);
        // positions stand at full steps and velocities at half steps, but for the start
        let kick = if self.steps == 0 { dt / 2.0 } else { dt };
        for (grain, (force, moment)) in self.grains.iter_mut().zip(loads) {
            let force = add(force, scaled(gravity, grain.mass));
            let inertia = 0.4 * grain.mass * grain.radius * grain.radius;
            for c in 0..3 {
                let braked = |load: f64, rate: f64, inertia: f64| {
                    let now = rate + load / inertia * kick / 2.0;
                    load - damping * load.abs() * if now > 0.0 { 1.0 } else { -1.0 }
                };
                grain.velocity[c] += braked(force[c], grain.velocity[c], grain.mass) / grain.mass * kick;
                grain.spin[c] += braked(moment[c], grain.spin[c], inertia) / inertia * kick;
                grain.place[c] += grain.velocity[c] * dt;
            }
        }
        self.steps += 1;
    }

    /// Force on the first, and that of its shear spring alone.
    fn contact(&self, key: (usize, usize), overlap: f64, normal: Vec3, mass: f64, a: Side, b: Side) -> (Vec3, Vec3) {
        let (one, other) = (&self.surfaces[a.surface], &self.surfaces[b.surface]);
        let series = |k: f64, l: f64| 1.0 / (1.0 / k + 1.0 / l);
        let kn = series(one.normal_stiffness, other.normal_stiffness);
        let ks = series(one.shear_stiffness, other.shear_stiffness);
        let friction = one.friction.min(other.friction);
        let cn = 2.0 * one.damping[0].min(other.damping[0]) * (mass * kn).sqrt();
        let cs = 2.0 * one.damping[1].min(other.damping[1]) * (mass * ks).sqrt();

        let relative = sub(a.at_contact, b.at_contact);
        let approach = -dot(relative, normal);
        let slip = add(relative, scaled(normal, approach));
        let spring = kn * overlap;
        let total = (spring + cn * approach).max(0.0);

        let before = self.shear.get(&key).copied();
        // a contact that is new was there for a part of the step only
        let part = match before {
            None if approach > 0.0 => (overlap / (approach * self.dt)).min(1.0),
            _ => 1.0,
        };
        let twist = dot(add(a.spin, b.spin), normal) / 2.0 * self.dt;
        let carried = before.map_or([0.0; 3], |force| carried(force, normal, twist));
        let trial = sub(carried, scaled(slip, ks * self.dt * part));
        let slides = norm(trial) > friction * spring;
        let held = if slides { scaled(trial, friction * spring / norm(trial)) } else { trial };
        let viscous = if slides { [0.0; 3] } else { scaled(slip, -cs) };
        (add(scaled(normal, total), add(held, viscous)), held)
    }
}

/// The shear force in the contact plane of now: as large as it was, and turned by the twist.
fn carried(force: Vec3, normal: Vec3, twist: f64) -> Vec3 {
    let size = norm(force);
    let inside = sub(force, scaled(normal, dot(force, normal)));
    if norm(inside) == 0.0 {
        return inside;
    }
    let inside = scaled(inside, size / norm(inside));
    add(inside, scaled(cross(normal, inside), twist))
}

impl Grain {
    fn side(&self, point: Vec3) -> Side {
        let at_contact = add(self.velocity, cross(self.spin, sub(point, self.place)));
        Side { spin: self.spin, surface: self.surface, at_contact }
    }
}

fn push((force, moment): &mut (Vec3, Vec3), by: Vec3, arm: Vec3) {
    *force = add(*force, by);
    *moment = add(*moment, cross(arm, by));
}
