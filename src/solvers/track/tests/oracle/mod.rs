//! An independent solution of a passage: separate elements by quadrature, separate bodies, no matrix of the solver.
//!
//! A support carries `R = k g + c g'` while its gap g and R are above 0, otherwise 0. Between two changes its law is
//! linear, so an integrator keeps its order. The indentation d of a wheel solves `d + L C_H d^1.5 = approach` with the
//! local compliance L of its element.

mod elements;
mod wagon;

pub mod dormand_prince;

use super::super::*;
use elements::{Band, cubics, integrated};

#[derive(Clone, Copy)]
struct Support {
    node: usize,
    pad: (f64, f64),
    mass: f64,
    ground: (f64, f64),
    settlement: f64,
}

/// Track and wagon, and their state. The state is rail (deflection and slope of every node), sleepers, wagon (car body
/// bounce and pitch, the same for both bogies, four wheels), then the velocities of all of these.
pub struct Oracle {
    h: f64,
    rail_mass: f64,
    bending: [[f64; 4]; 4],
    bending_stiffness: f64,
    inverse_mass: Band,
    nodes: usize,
    supports: Vec<Support>,
    wagon: Vehicle,
    gravity: f64,
    first_wheel: f64,
    speed: f64,
    pub carrying: Vec<bool>,
    /// Start, length and depth (m) of a dip in the running surface, a parabola.
    pub dip: Option<[f64; 3]>,
}

impl Oracle {
    /// The same track and run as the passage, with an even number of elements per bay; the four end unknowns of the
    /// rail are held.
    pub fn new(model: &TrackModel, level: &TrackLevel, wagon: Vehicle, first_wheel: f64, speed: f64) -> Self {
        let h = 0.6 / model.elements_per_bay as f64;
        let elements = ((model.ends[1] - model.ends[0]) / h).round() as usize;
        let section = model.rail[0];
        let mass = integrated(section.mass, h, 0);
        let mut rows = vec![[0.0; 4]; 2 * elements + 2];
        for e in 0..elements {
            for i in 0..4 {
                for j in 0..=i {
                    rows[2 * e + i][i - j] += mass[i][j];
                }
            }
        }
        let last = rows.len();
        for held in [0, 1, last - 2, last - 1] {
            for d in 1..4 {
                rows[held][d] = 0.0;
                if held + d < last {
                    rows[held + d][d] = 0.0;
                }
            }
            rows[held][0] = 1.0;
        }
        let supports = model.seats.iter().zip(&level.settlements).map(|(seat, settlement)| {
            let Foot::Sleeper { mass, support_stiffness, support_damping, .. } = seat.foot else { panic!("a sleeper") };
            Support {
                node: ((seat.x - model.ends[0]) / h).round() as usize,
                pad: (seat.pad_stiffness, seat.pad_damping),
                mass,
                ground: (support_stiffness, support_damping),
                settlement: *settlement,
            }
        });
        let supports: Vec<Support> = supports.collect();
        Self {
            h,
            rail_mass: section.mass,
            bending: integrated(section.bending_stiffness, h, 2),
            bending_stiffness: section.bending_stiffness,
            inverse_mass: Band::factor(rows),
            nodes: elements + 1,
            carrying: vec![true; supports.len()],
            dip: None,
            supports,
            wagon,
            gravity: model.gravity,
            first_wheel,
            speed,
        }
    }

    /// Seats of the track.
    pub fn seats(&self) -> usize {
        self.supports.len()
    }

    fn unknowns(&self) -> usize {
        2 * self.nodes + self.supports.len() + 10
    }

    /// Force of a wheel on the rail, N.
    pub fn wheel_force(&self, wheel: usize, time: f64, y: &[f64]) -> f64 {
        self.wheel(wheel, time, y).0
    }

    /// The same, its element and the cubics at its place.
    fn wheel(&self, wheel: usize, time: f64, u: &[f64]) -> (f64, usize, [f64; 4]) {
        let offset = [0.0, 1.0, 0.0, 1.0][wheel] * self.wagon.wheelset_spacing
            + [0.0, 0.0, 1.0, 1.0][wheel] * self.wagon.bogie_spacing;
        let x = self.first_wheel + self.speed * time - offset;
        let element = ((x / self.h).floor().max(0.0) as usize).min(self.nodes - 2);
        let a = x - element as f64 * self.h;
        let n = cubics(a / self.h, self.h, 0);
        let rail: f64 = (0..4).map(|i| n[i] * u[2 * element + i]).sum();
        let surface = self.dip.map_or(0.0, |[start, length, depth]| {
            let t = ((x - start) / length).clamp(0.0, 1.0);
            4.0 * depth * t * (1.0 - t)
        });
        let approach = u[self.unknowns() - 4 + wheel] - rail - surface;
        let local = (a * (self.h - a) / self.h).powi(3) / (3.0 * self.bending_stiffness);
        let hertz = self.wagon.hertz;
        let mut d = approach.max(0.0);
        for _ in 0..8 {
            d -= (d + local * hertz * d * d.sqrt() - approach.max(0.0)) / (1.0 + 1.5 * local * hertz * d.sqrt());
        }
        (hertz * d * d.sqrt(), element, n)
    }

    fn support_line(&self, s: usize, y: &[f64]) -> (f64, f64) {
        let (support, i) = (&self.supports[s], 2 * self.nodes + s);
        let gap = y[i] - support.settlement;
        (gap, support.ground.0 * gap + support.ground.1 * y[self.unknowns() + i])
    }

    pub fn support_force(&self, s: usize, y: &[f64]) -> f64 {
        if self.carrying[s] { self.support_line(s, y).1.max(0.0) } else { 0.0 }
    }

    pub fn seat_load(&self, s: usize, y: &[f64]) -> f64 {
        let (support, rail, foot, n) =
            (&self.supports[s], 2 * self.supports[s].node, 2 * self.nodes + s, self.unknowns());
        support.pad.0 * (y[rail] - y[foot]) + support.pad.1 * (y[n + rail] - y[n + foot])
    }

    /// Derivative of the state.
    pub fn rate(&self, time: f64, y: &[f64], rate: &mut [f64]) {
        let n = self.unknowns();
        let (u, v) = y.split_at(n);
        let (velocity, force) = rate.split_at_mut(n);
        velocity.copy_from_slice(v);
        force.fill(0.0);
        let (h, weight) = (self.h, self.rail_mass * self.gravity);
        for e in 0..self.nodes - 1 {
            let own = &u[2 * e..2 * e + 4];
            let even = [weight * h / 2.0, weight * h * h / 12.0, weight * h / 2.0, -weight * h * h / 12.0];
            for i in 0..4 {
                let bent: f64 = (0..4).map(|j| self.bending[i][j] * own[j]).sum();
                force[2 * e + i] += even[i] - bent;
            }
        }
        for (s, support) in self.supports.iter().enumerate() {
            let foot = 2 * self.nodes + s;
            let pad = self.seat_load(s, y);
            force[2 * support.node] -= pad;
            let ground = if self.carrying[s] { self.support_line(s, y).1 } else { 0.0 };
            force[foot] = (pad - ground) / support.mass + self.gravity;
        }
        let mut wheel_forces = [0.0; 4];
        for (wheel, found) in wheel_forces.iter_mut().enumerate() {
            let (q, element, shape) = self.wheel(wheel, time, u);
            *found = q;
            for i in 0..4 {
                force[2 * element + i] += q * shape[i];
            }
        }
        let rail = &mut force[..2 * self.nodes];
        for held in [0, 1, 2 * self.nodes - 2, 2 * self.nodes - 1] {
            rail[held] = 0.0;
        }
        self.inverse_mass.solve(rail);
        let at = n - 10;
        wagon::accelerations(&self.wagon, self.gravity, &u[at..], &v[at..], wheel_forces, &mut force[at..]);
    }

    /// Sets the phases of the supports from the state.
    pub fn settle_phases(&mut self, y: &[f64]) {
        for s in 0..self.supports.len() {
            let (gap, force) = self.support_line(s, y);
            self.carrying[s] = gap.min(force) > 0.0;
        }
    }

    pub fn contradicted(&self, y: &[f64]) -> bool {
        (0..self.supports.len()).any(|s| {
            let (gap, force) = self.support_line(s, y);
            self.carrying[s] != (gap.min(force) > 0.0)
        })
    }
}
